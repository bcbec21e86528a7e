<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" sourcelanguage="en">
<context>
    <name>App::Property</name>
    <message>
        <source>A hole that is made before, or comes with the stock (`in_stock = true`), at least as deep as the pocket: the tool goes down in it.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A second set of rows over the same faces, across the first.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A table of cutting data of your own (TOML), which goes before the shipped one; relative to the job file.
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Air that rapids below clearance keep above the part, the sheet as it stands and uncut stock, mm.
Range: 0.1 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle from the first set of rows to the second, degrees; 90 when left out.
Range: 10 to 170 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of helices and ramps down into the material, degrees.
Range: 0.1 to 30 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of ramps along the wall from level to level, degrees: they leave no line of steps; straight down when left out.
Range: 0.1 to 45 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of the arcs of leads, degrees.
Range: 1 to 90 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>By how much holes may be wider than the tool, mm: for core holes of threads, holes that are reamed or bored afterwards.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>By how much that direction turns from level to level, degrees: 137.5 spreads the beginnings evenly.
Range: -360 to 360 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>By how much the angle may become larger, degrees; with the engagement angle 90 at most.
Range: 0 to 80 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of helices and length of ramps, of the path of the tool's centre, mm at most; 0.7 tool diameters and 1 when left out.
Range: above 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the holes that are bored, mm; when left out, all that are wider than the tool.
Range: above 0 to 10000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Direction from a loop's middle in which it begins, degrees from +X; where it is nearest when left out.
Range: -360 to 360 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Direction of rows from +X, degrees.
Range: -360 to 360 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between helices, mm at most, where the tool is too narrow to clear the hole in one; its radius when left out.
Range: 0.01 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between levels.
No more than this scallop between them, mm: steps follow from the wall's slope and curvature and from the tool.
Range: above 0 to 10 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between levels.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between levels.
These distances one after the other, mm, from `z_top` or the sheet's (the part's) highest point down; the last one again
and again.
Range: above 0 to 100 mm
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between rows in plan, mm.
Range: above 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Faces that the tool keeps away from: "rest" (all others that face up, or stand upright where faces = "all" takes upright
walls), or names; the part's when left out.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Faces that the tool keeps away from: "rest" (all others), or names: ["Face7"].
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Fall of a turn, mm at most: turns share the depth evenly.
Range: 0.01 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Feed along helices and ramps, mm/min; that of plunges when left out. It is lower where they would take more stock in a minute than the
passes do.
Range: 0.1 to 100000 mm/min
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Feed of links at depth, through what is cleared, mm/min, within the machine's highest; max_feed when left out, or without it the feed of
the passes.
Range: 0.1 to 100000 mm/min
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Feed per revolution along the path, mm: the distance between its turns on the part.
Range: 0.001 to 20 mm/rev</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Highest feed, mm/min: where less than a full stepover is cut, the feed rises up to it, so that as much stock is taken in a
minute. The feed of the passes everywhere when left out.
Range: 0.1 to 100000 mm/min
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How deep a row presses the sheet at most below where it stands, mm: flat sheet is formed by rows in layers so far apart.
When left out, rows finish what operations before them have formed.
Range: 0.05 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How deep blind holes are drilled. Through holes are drilled to their full diameter.
tip: The tool's tip reaches the floor: of a flat floor its point leaves a cone.
full-diameter: The tool's full diameter reaches the end of the wall: for floors that are modelled as cones.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far above a hole's top the tool comes down at rapid, mm.
Range: 0.1 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far above the exact path the posted one may lie, mm; below it, never more than 0.001.
Range: 0.0001 to 1 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the lower end of the tool's cone is below the chamfer, mm: so its side cuts, and not its tip.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the side of the tool goes on below the lower rail, mm; a round end lies below that. Below 0 the side ends above the rail, where a
floor is in the way, and what is lower stays.
Range: -100 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the tool goes on beyond both ends of the surface, mm: the curves go on as they end.
Range: 0 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the tool is lifted off the floor on links at depth, mm.
Range: 0 to 10 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the tool's full diameter goes on below through holes, mm.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far tool, shank and holder, with the sheet under them, stay away from those faces, mm; 0 when left out.
Range: 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far tool, shank and holder, with the sheet under them, stay away from those faces, mm; the part's when left out.
Range: 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How high rapids from pass to pass go.
clearance: To clearance.
low: `link_margin` above what stands under the line that they cross, clearance at most: for machines whose rapids go straight.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the thickness behaves as the sheet is formed.
constant: The same thickness everywhere, along the normal.
sine: Pure shear: a vertical column keeps its height, so a wall of slope phi is t cos(phi) thick.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the tool comes from the air into a pass and leaves it; straight where that does not fit. Loops begin where it fits, unless
their seam is stated.
none: None: straight down and straight up.
tangent: An arc tangent to the pass, in its plane, on the free side.
vertical: An arc tangent to the pass in the vertical plane, from above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the tool goes down into stock, where it cannot come from an open side.
auto: A helix; a ramp where there is room for a small helix only, and more along a line.
helix: Helices.
ramp: Zig-zag ramps: to and fro along a line, both ways going down.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the tool is placed along the surface.
swept: It touches both rails, and what its movement leaves of the surface between them is least.
rails: It touches both rails at equal parameters.
three-points: It touches both rails and the line between them.
two-points: Two points of its axis lie beside two points of the line.
one-point: Its axis is parallel to the line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the tool turns from a row to the next.
straight: A line along the surface.
rounded: Without a corner, along arcs of half the distance between the rows; where none fits, straight.
looped: Without a corner, along a loop of `turn_radius` beyond the ends of the rows; where none fits, straight.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In which direction levels and rows are run.
alternate: Every other one in the other direction: counters the twist of a formed sheet.
same: All in the same direction: the higher ground on the right of levels, rows along `angle_deg`.
climb: All so that the turning tool meets the material from its uncut side: on the right of a tool that turns clockwise.
conventional: All the other way round than `climb`.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In which order loops of several areas are run: areas are apart by more than the tool's diameter. When left out by level
in forming, else by area.
0 or empty: not stated
by-level: All of a level before the next one: a sheet is formed evenly.
by-area: Each area from the top down before the next one, where that is less air.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intermediate stages: their wall angles, degrees, rising, [50.0, 65.0]; or how many, 2, which are then spread evenly between
what the sheet withstands in one pass and the part's steepest wall. All operations are done for each stage first, whose walls
are no steeper, and for the part at last; for walls that the sheet does not withstand in one pass.
Range: 1 to 89
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest angle by which the path turns from one cutting move to the next, degrees: passes that follow the surface get shorter lines
and arcs for it. Edges of the part, straight links and plunges turn by more; the verification names each. Not limited when left out.
Range: 0.1 to 90 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest deviation of the triangles from the model's surfaces, mm; checked by sampling.
Range: 0.0001 to 1 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest step by scallop, mm; the tool's radius when left out.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Length of the way in from the free side and out to it, mm.
Range: 0 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lower feeds before and behind sharp turns and on small arcs, as far as the machine's acceleration asks for them
(`limits.acceleration` and `limits.corner_tolerance` of its file).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most that a pass cuts along the tool, mm; all at once, as far as the tool's length allows it, when left out. Cylinders only.
Range: 0.1 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most that may be left on the faces where the tool cannot get, mm; 1 mm of a sheet, and not checked in milling, when left
out.
Range: 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most that the tool may enter the surface or leave on it when it moves, mm: twisted surfaces cannot be milled exactly.
Range: 0.0001 to 10 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Name of the tool under the sheet, for all operations.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>No loop is missed whose inside or surroundings hold a disc of this diameter, mm.
Range: 0.01 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>No more than this scallop between rows, mm: they lie closer than the stepover where that takes it.
Range: above 0 to 10 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Of what feeds.cut is the feed.
rim: Of the tool's rim on the wall, as tables of cutting data state it: the axis is slower by (D - d) / D.
axis: Of the tool's axis, as it is posted: the rim is faster.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>On which side of the edges the tool is: of those that close outside, inside or on; of others left, right or on, seen from the first
named one on.
outside: Outside of edges that close.
inside: Inside of them.
left: On the left of edges that do not close.
right: On the right of them.
on: On the edges: the tip goes along them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One more level at every level floor that no other level stands on: shoulders and pockets' floors at their exact height.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One operation: what is common to all kinds.
z-level: Loops at constant heights, from the top down.
zig-zag: Parallel rows over the surface.
spiral: One descent along the walls: a loop at the top, turns that fall evenly along their length, a loop at the bottom. Where a
wall's loops part (two pockets in one cup) each part has a spiral of its own. It runs one way: the higher ground on its right.
meridian: The path along the part's meridian, from the axis outwards, in X and Z, while the spindle turns the part: for parts that are
surfaces of revolution about X = Y = 0, which is measured, with a tool that stands parallel to that axis. `feeds.cut` follows from
the feed per revolution and the spindle's speed.
pocket: Clears the stock over the selected faces, or all of it, level by level, with an engagement angle that stays below a bound all along the path.
Stock is that of the set-up, the part's box where it states none, or what the operations before leave of it.
flank: Mills ruled surfaces, such as blades and twisted walls, with the side of a tool that leans: on machines with two rotary axes. The tool
is a cylinder or a cone, with a flat end or a round one.
drill: Drills, taps or bores the round upright holes among the selected faces, each along its axis from its own top. Machines without the
cycle get its moves. Of faces = "all" only holes of the tool's diameter are taken; named faces must all be walls of such holes.
helix-bore: Bores the round upright holes among the selected faces with a tool narrower than they are: down along a helix with a level turn at its
end, back to the axis and up; in several, from the inside out, where one would leave a core. Turns are full circles, or short lines on
machines without these arcs. Of faces = "all" wider holes are taken; named faces must all be walls of such holes. All directions but
conventional are climb.
constant-scallop: Contours over the surface, from its border inwards, between which the same scallop stands everywhere.
pencil: Passes along concave edges and narrow fillets, where the tool touches two faces at once: they take what wider steps and a larger
tool leave in the corners.
chamfer: Chamfers the sharp edges between the level ones of the selected faces and the walls that go down from them, with the cone of a tool:
the chamfer has its angle. The model has the edges sharp. What the tool cannot reach without entering what is beside it is left, and
listed. All directions but conventional are climb.
contour: Mills along level edges of the part, beside them or on them, level by level down the walls at them. The tool stands so that its
silhouette touches the upright plane through the edge; where it would enter the part elsewhere the path ends, and what is left is listed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Plan what can be reached of named faces that partly face down.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of leads, mm.
Range: 0.1 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of looped turns, mm.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Risks that are taken: what the verifier would report for them as an error becomes a warning.
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the faces, 0 to 1, that the tool may be unable to get to.
Range: 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smallest distance between rows by scallop, mm: steeper walls keep it and a larger scallop; a tenth of the stepover when
left out.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smallest radius of the path of the tool's centre, mm: corners stay rounded by it and the tool's radius; a twentieth of the
tool's radius when left out.
Range: above 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smallest step by scallop, mm: gentler slopes keep it and a larger scallop; what the scallop allows at 10 degrees when left
out.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Steepest wall that may be formed, degrees; when left out, what is known of `process.material`, or of any sheet, decides.
Range: 1 to 90 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stock that stays on the surface, mm along its normals.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stock that stays on walls, mm, measured across them in plan; a pocket with `finish` takes it last.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stock that stays under the tool, on floors and slopes, mm in height; a pocket with `finish` takes it last.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tabs that hold the part while loops cut it out.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tensile strength of its material, MPa: for an estimate of the axial force; none is made when left out.
Range: 1 to 3000 MPa
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The curves between which the surface is ruled; when left out, the selected faces are milled, each of which must be ruled.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The edges by their names, as FreeCAD shows them: ["Edge3", "Edge7"]; all edges of the selected level faces when left out.
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The engagement angle that the path keeps to, degrees: of the arc along which the tool's rim is in the material.
Range: 10 to 90 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The least angle by which the two faces turn away from each other where the tool touches them, degrees.
Range: 6 to 175 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The side of stated rails on which the tool moves, seen along them with the upper one above the lower one; of faces, it is outside.
0 or empty: not stated
left: To the left, seen along the rails with the second above the first.
right: To the right.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The steepest helix that the tool withstands, degrees; steeper ones are refused.
Range: 0.1 to 60 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thickness, mm.
Range: above 0 to 50 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thinnest that the sheet may become, by the sine law, mm; not checked when left out.
Range: above 0 to 50 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What formed parts were measured, or simulated, to deviate by: the part is formed the other way. The verifier then compares
with the part as it is formed.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What happens at the outer edges of the selected faces; when left out, passes stop there, and in forming roll over those
that the tool comes down over.
0 or empty: not stated
roll: The tool rolls over them, its contact on the edge, until it touches another face or leaves the edge.
stop: They end where the contact reaches the edge.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What holds it.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What is done at each hole.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What is done to it.
spif: Single-point incremental forming: a sheet, no die.
dsif: Double-sided incremental forming: a sheet between two tools. The one below follows the contacts of the one above, on the
other face of the sheet, block by block; its machine is in `[machines.support]`.
milling: Milling: no sheet.
spinning: Shear spinning: a disc of sheet and a mandrel of the part's shape turn about Z, and the tool goes along the part's meridian, from
the centre outwards, once. X is the distance from the axis, Y stays 0. Parts that are surfaces of revolution about Z only.
tpif: Two-point incremental forming: a sheet over a male die, with a clamp frame that goes down, or into a female one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What is formed around a part without a flange: a wall from its outer edge to the blank's plane. Its faces have the names
"Addendum" and "Blank".
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What is left between the tools, as a share of the thickness that the sheet has there: below 1 they squeeze it.
Range: 0.8 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What lies under the sheet.
male: The part is formed over it from outside, from its top outwards and down; the clamp frame goes down with the path.
female: The part is formed into it from inside; the sheet is clamped at its rim.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What the part is cut from; its box when left out.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What the part is made of, by a name. Of a sheet, that of a shipped material (`styluscam material list`): it sets the steepest wall
that the sheet withstands. Of what is milled, that of a table of cutting data (`styluscam material cutting`): feeds and the spindle
that an operation leaves out follow from it.
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What the posted path is made of.
lines: Lines.
arcs: Arcs and lines, of which fewer are needed; lines where the machine has no arc for it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Where passes may run: inside edges in plan, and on contacts of some slopes.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whether feeds rise no higher than the thickest chip allows: it is nowhere thicker than at a full stepover.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whether the stock to leave is taken as well, after the rest of its level: by a pass along the walls and a layer over each level floor,
with the same bound of the engagement angle.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whether the tool goes straight down to each level instead, into the material too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Which face of the sheet the model shows; required with a sheet.
0 or empty: not stated
tool: The face that the tool touches.
back: The face away from the tool.
mid: The middle of the sheet.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Which stock is cleared on each level: that over the selected faces, or all that the tool reaches, around the part too (roughing). Levels
go down to the lowest selected face that the tool reaches; of all stock to z_bottom, where that is stated.
faces: That in areas over the selected faces: a pocket.
stock: All that the tool reaches, around the part too: roughing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Width of the chamfer, mm, measured level; some tenths deburr.
Range: 0.01 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
</context>
<context>
    <name>StylusCAM</name>
    <message>
        <source>(r, z) from the tip outwards, mm; moved so that the first is the tip.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A V-shaped engraver with a flat tip.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A ball that runs tangentially into an arc of a larger circle.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A ball with a conical side.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A cone to the shank's diameter.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A cone, its tip rounded by a ball unless `tip_radius` is 0.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A convex curve through measured points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A curve by formula: explicit, parametric or implicit.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A cylinder of the base's diameter.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A dome milled with FreeCAD's own ball end mill, row by row</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A flat end with a sharp corner.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A flat with a rounded corner, as the milling cutter.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A function of r and z that is zero on the curve.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A half circle, the ball-end tool; or with `radius` the part of a larger circle that the diameter cuts off.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A helix; a ramp where there is room for a small helix only, and more along a line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A hole that is made before, or comes with the stock (`in_stock = true`), at least as deep as the pocket: the tool goes down in it.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A line along the surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A point [r, z] of the curve that `implicit` describes, or near it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A rectangle with rounded corners, as the forming stylus: flat, arc, vertical side.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A second set of rows over the same faces, across the first.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A sheet formed with a clothoid stylus, level by level</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A smooth transition to the shank's diameter, with one tangent at both ends.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A table of cutting data of your own (TOML), which goes before the shipped one; relative to the job file.
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Accepted risks</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Addendum</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Adds a tool of any convex shape to the job in front; its spindle stays off</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Adds the selected tool to FreeCAD's tool library, with exact numbers</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Adds the tool of a file (.fctb of FreeCAD, .json of StylusCAM) to the job in front</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Advanced</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Air that rapids below clearance keep above the part, the sheet as it stands and uncut stock, mm.
Range: 0.1 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All faces that face up, when no face is selected</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All in the same direction: the higher ground on the right of levels, rows along `angle_deg`.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All of a level before the next one: a sheet is formed evenly.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All so that the turning tool meets the material from its uncut side: on the right of a tool that turns clockwise.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All that the tool reaches, around the part too: roughing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All the other way round than `climb`.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Allow undercuts</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>An arc tangent to the pass in the vertical plane, from above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>An arc tangent to the pass, in its plane, on the free side.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle between axis and side, degrees.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle from the first set of rows to the second, degrees; 90 when left out.
Range: 10 to 170 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of helices and ramps down into the material, degrees.
Range: 0.1 to 30 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of ramps along the wall from level to level, degrees: they leave no line of steps; straight down when left out.
Range: 0.1 to 45 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of the arcs of leads, degrees.
Range: 1 to 90 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Apex radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Arcs and lines, of which fewer are needed; lines where the machine has no arc for it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Axial</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Axial stock to leave</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ball</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Barrel</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Base</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Bores the round upright holes among the selected faces with a tool narrower than they are: down along a helix with a level turn at its
end, back to the axis and up; in several, from the inside out, where one would leave a core. Turns are full circles, or short lines on
machines without these arcs. Of faces = "all" wider holes are taken; named faces must all be walls of such holes. All directions but
conventional are climb.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Boundary</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Breakthrough</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Bull nose</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>By how much holes may be wider than the tool, mm: for core holes of threads, holes that are reamed or bored afterwards.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>By how much that direction turns from level to level, degrees: 137.5 spreads the beginnings evenly.
Range: -360 to 360 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>By how much the angle may become larger, degrees; with the engagement angle 90 at most.
Range: 0 to 80 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cancelling...</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Chamfer</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Chamfers the sharp edges between the level ones of the selected faces and the walls that go down from them, with the cone of a tool:
the chamfer has its angle. The model has the edges sharp. What the tool cannot reach without entering what is beside it is left, and
listed. All directions but conventional are climb.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Check clearance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Check faces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Chip thinning</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Choose...</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Clears</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Clears the stock over the selected faces, or all of it, level by level, with an engagement angle that stays below a bound all along the path.
Stock is that of the set-up, the part's box where it states none, or what the operations before leave of it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Clothoid</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Coefficient</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Colours a pocket's path by its engagement angle, from 0 to the bound; again to take it away</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Colours ruled surfaces by what the side of the moving tool leaves of them or cuts too deep; again to take it away</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Colours the job's paths by the kind of move, with a legend; again for FreeCAD's own two colours</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Colours the model by what the job leaves on it, gouges, wall angle or thickness; again to take it away</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Colours the path by its engagement angle, from 0 to the bound; Apply computes the path</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Colours the path by the kind of move; else rapids have one colour and feed moves another</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Colours the surfaces by what the moving tool leaves of them or cuts too deep; Apply computes the path</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cone</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Constant scallop</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Contact track</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Contour</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Contours over the surface, from its border inwards, between which the same scallop stands everywhere.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Coolant</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Coolant or lubricant during this operation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Corner radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cross</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cross angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Curvature grows linearly with arc length from the tip: R L = A.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cutter material</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cutting data</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cycle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cycloid</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cylindrical</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Depth</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of helices and length of ramps, of the path of the tool's centre, mm at most; 0.7 tool diameters and 1 when left out.
Range: above 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the base, mm, if the ellipse ends before its equator.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the base, mm, where the curve ends; `z` alone needs it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the base, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the base, mm; leave it out when `scale` is given.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the cutter, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the holes that are bored, mm; when left out, all that are wider than the tool.
Range: above 0 to 10000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the shank, mm; the base's when left out.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the tip, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter tolerance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter where it is widest, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Die</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Direction</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Direction from a loop's middle in which it begins, degrees from +X; where it is nearest when left out.
Range: -360 to 360 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Direction of rows from +X, degrees.
Range: -360 to 360 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between helices, mm at most, where the tool is too narrow to clear the hole in one; its radius when left out.
Range: 0.01 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between levels.
No more than this scallop between them, mm: steps follow from the wall's slope and curvature and from the tool.
Range: above 0 to 10 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between levels.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between levels.
These distances one after the other, mm, from `z_top` or the sheet's (the part's) highest point down; the last one again
and again.
Range: above 0 to 100 mm
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between rows in plan, mm.
Range: above 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Double-sided incremental forming: a sheet between two tools. The one below follows the contacts of the one above, on the
other face of the sheet, block by block; its machine is in `[machines.support]`.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Draws the axis of a leaning tool at each position of its path; again to take it away</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Draws the job's blank, formed sheet and die instead of the block of stock; again to take them away</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Draws the tool's axis at each position of the path; Apply computes the path</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Draws where the tool touches the model along the job's paths; again to take it away</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Drill</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Drills, taps or bores the round upright holes among the selected faces, each along its axis from its own top. Machines without the
cycle get its moves. Of faces = "all" only holes of the tool's diameter are taken; named faces must all be walls of such holes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Dsif</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each area from the top down before the next one, where that is less air.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each machine file NAME.toml in this folder is a post of every job. Without a folder of your own it is the one in FreeCAD's user data</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Edge names</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Edge side</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Edges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Edit</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ellipse</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>End slope</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Engagement</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Engagement map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Engine missing</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Entry</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Entry angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Entry feed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Entry hole</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Entry size</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Error map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Every other one in the other direction: counters the twist of a formed sheet.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Example</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Exponent</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Extension</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Faces that the tool keeps away from: "rest" (all others that face up, or stand upright where faces = "all" takes upright
walls), or names; the part's when left out.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Faces that the tool keeps away from: "rest" (all others), or names: ["Face7"].
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Fall of a turn, mm at most: turns share the depth evenly.
Range: 0.01 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Feed along helices and ramps, mm/min; that of plunges when left out. It is lower where they would take more stock in a minute than the
passes do.
Range: 0.1 to 100000 mm/min
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Feed at</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Feed of links at depth, through what is cleared, mm/min, within the machine's highest; max_feed when left out, or without it the feed of
the passes.
Range: 0.1 to 100000 mm/min
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Feed per rev</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Feed per revolution along the path, mm: the distance between its turns on the part.
Range: 0.001 to 20 mm/rev</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Final Depth</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Finding</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Finish</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Fit</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Fit tolerance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Fixture</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Flank</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Flat</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Flat at the tip: its radius, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Flutes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Folder of machine files</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Formed cup</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Formula</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>From selection</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>General</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Growth</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Half an ellipse.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Half angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Heat map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height: of r when it stands alone, of t beside `r`.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Helices.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Helix bore</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Helix distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Highest feed, mm/min: where less than a full stepover is cut, the feed rises up to it, so that as much stock is taken in a
minute. The feed of the passes everywhere when left out.
Range: 0.1 to 100000 mm/min
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Holder</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How deep a row presses the sheet at most below where it stands, mm: flat sheet is formed by rows in layers so far apart.
When left out, rows finish what operations before them have formed.
Range: 0.05 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How deep blind holes are drilled. Through holes are drilled to their full diameter.
tip: The tool's tip reaches the floor: of a flat floor its point leaves a cone.
full-diameter: The tool's full diameter reaches the end of the wall: for floors that are modelled as cones.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far above a hole's top the tool comes down at rapid, mm.
Range: 0.1 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far above the exact path the posted one may lie, mm; below it, never more than 0.001.
Range: 0.0001 to 1 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the lower end of the tool's cone is below the chamfer, mm: so its side cuts, and not its tip.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the points may be from the profile, inside or outside, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the side of the tool goes on below the lower rail, mm; a round end lies below that. Below 0 the side ends above the rail, where a
floor is in the way, and what is lower stays.
Range: -100 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the tool goes on beyond both ends of the surface, mm: the curves go on as they end.
Range: 0 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the tool is lifted off the floor on links at depth, mm.
Range: 0 to 10 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the tool's full diameter goes on below through holes, mm.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far tool, shank and holder, with the sheet under them, stay away from those faces, mm; 0 when left out.
Range: 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far tool, shank and holder, with the sheet under them, stay away from those faces, mm; the part's when left out.
Range: 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How high rapids from pass to pass go.
clearance: To clearance.
low: `link_margin` above what stands under the line that they cross, clearance at most: for machines whose rapids go straight.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How many cutting edges it has.
Range: 1 to 100</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the thickness behaves as the sheet is formed.
constant: The same thickness everywhere, along the normal.
sine: Pure shear: a vertical column keeps its height, so a wall of slope phi is t cos(phi) thick.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the tool comes from the air into a pass and leaves it; straight where that does not fit. Loops begin where it fits, unless
their seam is stated.
none: None: straight down and straight up.
tangent: An arc tangent to the pass, in its plane, on the free side.
vertical: An arc tangent to the pass in the vertical plane, from above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the tool goes down into stock, where it cannot come from an open side.
auto: A helix; a ramp where there is room for a small helix only, and more along a line.
helix: Helices.
ramp: Zig-zag ramps: to and fro along a line, both ways going down.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the tool is placed along the surface.
swept: It touches both rails, and what its movement leaves of the surface between them is least.
rails: It touches both rails at equal parameters.
three-points: It touches both rails and the line between them.
two-points: Two points of its axis lie beside two points of the line.
one-point: Its axis is parallel to the line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the tool turns from a row to the next.
straight: A line along the surface.
rounded: Without a corner, along arcs of half the distance between the rows; where none fits, straight.
looped: Without a corner, along a loop of `turn_radius` beyond the ends of the rows; where none fits, straight.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Implicit</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In which direction levels and rows are run.
alternate: Every other one in the other direction: counters the twist of a formed sheet.
same: All in the same direction: the higher ground on the right of levels, rows along `angle_deg`.
climb: All so that the turning tool meets the material from its uncut side: on the right of a tool that turns clockwise.
conventional: All the other way round than `climb`.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In which order loops of several areas are run: areas are apart by more than the tool's diameter. When left out by level
in forming, else by area.
0 or empty: not stated
by-level: All of a level before the next one: a sheet is formed evenly.
by-area: Each area from the top down before the next one, where that is less air.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Included angle, degrees.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Inside of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intermediate stages: their wall angles, degrees, rising, [50.0, 65.0]; or how many, 2, which are then spread evenly between
what the sheet withstands in one pass and the part's steepest wall. All operations are done for each stage first, whose walls
are no steeper, and for the part at last; for walls that the sheet does not withstand in one pass.
Range: 1 to 89
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>It touches both rails and the line between them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>It touches both rails at equal parameters.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>It touches both rails, and what its movement leaves of the surface between them is least.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Its axis is parallel to the line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Its diameter, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Its height, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Its length, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Job</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest angle by which the path turns from one cutting move to the next, degrees: passes that follow the surface get shorter lines
and arcs for it. Edges of the part, straight links and plunges turn by more; the verification names each. Not limited when left out.
Range: 0.1 to 90 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest deviation of the triangles from the model's surfaces, mm; checked by sampling.
Range: 0.0001 to 1 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest step by scallop, mm; the tool's radius when left out.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lead</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lead angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lead length</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lead radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Least turn</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Left out</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Length</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Length from tip to holder, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Length of the way in from the free side and out to it, mm.
Range: 0 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Levels at flats</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Line</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lines.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Link feed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Link lift</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Link margin</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Links</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Load tool file...</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Loops at constant heights, from the top down.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lower feeds before and behind sharp turns and on small arcs, as far as the machine's acceleration asks for them
(`limits.acceleration` and `limits.corner_tolerance` of its file).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Machine of new jobs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Machines</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Makes a CAM job of the selected model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Material</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Max bridged</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Max corner</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Max error</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Max feed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Max increment</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Max ramp</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Max unreached</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Meridian</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Method</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Milled dome</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Milling</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Milling: no sheet.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mills along level edges of the part, beside them or on them, level by level down the walls at them. The tool stands so that its
silhouette touches the upright plane through the edge; where it would enter the part elsewhere the path ends, and what is left is listed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mills ruled surfaces, such as blades and twisted walls, with the side of a tool that leans: on machines with two rotary axes. The tool
is a cylinder or a cone, with a flat end or a round one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model face</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model tolerance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most that a pass cuts along the tool, mm; all at once, as far as the tool's length allows it, when left out. Cylinders only.
Range: 0.1 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most that may be left on the faces where the tool cannot get, mm; 1 mm of a sheet, and not checked in milling, when left
out.
Range: 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most that the tool may enter the surface or leave on it when it moves, mm: twisted surfaces cannot be milled exactly.
Range: 0.0001 to 10 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Move tool</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Moves the tool along an operation's path, with its position, feed and line</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Name</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Name of the tool under the sheet, for all operations.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>New job</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>No loop is missed whose inside or surroundings hold a disc of this diameter, mm.
Range: 0.01 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>No more than this scallop between rows, mm: they lie closer than the stepover where that takes it.
Range: above 0 to 10 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>None</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>None: straight down and straight up.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Not verified, because they are not StylusCAM's: {labels}</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Numbers by name, for use in the formulas.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Of the tool's axis, as it is posted: the rim is faster.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Of the tool's rim on the wall, as tables of cutting data state it: the axis is slower by (D - d) / D.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Of what feeds.cut is the feed.
rim: Of the tool's rim on the wall, as tables of cutting data state it: the axis is slower by (D - d) / D.
axis: Of the tool's axis, as it is posted: the rim is faster.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>On the edges: the tip goes along them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>On the left of edges that do not close.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>On the right of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>On which side of the edges the tool is: of those that close outside, inside or on; of others left, right or on, seen from the first
named one on.
outside: Outside of edges that close.
inside: Inside of them.
left: On the left of edges that do not close.
right: On the right of them.
on: On the edges: the tip goes along them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One descent along the walls: a loop at the top, turns that fall evenly along their length, a loop at the bottom. Where a
wall's loops part (two pockets in one cup) each part has a spiral of its own. It runs one way: the higher ground on its right.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One more level at every level floor that no other level stands on: shoulders and pockets' floors at their exact height.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One operation: what is common to all kinds.
z-level: Loops at constant heights, from the top down.
zig-zag: Parallel rows over the surface.
spiral: One descent along the walls: a loop at the top, turns that fall evenly along their length, a loop at the bottom. Where a
wall's loops part (two pockets in one cup) each part has a spiral of its own. It runs one way: the higher ground on its right.
meridian: The path along the part's meridian, from the axis outwards, in X and Z, while the spindle turns the part: for parts that are
surfaces of revolution about X = Y = 0, which is measured, with a tool that stands parallel to that axis. `feeds.cut` follows from
the feed per revolution and the spindle's speed.
pocket: Clears the stock over the selected faces, or all of it, level by level, with an engagement angle that stays below a bound all along the path.
Stock is that of the set-up, the part's box where it states none, or what the operations before leave of it.
flank: Mills ruled surfaces, such as blades and twisted walls, with the side of a tool that leans: on machines with two rotary axes. The tool
is a cylinder or a cone, with a flat end or a round one.
drill: Drills, taps or bores the round upright holes among the selected faces, each along its axis from its own top. Machines without the
cycle get its moves. Of faces = "all" only holes of the tool's diameter are taken; named faces must all be walls of such holes.
helix-bore: Bores the round upright holes among the selected faces with a tool narrower than they are: down along a helix with a level turn at its
end, back to the axis and up; in several, from the inside out, where one would leave a core. Turns are full circles, or short lines on
machines without these arcs. Of faces = "all" wider holes are taken; named faces must all be walls of such holes. All directions but
conventional are climb.
constant-scallop: Contours over the surface, from its border inwards, between which the same scallop stands everywhere.
pencil: Passes along concave edges and narrow fillets, where the tool touches two faces at once: they take what wider steps and a larger
tool leave in the corners.
chamfer: Chamfers the sharp edges between the level ones of the selected faces and the walls that go down from them, with the cone of a tool:
the chamfer has its angle. The model has the edges sharp. What the tool cannot reach without entering what is beside it is left, and
listed. All directions but conventional are climb.
contour: Mills along level edges of the part, beside them or on them, level by level down the walls at them. The tool stands so that its
silhouette touches the upright plane through the edge; where it would enter the part elsewhere the path ends, and what is left is listed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Opens FreeCAD's own simulator, which cuts the job's stock</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Order</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outside of edges that close.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Overreach</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parabola</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parallel rows over the surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Part check clearance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Part check faces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Part of the end, which is flat as a whole: at most half the diameter, and without effect.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pass depth</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Passes along concave edges and narrow fillets, where the tool touches two faces at once: they take what wider steps and a larger
tool leave in the corners.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Path</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Path colours</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Paths for tools of any convex shape</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pencil</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pitch</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Plan what can be reached of named faces that partly face down.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Play</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Plunge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pocket</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Post</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Posts the job's StylusCAM operations in memory, holds every move against the model and lists what it finds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Power</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Preferences</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Process</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Profile</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Program written:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Programs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pure shear: a vertical column keeps its height, so a wall of slope phi is t cos(phi) thick.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radial</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radial stock to leave</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius as a function of t.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of a flat that is added at the tip, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of curvature</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of curvature at the tip (R0), mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of leads, mm.
Range: 0.1 to 1000 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of looped turns, mm.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of the ball at the tip, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of the circle, mm; half the diameter when left out.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of the corners, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of the flat at the tip, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of the generating arc, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Rails</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ramp angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Range of t; either end may be the tip.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reads each posted program back and compares it with the model, and writes it only if no error is found. Without it the program's header states that it was not verified</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Report</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Result</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Retract height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Risks that are taken: what the verifier would report for them as an error becomes a warning.
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Rounded rectangle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Save tool file...</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Save tool to library</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scale</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scallop</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scallop height by wall angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Seam direction</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Seam spread</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Select two edges of the model in the view, then press this</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Semi-axis across the tool's axis, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Semi-axis along the tool's axis, mm.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Shank</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Shank diameter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the faces, 0 to 1, that the tool may be unable to get to.
Range: 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Shear spinning: a disc of sheet and a mandrel of the part's shape turn about Z, and the tool goes along the part's meridian, from
the centre outwards, once. X is the distance from the axis, Y stays 0. Parts that are surfaces of revolution about Z only.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sheet</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sheet law</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sheet max wall angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sheet min thickness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sheet tensile strength</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sheet thickness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Single-point incremental forming: a sheet, no die.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope at which the curve ends, degrees; 90 unless given.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slow corners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smallest distance between rows by scallop, mm: steeper walls keep it and a larger scallop; a tenth of the stepover when
left out.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smallest feature</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smallest radius of the path of the tool's centre, mm: corners stay rounded by it and the tool's radius; a twentieth of the
tool's radius when left out.
Range: above 0 to 1000 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smallest step by scallop, mm: gentler slopes keep it and a larger scallop; what the scallop allows at 10 degrees when left
out.
Range: above 0 to 100 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smoothing radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Spif</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Spinning</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Spiral</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Springback</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Squeeze</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stages</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Start</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Start Depth</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>States how the StylusCAM engine is installed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Steepest wall that may be formed, degrees; when left out, what is known of `process.material`, or of any sheet, decides.
Range: 1 to 90 deg
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Step</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Step list</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Step max</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Step min</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Step scallop</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stepover</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stepover min</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stock</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stock that stays on the surface, mm along its normals.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stock that stays on walls, mm, measured across them in plan; a pocket with `finish` takes it last.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stock that stays under the tool, on floors and slopes, mm in height; a pocket with `finish` takes it last.
Range: 0 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stock to leave</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stop</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Strategy</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stylus</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stylus tool</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>StylusCAM check and post</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>StylusCAM job</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>StylusCAM operations</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>StylusCAM path</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Support tool</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tabs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tabs that hold the part while loops cut it out.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tangent</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tapered ball</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tensile strength of its material, MPa: for an estimate of the axial force; none is made when left out.
Range: 1 to 3000 MPa
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>That in areas over the selected faces: a pocket.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The coefficient c, mm^(1 - p).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The constant A, mm^2; needs `end_slope_deg`.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The curve from tip to base; this or `library`.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The curves between which the surface is ruled; when left out, the selected faces are milled, each of which must be ruled.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The edges by their names, as FreeCAD shows them: ["Edge3", "Edge7"]; all edges of the selected level faces when left out.
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The engagement angle that the path keeps to, degrees: of the arc along which the tool's rim is in the material.
Range: 10 to 90 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The exponent p, above 1.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The face away from the tool.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The face that the tool touches.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The folder of your machine files, the machine of new jobs, verification</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The holder above it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The least angle by which the two faces turn away from each other where the tool touches them, degrees.
Range: 6 to 175 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The machine for which the jobs of the command New job are posted, and whose decimals and units planning takes into account; not stated: CAM's own default post</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The middle of the sheet.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The model is a solid, and no sheet of nearly constant thickness.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The model is thicker or thinner than the sheet.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The model shows another face of the sheet than model_face states.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The model's flange does not lie where the sheet is clamped.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The part is formed into it from inside; the sheet is clamped at its rim.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The part is formed over it from outside, from its top outwards and down; the clamp frame goes down with the path.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The path along the part's meridian, from the axis outwards, in X and Z, while the spindle turns the part: for parts that are
surfaces of revolution about X = Y = 0, which is measured, with a tool that stands parallel to that axis. `feeds.cut` follows from
the feed per revolution and the spindle's speed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The same thickness everywhere, along the normal.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The sheet becomes thinner than min_thickness.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The side of stated rails on which the tool moves, seen along them with the upper one above the lower one; of faces, it is outside.
0 or empty: not stated
left: To the left, seen along the rails with the second above the first.
right: To the right.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The steepest helix that the tool withstands, degrees; steeper ones are refused.
Range: 0.1 to 60 deg</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tool bridges faces by more than it may: it is less curved than they are.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tool goes deeper into sheet that is not formed yet than a step.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tool has no name: give it one</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tool reaches less of the faces than it should.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tool rolls over them, its contact on the edge, until it touches another face or leaves the edge.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tool's full diameter reaches the end of the wall: for floors that are modelled as cones.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tool's tip reaches the floor: of a flat floor its point leaves a cone.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>They end where the contact reaches the edge.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thickness, mm.
Range: above 0 to 50 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thinnest that the sheet may become, by the sine law, mm; not checked when left out.
Range: above 0 to 50 mm
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Times the machine's speed; by length, times 10 mm/s</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tip diameter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tip flat</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tip offset</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tip radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>To clearance.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>To the left, seen along the rails with the second above the first.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>To the right.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tolerance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tool</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tool along</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tool axes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tool bits (*.fctb)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tool controller: the tool, its number and its feeds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tool number</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Toolpaths for tools of any convex shape</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tools (*.fctb *.json)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tpif</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Turn radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Turns</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Two points of its axis lie beside two points of the line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Two-point incremental forming: a sheet over a male die, with a clamp frame that goes down, or into a female one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Value</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Values that are rarely changed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Verification</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Verifies the job and writes its report, one page for the browser, beside the document</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Verify</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Verify programs before they are written</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Walls steeper than the material withstands in one pass.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Web pages (*.html)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What formed parts were measured, or simulated, to deviate by: the part is formed the other way. The verifier then compares
with the part as it is formed.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What happens at the outer edges of the selected faces; when left out, passes stop there, and in forming roll over those
that the tool comes down over.
0 or empty: not stated
roll: The tool rolls over them, its contact on the edge, until it touches another face or leaves the edge.
stop: They end where the contact reaches the edge.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What holds it.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What is done at each hole.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What is done to it.
spif: Single-point incremental forming: a sheet, no die.
dsif: Double-sided incremental forming: a sheet between two tools. The one below follows the contacts of the one above, on the
other face of the sheet, block by block; its machine is in `[machines.support]`.
milling: Milling: no sheet.
spinning: Shear spinning: a disc of sheet and a mandrel of the part's shape turn about Z, and the tool goes along the part's meridian, from
the centre outwards, once. X is the distance from the axis, Y stays 0. Parts that are surfaces of revolution about Z only.
tpif: Two-point incremental forming: a sheet over a male die, with a clamp frame that goes down, or into a female one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What is formed around a part without a flange: a wall from its outer edge to the blank's plane. Its faces have the names
"Addendum" and "Blank".
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What is left between the tools, as a share of the thickness that the sheet has there: below 1 they squeeze it.
Range: 0.8 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What its cutting edges are made of: "hss" (high-speed steel) or "carbide".</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What joins the profile's base to the shank.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What lies under the sheet.
male: The part is formed over it from outside, from its top outwards and down; the clamp frame goes down with the path.
female: The part is formed into it from inside; the sheet is clamped at its rim.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What the part is cut from; its box when left out.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What the part is made of, by a name. Of a sheet, that of a shipped material (`styluscam material list`): it sets the steepest wall
that the sheet withstands. Of what is milled, that of a table of cutting data (`styluscam material cutting`): feeds and the spindle
that an operation leaves out follow from it.
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What the posted path is made of.
lines: Lines.
arcs: Arcs and lines, of which fewer are needed; lines where the machine has no arc for it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Where passes may run: inside edges in plan, and on contacts of some slopes.
As JSON
0 or empty: not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whether feeds rise no higher than the thickest chip allows: it is nowhere thicker than at a full stepover.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whether the stock to leave is taken as well, after the rest of its level: by a pass along the walls and a layer over each level floor,
with the same bound of the engagement angle.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whether the tool goes straight down to each level instead, into the material too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whether this is stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Which face of the sheet the model shows; required with a sheet.
0 or empty: not stated
tool: The face that the tool touches.
back: The face away from the tool.
mid: The middle of the sheet.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Which stock is cleared on each level: that over the selected faces, or all that the tool reaches, around the part too (roughing). Levels
go down to the lowest selected face that the tool reaches; of all stock to z_bottom, where that is stated.
faces: That in areas over the selected faces: a pocket.
stock: All that the tool reaches, around the part too: roughing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whole model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Width</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Width of the chamfer, mm, measured level; some tenths deburr.
Range: 0.01 to 100 mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Without a corner, along a loop of `turn_radius` beyond the ends of the rows; where none fits, straight.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Without a corner, along arcs of half the distance between the rows; where none fits, straight.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Worst gouge {gouge:.4f} mm, worst excess {excess:.4f} mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Writes the machine's program of the job; paths of StylusCAM are verified before</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Writes the selected tool as FreeCAD's .fctb, with exact numbers</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Z level</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Zig zag</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Zig-zag ramps: to and fro along a line, both ways going down.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>`link_margin` above what stands under the line that they cross, clearance at most: for machines whose rapids go straight.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>allowed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>alternate</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>arcs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>at</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>auto</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>axis</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>back</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>between rows</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>bounds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>bridged</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>bridging</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>by length, mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>by time, s</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>by-area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>by-level</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>chamfer</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>check</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>clearance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>clearing the pocket</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>climb</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>comparing</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>constant</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>constant-scallop</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>contour</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>contours</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>conventional</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>coverage</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>cut, or link along the part</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>depth in the stock</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>distances</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>down at a feed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>drill</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>drop-cutter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>dsif</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>engagement angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>engages nothing</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>entry: not bounded</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>error along the normals</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>faces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>female</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>finishing the walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>fitting arcs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>fitting leads</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>flange</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>flank</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>from the tip up</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>full-diameter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>helix</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>helix-bore</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>hidden</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>index</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>inside</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>largest</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>leans by</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>left</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>left over</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>levels</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>line</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>lines</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>linking</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>linking the pieces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>looped</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>low</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>male</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>measuring</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>measuring roundness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>measuring ruled surfaces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>measuring the engagement</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>meridian</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>mesh</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>mid</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>milling</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>missed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>missing passes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>mm^2</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>model-face</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>must be {}</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>none</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>not stated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>nowhere</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>offset surface</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>on</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>one-point</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>ordering</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>outside</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>pair</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>pencil</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>planning</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>pocket</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>positions</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>preferences/preferences-styluscam</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>preparing</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>punch</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>push-cutter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>r = a (t + sin t), z = a (1 - cos t).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>r, z in mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>radius, height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>rails</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>ramp</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>rapid</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>reach</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>reading</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>red: cut too deep, blue: left over</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>ridges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>right</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>rim</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>roll</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>rounded</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>rows</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>same</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>sampling</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>scallops</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>select two edges of the model and nothing else; selected now: {}</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>shank and holder in the stock</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>shortening links</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>sides</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>simulating</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>sine</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>slope of the surface, °</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>slopes between levels</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>smallest</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>solid</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>spif</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>spinning</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>spiral</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>spirals</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>stepover along the wall, mm</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>stock</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>stock as it stands</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>stop</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>straight</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>support</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>swept</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>tangent</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>the horizontal feed of the tool controller</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>the tool does not come there</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>the vertical feed of the tool controller</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>thickness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>thinning</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>those of the faces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>three-points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>tip</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>to</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>too deep</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>tool</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>tool axes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>tpif</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>turns</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>two-points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>unreached</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>up at a feed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>verifying</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>verifying leaning tools</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>vertical</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>wall-angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>what is left</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>what stays flat</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>z-level</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>zig-zag</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>{count} measured contacts; between them along the path</source>
        <translation type="unfinished"></translation>
    </message>
</context>
<context>
    <name>Workbench</name>
    <message>
        <source>StylusCAM check and post</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>StylusCAM job</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>StylusCAM operations</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>StylusCAM path</source>
        <translation type="unfinished"></translation>
    </message>
</context>
</TS>

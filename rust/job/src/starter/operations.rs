//! The operations that finish a part: rows for floors and gentle slopes, levels for walls, no face twice.

use std::collections::BTreeMap;

use styluscam_geometry::Mesh;
use styluscam_verify::ToolReach;

use super::cutter::{Cutter, Shape};
use super::drilling::Drilled;
use super::shop::Shop;
use super::sizes::{self, round};
use super::work::Work;
use super::workable::{covered, workable};
use crate::body::{Body, FaceLook, Hollows};
use crate::faces::UP;
use crate::limits::NO_ROOM;
use crate::operations::{Serves, StarterPasses};
use crate::ProcessKeys;

/// Share of the seen area that is worth an operation of its own.
const WORTH: f64 = 0.01;
/// Names in one operation at most: beyond, nobody reads or edits them.
pub const NAMES: usize = 400;
/// A face that is steep on this share of what faces up is a wall.
const WALL: f64 = 0.75;
/// A part whose faces are flat or upright on this share of their area is milled with a flat tool.
const PRISMATIC: f64 = 0.98;
/// Scallop that is aimed at, as a share of the tool's diameter, and its limits, mm.
const SCALLOP: f64 = 0.001;
const SCALLOPS: [f64; 2] = [0.005, 0.01];
/// Rows of a flat tool overlap by the rest of its diameter.
const FLAT_ROWS: f64 = 0.5;
/// Distance between levels of a flat tool, as a share of its diameter.
const FLAT_LEVELS: f64 = 0.2;
/// Path that anybody waits for, mm: rows lie farther apart where they would be longer.
const LONGEST: f64 = 100_000.0;
/// Places of a wall before which the floor is looked for, about.
const LOOKED_AT: usize = 24;
/// A tool touches what it comes nearer to than this share of its radius.
const TOUCHED: f64 = 0.02;
/// Places at which it is asked what a tool gets to: shares are right to about two percent.
const PLACES: usize = 2000;
/// Faces that a reason names at most.
const NAMED: usize = 6;
/// Of what the verifier lets pass: a tool that leaves less than this share of it is sure to pass,
const SURE: f64 = 0.8;
/// and a smaller one is worth its longer path if it leaves no more than this share of what the wider one leaves.
const WORTHWHILE: f64 = 0.95;
/// Smaller sizes in a row that are not worth it, after which the search ends.
const TRIED: usize = 2;
/// Share of the faces beyond which the tool is no tool for the part.
const MOST_LEFT: f64 = 0.3;
/// Points of a floor at which it is asked what a ball leaves there,
const FLOOR_POINTS: usize = 200;
/// the share of a floor, or of a wall's height, that it may leave,
const BALL_LEAVES: f64 = 0.05;
/// and how much less a flat tool must leave for the floor to be its.
const FLAT_LEAVES: f64 = 0.5;
/// Why levels and rows are there.
const WALLS: &str = "finishing of upright and steep faces, in levels";
const FLOORS: &str = "finishing of floors and gentle slopes, in rows";
const FLAT_WALLS: &str =
    "finishing of upright walls down to what lies before them, in levels, with a flat tool: a ball leaves its own radius at their foot, or does not get to them";
const FLAT_FLOORS: &str =
    "finishing of level floors up to the walls, in rows, with a flat tool: a ball leaves much there";
/// Levels at most.
const LEVELS: f64 = 250.0;

/// What is milled, and why so.
pub struct Milled {
    pub works: Vec<Work>,
    pub tool: Cutter,
    pub reasons: Vec<String>,
    /// Share of the faces that the tool may be unable to get to, where that is more than usual.
    pub max_unreached: Option<f64>,
}

impl Milled {
    /// How a sentence begins about faces that no operation names: rows over the whole part leave out none by name.
    fn left_out(&self) -> &'static str {
        if self.works.iter().all(|work| work.faces.is_some()) {
            "left out: "
        } else {
            ""
        }
    }

    fn names(&self, face: &FaceLook) -> bool {
        self.works.iter().any(|work| work.names(face.face))
    }
}

/// Levels over all that faces up.
pub fn forming(mesh: &Mesh, looks: &Hollows, tool: &Cutter) -> Work {
    let faces: Vec<&FaceLook> = workable(looks).collect();
    work(
        "walls",
        Serves::Walls,
        ("stylus", tool),
        None,
        ([levels_apart(mesh, &faces, tool), 0.0], "levels over all that faces up"),
    )
}

fn work(
    id: &str,
    serves: Serves,
    (tool, cutter): (&str, &Cutter),
    faces: Option<Vec<u32>>,
    ([pitch, angle_deg], why): ([f64; 2], &str),
) -> Work {
    Work {
        id: id.to_owned(),
        serves,
        tool: tool.to_owned(),
        cutter: *cutter,
        faces,
        passes: StarterPasses { pitch, angle_deg, ..StarterPasses::default() },
        leave: 0.0,
        why: vec![why.to_owned()],
    }
}

/// Rows, levels, or both, with a tool that gets to the faces that drilling does not finish. A flat one is no wider than the
/// `rougher`: in corners it would meet what a narrower one has not cleared. Level floors and upright walls that a ball leaves are a
/// flat one's.
pub fn milling(
    (body, shop): (&Body<'_>, &Shop),
    looks: &Hollows,
    drilled: &[Drilled],
    rougher: Option<&Cutter>,
) -> Milled {
    let done: Vec<u32> = drilled.iter().flat_map(Drilled::done).collect();
    let seen: Vec<&FaceLook> = workable(looks).filter(|face| !done.contains(&face.face)).collect();
    let is_prismatic = seen.iter().all(|face| face.flat >= PRISMATIC || face.vertical >= PRISMATIC);
    let shape = if is_prismatic { Shape::Flat } else { Shape::Ball };
    let (fitting, words) = finisher((body.mesh(), shop), (&seen, drilled), shape, rougher);
    let by_face = ByFace::of(body);
    let allowed = ProcessKeys::default().max_unreached;
    let mut milled = worked(&by_face, (&seen, true), fitting, words);
    let mut left = by_face.share_left(&milled);
    let (mut diameter, mut in_vain) = (fitting.diameter, 0);
    while left > SURE * allowed && in_vain < TRIED {
        let Some(smaller) = sizes::next_smaller(&Cutter { diameter, ..fitting }, body.mesh(), shop) else { break };
        diameter = smaller;
        let words = format!("the tool, {diameter} mm wide: wider tools reach less of the faces");
        let smaller = worked(&by_face, (&seen, true), Cutter { diameter, ..fitting }, words);
        let share = by_face.share_left(&smaller);
        in_vain += 1;
        if share <= WORTHWHILE * left {
            (milled, left, in_vain) = (smaller, share, 0);
        }
    }
    let flat = rougher
        .filter(|_| !is_prismatic)
        .map(|rougher| Cutter { shape: Shape::Flat, diameter: rougher.diameter.min(milled.tool.diameter) });
    if let Some((with_flat, share)) = flat.and_then(|flat| with_flat(&by_face, &seen, &milled, &flat)) {
        (milled, left) = (with_flat, left.min(share));
    }
    let prefix = milled.left_out();
    milled.reasons.extend(under_others(looks).map(|words| format!("{prefix}{words}")));
    if left > SURE * allowed {
        let limit = (100.0 * (left + (1.0 - SURE) * allowed)).ceil() / 100.0;
        milled.max_unreached = Some(limit).filter(|_| left <= MOST_LEFT);
        let passes = if left <= MOST_LEFT {
            format!("max_unreached = {limit} accepts that")
        } else {
            "`styluscam run` refuses the job as it is".to_owned()
        };
        milled.reasons.push(format!(
            "the tool does not reach {} of these faces, which lie under others or between walls: {passes}; leave faces out, or \
             cut them from another side",
            sizes::percent(left)
        ));
    }
    milled
}

/// The widest tool that fits the faces seen, and the sentence on it: a flat one is no wider than the `rougher`, and all have room in the
/// counterbores that they mill.
fn finisher(
    (mesh, shop): (&Mesh, &Shop),
    (seen, drilled): (&[&FaceLook], &[Drilled]),
    shape: Shape,
    rougher: Option<&Cutter>,
) -> (Cutter, String) {
    let (holes, open): (Vec<&FaceLook>, Vec<&FaceLook>) = seen.iter().partition(|face| face.hole.is_some());
    let (mut fitting, mut words) = sizes::cutter((mesh, shop), open, shape);
    if let Some(rougher) = rougher.filter(|rougher| shape == Shape::Flat && rougher.diameter < fitting.diameter) {
        fitting.diameter = rougher.diameter;
        words = format!("the tool, {} mm wide: no wider than that of the roughing", rougher.diameter);
    }
    for counterbore in holes.into_iter().filter(|face| drilled.iter().any(|holes| holes.mills(face.face))) {
        while !fits(counterbore, &fitting) {
            let Some(smaller) = sizes::next_smaller(&fitting, mesh, shop) else { break };
            fitting.diameter = smaller;
            words = format!("the tool, {smaller} mm wide, fits the narrowest counterbore");
        }
    }
    (fitting, words)
}

/// The same with a flat tool, too, for the level floors and upright walls that the ball leaves, and the share of the
/// ball's own faces to which it does not get; none where a flat tool is not worth it, or rows serve the whole part.
fn with_flat(by_face: &ByFace<'_>, seen: &[&FaceLook], milled: &Milled, flat: &Cutter) -> Option<(Milled, f64)> {
    if milled.works.iter().any(|work| work.faces.is_none()) {
        return None;
    }
    let [ball_reach, flat_reach] = [by_face.reach(&milled.tool)?, by_face.reach(flat)?];
    let suits = |face: &FaceLook| {
        let is_upright = face.hole.is_none() && face.vertical >= PRISMATIC;
        is_upright && fits(face, flat) && by_face.is_touched(face, flat, None)
    };
    let of_ball = || seen.iter().filter(|face| is_wall(face) && milled.names(face));
    // all or none: levels along what leans go on along the upright walls beside it
    let takes_walls = of_ball().all(|face| suits(face))
        && of_ball().any(|face| by_face.share_at_foot(face, &milled.tool) > BALL_LEAVES);
    let is_for_flat = |face: &&FaceLook| {
        if face.hole.is_some() {
            return false;
        }
        if is_wall(face) {
            return (takes_walls || !milled.names(face)) && suits(face);
        }
        let leaves = |reach: &ToolReach<'_>| {
            reach.share_left(by_face.of_face(face.face), FLOOR_POINTS, 0.5 * TOUCHED * milled.tool.diameter)
        };
        let by_ball = if face.flat >= PRISMATIC { leaves(&ball_reach) } else { 0.0 };
        by_ball > BALL_LEAVES && leaves(&flat_reach) <= FLAT_LEAVES * by_ball
    };
    let (of_flat, rest): (Vec<&FaceLook>, Vec<&FaceLook>) = seen.iter().copied().partition(is_for_flat);
    if area(&of_flat) < WORTH * area(seen) || of_flat.len() > NAMES {
        return None;
    }
    let words = milled.reasons.first().cloned().unwrap_or_default();
    let mut both = worked(by_face, (&rest, false), milled.tool, words);
    let of_both: Vec<&FaceLook> = rest.iter().copied().filter(|face| both.names(face)).collect();
    if area(&of_both) < WORTH * area(seen) || rest.iter().any(|face| milled.names(face) && !both.names(face)) {
        return None; // too little is left for the ball
    }
    let share = by_face.share_left(&both);
    let mesh = by_face.body.mesh();
    let angle_deg = rows_along(mesh);
    let (walls, floors): (Vec<&FaceLook>, Vec<&FaceLook>) = of_flat.into_iter().partition(|face| is_wall(face));
    let cutter = ("flat-cutter", flat);
    let mut finished = Vec::new();
    // levels come first: they take what roughing leaves in corners bit by bit, rows would take it at once
    if !walls.is_empty() {
        let passes = [levels_apart(mesh, &walls, flat), angle_deg];
        finished.push("upright walls");
        both.works.insert(0, work("flat-walls", Serves::Walls, cutter, numbers(&walls), (passes, FLAT_WALLS)));
    }
    if !floors.is_empty() {
        let passes = [rows_apart(&floors, flat), angle_deg];
        finished.push("level floors");
        both.works.push(work("flat-floors", Serves::Floors, cutter, numbers(&floors), (passes, FLAT_FLOORS)));
    }
    both.reasons.push(format!(
        "a flat tool of {} mm finishes {} of which a ball leaves more",
        flat.diameter,
        finished.join(" and ")
    ));
    Some((both, share))
}

/// Rows, levels, or both for the faces seen, with a tool; rows over the whole part only where these `are_all` that is finished.
fn worked(by_face: &ByFace<'_>, (seen, are_all): (&[&FaceLook], bool), tool: Cutter, words: String) -> Milled {
    let mesh = by_face.body.mesh();
    let whole = area(seen);
    let (walls, floors): (Vec<&FaceLook>, Vec<&FaceLook>) = seen.iter().partition(|face| is_wall(face));
    let reasons = vec![words];
    // of more walls than an operation names it is not asked: nearly always rows serve the whole part then
    let asks_reach = tool.shape == Shape::Ball && walls.len() <= NAMES;
    let reach = asks_reach.then(|| by_face.reach(&tool)).flatten();
    let (open, narrow): (Vec<&FaceLook>, Vec<&FaceLook>) = walls.into_iter().partition(|face| fits(face, &tool));
    let (open, low): (Vec<&FaceLook>, Vec<&FaceLook>) =
        open.into_iter().partition(|face| face.vertical < PRISMATIC || by_face.is_touched(face, &tool, reach.as_ref()));
    let few = floors.len().max(open.len()) <= NAMES;
    let with_levels = area(&open) >= WORTH * whole && few;
    let with_rows = area(&floors) >= WORTH * whole || !with_levels;
    let angle_deg = rows_along(mesh);
    let cutter = ("cutter", &tool);
    let rows = |faces| work("floors", Serves::Floors, cutter, faces, ([rows_apart(seen, &tool), angle_deg], FLOORS));
    let levels =
        |faces| work("walls", Serves::Walls, cutter, faces, ([levels_apart(mesh, &open, &tool), angle_deg], WALLS));
    let (works, words) = match (with_levels, with_rows) {
        (true, true) => (
            vec![levels(numbers(&open)), rows(numbers(&floors))],
            "levels for the walls, rows for floors and gentle slopes: each face in one of the two",
        ),
        (true, false) => (vec![levels(numbers(&open))], "levels: all faces to be cut are walls"),
        (false, _) if !few => (vec![rows(None)], "rows over the whole part: it has too many faces to name them"),
        (false, _) if !are_all => (vec![rows(numbers(&floors))], "rows: they serve floors and slopes"),
        (false, _) if !open.is_empty() || !narrow.is_empty() || !low.is_empty() => {
            (vec![rows(None)], "rows over the whole part: few of its walls suit levels")
        }
        (false, _) => (vec![rows(None)], "rows: they serve floors and slopes; no face is all wall"),
    };
    let mut milled = Milled { works, tool, reasons, max_unreached: None };
    let missed = left(&narrow, &tool).into_iter().chain(untouched(&low, &tool));
    let prefix = milled.left_out();
    milled.reasons.extend(missed.map(|words| format!("{prefix}{words}")));
    milled.reasons.push(words.to_owned());
    milled
}

/// A body's triangles by face.
struct ByFace<'a> {
    body: &'a Body<'a>,
    triangles: BTreeMap<u32, Vec<usize>>,
    /// Height of the part's foot, mm.
    foot: f64,
}

impl<'a> ByFace<'a> {
    fn of(body: &'a Body<'a>) -> Self {
        let mut triangles: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (triangle, face) in body.mesh().faces().iter().enumerate() {
            triangles.entry(*face).or_default().push(triangle);
        }
        Self { body, triangles, foot: body.bounds().0.z }
    }

    /// What a tool gets to; none for one that cannot be made: the job's check states why.
    fn reach(&self, tool: &Cutter) -> Option<ToolReach<'a>> {
        tool.made().map(|tool| ToolReach::new(&tool, None, self.body.mesh(), self.body.bvh()))
    }

    fn of_face(&self, face: u32) -> &[usize] {
        self.triangles.get(&face).map_or(&[], Vec::as_slice)
    }

    /// Whether the tool's side touches an upright face while its tip stays above what lies in front of it.
    fn is_touched(&self, face: &FaceLook, tool: &Cutter, reach: Option<&ToolReach<'_>>) -> bool {
        let (own, side) = (self.of_face(face.face), side(tool));
        let has_room = self.floors_before(own, tool).any(|floor| face.heights[1] - floor > 1.2 * side);
        let touches = |reach: &ToolReach<'_>| reach.share_left(own, LOOKED_AT, TOUCHED * side) < 1.0;
        has_room && reach.is_none_or(touches)
    }

    /// Share of an upright face's height that the tool's side does not touch over the lowest of what lies in front of it.
    fn share_at_foot(&self, face: &FaceLook, tool: &Cutter) -> f64 {
        let floors = self.floors_before(self.of_face(face.face), tool);
        let lowest = floors.fold(f64::INFINITY, f64::min) + side(tool);
        let [low, high] = face.heights;
        ((lowest - low) / (high - low)).clamp(0.0, 1.0)
    }

    /// Heights of what lies in front of some of an upright face's triangles, at the axis of a tool that touches them, mm.
    fn floors_before<'b>(&'b self, own: &'b [usize], tool: &'b Cutter) -> impl Iterator<Item = f64> + 'b {
        let mesh = self.body.mesh();
        own.iter().step_by(own.len().div_ceil(LOOKED_AT).max(1)).map(move |triangle| {
            let [a, b, c] = mesh.corners(*triangle);
            let axis = (a + b + c) / 3.0 + 0.5 * tool.diameter * mesh.normal(*triangle);
            self.body.height_at(axis.x, axis.y).unwrap_or(self.foot)
        })
    }

    /// Share of the faces to which the tool does not get, by the verifier's measure, but for what the program's moves leave where
    /// the tool stands between walls: at least what the verifier will find. Rows over the whole part serve what faces up.
    fn share_left(&self, milled: &Milled) -> f64 {
        let mesh = self.body.mesh();
        let triangles: Vec<usize> = if milled.works.iter().any(|work| work.faces.is_none()) {
            (0..mesh.triangles().len()).filter(|triangle| mesh.normal(*triangle).z > UP).collect()
        } else {
            let named = milled.works.iter().flat_map(|work| work.faces.iter().flatten());
            let all = named.flat_map(|face| self.of_face(*face)).copied();
            all.filter(|triangle| !mesh.looks_down(*triangle)).collect()
        };
        let radius = 0.5 * milled.tool.diameter;
        self.reach(&milled.tool).map_or(0.0, |reach| reach.share_left(&triangles, PLACES, NO_ROOM * radius))
    }
}

/// Height over its tip from which a tool is as wide as it gets, mm.
fn side(tool: &Cutter) -> f64 {
    match tool.shape {
        Shape::Ball => 0.5 * tool.diameter,
        Shape::Flat | Shape::Drill => 0.0,
    }
}

/// What no tool from above gets to, in words: holes across, undercuts.
fn under_others(looks: &Hollows) -> Option<String> {
    let mut faces: Vec<&FaceLook> = covered(looks).collect();
    faces.sort_by(|a, b| b.area.total_cmp(&a.area).then(a.face.cmp(&b.face)));
    (!faces.is_empty()).then(|| {
        format!(
            "no tool from above reaches what lies under other faces: {}; a second job from another side may",
            names(&faces)
        )
    })
}

/// What is left because the tool's side does not reach down to it, in words.
fn untouched(low: &[&FaceLook], tool: &Cutter) -> Option<String> {
    let diameter = tool.diameter;
    let other = match tool.shape {
        Shape::Ball => "a flat or a smaller tool",
        Shape::Flat | Shape::Drill => "a smaller tool",
    };
    (!low.is_empty()).then(|| {
        format!(
            "the tool of {diameter} mm does not touch these over the floor before them, or beside other walls: {}; {other} may",
            names(low)
        )
    })
}

/// The numbers of faces, for an operation to name.
fn numbers(faces: &[&FaceLook]) -> Option<Vec<u32>> {
    Some(faces.iter().map(|face| face.face).collect())
}

/// The angle of rows along a part's longer side, deg.
fn rows_along(mesh: &Mesh) -> f64 {
    let [x, y, ..] = size(mesh);
    if x >= y {
        0.0
    } else {
        90.0
    }
}

/// Whether a tool has room before most of a face.
fn fits(face: &FaceLook, tool: &Cutter) -> bool {
    Hollows::bound([face], 0.5).is_none_or(|radius| 2.02 * radius >= tool.diameter)
}

/// Rows serve a face that is wall and floor in one.
fn is_wall(face: &FaceLook) -> bool {
    face.steep >= WALL * (face.flat + face.gentle + face.steep)
}

/// What is left for another tool, in words.
fn left(narrow: &[&FaceLook], tool: &Cutter) -> Option<String> {
    let (holes, slots): (Vec<&FaceLook>, Vec<&FaceLook>) = narrow.iter().partition(|face| face.hole.is_some());
    let mut sentences = Vec::new();
    if !holes.is_empty() {
        let plural = if holes.len() == 1 { "" } else { "s" };
        sentences.push(format!("the hole{plural} {} must be drilled", names(&holes)));
    }
    if !slots.is_empty() {
        let need = if slots.len() == 1 { "needs" } else { "need" };
        sentences.push(format!("{} {need} a smaller tool", names(&slots)));
    }
    let diameter = tool.diameter;
    (!sentences.is_empty())
        .then(|| format!("the tool of {diameter} mm has too little room in these: {}", sentences.join("; ")))
}

/// Some of the names, and how many more there are.
fn names(faces: &[&FaceLook]) -> String {
    let shown: Vec<String> = faces.iter().take(NAMED).map(|face| format!("Face{}", face.face)).collect();
    let more = if faces.len() > NAMED { format!(" and {} more", faces.len() - NAMED) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}

fn area(faces: &[&FaceLook]) -> f64 {
    faces.iter().map(|face| face.seen_area()).sum()
}

fn size(mesh: &Mesh) -> [f64; 3] {
    let (low, high) = mesh.bounds();
    (high - low).into()
}

/// From the scallop on a plane: p = sqrt(8 R h).
fn by_scallop(tool: &Cutter) -> f64 {
    let [least, most] = SCALLOPS;
    (4.0 * tool.diameter * (SCALLOP * tool.diameter).clamp(least, most)).sqrt()
}

fn rows_apart(faces: &[&FaceLook], tool: &Cutter) -> f64 {
    let length = match tool.shape {
        Shape::Ball => by_scallop(tool),
        Shape::Flat | Shape::Drill => FLAT_ROWS * tool.diameter,
    };
    let longest = area(faces) / LONGEST;
    round(length.max(longest.min(0.25 * tool.diameter)))
}

fn levels_apart(mesh: &Mesh, faces: &[&FaceLook], tool: &Cutter) -> f64 {
    let length = match tool.shape {
        Shape::Ball => by_scallop(tool) * steepness(faces),
        Shape::Flat | Shape::Drill => FLAT_LEVELS * tool.diameter,
    };
    let deepest = size(mesh)[2] / LEVELS;
    let longest = area(faces) / LONGEST;
    round(length.max(deepest).max(longest.min(0.25 * tool.diameter)))
}

/// Sine of a usual wall's slope: half of what is steep, and the gentle rest, lie farther apart than levels do.
fn steepness(faces: &[&FaceLook]) -> f64 {
    let steep: f64 = faces.iter().map(|face| face.steep * face.area).sum();
    let gentle: f64 = faces.iter().map(|face| face.gentle * face.area).sum();
    let share = steep / (steep + gentle).max(f64::MIN_POSITIVE);
    0.4 + 0.5 * share
}

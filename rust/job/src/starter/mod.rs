//! A commented job for a part that has none yet: it runs as it is, states why it is so, and shows what can be changed.

mod choice;
mod feeds;
mod operations;
mod part;
mod sizes;
mod text;
mod workable;

use std::path::Path;

use crate::operations::{About, Operation, StarterPasses};
use crate::{JobError, Process, UpAxis};
use choice::{choose, Choice};
use feeds::StarterFeeds;
use operations::Work;
pub use part::{StarterFace, StarterPart};
pub use sizes::fitting_radius;
use sizes::{round, Shape};
use text::{number, quoted, wrapped};

/// From this slope on a face does not face up: it is not listed, degrees.
const WALL: f64 = 90.1;
/// Faces that the comment lists at most.
const LISTED: usize = 60;
/// The path's tolerance, and what the file's own edges may take of it, mm.
const PATH_TOLERANCE: f64 = 0.01;
const PART_TOLERANCE: f64 = 0.003;
/// Nodes of the grid over the part's plan in which levels look for loops, about.
const NODES: f64 = 2e5;
/// A part that lies farther from its origin than this many times its size gets a zero point of its own.
const FAR: f64 = 1.0;

/// A job, and why it is so.
#[derive(Clone, Debug, PartialEq)]
pub struct Starter {
    /// The job in TOML.
    pub text: String,
    /// Sentences: what the part is taken for, and what follows from it.
    pub reasons: Vec<String>,
}

/// A job for a part: formed where it is a sheet or an open surface that a sheet can take, else milled; levels for its
/// walls, rows for its floors; a tool that fits its concave areas.
///
/// # Errors
/// A material that the table of cutting data does not have.
pub fn starter(part: &StarterPart<'_>) -> Result<Starter, JobError> {
    let mut choice = choose(part);
    let tolerances = tolerances(part, &mut choice);
    let feeds = if choice.sheet.is_some() { feeds::forming(part) } else { feeds::milling(part, &choice.tool)? };
    choice.reasons.extend(feeds.reason.clone());
    let text = job(part, &choice, &feeds, tolerances);
    Ok(Starter { text, reasons: choice.reasons })
}

/// Of the triangles and of the path, mm: a file whose edges lie off its surfaces is read no finer than that.
fn tolerances(part: &StarterPart<'_>, choice: &mut Choice) -> [f64; 2] {
    let size = (0..3).map(|axis| choice.bounds[1][axis] - choice.bounds[0][axis]).fold(0.0, f64::max);
    // triangles of a large part at three micrometres are millions
    let own = round(PART_TOLERANCE * f64::max(1.0, size / 500.0));
    if part.edge_gap <= own {
        return [own, round(PATH_TOLERANCE * own / PART_TOLERANCE)];
    }
    let needed = round(1.1 * part.edge_gap);
    choice.reasons.push(format!(
        "edges of the file lie up to {:.4} mm off their surfaces: tolerance = {needed} is the finest that it allows",
        part.edge_gap
    ));
    [needed, round(PATH_TOLERANCE + 2.0 * needed)]
}

fn job(part: &StarterPart<'_>, choice: &Choice, feeds: &StarterFeeds, tolerances: [f64; 2]) -> String {
    let [part_tolerance, path_tolerance] = tolerances;
    let stem = stem_of(part.file);
    let units = part.units.map_or(String::new(), |u| format!("units = {}\n", quoted(u)));
    let undercuts = if choice.allow_undercuts {
        "allow_undercuts = true      # some of the named faces face down in parts: those are left\n"
    } else {
        ""
    };
    let operations: String = choice
        .operations
        .iter()
        .map(|work| operation(work, choice, feeds, path_tolerance))
        .collect::<Vec<_>>()
        .join("\n");
    format!(
        r#"# A StylusCAM job. Lengths are mm, angles degrees, feeds mm/min.
# Run it: `styluscam run` and the name of this file.
#
# Why it is so:
{reasons}schema = 1
title = {title}

[part]
file = {file}
{units}faces = "all"              # the faces that face up, or names: ["Face3", "Face4"]
{faces}{undercuts}{model_face}tolerance = {part_tolerance}           # largest deviation of triangles from surfaces, checked

{setup}
{process}{material}
[tools.{tool}]
number = 1
reference = "tip"           # the point that the program moves
profile = {{ kind = "{shape}", diameter = {diameter} }}   # or library = "{library}"; see `styluscam tool list`
{edges}
{operations}
[machine]
name = "linuxcnc"           # or "grbl"; see `styluscam machine list`

[output]
file = {gcode}
program = {program}
"#,
        reasons = choice.reasons.iter().map(|reason| wrapped(reason)).collect::<String>(),
        title = quoted(&stem),
        file = quoted(part.file),
        faces = listed(&lying(part, choice.up)),
        model_face = model_face(choice),
        setup = setup(choice),
        process = process(choice),
        material = feeds.process,
        edges = feeds.tool,
        tool = tool_name(choice),
        shape = shape(choice),
        diameter = number(choice.tool.diameter),
        library = if choice.sheet.is_some() { "clothoid:medium" } else { "ball-d6" },
        gcode = quoted(&format!("{stem}.ngc")),
        program = quoted(&format!("{stem}.program.json")),
        part_tolerance = number(part_tolerance),
    )
}

fn model_face(choice: &Choice) -> &'static str {
    if choice.sheet.is_some() {
        "model_face = \"tool\"         # the model shows the sheet's face that the tool touches (\"back\", \"mid\")\n"
    } else {
        ""
    }
}

fn setup(choice: &Choice) -> String {
    let [low, high] = choice.bounds;
    let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let is_far = (0..2).any(|axis| low[axis] > FAR * size[axis] || high[axis] < -FAR * size[axis])
        || (choice.sheet.is_none() && (low[2] > size[2].max(100.0) || high[2] < -size[2].max(100.0)));
    let corner = [low[0], low[1], high[2]].map(|x| number((x * 1000.0).round() / 1000.0 + 0.0)).join(", ");
    let zero = match (is_far, choice.sheet) {
        (true, _) => format!("zero = [{corner}]  # the part's left front corner, its top: its own origin lies far off"),
        (false, Some(_)) => {
            "zero = \"sheet-top\"          # Z0 on the sheet, X0 Y0 at the model's origin; or \"model\", \
                             or [x, y, z]"
                .to_owned()
        }
        (false, None) => "zero = \"model\"              # the model's origin, or [x, y, z] of the model".to_owned(),
    };
    let over = if choice.sheet.is_some() { "sheet" } else { "part" };
    let setup = format!(
        "[setup]\nup = \"{}\"                   # axis of the model that points to the spindle\n{zero}\nwcs = \
         \"G54\"\nclearance = 10.0            # rapids cross this far above the {over}\nretract = 2.0               # \
         and come down to here\n",
        choice.up.name()
    );
    let Some(thickness) = choice.sheet else { return setup };
    let room = 2.0 * choice.tool.diameter;
    let opening = format!("[{:.1}, {:.1}]", size[0] + room, size[1] + room);
    format!(
        r#"{setup}
[setup.sheet]
thickness = {}
law = "constant"            # or "sine"
# max_wall_angle_deg = 65.0   # steeper walls are refused; min_thickness = 0.4: thinner ones by the sine law

# [setup.fixture]           # what holds the sheet is kept clear: an opening is [width, height] or a diameter
# clamp = {{ opening = {opening}, height = 8.0 }}
# backing = {{ opening = {opening} }}
# margin = 1.0
"#,
        number(thickness)
    )
}

fn process(choice: &Choice) -> String {
    let known = Process::ABOUT.iter().find(|(_, about)| about.for_sheets == choice.sheet.is_some());
    let kind = known.map_or(String::new(), |(name, about)| match about.words {
        "" => format!("kind = {name:?}\n"),
        words => format!("kind = {name:?}               # {words}\n"),
    });
    let unreached = choice.max_unreached.map_or(String::new(), |share| {
        format!("max_unreached = {}        # share of the faces that the tool may be unable to get to\n", number(share))
    });
    format!("[process]\n{kind}{unreached}")
}

fn tool_name(choice: &Choice) -> &'static str {
    if choice.sheet.is_some() {
        "stylus"
    } else {
        "cutter"
    }
}

fn shape(choice: &Choice) -> &'static str {
    match choice.tool.shape {
        Shape::Ball => "ball",
        Shape::Flat => "flat",
    }
}

fn operation(work: &Work, choice: &Choice, feeds: &StarterFeeds, tolerance: f64) -> String {
    let faces = work.faces.as_ref().map_or(String::new(), |faces| format!("faces = {}\n", names(faces)));
    let Some((kind, about)) = Operation::ABOUT.iter().find(|(_, about)| about.serves == work.serves) else {
        return String::new(); // no kind serves that: a test holds the table to it
    };
    let distance = (about.starter)(StarterPasses { pitch: work.pitch, angle_deg: work.angle_deg });
    format!(
        r#"[[operations]]
id = "{}"
kind = "{kind}"            # {kinds}
{faces}tool = "{}"
{distance}direction = "alternate"     # or "same", "climb", "conventional"
tolerance = {}           # the posted path lies at most this far above the exact one
smallest_feature = {}     # no loop is missed that holds a disc of this diameter
{feeds}"#,
        work.id,
        tool_name(choice),
        number(tolerance),
        number(smallest_feature(choice)),
        kinds = kinds(),
        feeds = feeds.operation,
    )
}

/// All kinds of operations and what they are for: "z-level" for walls, ...
fn kinds() -> String {
    let one = |(name, about): &(&str, About)| format!("{name:?} {}", about.purpose);
    Operation::ABOUT.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// A tenth of the tool, but no more nodes over the part's plan than anybody waits for.
fn smallest_feature(choice: &Choice) -> f64 {
    let [low, high] = choice.bounds;
    let plan = (high[0] - low[0]) * (high[1] - low[1]);
    round(f64::clamp(0.1 * choice.tool.diameter, 0.05, 1.0).max((2.0 * plan / NODES).sqrt()).min(100.0))
}

/// A TOML list of names, broken into lines.
fn names(faces: &[u32]) -> String {
    let names: Vec<String> = faces.iter().map(|face| format!("\"Face{face}\"")).collect();
    if names.len() <= 8 {
        return format!("[{}]", names.join(", "));
    }
    let lines: Vec<String> = names.chunks(10).map(|line| format!("    {},\n", line.join(", "))).collect();
    format!("[\n{}]", lines.concat())
}

/// The faces as they slope with the tool's side up.
fn lying(part: &StarterPart<'_>, up: UpAxis) -> Vec<StarterFace> {
    let mut faces = part.faces.to_vec();
    if up == UpAxis::PlusZ {
        return faces;
    }
    faces.iter_mut().for_each(|face| face.slope_deg = [180.0, 0.0]);
    for (triangle, number) in part.mesh.faces().iter().enumerate() {
        let Some(face) = faces.get_mut((*number as usize).wrapping_sub(1)) else { continue };
        for normal in part.mesh.corner_normals(triangle) {
            let slope = libm::acos(normal.dot(&up.vector()).clamp(-1.0, 1.0)).to_degrees();
            face.slope_deg = [face.slope_deg[0].min(slope), face.slope_deg[1].max(slope)];
        }
    }
    faces
}

fn listed(faces: &[StarterFace]) -> String {
    let up: Vec<&StarterFace> = faces.iter().filter(|face| face.slope_deg[0] < WALL).collect();
    let mut lines: String = up.iter().take(LISTED).map(|face| described(face)).collect();
    if up.len() > LISTED {
        lines.push_str(&format!("#   and {} more: see `styluscam part show`\n", up.len() - LISTED));
    }
    lines
}

fn described(face: &StarterFace) -> String {
    let [low, high] = face.slope_deg;
    format!("#   {}: {}, {:.0} mm2, slope {low:.0} to {high:.0} deg\n", face.name, face.kind, face.area)
}

/// The file's name without its ending; what ends a line or a comment would break the job's text.
fn stem_of(file: &str) -> String {
    let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
    stem.chars().map(|c| if c.is_control() { '_' } else { c }).collect()
}

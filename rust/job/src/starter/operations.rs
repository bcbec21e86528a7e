//! The operations of a job: rows for floors and gentle slopes, levels for walls, no face twice.

use styluscam_geometry::Mesh;

use super::choice::worth;
use super::sizes::{self, round, Cutter, Shape};
use crate::body::{Body, FaceLook, Hollows};
use crate::OperationKind;

/// Share of the seen area that is worth an operation of its own.
const WORTH: f64 = 0.01;
/// Names in one operation at most: beyond, nobody reads or edits them.
const NAMES: usize = 400;
/// A face that is steep on this share of what looks up is a wall.
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
/// Faces that a reason names at most.
const NAMED: usize = 6;
/// Levels at most.
const LEVELS: f64 = 250.0;

/// One operation.
#[derive(Clone, Debug)]
pub struct Work {
    pub id: &'static str,
    pub kind: OperationKind,
    /// Numbers of the faces; none: the part's.
    pub faces: Option<Vec<u32>>,
    /// Between levels or rows, mm.
    pub pitch: f64,
    /// Direction of rows, degrees.
    pub angle_deg: f64,
}

impl Work {
    /// Whether it names a face.
    pub fn names(&self, face: u32) -> bool {
        self.faces.as_ref().is_some_and(|faces| faces.contains(&face))
    }
}

/// What is milled, and why so.
pub struct Milled {
    pub works: Vec<Work>,
    pub tool: Cutter,
    pub reasons: Vec<String>,
}

/// Levels over all that looks up.
pub fn forming(mesh: &Mesh, looks: &Hollows, tool: &Cutter) -> Work {
    let faces: Vec<&FaceLook> = worth(looks).collect();
    let pitch = levels_apart(mesh, &faces, tool);
    Work { id: "walls", kind: OperationKind::ZLevel, faces: None, pitch, angle_deg: 0.0 }
}

/// Rows, levels, or both.
pub fn milling(body: &Body<'_>, looks: &Hollows) -> Milled {
    let mesh = body.mesh();
    let seen: Vec<&FaceLook> = worth(looks).collect();
    let whole = area(&seen);
    let (walls, floors): (Vec<&FaceLook>, Vec<&FaceLook>) = seen.iter().partition(|face| is_wall(face));
    let is_prismatic = seen.iter().all(|face| face.flat >= PRISMATIC || face.vertical >= PRISMATIC);
    let shape = if is_prismatic { Shape::Flat } else { Shape::Ball };
    let drilled = |face: &&FaceLook| face.hole.is_some();
    let (tool, words) = sizes::cutter(mesh, seen.iter().copied().filter(|face| !drilled(face)), shape);
    let mut reasons = vec![words];
    let fits = |face: &&FaceLook| Hollows::bound([*face], 0.5).is_none_or(|radius| 2.02 * radius >= tool.diameter);
    let (walls, low): (Vec<&FaceLook>, Vec<&FaceLook>) =
        walls.into_iter().partition(|face| face.vertical < PRISMATIC || is_touched(body, face, &tool));
    let (open, narrow): (Vec<&FaceLook>, Vec<&FaceLook>) = walls.into_iter().partition(|face| fits(face));
    reasons.extend(left(&narrow, &tool));
    reasons.extend(untouched(&low, &tool));
    let with_levels = area(&open) >= WORTH * whole && floors.len().max(open.len()) <= NAMES;
    let with_rows = area(&floors) >= WORTH * whole || !with_levels;
    let angle_deg = if size(mesh)[0] >= size(mesh)[1] { 0.0 } else { 90.0 };
    let rows =
        |faces| Work { id: "floors", kind: OperationKind::ZigZag, faces, pitch: rows_apart(&seen, &tool), angle_deg };
    let levels = |faces| Work {
        id: "walls",
        kind: OperationKind::ZLevel,
        faces,
        pitch: levels_apart(mesh, &open, &tool),
        angle_deg,
    };
    let numbers = |faces: &[&FaceLook]| Some(faces.iter().map(|face| face.face).collect::<Vec<u32>>());
    let (works, words) = match (with_levels, with_rows) {
        (true, true) => (
            vec![levels(numbers(&open)), rows(numbers(&floors))],
            "levels for the walls, rows for floors and gentle slopes: each face in one of the two",
        ),
        (true, false) => (vec![levels(numbers(&open))], "levels: all that is worth cutting is walls"),
        (false, _) => (vec![rows(None)], "rows: they serve floors and slopes; no face is all wall"),
    };
    reasons.push(words.to_owned());
    reasons.push("these are finishing passes: the stock is to be roughed before".to_owned());
    Milled { works, tool, reasons }
}

/// Whether the tool's side touches an upright face while its tip stays above what lies in front of it.
fn is_touched(body: &Body<'_>, face: &FaceLook, tool: &Cutter) -> bool {
    let (mesh, foot) = (body.mesh(), body.mesh().bounds().0.z);
    let side = match tool.shape {
        Shape::Ball => 0.5 * tool.diameter,
        Shape::Flat => 0.0,
    };
    let own: Vec<usize> = (0..mesh.triangles().len()).filter(|t| mesh.faces()[*t] == face.face).collect();
    let floor_before = |triangle: &usize| {
        let [a, b, c] = mesh.corners(*triangle);
        let axis = (a + b + c) / 3.0 + 0.5 * tool.diameter * mesh.normal(*triangle);
        body.height_at(axis.x, axis.y).unwrap_or(foot)
    };
    let few = own.iter().step_by(own.len().div_ceil(LOOKED_AT).max(1));
    few.map(floor_before).any(|floor| face.heights[1] - floor > 1.2 * side)
}

/// What is left because the tool's side does not reach down to it, in words.
fn untouched(low: &[&FaceLook], tool: &Cutter) -> Option<String> {
    let radius = 0.5 * tool.diameter;
    (!low.is_empty()).then(|| {
        format!(
            "left out, for the side of a ball touches walls from {radius} mm over the floor on: {}; a flat tool reaches them",
            names(low)
        )
    })
}

/// Rows serve a face that is wall and floor in one.
fn is_wall(face: &FaceLook) -> bool {
    face.steep >= WALL * (face.flat + face.gentle + face.steep)
}

/// What is left for another tool, in words.
fn left(narrow: &[&FaceLook], tool: &Cutter) -> Option<String> {
    let (holes, slots): (Vec<&FaceLook>, Vec<&FaceLook>) = narrow.iter().partition(|face| face.hole.is_some());
    let mut said = Vec::new();
    if !holes.is_empty() {
        said.push(format!("the holes {} are for a drill", names(&holes)));
    }
    if !slots.is_empty() {
        said.push(format!("{} are narrower than the tool and for a smaller one", names(&slots)));
    }
    let diameter = tool.diameter;
    (!said.is_empty()).then(|| format!("left out, for the tool of {diameter} mm does not enter: {}", said.join("; ")))
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
    let wanted = match tool.shape {
        Shape::Ball => by_scallop(tool),
        Shape::Flat => FLAT_ROWS * tool.diameter,
    };
    let longest = area(faces) / LONGEST;
    round(wanted.max(longest.min(0.25 * tool.diameter)))
}

fn levels_apart(mesh: &Mesh, faces: &[&FaceLook], tool: &Cutter) -> f64 {
    let wanted = match tool.shape {
        Shape::Ball => by_scallop(tool) * steepness(faces),
        Shape::Flat => FLAT_LEVELS * tool.diameter,
    };
    let deepest = size(mesh)[2] / LEVELS;
    let longest = area(faces) / LONGEST;
    round(wanted.max(deepest).max(longest.min(0.25 * tool.diameter)))
}

/// Sine of a usual wall's slope: half of what is steep, and the gentle rest, lie farther apart than levels do.
fn steepness(faces: &[&FaceLook]) -> f64 {
    let steep: f64 = faces.iter().map(|face| face.steep * face.area).sum();
    let gentle: f64 = faces.iter().map(|face| face.gentle * face.area).sum();
    let share = steep / (steep + gentle).max(f64::MIN_POSITIVE);
    0.4 + 0.5 * share
}

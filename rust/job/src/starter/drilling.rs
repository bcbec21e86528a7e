//! Drilling of a starter job: the round upright holes of a part, by diameter.

use std::collections::BTreeMap;

use styluscam_geometry::{Mesh, Vector};

use super::cutter::{Cutter, Shape};
use super::sizes::measured;
use super::work::Work;
use crate::body::Body;
use crate::holes::{holes_among, Hole};
use crate::operations::{Serves, StarterPasses};

/// The widest drill that a shop's chuck takes, and the narrowest that is no wire, mm.
const DRILLS: [f64; 2] = [0.3, 13.0];
/// Drills are a tenth of a millimetre apart.
const APART: f64 = 0.1;
/// A hole that is wider than its drill by no more is drilled to size, mm.
const TO_SIZE: f64 = 0.01;
/// What is left of a hole's size when it is read, mm.
const READ: f64 = 0.001;
/// Deeper holes are drilled in pecks, in diameters.
const DEEP: f64 = 3.0;
/// Flat floors of holes that are no narrower are finished by milling, mm: usual end mills get in there.
const MILLED: f64 = 6.0;
/// What an axis may be off the middle of a hole's floor, mm.
const SAME: f64 = 0.01;

/// Drilling of the holes of one diameter.
pub struct Drilled {
    pub work: Work,
    /// Walls and floors of the holes: they are not roughed.
    pub faces: Vec<u32>,
    /// Those of them that are finished by milling.
    milled: Vec<u32>,
    /// Axes in plan, mm.
    pub axes: Vec<[f64; 2]>,
    /// The widest one's radius, mm.
    pub radius: f64,
}

impl Drilled {
    /// Whether a face in a hole is finished by milling.
    pub fn mills(&self, face: u32) -> bool {
        self.milled.contains(&face)
    }

    /// Faces that are done with it: no other operation is for them.
    pub fn done(&self) -> impl Iterator<Item = u32> + '_ {
        self.faces.iter().copied().filter(|face| !self.milled.contains(face))
    }

    /// Whether a position in plan lies in one of the holes.
    pub fn holds(&self, [x, y]: [f64; 2]) -> bool {
        self.axes.iter().any(|at| libm::hypot(x - at[0], y - at[1]) <= self.radius)
    }
}

/// Drilling of a part's round upright holes, the narrowest first.
pub fn drilling(body: &Body<'_>) -> Vec<Drilled> {
    let mut faces: Vec<u32> = body.mesh().faces().to_vec();
    faces.sort_unstable();
    faces.dedup();
    let mut holes = holes_among((body.mesh(), body.bvh()), &faces);
    holes.sort_by(|a, b| a.radius.total_cmp(&b.radius).then(a.faces.cmp(&b.faces)));
    let mut sizes: BTreeMap<u32, Vec<Hole>> = BTreeMap::new();
    for hole in holes.into_iter().filter(|hole| (DRILLS[0]..=DRILLS[1]).contains(&hole.diameter())) {
        sizes.entry(drill(body.mesh(), &hole)).or_default().push(hole);
    }
    sizes.iter().filter_map(|(tenths, holes)| drilled(body, f64::from(*tenths) / 10.0, holes)).collect()
}

/// Tenths of a millimetre of the drill for a hole: of a hole in facets the drill is as wide as they leave room for.
fn drill(mesh: &Mesh, hole: &Hole) -> u32 {
    let off = |p: Vector| libm::hypot(p.x - hole.at[0], p.y - hole.at[1]);
    let of_hole = |triangle: &usize| mesh.faces().get(*triangle).is_some_and(|face| hole.faces.contains(face));
    let facets = (0..mesh.triangles().len()).filter(of_hole).filter(|_| !mesh.has_corner_normals());
    let middles = facets.flat_map(|triangle| {
        let [a, b, c] = mesh.corners(triangle);
        [a + b, b + c, c + a].map(|sum| off(0.5 * sum))
    });
    let room = middles.fold(hole.radius, f64::min);
    ((2.0 * room + READ) / APART).floor() as u32
}

fn drilled(body: &Body<'_>, diameter: f64, holes: &[Hole]) -> Option<Drilled> {
    if diameter < DRILLS[0] {
        return None;
    }
    let widest = holes.iter().map(Hole::diameter).fold(0.0, f64::max);
    let deepest = holes.iter().map(|hole| hole.top - hole.bottom).fold(0.0, f64::max);
    let mut walls: Vec<u32> = holes.iter().flat_map(|hole| hole.faces.iter().copied()).collect();
    walls.sort_unstable();
    let count = holes.len();
    let plural = if count == 1 { "" } else { "s" };
    let mut why =
        vec![format!("{count} round upright hole{plural} of {} mm, {deepest:.1} mm deep at most", measured(widest))];
    let is_deep = deepest > DEEP * diameter;
    if is_deep {
        why.push(format!("deeper than {DEEP} diameters: in pecks, so that chips come out"));
    }
    let wider = widest - diameter;
    let off = wider > TO_SIZE;
    if off {
        why.push(format!("the next drill is {wider:.2} mm narrower: ream or bore what has to have its size"));
    }
    let is_milled = |hole: &&Hole| has_flat_floor(hole) && hole.diameter() >= MILLED;
    let milled: Vec<Hole> = holes.iter().filter(is_milled).cloned().collect();
    if !milled.is_empty() {
        why.push("the drill's point leaves a cone on flat floors: finishing takes it".to_owned());
    } else if holes.iter().any(has_flat_floor) {
        why.push("the drill's point leaves a cone on flat floors: mill them if they have to be flat".to_owned());
    }
    let passes = StarterPasses {
        peck: is_deep.then_some(diameter),
        wider: if off { (wider * 1000.0).ceil() / 1000.0 } else { 0.0 },
        ..StarterPasses::default()
    };
    let faces_of = |holes: &[Hole]| -> Vec<u32> {
        holes.iter().flat_map(|hole| hole.faces.iter().copied()).chain(floors(body, holes)).collect()
    };
    Some(Drilled {
        axes: holes.iter().map(|hole| hole.at).collect(),
        radius: 0.5 * widest,
        faces: faces_of(holes),
        milled: faces_of(&milled),
        work: Work {
            id: format!("holes-{diameter}"),
            serves: Serves::Holes,
            tool: format!("drill-{diameter}"),
            cutter: Cutter { shape: Shape::Drill, diameter },
            faces: Some(walls),
            passes,
            leave: 0.0,
            why,
        },
    })
}

/// Whether the hole's wall goes down to a flat floor, or a shoulder around a narrower hole.
fn has_flat_floor(hole: &Hole) -> bool {
    hole.floor.is_some_and(|floor| floor > hole.bottom - SAME)
}

/// Faces that lie in holes all over.
fn floors(body: &Body<'_>, holes: &[Hole]) -> Vec<u32> {
    let mesh = body.mesh();
    let mut inside: BTreeMap<u32, bool> = BTreeMap::new();
    for (triangle, face) in mesh.faces().iter().enumerate() {
        let lies_in = |hole: &Hole| {
            mesh.corners(triangle).iter().all(|corner| {
                let off = libm::hypot(corner.x - hole.at[0], corner.y - hole.at[1]);
                off <= hole.radius + SAME && corner.z <= hole.bottom + SAME
            })
        };
        let is_inside = holes.iter().any(|hole| hole.floor.is_some() && lies_in(hole));
        *inside.entry(*face).or_insert(true) &= is_inside;
    }
    inside.into_iter().filter(|(_, is_inside)| *is_inside).map(|(face, _)| face).collect()
}

//! What a program leaves on the faces that it was to touch.
//!
//! What is left at a point of the part is its distance from all that the tool (with sheet) sweeps on the moves that are
//! meant to touch, each straight move exactly, an arc to 0.0001 mm. Between neighbouring passes that is the scallop; where no pass
//! comes near it is everything.

use std::cell::Cell;
use std::collections::BTreeMap;

use rayon::prelude::*;
use rstar::{PointDistance, RTree, RTreeObject, SelectionFunction, AABB};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Mesh, Vector};
use styluscam_motion::{Cancelled, Program, Watch};

use crate::body::Body;
use crate::bounds::box_bound;
use crate::convex::{lower, EQUAL};
use crate::flats::{Flats, Need};
use crate::measure::strokes_of;
use crate::probes::{self, Probe};
use crate::region_faults::Asked;
use crate::segments::{placed, Segment, SegmentKind};
use crate::stroke::Stroke;
use crate::subject::{Limits, Subject};

/// Points for each square of the mean distance between passes.
const PER_PASS: f64 = 25.0;
/// Points of a face at least.
const OF_A_FACE: usize = 400;
/// Points at least and at most, for all faces.
const POINTS: [f64; 2] = [20_000.0, 400_000.0];
/// Points in a piece of work. Fixed, so that the result does not depend on the number of threads.
const CHUNK: usize = 256;
/// A position counts as covered when no more than this share of the diameter is left there, that of the smallest tool that
/// touches anything.
const COVERED: f64 = 0.01;
/// Arcs are looked at as chords that are nearer than this, mm.
const SAG: f64 = 1e-4;

/// What is left on one face.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FaceCoverage {
    /// The face.
    pub face: u32,
    /// Its area, mm^2, without what faces down, and of what the operations' boundaries and check faces leave of it.
    pub area: f64,
    /// Share of it that needs no forming since the blank lies there before.
    pub flat: f64,
    /// Share of it that needs no forming since it goes down flat with the passes around it.
    pub carried: f64,
    /// Share of the rest that is covered: where at most a hundredth of the diameter of the smallest tool used is left; 1 where
    /// there is no rest.
    pub covered: f64,
    /// Most that is left where it is covered, mm: the scallop.
    pub scallop: f64,
    /// What is left on average where it is covered, mm.
    pub mean: f64,
    /// Most that is left anywhere on the rest of the face, mm; none where nothing at all was swept, or is to be.
    pub left: Option<f64>,
    /// Where that is, work coordinates, mm.
    pub at: Option<[f64; 3]>,
    /// Points looked at.
    pub points: usize,
}

/// What a program leaves on the triangles that `selected` names, face by face in the order of their numbers.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub fn coverage(
    program: &Program,
    subject: &Subject,
    limits: &Limits,
    selected: &[bool],
    watch: &Watch,
) -> Result<Vec<FaceCoverage>, Cancelled> {
    let segments = placed(program, subject, limits);
    let sweeps = Sweeps::of_all(&segments, subject);
    let flats = Flats::of(&segments, subject, limits, sweeps.enough);
    let faces = faces(subject, selected);
    let asked = Asked::of(subject);
    let area: f64 = faces.iter().map(|face| face.area).sum();
    let between_passes = area / sweeps.length_near(subject.mesh).max(f64::MIN_POSITIVE);
    let count = (PER_PASS * area / (between_passes * between_passes)).clamp(POINTS[0], POINTS[1]);
    let of_face = |face: &Face| ((count * face.area / area) as usize).max(OF_A_FACE);
    watch.begin("coverage", faces.iter().map(of_face).sum());
    let looked_at = |face: &Face| {
        let (probes, share) = asked.of_points(probes::spread(subject.mesh, &face.triangles, of_face(face)));
        let points: Vec<Vector> = probes.iter().map(|probe| probe.point).collect();
        let left = sweeps.left_at(&points, watch)?;
        let need = |probe: &Probe| flats.need(probe.point, subject.mesh.normal(probe.triangle));
        let needs: Vec<Need> = probes.par_iter().map(need).collect();
        Ok((share > 0.0).then(|| face.coverage((&points, share), &left, &needs, sweeps.enough)))
    };
    faces.iter().filter_map(|face| looked_at(face).transpose()).collect()
}

/// What each of some points, with its unit normal, asks for.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub fn needs(
    program: &Program,
    subject: &Subject,
    limits: &Limits,
    points: &[(Vector, Vector)],
    watch: &Watch,
) -> Result<Vec<Need>, Cancelled> {
    watch.begin("what stays flat", points.len());
    let segments = placed(program, subject, limits);
    let flats = Flats::of(&segments, subject, limits, Sweeps::of_all(&segments, subject).enough);
    let of_chunk = |chunk: &[(Vector, Vector)]| {
        watch.advance(chunk.len())?;
        Ok(chunk.iter().map(|(point, up)| flats.need(*point, *up)).collect())
    };
    let needs: Result<Vec<Vec<Need>>, Cancelled> = points.par_chunks(CHUNK).map(of_chunk).collect();
    Ok(needs?.concat())
}

/// What a program leaves at each of some points, mm: negative where they lie in what is swept, infinite where nothing is.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub fn left(
    program: &Program,
    subject: &Subject,
    limits: &Limits,
    points: &[Vector],
    watch: &Watch,
) -> Result<Vec<f64>, Cancelled> {
    watch.begin("what is left", points.len());
    Sweeps::of_all(&placed(program, subject, limits), subject).left_at(points, watch)
}

/// A face's selected triangles.
struct Face {
    number: u32,
    triangles: Vec<usize>,
    area: f64,
}

fn faces(subject: &Subject, selected: &[bool]) -> Vec<Face> {
    let mut by_number: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for triangle in (0..selected.len()).filter(|t| selected[*t]) {
        by_number.entry(subject.mesh.faces()[triangle]).or_default().push(triangle);
    }
    let face = |(number, triangles): (u32, Vec<usize>)| {
        let area = triangles.iter().map(|t| subject.mesh.area(*t)).sum();
        Face { number, triangles, area }
    };
    by_number.into_iter().map(face).collect()
}

impl Face {
    /// Sums up what is left at points that stand for equal areas. A floor that was touched is covered, not carried.
    fn coverage(&self, (points, asked): (&[Vector], f64), left: &[f64], needs: &[Need], enough: f64) -> FaceCoverage {
        let is_covered = |i: usize| left[i] <= enough;
        let stays = |i: usize| needs[i] == Need::Flat || needs[i] == Need::Carried && !is_covered(i);
        let formed: Vec<usize> = (0..left.len()).filter(|i| !stays(*i)).collect();
        let covered: Vec<f64> = formed.iter().filter(|i| is_covered(**i)).map(|i| left[*i].max(0.0)).collect();
        let finite = formed.iter().copied().filter(|i| left[*i].is_finite());
        let most = finite.max_by(|i, j| left[*i].total_cmp(&left[*j]));
        let share = |count: usize| count as f64 / left.len().max(1) as f64;
        let flat = needs.iter().filter(|need| **need == Need::Flat).count();
        FaceCoverage {
            face: self.number,
            area: asked * self.area,
            flat: share(flat),
            carried: share(left.len() - flat - formed.len()),
            covered: if formed.is_empty() { 1.0 } else { covered.len() as f64 / formed.len() as f64 },
            scallop: covered.iter().copied().fold(0.0, f64::max),
            mean: covered.iter().sum::<f64>() / covered.len().max(1) as f64,
            left: most.map(|i| left[i].max(0.0)),
            at: most.map(|i| points[i].into()),
            points: points.len(),
        }
    }
}

/// All moves that are meant to touch, by tool.
pub(crate) struct Sweeps {
    tools: Vec<(Body, RTree<Sweep>)>,
    /// What may be left at a covered position, mm.
    enough: f64,
}

/// A straight move of a body's tip, or a chord of an arc.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sweep {
    stroke: Stroke,
    /// Index of its segment among those that are meant to touch.
    pub segment: usize,
}

impl RTreeObject for Sweep {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.stroke.from.into(), self.stroke.to.into())
    }
}

impl Sweep {
    /// The position of the body on the path that is nearest to a point.
    pub fn nearest(&self, point: Vector) -> Vector {
        let travel = self.stroke.to - self.stroke.from;
        let share = (point - self.stroke.from).dot(&travel) / travel.norm_squared().max(f64::MIN_POSITIVE);
        self.stroke.at(share.clamp(0.0, 1.0))
    }

    /// Distance from a point to what the body sweeps, mm.
    pub fn distance(&self, body: &Body, point: Vector) -> f64 {
        distance(body, point, &self.stroke, f64::INFINITY)
    }

    /// The position of the body on the path where it passes a point nearest by.
    pub fn position_nearest(&self, body: &Body, point: Vector) -> Vector {
        let mut nearest = (f64::INFINITY, self.stroke.from);
        least(body, point, &self.stroke, f64::INFINITY, |value, position| {
            if value < nearest.0 {
                nearest = (value, position);
            }
        });
        nearest.1
    }
}

impl PointDistance for Sweep {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        let point = Vector::from(*point);
        (point - self.nearest(point)).norm_squared()
    }
}

impl Sweeps {
    /// Those of `segments` that are meant to touch.
    pub fn of_all(segments: &[Segment], subject: &Subject) -> Self {
        let contacts: Vec<&Segment> = segments.iter().filter(|segment| segment.kind == SegmentKind::Lateral).collect();
        Self::of(&contacts, subject, [0.0; 2])
    }

    /// Of moves that are meant to touch, but for so much stock that is to be left across walls in plan and in height, mm.
    pub fn of(contacts: &[&Segment], subject: &Subject, to_leave: [f64; 2]) -> Self {
        let tools = subject.tools.iter().enumerate().map(|(number, tool)| {
            let body = Body::leaving(tool, subject.sheet.as_ref(), to_leave);
            let own = contacts.iter().enumerate().filter(|(_, segment)| segment.tool == Some(number));
            let pieces = own.flat_map(|(segment, whole)| whole.pieces().map(move |piece| (segment, piece)));
            let strokes = pieces.flat_map(|(segment, piece)| {
                strokes_of(&piece, &body, SAG).into_iter().map(move |stroke| Sweep { stroke, segment })
            });
            let tree = RTree::bulk_load(strokes.collect());
            (body, tree)
        });
        let tools: Vec<(Body, RTree<Sweep>)> = tools.collect();
        let used = tools.iter().zip(subject.tools).filter(|((_, tree), _)| tree.size() > 0);
        let smallest = used.map(|(_, tool)| tool.diameter()).fold(f64::INFINITY, f64::min);
        let enough = if smallest.is_finite() { COVERED * smallest } else { 0.0 };
        Self { tools, enough }
    }

    /// Length of the moves near a mesh, mm.
    fn length_near(&self, mesh: &Mesh) -> f64 {
        let near = self.tools.iter().flat_map(|(body, tree)| tree.locate_in_envelope_intersecting(around(mesh, body)));
        near.map(|sweep| sweep.stroke.length()).sum()
    }

    /// Tool and sheet, by the tool's index.
    pub fn body(&self, tool: usize) -> Option<&Body> {
        self.tools.get(tool).map(|(body, _)| body)
    }

    /// The moves whose body is within a distance of a position on its path, mm.
    pub fn near(&self, position: Vector, distance: f64) -> impl Iterator<Item = &Sweep> {
        let trees = self.tools.iter().map(|(_, tree)| tree);
        trees.flat_map(move |tree| tree.locate_within_distance(position.into(), distance * distance))
    }

    /// Distances from points to what is swept, mm; points near by follow each other.
    fn left_at(&self, points: &[Vector], watch: &Watch) -> Result<Vec<f64>, Cancelled> {
        let of_chunk = |chunk: &[Vector]| {
            let mut last = None;
            watch.advance(chunk.len())?;
            Ok(chunk.iter().map(|point| self.left(*point, &mut last)).collect())
        };
        let left: Result<Vec<Vec<f64>>, Cancelled> = points.par_chunks(CHUNK).map(of_chunk).collect();
        Ok(left?.concat())
    }

    /// The same if it is more than `enough`, mm; where it is not, one move is mostly all that is looked at: the last one, or
    /// the one nearest to a position at which a body touches the point.
    pub fn left_beyond(
        &self,
        point: Vector,
        enough: f64,
        position: Vector,
        last: &mut Option<(usize, Sweep)>,
    ) -> Option<f64> {
        let near = self.tools.iter().enumerate();
        let near = near.filter_map(|(tool, (_, tree))| Some((tool, *tree.nearest_neighbor(position.into())?)));
        for (tool, sweep) in (*last).into_iter().chain(near) {
            if distance(&self.tools[tool].0, point, &sweep.stroke, f64::INFINITY) <= enough {
                *last = Some((tool, sweep));
                return None;
            }
        }
        Some(self.left(point, last)).filter(|left| *left > enough)
    }

    /// Distance from a point to what is swept, mm; `last` holds the move that was nearest to a point near by.
    pub fn left(&self, point: Vector, last: &mut Option<(usize, Sweep)>) -> f64 {
        let best = Cell::new(f64::INFINITY);
        let nearest = Cell::new(*last);
        if let Some((tool, sweep)) = *last {
            best.set(distance(&self.tools[tool].0, point, &sweep.stroke, f64::INFINITY));
        }
        for (tool, (body, tree)) in self.tools.iter().enumerate() {
            let search = Search { body, tool, point, best: &best, nearest: &nearest };
            tree.locate_with_selection_function(search).for_each(drop);
        }
        *last = nearest.get();
        best.get()
    }
}

/// A box that holds every position at which a body touches a mesh, or is within half its radius of it.
fn around(mesh: &Mesh, body: &Body) -> AABB<[f64; 3]> {
    let (low, high) = mesh.bounds();
    let near = 0.5 * body.radius();
    let beside = near + body.radius();
    AABB::from_corners(
        [low.x - beside, low.y - beside, f64::NEG_INFINITY],
        [high.x + beside, high.y + beside, high.z + near],
    )
}

/// The search for the move that sweeps nearest to a point.
struct Search<'a> {
    body: &'a Body,
    tool: usize,
    point: Vector,
    best: &'a Cell<f64>,
    nearest: &'a Cell<Option<(usize, Sweep)>>,
}

impl SelectionFunction<Sweep> for Search<'_> {
    fn should_unpack_parent(&self, envelope: &AABB<[f64; 3]>) -> bool {
        // the point as bodies with their tips in the box see it
        let high = self.point - Vector::from(envelope.lower());
        let low = self.point - Vector::from(envelope.upper());
        box_bound(self.body, low, high) < self.best.get() - EQUAL
    }

    fn should_unpack_leaf(&self, sweep: &Sweep) -> bool {
        let found = distance(self.body, self.point, &sweep.stroke, self.best.get());
        if found < self.best.get() {
            self.best.set(found);
            self.nearest.set(Some((self.tool, *sweep)));
        }
        false
    }
}

/// Distance from a point to a body on its path, where it is below `best`: convex in the position on the path.
fn distance(body: &Body, point: Vector, stroke: &Stroke, best: f64) -> f64 {
    let mut nearest = f64::INFINITY;
    least(body, point, stroke, best, |value, _| nearest = nearest.min(value));
    nearest
}

/// Looks for the least distance below `best` from a point to a body on its path: `seen` is given each that is computed, with
/// the body's position.
fn least(body: &Body, point: Vector, stroke: &Stroke, best: f64, mut seen: impl FnMut(f64, Vector)) {
    let along = stroke.from - stroke.to;
    lower(stroke.share_near(point), along.norm(), best, |share| {
        let position = stroke.at(share);
        let p = point - position;
        let here = body.distance(p);
        seen(here.value, position);
        body.tangent(p, &here, along)
    });
}

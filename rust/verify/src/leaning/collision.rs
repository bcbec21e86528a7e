//! What leaning tools enter: the profile, the shank and the holder against the whole part.
//!
//! Of the ruled surfaces that an operation mills, what its feeds do to them is measured along their normals (`swept`); there, and at
//! the edges around them, feeds may enter by the error that is allowed.

use rayon::prelude::*;
use styluscam_geometry::{Bvh, Mesh, Tool, ToolPart, Vector};
use styluscam_motion::{Cancelled, MoveKind, Watch};

use super::found::Judged;
use super::moves::{LeaningMove, Pose};
use super::surface::{samples, POINTS};
use crate::body::Body;
use crate::clearance::nearest;
use crate::expectation::FlankFace;
use crate::faults::{self, Fault, FaultKind};
use crate::measure::gouge_level;
use crate::place::Place;
use crate::sections::least_between;
use crate::subject::{Limits, Subject};
use crate::tolerances::SLACK;

/// Distance between positions that are looked at, as a share of the tool's radius.
const STEP: f64 = 0.125;
/// Positions of a move at most.
const MOST: usize = 4096;
/// A tool that is nearer to the part than this, mm, may touch it between two positions.
const NEAR: f64 = 0.1;
/// The same on the surfaces that it mills, where it is always near.
const AT_SURFACE: f64 = 2e-3;
/// Clearances that differ by less are the same, mm.
const LEVEL: f64 = 1e-5;
/// Parts of the golden section between positions: to 1e-4 of their distance.
const SECTIONS: usize = 18;

/// A body of the tool, and what it is when it enters the part.
struct Solid {
    body: Body,
    kind: Option<&'static FaultKind>,
}

/// The part of an operation in two: the triangles of the surfaces that it mills, and all others.
struct Own {
    surfaces: Option<Indexed>,
    others: Option<Indexed>,
    max_error: f64,
}

/// Triangles with their index.
struct Indexed {
    mesh: Mesh,
    bvh: Bvh,
}

impl Indexed {
    /// Some triangles of a mesh; none of none.
    fn of(mesh: &Mesh, chosen: impl Fn(usize) -> bool) -> Option<Self> {
        let chosen = (0..mesh.triangles().len()).filter(|triangle| chosen(*triangle));
        let triangles: Vec<[i64; 3]> = chosen.map(|triangle| mesh.triangles()[triangle].map(i64::from)).collect();
        let mesh = Mesh::new(mesh.vertices().to_vec(), &triangles, &[]).ok()?;
        let bvh = Bvh::new(&mesh);
        Some(Self { mesh, bvh })
    }
}

/// Checks every move.
///
/// # Errors
/// `Cancelled`.
pub(super) fn judge(
    moves: &[LeaningMove],
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
    judged: &mut Judged,
) -> Result<(), Cancelled> {
    watch.begin("verifying leaning tools", moves.len());
    judged.samples += moves.len();
    let solids: Vec<Vec<Solid>> = subject.tools.iter().map(solids).collect();
    let owns: Vec<Option<Own>> = (0..subject.expected.len()).map(|number| Own::of(subject, number)).collect();
    let limit = gouge_level(subject, limits);
    let found = moves.par_iter().map(|step| {
        watch.advance(1)?;
        let Some(solids) = step.tool.and_then(|tool| solids.get(tool)) else { return Ok(Vec::new()) };
        let own = step.expected.and_then(|number| owns.get(number)?.as_ref()).filter(|_| step.kind == MoveKind::Feed);
        let whole = Target { mesh: subject.mesh, bvh: subject.bvh, own: None, limit, near: NEAR };
        let of_part = own.map_or([Some(whole), None], |own| [own.others(limit), own.surfaces(limit)]);
        let at_part = of_part.into_iter().flatten().flat_map(|target| {
            solids.iter().filter_map(move |solid| {
                let (clearance, tip) = Search { step, body: &solid.body, target }.deepest()?;
                Some(Struck { step, kind: solid.kind, clearance, tip, least: None })
            })
        });
        let at_check = check_of(step, subject).into_iter().flat_map(|(target, least)| {
            solids.iter().filter_map(move |solid| {
                let (clearance, tip) = Search { step, body: &solid.body, target }.deepest()?;
                Some(Struck { step, kind: Some(&faults::CHECK_CLEARANCE), clearance, tip, least: Some(least) })
            })
        });
        Ok(at_part.chain(at_check).collect())
    });
    for struck in found.collect::<Result<Vec<Vec<_>>, Cancelled>>()?.into_iter().flatten() {
        struck.report(subject, limits, judged);
    }
    Ok(())
}

/// The faces that a move's operation keeps away from, with the clearance that is asked for, mm.
fn check_of<'a>(step: &LeaningMove, subject: &Subject<'a>) -> Option<(Target<'a>, f64)> {
    let check = subject.expected.get(step.expected?)?.expectation.region.check.as_deref()?;
    let limit = check.clearance + subject.deviation_inward;
    Some((Target { mesh: &check.mesh, bvh: &check.bvh, own: None, limit, near: NEAR }, check.clearance))
}

/// Where a move comes too near to something.
struct Struck<'a> {
    step: &'a LeaningMove,
    /// None of the profile in the part: a gouge, or a rapid into it.
    kind: Option<&'static FaultKind>,
    clearance: f64,
    tip: Vector,
    /// What was asked for of check faces, mm.
    least: Option<f64>,
}

impl Struck<'_> {
    fn report(&self, subject: &Subject, limits: &Limits, judged: &mut Judged) {
        let Self { step, clearance, .. } = *self;
        let kind = self.kind.unwrap_or(match step.kind {
            MoveKind::Rapid => &faults::RAPID_INTO_MATERIAL,
            MoveKind::Feed => &faults::GOUGE,
        });
        let at = Place { line: step.line, position: self.tip.into() };
        let fault = Fault::new(kind, step.index, step.line, at.position);
        let depth = subject.deviation_inward - clearance;
        if let Some(least) = self.least {
            judged.faults.push(fault.measured(-depth, least));
            return;
        }
        judged.faults.push(fault.measured(depth, limits.gouge));
        judged.gouge.take(depth, at);
    }
}

fn solids(tool: &Tool) -> Vec<Solid> {
    let above = tool.bodies_above(None).into_iter().map(|(part, solid)| {
        let kind = match part {
            ToolPart::Shank => &faults::SHANK,
            ToolPart::Holder => &faults::HOLDER,
        };
        Solid { body: Body::of(solid), kind: Some(kind) }
    });
    std::iter::once(Solid { body: Body::new(tool, None), kind: None }).chain(above).collect()
}

impl Own {
    fn of(subject: &Subject, number: usize) -> Option<Self> {
        let passes = subject.expected.get(number)?.expectation.flank()?;
        let faces: Vec<u32> = passes.faces.iter().filter_map(|face| face.face).collect();
        let stated: Vec<Stated> = passes.faces.iter().filter(|face| face.face.is_none()).map(Stated::of).collect();
        let reach = passes.max_error + subject.deviation_inward.max(subject.deviation_outward);
        let is_own = |(triangle, face): (usize, &u32)| {
            faces.contains(face) || stated.iter().any(|surface| surface.holds(subject.mesh.corners(triangle), reach))
        };
        let is_own: Vec<bool> = subject.mesh.faces().iter().enumerate().map(is_own).collect();
        let of = |own: bool| Indexed::of(subject.mesh, |triangle| is_own.get(triangle) == Some(&own));
        Some(Self { surfaces: of(true), others: of(false), max_error: passes.max_error })
    }

    /// All but the surfaces, as what feeds must not come nearer to than `limit`, mm.
    fn others(&self, limit: f64) -> Option<Target<'_>> {
        self.others.as_ref().map(|Indexed { mesh, bvh }| Target { mesh, bvh, own: Some(self), limit, near: NEAR })
    }

    /// The surfaces, which feeds may enter by the error that is allowed: all of them, for what is measured along their normals is
    /// measured at some of their points.
    fn surfaces(&self, limit: f64) -> Option<Target<'_>> {
        let limit = limit - self.max_error;
        self.surfaces.as_ref().map(|Indexed { mesh, bvh }| Target { mesh, bvh, own: None, limit, near: AT_SURFACE })
    }

    /// Whether a point lies on the surfaces or at their edges: within the error that is allowed there.
    fn is_beside(&self, point: Vector) -> bool {
        let Some(Indexed { mesh, bvh }) = &self.surfaces else { return false };
        (bvh.nearest(mesh, point).0 - point).norm() <= 2.0 * self.max_error + SLACK
    }
}

/// A surface between stated rails, for the triangles of the part that lie on it.
struct Stated {
    samples: Vec<(Vector, Vector)>,
    /// Of neighbouring samples, mm at most.
    apart: f64,
    /// The box around it.
    around: [Vector; 2],
}

impl Stated {
    fn of(face: &FlankFace) -> Self {
        let samples = samples(face);
        let apart = |i: usize, j: usize| match (samples.get(i), samples.get(j)) {
            (Some(a), Some(b)) => (a.0 - b.0).norm(),
            _ => 0.0,
        };
        let widest = (0..samples.len()).map(|i| {
            let along = if (i + 1) % POINTS == 0 { 0.0 } else { apart(i, i + 1) };
            apart(i, i + POINTS).max(along)
        });
        let apart = widest.fold(0.0, f64::max);
        let beyond = Vector::repeat(apart);
        let first = samples.first().map_or_else(Vector::zeros, |(point, _)| *point);
        let around = samples.iter().fold([first; 2], |[low, high], (point, _)| [low.inf(point), high.sup(point)]);
        Self { samples, apart, around: [around[0] - beyond, around[1] + beyond] }
    }

    /// Whether a triangle lies on it, within `reach` mm of the planes that touch it beside the corners.
    fn holds(&self, corners: [Vector; 3], reach: f64) -> bool {
        let [low, high] = self.around;
        let is_near = |corner: &Vector| (0..3).all(|i| (low[i]..=high[i]).contains(&corner[i]));
        corners.iter().all(is_near)
            && corners.into_iter().all(|corner| {
                let beside = |sample: &&(Vector, Vector)| (sample.0 - corner).norm_squared();
                let nearest = self.samples.iter().min_by(|a, b| beside(a).total_cmp(&beside(b)));
                nearest.is_some_and(|(point, normal)| {
                    let from = corner - point;
                    normal.dot(&from).abs() <= reach + BENT * self.apart && from.norm() <= self.apart
                })
            })
    }
}

/// How far a surface may bend away from the planes between which it is known, as a share of their distance.
const BENT: f64 = 0.02;

/// What a body must not come near.
#[derive(Clone, Copy)]
struct Target<'a> {
    mesh: &'a Mesh,
    bvh: &'a Bvh,
    /// Beside whose surfaces it may be entered by the error that is allowed there.
    own: Option<&'a Own>,
    /// The clearance below which it is too near, mm.
    limit: f64,
    /// How near to that, mm, it is looked for between positions.
    near: f64,
}

/// Looks for the deepest entry of a body on a move.
struct Search<'a> {
    step: &'a LeaningMove,
    body: &'a Body,
    target: Target<'a>,
}

impl Search<'_> {
    /// The least clearance, mm, if it is too little, and the tip there.
    fn deepest(&self) -> Option<(f64, Vector)> {
        let to = self.step.to;
        let Some(from) = self.step.from else {
            return self.clearance(&to).filter(|found| *found < self.target.limit - SLACK).map(|found| (found, to.tip));
        };
        let high = self.height();
        let count = (from.apart(&to, high) / (STEP * self.body.radius())).ceil().clamp(1.0, MOST as f64) as usize;
        let at = |i: f64| from.towards(&to, i / count as f64);
        // what a rapid leaves behind is the fault of the move that brought the tool there
        let first = usize::from(self.step.kind == MoveKind::Rapid);
        let value = |i: f64| self.clearance(&at(i)).unwrap_or(f64::INFINITY);
        let values: Vec<f64> = (0..=count).map(|i| value(i as f64)).collect();
        let lowest = (first..=count).map(|i| {
            let beside = [i.checked_sub(1), Some(i + 1)].map(|j| j.and_then(|j| values.get(j)).copied());
            let changes = || beside.into_iter().flatten().map(|other| other - values[i]);
            // the distance of a convex body is convex: where it stays the same there is nothing lower in between
            let is_lowest = changes().all(|change| change >= 0.0) && changes().any(|change| change > LEVEL);
            // what is far in is deep enough to be reported
            if is_lowest && (values[i] - self.target.limit).abs() < self.target.near {
                let [low, high] = [i.saturating_sub(1).max(first), (i + 1).min(count)].map(|i| i as f64);
                return least_between((values[i], i as f64), [low, high], SECTIONS, value);
            }
            (values[i], i as f64)
        });
        let (found, share) = lowest.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (found < self.target.limit - SLACK).then(|| (found, at(share).tip))
    }

    /// How high up the tool the part may reach, mm.
    fn height(&self) -> f64 {
        let (low, high) = self.target.mesh.bounds();
        (high - low).norm()
    }

    /// Of the body from the part, where it is nearly a gouge; deep or beside the tool's own surfaces, as far as that is none.
    fn clearance(&self, pose: &Pose) -> Option<f64> {
        let Self { body, target: Target { mesh, bvh, own, .. }, .. } = *self;
        let frame = pose.frame();
        let radius = body.radius();
        let origin = body.position([0.0; 3]);
        let bound = |node: &styluscam_geometry::Node| {
            let middle = frame.turned((node.low + node.high) * 0.5 - pose.tip) - origin;
            let half = 0.5 * (node.high - node.low).norm();
            half - (libm::hypot(middle.x, middle.y) - radius).max(-middle.z)
        };
        let visit = |triangle: u32, best: f64| {
            let corners = mesh.corners(triangle as usize);
            let in_tool = corners.map(|corner| frame.turned(corner - pose.tip) - origin);
            let Some((value, point)) = nearest(body, in_tool, -best) else { return best };
            let at = || frame.back(point + origin) + pose.tip;
            let is_allowed = value < self.target.limit
                && own.is_some_and(|own| value >= self.target.limit - own.max_error && own.is_beside(at()));
            if is_allowed {
                best
            } else {
                -value
            }
        };
        let nothing = -(self.target.limit + self.target.near);
        let found = bvh.maximise(nothing, bound, visit);
        (found > nothing).then_some(-found)
    }
}

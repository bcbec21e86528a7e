//! Scallops as a program leaves them: what stands between two neighbouring passes, above the floor of both.
//!
//! A scallop is measured, not computed from the tool's curvature: from a point of the part the surface is followed across the
//! passes to where both neighbours leave equally much; over that point they meet at the top of the ridge, from whose height
//! their mean distance from the part is subtracted. So neither the path's tolerance nor the margin that it keeps counts.

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Program, Watch};

use crate::assignment::Assignment;
use crate::body::Body;
use crate::clearance::Prober;
use crate::coverage::{Sweep, Sweeps};
use crate::expectation::{ExpectedOperation, OrderedPasses};
use crate::faults::{self, Fault};
use crate::pitch::Pitch;
use crate::probes::{self, Probe};
use crate::segments::{placed, Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::{ROOM, ROUGH, SAME_LEVEL};

/// Points in a piece of work. Fixed, so that the result does not depend on the number of threads.
const CHUNK: usize = 64;
/// Neighbours are looked for this far at first, in the smallest steps, and then twice as far until the tool's radius.
const NEAR: f64 = 1.2;
/// A neighbour runs by no farther aside or off the face than this share of the distance to it.
const RUNS_BY: f64 = 0.5;
/// Moves belong to one pass whose values differ by no more than this share of what lies between two passes.
const ONE_PASS: f64 = 0.25;
/// The interval that holds the scallop's highest point is halved so often: a ten-thousandth of it is a two-thousandth of the
/// scallop, which falls off beside that point by four times the share of the distance between passes.
const HALVINGS: usize = 14;
/// Where the part is curved the neighbours' values do not lie where the plane has them: the interval is this much longer.
const LONGER: f64 = 0.25;
/// Points at which scallops are compared with what is asked for.
const CHECKED: usize = 2000;
/// What a text may leave more than asked for: a share, and mm, for what rounding does to passes.
const POSTED: f64 = 1.03;
const ROUNDED: f64 = 0.0015;
/// A scallop that is so many times as high is none of rounding or of the part's curvature: a pass is missing.
const SURELY: f64 = 1.5;
/// Steps up to where two neighbours meet: each leaves a share of the last as large as the scallop is to the tool's radius.
const RISES: usize = 4;
/// Two neighbours leave equally much where that differs by no more than this share: ten times what the halvings leave.
const EQUAL: f64 = 0.01;

/// The highest point of what is left between two neighbouring passes, above their floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scallop {
    /// Its height, mm.
    pub height: f64,
    /// Where, work coordinates, mm.
    pub at: Vector,
    /// Distance of the neighbours in the scalar of their order, mm.
    pub step: f64,
    /// Length of ridge that it stands for, mm.
    pub length: f64,
    /// Number of the contact move on its side of the smaller value.
    below: usize,
}

/// The scallops of one operation of a program, at about `count` points spread evenly over the faces that it is for. None
/// where nothing is known of the order of its passes.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub fn scallops(
    program: &Program,
    subject: &Subject,
    limits: &Limits,
    operation: &ExpectedOperation,
    count: usize,
    watch: &Watch,
) -> Result<Vec<Scallop>, Cancelled> {
    let segments = placed(program, subject, limits);
    let assignment = Assignment::new(program, subject);
    let contacts: Vec<&Segment> = segments
        .iter()
        .filter(|segment| segment.kind == SegmentKind::Lateral && assignment.is(segment.operation, operation))
        .collect();
    let sweeps = Sweeps::of(&contacts, subject, operation.expectation.to_leave);
    match (operation.expectation.ordered(), sweeps.body(operation.tool)) {
        (Some(passes), Some(body)) => {
            let ridges = Ridges { subject, operation, passes, body, sweeps: &sweeps, contacts: &contacts };
            ridges.scallops(count, watch)
        }
        (None, _) | (_, None) => Ok(Vec::new()),
    }
}

/// The passes of an operation, and the part.
pub(crate) struct Ridges<'a> {
    pub subject: &'a Subject<'a>,
    pub operation: &'a ExpectedOperation,
    pub passes: &'a OrderedPasses,
    pub body: &'a Body,
    pub sweeps: &'a Sweeps,
    /// The operation's moves that should touch, as the sweeps number them.
    pub contacts: &'a [&'a Segment],
}

/// A neighbour: its value beside a position, and what of it runs by.
struct Neighbour {
    value: f64,
    sweeps: Vec<Sweep>,
}

impl Ridges<'_> {
    /// The scallops at about `count` points.
    pub fn scallops(&self, count: usize, watch: &Watch) -> Result<Vec<Scallop>, Cancelled> {
        let selected = self.operation.expectation.triangles();
        let area: f64 = selected.iter().map(|triangle| self.subject.mesh.area(*triangle)).sum();
        let probes = probes::spread(self.subject.mesh, &selected, count);
        let each = area / probes.len().max(1) as f64;
        watch.begin("scallops", probes.len().div_ceil(CHUNK));
        let of_chunk = |chunk: &[Probe]| {
            watch.advance(1)?;
            Ok(chunk.iter().filter_map(|probe| self.scallop(probe, each)).collect())
        };
        let found: Result<Vec<Vec<Scallop>>, Cancelled> = probes.par_chunks(CHUNK).map(of_chunk).collect();
        Ok(found?.concat())
    }

    /// Scallops that are higher than asked for, where passes are to lie by them.
    pub fn faults(&self, watch: &Watch) -> Result<Vec<Fault>, Cancelled> {
        let Pitch::Scallop { height, steps: [smallest, _] } = self.passes.pitch else { return Ok(Vec::new()) };
        let most = POSTED * height + ROUNDED;
        let found = self.scallops(CHECKED, watch)?.into_iter();
        let high = found.filter(|scallop| scallop.height > most && scallop.step > smallest + SAME_LEVEL);
        let fault = |scallop: Scallop| {
            let below = self.contacts.get(scallop.below)?;
            let fault = below.fault(&faults::SCALLOP).measured(scallop.height, height);
            Some(if scallop.height > SURELY * most { fault } else { fault.warning() })
        };
        Ok(high.filter_map(fault).collect())
    }

    /// The scallop between the passes on both sides of a point that stands for an `area`, mm^2.
    fn scallop(&self, probe: &Probe, area: f64) -> Option<Scallop> {
        let up = self.subject.mesh.normal(probe.triangle);
        let position = probe.point - self.body.farthest(up).0;
        let tip = self.body.tip(position);
        let scalar = &*self.passes.scalar;
        let expectation = &self.operation.expectation;
        if !expectation.reaches(tip[2]) || !expectation.region.takes(self.body, position, (probe.point, up)) {
            return None;
        }
        // by so much, on the plane of the point, does the scalar change by 1 mm
        let across = scalar.next(tip.into(), up, 1.0)?;
        let (value, rate, direction) = (scalar.value(tip.into()), across.norm().recip(), across.normalize());
        let falls = scalar.value(Vector::from(tip) + across) < value;
        let [low, high] = self.neighbours(position, value, (up, direction), rate)?;
        let step = high.value - low.value;
        let along = |neighbour: &Neighbour| (neighbour.value - value) / rate * if falls { -1.0 } else { 1.0 };
        let (from, to) = (along(&low), along(&high));
        let beyond = LONGER * (to - from);
        let at = self.where_equal(probe.point, direction, [from - beyond, to + beyond], [&low, &high])?;
        let (_, triangle) = self.subject.bvh.nearest(self.subject.mesh, at);
        let normal = self.subject.mesh.normal(triangle);
        if !self.is_reached(at, normal) {
            return None;
        }
        let (left_low, below) = self.left(&low, at)?;
        let (left_high, above) = self.left(&high, at)?;
        if (left_low - left_high).abs() > EQUAL * left_low.max(left_high) {
            return None; // the part ends before
        }
        if self.sweeps.left(at, &mut None) < (1.0 - EQUAL) * left_low.min(left_high) {
            return None; // another pass goes over it
        }
        let across = scalar.next(tip.into(), normal, 1.0)?;
        let (position, along) = (at - self.body.farthest(normal).0, normal.cross(&across).normalize());
        let passes_by = |sweep: &Sweep| runs_by(sweep.position_nearest(self.body, at) - position, [along, normal]);
        if !passes_by(&below) || !passes_by(&above) {
            return None; // one of them ends before
        }
        let top = self.top([&low, &high], at, normal)?;
        let floor = 0.5 * (self.floor(&below, at)? + self.floor(&above, at)?);
        let length = area * rate / step;
        Some(Scallop { height: top - floor, at, step, length, below: below.segment })
    }

    /// The passes with the next smaller and the next larger value beside a position.
    fn neighbours(
        &self,
        position: Vector,
        value: f64,
        (up, direction): (Vector, Vector),
        rate: f64,
    ) -> Option<[Neighbour; 2]> {
        let mut reach = NEAR * self.passes.pitch.smallest() / rate;
        let farthest = self.body.radius();
        loop {
            reach = reach.min(farthest);
            let around = self.around(position, (up, direction), reach);
            if let Some(found) = beside(&around, value) {
                return Some(found);
            }
            if reach >= farthest {
                return None;
            }
            reach *= 2.0;
        }
    }

    /// What runs by a position on its face within a reach, by value.
    fn around(&self, position: Vector, (up, direction): (Vector, Vector), reach: f64) -> Vec<(f64, Sweep)> {
        let along = up.cross(&direction);
        let near = self.sweeps.near(position, reach).filter_map(|sweep| {
            let nearest = sweep.nearest(position);
            let runs_by = runs_by(nearest - position, [along, up]);
            runs_by.then(|| (self.passes.scalar.value(self.body.tip(nearest).into()), *sweep))
        });
        let mut around: Vec<(f64, Sweep)> = near.collect();
        around.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.segment.cmp(&b.1.segment)));
        around
    }

    /// The point of the part across the passes at which two neighbours leave equally much.
    fn where_equal(
        &self,
        from: Vector,
        direction: Vector,
        [mut low, mut high]: [f64; 2],
        [first, second]: [&Neighbour; 2],
    ) -> Option<Vector> {
        let Subject { mesh, bvh, .. } = *self.subject;
        let point = |travel: f64| bvh.nearest(mesh, from + travel * direction).0;
        let more = |travel: f64| {
            let at = point(travel);
            Some(self.left(first, at)?.0 - self.left(second, at)?.0)
        };
        if more(low)? >= 0.0 || more(high)? <= 0.0 {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if more(middle)? < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(point(0.5 * (low + high)))
    }

    /// How far over a point of the part two neighbours meet, mm: they are as near to that point in space as makes no difference.
    fn top(&self, [first, second]: [&Neighbour; 2], point: Vector, normal: Vector) -> Option<f64> {
        let mut over = 0.0;
        for _ in 0..RISES {
            let here = point + over * normal;
            over += 0.5 * (self.left(first, here)?.0 + self.left(second, here)?.0);
        }
        Some(over)
    }

    /// Whether the tool can touch a point of the part with a unit normal: elsewhere it is not the passes' distance that leaves
    /// something.
    fn is_reached(&self, point: Vector, normal: Vector) -> bool {
        let prober = Prober { body: self.body, mesh: self.subject.mesh, bvh: self.subject.bvh };
        let position = point - self.body.farthest(normal).0;
        prober.at(position, None).is_some_and(|touch| touch.value >= -ROOM)
    }

    /// What a neighbour leaves at a point, mm, and the move of it that leaves least.
    fn left(&self, neighbour: &Neighbour, point: Vector) -> Option<(f64, Sweep)> {
        let left = neighbour.sweeps.iter().map(|sweep| (sweep.distance(self.body, point), *sweep));
        left.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.segment.cmp(&b.1.segment)))
    }

    /// How far off the part the tool is where it passes a point nearest by, mm.
    fn floor(&self, sweep: &Sweep, point: Vector) -> Option<f64> {
        let prober = Prober { body: self.body, mesh: self.subject.mesh, bvh: self.subject.bvh };
        Some(prober.at(sweep.position_nearest(self.body, point), None)?.value)
    }
}

/// Whether what lies at a shift from a position passes it: across the two axes, along a pass and off the face. A pass at the
/// position itself lies off the part within the tolerance.
fn runs_by(shift: Vector, axes: [Vector; 2]) -> bool {
    let [aside, off] = axes.map(|axis| shift.dot(&axis).abs());
    aside.max(off) <= RUNS_BY * shift.norm() + ROUGH
}

/// The two passes between which a value lies, of those that run by, by value.
fn beside(around: &[(f64, Sweep)], value: f64) -> Option<[Neighbour; 2]> {
    let (smaller, larger) = around.split_at(around.partition_point(|(other, _)| *other <= value));
    let (low, high) = (smaller.last()?.0, larger.first()?.0);
    let same = ONE_PASS * (high - low);
    let one = |value: f64| {
        let sweeps = around.iter().filter(|(other, _)| (other - value).abs() <= same).map(|(_, sweep)| *sweep);
        Neighbour { value, sweeps: sweeps.collect() }
    };
    Some([one(low), one(high)])
}

//! Passes that are missing: places of the part that the tool could touch, and that neither the passes of their operation
//! nor the distance ordered between them explains.

use std::collections::BTreeMap;

use rayon::prelude::*;
use styluscam_motion::{Cancelled, Program, Watch};

use crate::body::Body;
use crate::clearance::Prober;
use crate::coverage::Sweeps;
use crate::findings::Fault;
use crate::legs::{Leg, LegKind};
use crate::orders::Orders;
use crate::probes::{self, Probe};
use crate::sweep::{Question, Stroke};
use crate::{FindingKind, Limits, Severity, Subject, Vector};

/// Points that are looked at for an operation.
const POINTS: usize = 20_000;
/// Points in a piece of work. Fixed, so that the result does not depend on the number of threads.
const CHUNK: usize = 256;
/// What may be left where passes lie a whole step away, as a share of what such a pass leaves on a plane: the part is curved.
const CURVED: f64 = 1.5;
/// The same where they lie half a step away: twice as far they leave four times as much.
const CURVED_AMIDST: f64 = 2.5;
/// What may be left besides, mm: triangles' corners.
const ROUGH: f64 = 0.01;
/// Where a tool that touches a triangle is in others by less than this, it can get there, mm.
const ROOM: f64 = 0.005;

/// A face goes on where the tool, moved along the plane that it touches, is as near to it as this, mm.
const TOUCH: f64 = 0.03;

/// Points at which it is asked how high the tool can touch.
const TOUCHING: usize = 2000;
/// Levels that differ by less are one, mm.
const SAME_LEVEL: f64 = 1e-3;
/// Levels may be this many steps apart: a short last step is joined to the one before it.
const WIDE: f64 = 1.3;
/// The last level may be this many steps above the lowest height at which the tool can touch.
const REST: f64 = 0.25;

/// How an operation's passes lie.
#[derive(Clone, Debug, PartialEq)]
pub struct Passes {
    /// What lies between them.
    pub spacing: Spacing,
    /// Lowest and highest tip that is asked for, mm.
    pub heights: [f64; 2],
    /// Which triangles they are for.
    pub wanted: Vec<bool>,
}

/// The distance between neighbouring passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spacing {
    /// In height, mm.
    Levels(f64),
    /// In plan, mm, across a direction, rad from X.
    Rows(f64, f64),
}

/// Faults in the order of the moves that lie beside the missing passes.
pub(crate) fn faults(
    program: &Program,
    legs: &[Leg],
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let orders = Orders::new(program, subject, limits);
    let mut worst: BTreeMap<usize, Fault> = BTreeMap::new();
    for order in subject.orders {
        let Some(passes) = &order.passes else { continue };
        let own = |leg: &Leg| orders.of(program.moves[leg.index].operation).is_some_and(|of| std::ptr::eq(of, order));
        if !legs.iter().any(|leg| leg.kind == LegKind::Contact && own(leg)) {
            continue;
        }
        let Some(tool) = subject.tools.get(order.tool) else { continue };
        let body = Body::new(tool, subject.sheet.as_ref());
        let looked = Look { subject, limits, passes, body: &body, sweeps: &Sweeps::of(legs, subject, own), legs };
        for fault in looked.faults(watch)?.into_iter().chain(looked.levels(own)) {
            let known = worst.entry(fault.index).or_insert(fault);
            if fault.weight > known.weight {
                *known = fault;
            }
        }
    }
    Ok(worst.into_values().collect())
}

/// One operation, looked at.
struct Look<'a> {
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    passes: &'a Passes,
    body: &'a Body,
    sweeps: &'a Sweeps,
    legs: &'a [Leg],
}

impl Look<'_> {
    /// Levels that are farther apart than ordered, or end too soon, while the tool could touch between or beyond.
    fn levels(&self, own: impl Fn(&Leg) -> bool) -> Vec<Fault> {
        let Spacing::Levels(step) = self.passes.spacing else { return Vec::new() };
        let level = |leg: &&Leg| leg.kind == LegKind::Contact && !leg.falls() && own(leg);
        let mut levels: Vec<&Leg> = self.legs.iter().filter(level).collect();
        levels.sort_by(|a, b| b.end[2].total_cmp(&a.end[2]).then(a.index.cmp(&b.index)));
        levels.dedup_by(|b, a| a.end[2] - b.end[2] <= SAME_LEVEL);
        let (Some(first), Some(last)) = (levels.first(), levels.last()) else { return Vec::new() };
        let heights = self.heights();
        let between = |low: f64, high: f64| heights.iter().any(|h| *h > low && *h < high);
        let gaps = levels.windows(2).filter_map(|pair| {
            let (high, low) = (pair[0].end[2], pair[1].end[2]);
            let inside = 0.3 * (high - low);
            (high - low > WIDE * step + ROUGH && between(low + inside, high - inside)).then(|| (pair[1], high - low))
        });
        let beyond = |leg: &'_ Leg, gap: f64, room: f64| {
            (gap > room * step + ROUGH).then_some((leg.index, leg.line, leg.end, gap))
        };
        let top = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max) - first.end[2];
        let bottom = last.end[2] - heights.iter().copied().fold(f64::INFINITY, f64::min);
        let gaps = gaps.map(|(leg, gap)| (leg.index, leg.line, leg.end, gap));
        let ends = [beyond(first, top, WIDE), beyond(last, bottom, REST)].into_iter().flatten();
        let fault = |(index, line, position, gap): (usize, u32, [f64; 3], f64)| Fault {
            kind: FindingKind::MissingLevel,
            severity: Severity::Warning,
            index,
            line,
            position,
            measure: Some((gap, step)),
            weight: gap,
        };
        gaps.chain(ends).map(fault).collect()
    }

    /// Heights at which the tool can touch.
    fn heights(&self) -> Vec<f64> {
        let wanted: Vec<usize> = (0..self.passes.wanted.len()).filter(|t| self.passes.wanted[*t]).collect();
        let [lowest, highest] = self.passes.heights;
        let touching = probes::spread(self.subject.mesh, &wanted, TOUCHING).into_par_iter().filter_map(|probe| {
            let position = probe.point - self.body.farthest(self.subject.mesh.normal(probe.triangle)).0;
            let height = self.body.tip(position)[2];
            (height >= lowest && height <= highest && self.clearance(position) >= -ROOM).then_some(height)
        });
        touching.collect()
    }

    fn faults(&self, watch: &Watch) -> Result<Vec<Fault>, Cancelled> {
        let wanted: Vec<usize> = (0..self.passes.wanted.len()).filter(|t| self.passes.wanted[*t]).collect();
        let probes = probes::spread(self.subject.mesh, &wanted, POINTS);
        watch.begin("missing passes", probes.len().div_ceil(CHUNK));
        let found: Result<Vec<Vec<Fault>>, Cancelled> = probes
            .par_chunks(CHUNK)
            .map(|chunk| {
                watch.advance(1)?;
                let mut last = None;
                Ok(chunk.iter().filter_map(|probe| self.fault(probe, &mut last)).collect())
            })
            .collect();
        Ok(found?.concat())
    }

    /// What is left at a point, if it is more than the distance between passes explains, and the tool can get there.
    fn fault(&self, probe: &Probe, last: &mut Option<(usize, crate::coverage::Sweep)>) -> Option<Fault> {
        let up = self.subject.mesh.normal(probe.triangle);
        let (witness, _) = self.body.farthest(up);
        let position = probe.point - witness;
        let tip = self.body.tip(position);
        let [lowest, highest] = self.passes.heights;
        if tip[2] < lowest || tip[2] > highest {
            return None;
        }
        let step = self.passes.spacing.along(up).filter(|step| 0.5 * step.norm() < self.body.radius())?;
        let left = self.sweeps.left(probe.point, last);
        let near = [position + 0.5 * step, position - 0.5 * step];
        if left <= CURVED_AMIDST * self.leaves(probe.point, near) || self.clearance(position) < -ROOM {
            return None;
        }
        // in the midst of a face a pass is half a step away at most, at its ends a whole one
        let explained = if near.into_iter().all(|place| self.goes_on(place)) {
            CURVED_AMIDST * self.leaves(probe.point, near)
        } else {
            CURVED * self.leaves(probe.point, [position + step, position - step])
        };
        let allowed = explained + ROUGH + self.limits.excess.unwrap_or(0.0) + self.subject.deviation_outward;
        if left <= allowed {
            return None;
        }
        let leg = &self.legs[last.as_ref()?.1.leg];
        Some(Fault {
            kind: FindingKind::MissingPass,
            severity: Severity::Warning,
            index: leg.index,
            line: leg.line,
            position: tip,
            measure: Some((left, allowed)),
            weight: left,
        })
    }

    /// What passes at these places leave at a point, mm.
    fn leaves(&self, point: Vector, places: [Vector; 2]) -> f64 {
        places.map(|place| self.body.distance(point - place).value).into_iter().fold(0.0, f64::max)
    }

    /// Whether the tool touches the part at a place that is asked for.
    fn goes_on(&self, position: Vector) -> bool {
        let [lowest, highest] = self.passes.heights;
        let height = self.body.tip(position)[2];
        height >= lowest && height <= highest && self.clearance(position).abs() <= TOUCH
    }

    fn clearance(&self, position: Vector) -> f64 {
        let prober = Prober { body: self.body, mesh: self.subject.mesh, bvh: self.subject.bvh };
        let places = [Some(position), None];
        let question = Question { stroke: Stroke::still(position), places, below: f64::NEG_INFINITY };
        prober.survey(question, None).places[0].map_or(f64::INFINITY, |touch| touch.value)
    }
}

impl Spacing {
    /// The way on a plane of this normal from a pass to the next; none where that is beyond all measure.
    fn along(self, up: Vector) -> Option<Vector> {
        let steep = (up.x * up.x + up.y * up.y).sqrt();
        match self {
            Self::Levels(step) if steep > 1e-6 => {
                let (run, rise) = (step * up.z / (steep * steep), -step);
                Some(Vector::new(run * up.x, run * up.y, rise))
            }
            Self::Rows(spacing, angle) if up.z > 1e-6 => {
                let (sin, cos) = libm::sincos(angle);
                let (x, y) = (-sin * spacing, cos * spacing);
                Some(Vector::new(x, y, -(up.x * x + up.y * y) / up.z))
            }
            _ => None,
        }
    }
}

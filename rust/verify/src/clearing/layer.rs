//! One layer of stock: the moves in it, and what they engage.

use std::f64::consts::PI;

use styluscam_geometry::PlanePiece;
use styluscam_motion::{Cancelled, Watch};

use crate::engagement::{engagement, Cleared, EngagementError, Ground, PlaneRun, PlaneRunKind, Swept};
use crate::expectation::{Clearing, ExpectedOperation};
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::subject::Subject;
use crate::tolerances::{SAME_LEVEL, SLACK};

/// What the angle may exceed the bound by, rad (half a degree): planning's own account of the material is good to a twentieth.
const ALLOWED: f64 = 0.5 * PI / 180.0;
/// An angle from which on a move cuts, rad: of a disc that grazes stock within a hundredth of its radius.
const CUTS: f64 = 0.14;
/// By how much an entry may be steeper than asked, as a share: its ends are rounded.
const STEEP: f64 = 0.05;

/// Stock between two heights, and what clears it.
pub(super) struct Layer<'a> {
    /// mm.
    pub top: f64,
    /// Height of the tip, mm.
    pub floor: f64,
    /// The tool's radius at the layer's top, mm.
    pub radius: f64,
    /// Thickness of chips that count, mm.
    pub chip: f64,
    /// What was swept in it before.
    pub cleared: &'a [Swept],
    pub gone: &'a Cleared,
    pub clearing: &'a Clearing,
    pub operation: &'a ExpectedOperation,
}

/// What a move does in a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Doing {
    /// Level, or up.
    Runs,
    /// Down at a feed.
    Enters,
    /// A rapid.
    Rapid,
}

impl Layer<'_> {
    /// Looks at the moves of its operation that lie in the layer; what they sweep.
    pub fn judged(
        &self,
        own: &[&Segment],
        subject: &Subject,
        watch: &Watch,
        faults: &mut Vec<Fault>,
    ) -> Result<Vec<PlanePiece>, Cancelled> {
        let inside: Vec<(&Segment, Doing)> =
            own.iter().filter_map(|segment| Some((*segment, self.doing(segment)?))).collect();
        let runs: Vec<PlaneRun> = inside.iter().map(|(segment, doing)| run(segment, *doing)).collect();
        let stock = self.stock(subject);
        let ground =
            Ground { radius: self.radius, stock: &stock, pocket: &stock, cleared: self.cleared, chip: self.chip };
        let found = match engagement(&runs, &ground, watch) {
            Ok(found) => found,
            Err(EngagementError::Cancelled) => return Err(Cancelled),
            // a tool without a radius at the layer's top cuts nothing there
            Err(EngagementError::Number { .. } | EngagementError::Outline { .. }) => return Ok(Vec::new()),
        };
        for ((segment, doing), along) in inside.iter().zip(&found) {
            let Some(worst) = along.measures.iter().max_by(|a, b| a.angle.total_cmp(&b.angle)) else { continue };
            let at = |fault: Fault| Fault { position: [worst.at[0], worst.at[1], segment.end[2]], ..fault };
            faults.extend(self.fault(segment, *doing, worst.angle).map(at));
        }
        Ok(runs.iter().flat_map(swept).collect())
    }

    /// The outlines of the stock: of the box, and of the hole in it.
    fn stock(&self, subject: &Subject) -> Vec<Vec<[f64; 3]>> {
        let (low, high) = subject.mesh.bounds();
        let around = vec![[low.x, low.y, 0.0], [high.x, low.y, 0.0], [high.x, high.y, 0.0], [low.x, high.y, 0.0]];
        let hole = self.clearing.hole.map(|([x, y], radius)| vec![[x + radius, y, 1.0], [x - radius, y, 1.0]]);
        std::iter::once(around).chain(hole).collect()
    }

    /// Whether a point lies in the stock.
    pub fn is_stock(&self, [x, y]: [f64; 2], subject: &Subject) -> bool {
        let (low, high) = subject.mesh.bounds();
        let is_drilled = |([u, v], radius): ([f64; 2], f64)| libm::hypot(x - u, y - v) < radius;
        let is_in_box = (low.x..=high.x).contains(&x) && (low.y..=high.y).contains(&y);
        is_in_box && !self.clearing.hole.is_some_and(is_drilled) && !self.gone.holds([x, y])
    }

    fn fault(&self, segment: &Segment, doing: Doing, angle: f64) -> Option<Fault> {
        let degrees = angle.to_degrees();
        match doing {
            Doing::Rapid => (angle > CUTS).then(|| segment.fault(&faults::RAPID_IN_STOCK).measured(degrees, 0.0)),
            Doing::Runs => {
                let bound = self.clearing.angle;
                let over = angle > bound + ALLOWED;
                over.then(|| segment.fault(&faults::ENGAGEMENT).measured(degrees, bound.to_degrees()))
            }
            Doing::Enters => {
                let start = segment.start?;
                let fall = start[2] - segment.end[2];
                let along = ((segment.length() - fall) * (segment.length() + fall)).max(0.0).sqrt();
                let (found, most) = (libm::atan2(fall, along), libm::atan(self.clearing.entry_slope));
                let is_steep = fall > (1.0 + STEEP) * self.clearing.entry_slope * along + SAME_LEVEL;
                let fault = || segment.fault(&faults::STEEP_ENTRY).measured(found.to_degrees(), most.to_degrees());
                (angle > CUTS && is_steep).then(fault)
            }
        }
    }

    /// What a move does in the layer; none where it is not in it, or goes straight up.
    fn doing(&self, segment: &Segment) -> Option<Doing> {
        let lowest = segment.lowest();
        let is_inside = lowest < self.top - SLACK && lowest > self.floor - SAME_LEVEL;
        let start = segment.start.filter(|_| is_inside)?;
        let goes_up = !segment.travels() && segment.end[2] >= start[2];
        let falls = segment.descends() && start[2] > self.floor + SAME_LEVEL;
        match segment.kind {
            _ if goes_up => None,
            SegmentKind::Rapid => Some(Doing::Rapid),
            SegmentKind::Plunge => Some(Doing::Enters),
            SegmentKind::Lateral if falls => Some(Doing::Enters),
            SegmentKind::Lateral | SegmentKind::Retract | SegmentKind::Still => Some(Doing::Runs),
        }
    }
}

/// A move seen from above.
fn run(segment: &Segment, doing: Doing) -> PlaneRun {
    let start = segment.start.unwrap_or(segment.end);
    let mut points = vec![[start[0], start[1], 0.0]];
    for piece in segment.pieces() {
        if let Some(last) = points.last_mut() {
            last[2] = piece.bend.map_or(0.0, |bend| bend.bulge());
        }
        points.push([piece.end[0], piece.end[1], 0.0]);
    }
    if !segment.travels() {
        points.truncate(1);
    }
    let kind = match doing {
        Doing::Enters => PlaneRunKind::Entry,
        Doing::Runs | Doing::Rapid => PlaneRunKind::Cut,
    };
    PlaneRun { points, kind }
}

/// What the centre passes on a run.
fn swept(run: &PlaneRun) -> Vec<PlanePiece> {
    let pieces = PlanePiece::path(&run.points);
    if pieces.is_empty() {
        let point = run.points.first().map(|[x, y, _]| PlanePiece::new([*x, *y], [*x, *y], 0.0));
        return point.into_iter().collect();
    }
    pieces
}

//! One layer of stock: the moves in it, and what they engage.

use std::f64::consts::{PI, SQRT_2};

use styluscam_geometry::{circle_outline, PlanePiece, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::before::Took;
use super::own::Own;
use crate::engagement::{
    engagement, Area, Engaged, EngagementError, Ground, PlaneRun, PlaneRunKind, RunEngagement, Sweeps, Swept,
};
use crate::expectation::{ClearedHole, Clearing, ExpectedOperation};
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::tolerances::{SAME_LEVEL, SLACK};

/// What the angle may exceed the bound by, rad (half a degree): planning's own account of the material is good to a twentieth.
const ALLOWED: f64 = 0.5 * PI / 180.0;
/// An angle from which on a move cuts, rad: of a disc that grazes stock within a hundredth of its radius.
const CUTS: f64 = 0.14;
/// The same of a move under a layer, whose walls need not be that exactly below each other, and of one with the feed of links: of a disc that
/// grazes stock within a fiftieth.
const GRAZES: f64 = 0.4;
/// By how much the rate at which stock is removed may be larger than it may, as a share: feeds and positions are rounded.
const ROUNDED: f64 = 0.01;
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
    /// What the text's last decimal counts, mm.
    pub unit: f64,
    /// Thickness of chips that count, mm.
    pub chip: f64,
    /// What rapids have to keep over what stands, mm.
    pub gap: f64,
    /// The outlines of what is cut.
    pub stock: &'a [Vec<[f64; 3]>],
    /// Corners of the box of all that is cut, not only in the layer.
    pub bounds: (Vector, Vector),
    /// Where that is, under the layer's top.
    pub area: &'a Area,
    /// What was swept in it before.
    pub cleared: &'a [Swept],
    pub gone: &'a Sweeps,
    /// What took of the stock before its operation.
    pub before: &'a Took<'a>,
    pub clearing: &'a Clearing,
    pub operation: &'a ExpectedOperation,
}

/// What a move does in a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Doing {
    /// Level, or up.
    Runs,
    /// As that, and cuts nothing.
    Links,
    /// Down at a feed.
    Enters,
    /// A rapid.
    Rapid,
    /// It goes on below the layer.
    Below,
}

/// A move in a layer, or below it, as it is seen just under the layer's top.
pub(super) struct Inside<'a> {
    pub own: &'a Own<'a>,
    pub doing: Doing,
    run: PlaneRun,
    pub measures: Vec<Engaged>,
}

impl Inside<'_> {
    /// What the tool's centre passes.
    pub fn centres(&self) -> Vec<PlanePiece> {
        centres(&self.run)
    }
}

impl Layer<'_> {
    /// Looks at what was measured on the moves of its operation; what they sweep.
    pub fn judged(
        &self,
        inside: &[Inside],
        watch: &Watch,
        faults: &mut Vec<Fault>,
    ) -> Result<Vec<PlanePiece>, Cancelled> {
        for found in inside {
            faults.extend(self.fault(found.own, found.doing, &found.measures));
            faults.extend(self.too_fast(found));
        }
        self.without_stock(inside, watch, faults)?;
        let swept = inside.iter().filter(|found| matches!(found.doing, Doing::Runs | Doing::Enters));
        Ok(swept.flat_map(Inside::centres).collect())
    }

    /// Height of the floor, lowered by what is to stay on it, mm.
    pub fn lowered(&self) -> f64 {
        self.floor - self.clearing.left[1]
    }

    /// What the moves of its operation that lie in the layer, or below it, engage just under its top.
    pub fn measured<'a>(&self, own: &'a [Own<'a>], watch: &Watch) -> Result<Vec<Inside<'a>>, Cancelled> {
        let inside: Vec<(&Own, Doing)> = own.iter().filter_map(|own| Some((own, self.doing(own)?))).collect();
        let under_top = |(own, doing): &(&Own, Doing)| match doing {
            Doing::Below | Doing::Rapid => run(own.segment, PlaneRunKind::Probed),
            Doing::Enters => run(own.segment, PlaneRunKind::Entry),
            Doing::Runs | Doing::Links => run(own.segment, PlaneRunKind::Cut),
        };
        let runs: Vec<PlaneRun> = inside.iter().map(under_top).collect();
        let found = self.engagement(&runs, watch)?.unwrap_or_default();
        let moves = inside.into_iter().zip(runs).zip(found);
        Ok(moves.map(|(((own, doing), run), along)| Inside { own, doing, run, measures: along.measures }).collect())
    }

    /// Looks at moves down that are steeper than asked, at links and at rapids: at what stands on the floor, of which ways into the
    /// material leave some all along.
    fn without_stock(&self, inside: &[Inside], watch: &Watch, faults: &mut Vec<Fault>) -> Result<(), Cancelled> {
        let on_floor = inside.iter().filter_map(|Inside { own, doing, .. }| {
            let kind = match doing {
                Doing::Runs if own.segment.lowest() < self.floor + SAME_LEVEL => PlaneRunKind::Swept,
                Doing::Rapid | Doing::Links => PlaneRunKind::Probed,
                Doing::Enters if self.is_steep(own.segment) => PlaneRunKind::Probed,
                Doing::Runs | Doing::Enters | Doing::Below => return None,
            };
            Some((*own, *doing, run(own.segment, kind)))
        });
        let on_floor: Vec<(&Own, Doing, PlaneRun)> = on_floor.collect();
        let runs: Vec<PlaneRun> = on_floor.iter().map(|(_, _, run)| run.clone()).collect();
        let Some(found) = self.engagement(&runs, watch)? else { return Ok(()) };
        for (number, ((own, doing, _), along)) in on_floor.iter().zip(&found).enumerate() {
            let Some(worst) = worst(&along.measures).filter(|worst| worst.angle > CUTS) else { continue };
            if !self.stands_over(own, runs.get(..=number).unwrap_or_default(), watch)? {
                continue;
            }
            let fault = match doing {
                Doing::Rapid => own.segment.fault(&faults::RAPID_IN_STOCK).measured(worst.angle.to_degrees(), 0.0),
                Doing::Links => own.segment.fault(&faults::LINK_IN_STOCK).measured(worst.angle.to_degrees(), 0.0),
                Doing::Runs | Doing::Enters | Doing::Below => {
                    let [found, most] =
                        [slope(own.segment), libm::atan(self.clearing.entry_slope)].map(f64::to_degrees);
                    own.segment.fault(&faults::STEEP_ENTRY).measured(found, most)
                }
            };
            faults.push(Fault { position: [worst.at[0], worst.at[1], own.segment.end[2]], ..fault });
        }
        Ok(())
    }

    /// Whether the last of some runs, that of a move which ends above the floor, meets what the operations before left over its end: they may have
    /// been there on levels that this one has not.
    fn stands_over(&self, own: &Own, runs: &[PlaneRun], watch: &Watch) -> Result<bool, Cancelled> {
        let end = own.segment.lowest() - self.gap_of(own);
        if end <= self.floor + SAME_LEVEL || self.before.is_empty() {
            return Ok(true);
        }
        let cleared = self.before.cleared([self.top, end]);
        let found = self.engagement_in(runs, &cleared, watch)?.unwrap_or_default();
        Ok(found.last().and_then(|along| worst(&along.measures)).is_none_or(|worst| worst.angle > CUTS))
    }

    /// What runs engage; none of a tool without a radius at the layer's top, which cuts nothing there.
    fn engagement(&self, runs: &[PlaneRun], watch: &Watch) -> Result<Option<Vec<RunEngagement>>, Cancelled> {
        self.engagement_in(runs, self.cleared, watch)
    }

    fn engagement_in(
        &self,
        runs: &[PlaneRun],
        cleared: &[Swept],
        watch: &Watch,
    ) -> Result<Option<Vec<RunEngagement>>, Cancelled> {
        let stock = self.stock();
        let ground = Ground { radius: self.radius, stock: &stock, pocket: &stock, cleared, chip: self.chip };
        match engagement(runs, &ground, watch) {
            Ok(found) => Ok(Some(found)),
            Err(EngagementError::Cancelled) => Err(Cancelled),
            Err(EngagementError::Number { .. } | EngagementError::Outline { .. }) => Ok(None),
        }
    }

    /// The outlines of the stock, and of the hole in it.
    fn stock(&self) -> Vec<Vec<[f64; 3]>> {
        let hole = self.clearing.hole.filter(|hole| self.area.holds(hole.at));
        let hole = hole.map(|hole| circle_outline(hole.at, hole.radius));
        self.stock.iter().cloned().chain(hole).collect()
    }

    /// Whether a point lies in the stock.
    pub fn is_stock(&self, [x, y]: [f64; 2]) -> bool {
        let is_drilled = |hole: ClearedHole| libm::hypot(x - hole.at[0], y - hole.at[1]) < hole.radius;
        self.area.holds([x, y]) && !self.clearing.hole.is_some_and(is_drilled) && !self.gone.holds([x, y])
    }

    fn fault(&self, own: &Own, doing: Doing, measures: &[Engaged]) -> Option<Fault> {
        let segment = own.segment;
        let worst = worst(measures)?;
        let (angle, bound) = (worst.angle, self.clearing.angle);
        let degrees = angle.to_degrees();
        let least = angle - self.heading_error(segment);
        let found = match doing {
            Doing::Rapid | Doing::Enters => None,
            Doing::Below if segment.kind == SegmentKind::Rapid => {
                (angle > CUTS).then(|| segment.fault(&faults::RAPID_IN_STOCK).measured(degrees, 0.0))
            }
            Doing::Below => (angle > GRAZES).then(|| segment.fault(&faults::UNDER_STOCK).measured(degrees, 0.0)),
            Doing::Runs | Doing::Links if least > bound + ALLOWED => {
                Some(segment.fault(&faults::ENGAGEMENT).measured(least.to_degrees(), bound.to_degrees()))
            }
            Doing::Runs | Doing::Links => return self.removal(own, measures),
        };
        let at = |fault: Fault| Fault { position: [worst.at[0], worst.at[1], segment.end[2]], ..fault };
        found.map(at)
    }

    /// A move that cuts, and does not graze, faster than any that is asked for: the feed of links is for what cuts nothing.
    fn too_fast(&self, Inside { own, doing, measures, .. }: &Inside) -> Option<Fault> {
        let operation = self.operation;
        let most = match doing {
            Doing::Runs | Doing::Links => operation.highest.unwrap_or(operation.cut),
            Doing::Enters => operation.cut.max(operation.plunge).max(self.clearing.entry_feed.unwrap_or(0.0)),
            Doing::Rapid | Doing::Below => return None,
        };
        let cuts = worst(measures).is_some_and(|worst| worst.angle > GRAZES);
        let feed = own.feed.filter(|feed| cuts && *feed > (1.0 + ROUNDED) * most)?;
        Some(own.segment.fault(&faults::FEED).measured(feed, most))
    }

    /// More stock removed in a minute than by a straight pass at the largest angle: in the layer, of even depth, more area.
    fn removal(&self, own: &Own, measures: &[Engaged]) -> Option<Fault> {
        let widest = measures.iter().max_by(|a, b| a.width.total_cmp(&b.width))?;
        let (bound, cut, feed) = (self.clearing.angle, self.operation.cut, own.feed?);
        let width = widest.width - self.radius * self.heading_error(own.segment);
        let is_over = feed * width > (1.0 + ROUNDED) * cut * self.full(bound + ALLOWED);
        let most = cut * self.full(bound) / widest.width;
        let fault = || own.segment.fault(&faults::REMOVAL_RATE).measured(feed, most);
        is_over.then(|| Fault { position: [widest.at[0], widest.at[1], own.segment.end[2]], ..fault() })
    }

    /// The stepover of a straight pass at an engagement angle, mm.
    pub fn full(&self, angle: f64) -> f64 {
        self.radius * (1.0 - libm::cos(angle))
    }

    /// By how much the heading of a move may be off, rad, as its ends, and of an arc the centre, are rounded to half a unit along both axes. The
    /// engagement angle changes by no more than that, the stepover by no more than the radius times that.
    pub fn heading_error(&self, segment: &Segment) -> f64 {
        let length = segment.bend.map_or(segment.length(), |bend| bend.radius().min(segment.length()));
        (SQRT_2 * self.unit / length).min(1.0)
    }

    /// What a move does in the layer; none where it is not in it, or goes straight up.
    fn doing(&self, own: &Own) -> Option<Doing> {
        let segment = own.segment;
        let lowest = segment.lowest() - self.gap_of(own);
        // a height that is rounded to the top of the layer is not in it
        let start = segment.start.filter(|_| lowest < self.top - SLACK.max(0.5 * self.unit))?;
        let falls = own.descends && start[2] > self.floor + SAME_LEVEL;
        match segment.kind {
            _ if segment.goes_straight_up() => None,
            _ if lowest <= self.floor - SAME_LEVEL => Some(Doing::Below),
            SegmentKind::Rapid => Some(Doing::Rapid),
            SegmentKind::Plunge => Some(Doing::Enters),
            SegmentKind::Lateral if falls => Some(Doing::Enters),
            SegmentKind::Lateral | SegmentKind::Retract | SegmentKind::Still if own.is_link => Some(Doing::Links),
            SegmentKind::Lateral | SegmentKind::Retract | SegmentKind::Still => Some(Doing::Runs),
        }
    }

    /// What a move has to keep over what stands, mm.
    fn gap_of(&self, own: &Own) -> f64 {
        match own.segment.kind {
            SegmentKind::Rapid => self.gap,
            SegmentKind::Plunge | SegmentKind::Lateral | SegmentKind::Retract | SegmentKind::Still => 0.0,
        }
    }

    /// Whether a move down is steeper than an entry is to be.
    fn is_steep(&self, segment: &Segment) -> bool {
        let (fall, along) = fall(segment);
        fall > (1.0 + STEEP) * self.clearing.entry_slope * along + SAME_LEVEL
    }
}

/// How far a move goes down, and along, mm.
fn fall(segment: &Segment) -> (f64, f64) {
    let fall = segment.start.map_or(0.0, |start| start[2] - segment.end[2]);
    (fall, ((segment.length() - fall) * (segment.length() + fall)).max(0.0).sqrt())
}

/// The angle at which a move goes down, rad.
fn slope(segment: &Segment) -> f64 {
    let (fall, along) = fall(segment);
    libm::atan2(fall, along)
}

fn worst(measures: &[Engaged]) -> Option<&Engaged> {
    measures.iter().max_by(|a, b| a.angle.total_cmp(&b.angle))
}

/// A move seen from above.
fn run(segment: &Segment, kind: PlaneRunKind) -> PlaneRun {
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
    PlaneRun { points, kind }
}

/// What the centre passes on a run.
fn centres(run: &PlaneRun) -> Vec<PlanePiece> {
    let pieces = PlanePiece::path(&run.points);
    if pieces.is_empty() {
        let point = run.points.first().map(|[x, y, _]| PlanePiece::new([*x, *y], [*x, *y], 0.0));
        return point.into_iter().collect();
    }
    pieces
}

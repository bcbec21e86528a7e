//! Along the path, a step at a time: what is swept so far, and what the rim meets of the rest.

use std::collections::VecDeque;
use std::f64::consts::{FRAC_PI_2, TAU};

use styluscam_geometry::{PlanePiece, PlanePoint};
use styluscam_motion::Watch;

use super::area::Area;
use super::error::EngagementError;
use super::open::Open;
use super::rim::Rim;
use super::runs::{Engaged, Ground, PlaneRun, PlaneRunKind, RunEngagement, PROBE, RECENT, STEP};
use super::sweeps::{Search, Sweeps};

/// Ends of runs that lie nearer than this are one position, mm.
const SAME: f64 = 1e-6;
/// Recent discs are larger than the tool by this, mm: a rim on the edge of one, where the tool has come back to a position, cuts nothing.
/// It takes some millionths of a radian off the chip of a step.
const COINCIDES: f64 = 1e-7;
/// Turns above this are corners of the path, rad.
const CORNER: f64 = 0.01;
/// Circles on which it is looked for what stands under a tool that goes straight down.
const RINGS: u32 = 8;
/// The watch is asked after so many positions.
const ASKED: usize = 256;

/// A tool on its way.
pub struct Walk {
    radius: f64,
    chip: f64,
    stock: Area,
    pocket: Area,
    swept: Sweeps,
    /// What was swept before the path.
    cleared: Sweeps,
    /// Pieces that are recent still, with the length of the path up to their end.
    pending: VecDeque<(PlanePiece, f64)>,
    /// Length of the path so far, mm.
    travelled: f64,
    /// Length of the path up to which all is swept, mm.
    behind: f64,
    open: Open,
    scratch: Vec<f64>,
    /// In the one and in the other.
    searches: [Search; 2],
}

impl Walk {
    pub fn new(ground: &Ground<'_>) -> Self {
        let radius = ground.radius;
        Self {
            radius,
            chip: ground.chip,
            stock: Area::new(ground.stock, 2.0 * radius),
            pocket: Area::new(ground.pocket, 2.0 * radius),
            swept: Sweeps::new(radius),
            cleared: Sweeps::along(ground.cleared, ground.chip, radius),
            pending: VecDeque::new(),
            travelled: 0.0,
            behind: 0.0,
            open: Open::default(),
            scratch: Vec::new(),
            searches: Default::default(),
        }
    }

    /// The engagement along every run.
    pub fn along(&mut self, runs: &[PlaneRun], watch: &Watch) -> Result<Vec<RunEngagement>, EngagementError> {
        watch.begin("measuring the engagement", runs.len());
        let mut last: Option<PlanePoint> = None;
        let mut found = Vec::with_capacity(runs.len());
        for run in runs {
            let pieces = PlanePiece::path(&run.points);
            let (Some(start), Some(end)) = (run.points.first(), run.points.last()) else {
                found.push(RunEngagement::default());
                continue;
            };
            let from = [start[0], start[1]];
            let before = last.take();
            match run.kind {
                PlaneRunKind::Rapid => found.push(RunEngagement::default()),
                PlaneRunKind::Swept => {
                    self.sweep(&pieces, from);
                    found.push(RunEngagement::default());
                }
                PlaneRunKind::Probed => found.push(self.probed(&pieces, from)),
                PlaneRunKind::Cut | PlaneRunKind::Entry | PlaneRunKind::Link => {
                    let goes_on = before.is_some_and(|[x, y]| libm::hypot(start[0] - x, start[1] - y) < SAME);
                    if !goes_on {
                        self.commit(f64::INFINITY);
                    }
                    found.push(self.run(&pieces, from, goes_on, watch)?);
                    last = Some([end[0], end[1]]);
                }
            }
            watch.advance(1)?;
        }
        Ok(found)
    }

    /// Clears along a run.
    fn sweep(&mut self, pieces: &[PlanePiece], start: PlanePoint) {
        let still = [PlanePiece::new(start, start, 0.0)];
        for piece in if pieces.is_empty() { &still } else { pieces } {
            self.pending.push_back((*piece, self.travelled));
        }
        self.commit(f64::INFINITY);
    }

    /// What the tool meets all around along a run that clears nothing.
    fn probed(&mut self, pieces: &[PlanePiece], start: PlanePoint) -> RunEngagement {
        self.commit(f64::INFINITY);
        let mut travelled = 0.0;
        let mut positions = vec![(start, 0.0)];
        for piece in pieces {
            let length = piece.length();
            let parts = libm::ceil(length / (PROBE * self.radius)).max(1.0) as usize;
            let shares = (1..=parts).map(|part| part as f64 / parts as f64);
            positions.extend(shares.map(|share| (piece.at(share), travelled + share * length)));
            travelled += length;
        }
        let measures = positions.into_iter().map(|(at, travelled)| {
            self.open.all();
            self.measure(at, travelled, None)
        });
        let mut measures: Vec<Engaged> = measures.collect();
        if pieces.is_empty() {
            measures.extend(self.under(start));
        }
        RunEngagement { measures }
    }

    /// What a tool that goes straight down meets of stock that its rim surrounds.
    fn under(&mut self, at: PlanePoint) -> Vec<Engaged> {
        let rings = (1..RINGS).map(|ring| {
            self.open.all();
            self.keep_standing(&Rim { centre: at, radius: self.radius * f64::from(ring) / f64::from(RINGS) });
            self.engaged(at, 0.0, None)
        });
        rings.collect()
    }

    fn run(
        &mut self,
        pieces: &[PlanePiece],
        start: PlanePoint,
        goes_on: bool,
        watch: &Watch,
    ) -> Result<RunEngagement, EngagementError> {
        let step = STEP * self.radius;
        let (begin, mut measures) = (self.travelled, Vec::new());
        if !goes_on {
            // the tool comes down here: what it meets is what it meets all around
            self.open.all();
            measures.push(self.measure(start, 0.0, None));
            self.pending.push_back((PlanePiece::new(start, start, 0.0), begin));
        }
        let mut next = begin + step;
        let mut before: Option<f64> = None;
        for piece in pieces {
            let length = piece.length();
            if length <= 0.0 {
                continue;
            }
            let from = self.travelled;
            if let Some(before) = before.filter(|before| turned(*before, heading(piece, 0.0)) > CORNER) {
                // the angle may be largest at the corner itself, with the one heading or the other
                measures.push(self.facing(piece.start, before, from, begin));
                measures.push(self.facing(piece.start, heading(piece, 0.0), from, begin));
            }
            before = Some(heading(piece, 1.0));
            self.travelled += length;
            self.pending.push_back((*piece, self.travelled));
            while next <= self.travelled {
                let share = (next - from) / length;
                measures.push(self.facing(piece.at(share), heading(piece, share), next, begin));
                next += step;
                if measures.len() % ASKED == 0 {
                    watch.advance(0)?;
                }
            }
        }
        if let (Some(piece), true) = (pieces.last(), self.travelled > next - step) {
            measures.push(self.facing(piece.end, heading(piece, 1.0), self.travelled, begin));
        }
        Ok(RunEngagement { measures })
    }

    /// The engagement at a position with a heading, after a length of the path.
    fn facing(&mut self, at: PlanePoint, heading: f64, length: f64, begin: f64) -> Engaged {
        self.behind = length - STEP * self.radius;
        self.commit(length - RECENT * self.radius);
        self.open.ahead(heading);
        self.measure(at, length - begin, Some(heading))
    }

    /// Lists what ends before a length of the path: it is no longer recent.
    fn commit(&mut self, length: f64) {
        while let Some((piece, end)) = self.pending.front().copied() {
            if end > length {
                break;
            }
            self.swept.insert(&piece, self.radius + self.chip);
            self.pending.pop_front();
        }
    }

    /// The engagement of the open directions with the tool's centre at a point.
    fn measure(&mut self, at: PlanePoint, travelled: f64, heading: Option<f64>) -> Engaged {
        self.keep_standing(&Rim { centre: at, radius: self.radius });
        self.engaged(at, travelled, heading)
    }

    /// Keeps of the open directions those in which stock stands on a circle.
    fn keep_standing(&mut self, rim: &Rim) {
        let recent = self.radius + COINCIDES;
        let scratch = &mut self.scratch;
        // first what leaves least to look at: in most places the stock's outlines
        for area in [&self.pocket, &self.stock] {
            if !self.open.is_empty() {
                self.open.keep(|interval, left| area.within(rim, interval, scratch, left));
            }
        }
        for (piece, end) in self.pending.iter().rev() {
            let length = piece.length();
            if end - length > self.behind || (length <= 0.0 && *end > self.behind) {
                continue;
            }
            let swept = if *end > self.behind { piece.up_to(1.0 - (end - self.behind) / length) } else { *piece };
            self.open.keep(|interval, left| rim.outside_sweep(interval, &swept, recent, scratch, left));
        }
        for (swept, search) in [&self.swept, &self.cleared].into_iter().zip(&mut self.searches) {
            self.open.keep(|interval, left| swept.outside(rim, interval, search, left));
        }
    }

    /// What stands in the open directions.
    fn engaged(&self, at: PlanePoint, travelled: f64, heading: Option<f64>) -> Engaged {
        let width = heading.map_or(0.0, |heading| self.open.width(heading, self.radius));
        Engaged { at, travelled, angle: self.open.total(), width, clearance: self.pocket.clearance(at) }
    }
}

/// Angle between two headings, rad.
fn turned(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(TAU);
    turn.min(TAU - turn)
}

/// Direction of travel at a share of a piece, rad.
fn heading(piece: &PlanePiece, share: f64) -> f64 {
    match &piece.circle {
        Some(circle) => circle.from + share * circle.turn + FRAC_PI_2.copysign(circle.turn),
        None => libm::atan2(piece.end[1] - piece.start[1], piece.end[0] - piece.start[0]),
    }
}

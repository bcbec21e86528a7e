//! Stock that stands where a tool comes: that of the job, without what moves before have swept as low as a plane.

use rstar::primitives::{GeomWithData, Line};
use rstar::{PointDistance, RTree};
use styluscam_geometry::{Cutter, Tool};

use crate::before::Stretch;
use crate::earlier::{plan_chords, stretches};
use crate::engagement::Area;
use crate::segments::Segment;
use crate::subject::Subject;

/// Stock that reaches no farther into a tool's section from its rim is a skin that is left on walls, mm.
const SKIN: f64 = 0.5;
/// But no more than this share of the section's radius.
const SHARE: f64 = 0.25;
/// Positions along a move are so far apart at most, in radii of the tool.
const APART: f64 = 0.25;
/// Positions along a move at most.
const MOST: f64 = 4096.0;
/// Points on a circle about such a position.
const AROUND: u32 = 16;
/// Largest distance of chords from arcs, mm.
const SAG: f64 = 1e-3;
/// Cells in which outlines are listed are as large as this at least, mm.
const LEAST_CELL: f64 = 1.0;

/// A path of a tool in plan: by which move, none of programs before, and how much of the plane it sweeps to both sides, mm.
type Sweep = GeomWithData<Line<[f64; 2]>, (Option<usize>, f64)>;

/// What stands above a plane.
pub(crate) struct Standing {
    /// Its height, mm.
    plane: f64,
    area: Area,
    sweeps: RTree<Sweep>,
    /// The widest of the sweeps, mm.
    widest: f64,
}

impl Standing {
    /// Above a plane, without what some moves and the programs before sweep of it; none where the stock does not reach it.
    pub fn above<'s>(plane: f64, moves: impl Iterator<Item = &'s Segment>, subject: &Subject) -> Option<Self> {
        let stock = subject.stock?;
        let outlines = stock.outlines_between([stock.top, plane]);
        if outlines.is_empty() {
            return None;
        }
        let cutters: Vec<Cutter> = subject.tools.iter().map(Tool::cutter).collect();
        let own = moves.flat_map(|segment| stretches(segment).map(|stretch| (Some(segment.index), stretch)));
        let mut all: Vec<Sweep> = own.flat_map(|(index, stretch)| sweeps(index, &stretch, &cutters, plane)).collect();
        if let Some(before) = subject.before {
            let cutters: Vec<Cutter> = before.tools.iter().map(Tool::cutter).collect();
            all.extend(before.stretches.iter().flat_map(|stretch| sweeps(None, stretch, &cutters, plane)));
        }
        let widest = all.iter().fold(0.0, |widest: f64, sweep| widest.max(sweep.data.1));
        let (low, high) = stock.bounds();
        let reach = (0.05 * (high - low).xy().norm()).max(LEAST_CELL);
        Some(Self { plane, area: Area::new(&outlines, reach), sweeps: RTree::bulk_load(all), widest })
    }

    /// The first position on a move at which its tool is in what the moves before it leave.
    pub fn first_in(&self, segment: &Segment, cutter: &Cutter) -> Option<[f64; 3]> {
        if segment.lowest() >= self.plane {
            return None;
        }
        let count = (segment.length() / (APART * cutter.max_radius())).ceil().clamp(1.0, MOST);
        let mut tips = (0..=count as u32).map(|i| segment.at(f64::from(i) / count));
        tips.find(|tip| self.is_in(*tip, cutter, segment.index))
    }

    /// Whether the section of a tool in the plane is in stock.
    fn is_in(&self, [x, y, z]: [f64; 3], cutter: &Cutter, before: usize) -> bool {
        if z >= self.plane {
            return false;
        }
        let section = cutter.at_height(self.plane - z).0;
        let radius = section - SKIN.min(SHARE * section);
        if self.is_swept([x, y], radius, before) {
            return false; // all of it by one move
        }
        let on_circle = |radius: f64| {
            (0..AROUND).any(|i| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / f64::from(AROUND));
                self.stands([x + radius * cos, y + radius * sin], before)
            })
        };
        self.stands([x, y], before) || on_circle(0.5 * radius) || on_circle(radius)
    }

    fn stands(&self, point: [f64; 2], before: usize) -> bool {
        self.area.holds(point) && !self.is_swept(point, 0.0, before)
    }

    /// Whether one of the earlier moves sweeps a disc.
    fn is_swept(&self, centre: [f64; 2], radius: f64, before: usize) -> bool {
        let reach = self.widest - radius;
        let is_over = |sweep: &Sweep| {
            let (index, swept) = sweep.data;
            let most = swept - radius;
            index.is_none_or(|index| index < before) && most > 0.0 && sweep.distance_2(&centre) < most * most
        };
        reach > 0.0 && self.sweeps.locate_within_distance(centre, reach * reach).any(is_over)
    }
}

/// What a feed sweeps of a plane, in chords; one that falls as much as at its highest.
fn sweeps(index: Option<usize>, stretch: &Stretch, cutters: &[Cutter], plane: f64) -> Vec<Sweep> {
    let Some((start, cutter)) = stretch.start.zip(stretch.tool.and_then(|tool| cutters.get(tool))) else {
        return Vec::new();
    };
    let highest = start[2].max(stretch.end[2]);
    if stretch.is_rapid || highest >= plane {
        return Vec::new();
    }
    let radius = cutter.at_height(plane - highest).0;
    plan_chords([start, stretch.end], stretch.bend, SAG).map(|chord| Sweep::new(chord, (index, radius))).collect()
}

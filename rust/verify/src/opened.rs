//! Whether a hole is there before a tool goes down into it: the stock comes with it, or what is cut before makes it.

use std::f64::consts::TAU;

use rstar::PointDistance;
use styluscam_geometry::{Stock, Tool};

use crate::before::Stretch;
use crate::earlier::{plan_chords, stretches};
use crate::engagement::Area;
use crate::segments::Segment;
use crate::subject::Subject;
use crate::tolerances::SAME_LEVEL;

/// Points on the rim of a hole that are looked at.
const POINTS: usize = 24;
/// How much smaller the hole that is found may be, mm: axes and diameters are rounded.
const ROUNDED: f64 = 0.01;
/// Cells in which the outlines of the stock are listed, mm.
const CELL: f64 = 1.0;

/// An upright hole, work coordinates, mm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Opening {
    /// Its axis in plan.
    pub at: [f64; 2],
    pub radius: f64,
    /// From where to where it is looked for.
    pub top: f64,
    pub bottom: f64,
}

/// What is cut before a move, and of what.
pub(crate) struct Opened<'a> {
    stock: &'a Stock,
    own: Vec<Stretch>,
    tools: &'a [Tool],
    earlier: Option<(&'a [Stretch], &'a [Tool])>,
}

impl<'a> Opened<'a> {
    /// By earlier programs, and by the moves before one of an index; none where no stock is known.
    pub fn before(index: usize, segments: &[Segment], subject: &Subject<'a>) -> Option<Self> {
        let own = segments.iter().filter(|segment| segment.index < index).flat_map(stretches).collect();
        let earlier = subject.before.map(|before| (before.stretches.as_slice(), before.tools.as_slice()));
        Some(Self { stock: subject.stock?, own, tools: subject.tools, earlier })
    }

    /// Whether there is no stock in a hole any more.
    pub fn has(&self, hole: &Opening) -> bool {
        let outlines = self.stock.outlines_between([hole.top, hole.bottom]);
        let area = Area::new(&outlines, CELL);
        let radius = hole.radius - ROUNDED;
        let rim = (0..POINTS).map(|i| {
            let (sin, cos) = libm::sincos(TAU * i as f64 / POINTS as f64);
            [hole.at[0] + radius * cos, hole.at[1] + radius * sin]
        });
        rim.chain([hole.at]).all(|point| !area.holds(point) || self.is_cut(point, hole.bottom))
    }

    /// Whether a feed takes all that stands over a point, down to a height.
    fn is_cut(&self, point: [f64; 2], bottom: f64) -> bool {
        let cut = self.earlier.into_iter().chain([(self.own.as_slice(), self.tools)]);
        cut.into_iter().any(|(stretches, tools)| stretches.iter().any(|stretch| cuts(stretch, tools, point, bottom)))
    }
}

fn cuts(stretch: &Stretch, tools: &[Tool], point: [f64; 2], bottom: f64) -> bool {
    let tool = stretch.tool.and_then(|tool| tools.get(tool));
    let (Some(start), Some(tool), false) = (stretch.start, tool, stretch.is_rapid) else { return false };
    let goes_straight = start[..2] == stretch.end[..2];
    let tip = if goes_straight { start[2].min(stretch.end[2]) } else { start[2].max(stretch.end[2]) };
    if tip > bottom + SAME_LEVEL {
        return false;
    }
    let radius = tool.cutter().at_height(bottom + SAME_LEVEL - tip).0;
    if goes_straight {
        return libm::hypot(point[0] - start[0], point[1] - start[1]) <= radius;
    }
    plan_chords([start, stretch.end], stretch.bend, ROUNDED).any(|chord| chord.distance_2(&point) <= radius * radius)
}

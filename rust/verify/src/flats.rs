//! What of a sheet needs no forming: positions where the model is the flat blank, and level floors that go down flat with the
//! walls around them.
//!
//! Single-point forming works where the tool rolls over the sheet; what lies inside the tool's path keeps its shape and is
//! carried down with the path's depth. The literature calls it the undeformed minor base, and the bulge that it may take, the
//! pillow effect, an error of shape that passes over the floor do not mend (F. Micari, G. Ambrogio, L. Filice, "Shape and
//! dimensional accuracy in single point incremental forming: state of the art and future trends", J. Mater. Process. Technol.
//! 191, 2007). So a floor is as deep as the level passes that go round it, and needs no contact of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::Vector;

use crate::body::{length, Body};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::SLACK;

/// Level is what rises less than this, rad: 0.001 mm over a millimetre.
const LEVEL: f64 = 1e-3;
/// Bins of a pass's sides by height in plan: a side is looked up, not searched.
const BINS: usize = 256;

/// What a position of a sheet asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Need {
    /// The tool must touch it.
    Forming,
    /// Nothing: the blank lies there before.
    Flat,
    /// Nothing: it is a level floor inside a pass as deep as it, and goes down with it.
    Carried,
}

/// The blank and the closed level passes of a program.
pub(crate) struct Flats {
    /// Height of the model's surface on the blank, mm; none where no sheet is formed.
    blank: Option<f64>,
    /// How far off the blank a position still lies on it, mm.
    tolerance: f64,
    passes: Vec<Ring>,
}

impl Flats {
    /// Those of a program; a floor may be `enough` mm off the passes around it.
    pub fn of(segments: &[Segment], subject: &Subject, limits: &Limits, enough: f64) -> Self {
        let under = subject.sheet.map_or(0.0, |sheet| sheet.raise());
        let blank = limits.forming.filter(|_| subject.sheet.is_some()).map(|forming| forming.top - under);
        let tolerance = limits.excess.unwrap_or(0.0) + subject.deviation_outward + SLACK;
        let bodies: Vec<Body> = subject.tools.iter().map(|tool| Body::new(tool, subject.sheet.as_ref())).collect();
        let passes = if blank.is_some() { rings(segments, &bodies, enough) } else { Vec::new() };
        Self { blank, tolerance, passes }
    }

    /// What a point of the part, with its unit normal, asks for.
    pub fn need(&self, point: Vector, up: Vector) -> Need {
        let Some(blank) = self.blank.filter(|_| up.z > 0.0 && up.xy().norm() <= LEVEL) else { return Need::Forming };
        if (point.z - blank).abs() <= self.tolerance {
            Need::Flat
        } else if self.passes.iter().any(|ring| ring.holds(point)) {
            Need::Carried
        } else {
            Need::Forming
        }
    }
}

/// A closed pass at one height.
struct Ring {
    /// Heights of the floor that it takes along, mm.
    heights: [f64; 2],
    /// Of the pass in plan.
    low: [f64; 2],
    high: [f64; 2],
    /// Its sides by where they lie in Y.
    bins: Vec<Vec<[[f64; 2]; 2]>>,
}

/// The closed passes among moves that are meant to touch; of arcs their pieces' chords count.
fn rings(segments: &[Segment], bodies: &[Body], enough: f64) -> Vec<Ring> {
    let level =
        |segment: &&Segment| segment.kind == SegmentKind::Lateral && segment.excess.is_some() && !segment.falls();
    let level: Vec<&Segment> = segments.iter().filter(level).collect();
    let joined = |a: &&Segment, b: &&Segment| b.start == Some(a.end) && b.tool == a.tool;
    level.chunk_by(joined).flat_map(|chain| loops(chain, bodies, enough)).collect()
}

/// The loops that a chain of moves at one height goes through: each ends where it began; the last one may also end beside
/// that, nearer than its tool is wide.
fn loops(chain: &[&Segment], bodies: &[Body], enough: f64) -> Vec<Ring> {
    let Some((first, body)) = chain.first().and_then(|segment| Some((segment, bodies.get(segment.tool?)?))) else {
        return Vec::new();
    };
    let height = body.position(first.end).z;
    let heights = [height - enough, height + enough];
    let plan = |position: [f64; 3]| [position[0], position[1]];
    let apart = |a: &[f64; 2], b: &[f64; 2]| length(b[0] - a[0], b[1] - a[1]);
    let mut rings = Vec::new();
    let mut positions: Vec<[f64; 2]> = first.start.map(plan).into_iter().collect();
    for position in chain.iter().flat_map(|segment| segment.pieces()).map(|piece| plan(piece.end)) {
        positions.push(position);
        if positions.len() > 3 && apart(&positions[0], &position) <= SLACK {
            rings.push(Ring::new(&positions, heights));
            positions = vec![position];
        }
    }
    if positions.len() > 2 && apart(&positions[0], &positions[positions.len() - 1]) <= body.radius() {
        rings.push(Ring::new(&positions, heights));
    }
    rings
}

impl Ring {
    fn new(positions: &[[f64; 2]], heights: [f64; 2]) -> Self {
        let corner = |pick: fn(f64, f64) -> f64, none: f64| {
            [0, 1].map(|axis| positions.iter().map(|position| position[axis]).fold(none, pick))
        };
        let (low, high) = (corner(f64::min, f64::INFINITY), corner(f64::max, f64::NEG_INFINITY));
        let mut ring = Self { heights, low, high, bins: vec![Vec::new(); BINS] };
        for (i, from) in positions.iter().enumerate() {
            let to = positions[(i + 1) % positions.len()];
            let [a, b] = [ring.bin(from[1].min(to[1])), ring.bin(from[1].max(to[1]))];
            ring.bins[a..=b].iter_mut().for_each(|bin| bin.push([*from, to]));
        }
        ring
    }

    fn bin(&self, y: f64) -> usize {
        let share = (y - self.low[1]) / (self.high[1] - self.low[1]).max(f64::MIN_POSITIVE);
        ((share * BINS as f64) as usize).min(BINS - 1)
    }

    /// Whether a point lies at its height and inside it: it goes round the point, in whichever sense.
    fn holds(&self, point: Vector) -> bool {
        let inside = |axis: usize| (self.low[axis]..=self.high[axis]).contains(&point[axis]);
        if !(self.heights[0]..=self.heights[1]).contains(&point.z) || !inside(0) || !inside(1) {
            return false;
        }
        // Sunday's winding number: sides that cross the line to the right upwards less those that cross it downwards
        let turns = self.bins[self.bin(point.y)].iter().map(|[a, b]| {
            let side = (b[0] - a[0]) * (point.y - a[1]) - (point.x - a[0]) * (b[1] - a[1]);
            let (up, down) = (a[1] <= point.y && b[1] > point.y, a[1] > point.y && b[1] <= point.y);
            i32::from(up && side > 0.0) - i32::from(down && side < 0.0)
        });
        turns.sum::<i32>() != 0
    }
}

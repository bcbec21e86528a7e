//! Stock that stands above the height at which an operation begins: the tool would come straight down through it, and be in it
//! farther up than its layers are high.
//!
//! A job states that height (`z_top`); what lies above is taken to be cut. Here it is looked at: within a tool's section at that
//! height there is no stock but what the operations and programs before have swept as low. Knows nothing of how paths were planned.

use std::collections::BTreeMap;

use styluscam_geometry::{Cutter, Stock, Tool};
use styluscam_motion::{Cancelled, Watch};

use crate::before::Stretch;
use crate::earlier::stretches;
use crate::engagement::{Area, Cleared, Swept};
use crate::expectation::{DrilledHole, ExpectedOperation, Passes};
use crate::faults::{self, Fault};
use crate::segments::Segment;
use crate::subject::{Limits, Subject};

/// What stands no higher than this is nothing, mm: the air that ways down into the material begin with.
const AIR: f64 = 0.2;
/// The share of the tool's section that is looked at: beyond, it may be in what is left on walls.
const WITHIN: f64 = 0.9;
/// Positions along a move are so far apart at most, in radii of the section.
const APART: f64 = 0.5;
/// Positions along a move at most.
const MOST: f64 = 4096.0;
/// Points on a circle about such a position.
const AROUND: u32 = 16;
/// Cells in which outlines and paths are listed are as large as this at least, mm.
const LEAST_CELL: f64 = 1.0;

/// The first position of each operation at which stock is above its beginning, in the order of the job's.
///
/// # Errors
/// `Cancelled`.
pub(crate) fn faults(
    segments: &[Segment],
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let Some(stock) = subject.stock.filter(|_| subject.stock_is_stated) else { return Ok(Vec::new()) };
    let mut faults = Vec::new();
    for (number, operation) in subject.expected.iter().enumerate() {
        let Some(tool) = subject.tools.get(operation.tool) else { continue };
        let own: Vec<&Segment> = segments.iter().filter(|segment| segment.expected == Some(number)).collect();
        let Some(first) = own.iter().map(|segment| segment.index).min() else { continue };
        for (begins, own) in by_beginning(operation, &own) {
            let plane = begins + AIR;
            let outlines = stock.outlines_between([stock.top, plane]);
            if outlines.is_empty() {
                continue;
            }
            let before = segments.iter().filter(|segment| segment.index < first);
            let above = Above {
                stock,
                plane,
                area: Area::new(&outlines, tool.diameter().max(LEAST_CELL)),
                gone: gone(before, subject, plane),
                cutter: tool.cutter(),
                unit: limits.unit,
            };
            for segment in own {
                watch.advance(0)?;
                if let Some(fault) = above.fault(segment) {
                    faults.push(fault);
                    break;
                }
            }
        }
    }
    Ok(faults)
}

/// The moves of an operation by the height at which it begins where they are; none where that is not known.
fn by_beginning<'s>(operation: &ExpectedOperation, own: &[&'s Segment]) -> Vec<(f64, Vec<&'s Segment>)> {
    match &operation.expectation.passes {
        Passes::Clearing(clearing) => vec![(clearing.top, own.to_vec())],
        Passes::Contouring(contouring) => {
            let begins = contouring.lines.iter().map(|line| line.begins).reduce(f64::max);
            begins.into_iter().map(|begins| (begins, own.to_vec())).collect()
        }
        Passes::Drilling(drilling) => by_hole(&drilling.holes, own),
        Passes::Boring(boring) => by_hole(&boring.holes, own),
        // these follow the part: stock above them is what they are to take
        Passes::Ordered(_)
        | Passes::Crossed(_)
        | Passes::Flank(_)
        | Passes::Chamfering(_)
        | Passes::Covering { .. }
        | Passes::Unordered { .. } => Vec::new(),
    }
}

/// The moves by the height at which the hole begins that is nearest to their end.
fn by_hole<'s>(holes: &[DrilledHole], own: &[&'s Segment]) -> Vec<(f64, Vec<&'s Segment>)> {
    let mut found: BTreeMap<u64, (f64, Vec<&'s Segment>)> = BTreeMap::new();
    for segment in own {
        let [x, y, _] = segment.end;
        let apart = |hole: &DrilledHole| libm::hypot(hole.at[0] - x, hole.at[1] - y);
        let Some(hole) = holes.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))) else { continue };
        found.entry(hole.top.to_bits()).or_insert_with(|| (hole.top, Vec::new())).1.push(segment);
    }
    found.into_values().collect()
}

/// What moves before have swept down to a plane.
fn gone<'s>(before: impl Iterator<Item = &'s Segment>, subject: &Subject, plane: f64) -> Cleared {
    let own: Vec<Stretch> = before.flat_map(stretches).collect();
    let of_programs = subject.before.into_iter().flat_map(|before| swept(&before.stretches, &before.tools, plane));
    let all: Vec<Swept> = of_programs.chain(swept(&own, subject.tools, plane)).collect();
    Cleared::new(&all, LEAST_CELL)
}

/// The plane's part that feeds sweep; of those that fall as much as at their highest.
fn swept<'s>(stretches: &'s [Stretch], tools: &'s [Tool], plane: f64) -> impl Iterator<Item = Swept> + 's {
    stretches.iter().filter(|stretch| !stretch.is_rapid).filter_map(move |stretch| {
        let start = stretch.start?;
        let highest = start[2].max(stretch.end[2]);
        let tool = tools.get(stretch.tool?).filter(|_| highest < plane)?;
        let bulge = stretch.bend.map_or(0.0, |bend| bend.bulge());
        let points = vec![[start[0], start[1], bulge], [stretch.end[0], stretch.end[1], 0.0]];
        Some(Swept { points, radius: tool.cutter().at_height(plane - highest).0 })
    })
}

/// What stands above a plane.
struct Above<'a> {
    stock: &'a Stock,
    /// Its height, mm.
    plane: f64,
    area: Area,
    gone: Cleared,
    cutter: Cutter,
    /// The smallest step of coordinates, mm.
    unit: f64,
}

impl Above<'_> {
    /// That a tool is in stock above the plane on a move.
    fn fault(&self, segment: &Segment) -> Option<Fault> {
        if segment.lowest() >= self.plane {
            return None;
        }
        let radius = self.cutter.at_height(self.plane - segment.lowest()).0.max(self.unit);
        let count = (segment.length() / (APART * radius)).ceil().clamp(1.0, MOST);
        let tips = (0..=count as u32).map(|i| segment.at(f64::from(i) / count));
        let at = tips.into_iter().find(|tip| self.is_in(*tip))?;
        let height = self.stock.top - (self.plane - AIR);
        Some(Fault { position: at, ..segment.fault(&faults::STOCK_ABOVE).measured(height, 0.0) })
    }

    /// Whether the section of a tool in the plane is in stock.
    fn is_in(&self, [x, y, z]: [f64; 3]) -> bool {
        if z >= self.plane {
            return false;
        }
        let radius = WITHIN * self.cutter.at_height(self.plane - z).0;
        let stands = |point: [f64; 2]| self.area.holds(point) && !self.gone.holds(point);
        let on_circle = |radius: f64| {
            (0..AROUND).any(|i| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / f64::from(AROUND));
                stands([x + radius * cos, y + radius * sin])
            })
        };
        stands([x, y]) || on_circle(0.5 * radius) || on_circle(radius)
    }
}

//! Stock that stands above the height at which an operation begins: the tool would come straight down through it, and be in it
//! farther up than its layers are high. And of contours stock that stands above the level before: they take it level by level.
//!
//! A job states the height at which an operation begins (`z_top`); what lies above is taken to be cut. Here it is looked at: within a
//! tool's section at that height there is no stock but what the operations and programs before have swept as low. Knows nothing of how
//! paths were planned.

use std::collections::BTreeMap;

use rstar::primitives::Line;
use rstar::{PointDistance, RTree};
use styluscam_geometry::Cutter;
use styluscam_motion::{Cancelled, Watch};

use crate::expectation::{ContourLine, Contouring, DrilledHole, ExpectedOperation, Passes};
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::standing::Standing;
use crate::subject::Subject;
use crate::tolerances::SAME_LEVEL;

/// What stands no higher than this is nothing, mm: the air that ways down into the material begin with.
const AIR: f64 = 0.2;

/// The first position of each operation at which stock is above its beginning, or above the level before; in the order of the job's.
///
/// # Errors
/// `Cancelled`.
pub(crate) fn faults(segments: &[Segment], subject: &Subject, watch: &Watch) -> Result<Vec<Fault>, Cancelled> {
    let Some(stock) = subject.stock else { return Ok(Vec::new()) };
    let mut faults = Vec::new();
    for (number, operation) in subject.expected.iter().enumerate() {
        let Some(tool) = subject.tools.get(operation.tool) else { continue };
        let cutter = tool.cutter();
        let own: Vec<&Segment> = segments.iter().filter(|segment| segment.expected == Some(number)).collect();
        let Some(first) = own.iter().map(|segment| segment.index).min() else { continue };
        // of a stock that is not stated nothing is known but that the part is in it
        let beginnings = if subject.stock_is_stated { by_beginning(operation, &own) } else { Vec::new() };
        for (begins, own) in beginnings {
            let before = segments.iter().filter(|segment| segment.index < first);
            let Some(standing) = Standing::above(begins + AIR, before, subject) else { continue };
            for segment in own {
                watch.advance(0)?;
                if let Some(position) = standing.first_in(segment, &cutter) {
                    let fault = segment.fault(&faults::STOCK_ABOVE).measured(stock.top - begins, 0.0);
                    faults.push(Fault { position, ..fault });
                    break;
                }
            }
        }
        if let Some(contouring) = operation.expectation.contouring() {
            faults.extend(too_deep((contouring, &own), &cutter, (segments, subject), watch)?);
        }
    }
    Ok(faults)
}

/// The moves of an operation by the height at which it begins where they are; none where that is not known.
fn by_beginning<'s>(operation: &ExpectedOperation, own: &[&'s Segment]) -> Vec<(f64, Vec<&'s Segment>)> {
    match &operation.expectation.passes {
        Passes::Clearing(clearing) => vec![(clearing.top, own.to_vec())],
        Passes::Contouring(contouring) => {
            contouring.lines.first().map(|line| (line.begins, own.to_vec())).into_iter().collect()
        }
        Passes::Drilling(drilling) => by_hole(&drilling.holes, own),
        Passes::Boring(boring) => by_hole(&boring.holes, own),
        // these follow the part, and state no height at which they begin
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

/// The first move of a contour that cuts under stock which the level before has not taken. The tool's profile may be in it: where it is
/// no wider below than its paths are apart from level to level.
fn too_deep(
    (contouring, own): (&Contouring, &[&Segment]),
    cutter: &Cutter,
    (segments, subject): (&[Segment], &Subject),
    watch: &Watch,
) -> Result<Option<Fault>, Cancelled> {
    let profile = cutter.height_at_radius(cutter.max_radius());
    let sides = |line: &ContourLine| {
        RTree::bulk_load(line.pieces.iter().map(|piece| Line::new(piece.ends[0], piece.ends[1])).collect())
    };
    let lines: Vec<(RTree<Line<[f64; 2]>>, &ContourLine)> =
        contouring.lines.iter().map(|line| (sides(line), line)).collect();
    let mut planes: BTreeMap<[u64; 2], Option<Standing>> = BTreeMap::new();
    for segment in own {
        watch.advance(0)?;
        if !matches!(segment.kind, SegmentKind::Lateral | SegmentKind::Plunge) {
            continue;
        }
        let [x, y, _] = segment.at(0.5);
        let apart = |sides: &RTree<Line<[f64; 2]>>| {
            sides.nearest_neighbor([x, y]).map_or(f64::INFINITY, |side| side.distance_2(&[x, y]))
        };
        let Some((_, line)) = lines.iter().min_by(|a, b| apart(&a.0).total_cmp(&apart(&b.0))) else { continue };
        let tips = || line.levels.iter().map(|level| level.tip);
        let Some(level) = tips().filter(|tip| *tip > segment.lowest() + SAME_LEVEL).reduce(f64::min) else { continue };
        let next = tips().filter(|tip| *tip < level - SAME_LEVEL).fold(f64::NEG_INFINITY, f64::max);
        let standing = planes.entry([level, next].map(f64::to_bits)).or_insert_with(|| {
            // its own moves on that level and to the next: those below it come later
            let takes = |it: &&Segment| it.expected != segment.expected || it.end[2] > next + SAME_LEVEL;
            Standing::above(level + profile + AIR, segments.iter().filter(takes), subject)
        });
        let Some(position) = standing.as_ref().and_then(|it| it.first_in(segment, cutter)) else {
            continue;
        };
        let fault = segment.fault(&faults::LEVEL_ABOVE).measured(level, 0.0);
        return Ok(Some(Fault { position, ..fault }));
    }
    Ok(None)
}

//! What tools meet of the stock that no move has taken yet: shank and holder that are in it, and passes along the part that cut
//! deeper through it than their tool is wide.
//!
//! The material is heights over a grid, lowered piece by piece of every move in the order of the text. Heights are exact at the nodes; of
//! what is thinner than two nodes are apart nothing is known. Knows nothing of how paths were planned.

mod loaded;

use styluscam_geometry::Stock;
use styluscam_motion::{Cancelled, Watch};

use crate::expectation::Passes;
use crate::faults::Fault;
use crate::segments::{Segment, SegmentKind};
use crate::simulation::{Grid, Material};
use crate::subject::Subject;
use loaded::Loaded;

/// Nodes are as near to each other as this share of the narrowest solid's radius above a profile, where one may be in the stock,
const FINE: f64 = 0.1;
/// or else of the narrowest tool's,
const COARSE: f64 = 0.3;
/// but no nearer than this share of the stock's longer side.
const FINEST: f64 = 1.0 / 512.0;

/// The moves on which a tool is in the stock as it must not be, and by how much at most.
///
/// # Errors
/// `Cancelled`.
pub(crate) fn faults(segments: &[Segment], subject: &Subject, watch: &Watch) -> Result<Vec<Fault>, Cancelled> {
    // of a stock that is not stated nothing is known but that the part is in it
    let Some(stock) = subject.stock.filter(|_| subject.stock_is_stated && subject.sheet.is_none()) else {
        return Ok(Vec::new());
    };
    let tools: Vec<Loaded> = subject.tools.iter().map(Loaded::new).collect();
    let loaded = |segment: &Segment| tools.get(segment.tool?);
    let is_asked = |segment: &Segment| {
        let deep = |tool: &Loaded| follows_part(segment, subject) && tool.may_cut_deep(segment, stock.top);
        loaded(segment).is_some_and(|tool| tool.may_be_in(segment, stock.top) || deep(tool))
    };
    let Some(last) = segments.iter().rposition(is_asked) else { return Ok(Vec::new()) };
    let is_above = segments.iter().any(|it| loaded(it).is_some_and(|tool| tool.may_be_in(it, stock.top)));
    let Some(grid) = grid(stock, &tools, is_above) else { return Ok(Vec::new()) };
    let mut material = Material::uncut(subject, grid, stock.top, watch)?;
    let mut faults = Vec::new();
    for segment in &segments[..=last] {
        watch.advance(0)?;
        let Some(tool) = loaded(segment).filter(|_| segment.lowest() < stock.top) else { continue };
        let moved = tool.move_along(segment, &mut material, stock.top);
        faults.extend(moved.above);
        faults.extend(moved.deep.filter(|_| follows_part(segment, subject)));
    }
    Ok(faults)
}

/// Nodes over the stock; none where it has no size.
fn grid(stock: &Stock, tools: &[Loaded], is_above: bool) -> Option<Grid> {
    let (low, high) = stock.bounds();
    let narrowest = |radii: &mut dyn Iterator<Item = f64>| radii.fold(f64::INFINITY, f64::min);
    let near = if is_above {
        FINE * narrowest(&mut tools.iter().flat_map(Loaded::radii_above))
    } else {
        COARSE * narrowest(&mut tools.iter().map(Loaded::radius))
    };
    let spacing = near.max(FINEST * (high.x - low.x).max(high.y - low.y));
    Grid::over([low.x, low.y], [high.x, high.y], spacing).ok()
}

/// Whether a move cuts along the part, wherever that takes it; other passes have levels of their own, which are checked.
fn follows_part(segment: &Segment, subject: &Subject) -> bool {
    let is_cutting = matches!(segment.kind, SegmentKind::Lateral | SegmentKind::Plunge);
    let expected = segment.expected.and_then(|number| subject.expected.get(number)).filter(|_| is_cutting);
    expected.is_some_and(|operation| match &operation.expectation.passes {
        Passes::Ordered(_)
        | Passes::Crossed(_)
        | Passes::Flank(_)
        | Passes::Chamfering(_)
        | Passes::Covering { .. }
        | Passes::Unordered { .. } => true,
        Passes::Clearing(_) | Passes::Contouring(_) | Passes::Drilling(_) | Passes::Boring(_) => false,
    })
}

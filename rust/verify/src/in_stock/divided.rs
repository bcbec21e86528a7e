//! Stock in nodes, and moves in straight pieces.

use styluscam_geometry::Stock;
use styluscam_motion::{Cancelled, Watch};

use crate::segments::Segment;
use crate::simulation::{Grid, Material};
use crate::subject::Subject;

/// Nodes are no nearer to each other than this share of the stock's longer side.
const FINEST: f64 = 1.0 / 1024.0;
/// Pieces of a move are no longer than so many radii of the tool: the box in plan around one is looked at.
pub(super) const LONGEST: f64 = 8.0;
/// Pieces of a move at most.
const MOST_PIECES: f64 = 1e5;

/// Nodes over the stock, about so far apart; none where it has no size.
fn grid(stock: &Stock, spacing: f64) -> Option<Grid> {
    let (low, high) = stock.bounds();
    let finest = FINEST * (high.x - low.x).max(high.y - low.y);
    Grid::over([low.x, low.y], [high.x, high.y], spacing.max(finest)).ok()
}

/// The moves from the first to the last that are asked about, and what those before them leave of the stock in nodes so far apart; none
/// where none is asked about.
pub(super) fn asked<'s>(
    segments: &'s [Segment],
    is_asked: impl Fn(&Segment) -> bool,
    spacing: f64,
    (subject, stock): (&Subject, &Stock),
    watch: &Watch,
) -> Result<Option<(&'s [Segment], Material)>, Cancelled> {
    let ends = segments.iter().position(&is_asked).zip(segments.iter().rposition(&is_asked));
    let Some(((first, last), grid)) = ends.zip(grid(stock, spacing)) else { return Ok(None) };
    let material = Material::after(&segments[..first], subject, grid, stock.top, watch)?;
    Ok(Some((&segments[first..=last], material)))
}

/// A move in straight pieces, no longer than `longest` and no farther from arcs than `sag`, mm.
pub(super) fn pieces(segment: &Segment, longest: f64, sag: f64) -> impl Iterator<Item = Segment> {
    let count = (segment.length() / longest).ceil().clamp(1.0, MOST_PIECES) as u32;
    let chords = segment.bend.map_or(1, |bend| bend.chords(sag)) as u32;
    let divided = Segment { pieces: count.max(chords), ..*segment };
    divided.pieces().map(|piece| Segment { bend: None, ..piece })
}

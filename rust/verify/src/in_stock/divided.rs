//! Stock in nodes, and moves in straight pieces.

use styluscam_geometry::Stock;

use crate::segments::Segment;
use crate::simulation::Grid;

/// Nodes are no nearer to each other than this share of the stock's longer side.
const FINEST: f64 = 1.0 / 1024.0;
/// Pieces of a move at most.
const MOST_PIECES: f64 = 1e5;

/// Nodes over the stock, about so far apart; none where it has no size.
pub(super) fn grid(stock: &Stock, spacing: f64) -> Option<Grid> {
    let (low, high) = stock.bounds();
    let finest = FINEST * (high.x - low.x).max(high.y - low.y);
    Grid::over([low.x, low.y], [high.x, high.y], spacing.max(finest)).ok()
}

/// A move in straight pieces, no longer than `longest` and no farther from arcs than `sag`, mm.
pub(super) fn pieces(segment: &Segment, longest: f64, sag: f64) -> impl Iterator<Item = Segment> + '_ {
    let count = (segment.length() / longest).ceil().clamp(1.0, MOST_PIECES) as usize;
    let count = count.max(segment.bend.map_or(1, |bend| bend.chords(sag)));
    let at = move |i: usize| segment.at(i as f64 / count as f64);
    (0..count).map(move |i| Segment {
        start: if i == 0 { segment.start } else { Some(at(i)) },
        end: if i + 1 == count { segment.end } else { at(i + 1) },
        bend: None,
        pieces: 1,
        ..*segment
    })
}

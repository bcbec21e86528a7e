//! Pockets cleared with a bounded engagement angle.
//!
//! The tool's centre may move on the boundary of everything that permissible discs cover: discs on whose circles the bound holds,
//! because no material is nearer to their centres than a closed form allows (`bound`). The area that they cover grows as material goes:
//! pieces of its boundary on which the tool cuts are the path, until nothing is left. Clearing more only lowers the angle, so
//! the order of the pieces is free. What the construction guarantees, and where it does not, stands in docs/concepts/pockets.md.

mod areas;
mod bound;
mod boxes;
mod check;
mod contours;
mod cut;
mod entry;
mod error;
mod feeds;
mod finish;
mod fit;
mod ground;
mod growth;
mod links;
mod material;
mod moves;
mod offset;
mod pieces;
mod planner;
mod polygons;
mod request;
mod sequence;
mod steering;

#[cfg(test)]
mod tests;

use styluscam_motion::Watch;

pub use areas::CentreArea;
pub use error::PocketError;
pub use feeds::FeedLaw;
pub use moves::{segments, Layer};
pub use request::{Cleared, EntryForm, EntryRule, Pocket, PocketPath, PocketRun, PocketRunKind, Shape, Stepover};

/// Plans the path.
///
/// # Errors
/// What is not a pocket or a tool, a tool that fits nowhere; `Cancelled` when the watch is cancelled.
pub fn pocket_path(pocket: &Pocket<'_>, watch: &Watch) -> Result<PocketPath, PocketError> {
    if pocket.climb {
        return with_finish(pocket, watch);
    }
    // the other way round is climb milling of the mirrored pocket
    let all = |outlines: &[Vec<[f64; 3]>]| outlines.iter().map(|outline| mirrored(outline)).collect::<Vec<_>>();
    let stock = pocket.shape.stock().map(all);
    let cleared = |path: &Cleared| Cleared { points: mirrored(&path.points), radius: path.radius };
    let cleared: Vec<Cleared> = pocket.cleared.iter().map(cleared).collect();
    let there = Pocket { climb: true, cleared: &cleared, ..*pocket };
    let mut path = match pocket.shape {
        Shape::Walls { boundary, islands, open_edges, .. } => {
            let (boundary, islands) = (mirrored(boundary), all(islands));
            let stock = stock.as_deref();
            let shape = Shape::Walls { boundary: &boundary, islands: &islands, open_edges, stock };
            with_finish(&Pocket { shape, ..there }, watch)
        }
        Shape::Centres { outlines, .. } => {
            let (outlines, stock) = (all(outlines), stock.unwrap_or_default());
            let shape = Shape::Centres { outlines: &outlines, stock: &stock };
            with_finish(&Pocket { shape, ..there }, watch)
        }
    }
    .map_err(PocketError::mirrored)?;
    for run in &mut path.runs {
        run.points = mirrored(&run.points);
    }
    Ok(path)
}

/// By climb milling, with a pass along the walls at the end where one is asked for.
fn with_finish(pocket: &Pocket<'_>, watch: &Watch) -> Result<PocketPath, PocketError> {
    if pocket.finish > 0.0 {
        return finish::plan(pocket, watch);
    }
    planner::plan(pocket, watch)
}

fn mirrored(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    points.iter().map(|[x, y, bulge]| [-x, *y, -bulge]).collect()
}

//! Pockets cleared with a bounded engagement angle.
//!
//! The tool's centre may move on the boundary of everything that permissible discs cover: discs on whose circles the bound holds,
//! because no material is nearer to their centres than a closed form allows (`bound`). The area that they cover grows as material goes:
//! pieces of its boundary on which the tool cuts are the path, until nothing is left. Clearing more only lowers the angle, so
//! the order of the pieces is free. What the construction guarantees, and where it does not, stands in docs/concepts/pockets.md.

mod bound;
mod check;
mod cut;
mod entry;
mod error;
mod fit;
mod ground;
mod growth;
mod links;
mod material;
mod pieces;
mod planner;
mod polygons;
mod request;
mod sequence;
mod steering;

#[cfg(test)]
mod tests;

use styluscam_motion::Watch;

pub use error::PocketError;
pub use request::{Pocket, PocketPath, PocketRun, PocketRunKind};

/// Plans the path.
///
/// # Errors
/// What is not a pocket or a tool, a tool that fits nowhere; `Cancelled` when the watch is cancelled.
pub fn pocket_path(pocket: &Pocket<'_>, watch: &Watch) -> Result<PocketPath, PocketError> {
    if pocket.climb {
        return planner::plan(pocket, watch);
    }
    // the other way round is climb milling of the mirrored pocket
    let boundary = mirrored(pocket.boundary);
    let islands: Vec<Vec<[f64; 3]>> = pocket.islands.iter().map(|island| mirrored(island)).collect();
    let stock: Option<Vec<Vec<[f64; 3]>>> =
        pocket.stock.map(|stock| stock.iter().map(|outline| mirrored(outline)).collect());
    let there =
        Pocket { boundary: &boundary, islands: &islands, stock: stock.as_deref(), climb: true, ..pocket.clone() };
    let mut path = planner::plan(&there, watch)?;
    for run in &mut path.runs {
        run.points = mirrored(&run.points);
    }
    Ok(path)
}

fn mirrored(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    points.iter().map(|[x, y, bulge]| [-x, *y, -bulge]).collect()
}

//! A commented job for a part that has none yet: it runs as it is, states why it is so, and shows what can be changed.

mod allowances;
mod choice;
mod cutter;
mod drilling;
mod feed_lines;
mod feeds;
mod operations;
mod part;
mod preparing;
mod roughing;
mod shop;
mod sizes;
mod stock_nodes;
mod text;
mod work;
mod workable;
mod written;

use crate::JobError;
use choice::{choose, Choice};
pub use part::{StarterFace, StarterPart};
pub use sizes::fitting_radius;
use sizes::round;
use written::Written;

/// The path's tolerance, and what the file's own edges may take of it, mm.
const PATH_TOLERANCE: f64 = 0.01;
const PART_TOLERANCE: f64 = 0.003;
/// A job, and why it is so.
#[derive(Clone, Debug, PartialEq)]
pub struct Starter {
    /// The job in TOML.
    pub text: String,
    /// Sentences: what the part is taken for, and what follows from it.
    pub reasons: Vec<String>,
    /// Its operations, in order.
    pub operations: Vec<StarterOperation>,
}

/// An operation of it.
#[derive(Clone, Debug, PartialEq)]
pub struct StarterOperation {
    /// Its name in the job.
    pub id: String,
    /// Sentences: why it is there, and so.
    pub reasons: Vec<String>,
}

/// A job for a part: formed where it is a sheet or an open surface that a sheet can take, else milled from a block: the stock
/// cleared, holes drilled, levels for its walls and rows for its floors, each with a tool that fits.
///
/// # Errors
/// A material that the table of cutting data does not have.
pub fn starter(part: &StarterPart<'_>) -> Result<Starter, JobError> {
    let mut choice = choose(part);
    let tolerances = tolerances(part, &mut choice);
    let feeds = feeds::feeds(part, &mut choice, tolerances)?;
    let text = Written { part, choice: &choice, tolerances, feeds: Some(&feeds) }.job();
    let operations = choice.operations.into_iter();
    Ok(Starter {
        text,
        reasons: choice.reasons,
        operations: operations.map(|work| StarterOperation { id: work.id, reasons: work.why }).collect(),
    })
}

/// Of the triangles and of the path, mm: a file whose edges lie off its surfaces is read no finer than that.
fn tolerances(part: &StarterPart<'_>, choice: &mut Choice) -> [f64; 2] {
    let size = (0..3).map(|axis| choice.bounds[1][axis] - choice.bounds[0][axis]).fold(0.0, f64::max);
    // triangles of a large part at three micrometres are millions
    let own = round(PART_TOLERANCE * f64::max(1.0, size / 500.0));
    if part.edge_gap <= own {
        return [own, round(PATH_TOLERANCE * own / PART_TOLERANCE)];
    }
    let needed = round(1.1 * part.edge_gap);
    choice.reasons.push(format!(
        "edges of the file lie up to {:.4} mm off their surfaces: tolerance = {needed} is the finest that it allows",
        part.edge_gap
    ));
    [needed, round(PATH_TOLERANCE + 2.0 * needed)]
}

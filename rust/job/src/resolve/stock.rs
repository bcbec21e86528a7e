//! The stock of a job around its part.

use rayon::prelude::*;
use styluscam_geometry::{Frame, GeometryError, Mesh, Solid, Stock, Vector};

use crate::numbers::shown;
use crate::stock::{Around, Given, StockKind};
use crate::{JobDocument, JobError};

const SECTION: &str = "setup.stock";

/// Checks what the schema cannot state of the section.
///
/// # Errors
/// Stock beside a sheet, keys that do not go together.
pub fn check(job: &JobDocument) -> Result<(), JobError> {
    let Some(section) = &job.setup.stock else { return Ok(()) };
    if job.process.process.as_kind().takes_sheet() {
        let message = "stock is what a part is cut from, and this job forms a sheet";
        return Err(JobError::document("conflict", SECTION, message, "remove [setup.stock]"));
    }
    section.as_kind().check(SECTION)
}

/// The stock of a job, work coordinates, with its words where the job states one: else it is the part's box. The part's triangles are off it by
/// `deviation` at most, mm; from the frame of its file `frame` leads to work coordinates.
///
/// # Errors
/// The part sticks out of it; a body that does not close.
pub fn stock_of(
    job: &JobDocument,
    part: &Mesh,
    (deviation, frame): (f64, &Frame),
    given: Given<'_>,
) -> Result<(Stock, Option<String>), JobError> {
    let (low, high) = part.bounds();
    let Some(section) = &job.setup.stock else { return Ok((Stock::of_box(low, high), None)) };
    let kind = section.as_kind();
    let (body, earlier) = match given {
        Given::Nothing => (None, None),
        Given::Body(body) => (Some(Solid::new(&body.placed(frame)).map_err(not_closed)?), None),
        Given::Program(earlier) => (None, Some(&**earlier)),
    };
    let around = Around { part: (low, high), deviation, frame, body: &body, earlier };
    let stock = kind.around(&around)?;
    if stock.bottom >= stock.top {
        let message = format!("the stock ends at Z{}, and begins at Z{}", shown(stock.top), shown(stock.bottom));
        return Err(JobError::document("conflict", SECTION, message, "raise its top, or lower its bottom"));
    }
    let words = kind.words(&around, &stock);
    if let Some(point) = outside(part, &stock, kind) {
        let [x, y, z] = [point.x, point.y, point.z].map(|mm| shown((mm * 1e3).round() / 1e3));
        let message = format!("the part sticks out of the stock ({words}) at X{x} Y{y} Z{z}");
        let hint = "make the stock larger, or move it over the part";
        return Err(JobError::document("conflict", SECTION, message, hint));
    }
    Ok((stock, Some(words)))
}

fn not_closed(error: GeometryError) -> JobError {
    match error {
        GeometryError::NotClosed { .. } => {
            let message = format!("stock is a closed body, and {error}, work coordinates");
            let hint = "close it in the CAD system, or export it as a solid";
            JobError::document("not-closed", format!("{SECTION}.file"), message, hint)
        }
        other => JobError::geometry(format!("{SECTION}.file"))(other),
    }
}

/// A point of the part that the stock does not hold; of a body also one of the stock's surface that lies in the part.
fn outside(part: &Mesh, stock: &Stock, kind: &dyn StockKind) -> Option<Vector> {
    let within = kind.slack();
    let sticks_out = |point: &Vector| {
        let is_between = (stock.bottom - within..=stock.top + within).contains(&point.z);
        !is_between || !kind.holds(stock, *point, within)
    };
    let corner = part.vertices().par_iter().find_first(|point| sticks_out(point)).copied();
    let Some(body) = stock.solid().filter(|_| corner.is_none()) else { return corner };
    // what is not convex may leave the middle of a triangle out
    let middles = |triangle: usize| {
        let [a, b, c] = part.corners(triangle);
        [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0].into_iter().find(sticks_out)
    };
    let middle = (0..part.triangles().len()).into_par_iter().find_map_first(middles);
    let is_deep = |solid: &Solid, point: &Vector| solid.holds(*point, 0.0) && solid.distance(*point) > within;
    // of an open part it is not known what lies in it
    let within_part = || {
        let solid = Solid::new(part).ok()?;
        body.mesh().vertices().par_iter().find_first(|point| is_deep(&solid, point)).copied()
    };
    middle.or_else(within_part)
}

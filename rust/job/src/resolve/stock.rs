//! The stock of a job around its part.

use styluscam_geometry::{Stock, Vector};

use crate::numbers::shown;
use crate::{JobDocument, JobError};

const SECTION: &str = "setup.stock";
/// By how much stock may be smaller than the part, mm: what rounding does to its numbers.
const SAME: f64 = 1e-6;

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

/// The stock of a job, work coordinates, with its words where the job states one: else it is the part's box.
///
/// # Errors
/// The part sticks out of it.
pub fn stock_of(
    job: &JobDocument,
    vertices: &[Vector],
    (low, high): (Vector, Vector),
) -> Result<(Stock, Option<String>), JobError> {
    let Some(section) = &job.setup.stock else { return Ok((Stock::of_box(low, high), None)) };
    let kind = section.as_kind();
    let stock = kind.around(low, high);
    if stock.bottom >= stock.top {
        let message = format!("the stock ends at Z{}, and begins at Z{}", shown(stock.top), shown(stock.bottom));
        return Err(JobError::document("conflict", SECTION, message, "raise its top, or lower its bottom"));
    }
    let sticks_out = |point: &&Vector| {
        let is_between = (stock.bottom - SAME..=stock.top + SAME).contains(&point.z);
        !is_between || !kind.holds(&stock, [point.x, point.y], SAME)
    };
    let words = kind.words(&stock);
    if let Some(point) = vertices.iter().find(sticks_out) {
        let [x, y, z] = [point.x, point.y, point.z].map(|mm| shown((mm * 1e3).round() / 1e3));
        let message = format!("the part sticks out of the stock ({words}) at X{x} Y{y} Z{z}");
        let hint = "make the stock larger, or move it over the part";
        return Err(JobError::document("conflict", SECTION, message, hint));
    }
    Ok((stock, Some(words)))
}

//! What every kind of stock answers.

use std::sync::Arc;

use styluscam_geometry::{Frame, Mesh, Solid, Stock, Vector};

use crate::earlier::Earlier;
use crate::numbers::shown;
use crate::JobError;

/// By how much stock may be smaller than the part, mm: what rounding does to its numbers.
const SAME: f64 = 1e-6;

/// The extent of stock along the three axes, in words, work coordinates.
pub(super) fn extent(stock: &Stock) -> String {
    let (low, high) = stock.bounds();
    let axis = |i: usize, name: &str| {
        let [low, high] = [low, high].map(|corner| shown((corner[i] * 1e3).round() / 1e3));
        format!("{name}{low} to {high}")
    };
    format!("{}, {}, {}", axis(0, "X"), axis(1, "Y"), axis(2, "Z"))
}

/// What was read for stock that a job states by files.
#[derive(Clone, Copy)]
pub enum Given<'a> {
    /// It states none.
    Nothing,
    /// The body, in the frame of the part's file.
    Body(&'a Mesh),
    /// What the earlier program cut.
    Program(&'a Arc<Earlier>),
}

/// What stock is around, work coordinates, mm.
pub struct Around<'a> {
    /// The part's box.
    pub part: (Vector, Vector),
    /// How far its triangles are off it at most.
    pub deviation: f64,
    /// From the frame of its file to work coordinates.
    pub frame: &'a Frame,
    /// The body that was read for it.
    pub body: &'a Option<Solid>,
    /// What was cut before.
    pub earlier: Option<&'a Earlier>,
}

/// What a kind of stock answers.
pub trait StockKind: Sync {
    /// Keys that exclude each other, or belong together; `path` is the table's in the document.
    ///
    /// # Errors
    /// They do not go together.
    fn check(&self, path: &str) -> Result<(), JobError>;

    /// The stock of a part, work coordinates, mm.
    ///
    /// # Errors
    /// What it is made of was not read.
    fn around(&self, around: &Around<'_>) -> Result<Stock, JobError>;

    /// In words, with its size.
    fn words(&self, around: &Around<'_>, stock: &Stock) -> String;

    /// By how much the part may stick out of it, mm.
    fn slack(&self) -> f64 {
        SAME
    }

    /// Whether it holds a point of the part, between its underside and its top, up to some mm.
    fn holds(&self, stock: &Stock, point: Vector, within: f64) -> bool;
}

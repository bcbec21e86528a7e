//! What every kind of stock answers.

use styluscam_geometry::{Stock, Vector};

use crate::JobError;

/// What a kind of stock answers.
pub trait StockKind {
    /// Keys that exclude each other, or belong together; `path` is the table's in the document.
    ///
    /// # Errors
    /// They do not go together.
    fn check(&self, path: &str) -> Result<(), JobError>;

    /// The stock of a part with a box between two corners, work coordinates, mm.
    fn around(&self, low: Vector, high: Vector) -> Stock;

    /// In words, with its size.
    fn words(&self, stock: &Stock) -> String;

    /// Whether it holds a point of the part in plan, up to some mm.
    fn holds(&self, stock: &Stock, point: [f64; 2], within: f64) -> bool;
}

//! Feeds and speeds: what a cutter stands in a material, from tables that name the source of each number, and what follows from the
//! engagement and the machine.
//!
//! A shop's own table goes before the shipped one; both are read from texts of one format. See docs/concepts/cutting-data.md.

mod fill;
mod rules;
mod table;
#[cfg(test)]
#[allow(clippy::float_cmp)] // products of the tables' short numbers are exact
mod tests;

pub(crate) use fill::{data_of, spindles_stated};
pub use fill::{with_cutting_data, Filled};
pub use rules::{cutting_data, Cut, CuttingData, Engagement, MachineLimits};
pub use table::{shipped_texts, CuttingEntry, CuttingMaterial, CuttingTable, CuttingWork, Span};

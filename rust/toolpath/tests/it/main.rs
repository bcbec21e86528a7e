//! Tool positions and passes, from outside the crate.
//!
//! One binary: each would be linked with the whole crate again.

#![allow(clippy::disallowed_methods, clippy::unwrap_used, clippy::panic)] // helpers of tests are not test functions

mod bounds;
mod common;
mod contours;
mod levels;
mod linking;
mod push_cutter;
mod refinement;
mod rows;
mod single_triangles;

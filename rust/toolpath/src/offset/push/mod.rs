//! The push-cutter: how far a tool goes along a horizontal line before it touches, and where it comes free again.

mod release;
mod search;

pub use release::{release, Line, Release};
pub use search::first;

//! What the proofs of the drop-cutter share: random tools, triangles and surfaces, and a truth of another method.
#![allow(dead_code)] // every test file uses its own part

pub mod body;
pub mod dice;
pub mod plates;
pub mod polygon;
pub mod surfaces;
pub mod tools;
pub mod triangles;

//! What the proofs of the drop-cutter share: random tools, triangles and surfaces, and a truth of another method.

pub mod body;
pub mod dice;
pub mod plates;
pub mod polygon;
pub mod tools;
pub mod triangles;

//! What was done to make a part of a file's triangles.

use serde::Serialize;

/// What was done to a file's triangles.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Mending {
    /// Corners that were joined though they do not agree to the last bit.
    pub joined: usize,
    /// Within what distance corners are joined, mm.
    pub join_distance: f64,
    /// How far a corner moved at most, mm.
    pub moved: f64,
    /// Triangles without area that were dropped, or removed by cutting their neighbour at their middle corner.
    pub degenerate: usize,
    /// Cuts of triangles at corners of others that lie on their sides.
    pub cut: usize,
    /// Triangles that were there already, wound alike.
    pub duplicate: usize,
    /// Triangles that lay back to back between two bodies, both of each pair dropped.
    pub back_to_back: usize,
    /// Triangles of which a copy of opposite winding was dropped: a surface that has two sides in the file.
    pub double_sided: usize,
    /// Triangles turned over since their neighbours are wound in the opposite direction.
    pub turned: usize,
    /// Triangles of bodies that were inside out as a whole, turned over.
    pub inside_out: usize,
    /// Holes that were closed in what is a body but for them.
    pub filled: Option<Filled>,
    /// Whether each edge is run as often in one direction as in the other.
    pub closed: bool,
    /// A point at which triangles cannot be made to agree, mm.
    pub unclear: Option<[f64; 3]>,
}

/// Holes that were closed.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Filled {
    /// How many.
    pub holes: usize,
    /// What they were closed with.
    pub triangles: usize,
    /// Diagonal of the largest one's box, mm.
    pub widest: f64,
    /// The middle of that box.
    pub at: [f64; 3],
}

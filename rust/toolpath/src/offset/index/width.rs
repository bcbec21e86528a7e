//! How wide the tree is, and how much of it is built at a time.

/// Children of a node: the lanes that are tested at once.
pub const WIDTH: usize = 8;

/// Triangles, or as much work, between two looks at whether to stop: some milliseconds.
pub const BATCH: usize = 1 << 16;

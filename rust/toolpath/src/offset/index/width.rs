//! How wide the tree is.

/// Children of a node: the lanes that are tested at once.
pub const WIDTH: usize = 8;

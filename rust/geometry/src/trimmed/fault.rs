//! Why a face cannot be laid out.

use thiserror::Error;

/// Why a face cannot be laid out. Its edges are not where they should be: leave it to the kernel that made them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TrimmedFault {
    /// The edges do not close, or run over each other.
    #[error("the face's edges do not close, or cross each other")]
    Border,
    /// Nothing lies within the edges.
    #[error("nothing lies within the face's edges")]
    Empty,
    /// More points than any face needs: the deviation is too small for it.
    #[error("the face would need more than {0} points")]
    TooMany(usize),
}

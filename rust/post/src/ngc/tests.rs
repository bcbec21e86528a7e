//! Programs and the moves that they make.

//! Checking, resolving, planning and verifying whole jobs on a part whose answers are known.

mod check;
mod plan;
mod resolve;
pub mod setup;
mod verify;

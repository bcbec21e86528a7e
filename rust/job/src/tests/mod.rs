//! Checking, resolving, planning and verifying whole jobs on a part whose answers are known.

#![allow(clippy::float_cmp)] // what a job states is resolved exactly

mod check;
mod dsif;
mod plan;
mod resolve;
pub mod setup;
mod verify;

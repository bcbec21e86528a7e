//! What the verifier finds and lets pass, from outside the crate.
//!
//! One binary: each would be linked with the whole crate again.

#![allow(clippy::disallowed_methods, clippy::unwrap_used)] // helpers of tests are not test functions

mod arcs;
mod common;
mod coverage;
mod defects;
mod expectations;
mod frame;
mod holding;
mod leaning;
mod scallops;
mod simulation;
mod speed;
mod tabs;
mod threads;

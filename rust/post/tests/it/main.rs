//! Texts of programs and machines, from outside the crate.
//!
//! One binary: each would be linked with the whole crate again.

#![allow(clippy::disallowed_methods, clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::float_cmp)] // helpers of tests are not test functions

mod arcs;
mod controllers;
mod families;
mod fuzz;
mod machines;
mod posting;
mod reading;
mod rotary;
mod round_trip;
mod support;

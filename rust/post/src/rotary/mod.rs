//! Machines with two axes that turn the part or the tool: their angles for a tool's direction, where their linear axes stand, and
//! the poses that keep a tool to its moves.

mod angles;
mod error;
mod kinematics;
mod poses;

pub use error::RotaryError;
pub use kinematics::RotaryAxes;
pub(crate) use kinematics::{between, difference, dot, larger_turn, norm, unit};
pub(crate) use poses::{poses, Limits, Pose};

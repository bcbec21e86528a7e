//! Machines with two axes that turn the part or the tool: their angles for a tool's direction, where their linear axes stand, and
//! text with both.

mod angles;
mod error;
mod kinematics;
mod poses;
mod text;

pub use error::RotaryError;
pub use kinematics::{Carrier, RotaryAxes, RotaryAxis};
pub use text::{read_rotary, rotary_text, RotaryText};

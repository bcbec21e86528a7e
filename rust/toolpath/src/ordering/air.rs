//! What the tool travels from a pass to the next.

/// Orders that differ by less are equally long, mm.
pub const LEAST: f64 = 1e-6;

/// What the tool travels from a pass to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Height at which rapids cross, mm.
    pub height: f64,
    /// Up to this distance in plan the tool goes straight, mm.
    pub along: f64,
}

//! Limits that planning keeps to and the verifier checks.

/// Deepest gouge allowed, mm: the posted path may lie this far inside the exact envelope, and not more.
pub const GOUGE: f64 = 0.001;
/// Where more than this share of its radius is left, a milling tool has no room: in corners of three square walls it leaves
/// 0.73 of it.
pub const NO_ROOM: f64 = 0.75;

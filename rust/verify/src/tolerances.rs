//! Lengths and angles that several checks allow.

/// What arithmetic may cost, mm: comparisons with limits allow it, and of two positions whose values
/// differ by less the earlier one is named.
pub(crate) const SLACK: f64 = 1e-6;

/// What may be left beside a pass besides the scallop, the tolerance and the mesh's deviation, mm: triangles' corners.
/// Empirical, ten times the tessellation's default bound of 0.001 mm.
pub(crate) const ROUGH: f64 = 0.01;

/// Where a tool that touches a triangle is in others by less than this, it can get there, mm. Empirical, as large as the
/// default tolerance; it does not follow an operation's.
pub(crate) const ROOM: f64 = 0.005;

/// Passes may be this many steps apart: a short last step is joined to the one before it.
pub(crate) const WIDE: f64 = 1.3;

/// Heights that differ by less are one level, mm.
pub(crate) const SAME_LEVEL: f64 = 1e-3;

/// What triangles may add to a wall's angle, rad.
pub(crate) const ANGLE: f64 = 1e-3;

/// Normals whose Z is smaller are a vertical wall's.
pub(crate) const VERTICAL: f64 = 1e-3;

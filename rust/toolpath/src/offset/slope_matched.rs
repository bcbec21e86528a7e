//! The slope-matched offset: the tool's tip for a contact, found by matching slopes (US 2023/0035585).
//!
//! Derivation: docs/concepts/slope-matching.md.

use styluscam_geometry::{Sheet, Tool, Vector};

/// What is special about a slope-matched position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum OffsetFlag {
    /// Nothing: the profile has a point of this slope.
    Regular = 0,
    /// The surface is steeper than the profile: the base's rim touches.
    Rim = 1,
    /// The surface faces down: no vertical tool reaches it.
    Undercut = 2,
}

/// The tip's position with the tool, and the sheet if any, touching the surface at `point` with unit `normal`.
///
/// Exact to rounding and O(1); the tool may interfere elsewhere. With n = (sin phi h, cos phi):
/// CL = P + w t n + r(phi) h - z(phi) k for a sheet of constant thickness, P + w t k + r h - z k for the sine law.
/// On a floor r = 0 by symmetry: with a flat tip the axis stands over the point.
#[must_use]
pub fn slope_matched_offset(tool: &Tool, sheet: Option<&Sheet>, point: Vector, normal: Vector) -> (Vector, OffsetFlag) {
    let across = libm::hypot(normal.x, normal.y);
    let slope = libm::atan2(across, normal.z);
    let flag = if normal.z < -1e-12 {
        OffsetFlag::Undercut
    } else if slope > tool.profile().max_slope() + 1e-12 {
        OffsetFlag::Rim
    } else {
        OffsetFlag::Regular
    };
    let (r, z) = tool.point_at(slope.min(std::f64::consts::FRAC_PI_2));
    let shift =
        normal * sheet.map_or(0.0, Sheet::along_normal) + Vector::z() * sheet.map_or(0.0, Sheet::along_vertical);
    let outward = if across > 0.0 { Vector::new(normal.x / across, normal.y / across, 0.0) } else { Vector::zeros() };
    (point + shift + outward * r - Vector::z() * z, flag)
}

//! The error of a formula that cannot be a profile.

use crate::GeometryError;

/// A defect with its position (key, parameter or character), its reason and a hint.
pub(super) fn refusal(position: String, reason: String, hint: &str) -> GeometryError {
    GeometryError::Profile { place: position, reason, hint: hint.to_owned() }
}

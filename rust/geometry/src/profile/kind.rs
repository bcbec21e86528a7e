//! What every kind of profile knows about itself.

use serde::Serialize;

use super::chain::{Builder, Profile};
use crate::GeometryError;

/// What every kind of profile knows; its keys are its fields.
pub trait ProfileKind {
    /// A document of this kind with sensible numbers, as JSON.
    fn starter() -> &'static str
    where
        Self: Sized;

    /// Radius of the flat at the tip as the document gives it, mm.
    fn tip_flat(&self) -> f64;

    /// Radius of the flat that is put before the curve, mm.
    fn added_flat(&self) -> f64 {
        self.tip_flat()
    }

    /// Diameter of the base, mm, where the document gives it.
    fn diameter(&self) -> Option<f64> {
        None
    }

    /// The profile, from the end of the tip's flat.
    ///
    /// # Errors
    /// A length or angle out of range, keys that exclude each other, a flat that leaves no curve, a curve that is not
    /// convex.
    fn build(&self, tip: Builder) -> Result<Built, GeometryError>;

    /// Random documents of this kind, for tests.
    #[cfg(test)]
    fn any() -> proptest::strategy::BoxedStrategy<Self>
    where
        Self: Sized;
}

/// A profile and what was done to its curve.
pub struct Built {
    /// The curve.
    pub profile: Profile,
    /// What was done to it.
    pub report: ProfileReport,
}

impl From<Profile> for Built {
    fn from(profile: Profile) -> Self {
        Self { profile, report: ProfileReport::default() }
    }
}

/// What was done to a document's curve to make it a profile.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ProfileReport {
    /// Sentences: moved, mirrored, how exact.
    pub notes: Vec<String>,
    /// Largest distance of a given point from the profile, mm; points only.
    #[serde(rename = "fit_deviation_mm")]
    pub fit_deviation: Option<f64>,
}

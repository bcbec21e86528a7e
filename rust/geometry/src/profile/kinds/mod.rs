//! The kinds of profile, one file each: its keys, their ranges, and how it is put together.
//!
//! A new kind is a file with a struct and its [`ProfileKind`], and one line in the list below.

use super::{
    chain::{Builder, Profile},
    kind::{ProfileKind, ProfileReport},
};
use crate::{error::length, GeometryError};

/// Largest radius or height of a profile, mm.
const MOST: f64 = 1e4;

/// Makes the tagged document of all kinds, and what depends on the list: a line is the kind's name in documents, its file
/// and its struct.
macro_rules! kinds {
    ($($name:literal => $file:ident::$kind:ident,)+) => {
        $(mod $file;)+
        $(pub use $file::$kind;)+

        /// A profile as tool and job documents write it. Lengths in mm, angles in degrees. `diameter` is the base's, tip flat
        /// included, and ends the curve where nothing else does.
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(tag = "kind")]
        #[allow(missing_docs)] // documented at each kind's struct
        pub enum ProfileDocument {
            $(#[serde(rename = $name)] $kind($kind),)+
        }

        $(impl From<$kind> for ProfileDocument {
            fn from(document: $kind) -> Self {
                Self::$kind(document)
            }
        })+

        impl ProfileDocument {
            /// A document of each kind with sensible numbers, as JSON.
            #[must_use]
            pub fn starters() -> Vec<&'static str> {
                vec![$($kind::starter(),)+]
            }

            /// The kind's name as documents write it.
            #[must_use]
            pub fn kind(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $name,)+
                }
            }

            fn of_kind(&self) -> &dyn ProfileKind {
                match self {
                    $(Self::$kind(document) => document,)+
                }
            }
        }

        /// Random documents of every kind.
        #[cfg(test)]
        pub fn any_kind() -> impl proptest::strategy::Strategy<Value = ProfileDocument> {
            use proptest::strategy::{Strategy, Union};

            Union::new([$($kind::any().prop_map(ProfileDocument::from).boxed(),)+])
        }
    };
}

kinds! {
    "ball" => ball::Ball,
    "clothoid" => clothoid::Clothoid,
    "parabola" => parabola::Parabola,
    "ellipse" => ellipse::Ellipse,
    "cycloid" => cycloid::Cycloid,
    "power" => power::Power,
    "rounded-rectangle" => rounded_rectangle::RoundedRectangle,
    "bull-nose" => bull_nose::BullNose,
    "barrel" => barrel::Barrel,
    "cone" => cone::Cone,
    "tapered-ball" => tapered_ball::TaperedBall,
    "v" => v::V,
    "flat" => flat::Flat,
    "points" => points::Points,
    "formula" => formula::Formula,
}

impl ProfileDocument {
    /// Radius of the flat at the tip that the document adds to its curve, mm.
    #[must_use]
    pub fn added_flat(&self) -> f64 {
        self.of_kind().added_flat()
    }

    /// Builds the profile.
    ///
    /// # Errors
    /// A length or angle out of range, keys that exclude each other, a flat that leaves no curve, points that are not
    /// convex.
    pub fn build(&self) -> Result<(Profile, ProfileReport), GeometryError> {
        let kind = self.of_kind();
        length("tip_flat", kind.tip_flat())?;
        let mut tip = Builder::default();
        tip.straight(kind.added_flat());
        let built = kind.build(tip)?;
        Ok((based(within_limits(built.profile)?, kind.diameter()), built.report))
    }
}

/// The profile with its base at the very diameter that the document gives, where it is that but for rounding.
fn based(profile: Profile, diameter: Option<f64>) -> Profile {
    let radius = diameter.map(|diameter| diameter / 2.0);
    match radius.filter(|radius| (profile.base().0 - radius).abs() <= 1e-13 * radius) {
        Some(radius) => profile.ending_at(radius),
        None => profile,
    }
}

/// Refuses what no machine could hold: power laws grow fast.
fn within_limits(profile: Profile) -> Result<Profile, GeometryError> {
    let (radius, height) = profile.base();
    if radius <= MOST && height <= MOST {
        return Ok(profile);
    }
    Err(GeometryError::Profile {
        place: "the base".to_owned(),
        reason: format!("the profile reaches r = {radius:.6} mm and z = {height:.6} mm, more than {MOST} mm"),
        hint: "end it at a smaller diameter".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_a_starter_that_builds() {
        for text in ProfileDocument::starters() {
            let document: ProfileDocument = serde_json::from_str(text).unwrap();
            let named: serde_json::Value = serde_json::from_str(text).unwrap();
            assert_eq!(named["kind"], document.kind());
            document.build().unwrap();
        }
    }
}

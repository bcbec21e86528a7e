//! What can be wrong with a shape.

use thiserror::Error;

/// A shape that cannot be used.
///
/// Each variant states when it occurs and what to do about it; `code` is stable.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GeometryError {
    /// A number of a tool or sheet is out of its range. Correct the key named.
    #[error("{key} = {value}: allowed is {allowed}")]
    OutOfRange {
        /// The key of the document.
        key: &'static str,
        /// Its value, as given.
        value: f64,
        /// What is allowed, in words.
        allowed: &'static str,
    },
    /// Keys that are missing or exclude each other. Follow the hint.
    #[error("{0}")]
    Keys(String),
    /// A profile that no tool can have, or a formula that cannot be read. Follow the hint.
    #[error("{place}: {reason}; {hint}")]
    Profile {
        /// Where on the profile or in the formula: `t = 0.83`, `r = 4.1`, `z, character 7`.
        place: String,
        /// What is wrong there.
        reason: String,
        /// What to do about it.
        hint: String,
    },
    /// An array holds NaN or infinity: the reader or the model is at fault.
    #[error("{what} {index} is not a finite number")]
    NotFinite {
        /// Vertex, normal, ...
        what: &'static str,
        /// Its index in the array, from 0.
        index: usize,
    },
    /// A triangle names a vertex that does not exist: the arrays do not belong together.
    #[error("triangle {triangle} names vertex {vertex}, but there are {count} vertices")]
    NoSuchVertex {
        /// The triangle's index, from 0.
        triangle: usize,
        /// The vertex that it names.
        vertex: i64,
        /// How many there are.
        count: usize,
    },
    /// Two arrays that belong together differ in length.
    #[error("{what}: {count} given, {expected} expected")]
    Length {
        /// Which array.
        what: &'static str,
        /// Its length.
        count: usize,
        /// The length that fits.
        expected: usize,
    },
    /// A displacement is known at too few points: measure more of the part.
    #[error("a displacement at {count} points: {fewest} different ones are needed at least")]
    FewSamples {
        /// How many there are.
        count: usize,
        /// How many there must be.
        fewest: usize,
    },
    /// A change of shape needs more triangles than can be worked with: the displacement changes from point to point, as noise
    /// does. Smooth it, or allow a larger deviation.
    #[error("the changed shape needs more than {most} triangles to be followed within {deviation} mm")]
    TooFine {
        /// Most triangles.
        most: usize,
        /// What they may deviate, mm.
        deviation: f64,
    },
    /// No triangle of positive area is left: the selection or the file is empty.
    #[error("the mesh has no triangle of positive area")]
    EmptyMesh,
    /// A mesh that is to be a body does not close: repair it, or export it again as a solid.
    #[error("the mesh is not closed near X{:.3} Y{:.3} Z{:.3}", at[0], at[1], at[2])]
    NotClosed {
        /// Where, mm.
        at: [f64; 3],
    },
    /// Chamfers leave nothing of a level face.
    #[error(
        "the chamfer is too wide for the face beside the edge at X{:.3} Y{:.3} Z{:.3}: from all around it takes all of it; lower the width",
        .at[0], .at[1], .at[2]
    )]
    WideChamfer {
        /// Where the edge begins, mm.
        at: [f64; 3],
    },
    /// The part is larger than any machine: most likely its units are wrong.
    #[error("the mesh reaches {reach:.3e} mm from the origin, more than {limit:.0e} mm: check its units")]
    Huge {
        /// Largest absolute coordinate, mm.
        reach: f64,
        /// What is allowed, mm.
        limit: f64,
    },
}

impl GeometryError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::OutOfRange { .. } => "out-of-range",
            Self::Keys(_) => "keys",
            Self::Profile { .. } => "profile",
            Self::NotFinite { .. } => "not-finite",
            Self::NoSuchVertex { .. } => "no-such-vertex",
            Self::Length { .. } => "length",
            Self::FewSamples { .. } => "few-samples",
            Self::TooFine { .. } => "too-fine",
            Self::EmptyMesh => "empty-mesh",
            Self::NotClosed { .. } => "not-closed",
            Self::WideChamfer { .. } => "wide-chamfer",
            Self::Huge { .. } => "huge-mesh",
        }
    }
}

/// Refuses a length that is not positive or not one that a tool can have.
pub(crate) fn positive_length(key: &'static str, value: f64) -> Result<f64, GeometryError> {
    if value > 1e-6 && value <= 1e4 {
        Ok(value)
    } else {
        Err(GeometryError::OutOfRange { key, value, allowed: "a length above 0 and up to 10000 mm" })
    }
}

/// Refuses an area that is not positive or not one that a tool can have.
pub(crate) fn positive_area(key: &'static str, value: f64) -> Result<f64, GeometryError> {
    if value > 1e-12 && value <= 1e8 {
        Ok(value)
    } else {
        Err(GeometryError::OutOfRange { key, value, allowed: "an area above 0 and up to 1e8 mm^2" })
    }
}

/// Refuses a length that is negative or not one that a tool can have.
pub(crate) fn length(key: &'static str, value: f64) -> Result<f64, GeometryError> {
    if (0.0..=1e4).contains(&value) {
        Ok(value)
    } else {
        Err(GeometryError::OutOfRange { key, value, allowed: "a length from 0 to 10000 mm" })
    }
}

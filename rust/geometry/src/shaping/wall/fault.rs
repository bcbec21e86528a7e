//! Why there is no wall around a part.

use thiserror::Error;

use crate::{GeometryError, Vector};

/// Why no wall can be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WallFault {
    /// Nothing faces up, or no edge closes.
    #[error("the part has no closed outer edge, as seen from above")]
    NoEdge,
    /// The edge lies in a level flange at the blank's plane already.
    #[error("the part's edge lies in a level flange")]
    Flange,
    /// The edge climbs more steeply than the wall: from nowhere else on it can the wall rise to its highest points.
    #[error("the part's edge climbs more steeply than the wall at X{:.3} Y{:.3} Z{:.3}", at.x, at.y, at.z)]
    Steep {
        /// Where, in the frame of the mesh.
        at: Vector,
    },
    /// The part's own face falls outwards at its edge: a wall that leaves it by the same slope would go down first.
    #[error("the part falls outwards at its edge, at X{:.3} Y{:.3} Z{:.3}", at.x, at.y, at.z)]
    Falls {
        /// Where, in the frame of the mesh.
        at: Vector,
    },
    /// The part's edge does not lie within the line at which the wall is to end.
    #[error("the part reaches {beyond:.3} mm beyond the line within which its wall is to end")]
    Outside {
        /// By how much, mm.
        beyond: f64,
    },
    /// The part rises above the blank's plane.
    #[error("the part rises {beyond:.3} mm beyond the blank's plane")]
    Beyond {
        /// By how much, mm.
        beyond: f64,
    },
    /// Less height than the arc takes.
    #[error("the arc takes {least:.3} mm of height, and there are {height:.3}")]
    Arc {
        /// What it takes, mm.
        least: f64,
        /// What there is, mm.
        height: f64,
    },
    /// Edges cross in plan: the part overhangs itself.
    #[error("the part's edges cross as seen from above")]
    Crossed,
    /// Too many triangles.
    #[error("the wall takes too many triangles to be followed within {tolerance} mm")]
    TooFine {
        /// What they may deviate, mm.
        tolerance: f64,
    },
    /// The mesh of both is none.
    #[error(transparent)]
    Mesh(#[from] GeometryError),
}

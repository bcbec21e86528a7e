//! Why a path could not be planned.

use styluscam_motion::Cancelled;
use thiserror::Error;

/// Planning failed; nothing was planned.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlanError {
    /// No position of the tool touches the selected faces: the selection, the heights or the tool do not fit.
    #[error("the tool reaches none of the selected faces{0}")]
    NothingReached(String),
    /// Levels exist, but no loop lies on the selected faces at any of them. Check z_top, z_bottom and the faces.
    #[error(
        "no level meets the selected faces between Z {bottom:.3} and Z {top:.3}: flat faces need rows; else check \
         z_top, z_bottom, step and the faces"
    )]
    Empty {
        /// Lowest level asked for, mm.
        bottom: f64,
        /// Highest level, mm.
        top: f64,
    },
    /// What the part's tessellation and the machine's rounding leave of the tolerance is not enough to fit a path.
    #[error(
        "tolerance = {tolerance} mm: the triangles' deviation, inward and outward together ({tessellation:.4} mm), and the \
         machine's rounding ({rounding:.4} mm) leave nothing to fit the path with; {}raise tolerance or lower part.tolerance",
        .decimals.map_or(String::new(), |d| format!("add options = {{ decimals = {d} }} to [machine], or "))
    )]
    Budget {
        /// The tolerance asked for, mm.
        tolerance: f64,
        /// What the tessellation takes, mm.
        tessellation: f64,
        /// What rounding takes, mm.
        rounding: f64,
        /// Decimal places of coordinates with which it would be enough; None where the machine has none that help.
        decimals: Option<u32>,
    },
    /// The tolerance of waterlines asked for by height does not fit the part or the tool.
    #[error(
        "tolerance = {tolerance} mm: it must exceed the part's checked deviation, {deviation} mm, and be at most {most:.3} \
         mm, a tenth of the tool's diameter"
    )]
    LoopTolerance {
        /// The tolerance asked for, mm.
        tolerance: f64,
        /// How far the triangles deviate, inward and outward together, mm.
        deviation: f64,
        /// The largest tolerance, mm.
        most: f64,
    },
    /// The path would have more points than a program can hold: the step is too small for the part.
    #[error("{what} = {value} makes {count} passes, more than {limit}: raise it")]
    TooMany {
        /// The key.
        what: &'static str,
        /// Its value, mm.
        value: f64,
        /// Passes that would result.
        count: usize,
        /// Passes at most.
        limit: usize,
    },
    /// Between two positions of the main tool that are as good as one its contact jumps, and the tool on the other side of the
    /// sheet would have to jump with it.
    #[error(
        "at X{:.3} Y{:.3} Z{:.3} the main tool touches two places at once, and the tool below cannot be opposite to both: it \
         would move {jump:.3} mm while the main one stands; give the main tool a smaller radius than the corner there, or end the \
         operation above it with z_bottom",
        .at[0], .at[1], .at[2]
    )]
    Jump {
        /// The main tool's tip, mm.
        at: [f64; 3],
        /// How far the tool below would move, mm.
        jump: f64,
    },
    /// Stopped from outside.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for PlanError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl PlanError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::NothingReached(_) => "nothing-reached",
            Self::Empty { .. } => "empty-path",
            Self::Budget { .. } | Self::LoopTolerance { .. } => "tolerance-budget",
            Self::TooMany { .. } => "too-many-passes",
            Self::Jump { .. } => "contact-jumps",
            Self::Cancelled => "cancelled",
        }
    }
}

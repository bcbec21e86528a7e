//! Why a strip cannot be milled with the flank of a tool.

use thiserror::Error;

/// No positions were found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FlankError {
    /// The rails meet or cross: a ruling has no length.
    #[error("the rails meet at u = {u:.4}: a ruling needs a length; part the surface there")]
    NoRuling {
        /// Share of the way along the rails, 0 to 1.
        u: f64,
    },
    /// A rail stands still or turns back.
    #[error("rail{rail} has a cusp at u = {u:.4}: it has no direction there; part the surface there, or give the rail without it")]
    Cusp {
        /// Which rail, 0 or 1.
        rail: usize,
        /// Share of the way along it, 0 to 1.
        u: f64,
    },
    /// A rail turns in a point, or goes on elsewhere.
    #[error(
        "rail{rail} has a corner or a gap at u = {u:.4}: the axis would have to jump there; part the surface there"
    )]
    Corner {
        /// Which rail, 0 or 1.
        rail: usize,
        /// Share of the way along it, 0 to 1.
        u: f64,
    },
    /// The rulings cross one another.
    #[error("the rails run in opposite directions: reverse one of them")]
    Opposite,
    /// Rails that no part has.
    #[error("rail{rail} is {length:.3e} mm long and reaches to {farthest:.3e} mm from the zero point: 0.001 mm to 1e6 mm are allowed")]
    Size {
        /// Which rail, 0 or 1.
        rail: usize,
        /// Its length, mm.
        length: f64,
        /// Its largest coordinate, mm.
        farthest: f64,
    },
    /// A ruling runs along a rail: the surface has no normal.
    #[error("the ruling at u = {u:.4} runs along rail{rail}: the surface has no normal there; part it there")]
    NoNormal {
        /// Which rail, 0 or 1.
        rail: usize,
        /// Share of the way along it, 0 to 1.
        u: f64,
    },
    /// The surface is hollow with a smaller radius than the tool's.
    #[error("the surface is hollow with a radius of {hollow:.3} mm at u = {u:.4}, the tool's is {radius} mm: take a smaller tool, or the other side")]
    TooLarge {
        /// Share of the way along the rails, 0 to 1.
        u: f64,
        /// The surface's radius, mm.
        hollow: f64,
        /// The tool's radius, mm.
        radius: f64,
    },
    /// No line lies beside both rails at the tool's radius there, with the contacts where the method has them.
    #[error("no position of a tool of radius {radius:.3} mm touches both rails at u = {u:.4} with the contacts where the method has them: the surface is twisted too much; take a smaller tool, or method swept, which spreads them")]
    NoPosition {
        /// Share of the way along the rails, 0 to 1.
        u: f64,
        /// The tool's radius, mm.
        radius: f64,
    },
    /// The same with the contacts up to a ruling's length apart.
    #[error("no position of a tool of radius {radius:.3} mm touches both rails at u = {u:.4}, its contacts up to a ruling's length apart along them: the surface is twisted too much; take a tool of at most {most:.3} mm radius there, or offset points of the ruling instead (methods two-points, one-point)")]
    Nowhere {
        /// Share of the way along the rails, 0 to 1.
        u: f64,
        /// The tool's radius, mm.
        radius: f64,
        /// The largest of a tool that touches both there, mm.
        most: f64,
    },
    /// The ruling cannot be touched as well as both rails.
    #[error("no position touches both rails and the ruling at u = {u:.4}: place the tool by another method, as swept")]
    NoThreePoints {
        /// Share of the way along the rails, 0 to 1.
        u: f64,
    },
    /// Fewer positions than make a movement, or more than any program has.
    #[error("count = {0}: two positions at least, and 100000 at most")]
    Count(usize),
    /// No distance by which straight moves may lie off.
    #[error("tolerance = {0} mm: a length from 1e-6 mm on is needed")]
    Tolerance(f64),
    /// A tolerance that asks for more positions than any program has.
    #[error("tolerance = {tolerance} mm: more than {most} positions would be needed; allow more")]
    TooFine {
        /// The tolerance, mm.
        tolerance: f64,
        /// Positions at most.
        most: usize,
    },
    /// A radius that no tool has.
    #[error("radius = {0} mm: a length above 0 is needed")]
    Radius(f64),
    /// A half angle that no flank has.
    #[error("half_angle = {0} deg: 0 to 80 is needed, and the wide end above")]
    Taper(f64),
}

impl FlankError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoRuling { .. } => "rails-meet",
            Self::Cusp { .. } => "rail-cusp",
            Self::Corner { .. } => "rail-corner",
            Self::Opposite => "rails-opposite",
            Self::Size { .. } => "rail-size",
            Self::NoNormal { .. } => "no-normal",
            Self::TooLarge { .. } => "tool-too-large",
            Self::NoPosition { .. } | Self::Nowhere { .. } => "no-position",
            Self::NoThreePoints { .. } => "no-three-points",
            Self::Count(_) => "count",
            Self::Tolerance(_) | Self::TooFine { .. } => "tolerance",
            Self::Radius(_) => "radius",
            Self::Taper(_) => "taper",
        }
    }
}

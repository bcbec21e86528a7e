//! How what is left of a path's tolerance is shared between the surface's distance and the chords' deviation.

use crate::PlanError;

/// Share of what is left that a chord may deviate to either side. The planned surface lies in the middle; the rest is a
/// reserve on both sides.
pub const POSTED_EACH_SIDE: f64 = 0.48;
/// The same for waterlines asked for by height, which no machine posts.
const LOOPS_EACH_SIDE: f64 = 0.4;
/// Largest tolerance of such waterlines, as a share of the tool's diameter: coarser chords lose its shape.
const LARGEST_OF_LOOPS: f64 = 0.1;
/// Spacing of the grid that finds them, as a share of the tool's diameter.
const LOOP_SPACING: f64 = 0.08;

/// Where the planned surface lies, and how far chords may deviate from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Chords deviate by at most this to either side of the planned surface, mm.
    pub deviation: f64,
    /// The planned surface lies this far outside the part's triangles, mm.
    pub margin: f64,
}

impl Budget {
    /// Shares out `left`, the tolerance less tessellation and rounding, mm. `inward` is how far the triangles and the
    /// rounding may lie inside the part, mm.
    #[must_use]
    pub fn sharing(left: f64, inward: f64, each_side: f64) -> Self {
        Self { deviation: each_side * left, margin: inward + 0.5 * left }
    }
}

/// What waterlines asked for by height are computed with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopBudget {
    /// Shares of the tolerance.
    pub shares: Budget,
    /// Spacing of the grid that finds loops, mm.
    pub spacing: f64,
}

impl LoopBudget {
    /// Of a `tolerance` (mm), for a part whose triangles lie up to `inward` inside and `outward` outside the material (mm)
    /// and a tool of a `diameter` (mm).
    ///
    /// # Errors
    /// [`PlanError::LoopTolerance`]: the triangles leave nothing of the tolerance, or it is too large for the tool.
    pub fn new(tolerance: f64, [inward, outward]: [f64; 2], diameter: f64) -> Result<Self, PlanError> {
        let (left, most) = (tolerance - inward - outward, LARGEST_OF_LOOPS * diameter);
        if left > 0.0 && tolerance <= most {
            let shares = Budget::sharing(left, inward, LOOPS_EACH_SIDE);
            return Ok(Self { shares, spacing: LOOP_SPACING * diameter });
        }
        Err(PlanError::LoopTolerance { tolerance, deviation: inward + outward, most })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_deviate_by_two_fifths_of_what_the_triangles_leave() {
        let found = LoopBudget::new(0.005, [0.001, 0.0005], 10.0).unwrap();
        assert!((found.shares.deviation - 0.4 * 0.0035).abs() < 1e-15 && (found.spacing - 0.8).abs() < 1e-15);
        assert!((found.shares.margin - (0.001 + 0.5 * 0.0035)).abs() < 1e-15);
    }

    #[test]
    fn a_tolerance_that_nothing_is_left_of_or_too_large_for_the_tool_is_an_error() {
        for tolerance in [0.0015, 0.0, -1.0, 1.000_001, f64::NAN] {
            let error = LoopBudget::new(tolerance, [0.001, 0.0005], 10.0).unwrap_err();
            assert_eq!(error.code(), "tolerance-budget");
        }
        assert!(LoopBudget::new(1.0, [0.001, 0.0005], 10.0).is_ok());
    }
}

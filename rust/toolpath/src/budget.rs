//! How what is left of a path's tolerance is shared between the surface's distance and the chords' deviation.

/// Share of what the tolerance leaves that a chord of a posted path may deviate to either side of the planned surface: the
/// surface lies in the middle of what is left, and 0.02 on each side stay for rounding of this arithmetic.
pub const POSTED_EACH_SIDE: f64 = 0.48;
/// The same for loops that nobody posts, which are asked for point by point and tested in their chords' middles only.
pub const LOOPS_EACH_SIDE: f64 = 0.4;

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

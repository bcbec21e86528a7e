//! How what is left of a path's tolerance is shared between the surface's distance and the chords' deviation.

/// Share of what is left that a chord may deviate to either side. The planned surface lies in the middle; the rest is a
/// reserve on both sides.
pub const POSTED_EACH_SIDE: f64 = 0.48;
/// The same for waterlines asked for by height, which no machine posts.
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

//! What of the order of passes is free.

/// What of the order of passes is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Freedom<'a> {
    /// That of the passes of a group (a level or a row): groups follow one after the other.
    WithinGroups,
    /// A pass follows those of the groups above it that lie within a reach of it in plan, or that enclose it.
    OfAreas {
        /// mm.
        reach: f64,
        /// Whether what is inside of a loop is done before the next loop below around it: sheet hangs there.
        inside_first: bool,
    },
    /// Rows in any order; each set, which begins with one of these groups, after those before it.
    OfRows {
        /// Numbers of the first groups of all sets, ascending.
        sets: &'a [usize],
        /// Whether a row may be followed in its other direction.
        is_reversible: bool,
        /// Rows of another set that are within this reach come first, mm.
        reach: f64,
    },
}

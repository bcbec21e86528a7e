//! Parallel rows in plan.

/// How the rows lie: directions along and across them, and the distance between two of them, mm.
#[derive(Clone, Copy)]
pub(super) struct Pattern {
    pub along: [f64; 2],
    pub across: [f64; 2],
    pub stepover: f64,
}

impl Pattern {
    /// A position in plan, along and across the rows.
    pub fn along_across(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.along, self.across].map(|axis| x * axis[0] + y * axis[1])
    }
}

/// A line of the pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// Its position across, mm.
    pub across: f64,
    /// From and to along it, mm.
    pub range: [f64; 2],
}

/// From where to where along it a triangle (along, across) is cut at a position across.
pub(super) fn share(corners: &[[f64; 2]; 3], across: f64) -> Option<[f64; 2]> {
    let mut cuts = (0..3).filter_map(|i| {
        let ([a, from], [b, to]) = (corners[i], corners[(i + 1) % 3]);
        ((from < across) != (to < across)).then(|| a + (b - a) * (across - from) / (to - from))
    });
    let (a, b) = (cuts.next()?, cuts.next()?);
    Some([a.min(b), a.max(b)])
}

/// Rows a step apart in the middle of a band.
pub(super) fn spread([low, high]: [f64; 2], count: usize, step: f64) -> impl Iterator<Item = f64> {
    let first = 0.5 * (low + high - (count - 1) as f64 * step);
    (0..count).map(move |row| first + row as f64 * step)
}

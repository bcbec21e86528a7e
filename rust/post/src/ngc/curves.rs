//! Bezier curves as chords: G5 (cubic) and G5.1 (quadratic), in the XY plane.

use super::block::Block;
use super::fault::TraceFault;
use super::note::Gap;
use super::path::SAG;
use super::tracer::Tracer;

/// Chords of one curve.
const CHORDS: f64 = 10_000.0;

impl Tracer<'_> {
    pub(super) fn curve(&mut self, block: &Block, code: u32) -> Result<(), TraceFault> {
        self.begin()?;
        let start = self.position;
        let end = self.target(block, false)?;
        let unit = self.modes.unit();
        let length = |letter| block.word(letter).map(|word| word * unit);
        if code == 51 {
            let [i, j] = [b'i', b'j'].map(|letter| length(letter).unwrap_or(0.0));
            return self.chords(&[start, [start[0] + i, start[1] + j, 0.0], end]);
        }
        let before = self.tangent.take().unwrap_or_default();
        let [i, j] = [length(b'i').unwrap_or(-before[0]), length(b'j').unwrap_or(-before[1])];
        let [p, q] = [b'p', b'q'].map(|letter| length(letter).unwrap_or(0.0));
        self.chords(&[start, [start[0] + i, start[1] + j, 0.0], [end[0] + p, end[1] + q, 0.0], end])?;
        self.tangent = Some([p, q]);
        Ok(())
    }

    /// Along the curve of these control points; the third axis rises evenly.
    fn chords(&mut self, points: &[[f64; 3]]) -> Result<(), TraceFault> {
        let count = chord_count(points);
        let (first, last) = (self.position, points.last().copied().unwrap_or(self.position));
        for i in 1..count {
            let share = f64::from(i) / f64::from(count);
            let [x, y] = [0, 1].map(|axis| bezier(points.iter().map(|point| point[axis]).collect(), share));
            self.feed_to([x, y, first[2] + share * (last[2] - first[2])])?;
        }
        self.feed_to(last)
    }

    /// G5.2 and G5.3: straight to the next control point.
    pub(super) fn control_point(&mut self, block: &Block) -> Result<(), TraceFault> {
        self.note(Gap::Nurbs);
        self.begin()?;
        let end = self.target(block, false)?;
        self.feed_to(end)
    }
}

/// How many chords stay within the sag: G. Wang, "The subdivision method for finding the intersection between two Bezier
/// curves or surfaces", 1984.
fn chord_count(points: &[[f64; 3]]) -> u32 {
    let bend = points.windows(3).map(|three| {
        let [x, y] = [0, 1].map(|axis| three[0][axis] - 2.0 * three[1][axis] + three[2][axis]);
        libm::hypot(x, y)
    });
    let degree = points.len().saturating_sub(1) as f64;
    let count = (0.125 * degree * (degree - 1.0) * bend.fold(0.0, f64::max) / SAG).sqrt().ceil();
    count.clamp(1.0, CHORDS) as u32
}

/// De Casteljau's construction for one coordinate.
fn bezier(mut values: Vec<f64>, share: f64) -> f64 {
    while values.len() > 1 {
        values = values.windows(2).map(|two| two[0] + share * (two[1] - two[0])).collect();
    }
    values.first().copied().unwrap_or_default()
}

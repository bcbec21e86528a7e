//! Proof by interval arithmetic that a curve turns upwards everywhere, not only at the points that were looked at.
//!
//! The curve is halved into cells until over each, by outward-rounded intervals, both derivatives are finite, the tangent
//! does not leave a half plane, and r' z'' - r'' z' is not negative. Where the last cannot be shown, the cell's slope
//! falls by at most |r' z'' - r'' z'| / speed^2 times its width in the parameter. From all such falls together follows
//! how deep a hollow can be ([`deepest`]), and cells are halved on until that is at most [`HOLLOW`] of the size.
//!
//! What is guaranteed where [`prove`] gives a [`Proof`], for the formula with its numbers as f64:
//! - r and z are twice continuously differentiable by the parameter and the tangent turns by less than half a turn in
//!   every cell; from a tip and to a base whose slopes are within 0 and 90 degrees, so are all others, but for `fall`.
//! - No point of the curve lies higher over the curve's lower convex hull than `hollow`.
//!
//! A cell at the tip or the base need not be proved where it is [`TINY`] of the size, in r and z, or so in one of them
//! and [`SMALL`] in the other: there only its two ends have been looked at, and between them it is taken to rise.
//!
//! See docs/concepts/convexity.md.

use std::fmt;

use super::interval::Interval;
use super::number::Number;
use super::proof::refuse_defect;
use super::sample::{short, Enclosure, Sample, Source};
use crate::GeometryError;

/// Deepest hollow that is let pass, in parts of the size.
const HOLLOW: f64 = 1e-9;
/// Most that the slope may fall in all, rad.
const FALL: f64 = 1e-6;
/// Hollow of one cell that is let pass at first, in parts of the size, and what it is divided by if all are too many.
const CELL_HOLLOW: f64 = 1e-10;
const STRICTER: f64 = 64.0;
/// Extent of a cell at an end that need not be proved, in parts of the size: in r or z, and in the other one.
const TINY: f64 = 5e-11;
const SMALL: f64 = 1e-6;
/// Most evaluations over intervals, and most operators and functions in them: some 50 ms.
const MOST_EVALUATIONS: usize = 30_000;
const MOST_OPERATIONS: usize = 400_000;
/// dz/dr of a cell in which radii are too coarse to distinguish heights.
const STEEP: f64 = 1e3;
/// What to do about a curve without a proof.
const HINT: &str = "it needs a continuous tangent and curvature, and a formula in which fewer large terms cancel";
/// What rounding adds to slopes and lengths, rad and in parts of the size.
const ROUNDING: f64 = 1e-14;

/// What was proved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Proof {
    /// No hollow is deeper, mm.
    pub hollow: f64,
    /// The slope falls by no more in all, rad.
    pub fall: f64,
    /// Evaluations over intervals that it took.
    pub evaluations: usize,
}

impl fmt::Display for Proof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { hollow, fall, evaluations } = self;
        let (hollow, fall) = (short(*hollow), short(*fall));
        write!(
            f,
            "no hollow deeper than {hollow} mm, its slope falling by {fall} rad at most (evaluations: {evaluations})"
        )
    }
}

/// A position between two stretches where they do not quite meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    /// How much the slope falls there, rad.
    pub fall: f64,
    /// How far the ends are apart, mm.
    pub gap: f64,
}

/// A piece of the curve.
#[derive(Clone, Debug)]
struct Cell {
    from: Sample,
    to: Sample,
    /// It begins at the tip; it ends at the base.
    ends: [bool; 2],
    /// By how much the slope may fall along it, rad; infinite where nothing is known.
    fall: f64,
    /// Its length at most, mm.
    length: f64,
    /// How deep a hollow within it can be, mm.
    hollow: f64,
    /// It is not looked at again.
    settled: bool,
    /// A joint between two stretches.
    joint: bool,
}

/// Proves the stretches of a source, in order from tip to base, with what lies between them.
pub(super) fn prove(
    source: &dyn Source,
    stretches: &[[Sample; 2]],
    joints: &[Joint],
    size: f64,
) -> Result<Proof, GeometryError> {
    let mut prover = Prover { source, size, normal: None, evaluations: 0, spared: 0.0 };
    let mut cells = prover.cells(stretches, joints);
    let mut allowed = CELL_HOLLOW * size;
    loop {
        cells = prover.refined(cells, allowed)?;
        let fall: f64 = cells.iter().map(|cell| cell.fall).sum();
        let length: f64 = cells.iter().map(|cell| cell.length).sum();
        // over the whole length at first, which is often enough
        let mut hollow = 0.25 * fall * length;
        if hollow > 0.1 * HOLLOW * size {
            hollow = deepest(&cells, &prover.knots(&cells));
        }
        hollow += prover.spared + joints.iter().map(|joint| joint.gap).fold(0.0, f64::max);
        if hollow <= HOLLOW * size && fall <= FALL {
            return Ok(Proof { hollow, fall, evaluations: prover.evaluations });
        }
        allowed /= STRICTER;
        if cells.iter().all(|cell| cell.settled || cell.hollow <= allowed) && allowed < f64::MIN_POSITIVE {
            let worst = cells.iter().max_by(|a, b| a.fall.total_cmp(&b.fall));
            return Err(prover.no_proof(worst.unwrap_or(&cells[0])));
        }
    }
}

/// Proves that the stretches of a source are a straight line of a slope, rad, but for `hollow`.
pub(super) fn prove_straight(
    source: &dyn Source,
    stretches: &[[Sample; 2]],
    slope: f64,
    size: f64,
) -> Result<Proof, GeometryError> {
    let (sin, cos) = libm::sincos(slope);
    let mut prover = Prover { source, size, normal: Some([-sin, cos]), evaluations: 0, spared: 0.0 };
    let cells = prover.cells(stretches, &[]);
    let cells = prover.refined(cells, CELL_HOLLOW * size)?;
    let off = |sample: &Sample| (sample.point[1] * cos - sample.point[0] * sin).abs();
    let ends = cells.iter().map(|cell| off(&cell.to)).fold(0.0, f64::max);
    let within = cells.iter().map(|cell| cell.hollow).fold(0.0, f64::max);
    let hollow = 2.0 * (ends + within) + prover.spared;
    if hollow > HOLLOW * size {
        let worst = cells.iter().max_by(|a, b| off(&a.to).total_cmp(&off(&b.to)));
        return Err(prover.no_proof(worst.unwrap_or(&cells[0])));
    }
    Ok(Proof { hollow, fall: 0.0, evaluations: prover.evaluations })
}

struct Prover<'a> {
    source: &'a dyn Source,
    size: f64,
    /// Of the line, if it is to be one.
    normal: Option<[f64; 2]>,
    evaluations: usize,
    /// How deep a hollow the cells at the ends that are not proved can make, mm.
    spared: f64,
}

impl Prover<'_> {
    /// Each stretch as a cell, nothing known.
    fn cells(&mut self, stretches: &[[Sample; 2]], joints: &[Joint]) -> Vec<Cell> {
        let last = stretches.len().saturating_sub(1);
        let mut cells = Vec::with_capacity(64);
        for (index, [from, to]) in stretches.iter().enumerate() {
            cells.push(self.cell(*from, *to, [index == 0, index == last]));
            if let Some(Joint { fall, gap }) = joints.get(index) {
                let (fall, length) = (*fall, *gap);
                let hollow = fall * length;
                cells.push(Cell {
                    from: *to,
                    to: *to,
                    ends: [false; 2],
                    fall,
                    length,
                    hollow,
                    settled: true,
                    joint: true,
                });
            }
        }
        cells
    }

    fn cell(&mut self, from: Sample, to: Sample, ends: [bool; 2]) -> Cell {
        self.evaluations += 1;
        let [dr, dz] = extents(&from, &to);
        let mut length = dr + dz + ROUNDING * self.size;
        let (mut fall, mut hollow) = (f64::INFINITY, f64::INFINITY);
        if let Some(piece) = self.source.enclose(&from, &to) {
            fall = falls(&piece, ends[0] || ends[1]);
            let rises = piece.d.iter().all(|d| d.lo >= 0.0);
            let fastest = piece.speed().hi * piece.width;
            length = if rises { length.min(fastest) } else { fastest };
            hollow = match self.normal {
                None => 0.125 * fall * length,
                Some(normal) => sag(&piece, normal),
            };
        }
        Cell { from, to, ends, fall, length, hollow, settled: false, joint: false }
    }

    /// The cells, halved until none is worse than `allowed`.
    fn refined(&mut self, cells: Vec<Cell>, allowed: f64) -> Result<Vec<Cell>, GeometryError> {
        let mut refined = Vec::with_capacity(cells.len());
        let mut open = Vec::new();
        for cell in cells {
            open.push(cell);
            while let Some(cell) = open.pop() {
                if cell.settled || cell.hollow <= allowed {
                    refined.push(cell);
                } else if let Some(end) = self.as_end(&cell) {
                    refined.push(end);
                } else {
                    let [left, right] = self.halved(&cell)?;
                    open.push(right);
                    open.push(left);
                }
            }
        }
        Ok(refined)
    }

    fn halved(&mut self, cell: &Cell) -> Result<[Cell; 2], GeometryError> {
        let spent = self.evaluations >= MOST_EVALUATIONS
            || self.evaluations.saturating_mul(self.source.operations()) >= MOST_OPERATIONS;
        let Some(middle) = self.source.between(&cell.from, &cell.to).filter(|_| !spent) else {
            return Err(self.no_proof(cell));
        };
        if self.source.is_given() {
            refuse_defect(self.source, &cell.from, &middle, self.size)?;
        } else if cell.ends == [false; 2] && self.slope(&cell.from)[0] - self.slope(&middle)[1] > FALL {
            return Err(self.source.refuse(&middle, "the polynomials for the curve are concave", HINT));
        }
        let [tip, base] = cell.ends;
        Ok([self.cell(cell.from, middle, [tip, false]), self.cell(middle, cell.to, [false, base])])
    }

    fn no_proof(&self, cell: &Cell) -> GeometryError {
        let position = self.source.between(&cell.from, &cell.to).unwrap_or(cell.from);
        let [dr, dz] = extents(&cell.from, &cell.to);
        if dr <= TINY * self.size && dz > STEEP * dr {
            let reason = "the curve cannot be proved convex here: it is so nearly upright that z by r rounds too much";
            let hint = "write it as r(t), z(t) or as implicit, or end it at a slightly smaller diameter";
            return self.source.refuse(&position, reason, hint);
        }
        self.source.refuse(&position, "the curve cannot be proved convex here", HINT)
    }

    /// A cell at the tip or base that is too small to matter.
    fn as_end(&mut self, cell: &Cell) -> Option<Cell> {
        let [dr, dz] = extents(&cell.from, &cell.to);
        let (less, more) = (dr.min(dz), dr.max(dz));
        let rises = less >= -ROUNDING * self.size;
        if !(cell.ends[0] || cell.ends[1]) || !rises || less > TINY * self.size || more > SMALL * self.size {
            return None;
        }
        // a point, but for its extent on either side of a hull
        let (mut fall, mut length, mut spared) = (0.0, 0.0, 2.0 * (less.abs() + more));
        if more > TINY * self.size {
            // a straight line, if it continues the curve
            let chord = libm::atan2(dz, dr);
            let slope = |sample: &Sample| self.slope(sample);
            let falls = [
                if cell.ends[0] { chord - slope(&cell.to)[0] } else { 0.0 },
                if cell.ends[1] { slope(&cell.from)[1] - chord } else { 0.0 },
            ];
            // not so for NaN
            let continues = falls[0] + falls[1] < FALL;
            if !continues {
                return None;
            }
            (fall, length, spared) = (falls[0].max(0.0) + falls[1].max(0.0), dr + dz, less.abs());
        }
        self.spared += spared;
        Some(Cell { fall, length, hollow: 0.125 * fall * length, settled: true, ..cell.clone() })
    }

    /// Slope at a point, rad: not less and not more.
    fn slope(&self, sample: &Sample) -> [f64; 2] {
        let unknown = [f64::NEG_INFINITY, f64::INFINITY];
        let Some(piece) = self.source.enclose(sample, sample).filter(keeps_to_a_half_plane) else { return unknown };
        let [r, z] = piece.d;
        // the corners of the box at which the directions end
        let least = libm::atan2(z.lo, if z.lo >= 0.0 { r.hi } else { r.lo }) - ROUNDING;
        let most = libm::atan2(z.hi, if z.hi >= 0.0 { r.lo } else { r.hi }) + ROUNDING;
        if least.is_nan() || most.is_nan() {
            return unknown;
        }
        [least, most]
    }

    /// Slopes between the cells, the unknown ones of tip and base around them.
    fn knots(&mut self, cells: &[Cell]) -> Vec<[f64; 2]> {
        self.evaluations += cells.len();
        let unknown = [f64::NEG_INFINITY, f64::INFINITY];
        let inner = cells.windows(2).map(|pair| self.slope(if pair[0].joint { &pair[1].from } else { &pair[0].to }));
        std::iter::once(unknown).chain(inner).chain(std::iter::once(unknown)).collect()
    }
}

/// How much r and z rise, mm.
fn extents(from: &Sample, to: &Sample) -> [f64; 2] {
    [to.point[0] - from.point[0], to.point[1] - from.point[1]]
}

/// By how much the slope may fall over a piece, rad; infinite where nothing is known.
fn falls(piece: &Enclosure, at_end: bool) -> f64 {
    let turning = piece.turning.lo;
    if turning.is_nan() || !keeps_to_a_half_plane(piece) {
        return f64::INFINITY;
    }
    let slowest = piece.speed().lo;
    if turning >= 0.0 && (slowest > 0.0 || at_end) {
        return 0.0;
    }
    let fall = -turning / (slowest * slowest) * piece.width * (1.0 + ROUNDING);
    if fall.is_nan() {
        f64::INFINITY
    } else {
        fall
    }
}

/// The tangent turns by less than half a turn.
fn keeps_to_a_half_plane(Enclosure { d: [r, z], .. }: &Enclosure) -> bool {
    r.lo > 0.0 || z.lo > 0.0 || (r.lo >= 0.0 && z.lo >= 0.0)
}

/// How far a piece may be from its chord across a line, mm.
fn sag(piece: &Enclosure, normal: [f64; 2]) -> f64 {
    if !keeps_to_a_half_plane(piece) {
        return f64::INFINITY;
    }
    let across = piece.dd[0] * Interval::exact(normal[0]) + piece.dd[1] * Interval::exact(normal[1]);
    let sag = 0.125 * across.size() * piece.width * piece.width * (1.0 + ROUNDING);
    if sag.is_nan() {
        f64::INFINITY
    } else {
        sag
    }
}

/// The deepest hollow that falls of the slope can make, mm, given the slopes before, between and after the cells.
///
/// A hollow lies over a line that touches the curve at two points a and b, so the slope at b is not above that at a: it
/// spans only cells between which the slope has not risen by more than what it may fall within them. The height h over
/// the line is zero at both and h'' by arc length is not below the (negative) curvature, so by the Green function
/// (x - a)(b - y)/(b - a) of h'' it is nowhere above a quarter of the length from a to b times the falls between; and
/// above an eighth, if they are spread evenly as in one cell.
fn deepest(cells: &[Cell], knots: &[[f64; 2]]) -> f64 {
    let mut lowest_from = vec![f64::INFINITY; cells.len() + 1];
    for (j, cell) in cells.iter().enumerate().rev() {
        lowest_from[j] = lowest_from[j + 1].min(knots[j][0] - cell.fall);
    }
    let mut sums = Vec::with_capacity(cells.len() + 1);
    sums.push([0.0, 0.0]);
    let (mut fall, mut length) = (0.0, 0.0);
    for cell in cells {
        (fall, length) = (fall + cell.fall, length + cell.length);
        sums.push([fall, length]);
    }
    let mut deepest: f64 = 0.0;
    for (i, cell) in cells.iter().enumerate() {
        let highest = knots[i + 1][1] + cell.fall;
        let end = i + lowest_from[i..cells.len()].partition_point(|lowest| *lowest <= highest);
        let hollow =
            if end <= i + 1 { cell.hollow } else { 0.25 * (sums[end][0] - sums[i][0]) * (sums[end][1] - sums[i][1]) };
        deepest = deepest.max(hollow);
    }
    deepest * (1.0 + 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(fall: f64, length: f64) -> Cell {
        let nowhere = Sample { stretch: 0, p: 0.0, point: [0.0; 2], d: [0.0; 2], dd: [0.0; 2] };
        let hollow = 0.125 * fall * length;
        Cell { from: nowhere, to: nowhere, ends: [false; 2], fall, length, hollow, settled: false, joint: false }
    }

    const UNKNOWN: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    #[test]
    fn a_hollow_spans_what_does_not_rise_by_more_than_falls() {
        // 1e-9 rad in 1 mm between two parts of 5 mm, straight: half of the 5 mm over all 11 at most
        let cells = [cell(0.0, 5.0), cell(1e-9, 1.0), cell(0.0, 5.0)];
        let straight = deepest(&cells, &[UNKNOWN, [0.0; 2], [-1e-9; 2], UNKNOWN]);
        assert!((straight - 0.25e-9 * 11.0).abs() < 1e-15, "{straight:e}");
        // its neighbours turn by more: a hollow may begin and end anywhere in them, but not pass them
        let (near, far) = ([0.1; 2], [0.2; 2]);
        let turning = [cell(0.0, 50.0), cell(0.0, 5.0), cell(1e-9, 1.0), cell(0.0, 5.0), cell(0.0, 50.0)];
        let within = deepest(&turning, &[UNKNOWN, [0.0; 2], near, near, far, UNKNOWN]);
        assert!((within - straight).abs() < 1e-15, "{within:e}");
        assert!(deepest(&[cell(0.0, 5.0), cell(0.0, 7.0)], &[UNKNOWN, near, UNKNOWN]) <= 0.0);
    }

    #[test]
    fn a_tangent_that_may_turn_about_proves_nothing() {
        let [one, any] = [Interval::exact(1.0), Interval::new(-1.0, 1.0)];
        let turning = one;
        let piece = |d| Enclosure { width: 1.0, d, dd: [any, any], turning };
        assert!(falls(&piece([one, any]), false) <= 0.0 && falls(&piece([any, one]), false) <= 0.0);
        assert!(falls(&piece([any, any]), false).is_infinite() && sag(&piece([any, any]), [0.0, 1.0]).is_infinite());
        let undecided = Enclosure { turning: Interval::UNDECIDED, ..piece([one, one]) };
        assert!(falls(&undecided, true).is_infinite());
    }
}

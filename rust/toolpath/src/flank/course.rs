//! How far apart the contacts with the two rails lie, all along a strip: a uniform cubic B-spline.

use nalgebra::{DMatrix, DVector};

/// Pieces of the spline.
const PIECES: usize = 16;
/// Its coefficients.
pub const COUNT: usize = PIECES + 3;

/// The spread of the contacts along the strip: half the difference of their shares of the rails.
#[derive(Clone, Debug)]
pub struct Course {
    coefficients: DVector<f64>,
}

impl Course {
    /// Contacts at equal shares of both rails.
    pub fn straight() -> Self {
        Self { coefficients: DVector::zeros(COUNT) }
    }

    /// The course that is nearest to spreads at shares of the way; where none are given it goes on straight.
    pub fn near(spreads: &[(f64, f64)], stiffness: f64) -> Option<Self> {
        let mut normal = Normal::zeros();
        for (u, spread) in spreads {
            normal.add_square(weights(*u), *spread, 1.0);
        }
        normal.stiffen(stiffness, &DVector::zeros(COUNT));
        Some(Self { coefficients: normal.solved()? })
    }

    /// So many times as far apart.
    pub fn times(&self, factor: f64) -> Self {
        Self { coefficients: &self.coefficients * factor }
    }

    /// The spreads of so many positions, evenly spread over the strip.
    pub fn spreads(&self, count: usize) -> Vec<f64> {
        (0..count).map(|i| self.spread(i as f64 / (count - 1) as f64)).collect()
    }

    /// About the largest spread to either side.
    pub fn largest(&self) -> f64 {
        self.coefficients.amax()
    }

    /// The spread at a share of the way along the strip.
    pub fn spread(&self, u: f64) -> f64 {
        let (first, weights) = weights(u);
        weights.iter().enumerate().map(|(i, weight)| weight * self.coefficients[first + i]).sum()
    }

    /// Moved by Newton's step for weighted squares, damped; bends count for so much beside the largest of the squares.
    pub fn stepped(&self, mut normal: Normal, damping: f64, stiffness: f64) -> Option<Self> {
        let largest = normal.matrix.diagonal().amax().max(f64::MIN_POSITIVE);
        normal.matrix += DMatrix::identity(COUNT, COUNT) * (largest * damping);
        normal.stiffen(largest * stiffness, &self.coefficients);
        Some(Self { coefficients: &self.coefficients - normal.solved()? })
    }
}

/// Normal equations of the coefficients.
pub struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Normal {
    pub fn zeros() -> Self {
        Self { matrix: DMatrix::zeros(COUNT, COUNT), right: DVector::zeros(COUNT) }
    }

    /// Adds the square of what a row of coefficients lies off a value.
    pub fn add_square<const N: usize>(&mut self, (first, row): (usize, [f64; N]), value: f64, count: f64) {
        for (i, a) in row.iter().enumerate() {
            self.right[first + i] += count * a * value;
            for (j, b) in row.iter().enumerate() {
                self.matrix[(first + i, first + j)] += count * a * b;
            }
        }
    }

    /// Adds the squares of the bends of a course with these coefficients.
    fn stiffen(&mut self, count: f64, coefficients: &DVector<f64>) {
        const BEND: [f64; 3] = [1.0, -2.0, 1.0];
        for first in 0..COUNT - 2 {
            let bend = BEND.iter().enumerate().map(|(i, weight)| weight * coefficients[first + i]).sum();
            self.add_square((first, BEND), bend, count);
        }
    }

    fn solved(self) -> Option<DVector<f64>> {
        Some(self.matrix.cholesky()?.solve(&self.right))
    }
}

/// The first of four coefficients that count at a share of the strip, and how much each does.
pub fn weights(u: f64) -> (usize, [f64; 4]) {
    let at = (u * PIECES as f64).clamp(0.0, PIECES as f64);
    let piece = (at.floor() as usize).min(PIECES - 1);
    let t = at - piece as f64;
    let s = 1.0 - t;
    let inner = |t: f64| (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
    (piece, [s * s * s / 6.0, inner(t), inner(s), t * t * t / 6.0])
}

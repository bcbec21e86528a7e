//! How far apart the contacts with the two rails lie, all along a strip: a spline that makes what the moving tool leaves least.
//!
//! A single position has two best spreads; chosen for each position by itself, the axis jumps from one to the other and the
//! movement between cuts into the surface. One smooth function for the whole strip, fitted to the surface that the movement
//! leaves, stays on one of them.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::cutter::Flank;
use super::stand::stand;
use super::swept::{left, Left, Sample};
use super::touch::touching;
use super::{FlankError, RuledStrip};

/// Pieces of the spline.
const PIECES: usize = 16;
/// Its coefficients.
const COUNT: usize = PIECES + 3;
/// Stations along the strip from which its swept surface is found, at least.
const STATIONS: usize = 193;
/// Of so many positions at most the straight moves between them count; of more they leave next to nothing.
pub const STRAIGHT_MOVES: usize = 400;
/// Stations in each of those moves, at least.
const PARTS: usize = 3;
/// Samples of the strip along and across.
const ALONG: usize = 65;
const ACROSS: usize = 13;
/// The same where courses are compared at last.
const FINE_ALONG: usize = 161;
const FINE_ACROSS: usize = 21;
const FINE_PARTS: usize = 6;
/// Steps of the fit at most.
const STEPS: usize = 25;
/// Steps from the least squares towards the least of the largest: along every ruling, then of the whole strip.
const LAWSON_STEPS: usize = 16;
const WHOLE_STEPS: usize = 12;
/// What a height of 0 counts in a step for the whole strip, beside the largest.
const FLOOR: f64 = 0.1;
/// Places along the strip at which a start touches the ruling, and how little its bends count beside that.
const TOUCHED: usize = 33;
const STIFFNESS: f64 = 1e-4;
/// A course is gone on with when the mean of squares is at most so many times the least.
const HOPEFUL: f64 = 2.0;
/// Two courses that leave the same but for this share are one.
const SAME: f64 = 1e-3;
/// The fit has ended when a step gains less than this share.
const GAIN: f64 = 1e-4;
/// Damping at first, as a share of the largest diagonal element, and the least that keeps idle coefficients at rest.
const DAMPING: f64 = 1e-4;
const LEAST_DAMPING: f64 = 1e-10;
/// With more a step is none.
const MOST_DAMPING: f64 = 1e6;

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

    /// The spreads of so many positions, evenly spread over the strip.
    pub fn spreads(&self, count: usize) -> Vec<f64> {
        (0..count).map(|i| self.spread(i as f64 / (count - 1) as f64)).collect()
    }

    /// What the tool leaves when it moves between positions with these spreads, evenly spread over the strip, straight or along
    /// a curve: the largest height, mm.
    ///
    /// # Errors
    /// No position somewhere.
    pub fn largest_of(
        strip: &RuledStrip,
        flank: &Flank,
        spreads: &[f64],
        is_straight: bool,
    ) -> Result<f64, FlankError> {
        let moves = spreads.len() - 1;
        let parts = if is_straight { FINE_PARTS.max((STATIONS - 1).div_ceil(moves)) } else { 1 };
        let layout = Layout { moves, parts };
        let samples = samples(strip, &layout, [FINE_ALONG, FINE_ACROSS]);
        let heights = Heights::of(&|i| spreads[i], strip, &samples, flank, &layout)?;
        Ok(heights.largest())
    }

    /// The spread at a share of the way along the strip.
    pub fn spread(&self, u: f64) -> f64 {
        let (first, weights) = weights(u);
        weights.iter().enumerate().map(|(i, weight)| weight * self.coefficients[first + i]).sum()
    }

    /// The course that leaves least in so many positions: first by least squares, from there on by the largest heights.
    ///
    /// # Errors
    /// No position with equal shares somewhere.
    pub fn fitted(strip: &RuledStrip, flank: &Flank, count: usize) -> Result<Self, FlankError> {
        let layout = Layout::of(count);
        let samples = samples(strip, &layout, [ALONG, ACROSS]);
        let left = |course: &Self| {
            let spread = |i: usize| course.spread(i as f64 / layout.moves as f64);
            Heights::of(&spread, strip, &samples, flank, &layout)
        };
        // there are two best spreads, on either side of equal shares, about where the ruling is touched too
        let touching = [0, 1].map(|sign| Self::touching(strip, flank, sign));
        let are_both = touching.iter().all(Option::is_some);
        let straight = least_squares(Self::straight(), &left)?;
        // the other of the two best spreads lies on about the other side
        let mirrored = (!are_both).then(|| Self { coefficients: -&straight.0.coefficients });
        let starts: Vec<_> = touching.into_iter().chain([mirrored]).flatten().collect();
        // also where no position lies there
        let mut fits: Vec<_> = starts.into_par_iter().filter_map(|start| least_squares(start, &left).ok()).collect();
        fits.push(straight);
        fits.sort_by(|a, b| a.1.squares().total_cmp(&b.1.squares()));
        let hopeful = fits.first().map_or(0.0, |best| HOPEFUL * best.1.squares());
        fits.retain(|fit| fit.1.squares() <= hopeful);
        fits.dedup_by(|b, a| b.1.squares() <= a.1.squares() * (1.0 + SAME));
        let found: Vec<_> = fits.into_par_iter().map(|fit| least_largest(fit, &left)).collect();
        let best = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        Ok(best.map_or_else(Self::straight, |(_, course)| course))
    }

    /// About where the ruling is touched as well as both rails, with the contacts spread to one side; none where it is so in few
    /// places only.
    fn touching(strip: &RuledStrip, flank: &Flank, sign: usize) -> Option<Self> {
        let (mut normal, mut right) = (DMatrix::zeros(COUNT, COUNT), DVector::zeros(COUNT));
        let mut touched = 0;
        for i in 0..TOUCHED {
            let u = i as f64 / (TOUCHED - 1) as f64;
            let Some(spread) = touching(strip, flank, u).ok()?[sign] else { continue };
            add_square(&mut normal, &mut right, weights(u), spread, 1.0);
            touched += 1;
        }
        // where it is not, the course goes on straight
        for first in 0..COUNT - 2 {
            add_square(&mut normal, &mut right, (first, [1.0, -2.0, 1.0]), 0.0, STIFFNESS);
        }
        let coefficients = (2 * touched > TOUCHED).then(|| normal.cholesky())??.solve(&right);
        Some(Self { coefficients })
    }

    /// Moved by Newton's step for weighted squares, damped.
    fn stepped(&self, left: &Heights, counts: &[f64], damping: f64) -> Option<Self> {
        let (mut normal, gradient) = left.normal_equations(counts);
        let largest = normal.diagonal().amax().max(f64::MIN_POSITIVE);
        normal += DMatrix::identity(COUNT, COUNT) * (largest * damping.max(LEAST_DAMPING));
        Some(Self { coefficients: &self.coefficients - normal.cholesky()?.solve(&gradient) })
    }
}

/// What courses leave.
type LeftBy<'a> = dyn Fn(&Course) -> Result<Heights, FlankError> + Sync + 'a;

/// A damped Gauss-Newton search (Levenberg, Marquardt): the course and what it leaves.
fn least_squares(start: Course, left: &LeftBy<'_>) -> Result<(Course, Heights), FlankError> {
    let mut course = start;
    let mut found = left(&course)?;
    let counts = vec![1.0; found.left.len()];
    let mut damping = DAMPING;
    for _ in 0..STEPS {
        let Some(tried) = course.stepped(&found, &counts, damping) else { break };
        match left(&tried) {
            Ok(better) if better.squares() < found.squares() => {
                let gain = 1.0 - better.squares() / found.squares();
                (course, found, damping) = (tried, better, 0.1 * damping);
                if gain < GAIN {
                    break;
                }
            }
            // also where there is no position so far off
            Ok(_) | Err(_) => damping = 10.0 * damping.max(LEAST_DAMPING),
        }
        if damping > MOST_DAMPING {
            break;
        }
    }
    Ok((course, found))
}

/// Least squares whose weights grow where heights are large, until along every ruling the largest are equal, and of the whole
/// strip (C. L. Lawson: Contributions to the theory of linear least maximum approximation. UCLA 1961); the best of the courses
/// on the way, and its measure, mm.
fn least_largest((start, mut found): (Course, Heights), left: &LeftBy<'_>) -> (f64, Course) {
    let (mut course, mut best) = (start.clone(), (found.measure(), start));
    let mut counts = vec![1.0; found.left.len()];
    let height = |left: &Option<Left>| left.map_or(0.0, |left| left.height.abs());
    for step in 0..LAWSON_STEPS + WHOLE_STEPS {
        if step < LAWSON_STEPS {
            for (counts, left) in counts.chunks_mut(ACROSS).zip(found.left.chunks(ACROSS)) {
                counts.iter_mut().zip(left).for_each(|(count, left)| *count *= height(left));
                let whole: f64 = counts.iter().sum();
                // a ruling without heights counts as before it had any
                counts
                    .iter_mut()
                    .for_each(|count| *count = if whole > 0.0 { *count / whole } else { 1.0 / ACROSS as f64 });
            }
        } else {
            let largest = found.largest().max(f64::MIN_POSITIVE);
            counts.iter_mut().zip(&found.left).for_each(|(count, left)| *count *= FLOOR + height(left) / largest);
        }
        let Some(tried) = course.stepped(&found, &counts, LEAST_DAMPING) else { break };
        let Ok(next) = left(&tried) else { break };
        (course, found) = (tried, next);
        if found.measure() < best.0 {
            best = (found.measure(), course.clone());
        }
    }
    best
}

/// Adds the square of what a row of coefficients lies off a value to normal equations.
fn add_square<const N: usize>(
    normal: &mut DMatrix<f64>,
    right: &mut DVector<f64>,
    (first, row): (usize, [f64; N]),
    value: f64,
    count: f64,
) {
    for (i, a) in row.iter().enumerate() {
        right[first + i] += count * a * value;
        for (j, b) in row.iter().enumerate() {
            normal[(first + i, first + j)] += count * a * b;
        }
    }
}

/// The first of four coefficients that count at a share of the strip, and how much each does: a uniform cubic B-spline.
fn weights(u: f64) -> (usize, [f64; 4]) {
    let at = (u * PIECES as f64).clamp(0.0, PIECES as f64);
    let piece = (at.floor() as usize).min(PIECES - 1);
    let t = at - piece as f64;
    let s = 1.0 - t;
    let inner = |t: f64| (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
    (piece, [s * s * s / 6.0, inner(t), inner(s), t * t * t / 6.0])
}

/// Where a course is looked at.
struct Layout {
    /// Moves between positions of the tool.
    moves: usize,
    /// Stations in each: between positions the axis moves straight.
    parts: usize,
}

impl Layout {
    fn of(count: usize) -> Self {
        let moves = count.saturating_sub(1).max(1);
        if count > STRAIGHT_MOVES {
            return Self { moves: STATIONS - 1, parts: 1 };
        }
        Self { moves, parts: (STATIONS - 1).div_ceil(moves).max(PARTS) }
    }

    fn stations(&self) -> usize {
        self.moves * self.parts + 1
    }

    fn share(&self, station: f64) -> f64 {
        station / (self.moves * self.parts) as f64
    }
}

/// Points of the strip.
fn samples(strip: &RuledStrip, layout: &Layout, [along, across]: [usize; 2]) -> Vec<Sample> {
    let sample = |i: usize, j: usize| {
        let at = [i as f64 / (along - 1) as f64, j as f64 / (across - 1) as f64];
        let near = (at[0] * (layout.stations() - 1) as f64).round() as usize;
        Sample { point: strip.point(at), normal: strip.normal(at), near }
    };
    (0..along).flat_map(|i| (0..across).map(move |j| (i, j))).map(|(i, j)| sample(i, j)).collect()
}

/// What a course leaves over each sample; none where that is not known.
struct Heights {
    left: Vec<Option<Left>>,
    /// Shares of the strip of their stations.
    shares: Vec<f64>,
}

impl Heights {
    /// Of positions with these spreads, by their number.
    fn of(
        spread: &(dyn Fn(usize) -> f64 + Sync),
        strip: &RuledStrip,
        samples: &[Sample],
        flank: &Flank,
        layout: &Layout,
    ) -> Result<Self, FlankError> {
        let position = |i: usize| {
            let u = i as f64 / layout.moves as f64;
            let spread = spread(i);
            stand(strip, flank, [u - spread, u + spread], [-1.0, 1.0]).map(|(_, station)| station)
        };
        let positions = (0..=layout.moves).map(position).collect::<Result<Vec<_>, _>>()?;
        let station = |i: usize| {
            let (number, part) = (i / layout.parts, i % layout.parts);
            match positions.get(number + 1) {
                Some(next) if part > 0 => positions[number].towards(next, part as f64 / layout.parts as f64),
                _ => positions[number],
            }
        };
        let stations: Vec<_> = (0..layout.stations()).map(station).collect();
        let left: Vec<_> = samples.iter().map(|sample| left(sample, &stations, flank, layout.parts)).collect();
        let shares = left.iter().map(|left| left.map_or(0.0, |left| layout.share(left.station))).collect();
        Ok(Self { left, shares })
    }

    fn known(&self) -> impl Iterator<Item = &Left> {
        self.left.iter().flatten()
    }

    /// The mean of the squares, mm^2.
    fn squares(&self) -> f64 {
        self.known().map(|left| left.height * left.height).sum::<f64>() / self.known().count().max(1) as f64
    }

    /// The largest of all, mm.
    fn largest(&self) -> f64 {
        self.known().map(|left| left.height.abs()).fold(0.0, f64::max)
    }

    /// The largest of all, and the root of the mean over the rulings of the square of the largest along each, mm: what is good at
    /// the worst place only, and what is good but there, both count.
    fn measure(&self) -> f64 {
        let along = |left: &[Option<Left>]| left.iter().flatten().map(|left| left.height.abs()).fold(0.0, f64::max);
        let squares: f64 = self.left.chunks(ACROSS).map(along).map(|largest| largest * largest).sum();
        self.largest() + (squares / ALONG as f64).sqrt()
    }

    /// Matrix and right side of weighted least squares.
    fn normal_equations(&self, counts: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let (mut normal, mut gradient) = (DMatrix::zeros(COUNT, COUNT), DVector::zeros(COUNT));
        for ((left, share), count) in self.left.iter().zip(&self.shares).zip(counts) {
            let Some(Left { height, rate, .. }) = left else { continue };
            let (first, weights) = weights(*share);
            add_square(&mut normal, &mut gradient, (first, weights.map(|a| a * rate)), *height, *count);
        }
        (normal, gradient)
    }
}

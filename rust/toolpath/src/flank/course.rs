//! How far apart the contacts with the two rails lie, all along a strip: a spline that makes what the moving tool leaves least.
//!
//! A single position has two best spreads; chosen for each position by itself, the axis jumps from one to the other and the
//! movement between cuts into the surface. One smooth function for the whole strip, fitted to the surface that the movement
//! leaves, stays on one of them.

use nalgebra::{DMatrix, DVector};

use super::stand::stand;
use super::swept::{left, Left, Sample, Station};
use super::{FlankError, RuledStrip};

/// Pieces of the spline.
const PIECES: usize = 16;
/// Its coefficients.
const COUNT: usize = PIECES + 3;
/// Stations along the strip from which its swept surface is found.
const STATIONS: usize = 193;
/// Samples of the strip along and across.
const ALONG: usize = 65;
const ACROSS: usize = 13;
/// Steps of the fit at most.
const STEPS: usize = 25;
/// Steps from the least squares towards the least of the largest.
const LAWSON_STEPS: usize = 16;
/// The fit has ended when a step gains less than this share.
const GAIN: f64 = 1e-6;
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

    /// The spread at a share of the way along the strip.
    pub fn spread(&self, u: f64) -> f64 {
        let (first, weights) = weights(u);
        weights.iter().enumerate().map(|(i, weight)| weight * self.coefficients[first + i]).sum()
    }

    /// The course that leaves least: first by least squares, from there on by the largest height along each ruling.
    ///
    /// # Errors
    /// No position with equal shares somewhere.
    pub fn fitted(strip: &RuledStrip, radius: f64) -> Result<Self, FlankError> {
        let samples = samples(strip);
        let left = |course: &Self| Heights::of(course, strip, &samples, radius);
        let start = least_squares(Self::straight(), &left)?;
        // the other of the two best spreads lies on about the other side
        let mirrored = least_squares(Self { coefficients: -&start.0.coefficients }, &left);
        let start = match mirrored {
            Ok(mirrored) if mirrored.1.squares() < start.1.squares() => mirrored,
            // also where no position lies there
            Ok(_) | Err(_) => start,
        };
        Ok(least_largest(start, &left))
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
type LeftBy<'a> = dyn Fn(&Course) -> Result<Heights, FlankError> + 'a;

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

/// Least squares whose weights grow where heights are large, until along every ruling the largest are equal (C. L. Lawson:
/// Contributions to the theory of linear least maximum approximation. UCLA 1961); the best of the courses on the way.
fn least_largest((start, mut found): (Course, Heights), left: &LeftBy<'_>) -> Course {
    let (mut course, mut best) = (start.clone(), (found.largest(), start));
    let mut counts = vec![1.0; found.left.len()];
    for _ in 0..LAWSON_STEPS {
        for (counts, left) in counts.chunks_mut(ACROSS).zip(found.left.chunks(ACROSS)) {
            let height = |left: &Option<Left>| left.map_or(0.0, |left| left.height.abs());
            counts.iter_mut().zip(left).for_each(|(count, left)| *count *= height(left));
            let whole: f64 = counts.iter().sum();
            // a ruling without heights counts as before it had any
            counts.iter_mut().for_each(|count| *count = if whole > 0.0 { *count / whole } else { 1.0 / ACROSS as f64 });
        }
        let Some(tried) = course.stepped(&found, &counts, LEAST_DAMPING) else { break };
        let Ok(next) = left(&tried) else { break };
        (course, found) = (tried, next);
        if found.largest() < best.0 {
            best = (found.largest(), course.clone());
        }
    }
    best.1
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

fn station_share(number: f64) -> f64 {
    number / (STATIONS - 1) as f64
}

/// Points of the strip, but for its ends: what is left there depends on how the tool comes and leaves.
fn samples(strip: &RuledStrip) -> Vec<Sample> {
    let sample = |i: usize, j: usize| {
        let at = [(i as f64 + 0.5) / ALONG as f64, j as f64 / (ACROSS - 1) as f64];
        let near = (at[0] * (STATIONS - 1) as f64).round() as usize;
        Sample { point: strip.point(at), normal: strip.normal(at), near }
    };
    (0..ALONG).flat_map(|i| (0..ACROSS).map(move |j| (i, j))).map(|(i, j)| sample(i, j)).collect()
}

/// What a course leaves over each sample; none where that is not known.
struct Heights {
    left: Vec<Option<Left>>,
}

impl Heights {
    fn of(course: &Course, strip: &RuledStrip, samples: &[Sample], radius: f64) -> Result<Self, FlankError> {
        let station = |i: usize| {
            let u = station_share(i as f64);
            let spread = course.spread(u);
            let (stand, rates) = stand(strip, radius, [u - spread, u + spread], [-1.0, 1.0])?;
            Ok::<_, FlankError>(Station { axis: stand.axis, rates })
        };
        let stations = (0..STATIONS).map(station).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { left: samples.iter().map(|sample| left(sample, &stations, radius)).collect() })
    }

    fn known(&self) -> impl Iterator<Item = &Left> {
        self.left.iter().flatten()
    }

    /// The mean of the squares, mm^2.
    fn squares(&self) -> f64 {
        self.known().map(|left| left.height * left.height).sum::<f64>() / self.known().count().max(1) as f64
    }

    /// The mean over the rulings of the square of the largest along each, mm^2.
    fn largest(&self) -> f64 {
        let along = |left: &[Option<Left>]| left.iter().flatten().map(|left| left.height.abs()).fold(0.0, f64::max);
        self.left.chunks(ACROSS).map(along).map(|largest| largest * largest).sum::<f64>() / ALONG as f64
    }

    /// Matrix and right side of weighted least squares.
    fn normal_equations(&self, counts: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let (mut normal, mut gradient) = (DMatrix::zeros(COUNT, COUNT), DVector::zeros(COUNT));
        for (left, count) in self.left.iter().zip(counts) {
            let Some(Left { height, rate, station }) = left else { continue };
            let (first, weights) = weights(station_share(*station));
            for (i, a) in weights.iter().enumerate() {
                gradient[first + i] += count * rate * a * height;
                for (j, b) in weights.iter().enumerate() {
                    normal[(first + i, first + j)] += count * rate * a * rate * b;
                }
            }
        }
        (normal, gradient)
    }
}

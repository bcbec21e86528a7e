//! From a proven curve to piecewise polynomials, halved until they agree with it.

use super::closeness::{bound, Bound, Cell, Fault, Piece, Ruler};
use super::refusal::refusal;
use super::sample::{short, Route, Sample, Source};
use crate::profile::fitted::{Fitted, Interval, TERMS};
use crate::GeometryError;

/// Nodes of an interval: r' and z' are interpolated there, r and z integrated.
const NODES: usize = TERMS - 1;
/// Most intervals; a smooth profile takes about ten, one with a singular tip sixty.
const MOST_INTERVALS: usize = 300;

/// What is allowed between the nodes, and what is met where halving no longer helps.
const ALLOWED: Deviation = Deviation { distance: 1e-12, slope: 1e-10, curvature: 1e-10, turn: 1e-11 };
const ROUNDING: Deviation = Deviation { distance: 1e-10, slope: 1e-8, curvature: 1e-6, turn: 1e-11 };
/// No interval is shorter than this part of its stretch.
const SHORTEST: f64 = 1e-12;
/// Longest interval at a tip or base where the curvature is infinite, in parts of the size.
const SINGULAR: f64 = 2.5e-11;
/// Largest distance from the formula, r and z as well as by slope, in parts of the diameter or the height.
const FARTHEST: f64 = 1e-9;

/// Largest differences between polynomials and formula at points between the nodes.
#[derive(Clone, Copy, Debug)]
struct Deviation {
    /// r and z, in parts of the size.
    distance: f64,
    /// The derivative's direction, rad.
    slope: f64,
    /// Radius of curvature, relative.
    curvature: f64,
    /// Curvature times the interval's length, rad: where this is nothing, the one above need not be small.
    turn: f64,
}

/// No deviation yet.
const NONE: Deviation = Deviation { distance: 0.0, slope: 0.0, curvature: 0.0, turn: 0.0 };

impl Deviation {
    /// The largest part of what is allowed.
    fn share_of(&self, allowed: &Self) -> f64 {
        let curvature = (self.curvature / allowed.curvature).min(self.turn / allowed.turn);
        let shares = [self.distance / allowed.distance, self.slope / allowed.slope, curvature];
        // NaN is a whole share
        shares.into_iter().map(|x| if x.is_nan() { f64::INFINITY } else { x }).fold(0.0, f64::max)
    }

    fn worse(&self, other: &Self) -> Self {
        Self {
            distance: self.distance.max(other.distance),
            slope: self.slope.max(other.slope),
            curvature: self.curvature.max(other.curvature),
            turn: self.turn.max(other.turn),
        }
    }
}

/// Cosine tables of the nodes.
struct Tables {
    /// Nodes on [-1, 1], rising.
    nodes: [f64; NODES],
    /// Points half-way between them.
    between: [f64; NODES - 1],
    /// From values at the nodes to coefficients of powers of u.
    powers: [[f64; NODES]; NODES],
}

impl Tables {
    fn new() -> Self {
        let last = (NODES - 1) as f64;
        // sin, so that the middle is 0
        let cosine = |x: f64| libm::sin(std::f64::consts::PI * (0.5 - x));
        let chebyshev = chebyshev_powers();
        let mut powers = [[0.0; NODES]; NODES];
        for (m, polynomial) in chebyshev.iter().enumerate() {
            for j in 0..NODES {
                let ends = |k: usize| if k == 0 || k == NODES - 1 { 0.5 } else { 1.0 };
                // nodes rise: node j is -cos(pi j / n)
                let weight = 2.0 / last * ends(m) * ends(j) * cosine_of_multiple(m * (NODES - 1 - j));
                for (row, coefficient) in powers.iter_mut().zip(polynomial) {
                    row[j] += weight * coefficient;
                }
            }
        }
        Self {
            nodes: std::array::from_fn(|j| -cosine(j as f64 / last)),
            between: std::array::from_fn(|j| -cosine((j as f64 + 0.5) / last)),
            powers,
        }
    }
}

/// cos(pi k / (NODES - 1)).
fn cosine_of_multiple(k: usize) -> f64 {
    let period = 2 * (NODES - 1);
    libm::cos(std::f64::consts::PI * (k % period) as f64 / (NODES - 1) as f64)
}

/// Coefficients of the Chebyshev polynomials by powers.
fn chebyshev_powers() -> [[f64; NODES]; NODES] {
    let mut table = [[0.0; NODES]; NODES];
    table[0][0] = 1.0;
    table[1][1] = 1.0;
    for m in 2..NODES {
        for k in 0..NODES {
            let shifted = if k > 0 { table[m - 1][k - 1] } else { 0.0 };
            table[m][k] = 2.0 * shifted - table[m - 2][k];
        }
    }
    table
}

/// The curve, and how far it is from the formula, in words.
pub(super) fn fit(route: &Route) -> Result<(Fitted, String), GeometryError> {
    let extent = route.stretches.last().map_or(0.0, |[_, base]| base.point[1].max(2.0 * base.point[0]));
    let mut fitter = Fitter {
        source: route.source.as_ref(),
        tables: Tables::new(),
        size: route.size(),
        intervals: Vec::new(),
        worst: NONE,
        singular: false,
        ruler: Ruler::new(route.source.as_ref(), extent),
        cells: Vec::new(),
    };
    for (index, [from, to]) in route.stretches.iter().enumerate() {
        fitter.stretch(from, to, index == 0, index + 1 == route.stretches.len())?;
    }
    let bound = bound(&fitter.cells);
    if bound.distance.max(bound.by_slope) > FARTHEST * extent {
        return Err(fitter.too_far(route, &bound));
    }
    let note = fitter.note(&bound);
    let (start, end) = match (route.stretches.first(), route.stretches.last()) {
        (Some(first), Some(last)) => (first[0].point, last[1].point),
        _ => ([0.0; 2], [0.0; 2]),
    };
    Ok((Fitted::new(fitter.intervals, (start[0], start[1]), (end[0], end[1])), note))
}

struct Fitter<'a> {
    source: &'a dyn Source,
    tables: Tables,
    size: f64,
    intervals: Vec<Interval>,
    worst: Deviation,
    singular: bool,
    ruler: Ruler<'a>,
    cells: Vec<Cell>,
}

/// A piece still to be fitted.
struct Job {
    from: Sample,
    to: Sample,
    /// Its parent's share of what is allowed.
    before: f64,
    at_tip: bool,
    at_base: bool,
}

impl Fitter<'_> {
    fn stretch(&mut self, from: &Sample, to: &Sample, at_tip: bool, at_base: bool) -> Result<(), GeometryError> {
        let whole = to.p - from.p;
        let mut jobs = vec![Job { from: *from, to: *to, before: f64::INFINITY, at_tip, at_base }];
        while let Some(job) = jobs.pop() {
            let (interval, deviation) = self.interval(&job);
            let (mut fault, mut cut) = (Fault::Off, 0.0);
            if let Some(counted) = self.accepted(&job, deviation) {
                let ends = [job.at_tip, job.at_base];
                match self.ruler.cells(&Piece { interval: &interval, from: &job.from, to: &job.to, ends }) {
                    Ok(cells) => {
                        self.cells.extend(cells);
                        self.worst = self.worst.worse(&counted);
                        self.push(&interval, &job);
                        continue;
                    }
                    Err(found) => (fault, cut) = found,
                }
            }
            let (half, middle) = (0.5 * (job.to.p - job.from.p), 0.5 * (job.to.p + job.from.p));
            let middle = self.source.at(job.from.stretch, middle + half * cut);
            let spent = self.intervals.len() + jobs.len() > MOST_INTERVALS || fault == Fault::Spent;
            if spent || fault == Fault::Rounding || job.to.p - job.from.p <= SHORTEST * whole.abs() {
                // the derivatives agree, the values do not, however short the interval
                let rounds = deviation.distance > ROUNDING.distance && deviation.slope <= ROUNDING.slope;
                return Err(self.refused(&middle, if rounds { Fault::Rounding } else { fault }));
            }
            let before = deviation.share_of(&ALLOWED);
            jobs.push(Job { from: middle, before, at_tip: false, ..job });
            jobs.push(Job { to: middle, before, at_base: false, ..job });
        }
        Ok(())
    }

    fn refused(&self, position: &Sample, fault: Fault) -> GeometryError {
        let (reason, hint) = match fault {
            Fault::Off => (
                "the formula is not smooth here, or too rough to be followed",
                "it needs a continuous tangent and curvature between tip and base",
            ),
            Fault::Rounding => (
                "rounding in the formula is larger than a part in 1e9 of the profile: large terms cancel",
                "leave out a large constant, or write the formula so that no large terms cancel",
            ),
            Fault::Spent => (
                "it takes too long to prove how near polynomials are to the formula here",
                "write the formula shorter, or smoother",
            ),
        };
        self.source.refuse(position, reason, hint)
    }

    fn too_far(&self, route: &Route, bound: &Bound) -> GeometryError {
        let far = short(bound.distance.max(bound.by_slope));
        let position = route.samples.last().map_or_else(String::new, |sample| self.source.position(sample));
        let hint = "it needs a continuous tangent and curvature between tip and base";
        refusal(position, format!("the polynomials before it are off the formula by up to {far} mm"), hint)
    }

    /// What counts of a deviation that is small enough, or as small as rounding lets it be.
    fn accepted(&mut self, job: &Job, deviation: Deviation) -> Option<Deviation> {
        let share = deviation.share_of(&ALLOWED);
        if share <= 1.0 || (share > 0.25 * job.before && deviation.share_of(&ROUNDING) <= 1.0) {
            return Some(deviation);
        }
        let [dr, dz] = [0, 1].map(|i| (job.to.point[i] - job.from.point[i]).abs());
        let tiny = dr.max(dz) <= SINGULAR * self.size;
        let singular = (job.at_tip || job.at_base) && tiny && deviation.distance <= ALLOWED.distance;
        self.singular |= singular;
        singular.then_some(Deviation { distance: deviation.distance, ..NONE })
    }

    fn push(&mut self, interval: &Interval, job: &Job) {
        let before = self.intervals.last().map_or(job.from.slope().max(0.0), |last| last.slopes[1]);
        let slopes = [before, right_angle_or_less(job.to.slope()).max(before)];
        self.intervals.push(Interval::new(interval.r, interval.z, slopes));
    }

    fn interval(&self, job: &Job) -> (Interval, Deviation) {
        let half = 0.5 * (job.to.p - job.from.p);
        let middle = 0.5 * (job.to.p + job.from.p);
        let nodes = self.tables.nodes.map(|u| match u {
            u if u <= -1.0 => job.from,
            u if u >= 1.0 => job.to,
            u => self.source.at(job.from.stretch, middle + half * u),
        });
        let [r, z] = [0, 1].map(|i| self.polynomial(nodes.map(|node| node.d[i] * half), nodes[NODES / 2].point[i]));
        let interval = Interval::new(r, z, [0.0, 0.0]);
        let checks = self.tables.between.map(|u| (u, self.source.at(job.from.stretch, middle + half * u)));
        let deviation = self.deviation(&interval, half, &checks);
        (interval, deviation)
    }

    /// The integral of the interpolating polynomial.
    fn polynomial(&self, rates: [f64; NODES], middle: f64) -> [f64; TERMS] {
        let mut out = [0.0; TERMS];
        out[0] = middle;
        // the coordinate of which the curve is a function
        if rates.iter().all(|rate| rate.to_bits() == rates[0].to_bits()) {
            out[1] = rates[0];
            return out;
        }
        for (k, row) in self.tables.powers.iter().enumerate() {
            let coefficient: f64 = row.iter().zip(&rates).map(|(weight, rate)| weight * rate).sum();
            out[k + 1] = coefficient / (k + 1) as f64;
        }
        out
    }

    fn deviation(&self, interval: &Interval, half: f64, checks: &[(f64, Sample)]) -> Deviation {
        let sharpest = checks.iter().map(|(_, exact)| exact.curvature().abs()).fold(0.0, f64::max);
        // where it is nearly flat, in parts of the interval's own or a very slight curvature
        let floor = 1e-3 * sharpest + 1e-4 / self.size;
        let mut worst = NONE;
        for (u, exact) in checks {
            let (r, z) = interval.point(*u);
            let (d, dd) = interval.rates(*u);
            let found = Sample { point: [r, z], d: d.map(|x| x / half), dd: dd.map(|x| x / half / half), ..*exact };
            let off = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
            let bend = (found.curvature() - exact.curvature()).abs();
            let here = Deviation {
                distance: off(found.point, exact.point) / self.size,
                slope: off(found.d, exact.d) / exact.speed(),
                curvature: bend / (exact.curvature().abs() + floor),
                turn: bend * exact.speed() * 2.0 * half,
            };
            if here.share_of(&ALLOWED).is_infinite() {
                return here;
            }
            worst = worst.worse(&here);
        }
        worst
    }

    fn note(&self, bound: &Bound) -> String {
        let Deviation { slope, curvature, .. } = self.worst;
        let singular = if self.singular { "; the curvature has no limit at an end" } else { "" };
        let except = if bound.except > 0.0 {
            format!("; within {} mm of an end r and z by slope are not proved", short(bound.except))
        } else {
            String::new()
        };
        format!(
            "polynomials (intervals: {}) follow the formula to {} mm, and to {} mm by slope, by interval arithmetic; {} rad \
             in slope and {} in radius of curvature (relative) where compared{singular}{except}",
            self.intervals.len(),
            short(bound.distance),
            short(bound.by_slope),
            short(slope),
            short(curvature),
        )
    }
}

/// Within rounding of a right angle it is one.
fn right_angle_or_less(slope: f64) -> f64 {
    use std::f64::consts::FRAC_PI_2;
    if slope > FRAC_PI_2 - 1e-12 {
        FRAC_PI_2
    } else {
        slope
    }
}

//! A point of the curve with its derivatives, and where such points come from.

use super::interval::Interval;
use super::jet::Jet;
use super::number::Number;
use super::refusal::refusal;
use super::series::Series;
use crate::GeometryError;

/// Stretches by radius and by height, of formulas that have no parameter of their own.
pub(super) const BY_RADIUS: usize = 0;
pub(super) const BY_HEIGHT: usize = 1;

/// A point of the curve by its own parameter: t, the radius, or the height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Which stretch of the source the parameter belongs to.
    pub stretch: usize,
    /// The parameter; it grows from the tip to the base.
    pub p: f64,
    /// (r, z), mm, the tip at the origin and z upwards.
    pub point: [f64; 2],
    /// d(r, z)/dp.
    pub d: [f64; 2],
    /// d2(r, z)/dp2.
    pub dd: [f64; 2],
}

impl Sample {
    /// |d(r, z)/dp|.
    pub fn speed(&self) -> f64 {
        (self.d[0] * self.d[0] + self.d[1] * self.d[1]).sqrt()
    }

    /// r' z'' - r'' z': positive where the curve turns upwards.
    pub fn turning(&self) -> f64 {
        self.d[0] * self.dd[1] - self.d[1] * self.dd[0]
    }

    /// What `turning` can be wrong by: a part in 1e12 of its two terms.
    pub fn turning_noise(&self) -> f64 {
        1e-12 * ((self.d[0] * self.dd[1]).abs() + (self.d[1] * self.dd[0]).abs())
    }

    /// Curvature, 1/mm.
    pub fn curvature(&self) -> f64 {
        let speed = self.speed();
        self.turning() / (speed * speed * speed)
    }

    /// The angle of the tangent, rad.
    pub fn slope(&self) -> f64 {
        libm::atan2(self.d[1], self.d[0])
    }

    pub fn is_finite(&self) -> bool {
        self.point.iter().chain(&self.d).all(|x| x.is_finite())
    }
}

/// What the derivatives are over a piece of the curve, by a parameter of the piece's own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Enclosure {
    /// By how much the parameter grows, at most.
    pub width: f64,
    /// d(r, z)/dp.
    pub d: [Interval; 2],
    /// d2(r, z)/dp2.
    pub dd: [Interval; 2],
    /// r' z'' - r'' z'.
    pub turning: Interval,
}

impl Enclosure {
    /// By the derivatives alone.
    pub fn new(width: f64, d: [Interval; 2], dd: [Interval; 2]) -> Self {
        Self { width, d, dd, turning: d[0] * dd[1] - dd[0] * d[1] }
    }

    /// |d(r, z)/dp|.
    pub fn speed(&self) -> Interval {
        (self.d[0].square() + self.d[1].square()).sqrt()
    }
}

/// A formula as a curve: gives points by parameter and names them as the user knows them.
pub(super) trait Source {
    /// The point at a parameter of a stretch; not finite where the formula is not.
    fn at(&self, stretch: usize, p: f64) -> Sample;

    /// A point about half-way between two of a stretch; none where they are neighbours.
    fn between(&self, from: &Sample, to: &Sample) -> Option<Sample> {
        let p = 0.5 * (from.p + to.p);
        (from.p < p && p < to.p).then(|| self.at(from.stretch, p))
    }

    /// Intervals that hold the derivatives everywhere between two points of a stretch; none where nothing is known.
    fn enclose(&self, from: &Sample, to: &Sample) -> Option<Enclosure>;

    /// By how much points, given with the parameter as series of another variable, miss the curve: in r and z, or as the
    /// value of the [`field`](Self::field) that is zero on it.
    fn residual(&self, _stretch: usize, _p: Series, _point: &[Series; 2]) -> [Series; 2] {
        [Series::undecided(); 2]
    }

    /// What the residual is the value of, over a box of r and z; none where it is the miss itself.
    fn field(&self, _over: [Interval; 2]) -> Option<Jet<Interval>> {
        None
    }

    /// It is what the user gave, so that a point with a defect is refused however short the defect; not so for
    /// polynomials, whose rounding makes such points of no depth.
    fn is_given(&self) -> bool {
        true
    }

    /// Operators and functions that an enclosure takes.
    fn operations(&self) -> usize;

    /// Operators and functions of the formula itself.
    fn operators(&self) -> usize {
        self.operations()
    }

    /// `t = 0.83`, `r = 4.1`: in the formula's own terms.
    fn position(&self, sample: &Sample) -> String;

    /// An error at a point.
    fn refuse(&self, sample: &Sample, reason: &str, hint: &str) -> GeometryError {
        refusal(self.position(sample), reason.to_owned(), hint)
    }
}

/// A formula traced from tip to base.
pub(super) struct Route {
    /// Where points come from.
    pub source: Box<dyn Source>,
    /// First and last point of each stretch, from tip to base.
    pub stretches: Vec<[Sample; 2]>,
    /// Points along all of it, from tip to base, for the proof.
    pub samples: Vec<Sample>,
    /// What was done to it, in words.
    pub notes: Vec<String>,
}

impl Route {
    /// The larger of radius and height, mm.
    pub fn size(&self) -> f64 {
        self.samples.iter().flat_map(|sample| sample.point).filter(|x| x.is_finite()).fold(0.0, |a, x| x.abs().max(a))
    }
}

/// Points that every proof looks at.
pub(super) const SAMPLES: usize = 2048;

/// A number as errors and notes show it: up to six significant digits.
pub(super) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return if x == 0.0 { "0".to_owned() } else { x.to_string() };
    }
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if (1e-4..1e7).contains(&x.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

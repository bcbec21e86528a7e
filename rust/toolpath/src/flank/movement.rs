//! Where a tool is at any share of the way along a strip.

use rayon::prelude::*;
use styluscam_geometry::Vector;

use super::course::Course;
use super::cutter::Flank;
use super::fit::fitted;
use super::heights::{largest_of, STRAIGHT_MOVES};
use super::method::{beside_middle, offset, QUARTERS};
use super::stand::Stand;
use super::touch::{on_rails, touching};
use super::{FlankError, Method, RuledStrip};

/// Of more positions than straight moves count, so many are compared.
const COMPARED: usize = 97;
/// A change of the spread so many times that of the contacts, or of its mean, is a jump.
const STEADY: f64 = 2.0;

/// How much bends of a course count beside heights, the more the less steady it is.
const STIFFNESSES: [f64; 4] = [1e-7, 1e-5, 1e-4, 1e-3];
/// A turn of the axis so many times the mean is a jump, or so many times the largest turn of the rulings beside theirs.
const JUMP: f64 = 4.0;
const NATURAL: f64 = 1.5;
/// Turns that are none, rad.
const NO_TURN: f64 = 1e-9;

/// A tool on its way along a strip.
pub struct Movement<'a> {
    strip: &'a RuledStrip,
    flank: &'a Flank,
    way: Way,
}

/// What its positions follow from.
enum Way {
    /// A smooth spread of the contacts.
    Spread(Course),
    /// The ruling touched as well as the rails.
    Touching(Touched),
    TwoPoints,
    OnePoint,
}

/// Which of the two spreads that touch the ruling.
#[derive(Clone, Copy)]
enum Touched {
    Above,
    Below,
    Least,
}

impl Touched {
    fn of(self, [above, below]: [Option<f64>; 2]) -> Option<f64> {
        match self {
            Self::Above => above,
            Self::Below => below,
            Self::Least => above.into_iter().chain(below).min_by(|a, b| a.abs().total_cmp(&b.abs())),
        }
    }
}

impl<'a> Movement<'a> {
    /// That of a method, for so many positions evenly spread over the rails' parameters.
    ///
    /// # Errors
    /// The tool does not fit, or no position touches both rails.
    pub fn of(strip: &'a RuledStrip, flank: &'a Flank, count: usize, method: Method) -> Result<Self, FlankError> {
        strip.takes(flank)?;
        let way = match method {
            Method::Swept => least_left(strip, flank, count)?,
            Method::Rails => Way::Spread(Course::straight()),
            Method::ThreePoints => Way::Touching(Touched::Least),
            Method::TwoPoints => Way::TwoPoints,
            Method::OnePoint => Way::OnePoint,
        };
        Ok(Self { strip, flank, way })
    }

    /// The position at a share of the way.
    ///
    /// # Errors
    /// None touches what it has to.
    pub fn at(&self, u: f64) -> Result<Stand, FlankError> {
        let (strip, flank) = (self.strip, self.flank);
        match &self.way {
            Way::Spread(course) => on_rails(strip, flank, u, course.spread(u)),
            Way::Touching(which) => {
                let spread = which.of(touching(strip, flank, u)).ok_or(FlankError::NoThreePoints { u })?;
                on_rails(strip, flank, u, spread)
            }
            Way::TwoPoints => Ok(offset(strip, flank, u, QUARTERS)),
            Way::OnePoint => Ok(beside_middle(strip, flank, u)),
        }
    }
}

/// The way that leaves least of those on which the axis does not jump: a smooth course, the stiffer the more it would, or one that
/// touches the ruling all along.
fn least_left(strip: &RuledStrip, flank: &Flank, count: usize) -> Result<Way, FlankError> {
    let choice = Choice::of(strip, flank, count);
    let mut best: Option<(Judged, Way)> = None;
    let mut refused = None;
    for stiffness in STIFFNESSES {
        let course = match fitted(strip, flank, count, stiffness) {
            Ok(course) => course,
            Err(error) => {
                refused = Some(error);
                continue;
            }
        };
        if let Some(judged) = choice.better(&best, &course.spreads(choice.compared)) {
            best = Some((judged, Way::Spread(course)));
            if judged.is_steady {
                break;
            }
        }
    }
    let found = touched(strip, flank, choice.compared);
    for which in [Touched::Above, Touched::Below, Touched::Least] {
        let Some(spreads) = steady(&found, which) else { continue };
        let better = choice.better(&best, &spreads);
        let is_all_along = || choice.compared == count || steady(&touched(strip, flank, count), which).is_some();
        if let Some(judged) = better.filter(|_| is_all_along()) {
            best = Some((judged, Way::Touching(which)));
        }
    }
    best.map(|(_, way)| way).ok_or(refused.unwrap_or(FlankError::NoPosition { u: 0.5, radius: flank.radius() }))
}

/// What a way comes to.
#[derive(Clone, Copy)]
struct Judged {
    is_steady: bool,
    largest: f64,
}

/// How ways are compared.
struct Choice<'a> {
    strip: &'a RuledStrip,
    flank: &'a Flank,
    compared: usize,
    is_straight: bool,
    /// The largest turn of the axis that is no jump, beside the mean.
    jump: f64,
}

impl<'a> Choice<'a> {
    fn of(strip: &'a RuledStrip, flank: &'a Flank, count: usize) -> Self {
        let is_straight = count <= STRAIGHT_MOVES;
        let compared = if is_straight { count } else { COMPARED };
        let share = |i: usize| i as f64 / (compared - 1) as f64;
        // as the surface itself turns
        let rulings = (0..compared).map(|i| (strip.point([share(i), 1.0]) - strip.point([share(i), 0.0])).normalize());
        let jump = JUMP.max(NATURAL * largest_turn(&rulings.collect::<Vec<_>>()));
        Self { strip, flank, compared, is_straight, jump }
    }

    /// What a way comes to that is better than the best so far.
    fn better(&self, best: &Option<(Judged, Way)>, spreads: &[f64]) -> Option<Judged> {
        let (largest, positions) = largest_of(self.strip, self.flank, spreads, self.is_straight).ok()?;
        let axes: Vec<_> = positions.iter().map(|station| (station.axis[1] - station.axis[0]).normalize()).collect();
        let judged = Judged { is_steady: largest_turn(&axes) <= self.jump, largest };
        let is_better = best.as_ref().is_none_or(|(so_far, _)| {
            (judged.is_steady && !so_far.is_steady)
                || (judged.is_steady == so_far.is_steady && largest < so_far.largest)
        });
        is_better.then_some(judged)
    }
}

/// The largest turn from one direction to the next beside the mean.
fn largest_turn(directions: &[Vector]) -> f64 {
    let turns = directions.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    let mean = turns.clone().sum::<f64>() / (directions.len() - 1).max(1) as f64;
    turns.fold(0.0, f64::max) / mean.max(NO_TURN)
}

/// The spreads at which the ruling is touched on either side.
fn touched(strip: &RuledStrip, flank: &Flank, count: usize) -> Vec<[Option<f64>; 2]> {
    let at = |i: usize| touching(strip, flank, i as f64 / (count - 1) as f64);
    (0..count).into_par_iter().map(at).collect()
}

/// Those of a choice, where there is one all along and none differs from the one before it by far more than they do in the mean.
fn steady(found: &[[Option<f64>; 2]], which: Touched) -> Option<Vec<f64>> {
    let spreads: Vec<f64> = found.iter().map(|pair| which.of(*pair)).collect::<Option<_>>()?;
    let changes = spreads.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let moves = (spreads.len() - 1) as f64;
    let mean = changes.clone().sum::<f64>() / moves;
    (changes.fold(0.0, f64::max) <= STEADY * mean.max(1.0 / moves)).then_some(spreads)
}

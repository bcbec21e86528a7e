//! Where a tool is at any share of the way along a strip.

use rayon::prelude::*;

use super::course::{Course, STRAIGHT_MOVES};
use super::cutter::Flank;
use super::method::{beside_middle, offset, QUARTERS};
use super::stand::Stand;
use super::touch::{on_rails, touching};
use super::{FlankError, Method, RuledStrip};

/// Of more positions than straight moves count, so many are compared.
const COMPARED: usize = 161;
/// A change of the spread so many times that of the contacts, or of its mean, is a jump.
const STEADY: f64 = 2.0;

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
                let spread = which.of(touching(strip, flank, u)?).ok_or(FlankError::NoThreePoints { u })?;
                on_rails(strip, flank, u, spread)
            }
            Way::TwoPoints => Ok(offset(strip, flank, u, QUARTERS)),
            Way::OnePoint => Ok(beside_middle(strip, flank, u)),
        }
    }
}

/// The way that leaves least: a smooth course, or that which touches the ruling all along where the largest height is smaller so.
fn least_left(strip: &RuledStrip, flank: &Flank, count: usize) -> Result<Way, FlankError> {
    let course = Course::fitted(strip, flank, count)?;
    let is_straight = count <= STRAIGHT_MOVES;
    let compared = if is_straight { count } else { COMPARED };
    let largest = |spreads: &[f64]| Course::largest_of(strip, flank, spreads, is_straight);
    let least = largest(&course.spreads(compared))?;
    let found = touched(strip, flank, compared);
    let left = |which: Touched| {
        let spreads = steady(&found, which)?;
        largest(&spreads).ok().filter(|left| *left < least)
    };
    let lefts = [Touched::Above, Touched::Below, Touched::Least].map(|which| (which, left(which)));
    let better = lefts.into_iter().filter_map(|(which, left)| Some((which, left?)));
    let best = better.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(which, _)| which);
    let all_along = best.filter(|which| compared == count || steady(&touched(strip, flank, count), *which).is_some());
    Ok(all_along.map_or_else(|| Way::Spread(course), Way::Touching))
}

/// The spreads at which the ruling is touched on either side.
fn touched(strip: &RuledStrip, flank: &Flank, count: usize) -> Vec<[Option<f64>; 2]> {
    let at = |i: usize| touching(strip, flank, i as f64 / (count - 1) as f64).unwrap_or_default();
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

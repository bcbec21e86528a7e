//! z(r): by radius while the slope is below 45 degrees, by height above, where dz/dr has no limit.

use std::f64::consts::FRAC_PI_2;

use super::expression::Expression;
use super::interval::Interval;
use super::jet::Jet;
use super::number::Number;
use super::parametric::note_move;
use super::sample::{short, Enclosure, Route, Sample, Source, BY_HEIGHT, BY_RADIUS, SAMPLES};
use super::series::Series;
use super::solve::{bracket, solve};
use crate::GeometryError;

/// dz/dr from here on is a right angle but for rounding, if the height left is [`SLIVER`] of the radius at most.
const STEEP: f64 = 3e6;
const SLIVER: f64 = 1e-6;

struct Explicit {
    z: Expression,
    /// z at r = 0, in the formula's coordinates.
    origin: f64,
    upwards: f64,
    /// Radius of the base, mm.
    radius: f64,
    /// Points by radius, for the heights.
    knots: Vec<Sample>,
}

impl Explicit {
    fn jet(&self, r: f64) -> Jet {
        self.z.at(r, 0.0)
    }

    fn by_radius(&self, r: f64) -> Sample {
        let jet = self.jet(r);
        Sample {
            stretch: BY_RADIUS,
            p: r,
            point: [r, self.upwards * (jet.value - self.origin)],
            d: [1.0, self.upwards * jet.first[0]],
            dd: [0.0, self.upwards * jet.second[0]],
        }
    }

    fn by_height(&self, z: f64) -> Option<Sample> {
        let bracket = bracket(&self.knots, 1, z, self.radius)?;
        let above = |r: f64| {
            let mut jet = self.jet(r);
            jet.value = self.upwards * (jet.value - self.origin) - z;
            jet.first[0] *= self.upwards;
            jet
        };
        let (r, jet) = solve(&bracket, 0, 1.0, above)?;
        let d = 1.0 / jet.first[0];
        let dd = -self.upwards * jet.second[0] * d * d * d;
        Some(Sample { stretch: BY_HEIGHT, p: z, point: [r, z], d: [d, 1.0], dd: [dd, 0.0] })
    }
}

impl Source for Explicit {
    fn at(&self, stretch: usize, p: f64) -> Sample {
        if stretch == BY_RADIUS {
            return self.by_radius(p);
        }
        self.by_height(p).unwrap_or_else(|| self.by_radius(f64::NAN))
    }

    /// By radius, whatever the stretch.
    fn between(&self, from: &Sample, to: &Sample) -> Option<Sample> {
        let [low, high] = [from.point[0], to.point[0]];
        let r = 0.5 * (low + high);
        (low < r && r < high).then(|| self.by_radius(r))
    }

    fn enclose(&self, from: &Sample, to: &Sample) -> Option<Enclosure> {
        let [low, high] = [from.point[0], to.point[0]];
        let jet = self.z.over(Interval::new(low, high), Interval::default());
        let upwards = Interval::exact(self.upwards);
        let width = (high - low).next_up();
        let d = [Interval::exact(1.0), upwards * jet.first[0]];
        Some(Enclosure::new(width, d, [Interval::default(), upwards * jet.second[0]]))
    }

    fn residual(&self, _stretch: usize, _p: Series, [r, z]: &[Series; 2]) -> [Series; 2] {
        let number = |x: f64| Series::constant(Interval::exact(x));
        let above = self.z.along(*r, Series::default()).sub(number(self.origin));
        [number(self.upwards).mul(above).sub(*z), Series::default()]
    }

    fn field(&self, [r, _]: [Interval; 2]) -> Option<Jet<Interval>> {
        let upwards = Interval::exact(self.upwards);
        let mut jet = self.z.over(r, Interval::default());
        jet.first = [upwards * jet.first[0], Interval::exact(-1.0)];
        jet.second = [upwards * jet.second[0], Interval::default(), Interval::default()];
        Some(jet)
    }

    fn operations(&self) -> usize {
        self.z.operations
    }

    fn position(&self, sample: &Sample) -> String {
        format!("r = {}", short(if sample.stretch == BY_RADIUS { sample.p } else { sample.point[0] }))
    }
}

/// The same point by height instead of radius.
fn turned(knot: &Sample) -> Sample {
    let d = 1.0 / knot.d[1];
    let dd = if d == 0.0 { 0.0 } else { -knot.dd[1] * d * d * d };
    Sample { stretch: BY_HEIGHT, p: knot.point[1], d: [d, 1.0], dd: [dd, 0.0], ..*knot }
}

/// The route of z(r) from the axis to the base's radius.
pub(super) fn route(z: Expression, radius: f64) -> Result<Route, GeometryError> {
    let mut curve = Explicit { z, origin: 0.0, upwards: 1.0, radius, knots: Vec::new() };
    let tip = curve.by_radius(0.0);
    if !tip.is_finite() {
        let reason = "z or its derivative is not a finite number on the axis";
        let hint = "write the formula so that it has a value and a derivative there: 0/0 has none, its series has \
                    (1 - r^2/6 for sin(r)/r); a curve that begins upright is no tip";
        return Err(curve.refuse(&tip, reason, hint));
    }
    curve.origin = tip.point[1];
    let mut samples = spread(&curve, radius);
    // looked at near the tip: beyond a pole it may be anywhere
    if samples.get(SAMPLES / 8).is_some_and(|sample| sample.point[1] < 0.0) {
        curve.upwards = -1.0;
        samples = spread(&curve, radius);
    }
    let mut notes = Vec::new();
    note_move([0.0, curve.origin], curve.upwards < 0.0, &mut notes);
    if let Some(end) = samples.last_mut() {
        if upright(&curve, end, radius) {
            notes.push("the base's end is a right angle but for rounding and is taken as one".to_owned());
        }
    }
    let stretches = stretches(&samples);
    curve.knots.clone_from(&samples);
    Ok(Route { source: Box::new(curve), stretches, samples, notes })
}

/// Points from the axis to the radius, denser towards the base; the last one where the formula still has a value.
fn spread(curve: &Explicit, radius: f64) -> Vec<Sample> {
    let mut samples: Vec<Sample> =
        (0..SAMPLES).map(|k| curve.by_radius(radius * libm::sin(FRAC_PI_2 * k as f64 / SAMPLES as f64))).collect();
    let end = curve.by_radius(radius);
    let before = samples.last().map_or(0.0, |sample| sample.p);
    samples.push(if end.point[1].is_finite() { end } else { last_value(curve, before, radius).unwrap_or(end) });
    samples
}

/// The last point with a value, if only rounding parts it from the radius.
fn last_value(curve: &Explicit, before: f64, radius: f64) -> Option<Sample> {
    let (mut low, mut high) = (before, radius);
    while 0.5 * (low + high) > low && 0.5 * (low + high) < high {
        let middle = 0.5 * (low + high);
        if curve.by_radius(middle).is_finite() {
            low = middle;
        } else {
            high = middle;
        }
    }
    (radius - low <= 1e-9 * radius).then(|| curve.by_radius(low))
}

/// Makes the end upright where it is so, but for rounding (a sphere up to its equator); true if it was not quite.
fn upright(curve: &Explicit, end: &mut Sample, radius: f64) -> bool {
    let (d, dd) = (end.d[1], end.dd[1]);
    // what is left of a parabola that lies on its side
    let left = d * d / dd;
    let rounded = d > STEEP && d.is_finite() && left > 0.0 && left < SLIVER * radius;
    if d == f64::INFINITY || rounded {
        let height = end.point[1] + if rounded { left } else { 0.0 };
        let near = turned(&curve.by_radius(radius * (1.0 - 1e-9)));
        *end = Sample { stretch: BY_HEIGHT, p: height, point: [radius, height], d: [0.0, 1.0], dd: near.dd };
    }
    rounded
}

/// By radius up to the first point at 45 degrees, by height from there.
fn stretches(samples: &[Sample]) -> Vec<[Sample; 2]> {
    let (Some(tip), Some(end)) = (samples.first(), samples.last()) else { return Vec::new() };
    let upright = end.stretch == BY_HEIGHT;
    let steep = samples.iter().position(|sample| sample.d[1] >= sample.d[0]);
    let steep = if upright { steep.map(|index| index.min(samples.len() - 2)) } else { steep };
    match steep.filter(|index| index + 1 < samples.len()) {
        None => vec![[*tip, *end]],
        Some(index) => {
            let high = if upright { *end } else { turned(end) };
            let knot = samples[index];
            let above = [turned(&knot), high];
            if index == 0 {
                vec![above]
            } else {
                vec![[*tip, knot], above]
            }
        }
    }
}

//! f(r, z) = 0 from a start point: followed to the axis and to the base, by radius or by height as it lies.

use super::expression::Expression;
use super::field::{bending, Field};
use super::interval::Interval;
use super::jet::Jet;
use super::number::Number;
use super::parametric::note_move;
use super::proof::rises;
use super::refusal::refusal;
use super::sample::{Enclosure, Route, Sample, Source, BY_HEIGHT, BY_RADIUS, SAMPLES};
use super::series::Series;
use super::solve::{bracket, solve};
use super::trace::{trace, Knot};
use crate::GeometryError;

/// How near a point must be to the curve to be taken for one of it, in parts of the largest of its coordinates.
const ON_CURVE: f64 = 1e-11;
/// How often a box around a piece of the curve is made larger, and by how much of its extent.
const BOXES: usize = 3;
const LARGER: f64 = 0.25;

struct Implicit {
    field: Field,
    knots: Vec<Sample>,
    /// Signs of f's derivatives at the knots.
    signs: Vec<[f64; 2]>,
}

impl Implicit {
    /// The point with coordinate `axis` (0: r, 1: z) at a value.
    fn at_coordinate(&self, axis: usize, value: f64) -> Option<Sample> {
        let other = 1 - axis;
        let scale = self.knots.last()?.point[other].abs() + if axis == 0 { self.field.origin.abs() } else { 0.0 };
        let bracket = bracket(&self.knots, axis, value, scale)?;
        let point = |x: f64| if axis == 0 { [value, x] } else { [x, value] };
        // the end nearer to where the curve is a function of this coordinate
        let sign = self.signs.get(bracket.index + axis.min(1)).or(self.signs.get(bracket.index))?[other];
        let (x, jet) = solve(&bracket, other, sign, |x| self.field.jet(point(x)))?;
        let rate = -jet.first[axis] / jet.first[other];
        let d = if axis == 0 { [1.0, rate] } else { [rate, 1.0] };
        let turn = -bending(&jet, d) / jet.first[other];
        let dd = if axis == 0 { [0.0, turn] } else { [turn, 0.0] };
        let stretch = if axis == 0 { BY_RADIUS } else { BY_HEIGHT };
        Some(Sample { stretch, p: value, point: point(x), d, dd })
    }
}

/// Intervals by coordinates r and z, the two given in the order of `axis` and the other one.
fn by_axis(axis: usize, along: Interval, across: Interval) -> [Interval; 2] {
    if axis == 0 {
        [along, across]
    } else {
        [across, along]
    }
}

impl Implicit {
    /// The piece of the curve between two points as a graph over coordinate `axis`: a box that holds it.
    ///
    /// Where f's derivative across is not zero in a box, and the slopes that f has there keep the graph from the first
    /// point on inside it, the curve is that one graph: through the first point, which lies within [`ON_CURVE`] of
    /// f = 0 for the same derivative. The box of the next piece begins with a box around the same point, so both hold
    /// one and the same curve.
    fn graph(&self, axis: usize, from: &Sample, to: &Sample) -> Option<(Jet<Interval>, Interval)> {
        let other = 1 - axis;
        let near = ON_CURVE * self.knots.last()?.point[other].abs().max(self.field.origin.abs());
        let along = Interval::new(from.point[axis], to.point[axis]);
        let reach = Interval::new(0.0, (along.hi - along.lo).next_up());
        let start = Interval::exact(from.point[other]);
        let [first, last] = [from, to].map(|end| Interval::exact(end.point[other]) + Interval::around_zero(2.0 * near));
        let ends = first.joined(last);
        let mut across = ends;
        let value = self.field.over(by_axis(axis, Interval::exact(along.lo), start)).value;
        for _ in 0..=BOXES {
            let jet = self.field.over(by_axis(axis, along, across));
            let slope = -jet.first[axis] / jet.first[other];
            let off = value / jet.first[other];
            // not so for NaN
            let on_curve = off.size() <= near;
            if !on_curve {
                return None;
            }
            let graph = start - off + slope * reach;
            if graph.is_within(across) {
                return Some((jet, slope));
            }
            let margin = LARGER * (graph.hi - graph.lo);
            across = ends.joined(graph + Interval::around_zero(margin));
        }
        None
    }
}

impl Source for Implicit {
    fn at(&self, stretch: usize, p: f64) -> Sample {
        let point = if stretch == BY_RADIUS { [p, f64::NAN] } else { [f64::NAN, p] };
        let nowhere = Sample { stretch, p, point, d: [f64::NAN; 2], dd: [f64::NAN; 2] };
        self.at_coordinate(stretch, p).unwrap_or(nowhere)
    }

    fn enclose(&self, from: &Sample, to: &Sample) -> Option<Enclosure> {
        let axis = from.stretch;
        let (jet, slope) = self.graph(axis, from, to)?;
        let one = Interval::exact(1.0);
        let d = by_axis(axis, one, slope);
        let dd = by_axis(axis, Interval::default(), -bending(&jet, d) / jet.first[1 - axis]);
        Some(Enclosure::new((to.p - from.p).next_up(), d, dd))
    }

    fn residual(&self, _stretch: usize, _p: Series, [r, z]: &[Series; 2]) -> [Series; 2] {
        let number = |x: f64| Series::constant(Interval::exact(x));
        let height = number(self.field.origin).add(number(self.field.upwards).mul(*z));
        [self.field.f.along(*r, height), Series::default()]
    }

    fn field(&self, over: [Interval; 2]) -> Option<Jet<Interval>> {
        Some(self.field.over(over))
    }

    fn operations(&self) -> usize {
        (2 + BOXES) * self.field.f.operations
    }

    fn operators(&self) -> usize {
        self.field.f.operations
    }

    fn position(&self, sample: &Sample) -> String {
        self.field.position(sample.point)
    }
}

/// The route of f(r, z) = 0 through `start`, to the base's radius or where the slope is 90 degrees.
pub(super) fn route(f: Expression, start: [f64; 2], base: Option<f64>) -> Result<Route, GeometryError> {
    let mut field = Field { f, origin: 0.0, upwards: 1.0 };
    let knots = trace(&field, start, base)?;
    let (Some(tip), Some(end)) = (knots.first(), knots.last()) else { return Err(nothing(&field, start)) };
    field.origin = tip.point[1];
    field.upwards = if end.point[1] < tip.point[1] { -1.0 } else { 1.0 };
    let mut notes = Vec::new();
    note_move([0.0, field.origin], field.upwards < 0.0, &mut notes);
    let samples: Vec<Sample> = knots.iter().enumerate().map(|(index, knot)| moved(&field, knot, index)).collect();
    let signs = knots.iter().map(|knot| [knot.gradient[0], field.upwards * knot.gradient[1]].map(f64::signum));
    let curve = Implicit { signs: signs.collect(), knots: samples.clone(), field };
    let mut route = Route { source: Box::new(curve), stretches: Vec::new(), samples, notes };
    // the knots must rise before anything is looked for between them
    rises(&route)?;
    route.stretches = stretches(&route);
    route.samples = dense(&route);
    Ok(route)
}

fn nothing(field: &Field, start: [f64; 2]) -> GeometryError {
    refusal(field.position(start), "there is no curve here".to_owned(), "give a start point on the curve")
}

/// A knot in the tool's coordinates, by arc length. Each is a stretch of its own: nothing lies between them yet.
fn moved(field: &Field, knot: &Knot, index: usize) -> Sample {
    Sample {
        stretch: BY_HEIGHT + 1 + index,
        p: index as f64,
        point: [knot.point[0], field.upwards * (knot.point[1] - field.origin)],
        d: [knot.tangent[0], field.upwards * knot.tangent[1]],
        dd: [knot.turn[0], field.upwards * knot.turn[1]],
    }
}

/// By radius up to the first knot at 45 degrees, by height from there.
fn stretches(route: &Route) -> Vec<[Sample; 2]> {
    let knots = &route.samples;
    let (Some(tip), Some(end)) = (knots.first(), knots.last()) else { return Vec::new() };
    let by = |axis: usize, knot: &Sample| {
        let scale = 1.0 / knot.d[axis];
        let mut d = knot.d.map(|x| x * scale);
        d[axis] = 1.0;
        Sample { stretch: axis, p: knot.point[axis], d, ..*knot }
    };
    let steep = knots.iter().position(|knot| knot.d[1] >= knot.d[0]).filter(|index| index + 1 < knots.len());
    match steep {
        None => vec![[by(0, tip), by(0, end)]],
        Some(0) => vec![[by(1, tip), by(1, end)]],
        Some(index) => vec![[by(0, tip), by(0, &knots[index])], [by(1, &knots[index]), by(1, end)]],
    }
}

/// Points of the stretches, evenly; up to one that cannot be found, if there is one.
fn dense(route: &Route) -> Vec<Sample> {
    let each = SAMPLES / route.stretches.len().max(1);
    let mut samples = Vec::with_capacity(SAMPLES + 2);
    for [from, to] in &route.stretches {
        samples.push(*from);
        let step = (to.p - from.p) / each as f64;
        for k in 1..each {
            let sample = route.source.at(from.stretch, from.p + step * k as f64);
            samples.push(sample);
            if !sample.is_finite() {
                return samples;
            }
        }
        samples.push(*to);
    }
    samples
}

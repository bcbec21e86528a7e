//! r(t), z(t) over a range of t.

use super::expression::Expression;
use super::interval::Interval;
use super::number::Number;
use super::refusal::refusal;
use super::sample::{short, Enclosure, Route, Sample, Source, SAMPLES};
use super::series::Series;
use crate::GeometryError;

/// A tip this near to the axis, in parts of the size, is on it.
pub(super) const ON_AXIS: f64 = 1e-9;

/// The curve by p = t or, where the tip is at the end of the range, p = -t.
struct Parametric {
    r: Expression,
    z: Expression,
    /// Of t against p.
    direction: f64,
    /// The tip in the formula's coordinates.
    origin: [f64; 2],
    /// -1 where z falls from the tip.
    upwards: f64,
}

impl Source for Parametric {
    fn at(&self, stretch: usize, p: f64) -> Sample {
        let t = self.direction * p;
        let (r, z) = (self.r.at(t, 0.0), self.z.at(t, 0.0));
        Sample {
            stretch,
            p,
            point: [r.value - self.origin[0], self.upwards * (z.value - self.origin[1])],
            d: [self.direction * r.first[0], self.upwards * self.direction * z.first[0]],
            dd: [r.second[0], self.upwards * z.second[0]],
        }
    }

    fn enclose(&self, from: &Sample, to: &Sample) -> Option<Enclosure> {
        let t = Interval::between(self.direction * from.p, self.direction * to.p);
        let (r, z) = (self.r.over(t, Interval::default()), self.z.over(t, Interval::default()));
        let [direction, upwards] = [self.direction, self.upwards].map(Interval::exact);
        let d = [direction * r.first[0], upwards * direction * z.first[0]];
        Some(Enclosure::new((to.p - from.p).next_up(), d, [r.second[0], upwards * z.second[0]]))
    }

    fn residual(&self, _stretch: usize, p: Series, point: &[Series; 2]) -> [Series; 2] {
        let number = |x: f64| Series::constant(Interval::exact(x));
        let t = number(self.direction).mul(p);
        let (r, z) = (self.r.along(t, Series::default()), self.z.along(t, Series::default()));
        let r = r.sub(number(self.origin[0]));
        let z = number(self.upwards).mul(z.sub(number(self.origin[1])));
        [r.sub(point[0]), z.sub(point[1])]
    }

    fn operations(&self) -> usize {
        self.r.operations + self.z.operations
    }

    fn position(&self, sample: &Sample) -> String {
        format!("t = {}", short(self.direction * sample.p))
    }
}

impl Parametric {
    fn samples(&self, [from, to]: [f64; 2]) -> Vec<Sample> {
        let step = (to - from) / SAMPLES as f64;
        let at = |k: usize| self.at(0, if k == SAMPLES { to } else { from + step * k as f64 });
        (0..=SAMPLES).map(at).collect()
    }
}

/// The route of r(t), z(t), `t` from one end to the other, cut at the base's radius if there is one.
pub(super) fn route(
    r: Expression,
    z: Expression,
    [first, last]: [f64; 2],
    base: Option<f64>,
) -> Result<Route, GeometryError> {
    let mut curve = Parametric { r, z, direction: 1.0, origin: [0.0; 2], upwards: 1.0 };
    let [start, end] = tip_first(&mut curve, [first.min(last), first.max(last)], base)?;
    let mut notes = Vec::new();
    let mut range = [start, end];
    if let Some(radius) = base {
        range[1] = cut(&curve, range, radius)?;
    }
    // looked at near the tip: beyond a pole it may be anywhere
    if curve.at(0, range[0] + (range[1] - range[0]) / 8.0).point[1] < 0.0 {
        curve.upwards = -1.0;
    }
    note_move(curve.origin, curve.upwards < 0.0, &mut notes);
    let samples = curve.samples(range);
    let fastest = samples.iter().map(Sample::speed).filter(|speed| speed.is_finite()).fold(0.0, f64::max);
    let tip = moving(curve.at(0, range[0]), 1.0, fastest);
    let base = moving(curve.at(0, range[1]), -1.0, fastest);
    Ok(Route { source: Box::new(curve), stretches: vec![[tip, base]], samples, notes })
}

/// What was done to a curve to put its tip at the origin, z upwards.
pub(super) fn note_move(origin: [f64; 2], mirrored: bool, notes: &mut Vec<String>) {
    if origin[1] != 0.0 {
        notes.push(format!("moved by {} mm in z: the r = 0 end is the tip, at z = 0", short(-origin[1])));
    }
    if mirrored {
        notes.push("mirrored: z falls from its r = 0 end".to_owned());
    }
}

/// Turns the curve so that it begins at its end on the axis, and moves that to the origin.
fn tip_first(curve: &mut Parametric, range: [f64; 2], base: Option<f64>) -> Result<[f64; 2], GeometryError> {
    let ends = range.map(|t| curve.at(0, t));
    let finite_size = |sample: &Sample| sample.point[0].abs();
    let size = ends.iter().map(finite_size).chain(base).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let on_axis = |sample: &Sample| sample.point[0].abs() <= ON_AXIS * size;
    let tip = if on_axis(&ends[0]) {
        ends[0]
    } else if on_axis(&ends[1]) {
        curve.direction = -1.0;
        ends[1]
    } else {
        return Err(no_tip(&ends, range));
    };
    if !tip.point[1].is_finite() {
        return Err(curve.refuse(&tip, "z is not a finite number", "end the range before"));
    }
    if tip.d.iter().any(|d| !d.is_finite()) {
        let hint =
            "use a parameter by which r and z have derivatives there: for r = sqrt(t), z = t take r = t, z = t^2";
        return Err(curve.refuse(&tip, "r or z has no finite derivative at the tip", hint));
    }
    curve.origin = tip.point;
    Ok(if curve.direction > 0.0 { range } else { [-range[1], -range[0]] })
}

fn no_tip(ends: &[Sample; 2], range: [f64; 2]) -> GeometryError {
    let [a, b] = [0, 1].map(|i| format!("r = {} at t = {}", short(ends[i].point[0]), short(range[i])));
    refusal(
        format!("t = {} and t = {}", short(range[0]), short(range[1])),
        format!("the tip is not on the axis: {a}, {b}"),
        "one end of the range must have r = 0",
    )
}

/// The parameter at which the curve reaches the base's radius first.
fn cut(curve: &Parametric, range: [f64; 2], radius: f64) -> Result<f64, GeometryError> {
    let samples = curve.samples(range);
    let beyond = samples.iter().position(|sample| sample.point[0] >= radius);
    let Some(index) = beyond.filter(|index| *index > 0) else { return uncut(curve, &samples, radius) };
    let (mut low, mut high) = (samples[index - 1].p, samples[index].p);
    let mut p = high;
    for _ in 0..100 {
        let here = curve.at(0, p);
        let excess = here.point[0] - radius;
        if excess < 0.0 {
            low = p;
        } else {
            high = p;
        }
        let newton = p - excess / here.d[0];
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if excess == 0.0 || (next - p).abs() <= f64::EPSILON * p.abs().max(range[1] - range[0]) {
            break;
        }
        p = next;
    }
    Ok(p)
}

/// A curve that ends at the radius but for rounding, or one that does not get there.
fn uncut(curve: &Parametric, samples: &[Sample], radius: f64) -> Result<f64, GeometryError> {
    let finite = samples.iter().take_while(|sample| sample.is_finite());
    let widest = finite.max_by(|a, b| a.point[0].total_cmp(&b.point[0]));
    match widest {
        Some(widest) if widest.point[0] >= radius * (1.0 - ON_AXIS) => Ok(widest.p),
        Some(widest) => Err(curve.refuse(
            widest,
            &format!("the curve reaches r = {} only, not the base's {}", short(widest.point[0]), short(radius)),
            "give a smaller diameter, or a longer range",
        )),
        None => Err(refusal(
            format!("t = {}", short(curve.direction * samples.first().map_or(0.0, |sample| sample.p))),
            "the formula or its derivative is not a finite number".to_owned(),
            "end the range before",
        )),
    }
}

/// An end where the curve stands still (a cycloid's) goes on in the direction in which it starts or stops.
fn moving(mut end: Sample, inwards: f64, fastest: f64) -> Sample {
    if end.speed() <= 1e-9 * fastest {
        end.d = end.dd.map(|x| inwards * x * 1e-20);
    }
    end
}

//! Following f(r, z) = 0 in small steps, each put back on the curve.

use super::field::{bending, Field};
use super::jet::Jet;
use super::refusal::refusal;
use super::sample::short;
use super::solve::{solve, Bracket};
use crate::GeometryError;

/// Most steps, most turn of one, rad, and the turn below which steps grow.
const MOST_STEPS: usize = 4000;
const MOST_TURN: f64 = 0.04;
const LITTLE_TURN: f64 = 0.015;
/// Longest step in parts of the extent so far, and shortest in parts of the scale.
const LONGEST_STEP: f64 = 0.02;
const SHORTEST_STEP: f64 = 1e-9;
/// A tool is not larger than this, mm.
const LARGEST: f64 = 1e5;
/// A gradient this small, in parts of the start's, is none.
const NO_GRADIENT: f64 = 1e-9;

/// A point of the curve, by arc length outwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    pub point: [f64; 2],
    pub tangent: [f64; 2],
    /// Second derivative by arc length.
    pub turn: [f64; 2],
    pub gradient: [f64; 2],
}

struct Tracer<'a> {
    field: &'a Field,
    /// A length to measure by, mm.
    scale: f64,
    start: [f64; 2],
    /// Size of the gradient at the start.
    steepness: f64,
}

/// Knots from the axis outwards to the base's radius, or to where the slope is 90 degrees.
pub(super) fn trace(field: &Field, start: [f64; 2], base: Option<f64>) -> Result<Vec<Knot>, GeometryError> {
    let scale = start.iter().map(|x| x.abs()).chain(base).fold(1e-3, f64::max);
    let mut tracer = Tracer { field, scale, start, steepness: 0.0 };
    let first = tracer.first(start)?;
    let mut knots = tracer.inwards(first)?;
    knots.reverse();
    for knot in &mut knots {
        knot.tangent = knot.tangent.map(|x| -x);
    }
    tracer.outwards(&mut knots, base)?;
    Ok(knots)
}

impl Tracer<'_> {
    fn refuse(&self, point: [f64; 2], reason: &str, hint: &str) -> GeometryError {
        refusal(self.field.position(point), reason.to_owned(), hint)
    }

    fn no_gradient(&self, point: [f64; 2]) -> GeometryError {
        let hint = "the curve must be smooth and must not cross itself";
        // steps towards such a point shrink and do not quite reach it
        let point = point.map(|x| if x.abs() <= 1e-8 * self.scale { 0.0 } else { x });
        self.refuse(point, "the derivatives of the formula are both zero, or the curve has a corner", hint)
    }

    /// The start point, on the curve, with the tangent that leads inwards.
    fn first(&mut self, start: [f64; 2]) -> Result<Knot, GeometryError> {
        if start[0] < 0.0 {
            return Err(self.refuse(start, "the start point has a negative r", "r is the distance from the axis"));
        }
        let jet = self.field.jet(start);
        if !jet.value.is_finite() || !size(jet.first).is_finite() {
            return Err(self.refuse(start, "the formula is not a finite number here", "start on the curve"));
        }
        let Some(point) = self.corrected(start, 0.05 * self.scale) else {
            let reason = "the start point is not near the curve, or the formula has no derivative here";
            return Err(self.refuse(start, reason, "give a start point [r, z] on the curve"));
        };
        let point =
            if point[0].abs() <= 1e-9 * self.scale { self.on_axis(point[1], 0.1 * self.scale) } else { Some(point) };
        let Some(point) = point else { return Err(self.no_gradient(start)) };
        self.steepness = size(self.field.jet(point).first);
        let upright = self.knot(point, [0.0, -1.0]);
        let [along_r, _] = upright.tangent;
        // leads inwards; where it is upright, downwards
        Ok(if along_r > 1e-9 { self.knot(point, [-1.0, 0.0]) } else { upright })
    }

    /// The knot at a point of the curve, with the tangent that goes on most nearly in a direction.
    fn knot(&self, point: [f64; 2], direction: [f64; 2]) -> Knot {
        let jet = self.field.jet(point);
        let length = size(jet.first);
        let along = [jet.first[1] / length, -jet.first[0] / length];
        let forwards = along[0] * direction[0] + along[1] * direction[1] >= 0.0;
        let tangent = if forwards { along } else { along.map(|x| -x) };
        let turn = -bending(&jet, tangent) / (length * length);
        Knot { point, tangent, turn: jet.first.map(|x| turn * x), gradient: jet.first }
    }

    /// The point of the curve near a guess, at most `reach` from it.
    fn corrected(&self, guess: [f64; 2], reach: f64) -> Option<[f64; 2]> {
        let mut point = guess;
        for _ in 0..20 {
            let Jet { value, first, .. } = self.field.jet(point);
            let square = first[0] * first[0] + first[1] * first[1];
            let step = first.map(|d| value * d / square);
            point = [point[0] - step[0], point[1] - step[1]];
            let moved = size([point[0] - guess[0], point[1] - guess[1]]);
            if !moved.is_finite() || moved > reach {
                return None;
            }
            if size(step) <= 1e-15 * self.scale {
                return Some(point);
            }
        }
        (size(self.field.jet(point).first) > NO_GRADIENT * self.steepness).then_some(point)
    }

    /// The point of the curve on the axis near a height, at most `reach` from it.
    fn on_axis(&self, height: f64, reach: f64) -> Option<[f64; 2]> {
        let sign = self.field.jet([0.0, height]).first[1].signum();
        let bracket = Bracket { index: 0, ends: [height - reach, height + reach], guess: height, scale: self.scale };
        let (z, jet) = solve(&bracket, 1, sign, |z| self.field.jet([0.0, z]))?;
        let found = self.field.jet([0.0, z]).value.abs() <= 1e-9 * self.scale * jet.first[1].abs();
        (found && jet.first[1].abs() > NO_GRADIENT * self.steepness).then_some([0.0, z])
    }

    /// From the start to the axis.
    fn inwards(&self, first: Knot) -> Result<Vec<Knot>, GeometryError> {
        let mut knots = vec![first];
        let mut here = first;
        let mut step = 1e-3 * self.scale;
        while here.point[0] > 0.0 {
            if knots.len() > MOST_STEPS || here.tangent[0] > 1e-9 {
                return Err(self.refuse(here.point, "the curve does not reach the axis", "the tip must have r = 0"));
            }
            let to_axis = here.point[0] / -here.tangent[0];
            if to_axis > 0.0 && to_axis <= step {
                let height = here.point[1] + here.tangent[1] * to_axis;
                if let Some(tip) = self.on_axis(height, to_axis) {
                    knots.push(self.knot(tip, here.tangent));
                    break;
                }
                step = 0.5 * to_axis;
            }
            let before = here;
            (here, step) = self.advanced(&before, step)?;
            if here.point[0] <= 0.0 {
                // a little shorter by its tangent, and yet beyond the axis
                here = self.crossing(&before, &here)?;
            }
            knots.push(here);
        }
        match knots.last() {
            Some(tip) if size(tip.gradient) > NO_GRADIENT * self.steepness => Ok(knots),
            _ => Err(self.no_gradient(here.point)),
        }
    }

    /// The tip: where the curve between two knots crosses the axis.
    fn crossing(&self, before: &Knot, beyond: &Knot) -> Result<Knot, GeometryError> {
        let [r, z] = [0, 1].map(|i| beyond.point[i] - before.point[i]);
        let height = before.point[1] - z * before.point[0] / r;
        let tip = self.on_axis(height, size([r, z])).ok_or_else(|| self.no_gradient(before.point))?;
        Ok(self.knot(tip, before.tangent))
    }

    /// The next knot and the step after it.
    fn advanced(&self, here: &Knot, mut step: f64) -> Result<(Knot, f64), GeometryError> {
        let extent = size([here.point[0] - self.start[0], here.point[1] - self.start[1]]) + self.scale;
        step = step.min(LONGEST_STEP * extent);
        while step > SHORTEST_STEP * self.scale {
            let guess = std::array::from_fn(|i| here.point[i] + step * (here.tangent[i] + 0.5 * step * here.turn[i]));
            if let Some(point) = self.corrected(guess, 0.5 * step) {
                let next = self.knot(point, here.tangent);
                let turned = size([next.tangent[0] - here.tangent[0], next.tangent[1] - here.tangent[1]]);
                let same_side = next.gradient[0] * here.gradient[0] + next.gradient[1] * here.gradient[1] > 0.0;
                if turned <= MOST_TURN && same_side {
                    return Ok((next, if turned < LITTLE_TURN { 1.6 * step } else { step }));
                }
            }
            step *= 0.5;
        }
        Err(self.no_gradient(here.point))
    }

    /// From the last knot to the base.
    fn outwards(&self, knots: &mut Vec<Knot>, base: Option<f64>) -> Result<(), GeometryError> {
        let Some(mut here) = knots.last().copied() else { return Ok(()) };
        // a start beyond the base: the knots there are not needed
        if let Some(index) = base.and_then(|radius| knots.iter().position(|knot| knot.point[0] >= radius)) {
            knots.truncate(index + 1);
            return self.finish(knots, base);
        }
        let mut step = 1e-3 * self.scale;
        while here.tangent[0] > 1e-12 && base.is_none_or(|radius| here.point[0] < radius) {
            if knots.len() > 2 * MOST_STEPS || here.point.iter().any(|x| x.abs() > LARGEST) {
                self.rises_steadily(knots)?;
                let hint = "give a diameter: the curve does not reach 90 degrees";
                return Err(self.refuse(here.point, "the curve does not end", hint));
            }
            (here, step) = self.advanced(&here, step)?;
            knots.push(here);
        }
        self.finish(knots, base)
    }

    /// Refuses a curve that becomes less steep again, at its steepest knot.
    fn rises_steadily(&self, knots: &[Knot]) -> Result<(), GeometryError> {
        let slope = |knot: &Knot| libm::atan2(knot.tangent[1].abs(), knot.tangent[0]);
        let steepest = knots.iter().max_by(|a, b| slope(a).total_cmp(&slope(b)));
        let (Some(steepest), Some(last)) = (steepest, knots.last()) else { return Ok(()) };
        if slope(last) > slope(steepest) - MOST_TURN {
            return Ok(());
        }
        let reason = format!(
            "the slope comes near {} degrees here and falls again: the curve is concave beyond",
            short(slope(steepest).to_degrees().round())
        );
        Err(self.refuse(steepest.point, &reason, "give the diameter at which it is to end"))
    }

    /// Puts the last knot, which is at or beyond the end, onto the end.
    fn finish(&self, knots: &mut Vec<Knot>, base: Option<f64>) -> Result<(), GeometryError> {
        let (Some(beyond), Some(before)) = (knots.pop(), knots.last().copied()) else {
            return Err(self.refuse(self.start, "the curve ends where it begins", "start at a point of the profile"));
        };
        let equator = if beyond.tangent[0] <= 1e-12 { Some(self.equator(&before, &beyond)) } else { None };
        let widest = equator.map_or(beyond.point[0], |knot| knot.point[0]);
        let end = match (base, equator) {
            (Some(radius), Some(equator)) if radius > widest * (1.0 - 1e-9) => {
                if radius > widest * (1.0 + 1e-9) {
                    let reason = format!(
                        "the slope reaches 90 degrees at r = {}, before the base's {}",
                        short(widest),
                        short(radius)
                    );
                    return Err(self.refuse(equator.point, &reason, "give a smaller diameter, or none"));
                }
                equator
            }
            (Some(radius), _) => self.at_radius(&before, &beyond, radius),
            (None, Some(equator)) => equator,
            (None, None) => beyond,
        };
        if size([end.point[0] - before.point[0], end.point[1] - before.point[1]]) <= 1e-12 * self.scale {
            knots.pop();
        }
        knots.push(end);
        Ok(())
    }

    /// Where the curve passes a radius between two knots.
    fn at_radius(&self, before: &Knot, beyond: &Knot, radius: f64) -> Knot {
        let share = (radius - before.point[0]) / (beyond.point[0] - before.point[0]);
        let guess = before.point[1] + share * (beyond.point[1] - before.point[1]);
        let bracket = Bracket { index: 0, ends: [before.point[1], beyond.point[1]], guess, scale: self.scale };
        let sign = before.gradient[1].signum();
        let z = solve(&bracket, 1, sign, |z| self.field.jet([radius, z])).map_or(guess, |(z, _)| z);
        self.knot([radius, z], before.tangent)
    }

    /// Where the slope is 90 degrees: between a knot before and one at or beyond.
    fn equator(&self, before: &Knot, beyond: &Knot) -> Knot {
        let (mut low, mut high) = (*before, *beyond);
        let reach = size([high.point[0] - low.point[0], high.point[1] - low.point[1]]);
        for _ in 0..60 {
            if high.tangent[0] >= -1e-15 {
                break;
            }
            let middle = std::array::from_fn(|i| 0.5 * (low.point[i] + high.point[i]));
            let Some(point) = self.corrected(middle, reach) else { break };
            let knot = self.knot(point, before.tangent);
            if knot.tangent[0] > 0.0 {
                low = knot;
            } else {
                high = knot;
            }
        }
        high.tangent[0] = 0.0;
        high
    }
}

fn size([a, b]: [f64; 2]) -> f64 {
    (a * a + b * b).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::formula::expression::Expression;
    use crate::profile::formula::tokens::Names;

    /// The last step before the axis ends just beyond it: a few micrometres in a hundred thousand sizes do.
    #[test]
    fn the_tip_is_on_the_axis() {
        let parameters = std::collections::BTreeMap::new();
        let names = Names { key: "implicit", variables: &["r", "z"], parameters: &parameters };
        for [radius, height] in [[0.53012, 0.221084], [1.11416, 0.629912], [1.16567, 0.665969], [2.24976, 1.424832]] {
            let text = format!("(r/{radius})^2 + (z/{height} - 1)^2 - 1");
            let field = Field { f: Expression::new(&text, &names).unwrap(), origin: 0.0, upwards: 1.0 };
            let knots = trace(&field, [radius, height], None).unwrap();
            assert!(knots[0].point[0].abs() < f64::MIN_POSITIVE, "{text}: the tip is at {:?}", knots[0].point);
        }
    }
}

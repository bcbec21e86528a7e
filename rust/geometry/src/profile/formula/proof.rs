//! Proof that a formula is a profile: finite, rising, convex, up to 90 degrees; or where it is not.

use std::f64::consts::FRAC_PI_2;

use super::sample::{short, Enclosure, Route, Sample, Source};
use crate::GeometryError;

/// Slopes out of [0, 90 degrees] by less than this are rounding, rad.
const SLOPE_ROUNDING: f64 = 1e-8;
/// A tip this near to 90 degrees has no profile beyond it, rad.
const UPRIGHT: f64 = 1e-6;
/// Curvature times size below zero by less than this is rounding.
const CURVATURE_ROUNDING: f64 = 1e-9;
/// A point slower than this part of the fastest stands still.
const STANDSTILL: f64 = 1e-9;

/// Least and largest lengths of a base, mm.
const SMALLEST: f64 = 1e-6;
const LARGEST: f64 = 1e4;
/// Reason and hint for a point that does not move on with its parameter.
const STANDS_STILL: (&str, &str) =
    ("both derivatives are zero: the curve has no tangent", "use a parameter by which the point moves on everywhere");
/// How many of the defects are of value and slope; the others are of curvature.
const RISING: usize = 3;

/// A defect that a point can have.
struct Defect {
    is_at: fn(&Sample, f64) -> bool,
    /// Rounding cannot make it up, at a point with these derivatives.
    is_certain: fn(&Enclosure) -> bool,
    reason: &'static str,
    hint: &'static str,
}

const DEFECTS: [Defect; 4] = [
    Defect {
        is_at: |sample, _| !sample.is_finite(),
        is_certain: |_| true,
        reason: "the formula or its derivative is not a finite number",
        hint: "end the range before, or write the formula so that it is smooth there",
    },
    Defect {
        is_at: |sample, _| sample.d[1] < -SLOPE_ROUNDING * sample.speed() && sample.d[0] > 0.0,
        is_certain: |piece| piece.d[1].hi < 0.0,
        reason: "z falls: the curve is not monotone",
        hint: "z must rise all the way from tip to base (or fall, then it is mirrored)",
    },
    Defect {
        is_at: |sample, _| sample.slope().abs() > FRAC_PI_2 + SLOPE_ROUNDING,
        is_certain: |piece| piece.d[0].hi < 0.0,
        reason: "r falls: the slope passes 90 degrees, the curve turns inwards",
        hint: "end the range there, or give a diameter",
    },
    Defect {
        is_at: |sample, size| {
            let speed = sample.speed();
            sample.turning() < -sample.turning_noise() - CURVATURE_ROUNDING * speed * speed * speed / size
        },
        is_certain: |piece| piece.turning.hi < 0.0,
        reason: "the curve is concave: its slope falls",
        hint: "a tool's profile turns upwards all the way from tip to base",
    },
];

/// Refuses a route with a defect, with the position where it begins.
pub(super) fn prove(route: &Route) -> Result<(), GeometryError> {
    has_none_of(&DEFECTS, route)?;
    ends_are_in_range(route)?;
    moves_everywhere(route)?;
    is_of_a_tools_size(route)
}

/// Refuses a route that does not rise; its curvature is not checked.
pub(super) fn rises(route: &Route) -> Result<(), GeometryError> {
    has_none_of(&DEFECTS[..RISING], route)
}

fn has_none_of(all: &[Defect], route: &Route) -> Result<(), GeometryError> {
    let size = route.size();
    let last = route.samples.len().saturating_sub(1);
    for (index, sample) in route.samples.iter().enumerate() {
        values_rise(route, index, size)?;
        // at its two ends the curve may have no curvature or stand still: their slopes come from within
        let defects = if index == 0 || index == last { &all[..1] } else { all };
        for defect in defects {
            if (defect.is_at)(sample, size) {
                let position = beginning(route, index, |sample| (defect.is_at)(sample, size));
                return Err(route.source.refuse(&position, defect.reason, defect.hint));
            }
        }
    }
    Ok(())
}

/// Refuses a point, the one before it being without defect, that has one for certain: with the position where it begins.
pub(super) fn refuse_defect(
    source: &dyn Source,
    before: &Sample,
    point: &Sample,
    size: f64,
) -> Result<(), GeometryError> {
    for defect in DEFECTS.iter().filter(|defect| (defect.is_at)(point, size)) {
        let certain = source.enclose(point, point).is_none_or(|piece| (defect.is_certain)(&piece));
        if certain {
            let position = between(source, *before, *point, |sample| (defect.is_at)(sample, size));
            return Err(source.refuse(&position, defect.reason, defect.hint));
        }
    }
    Ok(())
}

/// Refuses r or z lower than at the sample before although the derivatives rise: a pole lies between.
fn values_rise(route: &Route, index: usize, size: f64) -> Result<(), GeometryError> {
    let Some(before) = index.checked_sub(1).map(|before| route.samples[before].point) else { return Ok(()) };
    let falls = |sample: &Sample, i: usize| sample.point[i] < before[i] - 1e-9 * size;
    for (i, reason) in
        ["r falls: the curve turns inwards", "z falls: the curve is not monotone"].into_iter().enumerate()
    {
        if falls(&route.samples[index], i) && route.samples[index].d[i] >= 0.0 {
            let position = beginning(route, index, |sample| falls(sample, i));
            let hint = "r and z must rise all the way from tip to base (or z fall, then it is mirrored)";
            return Err(route.source.refuse(&position, reason, hint));
        }
    }
    Ok(())
}

/// Where, between the sample with a defect and the one before, the defect begins.
fn beginning(route: &Route, index: usize, is_bad: impl Fn(&Sample) -> bool) -> Sample {
    let bad = route.samples[index];
    let Some(good) = index.checked_sub(1).map(|before| route.samples[before]) else { return bad };
    between(route.source.as_ref(), good, bad, is_bad)
}

fn between(source: &dyn Source, good: Sample, bad: Sample, is_bad: impl Fn(&Sample) -> bool) -> Sample {
    if good.stretch != bad.stretch || is_bad(&good) {
        return bad;
    }
    let (mut low, mut high) = (good, bad);
    for _ in 0..40 {
        let middle = source.at(bad.stretch, 0.5 * (low.p + high.p));
        if is_bad(&middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    if high.point.iter().all(|x| x.is_finite()) {
        high
    } else {
        Sample { p: high.p, ..low }
    }
}

fn ends_are_in_range(route: &Route) -> Result<(), GeometryError> {
    let (Some([tip, _]), Some([_, base])) = (route.stretches.first(), route.stretches.last()) else { return Ok(()) };
    if let Some(end) = [tip, base].into_iter().find(|end| end.speed() == 0.0) {
        return Err(route.source.refuse(end, STANDS_STILL.0, STANDS_STILL.1));
    }
    if tip.slope() < -SLOPE_ROUNDING || tip.slope() > FRAC_PI_2 - UPRIGHT {
        let reason = "the slope on the axis is not between 0 and 90 degrees";
        return Err(route.source.refuse(tip, reason, "the curve rises from its tip"));
    }
    let passes = |sample: &Sample| !(-SLOPE_ROUNDING..=FRAC_PI_2 + SLOPE_ROUNDING).contains(&sample.slope());
    if passes(base) {
        let position = beginning(route, route.samples.len() - 1, passes);
        let reason = "the slope at the base is not between 0 and 90 degrees";
        return Err(route.source.refuse(&position, reason, "end the range there, or give a diameter"));
    }
    Ok(())
}

/// Refuses a profile too small or too large for a tool.
fn is_of_a_tools_size(route: &Route) -> Result<(), GeometryError> {
    let Some([_, base]) = route.stretches.last() else { return Ok(()) };
    let [radius, height] = base.point;
    if radius > SMALLEST && radius <= LARGEST && height <= LARGEST {
        return Ok(());
    }
    let reason = format!("the base has a radius of {} mm and a height of {} mm", short(radius), short(height));
    Err(route.source.refuse(base, &reason, "lengths are mm, up to 10000: end the range before, or scale the formula"))
}

/// Refuses a point inside where the parameter moves on and the curve does not.
fn moves_everywhere(route: &Route) -> Result<(), GeometryError> {
    let fastest = route.samples.iter().map(Sample::speed).filter(|speed| speed.is_finite()).fold(0.0, f64::max);
    let approach = |sample: &Sample| sample.d[0] * sample.dd[0] + sample.d[1] * sample.dd[1];
    let inside = route.samples.len().saturating_sub(1);
    for (index, pair) in route.samples.windows(2).enumerate().take(inside).skip(1) {
        if pair[0].stretch != pair[1].stretch || approach(&pair[0]) > 0.0 || approach(&pair[1]) < 0.0 {
            continue;
        }
        let slowest = beginning(route, index + 1, |sample| approach(sample) >= 0.0);
        if slowest.speed() <= STANDSTILL * fastest && index + 2 < route.samples.len() {
            return Err(route.source.refuse(&slowest, STANDS_STILL.0, STANDS_STILL.1));
        }
    }
    Ok(())
}

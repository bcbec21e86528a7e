//! A profile through measured points: arcs of circles that meet with one tangent, convex because the points are.

use std::f64::consts::FRAC_PI_2;

use super::{chain::Builder, Arc, Curve, Profile};
use crate::GeometryError;

/// Points at most: a file with more is a scan, not a profile.
const MOST: usize = 100_000;
/// Points nearer to a chord than this share of the profile's size lie on it: a straight part is meant.
const STRAIGHT: f64 = 1e-9;
/// Slopes that differ by less are one, rad.
const SAME_SLOPE: f64 = 1e-9;

/// A profile and the largest distance (mm) of a given point from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The profile.
    pub profile: Profile,
    /// Largest distance of a point from it, mm.
    pub deviation: f64,
}

/// Fits a convex profile with a continuous tangent through points (r, z), mm, ordered from the tip, beyond the end of
/// `tip`.
///
/// Points inside the convex hull of the others by up to `tolerance` mm are passed by: the profile then encloses them,
/// which can only keep the tool off the part. Between two corners of the hull run two arcs that meet at the chord's
/// slope (a convex biarc); where three points or more lie on a line, the line is kept.
///
/// # Errors
/// Too few points, one that is not finite or turns back, a tip off the axis, a hollow deeper than `tolerance`, a
/// corner: each with the point's number and place.
pub fn fit(points: &[[f64; 2]], tolerance: f64, tip: Builder) -> Result<Fit, GeometryError> {
    check(points)?;
    let [r0, z0] = points[0];
    let begin = tip.at().0;
    let moved: Vec<[f64; 2]> = points.iter().map(|[r, z]| [r - r0 + begin, z - z0]).collect();
    let hull = hull(&moved);
    let size = moved[moved.len() - 1].iter().fold(0.0, |a: f64, b| a.max(*b));
    let depth = deepest_hollow(&moved, &hull, tolerance)?;
    let chords = chords(&moved, &hull, STRAIGHT * size);
    let slopes = tangents(&moved, &hull, &chords)?;
    let profile = led(tip, &moved, &hull, &chords, &slopes);
    Ok(Fit { deviation: depth.max(outside(&moved, &profile)), profile })
}

fn refused(number: usize, [r, z]: [f64; 2], reason: impl Into<String>, hint: &str) -> GeometryError {
    let place = format!("points[{number}] (r = {r}, z = {z})");
    GeometryError::Profile { place, reason: reason.into(), hint: hint.to_owned() }
}

fn check(points: &[[f64; 2]]) -> Result<(), GeometryError> {
    if points.len() < 3 || points.len() > MOST {
        let reason = format!("{} points: 3 to {MOST} make a profile", points.len());
        return Err(GeometryError::Profile { place: "points".to_owned(), reason, hint: "add points".to_owned() });
    }
    let in_this_world = |x: &f64| x.is_finite() && x.abs() <= 1e4;
    if let Some((i, p)) = points.iter().enumerate().find(|(_, p)| !p.iter().all(in_this_world)) {
        return Err(refused(i, *p, "not a length of up to 10000 mm", "correct the point"));
    }
    if points[0][0] != 0.0 {
        return Err(refused(0, points[0], "the tip is not on the axis", "begin with r = 0"));
    }
    for (i, pair) in points.windows(2).enumerate() {
        let ([r, z], next) = (pair[0], pair[1]);
        if next[0] < r || next[1] < z {
            return Err(refused(
                i + 1,
                next,
                "r or z falls from the point before",
                "order the points from tip to base",
            ));
        }
        if next[0] <= r && next[1] <= z {
            return Err(refused(i + 1, next, "the same point twice", "remove one"));
        }
    }
    if points[points.len() - 1][0] <= 1e-6 {
        return Err(refused(points.len() - 1, points[points.len() - 1], "no radius is reached", "give r in mm"));
    }
    Ok(())
}

/// Positive where c lies to the left of the line from a to b: towards the axis and up, outside of a convex tool.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Numbers of the points that are corners of the lower right hull, in order.
fn hull(points: &[[f64; 2]]) -> Vec<usize> {
    let mut corners: Vec<usize> = Vec::new();
    for (i, p) in points.iter().enumerate() {
        while let [.., a, b] = corners[..] {
            if turn(points[a], points[b], *p) > 0.0 {
                break;
            }
            corners.pop();
        }
        corners.push(i);
    }
    corners
}

/// The largest distance of a point from the hull; none may be above `tolerance`.
fn deepest_hollow(points: &[[f64; 2]], hull: &[usize], tolerance: f64) -> Result<f64, GeometryError> {
    let mut deepest = (0.0, 0);
    for pair in hull.windows(2) {
        for i in pair[0] + 1..pair[1] {
            let depth = off_line(points[pair[0]], points[pair[1]], points[i]);
            if depth > deepest.0 {
                deepest = (depth, i);
            }
        }
    }
    let (depth, number) = deepest;
    if depth > tolerance {
        let reason = format!("the profile is hollow here, by {depth:.3e} mm");
        return Err(refused(number, points[number], reason, "correct the point, or raise fit_tolerance"));
    }
    Ok(depth)
}

fn off_line(a: [f64; 2], b: [f64; 2], p: [f64; 2]) -> f64 {
    turn(a, b, p).abs() / libm::hypot(b[0] - a[0], b[1] - a[1])
}

/// A chord between two corners of the hull.
struct Chord {
    slope: f64,
    length: f64,
    /// Whether a line is meant: points lie on it.
    straight: bool,
}

fn chords(points: &[[f64; 2]], hull: &[usize], straight: f64) -> Vec<Chord> {
    hull.windows(2)
        .map(|pair| {
            let (a, b) = (points[pair[0]], points[pair[1]]);
            let (r, z) = (b[0] - a[0], b[1] - a[1]);
            let mut between = pair[0] + 1..pair[1];
            let on_line = !between.is_empty() && between.all(|i| off_line(a, b, points[i]) <= straight);
            let slope = libm::atan2(z, r);
            // at 0 and at a right angle there is nothing to bend to
            let axial = slope <= SAME_SLOPE || slope >= FRAC_PI_2 - SAME_SLOPE;
            Chord { slope, length: libm::hypot(r, z), straight: on_line || axial }
        })
        .collect()
}

/// The slope at each corner of the hull: horizontal at the tip, that of the circle through the neighbours elsewhere.
fn tangents(points: &[[f64; 2]], hull: &[usize], chords: &[Chord]) -> Result<Vec<f64>, GeometryError> {
    let mut slopes = vec![if chords[0].straight { chords[0].slope } else { 0.0 }];
    for (i, pair) in chords.windows(2).enumerate() {
        let (before, after) = (&pair[0], &pair[1]);
        slopes.push(match (before.straight, after.straight) {
            (true, true) => {
                let reason = format!(
                    "a corner between straight parts, from {:.3} to {:.3} degrees",
                    before.slope.to_degrees(),
                    after.slope.to_degrees()
                );
                let number = hull[i + 1];
                return Err(refused(number, points[number], reason, "round it with more points"));
            }
            (true, false) => before.slope,
            (false, true) => after.slope,
            // the tangent of the circle through three points turns as the chords are long
            _ => before.slope + (after.slope - before.slope) * before.length / (before.length + after.length),
        });
    }
    let last = &chords[chords.len() - 1];
    let end = if last.straight { last.slope } else { 2.0 * last.slope - slopes[slopes.len() - 1] };
    slopes.push(end.min(FRAC_PI_2));
    Ok(slopes)
}

fn led(mut builder: Builder, points: &[[f64; 2]], hull: &[usize], chords: &[Chord], slopes: &[f64]) -> Profile {
    for (i, chord) in chords.iter().enumerate() {
        builder.kink(slopes[i]);
        let turns = |from: f64, to: f64| to - from > SAME_SLOPE;
        if chord.straight || !turns(slopes[i], chord.slope) || !turns(chord.slope, slopes[i + 1]) {
            builder.straight(chord.length);
        } else {
            let (a, b) = (builder.at(), points[hull[i + 1]]);
            for (radius, from, to) in biarc([b[0] - a.0, b[1] - a.1], slopes[i], slopes[i + 1]) {
                builder.curve(Curve::Arc(Arc::new(radius, from)), from, to);
            }
        }
    }
    builder.finish()
}

/// Two arcs from the origin to `end`, from the slope `first` to `last`, that meet at the chord's own slope.
///
/// The chord's direction lies between those of the two arcs' chords, so both radii are positive.
fn biarc(end: [f64; 2], first: f64, last: f64) -> [(f64, f64, f64); 2] {
    let middle = libm::atan2(end[1], end[0]).clamp(first, last);
    let unit = |from: f64, to: f64| {
        let chord = 2.0 * libm::sin(0.5 * (to - from));
        let (sin, cos) = libm::sincos(0.5 * (from + to));
        [chord * cos, chord * sin]
    };
    let (a, b) = (unit(first, middle), unit(middle, last));
    let determinant = a[0] * b[1] - a[1] * b[0];
    let cross = |u: [f64; 2], v: [f64; 2]| (u[0] * v[1] - u[1] * v[0]) / determinant;
    [(cross(end, b).max(0.0), first, middle), (cross(a, end).max(0.0), middle, last)]
}

/// The largest distance of a point outside the profile: rounding, unless the chain was led astray.
fn outside(points: &[[f64; 2]], profile: &Profile) -> f64 {
    let gap = |[r, z]: &[f64; 2]| {
        let slope = profile.slope_at_radius(r.min(profile.base().0));
        let (sin, cos) = libm::sincos(slope);
        let on = profile.point_at(slope);
        (r - on.0) * sin - (z - on.1) * cos
    };
    points.iter().map(gap).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of_circle(count: usize, radius: f64) -> Vec<[f64; 2]> {
        (0..=count)
            .map(|i| FRAC_PI_2 * i as f64 / count as f64)
            .map(|a| [if a == 0.0 { 0.0 } else { radius * a.sin() }, radius * (1.0 - a.cos())])
            .collect()
    }

    #[test]
    fn points_of_a_circle_give_the_circle() {
        let fit = fit(&of_circle(12, 5.0), 1e-6, Builder::default()).unwrap();
        assert!(fit.deviation < 1e-12, "{}", fit.deviation);
        for slope in [0.0, 0.2, 0.7, 1.2, 1.5] {
            let (r, z) = fit.profile.point_at(slope);
            assert!((r - 5.0 * slope.sin()).abs() < 1e-9, "{slope}: {r}");
            assert!((z - 5.0 * (1.0 - slope.cos())).abs() < 1e-9, "{slope}: {z}");
        }
    }

    #[test]
    fn flats_and_lines_are_kept() {
        let mut points = vec![[0.0, 0.0], [1.0, 0.0]];
        points.extend(
            (1..=9).map(|i| f64::from(i).to_radians() * 5.0).map(|a| [1.0 + 4.0 * a.sin(), 4.0 * (1.0 - a.cos())]),
        );
        let (r, z) = (points[10][0], points[10][1]);
        points.extend((1..=3).map(|i| [r + f64::from(i), z + f64::from(i)]));
        let profile = fit(&points, 1e-6, Builder::default()).unwrap().profile;
        let straights: Vec<_> = profile.straights().collect();
        assert_eq!(straights.len(), 2);
        assert!(straights[0].slope.abs() < 1e-12 && (straights[0].outer.0 - 1.0).abs() < 1e-12);
        assert!((straights[1].slope - 45.0_f64.to_radians()).abs() < 1e-9);
        assert!((straights[1].outer.0 - straights[1].inner.0 - 3.0).abs() < 1e-9);
    }

    #[test]
    fn a_hollow_is_passed_by_within_the_tolerance_or_refused_with_its_place() {
        let mut points = of_circle(40, 5.0);
        points[20][1] += 0.01;
        let chord = fit(&points, 0.01, Builder::default()).unwrap();
        assert!(chord.deviation > 1e-4 && chord.deviation < 0.01, "{}", chord.deviation);
        let error = fit(&points, 1e-6, Builder::default()).unwrap_err().to_string();
        assert!(error.contains("points[20]") && error.contains("hollow"), "{error}");
    }

    #[test]
    fn what_is_no_profile_is_refused_with_its_place() {
        let refused = |points: &[[f64; 2]], word: &str| {
            let error = fit(points, 1e-3, Builder::default()).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
        };
        refused(&[[0.0, 0.0], [1.0, 0.1]], "2 points");
        refused(&[[0.1, 0.0], [1.0, 0.1], [2.0, 1.0]], "axis");
        refused(&[[0.0, 0.0], [1.0, f64::NAN], [2.0, 1.0]], "points[1]");
        refused(&[[0.0, 0.0], [1.0, 0.1], [0.5, 1.0]], "points[2]");
        refused(&[[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]], "corner");
        refused(&[[0.0, 0.0], [0.0, 0.0], [5.0, 5.0]], "twice");
    }

    proptest! {
        #[test]
        fn any_convex_points_give_a_convex_profile_through_them(
            steps in prop::collection::vec((0.01..2.0_f64, 0.001..1.0_f64), 2..40),
        ) {
            let total: f64 = steps.iter().map(|s| s.1).sum();
            let (mut at, mut slope) = ([0.0, 0.0], 0.0);
            let mut points = vec![at];
            for (length, turned) in steps {
                slope += turned / total * 1.5;
                at = [at[0] + length * f64::cos(slope), at[1] + length * f64::sin(slope)];
                points.push(at);
            }
            let fit = fit(&points, 1e-9, Builder::default()).unwrap();
            prop_assert!(fit.deviation < 1e-9, "{}", fit.deviation);
            for [r, z] in points {
                let slope = fit.profile.slope_at_radius(r.min(fit.profile.base().0));
                let on = fit.profile.point_at(slope);
                let off = (r - on.0) * slope.sin() - (z - on.1) * slope.cos();
                prop_assert!(off.abs() < 1e-9, "{off}");
            }
            let ends: Vec<f64> = fit.profile.breaks().collect();
            prop_assert!(ends.windows(2).all(|pair| pair[0] <= pair[1]));
        }
    }
}

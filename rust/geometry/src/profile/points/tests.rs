//! Points of known curves, of rubbish, and of what lies between.

use std::f64::consts::FRAC_PI_2;

use proptest::prelude::*;

use super::*;
use crate::profile::{kinds, ProfileDocument};

fn of_circle(count: usize, radius: f64) -> Vec<[f64; 2]> {
    (0..=count)
        .map(|i| FRAC_PI_2 * i as f64 / count as f64)
        .map(|a| [if a == 0.0 { 0.0 } else { radius * a.sin() }, radius * (1.0 - a.cos())])
        .collect()
}

fn fitted(points: &[[f64; 2]], tolerance: f64) -> Fit {
    fit(points, tolerance, &Builder::default()).unwrap()
}

fn refusal(points: &[[f64; 2]], tolerance: f64) -> String {
    fit(points, tolerance, &Builder::default()).unwrap_err().to_string()
}

#[test]
fn points_of_a_circle_give_the_circle() {
    let fit = fitted(&of_circle(12, 5.0), 1e-6);
    assert!(fit.deviation < 1e-12, "{}", fit.deviation);
    for slope in [0.0, 0.2, 0.7, 1.2, 1.5] {
        let (r, z) = fit.profile.point_at(slope);
        assert!((r - 5.0 * slope.sin()).abs() < 1e-9, "{slope}: {r}");
        assert!((z - 5.0 * (1.0 - slope.cos())).abs() < 1e-9, "{slope}: {z}");
        assert!((fit.profile.curvature_radius_at(slope) - 5.0).abs() < 1e-9);
    }
}

#[test]
fn flats_and_lines_are_kept() {
    let mut points = vec![[0.0, 0.0], [1.0, 0.0]];
    points
        .extend((1..=9).map(|i| f64::from(i).to_radians() * 5.0).map(|a| [1.0 + 4.0 * a.sin(), 4.0 * (1.0 - a.cos())]));
    let (r, z) = (points[10][0], points[10][1]);
    points.extend((1..=3).map(|i| [r + f64::from(i), z + f64::from(i)]));
    let profile = fitted(&points, 1e-6).profile;
    let straights: Vec<_> = profile.straights().collect();
    assert_eq!(straights.len(), 2);
    assert!(straights[0].slope.abs() < 1e-12 && (straights[0].outer.0 - 1.0).abs() < 1e-12);
    assert!((straights[1].slope - 45.0_f64.to_radians()).abs() < 1e-9);
    assert!((straights[1].outer.0 - straights[1].inner.0 - 3.0).abs() < 1e-9);
}

/// An arc and its tangent as CAM data has them: to the last bit the line's points are not on a line.
const ARC_AND_LINE: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [1.0003847946556363, 0.354128369374208],
    [1.555172856027735, 1.2587757295830484],
    [1.9530697410562663, 3.1266060291556235],
    [2.3509666260847975, 4.994436328728199],
    [2.7488635111133286, 6.862266628300773],
];

#[test]
fn a_line_that_rounding_has_bent_is_a_line() {
    for tolerance in [0.0, 1e-3] {
        let fit = fitted(&ARC_AND_LINE, tolerance);
        assert_eq!(fit.profile.base(), (2.7488635111133286, 6.862266628300773));
        assert!(fit.deviation < 1e-9, "{}", fit.deviation);
        check(&ARC_AND_LINE, tolerance, &fit);
    }
}

#[test]
fn lists_that_went_wrong_once() {
    let nearly_collinear = [[0.0, 0.0], [1.0, 0.1], [2.0, 0.6], [3.0, 1.1 + 1e-10], [4.0, 2.1]];
    let kinked = [[0.0, 0.0], [1.9, 0.3], [3.1, 0.9], [3.5, 1.1], [3.6, 1.2], [4.7, 2.3], [5.1, 2.8], [5.4, 3.4]];
    for (points, tolerance) in [(&nearly_collinear[..], 1e-3), (&kinked[..], 0.1)] {
        check(points, tolerance, &fitted(points, tolerance));
    }
}

#[test]
fn the_deviation_is_that_of_the_profile_on_both_sides() {
    let mut points = of_circle(19, 6.0);
    points[10][1] += 0.2;
    let fit = fitted(&points, 0.2);
    check(&points, 0.2, &fit);
    // the ball itself is 0.1336 mm away
    assert!((0.12..0.15).contains(&fit.deviation), "{}", fit.deviation);
    assert!(refusal(&points, 0.1).contains("points[10]"));
}

#[test]
fn a_hollow_is_passed_by_within_the_tolerance_or_refused_with_its_place() {
    let mut points = of_circle(40, 5.0);
    points[20][1] += 0.01;
    let fit = fitted(&points, 0.01);
    assert!(fit.deviation > 1e-4 && fit.deviation < 0.01, "{}", fit.deviation);
    let error = refusal(&points, 1e-6);
    assert!(error.contains("points[20]") && error.contains("hollow"), "{error}");
}

#[test]
fn a_wiggle_of_a_nanometre_is_repaired_or_refused() {
    let mut points: Vec<_> = (0..=100).map(|i| [0.05 * f64::from(i), (0.05 * f64::from(i)).powi(2) / 16.0]).collect();
    // a line to see it on: on the parabola a point may be off by its sagitta and still be convex
    points.extend((1..=20).map(|i| [5.0 + 0.1 * f64::from(i), 25.0 / 16.0 + 0.1 * f64::from(i) * 0.625]));
    points[110][1] += 1e-6;
    let fit = fitted(&points, 1e-5);
    check(&points, 1e-5, &fit);
    assert!(fit.deviation > 5e-7, "{}", fit.deviation);
    let error = refusal(&points, 1e-7);
    assert!(error.contains("points[110]") && error.contains("hollow"), "{error}");
}

#[test]
fn what_is_no_profile_is_refused_with_its_place() {
    let refused = |points: &[[f64; 2]], word: &str| {
        let error = refusal(points, 1e-3);
        assert!(error.contains(word), "{error}");
    };
    refused(&[[0.0, 0.0], [1.0, 0.1]], "2 points");
    refused(&[[0.1, 0.0], [1.0, 0.1], [2.0, 1.0]], "axis");
    refused(&[[0.0, 0.0], [1.0, f64::NAN], [2.0, 1.0]], "points[1]");
    refused(&[[0.0, 0.0], [1.0, 0.1], [0.5, 1.0]], "points[2]");
    refused(&[[0.0, 0.0], [0.0, 0.0], [5.0, 5.0]], "2 points");
    refused(&[[0.0, 0.0], [0.0, 1.0], [0.0, 2.0]], "no radius");
}

#[test]
fn corners_are_refused_with_their_place() {
    let line = |from: [f64; 2], degrees: f64, count: u8| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        (1..=count).map(move |i| [from[0] + f64::from(i) * cos, from[1] + f64::from(i) * sin])
    };
    let refused = |points: &[[f64; 2]], number: usize, degrees: &str| {
        let error = refusal(points, 1e-3);
        assert!(error.contains(&format!("points[{number}]")) && error.contains(degrees), "{error}");
    };
    refused(&[[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]], 1, "a corner of 90.000 degrees");
    let mut points = vec![[0.0, 0.0]];
    points.extend(line([0.0, 0.0], 20.0, 4));
    points.extend(line(points[4], 65.0, 4));
    refused(&points, 4, "a corner of 45.000 degrees");
    points = vec![[0.0, 0.0], [4.0, 0.0]];
    points.extend(line([4.0, 0.0], 45.0, 4));
    refused(&points, 1, "a corner of 45.000 degrees");
    // where the points allow it, it is rounded: 4 mm of flank with a point at its middle
    points = vec![[0.0, 0.0]];
    points.extend(line([0.0, 0.0], 20.0, 2));
    points.extend(line(points[2], 25.0, 2));
    check(&points, 1e-3, &fitted(&points, 1e-3));
    refused(
        &[&points[..3], &line(points[2], 50.0, 2).collect::<Vec<_>>()[..]].concat(),
        2,
        "a corner of 30.000 degrees",
    );
}

#[test]
fn a_line_from_the_tip_is_a_pointed_tool() {
    let fit = fitted(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]], 1e-3);
    assert_eq!(fit.profile.straights().count(), 1);
    assert!((fit.profile.max_slope() - 45.0_f64.to_radians()).abs() < 1e-15);
    assert!(fit.notes[0].contains("pointed") && fit.notes[0].contains("45.000"), "{:?}", fit.notes);
}

#[test]
fn falls_and_repetitions_within_the_tolerance_are_no_matter() {
    let mut points: Vec<_> = (0..10).map(|i| [0.3 * f64::from(i), if i % 2 == 0 { 0.0 } else { 1e-6 }]).collect();
    points
        .extend((0..=20).map(|i| FRAC_PI_2 * f64::from(i) / 20.0).map(|a| [2.7 + 2.0 * a.sin(), 2.0 - 2.0 * a.cos()]));
    points.push(points[30]);
    points.extend((1..10).map(|i| [4.7 - 1e-6 * f64::from(i % 3), 2.0 + 0.2 * f64::from(i)]));
    check(&points, 1e-5, &fitted(&points, 1e-5));
    assert!(refusal(&points, 1e-7).contains("points[2]"));
}

#[test]
fn the_radius_of_curvature_follows_that_of_a_smooth_curve() {
    let worst = |count: usize, point: &dyn Fn(f64) -> [f64; 2], radius: &dyn Fn(f64) -> f64| {
        let points: Vec<_> = (0..=count).map(|i| point(i as f64 / count as f64)).collect();
        let profile = fitted(&points, 0.0).profile;
        let off = |slope: f64| (profile.curvature_radius_at(slope) / radius(slope) - 1.0).abs();
        (1..400).map(|i| off(profile.max_slope() * f64::from(i) / 400.0)).fold(0.0, f64::max)
    };
    // z = r^2 / 16 to r = 6
    let parabola = |count| worst(count, &|t| [6.0 * t, 2.25 * t * t], &|slope| 8.0 / slope.cos().powi(3));
    let ellipse = |count| {
        let point =
            |t: f64| [if t == 0.0 { 0.0 } else { 6.0 * (FRAC_PI_2 * t).sin() }, 4.0 - 4.0 * (FRAC_PI_2 * t).cos()];
        let radius = |slope: f64| 576.0 / (6.0 * slope.sin()).hypot(4.0 * slope.cos()).powi(3);
        worst(count, &point, &radius)
    };
    assert!(parabola(12) < 0.01 && parabola(25) < 0.0025, "{} {}", parabola(12), parabola(25));
    assert!(ellipse(12) < 0.03 && ellipse(25) < 0.008, "{} {}", ellipse(12), ellipse(25));
}

#[test]
fn a_hundred_thousand_points_take_no_time() {
    let points = of_circle(99_999, 6.0);
    let begin = std::time::Instant::now();
    let fit = fitted(&points, 1e-3);
    // 15 ms measured; a debug build on a busy machine takes its time
    assert!(begin.elapsed().as_secs_f64() < 2.0, "{:?}", begin.elapsed());
    assert!(fit.deviation < 1e-7, "{}", fit.deviation);
}

/// Everything that an accepted list is promised, by other means than the fit's own: dense points of the finished curve.
fn check(points: &[[f64; 2]], tolerance: f64, fit: &Fit) {
    if let Err(error) = checked(points, tolerance, fit) {
        panic!("{error}\n{points:?} {tolerance}");
    }
}

fn checked(points: &[[f64; 2]], tolerance: f64, fit: &Fit) -> Result<(), TestCaseError> {
    let profile = &fit.profile;
    let lowest = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let most = points[1..].iter().fold([0.0_f64, 0.0], |m, p| [m[0].max(p[0]), m[1].max(p[1] - lowest)]);
    let size = most[0].max(most[1]);
    // it ends where it must, exactly
    prop_assert_eq!(profile.base(), (most[0], most[1]), "{:?}", profile);
    prop_assert_eq!(profile.point_at(FRAC_PI_2), profile.base());
    // slopes in order, and no kink but at the tip
    let breaks: Vec<f64> = profile.breaks().collect();
    prop_assert!(breaks.iter().all(|s| (0.0..=FRAC_PI_2).contains(s)) && breaks.windows(2).all(|p| p[0] <= p[1]));
    let mut curve = vec![(0.0, 0.0)];
    let mut sagitta = 0.0_f64;
    for pair in breaks.windows(2).filter(|pair| pair[0] < pair[1]) {
        let at_tip = pair[0] == 0.0;
        let (from, to) = (profile.point_at(pair[0]), profile.inner_point_at(pair[1]));
        prop_assert!(at_tip || from != to, "a kink at {pair:?}");
        for i in 0..=SAMPLES {
            let slope = pair[0] + (pair[1] - pair[0]) * f64::from(i) / f64::from(SAMPLES);
            let on = match i {
                0 => profile.point_at(pair[0]),
                SAMPLES => profile.inner_point_at(pair[1]),
                _ => profile.point_at(slope.clamp(pair[0], pair[1])),
            };
            let last = curve[curve.len() - 1];
            sagitta =
                sagitta.max((on.0 - last.0).hypot(on.1 - last.1) * (pair[1] - pair[0]) / f64::from(SAMPLES) / 8.0);
            curve.push(on);
        }
    }
    curve.push(profile.base());
    // the chain of its points rises, and is convex: the direction of each step is between the slopes around it
    let mut direction = 0.0;
    for step in curve.windows(2) {
        let (r, z) = (step[1].0 - step[0].0, step[1].1 - step[0].1);
        prop_assert!(r >= -1e-12 * size && z >= -1e-12 * size, "{step:?}");
        let length = r.hypot(z);
        if length > 1e-6 * size {
            let next = z.atan2(r);
            prop_assert!(next >= direction - 2e-12 * size / length, "{next} {direction} {step:?}");
            direction = next;
        }
    }
    // the deviation, by the distance from all of them
    let mut worst = 0.0_f64;
    for [r, z] in points {
        let nearest =
            curve.windows(2).map(|step| from_line(step[0], step[1], (*r, z - lowest))).fold(f64::INFINITY, f64::min);
        worst = worst.max(nearest);
    }
    prop_assert!((worst - fit.deviation).abs() <= 1.1 * sagitta + 1e-12 * size, "{worst} {} {sagitta}", fit.deviation);
    prop_assert!(fit.deviation <= tolerance.max(1e-10 * size), "{}", fit.deviation);
    // heights to the very end
    let height = profile.height_at_radius(profile.base().0);
    prop_assert!(height.is_finite() && height <= profile.base().1 + 1e-12 * size);
    Ok(())
}

/// Steps of each piece that are checked.
const SAMPLES: i32 = 48;

fn from_line(a: (f64, f64), b: (f64, f64), p: (f64, f64)) -> f64 {
    let (r, z) = (b.0 - a.0, b.1 - a.1);
    let square = r * r + z * z;
    let share = if square > 0.0 { (((p.0 - a.0) * r + (p.1 - a.1) * z) / square).clamp(0.0, 1.0) } else { 0.0 };
    (p.0 - a.0 - share * r).hypot(p.1 - a.1 - share * z)
}

/// A part of a smooth convex curve.
#[derive(Clone, Debug)]
enum Part {
    Line {
        length: f64,
    },
    Arc {
        radius: f64,
        turn: f64,
    },
    /// From no curvature to most, or back.
    Clothoid {
        length: f64,
        turn: f64,
        back: bool,
    },
}

impl Part {
    fn turn(&self) -> f64 {
        match self {
            Self::Line { .. } => 0.0,
            Self::Arc { turn, .. } | Self::Clothoid { turn, .. } => *turn,
        }
    }

    fn length(&self) -> f64 {
        match self {
            Self::Line { length } | Self::Clothoid { length, .. } => *length,
            Self::Arc { radius, turn } => radius * turn,
        }
    }

    fn slope_at(&self, share: f64) -> f64 {
        match self {
            Self::Clothoid { turn, back: true, .. } => turn * (1.0 - (1.0 - share) * (1.0 - share)),
            Self::Clothoid { turn, .. } => turn * share * share,
            _ => self.turn() * share,
        }
    }

    /// Points at even steps after its start, by Simpson's rule over parts of each.
    fn sampled(&self, start: [f64; 2], slope: f64, count: usize) -> Vec<[f64; 2]> {
        let (mut at, mut out) = (start, Vec::new());
        let parts = 64;
        let step = 1.0 / (count * parts) as f64;
        for i in 0..count * parts {
            for (share, weight) in [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)] {
                let (sin, cos) = (slope + self.slope_at((i as f64 + share) * step)).sin_cos();
                at[0] += weight / 6.0 * step * self.length() * cos;
                at[1] += weight / 6.0 * step * self.length() * sin;
            }
            if (i + 1) % parts == 0 {
                out.push(at);
            }
        }
        out
    }
}

/// Points of a curve of lines, arcs and clothoids: nowhere a corner.
fn any_smooth_points() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let part = (0..4_u8, 0.1..1.0_f64, 0.3..6.0_f64, any::<bool>(), 1..12_usize);
    (prop::collection::vec(part, 1..6), 0.2..1.0_f64).prop_map(|(parts, last)| {
        let total: f64 = parts.iter().map(|part| part.1).sum();
        let (mut points, mut slope) = (vec![[0.0, 0.0]], 0.0);
        for (index, (kind, share, size, back, count)) in parts.into_iter().enumerate() {
            let turn = share / total * last * FRAC_PI_2;
            let part = match kind {
                0 => Part::Line { length: size },
                1 => Part::Clothoid { length: size, turn, back },
                _ => Part::Arc { radius: size, turn },
            };
            // two points alone do not determine a line
            let count = if kind == 0 && index > 0 { count + 1 } else { count + 3 };
            let more = part.sampled(points[points.len() - 1], slope, count);
            slope += part.turn();
            points.extend(more);
        }
        points
    })
}

fn rounded(points: &[[f64; 2]], digits: i32) -> Vec<[f64; 2]> {
    let scale = 10_f64.powi(digits);
    points.iter().map(|p| p.map(|x| (x * scale).round() / scale)).collect()
}

/// Lists that look like points of something: coordinates of few digits, in order or nearly.
fn any_rubbish() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let coordinate = prop_oneof![
        8 => (0..1000_i32).prop_map(|x| f64::from(x) / 100.0),
        4 => (0..12_i32).prop_map(f64::from),
        2 => 0.0..10.0_f64,
        1 => (-12..5_i32).prop_map(|e| 10_f64.powi(e)),
        1 => (0..9_i32).prop_map(|e| 5.0 + 10_f64.powi(-e - 5)),
    ];
    let sorted = prop::collection::vec((coordinate.clone(), coordinate), 2..12).prop_map(|list| {
        let (mut r, mut z): (Vec<f64>, Vec<f64>) = list.into_iter().unzip();
        r.sort_by(f64::total_cmp);
        z.sort_by(f64::total_cmp);
        r[0] = 0.0;
        r.into_iter().zip(z).map(|(r, z)| [r, z]).collect::<Vec<_>>()
    });
    let of_steps = prop::collection::vec((0..4_i32, 0..4_i32, -9..1_i32), 2..20).prop_map(|steps| {
        let mut at = [0.0, 0.0];
        let mut points = vec![at];
        let mut rise = 0;
        for (across, more, scale) in steps {
            rise += more;
            let scale = if scale > -5 { 1.0 } else { 10_f64.powi(scale) };
            at = [at[0] + f64::from(across) * scale, at[1] + f64::from(across * rise + i32::from(across == 0)) * scale];
            points.push(at);
        }
        points
    });
    prop_oneof![sorted, of_steps]
}

/// Lists of numbers, all of them.
fn any_numbers() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let number = prop_oneof![any::<f64>(), 0.0..10.0_f64, Just(0.0), Just(f64::NAN), Just(1e4), Just(5e-324)];
    prop::collection::vec([number.clone(), number], 0..10)
}

fn any_tolerance() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1e-3), (-12..4_i32).prop_map(|e| 10_f64.powi(e))]
}

proptest! {
    #[test]
    fn points_of_a_smooth_curve_are_followed(points in any_smooth_points(), tolerance in any_tolerance()) {
        let tolerance = tolerance.max(1e-9);
        match fit(&points, tolerance, &Builder::default()) {
            Ok(fit) => checked(&points, tolerance, &fit)?,
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn rounded_points_of_a_smooth_curve_are_followed(points in any_smooth_points(), digits in 1..=9_i32, share in 2.0..20.0_f64) {
        // an arc of a few roundings has no shape left: the smallest has a radius of 300
        let scale = 10_f64.powi((3 - digits).max(0));
        let points: Vec<_> = points.iter().map(|p| p.map(|x| scale * x)).collect();
        let (points, tolerance) = (rounded(&points, digits), share * 10_f64.powi(-digits));
        match fit(&points, tolerance, &Builder::default()) {
            Ok(fit) => checked(&points, tolerance, &fit)?,
            Err(error) => prop_assert!(error.to_string().contains(" points: 3 to"), "{error}"),
        }
    }

    #[test]
    fn noisy_points_of_a_smooth_curve_are_followed(
        points in any_smooth_points(),
        noise in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 100),
        size in -9..=-3_i32,
        share in 4.0..20.0_f64,
    ) {
        let size = 10_f64.powi(size);
        let points: Vec<_> = points.iter().zip(noise.iter().cycle()).enumerate().map(|(i, ([r, z], noise))| {
            [if i == 0 { 0.0 } else { r + size * noise.0 }, z + size * noise.1]
        }).collect();
        match fit(&points, share * size, &Builder::default()) {
            Ok(fit) => checked(&points, share * size, &fit)?,
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn what_is_accepted_of_rubbish_keeps_every_promise(points in any_rubbish(), tolerance in any_tolerance()) {
        match fit(&points, tolerance, &Builder::default()) {
            Ok(fit) => checked(&points, tolerance, &fit)?,
            Err(error) => prop_assert!(!error.to_string().contains("NaN") && !error.to_string().contains("please report"), "{error}"),
        }
    }

    #[test]
    fn any_numbers_are_judged(points in any_numbers(), tolerance in any_tolerance()) {
        if let Ok(fit) = fit(&points, tolerance, &Builder::default()) {
            checked(&points, tolerance, &fit)?;
        }
    }

    #[test]
    fn lists_survive_json(points in any_rubbish(), fit_tolerance in any_tolerance(), tip_flat in 0.0..3.0_f64) {
        let document = ProfileDocument::from(kinds::Points { points, fit_tolerance, tip_flat });
        let again: ProfileDocument = serde_json::from_str(&serde_json::to_string(&document).unwrap()).unwrap();
        prop_assert_eq!(&again, &document);
        match (document.build(), again.build()) {
            (Ok(first), Ok(second)) => prop_assert_eq!(first, second),
            (Err(first), Err(second)) => prop_assert_eq!(first, second),
            _ => prop_assert!(false),
        }
    }
}

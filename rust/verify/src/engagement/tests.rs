//! Exact answers: the tables of the published formulas, and closed forms.

use std::f64::consts::PI;

use proptest::prelude::*;
use styluscam_motion::Watch;

use super::CHIP;
use super::{engagement, EngagementError, Ground, PlaneRun, PlaneRunKind, RunEngagement};

const R: f64 = 5.0;

fn rectangle(x: f64, y: f64) -> Vec<[f64; 3]> {
    vec![[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]]
}

fn run(points: Vec<[f64; 3]>, kind: PlaneRunKind) -> PlaneRun {
    PlaneRun { points, kind }
}

fn measured(runs: &[PlaneRun], radius: f64, outline: &[Vec<[f64; 3]>]) -> Vec<RunEngagement> {
    engagement(runs, &Ground { radius, stock: outline, pocket: outline, cleared: &[], chip: CHIP }, &Watch::default())
        .unwrap()
}

/// Largest angle of a run, deg.
fn largest(run: &RunEngagement) -> f64 {
    run.measures.iter().map(|m| m.angle.to_degrees()).fold(0.0, f64::max)
}

/// A pass from the right, round a corner of a right angle of which the sides are the lines x = a and y = a.
fn corner(a: f64, radius: f64) -> Vec<[f64; 3]> {
    let bulge = (PI / 8.0).tan();
    let mut points = vec![[a, -60.0, 0.0], [a, a - radius, bulge], [a - radius, a, 0.0], [-60.0, a, 0.0]];
    if radius == 0.0 {
        points.remove(2);
        points[1][2] = 0.0;
    }
    points
}

/// Largest angle of a pass `s` outside another around a corner, the inner one rounded by `inner`, the outer one by `outer`.
fn around_corner(radius: f64, s: f64, inner: f64, outer: f64) -> f64 {
    let runs = [
        run(corner(0.0, inner), PlaneRunKind::Cut),
        run(vec![[-60.0, 0.0, 0.0], [s, -60.0, 0.0]], PlaneRunKind::Rapid),
        run(corner(s, outer), PlaneRunKind::Cut),
    ];
    let found = measured(&runs, radius, &[rectangle(200.0, 200.0)]);
    let slot = found[0].measures.iter().skip(1).map(|m| m.angle.to_degrees()).fold(0.0, f64::max);
    assert!((180.0 - 1e-6..270.1).contains(&slot), "the first pass is a slot: {slot}");
    // at both ends the caps of the two passes differ
    found[2]
        .measures
        .iter()
        .filter(|m| m.at.iter().all(|x| *x > -50.0))
        .map(|m| m.angle.to_degrees())
        .fold(0.0, f64::max)
}

#[test]
fn the_table_of_smoothing_radii_gives_the_angle_that_it_is_for() {
    // base angle, growth, stepover and profile smoothing radius for r = 5 (SOURCES S2, row 2.3)
    let table = [
        (30.0, [(5.0, 12.6639), (10.0, 5.5813), (20.0, 2.1298), (30.0, 1.0377)]),
        (45.0, [(5.0, 17.9699), (10.0, 7.8967), (20.0, 2.9294), (30.0, 1.3239)]),
        (60.0, [(5.0, 21.7305), (10.0, 9.3686), (20.0, 3.2453), (30.0, 1.2500)]),
        (75.0, [(5.0, 23.6806), (10.0, 9.8819), (20.0, 3.0360), (30.0, 0.8002)]),
        (90.0, [(5.0, 23.6843), (10.0, 9.3969), (20.0, 2.3095), (30.0, 0.0)]),
    ];
    for (base, rows) in table {
        let s = R * (1.0 - f64::to_radians(base).cos());
        for (growth, smoothing) in rows {
            let angle = around_corner(R, s, smoothing, smoothing + s);
            assert!((angle - base - growth).abs() < 0.1, "a {base} b {} simulated {angle}", base + growth);
        }
    }
}

#[test]
fn a_sharp_pass_inside_a_sharp_pass_engages_as_the_closed_form_says() {
    let angle = around_corner(3.0, 2.4, 0.0, 0.0);
    assert!((angle - 168.463).abs() < 0.025, "{angle}");
    // what is left of the chip after the 1 um that does not count
    let exact = 90.0 + f64::acos(1.0 - (2.4 - CHIP) / 3.0).to_degrees();
    assert!((angle - exact).abs() < 1e-6, "{angle} {exact}");
}

#[test]
fn a_trochoid_engages_as_its_closed_form_says() {
    // circles of rho, advance p, r = 5: the angle where the new circle leaves the old one behind the farthest
    for (rho, p, expected) in
        [(2.5, 1.0, 63.90), (5.0, 1.0, 51.68), (10.0, 1.0, 44.77), (5.0, 2.0, 73.74), (2.5, 2.0, 92.29)]
    {
        let circle = |x: f64| vec![[x - rho, 0.0, 1.0], [x + rho, 0.0, 1.0], [x - rho, 0.0, 0.0]];
        let runs = [run(circle(0.0), PlaneRunKind::Entry), run(circle(p), PlaneRunKind::Cut)];
        let found = measured(&runs, R, &[rectangle(100.0, 100.0)]);
        let largest = found[1].measures.iter().skip(1).map(|m| m.angle.to_degrees()).fold(0.0, f64::max);
        assert!((largest - expected).abs() < 0.05, "rho {rho} p {p}: {largest}, expected {expected}");
    }
}

#[test]
fn a_wall_is_no_material_and_what_is_cut_twice_is_none() {
    let bar = [rectangle(50.0, 6.0)];
    // along a wall, at half the tool's width: what lies beyond the wall does not count
    let there = run(vec![[-45.0, 1.0, 0.0], [45.0, 1.0, 0.0]], PlaneRunKind::Cut);
    let back = run(vec![[45.0, 1.0, 0.0], [-45.0, 1.0, 0.0]], PlaneRunKind::Link);
    let found = measured(&[there.clone(), back, there], R, &bar);
    let of =
        |run: &RunEngagement| run.measures.iter().filter(|m| m.at[0].abs() < 40.0).map(|m| m.angle).fold(0.0, f64::max);
    assert!((of(&found[0]) - PI).abs() < 1e-9);
    assert!((of(&found[1]), of(&found[2])) == (0.0, 0.0));
    assert!(found[0].measures.iter().all(|m| (m.clearance - 5.0).abs() < 1e-12));
}

#[test]
fn a_link_back_to_where_a_cut_ended_a_radius_before_cuts_nothing() {
    for i in 0..360 {
        let turned = |[x, y]: [f64; 2]| {
            let (sin, cos) = (f64::from(i) * 0.0175).sin_cos();
            [x * cos - y * sin + 0.53, x * sin + y * cos + 11.699, 0.0]
        };
        let end = turned([0.0, 0.0]);
        let cut = run(vec![turned([-20.0, 0.0]), end], PlaneRunKind::Cut);
        let link = run([[0.0, 0.0], [-1.0, 0.0], [0.0, 0.0]].map(turned).to_vec(), PlaneRunKind::Link);
        let found = measured(&[cut, link], R, &[rectangle(100.0, 100.0)]);
        assert!(largest(&found[1]) < 1e-3, "{i}: {}", largest(&found[1]));
    }
}

#[test]
fn coming_down_into_material_engages_all_around_and_into_air_nothing() {
    let ring = [rectangle(50.0, 50.0), rectangle(10.0, 10.0)];
    let down = |x: f64| run(vec![[x, 0.0, 0.0], [x + 0.5, 0.0, 0.0]], PlaneRunKind::Cut);
    let found = measured(&[down(30.0), down(0.0)], R, &ring);
    assert!((found[0].measures[0].angle - 2.0 * PI).abs() < 1e-9);
    assert!(largest(&found[1]) <= 0.0);
}

#[test]
fn short_chords_engage_as_the_arc_that_they_follow() {
    let ring = |count: usize, radius: f64| -> Vec<[f64; 3]> {
        let at = |i: usize| (i as f64 / count as f64) * 2.0 * PI;
        (0..=count).map(|i| [radius * at(i).cos(), radius * at(i).sin(), 0.0]).collect()
    };
    let outline = [rectangle(60.0, 60.0)];
    let chords = [run(ring(6000, 10.0), PlaneRunKind::Entry), run(ring(7000, 12.0), PlaneRunKind::Cut)];
    let arc = |radius: f64| vec![[radius, 0.0, 1.0], [-radius, 0.0, 1.0], [radius, 0.0, 0.0]];
    let arcs = [run(arc(10.0), PlaneRunKind::Entry), run(arc(12.0), PlaneRunKind::Cut)];
    let of = |runs: &[PlaneRun]| {
        let measures = measured(runs, R, &outline)[1].measures.clone();
        measures.iter().skip(200).map(|m| m.angle).fold(0.0, f64::max)
    };
    // law of cosines between the concentric rims
    let exact = PI - ((12.0f64.powi(2) + 25.0 - 15.0f64.powi(2)) / (2.0 * 12.0 * 5.0)).acos();
    assert!((of(&chords) - of(&arcs)).abs() < 2e-3, "{} {}", of(&chords), of(&arcs));
    assert!((of(&arcs) - exact).abs() < 1e-3, "{} {exact}", of(&arcs));
}

#[test]
fn what_is_no_path_is_refused_by_name() {
    let outline = vec![rectangle(10.0, 10.0)];
    let ground = |radius| Ground { radius, stock: &outline, pocket: &outline, cleared: &[], chip: CHIP };
    let watch = Watch::default();
    let cut = |x| [run(vec![[0.0, 0.0, 0.0], [x, 0.0, 0.0]], PlaneRunKind::Cut)];
    let code = |runs: &[PlaneRun], radius| engagement(runs, &ground(radius), &watch).unwrap_err().key().to_owned();
    assert_eq!(code(&cut(f64::NAN), 1.0), "runs[0][1]");
    assert_eq!(code(&cut(1.0), 0.0), "tool_radius");
    let line = vec![rectangle(1.0, 1.0), vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]];
    let found = engagement(
        &cut(1.0),
        &Ground { radius: 1.0, stock: &outline, pocket: &line, cleared: &[], chip: CHIP },
        &watch,
    );
    assert_eq!(found, Err(EngagementError::Outline { key: "boundary[1]".to_owned(), count: 2 }));
    watch.cancel();
    assert_eq!(engagement(&cut(1.0), &ground(1.0), &watch), Err(EngagementError::Cancelled));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The tool's rim at 1/10 deg, each direction by the distance to every piece before: the slow way to the same angle.
    #[test]
    fn the_angle_is_that_of_brute_force(points in prop::collection::vec((-12.0..12.0f64, -12.0..12.0f64, -1.2..1.2f64), 3..7)) {
        let outline = [rectangle(15.0, 15.0), vec![[3.0, 0.0, 1.0], [-3.0, 0.0, 1.0]]];
        let path: Vec<[f64; 3]> = points.iter().map(|(x, y, bulge)| [*x, *y, *bulge]).collect();
        let found = measured(&[run(path, PlaneRunKind::Cut)], 2.0, &outline);
        let samples: Vec<[f64; 2]> = found[0].measures.iter().map(|m| m.at).collect();
        for (i, m) in found[0].measures.iter().enumerate().skip(60).step_by(97) {
            let count = 720;
            let Some(next) = samples.get(i + 1) else { continue };
            let heading = [m.at[0] - samples[i - 1][0], m.at[1] - samples[i - 1][1]];
            let onward = [next[0] - m.at[0], next[1] - m.at[1]];
            let turned = (heading[0] * onward[1] - heading[1] * onward[0]).atan2(heading[0] * onward[0] + heading[1] * onward[1]);
            if turned.abs() > 0.05 || heading[0].hypot(heading[1]).min(onward[0].hypot(onward[1])) < 1e-6 {
                continue; // a corner of the path, measured twice: the samples do not show the heading
            }
            let engaged = (0..count).filter(|k| {
                let angle = 2.0 * PI * f64::from(*k) / f64::from(count);
                let p = [m.at[0] + 2.0 * angle.cos(), m.at[1] + 2.0 * angle.sin()];
                let inside = p[0].abs() < 15.0 && p[1].abs() < 15.0 && p[0].hypot(p[1]) > 3.0;
                let ahead = heading[0] * angle.cos() + heading[1] * angle.sin() > 0.0;
                // 0.04 mm apart, the discs leave ridges of 0.1 um between them
                inside && ahead && samples[..i].iter().all(|c| (c[0] - p[0]).hypot(c[1] - p[1]) > 2.0)
            }).count();
            let brute = engaged as f64 * 2.0 * PI / f64::from(count);
            prop_assert!((brute - m.angle).abs() < 0.06, "{} {} at {:?}", brute, m.angle, m.at);
        }
    }
}

#[test]
fn a_pillar_inside_the_rim_is_met_by_a_tool_that_goes_straight_down() {
    // a ring of radius 6 leaves a pillar of radius 1 about its middle
    let ring = vec![[6.0, 0.0, 1.0], [-6.0, 0.0, 1.0], [6.0, 0.0, 0.0]];
    let down = |x: f64| run(vec![[x, 0.0, 0.0]], PlaneRunKind::Probed);
    let found = measured(&[run(ring, PlaneRunKind::Swept), down(0.0), down(6.0)], R, &[rectangle(20.0, 20.0)]);
    // the rim itself is free, the circle of an eighth of its radius is in the pillar
    assert!(found[1].measures[0].angle < 1e-9 && (largest(&found[1]) - 360.0).abs() < 1e-9);
    assert!(largest(&found[2]) < 1e-9);
}

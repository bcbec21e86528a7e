//! Arcs: read as controllers read them, posted so that they take them, and the same path after both.

use std::f64::consts::{PI, TAU};

use crate::support::{change, feed, grbl, linuxcnc, rapid, stylus};
use proptest::prelude::*;
use styluscam_motion::{Arc, ArcPath, Move, MoveKind, Plane, Program};
use styluscam_post::machine::{LengthUnit, RadiusError};
use styluscam_post::{post, read, Machine, ReadFault};

fn reads(block: &str, machine: &Machine) -> Result<Move, ReadFault> {
    let text = format!("G21 G90 G17\nG0 X10 Y0 Z0\nF100\n{block}\nM2\n");
    read(&text, machine, &[]).map(|r| *r.program.moves.last().unwrap()).map_err(|e| {
        assert!(!e.hint().is_empty() && !e.code().is_empty());
        e.fault
    })
}

fn path(block: &str) -> ArcPath {
    reads(block, &linuxcnc()).unwrap().path([10.0, 0.0, 0.0]).unwrap()
}

#[test]
fn centres_radii_planes_and_turns() {
    let quarter =
        [path("G3 X0 Y10 I-10"), path("G3 X0 Y10 R10"), path("G90.1 G3 X0 Y10 I0 J0"), path("G91 G3 X-10 Y10 I-10 J0")];
    for path in quarter {
        assert!((path.sweep() - PI / 2.0).abs() < 1e-12 && (path.radius() - 10.0).abs() < 1e-12);
    }
    assert!((path("G2 X0 Y10 R-10").sweep() + PI * 1.5).abs() < 1e-12);
    assert!((path("G2 X0 Y10 I-10").sweep() + PI * 1.5).abs() < 1e-12);
    assert!((path("G2 X10 Y0 I-10").sweep() + TAU).abs() < 1e-12);
    assert!((path("G2 I-10").sweep() + TAU).abs() < 1e-12);
    assert!((path("G2 I-10 P3 Z-3").sweep() + 3.0 * TAU).abs() < 1e-12);
    // G18 is seen from +Y: from X to Z is clockwise
    assert!((path("G18 G2 X0 Z10 I-10").sweep() + PI * 0.5).abs() < 1e-12);
    assert!((path("G18 G3 X0 Z10 I-10").sweep() - PI * 1.5).abs() < 1e-12);
    assert!(path("G18 G2 X0 Z-10 I-10").at(1.0).iter().zip([0.0, 0.0, -10.0]).all(|(a, b)| (a - b).abs() < 1e-12));
}

#[test]
fn what_is_wrong_with_an_arc_is_said() {
    let fault = |block: &str| reads(block, &linuxcnc()).unwrap_err();
    assert!(matches!(fault("G2 X0 Y10"), ReadFault::MissingWord { .. }));
    assert!(matches!(fault("G2 X0 Y10 I-9"), ReadFault::ArcEnds { .. }));
    assert_eq!(fault("G2 X0 Y10 R3"), ReadFault::ArcOfShortRadius);
    assert_eq!(fault("G2 X10 Y0 R3"), ReadFault::ArcForm);
    assert_eq!(fault("G2 X0 Y10 I-10 R10"), ReadFault::ArcForm);
    assert_eq!(fault("G2 X0 Y10 I-10 K1"), ReadFault::ArcPlane);
    assert_eq!(fault("G18 G2 X0 Z10 J-10"), ReadFault::ArcPlane);
    assert_eq!(fault("G2 I0 J0"), ReadFault::ArcOfNoRadius);
    assert_eq!(fault("G1 X0 I5"), ReadFault::StrayWord);
    assert_eq!(fault("G2 I-10 P0"), ReadFault::NotNatural);
    assert_eq!(reads("G2 I-10", &grbl()).unwrap_err(), ReadFault::ArcNeedsAxis);
    assert_eq!(reads("G2 X10 I-10 P2", &grbl()).unwrap_err(), ReadFault::StrayWord);
    assert!(matches!(reads("G2 X0 Y10 I-10.02", &grbl()).unwrap_err(), ReadFault::ArcEnds { .. }));
    assert!(reads("G2 X0 Y10 I-10.005", &grbl()).is_ok());
    let straight = Machine { arc: None, ..linuxcnc() };
    assert!(matches!(reads("G2 X0 Y10 I-10", &straight).unwrap_err(), ReadFault::Refused { .. }));
}

fn program(start: [f64; 3], step: Move) -> Program {
    crate::support::program(vec![rapid(start[0], start[1], start[2]), step], vec![change(0, 0)], vec![stylus(1)])
}

/// How far the posted path is from the one that is meant, at positions between the blocks' ends.
fn off(posted: &Program, start: [f64; 3], meant: &ArcPath) -> f64 {
    let mut worst: f64 = 0.0;
    let mut from = start;
    for step in &posted.moves[1..] {
        for i in 0..=20 {
            let share = f64::from(i) / 20.0;
            let straight = |axis: usize| from[axis] + share * (step.end.tip[axis] - from[axis]);
            let position = step.path(from).map_or([straight(0), straight(1), straight(2)], |path| path.at(share));
            worst = worst.max(distance_to(meant, position));
        }
        from = step.end.tip;
    }
    worst
}

/// Distance of a position to a path: coarse, then fine.
fn distance_to(path: &ArcPath, position: [f64; 3]) -> f64 {
    let gap = |share: f64| {
        let at = path.at(share.clamp(0.0, 1.0));
        (0..3).map(|i| (at[i] - position[i]).powi(2)).sum::<f64>().sqrt()
    };
    let near = |i: u32| gap(f64::from(i) / 2000.0);
    let best = (0..=2000).map(near).fold(f64::INFINITY, f64::min);
    // turns of a helix lie side by side: every one that may be the nearest is looked at
    let chosen = (0..=2000).filter(|i| near(*i) <= best + path.length() / 2000.0);
    chosen.map(|i| fine(&gap, f64::from(i) / 2000.0)).fold(f64::INFINITY, f64::min)
}

fn fine(gap: &impl Fn(f64) -> f64, share: f64) -> f64 {
    let (mut low, mut high) = (share - 5e-4, share + 5e-4);
    for _ in 0..60 {
        let (a, b) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
        if gap(a) < gap(b) {
            high = b;
        } else {
            low = a;
        }
    }
    gap(0.5 * (low + high))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn an_arc_comes_back_as_the_same_way(
        centre in [-40.0..40.0_f64, -40.0..40.0_f64, -40.0..40.0_f64], radius in prop_oneof![0.001..0.05_f64, 0.05..80.0_f64],
        angle in 0.0..TAU, sweep in prop_oneof![1e-4..0.01_f64, 0.01..6.25_f64, Just(TAU)], rise in -3.0..3.0_f64,
        plane in prop_oneof![Just(Plane::Xy), Just(Plane::Zx), Just(Plane::Yz)], clockwise: bool, turns in 0..3_u32,
        inch: bool, small: bool,
    ) {
        let [first, second, third] = plane.axes();
        let at = |angle: f64, height: f64| {
            let mut position = centre;
            position[first] += radius * angle.cos();
            position[second] += radius * angle.sin();
            position[third] += height;
            position
        };
        let start = at(angle, 0.0);
        let mut end = at(if clockwise { angle - sweep } else { angle + sweep }, rise);
        if sweep == TAU {
            end[first] = start[first];
            end[second] = start[second];
        }
        let arc = Arc { centre, plane, clockwise, turns };
        let step = feed(end[0], end[1], end[2], 500.0).arc(arc);
        let mut machine = if small { grbl() } else { linuxcnc() };
        if inch {
            machine.units.output = LengthUnit::Inch;
        }
        let text = post(&program(start, step), &machine).unwrap().text;
        let back = read(&text, &machine, &[]).unwrap_or_else(|e| panic!("{e}\n{text}")).program;
        let unit = machine.resolution_mm();
        let worst = off(&back, start, &arc.path(start, end));
        let fed: Vec<&Move> = back.moves.iter().filter(|step| step.kind == MoveKind::Feed).collect();
        let are_arcs = !fed.is_empty() && fed.iter().all(|step| step.arc.is_some());
        prop_assert_eq!(machine.posts_arc([start, end], &arc, 0.0), are_arcs, "{}", text);
        prop_assert!(worst <= 2.5 * unit, "{worst} {}", text.lines().skip(12).collect::<Vec<_>>().join("\n"));
    }
}

#[test]
fn arcs_that_the_machine_would_not_take_become_lines() {
    let quarter = Arc { centre: [0.0; 3], plane: Plane::Xy, clockwise: false, turns: 0 };
    let meant = feed(0.0, 10.0, 0.0, 500.0).arc(quarter);
    let mut machine = linuxcnc();
    let arcs = |machine: &Machine| post(&program([10.0, 0.0, 0.0], meant), machine).unwrap().text.matches("G3").count();
    assert_eq!(arcs(&machine), 1);
    machine.arc = None;
    assert_eq!(arcs(&machine), 0);
    let exact = RadiusError { absolute: 0.0, relative: 0.0, most: 0.0 };
    let odd = meant.to([7.0714, 7.0708, 0.0]);
    let mut strict = linuxcnc();
    strict.arc.as_mut().unwrap().radius_error = exact;
    let text = post(&program([10.0, 0.0, 0.0], odd), &strict).unwrap().text;
    assert!(!text.contains("G3") && text.matches("\nX").count() > 10, "{text}");
}

use std::f64::consts::{FRAC_PI_2, TAU};

use proptest::prelude::*;

use super::*;

const DEVIATION: f64 = 1e-3;
const UNIT: f64 = 1e-3;
/// Ends that are rounded to [`UNIT`] may differ by so much more in their distance from the centre.
const MISMATCH: f64 = 2e-3;

const ALL: [Plane; 3] = [Plane::Xy, Plane::Zx, Plane::Yz];

fn takes([start, end]: [[f64; 3]; 2], arc: &Arc) -> bool {
    let path = arc.path(start, end);
    path.radius() > 5.0 * UNIT && path.mismatch() <= MISMATCH
}

fn arcs() -> Arcs<'static> {
    Arcs { planes: &ALL, unit: UNIT, height: 0.0, takes: &takes, corner: f64::INFINITY }
}

/// A point whose contact is on the left of its direction of travel in plan, and `rise` from the horizontal, rad.
fn point(tip: Vector, along: Vector, rise: f64) -> PathPoint {
    let (sin, cos) = libm::sincos(rise);
    let left = Vector::new(-along.y, along.x, 0.0).try_normalize(0.0).unwrap_or(Vector::x());
    PathPoint { tip, normal: left * cos + Vector::z() * sin, selected: true, triangle: 0 }
}

fn fitted(witnesses: &[PathPoint]) -> Vec<Segment> {
    let segments = arcs().along(witnesses, Neighbours::default(), DEVIATION, 500.0);
    assert_eq!(segments.last().map(|last| last.end), witnesses.get(1..).and_then(<[_]>::last).map(|last| last.tip));
    let mut at = witnesses[0].tip;
    for segment in &segments {
        if let Some(arc) = segment.turning() {
            assert!(takes([at.into(), segment.end.into()], &arc), "{segment:?} from {at:?}");
            let [first, second, _] = arc.plane.axes();
            for axis in [first, second] {
                let count = arc.centre[axis] / UNIT;
                assert!((count - count.round()).abs() < 1e-6, "{segment:?}");
            }
        }
        at = segment.end;
    }
    segments
}

/// Points of the posted path, no farther apart than `step` mm.
fn samples(start: Vector, segments: &[Segment], step: f64) -> Vec<Vector> {
    let mut points = vec![start];
    for segment in segments {
        let from = points[points.len() - 1];
        let path = segment.turning().map(|arc| arc.path(from.into(), segment.end.into()));
        let length = path.map_or((segment.end - from).norm(), |path| path.length());
        let count = (length / step).ceil().max(1.0);
        for i in 1..=count as usize {
            let share = i as f64 / count;
            points.push(path.map_or(from + (segment.end - from) * share, |path| path.at(share).into()));
        }
    }
    points
}

/// How far the first points are from the polyline through the others, at most: along the normal, or a quarter of the distance.
fn farthest_from(exact: &[PathPoint], line: &[Vector]) -> f64 {
    let off = |point: &PathPoint, pair: &[Vector]| {
        let along = pair[1] - pair[0];
        let share = ((point.tip - pair[0]).dot(&along) / along.norm_squared().max(1e-300)).clamp(0.0, 1.0);
        fitting::counted(pair[0] + along * share - point.tip, &point.normal)
    };
    let nearest = |point: &PathPoint| line.windows(2).map(|pair| off(point, pair)).fold(f64::INFINITY, f64::min);
    exact.iter().map(nearest).fold(0.0, f64::max)
}

/// A closed curve in plan that swells and falls: its point and its direction at an angle, rad.
fn flower([radius, swell, phase, fall]: [f64; 4], waves: u8, angle: f64) -> (Vector, Vector) {
    let waves = f64::from(waves);
    let (wave, slope) = libm::sincos(waves * angle + phase);
    let (r, grows) = (radius + swell * wave, swell * waves * slope);
    let (sin, cos) = libm::sincos(angle);
    (Vector::new(r * cos, r * sin, -fall * angle / TAU), Vector::new(grows * cos - r * sin, grows * sin + r * cos, 0.0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_smooth_curve_is_kept_to(
        radius in 2.0..30.0_f64, swell in 0.0..0.3_f64, phase in 0.0..TAU, waves in 1..6_u8,
        fall in prop_oneof![Just(0.0), 0.01..2.0_f64], rise in 0.0..1.5_f64, backwards: bool,
    ) {
        let shape = [radius, swell * radius / f64::from(waves * waves), phase, fall];
        let at = |share: f64| {
            let angle = TAU * if backwards { 1.0 - share } else { share };
            let (tip, along) = flower(shape, waves, angle);
            point(tip, along, rise)
        };
        // chords keep to a proven share: the sagitta is a square over 8 radii, the least of which is some of the radius
        let chord = libm::sqrt(8.0 * 0.3 * radius * fitting::PROVEN * DEVIATION);
        let count = (TAU * radius * 1.5 / chord).ceil() as usize;
        let mut witnesses: Vec<PathPoint> = (0..=count).map(|i| at(i as f64 / count as f64)).collect();
        if fall == 0.0 {
            witnesses[count] = witnesses[0];
        }
        let segments = fitted(&witnesses);
        let exact: Vec<PathPoint> = (0..1000).map(|i| at((f64::from(i) + 0.3) / 1000.0)).collect();
        let posted = samples(witnesses[0].tip, &segments, 0.05);
        // a twentieth of a mm on a radius of 1 mm is 0.0003 mm off at most, and there only
        let worst = farthest_from(&exact, &posted);
        prop_assert!(worst <= 1.05 * DEVIATION, "{worst}");
        prop_assert!(segments.len() <= fitting::thinned(&witnesses, DEVIATION).len());
    }

    #[test]
    fn facets_round_a_circle_become_one_arc(radius in 3.0..20.0_f64, sag in 0.0..0.9_f64, phase in 0.0..1.0_f64) {
        // what facets are off the circle is less than what a witness may be off
        let half = libm::acos(1.0 - sag.max(0.05) * fitting::AT_WITNESSES * DEVIATION / radius);
        let count = (std::f64::consts::PI / half).ceil() as usize;
        let corner = |i: usize| {
            let (tip, along) = flower([radius, 0.0, 0.0, 0.0], 1, TAU * ((i % count) as f64 + phase) / count as f64);
            point(tip, along, 0.0)
        };
        let witnesses: Vec<PathPoint> = (0..=count).map(corner).collect();
        let segments = fitted(&witnesses);
        prop_assert_eq!(segments.len(), 1, "{:?}", &segments[..2.min(segments.len())]);
        let middles: Vec<PathPoint> = witnesses
            .windows(2)
            .map(|pair| PathPoint { tip: (pair[0].tip + pair[1].tip) * 0.5, ..pair[0] })
            .collect();
        let posted = samples(witnesses[0].tip, &segments, 0.05);
        prop_assert!(farthest_from(&middles, &posted).max(farthest_from(&witnesses, &posted)) <= 1.05 * DEVIATION);
    }

    #[test]
    fn points_at_random_are_passed_in_order(steps in prop::collection::vec(([-1.0..1.0_f64, -1.0..1.0_f64], 0..4_u8), 2..40)) {
        let mut tip = Vector::new(3.0, 4.0, 5.0);
        let mut witnesses = vec![point(tip, Vector::x(), 0.2)];
        for ([x, y], kind) in steps {
            // a step, a duplicate, straight on, straight back
            let last = witnesses.windows(2).last().map_or(Vector::x(), |pair| pair[1].tip - pair[0].tip);
            let along = match kind {
                0 => Vector::new(x, y, 0.0),
                1 => Vector::zeros(),
                2 => last,
                _ => -last,
            };
            tip += along;
            witnesses.push(point(tip, along, 0.2));
        }
        let segments = fitted(&witnesses);
        let posted = samples(witnesses[0].tip, &segments, 0.01);
        prop_assert!(farthest_from(&witnesses, &posted) <= DEVIATION);
    }
}

#[test]
fn a_row_over_a_round_hill_is_an_arc_in_its_plane() {
    for (plane, axis) in [(Plane::Zx, 0), (Plane::Yz, 1)] {
        let at = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            let mut normal = Vector::new(0.0, 0.0, sin);
            normal[axis] = cos;
            let tip = Vector::new(7.0, 7.0, 2.0).component_mul(&(Vector::repeat(1.0) - Vector::ith(axis, 1.0)));
            PathPoint { tip: tip + normal * 20.0, normal, selected: true, triangle: 0 }
        };
        let witnesses: Vec<PathPoint> = (0..=150).map(|i| at(FRAC_PI_2 + 0.9 - 1.8 * f64::from(i) / 150.0)).collect();
        let segments = fitted(&witnesses);
        let [only] = &segments[..] else { panic!("{segments:?}") };
        assert!(matches!(only.curve, Curve::Arc { plane: found, .. } if found == plane), "{only:?}");
        let posted = samples(witnesses[0].tip, &segments, 0.05);
        assert!(farthest_from(&witnesses, &posted) <= DEVIATION);
    }
}

#[test]
fn centres_stand_in_units_of_the_posted_point() {
    let witnesses: Vec<PathPoint> = (0..=100)
        .map(|i| {
            let (sin, cos) = libm::sincos(FRAC_PI_2 + 0.5 - f64::from(i) / 100.0);
            let normal = Vector::new(cos, 0.0, sin);
            PathPoint { tip: normal * 20.0, normal, selected: true, triangle: 0 }
        })
        .collect();
    let arcs = Arcs { height: 2.0003, ..arcs() };
    let segments = arcs.along(&witnesses, Neighbours::default(), DEVIATION, 500.0);
    let [Segment { curve: Curve::Arc { centre: [z, x], .. }, .. }] = segments[..] else { panic!("{segments:?}") };
    for posted in [z + 2.0003, x] {
        let count = posted / UNIT;
        assert!((count - count.round()).abs() < 1e-6, "{posted}");
    }
}

#[test]
fn a_machine_that_takes_no_arc_gets_the_chords() {
    let shape = [20.0, 1.0, 0.3, 0.0];
    let at = |i: u32| {
        let (tip, along) = flower(shape, 3, TAU * f64::from(i) / 900.0);
        point(tip, along, 0.3)
    };
    let witnesses: Vec<PathPoint> = (0..=900).map(at).collect();
    let chords: Vec<Vector> = fitting::thinned(&witnesses, DEVIATION)[1..].iter().map(|point| point.tip).collect();
    let none = Arcs { takes: &|_, _| false, ..arcs() };
    let no_plane = Arcs { planes: &[Plane::Zx], ..arcs() };
    for arcs in [none, no_plane] {
        let ends: Vec<Vector> =
            arcs.along(&witnesses, Neighbours::default(), DEVIATION, 500.0).iter().map(|line| line.end).collect();
        assert_eq!(ends, chords);
    }
}

#[test]
fn an_arc_is_held_to_the_path_between_witnesses_too() {
    // three witnesses on a circle of 10 mm, with nothing known between them but chords of 0.5 mm sagitta
    let at = |angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        point(Vector::new(10.0 * cos, 10.0 * sin, 0.0), Vector::new(-sin, cos, 0.0), 0.0)
    };
    let witnesses = [at(0.0), at(0.63), at(1.26)];
    let candidate = |clockwise| Candidate {
        plane: Plane::Xy,
        centre: [0.0; 2],
        clockwise,
        start: witnesses[0].tip,
        end: witnesses[2].tip,
    };
    assert!(!candidate(false).keeps_to(&witnesses, 0.4) && candidate(false).keeps_to(&witnesses, 0.6));
    // the other way round it does not pass them in their order
    assert!(!candidate(true).keeps_to(&witnesses, 100.0));
}

#[test]
fn figures_count_pieces_and_corners() {
    // half a circle, and back along its diameter: a right angle at the end
    let at = |i: u32| {
        let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(i) / 500.0);
        point(Vector::new(10.0 * cos, 10.0 * sin, 0.0), Vector::new(-sin, cos, 0.0), 0.0)
    };
    let mut witnesses: Vec<PathPoint> = (0..=500).map(at).collect();
    witnesses.push(witnesses[0]);
    let found = Fitted::of(&witnesses, &fitted(&witnesses), DEVIATION);
    assert_eq!((found.pieces, found.arcs), (2, 1), "{found:?}");
    assert!(found.chords > 100 && (found.corner - FRAC_PI_2).abs() < 1e-3, "{found:?}");
}

#[test]
fn pieces_turn_by_no_more_than_asked_and_two_paths_meet_in_the_same_direction() {
    let at = |i: u32| {
        let (tip, along) = flower([20.0, 1.0, 0.3, 0.0], 3, TAU * f64::from(i) / 3000.0);
        point(tip, along, 0.3)
    };
    let witnesses: Vec<PathPoint> = (0..=3000).map(at).collect();
    let largest = |segments: &[Segment]| {
        let (mut at, mut before, mut most) = (witnesses[0].tip, None, 0.0_f64);
        for segment in segments {
            let [start, end] = of_segment(segment, at);
            most = before.map_or(most, |before| most.max(fitting::angle(&before, &start)));
            (before, at) = (Some(end), segment.end);
        }
        most
    };
    let corner = 0.01;
    let coarse = 20.0 * DEVIATION;
    for smooth in [Arcs { corner, ..arcs() }, Arcs::none(corner)] {
        let free = Arcs { corner: f64::INFINITY, ..smooth };
        let none = Neighbours::default();
        assert!(largest(&free.along(&witnesses, none, coarse, 500.0)) > corner);
        assert!(largest(&smooth.along(&witnesses, none, coarse, 500.0)) <= corner);
        let (first, second) = (&witnesses[..=1000], &witnesses[1000..]);
        let mut both = smooth.along(first, Neighbours { after: second, ..none }, coarse, 500.0);
        both.extend(smooth.along(second, Neighbours { before: first, ..none }, coarse, 500.0));
        assert!(largest(&both) <= corner, "{}", largest(&both));
    }
}

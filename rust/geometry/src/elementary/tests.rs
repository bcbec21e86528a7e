use proptest::prelude::*;

use super::*;

const KINDS: [ElementaryKind; 6] = [
    ElementaryKind::Plane,
    ElementaryKind::Cylinder { radius: 4.0 },
    ElementaryKind::Cone { radius: 3.0, semi_angle: 0.4 },
    ElementaryKind::Cone { radius: 3.0, semi_angle: -0.4 },
    ElementaryKind::Sphere { radius: 7.0 },
    ElementaryKind::Torus { major: 9.0, minor: 2.5 },
];

fn surface(kind: ElementaryKind, sign: f64, second: f64) -> ElementarySurface {
    let across = [Vector::new(0.3, 1.0, 0.2), Vector::new(-1.0, 0.1, 0.4) * second];
    let axes = Axes::new(Vector::new(1.0, -2.0, 3.0), Vector::new(0.2, -0.3, 1.0), across).unwrap();
    ElementarySurface::new(kind, axes, sign).unwrap()
}

proptest! {
    #[test]
    fn points_off_the_surface_are_as_far_as_they_were_moved(
        kind in 0..KINDS.len(), sign in prop_oneof![Just(1.0), Just(-1.0)], second in prop_oneof![Just(1.0), Just(-1.0)],
        u in -3.0_f64..3.0, v in -1.4_f64..1.4, off in -1.0_f64..1.0,
    ) {
        let surface = surface(KINDS[kind], sign, second);
        let on = surface.point([u, v]);
        prop_assert!(surface.distance(on).abs() < 1e-12);
        let normal = surface.normal(on);
        prop_assert!((normal.norm() - 1.0).abs() < 1e-12);
        let moved: Vector = on + normal * off;
        prop_assert!((surface.distance(moved) - off).abs() < 1e-12);
        let [u2, v2] = surface.parameters(moved);
        let expected_v = match surface.kind() { // the height of a cone's foot is not that of the point
            ElementaryKind::Cone { .. } => surface.parameters(moved)[1],
            _ => v,
        };
        prop_assert!((u2 - u).abs() < 1e-12 && (v2 - expected_v).abs() < 1e-12, "{u2} {v2} for {u} {v}");
    }
}

#[test]
fn the_second_axis_lies_on_its_side() {
    for second in [1.0, -1.0] {
        let surface = surface(ElementaryKind::Plane, 1.0, second);
        let along = surface.point([0.0, 1.0]) - surface.point([0.0, 0.0]);
        assert!(along.dot(&(Vector::new(-1.0, 0.1, 0.4) * second)) > 0.0);
    }
}

#[test]
fn beyond_a_cones_apex_the_apex_is_nearest() {
    let cone = ElementaryKind::Cone { radius: 3.0, semi_angle: std::f64::consts::FRAC_PI_4 };
    let axes = Axes::new(Vector::zeros(), Vector::z(), [Vector::zeros(); 2]).unwrap();
    let cone = ElementarySurface::new(cone, axes, 1.0).unwrap();
    assert!((cone.distance(Vector::new(0.0, 0.0, -5.0)) - 2.0).abs() < 1e-14);
    assert!(cone.radius_at(-5.0).abs() < f64::MIN_POSITIVE);
}

#[test]
fn a_tube_over_the_axis_has_two_walls() {
    let axes = Axes::new(Vector::zeros(), Vector::z(), [Vector::zeros(); 2]).unwrap();
    let torus = ElementarySurface::new(ElementaryKind::Torus { major: 1.0, minor: 3.0 }, axes, 1.0).unwrap();
    assert!((torus.distance(Vector::new(2.0, 0.0, 0.0)) - 0.0).abs() < 1e-14); // the inner arc's crossing of the plane
    assert!((torus.distance(Vector::new(4.0, 0.0, 0.0)) - 0.0).abs() < 1e-14);
}

#[test]
fn what_has_no_direction_or_size_is_refused() {
    assert!(Axes::new(Vector::zeros(), Vector::zeros(), [Vector::x(); 2]).is_err());
    assert!(Axes::new(Vector::new(f64::NAN, 0.0, 0.0), Vector::z(), [Vector::x(); 2]).is_err());
    let axes = Axes::new(Vector::zeros(), Vector::z(), [Vector::x(); 2]).unwrap();
    assert!(ElementarySurface::new(ElementaryKind::Sphere { radius: f64::INFINITY }, axes, 1.0).is_err());
    assert!(ElementarySurface::new(ElementaryKind::Cone { radius: 1.0, semi_angle: 0.0 }, axes, 1.0).is_err());
}

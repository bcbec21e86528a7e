use styluscam_geometry::{NurbsCurve, Vector};

use super::stand::stand;
use super::{positions, FlankError, Method, RuledStrip, Side};

fn bezier(poles: &[[f64; 3]]) -> NurbsCurve {
    let degree = poles.len() - 1;
    let knots = [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    let poles: Vec<[f64; 4]> = poles.iter().map(|[x, y, z]| [*x, *y, *z, 1.0]).collect();
    NurbsCurve::new(degree, knots, &poles).unwrap()
}

fn curved() -> RuledStrip {
    let rails = [
        bezier(&[[0.0, 0.0, 0.0], [30.0, 15.0, 0.0], [60.0, 0.0, 0.0]]),
        bezier(&[[0.0, 5.0, 30.0], [30.0, 28.0, 30.0], [60.0, -8.0, 30.0]]),
    ];
    RuledStrip::new(rails, Side::Left).unwrap()
}

#[test]
fn the_cylinder_touches_both_rails() {
    let strip = curved();
    for method in [Method::Swept, Method::Rails, Method::ThreePoints] {
        for stand in positions(&strip, 5.0, 25, method).unwrap() {
            for (axis, contact) in stand.axis.iter().zip(stand.contacts) {
                let q = axis - contact;
                assert!((q.norm() - 5.0).abs() < 1e-12, "{method:?}");
                assert!(q.dot(&(stand.axis[1] - stand.axis[0])).abs() < 1e-10, "{method:?}");
            }
        }
    }
}

#[test]
fn the_axis_moves_as_its_derivative_says() {
    let strip = curved();
    for u in [0.1, 0.4, 0.77] {
        let at = |spread: f64| stand(&strip, 10.0, [u - spread, u + spread], [-1.0, 1.0]).unwrap();
        let h = 1e-6;
        let ((_, rates), (less, _), (more, _)) = (at(0.01), at(0.01 - h), at(0.01 + h));
        for (rate, (more, less)) in rates.iter().zip(more.axis.iter().zip(&less.axis)) {
            assert!(((more - less) / (2.0 * h) - rate).norm() < 1e-6, "{u}");
        }
    }
}

#[test]
fn both_sides_lie_opposite() {
    let rails = || [bezier(&[[0.0, 0.0, 0.0], [40.0, 0.0, 0.0]]), bezier(&[[0.0, 0.0, 20.0], [40.0, 0.0, 20.0]])];
    // walking along +X with +Z up, +Y is on the left
    for (side, y) in [(Side::Left, 3.0), (Side::Right, -3.0)] {
        let strip = RuledStrip::new(rails(), side).unwrap();
        for stand in positions(&strip, 3.0, 3, Method::Swept).unwrap() {
            assert!((stand.axis[0].y - y).abs() < 1e-12 && (stand.direction() - Vector::z()).norm() < 1e-12);
        }
    }
}

#[test]
fn what_is_no_strip_is_refused() {
    let line = |a: [f64; 3], b: [f64; 3]| bezier(&[a, b]);
    let strip = |rails| RuledStrip::new(rails, Side::Left);
    let floor = line([0.0, 0.0, 0.0], [40.0, 0.0, 0.0]);
    let crossing = strip([floor.clone(), line([0.0, -10.0, 0.0], [40.0, 10.0, 0.0])]);
    assert!(matches!(crossing, Err(FlankError::NoRuling { u }) if (u - 0.5).abs() < 1e-9));
    let back = bezier(&[[0.0, 0.0, 20.0], [60.0, 0.0, 20.0], [-20.0, 0.0, 20.0], [40.0, 0.0, 20.0]]);
    assert!(matches!(strip([floor.clone(), back]), Err(FlankError::Cusp { rail: 1, .. })));
    let along = line([50.0, 0.0, 0.0], [90.0, 0.0, 0.0]);
    assert!(matches!(strip([floor, along]), Err(FlankError::NoNormal { rail: 0, .. })));
}

#[test]
fn a_hollow_that_is_tighter_than_the_tool_is_refused() {
    let arc = |z: f64| bezier(&[[0.0, 0.0, z], [10.0, 20.0, z], [20.0, 0.0, z]]);
    let strip = |side| RuledStrip::new([arc(0.0), arc(15.0)], side).unwrap();
    assert!(matches!(positions(&strip(Side::Right), 12.0, 5, Method::Rails), Err(FlankError::TooLarge { .. })));
    assert!(positions(&strip(Side::Left), 12.0, 5, Method::Rails).is_ok());
    assert_eq!(positions(&strip(Side::Left), f64::NAN, 5, Method::Rails).map_err(|e| e.code()), Err("radius"));
    assert_eq!(positions(&strip(Side::Left), 1.0, 1, Method::Rails).map_err(|e| e.code()), Err("count"));
}

use styluscam_geometry::{NurbsCurve, Vector};

use super::stand::stand;
use super::{positions, Flank, FlankError, Method, RuledStrip, Side};

fn bezier(poles: &[[f64; 3]]) -> NurbsCurve {
    let degree = poles.len() - 1;
    let knots = [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    let poles: Vec<[f64; 4]> = poles.iter().map(|[x, y, z]| [*x, *y, *z, 1.0]).collect();
    NurbsCurve::new(degree, knots, &poles).unwrap()
}

fn cylinder(radius: f64) -> Flank {
    Flank::new(radius, 0.0).unwrap()
}

fn curved() -> RuledStrip {
    let rails = [
        bezier(&[[0.0, 0.0, 0.0], [30.0, 15.0, 0.0], [60.0, 0.0, 0.0]]),
        bezier(&[[0.0, 5.0, 30.0], [30.0, 28.0, 30.0], [60.0, -8.0, 30.0]]),
    ];
    RuledStrip::new(rails, Side::Left).unwrap()
}

#[test]
fn the_flank_touches_both_rails() {
    let strip = curved();
    for taper in [0.0_f64, 4.0, 15.0] {
        let flank = Flank::new(5.0, taper.to_radians()).unwrap();
        for method in [Method::Swept, Method::Rails, Method::ThreePoints] {
            for stand in positions(&strip, &flank, 25, method).unwrap() {
                let length = (stand.axis[1] - stand.axis[0]).norm();
                for (end, (axis, contact)) in stand.axis.iter().zip(stand.contacts).enumerate() {
                    let q = axis - contact;
                    let radius = flank.radius_at(length, end as f64);
                    assert!((q.norm() - radius).abs() < 1e-11, "{method:?}");
                    // as far down from its ball's centre as the flank is tapered
                    let down = q.dot(&stand.direction());
                    assert!((down - radius * taper.to_radians().sin()).abs() < 1e-10, "{method:?}");
                }
            }
        }
    }
}

#[test]
fn the_axis_moves_as_its_derivative_says() {
    let strip = curved();
    for (u, taper) in [(0.1, 0.0), (0.4, 0.2), (0.77, 0.05)] {
        let flank = Flank::new(10.0, taper).unwrap();
        let at = |spread: f64| stand(&strip, &flank, [u - spread, u + spread], [-1.0, 1.0]).unwrap().1;
        let h = 1e-6;
        let (here, less, more) = (at(0.01), at(0.01 - h), at(0.01 + h));
        for end in 0..2 {
            let rate = (more.axis[end] - less.axis[end]) / (2.0 * h);
            assert!((rate - here.rates[end]).norm() < 1e-6, "{u}");
        }
        let radius = |station: &super::swept::Station| flank.radius_at((station.axis[1] - station.axis[0]).norm(), 1.0);
        assert!(((radius(&more) - radius(&less)) / (2.0 * h) - here.swell).abs() < 1e-6, "{u}");
    }
}

#[test]
fn a_cone_lies_along_the_lines_of_another() {
    // a frustum around Z, apex below: its lines are cut by a cone whose axis leans with them
    let arc = |r: f64, z: f64| {
        let w = 0.5_f64.sqrt();
        let poles = [[r, 0.0, z, 1.0], [r, r, z, w], [0.0, r, z, 1.0]];
        NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &poles).unwrap()
    };
    let strip = RuledStrip::new([arc(20.0, 0.0), arc(28.0, 30.0)], Side::Right).unwrap();
    let flank = Flank::new(3.0, 0.1).unwrap();
    let wall = (8.0_f64 / 30.0).atan();
    // of so many positions the straight moves between them do not count
    for stand in positions(&strip, &flank, 500, Method::Swept).unwrap() {
        let lean = stand.direction().z.acos();
        assert!((lean - (wall - 0.1).abs()).abs() < 1e-9 || (lean - wall - 0.1).abs() < 1e-9, "{lean}");
    }
}

#[test]
fn both_sides_lie_opposite() {
    let rails = || [bezier(&[[0.0, 0.0, 0.0], [40.0, 0.0, 0.0]]), bezier(&[[0.0, 0.0, 20.0], [40.0, 0.0, 20.0]])];
    // walking along +X with +Z up, +Y is on the left
    for (side, y) in [(Side::Left, 3.0), (Side::Right, -3.0)] {
        let strip = RuledStrip::new(rails(), side).unwrap();
        for stand in positions(&strip, &cylinder(3.0), 3, Method::Swept).unwrap() {
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
    assert!(matches!(
        positions(&strip(Side::Right), &cylinder(12.0), 5, Method::Rails),
        Err(FlankError::TooLarge { .. })
    ));
    assert!(positions(&strip(Side::Left), &cylinder(12.0), 5, Method::Rails).is_ok());
    assert_eq!(Flank::new(f64::NAN, 0.0).map_err(|e| e.code()), Err("radius"));
    assert_eq!(Flank::new(3.0, f64::NAN).map_err(|e| e.code()), Err("taper"));
    assert_eq!(positions(&strip(Side::Left), &cylinder(1.0), 1, Method::Rails).map_err(|e| e.code()), Err("count"));
}

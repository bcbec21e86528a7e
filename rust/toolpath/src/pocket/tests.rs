//! Small pockets, and what is refused.

use std::f64::consts::PI;

use styluscam_motion::Watch;

use super::polygons::{Kernel, Polygons};
use super::{pocket_path, Pocket, PocketError, PocketPath, PocketRunKind};

fn rectangle(x: f64, y: f64) -> Vec<[f64; 3]> {
    vec![[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]]
}

fn pocket(boundary: &[[f64; 3]]) -> Pocket<'_> {
    Pocket {
        boundary,
        islands: &[],
        open_edges: &[],
        stock: None,
        radius: 2.5,
        angle: PI / 3.0,
        smoothing: 0.125,
        climb: true,
        two_way: false,
    }
}

fn planned(pocket: &Pocket<'_>) -> PocketPath {
    pocket_path(pocket, &Watch::default()).unwrap()
}

#[test]
fn offsets_are_what_they_are_for_squares_and_discs() {
    let kernel = Kernel::new(100.0);
    let square = kernel.even_odd(&[vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]]);
    let area = |distance: f64| kernel.offset(&square, distance, 1e-4).area();
    assert!((area(2.0) - (100.0 + 4.0 * 20.0 + 4.0 * PI)).abs() < 1e-3, "{}", area(2.0));
    assert!((area(-2.0) - 36.0).abs() < 1e-5 && area(-5.1) == 0.0);
    let hole = kernel.difference(&square, &Polygons::disc([5.0, 5.0], 2.0, 1e-4));
    assert!((kernel.offset(&hole, -1.0, 1e-4).area() - (64.0 - 9.0 * PI)).abs() < 1e-3);
    assert!((kernel.offset(&hole, 2.5, 1e-4).area() - (100.0 + 100.0 + 6.25 * PI)).abs() < 1e-3);
    let line = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0]];
    let swept = kernel.sweep(&line, 1.0, 1e-5).area();
    // two strips, a half disc at each end, a quarter disc outside the corner, a square less than both strips inside
    assert!((swept - (20.0 + 10.0 + PI + PI / 4.0 - 1.0)).abs() < 1e-3, "{swept}");
}

#[test]
fn a_square_is_cleared() {
    let boundary = rectangle(15.0, 15.0);
    let path = planned(&pocket(&boundary));
    assert!(path.left < 0.01, "{} left", path.left);
    let kinds = |kind| path.runs.iter().filter(|run| run.kind == kind).count();
    assert_eq!(kinds(PocketRunKind::Entry), 1);
    assert!(kinds(PocketRunKind::Cut) > 10);
}

#[test]
fn what_is_no_pocket_is_refused_by_name() {
    let square = rectangle(15.0, 15.0);
    let refused = |pocket: &Pocket<'_>| pocket_path(pocket, &Watch::default()).unwrap_err();
    assert_eq!(refused(&Pocket { radius: 16.0, ..pocket(&square) }).code(), "tool-too-large");
    assert_eq!(refused(&Pocket { angle: 2.0, ..pocket(&square) }).key(), "engagement_deg");
    assert_eq!(refused(&Pocket { open_edges: &[4], ..pocket(&square) }), PocketError::Edge { edge: 4, count: 4 });
    assert_eq!(refused(&pocket(&square[..2])), PocketError::Outline { key: "boundary".to_owned(), count: 2 });
    let line = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [20.0, 0.0, 0.0]];
    assert_eq!(refused(&pocket(&line)).code(), "outline");
    let watch = Watch::default();
    watch.cancel();
    assert_eq!(pocket_path(&pocket(&square), &watch), Err(PocketError::Cancelled));
}

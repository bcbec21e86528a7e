//! Points of a ruled surface and its normals, out of the part.

use styluscam_geometry::{CurvePoint, Vector};

use crate::expectation::FlankFace;

/// Rows of points along the rails, and points of each.
pub(super) const ROWS: usize = 65;
pub(super) const POINTS: usize = 17;

/// The points of a surface with their normals, row by row: at each share of the rails so many shares of the ruling.
pub(super) fn samples(face: &FlankFace) -> Vec<(Vector, Vector)> {
    let row = |i: usize| {
        let [a, b] = [0, 1].map(|rail| at(face, rail, i as f64 / (ROWS - 1) as f64));
        (0..POINTS).map(move |j| between(&a, &b, j as f64 / (POINTS - 1) as f64, face.is_left))
    };
    (0..ROWS).flat_map(row).collect()
}

/// A rail at a share of its parameters; derivatives by the share.
fn at(face: &FlankFace, rail: usize, share: f64) -> CurvePoint {
    let [first, last] = face.rails[rail].domain();
    let found = face.rails[rail].at(first + share * (last - first));
    CurvePoint { first: found.first * (last - first), ..found }
}

fn between(a: &CurvePoint, b: &CurvePoint, share: f64, is_left: bool) -> (Vector, Vector) {
    let ruling = b.point - a.point;
    let along = a.first + (b.first - a.first) * share;
    let left = ruling.cross(&along).normalize();
    (a.point + ruling * share, if is_left { left } else { -left })
}

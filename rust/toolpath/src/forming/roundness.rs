//! How far a part is from a surface of revolution about Z.

use std::collections::BTreeSet;

use rayon::prelude::*;
use styluscam_geometry::{Bvh, Mesh, Vector};
use styluscam_motion::{Cancelled, Watch};

/// The angle between neighbouring leaves of a plant, rad: multiples of it are spread evenly over a turn, however many there are
/// (H. Vogel, "A better way to construct the sunflower head", Mathematical Biosciences 44, 1979).
const GOLDEN: f64 = 2.399_963_229_728_653;
/// Angles by which each point is turned.
const TURNS: u32 = 8;
/// Large triangles are looked at in parts of this share of the part's size.
const FINE: f64 = 0.02;
/// Corners that are looked at, at most: of more, every so manieth.
const MOST: usize = 8000;
/// Points in a piece of work. Fixed, so that the result does not depend on the number of threads.
const CHUNK: usize = 256;

/// The largest deviation that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roundness {
    /// Distance from the part of a point of it that was turned about Z, mm.
    pub deviation: f64,
    /// That point before it was turned, mm.
    pub at: Vector,
    /// Points that were turned, each by some angles.
    pub samples: usize,
}

/// Measures how far the triangles of `selected` leave the part when they are turned about Z.
///
/// Corners of triangles, and points of large ones, are turned by each of some angles; the distance from where they come to lie to the
/// nearest point of the part is the deviation. It is measured on triangles, and so contains how far these are from the surfaces.
/// None without triangles.
///
/// # Errors
/// `Cancelled`.
pub fn roundness(mesh: &Mesh, bvh: &Bvh, selected: &[bool], watch: &Watch) -> Result<Option<Roundness>, Cancelled> {
    let (low, high) = mesh.bounds();
    let spacing = FINE * (high - low).norm();
    let points = samples(mesh, selected, spacing);
    watch.begin("measuring roundness", points.len().div_ceil(CHUNK));
    let off = |point: &Vector| {
        let turned = |turn: u32| {
            let (sin, cos) = libm::sincos(f64::from(turn) * GOLDEN);
            let there = Vector::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y, point.z);
            (bvh.nearest(mesh, there).0 - there).norm()
        };
        (1..=TURNS).map(turned).fold(0.0, f64::max)
    };
    let worst = points.par_chunks(CHUNK).map(|chunk| {
        watch.advance(1)?;
        Ok(chunk.iter().map(|point| (off(point), *point)).reduce(larger))
    });
    let worst: Result<Vec<_>, Cancelled> = worst.collect();
    let worst = worst?.into_iter().flatten().reduce(larger);
    Ok(worst.map(|(deviation, at)| Roundness { deviation, at, samples: points.len() }))
}

fn larger(a: (f64, Vector), b: (f64, Vector)) -> (f64, Vector) {
    if b.0 > a.0 {
        b
    } else {
        a
    }
}

/// Corners of some triangles, spread over their order, and points of those that are large.
fn samples(mesh: &Mesh, selected: &[bool], spacing: f64) -> Vec<Vector> {
    let triangles = || (0..selected.len()).filter(|triangle| selected[*triangle]);
    let corners: BTreeSet<u32> = triangles().flat_map(|triangle| mesh.triangles()[triangle]).collect();
    let each = corners.len().div_ceil(MOST).max(1);
    let corners = corners.into_iter().step_by(each).map(|vertex| mesh.vertices()[vertex as usize]);
    corners.chain(triangles().flat_map(|triangle| parts(mesh.corners(triangle), spacing))).collect()
}

/// The corners of a triangle's equal parts, of the area of a square of `spacing`, mm, each, and its middle; none where it is one.
fn parts([a, b, c]: [Vector; 3], spacing: f64) -> impl Iterator<Item = Vector> {
    let twice_area = (b - a).cross(&(c - a)).norm();
    let parts = (libm::sqrt(twice_area) / spacing).ceil().max(1.0) as u32;
    let share = move |i: u32| f64::from(i) / f64::from(parts);
    let at = move |i: u32, j: u32| a + share(i) * (b - a) + share(j) * (c - a);
    let inside = (0..=parts).flat_map(move |i| (0..=parts - i).map(move |j| at(i, j))).chain([(a + b + c) / 3.0]);
    inside.filter(move |_| parts > 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cone of so many sides and 45 degrees, its axis at X = `off`.
    fn cone(sides: i64, off: f64) -> Mesh {
        let rim = (0..sides).map(|i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / sides as f64);
            Vector::new(off + 20.0 * cos, 20.0 * sin, -20.0)
        });
        let vertices = std::iter::once(Vector::new(off, 0.0, 0.0)).chain(rim).collect();
        let triangles: Vec<[i64; 3]> = (0..sides).map(|i| [0, 1 + i, 1 + (i + 1) % sides]).collect();
        Mesh::new(vertices, &triangles, &[]).unwrap()
    }

    fn measured(mesh: &Mesh) -> Roundness {
        let selected = vec![true; mesh.triangles().len()];
        roundness(mesh, &Bvh::new(mesh), &selected, &Watch::default()).unwrap().unwrap()
    }

    #[test]
    fn a_cone_is_round_but_for_its_facets() {
        // sides of the rim are 20 (1 - cos(pi / n)) nearer to the axis than corners; the foot of a turned corner on the wall's plane
        // would lie below the rim, so that the rim is the nearest
        for sides in [48, 192] {
            let sag = 20.0 * (1.0 - libm::cos(std::f64::consts::PI / sides as f64));
            let found = measured(&cone(sides, 0.0)).deviation;
            assert!(found <= sag * (1.0 + 1e-9) && found > 0.5 * sag, "{sides}: {found} {sag}");
        }
    }

    #[test]
    fn an_axis_beside_that_of_the_spindle_and_a_pyramid_are_not_round() {
        let off = measured(&cone(192, 1.0));
        // half a turn takes a point of the rim 2 mm beyond it
        assert!(off.deviation > 1.3 && off.deviation < 2.0, "{off:?}");
        assert!(measured(&cone(4, 0.0)).deviation > 3.0);
    }

    #[test]
    fn nothing_is_measured_of_nothing() {
        let mesh = cone(4, 0.0);
        assert_eq!(roundness(&mesh, &Bvh::new(&mesh), &[false; 4], &Watch::default()), Ok(None));
    }
}

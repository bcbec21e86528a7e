//! An intermediate stage of a shape: the lowest surface above it whose walls are no steeper than an angle.
//!
//! Over a position p it is z(p) = max over all points q of the shape of h(q) - tan(angle) |p - q|: the highest of the cones that hang
//! down from it. Derivation: docs/concepts/stages.md.

use std::collections::HashMap;

use rayon::prelude::*;

use super::{cone, refine::Pieces};
use crate::{Bvh, GeometryError, Mesh, Vector};

/// Sides are not divided below this length for a stage, mm: what is formed again needs no sharper creases.
const FINEST: f64 = 0.3;
/// How far a stage's triangles may lie off it where they are not as small as that, mm.
const TOLERANCE: f64 = 0.01;
/// Triangles that are gentler than the stage by this share of its slope count as steep: rounding.
const NEARLY: f64 = 1e-9;
/// Triangles whose normal has a smaller part along Z show no direction in plan.
const UPRIGHT: f64 = 1e-3;
/// Triangles of less area in plan are walls of the shape that the stage does not have, mm^2.
const LEAST_AREA: f64 = 1e-9;

/// A stage and the shape that it is one of, with the same triangles.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The stage.
    pub mesh: Mesh,
    /// The shape.
    pub target: Mesh,
    /// Most that it lies above the shape, mm.
    pub above: f64,
}

/// The stage of some triangles of a mesh, which lies as it is formed, for a wall angle in rad.
///
/// Each of the shape's triangles is divided, so what is linear between corners lies nowhere below it.
///
/// # Errors
/// No triangle is left, or too many.
pub fn stage(mesh: &Mesh, keep: &[bool], angle: f64) -> Result<Stage, GeometryError> {
    let kept = || (0..keep.len()).filter(|triangle| keep[*triangle]);
    let triangles: Vec<[i64; 3]> = kept().map(|triangle| mesh.triangles()[triangle].map(i64::from)).collect();
    let faces: Vec<u32> = kept().map(|triangle| mesh.faces()[triangle]).collect();
    let shape = Mesh::new(mesh.vertices().to_vec(), &triangles, &faces)?;
    let slope = libm::tan(angle);
    let holding: Vec<[i64; 3]> = holding(&shape, slope).into_iter().map(|i| triangles[i]).collect();
    let holding = if holding.is_empty() { None } else { Some(Mesh::new(shape.vertices().to_vec(), &holding, &[])?) };
    let holding = holding.map(|mesh| (Bvh::new(&mesh), mesh));
    let raised = |point: Vector| {
        let held = |(bvh, mesh): &(Bvh, Mesh)| height(mesh, bvh, point, slope);
        Vector::new(point.x, point.y, holding.as_ref().map_or(point.z, held))
    };
    let pieces = Pieces::of(&shape, &raised, TOLERANCE, FINEST)?;
    let moved = |corners: [u32; 3]| corners.map(|corner| pieces.moved[corner as usize]);
    let is_seen = |corners: [u32; 3]| {
        let [a, b, c] = moved(corners);
        (b - a).cross(&(c - a)).z > LEAST_AREA
    };
    let seen = || pieces.triangles.iter().filter(|piece| is_seen(piece.corners));
    let triangles: Vec<[i64; 3]> = seen().map(|piece| piece.corners.map(i64::from)).collect();
    let faces: Vec<u32> = seen().map(|piece| piece.face).collect();
    let above = pieces.vertices.par_iter().zip(&pieces.moved).map(|(before, after)| after.z - before.z);
    let above = above.reduce(|| 0.0, f64::max);
    let target = Mesh::new(pieces.vertices.clone(), &triangles, &faces)?;
    let normals: Vec<[Vector; 3]> = seen().map(|piece| [normal(moved(piece.corners), slope); 3]).collect();
    Ok(Stage { mesh: Mesh::with_normals(pieces.moved, &triangles, &faces, &normals)?, target, above })
}

/// The unit normal of a stage over a triangle of it: that of its facet, but no steeper than a stage is. A narrow facet whose corners lie
/// on it leans by more.
fn normal([a, b, c]: [Vector; 3], slope: f64) -> Vector {
    let across = (b - a).cross(&(c - a));
    let level = across.xy().norm();
    let least = level / slope;
    Vector::new(across.x, across.y, across.z.max(least)).normalize()
}

/// The triangles from which the highest cones hang, over positions that lie above the shape: those at its border, the gentle ones
/// beside steep ones, and steep ones that fall away on both sides of an edge.
///
/// A cone that hangs down from within a gentle triangle is below one that hangs down from nearer by, and one from within a steep triangle
/// below one from farther up. Derivation: docs/concepts/stages.md.
fn holding(shape: &Mesh, slope: f64) -> Vec<usize> {
    let triangles = shape.triangles();
    let mut beside: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
    for (number, corners) in triangles.iter().enumerate() {
        for side in sides(*corners) {
            beside.entry(side).or_default().push(number);
        }
    }
    let rising = |triangle: usize| -shape.normal(triangle).xy();
    let is_steep = |triangle: usize| {
        let normal = shape.normal(triangle);
        normal.xy().norm() >= slope * normal.z * (1.0 - NEARLY)
    };
    let is_upright = |triangle: usize| shape.normal(triangle).z < UPRIGHT;
    let holds = |triangle: &usize| {
        let [a, b, c] = triangles[*triangle];
        [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| {
            let others = beside.get(&(from.min(to), from.max(to))).map_or(&[][..], Vec::as_slice);
            let [Some(other), None] = [0, 1].map(|i| others.iter().filter(|other| *other != triangle).nth(i)) else {
                return true; // the border, or more than two of them
            };
            match [*triangle, *other].map(is_steep) {
                [false, steep] => steep,
                [true, false] => is_upright(*triangle),
                [true, true] => {
                    let along = shape.vertices()[to as usize] - shape.vertices()[from as usize];
                    let outwards = nalgebra::Vector2::new(along.y, -along.x);
                    let is_ridge = rising(*triangle).dot(&outwards) >= 0.0 && rising(*other).dot(&outwards) <= 0.0;
                    is_ridge || is_upright(*triangle)
                }
            }
        })
    };
    (0..triangles.len()).filter(holds).collect()
}

/// A triangle's sides, each from its end with the smaller number.
fn sides([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)].map(|(from, to)| (from.min(to), from.max(to)))
}

/// The height of the stage over a position of the shape, mm.
fn height(mesh: &Mesh, bvh: &Bvh, point: Vector, slope: f64) -> f64 {
    let at = [point.x, point.y];
    let bound = |node: &crate::Node| {
        let away = |axis: usize| (node.low[axis] - at[axis]).max(at[axis] - node.high[axis]).max(0.0);
        node.high.z - slope * libm::hypot(away(0), away(1))
    };
    let visit = |triangle: u32, best: f64| best.max(hanging(&mesh.corners(triangle as usize), at, slope));
    bvh.maximise(point.z, bound, visit)
}

/// The highest of the cones that hang down from the points of a triangle, over a position: from the point above it, or from one of
/// the sides.
fn hanging(corners: &[Vector; 3], at: [f64; 2], slope: f64) -> f64 {
    let [a, b, c] = corners;
    let turned = |point: &Vector| Vector::new(point.x, point.y, -point.z);
    let sides = [[a, b], [b, c], [c, a]].map(|[from, to]| -cone::lowest(turned(from), turned(to), at, slope).0);
    let highest = sides.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let area = |p: &Vector, q: &Vector| (p.x - at[0]) * (q.y - at[1]) - (p.y - at[1]) * (q.x - at[0]);
    let (of_a, of_b, of_c) = (area(b, c), area(c, a), area(a, b));
    let whole = of_a + of_b + of_c;
    if whole > 0.0 && of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0 {
        return highest.max((of_a * a.z + of_b * b.z + of_c * c.z) / whole);
    }
    highest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cup: rings of 90 points at radii and heights, closed in the middle, in a flange.
    fn cup(rings: &[(f64, f64)]) -> Mesh {
        let point = |radius: f64, z: f64, i: u32| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 90.0);
            Vector::new(radius * cos, radius * sin, z)
        };
        let mut vertices: Vec<Vector> =
            rings.iter().flat_map(|(radius, z)| (0..90).map(move |i| point(*radius, *z, i))).collect();
        let mut triangles = Vec::new();
        for ring in 1..rings.len() as i64 {
            for i in 0..90 {
                let (a, b) = (90 * (ring - 1) + i, 90 * (ring - 1) + (i + 1) % 90);
                triangles.extend([[a, b, b + 90], [a, b + 90, a + 90]]);
            }
        }
        let last = vertices.len() as i64 - 90;
        vertices.push(Vector::new(0.0, 0.0, rings[rings.len() - 1].1));
        triangles.extend((0..90).map(|i| [last + i, last + (i + 1) % 90, last + 90]));
        Mesh::new(vertices, &triangles, &[]).unwrap()
    }

    #[test]
    fn a_stage_of_an_upright_cup_is_a_cone_from_its_rim_to_its_floor() {
        let mesh = cup(&[(50.0, 0.0), (30.0, 0.0), (30.0, -15.0)]);
        let found = stage(&mesh, &vec![true; mesh.triangles().len()], 50_f64.to_radians()).unwrap();
        let slope = libm::tan(50_f64.to_radians());
        for triangle in 0..found.mesh.triangles().len() {
            let corners = found.mesh.corners(triangle);
            for corner in corners {
                let exact = (-slope * (30.0 - libm::hypot(corner.x, corner.y)).max(0.0)).max(-15.0);
                assert!((corner.z - exact).abs() < 0.03, "{corner} {exact}");
            }
            let steepest = found.mesh.corner_normals(triangle)[0];
            assert!(steepest.xy().norm() <= slope * steepest.z * (1.0 + 1e-12));
            let middle = |mesh: &Mesh| mesh.corners(triangle).iter().sum::<Vector>().z;
            assert!(middle(&found.mesh) >= middle(&found.target) - 1e-9);
        }
        assert!((found.above - 15.0).abs() < 1e-6 && found.mesh.triangles().len() < 150_000);
    }

    #[test]
    fn the_triangles_that_hold_it_give_what_all_of_them_give() {
        // a cup with a steep hill in a stepped floor, whose rings are not round
        let rings = [(50.0, 0.0), (30.0, 0.0), (28.0, -9.0), (22.0, -9.5), (20.0, -15.0), (9.0, -15.2), (6.0, -4.0)];
        let mut mesh = cup(&rings);
        for twist in [0.0, 0.35] {
            let bent = |p: &Vector| Vector::new(p.x, p.y * (1.0 + twist), p.z + twist * libm::sin(0.3 * p.x));
            let triangles: Vec<[i64; 3]> = mesh.triangles().iter().map(|corners| corners.map(i64::from)).collect();
            mesh = Mesh::new(mesh.vertices().iter().map(bent).collect(), &triangles, &[]).unwrap();
            for degrees in [20.0_f64, 45.0, 60.0, 75.0] {
                let slope = libm::tan(degrees.to_radians());
                let found = holding(&mesh, slope);
                let some: Vec<[i64; 3]> = found.iter().map(|i| triangles[*i]).collect();
                let held = Mesh::new(mesh.vertices().to_vec(), &some, &[]).unwrap();
                let bvh = Bvh::new(&held);
                let all = 0..triangles.len();
                for number in all.clone().step_by(7) {
                    let point = mesh.corners(number).iter().sum::<Vector>() / 3.0;
                    let hangs = |i: usize| hanging(&mesh.corners(i), [point.x, point.y], slope);
                    let exact = all.clone().map(hangs).fold(f64::NEG_INFINITY, f64::max);
                    assert!((height(&held, &bvh, point, slope) - exact).abs() < 1e-9, "{degrees} {point}");
                }
                assert!(found.len() < all.len());
            }
        }
    }

    #[test]
    fn gentle_walls_stay_as_they_are() {
        let mesh = cup(&[(50.0, 0.0), (30.0, 0.0), (10.0, -15.0)]);
        let found = stage(&mesh, &vec![true; mesh.triangles().len()], 50_f64.to_radians()).unwrap();
        assert!(found.above < 1e-9 && found.mesh.triangles().len() == mesh.triangles().len());
    }
}

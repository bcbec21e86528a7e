//! Which simple surface a face of triangles lies on.

use nalgebra::{Matrix3, Matrix4, SymmetricEigen, Vector4};
use serde::Serialize;

use crate::Vector;

/// The kind of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// All in one plane.
    Plane,
    /// A part of a circular cylinder.
    Cylinder,
    /// A part of a circular cone.
    Cone,
    /// A part of a sphere.
    Sphere,
    /// None of these.
    Freeform,
}

/// Corners lie on a simple surface within this share of its radius,
const CLOSE: f64 = 2e-3;
/// facets stand along its axis within this (cosine of an angle).
const ALONG: f64 = 2e-3;

/// A triangle's plane: its unit normal, a point of it, and its weight (twice its area).
struct Facet {
    normal: Vector,
    point: Vector,
    weight: f64,
}

/// The kind of a curved face of triangles whose corners are good to `flatness`, mm.
pub fn shape_of(corners: &[[Vector; 3]], flatness: f64) -> Shape {
    let middle = corners.iter().flatten().sum::<Vector>() / (3 * corners.len()).max(1) as f64;
    let points: Vec<Vector> = corners.iter().flatten().map(|p| p - middle).collect();
    let facets: Vec<Facet> = points
        .chunks_exact(3)
        .map(|t| (t[0], (t[1] - t[0]).cross(&(t[2] - t[0]))))
        .filter(|(_, twice)| twice.norm() > 0.0)
        .map(|(point, twice)| Facet { normal: twice.normalize(), point, weight: twice.norm() })
        .collect();
    let total: f64 = facets.iter().map(|facet| facet.weight).sum();
    let mean = facets.iter().map(|facet| facet.normal * facet.weight).sum::<Vector>() / total;
    // a cylinder's normals lie in a plane through the origin, a cone's in one beside it
    let round = direction(&facets, Vector::zeros()).filter(|axis| stands(&facets, *axis, 0.0));
    if round.is_some_and(|axis| is_circle(&points, axis, flatness)) {
        return Shape::Cylinder;
    }
    let height = |axis: Vector| mean.dot(&axis);
    let tapered = direction(&facets, mean).filter(|axis| stands(&facets, *axis, height(*axis)));
    if tapered.is_some_and(|axis| is_cone(&points, &facets, axis, height(axis), flatness)) {
        return Shape::Cone;
    }
    // last: two circles of a cylinder or a cone lie on a sphere too
    if is_sphere(&points, flatness) {
        return Shape::Sphere;
    }
    Shape::Freeform
}

/// The direction in which normals, seen from a point, spread least.
fn direction(facets: &[Facet], from: Vector) -> Option<Vector> {
    let away = |facet: &Facet| facet.normal - from;
    let spread: Matrix3<f64> = facets.iter().map(|f| away(f) * away(f).transpose() * f.weight).sum();
    let eigen = SymmetricEigen::new(spread);
    let least = (0..3).min_by(|i, j| eigen.eigenvalues[*i].total_cmp(&eigen.eigenvalues[*j]))?;
    Some(eigen.eigenvectors.column(least).into_owned())
}

/// Whether all normals have the same height along an axis; the smallest facets' are not known well.
fn stands(facets: &[Facet], axis: Vector, height: f64) -> bool {
    let typical = facets.iter().map(|facet| facet.weight).sum::<f64>() / facets.len().max(1) as f64;
    facets.iter().all(|facet| (facet.normal.dot(&axis) - height).abs() <= ALONG || facet.weight < 1e-3 * typical)
}

/// Whether points lie on one sphere (least squares of |p|^2 = 2 c p + k).
fn is_sphere(points: &[Vector], flatness: f64) -> bool {
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for p in points {
        let row = Vector4::new(2.0 * p.x, 2.0 * p.y, 2.0 * p.z, 1.0);
        normal += row * row.transpose();
        right += row * p.norm_squared();
    }
    let Some(found) = normal.lu().solve(&right) else { return false };
    let centre = found.xyz();
    let radius = (found.w + centre.norm_squared()).sqrt();
    is_near(points.iter().map(|p| (p - centre).norm()), radius, reach(points), flatness)
}

/// Whether points seen along an axis lie on one circle.
fn is_circle(points: &[Vector], axis: Vector, flatness: f64) -> bool {
    let across = axis.cross(&Vector::ith(axis.iamin(), 1.0)).normalize();
    let beside = axis.cross(&across);
    let flat = points.iter().map(|p| (p.dot(&across), p.dot(&beside)));
    let (mut normal, mut right) = (Matrix3::zeros(), Vector::zeros());
    for (x, y) in flat.clone() {
        let row = Vector::new(2.0 * x, 2.0 * y, 1.0);
        normal += row * row.transpose();
        right += row * (x * x + y * y);
    }
    let Some(found) = normal.lu().solve(&right) else { return false };
    let radius = (found.z + found.x * found.x + found.y * found.y).sqrt();
    is_near(flat.map(|(x, y)| libm::hypot(x - found.x, y - found.y)), radius, reach(points), flatness)
}

/// Whether the facets' planes meet in one point, from which the points lie in their directions on one cone.
fn is_cone(points: &[Vector], facets: &[Facet], axis: Vector, height: f64, flatness: f64) -> bool {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector::zeros());
    for facet in facets {
        normal += facet.normal * facet.normal.transpose() * facet.weight;
        right += facet.normal * facet.normal.dot(&facet.point) * facet.weight;
    }
    let Some(apex) = normal.lu().solve(&right) else { return false };
    // the corners' cone, not the facets': chords lie inside
    let along = |p: &Vector| (p - apex).dot(&axis);
    let across = |p: &Vector| (p - apex - axis * along(p)).norm();
    let squares: f64 = points.iter().map(|p| along(p) * along(p)).sum();
    let slope = points.iter().map(|p| across(p) * along(p).abs()).sum::<f64>() / squares;
    let size = reach(points);
    height.abs() > ALONG
        && slope.is_finite()
        && points.iter().all(|p| (across(p) - slope * along(p).abs()).abs() <= CLOSE * size + 4.0 * flatness)
}

fn reach(points: &[Vector]) -> f64 {
    points.iter().map(|p| p.norm()).fold(0.0, f64::max)
}

/// Whether distances are a radius that a part can have.
fn is_near(mut distances: impl Iterator<Item = f64>, radius: f64, reach: f64, flatness: f64) -> bool {
    radius.is_finite()
        && radius < 100.0 * reach
        && distances.all(|distance| (distance - radius).abs() <= (CLOSE * radius).min(0.02 * reach) + 4.0 * flatness)
}

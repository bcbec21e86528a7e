//! A mesh whose every point was moved: its triangles, normals, and how far it may be from the moved surface.

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::refine::{Map, Piece, Pieces};
use crate::{GeometryError, Mesh, Vector};

/// Derivatives are taken over this share of the distance within which the map is not known: good to 1e-3 of what it changes by.
const SHARE: f64 = 1e-3;

/// A moved mesh.
#[derive(Clone, Debug)]
pub struct Warped {
    /// Moved. Its triangles are those of `source`, in their order.
    pub mesh: Mesh,
    /// At rest, with as many triangles.
    pub source: Mesh,
    /// How far the moved triangles, within which the map is linear, were found to lie off the map itself, mm.
    pub linear: f64,
    /// By how much a small distance along a normal grew at most.
    pub stretch: f64,
    /// A triangle that was turned inside out, if any.
    pub folded: Option<usize>,
}

/// Moves every point of a mesh. Triangles are split until they follow the moved surface to `tolerance`, mm, or to the size of
/// `spacing`, mm, above 0: the distance within which the map is not known, as that between measured points, and taken as linear.
///
/// # Errors
/// Points that are moved to no finite position or absurdly far, or that take too many triangles.
pub fn warped(mesh: &Mesh, map: Map<'_>, tolerance: f64, spacing: f64) -> Result<Warped, GeometryError> {
    let pieces = Pieces::of(mesh, map, tolerance, spacing)?;
    let points = pieces.vertices.par_iter().zip(&pieces.moved);
    let gradients: Vec<Matrix3<f64>> =
        points.map(|(point, moved)| gradient(map, *point, *moved, SHARE * spacing)).collect();
    let at = |corner: u32| &gradients[corner as usize];
    let triangles: Vec<[i64; 3]> = pieces.triangles.iter().map(|piece| piece.corners.map(i64::from)).collect();
    let faces: Vec<u32> = pieces.triangles.iter().map(|piece| piece.face).collect();
    let before: Vec<[Vector; 3]> = pieces.triangles.iter().filter_map(|piece| piece.normals).collect();
    let turned = |piece: &Piece| {
        let normals = piece.normals?;
        Some([0, 1, 2].map(|i| turned(at(piece.corners[i]), normals[i])))
    };
    let after: Vec<[Vector; 3]> = pieces.triangles.iter().filter_map(turned).collect();
    let folded = pieces.triangles.iter().position(|piece| is_folded(piece, &pieces));
    let source = Mesh::with_normals(pieces.vertices, &triangles, &faces, &before)?;
    let grown = |t: usize| {
        let (corners, normals) = (source.triangles()[t], source.corner_normals(t));
        let along = (0..3).map(|i| (at(corners[i]) * normals[i]).norm());
        along.fold(0.0, f64::max)
    };
    let stretch = (0..source.triangles().len()).map(grown).fold(1.0, f64::max);
    let mesh = Mesh::with_normals(pieces.moved, &triangles, &faces, &after)?;
    Ok(Warped { mesh, source, linear: pieces.linear, stretch, folded })
}

/// How the map changes about a point that it moved.
fn gradient(map: Map<'_>, point: Vector, moved: Vector, step: f64) -> Matrix3<f64> {
    let column = |axis: Vector| (map(point + step * axis) - moved) / step;
    Matrix3::from_columns(&[Vector::x(), Vector::y(), Vector::z()].map(column))
}

/// The normal of a moved surface: at right angles to what its tangents became.
fn turned(gradient: &Matrix3<f64>, normal: Vector) -> Vector {
    let aside = if normal.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    let first = normal.cross(&aside);
    let second = normal.cross(&first);
    let turned = (gradient * first).cross(&(gradient * second));
    turned.try_normalize(f64::EPSILON).unwrap_or(normal)
}

/// Whether a triangle was turned by more than a right angle, or lost its area.
fn is_folded(piece: &Piece, pieces: &Pieces<'_>) -> bool {
    let area = |[a, b, c]: [Vector; 3]| (b - a).cross(&(c - a));
    let [before, after] =
        [&pieces.vertices, &pieces.moved].map(|points| area(piece.corners.map(|i| points[i as usize])));
    after.dot(&before) <= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles over a square of 40 mm, with normals, in two faces; corners are not shared.
    fn square() -> Mesh {
        let at = |x: f64, y: f64| Vector::new(x, y, 0.0);
        let corners = [at(0.0, 0.0), at(40.0, 0.0), at(40.0, 40.0), at(0.0, 0.0), at(40.0, 40.0), at(0.0, 40.0)];
        Mesh::with_normals(corners.to_vec(), &[[0, 1, 2], [3, 4, 5]], &[1, 2], &[[Vector::z(); 3]; 2]).unwrap()
    }

    /// A square becomes a cylinder's sector about an axis along y, of radius 100.
    fn rolled(point: Vector) -> Vector {
        let (sin, cos) = libm::sincos(point.x / 100.0);
        Vector::new((100.0 + point.z) * sin, point.y, (100.0 + point.z) * cos - 100.0)
    }

    #[test]
    fn a_rolled_sheet_lies_on_its_cylinder_to_the_tolerance_with_its_normals_and_without_gaps() {
        let warped = warped(&square(), &rolled, 0.001, 1.0).unwrap();
        assert!(warped.linear <= 0.001 && warped.folded.is_none() && (warped.stretch - 1.0).abs() < 1e-4);
        let axis = Vector::new(0.0, 0.0, -100.0);
        let radius = |p: Vector| libm::hypot(p.x - axis.x, p.z - axis.z);
        let mut open: std::collections::HashMap<(u32, u32), i32> = std::collections::HashMap::new();
        for t in 0..warped.mesh.triangles().len() {
            let corners = warped.mesh.corners(t);
            let middle = corners.iter().sum::<Vector>() / 3.0;
            assert!((radius(middle) - 100.0).abs() <= 0.001, "{}", radius(middle));
            for (normal, corner) in warped.mesh.corner_normals(t).into_iter().zip(corners) {
                let exact = Vector::new(corner.x, 0.0, corner.z + 100.0) / 100.0;
                assert!((normal - exact).norm() < 1e-4, "{normal} at {corner}");
            }
            let [a, b, c] = warped.mesh.triangles()[t];
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *open.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
        }
        // every side inside has one triangle on each side of it: only those on the border of the square are left
        let border = |i: u32| {
            let p = warped.source.vertices()[i as usize];
            [p.x, p.y].iter().any(|x| *x == 0.0 || (*x - 40.0).abs() < 1e-12)
        };
        assert!(open.iter().all(|((a, b), count)| *count == 0 || border(*a) && border(*b)));
        let area: f64 = (0..warped.source.triangles().len()).map(|t| warped.source.area(t)).sum();
        assert!((area - 1600.0).abs() < 1e-6 && warped.mesh.faces().contains(&2));
    }

    #[test]
    fn what_moves_as_a_whole_keeps_its_triangles() {
        let lifted = warped(&square(), &|p| p + Vector::new(1.0, 2.0, 3.0), 1e-4, 1.0).unwrap();
        assert_eq!(lifted.mesh.triangles().len(), 2);
    }

    #[test]
    fn a_bump_inside_a_triangle_is_seen_and_a_fold_too() {
        let bump = |p: Vector| p + Vector::z() * (-((p.x - 25.0).powi(2) + (p.y - 10.0).powi(2)) / 4.0).exp();
        let warped_bump = warped(&square(), &bump, 0.001, 2.0).unwrap();
        assert!(warped_bump.mesh.bounds().1.z > 0.99, "{}", warped_bump.mesh.bounds().1.z);
        let mirrored = warped(&square(), &|p| Vector::new(-p.x, p.y, p.z), 0.001, 1.0).unwrap();
        assert_eq!(mirrored.folded, Some(0));
    }
}

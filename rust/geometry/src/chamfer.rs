//! A part with some of its sharp level edges chamfered: what a cone that goes along them is to make of it.
//!
//! At an edge a wedge is taken off, which ends between neighbouring edges in the upright plane that halves their corner. Triangles are cut
//! at the wedges' planes, what lies in a wedge is dropped, and its slope is put there instead.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{RTree, AABB};

use crate::{GeometryError, Mesh, Vector};

/// How far a wall's triangles may lie in front of the plane through its edge, mm: round walls are twisted by as much.
const TWISTED: f64 = 5e-3;
/// Heights that differ by less are the same, mm.
const SAME: f64 = 1e-4;
/// How far slopes are drawn out beyond their ends before they are cut off, in their widths.
const FAR: f64 = 100.0;
/// A level face around which chamfers turn by more, while they meet across it, is gone, rad.
const AROUND: f64 = 2.6;
/// What lies so little beyond a plane lies in it, mm.
const EXACT: f64 = 1e-9;
/// Pieces of less area are none, mm^2.
const NOTHING: f64 = 1e-12;

/// A straight piece of a level edge between a level face and a wall that goes down from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamferEdge {
    /// Its ends, mm.
    pub ends: [Vector; 2],
    /// Level unit vector across it, into the level face.
    pub inward: Vector,
    /// Angle of the wall from the vertical, rad: positive where it comes out below the edge.
    pub lean: f64,
    /// Level unit vectors along it, square to the planes in which its chamfer ends.
    pub miters: [Vector; 2],
}

/// The size of chamfers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamferSize {
    /// Of the level face, measured across the edge, mm.
    pub width: f64,
    /// The cone's angle from its axis, rad: between 0 and a right angle.
    pub half_angle: f64,
}

impl ChamferSize {
    /// How far below an edge its chamfer ends on the wall, mm: infinite where the wall leans as the cone does.
    #[must_use]
    pub fn depth(&self, lean: f64) -> f64 {
        let turn = libm::tan(self.half_angle) - libm::tan(lean);
        if turn > 0.0 {
            self.width / turn
        } else {
            f64::INFINITY
        }
    }
}

impl ChamferEdge {
    /// Unit vector along it.
    #[must_use]
    pub fn along(&self) -> Vector {
        (self.ends[1] - self.ends[0]).normalize()
    }

    /// Its length, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    /// From a point of the edge to the ends of its chamfer there: on the level face, and on the wall, mm.
    #[must_use]
    pub fn lines(&self, size: ChamferSize) -> [Vector; 2] {
        let depth = size.depth(self.lean);
        let aside = -depth * libm::tan(self.lean);
        [size.width * self.inward, aside * self.inward - depth * Vector::z()]
    }

    /// Whether a point lies between the planes in which the chamfer ends.
    #[must_use]
    pub fn is_between_miters(&self, point: Vector) -> bool {
        (point - self.ends[0]).dot(&self.miters[0]) >= 0.0 && (point - self.ends[1]).dot(&self.miters[1]) <= 0.0
    }

    /// The corners of the slope, counterclockwise seen from outside, and whether its neighbours' leave it less than its width.
    fn slope(&self, size: ChamferSize) -> (Vec<Vector>, bool) {
        let along = self.along();
        let lines = self.lines(size);
        let on = |end: usize, offset: Vector| {
            let miter = self.miters[end];
            self.ends[end] + offset - along * (offset.dot(&miter) / along.dot(&miter))
        };
        let [top, low] = lines;
        let corners = [on(0, top), on(1, top), on(1, low), on(0, low)];
        let goes_on = |[from, to]: [usize; 2]| (corners[to] - corners[from]).dot(&along) > 0.0;
        let is_whole = goes_on([0, 1]) && goes_on([3, 2]);
        let mut slope = corners.to_vec();
        if !is_whole {
            // neighbours meet across it: what is between the planes in which it ends
            let far = along * (self.length() + FAR * lines.iter().map(|line| line.norm()).fold(0.0, f64::max));
            let [begin, end] = self.ends;
            slope = vec![begin + top - far, end + top + far, end + low + far, begin + low - far];
            slope = clipped(&slope, -self.miters[0], -self.miters[0].dot(&begin));
            slope = clipped(&slope, self.miters[1], self.miters[1].dot(&end));
        }
        if Vector::z().cross(&along).dot(&self.inward) > 0.0 {
            slope.reverse();
        }
        (slope, !is_whole)
    }

    /// The planes of its wedge.
    fn planes(&self, size: ChamferSize) -> [(Vector, f64); 5] {
        let (sin, cos) = libm::sincos(size.half_angle);
        let (start, end) = (self.ends[0], self.ends[1]);
        let at = |normal: Vector, point: Vector, beyond: f64| (normal, normal.dot(&point) + beyond);
        let wall = -self.inward * libm::cos(self.lean) + Vector::z() * libm::sin(self.lean);
        [
            at(self.inward * cos - Vector::z() * sin, start + size.width * self.inward, 0.0),
            at(Vector::z(), start, SAME),
            at(wall, start, TWISTED),
            at(-self.miters[0], start, 0.0),
            at(self.miters[1], end, 0.0),
        ]
    }

    /// The box around its wedge.
    fn bounds(&self, slope: &[Vector]) -> (Vector, Vector) {
        let [from, to] = self.ends;
        let ends = (from.inf(&to), from.sup(&to));
        let (low, high) = slope.iter().fold(ends, |(low, high), p| (low.inf(p), high.sup(p)));
        (low - Vector::repeat(TWISTED), high + Vector::repeat(TWISTED))
    }
}

/// Refuses chamfers that meet across the level face all around it: it would be gone.
///
/// # Errors
/// [`GeometryError::WideChamfer`].
pub fn check_chamfers(edges: &[ChamferEdge], size: ChamferSize) -> Result<(), GeometryError> {
    wedges(edges, size).map(drop)
}

/// The mesh with its edges chamfered. Its triangles have the faces that they had; slopes have that of 0.
///
/// # Errors
/// [`GeometryError::WideChamfer`] where chamfers meet across the level face all around it.
pub fn chamfered(mesh: &Mesh, edges: &[ChamferEdge], size: ChamferSize) -> Result<Mesh, GeometryError> {
    let wedges = wedges(edges, size)?;
    let boxes = wedges.iter().enumerate().map(|(number, wedge)| {
        let (low, high) = wedge.bounds;
        GeomWithData::new(Rectangle::from_corners(low.into(), high.into()), number)
    });
    let tree: RTree<GeomWithData<Rectangle<[f64; 3]>, usize>> = RTree::bulk_load(boxes.collect());
    // what is left of a polygon, by the wedges but its own
    let left = |polygon: Vec<Vector>, own: Option<usize>| {
        let first = polygon.first().copied().unwrap_or_default();
        let (low, high) = polygon.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        let around = AABB::from_corners(low.into(), high.into());
        let mut near: Vec<usize> = tree.locate_in_envelope_intersecting(around).map(|found| found.data).collect();
        near.sort_unstable();
        let others = near.into_iter().filter(|number| Some(*number) != own).filter_map(|number| wedges.get(number));
        others.fold(vec![polygon], |polygons, wedge| {
            polygons.into_iter().flat_map(|polygon| without(polygon, wedge)).collect::<Vec<_>>()
        })
    };
    let mut pieces: Vec<([Vector; 3], u32)> = Vec::with_capacity(mesh.triangles().len() + 2 * edges.len());
    let mut take = |polygons: Vec<Vec<Vector>>, face: u32| {
        pieces.extend(polygons.iter().flat_map(|polygon| fan(polygon)).map(|corners| (corners, face)));
    };
    for triangle in 0..mesh.triangles().len() {
        let face = mesh.faces().get(triangle).copied().unwrap_or(0);
        take(left(mesh.corners(triangle).to_vec(), None), face);
    }
    for (number, wedge) in wedges.iter().enumerate().filter(|(_, wedge)| wedge.slope.len() > 2) {
        take(left(wedge.slope.clone(), Some(number)), 0);
    }
    let vertices = pieces.iter().flat_map(|(corners, _)| *corners).collect();
    let triangles: Vec<[i64; 3]> = (0..pieces.len() as i64).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let faces: Vec<u32> = pieces.iter().map(|(_, face)| *face).collect();
    Mesh::new(vertices, &triangles, &faces)
}

/// What is taken off at an edge.
struct Wedge {
    /// The box around it.
    bounds: (Vector, Vector),
    /// Half spaces whose common part it is: normals outwards, and what their points reach along them at most, mm.
    planes: [(Vector, f64); 5],
    /// The corners of what is put in its place.
    slope: Vec<Vector>,
}

fn wedges(edges: &[ChamferEdge], size: ChamferSize) -> Result<Vec<Wedge>, GeometryError> {
    let mut turned = 0.0;
    let wedge = |edge: &ChamferEdge| {
        let (slope, is_cut) = edge.slope(size);
        // how far those turn in a row of which neighbours leave less than their width
        turned = if is_cut { turned + libm::acos(edge.miters[0].dot(&edge.miters[1]).clamp(-1.0, 1.0)) } else { 0.0 };
        if turned > AROUND {
            return Err(GeometryError::WideChamfer { at: edge.ends[0].into() });
        }
        Ok(Wedge { bounds: edge.bounds(&slope), planes: edge.planes(size), slope })
    };
    edges.iter().map(wedge).collect()
}

fn meets((low, high): (Vector, Vector), corners: &[Vector]) -> bool {
    (0..3).all(|axis| {
        corners.iter().any(|corner| corner[axis] <= high[axis])
            && corners.iter().any(|corner| corner[axis] >= low[axis])
    })
}

/// A convex polygon without what of it lies inside of all planes, in convex pieces.
fn without(polygon: Vec<Vector>, wedge: &Wedge) -> Vec<Vec<Vector>> {
    if !meets(wedge.bounds, &polygon) {
        return vec![polygon];
    }
    let (mut inside, mut outside) = (polygon.clone(), Vec::new());
    for (normal, reach) in &wedge.planes {
        // what lies in the plane is inside
        if inside.iter().any(|point| normal.dot(point) - reach > EXACT) {
            let over = clipped(&inside, -*normal, -reach);
            inside = clipped(&inside, *normal, *reach);
            if area(&over) > NOTHING {
                outside.push(over);
            }
        }
        if area(&inside) <= NOTHING {
            return vec![polygon]; // whole, and not in the pieces that the planes make of it
        }
    }
    outside
}

/// The part of a convex polygon that reaches no farther along a normal.
fn clipped(polygon: &[Vector], normal: Vector, reach: f64) -> Vec<Vector> {
    let over = |point: &Vector| normal.dot(point) - reach;
    let next = polygon.iter().cycle().skip(1);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (a, b) in polygon.iter().zip(next) {
        let (from, to) = (over(a), over(b));
        if from <= 0.0 {
            kept.push(*a);
        }
        if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
            kept.push(a + (b - a) * (from / (from - to)));
        }
    }
    kept
}

fn area(polygon: &[Vector]) -> f64 {
    fan(polygon).map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm()).sum()
}

/// A convex polygon in triangles.
fn fan(polygon: &[Vector]) -> impl Iterator<Item = [Vector; 3]> + '_ {
    let first = polygon.first().copied().unwrap_or_default();
    polygon.windows(2).skip(1).filter_map(move |pair| match pair {
        [b, c] => Some([first, *b, *c]),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: ChamferSize = ChamferSize { width: 1.0, half_angle: std::f64::consts::FRAC_PI_4 };

    /// The box from the origin to 10, 8, 6 mm, all of whose upper edges are chamfered.
    fn cuboid(size: ChamferSize) -> (Mesh, Vec<ChamferEdge>) {
        let (x, y, z) = (10.0, 8.0, 6.0);
        let corner = |i: usize| {
            Vector::new(
                if i & 1 > 0 { x } else { 0.0 },
                if i & 2 > 0 { y } else { 0.0 },
                if i & 4 > 0 { z } else { 0.0 },
            )
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
        let triangles: Vec<[i64; 3]> = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let mesh = Mesh::new((0..8).map(corner).collect(), &triangles, &[]).unwrap();
        let ring = [4, 5, 7, 6];
        let along = |i: usize| (corner(ring[(i + 1) % 4]) - corner(ring[i % 4])).normalize();
        let edge = |i: usize| ChamferEdge {
            ends: [corner(ring[i]), corner(ring[(i + 1) % 4])],
            inward: Vector::z().cross(&along(i)),
            lean: 0.0,
            miters: [(along(i + 3) + along(i)).normalize(), (along(i) + along(i + 1)).normalize()],
        };
        let edges: Vec<ChamferEdge> = (0..4).map(edge).collect();
        assert!(size.depth(0.0) < z);
        (mesh, edges)
    }

    fn volume(mesh: &Mesh) -> f64 {
        let of = |triangle| {
            let [a, b, c] = mesh.corners(triangle);
            a.dot(&b.cross(&c)) / 6.0
        };
        (0..mesh.triangles().len()).map(of).sum()
    }

    #[test]
    fn a_box_loses_a_wedge_at_each_edge_and_stays_whole() {
        for (width, half_angle) in [(1.0, 45.0_f64), (0.2, 30.0), (2.0, 60.0)] {
            let size = ChamferSize { width, half_angle: half_angle.to_radians() };
            let (mesh, edges) = cuboid(size);
            let found = chamfered(&mesh, &edges, size).unwrap();
            let depth = width / size.half_angle.tan();
            // a frustum of a pyramid on the rest of the box
            let [inner, outer] = [(10.0 - 2.0 * width) * (8.0 - 2.0 * width), 80.0];
            let middle = (10.0 - width) * (8.0 - width);
            let expected = 80.0 * (6.0 - depth) + depth * (inner + 4.0 * middle + outer) / 6.0;
            assert!((volume(&found) - expected).abs() < 1e-9, "{width}: {} {expected}", volume(&found));
            assert!((volume(&mesh) - 480.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_leaning_wall_meets_the_chamfer_farther_down() {
        let size = SIZE;
        assert!((size.depth(0.0) - 1.0).abs() < 1e-12);
        assert!((size.depth(libm::atan(0.5)) - 2.0).abs() < 1e-12);
        assert!(size.depth(std::f64::consts::FRAC_PI_4).is_infinite());
        let (_, edges) = cuboid(size);
        let leaning = ChamferEdge { lean: libm::atan(0.5), ..edges[0] };
        let [top, low] = leaning.lines(size);
        assert!(
            (top - Vector::new(0.0, 1.0, 0.0)).norm() < 1e-12 && (low - Vector::new(0.0, -1.0, -2.0)).norm() < 1e-12
        );
    }

    #[test]
    fn chamfers_of_a_narrow_rib_meet_in_a_ridge() {
        let (mesh, edges) = cuboid(SIZE);
        // of 8 mm between the long edges, chamfers of 5 mm overlap on 2 mm, and the triangle there is taken off once
        let open = |edge: &ChamferEdge| ChamferEdge { miters: [edge.along(); 2], ..*edge };
        let long = [open(&edges[0]), open(&edges[2])];
        let found = chamfered(&mesh, &long, ChamferSize { width: 5.0, ..SIZE }).unwrap();
        assert!((volume(&found) - 10.0 * (48.0 - 25.0 + 1.0)).abs() < 1e-9, "{}", volume(&found));
    }

    #[test]
    fn an_edge_shorter_than_its_neighbours_chamfers_take_is_cut_off_by_them() {
        let (mesh, edges) = cuboid(SIZE);
        let size = ChamferSize { width: 4.5, ..SIZE };
        // a hip roof: two slopes of 4.5 mm over 8 mm meet in a ridge at 4 mm
        let found = chamfered(&mesh, &edges, size).unwrap();
        let ridge = 10.0 - 8.0;
        let roof = 8.0 * 4.0 * (2.0 * 10.0 + ridge) / 6.0;
        assert!((volume(&found) - (80.0 * 1.5 + roof)).abs() < 1e-9, "{}", volume(&found));
    }

    #[test]
    fn a_boss_that_would_be_gone_is_an_error() {
        let (mesh, _) = cuboid(SIZE);
        let corner = |i: usize| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / 24.0);
            Vector::new(3.0 * cos, 3.0 * sin, 6.0)
        };
        let along = |i: usize| (corner(i + 1) - corner(i)).normalize();
        let edge = |i: usize| ChamferEdge {
            ends: [corner(i), corner(i + 1)],
            inward: Vector::z().cross(&along(i)),
            lean: 0.0,
            miters: [(along(i + 23) + along(i)).normalize(), (along(i) + along(i + 1)).normalize()],
        };
        let edges: Vec<ChamferEdge> = (0..24).map(edge).collect();
        assert!(chamfered(&mesh, &edges, ChamferSize { width: 2.9, ..SIZE }).is_ok());
        let error = chamfered(&mesh, &edges, ChamferSize { width: 3.1, ..SIZE }).unwrap_err();
        assert!(matches!(error, GeometryError::WideChamfer { .. }), "{error}");
    }
}

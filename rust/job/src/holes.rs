//! Round upright holes of the part: where they are, how wide, how deep, and whether they go through.
//!
//! Every vertex of a hole's wall lies on its circle, for meshing puts them there; the circle is fitted to them by least squares
//! (I. Kasa, "A circle fitting procedure and its error analysis", IEEE Transactions on Instrumentation and Measurement 25, 1976).

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::Matrix3;
use styluscam_geometry::{Bvh, Mesh, Vector};

use crate::body::Rays;
use crate::Scene;

/// How far vertices lie off the circle at most, mm.
const ROUND: f64 = 0.01;
/// The widest facet of a wall, rad: chords of wider ones are off the circle by more than 2 percent of its radius.
const WIDEST: f64 = 0.41;
/// Axes, radii and ends that differ by less are the same, mm.
const SAME: f64 = 0.01;
/// Where the bottom is looked at: on a circle of this share of the hole's radius.
const RING: f64 = 0.9;
/// Positions on it.
const RAYS: usize = 8;
/// How far beside the axis the floor is looked for, mm: on it edges of triangles meet.
const BESIDE: f64 = 1e-4;
/// How far under the wall's end a floor lies there at most, as a share of the radius: a cone of 50 degrees does.
const FLOOR: f64 = 0.25;

/// A round upright hole, work coordinates, mm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Hole {
    /// Its wall's faces.
    pub faces: Vec<u32>,
    /// Its axis in plan.
    pub at: [f64; 2],
    /// Radius.
    pub radius: f64,
    /// Where its wall begins and ends.
    pub top: f64,
    pub bottom: f64,
    /// Height of its floor at the axis; none where it goes through.
    pub floor: Option<f64>,
    /// The greatest height of its floor at the axis and beside the wall; none where it goes through.
    pub floor_top: Option<f64>,
    /// How far its wall's triangles, which are chords, lie inside of the circle at most.
    pub chord: f64,
}

impl Hole {
    /// The diameter, mm.
    pub fn diameter(&self) -> f64 {
        2.0 * self.radius
    }

    /// Whether another hole lies above or below on the same axis, as in the knuckles of a hinge: a tool that goes down the lower one comes
    /// through the upper.
    fn goes_on_in(&self, other: &Self) -> bool {
        let apart = libm::hypot(self.at[0] - other.at[0], self.at[1] - other.at[1]);
        let upper = if self.bottom > other.bottom { self } else { other };
        apart <= SAME && (self.radius - other.radius).abs() <= SAME && upper.floor.is_none()
    }

    fn join(&mut self, other: Self) {
        if other.bottom < self.bottom {
            (self.floor, self.floor_top) = (other.floor, other.floor_top);
        }
        self.faces.extend(other.faces);
        self.radius = self.radius.min(other.radius);
        self.top = self.top.max(other.top);
        self.bottom = self.bottom.min(other.bottom);
        self.chord = self.chord.max(other.chord);
    }

    /// "Face7", "Face7 and Face8".
    pub fn name(&self) -> String {
        self.faces.iter().map(|face| format!("Face{face}")).collect::<Vec<_>>().join(" and ")
    }
}

/// The holes among some faces, in the order of their lowest faces; faces that are no wall of one are left out, as are holes that
/// are covered from above.
pub(crate) fn holes_among((mesh, bvh): (&Mesh, &Bvh), faces: &[u32]) -> Vec<Hole> {
    let mut triangles: BTreeMap<u32, Vec<usize>> = faces.iter().map(|face| (*face, Vec::new())).collect();
    for (triangle, face) in mesh.faces().iter().enumerate() {
        triangles.entry(*face).and_modify(|of| of.push(triangle));
    }
    let mut walls: Vec<Wall> = Vec::new();
    for (face, triangles) in &triangles {
        let Some(wall) = Wall::of(mesh, *face, triangles) else { continue };
        match walls.iter_mut().find(|known| known.goes_on_in(&wall)) {
            Some(known) => known.join(wall),
            None => walls.push(wall),
        }
    }
    let rays = Rays::new(mesh, bvh);
    let mut holes: Vec<Hole> = Vec::new();
    for hole in walls.into_iter().filter(Wall::is_whole).filter_map(|wall| wall.hole(&rays)) {
        match holes.iter_mut().find(|known| known.goes_on_in(&hole)) {
            Some(known) => known.join(hole),
            None => holes.push(hole),
        }
    }
    holes
}

/// Whether a face is the wall of a round hole whose axis is not upright: its axis' angle from the vertical, rad.
pub(crate) fn leaning_hole(scene: &Scene, face: u32) -> Option<f64> {
    let mesh = &scene.mesh;
    let of_face = || (0..mesh.triangles().len()).filter(|triangle| mesh.faces().get(*triangle) == Some(&face));
    // normals of a cylinder are across its axis: the direction in which they spread least
    let spread = of_face().fold(Matrix3::<f64>::zeros(), |sum, triangle| {
        let normal = mesh.model_normal(triangle);
        sum + normal * normal.transpose() * mesh.area(triangle)
    });
    let eigen = spread.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let [least, middle, most] = order.map(|i| eigen.eigenvalues[i]);
    let is_round = least <= FLAT * most && middle >= EVEN * most;
    let axis: Vector = eigen.eigenvectors.column(order[0]).into_owned();
    let (sum, area) = of_face().fold((Vector::zeros(), 0.0), |(sum, area), triangle| {
        let own = mesh.area(triangle);
        (sum + mesh.corners(triangle).iter().sum::<Vector>() * (own / 3.0), area + own)
    });
    let centre = sum / area;
    let inwards: f64 = of_face().map(|t| (centre - mesh.corners(t)[0]).dot(&mesh.model_normal(t)).signum()).sum();
    (is_round && inwards > 0.0).then(|| libm::acos(axis.z.abs().min(1.0)))
}

/// Normals of a cylinder along its axis, and the evenness of those across it: shares of their spread.
const FLAT: f64 = 1e-3;
const EVEN: f64 = 0.5;

/// An upright concave wall about an axis.
struct Wall {
    faces: Vec<u32>,
    at: [f64; 2],
    radius: f64,
    top: f64,
    bottom: f64,
    /// Directions of its vertices from the axis, rad.
    bearings: Vec<f64>,
}

impl Wall {
    fn of(mesh: &Mesh, face: u32, triangles: &[usize]) -> Option<Self> {
        if triangles.is_empty() || !triangles.iter().all(|triangle| mesh.is_upright(*triangle)) {
            return None;
        }
        let points: Vec<Vector> = triangles.iter().flat_map(|triangle| mesh.corners(*triangle)).collect();
        let (at, radius) = circle(&points)?;
        let off = |p: &Vector| (libm::hypot(p.x - at[0], p.y - at[1]) - radius).abs();
        let faces_axis = |triangle: &usize| {
            let (corner, normal) = (mesh.corners(*triangle)[0], mesh.normal(*triangle));
            normal.x * (at[0] - corner.x) + normal.y * (at[1] - corner.y) > 0.0
        };
        if !points.iter().all(|point| off(point) <= ROUND) || !triangles.iter().all(faces_axis) {
            return None;
        }
        let heights = || points.iter().map(|point| point.z);
        Some(Self {
            faces: vec![face],
            at,
            radius,
            top: heights().fold(f64::NEG_INFINITY, f64::max),
            bottom: heights().fold(f64::INFINITY, f64::min),
            bearings: points.iter().map(|p| libm::atan2(p.y - at[1], p.x - at[0])).collect(),
        })
    }

    fn goes_on_in(&self, other: &Self) -> bool {
        let apart = libm::hypot(self.at[0] - other.at[0], self.at[1] - other.at[1]);
        let touch = self.bottom <= other.top + SAME && other.bottom <= self.top + SAME;
        apart <= SAME && (self.radius - other.radius).abs() <= SAME && touch
    }

    fn join(&mut self, other: Self) {
        self.faces.extend(other.faces);
        self.top = self.top.max(other.top);
        self.bottom = self.bottom.min(other.bottom);
        self.bearings.extend(other.bearings);
    }

    /// Whether it goes all the way around.
    fn is_whole(&self) -> bool {
        self.widest() <= WIDEST
    }

    /// Its widest facet, rad.
    fn widest(&self) -> f64 {
        let mut bearings = self.bearings.clone();
        bearings.sort_by(f64::total_cmp);
        let around = bearings.first().zip(bearings.last()).map_or(TAU, |(first, last)| TAU - (last - first));
        bearings.windows(2).map(|pair| pair[1] - pair[0]).fold(around, f64::max)
    }

    fn hole(self, rays: &Rays<'_>) -> Option<Hole> {
        let [x, y] = self.at;
        let ring = |share: f64, z: f64| {
            (0..RAYS).map(move |i| {
                let (sin, cos) = libm::sincos(TAU * (i as f64 + 0.5) / RAYS as f64);
                Vector::new(x + share * cos, y + share * sin, z)
            })
        };
        let within = RING * self.radius;
        let middle = 0.5 * (self.top + self.bottom);
        let covered = |start: Vector| rays.first(start, Vector::z(), 0.0, |_| true).is_some();
        if ring(within, middle).any(covered) {
            return None;
        }
        let below = |start: Vector| rays.first(start, -Vector::z(), 0.0, |_| true).map(|hit| middle - hit.distance);
        let is_floor = |z: f64| z >= self.bottom - FLOOR * self.radius;
        let beside_wall = ring(within, middle).filter_map(below).filter(|z| is_floor(*z)).reduce(f64::max);
        let floor = ring(BESIDE, middle).filter_map(below).fold(f64::NEG_INFINITY, f64::max);
        // under a shoulder a narrower hole goes on
        let floor = if floor.is_finite() && floor >= self.bottom - 2.0 * self.radius { floor } else { self.bottom };
        let chord = self.radius * (1.0 - libm::cos(0.5 * self.widest()));
        Some(Hole {
            faces: self.faces,
            at: self.at,
            radius: self.radius,
            top: self.top,
            bottom: self.bottom,
            floor: beside_wall.map(|_| floor),
            floor_top: beside_wall.map(|z| z.max(floor)),
            chord,
        })
    }
}

/// The circle in plan through points, as good as it can be: its centre and radius; none where they lie on a line.
fn circle(points: &[Vector]) -> Option<([f64; 2], f64)> {
    let count = points.len() as f64;
    let mean = points.iter().sum::<Vector>() / count;
    let [mut uu, mut uv, mut vv, mut u3, mut v3] = [0.0; 5];
    for point in points {
        let (u, v) = (point.x - mean.x, point.y - mean.y);
        let square = u * u + v * v;
        uu += u * u;
        uv += u * v;
        vv += v * v;
        u3 += 0.5 * u * square;
        v3 += 0.5 * v * square;
    }
    let det = uu * vv - uv * uv;
    if det <= 1e-12 * (uu + vv) * (uu + vv) {
        return None;
    }
    let (x, y) = ((u3 * vv - v3 * uv) / det, (v3 * uu - u3 * uv) / det);
    let radius = (x * x + y * y + (uu + vv) / count).sqrt();
    Some(([mean.x + x, mean.y + y], radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: usize, share: f64) -> Vec<Vector> {
        let at = |i: usize| libm::sincos(share * TAU * i as f64 / count as f64);
        (0..count).map(at).map(|(sin, cos)| Vector::new(3.0 + 2.5 * cos, -7.0 + 2.5 * sin, 0.1)).collect()
    }

    #[test]
    fn the_circle_is_that_of_the_points_though_they_are_on_an_arc() {
        for share in [1.0, 0.3] {
            let ([x, y], radius) = circle(&points(40, share)).unwrap();
            assert!((x - 3.0).abs() + (y + 7.0).abs() + (radius - 2.5).abs() < 1e-9, "{x} {y} {radius}");
        }
        assert_eq!(circle(&[Vector::zeros(), Vector::x(), Vector::x() * 2.0]), None);
    }

    #[test]
    fn a_wall_is_whole_only_all_the_way_around_in_narrow_facets() {
        let wall = |count: usize, share: f64| Wall {
            faces: vec![1],
            at: [3.0, -7.0],
            radius: 2.5,
            top: 1.0,
            bottom: 0.0,
            bearings: points(count, share).iter().map(|p| libm::atan2(p.y + 7.0, p.x - 3.0)).collect(),
        };
        assert!(wall(16, 1.0).is_whole());
        assert!(!wall(6, 1.0).is_whole(), "a hexagon");
        assert!(!wall(200, 0.5).is_whole(), "the end of a slot");
        let mut halves = wall(200, 0.5);
        halves.join(Wall { bearings: wall(200, 0.5).bearings.iter().map(|b| -b).collect(), ..wall(200, 0.5) });
        assert!(halves.is_whole());
    }

    #[test]
    fn holes_on_one_axis_are_one_where_the_upper_goes_through() {
        let hole = |faces: &[u32], [bottom, top]: [f64; 2], floor: Option<f64>| Hole {
            faces: faces.to_vec(),
            at: [3.0, -7.0],
            radius: 2.5,
            top,
            bottom,
            floor,
            floor_top: floor,
            chord: 0.0,
        };
        let (upper, lower) = (hole(&[1], [5.0, 9.0], None), hole(&[2], [-4.0, 1.0], Some(-4.0)));
        assert!(upper.goes_on_in(&lower) && lower.goes_on_in(&upper));
        assert!(!hole(&[1], [5.0, 9.0], Some(5.0)).goes_on_in(&lower), "a blind hole above another");
        assert!(!Hole { radius: 2.0, ..upper.clone() }.goes_on_in(&lower), "a narrower one");
        for (mut joined, other, faces) in [(upper.clone(), lower.clone(), [1, 2]), (lower, upper, [2, 1])] {
            joined.join(other);
            assert_eq!(joined, hole(&faces, [-4.0, 9.0], Some(-4.0)));
        }
    }
}

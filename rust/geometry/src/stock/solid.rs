//! A closed body: its triangles, joined and wound outward.

use crate::stock::slab;
use crate::{Bvh, GeometryError, Mesh, Node, Soup, Vector};

/// A closed body.
#[derive(Clone, Debug)]
pub struct Solid {
    mesh: Mesh,
    bvh: Bvh,
}

impl Solid {
    /// The body of which a mesh is the surface: corners of triangles that meet are joined, and triangles turned outward.
    ///
    /// # Errors
    /// `NotClosed`; what makes no mesh.
    pub fn new(mesh: &Mesh) -> Result<Self, GeometryError> {
        let triangles: Vec<[i64; 3]> = mesh.triangles().iter().map(|triangle| triangle.map(i64::from)).collect();
        let soup = Soup::new(mesh.vertices(), &triangles)?;
        if let Some(at) = soup.mending.unclear.or_else(|| soup.gap()) {
            return Err(GeometryError::NotClosed { at });
        }
        let triangles: Vec<[i64; 3]> = soup.triangles.iter().map(|triangle| triangle.map(i64::from)).collect();
        let mesh = Mesh::new(soup.vertices, &triangles, &[])?;
        Ok(Self { bvh: Bvh::new(&mesh), mesh })
    }

    /// Its surface, wound outward.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The outlines of all that lies between two heights, from the upper one, as seen from above; points (x, y, 0), holes are outlines within
    /// outlines.
    #[must_use]
    pub fn outlines_between(&self, heights: [f64; 2]) -> Vec<Vec<[f64; 3]>> {
        let outlines = slab::outlines(&self.mesh, heights).into_iter();
        outlines.map(|outline| outline.into_iter().map(|[x, y]| [x, y, 0.0]).collect()).collect()
    }

    /// A point's distance from its surface, mm.
    #[must_use]
    pub fn distance(&self, point: Vector) -> f64 {
        (self.bvh.nearest(&self.mesh, point).0 - point).norm()
    }

    /// Whether a point lies in it, or no farther from it than some mm.
    #[must_use]
    pub fn holds(&self, point: Vector, within: f64) -> bool {
        self.distance(point) <= within || self.heights_over(point).filter(|z| *z > point.z).count() % 2 == 1
    }

    /// Height of its upper side at a position in plan, mm; none beside it.
    #[must_use]
    pub fn height_at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        self.heights_over(Vector::new(x, y, 0.0)).reduce(f64::max)
    }

    /// Where the upright line through a point meets the surface: what two triangles share it meets once.
    pub(super) fn heights_over(&self, point: Vector) -> impl Iterator<Item = f64> {
        let is_over = |node: &Node| {
            (node.low.x..=node.high.x).contains(&point.x) && (node.low.y..=node.high.y).contains(&point.y)
        };
        let bound = |node: &Node| if is_over(node) { 0.0 } else { f64::NEG_INFINITY };
        let mut heights = Vec::new();
        self.bvh.maximise(f64::NEG_INFINITY, bound, |triangle, _| {
            heights.extend(height_over(self.mesh.corners(triangle as usize), point));
            f64::NEG_INFINITY
        });
        heights.into_iter()
    }
}

/// Height of a triangle over a point in plan, mm; none where it does not lie there.
fn height_over(corners: [Vector; 3], point: Vector) -> Option<f64> {
    let [a, b, c] = corners;
    let crosses = [[a, b], [b, c], [c, a]].into_iter().filter(|ends| is_left_of(*ends, point)).count();
    let normal = (b - a).cross(&(c - a));
    (crosses % 2 == 1).then(|| a.z - ((point.x - a.x) * normal.x + (point.y - a.y) * normal.y) / normal.z)
}

/// Whether a side crosses the ray from a point along X in plan: the same from both its triangles.
fn is_left_of([a, b]: [Vector; 2], point: Vector) -> bool {
    let [low, high] = if (a.y, a.x) < (b.y, b.x) { [a, b] } else { [b, a] };
    let crosses = low.y <= point.y && point.y < high.y;
    crosses && low.x + (high.x - low.x) * ((point.y - low.y) / (high.y - low.y)) > point.x
}

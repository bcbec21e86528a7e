//! Rays against a mesh (Moeller and Trumbore, 1997), through the index of its boxes.

use styluscam_geometry::{Bvh, Mesh, Node, Vector};

/// Barycentric slack: a ray through an edge meets at least one of its triangles.
const EDGE: f64 = 1e-9;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Along the ray, mm.
    pub distance: f64,
    /// Cosine between the ray and the triangle's normal: positive where the ray leaves the material.
    pub along: f64,
    /// The triangle.
    pub triangle: u32,
}

/// A mesh and its index.
pub struct Rays<'a> {
    pub mesh: &'a Mesh,
    pub bvh: &'a Bvh,
}

impl<'a> Rays<'a> {
    pub fn new(mesh: &'a Mesh, bvh: &'a Bvh) -> Self {
        Self { mesh, bvh }
    }

    /// The nearest triangle from `start` on along the unit vector `direction`, farther than `from` mm, of those that `counts` takes.
    pub fn first(&self, start: Vector, direction: Vector, from: f64, counts: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        let inverse = direction.map(|x| 1.0 / x);
        let bound = |node: &Node| -entry(node, start, inverse);
        self.bvh.maximise(f64::NEG_INFINITY, bound, |triangle, best| {
            let hit = self.hit(triangle, start, direction).filter(|hit| hit.distance > from && counts(hit));
            match hit {
                Some(hit) if -hit.distance > best => {
                    nearest = Some(hit);
                    -hit.distance
                }
                Some(_) | None => best,
            }
        });
        nearest
    }

    /// All that the whole line meets, from one end to the other; twice at one point counts once.
    pub fn line(&self, through: Vector, direction: Vector, fine: f64) -> Vec<Hit> {
        let mut hits = Vec::new();
        let inverse = direction.map(|x| 1.0 / x);
        let bound = |node: &Node| if crossed(node, through, inverse) { 0.0 } else { f64::NEG_INFINITY };
        self.bvh.maximise(f64::NEG_INFINITY, bound, |triangle, _| {
            hits.extend(self.hit(triangle, through, direction));
            f64::NEG_INFINITY
        });
        hits.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.triangle.cmp(&b.triangle)));
        hits.dedup_by(|b, a| b.distance - a.distance < fine && (a.along > 0.0) == (b.along > 0.0));
        hits
    }

    fn hit(&self, triangle: u32, start: Vector, direction: Vector) -> Option<Hit> {
        let [a, b, c] = self.mesh.corners(triangle as usize);
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(&ac);
        let away = start - a;
        let across = away.cross(&direction);
        let fall = -direction.dot(&normal);
        if fall == 0.0 {
            return None;
        }
        let (u, v) = (ac.dot(&across) / fall, -ab.dot(&across) / fall);
        let inside = u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE;
        let along = -fall / normal.norm();
        inside.then_some(Hit { distance: away.dot(&normal) / fall, along, triangle })
    }
}

/// Where the line enters and leaves a box, mm.
fn slab(node: &Node, start: Vector, inverse: Vector) -> (f64, f64) {
    let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let a = (node.low[axis] - start[axis]) * inverse[axis];
        let b = (node.high[axis] - start[axis]) * inverse[axis];
        // 0 times infinity: the ray runs in the face of the box, which is inside
        enters = enters.max(if a.is_nan() || b.is_nan() { f64::NEG_INFINITY } else { a.min(b) });
        leaves = leaves.min(if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) });
    }
    (enters, leaves)
}

/// Distance at which the ray enters a box, infinite where it does not.
fn entry(node: &Node, start: Vector, inverse: Vector) -> f64 {
    let (enters, leaves) = slab(node, start, inverse);
    // boxes of flat triangles have no depth: the arithmetic's last bits must not miss them
    if enters.max(0.0) <= leaves + 1e-9 * (1.0 + leaves.abs()) {
        enters.max(0.0)
    } else {
        f64::INFINITY
    }
}

fn crossed(node: &Node, start: Vector, inverse: Vector) -> bool {
    let (enters, leaves) = slab(node, start, inverse);
    enters <= leaves + 1e-9 * (1.0 + leaves.abs())
}

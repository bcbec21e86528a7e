//! The index of a mesh: a binary tree of boxes, each with a plane over what it holds.
//!
//! A node keeps the mean gradient of its triangles and the height of a plane of that gradient over all their points; a
//! search prunes by that plane and by the box.

use rayon::prelude::*;

use crate::{Mesh, Vector};

/// Triangles in a leaf at most: below four the boxes cost more than the triangles they save.
const LEAF: usize = 4;
/// Subtrees larger than this are built in parallel.
const PARALLEL: usize = 4096;
/// Steepest gradient taken into a node's mean: a wall would otherwise rule it.
const STEEPEST: f64 = 20.0;

/// A box of triangles.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Lower corner.
    pub low: Vector,
    /// Upper corner.
    pub high: Vector,
    /// Gradient dz/dx, dz/dy of the plane over the node's points.
    pub gradient: [f64; 2],
    /// The plane's height over the middle of the box: no point of the node is above it.
    pub lift: f64,
    /// First entry of [`Bvh::order`] for a leaf; index of the second child for an inner node (the first follows it).
    start: u32,
    /// Triangles of a leaf; 0 for an inner node.
    count: u32,
}

impl Node {
    /// Middle of the box in plan.
    #[inline]
    #[must_use]
    pub fn middle(&self) -> [f64; 2] {
        [0.5 * (self.low.x + self.high.x), 0.5 * (self.low.y + self.high.y)]
    }

    /// Whether a point lies in the box.
    #[inline]
    #[must_use]
    pub fn holds(&self, point: Vector) -> bool {
        let (low, high) = (self.low, self.high);
        (low.x..=high.x).contains(&point.x)
            && (low.y..=high.y).contains(&point.y)
            && (low.z..=high.z).contains(&point.z)
    }

    /// Square of a point's distance from the box, mm^2.
    #[inline]
    pub(super) fn distance_squared(&self, point: Vector) -> f64 {
        (self.low - point).sup(&(point - self.high)).sup(&Vector::zeros()).norm_squared()
    }
}

/// The index. Nodes stand in depth-first order.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

/// What a node needs to know of a triangle.
struct Item {
    triangle: u32,
    centre: [f64; 3],
    gradient: [f64; 2],
    weight: f64,
}

impl Bvh {
    /// Builds the index; the result does not depend on the number of threads.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let mut items: Vec<Item> = (0..mesh.triangles().len()).into_par_iter().map(|i| Item::of(mesh, i)).collect();
        let nodes = build(mesh, &mut items, 0);
        Self { nodes, order: items.iter().map(|i| i.triangle).collect() }
    }

    /// The triangles of a leaf near a point, found by going down to the nearer box: often the nearest ones, and if not, a point
    /// to begin at.
    #[must_use]
    pub fn near(&self, point: Vector) -> &[u32] {
        let mut index = 0;
        loop {
            let node = &self.nodes[index];
            if node.count > 0 {
                let start = node.start as usize;
                return &self.order[start..start + node.count as usize];
            }
            let (first, second) = (index + 1, node.start as usize);
            let further = self.nodes[second].distance_squared(point) < self.nodes[first].distance_squared(point);
            index = if further { second } else { first };
        }
    }

    /// Searches for the triangle of largest value, starting from `best`.
    ///
    /// `bound` is given a node and must not be below the value of any triangle in it (minus infinity: nothing there);
    /// `visit` is given a triangle and the best value so far and returns the better of the two. Of two
    /// children the one of the higher bound is entered first.
    pub fn maximise(
        &self,
        best: f64,
        mut bound: impl FnMut(&Node) -> f64,
        mut visit: impl FnMut(u32, f64) -> f64,
    ) -> f64 {
        let mut best = best;
        let mut stack = [(0_u32, f64::INFINITY); 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (index, limit) = stack[depth];
            if limit < best {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let start = node.start as usize;
                for triangle in &self.order[start..start + node.count as usize] {
                    best = visit(*triangle, best);
                }
                continue;
            }
            let (first, second) = (index + 1, node.start);
            let a = (first, bound(&self.nodes[first as usize]));
            let b = (second, bound(&self.nodes[second as usize]));
            let (near, far) = if a.1 >= b.1 { (a, b) } else { (b, a) };
            for child in [far, near] {
                // minus infinity is never worth a look, not even when nothing was found yet
                if child.1 >= best && child.1 > f64::NEG_INFINITY {
                    stack[depth] = child;
                    depth += 1;
                }
            }
        }
        best
    }
}

impl Item {
    fn of(mesh: &Mesh, i: usize) -> Self {
        let [a, b, c] = mesh.corners(i);
        let centre = (a + b + c) / 3.0;
        let normal = (b - a).cross(&(c - a));
        let steepness = libm::hypot(normal.x, normal.y);
        // in plan, where the tool looks from; walls keep their direction, but not their infinite gradient
        let scale = if normal.z.abs() * STEEPEST > steepness {
            -1.0 / normal.z
        } else {
            -STEEPEST / steepness * normal.z.signum()
        };
        Self {
            triangle: i as u32,
            centre: [centre.x, centre.y, centre.z],
            gradient: [normal.x * scale, normal.y * scale],
            weight: normal.z.abs(),
        }
    }
}

fn build(mesh: &Mesh, items: &mut [Item], first: u32) -> Vec<Node> {
    let node = cover(mesh, items);
    if items.len() <= LEAF {
        return vec![Node { start: first, count: items.len() as u32, ..node }];
    }
    let axis = longest_spread(items);
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        a.centre[axis].total_cmp(&b.centre[axis]).then(a.triangle.cmp(&b.triangle))
    });
    let (left, right) = items.split_at_mut(half);
    let second = first + half as u32;
    let (left, right) = if left.len() > PARALLEL {
        rayon::join(|| build(mesh, left, first), || build(mesh, right, second))
    } else {
        (build(mesh, left, first), build(mesh, right, second))
    };
    join(node, left, right)
}

/// Joins subtrees under `node`; inner nodes name their second child relative to themselves until here.
fn join(node: Node, left: Vec<Node>, right: Vec<Node>) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.push(Node { start: 1 + left.len() as u32, count: 0, ..node });
    let offset = 1 + left.len() as u32;
    nodes.extend(left.into_iter().map(|n| moved(n, 1)));
    nodes.extend(right.into_iter().map(|n| moved(n, offset)));
    nodes
}

fn moved(node: Node, by: u32) -> Node {
    if node.count == 0 {
        Node { start: node.start + by, ..node }
    } else {
        node
    }
}

/// The box of the items and a plane over them.
fn cover(mesh: &Mesh, items: &[Item]) -> Node {
    let infinite = Vector::repeat(f64::INFINITY);
    let (mut low, mut high) = (infinite, -infinite);
    let (mut gradient, mut weight) = ([0.0; 2], 0.0);
    for item in items {
        for corner in mesh.corners(item.triangle as usize) {
            low = low.inf(&corner);
            high = high.sup(&corner);
        }
        gradient = [gradient[0] + item.gradient[0] * item.weight, gradient[1] + item.gradient[1] * item.weight];
        weight += item.weight;
    }
    let gradient = if weight > 0.0 { gradient.map(|g| g / weight) } else { [0.0; 2] };
    let mut node = Node { low, high, gradient, lift: f64::NEG_INFINITY, start: 0, count: 0 };
    let [x, y] = node.middle();
    for item in items {
        for corner in mesh.corners(item.triangle as usize) {
            let height = corner.z - gradient[0] * (corner.x - x) - gradient[1] * (corner.y - y);
            node.lift = node.lift.max(height);
        }
    }
    node
}

fn longest_spread(items: &[Item]) -> usize {
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for item in items {
        for (r, c) in range.iter_mut().zip(item.centre) {
            *r = [r[0].min(c), r[1].max(c)];
        }
    }
    // tools look from above: height separates best only where plan does not
    let spread = [range[0][1] - range[0][0], range[1][1] - range[1][0], 0.5 * (range[2][1] - range[2][0])];
    (0..3).max_by(|a, b| spread[*a].total_cmp(&spread[*b])).unwrap_or(0)
}

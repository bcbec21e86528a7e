//! Which edges and corners of a mesh a drop-cutter must try, and whose they are.
//!
//! An edge between two facets that meet in a valley can carry no contact that a facet does not carry as well, and is left
//! out; so is one below an upright facet, for what stands over it in plan is higher. Every other edge is tried once, by the
//! first triangle that has it; every corner likewise. Between two facets in one plane it depends on the tool: where it
//! touches both at the same point, the edge is left out as well.

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::Watch;

use super::index::{Triangles, BATCH};
use super::normal;

/// Bit i: the edge from corner i to the next one is this triangle's to try; bit 3 + i: corner i is; bit 6 + i: the edge is,
/// should the tool touch the facets on its two sides, which lie in one plane but for rounding, at different points.
pub type Owned = u16;

/// All edges and corners.
pub const ALL: Owned = 0b11_1111;

/// Of [`Owned`], the bit of an edge in a plane.
pub const fn in_plane(edge: usize) -> Owned {
    1 << (6 + edge)
}

/// The triangle on the other side of each edge, or [`NO_NEIGHBOUR`] at borders and where more than two meet.
pub type Neighbours = [u32; 3];

/// No single triangle lies beyond the edge.
pub const NO_NEIGHBOUR: u32 = u32::MAX;

/// Two facets lie in one plane up to this height of one over or under the other's plane, relative to size.
const ROUNDING: f64 = 1e-12;
/// A facet stands upright when its normal rises by less: over its height it leans by less than counts as rounding.
const UPRIGHT: f64 = 1e-13;

/// Ownership and neighbours of all triangles; `firsts` marks for each which corners no triangle before it has. Not
/// all of them when `watch` is cancelled.
pub fn of(triangles: &Triangles, firsts: &[u8], watch: &Watch) -> (Vec<Owned>, Vec<Neighbours>) {
    let neighbours = neighbours(triangles, watch);
    let mut owned = Vec::with_capacity(firsts.len());
    for batch in watch.batches(firsts.len(), BATCH) {
        let owned_of = |t| owned_edges(triangles, &neighbours, t) | (Owned::from(firsts[t]) << 3);
        owned.par_extend(batch.into_par_iter().map(owned_of));
    }
    (owned, neighbours)
}

/// A side of a triangle, kept with its lower corner.
#[derive(Clone, Copy, Default)]
struct Side {
    /// The higher of its corners.
    to: u32,
    /// 3 * triangle + number of the side.
    side: u32,
}

fn neighbours(triangles: &Triangles, watch: &Watch) -> Vec<Neighbours> {
    let (starts, mut sides) = sides_by_corner(triangles, watch);
    let mut out = vec![[NO_NEIGHBOUR; 3]; triangles.corners.len()];
    for corner in watch.batches(triangles.points.len(), BATCH).flatten() {
        let fan = &mut sides[starts[corner] as usize..starts[corner + 1] as usize];
        fan.sort_unstable_by_key(|s| s.to);
        for meeting in fan.chunk_by(|a, b| a.to == b.to) {
            if let [a, b] = meeting {
                out[a.side as usize / 3][a.side as usize % 3] = b.side / 3;
                out[b.side as usize / 3][b.side as usize % 3] = a.side / 3;
            }
        }
    }
    out
}

/// All sides sorted by their lower corner, and where each corner's begin.
fn sides_by_corner(triangles: &Triangles, watch: &Watch) -> (Vec<u32>, Vec<Side>) {
    let ends = |corners: &[u32; 3], i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        (a.min(b), a.max(b))
    };
    let mut starts = vec![0; triangles.points.len() + 1];
    let in_batches = || watch.batches(triangles.corners.len(), BATCH).flatten();
    for t in in_batches() {
        let corners = &triangles.corners[t];
        for i in 0..3 {
            starts[ends(corners, i).0 as usize + 1] += 1;
        }
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut sides = vec![Side::default(); 3 * triangles.corners.len()];
    for t in in_batches() {
        let corners = &triangles.corners[t];
        for i in 0..3 {
            let (from, to) = ends(corners, i);
            let slot = &mut next[from as usize];
            sides[*slot as usize] = Side { to, side: (3 * t + i) as u32 };
            *slot += 1;
        }
    }
    (starts, sides)
}

fn owned_edges(triangles: &Triangles, neighbours: &[Neighbours], t: usize) -> Owned {
    let mut owned = 0;
    for (i, other) in neighbours[t].into_iter().enumerate() {
        let is_first = other == NO_NEIGHBOUR || (t as u32) < other;
        let is_under = || [(t as u32), other].into_iter().any(|wall| stands_on(triangles, wall, side(triangles, t, i)));
        if !is_first || is_under() {
            continue;
        }
        owned |= match meeting(triangles, t, i, other) {
            Meeting::Ridge => 1 << i,
            Meeting::Plane => in_plane(i),
            Meeting::Valley => 0,
        };
    }
    owned
}

/// The corners of a triangle's edge, by number.
fn side(triangles: &Triangles, t: usize, i: usize) -> [u32; 2] {
    let corners = triangles.corners[t];
    [corners[i], corners[(i + 1) % 3]]
}

/// Whether a facet stands upright on an edge, given by its corners: over each of its points there is a point of the facet.
fn stands_on(triangles: &Triangles, wall: u32, edge: [u32; 2]) -> bool {
    if wall == NO_NEIGHBOUR {
        return false;
    }
    let Some(top) = triangles.corners[wall as usize].iter().position(|corner| !edge.contains(corner)) else {
        return false;
    };
    let corners = triangles.at(wall);
    let (c, a, b) = (corners[top], corners[(top + 1) % 3], corners[(top + 2) % 3]);
    let normal = normal::of(corners);
    let along = (b - a).xy();
    // the edge's height below the third corner; a vertical edge has nothing over it
    let share = along.dot(&(c - a).xy()) / along.norm_squared();
    normal.z.abs() <= UPRIGHT * normal.norm() && along.norm() > 0.0 && c.z > a.z + share * (b.z - a.z)
}

/// How two facets meet in an edge.
enum Meeting {
    /// One falls away below the other's plane, they lie on one side of the edge in plan, or there is one facet alone.
    Ridge,
    /// They lie in one plane but for rounding, on both sides of the edge in plan.
    Plane,
    /// Each rises over the other's plane, on both sides of the edge in plan.
    Valley,
}

fn meeting(triangles: &Triangles, t: usize, i: usize, other: u32) -> Meeting {
    let corners = triangles.at(t as u32);
    let (a, b, c) = (corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]);
    let edge = side(triangles, t, i);
    let opposite =
        triangles.corners.get(other as usize).and_then(|corners| corners.iter().position(|v| !edge.contains(v)));
    let Some(k) = opposite else {
        return Meeting::Ridge;
    };
    let d = triangles.at(other)[k];
    let aside = |p: Vector| (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    let normal = normal::of(corners);
    let size = normal.norm() * (b - a).norm().max((d - a).norm());
    let lies_over = (d - a).dot(&normal) * normal.z.signum();
    let thin = 1e-9 * size;
    let falls_nowhere = normal.z.abs() > thin && aside(c) * aside(d) < 0.0 && lies_over >= -ROUNDING * size;
    if !falls_nowhere {
        Meeting::Ridge // of a triangle without area too
    } else if lies_over <= ROUNDING * size {
        Meeting::Plane
    } else {
        Meeting::Valley
    }
}

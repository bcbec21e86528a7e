//! Corners that mean one point, and triangles without area.

use std::collections::HashMap;

use rayon::prelude::*;

use super::edges::{ends, Edges, NONE};
use super::mending::Mending;
use super::triangles::{area_vector, bounds, retain};
use crate::Vector;

/// Corners on open edges are joined within this share of the part's size, and never farther than [`FARTHEST`],
const SHARE: f64 = 1e-5;
/// mm: the tolerance of a part where its job states none,
const FARTHEST: f64 = 1e-3;
/// except that a coordinate of single precision is not known better than this share of itself (four of its units).
const SINGLE: f64 = 4.0 / 8_388_608.0;
/// Triangles less high than this share of the part are lines.
const FLAT: f64 = 1e-10;
/// Cutting at a line may leave others: more rounds than lines in a row are not needed.
const ROUNDS: usize = 16;

/// Joins points that agree to the last bit: vertices in the order of their coordinates, and the vertex of each point.
pub fn exact(points: &[Vector]) -> (Vec<Vector>, Vec<u32>) {
    // of the two zeros one
    let plain = |p: &Vector| [p.x + 0.0, p.y + 0.0, p.z + 0.0];
    let mut order: Vec<([f64; 3], u32)> = points.par_iter().enumerate().map(|(i, p)| (plain(p), i as u32)).collect();
    order.par_sort_unstable_by(|a, b| {
        let by = |k: usize| a.0[k].total_cmp(&b.0[k]);
        by(0).then(by(1)).then(by(2)).then(a.1.cmp(&b.1))
    });
    let (mut vertices, mut index) = (Vec::new(), vec![0; points.len()]);
    for same in order.chunk_by(|a, b| a.0.iter().zip(b.0).all(|(x, y)| x.total_cmp(&y).is_eq())) {
        same.iter().for_each(|(_, i)| index[*i as usize] = vertices.len() as u32);
        vertices.extend(same.first().map(|(p, _)| Vector::from(*p)));
    }
    (vertices, index)
}

/// Within what distance corners on open edges mean one point, mm.
pub fn join_distance(vertices: &[Vector]) -> f64 {
    let (low, high) = bounds(vertices.iter().copied());
    let reach = low.amax().max(high.amax());
    (SHARE * (high - low).norm()).min(FARTHEST).max(SINGLE * reach)
}

/// Joins corners on open edges that lie near each other, where that closes edges.
pub fn near(vertices: &[Vector], triangles: &mut [[u32; 3]], mending: &mut Mending) {
    let distance = join_distance(vertices);
    let open = open_corners(triangles);
    if open.is_empty() || !distance.is_finite() {
        return;
    }
    let target = nearest_before(vertices, &open, distance);
    let joined: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|i| target.get(&i).copied().unwrap_or(i))).collect();
    if open_corners(&joined).len() + target.len() >= open.len() {
        return; // they are borders: nothing was closed by that
    }
    triangles.copy_from_slice(&joined);
    mending.joined = target.len();
    mending.join_distance = distance;
    let moved = |(from, to): (&u32, &u32)| (vertices[*from as usize] - vertices[*to as usize]).norm();
    mending.moved = target.iter().map(moved).fold(0.0, f64::max);
}

/// Vertices on edges that only one triangle has, ascending.
fn open_corners(triangles: &[[u32; 3]]) -> Vec<u32> {
    let edges = Edges::of(triangles);
    let mut corners: Vec<u32> = edges.open().flat_map(|half| <[u32; 2]>::from(ends(triangles, half))).collect();
    corners.sort_unstable();
    corners.dedup();
    corners
}

/// For each vertex that has an earlier one within `distance`: that one, which has none itself.
fn nearest_before(vertices: &[Vector], candidates: &[u32], distance: f64) -> HashMap<u32, u32> {
    let cell = 2.0 * distance;
    let cell_index = |p: f64| (p / cell).floor() as i64;
    let mut kept: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut target = HashMap::new();
    for vertex in candidates {
        let point = vertices[*vertex as usize];
        let (low, high) = (point.map(|x| cell_index(x - distance)), point.map(|x| cell_index(x + distance)));
        let mut best: Option<(f64, u32)> = None;
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    for other in kept.get(&[x, y, z]).into_iter().flatten() {
                        let apart = (vertices[*other as usize] - point).norm();
                        if apart <= distance && best.is_none_or(|found| (apart, *other) < found) {
                            best = Some((apart, *other));
                        }
                    }
                }
            }
        }
        match best {
            Some((_, other)) => {
                target.insert(*vertex, other);
            }
            None => kept.entry(point.map(cell_index).into()).or_default().push(*vertex),
        }
    }
    target
}

/// Removes triangles whose corners lie on a line: the neighbour at the longest side is cut at the corner between.
pub fn cut_at_flat(vertices: &[Vector], triangles: &mut Vec<[u32; 3]>, mending: &mut Mending) {
    let (low, high) = bounds(vertices.iter().copied());
    let least = FLAT * (high - low).norm();
    for _ in 0..ROUNDS {
        let flat: Vec<u32> =
            (0..triangles.len() as u32).filter(|t| is_flat(vertices, triangles[*t as usize], least)).collect();
        if flat.is_empty() {
            return;
        }
        let edges = Edges::of(triangles);
        let (mut changed, mut gone) = (vec![false; triangles.len()], vec![false; triangles.len()]);
        for t in flat {
            let longest = 3 * t + longest_side(vertices, triangles[t as usize]) as u32;
            let twin = edges.twins[longest as usize];
            if twin == NONE {
                gone[t as usize] = true; // nothing lies beyond: it covers nothing
                continue;
            }
            let (other, middle) = (twin / 3, triangles[t as usize][(longest as usize + 2) % 3]);
            if changed[t as usize] || changed[other as usize] || ends(triangles, twin).0 == ends(triangles, longest).0 {
                continue;
            }
            let (from, to) = ends(triangles, twin);
            let apex = triangles[other as usize][(twin as usize + 2) % 3];
            if apex == middle {
                continue;
            }
            triangles[other as usize] = [from, middle, apex];
            triangles[t as usize] = [middle, to, apex];
            (changed[t as usize], changed[other as usize]) = (true, true);
            mending.degenerate += 1;
        }
        if !gone.contains(&true) && !changed.contains(&true) {
            break;
        }
        mending.degenerate += retain(triangles, |t| !gone[t]);
    }
    // lines in a tangle: without area they are no part of the surface
    let covers: Vec<bool> = triangles.iter().map(|corners| area_vector(vertices, *corners).norm() > 0.0).collect();
    mending.degenerate += retain(triangles, |t| covers[t]);
}

/// The longest side of a triangle.
fn longest_side(vertices: &[Vector], corners: [u32; 3]) -> usize {
    let [a, b, c] = corners.map(|i| vertices[i as usize]);
    let lengths = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
    (0..3).max_by(|i, j| lengths[*i].total_cmp(&lengths[*j])).unwrap_or(0)
}

fn is_flat(vertices: &[Vector], corners: [u32; 3], least: f64) -> bool {
    let k = longest_side(vertices, corners);
    let side = vertices[corners[(k + 1) % 3] as usize] - vertices[corners[k] as usize];
    area_vector(vertices, corners).norm() <= least * side.norm()
}

/// The vertices that triangles have, and the triangles with their new numbers.
pub fn used(vertices: &[Vector], mut triangles: Vec<[u32; 3]>) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let mut number = vec![NONE; vertices.len()];
    triangles.iter().flatten().for_each(|i| number[*i as usize] = 0);
    let mut kept = Vec::new();
    for (vertex, number) in vertices.iter().zip(&mut number).filter(|(_, number)| **number == 0) {
        *number = kept.len() as u32;
        kept.push(*vertex);
    }
    triangles.iter_mut().flatten().for_each(|i| *i = number[*i as usize]);
    (kept, triangles)
}

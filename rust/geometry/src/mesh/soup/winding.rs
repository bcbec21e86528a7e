//! Which side of each triangle is out.

use super::edges::{ends, is_closed, Edges};
use super::mending::Mending;
use super::triangles::{area_vector, bounds};
use super::union_find::Union;
use crate::Vector;

/// In a surface with a border, triangles that wind against their neighbours are turned where they are fewer than this
/// share of its area: with more of them it is unknown which side is meant.
const MINORITY: f64 = 0.25;
/// A border that could span no more than this share of a surface is a hole in a body: which side is out is plain.
const SMALL_HOLE: f64 = 0.01;

/// Makes bodies have their material inside: connected patches whose triangles agree.
pub fn turn_outward(
    vertices: &[Vector],
    triangles: &mut [[u32; 3]],
    edges: &Edges,
    patches: &[u32],
    mending: &mut Mending,
) {
    let bodies = Bodies::of(vertices, triangles, edges, patches);
    let turned_over = bodies.inside_out(vertices, triangles);
    for (corners, body) in triangles.iter_mut().zip(&bodies.of_triangle) {
        if turned_over[*body as usize] {
            corners.swap(1, 2);
            mending.inside_out += 1;
        }
    }
    let edges = if mending.inside_out > 0 { &Edges::of(triangles) } else { edges };
    mending.closed = is_closed(triangles, edges);
}

/// Turns triangles so that neighbours agree, the fewer of each connected patch; returns the patch of each triangle, and the
/// edges.
pub fn agree(vertices: &[Vector], triangles: &mut [[u32; 3]], mending: &mut Mending) -> (Vec<u32>, Edges) {
    let edges = Edges::of(triangles);
    let (patches, against) = followed(vertices, triangles, &edges, mending);
    let count = patches.iter().max().map_or(0, |last| *last as usize + 1);
    let (mut areas, mut has_border) = (vec![[0.0; 2]; count], vec![false; count]);
    for (t, patch) in patches.iter().enumerate() {
        areas[*patch as usize][usize::from(against[t])] += 0.5 * area_vector(vertices, triangles[t]).norm();
    }
    edges.odd.iter().flatten().for_each(|half| has_border[patches[*half as usize / 3] as usize] = true);
    for (t, corners) in triangles.iter_mut().enumerate() {
        let patch = patches[t] as usize;
        let [with, contrary] = areas[patch];
        if against[t] != (contrary > with) {
            corners.swap(1, 2);
            mending.turned += 1;
            let is_plain = !has_border[patch] || with.min(contrary) < MINORITY * (with + contrary);
            if !is_plain && mending.double_sided == 0 && mending.unclear.is_none() {
                mending.unclear = Some(vertices[corners[0] as usize].into());
            }
        }
    }
    // a triangle turned over has its sides in another order
    let edges = if mending.turned > 0 { Edges::of(triangles) } else { edges };
    (patches, edges)
}

/// Follows neighbours: the connected patch of each triangle, and whether it winds against the patch's first one.
fn followed(
    vertices: &[Vector],
    triangles: &[[u32; 3]],
    edges: &Edges,
    mending: &mut Mending,
) -> (Vec<u32>, Vec<bool>) {
    const UNVISITED: u32 = u32::MAX;
    let (mut patches, mut against) = (vec![UNVISITED; triangles.len()], vec![false; triangles.len()]);
    let (mut stack, mut count) = (Vec::new(), 0);
    for first in 0..triangles.len() as u32 {
        if patches[first as usize] != UNVISITED {
            continue;
        }
        patches[first as usize] = count;
        stack.push(first);
        while let Some(t) = stack.pop() {
            for half in 3 * t..3 * t + 3 {
                let Some(other) = edges.beyond(half) else { continue };
                let agrees = ends(triangles, half).0 == ends(triangles, edges.twins[half as usize]).1;
                let turned = against[t as usize] ^ !agrees;
                if patches[other as usize] == UNVISITED {
                    (patches[other as usize], against[other as usize]) = (count, turned);
                    stack.push(other);
                } else if against[other as usize] != turned && mending.unclear.is_none() {
                    mending.unclear = Some(vertices[ends(triangles, half).0 as usize].into());
                }
            }
        }
        count += 1;
    }
    (patches, against)
}

/// Patches that enclose something together.
struct Bodies {
    of_triangle: Vec<u32>,
    /// Signed volume of each; none where it has a border that is more than a small hole.
    volumes: Vec<Option<f64>>,
    /// A corner of each.
    corners: Vec<Vector>,
}

impl Bodies {
    /// Patches that meet along an edge of more than two triangles, and do not close there by themselves, are one body.
    fn of(vertices: &[Vector], triangles: &[[u32; 3]], edges: &Edges, patches: &[u32]) -> Self {
        let count = patches.iter().max().map_or(0, |last| *last as usize + 1);
        let mut together = Union::new(count);
        let mut open = vec![0.0; count];
        for edge in &edges.odd {
            let mut sums: Vec<(u32, i64)> = Vec::new();
            for half in edge {
                let (patch, (a, b)) = (patches[*half as usize / 3], ends(triangles, *half));
                let direction = if a < b { 1 } else { -1 };
                match sums.iter_mut().find(|(known, _)| *known == patch) {
                    Some((_, sum)) => *sum += direction,
                    None => sums.push((patch, direction)),
                }
            }
            sums.retain(|(_, sum)| *sum != 0);
            let Some((first, _)) = sums.first().copied() else { continue };
            sums.iter().for_each(|(other, _)| together.join(first, *other));
            if sums.iter().map(|(_, sum)| *sum).sum::<i64>() != 0 {
                let (a, b) = ends(triangles, edge[0]);
                open[first as usize] += (vertices[a as usize] - vertices[b as usize]).norm();
            }
        }
        let of_triangle: Vec<u32> = patches.iter().map(|patch| together.root(*patch)).collect();
        let (mut border, mut area, mut volume) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        let mut corners: Vec<Option<Vector>> = vec![None; count];
        for (patch, length) in open.iter().enumerate() {
            border[together.root(patch as u32) as usize] += length;
        }
        for (corner, body) in triangles.iter().zip(&of_triangle) {
            let body = *body as usize;
            let origin = *corners[body].get_or_insert(vertices[corner[0] as usize]);
            let twice = area_vector(vertices, *corner);
            area[body] += 0.5 * twice.norm();
            volume[body] += (vertices[corner[0] as usize] - origin).dot(&twice) / 6.0;
        }
        let spanned = |border: f64| border * border / (4.0 * std::f64::consts::PI);
        let volumes = (0..count).map(|i| (spanned(border[i]) <= SMALL_HOLE * area[i]).then_some(volume[i])).collect();
        Self { of_triangle, volumes, corners: corners.into_iter().map(Option::unwrap_or_default).collect() }
    }

    /// Which bodies have their material outside: those of negative volume that lie in no other, and all that lie in
    /// these. A body of negative volume in another is a hollow.
    fn inside_out(&self, vertices: &[Vector], triangles: &[[u32; 3]]) -> Vec<bool> {
        let negative = |body: usize| self.volumes[body].is_some_and(|volume| volume < 0.0);
        let mut out: Vec<bool> = (0..self.volumes.len()).map(negative).collect();
        let bodies = (0..out.len()).filter(|body| self.volumes[*body].is_some_and(|v| v != 0.0));
        let bodies: Vec<usize> = bodies.collect();
        if bodies.len() < 2 || !out.contains(&true) {
            return out;
        }
        let around = self.around(vertices, triangles, &bodies);
        for (body, containers) in bodies.iter().zip(&around) {
            out[*body] = negative(*body) && containers.len() % 2 == 0;
        }
        let outer = out.clone();
        for (body, containers) in bodies.iter().zip(&around) {
            out[*body] |= containers.iter().any(|container| outer[*container as usize]);
        }
        out
    }

    /// The bodies around each of some bodies: those whose triangles a ray upwards from it meets an odd number of times.
    fn around(&self, vertices: &[Vector], triangles: &[[u32; 3]], bodies: &[usize]) -> Vec<Vec<u32>> {
        let mut order: Vec<usize> = (0..bodies.len()).collect();
        let start = |i: usize| self.corners[bodies[i]];
        order.sort_by(|a, b| start(*a).x.total_cmp(&start(*b).x));
        let mut met: Vec<Vec<u32>> = vec![Vec::new(); bodies.len()];
        for (corners, body) in triangles.iter().zip(&self.of_triangle) {
            if self.volumes[*body as usize].is_none() {
                continue;
            }
            let corners = corners.map(|i| vertices[i as usize]);
            let (low, high) = bounds(corners.into_iter());
            let from = order.partition_point(|i| start(*i).x < low.x);
            for i in order[from..].iter().take_while(|i| start(**i).x <= high.x) {
                if bodies[*i] != *body as usize && is_over(corners, start(*i)) {
                    toggle(&mut met[*i], *body);
                }
            }
        }
        met
    }
}

fn toggle(set: &mut Vec<u32>, item: u32) {
    match set.iter().position(|known| *known == item) {
        Some(at) => drop(set.swap_remove(at)),
        None => set.push(item),
    }
}

/// Whether a ray upwards from a point meets a triangle; where it meets an edge or a corner, one of the triangles there.
fn is_over([a, b, c]: [Vector; 3], point: Vector) -> bool {
    let crosses = |p: Vector, q: Vector| {
        if (p.y > point.y) == (q.y > point.y) {
            return false;
        }
        // the same for both triangles at an edge, to the last bit
        let (p, q) = if p.y < q.y { (p, q) } else { (q, p) };
        point.x < p.x + (point.y - p.y) / (q.y - p.y) * (q.x - p.x)
    };
    let is_inside = crosses(a, b) ^ crosses(b, c) ^ crosses(c, a);
    let normal = (b - a).cross(&(c - a));
    is_inside && normal.z.abs() > 0.0 && (a - point).dot(&normal) / normal.z > 0.0
}

//! Which edges of a mesh a drop-cutter must try, and whose they are.
//!
//! An edge between two facets that meet in a valley or lie in one plane can carry no contact that
//! a facet does not carry as well, and is left out. Every other edge is tried once, by the
//! first triangle that has it. Corners are tried by all their triangles: they cost little and are good first tips.

use rayon::prelude::*;
use styluscam_geometry::Mesh;

/// Bit i: the edge from corner i to the next one is this triangle's to try.
pub type Owned = u8;

/// The triangle on the other side of each edge, or [`NO_NEIGHBOUR`] at borders and where more than two meet.
pub type Neighbours = [u32; 3];

/// No single triangle lies beyond the edge.
pub const NO_NEIGHBOUR: u32 = u32::MAX;

/// Two facets count as meeting in a valley only beyond this height of one over the other's plane, relative to size.
const VALLEY: f64 = 1e-12;

/// Ownership and neighbours of all triangles.
pub fn of(mesh: &Mesh) -> (Vec<Owned>, Vec<Neighbours>) {
    let neighbours = neighbours(mesh);
    let owned = (0..mesh.triangles().len()).into_par_iter().map(|t| owned_edges(mesh, &neighbours, t)).collect();
    (owned, neighbours)
}

fn neighbours(mesh: &Mesh) -> Vec<Neighbours> {
    let mut sides: Vec<(u32, u32, u32, u8)> = (0..mesh.triangles().len() as u32)
        .into_par_iter()
        .flat_map_iter(|t| {
            let [a, b, c] = mesh.triangles()[t as usize];
            [(a, b, 0), (b, c, 1), (c, a, 2)].map(|(p, q, i)| (p.min(q), p.max(q), t, i))
        })
        .collect();
    sides.par_sort_unstable();
    let mut out = vec![[NO_NEIGHBOUR; 3]; mesh.triangles().len()];
    for meeting in sides.chunk_by(|m, n| (m.0, m.1) == (n.0, n.1)) {
        if let [(_, _, t, i), (_, _, u, j)] = meeting {
            out[*t as usize][*i as usize] = *u;
            out[*u as usize][*j as usize] = *t;
        }
    }
    out
}

fn owned_edges(mesh: &Mesh, neighbours: &[Neighbours], t: usize) -> Owned {
    let mut owned = 0;
    for (i, other) in neighbours[t].into_iter().enumerate() {
        let mine = other == NO_NEIGHBOUR || ((t as u32) < other && !is_valley(mesh, t, i, other as usize));
        owned |= u8::from(mine) << i;
    }
    owned
}

/// Whether the facets lie on both sides of the edge in plan and neither falls away below the other's plane.
fn is_valley(mesh: &Mesh, t: usize, i: usize, other: usize) -> bool {
    let corners = mesh.corners(t);
    let (a, b, c) = (corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]);
    let names = mesh.triangles()[t];
    let edge = [names[i], names[(i + 1) % 3]];
    let Some(k) = mesh.triangles()[other].iter().position(|v| !edge.contains(v)) else {
        return false;
    };
    let d = mesh.corners(other)[k];
    let side = |p: styluscam_geometry::Vector| (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    let normal = (b - a).cross(&(c - a));
    let size = normal.norm() * (b - a).norm().max((d - a).norm());
    let lies_over = (d - a).dot(&normal) * normal.z.signum();
    let thin = 1e-9 * size;
    normal.z.abs() > thin && side(c) * side(d) < 0.0 && lies_over >= VALLEY * size
}

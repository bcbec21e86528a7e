//! A wall of constant angle that rises from the outer edge of a part to the level plane of the blank.
//!
//! Over a position p it is the lowest of the upright cones on the edge, z(p) = min over q of h(q) + tan(angle) |p - q|: the one surface
//! with this slope that meets the edge wherever the edge itself climbs less steeply, and never meets itself. Where an edge is hollow in
//! plan, parts of the wall meet in a crease.
//!
//! Derivation: docs/concepts/addendum.md.

mod corner;
mod fault;
mod field;
mod mesh;
mod rays;

use corner::Corner;
use field::Walls;
use mesh::Ground;

pub use fault::WallFault;

use super::outline::outer_edges;
use crate::{GeometryError, Mesh, Vector};

/// Heights within this are one, mm.
const SAME: f64 = 1e-6;

/// What wall to build.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallShape {
    /// Wall angle, rad, between 0 and a right angle.
    pub angle: f64,
    /// Radius of the arc that joins it to the blank's plane, mm; 0 for none.
    pub radius: f64,
    /// Height of the blank's plane above the edge's highest point, mm; the least that the part and the arc take when left out.
    pub height: Option<f64>,
    /// What is left of the blank around the wall, in plan, mm.
    pub margin: f64,
    /// How far triangles may lie off the wall, mm.
    pub tolerance: f64,
    /// Whether the wall goes down from the edge to the blank, as over a male die, instead of up.
    pub goes_down: bool,
}

/// A part with a wall around it.
#[derive(Clone, Debug)]
pub struct Walled {
    /// The part's triangles first, then those of the wall and the blank.
    pub mesh: Mesh,
    /// Number of the wall's face.
    pub wall: u32,
    /// Number of the face of the level blank around it.
    pub blank: u32,
    /// Height of the blank's plane, mm.
    pub plane: f64,
    /// Lower and upper corner of the blank in plan, mm.
    pub extent: [[f64; 2]; 2],
    /// The edges that the wall rises from, closed, counter-clockwise.
    pub edges: Vec<Vec<Vector>>,
    /// How far the wall's triangles were found to lie off it, mm.
    pub deviation: f64,
}

/// Builds a wall around what is kept of a part's triangles, which lies as it is formed: +Z to the tool.
///
/// # Errors
/// As [`WallFault`] states.
pub fn walled(part: &Mesh, keep: &[bool], shape: &WallShape) -> Result<Walled, WallFault> {
    let edges = outer_edges(part, keep);
    if edges.is_empty() {
        return Err(WallFault::NoEdge);
    }
    let sign = if shape.goes_down { -1.0 } else { 1.0 };
    let flipped = |point: Vector| Vector::new(point.x, point.y, sign * point.z);
    let lines: Vec<Vec<Vector>> =
        edges.iter().map(|edge| edge.iter().map(|(point, _)| flipped(*point)).collect()).collect();
    let kept = (0..keep.len()).filter(|triangle| keep[*triangle]).flat_map(|triangle| part.corners(triangle));
    let top = kept.map(|corner| sign * corner.z).fold(f64::NEG_INFINITY, f64::max);
    let is_level = |(point, triangle): &(Vector, usize)| {
        (sign * point.z - top).abs() <= SAME && part.model_normal(*triangle).z > 1.0 - SAME
    };
    if shape.height.is_none() && edges.iter().flatten().all(is_level) {
        return Err(WallFault::Flange);
    }
    let plane = plane(top, &lines, shape)?;
    let corner = Corner::new(shape.angle, plane, shape.radius);
    let sides = lines.iter().flat_map(|line| line.iter().copied().zip(line.iter().copied().cycle().skip(1)));
    let walls = Walls::new(climbing(sides.map(|(a, b)| [a, b]).collect(), corner.slope(), sign)?, corner.slope());
    meets(&lines, &walls, sign)?;
    let levels = corner.levels(shape.tolerance);
    let mut ground = Ground::new(&lines, &walls, &corner, shape.tolerance);
    let mut first = 0;
    for line in &lines {
        ground.add_rays(&rays::rays(line, first, &walls, &corner, &levels, shape.tolerance), first);
        first += line.len();
    }
    let extent = extent(&ground.points, shape.margin);
    ground.add_blank(extent[0], extent[1]);
    let triangles = ground.triangles()?;
    let [wall, blank] = [1, 2].map(|next| part.faces().iter().copied().max().unwrap_or(0) + next);
    let mesh = joined(part, &ground, &triangles, [wall, blank], sign)?;
    let edges = edges.into_iter().map(|edge| edge.into_iter().map(|(point, _)| point).collect()).collect();
    Ok(Walled { mesh, wall, blank, plane: sign * plane, extent, edges, deviation: ground.deviation })
}

/// Height of the blank's plane over a part whose highest point is `top`.
fn plane(top: f64, lines: &[Vec<Vector>], shape: &WallShape) -> Result<f64, WallFault> {
    let edge = lines.iter().flatten().map(|point| point.z).fold(f64::NEG_INFINITY, f64::max);
    let least = Corner::least(shape.angle, shape.radius);
    let plane = match shape.height {
        Some(height) => edge + height,
        None => top.max(edge + least),
    };
    if plane - edge < least - SAME {
        return Err(WallFault::Arc { least, height: plane - edge });
    }
    if top > plane + SAME {
        return Err(WallFault::Beyond { beyond: top - plane });
    }
    Ok(plane)
}

/// The sides, none of which climbs as steeply as the wall.
fn climbing(sides: Vec<[Vector; 2]>, slope: f64, sign: f64) -> Result<Vec<[Vector; 2]>, WallFault> {
    match sides.iter().find(|[a, b]| (b.z - a.z).abs() >= slope * (b - a).xy().norm()) {
        Some([a, _]) => Err(WallFault::Steep { at: Vector::new(a.x, a.y, sign * a.z) }),
        None => Ok(sides),
    }
}

/// Whether the wall passes through all of the edge, and not below it.
fn meets(lines: &[Vec<Vector>], walls: &Walls, sign: f64) -> Result<(), WallFault> {
    let below = |point: &&Vector| walls.at([point.x, point.y]).height < point.z - SAME;
    match lines.iter().flatten().find(below) {
        Some(at) => Err(WallFault::Steep { at: Vector::new(at.x, at.y, sign * at.z) }),
        None => Ok(()),
    }
}

/// The box of some points in plan, with a margin around it.
fn extent(points: &[Vector], margin: f64) -> [[f64; 2]; 2] {
    let infinite = [f64::INFINITY; 2];
    let grow = |[low, high]: [[f64; 2]; 2], point: &Vector| {
        [[low[0].min(point.x), low[1].min(point.y)], [high[0].max(point.x), high[1].max(point.y)]]
    };
    let [low, high] = points.iter().fold([infinite, infinite.map(|x| -x)], grow);
    [low.map(|x| x - margin), high.map(|x| x + margin)]
}

/// The part with the wall's triangles.
fn joined(
    part: &Mesh,
    ground: &Ground<'_>,
    triangles: &[[u32; 3]],
    faces: [u32; 2],
    sign: f64,
) -> Result<Mesh, GeometryError> {
    let first = part.vertices().len() as i64;
    let risen = ground.points.iter().map(|point| Vector::new(point.x, point.y, sign * point.z));
    let vertices = part.vertices().iter().copied().chain(risen).collect();
    let corners = part.triangles().iter().map(|corners| corners.map(i64::from));
    let corners: Vec<[i64; 3]> =
        corners.chain(triangles.iter().map(|corners| corners.map(|i| first + i64::from(i)))).collect();
    let face = |triangle: &[u32; 3]| faces[usize::from(ground.is_level(*triangle))];
    let numbers: Vec<u32> = part.faces().iter().copied().chain(triangles.iter().map(face)).collect();
    let mut normals = Vec::new();
    if part.has_corner_normals() {
        normals.extend((0..part.triangles().len()).map(|triangle| part.corner_normals(triangle)));
        let turned = |normal: Vector| Vector::new(sign * normal.x, sign * normal.y, normal.z);
        normals.extend(triangles.iter().map(|triangle| ground.normals(*triangle).map(turned)));
    }
    Mesh::with_normals(vertices, &corners, &numbers, &normals)
}

#[cfg(test)]
mod tests;

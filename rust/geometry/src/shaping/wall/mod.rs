//! A wall of constant angle that rises from the outer edge of a part to the level plane of the blank.
//!
//! Over a position p it is the lowest of the upright cones on the edge, z(p) = min over q of h(q) + tan(angle) |p - q|: the one surface
//! with this slope that meets the edge wherever the edge itself climbs less steeply, and never meets itself. Where an edge is hollow in
//! plan, parts of the wall meet in a crease.
//!
//! Derivation: docs/concepts/addendum.md.

mod bend;
mod corner;
mod fault;
mod field;
mod leaving;
mod mesh;
mod rays;

use std::collections::{HashMap, HashSet};

use corner::Corner;
use field::Walls;
use mesh::Ground;

pub use fault::WallFault;

use super::outline::outer_edges;
use crate::{GeometryError, Mesh, Vector};

/// Heights within this are one, mm.
const SAME: f64 = 1e-6;
/// Points of a line at which it is asked how high a wall is there lie no farther apart, mm.
const PITCH: f64 = 0.5;

/// What wall to build.
#[derive(Clone, Debug, PartialEq)]
pub struct WallShape {
    /// Wall angle, rad, between 0 and a right angle.
    pub angle: f64,
    /// Radius of the arc that joins it to the blank's plane, mm; 0 for none.
    pub radius: f64,
    /// Whether it leaves the edge by the part's own slope, from which an arc of the same radius leads to the wall's.
    pub blended: bool,
    /// Where it ends.
    pub end: WallEnd,
    /// What is left of the blank around the wall, in plan, mm.
    pub margin: f64,
    /// How far triangles may lie off the wall, mm.
    pub tolerance: f64,
    /// Whether the wall goes down from the edge to the blank, as over a male die, instead of up.
    pub goes_down: bool,
}

/// Where a wall ends, in the blank's plane.
#[derive(Clone, Debug, PartialEq)]
pub enum WallEnd {
    /// As low as the part and the arcs allow.
    Least,
    /// So many mm above the edge's highest point.
    Height(f64),
    /// As high as it may be and still end within a closed line in plan, whose corners these are, counter-clockwise, mm.
    Within(Vec<[f64; 2]>),
}

/// A part with a wall around it.
#[derive(Clone, Debug)]
pub struct Walled {
    /// The part's triangles first, then those of the wall and the blank; without what of the part hangs down from the edges: the
    /// wall goes on there instead.
    pub mesh: Mesh,
    /// Which triangles are the part's that were kept, or the wall's.
    pub formed: Vec<bool>,
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
    if shape.end == WallEnd::Least && edges.iter().flatten().all(is_level) {
        return Err(WallFault::Flange);
    }
    let sides = lines.iter().flat_map(|line| line.iter().copied().zip(line.iter().copied().cycle().skip(1)));
    let sides = climbing(sides.map(|(a, b)| [a, b]).collect(), libm::tan(shape.angle), sign)?;
    let leaving = if shape.blended { leaving(part, &edges, sign)? } else { Vec::new() };
    let walls = Walls::new(sides, leaving, shape.angle, shape.radius);
    meets(&lines, &walls, sign)?;
    let plane = plane(top, &lines, &walls, shape)?;
    let corner = Corner::new(shape.angle, plane, shape.radius);
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
    let hangs = hanging(part, keep, &edges);
    let above = part.part_of(|triangle| !hangs[triangle])?;
    let mesh = joined(&above, &ground, &triangles, [wall, blank], sign)?;
    let kept = keep.iter().zip(&hangs).filter(|(_, hangs)| !**hangs).map(|(keep, _)| *keep);
    let formed = kept.chain(triangles.iter().map(|triangle| !ground.is_level(*triangle))).collect();
    let edges = edges.into_iter().map(|edge| edge.into_iter().map(|(point, _)| point).collect()).collect();
    Ok(Walled { mesh, formed, wall, blank, plane: sign * plane, extent, edges, deviation: ground.deviation })
}

/// Height of the blank's plane over a part whose highest point is `top`.
fn plane(top: f64, lines: &[Vec<Vector>], walls: &Walls, shape: &WallShape) -> Result<f64, WallFault> {
    let edge = lines.iter().flatten().map(|point| point.z).fold(f64::NEG_INFINITY, f64::max);
    let least = walls.straight_from() - edge + Corner::least(shape.angle, shape.radius);
    let plane = match &shape.end {
        WallEnd::Height(height) => edge + height,
        WallEnd::Least => top.max(edge + least),
        WallEnd::Within(line) => lowest_on(line, lines, walls)? - Corner::beyond(shape.angle, shape.radius),
    };
    if plane - edge < least - SAME {
        return Err(WallFault::Arc { least, height: plane - edge });
    }
    if top > plane + SAME {
        return Err(WallFault::Beyond { beyond: top - plane });
    }
    Ok(plane)
}

/// The lowest that the wall alone is over a closed line around the edges, mm.
///
/// # Errors
/// An edge that does not lie within.
fn lowest_on(line: &[[f64; 2]], lines: &[Vec<Vector>], walls: &Walls) -> Result<f64, WallFault> {
    let sides = || line.iter().copied().zip(line.iter().copied().cycle().skip(1));
    // convex: how far a point lies outside of it, or of the nearest of its sides
    let outside = |point: &Vector| {
        let off = |([ax, ay], [bx, by]): ([f64; 2], [f64; 2])| {
            ((point.x - ax) * (by - ay) - (point.y - ay) * (bx - ax)) / libm::hypot(bx - ax, by - ay)
        };
        sides().map(off).fold(f64::NEG_INFINITY, f64::max)
    };
    let beyond = lines.iter().flatten().map(outside).fold(f64::NEG_INFINITY, f64::max);
    if beyond > 0.0 {
        return Err(WallFault::Outside { beyond });
    }
    let heights = sides().flat_map(|([ax, ay], [bx, by])| {
        let parts = (libm::hypot(bx - ax, by - ay) / PITCH).ceil().max(1.0) as u32;
        (0..parts).map(move |i| f64::from(i) / f64::from(parts)).map(move |share| {
            let at = [ax + share * (bx - ax), ay + share * (by - ay)];
            walls.at(at).height
        })
    });
    Ok(heights.fold(f64::INFINITY, f64::min))
}

/// The angles by which the part reaches all of its edges.
fn leaving(part: &Mesh, edges: &[Vec<(Vector, usize)>], sign: f64) -> Result<Vec<[f64; 2]>, WallFault> {
    let of_lines = edges.iter().map(|edge| leaving::angles(part, edge, sign)).collect::<Result<Vec<_>, _>>()?;
    Ok(of_lines.concat())
}

/// The triangles that are not kept and share a side with an edge: what hangs down from it. Without them each of these sides has one
/// triangle of the part, and the wall goes on there.
fn hanging(part: &Mesh, keep: &[bool], edges: &[Vec<(Vector, usize)>]) -> Vec<bool> {
    let ends = |a: Vector, b: Vector| [a, b].map(|p| <[u64; 3]>::from((p + Vector::zeros()).map(f64::to_bits)));
    let side = |a: Vector, b: Vector| {
        let [a, b] = ends(a, b);
        [a.min(b), a.max(b)]
    };
    let next = |edge: &[(Vector, usize)], i: usize| edge[(i + 1) % edge.len()].0;
    let sides: HashSet<[[u64; 3]; 2]> =
        edges.iter().flat_map(|edge| (0..edge.len()).map(|i| side(edge[i].0, next(edge, i)))).collect();
    let hangs = |triangle: usize| {
        let corners = part.corners(triangle);
        !keep[triangle] && (0..3).any(|i| sides.contains(&side(corners[i], corners[(i + 1) % 3])))
    };
    (0..keep.len()).map(hangs).collect()
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
    // the edge's own corners: where both meet there is one edge to the tool, which rolls over it
    let key = |p: Vector| <[u64; 3]>::from((p + Vector::zeros()).map(f64::to_bits));
    let used = part.triangles().iter().flatten().map(|i| (key(part.vertices()[*i as usize]), i64::from(*i)));
    let known: HashMap<[u64; 3], i64> = used.collect();
    let risen = || ground.points.iter().map(|point| Vector::new(point.x, point.y, sign * point.z));
    let number = |(i, point): (i64, Vector)| known.get(&key(point)).copied().unwrap_or(first + i);
    let numbers: Vec<i64> = (0..).zip(risen()).map(number).collect();
    let vertices = part.vertices().iter().copied().chain(risen()).collect();
    let corners = part.triangles().iter().map(|corners| corners.map(i64::from));
    let corners: Vec<[i64; 3]> =
        corners.chain(triangles.iter().map(|corners| corners.map(|i| numbers[i as usize]))).collect();
    let face = |triangle: &[u32; 3]| faces[usize::from(ground.is_level(*triangle))];
    let faces: Vec<u32> = part.faces().iter().copied().chain(triangles.iter().map(face)).collect();
    let mut normals = Vec::new();
    if part.has_corner_normals() {
        normals.extend((0..part.triangles().len()).map(|triangle| part.corner_normals(triangle)));
        let turned = |normal: Vector| Vector::new(sign * normal.x, sign * normal.y, normal.z);
        normals.extend(triangles.iter().map(|triangle| ground.normals(*triangle).map(turned)));
    }
    Mesh::with_normals(vertices, &corners, &faces, &normals)
}

#[cfg(test)]
mod tests;

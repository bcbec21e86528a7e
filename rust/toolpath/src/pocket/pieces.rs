//! Pieces of the boundary of what is reached next, where the tool cuts on it.

use super::material::Material;
use super::polygons::{sides, Point, Polygons};

/// A stretch of a boundary along which the tool meets material.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Positions of the tool's centre, the interior to the left; of a ring the first is repeated at the end.
    pub points: Vec<Point>,
    /// How deep the tool stands in the material at most, mm.
    pub depth: f64,
    /// Whether it cuts all around, and so has no end from which to begin.
    pub is_ring: bool,
}

/// Material nearer than this to the rim is none, mm: chips from there on are thinner than 1 um.
pub const SHALLOWEST: f64 = 1.5e-3;

/// Sides shorter than this have no heading: they are what the grid makes of crossings, mm.
const NOISE: f64 = 5e-5;

/// Depth at which pieces begin and end, mm: the link that comes there meets no chip that counts, wherever it comes from.
const BEGUN: f64 = 5e-4;
/// Where a piece begins is halved so often between two corners.
const HALVINGS: u32 = 6;

/// The pieces of a boundary where a tool of `radius` stands deeper than `SHALLOWEST` in the material.
pub fn pieces(reach: &Polygons, material: &Material, radius: f64) -> Vec<Piece> {
    let mut found = Vec::new();
    for contour in &reach.contours {
        let points = divided(contour, 0.1 * radius);
        let depth = |point: Point| radius - material.distance_up_to(radius, point);
        let depths: Vec<f64> = points.iter().map(|point| depth(*point)).collect();
        let mut stretches = stretches(&points, &depths);
        for piece in stretches.iter_mut().filter(|piece| !piece.is_ring) {
            shorten(&mut piece.points, depth);
            piece.points.reverse();
            shorten(&mut piece.points, depth);
            piece.points.reverse();
        }
        found.append(&mut stretches);
    }
    found
}

/// Moves the first position to where the tool meets the material.
fn shorten(points: &mut [Point], depth: impl Fn(Point) -> f64) {
    let [first, second, ..] = points else { return };
    let mut cuts = *second;
    for _ in 0..HALVINGS {
        let middle = [0, 1].map(|i| 0.5 * (first[i] + cuts[i]));
        if depth(middle) > BEGUN {
            cuts = middle;
        } else {
            *first = middle;
        }
    }
}

fn stretches(points: &[Point], depths: &[f64]) -> Vec<Piece> {
    let count = points.len();
    let cuts = |i: usize| depths.get(i % count).is_some_and(|depth| *depth > SHALLOWEST);
    let deepest = |depths: &mut dyn Iterator<Item = f64>| depths.fold(0.0, f64::max);
    let Some(free) = (0..count).find(|i| !cuts(*i)) else {
        let mut ring = points.to_vec();
        ring.extend(points.first());
        return vec![Piece { points: ring, depth: deepest(&mut depths.iter().copied()), is_ring: true }];
    };
    let mut found = Vec::new();
    let mut current: Option<Piece> = None;
    for i in free..=free + count {
        let (Some(point), Some(depth)) = (points.get(i % count), depths.get(i % count)) else { continue };
        if cuts(i) {
            let begin = points.get((i + count - 1) % count).unwrap_or(point);
            let piece = current.get_or_insert_with(|| Piece { points: vec![*begin], depth: 0.0, is_ring: false });
            piece.points.push(*point);
            piece.depth = piece.depth.max(*depth);
        } else if let Some(mut piece) = current.take() {
            piece.points.push(*point);
            found.push(piece);
        }
    }
    found
}

/// A closed contour with corners at most `step` apart.
fn divided(contour: &[Point], step: f64) -> Vec<Point> {
    let mut points = Vec::new();
    for (a, b) in sides(contour) {
        let length = libm::hypot(b[0] - a[0], b[1] - a[1]);
        if length < NOISE {
            continue;
        }
        let parts = libm::ceil(length / step).max(1.0) as usize;
        for part in 0..parts {
            let share = part as f64 / parts as f64;
            points.push([0, 1].map(|i| a[i] + share * (b[i] - a[i])));
        }
    }
    points
}

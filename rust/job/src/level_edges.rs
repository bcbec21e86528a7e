//! Sharp convex edges between level faces and the walls that go down from them: where they are, and how they follow each other.

use std::collections::{BTreeMap, HashMap, HashSet};

use styluscam_geometry::{ChamferEdge, Mesh, NurbsCurve, Vector};

use crate::Scene;

/// Normals of a level face differ from the vertical by less, in plan.
const LEVEL: f64 = 1e-4;
/// Heights that differ by less are the same, mm.
const SAME: f64 = 1e-4;
/// Walls that lean more in or out are no walls, rad.
pub(crate) const MOST_LEAN: f64 = 1.05;
/// How far a triangle's side lies beside a named edge's curve at most, beyond what its triangles are off, mm.
pub(crate) const BESIDE: f64 = 0.01;
/// Chords of a curve to which that is measured, at least and at most.
const CHORDS: usize = 512;
const MOST: usize = 65_536;
/// And what they are off at most, mm.
const SAG: f64 = 0.002;

/// A straight piece of an edge, with the level face on its left.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EdgePiece {
    /// Its place and its neighbours.
    pub edge: ChamferEdge,
    /// The level face and the wall.
    pub faces: [u32; 2],
}

impl EdgePiece {
    /// As a person names it.
    pub fn name(&self) -> String {
        format!("Face{} to Face{}", self.faces[0], self.faces[1])
    }
}

/// Pieces that follow each other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EdgeChain {
    /// In the order in which they follow each other.
    pub pieces: Vec<EdgePiece>,
    /// Whether the first follows the last.
    pub closed: bool,
}

/// What a corner measures, to the bit: faces of a STEP part share no vertex.
pub(crate) type Key = [u64; 3];

pub(crate) fn key(point: Vector) -> Key {
    <[u64; 3]>::from((point + Vector::zeros()).map(f64::to_bits))
}

/// The edges at the borders of the level ones of some faces whose walls lean by less than `most_lean` (rad), those of `named` curves alone
/// where some are given.
pub(crate) fn level_edges(
    scene: &Scene,
    faces: &[u32],
    named: Option<&[NurbsCurve]>,
    most_lean: f64,
) -> Vec<EdgeChain> {
    let mesh = &scene.mesh;
    let faces: HashSet<u32> = faces.iter().copied().collect();
    let mut others: HashMap<(Key, Key), usize> = HashMap::new();
    for triangle in 0..mesh.triangles().len() {
        for [a, b] in sides(mesh, triangle) {
            others.insert((key(a), key(b)), triangle);
        }
    }
    let is_meant = |triangle: &usize| mesh.faces().get(*triangle).is_some_and(|face| faces.contains(face));
    let level = (0..mesh.triangles().len()).filter(is_meant).filter(|triangle| is_level(mesh, *triangle));
    let all = level.flat_map(|triangle| {
        let others = &others;
        sides(mesh, triangle).into_iter().filter_map(move |ends| {
            let wall = *others.get(&(key(ends[1]), key(ends[0])))?;
            piece(mesh, ends, [triangle, wall])
        })
    });
    let curves = named.map(|curves| curves.iter().map(|curve| chords(scene, curve)).collect::<Vec<_>>());
    let near = BESIDE + scene.inward + scene.outward;
    let is_named = |piece: &EdgePiece| {
        let on = |curve: &Vec<Vector>| piece.edge.ends.iter().all(|end| beside(curve, *end) <= near);
        curves.as_ref().is_none_or(|curves| curves.iter().any(on))
    };
    chained(all.filter(|piece| piece.edge.lean < most_lean).filter(is_named).collect())
}

/// Whether some pieces lie on a curve of the part's file.
pub(crate) fn has_curve(scene: &Scene, chains: &[EdgeChain], curve: &NurbsCurve) -> bool {
    let (chords, near) = (chords(scene, curve), BESIDE + scene.inward + scene.outward);
    let mut pieces = chains.iter().flat_map(|chain| &chain.pieces);
    pieces.any(|piece| piece.edge.ends.iter().all(|end| beside(&chords, *end) <= near))
}

pub(crate) fn sides(mesh: &Mesh, triangle: usize) -> [[Vector; 2]; 3] {
    let [a, b, c] = mesh.corners(triangle);
    [[a, b], [b, c], [c, a]]
}

fn is_level(mesh: &Mesh, triangle: usize) -> bool {
    let normal = mesh.normal(triangle);
    normal.z > 0.0 && libm::hypot(normal.x, normal.y) <= LEVEL
}

/// A side of a level triangle, if beyond it a wall goes down.
fn piece(mesh: &Mesh, ends: [Vector; 2], [level, wall]: [usize; 2]) -> Option<EdgePiece> {
    let along = (ends[1] - ends[0]).try_normalize(0.0)?;
    let inward = Vector::new(-along.y, along.x, 0.0).try_normalize(0.0)?;
    let normal = mesh.normal(wall);
    let top = ends[0].z;
    let lowest = mesh.corners(wall).iter().map(|corner| corner.z).fold(f64::INFINITY, f64::min);
    let lean = if mesh.is_upright(wall) { 0.0 } else { libm::asin(normal.z.clamp(-1.0, 1.0)) };
    let goes_down = lowest < top - SAME && normal.dot(&inward) < 0.0;
    let is_level = (ends[1].z - top).abs() <= SAME;
    let face = |triangle: usize| mesh.faces().get(triangle).copied().unwrap_or(0);
    (goes_down && is_level && lean.abs() <= MOST_LEAN).then(|| EdgePiece {
        edge: ChamferEdge { ends, inward, lean, miters: [along, along] },
        faces: [face(level), face(wall)],
    })
}

/// Pieces in the order in which they follow each other, each with the planes that halve its corners.
fn chained(pieces: Vec<EdgePiece>) -> Vec<EdgeChain> {
    let mut starts: HashMap<Key, Vec<usize>> = HashMap::new();
    let mut ends: HashMap<Key, usize> = HashMap::new();
    for (number, piece) in pieces.iter().enumerate() {
        starts.entry(key(piece.edge.ends[0])).or_default().push(number);
        ends.insert(key(piece.edge.ends[1]), number);
    }
    let mut left: BTreeMap<usize, EdgePiece> = pieces.into_iter().enumerate().collect();
    // open ones from their beginnings; what is left then goes around
    let begins = |piece: &EdgePiece| !ends.contains_key(&key(piece.edge.ends[0]));
    let mut order: Vec<usize> = left.iter().filter(|(_, piece)| begins(piece)).map(|(number, _)| *number).collect();
    order.extend(left.keys().copied().collect::<Vec<_>>());
    let mut chains = Vec::new();
    for first in order {
        let Some(piece) = left.remove(&first) else { continue };
        let begin = key(piece.edge.ends[0]);
        let mut chain = vec![piece];
        let mut at = chain.last().map(|piece| piece.edge.ends[1]);
        while let Some(next) = at.and_then(|at| following(&starts, &left, key(at), chain.last())) {
            chain.extend(left.remove(&next));
            at = chain.last().map(|piece| piece.edge.ends[1]);
        }
        let closed = chain.len() > 2 && at.is_some_and(|at| key(at) == begin);
        miter(&mut chain, closed);
        chains.push(EdgeChain { pieces: chain, closed });
    }
    chains
}

/// The piece that goes on from a corner, of several the one that turns least.
fn following(
    starts: &HashMap<Key, Vec<usize>>,
    left: &BTreeMap<usize, EdgePiece>,
    corner: Key,
    last: Option<&EdgePiece>,
) -> Option<usize> {
    let straightness = |number: &usize| {
        let next = left.get(number)?.edge.along();
        Some((*number, next.dot(&last?.edge.along())))
    };
    let all = starts.get(&corner)?.iter().filter_map(straightness);
    all.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(number, _)| number)
}

fn miter(chain: &mut [EdgePiece], closed: bool) {
    let along: Vec<Vector> = chain.iter().map(|piece| piece.edge.along()).collect();
    let count = along.len();
    let half = |a: usize, b: usize| Some((along.get(a)? + along.get(b)?).try_normalize(1e-6)).flatten();
    for (i, piece) in chain.iter_mut().enumerate() {
        let own = piece.edge.along();
        let before = if i > 0 { half(i - 1, i) } else { closed.then(|| half(count - 1, i)).flatten() };
        let after = if i + 1 < count { half(i, i + 1) } else { closed.then(|| half(i, 0)).flatten() };
        piece.edge.miters = [before.unwrap_or(own), after.unwrap_or(own)];
    }
}

/// A curve of the part's file in chords, work coordinates.
pub(crate) fn chords(scene: &Scene, curve: &NurbsCurve) -> Vec<Vector> {
    let [from, to] = curve.domain();
    let points = |count: usize| -> Vec<Vector> {
        let at = |i: usize| curve.at(from + (to - from) * i as f64 / count as f64).point;
        (0..=count).map(|i| scene.frame.point(at(i))).collect()
    };
    let few = points(CHORDS);
    let length: f64 = few.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    // of a circle so many chords are off by no more
    let count = (0.25 * std::f64::consts::PI * length / SAG).sqrt().ceil() as usize;
    if count <= CHORDS {
        few
    } else {
        points(count.min(MOST))
    }
}

/// How far a point lies beside a line of chords, mm.
pub(crate) fn beside(chords: &[Vector], point: Vector) -> f64 {
    let of_chord = |pair: &[Vector]| match pair {
        [a, b] => {
            let along = b - a;
            let square = along.norm_squared();
            let share = if square > 0.0 { ((point - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
            (a + along * share - point).norm()
        }
        _ => f64::INFINITY,
    };
    chords.windows(2).map(of_chord).fold(f64::INFINITY, f64::min)
}

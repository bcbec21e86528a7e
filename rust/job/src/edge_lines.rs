//! Level edges of the part as lines in plan: named ones, joined end to end, or those of level faces; and the walls beside them.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use styluscam_geometry::{Mesh, NurbsCurve, Vector};

use crate::level_edges::{beside, chords, key, level_edges, sides, EdgeChain, Key, BESIDE};
use crate::{JobError, Scene};

/// Heights of a level edge differ by less, mm.
const LEVEL: f64 = 1e-3;
/// Walls that lean by less are upright, rad.
const UPRIGHT: f64 = 1e-3;
/// Feet of walls whose heights differ by less are one, mm.
const SAME_FOOT: f64 = 1e-3;
/// The share of an edge's length that its triangles' sides show at least.
const WHOLE: f64 = 0.98;
/// Edges that are named in a message at most.
const MOST_NAMES: usize = 6;

/// A straight piece of a line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinePiece {
    /// Its ends, in the line's direction.
    pub ends: [Vector; 2],
    /// As a person names it: "Edge3", "Face1 to Face4".
    pub name: String,
    /// Lowest and highest point of the upright wall beside it, mm; none where there is none.
    wall: Option<[f64; 2]>,
}

/// Level edges that follow each other.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EdgeLine {
    pub pieces: Vec<LinePiece>,
    pub closed: bool,
}

impl EdgeLine {
    /// Its height, mm.
    pub fn height(&self) -> f64 {
        self.pieces.first().map_or(0.0, |piece| piece.ends[0].z)
    }

    /// Its corners in plan; of a closed line the first is not repeated.
    pub fn corners(&self) -> Vec<[f64; 2]> {
        let plan = |point: &Vector| [point.x, point.y];
        let last = self.pieces.last().filter(|_| !self.closed).map(|piece| plan(&piece.ends[1]));
        self.pieces.iter().map(|piece| plan(&piece.ends[0])).chain(last).collect()
    }

    /// The edges of which it consists, in words.
    pub fn name(&self) -> String {
        let mut names: Vec<&str> = Vec::new();
        for piece in &self.pieces {
            if !names.contains(&piece.name.as_str()) {
                names.push(&piece.name);
            }
        }
        let few = names.get(..MOST_NAMES).unwrap_or(&names);
        let more = names.len() - few.len();
        few.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
    }

    /// Where the walls beside it end below, mm; none where they end at several heights, or some piece has no upright wall.
    pub fn foot(&self) -> Option<f64> {
        let feet: Option<Vec<f64>> = self.pieces.iter().map(|piece| piece.wall.map(|[foot, _]| foot)).collect();
        let feet = feet?;
        let first = *feet.first()?;
        feet.iter().all(|foot| (foot - first).abs() <= SAME_FOOT).then_some(first)
    }

    /// The highest point of itself and of the walls beside it, mm.
    pub fn top(&self) -> f64 {
        self.pieces.iter().filter_map(|piece| piece.wall).map(|[_, top]| top).fold(self.height(), f64::max)
    }

    fn reversed(mut self) -> Self {
        self.pieces.reverse();
        self.pieces.iter_mut().for_each(|piece| piece.ends.reverse());
        self
    }

    /// A closed line counterclockwise; an open one as it is.
    fn counterclockwise(self) -> Self {
        let cross = |piece: &LinePiece| piece.ends[0].x * piece.ends[1].y - piece.ends[0].y * piece.ends[1].x;
        let is_clockwise = self.closed && self.pieces.iter().map(cross).sum::<f64>() < 0.0;
        if is_clockwise {
            return self.reversed();
        }
        self
    }
}

/// The edges at the borders of level faces from which an upright wall goes down; of closed ones those with the wall outside of them,
/// or inside, where that is stated.
pub(crate) fn lines_of_faces(scene: &Scene, faces: &[u32], wall_is_outside: Option<bool>) -> Vec<EdgeLine> {
    let walls = Walls::of(&scene.mesh);
    let line = |chain: EdgeChain| {
        let piece = |piece: &crate::level_edges::EdgePiece| LinePiece {
            ends: piece.edge.ends,
            name: piece.name(),
            wall: walls.ranges.get(&piece.faces[1]).copied(),
        };
        EdgeLine { pieces: chain.pieces.iter().map(piece).collect(), closed: chain.closed }
    };
    // the level face is on the left
    let is_outside = |line: &EdgeLine| line.clone().counterclockwise() == *line;
    let all = level_edges(scene, faces, None, UPRIGHT).into_iter().map(line);
    let on_that_side =
        |line: &EdgeLine| wall_is_outside.is_none_or(|outside| line.closed && is_outside(line) == outside);
    all.filter(on_that_side).map(EdgeLine::counterclockwise).collect()
}

/// The lines along named edges; `path` is the operation's.
///
/// # Errors
/// Edges that are not level, or that are at the border of no face, and more than two that meet in a point.
pub(crate) fn lines_of_edges(
    scene: &Scene,
    (names, curves): (&[String], &[NurbsCurve]),
    path: &str,
) -> Result<Vec<EdgeLine>, JobError> {
    let named = Named::new(scene, curves);
    let at = |number: usize| format!("{path}.edge_names[{number}]");
    for (number, (chords, name)) in named.chords.iter().zip(names).enumerate() {
        let heights = chords.iter().map(|point| point.z);
        let [low, high] = [f64::min, f64::max].map(|of| heights.clone().reduce(of).unwrap_or_default());
        if high - low > LEVEL {
            let message = format!("{name} is not level: it rises by {:.3} mm", high - low);
            let hint = "name level edges only, or mill the wall below a rising one with kind = \"z-level\"";
            return Err(JobError::document("not-level", at(number), message, hint));
        }
    }
    let pieces = named.pieces(scene, names);
    for (number, (chords, name)) in named.chords.iter().zip(names).enumerate() {
        let found: f64 = pieces.iter().filter(|(of, _)| *of == number).map(|(_, piece)| length(piece.ends)).sum();
        let whole: f64 = chords.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        let is_twice = names.iter().take(number).any(|other| other == name);
        if found < WHOLE * whole && !is_twice {
            let message = format!("{name} is no edge between two faces along its whole length");
            return Err(JobError::document("no-edge", at(number), message, "name edges at which faces meet"));
        }
    }
    joined(&pieces, &named, path)
}

fn length([a, b]: [Vector; 2]) -> f64 {
    (b - a).norm()
}

/// The upright walls of a mesh.
struct Walls {
    /// Lowest and highest point by their face, mm.
    ranges: HashMap<u32, [f64; 2]>,
}

impl Walls {
    fn of(mesh: &Mesh) -> Self {
        let mut ranges: HashMap<u32, [f64; 2]> = HashMap::new();
        for triangle in (0..mesh.triangles().len()).filter(|triangle| mesh.is_upright(*triangle)) {
            let face = mesh.faces().get(triangle).copied().unwrap_or(0);
            let range = ranges.entry(face).or_insert([f64::INFINITY, f64::NEG_INFINITY]);
            for corner in mesh.corners(triangle) {
                *range = [range[0].min(corner.z), range[1].max(corner.z)];
            }
        }
        Self { ranges }
    }

    /// Of the walls among two triangles.
    fn beside(&self, mesh: &Mesh, triangles: impl Iterator<Item = usize>) -> Option<[f64; 2]> {
        let of = |triangle: usize| {
            let face = mesh.faces().get(triangle).copied().unwrap_or(0);
            self.ranges.get(&face).copied().filter(|_| mesh.is_upright(triangle))
        };
        triangles.filter_map(of).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// The curves of named edges in chords, work coordinates.
struct Named {
    chords: Vec<Vec<Vector>>,
    /// How far triangles' sides lie beside them at most, mm.
    near: f64,
}

impl Named {
    fn new(scene: &Scene, curves: &[NurbsCurve]) -> Self {
        let chords = curves.iter().map(|curve| chords(scene, curve)).collect();
        Self { chords, near: BESIDE + scene.inward + scene.outward }
    }

    /// The number of the first curve on which a side of a triangle lies.
    fn number(&self, ends: [Vector; 2]) -> Option<usize> {
        let is_on = |chords: &Vec<Vector>| {
            let height = chords.first().map_or(f64::NAN, |point| point.z);
            ends.iter().all(|end| (end.z - height).abs() <= self.near)
                && ends.iter().all(|end| beside(chords, *end) <= self.near)
        };
        self.chords.iter().position(is_on)
    }

    /// The sides of triangles on the curves between faces, each once, with the number of its curve.
    fn pieces(&self, scene: &Scene, names: &[String]) -> Vec<(usize, LinePiece)> {
        let mesh = &scene.mesh;
        let walls = Walls::of(mesh);
        let mut owners: HashMap<(Key, Key), usize> = HashMap::new();
        for triangle in 0..mesh.triangles().len() {
            for [a, b] in sides(mesh, triangle) {
                owners.insert((key(a), key(b)), triangle);
            }
        }
        let face = |triangle: usize| mesh.faces().get(triangle);
        let mut found = Vec::new();
        for triangle in 0..mesh.triangles().len() {
            for ends in sides(mesh, triangle) {
                let (a, b) = (key(ends[0]), key(ends[1]));
                let other = owners.get(&(b, a)).copied();
                let is_within = other.is_some_and(|other| face(other) == face(triangle));
                let is_seen = other.is_some() && b < a; // from its other side
                if is_within || is_seen || a == b {
                    continue;
                }
                let Some(number) = self.number(ends) else { continue };
                let wall = walls.beside(mesh, std::iter::once(triangle).chain(other));
                let name = names.get(number).cloned().unwrap_or_default();
                found.push((number, LinePiece { ends, name, wall }));
            }
        }
        found
    }
}

/// Pieces in the order in which they follow each other: open lines from the first named edge on, which alone runs as its curve does; closed ones
/// counterclockwise.
fn joined(pieces: &[(usize, LinePiece)], named: &Named, path: &str) -> Result<Vec<EdgeLine>, JobError> {
    let mut meeting: BTreeMap<Key, Vec<usize>> = BTreeMap::new();
    for (number, (_, piece)) in pieces.iter().enumerate() {
        for end in piece.ends {
            meeting.entry(key(end)).or_default().push(number);
        }
    }
    let branch = meeting.values().find(|numbers| numbers.len() > 2);
    if let Some((edge, piece)) = branch.and_then(|numbers| pieces.get(*numbers.last()?)) {
        let [x, y] = [piece.ends[0].x, piece.ends[0].y];
        let message = format!("more than two of the edges meet near X{x:.3} Y{y:.3}, among them {}", piece.name);
        let hint = "name edges that follow each other in one line, and others in an operation of their own";
        return Err(JobError::document("branching", format!("{path}.edge_names[{edge}]"), message, hint));
    }
    let mut left: BTreeSet<usize> = (0..pieces.len()).collect();
    let mut order: Vec<usize> = left.iter().copied().collect();
    order.sort_by_key(|number| pieces.get(*number).map(|(edge, _)| *edge));
    let ends: Vec<usize> =
        order.iter().copied().filter(|number| is_end(&meeting, pieces.get(*number).map(|(_, piece)| piece))).collect();
    let mut lines = Vec::new();
    for first in ends.into_iter().chain(order) {
        if !left.remove(&first) {
            continue;
        }
        let Some((edge, piece)) = pieces.get(first).cloned() else { continue };
        // from its free end on
        let is_free = |at: Vector| meeting.get(&key(at)).is_none_or(|numbers| numbers.len() < 2);
        let turned = is_free(piece.ends[1]) && !is_free(piece.ends[0]);
        let mut line = vec![(edge, if turned { back(piece) } else { piece })];
        while let Some((next, end)) = line.last().and_then(|(_, last)| {
            let end = last.ends[1];
            Some((*meeting.get(&key(end))?.iter().find(|number| left.contains(number))?, end))
        }) {
            left.remove(&next);
            let Some((edge, piece)) = pieces.get(next).cloned() else { break };
            line.push((edge, if key(piece.ends[0]) == key(end) { piece } else { back(piece) }));
        }
        lines.push(directed(line, named));
    }
    // as they are named
    lines.sort_by_key(|(first, _)| *first);
    Ok(lines.into_iter().map(|(_, line)| line).collect())
}

fn is_end(meeting: &BTreeMap<Key, Vec<usize>>, piece: Option<&LinePiece>) -> bool {
    let alone = |end: &Vector| meeting.get(&key(*end)).is_none_or(|numbers| numbers.len() < 2);
    piece.is_some_and(|piece| piece.ends.iter().any(alone))
}

fn back(mut piece: LinePiece) -> LinePiece {
    piece.ends.reverse();
    piece
}

/// A line in its direction, with the lowest number of its edges.
fn directed(line: Vec<(usize, LinePiece)>, named: &Named) -> (usize, EdgeLine) {
    let numbers: Vec<usize> = line.iter().map(|(edge, _)| *edge).collect();
    let lowest = numbers.iter().copied().min().unwrap_or_default();
    let pieces: Vec<LinePiece> = line.into_iter().map(|(_, piece)| piece).collect();
    let end = |piece: Option<&LinePiece>, i: usize| piece.map(|piece| key(piece.ends[i]));
    let closed = pieces.len() > 2 && end(pieces.first(), 0) == end(pieces.last(), 1);
    let line = EdgeLine { pieces, closed };
    if closed {
        return (lowest, line.counterclockwise());
    }
    let position = |number: usize| numbers.iter().position(|other| *other == number);
    let second = numbers.iter().copied().filter(|number| *number != lowest).min();
    let is_forward = match second {
        Some(second) => position(lowest) <= position(second),
        None => {
            let begin = named.chords.get(lowest).and_then(|chords| chords.first());
            let apart = |piece: Option<&LinePiece>, i: usize| {
                piece.zip(begin).map_or(0.0, |(piece, begin)| (piece.ends[i] - begin).norm())
            };
            apart(line.pieces.first(), 0) <= apart(line.pieces.last(), 1)
        }
    };
    (lowest, if is_forward { line } else { line.reversed() })
}

//! A mesh's faces: as a person would name them, found from the triangles alone.
//!
//! Three steps. *Facets*: triangles in one plane grow together, the largest first. *Turns*: two facets are one curved
//! face where the angle between them is one of a series (a neighbour of either turns about as much) and where both are
//! about as wide: so the strips of a tessellated cylinder join, but not the flat beside it, and a fold between two flats
//! stays a crease however small it is. *Noise*: where creases meet everywhere, as on a rough scan, small faces around such
//! corners are one.

use rayon::prelude::*;

use super::edges::{ends, Edges};
use super::shapes::{shape_of, Shape};
use super::triangles::{area_vector, bounds};
use super::union_find::Union;
use crate::Vector;

/// Corners of one facet lie on one plane within this share of the part's size,
const FLATNESS: f64 = 2e-6;
/// or within so many units of single precision at the part's farthest coordinate,
const SINGLE: f64 = 4.0 / 16_777_216.0;
/// and its triangles' normals within this angle of its own, rad.
const DEVIATION: f64 = 0.035;
/// Facets that meet at a larger angle are different faces, rad: a circle of ten sides (36 degrees) is still round, a
/// chamfer is a chamfer.
const LARGEST_TURN: f64 = 0.646;
/// Turns are of one series where none is so many times another.
const LIKE_TURN: f64 = 3.0;
/// Facets are about as wide where neither is so many times the other.
const LIKE_WIDTH: f64 = 5.0;
/// A facet is a curved face's where this share of its border could bend into it.
const MOSTLY: f64 = 0.5;
/// Fewer facets than this are no curved face.
const FEW: usize = 3;
/// At a corner where so many faces meet, the surface is rough;
const MANY: usize = 4;
/// a face is, where that is so at this share of its corners,
const ROUGH_SHARE: f64 = 0.1;
/// and the part is noisy where there are no fewer such corners than this, and this share of all on creases.
const ROUGH_CORNERS: (usize, f64) = (20, 0.03);
/// A face may be a part of a rough one, or an island in a curved one, with no more than this share of the part's area;
const SMALL_AREA: f64 = 0.01;
/// an island has so few triangles, of a noisy part any number,
const ISLAND: [usize; 2] = [4, usize::MAX];
/// and this share of its border with one curved face, of a noisy part with curved faces.
const SURROUNDED: f64 = 0.8;
/// Rounds of joining.
const ROUNDS: usize = 12;

/// The face of each triangle, from 1, and the shape of each.
pub fn of(vertices: &[Vector], triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<Shape>) {
    let surface = Surface::new(vertices, triangles);
    let facets = facets(&surface);
    let flat = Facets::of(&surface, &facets);
    let mut together = joined_turns(&surface, &facets, &flat);
    join_noise(&surface, &facets, &flat, &mut together);
    numbered(&surface, &facets, &flat, &mut together)
}

/// Triangles in an order of their own: by their corners, each beginning at its first one.
struct Surface<'a> {
    vertices: &'a [Vector],
    triangles: Vec<[u32; 3]>,
    /// The triangle's number in the file.
    given: Vec<u32>,
    edges: Edges,
    /// Twice the area along the normal.
    areas: Vec<Vector>,
    flatness: f64,
}

impl<'a> Surface<'a> {
    fn new(vertices: &'a [Vector], triangles: &[[u32; 3]]) -> Self {
        let turned = |corners: &[u32; 3]| {
            let first = (0..3).min_by_key(|k| corners[*k]).unwrap_or(0);
            [corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]]
        };
        let mut order: Vec<([u32; 3], u32)> =
            triangles.par_iter().enumerate().map(|(t, corners)| (turned(corners), t as u32)).collect();
        order.par_sort_unstable();
        let (triangles, given): (Vec<_>, Vec<_>) = order.into_iter().unzip();
        let (low, high) = bounds(vertices.iter().copied());
        let flatness = (FLATNESS * (high - low).norm()).max(SINGLE * low.amax().max(high.amax()));
        let edges = Edges::of(&triangles);
        let areas = triangles.par_iter().map(|corners| area_vector(vertices, *corners)).collect();
        Self { vertices, triangles, given, edges, areas, flatness }
    }

    /// Whether a triangle is so low that its normal is unreliable.
    fn is_sliver(&self, t: usize) -> bool {
        let [a, b, c] = self.triangles[t].map(|i| self.vertices[i as usize]);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        self.areas[t].norm() <= 4.0 * self.flatness * longest
    }

    fn side(&self, half: u32) -> f64 {
        let (a, b) = ends(&self.triangles, half);
        (self.vertices[a as usize] - self.vertices[b as usize]).norm()
    }
}

const NO_FACET: u32 = u32::MAX;

/// The facet of each triangle: connected triangles in the plane of the largest of them.
fn facets(surface: &Surface) -> Vec<u32> {
    let count = surface.triangles.len();
    let slivers: Vec<bool> = (0..count).into_par_iter().map(|t| surface.is_sliver(t)).collect();
    let mut seeds: Vec<(f64, u32)> = (0..count).map(|t| (-surface.areas[t].norm_squared(), t as u32)).collect();
    seeds.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (mut facet, mut next, mut stack) = (vec![NO_FACET; count], 0, Vec::new());
    for (_, seed) in seeds.iter().filter(|(_, t)| !slivers[*t as usize]) {
        if facet[*seed as usize] != NO_FACET {
            continue;
        }
        let normal = surface.areas[*seed as usize].normalize();
        let height = normal.dot(&surface.vertices[surface.triangles[*seed as usize][0] as usize]);
        let belongs = |t: u32| {
            let corners = surface.triangles[t as usize].map(|i| surface.vertices[i as usize]);
            let area = surface.areas[t as usize];
            corners.iter().all(|corner| (normal.dot(corner) - height).abs() <= surface.flatness)
                && (slivers[t as usize] || area.dot(&normal) >= libm::cos(DEVIATION) * area.norm())
        };
        facet[*seed as usize] = next;
        stack.push(*seed);
        while let Some(t) = stack.pop() {
            for other in (3 * t..3 * t + 3).filter_map(|half| surface.edges.beyond(half)) {
                if facet[other as usize] == NO_FACET && belongs(other) {
                    facet[other as usize] = next;
                    stack.push(other);
                }
            }
        }
        next += 1;
    }
    place_slivers(surface, &mut facet, next);
    facet
}

/// Gives slivers that lie in nobody's plane to the neighbour at their longest side.
fn place_slivers(surface: &Surface, facet: &mut [u32], mut next: u32) {
    let mut left: Vec<u32> = (0..facet.len() as u32).filter(|t| facet[*t as usize] == NO_FACET).collect();
    while !left.is_empty() {
        let found: Vec<(u32, u32)> = left
            .iter()
            .filter_map(|t| {
                let sides = (3 * t..3 * t + 3).filter_map(|half| Some((half, surface.edges.beyond(half)?)));
                let known = sides.filter(|(_, other)| facet[*other as usize] != NO_FACET);
                let longest = known.max_by(|a, b| surface.side(a.0).total_cmp(&surface.side(b.0)))?;
                Some((*t, facet[longest.1 as usize]))
            })
            .collect();
        if let (true, Some(t)) = (found.is_empty(), left.first()) {
            facet[*t as usize] = next;
            next += 1;
        }
        found.into_iter().for_each(|(t, of)| facet[t as usize] = of);
        left.retain(|t| facet[*t as usize] == NO_FACET);
    }
}

/// What facets are, by number.
struct Facets {
    /// Twice the area along the normal.
    areas: Vec<Vector>,
    triangles: Vec<usize>,
}

impl Facets {
    fn of(surface: &Surface, facet: &[u32]) -> Self {
        let count = facet.iter().max().map_or(0, |last| *last as usize + 1);
        let (mut areas, mut triangles) = (vec![Vector::zeros(); count], vec![0; count]);
        for (t, of) in facet.iter().enumerate() {
            areas[*of as usize] += surface.areas[t];
            triangles[*of as usize] += 1;
        }
        Self { areas, triangles }
    }

    fn area(&self, facet: u32) -> f64 {
        0.5 * self.areas[facet as usize].norm()
    }
}

/// Two facets that meet.
struct Turn {
    facets: [u32; 2],
    /// Between their normals, rad.
    angle: f64,
    /// Whether they are about as wide, seen from the edge between them.
    is_even: bool,
    /// Of the edge between them, mm.
    length: f64,
}

impl Turn {
    fn may_bend(&self) -> bool {
        self.is_even && self.angle <= LARGEST_TURN
    }

    fn is_like(&self, other: &Self) -> bool {
        let (low, high) = (self.angle.min(other.angle), self.angle.max(other.angle));
        high <= LIKE_TURN * low
    }
}

/// All pairs of facets that meet along edges of two triangles.
fn turns(surface: &Surface, facet: &[u32], facets: &Facets) -> Vec<Turn> {
    let mut sides: Vec<([u32; 2], u32)> = (0..surface.edges.twins.len() as u32)
        .into_par_iter()
        .filter_map(|half| {
            let other = surface.edges.beyond(half)?;
            let (a, b) = (facet[half as usize / 3], facet[other as usize]);
            (a < b).then_some(([a, b], half))
        })
        .collect();
    sides.par_sort_unstable();
    let pairs: Vec<&[([u32; 2], u32)]> = sides.chunk_by(|a, b| a.0 == b.0).collect();
    let turn = |pair: &&[([u32; 2], u32)]| {
        let [a, b] = pair[0].0;
        let (normal_a, normal_b) = (facets.areas[a as usize], facets.areas[b as usize]);
        let length: f64 = pair.iter().map(|(_, half)| surface.side(*half)).sum();
        let widths = [facets.area(a) / length, facets.area(b) / length];
        Turn {
            facets: [a, b],
            angle: libm::atan2(normal_a.cross(&normal_b).norm(), normal_a.dot(&normal_b)),
            is_even: widths[0] <= LIKE_WIDTH * widths[1] && widths[1] <= LIKE_WIDTH * widths[0],
            length,
        }
    };
    pairs.par_iter().map(turn).collect()
}

/// All turns, and those of each facet.
struct Turns {
    all: Vec<Turn>,
    /// Facet and turn, by facet.
    beside: Vec<(u32, u32)>,
    starts: Vec<usize>,
}

impl Turns {
    fn of(all: Vec<Turn>, facets: usize) -> Self {
        let mut beside: Vec<(u32, u32)> =
            all.iter().enumerate().flat_map(|(i, turn)| turn.facets.map(|f| (f, i as u32))).collect();
        beside.par_sort_unstable();
        let mut starts = vec![0; facets + 1];
        beside.iter().for_each(|(f, _)| starts[*f as usize + 1] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        Self { all, beside, starts }
    }

    fn at(&self, facet: u32) -> impl Iterator<Item = usize> + '_ {
        let own = self.starts[facet as usize]..self.starts[facet as usize + 1];
        self.beside[own].iter().map(|(_, i)| *i as usize)
    }

    /// Whether a neighbour of either facet turns about as much.
    fn is_of_series(&self, i: usize) -> bool {
        let turn = &self.all[i];
        let is_like = |j: usize| j != i && self.all[j].angle <= LARGEST_TURN && turn.is_like(&self.all[j]);
        turn.may_bend() && turn.facets.iter().any(|f| self.at(*f).any(is_like))
    }

    /// The curved face that most of a facet's border could bend into.
    fn surrounding(&self, facet: u32, together: &mut Union, sizes: &[usize]) -> Option<u32> {
        let mut shares: Vec<(u32, f64)> = Vec::new();
        let mut border = 0.0;
        for turn in self.at(facet).map(|i| &self.all[i]) {
            border += turn.length;
            let beyond = together.root(turn.facets[usize::from(turn.facets[0] == facet)]);
            if turn.may_bend() && sizes[beyond as usize] >= FEW {
                match shares.iter_mut().find(|(known, _)| *known == beyond) {
                    Some((_, share)) => *share += turn.length,
                    None => shares.push((beyond, turn.length)),
                }
            }
        }
        let most = shares.into_iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?;
        (most.1 >= MOSTLY * border).then_some(most.0)
    }
}

/// Facets joined to curved faces.
fn joined_turns(surface: &Surface, facet: &[u32], facets: &Facets) -> Union {
    let count = facets.areas.len();
    let turns = Turns::of(turns(surface, facet, facets), count);
    let bends: Vec<bool> = (0..turns.all.len()).into_par_iter().map(|i| turns.is_of_series(i)).collect();
    let mut together = Union::new(count);
    for (turn, _) in turns.all.iter().zip(&bends).filter(|(_, bends)| **bends) {
        together.join(turn.facets[0], turn.facets[1]);
    }
    let sizes = Faces::of(facets, &mut together).facets;
    // a facet of its own is its own root; other roots count more than themselves, the rest nothing
    let alone: Vec<u32> = (0..count as u32).filter(|f| sizes[*f as usize] == 1).collect();
    let joins: Vec<(u32, u32)> =
        alone.iter().filter_map(|f| Some((*f, turns.surrounding(*f, &mut together, &sizes)?))).collect();
    joins.iter().for_each(|(f, face)| together.join(*f, *face));
    together
}

/// Triangles and area of each face, by the number of its first facet; more than one facet makes it curved.
struct Faces {
    triangles: Vec<usize>,
    area: Vec<f64>,
    facets: Vec<usize>,
    total: f64,
}

impl Faces {
    fn of(facets: &Facets, together: &mut Union) -> Self {
        let count = facets.areas.len();
        let mut faces = Self { triangles: vec![0; count], area: vec![0.0; count], facets: vec![0; count], total: 0.0 };
        for f in 0..count as u32 {
            let root = together.root(f) as usize;
            faces.triangles[root] += facets.triangles[f as usize];
            faces.area[root] += facets.area(f);
            faces.facets[root] += 1;
            faces.total += facets.area(f);
        }
        faces
    }

    fn is_small(&self, face: u32) -> bool {
        self.area[face as usize] <= SMALL_AREA * self.total
    }

    fn is_curved(&self, face: u32) -> bool {
        self.facets[face as usize] >= FEW
    }
}

/// Joins small faces where creases meet everywhere, and islands of few triangles in curved faces.
fn join_noise(surface: &Surface, facet: &[u32], facets: &Facets, together: &mut Union) {
    let mut is_noisy = false;
    for _ in 0..ROUNDS {
        let faces = Faces::of(facets, together);
        let face_of: Vec<u32> = facet.iter().map(|f| together.root(*f)).collect();
        let corners = faces_at_corners(surface, &face_of);
        let (mut all, mut many) = (0_usize, 0_usize);
        for at in corners.chunk_by(|a, b| a.0 == b.0) {
            (all, many) = (all + 1, many + usize::from(at.len() >= MANY));
        }
        is_noisy |= many >= ROUGH_CORNERS.0 && many as f64 >= ROUGH_CORNERS.1 * all as f64;
        let mut joins = islands(surface, &face_of, &faces, is_noisy);
        if is_noisy {
            joins.extend(rough_faces(&corners, &faces));
        }
        if joins.is_empty() {
            return;
        }
        joins.iter().for_each(|(a, b)| together.join(*a, *b));
    }
}

/// Pairs of faces that meet at corners where many do, and are rough themselves or the curved face around them.
fn rough_faces(corners: &[(u32, u32)], faces: &Faces) -> Vec<(u32, u32)> {
    let by_corner = || corners.chunk_by(|a, b| a.0 == b.0);
    let (mut met, mut rough) = (vec![0_usize; faces.area.len()], vec![0_usize; faces.area.len()]);
    for at in by_corner() {
        for (_, face) in at {
            met[*face as usize] += 1;
            rough[*face as usize] += usize::from(at.len() >= MANY);
        }
    }
    let is_rough = |face: u32| {
        let (rough, met) = (rough[face as usize], met[face as usize]);
        faces.is_small(face) && rough as f64 >= ROUGH_SHARE * met as f64
    };
    let mut joins = Vec::new();
    for at in by_corner().filter(|at| at.len() >= MANY) {
        let of = |keeps: &dyn Fn(u32) -> bool| at.iter().map(|(_, f)| *f).filter(|f| keeps(*f)).collect::<Vec<u32>>();
        let around = of(&|f| !faces.is_small(f) && faces.is_curved(f));
        let largest = around.into_iter().max_by(|a, b| faces.area[*a as usize].total_cmp(&faces.area[*b as usize]));
        let own = of(&is_rough);
        let first = own.first().copied();
        joins.extend(own.iter().skip(1).copied().chain(largest).filter_map(|other| Some((first?, other))));
    }
    joins
}

/// For each vertex on a crease, in order: the faces that meet there.
fn faces_at_corners(surface: &Surface, face_of: &[u32]) -> Vec<(u32, u32)> {
    let mut is_on_crease = vec![false; surface.vertices.len()];
    for half in creases(surface, face_of) {
        let (a, b) = ends(&surface.triangles, half);
        (is_on_crease[a as usize], is_on_crease[b as usize]) = (true, true);
    }
    let mut pairs = Vec::new();
    for (corners, face) in surface.triangles.iter().zip(face_of) {
        pairs.extend(corners.iter().filter(|i| is_on_crease[**i as usize]).map(|i| (*i, *face)));
    }
    pairs.par_sort_unstable();
    pairs.dedup();
    pairs
}

/// The half-edges beyond which another face lies.
fn creases<'a>(surface: &'a Surface, face_of: &'a [u32]) -> impl Iterator<Item = u32> + 'a {
    (0..surface.edges.twins.len() as u32).filter(|half| {
        let beyond = surface.edges.beyond(*half);
        beyond.is_some_and(|other| face_of[other as usize] != face_of[*half as usize / 3])
    })
}

/// Faces of few triangles, each with the curved face that has most of its border.
fn islands(surface: &Surface, face_of: &[u32], faces: &Faces, is_noisy: bool) -> Vec<(u32, u32)> {
    let most = ISLAND[usize::from(is_noisy)];
    let is_island = |face: u32| faces.triangles[face as usize] <= most && faces.is_small(face);
    let mut border: Vec<(u32, u32, u32)> = creases(surface, face_of)
        .map(|half| (face_of[half as usize / 3], half))
        .filter(|(own, _)| is_island(*own))
        .filter_map(|(own, half)| Some((own, face_of[surface.edges.beyond(half)? as usize], half)))
        .collect();
    border.sort_unstable();
    let length = |part: &[(u32, u32, u32)]| part.iter().map(|(_, _, half)| surface.side(*half)).sum::<f64>();
    let around = |own: &[(u32, u32, u32)]| {
        let curved = own.chunk_by(|a, b| a.1 == b.1).filter(|part| faces.is_curved(part[0].1));
        let shares: Vec<(f64, u32)> = curved.map(|part| (length(part), part[0].1)).collect();
        let most = shares.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let share = if is_noisy { shares.iter().map(|(length, _)| length).sum() } else { most.0 };
        (share >= SURROUNDED * length(own)).then_some((own[0].0, most.1))
    };
    border.chunk_by(|a, b| a.0 == b.0).filter_map(around).collect()
}

/// A face's box as its rank from the top down, and its triangles by face and number.
type Boxed<'a> = ([f64; 6], &'a [(u32, u32)]);

/// Faces numbered from the top down, by the boxes around them, and their shapes.
fn numbered(surface: &Surface, facet: &[u32], facets: &Facets, together: &mut Union) -> (Vec<u32>, Vec<Shape>) {
    let mut members: Vec<(u32, u32)> = facet.iter().enumerate().map(|(t, f)| (together.root(*f), t as u32)).collect();
    members.par_sort_unstable();
    let faces = Faces::of(facets, together);
    let mut found: Vec<Boxed<'_>> = members
        .chunk_by(|a, b| a.0 == b.0)
        .map(|own| {
            let corners = own.iter().flat_map(|(_, t)| surface.triangles[*t as usize]);
            let (low, high) = bounds(corners.map(|i| surface.vertices[i as usize]));
            ([-high.z, -low.z, low.x, low.y, high.x, high.y], own)
        })
        .collect();
    // of faces in one box, that comes first whose first triangle does
    found.sort_by(|a, b| {
        let by_box = a.0.iter().zip(b.0).map(|(x, y)| x.total_cmp(&y)).find(|order| order.is_ne());
        by_box.unwrap_or_else(|| a.1[0].1.cmp(&b.1[0].1))
    });
    let mut numbers = vec![0; facet.len()];
    for (number, (_, own)) in found.iter().enumerate() {
        own.iter().for_each(|(_, t)| numbers[surface.given[*t as usize] as usize] = number as u32 + 1);
    }
    let shape = |(_, own): &Boxed<'_>| {
        if faces.facets[own[0].0 as usize] == 1 {
            return Shape::Plane;
        }
        let own: Vec<usize> = own.iter().map(|(_, t)| *t as usize).collect();
        let corners: Vec<[Vector; 3]> =
            own.iter().map(|t| surface.triangles[*t].map(|i| surface.vertices[i as usize])).collect();
        shape_of(&corners, surface.flatness)
    };
    let shapes = found.par_iter().map(shape).collect();
    (numbers, shapes)
}

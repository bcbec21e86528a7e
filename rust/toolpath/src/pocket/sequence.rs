//! The order of the pieces, and the moves between them.
//!
//! A piece is within the bound when all is cleared that was when it was planned and that its rim could meet: the pieces of lower levels nearer to
//! it than two radii. Clearing more only lowers the angle, so any order that keeps to that is legal; taken is what begins nearest.

use std::collections::BTreeMap;

use rayon::prelude::*;
use styluscam_geometry::PlanePiece;
use styluscam_motion::Watch;

use super::check::stepovers;
use super::cut::{left_of, Cut};
use super::error::PocketError;
use super::ground::{reversed, Ground};
use super::links;
use super::material::Material;
use super::polygons::Point;
use super::request::{PocketRun, PocketRunKind};

/// Distance of the positions of pieces that are compared, in tool radii.
const STEP: f64 = 0.25;

/// Pieces that are linked one after the other: blocks of them are at the same time.
const BLOCK: usize = 48;
/// Positions nearer than this are the same, mm.
const SAME: f64 = 2e-3;
/// A line or arc of which the start may be moved by as much, in tool radii.
const FIRST: f64 = 0.03;

/// A piece in its order.
#[derive(Clone, Copy, Debug)]
struct Next<'a> {
    cut: &'a Cut,
    /// Whether it is cut from its end.
    turned: bool,
    /// Where the one before it ends; None for the first.
    from: Option<Point>,
}

/// The runs: all pieces, and the moves between them.
pub fn sequenced(
    cuts: &[Cut],
    ground: &Ground,
    free: &Material,
    (radius, is_measured): (f64, bool),
    watch: &Watch,
) -> Result<Vec<PocketRun>, PocketError> {
    let order = ordered(cuts, radius);
    watch.begin("linking the pieces", order.len());
    // the material before each block
    let mut materials = vec![Material::new(ground.goal.clone())];
    let blocks: Vec<&[Next<'_>]> = order.chunks(BLOCK).collect();
    for block in blocks.iter().rev().skip(1).rev() {
        if let Some(before) = materials.last() {
            materials.push(left_of(&ground.kernel, before, block.iter().map(|next| next.cut)));
        }
    }
    let work = Work { ground, free, radius, is_measured, watch };
    let found: Result<Vec<Vec<PocketRun>>, PocketError> =
        blocks.into_par_iter().zip(materials).map(|(block, material)| work.linked(block, material)).collect();
    Ok(found?.concat())
}

/// The pieces in the order in which they are cut.
fn ordered(cuts: &[Cut], radius: f64) -> Vec<Next<'_>> {
    let (mut waits, followers) = dependencies(cuts, radius);
    let mut open: Vec<usize> = (0..cuts.len()).filter(|i| waits.get(*i) == Some(&0)).collect();
    let mut order = Vec::with_capacity(cuts.len());
    let mut at: Option<Point> = None;
    while let Some((place, turned)) = nearest(cuts, &open, at) {
        let number = open.swap_remove(place);
        let Some(cut) = cuts.get(number) else { continue };
        order.push(Next { cut, turned, from: at });
        at = if turned { cut.start() } else { cut.end() };
        for follower in followers.get(number).into_iter().flatten() {
            if let Some(waits) = waits.get_mut(*follower) {
                *waits -= 1;
                if *waits == 0 {
                    open.push(*follower);
                }
            }
        }
    }
    order
}

/// What pieces are linked in.
#[derive(Clone, Copy)]
struct Work<'a> {
    ground: &'a Ground,
    free: &'a Material,
    radius: f64,
    /// Whether the stepover along the cuts is measured.
    is_measured: bool,
    watch: &'a Watch,
}

impl Work<'_> {
    /// The runs of pieces that follow each other, in the material as it is before them.
    fn linked(&self, block: &[Next<'_>], mut material: Material) -> Result<Vec<PocketRun>, PocketError> {
        let radius = self.radius;
        let mut runs = Vec::new();
        for Next { cut, turned, from } in block {
            let mut path = if *turned { reversed(&cut.path) } else { cut.path.clone() };
            let Some([x, y, _]) = path.first().copied() else { continue };
            let goes_on = from.is_some_and(|from| begins_at(&mut path, from, radius));
            if let Some(from) = from.filter(|_| !goes_on) {
                let links = links::Ground { material: &material, free: self.free, radius };
                runs.push(link(from, [x, y], (!cut.is_entry).then_some(links)));
            }
            let kind = if cut.is_entry { PocketRunKind::Entry } else { PocketRunKind::Cut };
            let is_measured = self.is_measured && !cut.is_entry;
            let stepovers = if is_measured { stepovers(&path, &material, radius) } else { Vec::new() };
            runs.push(PocketRun { stepovers, ..PocketRun::new(path, kind) });
            material = left_of(&self.ground.kernel, &material, [*cut]);
            self.watch.advance(1)?;
        }
        Ok(runs)
    }
}

/// Lets a path begin at a position that its start is as good as at, for a link would cut there with any heading: all before its first longer line
/// or arc is moved. False where it is farther, or there is none.
fn begins_at(path: &mut [[f64; 3]], at: Point, radius: f64) -> bool {
    let Some(off) = path.first().map(|[x, y, _]| [at[0] - x, at[1] - y]) else { return false };
    let is_long = |pair: &[[f64; 3]]| match pair {
        [a, b] => libm::hypot(b[0] - a[0], b[1] - a[1]) >= FIRST * radius,
        _ => false,
    };
    let Some(first) = path.windows(2).position(is_long).filter(|_| libm::hypot(off[0], off[1]) < SAME) else {
        return false;
    };
    for [x, y, _] in path.iter_mut().take(first + 1) {
        (*x, *y) = (*x + off[0], *y + off[1]);
    }
    true
}

/// Measures the room of runs among the positions that walls leave to the tool's centre.
pub fn measure_room(runs: &mut [PocketRun], free: &Material) {
    for run in runs {
        let down = if run.kind == PocketRunKind::Link { run.points.last() } else { run.points.first() };
        run.room = down.map_or(0.0, |[x, y, _]| free.distance([*x, *y]));
    }
}

/// To a position, through what is cleared or over it.
pub fn link(from: Point, to: Point, ground: Option<links::Ground<'_>>) -> PocketRun {
    let way = ground.and_then(|ground| ground.way(from, to));
    let kind = if way.is_some() { PocketRunKind::Link } else { PocketRunKind::Rapid };
    let points = way.unwrap_or_else(|| vec![from, to]).iter().map(|[x, y]| [*x, *y, 0.0]).collect();
    PocketRun::new(points, kind)
}

/// The open piece that begins nearest, and whether at its end; entries last.
fn nearest(cuts: &[Cut], open: &[usize], at: Option<Point>) -> Option<(usize, bool)> {
    let away = |p: Option<Point>| match (p, at) {
        (Some(p), Some(at)) => libm::hypot(p[0] - at[0], p[1] - at[1]),
        _ => 0.0,
    };
    let both = open.iter().enumerate().filter_map(|(place, number)| cuts.get(*number).map(|cut| (place, cut)));
    let both = both.flat_map(|(place, cut)| {
        let ends = [(cut.start(), false), (cut.end().filter(|_| cut.two_way), true)];
        ends.into_iter().filter(|(end, _)| end.is_some()).map(move |(end, turned)| (cut, place, turned, away(end)))
    });
    let first =
        both.min_by(|a, b| (a.0.is_entry.cmp(&b.0.is_entry)).then(a.3.total_cmp(&b.3)).then(a.0.level.cmp(&b.0.level)));
    first.map(|(_, place, turned, _)| (place, turned))
}

/// Of each piece the number of those before which it may not be cut, and the pieces that wait for it.
fn dependencies(cuts: &[Cut], radius: f64) -> (Vec<usize>, Vec<Vec<usize>>) {
    let step = STEP * radius;
    // the positions of two pieces may lie half a step farther apart on either side than the pieces
    let near = 2.0 * radius + step;
    let cell = |p: Point| p.map(|x| libm::floor(x / near) as i64);
    let mut cells: BTreeMap<[i64; 2], Vec<(usize, Vec<Point>)>> = BTreeMap::new();
    let (mut waits, mut followers) = (vec![0; cuts.len()], vec![Vec::new(); cuts.len()]);
    let mut waits_for = vec![usize::MAX; cuts.len()];
    for (number, cut) in cuts.iter().enumerate() {
        let mut own: BTreeMap<[i64; 2], Vec<Point>> = BTreeMap::new();
        for position in positions(&cut.path, step) {
            own.entry(cell(position)).or_default().push(position);
        }
        for ([x, y], positions) in &own {
            let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x + i, y + j]));
            for (other, others) in around.filter_map(|cell| cells.get(&cell)).flatten() {
                let is_before = cuts.get(*other).is_some_and(|other| other.level < cut.level || other.is_entry);
                let (Some(found), true) = (waits_for.get_mut(*other), is_before) else { continue };
                if *found != number && positions.iter().any(|p| others.iter().any(|q| is_within(*p, *q, near))) {
                    *found = number;
                    if let (Some(followers), Some(waits)) = (followers.get_mut(*other), waits.get_mut(number)) {
                        followers.push(number);
                        *waits += 1;
                    }
                }
            }
        }
        for (cell, positions) in own {
            cells.entry(cell).or_default().push((number, positions));
        }
    }
    (waits, followers)
}

fn is_within(a: Point, b: Point, distance: f64) -> bool {
    let off = [a[0] - b[0], a[1] - b[1]];
    off[0] * off[0] + off[1] * off[1] < distance * distance
}

/// Positions along a path, no farther apart than `step`.
fn positions(path: &[[f64; 3]], step: f64) -> impl Iterator<Item = Point> {
    PlanePiece::path(path).into_iter().flat_map(move |piece| {
        let parts = libm::ceil(piece.length() / step).max(1.0) as usize;
        (0..=parts).map(move |part| piece.at(part as f64 / parts as f64))
    })
}

//! The order of the pieces, and the moves between them.
//!
//! A piece is within the bound when all is cleared that was when it was planned and that its rim could meet: the pieces of lower levels nearer to
//! it than two radii. Clearing more only lowers the angle, so any order that keeps to that is legal; taken is what begins nearest.

use std::collections::HashMap;

use styluscam_geometry::PlanePiece;
use styluscam_motion::Watch;

use super::cut::{left_of, Cut};
use super::error::PocketError;
use super::ground::{reversed, Ground};
use super::links;
use super::material::Material;
use super::polygons::Point;
use super::request::{PocketRun, PocketRunKind};

/// The runs: all pieces, and the moves between them.
pub fn sequenced(
    cuts: &[Cut],
    ground: &Ground,
    free: &Material,
    radius: f64,
    watch: &Watch,
) -> Result<Vec<PocketRun>, PocketError> {
    let (mut waits, followers) = dependencies(cuts, radius);
    let mut open: Vec<usize> = (0..cuts.len()).filter(|i| waits.get(*i) == Some(&0)).collect();
    let mut material = Material::new(ground.goal.clone());
    let mut runs: Vec<PocketRun> = Vec::new();
    let mut at: Option<Point> = None;
    watch.begin("linking the pieces", cuts.len());
    while let Some((place, turned)) = nearest(cuts, &open, at) {
        let number = open.swap_remove(place);
        let Some(cut) = cuts.get(number) else { continue };
        let path = if turned { reversed(&cut.path) } else { cut.path.clone() };
        let (Some([x, y, _]), Some([u, v, _])) = (path.first(), path.last()) else { continue };
        if let Some(from) = at {
            let links = links::Ground { material: &material, free, radius };
            runs.push(link(from, [*x, *y], (!cut.is_entry).then_some(links)));
        }
        at = Some([*u, *v]);
        let kind = if cut.is_entry { PocketRunKind::Entry } else { PocketRunKind::Cut };
        runs.push(PocketRun { points: path, kind });
        material = left_of(&ground.kernel, &material, std::slice::from_ref(cut));
        for follower in followers.get(number).into_iter().flatten() {
            if let Some(waits) = waits.get_mut(*follower) {
                *waits -= 1;
                if *waits == 0 {
                    open.push(*follower);
                }
            }
        }
        watch.advance(1)?;
    }
    Ok(runs)
}

/// To a position, through what is cleared or over it.
pub fn link(from: Point, to: Point, ground: Option<links::Ground<'_>>) -> PocketRun {
    let way = ground.and_then(|ground| ground.way(from, to));
    let kind = if way.is_some() { PocketRunKind::Link } else { PocketRunKind::Rapid };
    let points = way.unwrap_or_else(|| vec![from, to]).iter().map(|[x, y]| [*x, *y, 0.0]).collect();
    PocketRun { points, kind }
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
    let near = 2.0 * radius;
    let cell = |p: Point| p.map(|x| libm::floor(x / near) as i64);
    let mut cells: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    let (mut waits, mut followers) = (vec![0; cuts.len()], vec![Vec::new(); cuts.len()]);
    for (number, cut) in cuts.iter().enumerate() {
        let mut own: Vec<[i64; 2]> = positions(&cut.path, 0.25 * near).map(cell).collect();
        own.sort_unstable();
        own.dedup();
        let around = own.iter().flat_map(|[x, y]| (-1..=1).flat_map(move |i| (-1..=1).map(move |j| [x + i, y + j])));
        let mut before: Vec<usize> = around.filter_map(|cell| cells.get(&cell)).flatten().copied().collect();
        before.sort_unstable();
        before.dedup();
        before.retain(|other| cuts.get(*other).is_some_and(|other| other.level < cut.level || other.is_entry));
        for other in before {
            if let (Some(followers), Some(waits)) = (followers.get_mut(other), waits.get_mut(number)) {
                followers.push(number);
                *waits += 1;
            }
        }
        for cell in own {
            cells.entry(cell).or_default().push(number);
        }
    }
    (waits, followers)
}

/// Positions along a path, no farther apart than `step`.
fn positions(path: &[[f64; 3]], step: f64) -> impl Iterator<Item = Point> {
    PlanePiece::path(path).into_iter().flat_map(move |piece| {
        let parts = libm::ceil(piece.length() / step).max(1.0) as usize;
        (0..=parts).map(move |part| piece.at(part as f64 / parts as f64))
    })
}

//! The engagement along a piece before it is cut, by the planner's own account of the material: polygons, and discs along the
//! piece itself. The verifier measures the finished path by arcs of its own and shares nothing with this.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use styluscam_geometry::PlanePiece;

use super::material::Material;
use super::polygons::Point;
use super::request::Stepover;

/// Distance of the positions that are looked at, in tool radii.
const STEP: f64 = 0.04;
/// Of its own way the tool has not swept yet what lies this close behind, in tool radii.
const CLOSE: f64 = 0.02;
/// Angle between their headings, at most, rad.
const TURN: f64 = 0.1;
/// Positions of the piece itself that have swept what is near, at most: the way once around a small circle.
const OWN: usize = 160;

/// Chips at the side of the tool that are thinner than this may be counted or not, mm.
const EDGE: f64 = 4e-3;

/// A piece that is cut short ends so many positions before what is beyond the bound, and is not cut if it has fewer.
const BACK: usize = 3;
const LEAST: usize = 8;

/// A position on a piece with the angle that the tool engages there.
#[derive(Clone, Copy, Debug)]
struct Looked {
    /// Number of the piece's line or arc, and the share of it.
    at: (usize, f64),
    /// Engagement angle, rad.
    angle: f64,
    /// What is cut there.
    stepover: Stepover,
}

/// The angle along a path of points with bulges, in the order in which it is cut.
fn along(path: &[[f64; 3]], material: &Material, radius: f64) -> Vec<Looked> {
    let mut looked = Vec::new();
    let mut own: Vec<(Point, f64)> = Vec::new();
    let mut travelled = 0.0;
    for (number, piece) in PlanePiece::path(path).iter().enumerate() {
        let length = piece.length();
        if length <= 0.0 {
            continue;
        }
        let turn = piece.circle.map_or(0.0, |circle| circle.turn.abs());
        let parts = libm::ceil((length / (STEP * radius)).max(turn / TURN)).max(1.0) as usize;
        for part in 0..=parts {
            let share = part as f64 / parts as f64;
            let position = piece.at(share);
            // a disc close behind would hide what a turn of the heading brings before the tool
            let now = travelled + share * length;
            let behind = own.partition_point(|(_, when)| *when <= now - CLOSE * radius);
            let cut = engaged(position, heading(piece, share), own.get(..behind).unwrap_or(&[]), material, radius);
            let angle = angle(&cut, radius);
            looked.push(Looked { at: (number, share), angle, stepover: stepover(&cut, now, radius) });
            if part < parts {
                own.push((position, now));
            }
        }
        travelled += length;
    }
    looked
}

/// The angle over engaged directions, rad. Between the tool's side and the last of them that begins there chips would be thinner than arithmetic
/// can part from none, whoever measures: that counts as engaged.
fn angle(engaged: &[[f64; 2]], radius: f64) -> f64 {
    let edge = libm::acos(1.0 - EDGE / radius);
    let (aside, ahead): (Vec<[f64; 2]>, Vec<[f64; 2]>) = engaged.iter().partition(|[from, _]| *from < edge);
    aside.last().map_or(0.0, |[_, to]| *to) + ahead.iter().map(|[from, to]| to - from).sum::<f64>()
}

/// What is cut along a path of points with bulges.
pub fn stepovers(path: &[[f64; 3]], material: &Material, radius: f64) -> Vec<Stepover> {
    along(path, material, radius).iter().map(|looked| looked.stepover).collect()
}

/// What is cut by engaged directions, as angles from a right angle right of the heading: the tool does not turn with its path, so a
/// stretch of its rim clears per length of the path what it is wide across the heading.
fn stepover(engaged: &[[f64; 2]], travelled: f64, radius: f64) -> Stepover {
    let width = engaged.iter().map(|[a, b]| radius * (libm::cos(*a) - libm::cos(*b))).sum();
    let thickest = |[a, b]: &[f64; 2]| libm::sin(FRAC_PI_2.clamp(*a, *b));
    Stepover { travelled, width, chip: engaged.iter().map(thickest).fold(0.0, f64::max) }
}

/// The largest angle along a path, rad.
#[cfg(test)]
pub fn worst(path: &[[f64; 3]], material: &Material, radius: f64) -> f64 {
    along(path, material, radius).iter().fold(0.0, |worst, looked| worst.max(looked.angle))
}

/// The positions of a path at which it engages more than `most`, rad.
pub fn beyond(path: &[[f64; 3]], material: &Material, radius: f64, most: f64) -> Vec<Point> {
    let pieces = PlanePiece::path(path);
    let looked = along(path, material, radius);
    let over = looked.iter().filter(|looked| looked.angle > most);
    over.filter_map(|Looked { at: (number, share), .. }| pieces.get(*number).map(|piece| piece.at(*share))).collect()
}

/// The path up to where it first engages more than `most`, rad; empty where that is so soon that nothing is gained.
pub fn bounded(path: Vec<[f64; 3]>, material: &Material, radius: f64, most: f64) -> Vec<[f64; 3]> {
    let looked = along(&path, material, radius);
    let Some(first) = looked.iter().position(|looked| looked.angle > most) else { return path };
    let Some(last) = first.checked_sub(BACK).and_then(|last| looked.get(last)).filter(|_| first > LEAST) else {
        return Vec::new();
    };
    let (number, share) = last.at;
    let mut kept: Vec<[f64; 3]> = path.iter().take(number + 1).copied().collect();
    if let (Some(piece), Some([_, _, bulge])) = (PlanePiece::path(&path).get(number), kept.last_mut()) {
        *bulge = libm::tan(share * libm::atan(*bulge));
        let [x, y] = piece.at(share);
        kept.push([x, y, 0.0]);
    }
    kept
}

/// The directions ahead in which the rim lies in the material, and in none of the discs about the positions before: as angles from a
/// right angle right of the heading, rad.
fn engaged(at: Point, heading: f64, own: &[(Point, f64)], material: &Material, radius: f64) -> Vec<[f64; 2]> {
    let from = heading - FRAC_PI_2;
    let mut inside = within(at, from, material, radius);
    let (sin, cos) = libm::sincos(heading);
    for (before, _) in own.iter().rev().take(OWN) {
        if inside.is_empty() {
            break;
        }
        let arm = [before[0] - at[0], before[1] - at[1]];
        // of the rim ahead a disc behind reaches what lies aside of the heading, if its centre does so far enough
        let (ahead, aside) = (arm[0] * cos + arm[1] * sin, (arm[1] * cos - arm[0] * sin).abs());
        let square = arm[0] * arm[0] + arm[1] * arm[1];
        if ahead < 0.0 && 2.0 * radius * aside <= square {
            continue;
        }
        let half_distance = 0.5 * square.sqrt();
        if half_distance < radius && half_distance > 0.0 {
            let middle = (libm::atan2(arm[1], arm[0]) - from).rem_euclid(TAU);
            let half = libm::acos(half_distance / radius);
            // as seen from `from` the disc may begin before or end after a full turn
            for turn in [-TAU, 0.0] {
                take(&mut inside, middle - half + turn, middle + half + turn);
            }
        }
    }
    inside
}

/// Takes the directions between two out of intervals.
fn take(intervals: &mut Vec<[f64; 2]>, from: f64, to: f64) {
    if intervals.iter().all(|[a, b]| to <= *a || from >= *b) {
        return;
    }
    let left = intervals.iter().flat_map(|[a, b]| [[*a, b.min(from)], [a.max(to), *b]]);
    *intervals = left.filter(|[a, b]| a < b).collect();
}

/// Directions within half a turn on from `from` in which the rim lies in the material, as angles from there.
fn within(at: Point, from: f64, material: &Material, radius: f64) -> Vec<[f64; 2]> {
    // (direction, whether the rim comes into the material there): the material lies left of its sides
    let mut crossings: Vec<(f64, bool)> = Vec::new();
    material.crossed(at, radius, &mut |a, b| {
        let (along, arm) = ([b[0] - a[0], b[1] - a[1]], [a[0] - at[0], a[1] - at[1]]);
        let square = along[0] * along[0] + along[1] * along[1];
        let half = arm[0] * along[0] + arm[1] * along[1];
        let root = half * half - square * (arm[0] * arm[0] + arm[1] * arm[1] - radius * radius);
        if root <= 0.0 || square <= 0.0 {
            return;
        }
        for sign in [-1.0, 1.0] {
            let share = (sign * root.sqrt() - half) / square;
            if (0.0..1.0).contains(&share) {
                let on = [arm[0] + share * along[0], arm[1] + share * along[1]];
                // the side leaves the disc at its second crossing: the rim then comes over to its left
                crossings.push(((libm::atan2(on[1], on[0]) - from).rem_euclid(TAU), sign > 0.0));
            }
        }
    });
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let is_in = match crossings.last() {
        Some((_, comes_in)) => *comes_in,
        // all of the rim lies in it, or none: of a point where it only touches a side neither can be told
        None => {
            [radius, -radius].iter().all(|r| material.holds([at[0] + r * libm::cos(from), at[1] + r * libm::sin(from)]))
        }
    };
    let (mut intervals, mut begin) = (Vec::new(), is_in.then_some(0.0));
    for (direction, comes_in) in crossings.into_iter().take_while(|(direction, _)| *direction < PI) {
        if comes_in {
            begin.get_or_insert(direction);
        } else if let Some(begin) = begin.take() {
            intervals.push([begin, direction]);
        }
    }
    intervals.extend(begin.map(|begin| [begin, PI]));
    intervals
}

fn heading(piece: &PlanePiece, share: f64) -> f64 {
    match &piece.circle {
        Some(circle) => circle.from + share * circle.turn + FRAC_PI_2.copysign(circle.turn),
        None => libm::atan2(piece.end[1] - piece.start[1], piece.end[0] - piece.start[0]),
    }
}

//! Regions that the tool can touch, but between two levels only: short walls over a slope, steep rims.

use std::collections::BTreeMap;

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use super::untouched::{bands, in_plan, Untouched};
use super::{stances::stances_of, walls};
use crate::{Pass, Surface};

/// What is touched over less than this, mm, needs no level.
const LEAST: f64 = 0.02;
/// Lowest tips over one floor differ by no more than this from one to the next, mm.
const LEVEL: f64 = 1e-4;
/// From a corner that the tool touches towards one that it does not: how often that distance is halved.
const HALVINGS: usize = 12;

/// A triangle with lowest and highest tip with which it is touched, mm.
type Touched = (usize, (f64, f64));

/// Bands of heights, lowest and highest tip in mm, that hold none of `heights`, the levels: those in which the tool touches a
/// point of a selected upright wall, and those in which it touches a connected region of selected slopes that no pass touches;
/// and where a selected upright wall ends on what is in front of it, what it is touched over there ([`feet`]).
///
/// Walls are looked at at positions `spacing` mm apart, slopes at the corners of their facets and along their sides as far
/// as they are touched. Slopes beside some that a pass touches have their levels, a step apart.
///
/// # Errors
/// `Cancelled` when `watch` is cancelled.
pub fn left_out(
    surface: &Surface<'_>,
    (heights, passes): (&[f64], &[Pass]),
    spacing: f64,
    watch: &Watch,
) -> Result<Vec<(f64, f64)>, Cancelled> {
    let mesh = surface.envelope().mesh();
    let upright: Vec<usize> = surface.triangles().filter(|triangle| mesh.is_upright(*triangle)).collect();
    let untouched = Untouched::by(passes, surface);
    let sloping: Vec<usize> = untouched.triangles().filter(|t| !mesh.is_upright(*t)).collect();
    let mut by_region: BTreeMap<u32, Vec<(f64, f64)>> = BTreeMap::new();
    for (triangle, range) in of_slopes(&untouched, &sloping, watch)? {
        by_region.entry(untouched.region(triangle)).or_default().push(range);
    }
    let of_slopes = by_region.into_values().flat_map(|ranges| bands(ranges, LEAST));
    let holds_none = |(low, high): &(f64, f64)| !heights.iter().any(|z| (low..=high).contains(&z));
    let is_left = |tips: &(f64, f64)| tips.1 - tips.0 >= LEAST && holds_none(tips);
    let walls = walls::touched(surface, &upright, spacing, ("walls between levels", watch))?;
    // round the smallest loop that is sure to be found
    let length = std::f64::consts::PI * std::f64::consts::SQRT_2 * spacing;
    let feet = feet(&walls, length).into_iter().filter(holds_none);
    let of_walls: Vec<(f64, f64)> = walls
        .par_iter()
        .filter(|wall| holds_none(&wall.tips))
        .filter_map(|wall| {
            // a wall that goes on as far as the next level has its passes, a step apart
            let (low, high) = wall.to_top(surface);
            let below = heights.iter().copied().filter(|z| *z < low).reduce(f64::max);
            let goes_on = below.is_some_and(|z| wall.is_touched_at(surface, z));
            Some((low, high)).filter(|tips| is_left(tips) && !goes_on)
        })
        .collect();
    Ok(of_walls.into_iter().chain(of_slopes.filter(is_left)).chain(feet).collect())
}

/// Where upright walls end on a floor, or on whatever is in front of them at one height, over more than `length` mm: the
/// lowest tip with which they are touched there, and what needs no level over it. The last level over it would leave a
/// strip of the wall up to a step high.
fn feet(walls: &[walls::Touched], length: f64) -> Vec<(f64, f64)> {
    let mut ends: Vec<(f64, f64)> =
        walls.iter().filter(|wall| wall.is_stopped).map(|wall| (wall.tips.0, wall.length)).collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let level = ends.chunk_by(|a, b| b.0 - a.0 <= LEVEL);
    let long = level.filter(|floor| floor.iter().map(|(_, length)| length).sum::<f64>() > length);
    long.filter_map(|floor| floor.last()).map(|(tip, _)| (*tip, tip + LEAST)).collect()
}

/// For each sloping triangle of which a corner is touched, lowest and highest tip with which its corners and sides are.
fn of_slopes(untouched: &Untouched<'_>, triangles: &[usize], watch: &Watch) -> Result<Vec<Touched>, Cancelled> {
    let stances = stances_of(untouched.surface(), triangles);
    let corners: Vec<(usize, [f64; 2])> =
        stances.iter().flat_map(|(triangle, tips)| tips.map(|tip| (*triangle, in_plan(tip)))).collect();
    watch.begin("slopes between levels", corners.len());
    let found = untouched.tips(&corners, watch)?;
    let mut ranges = Vec::new();
    let mut sides = Vec::new();
    for ((triangle, corners), tips) in stances.iter().zip(found.chunks(3)) {
        ranges.extend(tips.iter().flatten().map(|tip| (*triangle, *tip)));
        let (touched, missed): (Vec<usize>, Vec<usize>) = (0..3).partition(|i| tips[*i].is_some());
        let pairs = touched.iter().flat_map(|i| missed.iter().map(move |j| (*i, *j)));
        sides.extend(pairs.map(|(i, j)| Side { triangle: *triangle, touched: corners[i], missed: corners[j] }));
    }
    ranges.extend(along(untouched, sides, watch)?);
    let mut joined: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for (triangle, tip) in ranges {
        let range = joined.entry(triangle).or_insert((tip, tip));
        *range = (range.0.min(tip), range.1.max(tip));
    }
    Ok(joined.into_iter().collect())
}

/// A side of a triangle by the tips that touch its ends, of which only one can be.
struct Side {
    triangle: usize,
    touched: Vector,
    missed: Vector,
}

/// The tips where sides cease to be touched, each with its triangle.
fn along(untouched: &Untouched<'_>, mut sides: Vec<Side>, watch: &Watch) -> Result<Vec<(usize, f64)>, Cancelled> {
    let mut last: Vec<Option<f64>> = vec![None; sides.len()];
    for _ in 0..HALVINGS {
        let middles: Vec<Vector> = sides.iter().map(|side| (side.touched + side.missed) * 0.5).collect();
        let asked: Vec<(usize, [f64; 2])> =
            sides.iter().zip(&middles).map(|(side, middle)| (side.triangle, in_plan(*middle))).collect();
        for (((side, middle), tip), last) in
            sides.iter_mut().zip(middles).zip(untouched.tips(&asked, watch)?).zip(&mut last)
        {
            match tip {
                Some(tip) => (side.touched, *last) = (middle, Some(tip)),
                None => side.missed = middle,
            }
        }
    }
    Ok(sides.iter().zip(last).filter_map(|(side, tip)| Some((side.triangle, tip?))).collect())
}

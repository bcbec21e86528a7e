//! Spirals: from level to level in one descent, whose height falls evenly along its length ([`super::descent`]).
//!
//! Derived in docs/concepts/spirals.md.

use rayon::prelude::*;
use styluscam_motion::Watch;

use super::descent::{Descent, Level};
use super::{level_curve::LevelCurve, nesting};
use crate::pass::plan_length;
use crate::{fitting, seam, Pass, PathPoint, PlanError, Surface};

/// A side of a loop between which a turn goes is no longer than this share of the loop: of two points that belong together, one
/// is that much farther round than the other at most, and the turn is off an even fall by half of it.
const SIDE: f64 = 0.01;
/// Points no farther apart are one, mm.
const SAME: f64 = 1e-6;

/// Loops of levels, in the order of their groups, joined to spirals: a loop at the first height, one descent, a loop at the last.
/// Where a loop parts, ends, or cannot be followed down to the next level, its spiral ends; open passes stay as they are.
///
/// Chords deviate by at most `deviation` mm along the normal; `longest` mm as in [`crate::fitting::densified`]. A spiral's group is that
/// of its first loop.
///
/// # Errors
/// `Cancelled`.
pub fn spirals(
    surface: &Surface<'_>,
    passes: &[Pass],
    deviation: f64,
    longest: f64,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    let outlines: Vec<Pass> =
        surface.outlines(passes, deviation).into_par_iter().map(|pass| divided(surface, pass, deviation)).collect();
    let followers = nesting::followers(&outlines);
    let mut is_followed = vec![false; passes.len()];
    followers.iter().flatten().for_each(|lower| is_followed[*lower] = true);
    let firsts: Vec<usize> = (0..passes.len()).filter(|number| !is_followed[*number]).collect();
    watch.begin("spirals", passes.len());
    let descent = Descent { surface, deviation, longest, is_turned: false };
    let of_first = |first: &usize| -> Result<Vec<Pass>, PlanError> {
        let mut loops = vec![*first];
        while let Some(lower) = loops.last().and_then(|last| followers[*last]) {
            loops.push(lower);
        }
        let loops: Vec<[&Pass; 2]> = loops.into_iter().map(|number| [&passes[number], &outlines[number]]).collect();
        along(&descent, &loops, watch)
    };
    let found: Result<Vec<Vec<Pass>>, PlanError> = firsts.par_iter().map(of_first).collect();
    let mut found: Vec<Pass> = found?.into_iter().flatten().collect();
    found.sort_by_key(|pass| pass.group);
    Ok(found)
}

/// A loop with points on its long sides; open passes as they are.
fn divided(surface: &Surface<'_>, pass: Pass, deviation: f64) -> Pass {
    let points = pass.points.first().filter(|_| pass.closed).and_then(|first| {
        let mut curve = LevelCurve::new(surface, first.tip.z);
        let mut between = |a: &PathPoint, b: &PathPoint| curve.between(a, b);
        let mut runs = fitting::densified(&pass.points, deviation, SIDE * plan_length(&pass.points), &mut between);
        runs.pop().filter(|_| runs.is_empty())
    });
    match points {
        Some(points) => Pass { points, ..pass },
        None => pass,
    }
}

/// The spirals along loops, each with its chords, each of which leads to the next.
fn along(descent: &Descent<'_>, loops: &[[&Pass; 2]], watch: &Watch) -> Result<Vec<Pass>, PlanError> {
    let mut found: Vec<Pass> = Vec::new();
    let mut last: Option<(Level, &Pass)> = None;
    for [pass, outline] in loops {
        watch.advance(1)?;
        let turn = last.as_ref().and_then(|(above, _)| descent.turn(above, outline));
        match (turn, found.last_mut()) {
            (Some((turn, below)), Some(spiral)) => {
                spiral.points.extend_from_slice(&turn[1..]);
                last = Some((below, pass));
            }
            _ => {
                close(&mut found, last.as_ref());
                found.push((*pass).clone());
                last = pass.closed.then(|| (Level::new(outline.points.clone()), *pass));
            }
        }
    }
    close(&mut found, last.as_ref());
    Ok(found)
}

/// Ends the last spiral, if it goes down, with the loop that it comes to.
fn close(found: &mut [Pass], last: Option<&(Level, &Pass)>) {
    if let (Some(spiral), Some((_, pass))) = (found.last_mut(), last) {
        if let (true, Some(end)) = (spiral.descends(), spiral.points.last()) {
            let (end, mut points) = (end.tip, pass.points.clone());
            seam::begin_beside(&mut points, end);
            // a turn that ends on an upright wall may end over the loop
            let is_there = points.first().is_some_and(|point| (point.tip - end).norm() < SAME);
            spiral.points.extend(points.into_iter().skip(usize::from(is_there)));
            spiral.closed = false;
        }
    }
}

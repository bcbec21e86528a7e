//! Ramps: from a level to the next along the wall, instead of straight down it.
//!
//! A ramp is the beginning of a turn ([`super::descent`]) that is done sooner: its points lie on the envelope, between two
//! loops that belong together, and its height falls evenly. The next loop begins and ends where the ramp arrives. Derived in
//! docs/concepts/spirals.md.

use styluscam_motion::{Cancelled, Role, Watch};

use super::{descent::Descent, nesting};
use crate::pass::plan_length;
use crate::{ordering, seam, Entered, Pass, PathPoint, Sense, Surface};

/// How ramps go down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    /// Height over length in plan; the longest is one turn.
    pub slope: f64,
    /// In which direction the passes are followed.
    pub sense: Sense,
    /// How far a chord may be from the envelope, mm.
    pub deviation: f64,
    /// In plan, mm, as in `fitting::densified`.
    pub longest: f64,
}

/// Passes in the order in which they are followed, each with the ramp to it where its loop follows that of the pass before, a
/// level down; the others as they are.
///
/// # Errors
/// `Cancelled`.
pub fn ramped(
    surface: &Surface<'_>,
    ordered: Vec<Pass>,
    ramp: &Ramp,
    watch: &Watch,
) -> Result<Vec<Entered>, Cancelled> {
    let outlines = surface.outlines(&ordered, ramp.deviation);
    let followers = nesting::followers(&outlines);
    let descent = Descent { surface, deviation: ramp.deviation, longest: ramp.longest, is_turned: false };
    let mut entered: Vec<Entered> = Vec::with_capacity(ordered.len());
    let levels = levels(&ordered);
    let level = |group: usize| levels.partition_point(|level| *level < group);
    for (number, (pass, outline)) in ordered.into_iter().zip(&outlines).enumerate() {
        watch.advance(0)?;
        let descent = Descent { is_turned: ramp.sense.turns(level(pass.group)), ..descent };
        let before = number.checked_sub(1).filter(|before| followers[*before] == Some(number));
        let found = before.and_then(|before| entered.get(before)).and_then(|before| {
            let mut above = surface.chords(&before.pass.points, ramp.deviation).into_owned();
            if ramp.sense.turns(level(before.pass.group)) != descent.is_turned {
                above.reverse(); // as its own follower runs
            }
            to_loop(&descent, above, [&pass, outline], ramp.slope)
        });
        entered.push(found.unwrap_or_else(|| Entered::from(begun_beside(entered.last(), pass))));
    }
    Ok(entered)
}

/// The numbers of all groups, ascending.
fn levels(passes: &[Pass]) -> Vec<usize> {
    let mut levels: Vec<usize> = passes.iter().map(|pass| pass.group).collect();
    levels.sort_unstable();
    levels.dedup();
    levels
}

/// A pass; a loop after one whose end a ramp has moved begins beside that end.
fn begun_beside(before: Option<&Entered>, mut pass: Pass) -> Pass {
    let moved = before.filter(|before| !before.ramp.is_empty()).and_then(|before| before.pass.points.last());
    if let (true, Some(end)) = (pass.closed, moved) {
        seam::begin_beside(&mut pass.points, end.tip);
    }
    pass
}

/// A loop, given with its chords, that begins where a ramp from the chords above, which run the same way, arrives; with that ramp.
fn to_loop(descent: &Descent<'_>, above: Vec<PathPoint>, [pass, outline]: [&Pass; 2], slope: f64) -> Option<Entered> {
    let fall = above.first()?.tip.z - pass.points.first()?.tip.z;
    let share = fall / slope / plan_length(&above).max(f64::MIN_POSITIVE);
    let ramp = descent.ramp(above, outline, share)?;
    let mut points = pass.points.clone();
    ordering::begin_nearest(&mut points, ramp.last()?.tip);
    Some(Entered { pass: Pass { points, ..*pass }, ramp, role: Some(Role::Ramp) })
}

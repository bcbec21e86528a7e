//! The moves of an operation on the other side of the sheet: as many as the main tool's, each in the same time.

use styluscam_geometry::{SheetLaw, Tool, Vector};
use styluscam_motion::{Move, MoveKind, Role, Watch};
use styluscam_post::Machine;
use styluscam_toolpath::forming::{Facing, Opposite, Station};
use styluscam_toolpath::{offset::Envelope, PlanError, Surface};

use crate::operations::budget;
use crate::timing::{self, Step};
use crate::{JobError, OperationKeys, Scene};

/// Coordinates that differ by less are the same, mm.
const SAME: f64 = 1e-6;

/// One of two channels that work together: its scene, its machine and its tool.
#[derive(Clone, Copy)]
pub struct Member<'a> {
    /// The part as it lies on its machine.
    pub scene: &'a Scene,
    /// Its machine.
    pub machine: &'a Machine,
    /// Its tool.
    pub tool: &'a Tool,
}

/// The moves of an operation on both sides, of equal number.
#[derive(Clone, Debug, PartialEq)]
pub struct Paired {
    /// The main tool's, divided where the other side needs it, without rapids behind the first.
    pub main: Vec<Move>,
    /// The other tool's.
    pub below: Vec<Move>,
    /// Into how many more moves the main tool's were divided.
    pub divided: usize,
}

/// A move of the main tool, and where both tools stand at its end, where they touch.
type Followed = (Move, Option<Station>);

/// Plans the other side of an operation whose main moves are given; `path` is its place in the document.
///
/// # Errors
/// The tolerance is used up, the main tool's contact jumps, the machine below is too slow, `Cancelled`.
pub fn paired(
    [main, below]: [Member<'_>; 2],
    common: &OperationKeys,
    moves: &[Move],
    path: &str,
    watch: &Watch,
) -> Result<Paired, JobError> {
    let error = JobError::planning;
    let of = |member: &Member<'_>| budget::of(common.tolerance, member.scene, member.machine).map_err(error(path));
    let budgets = [of(&main)?, of(&below)?];
    let envelopes = [(&main, budgets[0]), (&below, budgets[1])].map(|(member, budget)| {
        let Scene { mesh, index, sheet, .. } = member.scene;
        Envelope::new(mesh, index, member.tool, sheet.as_ref(), budget.margin)
    });
    let surfaces = [Surface::whole(&envelopes[0]), Surface::whole(&envelopes[1])];
    let balls = [(&main, budgets[0]), (&below, budgets[1])]
        .map(|(member, budget)| member.scene.sheet.map_or(0.0, |sheet| sheet.along_normal()) + budget.margin);
    let left = below.scene.opposite.unwrap_or_default();
    let [normal, vertical] = match below.scene.sheet.map(|sheet| sheet.law) {
        Some(SheetLaw::Sine) => [0.0, left],
        Some(SheetLaw::Constant) | None => [left, 0.0],
    };
    let opposite = Opposite {
        main: Facing { surface: &surfaces[0], tool: main.tool, ball: balls[0] },
        below: Facing { surface: &surfaces[1], tool: below.tool, ball: balls[1] },
        normal,
        vertical,
        touching: common.tolerance,
        deviation: budgets[1].deviation,
    };
    let followed = followed(&opposite, moves, watch).map_err(error(path))?;
    let steps = steps(&followed, [main.scene, below.scene], common.feeds.cut);
    let (main, below) = timing::timed(&steps, [main.machine, below.machine], path)?;
    Ok(Paired { divided: main.len() - moves.len(), main, below })
}

/// The main tool's moves, divided where both touch and the other tool's chords would leave its surface.
fn followed(opposite: &Opposite<'_>, moves: &[Move], watch: &Watch) -> Result<Vec<Followed>, PlanError> {
    watch.begin("support", moves.len());
    let mut hints = [None; 2];
    let mut followed: Vec<Followed> = Vec::with_capacity(moves.len());
    for step in moves {
        watch.advance(1)?;
        let from = followed.last().and_then(|(_, station)| *station).filter(|_| step.kind == MoveKind::Feed);
        let parts = from.map_or(Ok(None), |from| opposite.parts(from, step, &mut hints))?;
        match parts {
            Some(parts) => followed.extend(parts.into_iter().map(|(_, at)| (step.to(at.main.into()), Some(at)))),
            None if step.kind == MoveKind::Feed => {
                followed.push((*step, opposite.station(step.end.tip.into(), &mut hints)));
            }
            None => followed.push((*step, None)),
        }
    }
    Ok(followed)
}

/// The moves of both tools: where they touch nothing, the one below is as far off its contact as the main one is off its own.
///
/// Only the first is a rapid: how long one takes is the machine's secret, and the two would not stay together. The others
/// go at the feed along the path, or slower, so that neither tool is faster than that.
fn steps(followed: &[Followed], scenes: [&Scene; 2], cut: f64) -> Vec<Step> {
    let [clearance, clearance_below] = scenes.map(|scene| scene.clearance);
    let mut steps: Vec<Step> = Vec::with_capacity(followed.len());
    let mut near: Option<Station> = None;
    for (index, (step, station)) in followed.iter().enumerate() {
        let end = Vector::from(step.end.tip);
        let touched = index.checked_sub(1).is_some_and(|before| followed[before].1.is_some());
        let below = station.map_or_else(
            || {
                let stays = near.is_some_and(|near| (near.main - end).xy().norm() <= SAME);
                let next = || followed[index..].iter().find_map(|(_, station)| *station);
                near = near.filter(|_| stays).or_else(next).or(near);
                let foot = near.map_or(end, |near| near.below.tip);
                let off = near.map_or(0.0, |near| end.z - near.main.z);
                let height = if end.z >= clearance - SAME { clearance_below } else { foot.z + off };
                Vector::new(foot.x, foot.y, height)
            },
            |station| station.below.tip,
        );
        near = station.or(near);
        let goes_on = touched && station.is_some();
        let main = match step.kind {
            MoveKind::Rapid if index > 0 => Move::feed(step.end.tip, cut).role(Role::Link).of_operation(step.operation),
            MoveKind::Feed if !goes_on => step.role(Role::Lead),
            MoveKind::Rapid | MoveKind::Feed => *step,
        };
        steps.push(Step { main, below, touches: goes_on });
    }
    steps
}

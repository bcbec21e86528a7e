//! The order in which a sheet is formed: nothing deeper at once than a step, or it is pierced, and no level after a lower one
//! at the same place, or it is stretched twice.

use std::collections::HashMap;

use styluscam_geometry::{Cutter, Tool};
use styluscam_motion::Program;

use crate::assignment::Assignment;
use crate::blank::Blank;
use crate::expectation::OrderedPasses;
use crate::findings::Fault;
use crate::legs::{Leg, LegKind};
use crate::tolerances::{ROUGH, SAME_LEVEL, WIDE};
use crate::{FindingKind, Limits, Subject};

/// A level counts as lower from this share of the step on.
const LOWER: f64 = 0.25;

/// Cosine of the slope up to which flat sheet may wrap the tool in one go: by the sine law it then keeps three quarters of its
/// thickness, and 41 degrees are a wall angle that every sheet bears.
const WRAPPED: f64 = 0.75;

/// Places of a move that are looked at, at most.
const MOST_PLACES: f64 = 10_000.0;

/// Moves that go deeper than they may below the sheet as it stands around them.
///
/// Levels may go a step deeper than what hangs there. Rows form nothing that is deeper than a dent: they finish what the
/// operations before them have formed. A fall at the path's own feed is a part of a pass over a wall, and worth a warning.
pub(crate) fn punches(
    program: &Program,
    legs: &[Leg],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
) -> Vec<Fault> {
    let Some(forming) = limits.forming.filter(|_| subject.expected.iter().any(|operation| operation.expectation.forms))
    else {
        return Vec::new();
    };
    let tools: Vec<Cutter> = subject.tools.iter().map(Tool::cutter).collect();
    let narrowest = tools.iter().map(Cutter::max_radius).fold(f64::INFINITY, f64::min);
    let mut blank = Blank::new(subject.mesh, forming.top, narrowest);
    let mut rows = Vec::new();
    let mut operation = None;
    let mut faults = Vec::new();
    for leg in legs.iter().filter(|leg| !matches!(leg.kind, LegKind::Rapid | LegKind::Retract | LegKind::Still)) {
        let Some(order) = assignment.of(leg.operation).filter(|order| order.expectation.forms) else { continue };
        let Some(tool) = tools.get(order.tool) else { continue };
        let step = order.expectation.ordered().and_then(descent);
        if operation.replace(leg.operation) != Some(leg.operation) {
            rows.drain(..).for_each(|(tip, tool)| blank.press(tip, tool));
        }
        let dent = dent(tool, forming.thickness) + ROUGH;
        let places = places(leg, blank.cell());
        let deepest = places
            .iter()
            .filter_map(|tip| punch(&mut blank, *tip, step, dent))
            .max_by(|a, b| a.depth().total_cmp(&b.depth()));
        if let Some(Punch { tip, stands }) = deepest {
            let fault = Fault { position: tip, ..leg.fault(FindingKind::Punch) }.measured(tip[2], stands);
            let falls = leg.kind == LegKind::Plunge && at_cut(program, leg, order.cut, limits);
            faults.push(if falls { fault.warning() } else { fault });
        }
        if step.is_some() {
            places.into_iter().for_each(|tip| blank.press(tip, tool));
        } else {
            rows.extend(places.into_iter().map(|tip| (tip, tool)));
        }
    }
    faults
}

/// The step of passes that go down one below the other, mm.
fn descent(passes: &OrderedPasses) -> Option<f64> {
    passes.scalar.descends().then_some(passes.step)
}

/// A tip below the sheet, which stands at a height there.
struct Punch {
    tip: [f64; 3],
    stands: f64,
}

impl Punch {
    fn depth(&self) -> f64 {
        self.stands - self.tip[2]
    }
}

/// Whether a tip is deeper below the sheet than it may go.
fn punch(blank: &mut Blank, tip: [f64; 3], step: Option<f64>, dent: f64) -> Option<Punch> {
    let [x, y, z] = tip;
    let pressed = blank.pressed_at([x, y]);
    let allowed = match step {
        Some(step) if pressed < blank.top() => WIDE * step + ROUGH,
        Some(step) => dent.max(WIDE * step + ROUGH),
        None => dent,
    };
    let is_below = |stands: f64| z < stands - allowed;
    let stands = is_below(pressed).then(|| blank.hangs_at([x, y]))?;
    is_below(stands).then_some(Punch { tip, stands })
}

/// How deep a tool may be pressed into sheet that is not formed there, mm: until it is wrapped up to a slope.
fn dent(tool: &Cutter, thickness: f64) -> f64 {
    tool.point_at(libm::acos(WRAPPED)).1 + thickness * (1.0 - WRAPPED)
}

/// Places of the tip on its way that are no farther apart than `pitch`, mm, without the first; on absurdly long moves some.
fn places(leg: &Leg, pitch: f64) -> Vec<[f64; 3]> {
    let count = (leg.length() / pitch).ceil().clamp(1.0, MOST_PLACES) as u32;
    (1..=count).map(|i| leg.at(f64::from(i) / f64::from(count))).collect()
}

/// Faults in the order of the moves.
pub(crate) fn faults(
    program: &Program,
    legs: &[Leg],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    for order in subject.expected.iter().filter(|order| order.expectation.forms) {
        let Some(passes) = order.expectation.ordered() else { continue };
        let Some(step) = descent(passes) else { continue };
        let Some(tool) = subject.tools.get(order.tool) else { continue };
        let cell = 0.5 * tool.diameter();
        let mut lowest: HashMap<[i64; 2], f64> = HashMap::new();
        // straight up or down at the path's feed the tool climbs over what stands there, or falls beside it, and comes
        // back: that is no level
        let mut away_from: Option<f64> = None;
        for leg in legs.iter().flat_map(Leg::pieces) {
            let along =
                at_cut(program, &leg, order.cut, limits) && matches!(leg.kind, LegKind::Plunge | LegKind::Retract);
            match (leg.kind, away_from, leg.start) {
                (LegKind::Rapid, ..) => away_from = None,
                (_, Some(level), _) if (leg.end[2] - level).abs() <= SAME_LEVEL => away_from = None,
                (_, None, Some(start)) if along => away_from = Some(start[2]),
                _ => {}
            }
            if leg.kind != LegKind::Contact || leg.falls() && !passes.continuous || away_from.is_some() {
                continue;
            }
            if !assignment.is(leg.operation, order) {
                continue;
            }
            let [x, y, z] = leg.end;
            let [i, j] = [x, y].map(|at| (at / cell).floor() as i64);
            let around = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
            let formed = around.filter_map(|place| lowest.get(&place)).copied().fold(f64::INFINITY, f64::min);
            if z > formed + LOWER * step {
                faults.push(leg.fault(FindingKind::FormingOrder).measured(z, formed).warning());
            }
            let here = lowest.entry([i, j]).or_insert(z);
            *here = here.min(z);
        }
    }
    faults.sort_by_key(|fault| fault.index);
    faults
}

/// Whether a move has the feed of the path.
fn at_cut(program: &Program, leg: &Leg, cut: f64, limits: &Limits) -> bool {
    (program.moves[leg.index].feed - cut).abs() <= limits.feed_unit
}

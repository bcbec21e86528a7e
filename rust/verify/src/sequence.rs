//! The order in which a sheet is formed: nothing deeper at once than a step, or it is pierced, and no level after a lower one
//! at the same position, or it is stretched twice.

use std::collections::HashMap;

use styluscam_geometry::{Cutter, Tool};
use styluscam_motion::Program;

use crate::assignment::Assignment;
use crate::blank::{Blank, Cells};
use crate::expectation::Layers;
use crate::faults::{self, Fault};
use crate::frame::Frame;
use crate::level_moves::{at_cut, level_moves, LOWER};
use crate::low_links;
use crate::rows::Row;
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::{ROUGH, WIDE};

/// Cosine of the slope up to which flat sheet may wrap the tool in one go: by the sine law it then keeps three quarters of its
/// thickness, and 41 degrees are a wall angle that every sheet withstands.
const WRAPPED: f64 = 0.75;

/// Distance of positions in layers, as a share of a cell: the sheet stands too high between them by the square of half of it over
/// the tool's diameter, hundredths of what a cell may be too low.
const FINE: f64 = 0.25;

/// Positions of a move that are looked at, at most.
const MOST_PLACES: f64 = 10_000.0;

/// Moves that go deeper than they may below the sheet as it stands around them.
///
/// Levels may go a step deeper than what hangs there. Rows form nothing that is deeper than a dent: they finish what the
/// operations before them have formed. Rows in layers may go an increment deeper than the sheet stood before the row. A fall at the path's own feed is a part of a pass over a wall, and worth a warning.
pub(crate) fn punches(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
    frame: Option<&Frame>,
) -> Vec<Fault> {
    let Some(forming) = limits.forming.filter(|_| subject.expected.iter().any(|operation| operation.expectation.forms))
    else {
        return Vec::new();
    };
    let tools: Vec<Cutter> = subject.tools.iter().map(Tool::cutter).collect();
    let narrowest = tools.iter().map(|tool| tool.max_radius()).fold(f64::INFINITY, f64::min);
    let layered = subject.expected.iter().filter_map(|order| Some((tools.get(order.tool)?, order.expectation.layers?)));
    let cells = layered.fold(Cells::of(narrowest), |cells, (tool, layers)| cells.fine(tool, layers.increment));
    let mut blank = Blank::new(subject.mesh, forming.top, cells, forming.support);
    let mut rows = Vec::new();
    let mut row = Row::default();
    let mut operation = None;
    let mut faults = Vec::new();
    for segment in segments.iter().filter(|segment| !matches!(segment.kind, SegmentKind::Retract | SegmentKind::Still))
    {
        let Some(order) = assignment.of(segment.operation).filter(|order| order.expectation.forms) else { continue };
        let Some(tool) = tools.get(order.tool) else { continue };
        let passes = order.expectation.descending();
        if operation.replace(segment.operation) != Some(segment.operation) {
            press_all(&mut blank, &mut rows);
            row = Row::default();
        }
        let layers = order.expectation.layers;
        let is_other = segment.kind == SegmentKind::Rapid || row.changes(&order.expectation, segment);
        if layers.is_some() && is_other {
            press_all(&mut blank, &mut rows);
        }
        if let Some([before, _]) = frame.map(|frame| frame.at(segment.index)) {
            blank.hold_at(before);
        }
        if segment.kind == SegmentKind::Rapid {
            faults.extend(low_rapid(&mut blank, segment, tool, low_links::margin(segment, assignment, limits)));
            continue;
        }
        let dent = dent(tool, forming.thickness) + ROUGH;
        let pitch = if layers.is_some() { FINE * blank.cell() } else { blank.cell() };
        let positions = positions(segment, pitch);
        if let Some(layers) = layers {
            faults.extend(increment(&mut blank, segment, (&positions, tool), &layers, limits));
        }
        let deepest = positions
            .iter()
            .filter_map(|tip| {
                // whatever step the job states, no sheet wraps the tool up to where it is widest in one go
                let step = passes.map(|passes| passes.step_at(*tip).min(tool.max_radius() / WIDE));
                let dent = if layers.is_some() { tool.max_radius() + ROUGH } else { dent };
                punch(&mut blank, *tip, step, dent)
            })
            .max_by(|a, b| a.depth().total_cmp(&b.depth()));
        if let Some(Punch { tip, stands }) = deepest {
            let fault = Fault { position: tip, ..segment.fault(&faults::PUNCH) }.measured(tip[2], stands);
            let falls = segment.kind == SegmentKind::Plunge && at_cut(program, segment, order, limits);
            faults.push(if falls { fault.warning() } else { fault });
        }
        if passes.is_some() {
            positions.into_iter().for_each(|tip| blank.press(tip, tool));
        } else {
            rows.extend(positions.into_iter().map(|tip| (tip, tool)));
        }
    }
    faults
}

/// Presses the sheet down to where tools were.
fn press_all(blank: &mut Blank, rows: &mut Vec<([f64; 3], &Cutter)>) {
    rows.drain(..).for_each(|(tip, tool)| blank.press(tip, tool));
}

/// A move that presses the sheet farther down than an increment of layers, anywhere under the tool.
fn increment(
    blank: &mut Blank,
    segment: &Segment,
    (positions, tool): (&[[f64; 3]], &Cutter),
    layers: &Layers,
    limits: &Limits,
) -> Option<Fault> {
    let mut most = layers.increment + limits.excess_of(segment.operation).unwrap_or(0.0) + ROUGH;
    let mut worst = None;
    for tip in positions {
        if let Some(by) = blank.pressed_by(*tip, tool, most) {
            (most, worst) = (by, Some(*tip));
        }
    }
    let position = worst?;
    Some(Fault { position, ..segment.fault(&faults::INCREMENT) }.measured(most, layers.increment))
}

/// A low rapid, which has to keep a margin above the sheet as it stands, mm.
fn low_rapid(blank: &mut Blank, segment: &Segment, tool: &Cutter, margin: Option<f64>) -> Option<Fault> {
    let margin = margin?;
    let lowered = |[x, y, z]: [f64; 3]| [x, y, z - margin];
    let positions = positions(segment, blank.cell()).into_iter();
    let found = positions.filter_map(|tip| Some((tip, blank.in_the_way(lowered(tip), tool)?)));
    let (tip, (stands, _)) = found.max_by(|a, b| a.1 .1.total_cmp(&b.1 .1))?;
    Some(Fault { position: tip, ..segment.fault(&faults::RAPID_NEAR_SHEET) }.measured(tip[2], stands))
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

/// Positions of the tip on its path that are no farther apart than `pitch`, mm, without the first; on extremely long moves some.
fn positions(segment: &Segment, pitch: f64) -> Vec<[f64; 3]> {
    let count = (segment.length() / pitch).ceil().clamp(1.0, MOST_PLACES) as u32;
    (1..=count).map(|i| segment.at(f64::from(i) / f64::from(count))).collect()
}

/// Faults in the order of the moves.
pub(crate) fn faults(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    for order in subject.expected.iter().filter(|order| order.expectation.forms) {
        let Some(passes) = order.expectation.descending() else { continue };
        let Some(tool) = subject.tools.get(order.tool) else { continue };
        let cell = 0.5 * tool.diameter();
        let mut lowest: HashMap<[i64; 2], f64> = HashMap::new();
        for segment in level_moves(program, segments, assignment, (order, passes), limits) {
            let [x, y, z] = segment.end;
            let [i, j] = [x, y].map(|at| (at / cell).floor() as i64);
            let around = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
            let formed = around.filter_map(|cell| lowest.get(&cell)).copied().fold(f64::INFINITY, f64::min);
            if z > formed + LOWER * passes.step_at(segment.end) {
                faults.push(segment.fault(&faults::FORMING_ORDER).measured(z, formed).warning());
            }
            let here = lowest.entry([i, j]).or_insert(z);
            *here = here.min(z);
        }
    }
    faults.sort_by_key(|fault| fault.index);
    faults
}

//! Whether what was read is what was posted.

use styluscam_motion::{Cycle, CycleKind, Event, EventKind, Move, MoveKind, Program};

use crate::machine::{Machine, ToolChange};
use crate::reader::Reading;
use crate::trial::slack::feed_slack;
use crate::trial::{lean, words};
use crate::writer::Posted;

/// Positions are compared with this slack over and above their rounding, mm.
const SLACK: f64 = 1e-9;
/// An arc's centre is rounded too: its path may leave the planned one by so many units of the last decimal.
const ARC_PLACES: f64 = 3.0;

/// An arc of a few units of the last decimal may turn so much farther once rounded, rad.
const TINY_SWEEP: f64 = 0.6;

/// The first thing of a program that was posted and does not come back: its line, 0 where none is at fault, and what it is.
///
/// Positions are compared within half a unit of the last decimal, arcs within three, events in their order; remarks are not.
#[must_use]
pub fn difference(program: &Program, posted: &Posted, reading: &Reading, machine: &Machine) -> Option<(u32, String)> {
    if reading.program.setup.wcs != program.setup.wcs {
        let (sent, came) = (&program.setup.wcs, &reading.program.setup.wcs);
        return Some((0, format!("work offset {sent} was posted and {came} was read")));
    }
    event_difference(program, posted, reading, machine)
        .or_else(|| cycle_difference(program, posted, reading, machine))
        .or_else(|| match lean::leans(program) {
            true => lean::move_difference(program, posted, reading, machine),
            false => move_difference(program, posted, reading, machine),
        })
}

/// Holes that the machine has cycles for must come back as cycles.
fn cycle_difference(program: &Program, posted: &Posted, reading: &Reading, machine: &Machine) -> Option<(u32, String)> {
    let unit = machine.resolution_mm() / 2.0 + SLACK;
    let mut came = reading.program.cycles.iter();
    for cycle in program.cycles.iter().filter(|cycle| machine.takes_cycle(cycle)) {
        let line = posted.line_of_move.get(cycle.first).copied().unwrap_or(0);
        let Some(found) = came.next() else {
            return Some((line, format!("{} was posted and not read", words::cycle(cycle))));
        };
        let at_once = is_in_one(cycle, machine) || is_in_one(found, machine);
        let (cycle, found) = if at_once { (&in_one(cycle), &in_one(found)) } else { (cycle, found) };
        let lengths = |c: &Cycle| [c.at[0], c.at[1], c.retract, c.bottom, c.peck];
        let near = lengths(cycle).iter().zip(lengths(found)).all(|(a, b)| (a - b).abs() <= unit);
        let feeds = (cycle.feed - found.feed).abs()
            <= feed_slack(machine, cycle.feed, f64::INFINITY, rpm_at(program, cycle.first));
        if !near || !feeds || cycle.kind != found.kind || (cycle.dwell - found.dwell).abs() > 5.1e-4 {
            return Some((line, format!("{} was posted and {} was read", words::cycle(cycle), words::cycle(found))));
        }
    }
    came.next().map(|found| {
        let line = reading.program.moves.get(found.first).map_or(0, |m| m.line);
        (line, format!("{} was read and not posted", words::cycle(found)))
    })
}

/// Whether pecks reach the bottom at once: then they are none.
fn is_in_one(cycle: &Cycle, machine: &Machine) -> bool {
    let pecks = matches!(cycle.kind, CycleKind::Peck | CycleKind::ChipBreak);
    pecks && cycle.peck >= cycle.retract - cycle.bottom - 1.5 * machine.resolution_mm()
}

/// The hole without its pecks.
fn in_one(cycle: &Cycle) -> Cycle {
    let kind = if matches!(cycle.kind, CycleKind::Peck | CycleKind::ChipBreak) { CycleKind::Drill } else { cycle.kind };
    Cycle { kind, peck: 0.0, ..cycle.clone() }
}

/// The first event that differs.
fn event_difference(program: &Program, posted: &Posted, reading: &Reading, machine: &Machine) -> Option<(u32, String)> {
    let sent_line = |index: usize| posted.line_of_move.get(index).copied();
    let came_line = |index: usize| reading.program.moves.get(index).map(|m| m.line);
    let (sent, came) = (states(program, machine, sent_line), states(&reading.program, machine, came_line));
    let event = |kind| words::event(kind, program);
    for (index, (line, kind)) in sent.iter().enumerate() {
        match came.get(index) {
            Some((there, found)) if same_event(kind, found, machine) => {
                if there != line {
                    return Some((*there, format!("{} is not after line {line}", event(kind))));
                }
            }
            Some((_, found)) => {
                let what = format!("{} was posted and {} was read", event(kind), event(found));
                return Some((*line, what));
            }
            None => return Some((*line, format!("{} was posted and not read", event(kind)))),
        }
    }
    came.get(sent.len()).map(|(line, kind)| (*line, format!("{} was read and not posted", event(kind))))
}

/// The events that the text must state, each with the line of the move before it, without those that state nothing new; a
/// cycle's own are its moves'.
fn states(program: &Program, machine: &Machine, line_of_move: impl Fn(usize) -> Option<u32>) -> Vec<(u32, EventKind)> {
    let mut out: Vec<(u32, EventKind)> = Vec::new();
    let mut spindle = EventKind::SpindleOff;
    let mut coolant = (false, false);
    let turns = |kind: &EventKind| matches!(kind, EventKind::SpindleOn { .. } | EventKind::SpindleOff);
    for event in program.events.iter().chain(&all_off(program.moves.len())) {
        let inside = |cycle: &Cycle| {
            machine.takes_cycle(cycle) && event.before > cycle.first && event.before < cycle.first + cycle.count
        };
        if is_silent(&event.kind, machine) || program.cycles.iter().any(inside) {
            continue;
        }
        // one word switches all coolant off: what is on counts
        let kind = match event.kind {
            EventKind::Mist { on } => coolant_state(&mut coolant, |c| c.0 = on),
            EventKind::Flood { on } => coolant_state(&mut coolant, |c| c.1 = on),
            ref kind => kind.clone(),
        };
        let line = event.before.checked_sub(1).and_then(&line_of_move).unwrap_or(0);
        let last = out.last().filter(|(before, _)| *before == line).map(|(_, kind)| kind.clone());
        // of several states of the spindle at one position the last one counts; it stops before a tool change by itself
        let change = matches!(kind, EventKind::ToolChange { .. });
        if last.as_ref().is_some_and(turns) && (change || turns(&kind)) {
            out.pop();
            spindle = spindle_after(&out);
        }
        if let EventKind::Raw { .. } = kind {
            if last.is_some_and(|last| matches!(last, EventKind::Raw { .. })) {
                out.pop();
            }
            let before = out.iter().rev().find(|(_, kind)| matches!(kind, EventKind::Raw { .. }));
            if kind == before.map_or_else(|| coolant_said((false, false)), |(_, before)| before.clone()) {
                continue;
            }
        }
        if turns(&kind) && kind == spindle {
            continue;
        }
        out.push((line, kind));
        spindle = spindle_after(&out);
    }
    out
}

/// What every program ends with, whether it states it or not.
fn all_off(moves: usize) -> [Event; 3] {
    [EventKind::Flood { on: false }, EventKind::Mist { on: false }, EventKind::SpindleOff]
        .map(|kind| Event { before: moves, kind })
}

/// Mist and flood after a change, as one event.
fn coolant_state(state: &mut (bool, bool), change: impl Fn(&mut (bool, bool))) -> EventKind {
    change(state);
    coolant_said(*state)
}

fn coolant_said((mist, flood): (bool, bool)) -> EventKind {
    EventKind::Raw { text: format!("mist {}, flood {}", words::switched(mist), words::switched(flood)) }
}

/// What the text need not state.
fn is_silent(kind: &EventKind, machine: &Machine) -> bool {
    match kind {
        EventKind::Comment { .. } | EventKind::Raw { .. } | EventKind::Sync { .. } => true,
        EventKind::Flood { on: false } | EventKind::Mist { on: false } => {
            machine.coolant.flood.is_none() && machine.coolant.mist.is_none()
        }
        EventKind::ToolChange { .. } => machine.tool.change == ToolChange::Unsaid,
        EventKind::Stop { .. } => machine.tool.change == ToolChange::Pause,
        // a start may wait
        EventKind::Dwell { .. } => machine.spindle.start_dwell > 0.0,
        _ => false,
    }
}

/// How the spindle turns after these.
fn spindle_after(events: &[(u32, EventKind)]) -> EventKind {
    let last = events.iter().rev().find_map(|(_, kind)| match kind {
        EventKind::SpindleOn { .. } => Some(kind.clone()),
        EventKind::SpindleOff | EventKind::ToolChange { .. } => Some(EventKind::SpindleOff),
        _ => None,
    });
    last.unwrap_or(EventKind::SpindleOff)
}

fn same_event(sent: &EventKind, came: &EventKind, machine: &Machine) -> bool {
    let unit = machine.resolution_mm() / 2.0 + SLACK;
    match (sent, came) {
        (EventKind::Dwell { seconds: a }, EventKind::Dwell { seconds: b }) => (a - b).abs() <= 5.1e-4,
        (EventKind::SpindleOn { rpm: a, direction: d }, EventKind::SpindleOn { rpm: b, direction: e }) => {
            let unit = machine.speed_resolution();
            d == e && (a - b).abs() <= unit / 2.0 + SLACK
        }
        (EventKind::Probe { end: a, must_touch: m, .. }, EventKind::Probe { end: b, must_touch: n, .. }) => {
            let near = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
                (Some(a), Some(b)) => (a - b).abs() <= unit,
                (None, None) => true,
                _ => false,
            };
            m == n && a.iter().zip(b).all(near)
        }
        (sent, came) => sent == came,
    }
}

fn move_difference(program: &Program, posted: &Posted, reading: &Reading, machine: &Machine) -> Option<(u32, String)> {
    let mut read = reading.program.segments().peekable();
    let (mut last_line, mut last_found) = (0, None);
    for (index, ((start, step), line)) in program.segments().zip(&posted.line_of_move).enumerate() {
        let mut arrived = None;
        let ends_cycle = |c: &&Cycle| machine.takes_cycle(c) && c.first + c.count == index + 1;
        while let Some((from, found)) = read.next_if(|(_, m)| m.line <= *line) {
            let deviation = || match cycle_at(program, index, machine) {
                Some(cycle) => low_crossing(program, cycle, from, found, machine),
                None => detour(start, step, found, *line, machine),
            };
            if let Some(what) = path_difference(start, step, from, found, machine).or_else(deviation) {
                return Some((found.line, what));
            }
            arrived = Some((from, found));
        }
        last_found = arrived.map(|(_, found)| found).or(last_found);
        // where a cycle leaves the tool is what counts, however it got there
        if let (Some(_), Some(found)) = (program.cycles.iter().find(ends_cycle), last_found) {
            if let Some(what) = end_difference(&Move { kind: found.kind, ..*step }, found, machine) {
                return Some((*line, what));
            }
        }
        let again = std::mem::replace(&mut last_line, *line) == *line;
        if again && arrived.is_none() || cycle_at(program, index, machine).is_some() {
            continue; // rounds to no motion, or is one of a cycle's
        }
        let Some(found) = arrived else {
            return Some((*line, format!("a move to {} was posted and not read", words::position(step.end.tip))));
        };
        let (from, found) = found;
        if let Some(what) = end_difference(step, found, machine) {
            return Some((*line, what));
        }
        let slack = feed_slack(machine, step.feed, found.length(from.unwrap_or(found.end.tip)), rpm_at(program, index));
        if step.kind == MoveKind::Feed && (step.feed - found.feed).abs() > slack {
            return Some((*line, format!("a feed of {} mm/min was posted and {} was read", step.feed, found.feed)));
        }
    }
    let unneeded = reading.planes_not_needed.iter().find_map(|run| reading.program.moves.get(run.start));
    let more = read.next().map(|(_, found)| (found.line, not_posted(found)));
    more.or(unneeded.map(|found| (found.line, "another plane than G17 is in force and no arc uses it".into())))
}

/// The canned cycle that a move belongs to.
fn cycle_at<'p>(program: &'p Program, index: usize, machine: &Machine) -> Option<&'p Cycle> {
    let cycle = program.cycles.iter().find(|c| (c.first..c.first + c.count).contains(&index))?;
    machine.takes_cycle(cycle).then_some(cycle)
}

/// Whether the path across to a hole is lower than planned.
fn low_crossing(
    program: &Program,
    cycle: &Cycle,
    from: Option<[f64; 3]>,
    found: &Move,
    machine: &Machine,
) -> Option<String> {
    let before = cycle.first.checked_sub(1).and_then(|before| program.moves.get(before));
    let height = before.map_or(cycle.retract, |step| step.end.tip[2].max(cycle.retract));
    let across = from.is_some_and(|from| (0..2).any(|axis| (from[axis] - found.end.tip[axis]).abs() > SLACK));
    let low = across && found.end.tip[2] < height - machine.resolution_mm() / 2.0 - SLACK;
    low.then(|| format!("it goes to {} before a hole, below Z{height:.3}", words::position(found.end.tip)))
}

/// Whether a move that was read goes to a position that its step does not have: templates must not move an axis.
fn detour(start: Option<[f64; 3]>, step: &Move, found: &Move, line: u32, machine: &Machine) -> Option<String> {
    if found.line == line || step.arc.is_some() {
        return None;
    }
    let slack = machine.resolution_mm() / 2.0 + SLACK;
    let between = found.end.tip.iter().zip(step.end.tip).enumerate().all(|(axis, (tip, end))| {
        let begin = start.map_or(end, |start| start[axis]);
        (tip - end).abs() <= slack || (tip - begin).abs() <= slack
    });
    let split = step.kind == MoveKind::Rapid && found.kind == MoveKind::Rapid && between;
    (!split).then(|| not_posted(found))
}

fn not_posted(found: &Move) -> String {
    format!("a move to {} was read and not posted", words::position(found.end.tip))
}

fn end_difference(step: &Move, found: &Move, machine: &Machine) -> Option<String> {
    let slack = machine.resolution_mm() / 2.0 + SLACK;
    let near = step.end.tip.iter().zip(found.end.tip).all(|(a, b)| (a - b).abs() <= slack);
    if !near || step.kind != found.kind {
        let move_to = |m: &Move| format!("{} to {}", words::motion(m.kind), words::position(m.end.tip));
        return Some(format!("a {} was posted and a {} was read", move_to(step), move_to(found)));
    }
    None
}

/// The spindle's speed when a move begins, rev/min; 0 while it stands.
fn rpm_at(program: &Program, index: usize) -> f64 {
    let count = program.events.partition_point(|event| event.before <= index);
    let events = program.events.iter().take(count).rev();
    let last = events.into_iter().find_map(|event| match event.kind {
        EventKind::SpindleOn { rpm, .. } => Some(rpm),
        EventKind::SpindleOff | EventKind::ToolChange { .. } => Some(0.0),
        _ => None,
    });
    last.unwrap_or(0.0)
}

/// Whether a posted move leaves an arc that it stands for.
fn path_difference(
    start: Option<[f64; 3]>,
    step: &Move,
    from: Option<[f64; 3]>,
    found: &Move,
    machine: &Machine,
) -> Option<String> {
    let (Some(arc), Some(start), Some(from)) = (step.arc, start, from) else { return None };
    let path = arc.path(start, step.end.tip);
    let slack = ARC_PLACES * machine.resolution_mm() + path.mismatch();
    let [first, second, _] = arc.plane.axes();
    let count = found.path(from).map_or(1, |w| w.chords(machine.resolution_mm()));
    let positions = (1..=count).map(|i| match found.path(from) {
        Some(w) => w.at(i as f64 / count as f64),
        None => found.end.tip,
    });
    let off = |position: [f64; 3]| {
        let radius = libm::hypot(position[first] - arc.centre[first], position[second] - arc.centre[second]);
        (radius - path.radius()).abs()
    };
    let worst = positions.map(off).fold(0.0, f64::max);
    let sweep = found.path(from).map_or(0.0, |w| w.sweep().abs());
    let too_far = sweep > path.sweep().abs() + TINY_SWEEP;
    (worst > slack || too_far).then(|| {
        format!("the move deviates from the posted arc by {worst:.4} mm, over {:.0} degrees", sweep.to_degrees())
    })
}

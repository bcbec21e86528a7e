//! Checks on a program before anything is written: records, order of events, the machine's limits.

use styluscam_motion::{EventKind, MoveKind, Program, ToolRecord};

use crate::machine::Machine;
use crate::post_error::PostError;

/// Finds the first thing that keeps `program` from this machine.
pub(crate) fn inspect(program: &Program, machine: &Machine) -> Result<(), PostError> {
    if program.moves.is_empty() {
        return Err(PostError::Empty);
    }
    inspect_wcs(program, machine)?;
    inspect_tools(program, machine)?;
    inspect_events(program, machine)?;
    inspect_moves(program, machine)?;
    inspect_range(program, machine)
}

fn inspect_wcs(program: &Program, machine: &Machine) -> Result<(), PostError> {
    let wcs = &program.setup.wcs;
    if machine.wcs.contains(wcs) {
        return Ok(());
    }
    Err(PostError::Wcs { wcs: wcs.clone(), allowed: machine.wcs.join(", ") })
}

fn inspect_tools(program: &Program, machine: &Machine) -> Result<(), PostError> {
    let max = machine.tool.max_number;
    for (index, tool) in program.tools.iter().enumerate() {
        if !(1..=max).contains(&tool.number) {
            return Err(PostError::ToolNumber { number: tool.number, max });
        }
        finite("the reference height", || format!("tools[{index}]"), tool.reference_height)?;
        let earlier = program.tools.iter().take(index);
        if let Some(other) = earlier.into_iter().find(|o| o.number == tool.number && !moves_alike(o, tool)) {
            let (first, second) = (other.name.clone(), tool.name.clone());
            return Err(PostError::ToolNumberTwice { number: tool.number, first, second });
        }
    }
    Ok(())
}

/// Whether two records mean the same motion in the text.
#[allow(clippy::float_cmp)] // the same number, not a near one
fn moves_alike(a: &ToolRecord, b: &ToolRecord) -> bool {
    a.length_offset == b.length_offset && a.reference_height == b.reference_height
}

fn inspect_events(program: &Program, machine: &Machine) -> Result<(), PostError> {
    let mut last = 0;
    for (number, event) in program.events.iter().enumerate() {
        if event.before < last || event.before > program.moves.len() {
            return Err(PostError::EventOrder { event: number });
        }
        last = event.before;
        inspect_event(number, &event.kind, machine)?;
    }
    Ok(())
}

fn inspect_event(number: usize, kind: &EventKind, machine: &Machine) -> Result<(), PostError> {
    match *kind {
        EventKind::SpindleOn { rpm, .. } => {
            let max = machine.limits.max_rpm.unwrap_or(f64::INFINITY);
            if !(0.0..=max).contains(&rpm) || rpm.is_infinite() {
                return Err(PostError::SpindleSpeed { rpm, max });
            }
            Ok(())
        }
        EventKind::Dwell { seconds } if seconds < 0.0 => Err(PostError::Dwell { event: number, seconds }),
        EventKind::Dwell { seconds } => finite("the dwell", || format!("events[{number}]"), seconds),
        _ => Ok(()),
    }
}

fn inspect_moves(program: &Program, machine: &Machine) -> Result<(), PostError> {
    let max = machine.limits.max_feed.unwrap_or(f64::INFINITY);
    for (index, step) in program.moves.iter().enumerate() {
        if step.operation as usize >= program.operations.len() {
            return Err(PostError::NoSuchRecord {
                place: format!("moves[{index}]"),
                what: "operation",
                index: step.operation,
            });
        }
        if step.kind == MoveKind::Rapid {
            continue;
        }
        if !step.feed.is_finite() || step.feed <= 0.0 {
            return Err(PostError::Feed { index, feed: step.feed });
        }
        if step.feed > max {
            return Err(PostError::FeedTooHigh { index, feed: step.feed, max });
        }
    }
    Ok(())
}

/// Compares the posted points, the tools' references, with the machine's range and travel.
fn inspect_range(program: &Program, machine: &Machine) -> Result<(), PostError> {
    let limits = &machine.limits;
    let ranges = [limits.x, limits.y, limits.z];
    if ranges.iter().all(Option::is_none) && limits.travel.is_none() {
        return Ok(());
    }
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (index, (least, most)) in program.posted_boxes().enumerate() {
        for axis in 0..3 {
            for value in [least[axis], most[axis]] {
                inspect_limit(index, axis, value, ranges[axis])?;
            }
            low[axis] = low[axis].min(least[axis]);
            high[axis] = high[axis].max(most[axis]);
        }
    }
    let Some(travel) = limits.travel else { return Ok(()) };
    for axis in 0..3 {
        let needed = high[axis] - low[axis];
        if needed > travel[axis] {
            return Err(PostError::Travel { axis: axis_name(axis), needed, travel: travel[axis] });
        }
    }
    Ok(())
}

fn inspect_limit(index: usize, axis: usize, value: f64, range: Option<[f64; 2]>) -> Result<(), PostError> {
    match range {
        Some([min, max]) if !(min..=max).contains(&value) => {
            Err(PostError::AxisLimit { index, axis: axis_name(axis), value, min, max })
        }
        _ => Ok(()),
    }
}

fn axis_name(axis: usize) -> char {
    ['X', 'Y', 'Z'].get(axis).copied().unwrap_or('?')
}

fn finite(what: &'static str, place: impl Fn() -> String, value: f64) -> Result<(), PostError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(PostError::Number { what, place: place(), value })
}

//! A part of a program: the moves of some of its operations.

use std::ops::Range;

use styluscam_motion::{Event, Move, Program};

/// The moves of some operations, by their ids, with all events; and those of them whose positions are not known.
pub fn own(program: &Program, ids: &[&str], is_unknown: impl Fn(usize) -> bool) -> (Program, Vec<Range<usize>>) {
    let mut operations = Vec::new();
    let numbers: Vec<Option<u32>> = program
        .operations
        .iter()
        .map(|operation| {
            ids.contains(&operation.id.as_str()).then(|| {
                operations.push(operation.clone());
                operations.len() as u32 - 1
            })
        })
        .collect();
    let number = |step: &Move| numbers.get(step.operation as usize).copied().flatten();
    let mut before = Vec::with_capacity(program.moves.len() + 1);
    let (mut moves, mut unknown) = (Vec::new(), Vec::new());
    for (index, step) in program.moves.iter().enumerate() {
        before.push(moves.len());
        let Some(operation) = number(step) else { continue };
        if is_unknown(index) {
            unknown.push(moves.len()..moves.len() + 1);
        }
        moves.push(Move { operation, ..*step });
    }
    let count = moves.len();
    before.push(count);
    let event = |event: &Event| {
        let at = before.get(event.before).copied().unwrap_or(count);
        Event { before: at, kind: event.kind.clone() }
    };
    let events = program.events.iter().map(event).collect();
    let own = Program { operations, events, moves, cycles: Vec::new(), ..program.clone() };
    (own, unknown)
}

//! Programs and machines for the tests.

use styluscam_motion::{
    Event, EventKind, Move, OperationRecord, Program, SetupRecord, SpindleDirection, ToolRecord, ToolReference,
};
use styluscam_post::machine::ToolChange;
use styluscam_post::Machine;

pub fn linuxcnc() -> Machine {
    Machine::shipped("linuxcnc").unwrap()
}

pub fn grbl() -> Machine {
    Machine::shipped("grbl").unwrap()
}

/// GRBL whose operator has tools of equal length.
pub fn grbl_with_pauses() -> Machine {
    let mut machine = grbl();
    machine.tool.change = ToolChange::Pause;
    machine
}

pub fn rapid(x: f64, y: f64, z: f64) -> Move {
    Move::rapid([x, y, z])
}

pub fn feed(x: f64, y: f64, z: f64, feed: f64) -> Move {
    Move::feed([x, y, z], feed)
}

pub fn event(before: usize, kind: EventKind) -> Event {
    Event { before, kind }
}

pub fn change(before: usize, tool: u32) -> Event {
    event(before, EventKind::ToolChange { tool })
}

pub fn spindle(before: usize, rpm: f64) -> Event {
    event(before, EventKind::SpindleOn { rpm, direction: SpindleDirection::Clockwise })
}

pub fn stylus(number: u32) -> ToolRecord {
    ToolRecord {
        name: format!("stylus{number}"),
        number,
        length_offset: number,
        description: "clothoid D10".into(),
        reference: ToolReference::Tip,
        reference_height: 0.0,
        diameter: 10.0,
    }
}

pub fn ball_by_center(number: u32, height: f64) -> ToolRecord {
    ToolRecord {
        reference: ToolReference::Center,
        reference_height: height,
        description: "ball D6".into(),
        ..stylus(number)
    }
}

pub fn program(moves: Vec<Move>, events: Vec<Event>, tools: Vec<ToolRecord>) -> Program {
    let setup = SetupRecord {
        title: "cone, first side".into(),
        wcs: "G54".into(),
        zero: "sheet top, centre of the blank".into(),
        part_min: [-50.0, -50.0, -20.0],
        part_max: [50.0, 50.0, 0.0],
        clearance: 10.0,
        notes: vec!["Sheet 1 mm, wall angle at most 60°; clamp the blank (M6 screws) before the start.".into()],
    };
    let operations = vec![OperationRecord { id: "walls".into(), kind: "z-level".into(), tool: 0 }];
    Program { moves, events, ..Program::empty(setup, tools, operations) }
}

/// A short program of one tool.
pub fn cone() -> Program {
    let moves = vec![
        rapid(10.0, -5.0, 10.0),
        rapid(10.0, -5.0, 1.0),
        feed(10.0, -5.0, -0.5, 100.0),
        feed(20.125, -5.0, -0.5, 1500.0),
        feed(20.125, 7.5, -0.5, 1500.0),
        rapid(20.125, 7.5, 10.0),
    ];
    program(moves, vec![change(0, 0)], vec![stylus(1)])
}

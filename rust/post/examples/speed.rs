//! Measures how many blocks a second are posted and read: `cargo run --release -p styluscam-post --example speed`.

#![allow(clippy::disallowed_methods)] // nothing here reaches a program

use std::time::Instant;

use styluscam_motion::{
    Event, EventKind, Move, MoveKind, OperationRecord, Program, SetupRecord, ToolRecord, ToolReference,
};
use styluscam_post::{post, read, Machine};

const MOVES: u32 = 2_000_000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let program = helix();
    for name in styluscam_post::shipped() {
        let machine = Machine::shipped(name)?;
        let start = Instant::now();
        let posted = post(&program, &machine)?;
        let seconds = start.elapsed().as_secs_f64();
        println!("{name}: posts {:.2} million blocks/s, {} bytes", f64::from(MOVES) / seconds / 1e6, posted.text.len());
        let start = Instant::now();
        let reading = read(&posted.text, &machine, &program.tools)?;
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "{name}: reads {:.2} million lines/s, {} moves",
            f64::from(MOVES) / seconds / 1e6,
            reading.program.moves.len()
        );
    }
    Ok(())
}

fn helix() -> Program {
    let tool = ToolRecord {
        name: "stylus".into(),
        number: 1,
        length_offset: 1,
        description: "ball D10".into(),
        reference: ToolReference::Tip,
        reference_height: 0.0,
        diameter: 10.0,
    };
    let setup = SetupRecord {
        title: "helix".into(),
        wcs: "G54".into(),
        zero: "sheet top".into(),
        part_min: [-100.0, -100.0, -40.0],
        part_max: [100.0, 100.0, 0.0],
        clearance: 10.0,
        notes: Vec::new(),
    };
    let operations = vec![OperationRecord { id: "helix".into(), kind: "spiral".into(), tool: 0 }];
    Program {
        moves: (0..MOVES).map(turn).collect(),
        events: vec![Event { before: 0, kind: EventKind::ToolChange { tool: 0 } }],
        ..Program::empty(setup, vec![tool], operations)
    }
}

fn turn(index: u32) -> Move {
    let (share, angle) = (f64::from(index) / f64::from(MOVES), f64::from(index) * 0.01);
    let (sine, cosine) = angle.sin_cos();
    let radius = 100.0 - 50.0 * share;
    let kind = if index == 0 { MoveKind::Rapid } else { MoveKind::Feed };
    Move::new(kind, [radius * cosine, radius * sine, -40.0 * share], 1500.0)
}

//! Prints a short program as the machines named are given it; as every shipped machine without names.

use styluscam_motion::{Event, EventKind, Move, OperationRecord, Program, SetupRecord, ToolRecord, ToolReference};
use styluscam_post::{post, shipped, Machine};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    for name in shipped().into_iter().filter(|name| names.is_empty() || names.iter().any(|n| n == name)) {
        let posted = post(&cone(), &Machine::shipped(name)?)?;
        println!("{}", posted.text);
    }
    Ok(())
}

fn cone() -> Program {
    let tool = ToolRecord {
        name: "stylus".into(),
        number: 1,
        length_offset: 1,
        description: "clothoid D10".into(),
        reference: ToolReference::Tip,
        reference_height: 0.0,
        diameter: 10.0,
    };
    let setup = SetupRecord {
        title: "cone".into(),
        wcs: "G54".into(),
        zero: "sheet top, centre of the blank".into(),
        part_min: [-50.0, -50.0, -20.0],
        part_max: [50.0, 50.0, 0.0],
        clearance: 10.0,
        notes: vec!["sheet 1 mm (constant law), steepest wall 60°".into()],
    };
    let operations = vec![OperationRecord { id: "walls".into(), kind: "z-level".into(), tool: 0 }];
    Program {
        moves: vec![
            Move::rapid([10.0, -5.0, 10.0]),
            Move::rapid([12.0, -5.0, 1.0]),
            Move::feed([12.0, -5.0, -0.5], 100.0),
            Move::feed([20.125, -5.0, -0.5], 1500.0),
            Move::feed([20.125, 7.5, -0.5], 1500.0),
            Move::rapid([20.125, 7.5, 10.0]),
        ],
        events: vec![Event { before: 0, kind: EventKind::ToolChange { tool: 0 } }],
        ..Program::empty(setup, vec![tool], operations)
    }
}

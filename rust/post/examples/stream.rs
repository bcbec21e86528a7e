//! Posts moves that are made one by one, and prints how many a second and how much memory that took:
//! `cargo run --release -p styluscam-post --example stream -- 10000000`.

#![allow(clippy::disallowed_methods)] // nothing here reaches a program

use std::fs::File;
use std::io::Write;
use std::time::Instant;

use styluscam_motion::{EventKind, Move, MoveKind, OperationRecord, Program, SetupRecord, ToolRecord, ToolReference};
use styluscam_post::{Facts, Machine, Poster};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let moves: u32 = std::env::args().nth(1).map_or(Ok(10_000_000), |text| text.parse())?;
    for name in ["linuxcnc", "heidenhain"] {
        let machine = Machine::shipped(name)?;
        let head = head();
        let mut sink = Counted { file: File::create("/dev/null")?, bytes: 0 };
        let start = Instant::now();
        let facts = Facts { deepest_z: -40.0, uses_spindle: false };
        let mut poster = Poster::streaming(&head, &facts, &machine, &mut sink)?;
        poster.event(&EventKind::ToolChange { tool: 0 })?;
        for index in 0..moves {
            poster.step(&turn(index))?;
        }
        poster.finish()?;
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "{name}: {:.2} million moves/s, {} MB of text, {} MB of memory at most",
            f64::from(moves) / seconds / 1e6,
            sink.bytes / 1_000_000,
            peak_memory_mb().unwrap_or_default()
        );
    }
    Ok(())
}

struct Counted {
    file: File,
    bytes: usize,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.bytes += bytes.len();
        self.file.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

/// The process's largest resident size, as the system reports it.
fn peak_memory_mb() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().trim_end_matches(" kB").parse::<u64>().ok()? / 1000)
}

fn head() -> Program {
    let tool = ToolRecord {
        name: "stylus".into(),
        number: 1,
        length_offset: 1,
        description: "ball D10".into(),
        reference: ToolReference::Tip,
        reference_height: 0.0,
        diameter: 10.0,
    };
    let setup = SetupRecord { title: "helix".into(), wcs: "G54".into(), clearance: 10.0, ..SetupRecord::default() };
    let operations = vec![OperationRecord { id: "helix".into(), kind: "spiral".into(), tool: 0 }];
    Program::empty(setup, vec![tool], operations)
}

fn turn(index: u32) -> Move {
    let angle = f64::from(index) * 0.005;
    let end = [80.0 * angle.cos(), 80.0 * angle.sin(), -1e-6 * f64::from(index)];
    let kind = if index == 0 { MoveKind::Rapid } else { MoveKind::Feed };
    Move::new(kind, end, 1500.0)
}

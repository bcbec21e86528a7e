//! Programs whose tool leans, for machines with rotary axes.

use styluscam_motion::{EventKind, Move, MoveKind, SpindleDirection, ToolRecord, ToolReference, UnitAxis};

use super::cases::{tool, Bench, Case, Draft};
use crate::machine::{Machine, RotaryAxis};
use crate::rotary::RotaryAxes;

/// Angles of the positions that are tried, as shares of how far each axis turns, and where the linear axes stand, as shares of their
/// range.
const STANDS: [([f64; 2], [f64; 3]); 6] = [
    ([0.3, 0.0], [0.0, 0.0, 0.4]),
    ([0.3, 0.0], [0.1, 0.0, 0.0]),
    ([0.6, 0.5], [0.2, 0.1, -0.1]),
    ([0.9, 0.2], [-0.1, 0.2, 0.0]),
    ([0.4, 0.8], [-0.2, -0.1, 0.1]),
    ([0.4, 0.8], [-0.2, -0.1, 0.3]),
];
/// An axis turns no farther, deg.
const WIDEST: f64 = 20.0;

/// A tool that leans, measured at its tip, and the next one after it.
pub(super) fn cases(machine: &Machine) -> Vec<Case> {
    let bench = &Bench::of(machine);
    let stands = stands(machine, |share| bench.at(share));
    if stands.is_empty() {
        return Vec::new();
    }
    let tip = |number: u32| ToolRecord { reference: ToolReference::Tip, reference_height: 0.0, ..tool(number) };
    let path = |draft: &mut Draft| {
        let last = stands.len() - 1;
        for (index, (tip, axis)) in stands.iter().enumerate() {
            let kind = if index == 0 || index == last { MoveKind::Rapid } else { MoveKind::Feed };
            let feed = if kind == MoveKind::Feed { bench.feed } else { 0.0 };
            draft.moves.push(Move::new(kind, *tip, feed).with_axis(*axis));
        }
    };
    let mut one = Draft::start(bench);
    one.moves.clear();
    path(&mut one);
    let mut two = Draft::start(bench);
    two.moves.clear();
    path(&mut two);
    two.event(EventKind::ToolChange { tool: 1 });
    if bench.always_turns {
        two.event(EventKind::SpindleOn { rpm: bench.rpm, direction: SpindleDirection::Clockwise });
    }
    path(&mut two);
    let case = |name: &str, draft: Draft, tools: Vec<ToolRecord>| {
        let mut case = bench.case(name, machine.clone(), draft);
        case.program.tools = tools;
        case
    };
    vec![case("a leaning tool", one, vec![tip(1)]), case("leaning tools", two, vec![tip(1), tip(2)])]
}

/// Tips and axes that the machine's axes reach; `at` gives a position within the linear ranges, mm.
fn stands(machine: &Machine, at: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<([f64; 3], UnitAxis)> {
    let axes = machine.rotary.as_ref().and_then(|rules| RotaryAxes::new(rules.axes).ok());
    let Some(axes) = axes else { return Vec::new() };
    let pose = |(shares, stand): &([f64; 2], [f64; 3])| {
        let angles = [0, 1].map(|i| angle(&axes.axes()[i], shares[i]));
        let axis = UnitAxis::new(axes.direction(angles)).unwrap_or_default();
        (axes.tip(at(*stand), angles), axis)
    };
    STANDS.iter().map(pose).collect()
}

fn angle(axis: &RotaryAxis, share: f64) -> f64 {
    let [low, high] = axis.limits_deg;
    let middle = 0.0_f64.clamp(low, high);
    let (up, down) = ((high - middle).min(WIDEST), (middle - low).min(WIDEST));
    middle + share * if up >= down { up } else { -down }
}

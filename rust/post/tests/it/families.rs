//! Every shipped machine: random programs of all that its file states it has come back as they were.

use crate::support::{ball_by_center, change, event, program, stylus};
use proptest::prelude::*;
use styluscam_motion::{
    Arc, Cycle, CycleKind, CycleStart, CycleStep, Event, EventKind, Move, MoveKind, Plane, Program, SpindleDirection,
};
use styluscam_post::machine::{LengthUnit, SpindleRules, ToolChange};
use styluscam_post::{difference, post, post_to, read, shipped, Machine};

/// One step of a random program.
#[derive(Clone, Debug)]
enum Step {
    Rapid([f64; 3]),
    Feed([f64; 3], f64),
    /// Plane, radius, start and sweep in degrees, rise, turns.
    Arc(Plane, f64, [f64; 2], f64, u32),
    /// Kind, depth, peck, dwell, whether it ends where it came from.
    Hole(CycleKind, f64, f64, f64, bool),
    Event(EventKind),
    Tool(u32),
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => -150.0..150.0_f64,
        2 => (-3_i32..3).prop_map(f64::from),
        1 => (-8_i32..8).prop_map(|n| f64::from(n) * 0.0003),
    ]
}

fn feed() -> impl Strategy<Value = f64> {
    prop_oneof![1.0..5000.0_f64, (1_i32..4).prop_map(|n| f64::from(n) * 500.0)]
}

fn plane() -> impl Strategy<Value = Plane> {
    prop_oneof![4 => Just(Plane::Xy), 1 => Just(Plane::Zx), 1 => Just(Plane::Yz)]
}

fn hole() -> impl Strategy<Value = Step> {
    use CycleKind::{Bore, ChipBreak, Drill, Peck, StopBore};
    let kind = prop_oneof![Just(Drill), Just(Peck), Just(ChipBreak), Just(Bore), Just(StopBore)];
    (kind, 0.5..20.0_f64, 0.3..5.0_f64, prop_oneof![Just(0.0), 0.01..2.0_f64], any::<bool>())
        .prop_map(|(kind, depth, peck, dwell, lift)| Step::Hole(kind, depth, peck, dwell, lift))
}

fn happening() -> impl Strategy<Value = EventKind> {
    prop_oneof![
        (100_u32..20_000)
            .prop_map(|rpm| EventKind::SpindleOn { rpm: f64::from(rpm), direction: SpindleDirection::Clockwise }),
        Just(EventKind::SpindleOff),
        any::<bool>().prop_map(|on| EventKind::Flood { on }),
        any::<bool>().prop_map(|on| EventKind::Mist { on }),
        "\\PC{0,90}".prop_map(|text| EventKind::Comment { text }),
        (0.001..60.0_f64).prop_map(|seconds| EventKind::Dwell { seconds }),
        any::<bool>().prop_map(|optional| EventKind::Stop { optional }),
    ]
}

fn step() -> impl Strategy<Value = Step> {
    let radius = prop_oneof![3 => 0.5..80.0_f64, 1 => 0.000_3..0.01_f64, 1 => 100.0..5000.0_f64];
    let sweep = prop_oneof![4 => -359.0..359.0_f64, 1 => Just(360.0), 1 => Just(-360.0), 1 => -1.0..1.0_f64];
    let rise = prop_oneof![2 => Just(0.0), 1 => -10.0..10.0_f64];
    let position = || [coordinate(), coordinate(), coordinate()];
    prop_oneof![
        2 => position().prop_map(Step::Rapid),
        5 => (position(), feed()).prop_map(|(end, feed)| Step::Feed(end, feed)),
        4 => (plane(), radius, 0.0..360.0_f64, sweep, rise, 0_u32..3)
            .prop_map(|(plane, radius, from, sweep, rise, turns)| Step::Arc(plane, radius, [from, sweep], rise, turns)),
        2 => hole(),
        3 => happening().prop_map(Step::Event),
        1 => (0_u32..3).prop_map(Step::Tool),
    ]
}

/// The steps as a program that this machine has words for.
fn built(steps: Vec<Step>, machine: &Machine) -> Program {
    let one_tool = matches!(machine.tool.change, ToolChange::LoadBeforeStart | ToolChange::Unsaid | ToolChange::Pause);
    let mut work = Work { moves: Vec::new(), events: vec![change(0, 0)], cycles: Vec::new(), tool: 0 };
    work.push(MoveKind::Rapid, [0.0, 0.0, 20.0], None, 0.0);
    for step in steps {
        match step {
            Step::Tool(tool) if !one_tool && tool != work.tool => {
                work.tool = tool;
                work.events.push(change(work.moves.len(), tool));
                work.push(MoveKind::Rapid, [1.0, 1.0, 20.0], None, 0.0);
            }
            Step::Tool(_) => {}
            Step::Rapid(end) => work.push(MoveKind::Rapid, end, None, 0.0),
            Step::Feed(end, feed) => work.push(MoveKind::Feed, end, None, feed),
            Step::Arc(plane, radius, angles, rise, turns) => work.arc(plane, radius, angles, rise, turns),
            Step::Hole(kind, depth, peck, dwell, lift) => work.hole(kind, depth, peck, dwell, lift, machine),
            Step::Event(kind) if has(machine, &kind) => work.events.push(event(work.moves.len(), kind)),
            Step::Event(_) => {}
        }
    }
    let mut tools = vec![stylus(1), ball_by_center(7, 3.0), ball_by_center(8, 4.567_891)];
    if one_tool {
        tools.truncate(1);
    }
    Program { cycles: work.cycles, ..program(work.moves, work.events, tools) }
}

/// Whether a machine has a word for an event.
fn has(machine: &Machine, kind: &EventKind) -> bool {
    let SpindleRules { clockwise, off, .. } = &machine.spindle;
    match kind {
        EventKind::SpindleOn { .. } => clockwise.is_some(),
        EventKind::SpindleOff => off.is_some(),
        EventKind::Flood { .. } => machine.coolant.flood.is_some(),
        EventKind::Mist { .. } => machine.coolant.mist.is_some(),
        EventKind::Dwell { .. } => machine.dwell.is_some(),
        EventKind::Stop { optional: true } => machine.stop.optional.is_some(),
        EventKind::Stop { optional: false } => machine.stop.always.is_some(),
        _ => true,
    }
}

struct Work {
    moves: Vec<Move>,
    events: Vec<Event>,
    cycles: Vec<Cycle>,
    tool: u32,
}

impl Work {
    fn push(&mut self, kind: MoveKind, end: [f64; 3], arc: Option<Arc>, feed: f64) {
        self.moves.push(Move::new(kind, end, feed).arc(arc));
    }

    fn at(&self) -> [f64; 3] {
        self.moves.last().unwrap().end.tip
    }

    fn arc(&mut self, plane: Plane, radius: f64, [from, sweep]: [f64; 2], rise: f64, turns: u32) {
        let [first, second, third] = plane.axes();
        let start = self.at();
        let (sin, cos) = from.to_radians().sin_cos();
        let mut centre = start;
        centre[first] -= radius * cos;
        centre[second] -= radius * sin;
        let (sin, cos) = (from + sweep).to_radians().sin_cos();
        let mut end = start;
        if sweep.abs() < 360.0 {
            end[first] = centre[first] + radius * cos;
            end[second] = centre[second] + radius * sin;
        }
        end[third] += rise;
        self.push(MoveKind::Feed, end, Some(Arc { centre, plane, clockwise: sweep < 0.0, turns }), 800.0);
    }

    fn hole(&mut self, kind: CycleKind, depth: f64, peck: f64, dwell: f64, lift: bool, machine: &Machine) {
        let position = self.at();
        let retract = position[2] - 1.0;
        let dwells = matches!(kind, CycleKind::Drill | CycleKind::Bore) && machine.dwell.is_some();
        let pecks = matches!(kind, CycleKind::Peck | CycleKind::ChipBreak);
        let hole = Cycle {
            first: self.moves.len(),
            count: 0,
            kind,
            at: [position[0] + 5.0, position[1]],
            retract,
            bottom: retract - depth,
            leave: if lift { position[2] } else { retract },
            feed: 200.0,
            dwell: if dwells { dwell } else { 0.0 },
            peck: if pecks { peck } else { 0.0 },
        };
        let spindle = self.events.iter().rev().find_map(|event| match event.kind {
            EventKind::SpindleOn { rpm, direction } => Some(Some((rpm, direction))),
            EventKind::SpindleOff | EventKind::ToolChange { .. } => Some(None),
            _ => None,
        });
        for step in hole.steps(&CycleStart { position, spindle: spindle.flatten() }).unwrap() {
            match step {
                CycleStep::Move(kind, end) => {
                    self.push(kind, end, None, if kind == MoveKind::Feed { 200.0 } else { 0.0 });
                }
                CycleStep::Event(kind) => self.events.push(event(self.moves.len(), kind)),
            }
        }
        self.cycles.push(Cycle { count: self.moves.len() - hole.first, ..hole });
    }
}

fn check(steps: Vec<Step>, machine: &Machine) {
    let program = built(steps, machine);
    let posted = post(&program, machine).unwrap_or_else(|e| panic!("{}: {e}", machine.name));
    for line in posted.text.lines() {
        assert!(line.is_ascii() && !line.contains(|c: char| c.is_control()), "{}: {line}", machine.name);
        let code = line.split(['(', ';']).next().unwrap();
        assert!(!code.contains("-0 ") && !code.ends_with("-0"), "{}: {line}", machine.name);
    }
    let reading = read(&posted.text, machine, &program.tools)
        .unwrap_or_else(|e| panic!("{}: {e}\n{}", machine.name, posted.text));
    if let Some((line, what)) = difference(&program, &posted, &reading, machine) {
        panic!("{}, line {line}: {what}\n{}", machine.name, posted.text);
    }
    let mut streamed = Vec::new();
    post_to(&program, machine, &mut streamed).unwrap();
    assert_eq!(String::from_utf8(streamed).unwrap(), posted.text, "in pieces as whole");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn any_machine_in_its_unit(name in prop::sample::select(shipped()), steps in prop::collection::vec(step(), 1..30)) {
        check(steps, &Machine::shipped(name).unwrap());
    }

    #[test]
    fn any_machine_in_inches(name in prop::sample::select(shipped()), steps in prop::collection::vec(step(), 1..30)) {
        let mut machine = Machine::shipped(name).unwrap();
        prop_assume!(machine.units.inch.is_some() && machine.reader.default_units.is_none());
        machine.units.output = LengthUnit::Inch;
        check(steps, &machine);
    }
}

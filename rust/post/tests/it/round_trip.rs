//! Whatever is posted reads back as the same program, rounded; and the text keeps the machine's rules.

use crate::support::{ball_by_center, grbl, grbl_with_pauses, linuxcnc, program, stylus};
use proptest::prelude::*;
use styluscam_motion::{Event, EventKind, Move, MoveKind, Program, Role, SpindleDirection, ToolRecord};
use styluscam_post::machine::{
    BlockNumber, CommentForm, LengthUnit, LineEnd, Point, Repeat, Separator, ToolChange, TrailingZeros,
};
use styluscam_post::{post, read, shipped, Machine, Posted, Reading};

/// What the text states, in order: events, and moves that move.
#[derive(Clone, Debug, PartialEq)]
enum Item {
    Event(EventKind),
    Move { kind: MoveKind, end: [f64; 3], feed: f64 },
}

/// The rounding of one machine.
struct Grid {
    per_mm: f64,
    linear: f64,
    feed: f64,
}

impl Grid {
    fn of(machine: &Machine) -> Self {
        let (unit, places) = match machine.units.output {
            LengthUnit::Mm => (1.0, machine.number.mm),
            LengthUnit::Inch => (25.4, machine.number.inch),
        };
        Self {
            per_mm: f64::recip(unit),
            linear: 10_f64.powi(i32::from(places.linear)),
            feed: 10_f64.powi(i32::from(places.feed)),
        }
    }

    fn round(&self, mm: f64) -> f64 {
        (mm * self.per_mm * self.linear).round() / self.linear / self.per_mm
    }

    fn round_feed(&self, feed: f64) -> f64 {
        (feed * self.per_mm * self.feed).round() / self.feed / self.per_mm
    }
}

/// What the text of `program` should state, found without the writer.
fn expected(program: &Program, machine: &Machine) -> Vec<Item> {
    let grid = Grid::of(machine);
    let mut items = Vec::new();
    let (mut tool, mut placed, mut turns, mut flood) = (0_usize, false, false, false);
    let mut at: Option<[f64; 3]> = None; // the posted point
    for index in 0..=program.moves.len() {
        for event in program.events.iter().filter(|e| e.before == index) {
            match &event.kind {
                EventKind::ToolChange { tool: next } => {
                    if turns {
                        items.push(Item::Event(EventKind::SpindleOff));
                    }
                    (tool, placed, turns) = (*next as usize, false, false);
                }
                EventKind::SpindleOn { .. } => turns = true,
                EventKind::SpindleOff => turns = false,
                EventKind::Flood { on } => flood = *on,
                EventKind::Comment { .. } => continue,
                _ => {}
            }
            items.push(Item::Event(event.kind.clone()));
        }
        let Some(step) = program.moves.get(index) else { break };
        let height = program.tools[tool].reference_height;
        let goal = [grid.round(step.end.tip[0]), grid.round(step.end.tip[1]), grid.round(step.end.tip[2] + height)];
        let from = at.unwrap_or(goal);
        let across = from[0] != goal[0] || from[1] != goal[1];
        let mut stops = vec![goal];
        if step.kind == MoveKind::Rapid && !placed {
            stops.insert(0, [from[0], from[1], goal[2]]);
        } else if step.kind == MoveKind::Rapid && across && goal[2] != from[2] {
            stops.insert(0, if goal[2] > from[2] { [from[0], from[1], goal[2]] } else { [goal[0], goal[1], from[2]] });
        }
        let feed = if step.kind == MoveKind::Feed { grid.round_feed(step.feed) } else { 0.0 };
        for stop in stops {
            items.push(Item::Move { kind: step.kind, end: [stop[0], stop[1], stop[2] - height], feed });
        }
        at = Some(goal);
        placed = true;
    }
    // what still runs at the end is switched off
    items.extend(flood.then_some(Item::Event(EventKind::Flood { on: false })));
    items.extend(turns.then_some(Item::Event(EventKind::SpindleOff)));
    without_repeats(items)
}

/// What was read, with events and moves in one row.
fn found(reading: &Reading) -> Vec<Item> {
    let program = &reading.program;
    let mut items = Vec::new();
    for index in 0..=program.moves.len() {
        let events = program.events.iter().filter(|e| e.before == index);
        items.extend(
            // a stop is how an operator changes the tool
            events
                .filter(|e| !matches!(e.kind, EventKind::Comment { .. } | EventKind::Stop { .. }))
                .map(|e| Item::Event(e.kind.clone())),
        );
        let step = program.moves.get(index);
        items.extend(step.map(|m| Item::Move { kind: m.kind, end: m.end.tip, feed: m.feed }));
    }
    without_repeats(items)
}

/// Leaves out moves to the position where the tip stands.
fn without_repeats(items: Vec<Item>) -> Vec<Item> {
    let mut at: Option<[f64; 3]> = None;
    items
        .into_iter()
        .filter(|item| match item {
            Item::Event(EventKind::ToolChange { .. }) => {
                at = None;
                true
            }
            Item::Event(_) => true,
            Item::Move { end, .. } => {
                let moved = at.is_none_or(|a| !near(a, *end));
                at = Some(*end);
                moved
            }
        })
        .collect()
}

fn near(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-7)
}

fn same(a: &Item, b: &Item) -> bool {
    match (a, b) {
        (Item::Move { kind, end, feed }, Item::Move { kind: k, end: e, feed: f }) => {
            kind == k && near(*end, *e) && (feed - f).abs() < 1e-7 * (1.0 + feed)
        }
        (Item::Event(EventKind::Dwell { seconds: a }), Item::Event(EventKind::Dwell { seconds: b })) => {
            (a - b).abs() < 6e-4
        }
        (a, b) => a == b,
    }
}

fn check_text(posted: &Posted, machine: &Machine) {
    assert!(posted.text.is_ascii());
    for line in posted.text.lines() {
        assert!(line.len() <= machine.line.max_chars as usize || line.starts_with('('), "{line}");
        assert!(!line.contains(|c: char| c.is_control() || machine.line.forbidden.contains(c)), "{line}");
        if !line.starts_with(['(', ';']) {
            check_numbers(line);
        }
    }
}

fn check_numbers(line: &str) {
    let words = line.split_inclusive(|c: char| c.is_ascii_alphabetic());
    let mut letter = ' ';
    for piece in words {
        let number = piece.trim_end_matches(|c: char| c.is_ascii_alphabetic()).trim();
        if !number.is_empty() {
            let value: f64 = number.parse().unwrap();
            assert!(value != 0.0 || !number.contains('-'), "minus zero in {line}");
            assert!(letter != 'F' || value > 0.0, "feed of zero in {line}");
        }
        letter = piece.chars().next_back().unwrap();
        assert!(letter != 'E', "exponent in {line}");
    }
}

/// Every move's line leads to its end, within half a unit of the last decimal.
fn check_lines(program: &Program, machine: &Machine, posted: &Posted, reading: &Reading) {
    assert_eq!(posted.line_of_move.len(), program.moves.len());
    for (step, line) in program.moves.iter().zip(&posted.line_of_move) {
        let arrived = reading.program.moves.iter().rfind(|m| m.line == *line).unwrap();
        for (a, b) in arrived.end.tip.iter().zip(step.end.tip) {
            assert!((a - b).abs() <= machine.resolution_mm() / 2.0 + 1e-9, "line {line}: {a} for {b}");
        }
    }
}

fn check_round_trip(program: &Program, machine: &Machine) {
    let posted = post(program, machine).unwrap();
    check_text(&posted, machine);
    let reading = read(&posted.text, machine, &program.tools).unwrap_or_else(|e| panic!("{e}\n{}", posted.text));
    let (planned, got) = (expected(program, machine), found(&reading));
    for (index, (a, b)) in planned.iter().zip(&got).enumerate() {
        assert!(same(a, b), "item {index}: {a:?} became {b:?}\n{}", posted.text);
    }
    assert_eq!(planned.len(), got.len(), "{}", posted.text);
    assert_eq!(reading.program.setup.wcs, program.setup.wcs);
    check_lines(program, machine, &posted, &reading);
}

// Random programs

fn coordinate() -> impl Strategy<Value = f64> {
    // Few values often: positions meet, and rounding makes motion vanish.
    prop_oneof![
        3 => -200.0..200.0_f64,
        2 => (-3_i32..3).prop_map(f64::from),
        1 => (-8_i32..8).prop_map(|n| f64::from(n) * 0.0003),
    ]
}

fn position() -> impl Strategy<Value = [f64; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

fn step() -> impl Strategy<Value = Move> {
    let feed = prop_oneof![(5.0..5000.0_f64), (1_i32..4).prop_map(|n| f64::from(n) * 500.0)];
    (position(), prop_oneof![1 => Just(None), 4 => feed.prop_map(Some)])
        .prop_map(|(end, feed)| feed.map_or(Move::rapid(end), |feed| Move::feed(end, feed)))
}

fn happening() -> impl Strategy<Value = EventKind> {
    prop_oneof![
        (0_u32..24_000, any::<bool>()).prop_map(|(rpm, cw)| EventKind::SpindleOn {
            rpm: f64::from(rpm),
            direction: if cw { SpindleDirection::Clockwise } else { SpindleDirection::Counterclockwise },
        }),
        Just(EventKind::SpindleOff),
        any::<bool>().prop_map(|on| EventKind::Flood { on }),
        "\\PC{0,120}".prop_map(|text| EventKind::Comment { text }),
        (0.0..100.0_f64).prop_map(|seconds| EventKind::Dwell { seconds }),
    ]
}

/// One tool's part of a program: moves, of which the first is a rapid, and events at some of them.
fn part() -> impl Strategy<Value = (Vec<Move>, Vec<(usize, EventKind)>)> {
    (prop::collection::vec(step(), 1..25), prop::collection::vec((0_usize..25, happening()), 0..5))
}

fn tools() -> Vec<ToolRecord> {
    vec![stylus(1), ball_by_center(7, 3.0), ball_by_center(12, 4.567_891)]
}

fn random_program(parts: std::ops::Range<usize>) -> impl Strategy<Value = Program> {
    prop::collection::vec((0_u32..3, part()), parts).prop_map(|parts| {
        let (mut moves, mut events): (Vec<Move>, Vec<Event>) = (Vec::new(), Vec::new());
        for (tool, (mut steps, happenings)) in parts {
            let start = moves.len();
            events.push(crate::support::change(start, tool));
            let mut happenings: Vec<_> =
                happenings.into_iter().map(|(at, e)| (start + at.min(steps.len()), e)).collect();
            happenings.sort_by_key(|(at, _)| *at);
            events.extend(happenings.into_iter().map(|(at, e)| crate::support::event(at, e)));
            steps[0].kind = MoveKind::Rapid;
            moves.extend(steps);
        }
        program(moves, events, tools())
    })
}

/// A machine with anything else that a file of this family may ask for.
fn styled(machine: Machine) -> impl Strategy<Value = Machine> {
    let flags = prop::collection::vec(any::<bool>(), 10);
    flags.prop_map(move |flags| {
        let mut machine = machine.clone();
        let pick = |i: usize| flags[i];
        machine.units.output = if pick(0) { LengthUnit::Mm } else { LengthUnit::Inch };
        machine.number.point = if pick(1) { Point::Always } else { Point::IfFraction };
        machine.number.trailing_zeros = if pick(2) { TrailingZeros::Keep } else { TrailingZeros::Strip };
        machine.number.leading_zero = pick(3);
        machine.number.plus_sign = pick(4);
        machine.words.separator = if pick(5) { Separator::Space } else { Separator::None };
        machine.words.repeat_g = if pick(6) { Repeat::Always } else { Repeat::Modal };
        machine.words.repeat_axes = if pick(7) { Repeat::Always } else { Repeat::Modal };
        machine.block_number = pick(8).then_some(BlockNumber::plain(10, 10, 200));
        machine.line.eol = if pick(9) { LineEnd::Crlf } else { LineEnd::Lf };
        if pick(8) {
            machine.comment.form = CommentForm::Semicolon;
            machine.comment.uppercase = true;
        }
        machine
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn linuxcnc_in_mm(program in random_program(1..4)) {
        check_round_trip(&program, &linuxcnc());
    }

    #[test]
    fn linuxcnc_in_inches(program in random_program(1..4)) {
        let mut machine = linuxcnc();
        machine.units.output = LengthUnit::Inch;
        check_round_trip(&program, &machine);
    }

    #[test]
    fn grbl_in_mm(program in random_program(1..2)) {
        check_round_trip(&program, &grbl());
    }

    #[test]
    fn grbl_in_inches(program in random_program(1..2)) {
        let mut machine = grbl();
        machine.units.output = LengthUnit::Inch;
        check_round_trip(&program, &machine);
    }

    #[test]
    fn grbl_with_pauses_for_tools(program in random_program(1..4)) {
        check_round_trip(&program, &grbl_with_pauses());
    }

    #[test]
    fn any_style_of_words((program, machine) in (random_program(1..4), styled(linuxcnc()))) {
        check_round_trip(&program, &machine);
    }

    #[test]
    fn text_is_the_same_every_time(program in random_program(1..3)) {
        prop_assert_eq!(post(&program, &linuxcnc()).unwrap(), post(&program, &linuxcnc()).unwrap());
    }

    /// Text read and posted again is the same motion: reading loses nothing that posting needs.
    #[test]
    fn reads_twice_alike(program in random_program(1..4)) {
        let machine = linuxcnc();
        let first = read(&post(&program, &machine).unwrap().text, &machine, &program.tools).unwrap();
        let second = read(&post(&first.program, &machine).unwrap().text, &machine, &program.tools).unwrap();
        let (a, b) = (found(&first), found(&second));
        prop_assert_eq!(a.len(), b.len());
        prop_assert!(a.iter().zip(&b).all(|(a, b)| same(a, b)));
    }

    #[test]
    fn numbers_of_any_size_end_in_text_or_an_error(end in [any::<f64>(), any::<f64>(), any::<f64>()], speed in any::<f64>()) {
        let mut program = crate::support::cone();
        program.moves[3].end.tip = end;
        program.moves[4].feed = speed;
        if let Ok(posted) = post(&program, &linuxcnc()) {
            check_text(&posted, &linuxcnc());
        }
    }
}

#[test]
fn the_pause_machine_is_grbl_otherwise() {
    let mut machine = grbl_with_pauses();
    machine.tool.change = ToolChange::LoadBeforeStart;
    assert_eq!(machine, grbl());
}

/// The roles of the moves that a text has when it is read.
fn roles_read(program: &Program, machine: &Machine) -> Vec<Option<Role>> {
    let text = post(program, machine).unwrap().text;
    read(&text, machine, &program.tools).unwrap().program.moves.iter().map(|step| step.role).collect()
}

#[test]
fn roles_of_feed_moves_are_stated_and_read() {
    let feed = |x: f64| Move::feed([x, 0.0, -1.0], 500.0);
    let moves = vec![
        Move::rapid([0.0, 0.0, 10.0]),
        Move::rapid([1.0, 0.0, 10.0]),
        feed(2.0).role(Role::Lead),
        feed(3.0).role(Role::Cut),
        feed(4.0).role(Role::Cut),
        Move::rapid([4.0, 0.0, 10.0]),
        feed(5.0).role(Role::Link),
        feed(6.0),
        feed(7.0).role(Role::Ramp),
        Move::rapid([7.0, 0.0, 10.0]),
    ];
    let tool_change = Event { before: 0, kind: EventKind::ToolChange { tool: 0 } };
    let mut program = program(moves, vec![tool_change], vec![stylus(1)]);
    let stated: Vec<Option<Role>> = program.moves.iter().map(|step| step.role).collect();
    let cut = &Some(Role::Cut);
    for machine in shipped().into_iter().map(|name| Machine::shipped(name).unwrap()) {
        let read = roles_read(&program, &machine);
        let expected = if machine.comment.form == CommentForm::None { 0 } else { 2 };
        assert_eq!(read.iter().filter(|role| *role == cut).count(), expected, "{}", machine.name);
    }
    let (linuxcnc, mut silent) = (linuxcnc(), linuxcnc());
    let found: Vec<_> = roles_read(&program, &linuxcnc).into_iter().flatten().collect();
    assert_eq!(found, stated.iter().copied().flatten().collect::<Vec<_>>());
    silent.comment.form = CommentForm::None;
    assert!(roles_read(&program, &silent).iter().all(Option::is_none));
    // without roles no text has a word of them
    program.moves.iter_mut().for_each(|step| step.role = None);
    assert!(!post(&program, &linuxcnc).unwrap().text.contains("role"));
}

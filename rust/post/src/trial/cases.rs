//! The programs of the trial.

use styluscam_motion::{
    Arc, Cycle, CycleKind, CycleStart, CycleStep, Event, EventKind, Move, MoveKind, OperationRecord, Plane, Program,
    SetupRecord, SpindleDirection, ToolRecord, ToolReference,
};

use crate::machine::{FeedMode, LengthUnit, Machine};

/// One program of the trial, and the machine that it is for.
pub(super) struct Case {
    pub name: String,
    pub program: Program,
    pub machine: Machine,
    /// Whether it must be refused.
    pub must_fail: bool,
    /// Whether it is read as text that nobody knows the tools of.
    foreign: bool,
}

impl Case {
    /// The tools that the reader is given.
    pub fn tools(&self) -> &[ToolRecord] {
        if self.foreign {
            &[]
        } else {
            &self.program.tools
        }
    }
}

/// All that is tried on a machine.
pub(super) fn cases(machine: &Machine) -> Vec<Case> {
    let bench = Bench::of(machine);
    let mut out: Vec<Case> = Vec::new();
    let mut add = |name: &str, draft: Draft| out.push(bench.case(name, machine.clone(), draft));
    add("rapids and lines", lines(&bench));
    add("operations, one behind the other", operations(&bench, machine));
    add("values at the edges of rounding", edges(&bench));
    add("feeds", feeds(&bench));
    let planes = [Plane::Xy, Plane::Zx, Plane::Yz];
    for plane in planes.into_iter().filter(|plane| !bench.lathe || *plane == Plane::Zx) {
        add(&format!("arcs in {}", name_of(plane)), arcs(&bench, plane));
        add(&format!("helices across {}", name_of(plane)), helices(&bench, plane));
    }
    add("tiny arcs", tiny_arcs(&bench));
    add("large arcs", large_arcs(&bench));
    add("remarks", remarks(&bench));
    add("spindle, clockwise", spindle(&bench, SpindleDirection::Clockwise));
    add("spindle, counterclockwise", spindle(&bench, SpindleDirection::Counterclockwise));
    add("coolant: flood", coolant(&bench, |on| EventKind::Flood { on }));
    add("coolant: mist", coolant(&bench, |on| EventKind::Mist { on }));
    add("dwells", dwells(&bench));
    add("program stops", stops(&bench, false));
    add("optional stops", stops(&bench, true));
    add("waiting for another program", waits(&bench));
    for (name, kind, peck, dwell) in HOLES {
        add(name, holes(&bench, kind, peck, dwell));
    }
    out.push(tools(&bench, machine));
    out.push(foreign(bench.case("probing", machine.clone(), probing(&bench))));
    out.push(foreign(bench.case(
        "another work offset on the way",
        machine.clone(),
        offsets_on_the_way(&bench, machine),
    )));
    out.extend(wcs(&bench, machine));
    out.extend(units(machine));
    out.extend(feed_modes(&bench, machine));
    out.extend(outside(&bench, machine));
    out
}

const HOLES: [(&str, CycleKind, f64, f64); 9] = [
    ("holes: drilling", CycleKind::Drill, 0.0, 0.0),
    ("holes: drilling with a dwell", CycleKind::Drill, 0.0, 0.5),
    ("holes: pecking", CycleKind::Peck, 0.3, 0.0),
    ("holes: chip breaking", CycleKind::ChipBreak, 0.3, 0.0),
    ("holes: tapping", CycleKind::Tap, 0.0, 0.0),
    ("holes: left-hand tapping", CycleKind::LeftTap, 0.0, 0.0),
    ("holes: boring", CycleKind::Bore, 0.0, 0.0),
    ("holes: boring with a dwell", CycleKind::Bore, 0.0, 0.25),
    ("holes: boring with a stopped spindle", CycleKind::StopBore, 0.0, 0.0),
];

fn name_of(plane: Plane) -> &'static str {
    match plane {
        Plane::Xy => "XY",
        Plane::Zx => "ZX",
        Plane::Yz => "YZ",
    }
}

/// Where a machine can move, and what it can do.
pub(super) struct Bench {
    centre: [f64; 3],
    /// Half of the range along each axis, mm.
    size: [f64; 3],
    pub feed: f64,
    pub rpm: f64,
    wcs: String,
    lathe: bool,
    /// Whether the spindle turns clockwise.
    turns: bool,
    /// Whether it must turn wherever there is a feed.
    pub always_turns: bool,
}

/// Height of the tried tool's reference above its tip, mm.
const HEIGHT: f64 = 1.0;

impl Bench {
    pub fn of(machine: &Machine) -> Self {
        let limits = &machine.limits;
        let ranges = [limits.x, limits.y, limits.z];
        let range = |axis: usize| {
            let (middle, half) = ranges[axis]
                .map_or((0.0, 100.0), |[low, high]| (f64::midpoint(low, high), ((high - low) / 2.0).min(100.0)));
            let travel = limits.travel.map_or(f64::INFINITY, |travel| travel[axis]);
            (middle, half.min(travel / 2.0) * 0.9)
        };
        let [x, y, z] = [0, 1, 2].map(range);
        let rpm = limits.max_rpm.map_or(1000.0, |most| most.min(1000.0)).max(limits.min_rpm.unwrap_or(0.0)).floor();
        let lathe = machine.motion.lathe.is_some();
        Self {
            centre: [x.0, if lathe { 0.0 } else { y.0 }, z.0 - HEIGHT],
            size: [x.1, if lathe { 0.0 } else { y.1 }, z.1 - HEIGHT],
            feed: limits.max_feed.map_or(400.0, |most| most.min(400.0)),
            rpm,
            wcs: machine.wcs.first().cloned().unwrap_or_default(),
            lathe,
            turns: machine.spindle.clockwise.is_some(),
            always_turns: machine.feed.mode == FeedMode::PerRevolution,
        }
    }

    /// A position; -1 to 1 is the range along each axis.
    pub fn at(&self, share: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.centre[axis] + share[axis] * self.size[axis])
    }

    /// A position so many mm from the middle.
    fn off(&self, mm: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.centre[axis] + if self.lathe && axis == 1 { 0.0 } else { mm[axis] })
    }

    /// A length that fits in the range, mm.
    fn fits(&self, mm: f64) -> f64 {
        let least =
            if self.lathe { self.size[0].min(self.size[2]) } else { self.size.iter().copied().fold(mm, f64::min) };
        mm.min(least / 2.5)
    }

    pub fn case(&self, name: &str, machine: Machine, draft: Draft) -> Case {
        let setup = SetupRecord {
            title: "trial".into(),
            wcs: self.wcs.clone(),
            zero: "anywhere".into(),
            part_min: [0.0; 3],
            part_max: [1.0; 3],
            clearance: 1.0,
            notes: vec!["äöü (°) and so on".into()],
        };
        let operation = |id: &str| OperationRecord { id: id.into(), kind: "z-level".into(), tool: 0 };
        let Draft { moves, events, cycles, operation: last } = draft;
        let operations = ["trial", "second"].into_iter().take(last as usize + 1).map(operation).collect();
        let program = Program { moves, events, cycles, ..Program::empty(setup, vec![tool(1)], operations) };
        Case { name: name.into(), program, machine, must_fail: false, foreign: false }
    }
}

pub(super) fn tool(number: u32) -> ToolRecord {
    ToolRecord {
        name: format!("stylus {number}"),
        number,
        length_offset: number,
        description: "ball D2".into(),
        reference: ToolReference::Center,
        reference_height: HEIGHT,
        diameter: 2.0,
    }
}

fn foreign(case: Case) -> Case {
    let mut program = case.program;
    for tool in &mut program.tools {
        (tool.reference, tool.reference_height) = (ToolReference::Tip, 0.0);
    }
    Case { program, foreign: true, ..case }
}

/// Moves and events in the making.
pub(super) struct Draft {
    pub moves: Vec<Move>,
    events: Vec<Event>,
    cycles: Vec<Cycle>,
    operation: u32,
}

impl Draft {
    /// The tool is called and goes to the middle.
    pub fn start(bench: &Bench) -> Self {
        let change = Event { before: 0, kind: EventKind::ToolChange { tool: 0 } };
        let mut draft = Self { moves: Vec::new(), events: vec![change], cycles: Vec::new(), operation: 0 };
        if bench.always_turns {
            draft.event(EventKind::SpindleOn { rpm: bench.rpm, direction: SpindleDirection::Clockwise });
        }
        draft.rapid(bench.at([0.0; 3]));
        draft
    }

    fn rapid(&mut self, end: [f64; 3]) {
        self.push(MoveKind::Rapid, end, None, 0.0);
    }

    fn feed(&mut self, end: [f64; 3], feed: f64) {
        self.push(MoveKind::Feed, end, None, feed);
    }

    fn push(&mut self, kind: MoveKind, end: [f64; 3], arc: Option<Arc>, feed: f64) {
        self.moves.push(Move::new(kind, end, feed).arc(arc).of_operation(self.operation));
    }

    pub fn event(&mut self, kind: EventKind) {
        self.events.push(Event { before: self.moves.len(), kind });
    }
}

fn lines(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    for [x, y, z] in [[0.5, 0.0, 0.5], [0.5, 0.5, -0.5], [-0.5, 0.5, -0.5], [-0.5, 0.5, 0.5], [0.0, 0.0, 0.25]] {
        draft.rapid(bench.at([x, y, z]));
    }
    for share in [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 0.3, 0.777_777]] {
        draft.feed(bench.at(share), bench.feed);
    }
    draft.rapid(bench.at([0.0, 0.0, 1.0]));
    draft
}

/// Two operations of one tool, with all that may run: what stands between them must leave it running.
fn operations(bench: &Bench, machine: &Machine) -> Draft {
    let mut draft = Draft::start(bench);
    if bench.turns && !bench.always_turns {
        draft.event(EventKind::SpindleOn { rpm: bench.rpm, direction: SpindleDirection::Clockwise });
    }
    if machine.coolant.flood.is_some() {
        draft.event(EventKind::Flood { on: true });
    }
    for operation in 0..2 {
        draft.operation = operation;
        draft.rapid(bench.at([0.5, 0.5, 0.5]));
        draft.feed(bench.at([0.5, 0.5, -0.5]), bench.feed);
        draft.feed(bench.at([-0.5, 0.5, -0.5]), bench.feed);
        draft.rapid(bench.at([-0.5, 0.5, 0.5]));
    }
    draft
}

/// Steps about the last decimal, halves of it, positions that round to where the tool stands, and back over zero.
fn edges(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    for step in
        [1e-7_f64, 0.000_049, 0.000_05, 0.000_1, 0.000_4, 0.000_499, 0.000_5, 0.000_51, 0.001, 0.9995, 0.999_499]
    {
        let step = step.min(bench.fits(1.0));
        for sign in [1.0, -1.0] {
            draft.feed(bench.off([sign * step, 0.0, 0.0]), bench.feed);
            draft.feed(bench.off([sign * step, sign * step, -sign * step]), bench.feed);
        }
    }
    draft.rapid(bench.off([0.000_2, 0.0, 0.0]));
    draft.feed(bench.off([bench.fits(1.0); 3]), bench.feed);
    draft
}

fn feeds(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    for (index, feed) in [1.0, 1.5, 10.0, 99.96, 333.333, 1e3, 12_345.678].into_iter().enumerate() {
        let x = bench.fits(1.0) * (index % 3) as f64;
        draft.feed(bench.off([x, bench.fits(1.0) * index as f64 / 7.0, 0.0]), bench.feed.min(feed).max(1.0));
    }
    draft
}

/// An arc about a centre in a plane, from where the tool stands.
fn arc(draft: &mut Draft, bench: &Bench, plane: Plane, radius: f64, angles: [f64; 2], turns: u32) {
    let [first, second, third] = plane.axes();
    let spot = |angle: f64| {
        let mut mm = [0.0; 3];
        let (sin, cos) = libm::sincos(angle.to_radians());
        mm[first] = radius * cos;
        mm[second] = radius * sin;
        bench.off(mm)
    };
    let [from, to] = angles;
    let (start, end) = (spot(from), if (to - from).abs() >= 360.0 { spot(from) } else { spot(to) });
    draft.rapid(start);
    let clockwise = to < from;
    let mut centre = bench.off([0.0; 3]);
    centre[third] = start[third];
    draft.push(MoveKind::Feed, end, Some(Arc { centre, plane, clockwise, turns }), bench.feed);
}

fn arcs(bench: &Bench, plane: Plane) -> Draft {
    let mut draft = Draft::start(bench);
    let radius = bench.fits(20.0);
    for angles in [
        [0.0, 90.0],
        [90.0, 0.0],
        [10.0, 190.0],
        [190.0, 10.0],
        [33.3, 303.3],
        [303.3, 33.3],
        [0.0, 359.0],
        [45.0, 405.0],
        [45.0, -315.0],
        [17.0, 17.5],
    ] {
        arc(&mut draft, bench, plane, radius, angles, 0);
    }
    draft
}

fn helices(bench: &Bench, plane: Plane) -> Draft {
    let mut draft = Draft::start(bench);
    let [_, _, third] = plane.axes();
    let radius = bench.fits(10.0);
    for (angles, turns) in [([0.0, 360.0], 0), ([90.0, -200.0], 0), ([0.0, 360.0], 2), ([30.0, -90.0], 3)] {
        arc(&mut draft, bench, plane, radius, angles, turns);
        if let Some(last) = draft.moves.last_mut().filter(|_| !(bench.lathe && third == 1)) {
            last.end.tip[third] += bench.fits(3.0);
        }
    }
    draft
}

fn tiny_arcs(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    let plane = if bench.lathe { Plane::Zx } else { Plane::Xy };
    for radius in [0.000_3, 0.000_7, 0.001, 0.001_6, 0.003, 0.01, 0.05] {
        for angles in [[0.0, 90.0], [0.0, 360.0], [20.0, -250.0]] {
            arc(&mut draft, bench, plane, radius, angles, 0);
        }
    }
    draft
}

/// Short paths on circles of 1 to 1000 m.
fn large_arcs(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    let plane = if bench.lathe { Plane::Zx } else { Plane::Xy };
    let [first, second, _] = plane.axes();
    for radius in [1e3, 1e4, 1e6] {
        let half = bench.fits(20.0);
        let angle = libm::asin(half / radius);
        let position = |side: f64| {
            let mut mm = [0.0; 3];
            mm[first] = side * half;
            mm[second] = radius * (libm::cos(angle) - 1.0);
            bench.off(mm)
        };
        let mut mm = [0.0; 3];
        mm[second] = -radius;
        let centre = bench.off(mm);
        draft.rapid(position(1.0));
        draft.push(MoveKind::Feed, position(-1.0), Some(Arc { centre, plane, clockwise: false, turns: 0 }), bench.feed);
    }
    draft
}

fn remarks(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    let long = "a long remark that goes on and on ".repeat(20);
    let texts = [
        "plain",
        "half way; [almost]",
        "(inside) ((twice)) )",
        "two\nlines\r\nand G0 Z-100",
        "%",
        ":",
        ";",
        "!?~$",
        "O1000",
        "N10 G1 X1",
        "/skip",
        "~",
        "ÄÖÜ äöü ß ° µ ± × Ø – … €",
        "MSG, DEBUG, PRINT",
        "operation of another: kind",
        "",
        "   ",
        &long,
    ];
    for (index, text) in texts.into_iter().enumerate() {
        draft.event(EventKind::Comment { text: text.into() });
        draft.feed(bench.off([bench.fits(1.0) * (index % 2) as f64, 0.0, 0.0]), bench.feed);
    }
    draft.event(EventKind::Comment { text: "MSG,stop".into() });
    draft
}

fn spindle(bench: &Bench, direction: SpindleDirection) -> Draft {
    let mut draft = Draft::start(bench);
    for (index, rpm) in [bench.rpm, (bench.rpm / 2.0).floor(), bench.rpm].into_iter().enumerate() {
        draft.event(EventKind::SpindleOn { rpm, direction });
        draft.feed(bench.off([bench.fits(1.0) * (1 + index) as f64, 0.0, 0.0]), bench.feed);
    }
    draft.event(EventKind::SpindleOff);
    draft
}

fn coolant(bench: &Bench, kind: fn(bool) -> EventKind) -> Draft {
    let mut draft = Draft::start(bench);
    for on in [true, false] {
        // all coolant goes off by one word, which switches flood off too
        draft.event(kind(on));
        draft.feed(bench.off([bench.fits(if on { 1.0 } else { 2.0 }), 0.0, 0.0]), bench.feed);
    }
    draft
}

fn dwells(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    for (index, seconds) in [0.001, 0.25, 1.0, 2.5, 60.0].into_iter().enumerate() {
        draft.event(EventKind::Dwell { seconds });
        draft.feed(bench.off([bench.fits(1.0) * (index % 2) as f64 + 0.1, 0.0, 0.0]), bench.feed);
    }
    draft
}

fn stops(bench: &Bench, optional: bool) -> Draft {
    let mut draft = Draft::start(bench);
    draft.event(EventKind::Stop { optional });
    draft.feed(bench.off([bench.fits(1.0), 0.0, 0.0]), bench.feed);
    draft
}

fn waits(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    draft.event(EventKind::Sync { mark: 1 });
    draft.feed(bench.off([bench.fits(1.0), 0.0, 0.0]), bench.feed);
    draft
}

/// Five holes: two alike, one deeper, one that ends lower, one at another position.
fn holes(bench: &Bench, kind: CycleKind, peck: f64, dwell: f64) -> Draft {
    let mut draft = Draft::start(bench);
    let direction =
        if kind == CycleKind::LeftTap { SpindleDirection::Counterclockwise } else { SpindleDirection::Clockwise };
    let turns = kind.is_tapping() || kind == CycleKind::StopBore && bench.turns;
    let spindle = turns.then_some((bench.rpm, direction));
    if let Some((rpm, direction)) = spindle {
        draft.event(EventKind::SpindleOn { rpm, direction });
    }
    let unit = bench.fits(1.0);
    let [x, y, z] = bench.off([0.0; 3]);
    let initial = z + unit;
    draft.rapid([x, y, initial]);
    for (dx, depth, lift) in
        [(1.0, 1.0, true), (2.0, 1.0, true), (2.0, 1.5, true), (1.0, 1.5, false), (0.0, 1.5, false)]
    {
        let position = draft.moves.last().map_or([x, y, initial], |m| m.end.tip);
        let retract = z;
        let hole = Cycle {
            first: draft.moves.len(),
            count: 0,
            kind,
            at: [x + dx * unit, y],
            retract,
            bottom: z - depth * unit,
            leave: if lift { position[2].max(retract) } else { retract },
            feed: bench.feed,
            dwell,
            peck: peck * unit,
        };
        for step in hole.steps(&CycleStart { position, spindle }).unwrap_or_default() {
            match step {
                CycleStep::Move(MoveKind::Rapid, end) => draft.rapid(end),
                CycleStep::Move(MoveKind::Feed, end) => draft.feed(end, bench.feed),
                CycleStep::Event(kind) => draft.event(kind),
            }
        }
        let count = draft.moves.len() - hole.first;
        draft.cycles.push(Cycle { count, ..hole });
    }
    draft.feed(bench.off([unit, unit, 0.0]), bench.feed);
    if spindle.is_some() {
        draft.event(EventKind::SpindleOff);
    }
    draft
}

/// Two tools, each with moves of its own.
fn tools(bench: &Bench, machine: &Machine) -> Case {
    let mut draft = lines(bench);
    draft.event(EventKind::ToolChange { tool: 1 });
    draft.rapid(bench.at([0.0; 3]));
    draft.feed(bench.at([0.1, 0.0, -0.1]), bench.feed);
    let mut case = bench.case("tool changes", machine.clone(), draft);
    case.program.tools.push(tool(2));
    case
}

fn probing(bench: &Bench) -> Draft {
    let mut draft = Draft::start(bench);
    let z = bench.off([0.0, 0.0, -bench.fits(1.0)])[2];
    draft.event(EventKind::Probe { end: [None, None, Some(z)], feed: bench.feed, must_touch: true });
    draft.rapid(bench.at([0.0; 3]));
    draft.feed(bench.off([bench.fits(1.0), 0.0, 0.0]), bench.feed);
    draft
}

fn offsets_on_the_way(bench: &Bench, machine: &Machine) -> Draft {
    let mut draft = lines(bench);
    if bench.turns && !bench.always_turns {
        draft.event(EventKind::SpindleOn { rpm: bench.rpm, direction: SpindleDirection::Clockwise });
    }
    if let Some(wcs) = machine.wcs.get(1) {
        draft.event(EventKind::WorkOffset { wcs: wcs.clone() });
        draft.rapid(bench.at([0.0; 3]));
        draft.feed(bench.off([bench.fits(1.0), 0.0, 0.0]), bench.feed);
    }
    draft
}

fn wcs(bench: &Bench, machine: &Machine) -> Vec<Case> {
    let case = |wcs: &String| {
        let mut case = bench.case(&format!("work offset {wcs}"), machine.clone(), lines(bench));
        case.program.setup.wcs.clone_from(wcs);
        case
    };
    machine.wcs.iter().map(case).collect()
}

/// The same in the unit that is not posted by default.
fn units(machine: &Machine) -> Vec<Case> {
    let mut other = machine.clone();
    other.units.output = match machine.units.output {
        LengthUnit::Mm => LengthUnit::Inch,
        LengthUnit::Inch => LengthUnit::Mm,
    };
    if other.check().is_err() || other.reader.default_units.is_some() {
        return Vec::new();
    }
    let bench = Bench::of(&other);
    let name = |what: &str| format!("{what} in {}", if other.units.output == LengthUnit::Mm { "mm" } else { "inches" });
    let plane = if bench.lathe { Plane::Zx } else { Plane::Xy };
    vec![
        bench.case(&name("lines"), other.clone(), lines(&bench)),
        bench.case(&name("arcs"), other.clone(), arcs(&bench, plane)),
    ]
}

fn feed_modes(bench: &Bench, machine: &Machine) -> Vec<Case> {
    let modes = [(FeedMode::PerRevolution, "feeds per revolution"), (FeedMode::InverseTime, "inverse time")];
    let mut out = Vec::new();
    for (mode, name) in modes {
        let mut other = machine.clone();
        other.feed.mode = mode;
        if other.feed.word().is_none() || other.spindle.clockwise.is_none() || other.check().is_err() {
            continue;
        }
        let draft = spindle(bench, SpindleDirection::Clockwise);
        out.push(bench.case(name, other, draft));
    }
    out
}

/// A position beyond each end of each axis must be refused.
fn outside(bench: &Bench, machine: &Machine) -> Vec<Case> {
    let limits = &machine.limits;
    let mut out = Vec::new();
    for (axis, range) in [limits.x, limits.y, limits.z].into_iter().enumerate() {
        for (end, sign) in range.into_iter().flatten().zip([-1.0, 1.0]) {
            let mut draft = Draft::start(bench);
            let mut position = bench.at([0.0; 3]);
            position[axis] = end + sign * 0.01 - if axis == 2 { HEIGHT } else { 0.0 };
            draft.rapid(position);
            let name = format!("limit {}{end}", ["X", "Y", "Z"][axis]);
            out.push(Case { must_fail: true, ..bench.case(&name, machine.clone(), draft) });
        }
    }
    out
}

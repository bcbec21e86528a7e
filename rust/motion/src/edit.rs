//! What shops do with a finished program: go on from the middle, run it in the air, stop between operations.

use crate::{Arc, Cycle, Event, EventKind, FeedMode, Move, MoveKind, Plane, Pose, Program, UnitAxis};

/// Heights of a level are compared with this slack, mm.
const SAME_HEIGHT: f64 = 1e-6;

/// A plunge along the axis may miss it by so much, mm: the coordinates of texts are rounded.
const SAME_PLAN: f64 = 0.05;

/// The tip up along the tool's axis at a height, mm; straight up where the tool lies.
fn above(pose: &Pose, height: f64) -> [f64; 3] {
    let ([x, y, z], [across, aside, rise]) = (pose.tip, pose.axis.vector());
    if rise < UnitAxis::LEAST_RISE || height <= z {
        return [x, y, height];
    }
    let length = (height - z) / rise;
    [x + across * length, y + aside * length, height]
}

impl Program {
    /// The program from one of its moves on: tool, spindle, coolant and work offset as they are there, the approach to its start
    /// at the clearance height and then down along the tool's axis at the feed of its operation's plunges.
    ///
    /// None when there is no such move, when it is the first (nothing comes before it), or when it lies in a canned cycle
    /// that began before it.
    #[must_use]
    pub fn restarted(&self, first: usize) -> Option<Self> {
        let before = first.checked_sub(1)?;
        let start = self.moves.get(before)?.end;
        let step = self.moves.get(first)?;
        if self.cycles.iter().any(|cycle| cycle.first < first && first < cycle.first + cycle.count) {
            return None;
        }
        let highest = self.moves.iter().take(first).map(|m| m.end.tip[2]).fold(self.setup.clearance, f64::max);
        let approach = |plain: Move| plain.with_axis(start.axis).of_operation(step.operation).on_line(step.line);
        // behind a tool or another zero point the last position means nothing: the program goes on with a rapid of its own
        let anew = |e: &Event| matches!(e.kind, EventKind::ToolChange { .. } | EventKind::WorkOffset { .. });
        let anew = self.events.iter().any(|event| event.before == first && anew(event));
        if anew && step.kind != MoveKind::Rapid {
            return None;
        }
        let mut moves = Vec::new();
        if !anew {
            moves.push(approach(Move::rapid(above(&start, highest))));
        }
        if !anew && step.kind == MoveKind::Feed && highest > start.tip[2] {
            let (feed, mode) = self.plunge_feed(start, step);
            moves.push(approach(Move::feed(start.tip, feed).with_feed(feed, mode)));
        }
        let shift = moves.len();
        moves.extend_from_slice(self.moves.get(first..)?);
        let (state, wcs) = self.state_before(first);
        let mut setup = self.setup.clone();
        setup.wcs = wcs.unwrap_or(setup.wcs);
        let later =
            self.events.iter().filter(|event| event.before > first || event.before == first && !is_state(&event.kind));
        let events = state.into_iter().map(|kind| Event { before: 0, kind });
        let events = events.chain(later.map(|e| Event { before: e.before - first + shift, kind: e.kind.clone() }));
        let cycles = self.cycles.iter().filter(|cycle| cycle.first >= first);
        Some(Self {
            moves,
            events: events.collect(),
            cycles: cycles.map(|c| Cycle { first: c.first - first + shift, ..c.clone() }).collect(),
            setup,
            ..Self::empty(self.setup.clone(), self.tools.clone(), self.operations.clone())
        })
    }

    /// The lowest feed at which the operation of a move from `start` goes straight down; the move's own where it never does.
    fn plunge_feed(&self, start: Pose, step: &Move) -> (f64, FeedMode) {
        let (own, mode) = lasting_feed(start.tip, step);
        let plunges = self.segments().filter_map(|(start, plunge)| {
            let (start, end) = (start?, plunge.end.tip);
            let foot = above(&plunge.end, start[2]);
            let down = end[2] < start[2]
                && libm::hypot(foot[0] - start[0], foot[1] - start[1])
                    <= if plunge.end.axis.is_up() { SAME_HEIGHT } else { SAME_PLAN };
            let (feed, of) = lasting_feed(start, plunge);
            (down && plunge.kind == MoveKind::Feed && plunge.operation == step.operation && of == mode).then_some(feed)
        });
        (plunges.fold(own, f64::min), mode)
    }

    /// Tool, spindle and coolant as they are when a move begins, and the work offset where one was called before it.
    fn state_before(&self, first: usize) -> (Vec<EventKind>, Option<String>) {
        state_of(self.events.iter().take_while(|event| event.before <= first))
    }

    /// The first move of a level of an operation: levels are the heights at which it goes level at feed, in order, from 1.
    #[must_use]
    pub fn level_start(&self, operation: u32, level: usize) -> Option<usize> {
        let mut height = None;
        let mut count = 0;
        for (index, (start, step)) in self.segments().enumerate() {
            let z = step.end.tip[2];
            let level_move =
                step.kind == MoveKind::Feed && start.is_none_or(|start| (z - start[2]).abs() <= SAME_HEIGHT);
            if step.operation != operation || !level_move {
                continue;
            }
            if height.is_none_or(|height: f64| (height - z).abs() > SAME_HEIGHT) {
                height = Some(z);
                count += 1;
                if count == level {
                    return Some(index);
                }
            }
        }
        None
    }

    /// The same program so many mm higher: it cuts air.
    #[must_use]
    pub fn raised(&self, by: f64) -> Self {
        let mut program = self.clone();
        for step in &mut program.moves {
            step.end.tip[2] += by;
            step.arc = step.arc.map(|arc| raised_arc(arc, by));
        }
        for cycle in &mut program.cycles {
            for z in [&mut cycle.retract, &mut cycle.bottom, &mut cycle.leave] {
                *z += by;
            }
        }
        for event in &mut program.events {
            if let EventKind::Probe { end: [_, _, Some(z)], .. } = &mut event.kind {
                *z += by;
            }
        }
        program.setup.clearance += by;
        program
    }

    /// The same program with an optional stop before every operation but the first: spindle and coolant are off there, and on
    /// again behind it unless an event of the program there decides otherwise.
    #[must_use]
    pub fn with_optional_stops(&self) -> Self {
        let mut program = self.clone();
        for before in self.operation_starts().into_iter().rev() {
            let first = program.events.partition_point(|event| event.before < before);
            let behind = program.events.partition_point(|event| event.before <= before);
            let (running, _) = state_of(program.events.iter().take(first));
            let running: Vec<EventKind> =
                running.into_iter().filter(|kind| !matches!(kind, EventKind::ToolChange { .. })).collect();
            let here = program.events.get(first..behind).unwrap_or_default();
            let decided = |kind: &EventKind| here.iter().any(|event| decides(&event.kind, kind));
            let again: Vec<EventKind> = running.iter().filter(|kind| !decided(kind)).cloned().collect();
            let stop = EventKind::Stop { optional: true };
            let at = |kind| Event { before, kind };
            program.events.splice(behind..behind, again.into_iter().map(at));
            program.events.splice(first..first, running.iter().rev().map(off).chain([stop]).map(at));
        }
        program
    }

    /// Leaves out what the header of a text states about itself: another machine's header takes its place.
    pub fn forget_old_header(&mut self) {
        // in small letters: some machines have capitals only
        const OWN: [&str; 8] = [
            "machine: ",
            "parts of this machine",
            "work offset ",
            "part box: ",
            "path tolerance of ",
            "deepest z of ",
            "tool t",
            "judged from this text",
        ];
        self.events.retain(|event| match &event.kind {
            EventKind::Comment { text } if event.before == 0 => {
                let text = text.to_lowercase();
                !OWN.iter().any(|own| text.starts_with(own))
            }
            _ => true,
        });
    }

    /// A tool without a number becomes number 1, called at the start.
    pub fn name_tools(&mut self) {
        let taken = self.tools.iter().any(|tool| tool.number == 1);
        if let Some(tool) = self.tools.iter_mut().find(|tool| tool.number == 0 && !taken) {
            (tool.number, tool.length_offset, tool.name) = (1, 1, "T1".into());
        }
        if !self.events.iter().any(|event| matches!(event.kind, EventKind::ToolChange { .. })) && !self.tools.is_empty()
        {
            self.events.insert(0, Event { before: 0, kind: EventKind::ToolChange { tool: 0 } });
        }
    }

    /// A pair of programs that wait for one another before every operation, the first included (double-sided forming).
    ///
    /// None when they have not equally many operations.
    #[must_use]
    pub fn paired(&self, other: &Self) -> Option<[Self; 2]> {
        let marked = |program: &Self| {
            let starts = std::iter::once(0).chain(program.operation_starts());
            let marks = starts.zip(1..).map(|(before, mark)| (before, EventKind::Sync { mark }));
            program.with_events(marks.collect())
        };
        let alike = self.operation_starts().len() == other.operation_starts().len();
        alike.then(|| [marked(self), marked(other)])
    }

    /// The first moves of the operations after the first one.
    fn operation_starts(&self) -> Vec<usize> {
        let starts = self.moves.windows(2).enumerate().filter(|(_, pair)| pair[0].operation != pair[1].operation);
        starts.map(|(index, _)| index + 1).collect()
    }

    /// The same program with more events, each before the others at its move.
    fn with_events(&self, events: Vec<(usize, EventKind)>) -> Self {
        let mut program = self.clone();
        for (before, kind) in events.into_iter().rev() {
            let index = program.events.iter().position(|event| event.before >= before).unwrap_or(program.events.len());
            program.events.insert(index, Event { before, kind });
        }
        program
    }
}

/// Tool, spindle and coolant after events, and the work offset where one was called.
fn state_of<'e>(events: impl Iterator<Item = &'e Event>) -> (Vec<EventKind>, Option<String>) {
    let (mut tool, mut spindle, mut mist, mut flood, mut wcs) = (None, None, None, None, None);
    for event in events {
        match &event.kind {
            kind @ EventKind::ToolChange { .. } => {
                tool = Some(kind.clone());
                spindle = None;
            }
            kind @ EventKind::SpindleOn { .. } => spindle = Some(kind.clone()),
            EventKind::SpindleOff => spindle = None,
            EventKind::Mist { on } => mist = on.then_some(EventKind::Mist { on: true }),
            EventKind::Flood { on } => flood = on.then_some(EventKind::Flood { on: true }),
            EventKind::WorkOffset { wcs: name } => wcs = Some(name.clone()),
            _ => {}
        }
    }
    ([tool, spindle, mist, flood].into_iter().flatten().collect(), wcs)
}

/// What switches something off that is on.
fn off(kind: &EventKind) -> EventKind {
    match kind {
        EventKind::Mist { .. } => EventKind::Mist { on: false },
        EventKind::Flood { .. } => EventKind::Flood { on: false },
        _ => EventKind::SpindleOff,
    }
}

/// Whether an event decides how something goes on that was on; behind a tool change the spindle stands.
fn decides(event: &EventKind, running: &EventKind) -> bool {
    match running {
        EventKind::Mist { .. } => matches!(event, EventKind::Mist { .. }),
        EventKind::Flood { .. } => matches!(event, EventKind::Flood { .. }),
        _ => matches!(event, EventKind::SpindleOn { .. } | EventKind::SpindleOff | EventKind::ToolChange { .. }),
    }
}

/// Whether an event sets what holds from then on.
fn is_state(kind: &EventKind) -> bool {
    matches!(
        kind,
        EventKind::ToolChange { .. }
            | EventKind::SpindleOn { .. }
            | EventKind::SpindleOff
            | EventKind::Mist { .. }
            | EventKind::Flood { .. }
            | EventKind::WorkOffset { .. }
    )
}

/// A move's feed in a mode that holds for moves of any length.
fn lasting_feed(start: [f64; 3], step: &Move) -> (f64, FeedMode) {
    match step.feed_mode {
        FeedMode::InverseTime => (step.feed * step.length(start), FeedMode::PerMinute),
        FeedMode::PerMinute | FeedMode::PerRevolution => (step.feed, step.feed_mode),
    }
}

fn raised_arc(arc: Arc, by: f64) -> Arc {
    let mut centre = arc.centre;
    // across the plane the centre has no meaning
    if arc.plane != Plane::Xy {
        centre[2] += by;
    }
    Arc { centre, ..arc }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{OperationRecord, SetupRecord, SpindleDirection};

    const ON: EventKind = EventKind::SpindleOn { rpm: 500.0, direction: SpindleDirection::Clockwise };

    /// Two operations of two levels each; the spindle turns in the second one.
    fn program() -> Program {
        let step = |kind, tip, operation| Move::new(kind, tip, 100.0).of_operation(operation);
        let mut moves = Vec::new();
        for operation in 0..2 {
            for z in [-1.0, -2.0] {
                moves.push(step(MoveKind::Rapid, [0.0, 0.0, 5.0], operation));
                moves.push(step(MoveKind::Feed, [0.0, 0.0, z], operation));
                moves.push(step(MoveKind::Feed, [9.0, 0.0, z], operation));
                moves.push(step(MoveKind::Feed, [9.0, 9.0, z], operation));
            }
        }
        let setup = SetupRecord { wcs: "G54".into(), clearance: 10.0, ..SetupRecord::default() };
        let operations =
            ["a", "b"].map(|id| OperationRecord { id: id.into(), kind: "z-level".into(), tool: 0 }).to_vec();
        let events = vec![
            Event { before: 0, kind: EventKind::ToolChange { tool: 0 } },
            Event { before: 8, kind: ON },
            Event { before: 8, kind: EventKind::Flood { on: true } },
            Event { before: 14, kind: EventKind::Dwell { seconds: 1.0 } },
            Event { before: 16, kind: EventKind::SpindleOff },
        ];
        Program { moves, events, ..Program::empty(setup, Vec::new(), operations) }
    }

    #[test]
    fn levels_count_from_one_in_each_operation() {
        let program = program();
        assert_eq!([1, 2, 3].map(|level| program.level_start(0, level)), [Some(2), Some(6), None]);
        assert_eq!(program.level_start(1, 2), Some(14));
    }

    #[test]
    #[allow(clippy::float_cmp)] // the same numbers
    fn a_restart_has_the_state_and_comes_from_above() {
        let whole = program();
        let rest = whole.restarted(14).unwrap();
        let kinds: Vec<_> = rest.events.iter().map(|e| (e.before, e.kind.clone())).collect();
        assert_eq!(
            kinds,
            [
                (0, EventKind::ToolChange { tool: 0 }),
                (0, ON),
                (0, EventKind::Flood { on: true }),
                (2, EventKind::Dwell { seconds: 1.0 }),
                (4, EventKind::SpindleOff),
            ]
        );
        assert_eq!(rest.moves[0].end.tip, [0.0, 0.0, 10.0]);
        assert_eq!((rest.moves[1].kind, rest.moves[1].end.tip), (MoveKind::Feed, [0.0, 0.0, -2.0]));
        assert_eq!(rest.moves[2..], whole.moves[14..]);
        assert_eq!(whole.restarted(0), None);
        assert_eq!(whole.restarted(16), None);
    }

    #[test]
    #[allow(clippy::float_cmp)] // the same numbers
    fn in_the_air_only_z_differs() {
        let whole = program();
        let air = whole.raised(20.0);
        assert!(whole
            .moves
            .iter()
            .zip(&air.moves)
            .all(|(a, b)| a.end.tip[..2] == b.end.tip[..2] && b.end.tip[2] - a.end.tip[2] == 20.0));
    }

    #[test]
    fn pairs_wait_before_every_operation() {
        let [one, other] = program().paired(&program().raised(3.0)).unwrap();
        let marks = |program: &Program| -> Vec<(usize, u32)> {
            let mark = |e: &Event| if let EventKind::Sync { mark } = e.kind { Some((e.before, mark)) } else { None };
            program.events.iter().filter_map(mark).collect()
        };
        assert_eq!(marks(&one), [(0, 1), (8, 2)]);
        assert_eq!(marks(&one), marks(&other));
        let shorter = Program { moves: program().moves[..4].to_vec(), ..program() };
        assert_eq!(program().paired(&shorter), None);
    }

    #[test]
    fn stops_stand_before_later_operations() {
        let stopped = program().with_optional_stops();
        let stop = stopped.events.iter().position(|e| e.kind == EventKind::Stop { optional: true }).unwrap();
        assert_eq!((stop, stopped.events[stop].before), (1, 8));
        assert_eq!(stopped.events.len(), program().events.len() + 1);
    }
}

//! Words of a letter and a number: G-code, and Sinumerik's dialect of it.

use styluscam_motion::{CycleKind, Plane};

use super::dialect::{Dialect, Feed, Hole, Position};
use super::lines::Lines;
use super::mcall;
use crate::machine::{ArcCentre, DwellRules, Family, FeedMode, LengthRules, Machine, Repeat, TimeUnit, Turns};
use crate::number::{NumberFormat, DWELL_PLACES};
use crate::post_error::PostError;
use crate::rounded::RoundedArc;

const RAPID: &str = "G0";
const LINE: &str = "G1";
const CLOCKWISE: &str = "G2";
const COUNTERCLOCKWISE: &str = "G3";
const CANCEL: &str = "G80";
const AXES: [&str; 3] = ["X", "Y", "Z"];
/// The letters of a centre's offsets from its arc's start.
const OFFSETS: [&str; 3] = ["I", "J", "K"];
const Z: usize = 2;

/// What was written last and holds until something else is written.
#[derive(Default)]
struct Stated {
    motion: Option<&'static str>,
    plane: Option<Plane>,
    feed: Option<Feed>,
    hole: Option<Hole>,
}

pub(super) struct Words<'m> {
    machine: &'m Machine,
    linear: NumberFormat,
    feed_format: NumberFormat,
    /// The feed of rapids, where they need one.
    rapid_feed: Option<Feed>,
    stated: Stated,
    /// A length offset to be named in the next block that moves Z.
    length: Option<(&'m LengthRules, u32)>,
    angle_format: NumberFormat,
    /// Angles to be stated in the next block.
    angles: [Option<i64>; 2],
}

impl<'m> Words<'m> {
    pub fn new(machine: &'m Machine) -> Self {
        let feed_format = machine.feed_format();
        let rate = machine.limits.rapid_rate / machine.units.output.in_mm() * machine.feed_scale();
        Self {
            machine,
            linear: machine.linear_format(),
            feed_format,
            rapid_feed: feed_format.count(rate).filter(|_| machine.motion.rapid_feed),
            stated: Stated::default(),
            length: None,
            angle_format: machine.angle_format(),
            angles: [None; 2],
        }
    }

    fn begin_motion(&mut self, lines: &mut Lines, word: &'static str) {
        lines.begin();
        if self.stated.motion != Some(word) || self.machine.words.repeat_g == Repeat::Always {
            lines.word(word);
            self.stated.motion = Some(word);
        }
    }

    /// Axis words of what changes, or of every axis.
    fn axes(&mut self, lines: &mut Lines, from: Position, to: Position) {
        let every = self.machine.words.repeat_axes == Repeat::Always;
        for (axis, (from, to)) in from.into_iter().zip(to).enumerate() {
            let Some(count) = to else { continue };
            if every || from != to {
                self.length_before(lines, axis);
                lines.number(AXES[axis], &self.linear, count);
                self.length_number(lines, axis);
            }
        }
    }

    /// Words of the rotary axes that turn.
    fn angles(&mut self, lines: &mut Lines) {
        let Some(rules) = &self.machine.rotary else { return };
        for (axis, count) in rules.axes.iter().zip(std::mem::take(&mut self.angles)) {
            if let Some(count) = count {
                lines.number(axis.letter.encode_utf8(&mut [0; 4]), &self.angle_format, count);
            }
        }
    }

    /// `G43` before the Z that it corrects,
    fn length_before(&self, lines: &mut Lines, axis: usize) {
        if let Some((rules, _)) = self.length.filter(|_| axis == Z) {
            lines.word(&rules.code);
        }
    }

    /// and its `H1` behind.
    fn length_number(&mut self, lines: &mut Lines, axis: usize) {
        if axis != Z {
            return;
        }
        if let Some((rules, number)) = self.length.take() {
            lines.number(rules.word.encode_utf8(&mut [0; 4]), &NumberFormat::plain(0), i64::from(number));
        }
    }

    /// F, where it changes; with inverse time in every block.
    fn changed_feed(&mut self, lines: &mut Lines, feed: Feed) {
        if self.stated.feed == Some(feed) && self.machine.feed.mode != FeedMode::InverseTime {
            return;
        }
        lines.number("F", &self.feed_format, feed);
        self.stated.feed = Some(feed);
    }

    fn plane(&mut self, lines: &mut Lines, plane: Plane) -> Result<(), PostError> {
        let only = self.machine.arc.as_ref().is_some_and(|rules| rules.planes.len() < 2);
        if only || self.stated.plane == Some(plane) {
            return Ok(());
        }
        self.stated.plane = Some(plane);
        lines.block(match plane {
            Plane::Xy => "G17",
            Plane::Zx => "G18",
            Plane::Yz => "G19",
        })
    }

    fn turns(&self, lines: &mut Lines, turns: u32) {
        let rules = self.machine.arc.as_ref().map_or(Turns::None, |rules| rules.turns);
        match rules {
            _ if turns == 0 => {}
            Turns::Arrivals => lines.number("P", &NumberFormat::plain(0), i64::from(turns) + 1),
            Turns::Extra => lines.number("TURN=", &NumberFormat::plain(0), i64::from(turns)),
            Turns::None => {}
        }
    }

    /// P of a cycle that waits, and of one that must state that it does not.
    fn hole_dwell(&self, lines: &mut Lines, hole: &Hole) {
        let Some(rules) = &self.machine.cycle else { return };
        let must = hole.kind == CycleKind::StopBore && rules.stop_bore_dwell;
        let time = self.time(rules.dwell_unit, hole.dwell).filter(|(_, time)| must || *time > 0);
        if let Some((format, time)) = time {
            lines.number("P", &format, time);
        }
    }

    /// Whether cycles are called at positions, not stated with them.
    fn calls_cycles(&self) -> bool {
        self.machine.family == Family::Siemens
    }

    /// The feed and the call in blocks of their own, then the position by a rapid.
    fn called_hole(&mut self, lines: &mut Lines, hole: &Hole, goes_on: bool) -> Result<(), PostError> {
        if !goes_on {
            if hole.thread.is_none() && self.stated.feed != Some(hole.feed) {
                lines.begin();
                self.changed_feed(lines, hole.feed);
                lines.end()?;
            }
            self.stated.motion = None;
            lines.block(&mcall::call(hole, &self.linear, &NumberFormat::plain(self.machine.number.rpm)))?;
        }
        self.begin_motion(lines, RAPID);
        lines.number("X", &self.linear, hole.at[0]);
        lines.number("Y", &self.linear, hole.at[1]);
        self.stated.hole = Some(*hole);
        lines.end()
    }

    fn time(&self, unit: TimeUnit, seconds: f64) -> Option<(NumberFormat, i64)> {
        let (format, per_second) = match unit {
            TimeUnit::S => (NumberFormat::new(&self.machine.number, DWELL_PLACES).unsigned(), 1.0),
            TimeUnit::Ms => (NumberFormat::plain(0), 1000.0),
        };
        Some((format, format.count(seconds * per_second)?))
    }
}

impl Dialect for Words<'_> {
    fn forget(&mut self) {
        self.stated = Stated::default();
    }

    fn tool_changed(&mut self, length_offset: u32) {
        let rules = self.machine.tool.length.as_ref();
        self.length = rules.filter(|rules| rules.with_z).map(|rules| (rules, length_offset));
    }

    fn close(&mut self, lines: &mut Lines) -> Result<(), PostError> {
        if self.stated.hole.take().is_none() {
            return Ok(());
        }
        self.stated = Stated { plane: self.stated.plane, ..Stated::default() };
        lines.block(if self.calls_cycles() { mcall::END } else { CANCEL })
    }

    fn turn(&mut self, angles: [Option<i64>; 2]) {
        self.angles = angles;
    }

    fn rapid(&mut self, lines: &mut Lines, from: Position, to: Position) -> Result<(), PostError> {
        self.begin_motion(lines, RAPID);
        self.axes(lines, from, to);
        self.angles(lines);
        if let Some(feed) = self.rapid_feed {
            self.changed_feed(lines, feed);
        }
        lines.end()
    }

    fn feed(&mut self, lines: &mut Lines, from: Position, to: Position, feed: Feed) -> Result<(), PostError> {
        self.begin_motion(lines, LINE);
        self.axes(lines, from, to);
        self.angles(lines);
        self.changed_feed(lines, feed);
        lines.end()
    }

    fn arc(&mut self, lines: &mut Lines, arc: &RoundedArc, feed: Feed) -> Result<(), PostError> {
        let [first, second, third] = arc.arc.plane.axes();
        self.plane(lines, arc.arc.plane)?;
        self.begin_motion(lines, if arc.arc.clockwise { CLOCKWISE } else { COUNTERCLOCKWISE });
        for (axis, (from, to)) in arc.from.into_iter().zip(arc.to).enumerate() {
            if axis != third || from != to {
                lines.number(AXES[axis], &self.linear, to);
            }
        }
        let absolute = self.machine.arc.as_ref().is_some_and(|rules| rules.centre == ArcCentre::Absolute);
        let centre = if absolute { arc.centre() } else { arc.offset };
        for axis in [first, second] {
            lines.number(OFFSETS[axis], &self.linear, centre[axis]);
        }
        self.turns(lines, arc.arc.turns);
        self.changed_feed(lines, feed);
        lines.end()
    }

    fn hole(&mut self, lines: &mut Lines, hole: &Hole) -> Result<(), PostError> {
        let goes_on = self.stated.hole.is_some_and(|last| last.is_like(hole));
        if !goes_on {
            self.close(lines)?;
            self.plane(lines, Plane::Xy)?;
        }
        if self.calls_cycles() {
            return self.called_hole(lines, hole, goes_on);
        }
        lines.begin();
        let every = !goes_on || self.machine.words.repeat_g == Repeat::Always;
        if every {
            lines.word(if hole.lifts() { "G98" } else { "G99" });
            lines.word(code(hole));
        }
        lines.number("X", &self.linear, hole.at[0]);
        lines.number("Y", &self.linear, hole.at[1]);
        if every {
            lines.number("Z", &self.linear, hole.bottom);
            lines.number("R", &self.linear, hole.retract);
            if hole.peck > 0 {
                lines.number("Q", &self.linear, hole.peck);
            }
            self.hole_dwell(lines, hole);
            lines.number("F", &self.feed_format, hole.feed);
        }
        self.stated = Stated { hole: Some(*hole), plane: self.stated.plane, ..Stated::default() };
        lines.end()
    }

    fn spindle(&mut self, lines: &mut Lines, speed: i64, word: &str) -> Result<(), PostError> {
        lines.begin();
        let format = NumberFormat::plain(self.machine.number.rpm);
        let mut letter = [0; 4];
        let letter: &str = self.machine.spindle.word.encode_utf8(&mut letter);
        if self.machine.words.one_command {
            lines.word(word);
            lines.number(letter, &format, speed);
        } else {
            lines.number(letter, &format, speed);
            lines.word(word);
        }
        lines.end()
    }

    fn dwell(&mut self, lines: &mut Lines, seconds: f64) -> Result<bool, PostError> {
        let Some(DwellRules { word, unit, before }) = &self.machine.dwell else { return Ok(false) };
        let Some((format, time)) = self.time(*unit, seconds) else { return Ok(false) };
        // Sinumerik's G4 F is always in seconds
        let per_revolution = self.machine.feed.mode == FeedMode::PerRevolution && !self.calls_cycles();
        let before = before.as_deref().or(self.machine.feed.per_minute.as_deref()).filter(|_| per_revolution);
        lines.begin();
        before.iter().for_each(|word| lines.word(word));
        lines.word("G4");
        if *word == 'F' {
            self.stated.feed = None;
        }
        lines.number(word.encode_utf8(&mut [0; 4]), &format, time);
        lines.end()?;
        if before.is_some() {
            self.stated.feed = None;
            lines.block(self.machine.feed.word().unwrap_or_default())?;
        }
        Ok(true)
    }

    fn probe(&mut self, lines: &mut Lines, word: &str, to: Position, feed: Feed) -> Result<(), PostError> {
        self.forget();
        lines.begin();
        lines.word(word);
        self.axes(lines, [None; 3], to);
        lines.number("F", &self.feed_format, feed);
        lines.end()
    }
}

/// The code of a hole's cycle.
fn code(hole: &Hole) -> &'static str {
    match hole.kind {
        CycleKind::Drill if hole.dwell > 0.0 => "G82",
        CycleKind::Drill => "G81",
        CycleKind::Peck => "G83",
        CycleKind::ChipBreak => "G73",
        CycleKind::Tap => "G84",
        CycleKind::LeftTap => "G74",
        CycleKind::Bore if hole.dwell > 0.0 => "G89",
        CycleKind::Bore => "G85",
        CycleKind::StopBore => "G86",
    }
}

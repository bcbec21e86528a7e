//! Heidenhain's conversational blocks (TNC 320 to 640, Klartext programming).

use styluscam_motion::Plane;

use super::cycl_def;
use super::dialect::{Dialect, Feed, Hole, Position};
use super::lines::Lines;
use crate::machine::Machine;
use crate::number::{NumberFormat, DWELL_PLACES};
use crate::post_error::PostError;
use crate::rounded::RoundedArc;

const AXES: [&str; 3] = ["X", "Y", "Z"];

pub(super) struct Klartext<'m> {
    machine: &'m Machine,
    linear: NumberFormat,
    feed_format: NumberFormat,
    feed: Option<Feed>,
    speed: Option<i64>,
    /// The word with which the spindle turns.
    turning: Option<String>,
    hole: Option<Hole>,
}

impl<'m> Klartext<'m> {
    pub fn new(machine: &'m Machine) -> Self {
        Self {
            machine,
            linear: machine.linear_format(),
            feed_format: machine.feed_format(),
            feed: None,
            speed: None,
            turning: None,
            hole: None,
        }
    }

    fn line(&self, lines: &mut Lines, from: Position, to: Position) {
        lines.begin();
        lines.word("L");
        for (axis, (from, to)) in from.into_iter().zip(to).enumerate() {
            if let Some(count) = to.filter(|to| from != Some(*to)) {
                lines.number(AXES[axis], &self.linear, count);
            }
        }
    }

    fn changed_feed(&mut self, lines: &mut Lines, feed: Feed) {
        if self.feed != Some(feed) {
            lines.number("F", &self.feed_format, feed);
            self.feed = Some(feed);
        }
    }
}

impl Dialect for Klartext<'_> {
    fn forget(&mut self) {
        self.feed = None;
    }

    /// TOOL CALL has its length, and may have a speed of its own.
    fn tool_changed(&mut self, _length_offset: u32) {
        self.speed = None;
    }

    /// A cycle stays defined and does nothing by itself. After a tap the spindle may stand.
    fn close(&mut self, lines: &mut Lines) -> Result<(), PostError> {
        match self.hole.take().and_then(|hole| hole.thread).and(self.turning.as_deref()) {
            Some(word) => lines.block(word),
            None => Ok(()),
        }
    }

    fn rapid(&mut self, lines: &mut Lines, from: Position, to: Position) -> Result<(), PostError> {
        self.line(lines, from, to);
        lines.word("R0");
        lines.word("FMAX");
        lines.end()
    }

    fn feed(&mut self, lines: &mut Lines, from: Position, to: Position, feed: Feed) -> Result<(), PostError> {
        self.line(lines, from, to);
        lines.word("R0");
        self.changed_feed(lines, feed);
        lines.end()
    }

    /// The centre in a block of its own, then the path to the end. Arcs lie in the plane across the tool's axis.
    fn arc(&mut self, lines: &mut Lines, arc: &RoundedArc, feed: Feed) -> Result<(), PostError> {
        debug_assert_eq!(arc.arc.plane, Plane::Xy);
        let centre = arc.centre();
        lines.begin();
        lines.word("CC");
        (0..2).for_each(|axis| lines.number(AXES[axis], &self.linear, centre[axis]));
        lines.end()?;
        lines.begin();
        lines.word("C");
        (0..2).for_each(|axis| lines.number(AXES[axis], &self.linear, arc.to[axis]));
        lines.word(if arc.arc.clockwise { "DR-" } else { "DR+" });
        self.changed_feed(lines, feed);
        lines.end()
    }

    fn hole(&mut self, lines: &mut Lines, hole: &Hole) -> Result<(), PostError> {
        if !self.hole.is_some_and(|last| last.is_like(hole)) {
            self.close(lines)?;
            let per_mm = self.machine.resolution_mm().recip();
            lines.text(&cycl_def::definition(hole, &self.linear, &self.feed_format, per_mm))?;
        }
        lines.begin();
        lines.word("L");
        (0..2).for_each(|axis| lines.number(AXES[axis], &self.linear, hole.at[axis]));
        ["R0", "FMAX", "M99"].iter().for_each(|word| lines.word(word));
        self.hole = Some(*hole);
        self.feed = None;
        lines.end()
    }

    /// The speed is part of a tool call; the word follows in a block of its own.
    fn spindle(&mut self, lines: &mut Lines, speed: i64, word: &str) -> Result<(), PostError> {
        if self.speed != Some(speed) {
            lines.begin();
            lines.word("TOOL CALL Z");
            lines.number("S", &NumberFormat::plain(self.machine.number.rpm), speed);
            lines.end()?;
            self.speed = Some(speed);
        }
        self.turning = Some(word.into());
        lines.block(word)
    }

    fn dwell(&mut self, lines: &mut Lines, seconds: f64) -> Result<bool, PostError> {
        let format = NumberFormat::plain(DWELL_PLACES);
        let Some(time) = format.count(seconds) else { return Ok(false) };
        lines.block("CYCL DEF 9.0 DWELL TIME")?;
        lines.begin();
        lines.word("CYCL DEF 9.1");
        lines.number("DWELL ", &format, time);
        lines.end()?;
        Ok(true)
    }

    fn probe(&mut self, _lines: &mut Lines, _word: &str, _to: Position, _feed: Feed) -> Result<(), PostError> {
        Err(PostError::Unsupported { what: "probing" })
    }
}

//! What happens between moves: tools, spindle, coolant, waits, stops, work offsets, probing.

use styluscam_motion::{EventKind, SpindleDirection};

use super::Poster;
use crate::machine::{CoolantRules, FeedMode, SpeedUnit, ToolChange};
use crate::number::NumberFormat;
use crate::post_error::PostError;

impl Poster<'_> {
    /// What happens before the next move.
    ///
    /// # Errors
    /// [`PostError`]: something that the machine does not have.
    pub fn event(&mut self, event: &EventKind) -> Result<(), PostError> {
        let number = self.events;
        self.events += 1;
        self.inspector.event(number, event)?;
        self.dialect.close(&mut self.lines)?;
        match event {
            EventKind::ToolChange { tool } => self.change_tool(number, *tool),
            EventKind::SpindleOn { rpm, direction } => self.start_spindle(number, *rpm, *direction),
            EventKind::SpindleOff => self.stop_spindle(),
            EventKind::Mist { on } => {
                self.mist = *on;
                self.switch_coolant(*on, |words| words.mist.as_deref())
            }
            EventKind::Flood { on } => {
                self.flood = *on;
                self.switch_coolant(*on, |words| words.flood.as_deref())
            }
            EventKind::Comment { text } => self.lines.comment(text),
            EventKind::Dwell { seconds } => self.dwell(number, *seconds),
            EventKind::Stop { optional } => self.stop(*optional),
            EventKind::WorkOffset { wcs } => self.change_wcs(wcs),
            EventKind::Probe { end, feed, must_touch } => self.probe(number, *end, *feed, *must_touch),
            EventKind::Raw { text } => self.raw(text),
            EventKind::Sync { mark } => self.sync(*mark),
        }
    }

    fn change_tool(&mut self, event: usize, tool: u32) -> Result<(), PostError> {
        let first = self.tool.is_none();
        if !first && matches!(self.machine.tool.change, ToolChange::LoadBeforeStart | ToolChange::Unsaid) {
            return Err(PostError::ToolChange { event });
        }
        if self.spindle.is_some() {
            self.stop_spindle()?;
        }
        self.stop_tracking()?;
        let record = self.head.tools.get(tool as usize);
        let record =
            record.ok_or(PostError::NoSuchRecord { place: format!("events[{event}]"), what: "tool", index: tool })?;
        let next = self.next_tool();
        let text = self.templater.tool_change(&self.names, record, first, next)?;
        self.lines.mark();
        self.speak(&text)?;
        self.tool = Some(record);
        if !self.rotary.as_ref().is_some_and(|rotary| rotary.names_length(self.machine)) {
            self.dialect.tool_changed(record.length_offset);
        }
        self.position = [None; 3];
        self.dialect.forget();
        Ok(())
    }

    /// The number of the tool after this one, where the head of the program states it.
    fn next_tool(&mut self) -> Option<u32> {
        self.calls.pop_front();
        let next = self.calls.front()?;
        self.head.tools.get(*next as usize).map(|tool| tool.number)
    }

    fn start_spindle(&mut self, event: usize, rpm: f64, direction: SpindleDirection) -> Result<(), PostError> {
        let words = &self.machine.spindle;
        let word = match direction {
            SpindleDirection::Clockwise => words.clockwise.as_deref(),
            SpindleDirection::Counterclockwise => words.counterclockwise.as_deref(),
        };
        let word = word.ok_or(PostError::SpindleDirection { direction })?;
        let speed = self.speed_count(rpm)?;
        self.dialect.spindle(&mut self.lines, speed, word)?;
        self.spindle = Some((rpm, direction));
        if words.start_dwell > 0.0 && rpm > 0.0 {
            return self.dwell(event, words.start_dwell);
        }
        Ok(())
    }

    /// A speed as the machine counts it, in units of the last decimal.
    pub(super) fn speed_count(&self, rpm: f64) -> Result<i64, PostError> {
        let speed = match (self.machine.spindle.unit, self.machine.limits.max_rpm) {
            (SpeedUnit::Percent, Some(most)) => 100.0 * rpm / most,
            _ => rpm,
        };
        let too_large = PostError::SpindleSpeed { rpm, min: 0.0, max: f64::INFINITY };
        NumberFormat::plain(self.machine.number.rpm).count(speed).ok_or(too_large)
    }

    fn stop_spindle(&mut self) -> Result<(), PostError> {
        self.spindle = None;
        let words = &self.machine.spindle;
        if words.clockwise.is_none() && words.counterclockwise.is_none() {
            return Ok(()); // what cannot turn stands
        }
        self.block_of(self.machine.spindle.off.as_deref(), "the spindle's stop")
    }

    /// One word switches all coolant off: what is to stay on is written again.
    fn switch_coolant(&mut self, on: bool, word: fn(&CoolantRules) -> Option<&str>) -> Result<(), PostError> {
        let words = &self.machine.coolant;
        if !on && words.mist.is_none() && words.flood.is_none() {
            return Ok(()); // there is nothing to switch off
        }
        self.block_of(if on { word(words) } else { words.off.as_deref() }, "coolant")?;
        let left = [(self.mist, &words.mist), (self.flood, &words.flood)];
        let left = left.into_iter().filter(|(stays, _)| *stays && !on);
        left.map(|(_, word)| word.as_deref()).try_for_each(|word| self.lines.block(word.unwrap_or_default()))
    }

    /// Not every program's end stops what still runs.
    pub(super) fn switch_off(&mut self) -> Result<(), PostError> {
        if std::mem::take(&mut self.mist) | std::mem::take(&mut self.flood) {
            self.switch_coolant(false, |_| None)?;
        }
        if self.spindle.is_some() {
            self.stop_spindle()?;
        }
        Ok(())
    }

    fn block_of(&mut self, word: Option<&str>, what: &'static str) -> Result<(), PostError> {
        let word = word.ok_or(PostError::Unsupported { what })?;
        self.lines.block(word)
    }

    fn dwell(&mut self, event: usize, seconds: f64) -> Result<(), PostError> {
        if self.machine.dwell.is_none() {
            return Err(PostError::Unsupported { what: "a dwell" });
        }
        if self.dialect.dwell(&mut self.lines, seconds)? {
            return Ok(());
        }
        Err(PostError::Number { what: "the dwell", place: format!("events[{event}]"), value: seconds })
    }

    fn stop(&mut self, optional: bool) -> Result<(), PostError> {
        if self.machine.templates.stop.is_some() {
            let text = self.templater.stop(&self.names, optional)?;
            return self.speak(&text);
        }
        let words = &self.machine.stop;
        let (word, what) =
            if optional { (&words.optional, "an optional stop") } else { (&words.always, "a program stop") };
        self.block_of(word.as_deref(), what)?;
        if words.stops_spindle {
            self.go_on()?;
        }
        Ok(())
    }

    /// Spindle and coolant again, which the stop has switched off.
    fn go_on(&mut self) -> Result<(), PostError> {
        if let Some((rpm, direction)) = self.spindle {
            self.start_spindle(self.events, rpm, direction)?;
        }
        let words = &self.machine.coolant;
        let running = [(self.mist, &words.mist), (self.flood, &words.flood)];
        let again = running.into_iter().filter(|(on, _)| *on).filter_map(|(_, word)| word.as_deref());
        again.into_iter().try_for_each(|word| self.lines.block(word))
    }

    /// Where the tool stands in the new work offset is not known.
    fn change_wcs(&mut self, wcs: &str) -> Result<(), PostError> {
        self.only_upright("another work offset in a program whose tool leans")?;
        if !self.machine.wcs.iter().any(|known| known == wcs) {
            return Err(PostError::Wcs { wcs: wcs.into(), allowed: self.machine.wcs.join(", ") });
        }
        let text = self.templater.work_offset(&self.names, wcs)?;
        self.position = [None; 3];
        self.speak(&text)
    }

    fn probe(&mut self, event: usize, end: [Option<f64>; 3], feed: f64, must_touch: bool) -> Result<(), PostError> {
        self.only_upright("probing in a program whose tool leans")?;
        let rules = self.machine.probe.as_ref().ok_or(PostError::Unsupported { what: "probing" })?;
        let word = if must_touch { Some(&rules.must_touch) } else { rules.may_touch.as_ref() };
        let word = word.ok_or(PostError::Unsupported { what: "probing that may miss" })?;
        let height = self.tool.ok_or(PostError::NoTool { index: self.moves })?.reference_height;
        let mut to = [None; 3];
        for (axis, position) in end.into_iter().enumerate() {
            let Some(position) = position else { continue };
            let position = position + if axis == 2 { height } else { 0.0 };
            let count = self.linear.count(position * self.per_mm);
            let at = || PostError::Number { what: "a position", place: format!("events[{event}]"), value: position };
            to[axis] = Some(count.ok_or_else(at)?);
        }
        if self.machine.feed.mode == FeedMode::InverseTime {
            return Err(PostError::Unsupported { what: "probing with feeds in inverse time" });
        }
        let count = self.feed_count(self.moves, feed, f64::INFINITY)?;
        self.dialect.probe(&mut self.lines, word, to, count)?;
        self.dialect.forget();
        for (axis, position) in to.into_iter().enumerate() {
            if position.is_some() {
                self.position[axis] = None;
            }
        }
        Ok(())
    }

    /// A line of the job's own: it must not move an axis, and it may change modes.
    fn raw(&mut self, text: &str) -> Result<(), PostError> {
        self.speak(text)
    }

    fn sync(&mut self, mark: u32) -> Result<(), PostError> {
        if self.machine.templates.sync.is_none() {
            return Err(PostError::Unsupported { what: "waiting for another program" });
        }
        let text = self.templater.sync(&self.names, mark)?;
        self.speak(&text)
    }
}

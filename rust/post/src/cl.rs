//! Cutter location text: APT's words for a program, before any controller (ISO 3592, ISO 4343).

use styluscam_motion::{EventKind, FeedMode, Move, MoveKind, Program, SpindleDirection, UnitAxis};

use crate::number::{write_integer, NumberFormat};
use crate::post_error::PostError;

/// Decimal places of positions and feeds, mm and mm/min; of directions.
const PLACES: u8 = 4;
const VECTOR_PLACES: u8 = 7;
/// How far the points of an arc's polyline may leave it, mm.
const SAG: f64 = 0.001;

/// The cutter location data of a program, in mm: positions are those of the tip. Arcs become points, none farther than 0.001 mm
/// from its arc. Where any tool axis is not +Z, every position has its
/// axis behind it.
///
/// # Errors
/// [`PostError::Number`] for a position or feed that is no number; [`PostError::FeedMode`] for a feed that is not in mm/min;
/// [`PostError::Empty`] without moves.
pub fn cl_text(program: &Program) -> Result<String, PostError> {
    if program.moves.is_empty() {
        return Err(PostError::Empty);
    }
    let tilted = program.moves.iter().any(|step| !step.end.axis.is_up());
    let mut out = Text { out: String::new(), feed: None };
    out.line(&format!("PARTNO {}", program.setup.title));
    out.line("UNITS/MM");
    program.setup.notes.iter().for_each(|note| out.line(&format!("PPRINT {note}")));
    let mut events = program.upcoming();
    for (index, (start, step)) in program.segments().enumerate() {
        events.before(index).try_for_each(|event| out.event(program, event))?;
        match step.kind {
            MoveKind::Rapid => out.line("RAPID"),
            MoveKind::Feed => out.feed(index, step)?,
        }
        let path = start.and_then(|start| step.path(start));
        let count = path.map_or(1, |path| path.chords(SAG));
        for chord in 1..=count {
            let position = match path {
                Some(path) if chord < count => path.at(chord as f64 / count as f64),
                _ => step.end.tip,
            };
            out.goto(index, position, tilted.then_some(step.end.axis))?;
        }
    }
    events.before(program.moves.len()).try_for_each(|event| out.event(program, event))?;
    out.line("FINI");
    Ok(out.out)
}

struct Text {
    out: String,
    feed: Option<f64>,
}

impl Text {
    /// One line: what is no printable ASCII becomes `_`.
    fn line(&mut self, text: &str) {
        self.out.extend(text.chars().map(|c| if (' '..='~').contains(&c) { c } else { '_' }));
        self.out.push('\n');
    }

    fn number(&mut self, index: usize, places: u8, value: f64) -> Result<(), PostError> {
        let format = NumberFormat::plain(places);
        let place = || format!("moves[{index}]");
        let count = format.count(value).ok_or_else(|| PostError::Number { what: "a number", place: place(), value })?;
        format.write(&mut self.out, count);
        Ok(())
    }

    fn goto(&mut self, index: usize, position: [f64; 3], axis: Option<UnitAxis>) -> Result<(), PostError> {
        self.out.push_str("GOTO/");
        let vector = axis.into_iter().flat_map(UnitAxis::vector).map(|v| (VECTOR_PLACES, v));
        for (number, (places, value)) in position.into_iter().map(|v| (PLACES, v)).chain(vector).enumerate() {
            if number > 0 {
                self.out.push(',');
            }
            self.number(index, places, value)?;
        }
        self.out.push('\n');
        Ok(())
    }

    #[allow(clippy::float_cmp)] // the same number, not a near one
    fn feed(&mut self, index: usize, step: &Move) -> Result<(), PostError> {
        if step.feed_mode != FeedMode::PerMinute {
            return Err(PostError::FeedMode { index });
        }
        let feed = step.feed;
        if self.feed == Some(feed) {
            return Ok(());
        }
        self.feed = Some(feed);
        self.out.push_str("FEDRAT/");
        self.number(index, PLACES, feed)?;
        self.line(",MMPM");
        Ok(())
    }

    fn event(&mut self, program: &Program, event: &EventKind) -> Result<(), PostError> {
        match event {
            EventKind::ToolChange { tool } => {
                let number = program.tools.get(*tool as usize).map_or(0, |tool| tool.number);
                self.out.push_str("LOADTL/");
                write_integer(&mut self.out, u64::from(number));
                self.out.push('\n');
            }
            EventKind::SpindleOn { rpm, direction } => {
                self.out.push_str("SPINDL/");
                self.number(0, PLACES, *rpm)?;
                self.line(if *direction == SpindleDirection::Clockwise { ",RPM,CLW" } else { ",RPM,CCLW" });
            }
            EventKind::SpindleOff => self.line("SPINDL/OFF"),
            EventKind::Mist { on } => self.line(if *on { "COOLNT/MIST" } else { "COOLNT/OFF" }),
            EventKind::Flood { on } => self.line(if *on { "COOLNT/FLOOD" } else { "COOLNT/OFF" }),
            EventKind::Dwell { seconds } => {
                self.out.push_str("DELAY/");
                self.number(0, PLACES, *seconds)?;
                self.out.push('\n');
            }
            EventKind::Stop { optional } => self.line(if *optional { "OPSTOP" } else { "STOP" }),
            EventKind::Comment { text } => self.line(&format!("PPRINT {text}")),
            EventKind::Raw { text } => self.line(&format!("INSERT {text}")),
            EventKind::WorkOffset { .. } => return Err(PostError::Unsupported { what: "another work offset" }),
            EventKind::Probe { .. } => return Err(PostError::Unsupported { what: "probing" }),
            EventKind::Sync { .. } => return Err(PostError::Unsupported { what: "waiting for another program" }),
        }
        Ok(())
    }
}

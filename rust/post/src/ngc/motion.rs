//! Codes that move: lines, arcs, probing, and the choice of the cycles and curves.

use styluscam_motion::MoveKind;

use super::block::Block;
use super::codes;
use super::fault::TraceFault;
use super::modes::NO_MOTION;
use super::note::{Gap, FEED_UNKNOWN};
use super::path::Pace;
use super::tracer::{Next, Tracer};
use crate::block::arc::{centre_by_offsets, ArcFault, Ends, Least, Slack, MOST_TURNS};
use crate::block::{Code, CycleWords, Feed};
use crate::machine::FeedMode;

/// Ends of an arc may differ so much in their distance from its centre unmentioned.
const SLACK: Slack = Slack { absolute: 0.005, relative: 1e-3 };
/// Any arc is shown that has a radius.
const LEAST: Least = Least { radius: 0.0, angle: 0.0 };

/// mm/min: a feed beyond them is none.
const SLOWEST: f64 = 1e-3;
const FASTEST: f64 = 1e7;

/// The parameters that hold where a probe tripped, and whether it did.
const PROBED: usize = 5061;
const PROBE_TRIPPED: usize = 5070;

impl Tracer<'_> {
    /// Moves by a code, given or in force.
    pub(super) fn motion(&mut self, block: &Block, code: u32) -> Result<Next, TraceFault> {
        self.modes.motion = code;
        if !is_cycle(code) {
            self.cycle = CycleWords::default();
        }
        if code != 50 {
            self.tangent = None;
        }
        match code {
            NO_MOTION => return Err(TraceFault::NoMotionMode),
            _ if !codes::moves(code) => self.note(Gap::Code { code: codes::name_g(code) }),
            0 | 10 if !names_position(block) => {}
            0 => {
                let end = self.target(block, block.has(Code::MachineCoordinates))?;
                self.rapid(end)?;
            }
            10 => self.straight(block)?,
            20 | 30 if !names_position(block) && !names_centre(block) => {}
            20 | 30 => self.arc(block, code == 20)?,
            50 | 51 => self.curve(block, code)?,
            52 | 53 => self.control_point(block)?,
            330 => self.thread(block)?,
            331 => self.tap(block)?,
            382..=385 => self.probe(block, code)?,
            700..=722 if block.word(b'q').is_none() => self.note(Gap::Code { code: codes::name_g(code) }),
            700..=722 => return self.contour(block),
            760 => self.thread_cycle(block)?,
            _ => self.drill(block, code)?,
        }
        Ok(Next::Line)
    }

    fn straight(&mut self, block: &Block) -> Result<(), TraceFault> {
        self.begin()?;
        let end = self.target(block, block.has(Code::MachineCoordinates))?;
        self.feed_to(end)
    }

    /// Makes sure that the path stands where the tip does, and notes which axes never had a position.
    pub(super) fn begin(&mut self) -> Result<(), TraceFault> {
        for (index, axis) in ['X', 'Y', 'Z'].into_iter().enumerate() {
            if !std::mem::replace(&mut self.positioned[index], true) {
                self.note(Gap::Start { axis });
            }
        }
        if self.path.stands_at(&self.offsets, self.position) {
            return Ok(());
        }
        self.rapid(self.position)
    }

    pub(super) fn feed_to(&mut self, end: [f64; 3]) -> Result<(), TraceFault> {
        let pace = self.pace(self.distance_to(end));
        self.path.line(&self.offsets, end, pace)?;
        self.position = end;
        Ok(())
    }

    /// A feed move's pace, for a length in mm.
    pub(super) fn pace(&mut self, length: f64) -> Pace {
        let feed = match self.modes.common.feed {
            // a move of no length takes its time, which no feed can state
            Feed { mode: FeedMode::InverseTime, .. } if length <= 0.0 => FEED_UNKNOWN,
            feed => feed.per_minute(length, Some(self.modes.revolutions())).unwrap_or_default(),
        };
        self.pace_of(feed)
    }

    pub(super) fn pace_of(&mut self, feed: f64) -> Pace {
        let known = (SLOWEST..=FASTEST).contains(&feed);
        if !known {
            self.note(Gap::Feed);
        }
        Pace { kind: MoveKind::Feed, feed: if known { feed } else { FEED_UNKNOWN }, line: self.line_of_program() }
    }

    /// G38: without a contact G38.2 and G38.4 are an error, and G38.3 and G38.5 come to their end point.
    fn probe(&mut self, block: &Block, code: u32) -> Result<(), TraceFault> {
        self.note(Gap::Probe);
        self.straight(block)?;
        let unit = self.modes.unit();
        self.parameters.set_run(PROBED, self.position.map(|length| length / unit));
        self.parameters.set_number(PROBE_TRIPPED, if matches!(code, 382 | 384) { 1.0 } else { 0.0 });
        Ok(())
    }

    // Arcs

    fn arc(&mut self, block: &Block, clockwise: bool) -> Result<(), TraceFault> {
        self.begin()?;
        let (start, end) = (self.position, self.target(block, false)?);
        let ends = Ends { start, end, plane: self.modes.common.plane, clockwise };
        let centre = match block.word(b'r') {
            Some(_) if names_centre(block) => return Err(TraceFault::ArcForm),
            Some(radius) => ends.centre_by_radius(radius * self.modes.unit(), SLACK).map_err(trace_fault)?,
            None => self.centre_by_words(start, block)?,
        };
        let turns = block.count(b'p', "P of an arc")?.unwrap_or(1).saturating_sub(1);
        if turns > MOST_TURNS {
            return Err(TraceFault::TooLarge);
        }
        let arc = ends.about(centre, turns);
        let path = ends.path(&arc, LEAST).map_err(trace_fault)?;
        if path.mismatch() > SLACK.of(path.radius()) {
            self.note(Gap::ArcEnds);
        }
        let pace = self.pace(path.length());
        self.path.arc(&self.offsets, [start, end], arc, pace)?;
        self.position = end;
        Ok(())
    }

    fn centre_by_words(&self, start: [f64; 3], block: &Block) -> Result<[f64; 3], TraceFault> {
        let axes = self.modes.common.plane.axes();
        let words = block.offsets().map(|word| word.map(|word| word * self.modes.unit()));
        if axes.iter().take(2).all(|axis| words[*axis].is_none()) {
            return Err(TraceFault::ArcForm);
        }
        let zero = if self.modes.common.absolute_centre { [0.0; 3] } else { start };
        Ok(centre_by_offsets(zero, zero, words))
    }
}

fn trace_fault(fault: ArcFault) -> TraceFault {
    match fault {
        ArcFault::FullByRadius => TraceFault::ArcForm,
        ArcFault::ShortRadius | ArcFault::NoRadius | ArcFault::NoAngle => TraceFault::ArcRadius,
    }
}

/// Whether a block names a position.
fn names_position(block: &Block) -> bool {
    block.axes().iter().any(Option::is_some) || block.distance.is_some() || block.angle.is_some()
}

fn names_centre(block: &Block) -> bool {
    block.offsets().iter().any(Option::is_some)
}

fn is_cycle(code: u32) -> bool {
    matches!(code, 730 | 740 | 810..=890)
}

//! Codes that move: lines, arcs, probing, and the choice of the cycles and curves.

use styluscam_motion::{Arc, MoveKind};

use super::block::Block;
use super::codes;
use super::cycles::Sticky;
use super::fault::TraceFault;
use super::modes::{FeedMode, NO_MOTION};
use super::note::Gap;
use super::path::Pace;
use super::tracer::{Next, Tracer};
use super::FEED_UNKNOWN;

/// mm: ends of an arc may differ so much in their distance from its centre, and by a thousandth of it, unmentioned.
const ROUNDED: f64 = 0.005;

/// mm/min: a feed beyond them is none.
const SLOWEST: f64 = 1e-3;
const FASTEST: f64 = 1e7;

/// Turns of one arc: each takes its chords.
const TURNS: u32 = 1000;

/// The parameters that hold where a probe tripped, and whether it did.
const PROBED: usize = 5061;
const PROBE_TRIPPED: usize = 5070;

impl Tracer<'_> {
    /// Moves by a code, given or in force.
    pub(super) fn motion(&mut self, block: &Block, code: u32) -> Result<Next, TraceFault> {
        self.modes.motion = code;
        if !is_cycle(code) {
            self.cycle = Sticky::default();
        }
        if code != 50 {
            self.tangent = None;
        }
        match code {
            NO_MOTION => return Err(TraceFault::NoMotionMode),
            _ if !codes::moves(code) => self.note(Gap::Code { code: codes::name_g(code) }),
            0 | 10 if !names_place(block) => {}
            0 => {
                let end = self.target(block, block.has_g(530))?;
                self.rapid(end)?;
            }
            10 => self.straight(block)?,
            20 | 30 if !names_place(block) && !names_centre(block) => {}
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
        let end = self.target(block, block.has_g(530))?;
        self.feed_to(end)
    }

    /// Makes sure that the path stands where the tip does, and tells which axes were never placed.
    pub(super) fn begin(&mut self) -> Result<(), TraceFault> {
        for (index, axis) in ['X', 'Y', 'Z'].into_iter().enumerate() {
            if !std::mem::replace(&mut self.placed[index], true) {
                self.note(Gap::Start { axis });
            }
        }
        if self.path.stands_at(&self.offsets, self.place) {
            return Ok(());
        }
        self.rapid(self.place)
    }

    pub(super) fn feed_to(&mut self, end: [f64; 3]) -> Result<(), TraceFault> {
        let pace = self.pace(self.way_to(end));
        self.path.line(&self.offsets, end, pace)?;
        self.place = end;
        Ok(())
    }

    /// A feed move's pace, for a length in mm.
    pub(super) fn pace(&mut self, length: f64) -> Pace {
        let feed = match self.modes.feed_mode {
            FeedMode::PerMinute => self.modes.feed,
            FeedMode::PerRevolution => self.modes.feed * self.modes.revolutions(),
            // a move of no length takes its time, which no feed can say
            FeedMode::InverseTime if length > 0.0 => self.modes.feed * length,
            FeedMode::InverseTime => FEED_UNKNOWN,
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
        self.parameters.set_run(PROBED, self.place.map(|length| length / unit));
        self.parameters.set_number(PROBE_TRIPPED, if matches!(code, 382 | 384) { 1.0 } else { 0.0 });
        Ok(())
    }

    // Arcs

    fn arc(&mut self, block: &Block, clockwise: bool) -> Result<(), TraceFault> {
        self.begin()?;
        let (start, end) = (self.place, self.target(block, false)?);
        let centre = match block.word(b'r') {
            Some(_) if names_centre(block) => return Err(TraceFault::ArcForm),
            Some(radius) => self.centre_by_radius(start, end, radius * self.modes.unit(), clockwise)?,
            None => self.centre_by_words(start, block)?,
        };
        let turns = block.count(b'p', "P of an arc")?.unwrap_or(1).saturating_sub(1);
        if turns > TURNS {
            return Err(TraceFault::TooLarge);
        }
        let arc = Arc { centre, plane: self.modes.plane, clockwise, turns };
        let way = arc.way(start, end);
        if way.radius() <= 0.0 {
            return Err(TraceFault::ArcRadius);
        }
        if way.mismatch() > ROUNDED + 1e-3 * way.radius() {
            self.note(Gap::ArcEnds);
        }
        let pace = self.pace(way.length());
        self.path.arc(&self.offsets, [start, end], arc, pace)?;
        self.place = end;
        Ok(())
    }

    fn centre_by_words(&self, start: [f64; 3], block: &Block) -> Result<[f64; 3], TraceFault> {
        let axes = self.modes.plane.axes();
        let words = [b'i', b'j', b'k'].map(|letter| block.word(letter).map(|word| word * self.modes.unit()));
        if axes.iter().take(2).all(|axis| words[*axis].is_none()) {
            return Err(TraceFault::ArcForm);
        }
        let zero = if self.modes.absolute_centre { [0.0; 3] } else { start };
        Ok([0, 1, 2].map(|axis| zero[axis] + words[axis].unwrap_or(0.0)))
    }

    /// The centre of the arc of this radius, the shorter one if it is positive.
    fn centre_by_radius(
        &self,
        start: [f64; 3],
        end: [f64; 3],
        radius: f64,
        clockwise: bool,
    ) -> Result<[f64; 3], TraceFault> {
        let [first, second, _] = self.modes.plane.axes();
        let way = [end[first] - start[first], end[second] - start[second]];
        let length = libm::hypot(way[0], way[1]);
        if length <= 0.0 {
            return Err(TraceFault::ArcForm);
        }
        let half = 0.5 * length;
        if half > radius.abs() + ROUNDED + 1e-3 * radius.abs() {
            return Err(TraceFault::ArcRadius);
        }
        let height = (radius * radius - half * half).max(0.0).sqrt();
        // to the left of the way for the shorter arc counterclockwise
        let side = if clockwise == (radius > 0.0) { -height } else { height };
        let mut centre = start;
        centre[first] = start[first] + 0.5 * way[0] - side * way[1] / length;
        centre[second] = start[second] + 0.5 * way[1] + side * way[0] / length;
        Ok(centre)
    }
}

/// Whether a block says where to go.
fn names_place(block: &Block) -> bool {
    block.axes().iter().any(Option::is_some) || block.distance.is_some() || block.angle.is_some()
}

fn names_centre(block: &Block) -> bool {
    b"ijk".iter().any(|letter| block.word(*letter).is_some())
}

fn is_cycle(code: u32) -> bool {
    matches!(code, 730 | 740 | 810..=890)
}

//! Lathe work: threads (G33, G33.1, G76) and contours (G70, G71, G72).

use super::block::Block;
use super::fault::TraceFault;
use super::note::Gap;
use super::tracer::{Next, Tracer};

const X: usize = 0;
const Z: usize = 2;

/// Passes of one thread: more are no thread.
const PASSES: u32 = 100_000;

/// The words of G76, mm.
struct Thread {
    pitch: f64,
    /// From the drive line to the thread's crest: I.
    crest: f64,
    /// Of the first pass below the crest: J.
    first: f64,
    /// Of the last pass: K.
    full: f64,
    /// How the depth falls off: R.
    degression: f64,
    /// Of the slide along which passes go deeper: Q, as a tangent.
    slide: f64,
    /// Passes after the last depth: H.
    spring: u32,
    /// Length of the taper: E; and whether the begin and the end have it: L.
    taper: f64,
    tapered: [bool; 2],
    /// Where the drive line begins and ends.
    start: [f64; 3],
    end: f64,
}

impl Tracer<'_> {
    /// G33: one pass with the spindle.
    pub(super) fn thread(&mut self, block: &Block) -> Result<(), TraceFault> {
        self.begin()?;
        let pitch = self.pitch(block, b'k', "K of G33")?;
        let end = self.target(block, false)?;
        self.turned_feed(end, pitch)
    }

    /// G33.1: down and back with the spindle.
    pub(super) fn tap(&mut self, block: &Block) -> Result<(), TraceFault> {
        self.begin()?;
        let pitch = self.pitch(block, b'k', "K of G33.1")?;
        let (start, end) = (self.position, self.target(block, false)?);
        self.turned_feed(end, pitch)?;
        self.turned_feed(start, pitch)
    }

    fn pitch(&mut self, block: &Block, letter: u8, what: &'static str) -> Result<f64, TraceFault> {
        self.note(Gap::Threading);
        let word = block.word(letter).ok_or(TraceFault::WordMissing { what })?;
        Ok(word.abs() * self.modes.unit())
    }

    fn turned_feed(&mut self, end: [f64; 3], pitch: f64) -> Result<(), TraceFault> {
        let pace = self.pace_of(pitch * self.modes.revolutions());
        self.path.line(&self.offsets, end, pace)?;
        self.position = end;
        Ok(())
    }

    /// G76: passes deeper and deeper along a drive line parallel to Z.
    pub(super) fn thread_cycle(&mut self, block: &Block) -> Result<(), TraceFault> {
        self.begin()?;
        let thread = self.read_thread(block)?;
        let mut depth = thread.first;
        let mut pass = 1;
        while depth < thread.full {
            self.pass(&thread, depth)?;
            pass += 1;
            if pass > PASSES {
                return Err(TraceFault::Thread);
            }
            depth = thread.first * libm::pow(f64::from(pass), 1.0 / thread.degression);
        }
        for _ in 0..=thread.spring {
            self.pass(&thread, thread.full)?;
        }
        let [x, y, _] = thread.start;
        self.rapid([x, y, thread.end])
    }

    fn read_thread(&mut self, block: &Block) -> Result<Thread, TraceFault> {
        let unit = self.modes.unit();
        let pitch = self.pitch(block, b'p', "P of G76")?;
        let length = |letter, what| block.word(letter).map(|word| word * unit).ok_or(TraceFault::WordMissing { what });
        let tapered = match block.count(b'l', "L of G76")?.unwrap_or(0) {
            0 => [false, false],
            1 => [true, false],
            2 => [false, true],
            _ => [true, true],
        };
        let start = self.position;
        let halved = if self.modes.diameter { 0.5 } else { 1.0 };
        let thread = Thread {
            pitch,
            crest: halved * length(b'i', "I of G76")?,
            first: halved * length(b'j', "J of G76")?,
            full: halved * length(b'k', "K of G76")?,
            degression: block.word(b'r').unwrap_or(1.0),
            slide: libm::tan(block.word(b'q').unwrap_or(0.0).to_radians()),
            spring: block.count(b'h', "H of G76")?.unwrap_or(0),
            taper: block.word(b'e').unwrap_or(0.0) * unit,
            tapered,
            start,
            end: self.target(block, false)?[Z],
        };
        let sound = thread.pitch > 0.0 && thread.first > 0.0 && thread.full > 0.0 && thread.degression >= 1.0;
        if sound && thread.spring <= PASSES {
            Ok(thread)
        } else {
            Err(TraceFault::Thread)
        }
    }

    /// One pass and the path to it; it ends beside the thread.
    fn pass(&mut self, thread: &Thread, depth: f64) -> Result<(), TraceFault> {
        let inward = if thread.crest < 0.0 { -1.0 } else { 1.0 };
        let [x, y, z] = thread.start;
        let along = if thread.end < z { -1.0 } else { 1.0 };
        // all of it stands off by what is left to cut, along Z by what the slide has gone
        let beside = x - inward * (thread.full - depth);
        let cut = beside + thread.crest + inward * thread.full;
        let begin = z + along * depth * thread.slide;
        let end = thread.end - along * (thread.full - depth) * thread.slide;
        let crest = cut - inward * thread.full;
        let [from, to] = thread.tapered.map(|tapered| if tapered { thread.taper } else { 0.0 });
        self.rapid([beside, y, begin])?;
        if from > 0.0 {
            self.rapid([crest, y, begin])?;
            self.turned_feed([cut, y, begin + along * from], thread.pitch)?;
        } else {
            self.rapid([cut, y, begin])?;
        }
        self.turned_feed([cut, y, end - along * to], thread.pitch)?;
        if to > 0.0 {
            self.turned_feed([crest, y, end], thread.pitch)?;
        }
        self.rapid([beside, y, end])
    }

    /// G70 to G72: to the position that is named, and along the contour.
    pub(super) fn contour(&mut self, block: &Block) -> Result<Next, TraceFault> {
        self.note(Gap::Contour);
        let label = block.count(b'q', "Q of a contour")?.ok_or(TraceFault::WordMissing { what: "Q of a contour" })?;
        let words = self.lengths(block);
        let position = self.position;
        if words[X].is_some() || words[Z].is_some() {
            self.rapid([words[X].unwrap_or(position[X]), position[1], words[Z].unwrap_or(position[Z])])?;
        }
        self.call_contour(&label.to_string())
    }
}

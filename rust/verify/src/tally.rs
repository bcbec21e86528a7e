//! What the measured moves come to: their faults, the worst positions, and some of the contacts.

use crate::faults::{self, Fault, FaultKind};
use crate::place::Place;
use crate::region_faults::Regions;
use crate::report::ContactRecord;
use crate::samples::{highest, normal_of, Measured, Sample, Strike};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Forming, Limits, Subject};
use crate::tolerances::{ANGLE, SLACK, VERTICAL};

/// Contacts that are kept at most.
const KEPT: usize = 4000;

/// The largest value so far and its position.
#[derive(Clone, Copy, Default)]
pub(crate) struct Worst {
    pub value: f64,
    pub at: Option<Place>,
}

impl Worst {
    /// Of this and what follows.
    pub fn join(&mut self, next: Self) {
        next.at.into_iter().for_each(|place| self.take(next.value, place));
    }

    pub fn take(&mut self, value: f64, place: Place) {
        if value > 0.0 && (self.at.is_none() || value > self.value + SLACK) {
            *self = Self { value, at: Some(place) };
        }
    }
}

/// A contact sample that is kept.
pub(crate) struct Kept {
    pub sample: Sample,
    line: u32,
    touches: bool,
}

impl Kept {
    fn record(&self, subject: &Subject) -> ContactRecord {
        let touch = &self.sample.touch;
        ContactRecord {
            line: self.line,
            tip: self.sample.tip,
            point: touch.point.into(),
            clearance: touch.value,
            triangle: touch.triangle,
            face: subject.mesh.faces().get(touch.triangle as usize).copied().unwrap_or(0),
        }
    }
}

/// What consecutive moves come to.
#[derive(Default)]
pub(crate) struct Tally {
    /// In the moves' order, kind by kind.
    pub faults: Vec<Fault>,
    pub gouge: Worst,
    pub excess: Worst,
    /// Positions at which the clearance was measured.
    pub samples: usize,
    /// Samples of moves that should touch, each position once.
    pub contacts: usize,
    /// How many of them do.
    touching: usize,
    /// Samples of moves in planes of layers that touch nothing.
    in_layers: usize,
    /// Some of them, spread evenly.
    pub kept: Vec<Kept>,
}

impl Tally {
    /// Of these moves and those that follow.
    pub fn join(&mut self, next: Self) {
        self.faults.extend(next.faults);
        self.gouge.join(next.gouge);
        self.excess.join(next.excess);
        self.samples += next.samples;
        self.contacts += next.contacts;
        self.touching += next.touching;
        self.in_layers += next.in_layers;
        self.kept.extend(next.kept);
    }

    pub fn nothing_touches(&self) -> bool {
        self.touching == 0 && self.contacts + self.in_layers > 0
    }

    /// The share of contacts that touch.
    pub fn share(&self) -> f64 {
        self.touching as f64 / self.contacts.max(1) as f64
    }

    /// Kept contacts that touch.
    pub fn records(&self, subject: &Subject) -> Vec<ContactRecord> {
        self.kept.iter().filter(|kept| kept.touches).map(|kept| kept.record(subject)).collect()
    }
}

/// By what moves are tallied.
#[derive(Clone, Copy)]
pub(crate) struct Rule<'a> {
    pub subject: &'a Subject<'a>,
    pub limits: &'a Limits,
    /// Where the operations' contacts must lie.
    regions: &'a Regions<'a>,
    /// One of so many pieces that should touch keeps its contacts.
    keep_every: usize,
}

impl<'a> Rule<'a> {
    pub fn new(segments: &[Segment], subject: &'a Subject<'a>, limits: &'a Limits, regions: &'a Regions<'a>) -> Self {
        let contacts =
            2 * segments.iter().filter(|segment| segment.excess.is_some()).map(Segment::piece_count).sum::<usize>();
        Self { subject, limits, regions, keep_every: contacts.div_ceil(KEPT).max(1) }
    }

    /// Adds a piece of a move to its tally; `ordinal` counts the pieces before it that should touch.
    pub fn add(&self, tally: &mut Tally, segment: &Segment, found: &Measured, ordinal: usize) {
        tally.samples += found.samples;
        if let Some(deepest) = &found.deepest {
            tally.gouge.take(self.depth(deepest), place(segment, deepest));
            tally.faults.extend(self.entry(segment, deepest));
        }
        tally.faults.extend(found.taken.as_ref().and_then(|sample| self.taken(segment, sample)));
        tally.faults.extend(found.struck.as_ref().and_then(|strike| self.strike(segment, strike)));
        if let Some(landing) = &found.landing {
            let (air, limit) = (landing.touch.value, self.limits.rapid_gap);
            tally.faults.push(fault(&faults::RAPID_PLUNGE, segment, landing, (air, limit), limit - air));
        }
        if let Some(limit) = segment.excess {
            tally.faults.extend(self.regions.faults(segment, &found.contacts, limit));
            self.contact(tally, segment, found, limit, ordinal.is_multiple_of(self.keep_every));
        }
    }

    fn depth(&self, sample: &Sample) -> f64 {
        self.subject.deviation_inward - sample.touch.value
    }

    fn distance(&self, sample: &Sample) -> f64 {
        sample.touch.value + self.subject.deviation_outward
    }

    /// The fault of a move that is too deep in the part.
    ///
    /// A rapid that is deepest where it starts only leaves a position that the move before it is blamed for.
    fn entry(&self, segment: &Segment, deepest: &Sample) -> Option<Fault> {
        let depth = self.depth(deepest);
        let brought_here = segment.kind == SegmentKind::Rapid && segment.starts_at(deepest.tip);
        if depth <= self.limits.gouge + SLACK || brought_here {
            return None;
        }
        let (kind, value) = match segment.kind {
            SegmentKind::Rapid if segment.descends() && !segment.travels() => (&faults::RAPID_PLUNGE, -depth),
            SegmentKind::Rapid => (&faults::RAPID_INTO_MATERIAL, depth),
            _ => (&faults::GOUGE, depth),
        };
        Some(fault(kind, segment, deepest, (value, self.limits.gouge), depth))
    }

    /// The fault of a move that takes of the stock that is to be left.
    fn taken(&self, segment: &Segment, deepest: &Sample) -> Option<Fault> {
        let (depth, limit) = (self.depth(deepest), self.limits.gouge);
        (depth > limit + SLACK).then(|| fault(&faults::STOCK_TO_LEAVE, segment, deepest, (depth, limit), depth))
    }

    fn strike(&self, segment: &Segment, strike: &Strike) -> Option<Fault> {
        let Strike { kind, is_at_part, sample, least } = strike;
        let room = sample.touch.value - least;
        if room >= -SLACK || segment.kind == SegmentKind::Rapid && segment.starts_at(sample.tip) {
            return None;
        }
        let measure = if *is_at_part { (self.depth(sample), self.limits.gouge) } else { (sample.touch.value, *least) };
        Some(fault(kind, segment, sample, measure, -room))
    }

    /// A move that should touch, within `limit` mm. Its middle and its end are counted: its start is the end of another.
    fn contact(&self, tally: &mut Tally, segment: &Segment, found: &Measured, limit: f64, kept: bool) {
        let layers = segment.expected.and_then(|number| self.subject.expected.get(number)?.expectation.layers);
        // in the plane of a layer the sheet itself is what is touched
        let is_in_layer = |sample: &Sample| {
            self.distance(sample) > limit + SLACK
                && layers.is_some_and(|layers| layers.off_plane(sample.tip[2]) <= limit + SLACK)
        };
        let owed = found.contacts.map(|sample| sample.filter(|sample| !is_in_layer(sample)));
        tally.in_layers += found.contacts[1..].iter().flatten().filter(|sample| is_in_layer(sample)).count();
        if let Some(sample) = highest(&owed) {
            let excess = self.distance(&sample);
            tally.excess.take(excess, place(segment, &sample));
            if excess > limit + SLACK {
                tally.faults.push(fault(&faults::EXCESS, segment, &sample, (excess, limit), excess));
            }
        }
        for sample in owed[1..].iter().flatten() {
            let shallow = self.depth(sample) <= self.limits.gouge + SLACK;
            let touches = shallow && self.distance(sample) <= limit + SLACK;
            tally.contacts += 1;
            tally.touching += usize::from(touches);
            if touches {
                tally.faults.extend(self.limits.forming.iter().flat_map(|forming| strain(forming, segment, sample)));
            }
            if kept {
                tally.kept.push(Kept { sample: *sample, line: segment.line, touches });
            }
        }
    }
}

/// A contact at which the sheet is formed steeper or thinner than it withstands.
fn strain(forming: &Forming, segment: &Segment, sample: &Sample) -> impl Iterator<Item = Fault> {
    let cos = normal_of(&sample.touch).z.clamp(0.0, 1.0);
    let (angle, thickness) = (libm::acos(cos), forming.thickness * cos);
    let at = |kind: &'static FaultKind| Fault { position: sample.tip, ..segment.fault(kind) };
    let most = forming.max_wall_angle;
    // an upright contact may be the blank's edge: `walls` distinguishes it from a wall
    let steep = (angle > most + ANGLE && cos > VERTICAL)
        .then(|| at(&faults::WALL_ANGLE).measured(angle.to_degrees(), most.to_degrees()));
    let thin = (thickness < forming.min_thickness - SLACK)
        .then(|| at(&faults::THINNING).measured(thickness, forming.min_thickness));
    steep.into_iter().chain(thin)
}

fn place(segment: &Segment, sample: &Sample) -> Place {
    Place { line: segment.line, position: sample.tip }
}

fn fault(kind: &'static FaultKind, segment: &Segment, at: &Sample, measure: (f64, f64), weight: f64) -> Fault {
    Fault { position: at.tip, measure: Some(measure), weight, ..segment.fault(kind) }
}

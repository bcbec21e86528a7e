//! Distances along each move: the exact part of the verification, in parallel.

use std::collections::VecDeque;

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{ArcPath, Cancelled, Watch};

use crate::body::Body;
use crate::clearance::{Prober, Touch};
use crate::expectation::ExpectedOperation;
use crate::frame::Frame;
use crate::holding::{colliders, Collider};
use crate::holes;
use crate::made::Shapes;
use crate::region_faults::Regions;
use crate::samples::{lowest, Measured, Sample, Strike};
use crate::segments::{Segment, SegmentKind};
use crate::stroke::Stroke;
use crate::subject::{Limits, Subject};
use crate::sweep::{Guess, Passed, Question, Seen};
use crate::tally::{Rule, Tally};
use crate::tolerances::SLACK;

/// Moves in a piece of work. Fixed, so that the result does not depend on the number of threads.
const CHUNK: usize = 64;

/// Length of a move, as a share of the tool's radius, up to which one search answers for all its positions.
const JOINT: f64 = 1.0;

/// A chord this near to its arc stands for it, mm.
const FLAT: f64 = 1e-7;

/// Pieces of an arc's segment that are halved at most: all of them, at radius 100 mm, are off by less than 1e-5 mm then.
const HALVINGS: usize = 512;

/// A tool as bodies.
struct Bodies<'a> {
    profile: Body,
    colliders: Vec<Collider<'a>>,
}

/// Measures every segment.
pub(crate) fn measure(
    segments: &[Segment],
    (subject, shapes): (&Subject, &Shapes),
    limits: &Limits,
    frame: Option<&Frame>,
    watch: &Watch,
) -> Result<Tally, Cancelled> {
    watch.begin("verifying", segments.len());
    let least = gouge_level(subject, limits);
    let bodies =
        |tool| Bodies { profile: Body::new(tool, subject.sheet.as_ref()), colliders: colliders(tool, subject, least) };
    let bodies: Vec<Bodies> = subject.tools.iter().map(bodies).collect();
    let top = subject.mesh.bounds().1.z;
    let leaving = |operation: &ExpectedOperation| {
        let leaves = operation.expectation.to_leave.iter().any(|left| *left > 0.0);
        subject.touching(operation).filter(|_| leaves)
    };
    let leaving: Vec<Option<Body>> = subject.expected.iter().map(leaving).collect();
    let regions = Regions::of(subject);
    let rule = Rule::new(segments, subject, limits, &regions);
    let chunks: Vec<&[Segment]> = segments.chunks(CHUNK).collect();
    let tallies = chunks.par_iter().zip(contacts_before(&chunks)).map(|(chunk, mut ordinal)| {
        let mut walk = Walk { subject, shapes, limits, frame, bodies: &bodies, leaving: &leaving, top, last: None };
        let mut tally = Tally::default();
        for segment in *chunk {
            for piece in segment.pieces() {
                watch.advance(0)?; // a long move has many
                rule.add(&mut tally, &piece, &walk.along(&piece), ordinal);
                ordinal += usize::from(segment.excess.is_some());
            }
            watch.advance(1)?;
        }
        Ok(tally)
    });
    let mut whole = Tally::default();
    tallies.collect::<Result<Vec<_>, _>>()?.into_iter().for_each(|tally| whole.join(tally));
    regions.keep_long(&mut whole.faults, segments);
    Ok(whole)
}

/// How many pieces that should touch come before each chunk.
fn contacts_before(chunks: &[&[Segment]]) -> Vec<usize> {
    let mut before = 0;
    let count = |chunk: &&[Segment]| {
        let own: usize = chunk.iter().filter(|segment| segment.excess.is_some()).map(Segment::piece_count).sum();
        before += own;
        before - own
    };
    chunks.iter().map(count).collect()
}

/// A walk along consecutive moves, which remembers the last contact.
struct Walk<'a> {
    subject: &'a Subject<'a>,
    /// What operations are to make of the part.
    shapes: &'a Shapes,
    limits: &'a Limits,
    frame: Option<&'a Frame>,
    bodies: &'a [Bodies<'a>],
    /// Of each operation that leaves stock, its tool with that around it.
    leaving: &'a [Option<Body>],
    /// Height of the part's highest point.
    top: f64,
    /// The last sample, its tool and its operation.
    last: Option<((usize, Option<usize>), Sample)>,
}

impl<'a> Walk<'a> {
    fn along(&mut self, segment: &Segment) -> Measured {
        let Some((tool, bodies)) = segment.tool.and_then(|t| Some((t, self.bodies.get(t)?))) else {
            return Measured::default();
        };
        let around = self.leaving_of(segment, tool);
        let prober = self.prober(segment, around.unwrap_or(&bodies.profile));
        let tool = (tool, segment.expected);
        let mut found = match segment.bend {
            Some(bend) => self.along_bend(segment, &bend, tool, &prober),
            None if segment.excess.is_some() => self.along_contact(segment, tool, &prober),
            None => self.along_air(segment, &prober),
        };
        if around.is_some() {
            // no tool is deeper than with the stock around it
            found.taken = found.deepest.take().filter(|sample| sample.touch.value < self.gouge_level());
            found.deepest = found
                .taken
                .and_then(|_| deepest_of(segment, self.gouge_level(), &self.prober(segment, &bodies.profile)));
        }
        let colliders = bodies
            .colliders
            .iter()
            .filter(|collider| collider.operation.is_none_or(|operation| segment.expected == Some(operation)));
        let strikes = colliders.filter_map(|collider| self.strike(segment, collider));
        let room = |strike: &Strike| strike.sample.touch.value - strike.least;
        Measured { struck: strikes.min_by(|a, b| room(a).total_cmp(&room(b))), ..found }
    }

    /// The tool of a segment with the stock around it that it is to leave; none where it leaves none, and of rapids.
    fn leaving_of(&self, segment: &Segment, tool: usize) -> Option<&'a Body> {
        let number = segment.expected.filter(|_| segment.kind != SegmentKind::Rapid)?;
        let operation = self.subject.expected.get(number).filter(|operation| operation.tool == tool);
        operation.and_then(|_| self.leaving.get(number)?.as_ref())
    }

    /// A body at the part, or at what the segment's operation is to make of it.
    fn prober(&self, segment: &Segment, body: &'a Body) -> Prober<'a> {
        let (mesh, bvh) = self.shapes.of_segment(segment).unwrap_or((self.subject.mesh, self.subject.bvh));
        Prober { body, mesh, bvh }
    }

    /// Where a body comes too near to something: of what goes down with the clamp frame, where that stands before the move or
    /// after it.
    fn strike(&self, segment: &Segment, collider: &Collider) -> Option<Strike> {
        let Some([before, after]) = self.frame.filter(|_| collider.follows).map(|frame| frame.fallen(segment.index))
        else {
            return strike(segment, collider);
        };
        let fallen = |by: f64| strike(&segment.raised(by), collider).map(|strike| strike.lowered(by));
        let strikes = [fallen(before), if before < after { fallen(after) } else { None }];
        strikes.into_iter().flatten().min_by(|a, b| a.sample.touch.value.total_cmp(&b.sample.touch.value))
    }

    /// A piece of an arc: samples, if it should touch, and a proof that nothing between them is deeper.
    fn along_bend(
        &mut self,
        segment: &Segment,
        bend: &ArcPath,
        tool: (usize, Option<usize>),
        prober: &Prober,
    ) -> Measured {
        let mut found = Measured::default();
        if segment.excess.is_some() {
            let start = segment.start.and_then(|tip| self.start(tip, tool, prober, &mut found));
            let samples = [bend.at(0.5), segment.end].map(|tip| self.sample(tip, prober));
            found.contacts = [start, samples[0], samples[1]];
            found.samples += samples.iter().flatten().count();
            self.last = samples[1].map(|end| (tool, end));
        }
        let sampled = lowest(&found.contacts);
        let below = self.level_of(segment).min(sampled.map_or(f64::INFINITY, |s| s.touch.value - SLACK));
        found.deepest = deepest_on_arc(bend, below, prober).or(sampled);
        found
    }

    fn sample(&self, tip: [f64; 3], prober: &Prober) -> Option<Sample> {
        prober.at(prober.body.position(tip), self.guess(prober)).map(|touch| Sample { tip, touch })
    }

    /// A move that should touch: three samples, and a proof that nothing between them is deeper.
    fn along_contact(&mut self, segment: &Segment, tool: (usize, Option<usize>), prober: &Prober) -> Measured {
        let mut found = Measured::default();
        let start = segment.start.and_then(|tip| self.start(tip, tool, prober, &mut found));
        let stroke = stroke_of(segment, prober.body);
        let middle = segment.start.map(|_| stroke.at(0.5));
        let asked = Question { stroke, positions: [middle, Some(stroke.to)], below: self.below(start) };
        let seen = if stroke.length() > JOINT * prober.body.radius() {
            self.one_by_one(asked, prober)
        } else {
            prober.survey(asked, self.guess(prober))
        };
        let sample = |position: Option<Vector>, touch: Option<Touch>| {
            Some(Sample { tip: prober.body.tip(position?), touch: touch? })
        };
        let end = seen.positions[1].map(|touch| Sample { tip: segment.end, touch });
        found.contacts = [start, sample(middle, seen.positions[0]), end];
        found.samples += found.contacts[1..].iter().flatten().count();
        self.last = end.map(|end| (tool, end));
        let passed = seen.deepest.map(|p| sample_of(p, prober.body));
        found.deepest = passed.or_else(|| lowest(&found.contacts));
        found
    }

    /// On a long move one search for all would look at too much.
    fn one_by_one(&self, asked: Question, prober: &Prober) -> Seen {
        let guess = |touch: Option<Touch>, position: Option<Vector>| Some(Guess::like(&touch?, position?));
        let [first, second] = asked.positions;
        let middle = first.and_then(|position| prober.at(position, self.guess(prober)));
        let end = second.and_then(|position| prober.at(position, guess(middle, first).or(self.guess(prober))));
        let sampled = [middle, end].iter().flatten().fold(f64::INFINITY, |a, t| a.min(t.value));
        let below = asked.below.min(sampled - SLACK);
        let passed = prober.survey(Question { positions: [None; 2], below, ..asked }, guess(end, second));
        Seen { positions: [middle, end], deepest: passed.deepest }
    }

    /// The start's sample: mostly the end of the move before.
    fn start(
        &self,
        tip: [f64; 3],
        tool: (usize, Option<usize>),
        prober: &Prober,
        found: &mut Measured,
    ) -> Option<Sample> {
        if let Some((_, sample)) = self.last.filter(|(t, sample)| *t == tool && same(sample.tip, tip)) {
            return Some(sample);
        }
        found.samples += 1;
        self.sample(tip, prober)
    }

    /// The depth from which on a position between the samples matters.
    fn below(&self, start: Option<Sample>) -> f64 {
        self.gouge_level().min(start.map_or(f64::INFINITY, |s| s.touch.value - SLACK))
    }

    /// The last contact.
    fn guess(&self, prober: &Prober) -> Option<Guess> {
        self.last.map(|(_, sample)| Guess::like(&sample.touch, prober.body.position(sample.tip)))
    }

    /// A move that need not touch: only what goes too deep is looked for.
    fn along_air(&self, segment: &Segment, prober: &Prober) -> Measured {
        let mut found = Measured::default();
        if lowest_of(segment, prober.body) - self.top > self.limits.rapid_gap.max(self.gouge_level()) {
            return found;
        }
        let stroke = stroke_of(segment, prober.body);
        let hole = holes::hole_of(segment, self.subject, self.limits);
        found.deepest = deepest_of(segment, self.level_of(segment), prober);
        found.samples = usize::from(found.deepest.is_some());
        // a drill is next to its wall: how deep a rapid may go there is another question
        if hole.is_none() && segment.kind == SegmentKind::Rapid && segment.descends() && found.deepest.is_none() {
            found.landing = deepest(Stroke::still(stroke.to), self.limits.rapid_gap, prober);
        }
        found
    }

    /// The clearance at and below which a move is in the part, mm: in holes their walls' triangles lie on the free side.
    fn level_of(&self, segment: &Segment) -> f64 {
        let hole = holes::hole_of(segment, self.subject, self.limits);
        hole.map_or(self.gouge_level(), |hole| holes::gouge_level(hole, self.subject, self.limits))
    }

    fn gouge_level(&self) -> f64 {
        gouge_level(self.subject, self.limits)
    }
}

/// The clearance at and below which a position counts as a gouge, mm.
pub(crate) fn gouge_level(subject: &Subject, limits: &Limits) -> f64 {
    subject.deviation_inward - limits.gouge
}

/// Where a body comes too near to something on a segment.
fn strike(segment: &Segment, collider: &Collider) -> Option<Strike> {
    let prober = collider.prober();
    let near = lowest_of(segment, prober.body) - collider.top <= collider.least;
    let sample = near.then(|| deepest_of(segment, collider.least, &prober)).flatten()?;
    Some(Strike { kind: collider.kind, is_at_part: collider.is_at_part, sample, least: collider.least })
}

/// Height of the body's tip where it is lowest, mm.
fn lowest_of(segment: &Segment, body: &Body) -> f64 {
    body.position([0.0, 0.0, segment.lowest()]).z
}

/// The deepest position of a segment, if it is below `below`.
pub(crate) fn deepest_of(segment: &Segment, below: f64, prober: &Prober) -> Option<Sample> {
    match segment.bend {
        Some(bend) => deepest_on_arc(&bend, below, prober),
        None => deepest(stroke_of(segment, prober.body), below, prober),
    }
}

/// The deepest position of a stroke, if it is below `below`.
fn deepest(stroke: Stroke, below: f64, prober: &Prober) -> Option<Sample> {
    let passed = prober.survey(Question { stroke, positions: [None; 2], below }, None).deepest;
    passed.map(|p| sample_of(p, prober.body))
}

/// The deepest position of a piece of an arc, if it is below `below`: chords that pass deeper than they are off it are halved.
///
/// Where halving ends, the depth on the chord and what the chord is off are both counted: never too little.
fn deepest_on_arc(bend: &ArcPath, below: f64, prober: &Prober) -> Option<Sample> {
    let mut best: Option<Sample> = None;
    let mut left = VecDeque::from([(0.0, 1.0)]);
    let mut halvings = 0;
    while let Some((from, to)) = left.pop_front() {
        let piece = bend.part(from, to);
        let (sag, limit) = (piece.sag(), best.map_or(below, |b| b.touch.value));
        let [a, b] = [0.0, 1.0].map(|share| prober.body.position(piece.at(share)));
        let Some(found) = deepest(Stroke { from: a, to: b }, limit + sag, prober) else { continue };
        if sag > FLAT && halvings < HALVINGS {
            halvings += 1;
            let middle = 0.5 * (from + to);
            left.extend([(from, middle), (middle, to)]);
        } else {
            let value = found.touch.value - sag;
            best = Some(Sample { touch: Touch { value, ..found.touch }, ..found });
        }
    }
    best
}

/// The path of the body's tip in chords, none farther than `sag` mm from it.
pub(crate) fn strokes_of(segment: &Segment, body: &Body, sag: f64) -> Vec<Stroke> {
    let Some(bend) = segment.bend else { return vec![stroke_of(segment, body)] };
    let count = bend.chords(sag);
    let at = |i: usize| body.position(bend.at(i as f64 / count as f64));
    (0..count).map(|i| Stroke { from: at(i), to: at(i + 1) }).collect()
}

/// The path of the body's tip, or its chord; a point when the start is not known.
fn stroke_of(segment: &Segment, body: &Body) -> Stroke {
    let to = body.position(segment.end);
    Stroke { from: segment.start.map_or(to, |s| body.position(s)), to }
}

/// Whether two tips are the same numbers.
fn same(a: [f64; 3], b: [f64; 3]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}

fn sample_of(passed: Passed, body: &Body) -> Sample {
    Sample { tip: body.tip(passed.position), touch: passed.touch }
}

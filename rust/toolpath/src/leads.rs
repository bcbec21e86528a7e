//! Leads: arcs tangent to a pass, into it and out of it.
//!
//! A tangent lead is an arc in the horizontal plane, on the pass' free side; a vertical one stands on the pass in the plane of
//! its direction and comes down to it, or leaves it upwards. Neither enters the part: piece by piece the envelope is proven to
//! stay under it, and where that cannot be seen, near the pass that it touches, it is compared at points no farther apart than
//! [`FINE`]. Neither goes into sheet that stands higher, nor nearer to check faces than their clearance. Where no lead fits there is none. Derived in docs/concepts/linking.md.

use styluscam_geometry::Vector;
use styluscam_motion::{Arc, Plane, Role};

use crate::offset::Keeping;
use crate::{Curve, Followed, Heights, Lead, LinkRules, Pace, PathPoint, Segment, Standing};

/// How far a piece's chord may be off the arc, mm: a fifth of what is still no gouge.
const SAG: f64 = 2e-4;
/// Tips may lie so far under the envelope, mm: rounding, and the chords.
const ALLOWED: f64 = 5e-4;
/// Pieces that are shorter are compared at their ends, mm.
const FINE: f64 = 0.05;
/// Normals with a smaller horizontal part have no free side.
const LEVEL: f64 = 1e-3;
/// Coordinates that differ by less are one, mm.
const SAME: f64 = 1e-9;

/// The form of leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeadShape {
    /// An arc in the horizontal plane, on the free side.
    Tangent,
    /// An arc in the vertical plane of the pass' direction, above it.
    Vertical,
}

/// What leads are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeadRule {
    /// Their form.
    pub shape: LeadShape,
    /// Of their arc, mm.
    pub radius: f64,
    /// Of their arc, rad.
    pub angle: f64,
    /// Feeds into a pass and out of one, mm/min.
    pub feeds: [f64; 2],
    /// How far passes are from the envelope at most, and chords from an arc that the machine does not have, mm.
    pub deviation: f64,
}

/// Rules with leads.
pub struct Leading<'a, R> {
    /// Paths and heights.
    pub rules: R,
    /// What stands.
    pub standing: &'a Standing<'a>,
    /// Whether what stands is a sheet, that no lead may press down before its pass does.
    pub is_sheet: bool,
    /// The leads.
    pub lead: LeadRule,
    /// Whether the machine has an arc between two positions of the tip.
    pub takes: &'a (dyn Fn([[f64; 3]; 2], &Arc) -> bool + Sync),
}

/// Which end of a run a lead is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    In,
    Out,
}

/// A circle on which a lead lies, from the run's end.
struct Bow {
    centre: Vector,
    /// From the centre to the run's end, mm.
    arm: Vector,
    /// As long, a quarter of a turn away from the run.
    aside: Vector,
    angle: f64,
}

impl Bow {
    /// The position at a share of the angle, from the run on.
    fn at(&self, share: f64) -> Vector {
        let (sin, cos) = libm::sincos(self.angle * share);
        self.centre + self.arm * cos + self.aside * sin
    }

    /// So many pieces that no chord is farther than `sag` mm off.
    fn pieces(&self, sag: f64) -> u32 {
        let half = libm::acos((1.0 - sag / self.arm.norm()).max(-1.0)).max(1e-4);
        (0.5 * self.angle / half).ceil().max(1.0) as u32
    }
}

impl<R: Sync> Leading<'_, R> {
    fn lead(&self, side: Side, number: usize, end: (&PathPoint, Vector)) -> Option<Lead> {
        let bow = self.bow_that_fits(side, number, end)?;
        Some(Lead { far: bow.at(1.0), segments: self.segments(&bow, side) })
    }

    /// Whether a lead fits at an end of a pass, by its number, with the direction of the pass there.
    pub(crate) fn fits(&self, side: Side, number: usize, end: (&PathPoint, Vector)) -> bool {
        self.bow_that_fits(side, number, end).is_some()
    }

    fn bow_that_fits(&self, side: Side, number: usize, (at, along): (&PathPoint, Vector)) -> Option<Bow> {
        let away = match side {
            Side::In => -along,
            Side::Out => along,
        };
        let bow = self.bow(at, away)?;
        let far = bow.at(1.0);
        // before its pass a sheet stands as the passes before left it, after it as that one did
        let passes = number + usize::from(side == Side::Out);
        let is_above_sheet = match self.lead.shape {
            LeadShape::Tangent => self.standing.sheet(passes, [at.tip, far]) <= at.tip.z + SAME,
            LeadShape::Vertical => true, // nowhere deeper than the pass is where they meet
        };
        let is_free = !self.is_sheet || is_above_sheet;
        (is_free && self.is_clear(&bow, at.normal)).then_some(bow)
    }

    fn bow(&self, at: &PathPoint, away: Vector) -> Option<Bow> {
        let LeadRule { shape, radius, angle, .. } = self.lead;
        let (away, towards) = match shape {
            LeadShape::Tangent => {
                let away = Vector::new(away.x, away.y, 0.0).try_normalize(SAME)?;
                let left = Vector::new(-away.y, away.x, 0.0);
                let free = left.dot(&at.normal);
                (free.abs() > LEVEL).then(|| (away, left * free.signum()))?
            }
            LeadShape::Vertical => {
                let away = away.try_normalize(SAME)?;
                let up = (Vector::z() - away * away.z).try_normalize(LEVEL)?;
                (away, up)
            }
        };
        Some(Bow { centre: at.tip + towards * radius, arm: -towards * radius, aside: away * radius, angle })
    }

    /// Whether the tool enters nothing anywhere on it. As its pass it may be within the path's deviation of the envelope: the
    /// tool clears the envelope if it is moved so far along the normal of the contact. Upright walls count so, too: beside them
    /// the envelope rises at once.
    fn is_clear(&self, bow: &Bow, normal: Vector) -> bool {
        let surface = self.standing.surface();
        let envelope = surface.envelope();
        let count = bow.pieces(SAG);
        let aside = normal * self.lead.deviation;
        let mut hint = None;
        let mut is_over = |tip: Vector| {
            envelope.contact_near(tip.x, tip.y, &mut hint).is_none_or(|contact| contact.tip <= tip.z + ALLOWED)
        };
        (0..count).all(|piece| {
            let [a, b] = [0, 1].map(|end| bow.at(f64::from(piece + end) / f64::from(count)));
            let moved = [a + aside, b + aside];
            let is_proven = envelope.keeps_under(moved, ALLOWED, |_| ALLOWED) == Keeping::Under;
            let is_short = (b - a).norm() <= FINE.max(2.0 * bow.arm.norm() * bow.angle / f64::from(count));
            let [from, to] = moved;
            surface.is_clear([a, b])
                && (is_proven || (is_short && [from, 0.5 * (from + to), to].into_iter().all(&mut is_over)))
        })
    }

    /// An arc where the machine has it, else chords on the side of its centre.
    fn segments(&self, bow: &Bow, side: Side) -> Vec<Segment> {
        let feed = match side {
            Side::In => self.lead.feeds[0],
            Side::Out => self.lead.feeds[1],
        };
        let share = |i: u32, count: u32| match side {
            Side::In => 1.0 - f64::from(i) / f64::from(count),
            Side::Out => f64::from(i) / f64::from(count),
        };
        if let Some(arc) = self.arc([bow.at(share(0, 1)), bow.at(0.5), bow.at(share(1, 1))], bow.centre, feed) {
            return vec![arc.in_role(Role::Lead)];
        }
        let count = bow.pieces(self.lead.deviation);
        (1..=count).map(|i| Segment::line(bow.at(share(i, count)), feed).in_role(Role::Lead)).collect()
    }

    /// The arc through three positions about a centre in one of the machine's planes, if it takes it.
    fn arc(&self, [start, middle, end]: [Vector; 3], centre: Vector, feed: f64) -> Option<Segment> {
        let plane = [Plane::Xy, Plane::Zx, Plane::Yz].into_iter().find(|plane| {
            let [_, _, third] = plane.axes();
            (start[third] - end[third]).abs() <= SAME && (start[third] - middle[third]).abs() <= SAME
        })?;
        let [first, second, _] = plane.axes();
        let centre = [centre[first], centre[second]];
        let ends = [start, end].map(<[f64; 3]>::from);
        [false, true].into_iter().find_map(|clockwise| {
            let curve = Curve::Arc { plane, centre, clockwise };
            let segment = Segment { end, curve, pace: Pace::Feed(feed), role: None };
            let path = segment.to_move(0).path(ends[0])?;
            let passes = (Vector::from(path.at(0.5)) - middle).norm() <= SAG;
            (passes && (self.takes)(ends, &segment.turning()?)).then_some(segment)
        })
    }
}

impl<R: LinkRules<PathPoint>> LinkRules<PathPoint> for Leading<'_, R> {
    fn path(&self, from: &PathPoint, to: &PathPoint) -> Option<Vec<Segment>> {
        self.rules.path(from, to)
    }

    fn heights(&self, number: usize, from: Option<Vector>, to: Vector, ceiling: Heights) -> Heights {
        self.rules.heights(number, from, to, ceiling)
    }

    fn lead_in(&self, number: usize, run: &Followed<'_, PathPoint>) -> Option<Lead> {
        self.lead(Side::In, number, (run.from, heading(run.from.tip, &run.first()?, 0.0)))
    }

    fn lead_out(&self, number: usize, run: &Followed<'_, PathPoint>) -> Option<Lead> {
        let (start, last) = run.last()?;
        self.lead(Side::Out, number, (run.to, heading(start, &last, 1.0)))
    }
}

/// The direction of a segment at its beginning, 0, or its end, 1.
fn heading(start: Vector, segment: &Segment, at: f64) -> Vector {
    const NEAR: f64 = 1e-4;
    let path = segment.to_move(0).path(start.into());
    path.map_or(segment.end - start, |path| {
        let from = if at > 0.0 { 1.0 - NEAR } else { 0.0 };
        Vector::from(path.at(from + NEAR)) - Vector::from(path.at(from))
    })
}

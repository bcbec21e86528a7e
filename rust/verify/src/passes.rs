//! Passes that are missing: positions of the part that the tool could touch, and that neither the passes of their operation
//! nor the distance expected between them explains.

use std::collections::BTreeMap;

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Program, Watch};

use crate::assignment::Assignment;
use crate::body::Body;
use crate::clearance::{Prober, Touch};
use crate::contact_lines::{self, End, Pass};
use crate::coverage::{Sweep, Sweeps};
use crate::expectation::{Expectation, OrderedPasses};
use crate::faults::{self, Fault, FaultKind};
use crate::findings::FindingKind;
use crate::in_layers;
use crate::pitch::Pitch;
use crate::probes::{self, Probe};
use crate::scalar::{PassKind, Scalar};
use crate::scallop::Ridges;
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tabs::Tabs;
use crate::tolerances::{ROOM, ROUGH, WIDE};

// Lengths below do not follow the tolerance and the mesh's deviation: these two are added where they matter (see
// `Look::tolerated`). Where "empirical" is written, no derivation and no measurement is recorded: with the value, sound programs
// have no finding and the defects that are seeded in them are found (tests/mutation, tests/python/test_missing_passes.py).

/// Points that are looked at for an operation. Empirical: one for each 0.7 mm on a face of 100 x 100 mm.
const POINTS: usize = 20_000;
/// Points that are looked at where passes end. Empirical: one for each 0.2 mm round 100 x 100 mm.
const POINTS_AT_END: usize = 2000;
/// Points in a piece of work. Fixed, so that the result does not depend on the number of threads.
const CHUNK: usize = 256;
/// What may be left where passes lie a whole step away, as a share of what such a pass leaves on a plane: the part is curved.
/// Empirical.
const CURVED: f64 = 1.5;
/// The same where they lie half a step away: twice as far they leave four times as much. Empirical, within the bound below.
const CURVED_AMIDST: f64 = 2.5;
const _: () = assert!(2.0 * CURVED >= CURVED_AMIDST);
/// What may be left on a pass besides the tolerance and the mesh's deviation, mm: facets that the tool cannot quite touch
/// for their neighbours'. Empirical: half as much again as [`ROUGH`].
const ON_PASS: f64 = 0.015;
/// A pass this near, as a share of the tool's radius, is the one that should be at a position. Empirical.
const BESIDE: f64 = 0.35;
/// Passes that differ by less than this share of what lies between neighbours are one: half of what a value can lie off the
/// nearest of them.
const SAME_PASS: f64 = 0.25;
/// Passes are looked for so many steps around a position: where one is missing the next lies up to two steps away.
const AROUND: f64 = 2.2;
/// They run by where they lie no more steps aside, along the pass or off the face. Empirical.
const RUNS_BY: f64 = 0.5;
/// Passes this many steps apart have none missing between them: a step, and a twentieth more. Empirical.
const APART: f64 = 1.05;

/// Parts of the smallest feature in which a face is measured, and how far a face may bend away within one, as a share of it:
/// across the passes, and along them, where a pass follows the face round its corners. Empirical.
const STEPS: usize = 8;
const BENT: f64 = 0.2;
const TURNED: f64 = 1.0;
/// A direction that shrinks to less than this share as it meets a face head-on ends there: within 6 degrees of its normal.
const HEAD_ON: f64 = 0.1;
/// Passes lie on a spot's face where the tool touches faces that lean by no more from the spot's, by the angle's cosine: 60
/// degrees. Empirical.
const ALIKE: f64 = 0.5;

/// Triangles that a tool enters by less are touched, mm: what arithmetic costs, as [`crate::tolerances::SLACK`].
const SAME_TOUCH: f64 = 1e-6;
/// Times that the tool is moved off what it enters, or to what it is to touch. Empirical.
const LIFTS: usize = 8;

/// A face goes on where the tool, moved along the plane that it touches, is as near to it as this, mm: it may curve
/// away by as much. Empirical.
const TOUCH: f64 = 0.03;

/// Planes that slope by less, a sine, are level: a tenth of a millimetre over a metre.
const LEVEL: f64 = 1e-4;

/// So many steps by scallop above the lowest level tell how large the next would be: the last one may be short.
const ALIKE_STEPS: usize = 3;
/// Points at which it is looked at whether the tool can touch beside passes. Empirical.
const TOUCHING: usize = 2000;
/// Passes that are more steps apart are no oversight in a few positions: the program is not the job's. Empirical.
const MANY: f64 = 3.0;

/// Where so much of an increment is left, a row of the last layer is missing, and no strip between rows.
const OF_LAYER: f64 = 0.5;

/// Faults in the order of the moves that lie beside the missing passes.
pub(crate) fn faults(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let mut worst: BTreeMap<(usize, FindingKind), Fault> = BTreeMap::new();
    let sets = subject
        .expected
        .iter()
        .flat_map(|operation| operation.expectation.sets().iter().map(move |passes| (operation, passes)));
    for (operation, passes) in sets {
        let expectation = &operation.expectation;
        let is_own = |segment: &&Segment| {
            segment.kind == SegmentKind::Lateral
                && assignment.is(segment.operation, operation)
                && may_be_of(passes, expectation, segment)
        };
        let rows: Vec<&Segment> = segments.iter().filter(is_own).collect();
        let Some(body) = subject.touching(operation) else { continue };
        if rows.is_empty() || !expectation.selected.contains(&true) {
            continue;
        }
        let touching = expectation.layers.map(|layers| in_layers::touching(&rows, &layers, (&body, subject, limits)));
        let contacts = touching.as_ref().map_or_else(|| rows.clone(), |touching| touching.iter().collect());
        let sweeps = Sweeps::of(&contacts, subject, expectation.to_leave);
        let Some(body) = sweeps.body(operation.tool) else { continue };
        let selected = expectation.triangles();
        let look =
            Look { subject, limits, expectation, passes, selected: &selected, body, rows: &rows, contacts: &contacts };
        let tabs = Tabs::of(program, segments, assignment, subject, operation);
        let counts = |fault: &Fault| !Tabs::excuse(&tabs, fault.position);
        let left = look.left(&sweeps, counts, watch)?;
        let on_passes = look.left_on_passes(&sweeps, watch)?;
        let at_ends = look.left_at_ends(&sweeps, watch)?;
        let ridges = Ridges { subject, operation, passes, body, sweeps: &sweeps, contacts: &contacts };
        let scallops = ridges.faults(watch)?;
        let found = on_passes.into_iter().chain(at_ends).filter(counts);
        for fault in left.into_iter().chain(found).chain(look.gaps()).chain(scallops) {
            let known = worst.entry((fault.index, fault.kind.finding)).or_insert(fault);
            if fault.weight > known.weight {
                *known = fault;
            }
        }
    }
    Ok(worst.into_values().collect())
}

/// Whether a move may be of a set of passes: not one along another set of them, which would hide what this one leaves.
fn may_be_of(passes: &OrderedPasses, expectation: &Expectation, segment: &Segment) -> bool {
    let is_along = |set: &OrderedPasses| contact_lines::holds(&*set.scalar, segment);
    let mut others = expectation.sets().iter().filter(|set| !std::ptr::eq(*set, passes));
    is_along(passes) || !others.any(is_along)
}

/// A position where more is left than the distance between passes explains: a fault where a feature is there, and no passes.
struct Excess {
    fault: Fault,
    spot: Spot,
    /// To the next pass, mm.
    step: Vector,
}

/// One operation, looked at.
struct Look<'a> {
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    expectation: &'a Expectation,
    passes: &'a OrderedPasses,
    /// The triangles that its passes are for.
    selected: &'a [usize],
    body: &'a Body,
    /// The operation's moves along its passes.
    rows: &'a [&'a Segment],
    /// Those that should touch.
    contacts: &'a [&'a Segment],
}

/// A point of the part, and the tool where it touches the point's triangle there.
struct Spot {
    point: Vector,
    /// The triangle's normal.
    up: Vector,
    /// Where the body is.
    position: Vector,
    tip: [f64; 3],
}

impl Look<'_> {
    /// Passes that are farther apart than expected, or end too soon, while the tool could touch between or beyond.
    fn gaps(&self) -> Vec<Fault> {
        let (scalar, pitch) = (self.scalar(), &self.passes.pitch);
        let [rest_low, rest_high] = scalar.rest();
        let passes = contact_lines::passes(self.passes, self.contacts);
        let (Some(lowest), Some(highest)) = (passes.first(), passes.last()) else { return Vec::new() };
        let touching = self.touching();
        let touches_amidst = |[low, high]: [f64; 2], step: f64| {
            let amidst = 0.3 * (high - low);
            let mut spots = touching.iter().filter(|(value, _)| *value > low + amidst && *value < high - amidst);
            let is_at_end = |spot: &Spot| [low, high].into_iter().any(|pass| self.is_last(pass, spot, step));
            spots.any(|(_, spot)| self.holds_feature(spot) && !is_at_end(spot))
        };
        let wide = |gap: f64, steps: f64, step: f64| gap > steps * step + ROUGH;
        let kind = |is_above: bool| match (scalar.kind(), is_above) {
            (PassKind::Level, true) => &faults::NO_LEVEL_ABOVE,
            (PassKind::Level, false) => &faults::NO_LEVEL_BELOW,
            (PassKind::Row, _) => &faults::NO_ROW,
        };
        let between = passes.windows(2).filter_map(|pair| {
            let (low, high) = (pair[0], pair[1]);
            let gap = high.value - low.value;
            let is_above = low.first.index > high.first.index;
            let later = if is_above { low } else { high };
            let step = pitch.between(low.value, high.value);
            let touches = || touches_amidst([low.value, high.value], step);
            (wide(gap, WIDE, step) && touches()).then_some((later.first, gap, step, kind(is_above)))
        });
        let farthest = |beyond: &dyn Fn(f64) -> f64, steps: f64, step: f64| {
            let ends = touching.iter().map(|(value, spot)| (beyond(*value), spot));
            let mut ends: Vec<(f64, &Spot)> = ends.filter(|(gap, _)| wide(*gap, steps, step)).collect();
            ends.sort_by(|a, b| b.0.total_cmp(&a.0));
            ends.into_iter().find(|(_, spot)| self.holds_feature(spot)).map(|(gap, _)| gap)
        };
        let [step_below, step_above] = [self.last_step(&passes), pitch.at(highest.value)];
        let below = farthest(&|value| lowest.value - value, rest_low, step_below);
        let below = below.map(|gap| (lowest.last, gap, step_below, kind(false)));
        let above = farthest(&|value| value - highest.value, rest_high, step_above);
        let above = above.map(|gap| (highest.last, gap, step_above, kind(true)));
        let gaps = between.chain(below).chain(above);
        let fault = |(segment, gap, step, kind): (&Segment, f64, f64, &'static FaultKind)| {
            let fault = segment.fault(kind).measured(gap, step);
            if gap > MANY * step {
                fault
            } else {
                fault.warning()
            }
        };
        gaps.map(fault).collect()
    }

    /// The step below the lowest pass, mm: where steps follow from the scallop, as large as the last ones above it.
    fn last_step(&self, passes: &[Pass]) -> f64 {
        let step = passes.first().map_or(0.0, |lowest| self.passes.pitch.at(lowest.value));
        let above = passes.windows(2).take(ALIKE_STEPS).map(|pair| pair[1].value - pair[0].value);
        match self.passes.pitch {
            Pitch::Scallop { .. } if !self.passes.continuous => above.reduce(f64::max).unwrap_or(step).min(step),
            Pitch::Scallop { .. } | Pitch::Even(_) | Pitch::Listed { .. } => step,
        }
    }

    /// Heights, or positions across the rows, at which the tool can touch, with where.
    fn touching(&self) -> Vec<(f64, Spot)> {
        let (scalar, mesh) = (self.scalar(), self.subject.mesh);
        let is_crossed = |triangle: &usize| {
            let up = mesh.normal(*triangle);
            let tip = |corner: Vector| self.body.tip(corner - self.body.farthest(up).0);
            mesh.corners(*triangle).into_iter().any(|corner| scalar.crosses(tip(corner).into(), up))
        };
        let asked: Vec<usize> = self.selected.iter().copied().filter(is_crossed).collect();
        let spots = probes::spread(mesh, &asked, TOUCHING).into_par_iter();
        let touching = spots.filter_map(|probe| self.spot(&probe)).filter(|spot| self.can_touch(spot));
        touching.map(|spot| (scalar.value(spot.tip.into()), spot)).collect()
    }

    /// Positions where more is left than the distance between passes explains: the worst beside each move, of those that count.
    fn left(
        &self,
        sweeps: &Sweeps,
        counts: impl Fn(&Fault) -> bool + Sync,
        watch: &Watch,
    ) -> Result<Vec<Fault>, Cancelled> {
        let probes = probes::spread(self.subject.mesh, self.selected, POINTS);
        let mut found = of_all(&probes, watch, |probe, last| self.left_at(probe, sweeps, last))?;
        found.sort_by(|a, b| a.fault.index.cmp(&b.fault.index).then(b.fault.weight.total_cmp(&a.fault.weight)));
        let is_missing = |excess: &Excess| {
            self.holds_feature(&excess.spot)
                && !self.lies_between_passes(&excess.spot, excess.step, sweeps)
                && counts(&excess.fault)
        };
        let stands = |excess: &&Excess| watch.is_cancelled() || is_missing(excess);
        let worst = |beside: &[Excess]| beside.par_iter().find_first(stands).map(|excess| excess.fault);
        let beside_each = found.par_chunk_by(|a, b| a.fault.index == b.fault.index);
        let faults = beside_each.filter_map(worst).collect();
        watch.advance(0).map(|()| faults)
    }

    /// Positions that the passes should touch, and do not.
    fn left_on_passes(&self, sweeps: &Sweeps, watch: &Watch) -> Result<Vec<Fault>, Cancelled> {
        let values = contact_lines::values(self.passes, self.rows);
        self.left_along((&values, POINTS), sweeps, watch, |spot| !self.passes_beside(spot, sweeps))
    }

    /// Positions all around at the end of the passes that the last one should touch, and does not.
    fn left_at_ends(&self, sweeps: &Sweeps, watch: &Watch) -> Result<Vec<Fault>, Cancelled> {
        let mut found = Vec::new();
        for end in contact_lines::ends(self.passes, self.contacts) {
            // as far up as the tool can go down: on the floor itself none is expected
            let over = [end.value + self.strip()];
            found
                .extend(self.left_along((&over, POINTS_AT_END), sweeps, watch, |spot| self.is_of(&end, spot, sweeps))?);
        }
        Ok(found)
    }

    /// Positions at values, of so many points, that a pass should touch and none does: where one `is_missing`.
    fn left_along(
        &self,
        (values, count): (&[f64], usize),
        sweeps: &Sweeps,
        watch: &Watch,
        is_missing: impl Fn(&Spot) -> bool + Sync,
    ) -> Result<Vec<Fault>, Cancelled> {
        let probes = contact_lines::spread(self.subject.mesh, self.selected, self.body, self.scalar(), values, count);
        let allowed = ON_PASS + self.tolerated();
        let faults = of_all(&probes, watch, |probe, last| {
            let spot = self.spot(probe)?;
            let left = sweeps.left_beyond(spot.point, allowed, spot.position, last)?;
            let missing = self.can_touch(&spot) && is_missing(&spot);
            missing.then(|| self.missing_pass(&spot, last.as_ref(), left, allowed)).flatten()
        })?;
        Ok(self.of_long_gaps(faults))
    }

    /// Whether the moves of an end run by above a spot, no farther than a step, and none of the end itself does.
    fn is_of(&self, end: &End, spot: &Spot, sweeps: &Sweeps) -> bool {
        let step = self.next(spot).map_or(self.body.radius(), |step| step.norm());
        let runs_by = |sweep: &Sweep| end.moves.as_ref().is_none_or(|moves| moves.contains(&sweep.segment));
        let ends = |sweep: &Sweep| {
            let value = self.scalar().value(self.contacts[sweep.segment].end.into());
            (value - end.value).abs() <= ROUGH
        };
        sweeps.near(spot.position, APART * step + ROUGH).any(runs_by)
            && !sweeps.near(spot.position, BESIDE * self.body.radius()).any(ends)
    }

    /// Those that have company on their pass: what is shorter than the smallest feature may be missing.
    fn of_long_gaps(&self, mut faults: Vec<Fault>) -> Vec<Fault> {
        let value = |fault: &Fault| self.scalar().value(fault.position.into());
        faults.sort_by(|a, b| value(a).total_cmp(&value(b)));
        let same = |fault: &Fault| SAME_PASS * self.passes.step_at(fault.position);
        let passes = faults.chunk_by(|a, b| value(b) - value(a) <= same(a));
        let long = |pass: &[Fault]| -> Vec<Fault> {
            pass.iter().filter(|fault| pass.iter().any(|other| self.are_apart(fault, other))).copied().collect()
        };
        passes.flat_map(long).collect()
    }

    /// Whether two positions are ends of a gap that is too long.
    fn are_apart(&self, a: &Fault, b: &Fault) -> bool {
        let distance = (Vector::from(a.position) - Vector::from(b.position)).norm();
        let shortest = self.passes.smallest_feature;
        (shortest..=3.0 * shortest + self.body.radius()).contains(&distance)
    }

    /// Whether the pass lies beside a spot on it: within the tolerance the same height may be some distance off.
    fn passes_beside(&self, spot: &Spot, sweeps: &Sweeps) -> bool {
        let value = self.scalar().value(spot.tip.into());
        let pitch = self.passes.step_at(spot.tip);
        let same = |segment: &Segment| (self.scalar().value(segment.end.into()) - value).abs() <= SAME_PASS * pitch;
        sweeps.near(spot.position, BESIDE * self.body.radius()).any(|sweep| same(self.contacts[sweep.segment]))
    }

    /// Where the tool touches a point, when its tip is then at a height that is asked for.
    fn spot(&self, probe: &Probe) -> Option<Spot> {
        let up = self.subject.mesh.normal(probe.triangle);
        let position = probe.point - self.body.farthest(up).0;
        let is_asked =
            self.asked_for(position) && self.expectation.region.takes(self.body, position, (probe.point, up));
        is_asked.then(|| Spot { point: probe.point, up, position, tip: self.body.tip(position) })
    }

    /// What is left at a point, if it is more than the distance between passes explains, and the tool can get there.
    fn left_at(&self, probe: &Probe, sweeps: &Sweeps, last: &mut Option<(usize, Sweep)>) -> Option<Excess> {
        let spot = self.spot(probe)?;
        let step = self.next(&spot).filter(|step| 0.5 * step.norm() < self.body.radius())?;
        let positions = |share: f64| [spot.position + share * step, spot.position - share * step];
        let amidst = CURVED_AMIDST * self.leaves(spot.point, positions(0.5));
        let rough = ROUGH + self.tolerated();
        // `leaves` is convex and zero where the tool touches: a whole step off it is at least twice what it is half a step off,
        // so `explained` below is never less than `amidst`
        let left = sweeps.left_beyond(spot.point, amidst + rough, spot.position, last)?;
        if !self.can_touch(&spot) {
            return None;
        }
        // in the midst of a face a pass is half a step away at most, at its ends a whole one; where it does not go on at
        // all, what lies around is not like it
        let explained = match positions(0.5).into_iter().filter(|position| self.goes_on(*position)).count() {
            0 => return None,
            1 => CURVED * self.leaves(spot.point, positions(1.0)),
            _ => amidst,
        };
        let allowed = explained + rough;
        let fault = self.missing_pass(&spot, last.as_ref(), left, allowed).filter(|_| left > allowed)?;
        Some(Excess { fault, spot, step })
    }

    /// Whether the tool can touch around a spot as far as a feature is that counts.
    fn holds_feature(&self, spot: &Spot) -> bool {
        let step = self.next(spot).unwrap_or_else(|| self.passes.step_at(spot.tip) * Vector::z());
        let (across, feature) = (step.normalize(), self.passes.smallest_feature);
        let reaches_across = |length: f64| self.reaches(spot, across, length, BENT);
        let reaches_along = |length: f64| self.reaches(spot, spot.up.cross(&across), length, TURNED);
        let mut lengths = self.scalar().features(feature, step.norm()).into_iter();
        lengths.any(|[across, along]| reaches_across(across) && reaches_along(along))
    }

    /// Whether the tool touches the face of a spot where a pass lies, and the face ends before the next one would: a ball that rolls
    /// over the edge of a shoulder touches neither wall over the height of its radius.
    fn is_last(&self, pass: f64, spot: &Spot, step: f64) -> bool {
        let value = |position: Vector| self.scalar().value(self.body.tip(position).into());
        let at = value(spot.position);
        let Some(next) = self.next(spot) else { return false };
        let to = |there: f64| next * ((there - at) / (value(spot.position + next) - at));
        let beyond = pass + APART * step * (at - pass).signum();
        let is_between = (beyond - at) * (at - pass) > 0.0;
        is_between
            && self.clearance(spot.position + to(pass)).abs() <= TOUCH
            && !self.selects_near(spot.point + to(beyond) - ROOM * spot.up)
    }

    /// Whether what is nearest to a point is what the passes are for.
    fn selects_near(&self, point: Vector) -> bool {
        self.expectation.selects(self.subject.bvh.nearest(self.subject.mesh, point).1)
    }

    fn scalar(&self) -> &dyn Scalar {
        &*self.passes.scalar
    }

    /// The shift from a spot to the next pass on its plane.
    fn next(&self, spot: &Spot) -> Option<Vector> {
        self.scalar().next(spot.tip.into(), spot.up, self.passes.step_at(spot.tip))
    }

    /// Whether the tool can go `length` mm both ways together along an axis from a spot, touching what the passes are for.
    fn reaches(&self, spot: &Spot, axis: Vector, length: f64, bend: f64) -> bool {
        let parts: usize = [axis, -axis].into_iter().map(|side| self.steps_that_touch(spot, length * side, bend)).sum();
        parts >= STEPS
    }

    /// How many of [`STEPS`] equal parts of a travel off a spot the tool can go, touching what the passes are for all along it:
    /// that bends away by no more than a share of a part within it.
    fn steps_that_touch(&self, spot: &Spot, travel: Vector, bend: f64) -> usize {
        let step = travel.norm() / STEPS as f64;
        let (mut position, mut travel) = (spot.position, travel.normalize());
        for taken in 0..STEPS {
            let Some((there, across)) = self.brought_to_touch(position + step * travel, bend * step) else {
                return taken;
            };
            position = there;
            let Some(on) = (travel - travel.dot(&across) * across).try_normalize(HEAD_ON) else { return taken };
            travel = on;
        }
        STEPS
    }

    /// Where a tool that is moved by `most` mm at most touches what the passes are for, and the direction across the face
    /// there.
    fn brought_to_touch(&self, position: Vector, most: f64) -> Option<(Vector, Vector)> {
        let mut there = position;
        for _ in 0..LIFTS {
            let touch = self.touch(there)?;
            if touch.value.abs() <= ROOM {
                return self.is_selected(touch.triangle).then_some((there, touch.away));
            }
            there += touch.value * touch.away;
            if (there - position).norm() > most {
                return None;
            }
        }
        None
    }

    /// Whether passes run by on either side of a spot no farther apart than expected, or on one side within a step where none
    /// does beyond: what is left there follows from the part's shape.
    fn lies_between_passes(&self, spot: &Spot, step: Vector, sweeps: &Sweeps) -> bool {
        let (scalar, length) = (self.scalar(), step.norm());
        let along = spot.up.cross(&step).normalize();
        let (value, pitch) = (scalar.value(spot.tip.into()), self.passes.step_at(spot.tip));
        let beside = sweeps.near(spot.position, AROUND * length).filter_map(|sweep| {
            let nearest = sweep.nearest(spot.position);
            let [aside, off] = [along, spot.up].map(|axis| (nearest - spot.position).dot(&axis).abs());
            let is_near = aside.max(off) <= RUNS_BY * length;
            let runs_by = is_near && (off <= ROUGH + self.tolerated() || self.touches_alike(nearest, spot.up));
            runs_by.then(|| (scalar.value(self.body.tip(nearest).into()) - value) / pitch)
        });
        let (before, behind): (Vec<f64>, Vec<f64>) = beside.partition(|steps| *steps < 0.0);
        let before = before.into_iter().reduce(f64::max);
        let behind = behind.into_iter().reduce(f64::min);
        match (before, behind) {
            (Some(before), Some(behind)) => behind - before <= APART,
            // tips at a face's end are known to within the tolerance
            (Some(only), None) | (None, Some(only)) => (only.abs() - 1.0) * pitch <= ROUGH + self.tolerated(),
            (None, None) => false,
        }
    }

    /// Whether what the tool touches at a position, if anything, leans as a face does: not the opposite wall, nor the land above.
    fn touches_alike(&self, position: Vector, up: Vector) -> bool {
        self.touch(position).is_some_and(|touch| -touch.away.dot(&up) >= ALIKE)
    }

    /// The fault of a position at which more is left than allowed; it belongs to the move beside it.
    fn missing_pass(&self, spot: &Spot, beside: Option<&(usize, Sweep)>, left: f64, allowed: f64) -> Option<Fault> {
        let beside = self.contacts[beside?.1.segment].fault(&faults::MISSING_PASS);
        let fault = Fault { position: spot.tip, ..beside }.measured(left, allowed);
        let layers = self.expectation.layers;
        // a layer that is missing leaves more than a pass does
        Some(if layers.is_some_and(|layers| left > OF_LAYER * layers.increment) { fault } else { fault.warning() })
    }

    /// How far off the part a move may be, mm.
    fn tolerated(&self) -> f64 {
        self.limits.excess.unwrap_or(0.0) + self.subject.deviation_outward
    }

    /// What passes at these positions leave at a point, mm.
    fn leaves(&self, point: Vector, positions: [Vector; 2]) -> f64 {
        positions.map(|position| self.body.distance(point - position).value).into_iter().fold(0.0, f64::max)
    }

    /// Whether the tool touches the part at a position that is asked for.
    fn goes_on(&self, position: Vector) -> bool {
        let takes = |touch: Touch| {
            touch.value.abs() <= TOUCH && self.expectation.region.takes(self.body, position, (touch.point, -touch.away))
        };
        self.asked_for(position) && self.touch(position).is_some_and(takes)
    }

    /// Whether the tip is at a height that is asked for.
    fn asked_for(&self, position: Vector) -> bool {
        self.expectation.reaches(self.body.tip(position)[2])
    }

    /// Whether the tool can touch at a spot and a little farther down: where it only does so within the tolerance to either
    /// side of an edge, beside a floor or over a rim that stops it, no pass is expected; nor where a triangle that the passes are
    /// not for keeps it off.
    fn can_touch(&self, spot: &Spot) -> bool {
        let down = (spot.up * spot.up.z - Vector::z()).try_normalize(LEVEL);
        let lower = spot.position + down.map_or(Vector::zeros(), |down| self.strip() * down);
        [spot.position, lower].into_iter().all(|position| self.clearance(position) >= -ROOM)
            && self.rests_on_selected(spot)
    }

    /// How far below a spot the tool is to have room, mm.
    fn strip(&self) -> f64 {
        2.0 * ROOM.max(self.tolerated())
    }

    /// Whether the tool, let down beside a spot, comes to rest on what the passes are for: as far off the part as a move may
    /// be, because there passes are planned.
    fn rests_on_selected(&self, spot: &Spot) -> bool {
        let off = self.tolerated();
        let aside = self.scalar().aside(spot.tip.into(), spot.up).map(|aside| off * aside);
        // on a gentle slope that is far off, and gives no information about the spot
        let Some(aside) = aside.filter(|aside| aside.norm() <= self.body.radius()) else { return true };
        let mut position = spot.position + aside;
        let mut rests_on_selected = true;
        for _ in 0..LIFTS {
            let Some(touch) = self.touch(position).filter(|touch| touch.value < off - SAME_TOUCH) else { break };
            rests_on_selected = self.is_selected(touch.triangle);
            if -touch.away.z < LEVEL {
                // no height clears an upright wall
                break;
            }
            position.z += (off - touch.value) / -touch.away.z;
        }
        rests_on_selected
    }

    fn is_selected(&self, triangle: u32) -> bool {
        self.expectation.selects(triangle as usize)
    }

    fn clearance(&self, position: Vector) -> f64 {
        self.touch(position).map_or(f64::INFINITY, |touch| touch.value)
    }

    fn touch(&self, position: Vector) -> Option<Touch> {
        let prober = Prober { body: self.body, mesh: self.subject.mesh, bvh: self.subject.bvh };
        prober.at(position, None)
    }
}

/// What is found at points, in parallel; points near by follow each other, and the last move found is passed to the next point.
fn of_all<T: Send>(
    probes: &[Probe],
    watch: &Watch,
    found_at: impl Fn(&Probe, &mut Option<(usize, Sweep)>) -> Option<T> + Sync,
) -> Result<Vec<T>, Cancelled> {
    watch.begin("missing passes", probes.len().div_ceil(CHUNK));
    let found: Result<Vec<Vec<T>>, Cancelled> = probes
        .par_chunks(CHUNK)
        .map(|chunk| {
            watch.advance(1)?;
            let mut last = None;
            Ok(chunk.iter().filter_map(|probe| found_at(probe, &mut last)).collect())
        })
        .collect();
    Ok(found?.into_iter().flatten().collect())
}

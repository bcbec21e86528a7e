//! Turns between neighbouring rows: rounded corners or outer loops instead of the straight line from end to start.
//!
//! A turn is a curve in plan, of arcs and lines that meet the rows and each other without a corner, and lies on the envelope at
//! each of its points. Three positions are tried: beyond the ends of the rows on selected faces; for rounded turns over the
//! rows' last stretch, which is left out for it; and beyond the ends, lifted off whatever is there. Derived in
//! docs/concepts/rows.md.

use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Role, Watch};

use super::turn_curve::{looped, outer, rounded, CurvePoint, Ends, Fine, Flat};
use crate::linking::along_selected;
use crate::pass::plan_length;
use crate::{fitting, Entered, Pass, PathPoint, Surface};

/// The tool is lifted off by this share of a free turn's length in its middle, and by no more than [`MOST_LIFT`].
const LIFT: f64 = 0.05;
/// mm.
const MOST_LIFT: f64 = 0.5;
/// Chords of a free turn are halved so many times at most where the part may rise over them.
const HALVINGS: u32 = 6;
/// Rows that are not this far apart are one, mm.
const BESIDE: f64 = 1e-4;
/// Most of a row that turns may take from it at one end, as a share of its length.
const OF_ROW: f64 = 0.45;

/// How the tool turns from row to row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// Along arcs of half the distance between the rows.
    Rounded,
    /// Along an outer loop of arcs of this radius, mm.
    Looped(f64),
}

/// What turns are planned with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns {
    /// Their shape.
    pub turn: Turn,
    /// Rows whose ends are farther apart in plan are not joined by turns, mm.
    pub longest: f64,
    /// How far a chord may be from the envelope, mm.
    pub deviation: f64,
    /// What is narrower may be missed, mm.
    pub narrow: f64,
    /// Whether turns may leave the faces: where a text cannot state that they are links, they would be passes that touch nothing.
    pub may_leave: bool,
}

/// How many turns there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Turned {
    /// Planned as asked for.
    pub turns: usize,
    /// Of these, off the part.
    pub free: usize,
    /// Pairs of neighbouring rows between which none fits: they are linked straight.
    pub straight: usize,
    /// Pairs whose ends are too far apart.
    pub apart: usize,
}

impl Turned {
    /// Those of two sets of rows together.
    #[must_use]
    pub fn sum(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        let (Some(a), Some(b)) = (a, b) else { return a.or(b) };
        Some(Self {
            turns: a.turns + b.turns,
            free: a.free + b.free,
            straight: a.straight + b.straight,
            apart: a.apart + b.apart,
        })
    }
}

/// Rows in the order in which they are followed, each with the turn to it where one fits.
///
/// # Errors
/// `Cancelled`.
pub fn turned(
    surface: &Surface<'_>,
    ordered: Vec<Pass>,
    rule: &Turns,
    watch: &Watch,
) -> Result<(Vec<Entered>, Turned), Cancelled> {
    watch.begin("turns", ordered.len());
    let mut counts = Turned::default();
    let mut entered: Vec<Entered> = Vec::with_capacity(ordered.len());
    // what a turn takes off a row is measured by the whole row
    let lengths: Vec<f64> = ordered.iter().map(|pass| plan_length(&pass.points)).collect();
    for (number, mut pass) in ordered.into_iter().enumerate() {
        watch.advance(1)?;
        let before = entered.last_mut().map(|before| &mut before.pass);
        let pair = before.and_then(|before| Some((Ends::between(before, &pass)?, before)));
        let pair = pair.filter(|(ends, _)| ends.apart > BESIDE);
        counts.apart += usize::from(pair.as_ref().is_some_and(|(ends, _)| ends.distance() > rule.longest));
        let Some((ends, before)) = pair.filter(|(ends, _)| ends.distance() <= rule.longest) else {
            entered.push(Entered::from(pass));
            continue;
        };
        let most = [number - 1, number].map(|row| OF_ROW * lengths[row]);
        let found = Turning { surface, rule, ends: &ends }.found(before, &pass, most);
        match found {
            Some(Found { points, role, taken: [from, to] }) => {
                counts.turns += 1;
                counts.free += usize::from(role.is_some());
                before.points = shortened(&before.points, from);
                pass.points.reverse();
                pass.points = shortened(&pass.points, to);
                pass.points.reverse();
                entered.push(Entered { pass, ramp: points, role });
            }
            None => {
                counts.straight += 1;
                entered.push(Entered::from(pass));
            }
        }
    }
    Ok((entered, counts))
}

/// A turn that fits.
struct Found {
    /// Its points, the ends of both rows included.
    points: Vec<PathPoint>,
    role: Option<Role>,
    /// What it takes off the ends of both rows, in plan, mm.
    taken: [f64; 2],
}

/// Two rows' ends with what there is between them.
struct Turning<'a> {
    surface: &'a Surface<'a>,
    rule: &'a Turns,
    ends: &'a Ends,
}

impl Turning<'_> {
    fn found(&self, before: &Pass, after: &Pass, most: [f64; 2]) -> Option<Found> {
        let (from, to) = (before.points.last()?, after.points.first()?);
        let fine = Fine { sagitta: 0.5 * self.rule.deviation, bend: self.surface.bend() };
        let beyond = match self.rule.turn {
            Turn::Rounded => outer(self.ends, fine),
            Turn::Looped(radius) => looped(self.ends, radius, fine),
        };
        let whole = |(points, role)| Found { points, role, taken: [0.0; 2] };
        let outside = beyond.as_deref().and_then(|curve| self.on_selected(from, curve, to));
        if let Some(points) = outside {
            return Some(whole((points, None)));
        }
        let inside = || {
            let (taken, curve) = rounded(self.ends, most, fine)?;
            let from = *shortened(&before.points, taken[0]).last()?;
            let turned: Vec<PathPoint> = after.points.iter().rev().copied().collect();
            let to = *shortened(&turned, taken[1]).last()?;
            let points = self.on_selected(&from, &curve, &to)?;
            Some(Found { points, role: None, taken })
        };
        let inside = if self.rule.turn == Turn::Rounded { inside() } else { None };
        let free = || Some(whole((self.free(from, beyond.as_deref()?, to)?, Some(Role::Link))));
        inside.or_else(|| self.rule.may_leave.then(free).flatten())
    }

    /// The curve on the envelope, if it touches selected faces all along.
    fn on_selected(&self, from: &PathPoint, curve: &[CurvePoint], to: &PathPoint) -> Option<Vec<PathPoint>> {
        let Turns { deviation, narrow, .. } = *self.rule;
        let mut hint = None;
        let mut points = vec![*from];
        for CurvePoint { at: [x, y], .. } in curve {
            points.push(self.surface.at(*x, *y, &mut hint).filter(|point| point.selected)?);
        }
        points.push(*to);
        let mut path = vec![*from];
        for pair in points.windows(2).filter(|pair| differs(&pair[0], &pair[1])) {
            let run = along_selected(self.surface, pair, deviation, narrow)?;
            let chords = self.surface.thinned(&run, deviation);
            path.extend_from_slice(chords.get(1..)?);
        }
        Some(path)
    }

    /// The curve at the height of the line between both ends, or of the envelope where that is higher, and lifted off both.
    fn free(&self, from: &PathPoint, curve: &[CurvePoint], to: &PathPoint) -> Option<Vec<PathPoint>> {
        let ends = [(self.ends.from, 0.0), (self.ends.to, 1.0)].map(|(at, share)| CurvePoint { at, share });
        let length: f64 = [&ends[..1], curve, &ends[1..]]
            .concat()
            .windows(2)
            .map(|pair| libm::hypot(pair[1].at[0] - pair[0].at[0], pair[1].at[1] - pair[0].at[1]))
            .sum();
        let lift = (LIFT * length).min(MOST_LIFT);
        let heights = [from.tip.z, to.tip.z];
        let mut hint = None;
        let mut raised = |point: &CurvePoint| {
            let ([x, y], share) = (point.at, point.share);
            let line = heights[0] + share * (heights[1] - heights[0]);
            let met = self.surface.at(x, y, &mut hint).map_or(f64::NEG_INFINITY, |point| point.tip.z);
            let sin = libm::sin(std::f64::consts::PI * share);
            PathPoint {
                tip: Vector::new(x, y, met.max(line) + lift * sin * sin),
                normal: Vector::z(),
                selected: false,
                triangle: from.triangle,
            }
        };
        let mut path = vec![*from];
        let mut last = ends[0];
        let targets: Vec<(CurvePoint, PathPoint)> = curve.iter().map(|point| (*point, raised(point))).collect();
        for (curve_point, point) in targets.into_iter().chain([(ends[1], *to)]) {
            let before = *path.last()?;
            self.clear_chord((last, before), (curve_point, point), HALVINGS, &mut raised, &mut path)?;
            last = curve_point;
        }
        Some(path).filter(|path| self.surface.is_clear_along(path))
    }

    /// Adds the end of a chord, with points between where the part may rise over it; none where it still may.
    fn clear_chord(
        &self,
        a: (CurvePoint, PathPoint),
        b: (CurvePoint, PathPoint),
        halvings: u32,
        raised: &mut impl FnMut(&CurvePoint) -> PathPoint,
        path: &mut Vec<PathPoint>,
    ) -> Option<()> {
        if !self.surface.may_rise(None, &a.1, &b.1, fitting::PROVEN * self.rule.deviation) {
            path.push(b.1);
            return Some(());
        }
        let middle = CurvePoint {
            at: [0, 1].map(|axis| 0.5 * (a.0.at[axis] + b.0.at[axis])),
            share: 0.5 * (a.0.share + b.0.share),
        };
        let halvings = halvings.checked_sub(1)?;
        let middle = (middle, raised(&middle));
        self.clear_chord(a, middle, halvings, raised, path)?;
        self.clear_chord(middle, b, halvings, raised, path)
    }
}

fn differs(a: &PathPoint, b: &PathPoint) -> bool {
    (b.tip - a.tip).xy().norm() > 1e-6
}

impl Ends {
    /// The end of a row and the start of the next one; none of loops, and of rows without a direction.
    fn between(before: &Pass, after: &Pass) -> Option<Self> {
        if before.closed || after.closed {
            return None;
        }
        let plan = |point: &PathPoint| -> Flat { [point.tip.x, point.tip.y] };
        let direction = |pass: &Pass| {
            let along = pass.points.last()?.tip.xy() - pass.points.first()?.tip.xy();
            along.try_normalize(BESIDE).map(|along| [along.x, along.y])
        };
        let (from, to) = (plan(before.points.last()?), plan(after.points.first()?));
        let (leaving, arriving) = (direction(before)?, direction(after)?);
        let apart = (leaving[0] * (to[1] - from[1]) - leaving[1] * (to[0] - from[0])).abs();
        Some(Self { from, to, leaving, arriving, apart })
    }
}

/// A path without its last `length` mm in plan; it ends on its own chord.
fn shortened(points: &[PathPoint], length: f64) -> Vec<PathPoint> {
    let mut points = points.to_vec();
    let mut left = length;
    while left > 0.0 && points.len() > 1 {
        let (last, before) = (points[points.len() - 1], points[points.len() - 2]);
        let chord = (last.tip - before.tip).xy().norm();
        points.pop();
        if chord > left {
            let share = left / chord;
            let tip = last.tip + share * (before.tip - last.tip);
            points.push(PathPoint { tip, ..last });
        }
        left -= chord;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shortened_row_ends_on_its_chord() {
        let point = |x: f64, z: f64| PathPoint {
            tip: Vector::new(x, 0.0, z),
            normal: Vector::z(),
            selected: true,
            triangle: 0,
        };
        let row = [point(0.0, 0.0), point(4.0, 0.0), point(6.0, 1.0)];
        let ends = |length: f64| shortened(&row, length).last().map(|point| [point.tip.x, point.tip.z]);
        assert_eq!(ends(0.0), Some([6.0, 1.0]));
        assert_eq!(ends(1.0), Some([5.0, 0.5]));
        assert_eq!(ends(3.0), Some([3.0, 0.0]));
        assert_eq!(shortened(&row, 3.0).len(), 2);
    }
}

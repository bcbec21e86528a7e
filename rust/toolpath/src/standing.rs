//! What stands under a link, and how low rapids may cross it.
//!
//! Two things stand there: the part, with its sheet, and what is not formed or cut yet. The first is the envelope along the
//! line: sampled, then raised until no triangle asks for more anywhere on it ([`Envelope::keeps_under`](crate::offset::Envelope)).
//! Check faces with their clearance stand there as the part does. The second is flat, at the height of the sheet's clamp plane or of the stock's top; inside a loop that was followed to its end it is no higher than
//! that loop, since sheet inside hangs from what the loop has pressed down. Derived in docs/concepts/linking.md.

use styluscam_geometry::Vector;
use styluscam_motion::Role;

use crate::offset::Keeping;
use crate::plan::{apart, foot};
use crate::{Entered, Followed, Heights, Lead, LinkRules, PathPoint, Segment, Surface};

/// Distance between samples along a link, as a share of the tool's radius: how much too low they are is found by the proof.
const SAMPLE: f64 = 0.25;
/// Samples along a link, at most.
const MOST_SAMPLES: f64 = 400.0;
/// First rise over the samples that is tried, mm; each further one is twice as high.
const RISE: f64 = 0.01;
/// Height over either end of a link that goes straight at a feed, at most, as a share of its length: it goes down steeply, if not far.
const DROP: f64 = 0.1;
/// Loops before a link that are asked whether they enclose it, at most: parts that are formed side by side are in the same few
/// levels.
const LOOPS: usize = 4096;

/// What stands while passes are followed, in their order.
pub struct Standing<'a> {
    surface: &'a Surface<'a>,
    /// Height of the tip on what is not formed, or cut, mm.
    flat: f64,
    /// By pass; none of open ones and where loops lower nothing.
    loops: Vec<Option<Loop>>,
    /// A position this near to a loop is inside, mm.
    near: f64,
}

/// A closed pass in plan.
struct Loop {
    points: Vec<[f64; 2]>,
    low: [f64; 2],
    high: [f64; 2],
    /// Its highest tip, mm.
    height: f64,
}

impl<'a> Standing<'a> {
    /// What stands at `flat` (the tip on it, mm) until it is formed: closed passes lower what is inside where `hangs`. Passes deviate
    /// from their curves by `deviation` mm.
    #[must_use]
    pub fn new(surface: &'a Surface<'a>, flat: f64, (passes, hangs): (&[Entered], bool), deviation: f64) -> Self {
        let passes = passes.iter().filter(|entered| !entered.pass.points.is_empty());
        let of = |entered: &Entered| (hangs && entered.pass.closed).then(|| Loop::of(&entered.pass.points));
        Self { surface, flat, loops: passes.map(of).collect(), near: 2.0 * deviation }
    }

    /// The lowest height, mm, at which the tip clears everything on the straight line in plan between two tips, after so many
    /// passes; at least the higher of both, `ceiling` where nothing lower is proven.
    #[must_use]
    pub fn height(&self, passes: usize, [from, to]: [Vector; 2], ceiling: f64) -> f64 {
        self.part([from, to], ceiling).max(self.sheet(passes, [from, to])).min(ceiling)
    }

    /// Height of the tip on the sheet, or the stock, under a line after so many passes, mm.
    pub(crate) fn sheet(&self, passes: usize, [from, to]: [Vector; 2]) -> f64 {
        let line = [[from.x, from.y], [to.x, to.y]];
        let before = self.loops.get(..passes).unwrap_or(&self.loops);
        // the last one that encloses it is the lowest: levels go from the top down
        let last = before.iter().rev().take(LOOPS).flatten().find(|around| around.encloses(line, self.near));
        last.map_or(self.flat, |around| around.height.min(self.flat))
    }

    /// The part with its sheet, and the check faces.
    pub(crate) fn surface(&self) -> &'a Surface<'a> {
        self.surface
    }

    /// The straight way at a feed from one tip to another, over the part and the check faces alone: up, across and down. None where
    /// it would be higher over either than a share of the distance in plan, or nothing is proven to be under it.
    fn across(&self, [from, to]: [Vector; 2], feed: f64) -> Option<Vec<Segment>> {
        let highest = from.z.min(to.z) + DROP * (to - from).xy().norm();
        let height = self.part([from, to], highest);
        if height >= highest {
            return None;
        }
        let at = |end: Vector| Vector::new(end.x, end.y, height);
        let link = |end| Segment { role: Some(Role::Link), ..Segment::line(end, feed) };
        Some([at(from), at(to), to].map(link).into())
    }

    /// A height under which no tip has to be over the line: proven, or `ceiling`.
    fn part(&self, [from, to]: [Vector; 2], ceiling: f64) -> f64 {
        let length = (to - from).xy().norm();
        let spacing = SAMPLE * self.surface.envelope().cutter().max_radius();
        let count = (length / spacing).ceil().clamp(1.0, MOST_SAMPLES) as u32;
        let sampled = self.surface.envelopes().flat_map(|envelope| {
            let mut hint = None;
            (0..=count).filter_map(move |i| {
                let at = from + (to - from) * (f64::from(i) / f64::from(count));
                envelope.contact_near(at.x, at.y, &mut hint).map(|contact| contact.tip)
            })
        });
        let highest = sampled.fold(from.z.max(to.z), f64::max);
        let at = |height: f64| [from, to].map(|end| Vector::new(end.x, end.y, height));
        let mut rise = RISE;
        while highest + rise < ceiling {
            let line = at(highest + rise);
            if self.surface.envelopes().all(|envelope| envelope.keeps_under(line, 0.0, |_| 0.0) == Keeping::Under) {
                return highest + rise;
            }
            rise *= 2.0;
        }
        ceiling
    }
}

impl Loop {
    fn of(points: &[PathPoint]) -> Self {
        let (mut low, mut high, mut height) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2], f64::NEG_INFINITY);
        for point in points {
            let at = [point.tip.x, point.tip.y];
            low = [0, 1].map(|i| low[i].min(at[i]));
            high = [0, 1].map(|i| high[i].max(at[i]));
            height = height.max(point.tip.z);
        }
        Self { points: points.iter().map(|point| [point.tip.x, point.tip.y]).collect(), low, high, height }
    }

    /// Whether all of a line is inside, or no farther than `near` outside.
    fn encloses(&self, [from, to]: [[f64; 2]; 2], near: f64) -> bool {
        let holds = |p: [f64; 2]| (0..2).all(|i| (self.low[i] - near..=self.high[i] + near).contains(&p[i]));
        if !holds(from) || !holds(to) {
            return false;
        }
        let at = |share: f64| [0, 1].map(|i| from[i] + share * (to[i] - from[i]));
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let mut shares: Vec<f64> = self.sides().filter_map(|side| crossing([from, to], side)).collect();
        shares.extend([0.0, 1.0]);
        shares.sort_by(f64::total_cmp);
        // between crossings a line is inside or outside; a short piece outside is near to where it crosses
        shares.windows(2).all(|pair| {
            let middle = at(0.5 * (pair[0] + pair[1]));
            let is_short = (pair[1] - pair[0]) * length <= 2.0 * near;
            self.has_inside(middle) || (is_short && self.distance(middle) <= near)
        })
    }

    fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        self.points.windows(2).map(|side| [side[0], side[1]])
    }

    /// By the number of sides that a ray along X crosses.
    fn has_inside(&self, [x, y]: [f64; 2]) -> bool {
        let crosses =
            |[a, b]: &[[f64; 2]; 2]| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        self.sides().filter(crosses).count() % 2 == 1
    }

    fn distance(&self, point: [f64; 2]) -> f64 {
        self.sides().map(|side| apart(foot(point, side), point)).fold(f64::INFINITY, f64::min)
    }
}

/// The share of a line at which it crosses another.
fn crossing([from, to]: [[f64; 2]; 2], [a, b]: [[f64; 2]; 2]) -> Option<f64> {
    let (along, side) = ([to[0] - from[0], to[1] - from[1]], [b[0] - a[0], b[1] - a[1]]);
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let (off, across) = ([a[0] - from[0], a[1] - from[1]], cross(along, side));
    if across == 0.0 {
        return None;
    }
    let (share, of_side) = (cross(off, side) / across, cross(off, along) / across);
    ((0.0..=1.0).contains(&share) && (0.0..=1.0).contains(&of_side)).then_some(share)
}

/// Rules whose rapids cross only a margin above what stands.
pub struct Low<'a, R> {
    /// Paths at a feed.
    pub rules: R,
    /// What stands.
    pub standing: &'a Standing<'a>,
    /// Air that rapids keep above that, mm.
    pub margin: f64,
    /// Short links that go straight over the part at a feed; none where passes have to be left by rapids.
    pub across: Option<Across>,
}

/// Links over what passes leave out, such as a hole between the ends of two rows: straight, at a feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    /// Longest distance in plan, mm.
    pub longest: f64,
    /// mm/min.
    pub feed: f64,
}

impl<R: LinkRules<PathPoint>> LinkRules<PathPoint> for Low<'_, R> {
    fn path(&self, from: &PathPoint, to: &PathPoint) -> Option<Vec<Segment>> {
        let is_short = |across: &Across| (to.tip - from.tip).xy().norm() <= across.longest;
        let across =
            || self.across.filter(is_short).and_then(|across| self.standing.across([from.tip, to.tip], across.feed));
        self.rules.path(from, to).or_else(across)
    }

    fn heights(&self, number: usize, from: Option<Vector>, to: Vector, ceiling: Heights) -> Heights {
        let over = |line, most: f64| (self.standing.height(number, line, most - self.margin) + self.margin).min(most);
        let clearance = from.map_or(ceiling.clearance, |from| over([from, to], ceiling.clearance));
        let retract = over([to, to], ceiling.retract.min(clearance));
        Heights { clearance, retract }
    }

    fn lead_in(&self, number: usize, run: &Followed<'_, PathPoint>) -> Option<Lead> {
        self.rules.lead_in(number, run)
    }

    fn lead_out(&self, number: usize, run: &Followed<'_, PathPoint>) -> Option<Lead> {
        self.rules.lead_out(number, run)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(corners: &[[f64; 2]]) -> Loop {
        let point = |[x, y]: &[f64; 2]| PathPoint {
            tip: Vector::new(*x, *y, -2.0),
            normal: Vector::z(),
            selected: true,
            triangle: 0,
        };
        let mut points: Vec<PathPoint> = corners.iter().map(point).collect();
        points.extend(points.first().copied());
        Loop::of(&points)
    }

    #[test]
    fn a_line_is_inside_where_all_of_it_is() {
        // a U, open upwards
        let loops =
            around(&[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [6.0, 9.0], [6.0, 3.0], [3.0, 3.0], [3.0, 9.0], [0.0, 9.0]]);
        let encloses = |from, to| loops.encloses([from, to], 0.01);
        assert!(encloses([1.0, 1.0], [8.0, 2.0]) && encloses([1.0, 8.0], [1.0, 1.0]));
        assert!(!encloses([1.0, 8.0], [8.0, 8.0]), "from arm to arm");
        assert!(!encloses([1.0, 1.0], [1.0, 12.0]) && !encloses([20.0, 1.0], [21.0, 1.0]));
        // from its own points, and from a little outside
        assert!(encloses([0.0, 0.0], [9.0, 2.0]) && encloses([-0.005, 1.0], [4.0, 1.0]));
        assert!(!encloses([-0.5, 1.0], [4.0, 1.0]));
        // single positions
        assert!(
            encloses([1.0, 1.0], [1.0, 1.0]) && encloses([0.0, 4.0], [0.0, 4.0]) && !encloses([4.5, 5.0], [4.5, 5.0])
        );
    }
}

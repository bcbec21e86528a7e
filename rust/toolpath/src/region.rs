//! Where passes may run beyond the faces that were selected: inside a boundary, on contacts of some slopes, and clear of check
//! faces.
//!
//! A boundary is a set of edges in plan: a position is inside where a ray from it crosses an odd number of them (even-odd rule,
//! M. Shimrat, "Algorithm 112: Position of point relative to polygon", Communications of the ACM 5, 1962). Edges need no order,
//! so a loop inside another is an island, and the outline of faces is the sum of their triangles' outlines.
//!
//! The clearance of check faces is exact: a point is nearer than a distance to a convex solid just where the solid grown by a ball
//! of that radius contains it (Minkowski sum). So the tool keeps its clearance where its tip is over the envelope of the grown
//! tool on the check faces. See docs/concepts/regions.md.

use styluscam_geometry::Vector;

use crate::offset::{Envelope, Keeping};
use crate::{fitting, PathPoint};

/// Passes are cut to this at the end of a region, mm.
const CUT: f64 = 1e-6;
/// Between positions nearer than this nothing is looked for, mm.
const FINE: f64 = 5e-3;
/// Check faces may ask for so much more between two positions that keep their clearance, mm: tools are planned that much larger.
pub const GRAZES: f64 = 1e-3;
/// Where it ends between two positions no farther apart than this, it ends there once, mm.
const NARROW: f64 = 0.05;
/// Slopes beyond a limit by less are at it, rad: a facet of a cone leans by what it deviates.
const SAME_SLOPE: f64 = 1e-3;

/// What of a tool must lie inside a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inside {
    /// Its axis.
    Centre,
    /// Its contact.
    Contact,
    /// All of its profile.
    Tool,
}

/// Edges in plan, and what must lie between them.
#[derive(Clone, Debug)]
pub struct Boundary {
    edges: Vec<[[f64; 2]; 2]>,
    inside: Inside,
    /// Of the tool, mm.
    radius: f64,
}

impl Boundary {
    /// Of edges in any order, mm, for a tool of a radius, mm.
    #[must_use]
    pub fn new(edges: Vec<[[f64; 2]; 2]>, inside: Inside, radius: f64) -> Self {
        Self { edges, inside, radius }
    }

    /// The position in plan that must lie inside.
    fn position(&self, envelope: &Envelope<'_>, tip: Vector, normal: Vector) -> [f64; 2] {
        let point = match self.inside {
            Inside::Centre | Inside::Tool => tip,
            Inside::Contact => envelope.touching_point(tip, normal),
        };
        [point.x, point.y]
    }

    fn allows(&self, position: [f64; 2]) -> bool {
        self.contains(position) && (self.inside != Inside::Tool || self.distance(position, position) >= self.radius)
    }

    /// Whether what is allowed at both ends of a segment may not be between them.
    fn may_end_on(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        match self.inside {
            Inside::Centre | Inside::Contact => self.edges.iter().any(|[c, d]| cross(a, b, *c, *d)),
            Inside::Tool => self.distance(a, b) < self.radius,
        }
    }

    /// By a ray along +X.
    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let crosses =
            |[[ax, ay], [bx, by]]: &&[[f64; 2]; 2]| (*ay > y) != (*by > y) && x < ax + (bx - ax) * (y - ay) / (by - ay);
        self.edges.iter().filter(crosses).count() % 2 == 1
    }

    /// Least distance of a segment from the edges, mm.
    fn distance(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        let of_edge = |[c, d]: &[[f64; 2]; 2]| {
            if cross(a, b, *c, *d) {
                return 0.0;
            }
            let ends =
                [from_segment(a, *c, *d), from_segment(b, *c, *d), from_segment(*c, a, b), from_segment(*d, a, b)];
            ends.into_iter().fold(f64::INFINITY, f64::min)
        };
        self.edges.iter().map(of_edge).fold(f64::INFINITY, f64::min)
    }
}

/// Whether two segments in plan meet.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let apart = |i: usize| a[i].max(b[i]) < c[i].min(d[i]) || c[i].max(d[i]) < a[i].min(b[i]);
    !apart(0) && !apart(1) && side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

/// Distance of a point from a segment in plan, mm.
fn from_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let share = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / square.max(f64::MIN_POSITIVE);
    let share = share.clamp(0.0, 1.0);
    libm::hypot(p[0] - a[0] - share * along[0], p[1] - a[1] - share * along[1])
}

/// Where passes may run.
#[derive(Default)]
pub struct Region<'a> {
    /// The edges that they stay between.
    pub boundary: Option<Boundary>,
    /// The least and the greatest slope of contacts, rad.
    pub slopes: Option<[f64; 2]>,
    /// The envelopes of the tool's solids, grown by the clearance, on the check faces.
    pub checks: Vec<Envelope<'a>>,
}

/// The exact point over the middle of two others, if there is one.
pub(crate) trait Between: FnMut(&PathPoint, &PathPoint) -> Option<PathPoint> {}
impl<F: FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>> Between for F {}

impl Region<'_> {
    /// Whether the tool may touch with this normal, its tip at a position; `envelope` is the part's.
    #[must_use]
    pub fn allows(&self, envelope: &Envelope<'_>, tip: Vector, normal: Vector) -> bool {
        let slope = || libm::atan2(libm::hypot(normal.x, normal.y), normal.z);
        let is_between = |[least, most]: [f64; 2]| (least - SAME_SLOPE..=most + SAME_SLOPE).contains(&slope());
        self.slopes.is_none_or(is_between)
            && self.boundary.as_ref().is_none_or(|boundary| boundary.allows(boundary.position(envelope, tip, normal)))
            && !self.checks.iter().any(|check| check.is_over(tip.x, tip.y, tip.z, &mut None))
    }

    /// Whether it may end between two points of a path that it allows.
    pub(crate) fn may_end_between(&self, envelope: &Envelope<'_>, a: &PathPoint, b: &PathPoint) -> bool {
        let leaves = |boundary: &Boundary| {
            let [a, b] = [a, b].map(|point| boundary.position(envelope, point.tip, point.normal));
            boundary.may_end_on(a, b)
        };
        self.boundary.as_ref().is_some_and(leaves) || self.may_be_near([a.tip, b.tip])
    }

    /// Whether the tool may come too near to check faces on the straight line between two tips, its ends included.
    pub(crate) fn may_be_near(&self, line: [Vector; 2]) -> bool {
        let is_over = |check: &Envelope<'_>, tip: Vector| check.is_over(tip.x, tip.y, tip.z + GRAZES, &mut None);
        let comes_near = |check: &Envelope<'_>| match check.keeps_under(line, GRAZES, |_| GRAZES) {
            Keeping::Under => false,
            Keeping::Over => true,
            Keeping::Crowded => (line[1] - line[0]).norm() > NARROW || line.iter().any(|tip| is_over(check, *tip)),
        };
        self.checks.iter().any(comes_near)
    }

    /// Whether it may begin between two points of a path that it does not allow: between edges in plan. What else it allows between
    /// them is narrower than they are apart.
    fn may_begin_between(&self, envelope: &Envelope<'_>, a: &PathPoint, b: &PathPoint) -> bool {
        self.boundary.as_ref().filter(|boundary| boundary.inside != Inside::Tool).is_some_and(|boundary| {
            let [a, b] = [a, b].map(|point| boundary.position(envelope, point.tip, point.normal));
            boundary.may_end_on(a, b)
        })
    }

    /// The stretches of a line of exact points in which it allows the tool, cut to [`CUT`], and whether each is closed. A closed line
    /// repeats its first point at its end.
    pub(crate) fn stretches(
        &self,
        envelope: &Envelope<'_>,
        points: &[PathPoint],
        closed: bool,
        mut between: impl Between,
    ) -> Vec<(Vec<PathPoint>, bool)> {
        let allows = |point: &PathPoint| self.allows(envelope, point.tip, point.normal);
        let dense = self.refined(envelope, points, &mut between);
        let is_whole = dense.iter().all(allows);
        let runs = fitting::runs_where((allows, CUT), &dense, closed, between);
        runs.into_iter().map(|run| (run, closed && is_whole)).collect()
    }

    /// The same points with more between those where the region may end unseen.
    fn refined(&self, envelope: &Envelope<'_>, points: &[PathPoint], between: &mut impl Between) -> Vec<PathPoint> {
        let allows = |point: &PathPoint| self.allows(envelope, point.tip, point.normal);
        let mut dense: Vec<PathPoint> = points.first().copied().into_iter().collect();
        for pair in points.windows(2) {
            let mut open = vec![pair[1]];
            let mut at = pair[0];
            while let Some(end) = open.pop() {
                let is_short = (end.tip - at.tip).norm() <= FINE;
                let is_seen = || match [allows(&at), allows(&end)] {
                    [true, true] => !self.may_end_between(envelope, &at, &end),
                    [false, false] => !self.may_begin_between(envelope, &at, &end),
                    [true, false] | [false, true] => (end.tip - at.tip).norm() <= NARROW,
                };
                let middle = if is_short || is_seen() { None } else { between(&at, &end) };
                match middle.filter(|middle| fitting::divides(middle, &at, &end)) {
                    Some(middle) => open.extend([end, middle]),
                    None => {
                        dense.push(end);
                        at = end;
                    }
                }
            }
        }
        dense
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64) -> Vec<[[f64; 2]; 2]> {
        let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
        (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).collect()
    }

    #[test]
    fn a_loop_inside_another_is_an_island() {
        let edges = [square(10.0), square(2.0)].concat();
        let boundary = Boundary::new(edges, Inside::Centre, 3.0);
        for (x, inside) in [(0.0, false), (1.9, false), (2.1, true), (9.9, true), (10.1, false)] {
            assert_eq!(boundary.allows([x, 0.3]), inside, "{x}");
        }
        assert!(boundary.may_end_on([-5.0, 0.0], [5.0, 0.0]) && !boundary.may_end_on([-5.0, 4.0], [5.0, 4.0]));
    }

    #[test]
    fn a_whole_tool_stays_its_radius_inside() {
        let boundary = Boundary::new(square(10.0), Inside::Tool, 3.0);
        for (x, inside) in [(6.9, true), (7.1, false), (13.5, false)] {
            assert_eq!(boundary.allows([x, 0.0]), inside, "{x}");
        }
        assert!((boundary.distance([0.0, 0.0], [0.0, 4.0]) - 6.0).abs() < 1e-12);
    }
}

//! Chords instead of curves: as few points as the tolerance allows, on either side of the exact path.
//!
//! The exact path lies on an envelope that keeps half of what is left for fitting as its margin, so
//! that a chord may deviate by that much to either side and still neither gouges nor leaves too much.
//!
//! Witnesses, exact points, are put in until the path between neighbours is proven to deviate little, or where that cannot
//! be proven, deviates little at points close by; then those are left out over which a longer chord passes closely. What a
//! final chord deviates is at most the sum of both.
//!
//! The proofs are derived in docs/concepts/fitting.md.

use crate::PathPoint;
use styluscam_geometry::Vector;

/// Share of the deviation within which the path stays at the middle between two witnesses. Where it has a kink beside
/// the middle, it deviates twice as much.
const BETWEEN_WITNESSES: f64 = 0.2;
/// Share of the deviation within which the path is proven to stay between two witnesses.
pub const PROVEN: f64 = 2.0 * BETWEEN_WITNESSES;
/// The rest: how far a witness may lie beside a chord.
pub const AT_WITNESSES: f64 = 1.0 - PROVEN;
/// A smooth path deviates half as much as its tangents lead beside the ends of a chord; where that is more than could be proven,
/// no proof is tried.
const TOO_BENT: f64 = 2.2;
/// Least share of a distance in any direction that counts as deviation.
pub const ASIDE: f64 = 0.25;
/// What a path that crosses its chord aslant at the middle deviates on both sides, as a share of what it would reach at
/// the chord's end: 0.19 where it is a cubic, up to 0.5 where it bends at once.
const ASLANT: f64 = 0.35;
/// Chords are not divided below this length in plan, mm: a kink is cut by less than a controller resolves.
const SHORTEST: f64 = 1e-4;
/// What is seen to rise between two points no farther apart is passed over, mm: there they may touch a wall by rounding.
const HIDDEN: f64 = 0.01;
/// Chords are not divided for their angle below this length, mm: there the path has an edge.
pub const EDGE: f64 = 0.02;
/// The border of the selected faces is found to this, mm.
pub const BORDER: f64 = 1e-3;

/// The exact path that chords are fitted to.
pub trait Course {
    /// The exact point over the middle of two others, or none where there is none.
    fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint>;

    /// Whether all of the path between two of its points is known to deviate by no more than `most` mm from the chord.
    fn keeps_to(&self, _a: &PathPoint, _b: &PathPoint, _most: f64) -> bool {
        false
    }

    /// Largest angle by which it turns between two witnesses where it is smooth, rad.
    fn bend(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether the path between two of its points is seen to rise over the chord by more than `most` mm, or that cannot be
    /// excluded.
    fn may_rise(&self, _a: &PathPoint, _b: &PathPoint, _most: f64) -> bool {
        false
    }
}

/// A path of which single points are known.
impl<F: FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>> Course for F {
    fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        self(a, b)
    }
}

/// The same, which turns by no more than `bend` rad between two witnesses where it is smooth.
pub struct Bending<F> {
    /// The exact point over the middle of two others.
    pub between: F,
    /// rad.
    pub bend: f64,
}

impl<F: FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>> Course for Bending<F> {
    fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        (self.between)(a, b)
    }

    fn bend(&self) -> f64 {
        self.bend
    }
}

/// Adds exact points between those given, dense enough for [`thinned`] to keep chords within `deviation` mm of the path,
/// and in plan no farther apart than `longest` mm where nothing is proven: there what is narrower may be missed.
///
/// Where the course has no middle to keep to, a run ends; what follows is another. The middles are kept: they are witnesses.
pub fn densified(points: &[PathPoint], deviation: f64, longest: f64, course: &mut impl Course) -> Vec<Vec<PathPoint>> {
    let Some(first) = points.first() else { return Vec::new() };
    let mut runs = Vec::new();
    let mut run = vec![*first];
    let mut pending = Vec::new();
    for end in &points[1..] {
        pending.push(*end);
        while let Some(b) = pending.pop() {
            let a = run[run.len() - 1];
            let length = (b.tip - a.tip).xy().norm();
            let is_long = (b.tip - a.tip).norm() > EDGE;
            let is_known = || {
                may_keep_to(&a, &b, PROVEN * deviation)
                    && !(is_long && turn(&a, &b) > course.bend())
                    && course.keeps_to(&a, &b, PROVEN * deviation)
            };
            if length <= SHORTEST || is_known() {
                run.push(b);
                continue;
            }
            match course.between(&a, &b).filter(|m| divides(m, &a, &b)) {
                Some(m)
                    if (is_long && angle(&(m.tip - a.tip), &(b.tip - m.tip)) > course.bend())
                        || 0.5 * length > longest
                        || deviation_around(&a, &m, &b) > BETWEEN_WITNESSES * deviation =>
                {
                    pending.extend([b, m]);
                }
                // what hides between two points is looked for in ever smaller pieces
                Some(m)
                    if length > HIDDEN
                        && (course.may_rise(&a, &m, PROVEN * deviation)
                            || course.may_rise(&m, &b, PROVEN * deviation)) =>
                {
                    pending.extend([b, m]);
                }
                Some(m) => run.extend([m, b]),
                None => runs.push(std::mem::replace(&mut run, vec![b])),
            }
        }
    }
    runs.push(run);
    runs.retain(|run| run.len() > 1);
    runs
}

/// By how much a smooth path in a vertical plane turns between two of its points, rad, as their normals show.
fn turn(a: &PathPoint, b: &PathPoint) -> f64 {
    let along = b.tip - a.tip;
    let Some(level) = Vector::new(along.x, along.y, 0.0).try_normalize(f64::MIN_POSITIVE) else { return 0.0 };
    let at = |point: &PathPoint| {
        let in_plane = libm::hypot(level.dot(&point.normal), point.normal.z);
        libm::asin((along.dot(&point.normal).abs() / (along.norm() * in_plane)).min(1.0))
    };
    at(a) + at(b)
}

/// Whether a point is nearer in plan to both ends than they are to each other: dividing there comes to an end.
pub fn divides(m: &PathPoint, a: &PathPoint, b: &PathPoint) -> bool {
    let whole = 0.95 * (b.tip - a.tip).xy().norm();
    (m.tip - a.tip).xy().norm() < whole && (b.tip - m.tip).xy().norm() < whole
}

/// Whether a proof that the path between two points keeps to within `most` mm of the chord is worth trying.
pub fn may_keep_to(a: &PathPoint, b: &PathPoint, most: f64) -> bool {
    bend(a, b) <= TOO_BENT * most
}

/// What a distance of `most` mm along the normals of two points, as [`deviation_at`] measures it, is in height.
pub fn in_height(a: &PathPoint, b: &PathPoint, most: f64) -> f64 {
    most / a.normal.z.max(b.normal.z).max(ASIDE)
}

/// Leaves out witnesses as long as the path between stays within `deviation` mm of the chord. Ends are kept.
///
/// How many a chord may pass is looked for in doubled, then in halved steps; what it passes is looked at whole each time.
pub fn thinned(points: &[PathPoint], deviation: f64) -> Vec<PathPoint> {
    let Some(first) = points.first() else { return Vec::new() };
    let mut out = vec![*first];
    let mut from = 0;
    while from + 1 < points.len() {
        let to = chord_end(points, from, points[from].tip, deviation);
        out.push(points[to]);
        from = to;
    }
    out
}

/// The angle between two directions, rad.
pub fn angle(a: &Vector, b: &Vector) -> f64 {
    libm::atan2(a.cross(b).norm(), a.dot(b))
}

/// The number of the farthest witness, at least the next one, to which a chord from `start`, at or beside the witness `from`, may
/// go.
pub fn chord_end(points: &[PathPoint], from: usize, start: Vector, deviation: f64) -> usize {
    farthest(from + 1, points.len(), 1, |to| {
        let mut passed = points[from + 1..to].iter();
        passed.all(|p| deviation_at(p, start, points[to].tip) <= AT_WITNESSES * deviation)
    })
}

/// The farthest number before `beyond` that passes, looked for in steps that are doubled from the first one on, then in halved ones;
/// at least `known`, of which that is known.
pub fn farthest(known: usize, beyond: usize, first_step: usize, mut passes: impl FnMut(usize) -> bool) -> usize {
    let (mut to, mut beyond, mut step) = (known, beyond, first_step);
    while to + step < beyond {
        if passes(to + step) {
            to += step;
            step *= 2;
        } else {
            beyond = to + step;
        }
    }
    while beyond - to > 1 {
        let middle = usize::midpoint(to, beyond);
        if passes(middle) {
            to = middle;
        } else {
            beyond = middle;
        }
    }
    to
}

/// The runs of selected points, their ends moved to the border of the selection.
///
/// `between` gives the exact point over the middle of two others, asked in the order of the points.
/// `closed` points repeat the first at the end; a run across the seam is joined. One run of all points comes
/// back as it is.
pub fn selected_runs(
    points: &[PathPoint],
    closed: bool,
    between: impl FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>,
) -> Vec<Vec<PathPoint>> {
    runs_where((|point: &PathPoint| point.selected, BORDER), points, closed, between)
}

/// As [`selected_runs`], of the points for which something holds; ends are moved to within `fine` mm of where it ceases to.
pub fn runs_where(
    (holds, fine): (impl Fn(&PathPoint) -> bool, f64),
    points: &[PathPoint],
    closed: bool,
    mut between: impl FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>,
) -> Vec<Vec<PathPoint>> {
    if points.iter().all(&holds) {
        return vec![points.to_vec()];
    }
    let turned = if closed { from_a_gap(points, &holds) } else { points.to_vec() };
    let mut runs: Vec<Vec<PathPoint>> = Vec::new();
    let mut run = Vec::new();
    for (i, point) in turned.iter().enumerate() {
        if holds(point) {
            if run.is_empty() && i > 0 {
                run.push(border((&holds, fine), point, &turned[i - 1], |inside, outside| between(outside, inside)));
            }
            run.push(*point);
        } else if !run.is_empty() {
            run.push(border((&holds, fine), &turned[i - 1], point, &mut between));
            runs.push(std::mem::take(&mut run));
        }
    }
    runs.push(run);
    runs.retain(|run| run.len() > 1);
    runs
}

/// The closed polyline begun at a point for which something does not hold.
fn from_a_gap(points: &[PathPoint], holds: impl Fn(&PathPoint) -> bool) -> Vec<PathPoint> {
    let ring = &points[..points.len() - 1];
    let gap = ring.iter().position(|p| !holds(p)).unwrap_or(0);
    let mut turned: Vec<PathPoint> = ring[gap..].iter().chain(&ring[..gap]).copied().collect();
    turned.push(ring[gap]);
    turned
}

/// The last point on the path from `inside` to `outside` for which something holds, to within `fine` mm; `between` is asked in
/// this order.
fn border(
    (holds, fine): (impl Fn(&PathPoint) -> bool, f64),
    inside: &PathPoint,
    outside: &PathPoint,
    mut between: impl FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>,
) -> PathPoint {
    let (mut inside, mut outside) = (*inside, *outside);
    while (outside.tip - inside.tip).norm() > fine {
        match between(&inside, &outside).filter(|m| divides(m, &inside, &outside)) {
            Some(middle) if holds(&middle) => inside = middle,
            Some(middle) => outside = middle,
            None => outside.tip = (inside.tip + outside.tip) * 0.5,
        }
    }
    inside
}

/// How far a chord passes beside an exact point, along the point's normal; at least a quarter of its distance in any
/// direction, so that it neither cuts a step nor drifts far over gentle ground.
///
/// The two are compared at the same position in plan: there the tool stands over the one and over the other.
fn deviation_at(exact: &PathPoint, a: Vector, b: Vector) -> f64 {
    let chord = b - a;
    let run = chord.xy().norm_squared();
    let share = if run > 0.0 { ((exact.tip - a).xy().dot(&chord.xy()) / run).clamp(0.0, 1.0) } else { 0.0 };
    counted(exact.tip - a - chord * share, &exact.normal)
}

/// How much of a distance counts as deviation at a contact with this normal.
pub fn counted(aside: Vector, normal: &Vector) -> f64 {
    aside.dot(normal).abs().max(ASIDE * aside.norm())
}

/// How far a path with the exact middle `m` deviates from a chord, at the middle or beside it.
fn deviation_around(a: &PathPoint, m: &PathPoint, b: &PathPoint) -> f64 {
    let aslant = ASLANT * (b.tip - a.tip).dot(&m.normal).abs();
    deviation_at(m, a.tip, b.tip).max(aslant).max(bend(a, m)).max(bend(m, b))
}

/// How far a path deviates from the chord between two of its points, as far as their normals show: where tangents meet at
/// the middle, it is half as far as one tangent leads beside the other end.
fn bend(a: &PathPoint, b: &PathPoint) -> f64 {
    let along = b.tip - a.tip;
    0.5 * along.dot(&a.normal).abs().max(along.dot(&b.normal).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, z: f64, selected: bool) -> PathPoint {
        PathPoint { tip: Vector::new(x, 0.0, z), normal: Vector::z(), selected, triangle: 0 }
    }

    fn parabola(a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        let x = 0.5 * (a.tip.x + b.tip.x);
        Some(point(x, 0.1 * x * x, x < 2.0))
    }

    #[test]
    fn chords_stay_within_the_deviation_and_are_few() {
        let ends = [point(-3.0, 0.9, true), point(3.0, 0.9, true)];
        let dense = densified(&ends, 1e-3, f64::INFINITY, &mut { parabola });
        assert_eq!(dense.len(), 1);
        let thin = thinned(&dense[0], 1e-3);
        for pair in thin.windows(2) {
            // the sagitta of z = 0.1 x^2 over a chord of length c is 0.1 c^2 / 4
            let chord = pair[1].tip.x - pair[0].tip.x;
            assert!(0.1 * chord * chord / 4.0 <= 1.001e-3, "{chord}");
        }
        assert!(thin.len() < 45, "{}", thin.len());
    }

    #[test]
    fn a_middle_that_lies_elsewhere_ends_the_run() {
        let ends = [point(0.0, 0.0, true), point(1.0, 0.0, false)];
        let mut elsewhere = |_: &PathPoint, _: &PathPoint| Some(point(5.0, 7.0, true));
        assert!(densified(&ends, 1e-3, f64::INFINITY, &mut elsewhere).is_empty());
        assert_eq!(selected_runs(&ends, false, elsewhere).len(), 1);
    }

    #[test]
    fn a_chord_without_a_middle_parts_the_run() {
        let points: Vec<PathPoint> = (0..5).map(|i| point(f64::from(i), 0.0, true)).collect();
        let mut torn = |a: &PathPoint, b: &PathPoint| {
            parabola(a, b).filter(|m| (m.tip.x - 1.5).abs() > 0.1).map(|m| point(m.tip.x, 0.0, true))
        };
        let runs = densified(&points, 1e-3, f64::INFINITY, &mut torn);
        let ends: Vec<[f64; 2]> = runs.iter().map(|run| [run[0].tip.x, run[run.len() - 1].tip.x]).collect();
        assert_eq!(ends, [[0.0, 1.0], [2.0, 4.0]]);
    }

    #[test]
    fn runs_end_at_the_border_of_the_selection() {
        let points: Vec<PathPoint> =
            (0..8).map(|i| f64::from(i) - 3.0).map(|x| point(x, 0.1 * x * x, x < 2.0)).collect();
        let runs = selected_runs(&points, false, parabola);
        assert_eq!(runs.len(), 1);
        assert!((runs[0].last().unwrap().tip.x - 2.0).abs() < 2e-3);
    }

    #[test]
    fn a_step_is_not_cut() {
        let mut step = |a: &PathPoint, b: &PathPoint| {
            let x = 0.5 * (a.tip.x + b.tip.x);
            Some(point(x, if x < 0.3 { 0.0 } else { 20.0 }, true))
        };
        let dense = densified(&[point(0.0, 0.0, true), point(1.0, 20.0, true)], 1e-3, f64::INFINITY, &mut step);
        assert_eq!(dense.len(), 1);
        for pair in thinned(&dense[0], 1e-3).windows(2) {
            let climbs = pair[1].tip.z - pair[0].tip.z > 1e-3;
            assert!(!climbs || pair[1].tip.x - pair[0].tip.x < 2.0 * SHORTEST);
        }
    }

    #[test]
    fn a_run_across_the_seam_of_a_loop_is_one() {
        let ring = [(0.0, true), (1.0, true), (2.0, false), (1.0, true), (0.0, true)];
        let points: Vec<PathPoint> = ring.iter().map(|(x, on)| point(*x, 0.0, *on)).collect();
        let runs = selected_runs(&points, true, |_, _| None);
        assert_eq!(runs.len(), 1);
    }
}

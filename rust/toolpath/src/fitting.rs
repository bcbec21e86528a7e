//! Chords instead of curves: as few points as the tolerance allows, on either side of the exact path.
//!
//! The exact path lies on an envelope that keeps half of what is left for fitting as its margin, so
//! that a chord may stray by that much to either side and still neither gouges nor leaves too much.

use crate::PathPoint;
use styluscam_geometry::Vector;

/// Chords are not divided below this length in plan, mm: a kink is cut by less than a controller resolves.
const SHORTEST: f64 = 1e-4;
/// The border of the selected faces is found to this, mm.
const BORDER: f64 = 1e-3;
/// Points that one chord may pass over: bounds the work on long straight runs.
const PASSED: usize = 512;

/// Adds exact points between those given until every chord's middle is within `deviation` of the exact path.
///
/// `between` gives the exact point over the middle of two others, or none where there is none.
/// The middles are kept: they are the witnesses of [`thinned`].
pub fn densified(
    points: &[PathPoint],
    deviation: f64,
    mut between: impl FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>,
) -> Vec<PathPoint> {
    let Some(first) = points.first() else { return Vec::new() };
    let mut out = vec![*first];
    let mut pending = Vec::new();
    for end in &points[1..] {
        pending.push(*end);
        while let Some(b) = pending.pop() {
            let a = out[out.len() - 1];
            let middle = if (b.tip - a.tip).xy().norm() > SHORTEST { between(&a, &b) } else { None };
            match middle {
                Some(m) if stray(&m, a.tip, b.tip) > deviation => pending.extend([b, m]),
                Some(m) => out.extend([m, b]),
                None => out.push(b),
            }
        }
    }
    out
}

/// Leaves out points as long as all that a chord passes over stay within `deviation` of it. Ends are kept.
pub fn thinned(points: &[PathPoint], deviation: f64) -> Vec<PathPoint> {
    let Some(first) = points.first() else { return Vec::new() };
    let mut out = vec![*first];
    let mut from = 0;
    while from + 1 < points.len() {
        let mut to = from + 1;
        while to + 1 < points.len() && to - from < PASSED {
            let passed = &points[from + 1..=to];
            if passed.iter().any(|p| stray(p, points[from].tip, points[to + 1].tip) > deviation) {
                break;
            }
            to += 1;
        }
        out.push(points[to]);
        from = to;
    }
    out
}

/// The runs of selected points, their ends moved to the border of the selection.
///
/// `closed` points repeat the first at the end; a run across the seam is joined. One run of all points comes
/// back as it is.
pub fn selected_runs(
    points: &[PathPoint],
    closed: bool,
    mut between: impl FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>,
) -> Vec<Vec<PathPoint>> {
    if points.iter().all(|p| p.selected) {
        return vec![points.to_vec()];
    }
    let turned = if closed { from_a_gap(points) } else { points.to_vec() };
    let mut runs: Vec<Vec<PathPoint>> = Vec::new();
    let mut run = Vec::new();
    for (i, point) in turned.iter().enumerate() {
        if point.selected {
            if run.is_empty() && i > 0 {
                run.push(border(point, &turned[i - 1], &mut between));
            }
            run.push(*point);
        } else if !run.is_empty() {
            run.push(border(&turned[i - 1], point, &mut between));
            runs.push(std::mem::take(&mut run));
        }
    }
    runs.push(run);
    runs.retain(|run| run.len() > 1);
    runs
}

/// The closed polyline begun at a point that is not selected.
fn from_a_gap(points: &[PathPoint]) -> Vec<PathPoint> {
    let ring = &points[..points.len() - 1];
    let gap = ring.iter().position(|p| !p.selected).unwrap_or(0);
    let mut turned: Vec<PathPoint> = ring[gap..].iter().chain(&ring[..gap]).copied().collect();
    turned.push(ring[gap]);
    turned
}

/// The last selected point on the way from `inside` to `outside`.
fn border(
    inside: &PathPoint,
    outside: &PathPoint,
    between: &mut impl FnMut(&PathPoint, &PathPoint) -> Option<PathPoint>,
) -> PathPoint {
    let (mut inside, mut outside) = (*inside, *outside);
    while (outside.tip - inside.tip).norm() > BORDER {
        match between(&inside, &outside) {
            Some(middle) if middle.selected => inside = middle,
            Some(middle) => outside = middle,
            None => break,
        }
    }
    inside
}

/// How far a chord passes beside an exact point, along the point's normal.
fn stray(exact: &PathPoint, a: Vector, b: Vector) -> f64 {
    let chord = b - a;
    let length = chord.norm_squared();
    let share = if length > 0.0 { ((exact.tip - a).dot(&chord) / length).clamp(0.0, 1.0) } else { 0.0 };
    (exact.tip - a - chord * share).dot(&exact.normal).abs()
}

//! Arcs through corners of polygons that are chords of arcs.

use super::polygons::Point;

/// Corners are at most this far off the arcs that take their place, mm.
const OFF: f64 = 5e-4;
/// Arcs stand out over their chords by less than this, mm.
const OUT: f64 = 1e-3;
/// Headings of chords and of what takes their place differ by less than this, rad: the engagement changes by as much.
const TURNED: f64 = 6e-3;
/// What corners are off by that thinning moved and the grid rounded, mm.
const NOISE: f64 = 1.8e-4;
/// Larger circles are lines, mm.
const LARGEST: f64 = 1e4;
/// An arc turns by less than this, rad: a longer one would be found by its middle less well.
const MOST: f64 = 3.0;

/// A path of chords as points with bulges.
pub fn arcs(points: &[Point]) -> Vec<[f64; 3]> {
    let mut fitted = Vec::new();
    let mut from = 0;
    while from + 1 < points.len() {
        let (to, bulge) = longest(points, from);
        if let Some([x, y]) = points.get(from) {
            fitted.push([*x, *y, bulge]);
        }
        from = to;
    }
    if let Some([x, y]) = points.last() {
        fitted.push([*x, *y, 0.0]);
    }
    fitted
}

/// The farthest corner up to which one line or arc goes, and its bulge.
fn longest(points: &[Point], from: usize) -> (usize, f64) {
    let (mut good, mut best) = (from + 1, 0.0);
    let (mut step, mut to) = (1, from + 2);
    // doubling steps forward, then halving them: n log n
    loop {
        let bulge = points.get(from..=to).and_then(one_piece);
        if let Some(bulge) = bulge {
            (good, best) = (to, bulge);
            step *= 2;
        } else if step <= 1 {
            break;
        } else {
            step /= 2;
            if to == good + 1 {
                break;
            }
        }
        to = good + step.max(1);
        if to >= points.len() && step > 1 {
            step = (points.len() - good).max(2) / 2;
            to = good + step.max(1);
        }
        if to >= points.len() {
            break;
        }
    }
    (good, best)
}

/// The bulge of the line or arc that all corners lie on.
fn one_piece(points: &[Point]) -> Option<f64> {
    let (first, last) = (*points.first()?, *points.last()?);
    let middle = *points.get(points.len() / 2)?;
    if points.iter().all(|p| off_line(*p, first, last) < OFF) && keeps_heading(points) {
        return Some(0.0);
    }
    let (centre, radius) = circle([first, middle, last])?;
    if radius > LARGEST {
        return None;
    }
    let mut turned = 0.0;
    let mut sign = 0.0;
    for pair in points.windows(2) {
        let [a, b] = pair else { continue };
        let arms = [a, b].map(|p| [p[0] - centre[0], p[1] - centre[1]]);
        let half = [0.5 * (arms[0][0] + arms[1][0]), 0.5 * (arms[0][1] + arms[1][1])];
        let turn = libm::atan2(
            arms[0][0] * arms[1][1] - arms[0][1] * arms[1][0],
            arms[0][0] * arms[1][0] + arms[0][1] * arms[1][1],
        );
        let off = (libm::hypot(arms[1][0], arms[1][1]) - radius).abs();
        let off_half = radius - libm::hypot(half[0], half[1]);
        // the tangent in the chord's middle, in the arc's sense
        let tangent = if turn > 0.0 { [-half[1], half[0]] } else { [half[1], -half[0]] };
        if !agrees([b[0] - a[0], b[1] - a[1]], tangent) || off > OFF || off_half.abs() > OUT || turn * sign < 0.0 {
            return None;
        }
        sign = turn;
        turned += turn;
    }
    // a single turn to the right is a joint of two arcs, where the heading jumps: an arc's would go past both
    if sign < 0.0 && points.len() < 5 {
        return None;
    }
    (turned.abs() < MOST).then(|| libm::tan(0.25 * turned))
}

/// Whether all chords have the heading of the line from the first corner to the last.
fn keeps_heading(points: &[Point]) -> bool {
    let (Some(a), Some(b)) = (points.first(), points.last()) else { return false };
    let along = [b[0] - a[0], b[1] - a[1]];
    points.windows(2).all(|pair| match pair {
        [p, q] => agrees([q[0] - p[0], q[1] - p[1]], along),
        _ => true,
    })
}

/// Whether a chord has a heading, as far as one so short shows it.
fn agrees(chord: Point, heading: Point) -> bool {
    let sin = chord[0] * heading[1] - chord[1] * heading[0];
    let cos = chord[0] * heading[0] + chord[1] * heading[1];
    let turned = TURNED + NOISE / libm::hypot(chord[0], chord[1]);
    cos > 0.0 && sin.abs() < turned * cos
}

fn off_line(p: Point, a: Point, b: Point) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = libm::hypot(along[0], along[1]);
    if length <= 0.0 {
        return libm::hypot(p[0] - a[0], p[1] - a[1]);
    }
    ((p[0] - a[0]) * along[1] - (p[1] - a[1]) * along[0]).abs() / length
}

/// Centre and radius of the circle through three points.
fn circle([a, b, c]: [Point; 3]) -> Option<(Point, f64)> {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let area = 2.0 * (u[0] * v[1] - u[1] * v[0]);
    let (uu, vv) = (u[0] * u[0] + u[1] * u[1], v[0] * v[0] + v[1] * v[1]);
    let arm = [(v[1] * uu - u[1] * vv) / area, (u[0] * vv - v[0] * uu) / area];
    let radius = libm::hypot(arm[0], arm[1]);
    radius.is_finite().then_some(([a[0] + arm[0], a[1] + arm[1]], radius))
}

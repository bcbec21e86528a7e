//! Circles through given points that pass closely by a polyline.
//!
//! A circle a (x^2 + y^2) + b x + c y = 0 passes through the origin; with b^2 + c^2 = 1 the left side is the distance from it,
//! to first order, and a = 0 is a line (V. Pratt, "Direct least-squares fitting of algebraic surfaces", Computer Graphics 21,
//! 1987). The smallest sum of its squares is an eigenvector's. Derived in docs/concepts/fitting.md.

/// A position in a plane, mm.
pub type Position = [f64; 2];

/// Larger circles are lines, mm: controllers read centres of five digits before the point (FANUC: eight digits, three decimals), and
/// this leaves one for the position.
const LARGEST: f64 = 1e4;

/// Centre, from `start`, of the circle through `start` that passes by a polyline most closely; none of a line.
pub fn through(start: Position, polyline: impl Iterator<Item = Position>) -> Option<Position> {
    let (mut rr, mut rx, mut ry, mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for ([x, y], weight) in samples(start, polyline) {
        let r = x * x + y * y;
        rr += weight * r * r;
        rx += weight * r * x;
        ry += weight * r * y;
        xx += weight * x * x;
        xy += weight * x * y;
        yy += weight * y * y;
    }
    if rr <= 0.0 {
        return None;
    }
    // the best `a` for any b and c is put in
    let [b, c] = least([xx - rx * rx / rr, xy - rx * ry / rr, yy - ry * ry / rr]);
    let a = -(b * rx + c * ry) / rr;
    bounded([-0.5 * b / a, -0.5 * c / a])
}

/// Centre, from `start`, of the circle through `start` and `end` that passes by a polyline most closely; none of a line, and where
/// both are one.
pub fn between(start: Position, end: Position, polyline: impl Iterator<Item = Position>) -> Option<Position> {
    let chord = [end[0] - start[0], end[1] - start[1]];
    let length = libm::hypot(chord[0], chord[1]);
    if length <= 0.0 {
        return None;
    }
    let along = [chord[0] / length, chord[1] / length];
    let (mut pp, mut py, mut yy) = (0.0, 0.0, 0.0);
    for (from, weight) in samples(start, polyline) {
        let x = from[0] * along[0] + from[1] * along[1];
        let y = along[0] * from[1] - along[1] * from[0];
        // in the chord's frame b is -a length
        let p = (x * x + y * y) / length - x;
        pp += weight * p * p;
        py += weight * p * y;
        yy += weight * y * y;
    }
    let [a, c] = least([pp, py, yy]);
    let (x, y) = (0.5 * length, -0.5 * c * length / a);
    bounded([x * along[0] - y * along[1], x * along[1] + y * along[0]])
}

/// Points of a polyline from a `start`, each with what it stands for of the length: by Simpson's rule.
fn samples(start: Position, polyline: impl Iterator<Item = Position>) -> impl Iterator<Item = (Position, f64)> {
    let mut before: Option<Position> = None;
    polyline.flat_map(move |[x, y]| {
        let point = [x - start[0], y - start[1]];
        let last = before.replace(point).unwrap_or(point);
        let sixth = libm::hypot(point[0] - last[0], point[1] - last[1]) / 6.0;
        let middle = [0.5 * (last[0] + point[0]), 0.5 * (last[1] + point[1])];
        [(last, sixth), (middle, 4.0 * sixth), (point, sixth)]
    })
}

/// The unit vector for which the form xx, xy, yy is least.
fn least([xx, xy, yy]: [f64; 3]) -> [f64; 2] {
    let (sin, cos) = libm::sincos(0.5 * libm::atan2(2.0 * xy, xx - yy));
    [-sin, cos]
}

fn bounded(centre: Position) -> Option<Position> {
    let radius = libm::hypot(centre[0], centre[1]);
    (radius > 0.0 && radius < LARGEST).then_some(centre)
}

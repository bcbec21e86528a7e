//! Closed contours of corners: their sides, boxes and areas, and circles as such.

use std::f64::consts::TAU;

/// A position, mm.
pub type Point = [f64; 2];

/// The sides of a closed contour.
pub fn sides(contour: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    contour.iter().copied().zip(contour.iter().copied().cycle().skip(1))
}

/// Corners of the smallest upright box around points; None where there is none.
pub fn bounds<'a>(mut points: impl Iterator<Item = &'a Point>) -> Option<[Point; 2]> {
    let first = *points.next()?;
    Some(points.fold([first, first], |[low, high], p| {
        [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
    }))
}

/// mm^2, below 0 clockwise.
pub fn signed_area(contour: &[Point]) -> f64 {
    0.5 * sides(contour).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}

/// Angle of the chords that are `tolerance` off an arc of `radius`, rad.
pub fn arc_step(radius: f64, tolerance: f64) -> f64 {
    let cos = (1.0 - tolerance / radius.max(tolerance)).clamp(-1.0, 1.0);
    (2.0 * libm::acos(cos)).clamp(1e-3, 0.5)
}

/// A circle as a contour whose sides touch it from inside.
pub fn circle(centre: Point, radius: f64, tolerance: f64) -> Vec<Point> {
    let count = libm::ceil(TAU / arc_step(radius, tolerance)).max(8.0) as usize;
    let corner = |i: usize| {
        let (sin, cos) = libm::sincos(i as f64 / count as f64 * TAU);
        [centre[0] + radius * cos, centre[1] + radius * sin]
    };
    (0..count).map(corner).collect()
}

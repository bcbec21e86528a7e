//! Random single triangles, and positions to stand the tool at: all that is hard for a drop-cutter.

use std::f64::consts::TAU;

use styluscam_geometry::Vector;

use super::dice::Dice;

/// Where triangles stand that a tool of up to 32 mm does not meet together.
pub const SPOTS: [[f64; 2]; 4] = [[-160.0, -160.0], [160.0, -160.0], [-160.0, 160.0], [160.0, 160.0]];

/// A triangle with an area at a spot.
pub fn at(spot: [f64; 2], dice: &mut Dice) -> [Vector; 3] {
    let off = Vector::new(spot[0], spot[1], if dice.chance(0.5) { dice.within(-100.0, 100.0) } else { 0.0 });
    loop {
        let corners = triangle(dice).map(|p| p + off);
        let [a, b, c] = corners;
        if (b - a).cross(&(c - a)).norm() > 0.0 {
            return corners;
        }
    }
}

/// A triangle of 0.001 to 100 mm about the origin: any, slivers, walls, level and nearly level ones, steep ones, on a grid.
fn triangle(dice: &mut Dice) -> [Vector; 3] {
    let size = dice.scale(1e-3, 100.0);
    let mut corners = [(); 3].map(|()| direction(dice) * size);
    let [a, b, c] = &mut corners;
    match dice.below(10) {
        0 => {
            // three corners nearly in a line
            let off = direction(dice) * (size * dice.scale(1e-9, 1e-2));
            *c = *a + (*b - *a) * dice.within(-0.2, 1.2) + off;
        }
        1 => {
            // an upright wall; of every third one side is upright as well
            let share = if dice.chance(0.3) { 0.0 } else { dice.within(-0.5, 1.5) };
            (c.x, c.y) = (a.x + share * (b.x - a.x), a.y + share * (b.y - a.y));
        }
        2 => {
            // an upright wall along an axis, so that it is one exactly
            (b.x, c.x) = (a.x, a.x);
            if dice.chance(0.3) {
                c.y = b.y;
            }
        }
        3 => (b.z, c.z) = (a.z, a.z),
        4 => {
            // nearly level
            let tilt = dice.scale(1e-14, 1e-2);
            corners.iter_mut().for_each(|p| p.z *= tilt);
        }
        5 => {
            // steep, to a needle
            let shrink = dice.scale(1e-10, 0.3);
            corners.iter_mut().for_each(|p| (p.x, p.y) = (shrink * p.x, shrink * p.y));
        }
        6 => {
            let grid = 0.25 * size;
            corners.iter_mut().for_each(|p| *p = p.map(|x| (x / grid).round() * grid));
        }
        _ => {}
    }
    if dice.chance(0.5) {
        corners
    } else {
        [corners[1], corners[0], corners[2]]
    }
}

/// A position for a tool of a radius: over the triangle and beside it, over edges and corners, and with them at the rim.
pub fn position(dice: &mut Dice, corners: &[Vector; 3], radius: f64) -> [f64; 2] {
    let [a, b, c] = corners;
    let (mut s, mut t) = (dice.share(), dice.share());
    if s + t > 1.0 {
        (s, t) = (1.0 - s, 1.0 - t);
    }
    match dice.below(4) {
        0 => (s, t) = (0.0, 0.0),
        1 => t = 0.0,
        _ => {}
    }
    let p = a + (b - a) * s + (c - a) * t;
    let rim = |dice: &mut Dice| dice.scale(1e-16, 1e-2) * if dice.chance(0.5) { 1.0 } else { -1.0 };
    let away = match dice.below(4) {
        0 => 0.0,
        1 => 1.0 + rim(dice),
        2 => dice.scale(1e-9, 1.0),
        _ => dice.within(0.0, 1.1),
    };
    let (sin, cos) = libm::sincos(TAU * if dice.chance(0.2) { 0.25 * dice.below(4) as f64 } else { dice.share() });
    [p.x + away * radius * cos, p.y + away * radius * sin]
}

fn direction(dice: &mut Dice) -> Vector {
    Vector::from_fn(|_, _| dice.within(-1.0, 1.0))
}

//! Where the tool goes down: a helix in the middle of the largest disc that the walls leave, or to and fro along a line through it.

use std::f64::consts::PI;

use super::ground::path_chords;
use super::growth::WALL;
use super::material::Material;
use super::polygons::{Kernel, Point, Polygons};
use super::request::{EntryForm, EntryRule, SHORTEST, SMALLEST};

/// Radius of the helix, in radii of the tool.
const HELIX: f64 = 0.7;
/// Larger ones would leave a core in their middle.
const CORE: f64 = 0.95;
/// Helices that are smaller, in radii of the tool, are small.
const SMALL: f64 = 0.35;
/// A ramp is taken instead of a small helix if it is so many of its radii long.
const LONGER: f64 = 4.0;
/// How far from its line the two ways of a ramp lie where there is room, in radii of the tool.
const ASIDE: f64 = 0.15;
/// Directions of lines that are tried, and the distance of positions that are looked at on them, in radii of the tool.
const DIRECTIONS: u32 = 24;
const STRIDE: f64 = 0.05;
/// The largest disc is found to this, in radii of the tool.
const FINE: f64 = 0.002;

/// An entry, seen from above: once around, and what the tool clears on it.
#[derive(Clone, Debug)]
pub struct EntryLoop {
    /// Points with bulges; the last is the first.
    pub points: Vec<[f64; 3]>,
    pub swept: Polygons,
}

/// Where an entry may lie.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    pub kernel: &'a Kernel,
    /// Where the tool's centre may be.
    pub free: &'a Material,
    /// The tool's radius, mm.
    pub radius: f64,
    /// How far from the line of a ramp its two ways lie, at least: so that the passes find room to begin, mm.
    pub aside: f64,
}

impl Site<'_> {
    /// The entry in the middle of a disc that is free; None where none of the form asked for fits.
    pub fn way(&self, (centre, room): (Point, f64), rule: EntryRule) -> Option<EntryLoop> {
        let r = self.radius;
        let size = rule.size.unwrap_or(2.0 * HELIX * r);
        let radius = room.max(if self.free.holds(centre) { self.free.distance(centre) } else { 0.0 });
        let radius = radius.min(0.5 * size).min(CORE * r);
        let helix = || (radius >= SMALLEST * r).then(|| self.helix(centre, radius));
        let ramp = || {
            let (from, to) = self.line(centre, room, rule.size.unwrap_or(2.0 * r))?;
            Some((libm::hypot(to[0] - from[0], to[1] - from[1]), self.ramp(from, to, room)))
        };
        match rule.form {
            EntryForm::Helix => helix(),
            EntryForm::Ramp => ramp().map(|(_, way)| way),
            EntryForm::Auto if radius >= SMALL.min(0.5 * size / r) * r => helix(),
            EntryForm::Auto => match ramp() {
                Some((length, way)) if length > LONGER * radius => Some(way),
                _ => helix(),
            },
        }
    }

    fn helix(&self, [x, y]: Point, radius: f64) -> EntryLoop {
        let points = vec![[x + radius, y, 1.0], [x - radius, y, 1.0], [x + radius, y, 0.0]];
        EntryLoop { points, swept: Polygons::disc([x, y], radius + self.radius, WALL) }
    }

    /// The longest line through a point, up to a length, from which the ways to and fro may lie aside; in a disc of so much room.
    fn line(&self, centre: Point, room: f64, longest: f64) -> Option<(Point, Point)> {
        let core = Material::new(self.kernel.offset(&self.free.area, -self.width(room), WALL));
        if room < self.aside || !core.holds(centre) {
            return None;
        }
        let step = STRIDE * self.radius;
        let reach = |[cos, sin]: [f64; 2]| {
            let at = |i: u32| [centre[0] + f64::from(i) * step * cos, centre[1] + f64::from(i) * step * sin];
            let count = (1..).take_while(|i| f64::from(*i) * step <= longest && core.holds(at(*i))).count();
            count as f64 * step
        };
        let lines = (0..DIRECTIONS).map(|i| {
            let (sin, cos) = libm::sincos(PI * f64::from(i) / f64::from(DIRECTIONS));
            let [ahead, behind] = [reach([cos, sin]), reach([-cos, -sin])];
            // about the middle, as far as both sides let it
            let more = (ahead + behind - longest).max(0.0);
            let off = (0.5 * (more + ahead - behind)).clamp(0.0, more);
            ([cos, sin], ahead - off, behind - (more - off))
        });
        let ([cos, sin], ahead, behind) = lines.max_by(|a, b| (a.1 + a.2).total_cmp(&(b.1 + b.2)))?;
        let at = |length: f64| [centre[0] + length * cos, centre[1] + length * sin];
        (ahead + behind >= SHORTEST * self.radius).then(|| (at(-behind), at(ahead)))
    }

    /// How far the ways of a ramp lie from its line, mm.
    fn width(&self, room: f64) -> f64 {
        (ASIDE * self.radius).min(room).max(self.aside)
    }

    fn ramp(&self, from: Point, to: Point, room: f64) -> EntryLoop {
        let along = [to[0] - from[0], to[1] - from[1]];
        let share = self.width(room) / libm::hypot(along[0], along[1]);
        let right = [share * along[1], -share * along[0]];
        let beside = |[x, y]: Point, sign: f64, bulge: f64| [x + sign * right[0], y + sign * right[1], bulge];
        let points = vec![
            beside(from, 1.0, 0.0),
            beside(to, 1.0, 1.0),
            beside(to, -1.0, 0.0),
            beside(from, -1.0, 1.0),
            beside(from, 1.0, 0.0),
        ];
        let swept = self.kernel.sweep(&path_chords(&points), self.radius, WALL);
        EntryLoop { points, swept }
    }
}

/// The largest disc within an area: its centre and radius, found to `FINE` tool radii, mm; None where the area is empty.
pub fn largest_disc(kernel: &Kernel, area: &Polygons, tool_radius: f64) -> Option<(Point, f64)> {
    let [low, high] = area.bounds()?;
    let mut most = 0.5 * (high[0] - low[0]).min(high[1] - low[1]) + FINE * tool_radius;
    let (mut least, mut left) = (0.0, area.clone());
    while most - least > FINE * tool_radius {
        let radius = 0.5 * (least + most);
        let core = kernel.offset(area, -radius, WALL);
        if core.is_empty() {
            most = radius;
        } else {
            (least, left) = (radius, core);
        }
    }
    // the largest rest: all of it lies within the accuracy of the centre
    let contour = left.contours.iter().max_by(|a, b| a.len().cmp(&b.len()))?;
    let count = contour.len().max(1) as f64;
    let mean = contour.iter().fold([0.0, 0.0], |sum, p| [sum[0] + p[0] / count, sum[1] + p[1] / count]);
    let centre = if Material::new(left.clone()).holds(mean) { mean } else { *contour.first()? };
    Some((centre, least))
}

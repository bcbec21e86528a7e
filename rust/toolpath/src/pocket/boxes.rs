//! Boxes around neighbouring sides, and boxes around those: the nearest side to a point however far it is.

use super::contours::Point;
use super::window::{around, Window};
use crate::plan::foot;

/// Sides in a box, and boxes in a larger one.
const GROUP: usize = 4;

/// Upright boxes around groups of sides that follow each other, level by level up to a single one: low and high corner.
#[derive(Debug)]
pub struct Boxes {
    levels: Vec<Vec<Window>>,
}

impl Boxes {
    pub fn new(sides: &[(Point, Point)]) -> Self {
        let of_side = |(a, b): &(Point, Point)| around([*a, *a], [*b, *b]);
        let mut level: Vec<Window> =
            sides.chunks(GROUP).filter_map(|group| group.iter().map(of_side).reduce(around)).collect();
        let mut levels = Vec::new();
        while level.len() > 1 {
            let next = level.chunks(GROUP).filter_map(|group| group.iter().copied().reduce(around)).collect();
            levels.push(std::mem::replace(&mut level, next));
        }
        levels.push(level);
        Self { levels }
    }

    /// The number of the nearest of the sides and the square of its distance, mm^2; `best` where none is nearer than that.
    pub fn nearest(&self, sides: &[(Point, Point)], point: Point, best: (f64, usize)) -> (f64, usize) {
        self.nearest_below(sides, point, best, self.levels.len(), 0)
    }

    /// Whether one of the sides is nearer than a distance to a point; `square` is that of the distance, mm^2.
    pub fn is_one_within(&self, sides: &[(Point, Point)], point: Point, square: f64) -> bool {
        self.is_one_below(sides, point, square, self.levels.len(), 0)
    }

    /// Whether an odd number of the sides crosses the ray from a point to +X: whether the point lies in the area that they bound.
    pub fn is_inside(&self, sides: &[(Point, Point)], point: Point) -> bool {
        self.is_odd_below(sides, point, self.levels.len(), 0)
    }

    fn is_odd_below(&self, sides: &[(Point, Point)], point: Point, level: usize, group: usize) -> bool {
        let [x, y] = point;
        let members = group * GROUP..(group + 1) * GROUP;
        let Some(below) = level.checked_sub(1) else {
            let crosses = |(a, b): &(Point, Point)| {
                (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            };
            return members.filter_map(|number| sides.get(number)).fold(false, |odd, side| odd ^ crosses(side));
        };
        let Some(boxes) = self.levels.get(below) else { return false };
        let is_met = |[low, high]: &Window| low[1] <= y && y <= high[1] && x <= high[0];
        let met = members.filter(|member| boxes.get(*member).is_some_and(is_met));
        met.fold(false, |odd, member| odd ^ self.is_odd_below(sides, point, below, member))
    }

    /// Calls with the sides that may come through a circle: those that lie neither farther from its centre than its radius all along, nor nearer.
    pub fn crossed(&self, sides: &[(Point, Point)], centre: Point, radius: f64, found: &mut impl FnMut(Point, Point)) {
        self.crossed_below(sides, (centre, radius * radius), self.levels.len(), 0, found);
    }

    fn crossed_below(
        &self,
        sides: &[(Point, Point)],
        (centre, square): (Point, f64),
        level: usize,
        group: usize,
        found: &mut impl FnMut(Point, Point),
    ) {
        let members = group * GROUP..(group + 1) * GROUP;
        let Some(below) = level.checked_sub(1) else {
            members.filter_map(|number| sides.get(number)).for_each(|(a, b)| found(*a, *b));
            return;
        };
        let Some(boxes) = self.levels.get(below) else { return };
        for member in members {
            let is_met = |b: &Window| square_outside(centre, b) < square && square_farthest(centre, b) >= square;
            if boxes.get(member).is_some_and(is_met) {
                self.crossed_below(sides, (centre, square), below, member, found);
            }
        }
    }

    fn is_one_below(&self, sides: &[(Point, Point)], point: Point, square: f64, level: usize, group: usize) -> bool {
        let members = group * GROUP..(group + 1) * GROUP;
        let Some(below) = level.checked_sub(1) else {
            let mut sides = members.filter_map(|number| sides.get(number));
            return sides.any(|(a, b)| square_distance(point, *a, *b) < square);
        };
        let Some(boxes) = self.levels.get(below) else { return false };
        members
            .filter(|member| boxes.get(*member).is_some_and(|b| square_outside(point, b) < square))
            .any(|member| self.is_one_below(sides, point, square, below, member))
    }

    fn nearest_below(
        &self,
        sides: &[(Point, Point)],
        point: Point,
        best: (f64, usize),
        level: usize,
        group: usize,
    ) -> (f64, usize) {
        let members = group * GROUP..(group + 1) * GROUP;
        let nearer = |best: (f64, usize), found: (f64, usize)| if found.0 < best.0 { found } else { best };
        let Some(below) = level.checked_sub(1) else {
            let sides = members.filter_map(|number| sides.get(number).map(|(a, b)| (*a, *b, number)));
            return sides.fold(best, |best, (a, b, number)| nearer(best, (square_distance(point, a, b), number)));
        };
        let Some(boxes) = self.levels.get(below) else { return best };
        let mut near = [(f64::INFINITY, 0); GROUP];
        for (slot, member) in near.iter_mut().zip(members) {
            *slot = (boxes.get(member).map_or(f64::INFINITY, |b| square_outside(point, b)), member);
        }
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        near.iter().fold(best, |best, (away, member)| {
            if *away < best.0 {
                self.nearest_below(sides, point, best, below, *member)
            } else {
                best
            }
        })
    }
}

/// Square of the distance between a point and a box.
fn square_outside(p: Point, [low, high]: &Window) -> f64 {
    let x = (low[0] - p[0]).max(p[0] - high[0]).max(0.0);
    let y = (low[1] - p[1]).max(p[1] - high[1]).max(0.0);
    x * x + y * y
}

/// Square of the distance from a point to the farthest point of a box.
fn square_farthest(p: Point, [low, high]: &Window) -> f64 {
    let x = (p[0] - low[0]).max(high[0] - p[0]);
    let y = (p[1] - low[1]).max(high[1] - p[1]);
    x * x + y * y
}

/// Square of the distance between a point and a side.
pub fn square_distance(p: Point, a: Point, b: Point) -> f64 {
    let on = foot(p, [a, b]);
    let off: Point = [p[0] - on[0], p[1] - on[1]];
    off[0] * off[0] + off[1] * off[1]
}

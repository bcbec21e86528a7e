//! From where a part of a mesh can be touched: a convex piece of the plan.

use super::frame::dot;

/// Sides of a footprint at most: those of a triangle and of the box around it.
const SIDES: usize = 7;

/// A convex piece of the plan, in coordinates along and across rows, mm.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    /// a + b along + c across is not negative inside.
    sides: [[f64; 3]; SIDES],
    count: usize,
    /// Middle and radius of a circle in which it lies.
    circle: Option<([f64; 2], f64)>,
    /// From and to across the rows.
    pub across: [f64; 2],
}

impl Footprint {
    /// The whole strip between two positions across.
    pub fn strip(across: [f64; 2]) -> Self {
        Self { sides: [[0.0; 3]; SIDES], count: 0, circle: None, across }
    }

    /// The part of it in which a linear function (its value at the origin, its gradient) is not negative.
    pub fn cut(mut self, at_origin: f64, gradient: [f64; 2]) -> Self {
        self.sides[self.count] = [at_origin, gradient[0], gradient[1]];
        self.count += 1;
        self
    }

    /// The part of it between two values of a linear function through the origin.
    pub fn between(self, [low, high]: [f64; 2], gradient: [f64; 2]) -> Self {
        self.cut(-low, gradient).cut(high, gradient.map(|part| -part))
    }

    /// The part of it in a circle.
    pub fn within(self, middle: [f64; 2], radius: f64) -> Self {
        Self { circle: Some((middle, radius)), ..self }
    }

    /// From where to where along it a row lies in it.
    #[inline]
    pub fn share(&self, across: f64) -> Option<[f64; 2]> {
        if across < self.across[0] || across > self.across[1] {
            return None;
        }
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for side in &self.sides[..self.count] {
            let (value, rate) = (side[0] + side[2] * across, side[1]);
            if rate > 0.0 {
                low = low.max(-value / rate);
            } else if rate < 0.0 {
                high = high.min(-value / rate);
            } else if value < 0.0 {
                return None;
            }
        }
        if let Some((middle, radius)) = self.circle {
            let aside = across - middle[1];
            let half = (radius * radius - aside * aside).max(0.0).sqrt();
            (low, high) = (low.max(middle[0] - half), high.min(middle[0] + half));
        }
        (low <= high).then_some([low, high])
    }
}

/// The least and the greatest of some numbers.
pub fn range(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    numbers.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// The positions at distances from `radii[0]` to `radii[1]` in the directions from `first` to `last` (unit vectors less than half a
/// turn apart), by their coordinate along a unit vector.
pub fn reach(axis: [f64; 2], [first, last]: [[f64; 2]; 2], radii: [f64; 2]) -> [f64; 2] {
    let shares = [dot(axis, first), dot(axis, last)];
    // the axis lies between the two where it turns from one and to the other in the same sense
    let sense = super::frame::cross(first, last).signum();
    let is_between = |axis: [f64; 2]| {
        sense * super::frame::cross(first, axis) >= 0.0 && sense * super::frame::cross(axis, last) >= 0.0
    };
    let most = if is_between(axis) { 1.0 } else { shares[0].max(shares[1]) };
    let least = if is_between(axis.map(|part| -part)) { -1.0 } else { shares[0].min(shares[1]) };
    [least * radii[usize::from(least < 0.0)], most * radii[usize::from(most > 0.0)]]
}

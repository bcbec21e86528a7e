//! A whole profile: smooth curves, kinks and straight parts, one after the other by slope.

use std::f64::consts::FRAC_PI_2;

use super::Curve;

/// A profile from tip to base: a chain of pieces in the order of their slopes.
///
/// A piece is a curve over an interval of slopes. A kink is a piece that stays at one point; a straight part is the
/// gap between the end of one piece and the start of the next, at the slope that they share.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pub(super) pieces: Vec<Piece>,
    /// Radius and height of the base, mm.
    base: (f64, f64),
}

/// A curve over an interval of slopes, at its position on the profile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub from: f64,
    pub to: f64,
    pub curve: Curve,
    /// What the curve is moved by, mm.
    pub shift: (f64, f64),
    pub start: (f64, f64),
    pub end: (f64, f64),
}

/// A straight part of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Straight {
    /// Its slope, rad.
    pub slope: f64,
    /// Radius and height of its end nearer to the tip, mm.
    pub inner: (f64, f64),
    /// Radius and height of its other end, mm.
    pub outer: (f64, f64),
}

/// The part of a profile at a radius.
enum Part<'a> {
    On(&'a Piece),
    Between(Straight),
}

impl Profile {
    /// The slope at which the profile ends, rad, at most a right angle.
    #[must_use]
    pub fn max_slope(&self) -> f64 {
        self.pieces.last().map_or(0.0, |p| p.to)
    }

    /// Radius and height of the base, mm.
    #[must_use]
    pub fn base(&self) -> (f64, f64) {
        self.base
    }

    /// Radius and height at a slope, mm: the outer end of a straight part, the base beyond the last slope.
    #[must_use]
    pub fn point_at(&self, slope: f64) -> (f64, f64) {
        let index = self.pieces.partition_point(|p| p.from <= slope);
        match self.pieces.get(index.max(1) - 1) {
            Some(piece) if slope < piece.to => piece.point_at(slope.max(piece.from)),
            Some(piece) => piece.end,
            None => self.base,
        }
    }

    /// As [`point_at`](Self::point_at), the inner end of a straight part.
    #[must_use]
    pub fn inner_point_at(&self, slope: f64) -> (f64, f64) {
        let index = self.pieces.partition_point(|p| p.to < slope);
        match self.pieces.get(index) {
            Some(piece) if slope <= piece.from => (0.0, 0.0),
            Some(piece) if slope < piece.to => piece.point_at(slope),
            Some(piece) => piece.end,
            None => self.base,
        }
    }

    /// Radius of curvature of the meridian at a slope, mm: 0 on a kink and beyond the end.
    #[must_use]
    pub fn curvature_radius_at(&self, slope: f64) -> f64 {
        let index = self.pieces.partition_point(|p| p.from <= slope);
        match self.pieces.get(index.max(1) - 1) {
            Some(piece) if slope <= piece.to => piece.curve.curvature_radius_at(slope.max(piece.from)),
            _ => 0.0,
        }
    }

    /// The slope at a radius from 0 to the base's, rad; the lowest one at a kink.
    #[must_use]
    pub fn slope_at_radius(&self, radius: f64) -> f64 {
        self.slope_within(radius, [0.0, FRAC_PI_2])
    }

    /// As [`slope_at_radius`](Self::slope_at_radius), when the slope is known to be one of `within`.
    #[must_use]
    pub fn slope_within(&self, radius: f64, within: [f64; 2]) -> f64 {
        match self.part_at(radius) {
            Part::On(piece) => piece.curve.slope_at_radius(radius - piece.shift.0, piece.narrowed(within)),
            Part::Between(straight) => straight.slope,
        }
    }

    /// Height over the tip at a radius from 0 to the base's, mm.
    #[must_use]
    pub fn height_at_radius(&self, radius: f64) -> f64 {
        self.height_within(radius, [0.0, FRAC_PI_2])
    }

    /// As [`height_at_radius`](Self::height_at_radius), when the slope is known to be one of `within`.
    #[must_use]
    pub fn height_within(&self, radius: f64, within: [f64; 2]) -> f64 {
        match self.part_at(radius) {
            Part::On(piece) => {
                let within = piece.narrowed(within);
                let height = piece.shift.1 + piece.curve.height_at_radius(radius - piece.shift.0, within);
                height.max(piece.start.1).min(piece.end.1)
            }
            Part::Between(straight) => straight.height_at(radius),
        }
    }

    /// Radius (mm) and slope (rad, one of `within` where the profile is curved) at a height over the tip from 0 to the
    /// base's, mm; the largest radius where there are several.
    #[must_use]
    pub fn at_height(&self, height: f64, within: [f64; 2]) -> (f64, f64) {
        let index = self.pieces.partition_point(|p| p.end.1 <= height);
        let before = || if index == 0 { (0.0, 0.0) } else { self.pieces[index - 1].end };
        match self.pieces.get(index) {
            Some(piece) if height >= piece.start.1 => {
                let slope = piece.curve.slope_at_height(height - piece.shift.1, piece.narrowed(within));
                (piece.point_at(slope).0.max(piece.start.0).min(piece.end.0), slope)
            }
            Some(piece) => {
                let straight = Straight { slope: piece.from, inner: before(), outer: piece.start };
                (straight.radius_at(height), straight.slope)
            }
            None => (self.base.0, self.max_slope()),
        }
    }

    /// The straight parts in the order of their slopes.
    pub fn straights(&self) -> impl Iterator<Item = Straight> + '_ {
        let ends = std::iter::once((0.0, 0.0)).chain(self.pieces.iter().map(|p| p.end));
        self.pieces.iter().zip(ends).filter(|(piece, end)| piece.start != *end).map(|(piece, end)| Straight {
            slope: piece.from,
            inner: end,
            outer: piece.start,
        })
    }

    /// Slopes at which the profile is not smooth, rad: the ends of its pieces.
    #[cfg(test)]
    pub fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.pieces.iter().flat_map(|p| [p.from, p.to])
    }

    /// The radius of the ball that the whole profile is, mm.
    #[must_use]
    pub fn as_ball(&self) -> Option<f64> {
        match &self.pieces[..] {
            [Piece { curve: Curve::Arc(arc), to, start: (r, _), .. }] if *to >= FRAC_PI_2 && *r == 0.0 => {
                Some(arc.radius())
            }
            _ => None,
        }
    }

    /// The same with `radius` (mm) as the base's, where it differs by rounding.
    #[must_use]
    pub fn ending_at(mut self, radius: f64) -> Self {
        self.base.0 = radius;
        if let Some(last) = self.pieces.last_mut() {
            // a point stays one
            if matches!(last.curve, Curve::Point) {
                last.start.0 = radius;
                last.shift.0 = radius;
            }
            last.end.0 = radius;
        }
        self
    }

    /// The same with a flat of this radius (mm, not negative) before it: its Minkowski sum with a level disc.
    #[must_use]
    pub fn widened(mut self, by: f64) -> Self {
        for piece in &mut self.pieces {
            piece.shift.0 += by;
            piece.start.0 += by;
            piece.end.0 += by;
        }
        self.base.0 += by;
        self
    }

    /// The profile up to a right angle, its rim there, offset outwards by a ball (radius in mm).
    #[must_use]
    pub fn grown(&self, ball: f64) -> Self {
        let offset = |(r, z): (f64, f64), slope: f64| {
            let (out, up) = Curve::Point.grown(ball, 0.0).point_at(slope);
            (r + out, z + up)
        };
        let mut grown = Builder::default();
        let mut end = (0.0, 0.0);
        for piece in &self.pieces {
            grown.kink(piece.from);
            if piece.start != end {
                grown.straight(length(end, piece.start));
                // each piece at its own position: of many, the rounding would add up
                grown.arrive(offset(piece.start, piece.from));
            }
            grown.curve(piece.curve.grown(ball, piece.from), piece.from, piece.to);
            grown.arrive(offset(piece.end, piece.to));
            end = piece.end;
        }
        if self.max_slope() < FRAC_PI_2 {
            grown.curve(Curve::Point.grown(ball, self.max_slope()), self.max_slope(), FRAC_PI_2);
            grown.arrive(offset(end, FRAC_PI_2));
        }
        grown.finish()
    }

    fn part_at(&self, radius: f64) -> Part<'_> {
        let index = self.pieces.partition_point(|p| p.end.0 < radius);
        let before = || if index == 0 { (0.0, 0.0) } else { self.pieces[index - 1].end };
        match self.pieces.get(index) {
            Some(piece) if radius >= piece.start.0 => Part::On(piece),
            Some(piece) => Part::Between(Straight { slope: piece.from, inner: before(), outer: piece.start }),
            None => Part::Between(Straight { slope: self.max_slope(), inner: self.base, outer: self.base }),
        }
    }
}

impl Piece {
    pub fn point_at(&self, slope: f64) -> (f64, f64) {
        let (r, z) = self.curve.point_at(slope);
        (self.shift.0 + r, self.shift.1 + z)
    }

    fn narrowed(&self, within: [f64; 2]) -> [f64; 2] {
        [within[0].clamp(self.from, self.to), within[1].clamp(self.from, self.to)]
    }
}

impl Straight {
    /// Height at one of its radii, mm.
    #[must_use]
    pub fn height_at(&self, radius: f64) -> f64 {
        let (width, rise) = (self.outer.0 - self.inner.0, self.outer.1 - self.inner.1);
        let share = if width > 0.0 { ((radius - self.inner.0) / width).clamp(0.0, 1.0) } else { 1.0 };
        self.inner.1 + share * rise
    }

    /// Radius at one of its heights, mm; the outer one where it is flat.
    #[must_use]
    pub fn radius_at(&self, height: f64) -> f64 {
        let (width, rise) = (self.outer.0 - self.inner.0, self.outer.1 - self.inner.1);
        let share = if rise > 0.0 { ((height - self.inner.1) / rise).clamp(0.0, 1.0) } else { 1.0 };
        self.inner.0 + share * width
    }
}

fn length(a: (f64, f64), b: (f64, f64)) -> f64 {
    let (r, z) = (b.0 - a.0, b.1 - a.1);
    (r * r + z * z).sqrt()
}

/// Puts a profile together, from the tip outwards.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    pieces: Vec<Piece>,
    at: (f64, f64),
    slope: f64,
}

impl Builder {
    /// Where the next part begins: radius and height, mm.
    #[must_use]
    pub fn at(&self) -> (f64, f64) {
        self.at
    }

    /// Goes on for `length` mm at the slope reached.
    pub fn straight(&mut self, length: f64) {
        if length > 0.0 {
            let (sin, cos) = if self.slope >= FRAC_PI_2 { (1.0, 0.0) } else { libm::sincos(self.slope) };
            self.at = (self.at.0 + length * cos, self.at.1 + length * sin);
        }
    }

    /// Puts the end of what was built last to where it is known to be: mends rounding.
    pub fn arrive(&mut self, at: (f64, f64)) {
        if let Some(last) = self.pieces.last_mut().filter(|last| last.end == self.at) {
            last.end = at;
        }
        self.at = at;
    }

    /// Turns on the spot to the slope `to`, rad.
    pub fn kink(&mut self, to: f64) {
        if to > self.slope {
            self.curve(Curve::Point, self.slope, to);
        }
    }

    /// Follows a curve over an interval of slopes, rad; a kink leads to its first slope.
    pub fn curve(&mut self, curve: Curve, from: f64, to: f64) {
        self.kink(from);
        let (first, last) = (curve.point_at(from), curve.point_at(to));
        let shift = (self.at.0 - first.0, self.at.1 - first.1);
        let end = (shift.0 + last.0, shift.1 + last.1);
        self.pieces.push(Piece { from, to, curve, shift, start: self.at, end });
        (self.at, self.slope) = (end, to);
    }

    /// The profile as far as it was led.
    #[must_use]
    pub fn finish(mut self) -> Profile {
        let open = self.pieces.last().is_none_or(|p| p.end != self.at);
        if open {
            self.curve(Curve::Point, self.slope, self.slope);
        }
        Profile { pieces: self.pieces, base: self.at }
    }
}

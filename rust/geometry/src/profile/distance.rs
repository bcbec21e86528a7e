//! How far a point is from a profile, on either side.

use super::chain::{Piece, Profile};
use super::solve::NEAREST;

/// The last bits of a slope that rounding leaves open, and then some.
const BITS: f64 = 16.0;

impl Profile {
    /// Distance of (r, z) from the curve between tip and base, mm, if it is at most `within`; else a distance from one
    /// of its points, which is the less exact the farther away it is.
    ///
    /// Along a profile r + z rises: the search begins where the point's own is met and goes in both directions while the curve
    /// stays near.
    #[must_use]
    pub(super) fn distance(&self, point: (f64, f64), within: f64) -> f64 {
        let pieces = &self.pieces;
        let along = |(r, z): (f64, f64)| r + z;
        let first = pieces.partition_point(|p| along(p.end) < along(point)).min(pieces.len().max(1) - 1);
        let mut nearest = apart(point, self.base());
        for index in (0..=first).rev() {
            let Some(piece) = pieces.get(index) else { break };
            let reach = if index == first { f64::INFINITY } else { nearest.min(within) };
            if point.0 - piece.end.0 > reach || point.1 - piece.end.1 > reach {
                break;
            }
            nearest = nearest.min(self.apart_from(index, point));
            if nearest == 0.0 {
                return nearest;
            }
        }
        for index in first + 1..pieces.len() {
            let (start, reach) = (pieces[index - 1].end, nearest.min(within));
            if start.0 - point.0 > reach || start.1 - point.1 > reach {
                break;
            }
            nearest = nearest.min(self.apart_from(index, point));
        }
        nearest
    }

    /// Distance from a piece and the straight part that leads to it.
    fn apart_from(&self, index: usize, point: (f64, f64)) -> f64 {
        let piece = &self.pieces[index];
        let before = if index == 0 { (0.0, 0.0) } else { self.pieces[index - 1].end };
        piece.apart(point).min(apart_from_line(before, piece.start, point))
    }
}

impl Piece {
    fn apart(&self, point: (f64, f64)) -> f64 {
        let ends = apart(point, self.start).min(apart(point, self.end));
        if self.to <= self.from || ends == 0.0 {
            return ends;
        }
        // as if the slope grew evenly along the chord
        let share = share_of_line(self.start, self.end, point);
        let guess = self.from + share.clamp(0.0, 1.0) * (self.to - self.from);
        let from_curve = (point.0 - self.shift.0, point.1 - self.shift.1);
        let slope = self.curve.slope_nearest(from_curve, [self.from, self.to], guess);
        let on = self.point_at(slope);
        let (sin, cos) = libm::sincos(slope);
        let (r, z) = (point.0 - on.0, point.1 - on.1);
        let (along, away) = (r * cos + z * sin, r * sin - z * cos);
        // on a nearly straight piece the last bit of the slope is a long distance: along the tangent, which is the curve
        let known_to = 2.0 * NEAREST * (self.to - self.from) + BITS * f64::EPSILON;
        let foot = (slope > self.from || along >= 0.0) && (slope < self.to || along <= 0.0);
        let foot = foot && along.abs() <= known_to * self.curve.curvature_radius_at(slope);
        ends.min(if foot { away.abs() } else { apart(point, on) })
    }
}

fn apart(a: (f64, f64), b: (f64, f64)) -> f64 {
    let (r, z) = (b.0 - a.0, b.1 - a.1);
    (r * r + z * z).sqrt()
}

/// Where along the line from a to b a point is: 0 at a, 1 at b.
fn share_of_line(a: (f64, f64), b: (f64, f64), point: (f64, f64)) -> f64 {
    let (r, z) = (b.0 - a.0, b.1 - a.1);
    ((point.0 - a.0) * r + (point.1 - a.1) * z) / (r * r + z * z)
}

fn apart_from_line(a: (f64, f64), b: (f64, f64), point: (f64, f64)) -> f64 {
    let (r, z) = (b.0 - a.0, b.1 - a.1);
    let share = share_of_line(a, b, point);
    if share > 0.0 && share < 1.0 {
        apart(point, (a.0 + share * r, a.1 + share * z))
    } else {
        apart(point, a).min(apart(point, b))
    }
}

#[cfg(test)]
mod tests {
    use crate::profile::samples::any_profile;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_other_point_of_the_curve_is_nearer(
            profile in any_profile(),
            across in 0.0..1.2_f64,
            up in 0.0..1.2_f64,
            shares in prop::collection::vec(0.0..1.0_f64, 50),
        ) {
            let base = profile.base();
            let point = (across * base.0, up * base.1);
            let distance = profile.distance(point, f64::INFINITY);
            let mut nearest = f64::INFINITY;
            for share in shares {
                let slope = share * profile.max_slope();
                let (inner, outer) = (profile.inner_point_at(slope), profile.point_at(slope));
                for on in [inner, outer] {
                    nearest = nearest.min((on.0 - point.0).hypot(on.1 - point.1));
                }
            }
            // deep inside, the minimum that is found need not be the deepest
            let outside = point.1 < profile.height_at_radius(point.0.min(base.0)) || point.0 > base.0;
            if outside {
                prop_assert!(distance <= nearest + 1e-12 * (base.0 + base.1), "{distance} {nearest}");
            }
        }

        #[test]
        fn a_step_along_the_normal_is_the_distance(profile in any_profile(), share in 0.0..1.0_f64, away in 0.0..1.0_f64) {
            let slope = share * profile.max_slope();
            let (r, z) = profile.point_at(slope);
            let distance = profile.distance((r + away * slope.sin(), z - away * slope.cos()), f64::INFINITY);
            prop_assert!((distance - away).abs() < 1e-11 * (1.0 + profile.base().0 + profile.base().1), "{distance} {away}");
        }
    }
}

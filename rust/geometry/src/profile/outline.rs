//! What a profile is made of, as a drawing needs it: straight parts, and smooth curves between them and the kinks.

use super::{
    chain::{Piece, Profile, Straight},
    Curve,
};

/// A part of a profile; each begins where the one before it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlinePart {
    /// A flat or a side of a cone.
    Straight(Straight),
    /// A curve without kinks.
    Curved(Curved),
}

/// A smooth curve of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curved {
    /// First and last slope, rad.
    pub slopes: [f64; 2],
    /// Radius and height of its end nearer to the tip, mm.
    pub inner: (f64, f64),
    /// Radius and height of its other end, mm.
    pub outer: (f64, f64),
}

impl OutlinePart {
    /// First and last slope, rad: the same one where it is straight.
    #[must_use]
    pub fn slopes(&self) -> [f64; 2] {
        match self {
            Self::Straight(part) => [part.slope; 2],
            Self::Curved(part) => part.slopes,
        }
    }

    /// Radius and height of both ends from the tip outwards, mm.
    #[must_use]
    pub fn ends(&self) -> [(f64, f64); 2] {
        match self {
            Self::Straight(part) => [part.inner, part.outer],
            Self::Curved(part) => [part.inner, part.outer],
        }
    }

    /// Whether it is straight.
    #[must_use]
    pub fn is_straight(&self) -> bool {
        matches!(self, Self::Straight(_))
    }
}

impl Profile {
    /// Its parts from the tip to the base. Curves that join smoothly are one part; a kink lies between two.
    #[must_use]
    pub fn outline(&self) -> Vec<OutlinePart> {
        let (mut parts, mut end, mut joins) = (Vec::new(), (0.0, 0.0), false);
        for piece in &self.pieces {
            if piece.start != end {
                parts.push(OutlinePart::Straight(Straight { slope: piece.from, inner: end, outer: piece.start }));
                joins = false;
            }
            joins = follow(&mut parts, piece, joins);
            end = piece.end;
        }
        parts
    }
}

/// Adds a piece; returns whether the next one may go on from it. `joins` is whether this one may go on from the last part.
fn follow(parts: &mut Vec<OutlinePart>, piece: &Piece, joins: bool) -> bool {
    if matches!(piece.curve, Curve::Point) {
        return joins && piece.to <= piece.from;
    }
    match parts.last_mut() {
        Some(OutlinePart::Curved(last)) if joins => {
            (last.slopes[1], last.outer) = (piece.to, piece.end);
        }
        _ => parts.push(OutlinePart::Curved(Curved {
            slopes: [piece.from, piece.to],
            inner: piece.start,
            outer: piece.end,
        })),
    }
    true
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

    use super::*;
    use crate::profile::{arc::Arc, chain::Builder, samples::any_profile};

    #[test]
    fn a_flat_an_edge_a_facet_and_two_arcs_have_exact_ends() {
        let mut tip = Builder::default();
        tip.straight(1.0);
        tip.kink(FRAC_PI_6);
        tip.straight(2.0);
        tip.curve(Curve::Arc(Arc::new(4.0, FRAC_PI_6)), FRAC_PI_6, 1.0);
        tip.curve(Curve::Arc(Arc::new(2.0, 1.0)), 1.0, FRAC_PI_2);
        let profile = tip.finish();
        let outline = profile.outline();
        let slopes: Vec<_> = outline.iter().map(OutlinePart::slopes).collect();
        assert_eq!(slopes, [[0.0, 0.0], [FRAC_PI_6, FRAC_PI_6], [FRAC_PI_6, FRAC_PI_2]]);
        assert_eq!(outline.iter().map(OutlinePart::is_straight).collect::<Vec<_>>(), [true, true, false]);
        let [start, facet] = outline[1].ends();
        assert_eq!(start, (1.0, 0.0));
        assert!((facet.0 - 1.0 - 3.0_f64.sqrt()).abs() < 1e-15 && (facet.1 - 1.0).abs() < 1e-15, "{facet:?}");
        assert_eq!(outline[2].ends(), [facet, profile.base()]);
    }

    #[test]
    fn curves_that_meet_in_an_edge_are_two_parts() {
        let mut tip = Builder::default();
        tip.curve(Curve::Arc(Arc::new(4.0, 0.0)), 0.0, 0.5);
        tip.kink(0.7);
        tip.curve(Curve::Arc(Arc::new(2.0, 0.7)), 0.7, 1.0);
        let slopes: Vec<_> = tip.finish().outline().iter().map(OutlinePart::slopes).collect();
        assert_eq!(slopes, [[0.0, 0.5], [0.7, 1.0]]);
    }

    proptest! {
        #[test]
        fn the_parts_join_and_lie_on_the_profile(profile in any_profile()) {
            let mut end = (0.0, 0.0);
            for part in profile.outline() {
                let [inner, outer] = part.ends();
                prop_assert_eq!(inner, end);
                let [from, to] = part.slopes();
                prop_assert!(from <= to && part.is_straight() != (from < to), "{:?}", part);
                prop_assert_eq!(profile.inner_point_at(to), if part.is_straight() { inner } else { outer });
                end = outer;
            }
            prop_assert_eq!(end, profile.base());
        }
    }
}

//! What must hold of a finished profile, checked on the whole of it.

use super::chain::Profile;
use crate::GeometryError;

/// Joints meet to this share of the profile's size.
const JOINED: f64 = 1e-12;

impl Profile {
    /// Checks that slopes never fall, that pieces begin where the one before ends and end where stated, that straight
    /// parts run at their slope, and that every curve bends upwards.
    ///
    /// # Errors
    /// The first point at which one of them does not hold.
    pub(super) fn proved(self) -> Result<Self, GeometryError> {
        match self.flaw() {
            None => Ok(self),
            Some(((r, z), reason)) => Err(GeometryError::Profile {
                place: format!("r = {r:.6}, z = {z:.6}"),
                reason: reason.to_owned(),
                hint: "please report this tool".to_owned(),
            }),
        }
    }

    fn flaw(&self) -> Option<((f64, f64), &'static str)> {
        let (width, height) = self.base();
        let close = JOINED * width.max(height);
        let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() <= close && (a.1 - b.1).abs() <= close;
        let (mut at, mut slope) = ((0.0, 0.0), 0.0);
        for piece in &self.pieces {
            let (r, z) = (piece.start.0 - at.0, piece.start.1 - at.1);
            let (sin, cos) = if r == 0.0 && z == 0.0 { (0.0, 1.0) } else { libm::sincos(piece.from) };
            let bends = |slope| (0.0..).contains(&piece.curve.curvature_radius_at(slope));
            let holds = [
                (piece.from >= slope && piece.to >= piece.from, "the slope falls"),
                (piece.to <= std::f64::consts::FRAC_PI_2, "the slope passes a right angle"),
                (r >= -close && z >= -close && piece.end.0 >= piece.start.0 - close, "the profile turns back"),
                ((r * sin - z * cos).abs() <= close, "a straight part leads off its slope"),
                (near(piece.point_at(piece.from), piece.start), "two parts do not meet"),
                (near(piece.point_at(piece.to), piece.end), "a part misses its end"),
                (bends(piece.from) && bends(piece.to), "the curve is hollow"),
            ];
            if let Some((_, reason)) = holds.iter().find(|(holds, _)| !holds) {
                return Some((piece.start, reason));
            }
            (at, slope) = (piece.end, piece.to);
        }
        (!near(at, self.base())).then_some((at, "the base is not reached"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Arc, Builder, Curve};
    use crate::profile::samples::any_profile;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_profile_passes(profile in any_profile()) {
            prop_assert!(profile.proved().is_ok());
        }
    }

    #[test]
    fn what_does_not_hold_is_reported() {
        let flaw = |build: &dyn Fn(&mut Builder)| {
            let mut builder = Builder::default();
            build(&mut builder);
            builder.finish().proved().unwrap_err().to_string()
        };
        let arc = |radius: f64, from: f64| Curve::Arc(Arc::new(radius, from));
        let slopes = flaw(&|b| {
            b.curve(arc(1.0, 0.0), 0.0, 0.6);
            b.curve(arc(1.0, 0.5), 0.5, 0.7);
        });
        assert!(slopes.contains("the slope falls"), "{slopes}");
        let hollow = flaw(&|b| b.curve(arc(-1.0, 0.0), 0.0, 0.6));
        assert!(hollow.contains("turns back"), "{hollow}");
        let missed = flaw(&|b| {
            b.curve(arc(1.0, 0.0), 0.0, 0.6);
            b.arrive((0.6, 0.2));
        });
        assert!(missed.contains("misses its end"), "{missed}");
        let led = flaw(&|b| {
            b.straight(1.0);
            b.arrive((1.0, 0.1));
            b.curve(arc(1.0, 0.0), 0.0, 0.6);
        });
        assert!(led.contains("off its slope"), "{led}");
        let nan = flaw(&|b| b.curve(arc(f64::NAN, 0.0), 0.0, 0.6));
        assert!(nan.contains("r = 0.000000"), "{nan}");
    }
}

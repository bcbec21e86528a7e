//! Random profiles of every kind, for tests.

use proptest::prelude::*;

use super::{kinds::any_kind, Profile};

/// A profile of any kind.
pub fn any_profile() -> impl Strategy<Value = Profile> {
    any_kind().prop_map(|document| document.build().unwrap().0)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::ProfileDocument;

    /// The last bits of a slope that rounding leaves open, and then some.
    const BITS: f64 = 16.0;

    proptest! {
        #[test]
        fn a_profile_is_convex_and_consistent(document in any_kind(), a in 0.0..1.0_f64, b in 0.0..1.0_f64) {
            let (profile, _) = document.build().unwrap();
            let last = profile.max_slope();
            let (low, high) = (a.min(b) * last, a.max(b) * last);
            let (p, q) = (profile.point_at(low), profile.inner_point_at(high));
            if low < high {
                prop_assert!(p.0 <= q.0 + 1e-12 && p.1 <= q.1 + 1e-12, "{p:?} {q:?}");
                // the chord's slope lies between those of its ends: dz/dr = tan(slope), and it grows
                let (r, z) = (q.0 - p.0, q.1 - p.1);
                let size = 1e-12 * (profile.base().0 + profile.base().1);
                prop_assert!(z * low.cos() - r * low.sin() >= -size && r * high.sin() - z * high.cos() >= -size);
            }
            let rho = profile.curvature_radius_at(low);
            prop_assert!(rho >= 0.0, "{rho}");
        }

        #[test]
        fn the_radius_of_curvature_is_that_of_the_curve(document in any_kind(), share in 0.05..0.95_f64) {
            let (profile, _) = document.build().unwrap();
            let slope = share * profile.max_slope();
            let step = 1e-5 * profile.max_slope();
            prop_assume!(profile.breaks().all(|at| (at - slope).abs() > 2.0 * step));
            let (p, q) = (profile.point_at(slope - step), profile.point_at(slope + step));
            let length = (q.0 - p.0).hypot(q.1 - p.1) / (2.0 * step);
            let rho = profile.curvature_radius_at(slope);
            prop_assert!((length - rho).abs() < 1e-5 * (rho + profile.base().0), "{length} {rho}");
        }

        #[test]
        fn a_document_survives_json(document in any_kind()) {
            let text = serde_json::to_string(&document).unwrap();
            prop_assert_eq!(serde_json::from_str::<ProfileDocument>(&text).unwrap(), document);
        }

        #[test]
        fn heights_and_slopes_belong_together(document in any_kind(), share in 0.001..0.999_f64) {
            let (profile, _) = document.build().unwrap();
            let radius = share * profile.base().0;
            let slope = profile.slope_at_radius(radius);
            let (inner, outer) = (profile.inner_point_at(slope), profile.point_at(slope));
            // on a nearly straight piece the last bits of the slope are a long distance
            let size = 1e-12 * (profile.base().0 + profile.base().1);
            let size = size + BITS * f64::EPSILON * profile.curvature_radius_at(slope);
            prop_assert!(inner.0 <= radius + size && radius <= outer.0 + size, "{inner:?} {radius} {outer:?}");
            let height = profile.height_at_radius(radius);
            let off = (radius - outer.0) * slope.sin() - (height - outer.1) * slope.cos();
            prop_assert!(off.abs() < 1e-10 * (profile.base().0 + profile.base().1), "{off}");
            prop_assert!(slope <= FRAC_PI_2);
        }
    }
}

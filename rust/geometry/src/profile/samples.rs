//! Random profiles of every kind, for tests.

use proptest::prelude::*;

use super::{Profile, ProfileDocument};

/// A document of any kind with a closed form, with sensible random numbers.
pub fn any_document() -> impl Strategy<Value = ProfileDocument> {
    let flat = prop_oneof![Just(0.0), 0.0..0.3_f64];
    (0..14_u8, 1.0..40.0_f64, 0.05..0.95_f64, 0.05..0.95_f64, flat).prop_map(|(kind, diameter, a, b, flat)| {
        let tip_flat = flat * diameter * 0.5;
        let beyond = 0.5 * diameter - tip_flat;
        match kind {
            0 => ProfileDocument::Ball { diameter, radius: None, tip_flat },
            1 => ProfileDocument::Ball { diameter, radius: Some(beyond / a), tip_flat },
            2 => ProfileDocument::Clothoid {
                diameter: Some(diameter),
                scale: None,
                end_slope_deg: Some(90.0 * a),
                tip_flat,
            },
            3 => ProfileDocument::Clothoid { diameter: Some(diameter), scale: None, end_slope_deg: None, tip_flat },
            4 => ProfileDocument::Parabola { apex_radius: diameter * a, diameter, tip_flat },
            5 => ProfileDocument::Ellipse { radial: diameter * a, axial: diameter * b, diameter: None, tip_flat },
            6 => ProfileDocument::Cycloid { diameter, tip_flat },
            7 => ProfileDocument::Power {
                coefficient: a * beyond.powf(-0.1 - 4.0 * b),
                exponent: 1.1 + 4.0 * b,
                diameter,
                tip_flat,
            },
            8 => ProfileDocument::BullNose { diameter, corner_radius: beyond * a, tip_flat },
            9 => ProfileDocument::Barrel { diameter, radius: beyond / a, tip_radius: beyond * b, tip_flat },
            10 => ProfileDocument::Cone { tip_radius: 0.0, half_angle_deg: 89.0 * a, diameter, tip_flat },
            11 => ProfileDocument::TaperedBall { tip_radius: beyond * a, half_angle_deg: 89.0 * b, diameter, tip_flat },
            12 => ProfileDocument::V { tip_diameter: 2.0 * beyond * a, angle_deg: 179.0 * b, diameter, tip_flat },
            _ => ProfileDocument::Flat { diameter, tip_flat: 0.0 },
        }
    })
}

/// A document of convex points: each turns by a part of the whole, and some stand on a line with the two before.
pub fn any_points() -> impl Strategy<Value = ProfileDocument> {
    let step = (0.05..2.0_f64, 0.001..1.0_f64, prop_oneof![4 => Just(0), 1 => 1..4_usize]);
    let flat = prop_oneof![Just(0.0), 0.0..3.0_f64];
    (prop::collection::vec(step, 2..30), 0.1..1.4_f64, flat).prop_map(|(steps, last, tip_flat)| {
        let total: f64 = steps.iter().map(|step| 2.0 * step.1).sum();
        let (mut at, mut slope) = ([0.0, 0.0], 0.0);
        let mut points = vec![at];
        for (length, turned, more) in steps {
            // a step that curves, then one that may go on as a line: two lines would make a corner
            for count in [1, 1 + more] {
                slope += turned / total * last;
                for _ in 0..count {
                    at = [at[0] + length * f64::cos(slope), at[1] + length * f64::sin(slope)];
                    points.push(at);
                }
            }
        }
        ProfileDocument::Points { points, fit_tolerance: 1e-6, tip_flat }
    })
}

/// A document of a formula that is another kind's curve.
pub fn any_formula() -> impl Strategy<Value = ProfileDocument> {
    let flat = prop_oneof![Just(0.0), 0.0..0.3_f64];
    (0..3_u8, 1.0..40.0_f64, 0.2..0.95_f64, flat).prop_map(|(kind, diameter, a, flat)| {
        let (size, tip_flat) = (0.5 * diameter, flat * diameter * 0.5);
        let text = match kind {
            0 => serde_json::json!({"z": format!("r^2 / {}", 4.0 * a * size), "diameter": diameter}),
            1 => serde_json::json!({
                "r": format!("{size} * sin(t)"), "z": format!("{} * cos(t)", a * size), "t": [0.0, 1.5]
            }),
            _ => serde_json::json!({
                "implicit": format!("(r/{size})^2 + (z/{0} - 1)^2 - 1", a * size), "start": [size, a * size]
            }),
        };
        let mut document = text;
        document["kind"] = "formula".into();
        document["tip_flat"] = tip_flat.into();
        serde_json::from_value(document).unwrap()
    })
}

/// A profile of any kind.
pub fn any_profile() -> impl Strategy<Value = Profile> {
    any_kind().prop_map(|document| document.build().unwrap().0)
}

/// A document of any kind, points and formulas too.
pub fn any_kind() -> impl Strategy<Value = ProfileDocument> {
    prop_oneof![14 => any_document(), 4 => any_points(), 1 => any_formula()]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

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
            // on a nearly straight piece the last bits of the slope are a long way
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

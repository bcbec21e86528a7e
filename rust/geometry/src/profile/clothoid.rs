//! The clothoid: radius of curvature times arc length is constant, R L = A (US 2023/0035585).

use std::f64::consts::{FRAC_PI_2, PI};

use super::Meridian;

/// A clothoid from its flat point, the tip.
///
/// The slope at arc length L is L^2 / 2A, so with x = L / sqrt(pi A) radius and height are the
/// Fresnel integrals sqrt(pi A) C(x) and sqrt(pi A) S(x), x from 0 to 1 at a right angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Clothoid {
    /// sqrt(pi A): the arc length to a right angle, mm.
    unit: f64,
}

/// Terms of the Fresnel series: on [0, 1] the twelfth is below 1e-17 of the sum.
const TERMS: usize = 12;

impl Clothoid {
    /// The clothoid with constant `scale` (A, mm^2).
    #[must_use]
    pub fn from_scale(scale: f64) -> Self {
        Self { unit: (PI * scale).sqrt() }
    }

    /// The clothoid that reaches `radius` mm at `end_slope`, rad.
    #[must_use]
    pub fn from_radius(radius: f64, end_slope: f64) -> Self {
        Self { unit: radius / fresnel(parameter(end_slope)).0 }
    }
}

impl Meridian for Clothoid {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        let (c, s) = fresnel(parameter(slope));
        (self.unit * c, self.unit * s)
    }

    fn curvature_radius_at(&self, slope: f64) -> f64 {
        // A / L with L = unit * x
        self.unit / (PI * parameter(slope))
    }

    fn slope_at_radius(&self, radius: f64, within: [f64; 2]) -> f64 {
        let c = radius.max(0.0) / self.unit;
        // C is increasing and concave on [0, 1]: C(x) = c by Newton from the left never overshoots
        let mut x = c + PI * PI / 40.0 * (c * c * (c * c) * c);
        for _ in 0..50 {
            let slope = FRAC_PI_2 * x * x;
            let step = (fresnel(x).0 - c) / libm::cos(slope).max(1e-300);
            x = (x - step).clamp(0.0, 1.0);
            if step.abs() <= 1e-15 * x {
                break;
            }
        }
        (FRAC_PI_2 * x * x).clamp(within[0], within[1])
    }
}

/// x of the Fresnel integrals at a slope: slope = pi x^2 / 2.
fn parameter(slope: f64) -> f64 {
    (slope / FRAC_PI_2).max(0.0).sqrt()
}

/// Fresnel integrals C(x), S(x) for x in [0, 1] by their power series (DLMF 7.6.4 and 7.6.6).
fn fresnel(x: f64) -> (f64, f64) {
    let t = FRAC_PI_2 * x * x;
    let square = t * t;
    let (mut c, mut s) = (0.0, 0.0);
    for n in (0..TERMS).rev() {
        c = COSINE[n] - square * c;
        s = SINE[n] - square * s;
    }
    (x * c, x * t * s)
}

/// 1 / ((2n)! (4n + 1)) and 1 / ((2n + 1)! (4n + 3)).
const COSINE: [f64; TERMS] = coefficients(0);
const SINE: [f64; TERMS] = coefficients(1);

const fn coefficients(odd: usize) -> [f64; TERMS] {
    // sum of (-1)^n t^2n a_n, in Horner form with the alternating sign outside: a_0 - t^2 (a_1 - t^2 ...)
    let mut out = [0.0; TERMS];
    let mut factorial = 1.0;
    let mut n = 0;
    while n < TERMS {
        let k = 2 * n + odd;
        if k > 1 {
            factorial *= (k * (k - 1)) as f64;
        }
        out[n] = 1.0 / (factorial * (2 * k + 1) as f64);
        n += 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn end_point_is_the_fresnel_integrals_at_one() {
        // mpmath: fresnelc(1), fresnels(1)
        let (c, s) = fresnel(1.0);
        assert!((c - 0.779_893_400_376_822_8).abs() < 2e-16, "{c}");
        assert!((s - 0.438_259_147_390_354_77).abs() < 2e-16, "{s}");
    }

    #[test]
    fn base_diameter_20_has_the_published_size() {
        let clothoid = Clothoid::from_radius(10.0, FRAC_PI_2);
        assert!((clothoid.unit - 12.822_26).abs() < 1e-4);
        assert!((clothoid.unit * clothoid.unit / PI - 52.334).abs() < 1e-3);
        assert!((clothoid.point_at(FRAC_PI_2).1 - 5.6195).abs() < 1e-4);
        assert!((clothoid.curvature_radius_at(FRAC_PI_2) - 4.0815).abs() < 1e-4);
    }

    #[test]
    fn radius_gives_back_the_slope() {
        let clothoid = Clothoid::from_radius(10.0, FRAC_PI_2);
        for slope in [0.0, 1e-9, 0.1, 0.5, 1.0, 1.5, 1.57] {
            let (r, _) = clothoid.point_at(slope);
            let back = clothoid.point_at(clothoid.slope_at_radius(r, [0.0, FRAC_PI_2])).0;
            assert!((back - r).abs() < 1e-14 * 10.0, "{slope}: {back} {r}");
        }
    }
}

//! The bound of the engagement angle on circles, and the radii that are tried.
//!
//! A tool of radius r that moves on a circle (O, rho), heading along it, engages at most b if no material lies nearer to O than
//! f(rho) = sqrt(rho^2 + r^2 + 2 rho r cos b): the rim's point at b from the outward normal is exactly f from O, and the rest of the
//! rim ahead is nearer. Two discs of radii rho1, cleared, and rho2 may lie rho1 + r - f(rho2) apart; concentric ones
//! give the profile smoothing radius, equal ones the trochoid (docs/concepts/pockets.md).

/// One degree, rad.
const DEGREE: f64 = 0.017_453_292_519_943_295;
/// What is kept below the bound for chords, the grid and the joints between pieces, rad.
const RESERVE: f64 = 0.5 * DEGREE;
/// What of that is kept where the tool is steered, rad: there the arcs are exact.
const STEERED: f64 = 0.15 * DEGREE;
/// What chords may change of the angle, rad.
const CHORDS: f64 = 0.1 * DEGREE;
/// Chords are never farther than this off their arcs, mm: arcs are put back through their corners (fit.rs), which has to tell them from lines.
const COARSEST: f64 = 5e-4;

/// The bound for one tool.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// The tool's radius, mm.
    pub radius: f64,
    cos: f64,
}

impl Bound {
    /// For a tool of a radius (mm) and a largest angle (rad).
    pub fn new(radius: f64, angle: f64) -> Self {
        Self { radius, cos: libm::cos(angle - RESERVE) }
    }

    /// With less reserve: a path that holds this one comes up to the edge of what the other permits.
    pub fn steering(radius: f64, angle: f64) -> Self {
        Self { radius, cos: libm::cos(angle - STEERED) }
    }

    /// Distance that material keeps from the centre of a circle of radius rho on which the tool moves, mm.
    pub fn keep(&self, rho: f64) -> f64 {
        let r = self.radius;
        (rho * rho + r * r + 2.0 * rho * r * self.cos).sqrt()
    }

    /// Radius of the largest circle to the left, along whose tangent the tool goes, from whose centre a point keeps its distance, mm: the
    /// point as seen from the tool, along the tangent and to the left of it. None where it does from no such centre, or
    /// from those of larger circles only.
    pub fn widest(&self, point: [f64; 2]) -> Option<f64> {
        let r = self.radius;
        let ahead = point[1] + r * self.cos;
        let radius = 0.5 * (point[0] * point[0] + point[1] * point[1] - r * r) / ahead;
        (ahead > 0.0 && radius > 0.0).then_some(radius)
    }

    /// How far chords may be off the arcs of the distances kept about circles of radius rho: the angle changes by a tenth of a degree.
    pub fn tolerance(&self, rho: f64) -> f64 {
        let sin = (1.0 - self.cos * self.cos).sqrt();
        (CHORDS * rho * self.radius * sin / self.keep(rho)).min(COARSEST)
    }
}

/// Radii from `largest` down to `smallest`, each 0.7 of the one before.
pub fn ladder(largest: f64, smallest: f64) -> Vec<f64> {
    let mut radii = Vec::new();
    let mut radius = largest;
    while radius > 1.1 * smallest {
        radii.push(radius);
        radius *= 0.7;
    }
    radii.push(smallest.min(largest));
    radii
}

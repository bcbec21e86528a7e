//! By how much the stock of a starter job is larger than the part.

use styluscam_geometry::Mesh;

use super::sizes::round;

/// By how much the stock is larger than the part's box, as a share of the part's largest size, and the limits of that, mm: what a saw
/// leaves, and half of it on top.
const ALLOWANCE: f64 = 0.02;
const ALLOWANCES: [f64; 2] = [0.2, 2.0];
const ON_TOP: f64 = 0.5;

/// By how much the stock is larger than the part's box.
#[derive(Clone, Copy, Debug)]
pub struct Allowances {
    /// On each of the four sides, mm.
    pub sides: f64,
    /// On top, mm.
    pub top: f64,
}

impl Allowances {
    /// What a sawn block has.
    pub fn of(mesh: &Mesh) -> Self {
        let (low, high) = mesh.bounds();
        let [least, most] = ALLOWANCES;
        let sides = round((ALLOWANCE * (high - low).max()).clamp(least, most));
        Self { sides, top: ON_TOP * sides }
    }
}

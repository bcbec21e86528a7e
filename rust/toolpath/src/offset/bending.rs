//! How a profile bends around a contact: more along its meridian than around its axis.

use styluscam_geometry::Cutter;

/// Radii at which it is known.
const CELLS: usize = 256;
/// Most and least of what the meridian's bending exceeds the other by, as a share of that: it points to where a triangle
/// is touched, and need not be exact.
const LIMITS: [f64; 2] = [-0.9, 100.0];

/// Bending by the radius of a contact.
pub struct Bending {
    cells_per_mm: f64,
    excess: Vec<f64>,
}

impl Bending {
    pub fn of(cutter: &Cutter) -> Self {
        let width = cutter.max_radius() / CELLS as f64;
        let excess = (0..CELLS).map(|cell| excess(cutter, (cell as f64 + 0.5) * width)).collect();
        Self { cells_per_mm: 1.0 / width, excess }
    }

    /// What the second derivative of the profile's height along the meridian exceeds that across it by, as a share of it.
    pub fn excess_at(&self, radius: f64) -> f64 {
        self.excess[((radius * self.cells_per_mm) as usize).min(CELLS - 1)]
    }
}

fn excess(cutter: &Cutter, radius: f64) -> f64 {
    let slope = cutter.slope_at_radius(radius);
    let cos = libm::cos(slope);
    let ratio = radius / (libm::tan(slope) * cutter.curvature_radius_at(slope) * cos * cos * cos);
    let [least, most] = LIMITS;
    // a flat tip bends nowhere
    if ratio.is_nan() {
        0.0
    } else {
        (ratio - 1.0).clamp(least, most)
    }
}

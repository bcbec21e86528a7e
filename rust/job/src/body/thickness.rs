//! How thick a closed body is: from each point straight into the material to the other side.

use super::samples::Sample;
use super::{Body, Shell};

/// Thicknesses this near to the middle one, as a share of it, are the same.
const ALIKE: f64 = 0.15;
/// Share of the area that a sheet's two faces have: its rim, and what is thicker in sharp folds, is the rest.
const SHEET: f64 = 0.8;
/// A sheet is this much thinner than the side of a square of its area.
const THIN: f64 = 0.08;

/// Local thickness over the area of a closed body, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thickness {
    /// Half of the area is thicker.
    pub median: f64,
    /// A twentieth of the area is thinner.
    pub thin: f64,
    /// A twentieth of the area is thicker.
    pub thick: f64,
    /// Share of the area whose thickness is nearly the median.
    pub alike: f64,
    /// The median against the side of a square as large as one of two faces.
    pub slenderness: f64,
}

impl Thickness {
    /// Whether the body is a sheet of one thickness.
    #[must_use]
    pub fn is_sheet(&self) -> bool {
        self.alike >= SHEET && self.slenderness <= THIN
    }
}

impl Body<'_> {
    /// How thick a body is that encloses a volume, but for holes where triangles are missing; none for other surfaces.
    #[must_use]
    pub fn thickness(&self) -> Option<Thickness> {
        if !matches!(self.shell(), Shell::Closed | Shell::Torn) {
            return None;
        }
        let through = |sample: &Sample| {
            let hit = self.rays.first(sample.point, -sample.normal, self.fine(), |hit| hit.along > 0.0);
            hit.map(|hit| hit.distance)
        };
        let mut all: Vec<f64> = self.samples.iter().filter_map(through).collect();
        all.sort_by(f64::total_cmp);
        let at = |share: f64| all.get((share * (all.len() as f64 - 1.0)).round() as usize).copied();
        let median = at(0.5)?;
        let alike = all.iter().filter(|t| (**t - median).abs() <= ALIKE * median).count() as f64;
        let mesh = self.mesh();
        let area: f64 = (0..mesh.triangles().len()).map(|t| mesh.area(t)).sum();
        Some(Thickness {
            median,
            thin: at(0.05)?,
            thick: at(0.95)?,
            alike: alike / self.samples.len() as f64,
            slenderness: median / (0.5 * area).sqrt(),
        })
    }
}

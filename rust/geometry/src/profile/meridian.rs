//! What every smooth curve of a profile answers.

use super::solve;

/// A smooth curve by slope, relative to its start.
///
/// Slopes are those of the piece that the curve stands in; implementors need not clamp them. Where a curve has a closed
/// form of an inverse, it gives it in place of the one by Newton's method.
pub trait Meridian {
    /// Radius and height at a slope, mm.
    fn point_at(&self, slope: f64) -> (f64, f64);

    /// Radius of curvature of the meridian at a slope, mm; infinite where it is flat.
    fn curvature_radius_at(&self, slope: f64) -> f64;

    /// The slope at a radius, rad, one of `within`; to rounding.
    fn slope_at_radius(&self, radius: f64, within: [f64; 2]) -> f64 {
        solve::slope_at_radius(|slope| (self.point_at(slope), self.curvature_radius_at(slope)), radius, within)
    }

    /// The slope at a height, rad, one of `within`; to rounding.
    fn slope_at_height(&self, height: f64, within: [f64; 2]) -> f64 {
        solve::slope_at_height(|slope| (self.point_at(slope), self.curvature_radius_at(slope)), height, within)
    }

    /// The slope of the point nearest to (r, z) of those with a slope of `within`, rad; about `guess`.
    fn slope_nearest(&self, point: (f64, f64), within: [f64; 2], guess: f64) -> f64 {
        solve::slope_nearest(|slope| (self.point_at(slope), self.curvature_radius_at(slope)), point, within, guess)
    }

    /// The height at a radius, mm, its slope one of `within`.
    fn height_at_radius(&self, radius: f64, within: [f64; 2]) -> f64 {
        self.point_at(self.slope_at_radius(radius, within)).1
    }
}

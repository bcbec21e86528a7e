//! How much of a part is steeper than an angle.

use styluscam_geometry::Vector;

use super::hollows::UPRIGHT_DEG;
use super::samples::Sample;
use super::Body;

impl Body<'_> {
    /// Share of the area seen from above that is steeper than an angle, degrees. Upright walls count where another stands
    /// opposite, as in a pit: those around the whole part are a block's sides, or a sheet's rim.
    #[must_use]
    pub fn steeper(&self, slope_deg: f64) -> f64 {
        let (limit, upright) = (libm::cos(slope_deg.to_radians()), libm::cos(UPRIGHT_DEG.to_radians()));
        let is_steep =
            |sample: &Sample| sample.normal.z < limit && (sample.normal.z > upright || self.gap(sample).is_some());
        let seen = self.samples.iter().filter(|sample| self.is_seen(sample, Vector::z()));
        let (all, steep) = seen.fold((0, 0), |(all, steep), sample| (all + 1, steep + i32::from(is_steep(sample))));
        f64::from(steep) / f64::from(all.max(1))
    }
}

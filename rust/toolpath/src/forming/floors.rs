//! Levels at floors: the clearance that an envelope keeps would hide a floor's height, and all that stands on the floor.

use crate::offset::Envelope;

/// Triangles count as horizontal whose unit normal lies this near to the vertical, in its cosine: a slope of 1e-6.
const LEVEL: f64 = 5e-13;
/// A floor counts as at a height up to this far over it, mm: as near as files of single precision tell heights.
const BESIDE: f64 = 1e-5;

/// The tips of a tool that stands on the horizontal triangles of a mesh.
#[derive(Clone, Debug, Default)]
pub struct Floors {
    ascending: Vec<f64>,
    /// How far a tip lies over the height at which the tool would touch the floor.
    margin: f64,
}

impl Floors {
    /// Of all horizontal triangles, selected or not.
    #[must_use]
    pub fn of(envelope: &Envelope<'_>) -> Self {
        let mesh = envelope.mesh();
        let is_level = |t: &usize| mesh.normal(*t).z.abs() >= 1.0 - LEVEL;
        let highest = |t: usize| mesh.corners(t).iter().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max);
        let levels = (0..mesh.triangles().len()).filter(is_level);
        Self::under(levels.map(|t| envelope.tip_on(highest(t))).collect(), envelope.margin())
    }

    fn under(mut tips: Vec<f64>, margin: f64) -> Self {
        tips.sort_unstable_by(f64::total_cmp);
        tips.dedup();
        Self { ascending: tips, margin }
    }

    /// Floors at some heights under a tool without a sheet.
    #[cfg(test)]
    pub fn at(heights: &[f64], margin: f64) -> Self {
        Self::under(heights.iter().map(|z| z + margin).collect(), margin)
    }

    /// A level's height, mm, raised by at most the envelope's margin where a tool without it would touch a floor: there it
    /// stands on the floor, and not within it.
    #[must_use]
    pub fn raised(&self, z: f64) -> f64 {
        let beyond = self.ascending.partition_point(|tip| *tip <= z + self.margin + BESIDE);
        self.ascending[..beyond].last().map_or(z, |tip| tip.max(z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_is_raised_onto_a_floor_and_no_further() {
        let floors = Floors::under(vec![7.003, 2.003, 2.005], 0.003);
        let heights = [1.9, 1.99998, 2.0, 2.0029, 2.004, 2.0051, 6.9999];
        let raised: Vec<f64> = heights.iter().map(|z| floors.raised(*z)).collect();
        assert_eq!(raised, [1.9, 1.99998, 2.003, 2.005, 2.005, 2.0051, 6.9999]);
    }
}

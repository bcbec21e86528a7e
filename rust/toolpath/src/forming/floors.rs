//! Levels at floors: the clearance that an envelope keeps would hide a floor's height, and all that stands on the floor.

use crate::offset::Envelope;

/// Triangles count as horizontal whose unit normal lies this near to the vertical, in its cosine: a slope of 1e-4,
const LEVEL: f64 = 5e-9;
/// and whose corners lie this near to one height, as a share of the largest coordinate: a unit of a file of six digits.
/// A floor counts as at a level up to so far over it.
const SIX_DIGITS: f64 = 1e-5;
/// But not farther than this share of the margin.
const BESIDE: f64 = 0.5;
/// A level that is no higher over a floor than this, mm, stands on it.
const ON_FLOOR: f64 = 0.02;

/// The tips of a tool that stands on the horizontal triangles of a mesh.
#[derive(Clone, Debug, Default)]
pub struct Floors {
    ascending: Vec<f64>,
    /// How far over a level a tip may be to be taken for it, mm: the envelope's margin and a little more.
    reach: f64,
}

impl Floors {
    /// Of all horizontal triangles that face up, selected or not.
    #[must_use]
    pub fn of(envelope: &Envelope<'_>) -> Self {
        let (mesh, margin) = (envelope.mesh(), envelope.margin());
        let (low, high) = mesh.bounds();
        let beside = (SIX_DIGITS * low.amax().max(high.amax())).min(BESIDE * margin);
        let floor = |t: usize| {
            let heights = mesh.corners(t).map(|corner| corner.z);
            let [low, high] = [f64::min, f64::max].map(|of| heights.into_iter().fold(heights[0], of));
            let is_level = mesh.normal(t).z >= 1.0 - LEVEL && high - low <= beside;
            is_level.then(|| envelope.tip_on(high))
        };
        Self::under((0..mesh.triangles().len()).filter_map(floor).collect(), margin + beside)
    }

    fn under(mut tips: Vec<f64>, reach: f64) -> Self {
        tips.sort_unstable_by(f64::total_cmp);
        tips.dedup();
        Self { ascending: tips, reach }
    }

    /// Floors at some heights under a tool without a sheet.
    #[cfg(test)]
    pub fn at(heights: &[f64], margin: f64) -> Self {
        Self::under(heights.iter().map(|z| z + margin).collect(), margin + 1e-5)
    }

    /// The heights within which a level stands on each floor: the tip on it, and a little more; mm.
    #[must_use]
    pub fn bands(&self) -> Vec<(f64, f64)> {
        self.ascending.iter().map(|tip| (*tip, tip + ON_FLOOR)).collect()
    }

    /// A level's height, mm, raised by at most one and a half of the envelope's margin where a tool without it would touch a
    /// floor: there it stands on the floor, and not within it.
    #[must_use]
    pub fn raised(&self, z: f64) -> f64 {
        let beyond = self.ascending.partition_point(|tip| *tip <= z + self.reach);
        self.ascending[..beyond].last().map_or(z, |tip| tip.max(z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_is_raised_onto_a_floor_and_no_further() {
        let floors = Floors::under(vec![7.003, 2.003, 2.005], 0.00301);
        let heights = [1.9, 1.99998, 2.0, 2.0029, 2.004, 2.0051, 6.9999];
        let raised: Vec<f64> = heights.iter().map(|z| floors.raised(*z)).collect();
        assert_eq!(raised, [1.9, 1.99998, 2.003, 2.005, 2.005, 2.0051, 6.9999]);
    }
}

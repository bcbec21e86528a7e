//! Into how many blocks an arc goes, and whether it is posted as arcs at all.

use styluscam_motion::{Arc, ArcPath};

use crate::machine::{Lathe, Machine, Turns};
use crate::rounded::RoundedArc;

impl Machine {
    /// In how many blocks an arc is posted, and how many full turns beyond its first arrival each has.
    pub(crate) fn arc_blocks(&self, path: &ArcPath, turns: u32) -> (u32, u32) {
        match &self.arc {
            Some(rules) if rules.turns != Turns::None && rules.max_sweep_deg >= 360.0 => (1, turns),
            Some(rules) => ((path.sweep().abs().to_degrees() / rules.max_sweep_deg - 1e-9).ceil().max(1.0) as u32, 0),
            None => (1, 0),
        }
    }

    /// Whether an arc of the tip between two points, mm, is posted as arcs, not as lines; `height` is that of the posted point
    /// above the tip, mm.
    #[must_use]
    pub fn posts_arc(&self, [start, end]: [[f64; 3]; 2], arc: &Arc, height: f64) -> bool {
        let Some(rules) = &self.arc else { return false };
        let path = arc.path(start, end);
        let (pieces, turns) = self.arc_blocks(&path, arc.turns);
        let x_scale = self.x_scale();
        let count = |[x, y, z]: [f64; 3], x_scale: f64| -> Option<[i64; 3]> {
            let counts =
                [x * x_scale, y, z + height].map(|mm| self.linear_format().count(mm / self.units.output.in_mm()));
            Some([counts[0]?, counts[1]?, counts[2]?])
        };
        let is_taken = |piece: u32| {
            let share = |i: u32| f64::from(i) / f64::from(pieces);
            let part = path.part(share(piece), share(piece + 1));
            let (from, to) = (count(part.at(0.0), x_scale)?, count(part.at(1.0), x_scale)?);
            let rounded = RoundedArc::new(Arc { turns, ..*arc }, from, to, count(arc.centre, 1.0)?, x_scale);
            Some(rounded.stands_for(&part, rules, self.resolution_mm()))
        };
        (0..pieces).all(|piece| is_taken(piece) == Some(true))
    }

    /// How often X is counted: twice where it is a diameter.
    pub(crate) fn x_scale(&self) -> f64 {
        if self.motion.lathe == Some(Lathe::Diameter) {
            2.0
        } else {
            1.0
        }
    }
}

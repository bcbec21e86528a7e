//! An arc with the numbers that would be posted, and whether the controller takes it.

use styluscam_motion::{Arc, ArcWay};

use crate::machine::ArcRules;

/// An arc of which the ends and the centre stand in last places.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundedArc {
    /// Plane, sense and turns.
    pub arc: Arc,
    pub from: [i64; 3],
    pub to: [i64; 3],
    /// The centre from the start.
    pub offset: [i64; 3],
}

impl RoundedArc {
    /// Whether a controller takes it for the way that is meant; `unit` is the last place, mm.
    ///
    /// A way too short for its ends to differ once rounded would be taken for a full circle.
    pub fn stands_for(&self, way: &ArcWay, rules: &ArcRules, unit: f64) -> bool {
        let place = |count: [i64; 3]| count.map(|c| c as f64 * unit);
        let centre = [0, 1, 2].map(|axis| self.from[axis] + self.offset[axis]);
        let posted = Arc { centre: place(centre), ..self.arc }.way(place(self.from), place(self.to));
        let as_meant = (posted.sweep() - way.sweep()).abs() < 1.0;
        as_meant && posted.radius() > 0.0 && rules.radius_error.takes(posted.mismatch(), posted.radius())
    }
}

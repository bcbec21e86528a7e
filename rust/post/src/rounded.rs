//! An arc with the numbers that would be posted, and whether the controller takes it.

use styluscam_motion::{Arc, ArcPath};

use crate::machine::ArcRules;

/// An arc of a smaller angle, rad, becomes a line: controllers differ in whether one of 1e-6 and less is a full circle.
const LEAST: f64 = 1e-5;

/// What arithmetic may add to a difference of radii, mm.
const ARITHMETIC: f64 = 1e-9;

/// A radius of fewer units of the last decimal is hardly a circle once rounded: it becomes lines.
const LEAST_PLACES: f64 = 5.0;

/// An arc of which the ends and the centre stand in units of the last decimal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundedArc {
    /// Plane, sense and turns.
    pub arc: Arc,
    pub from: [i64; 3],
    pub to: [i64; 3],
    /// The centre from the start.
    pub offset: [i64; 3],
    /// How often X is counted in `from` and `to`: twice where it is a diameter.
    x_scale: f64,
}

impl RoundedArc {
    /// `centre` counts every axis once.
    pub fn new(arc: Arc, from: [i64; 3], to: [i64; 3], centre: [i64; 3], x_scale: f64) -> Self {
        let once = |axis: usize, count: i64| if axis == 0 && x_scale > 1.0 { count / 2 } else { count };
        let offset = [0, 1, 2].map(|axis| centre[axis] - once(axis, from[axis]));
        Self { arc, from, to, offset, x_scale }
    }

    /// The centre from the zero point.
    pub fn centre(&self) -> [i64; 3] {
        [0, 1, 2].map(|axis| self.from[axis] + self.offset[axis])
    }

    /// The path that is posted; `unit` is the last decimal, mm.
    pub fn path(&self, unit: f64) -> ArcPath {
        let scale = [self.x_scale, 1.0, 1.0];
        let position = |count: [i64; 3]| [0, 1, 2].map(|axis| count[axis] as f64 * unit / scale[axis]);
        let start = position(self.from);
        let centre = [0, 1, 2].map(|axis| start[axis] + self.offset[axis] as f64 * unit);
        Arc { centre, ..self.arc }.path(start, position(self.to))
    }

    /// Whether a controller takes it for the path that is meant; `unit` is the last decimal, mm.
    ///
    /// A path too short for its ends to differ once rounded would be taken for a full circle.
    pub fn stands_for(&self, path: &ArcPath, rules: &ArcRules, unit: f64) -> bool {
        let [_, _, third] = self.arc.plane.axes();
        if !rules.planes.contains(&self.arc.plane) || !(rules.helix || self.from[third] == self.to[third]) {
            return false;
        }
        let posted = self.path(unit);
        let as_meant = (posted.sweep() - path.sweep()).abs() < 1.0 && posted.sweep().abs() > LEAST;
        let radius = posted.radius();
        let in_range =
            radius > rules.min_radius.max(LEAST_PLACES * unit) && rules.max_radius.is_none_or(|most| radius <= most);
        // the controller computes again, and rounds otherwise
        as_meant && in_range && rules.radius_error.takes(posted.mismatch() + ARITHMETIC, radius)
    }
}

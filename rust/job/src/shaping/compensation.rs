//! Where points of the target are formed, and back.

use std::sync::Arc;

use styluscam_geometry::{DisplacementField, Vector};

/// Steps back from a formed point to the target at most: each leaves the deviation's gradient of the error, and 0.3 to the 20th
/// is 3e-11.
const STEPS: usize = 20;
/// A step that leads no farther than this, mm, is the last.
const ARRIVED: f64 = 1e-9;
/// Points that lie no deeper than this under the sheet's plane are on it, mm: the rounding of arithmetic.
const ON_PLANE: f64 = 1e-6;

/// What becomes of a point.
#[derive(Clone, Debug)]
pub struct Compensation {
    /// The trials' deviations.
    pub fields: Arc<[DisplacementField]>,
    /// Share of them that is compensated.
    pub factor: f64,
    /// Beyond this distance from measured points, mm, they fade.
    pub max_gap: f64,
    /// Towards the spindle, in the frame of the part's file.
    pub up: Vector,
    /// Height of the sheet's plane along `up`: nothing is formed above it.
    pub plane: f64,
}

impl Compensation {
    /// Where the trials' deviations lead a point.
    pub fn moved(&self, point: Vector) -> Vector {
        point - self.factor * self.fields.iter().map(|field| self.known(field, point)).sum::<Vector>()
    }

    /// The deviation at a point. It fades to nothing over the largest gap beyond it: what no one measured stays as it is, and
    /// inside a block deviations of opposite walls do not meet.
    fn known(&self, field: &DisplacementField, point: Vector) -> Vector {
        let (deviation, gap) = field.at(point);
        let beyond = (gap / self.max_gap - 1.0).clamp(0.0, 1.0);
        deviation * (1.0 - beyond * beyond * (3.0 - 2.0 * beyond))
    }

    /// Whether a position lies in the sheet's plane, or above it.
    pub fn is_on_plane(&self, position: Vector) -> bool {
        self.up.dot(&position) > self.plane - ON_PLANE
    }

    /// How far a position lies above the sheet's plane, mm; 0 below it.
    pub fn above(&self, position: Vector) -> f64 {
        (self.up.dot(&position) - self.plane).max(0.0)
    }

    /// Where a point of the target is formed.
    pub fn formed(&self, point: Vector) -> Vector {
        let moved = self.moved(point);
        moved - self.above(moved) * self.up
    }

    /// The point of the target that is formed there; none in the sheet's plane, where several may be.
    pub fn undone(&self, formed: Vector) -> Option<Vector> {
        if self.is_on_plane(formed) {
            return None;
        }
        let mut point = formed;
        for _ in 0..STEPS {
            let step = formed - self.moved(point);
            point += step;
            if step.norm() < ARRIVED {
                break;
            }
        }
        Some(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half of a rise by 0.3 mm is compensated, measured at points of a square of 8 mm in the plane z = -1.
    fn compensation() -> Compensation {
        let points: Vec<Vector> = (0..81).map(|i| Vector::new(f64::from(i % 9), f64::from(i / 9), -1.0)).collect();
        let field = DisplacementField::new(&points, &[Vector::new(0.0, 0.0, -0.3); 81]).unwrap();
        Compensation { fields: [field].into(), factor: 0.5, max_gap: 2.0, up: Vector::z(), plane: 0.0 }
    }

    #[test]
    fn what_was_measured_moves_and_what_lies_far_from_it_stays() {
        let (near, far) = (Vector::new(3.3, 4.4, -2.0), Vector::new(3.3, 4.4, -5.1));
        assert!((compensation().formed(near) - near - Vector::new(0.0, 0.0, 0.15)).norm() < 1e-12);
        assert!((compensation().formed(far) - far).norm() < 1e-12);
        let between = Vector::new(3.0, 4.0, -4.0);
        let moved = compensation().formed(between).z - between.z;
        assert!((moved - 0.075).abs() < 1e-12, "{moved}");
    }

    #[test]
    fn nothing_is_formed_above_the_sheets_plane_and_points_below_it_are_taken_back() {
        let (high, low) = (Vector::new(3.0, 4.0, -0.1), Vector::new(3.0, 4.0, -1.5));
        let formed = compensation().formed(high);
        assert!(formed.z.abs() < 1e-12 && (compensation().above(compensation().moved(high)) - 0.05).abs() < 1e-12);
        assert_eq!(compensation().undone(formed), None);
        let back = compensation().undone(compensation().formed(low)).unwrap();
        assert!((back - low).norm() < 1e-9, "{back}");
    }
}

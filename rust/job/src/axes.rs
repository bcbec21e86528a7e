//! The machine's axes, as the job's set-up turns the model to them.

use styluscam_geometry::{Frame, Vector};

use crate::{Chuck, SetupSection};

impl SetupSection {
    /// The turn from the model to the machine's axes.
    #[must_use]
    pub(crate) fn turn(&self) -> Frame {
        Frame::turning_up(self.up.vector(), self.rotation.to_radians()).then(&self.chuck.turn())
    }

    /// The direction of the model that points to the spindle.
    #[must_use]
    pub(crate) fn to_spindle(&self) -> Vector {
        match self.chuck {
            Chuck::Above => self.up.vector(),
            Chuck::Below => -self.up.vector(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::UpAxis;

    #[test]
    fn below_x_stays_and_y_and_z_turn_round() {
        for up in [UpAxis::PlusX, UpAxis::MinusX, UpAxis::PlusY, UpAxis::MinusY, UpAxis::PlusZ, UpAxis::MinusZ] {
            let above = SetupSection { up, rotation: 30.0, ..SetupSection::default() };
            let below = SetupSection { chuck: Chuck::Below, ..above.clone() };
            let p = Vector::new(1.0, 2.0, 3.0);
            let [there, here] = [above.turn().point(p), below.turn().point(p)];
            assert_eq!(here, Vector::new(there.x, -there.y, -there.z));
            assert_eq!(below.turn().direction(below.to_spindle()), Vector::z());
        }
    }
}

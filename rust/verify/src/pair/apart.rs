//! How far two tools are apart that face each other: one comes from above, the other from below.
//!
//! Both are convex solids of revolution about vertical axes, and what separates them best is a plane that stands upright on
//! the plane through both axes. Its distance from each tool is that tool's support function, r sin(s) - z cos(s) at the slope s
//! where the meridian has the point (r, z); over the slopes the sum has one maximum, the distance.

use std::f64::consts::FRAC_PI_2;

use styluscam_geometry::{ToolBody, Vector};

use crate::body::length;
use crate::subject::Left;

/// Halvings of the right angle in which the slope lies: it is right to 1e-9, and the distance, flat there, to rounding.
const HALVINGS: usize = 30;

/// No sheet.
pub const NOTHING: Left = Left { normal: 0.0, vertical: 0.0 };

/// How far two tools are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// The room beyond the sheet, mm; negative where that is more than there is room for. Without a sheet their distance.
    pub value: f64,
    /// Unit vector from the tool below to the one above, where they are nearest: the value's gradient.
    pub away: Vector,
}

impl Apart {
    /// What is left of a distance beyond a sheet that lies square to the line on which the tools are nearest, mm.
    pub fn beyond(&self, sheet: Left) -> f64 {
        self.value - sheet.normal - sheet.vertical * self.away.z
    }
}

/// How far the tool above, whose tip is `between` from that of the tool below, is from it with a sheet between them: a ball
/// around either, or a lift of the tool below. A convex function of `between`.
pub fn apart(above: &ToolBody, below: &ToolBody, between: Vector, sheet: Left) -> Apart {
    let (axes, rise) = (length(between.x, between.y), between.z - sheet.vertical);
    // radius and height over the tips, of both together
    let both = |slope: f64| {
        let ([r, z], [s, w]) = (meridian(above, slope), meridian(below, slope));
        [r + s, z + w]
    };
    let widens = |slope: f64| {
        let (sin, cos) = libm::sincos(slope);
        let [radii, heights] = both(slope);
        (axes - radii) * cos > (rise + heights) * sin
    };
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if widens(middle) { &mut low } else { &mut high }) = middle;
    }
    // the ends of the range are exact
    let slope = match (low > 0.0, high < FRAC_PI_2) {
        (true, true) => 0.5 * (low + high),
        (true, false) => FRAC_PI_2,
        (false, _) => 0.0,
    };
    let (sin, cos) = libm::sincos(slope);
    let [radii, heights] = both(slope);
    let aside = if axes > 0.0 { Vector::new(between.x, between.y, 0.0) / axes } else { Vector::x() };
    Apart { value: (axes - radii) * sin + (rise + heights) * cos - sheet.normal, away: aside * sin + Vector::z() * cos }
}

/// Radius, and height over the tool's tip, at a slope, mm.
fn meridian(body: &ToolBody, slope: f64) -> [f64; 2] {
    let (radius, height) = body.point_at(slope);
    [radius, height - body.tip_above()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use styluscam_geometry::{kinds, ProfileDocument, Tool, ToolDocument};

    fn ball(diameter: f64) -> ToolBody {
        let profile = ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 });
        Tool::new(ToolDocument::of(profile)).unwrap().body(None)
    }

    #[test]
    fn balls_are_as_far_apart_as_their_centres_less_their_radii() {
        let (above, below) = (ball(10.0), ball(6.0));
        for between in [[0.0, 0.0, 2.0], [3.0, -1.0, 0.5], [6.0, 2.0, -1.0], [1.0, 0.0, -3.0]] {
            let between = Vector::from(between);
            let centres = between + Vector::z() * 8.0;
            let found = apart(&above, &below, between, NOTHING);
            assert!((found.value - (centres.norm() - 8.0)).abs() < 1e-12, "{between}: {}", found.value);
            assert!((found.away - centres.normalize()).norm() < 1e-8);
        }
    }

    #[test]
    fn cylinders_beside_each_other_are_as_far_apart_as_their_axes_less_their_radii() {
        let found = apart(&ball(10.0), &ball(6.0), Vector::new(0.0, 9.0, -20.0), NOTHING);
        assert!((found.value - 1.0).abs() < 1e-12 && (found.away - Vector::y()).norm() < 1e-8);
    }

    #[test]
    fn a_sheet_is_as_thick_as_its_law_has_it_where_the_tools_are_nearest() {
        let found = apart(&ball(10.0), &ball(6.0), Vector::new(6.0, 0.0, 0.0), NOTHING);
        assert!((found.value - 2.0).abs() < 1e-12 && (found.away.z - 0.8).abs() < 1e-8);
        assert!((found.beyond(Left { normal: 0.7, vertical: 0.0 }) - 1.3).abs() < 1e-12);
        assert!((found.beyond(Left { normal: 0.0, vertical: 0.5 }) - 1.6).abs() < 1e-8);
    }

    #[test]
    fn a_sheet_of_columns_leaves_as_much_as_a_tool_below_that_is_lifted_by_it() {
        let (above, below, between) = (ball(10.0), ball(6.0), Vector::new(4.0, 0.0, -1.0));
        let columns = apart(&above, &below, between, Left { normal: 0.0, vertical: 0.8 }).value;
        let lifted = apart(&above, &below, between - Vector::z() * 0.8, NOTHING).value;
        assert!((columns - lifted).abs() < 1e-12);
    }
}

//! A tool of a starter job: a shape and a diameter.

use styluscam_geometry::{kinds, ProfileDocument, Tool, ToolDocument};

use super::text::number;

/// Angle of a twist drill's point, degrees (DIN 338, for steel and cast metal).
const DRILL_POINT_DEG: f64 = 118.0;

/// The tool's profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// For slopes, and whatever has fillets at its floors.
    Ball,
    /// For floors and upright walls.
    Flat,
    /// For holes: a twist drill.
    Drill,
}

/// A tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutter {
    pub shape: Shape,
    /// mm.
    pub diameter: f64,
}

impl Cutter {
    /// Its profile as a job states it.
    pub fn profile(&self) -> String {
        let diameter = number(self.diameter);
        match self.shape {
            Shape::Ball => format!("{{ kind = \"ball\", diameter = {diameter} }}"),
            Shape::Flat => format!("{{ kind = \"flat\", diameter = {diameter} }}"),
            Shape::Drill => {
                format!("{{ kind = \"v\", angle_deg = {}, diameter = {diameter} }}", number(DRILL_POINT_DEG))
            }
        }
    }

    /// The tool itself; none where its diameter is no tool's.
    pub fn made(&self) -> Option<Tool> {
        let diameter = self.diameter;
        let profile = match self.shape {
            Shape::Ball => ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }),
            Shape::Flat => ProfileDocument::from(kinds::Flat { diameter, tip_flat: 0.0 }),
            Shape::Drill => {
                let (tip_diameter, angle_deg) = (0.0, DRILL_POINT_DEG);
                ProfileDocument::from(kinds::V { tip_diameter, angle_deg, diameter, tip_flat: 0.0 })
            }
        };
        Tool::new(ToolDocument::of(profile)).ok()
    }
}

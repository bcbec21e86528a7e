//! The sheet between tool and part.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::GeometryError;

/// How thickness behaves as the sheet is formed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SheetLaw {
    /// The same thickness everywhere, along the normal.
    #[default]
    Constant,
    /// Pure shear: a vertical column keeps its height, so a wall of slope phi is t cos(phi) thick.
    Sine,
}

/// Which face of the sheet the model shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ModelFace {
    /// The face that the tool touches.
    Tool,
    /// The face away from the tool.
    Back,
    /// The middle of the sheet.
    Mid,
}

/// The blank and its relation to the model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// Thickness of the blank, mm.
    pub thickness: f64,
    /// How the thickness behaves.
    #[serde(default)]
    pub law: SheetLaw,
    /// Which face the model shows.
    pub model_face: ModelFace,
}

impl Sheet {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A thickness that is not a positive length.
    pub fn checked(self) -> Result<Self, GeometryError> {
        crate::error::positive_length("thickness", self.thickness)?;
        Ok(self)
    }

    /// Sheet between model and tool, as a share of its thickness: 0, 1/2 or 1.
    #[must_use]
    pub fn share(&self) -> f64 {
        match self.model_face {
            ModelFace::Tool => 0.0,
            ModelFace::Mid => 0.5,
            ModelFace::Back => 1.0,
        }
    }

    /// Sheet between model and tool along the normal: the radius of the ball that it adds to the tool, mm.
    #[must_use]
    pub fn along_normal(&self) -> f64 {
        match self.law {
            SheetLaw::Constant => self.share() * self.thickness,
            SheetLaw::Sine => 0.0,
        }
    }

    /// Sheet between model and tool along the vertical, where the law keeps columns: the tool rises by it, mm.
    #[must_use]
    pub fn along_vertical(&self) -> f64 {
        match self.law {
            SheetLaw::Constant => 0.0,
            SheetLaw::Sine => self.share() * self.thickness,
        }
    }

    /// How far the sheet lifts the tool over a horizontal face of the model, mm.
    #[must_use]
    pub fn raise(&self) -> f64 {
        self.along_normal() + self.along_vertical()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_raise_is_the_sheet_between_model_and_tool_by_either_law() {
        for law in [SheetLaw::Constant, SheetLaw::Sine] {
            for (model_face, raise) in [(ModelFace::Tool, 0.0), (ModelFace::Mid, 0.75), (ModelFace::Back, 1.5)] {
                assert_eq!(Sheet { thickness: 1.5, law, model_face }.raise().to_bits(), f64::to_bits(raise));
            }
        }
    }
}

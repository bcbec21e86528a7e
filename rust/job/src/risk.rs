//! Risks that a job takes by name: the verifier then warns of them, and the program is written.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_verify::FindingKind;

/// What is an error of the verdict unless the job accepts it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Risk {
    /// Walls steeper than the material withstands in one pass.
    #[schemars(extend("x-takes-sheet" = true))]
    WallAngle,
    /// The sheet becomes thinner than min_thickness.
    #[schemars(extend("x-takes-sheet" = true))]
    Thinning,
    /// The tool goes deeper into sheet that is not formed yet than a step.
    #[schemars(extend("x-takes-sheet" = true))]
    Punch,
    /// The tool bridges faces by more than it may: it is less curved than they are.
    Bridged,
    /// The tool reaches less of the faces than it should.
    Unreached,
    /// The model is thicker or thinner than the sheet.
    #[schemars(extend("x-takes-sheet" = true))]
    Thickness,
    /// The model shows another face of the sheet than model_face states.
    #[schemars(extend("x-takes-sheet" = true))]
    ModelFace,
    /// The model is a solid, and no sheet of nearly constant thickness.
    #[schemars(extend("x-takes-sheet" = true))]
    Solid,
    /// The model's flange does not lie where the sheet is clamped.
    #[schemars(extend("x-takes-sheet" = true))]
    Flange,
}

impl Risk {
    /// The finding that it lets pass.
    pub(crate) fn finding(self) -> FindingKind {
        match self {
            Self::WallAngle => FindingKind::WallAngle,
            Self::Thinning => FindingKind::Thinning,
            Self::Punch => FindingKind::Punch,
            Self::Bridged => FindingKind::Bridged,
            Self::Unreached => FindingKind::Unreached,
            Self::Thickness => FindingKind::SheetThickness,
            Self::ModelFace => FindingKind::SheetFace,
            Self::Solid => FindingKind::SolidFormed,
            Self::Flange => FindingKind::FlangeHeight,
        }
    }
}

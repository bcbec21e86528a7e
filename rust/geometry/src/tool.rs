//! A tool: its profile and what is above it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    error::{length, positive_length},
    Cutter, GeometryError, Profile, ProfileDocument, Sheet,
};

/// A tool as documents write it. Lengths in mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolDocument {
    /// The curve from tip to base.
    pub profile: ProfileDocument,
    /// Diameter of the shank, mm; the base's when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shank_diameter: Option<f64>,
    /// Length from tip to holder, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
}

/// A checked tool, ready to be asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    document: ToolDocument,
    profile: Profile,
}

impl Tool {
    /// Checks a document and builds the tool.
    ///
    /// # Errors
    /// A profile that does not build, or a shank or length out of range.
    pub fn new(document: ToolDocument) -> Result<Self, GeometryError> {
        let profile = document.profile.build()?;
        if let Some(diameter) = document.shank_diameter {
            positive_length("shank_diameter", diameter)?;
        }
        if let Some(value) = document.length {
            let height = profile.point_at(profile.max_slope()).1;
            if length("length", value)? <= height {
                return Err(GeometryError::OutOfRange {
                    key: "length",
                    value,
                    allowed: "more than the profile is high",
                });
            }
        }
        Ok(Self { document, profile })
    }

    /// What it was built from.
    #[must_use]
    pub fn document(&self) -> &ToolDocument {
        &self.document
    }

    /// The curve beyond the tip flat.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Radius and height of the bare tool at a slope, mm; the outer end of a flat, the rim beyond the last slope.
    #[must_use]
    pub fn point_at(&self, slope: f64) -> (f64, f64) {
        let (r, z) = self.profile.point_at(slope.min(self.profile.max_slope()));
        (self.document.profile.tip_flat() + r, z)
    }

    /// The bare tool as a cutter.
    #[must_use]
    pub fn cutter(&self) -> Cutter {
        Cutter::new(self.profile.clone(), self.document.profile.tip_flat(), 0.0)
    }

    /// Tool and sheet as one, grown by `margin` mm along the normal: what must not enter the model.
    ///
    /// The tool's tip is [`tip_above`](Self::tip_above) over this cutter's.
    #[must_use]
    pub fn cutter_with(&self, sheet: Option<&Sheet>, margin: f64) -> Cutter {
        let ball = sheet.map_or(0.0, Sheet::along_normal) + margin;
        Cutter::new(self.profile.clone(), self.document.profile.tip_flat(), ball)
    }

    /// Height of the tool's tip over the tip of [`cutter_with`](Self::cutter_with), mm.
    #[must_use]
    pub fn tip_above(sheet: Option<&Sheet>, margin: f64) -> f64 {
        sheet.map_or(0.0, |s| s.along_normal() + s.along_vertical()) + margin
    }

    /// Height of the sphere's centre over the tip, mm; only a ball without a flat has one.
    #[must_use]
    pub fn center_height(&self) -> Option<f64> {
        match &self.profile {
            Profile::Ball(ball) if self.document.profile.tip_flat() == 0.0 => Some(ball.radius()),
            _ => None,
        }
    }

    /// Diameter of the base, mm.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        2.0 * self.point_at(self.profile.max_slope()).0
    }

    /// What it is, in words: `clothoid D10`.
    #[must_use]
    pub fn description(&self) -> String {
        let flat = self.document.profile.tip_flat();
        let kind = self.document.profile.kind();
        let diameter = (self.diameter() * 1e6).round() / 1e6;
        if flat > 0.0 {
            format!("{kind} D{diameter} tip flat {flat}")
        } else {
            format!("{kind} D{diameter}")
        }
    }
}

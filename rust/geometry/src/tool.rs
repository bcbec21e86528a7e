//! A tool: its profile and what is above it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    error::{length, positive_length},
    Cutter, GeometryError, Profile, ProfileDocument, ProfileReport, Sheet,
};

/// A tool as documents write it. Lengths in mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolDocument {
    /// The curve from tip to base.
    pub profile: ProfileDocument,
    /// What joins the profile's base to the shank; it does not form.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<Base>,
    /// Diameter of the shank, mm; the base's when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shank_diameter: Option<f64>,
    /// Length from tip to holder, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// The holder above it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub holder: Option<Holder>,
}

/// What joins a profile's base to the shank (US 2023/0035585: cylindrical, chamfered, or with a tangent transition).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Base {
    /// A cylinder of the base's diameter.
    Cylindrical {
        /// Its height, mm.
        height: f64,
    },
    /// A cone to the shank's diameter.
    Chamfer {
        /// Its height, mm.
        height: f64,
    },
    /// A smooth transition to the shank's diameter, with one tangent at both ends.
    Tangent {
        /// Its height, mm.
        height: f64,
    },
}

impl Base {
    /// Its height, mm.
    #[must_use]
    pub fn height(&self) -> f64 {
        match self {
            Self::Cylindrical { height } | Self::Chamfer { height } | Self::Tangent { height } => *height,
        }
    }
}

/// A cylinder above the shank.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Holder {
    /// Its diameter, mm.
    pub diameter: f64,
    /// Its length, mm.
    pub length: f64,
}

impl ToolDocument {
    /// A tool of which only the profile is known.
    #[must_use]
    pub fn of(profile: ProfileDocument) -> Self {
        Self { profile, base: None, shank_diameter: None, length: None, holder: None }
    }
}

/// A checked tool, ready to be asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    document: ToolDocument,
    profile: Profile,
    report: ProfileReport,
}

impl Tool {
    /// Checks a document and builds the tool.
    ///
    /// # Errors
    /// A profile that does not build, or a shank or length out of range.
    pub fn new(document: ToolDocument) -> Result<Self, GeometryError> {
        let (profile, report) = document.profile.build()?;
        if let Some(diameter) = document.shank_diameter {
            positive_length("shank_diameter", diameter)?;
        }
        let height = profile.base().1 + document.base.map_or(Ok(0.0), |base| length("base.height", base.height()))?;
        if let Some(value) = document.length {
            if length("length", value)? <= height {
                let allowed = "more than profile and base are high";
                return Err(GeometryError::OutOfRange { key: "length", value, allowed });
            }
        }
        if let Some(holder) = document.holder {
            positive_length("holder.diameter", holder.diameter)?;
            positive_length("holder.length", holder.length)?;
            if document.length.is_none() {
                return Err(GeometryError::Keys("a holder needs the tool's length: from the tip to it".to_owned()));
            }
        }
        Ok(Self { document, profile, report })
    }

    /// What it was built from.
    #[must_use]
    pub fn document(&self) -> &ToolDocument {
        &self.document
    }

    /// The curve from tip to base.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// What was done to the document's curve to make it the profile.
    #[must_use]
    pub fn report(&self) -> &ProfileReport {
        &self.report
    }

    /// Radius and height of the bare tool at a slope, mm; the outer end of a straight part, the rim beyond the last slope.
    #[must_use]
    pub fn point_at(&self, slope: f64) -> (f64, f64) {
        self.profile.point_at(slope)
    }

    /// The bare tool as a cutter.
    #[must_use]
    pub fn cutter(&self) -> Cutter {
        Cutter::new(&self.profile, 0.0)
    }

    /// Tool and sheet as one, grown by `margin` mm along the normal: what must not enter the model.
    ///
    /// The tool's tip is [`tip_above`](Self::tip_above) over this cutter's.
    #[must_use]
    pub fn cutter_with(&self, sheet: Option<&Sheet>, margin: f64) -> Cutter {
        let ball = sheet.map_or(0.0, Sheet::along_normal) + margin;
        Cutter::new(&self.profile, ball)
    }

    /// Height of the tool's tip over the tip of [`cutter_with`](Self::cutter_with), mm.
    #[must_use]
    pub fn tip_above(sheet: Option<&Sheet>, margin: f64) -> f64 {
        sheet.map_or(0.0, |s| s.along_normal() + s.along_vertical()) + margin
    }

    /// Height of the sphere's centre over the tip, mm; only a ball without a flat has one.
    #[must_use]
    pub fn center_height(&self) -> Option<f64> {
        self.profile.as_ball()
    }

    /// Diameter of the base, mm.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        2.0 * self.profile.base().0
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

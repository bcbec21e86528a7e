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
    #[schemars(extend("x-unit" = "mm"))]
    pub shank_diameter: Option<f64>,
    /// Length from tip to holder, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub length: Option<f64>,
    /// The holder above it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub holder: Option<Holder>,
    /// How many cutting edges it has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("minimum" = 1, "maximum" = 100))]
    pub flutes: Option<u32>,
    /// What its cutting edges are made of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cutter_material: Option<CutterMaterial>,
}

/// What cutting edges are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CutterMaterial {
    /// High-speed steel, with cobalt or without.
    Hss,
    /// Cemented carbide.
    Carbide,
}

impl CutterMaterial {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Hss, Self::Carbide];

    /// Its name in documents.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hss => "hss",
            Self::Carbide => "carbide",
        }
    }
}

/// What joins a profile's base to the shank (US 2023/0035585: cylindrical, chamfered, or with a tangent transition).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Base {
    /// A cylinder of the base's diameter.
    Cylindrical {
        /// Its height, mm.
        #[schemars(extend("x-unit" = "mm"))]
        height: f64,
    },
    /// A cone to the shank's diameter.
    Chamfer {
        /// Its height, mm.
        #[schemars(extend("x-unit" = "mm"))]
        height: f64,
    },
    /// A smooth transition to the shank's diameter, with one tangent at both ends.
    Tangent {
        /// Its height, mm.
        #[schemars(extend("x-unit" = "mm"))]
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

    /// Its height, mm, if it has any, and a shank to lead to.
    fn checked(&self, profile: &Profile, document: &ToolDocument) -> Result<f64, GeometryError> {
        let height = positive_length("base.height", self.height())?;
        let diameter = 2.0 * profile.base().0;
        let leads = document.shank_diameter.is_some_and(|shank| (shank - diameter).abs() > 1e-9 * diameter);
        if leads || matches!(self, Self::Cylindrical { .. }) {
            return Ok(height);
        }
        let kind = if matches!(self, Self::Chamfer { .. }) { "chamfer" } else { "tangent" };
        Err(GeometryError::Keys(format!(
            "base.kind = {kind:?} leads from the profile's diameter ({diameter:.6} mm) to the shank's: shank_diameter must \
             be given and be another; without, take \"cylindrical\" or leave base out"
        )))
    }
}

/// A cylinder above the shank.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Holder {
    /// Its diameter, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Its length, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub length: f64,
}

impl ToolDocument {
    /// A tool of which only the profile is known.
    #[must_use]
    pub fn of(profile: ProfileDocument) -> Self {
        Self {
            profile,
            base: None,
            shank_diameter: None,
            length: None,
            holder: None,
            flutes: None,
            cutter_material: None,
        }
    }
}

/// A checked tool, ready to be asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    document: ToolDocument,
    profile: Profile,
    report: ProfileReport,
    /// Stock around it that it is to leave, across walls in plan and in height, mm.
    left: [f64; 2],
}

impl Tool {
    /// Checks a document and builds the tool.
    ///
    /// # Errors
    /// A profile that does not build, or a shank or length out of range.
    pub fn new(document: ToolDocument) -> Result<Self, GeometryError> {
        let (profile, report) = document.profile.build()?;
        if document.flutes == Some(0) {
            return Err(GeometryError::OutOfRange { key: "flutes", value: 0.0, allowed: "1 or more" });
        }
        if let Some(diameter) = document.shank_diameter {
            positive_length("shank_diameter", diameter)?;
        }
        let height = profile.base().1 + document.base.map_or(Ok(0.0), |base| base.checked(&profile, &document))?;
        if let Some(value) = document.length {
            if length("length", value)? <= height {
                let allowed = "more than the height of profile and base";
                return Err(GeometryError::OutOfRange { key: "length", value, allowed });
            }
        }
        if let Some(holder) = document.holder {
            positive_length("holder.diameter", holder.diameter)?;
            positive_length("holder.length", holder.length)?;
            if document.length.is_none() {
                return Err(GeometryError::Keys(
                    "holder without the tool's length: add length, mm from the tip to the holder".to_owned(),
                ));
            }
        }
        Ok(Self { document, profile, report, left: [0.0; 2] })
    }

    /// The same with the stock around it that it is to leave on the part: so far across walls in plan, and so much in height, mm, not
    /// negative. What touches the part is wider by a level disc and lies lower; the tip stays where it is.
    #[must_use]
    pub fn leaving(&self, left: [f64; 2]) -> Self {
        let widened = self.profile.clone().widened(left[0]);
        Self { profile: widened, left: [0, 1].map(|i| self.left[i] + left[i]), ..self.clone() }
    }

    /// Stock around it that it is to leave, across walls in plan and in height, mm.
    pub(crate) fn left(&self) -> [f64; 2] {
        self.left
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

    /// Radius and height over the tip of the tool without a sheet at a slope, mm; the outer end of a straight part, the rim beyond the last slope.
    #[must_use]
    pub fn point_at(&self, slope: f64) -> (f64, f64) {
        let (radius, height) = self.profile.point_at(slope);
        (radius, height - self.left[1])
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
    pub fn tip_above(&self, sheet: Option<&Sheet>, margin: f64) -> f64 {
        sheet.map_or(0.0, Sheet::raise) + margin + self.left[1]
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

    /// What it is, in words, with diameters in mm: `clothoid D10`, `clothoid D10 tip flat D2`.
    #[must_use]
    pub fn description(&self) -> String {
        let profile = &self.document.profile;
        let (kind, millionths) = (profile.kind(), |x: f64| (x * 1e6).round() / 1e6);
        let name = format!("{kind} D{}", millionths(self.diameter()));
        match profile.added_flat() {
            flat if flat > 0.0 => format!("{name} tip flat D{}", millionths(2.0 * flat)),
            _ => name,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tool(text: &str) -> Result<Tool, String> {
        Tool::new(serde_json::from_str(text).unwrap()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_base_that_joins_nothing_is_refused() {
        let with = |base: &str, shank: &str| {
            tool(&format!(r#"{{"profile": {{"kind": "ball", "diameter": 10.0}}, "base": {base}{shank}}}"#))
        };
        for kind in ["chamfer", "tangent"] {
            let base = format!(r#"{{"kind": "{kind}", "height": 2.0}}"#);
            assert!(with(&base, "").unwrap_err().contains("shank_diameter must be given"));
            assert!(with(&base, r#", "shank_diameter": 10.0"#).unwrap_err().contains("another"));
            assert!(with(&base, r#", "shank_diameter": 12.0"#).is_ok());
        }
        assert!(with(r#"{"kind": "cylindrical", "height": 2.0}"#, "").is_ok());
        let flat = with(r#"{"kind": "cylindrical", "height": 0.0}"#, "").unwrap_err();
        assert!(flat.contains("base.height = 0"), "{flat}");
    }

    #[test]
    fn a_flat_end_has_no_flat_beyond_itself() {
        let error = tool(r#"{"profile": {"kind": "flat", "diameter": 10.0, "tip_flat": 9000.0}}"#).unwrap_err();
        assert!(error.contains("tip_flat = 9000"), "{error}");
        let flat = tool(r#"{"profile": {"kind": "flat", "diameter": 10.0, "tip_flat": 3.0}}"#).unwrap();
        assert_eq!(flat.description(), "flat D10");
    }

    #[test]
    fn descriptions_speak_of_diameters() {
        let tool = tool(r#"{"profile": {"kind": "clothoid", "diameter": 10.0, "tip_flat": 1.0}}"#).unwrap();
        assert_eq!(tool.description(), "clothoid D10 tip flat D2");
    }

    #[test]
    fn the_scale_of_a_clothoid_is_an_area() {
        let of = |scale: f64| {
            tool(&format!(r#"{{"profile": {{"kind": "clothoid", "scale": {scale:?}, "end_slope_deg": 90.0}}}}"#))
        };
        assert!(of(20_000.0).is_ok());
        let error = of(0.0).unwrap_err();
        assert!(error.contains("mm^2"), "{error}");
        assert!(of(1e9).unwrap_err().contains("mm^2"));
    }

    #[test]
    fn heights_reach_the_very_rim() {
        for kind in [
            r#""kind": "parabola", "apex_radius": 5.0, "diameter": 7.3"#,
            r#""kind": "tapered-ball", "tip_radius": 0.7, "half_angle_deg": 11.0, "diameter": 7.3"#,
            r#""kind": "barrel", "radius": 31.0, "tip_radius": 0.7, "diameter": 7.3, "tip_flat": 0.1"#,
            r#""kind": "points", "points": [[0.0, 0.0], [1.1, 0.1], [2.7, 0.9], [3.3, 1.6], [3.65, 2.9]]"#,
        ] {
            let tool = tool(&format!(r#"{{"profile": {{{kind}}}}}"#)).unwrap();
            assert_eq!(tool.diameter().to_bits(), 7.3_f64.to_bits(), "{kind}");
            assert!(tool.cutter().height_at_radius(3.65).is_finite(), "{kind}");
        }
    }

    #[test]
    fn stock_to_leave_is_a_disc_around_the_tool_and_a_height_under_it() {
        for kind in [
            r#""kind": "ball", "diameter": 6.0"#,
            r#""kind": "flat", "diameter": 6.0"#,
            r#""kind": "v", "tip_diameter": 0.0, "angle_deg": 90.0, "diameter": 6.0"#,
            r#""kind": "clothoid", "diameter": 6.0, "tip_flat": 0.5"#,
        ] {
            let tool = tool(&format!(r#"{{"profile": {{{kind}}}}}"#)).unwrap();
            let wide = tool.leaving([0.3, 0.2]);
            for slope in [0.0, 0.1, 0.7, 1.2, 1.5] {
                let support = |(r, z): (f64, f64)| r * libm::sin(slope) - z * libm::cos(slope);
                let more = 0.3 * libm::sin(slope) + 0.2 * libm::cos(slope);
                let [bare, around] = [&tool, &wide].map(|tool| support(tool.point_at(slope)));
                assert!((around - bare - more).abs() < 1e-12, "{kind} {slope}");
            }
            let body = wide.body(None);
            assert!((body.tip_above() - 0.2).abs() < 1e-12 && (body.max_radius() - 3.3).abs() < 1e-12);
            assert!(body.straights()[0].inner == (0.0, 0.0) && body.as_ball().is_none());
        }
    }
}

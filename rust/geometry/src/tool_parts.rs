//! The solids of a tool: its profile, and the shank and the holder above it, each with the sheet.

use crate::{kinds, Base, Cutter, Profile, ProfileDocument, Sheet, Tool, ToolBody};

/// Share of a tangent base's height at which the straight hull of its half cosine wave has the shank's radius: the line
/// from its foot that touches the wave rises pi / 2.3311 (1 - cos 2.3311) / 2 times as fast as the wave does on average.
const TANGENT_HULL: f64 = 0.878;

/// What a solid of a tool stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolPart {
    /// The shank, with the base that leads to it.
    Shank,
    /// The holder.
    Holder,
}

impl Tool {
    /// The profile with the sheet as one solid: what must not enter the model.
    #[must_use]
    pub fn body(&self, sheet: Option<&Sheet>) -> ToolBody {
        with_sheet(self.profile(), sheet, -self.left()[1])
    }

    /// The solids above the profile that are wider than it, with the sheet; the profile's own is its base's cylinder upwards.
    ///
    /// A tangent base is its straight hull; a wider shank without a base begins at the profile's rim.
    #[must_use]
    pub fn bodies_above(&self, sheet: Option<&Sheet>) -> Vec<(ToolPart, ToolBody)> {
        self.above().map(|(part, profile, height)| (part, with_sheet(&profile, sheet, height))).collect()
    }

    /// The same without a sheet as cutters, and how high the lowest point of each is over the tip, mm.
    #[must_use]
    pub fn cutters_above(&self) -> Vec<(ToolPart, Cutter, f64)> {
        self.above().map(|(part, profile, height)| (part, Cutter::new(&profile, 0.0), height)).collect()
    }

    /// Meridians of the solids above the profile, and how high each begins over the tip, mm.
    fn above(&self) -> impl Iterator<Item = (ToolPart, Profile, f64)> + '_ {
        let document = self.document();
        let held = document.holder.as_ref().zip(document.length);
        let holder = held.map(|(holder, length)| (ToolPart::Holder, cylinder(holder.diameter), length));
        let solids = self.shank().into_iter().chain(holder);
        // none where the numbers make none: a tool's own checks have passed them
        solids.filter_map(|(part, profile, height)| Some((part, profile.build().ok()?.0, height)))
    }

    /// The shank where it is wider than the profile, and how high it begins over the tip, mm.
    fn shank(&self) -> Option<(ToolPart, ProfileDocument, f64)> {
        let document = self.document();
        let (wide, rim) = self.profile().base();
        let radius = wide - self.left()[0];
        let diameter = document.shank_diameter.filter(|d| *d > 2.0 * radius)?;
        let (height, cone) = match document.base {
            None => (rim, None),
            Some(Base::Cylindrical { height }) => (rim + height, None),
            Some(Base::Chamfer { height }) => (rim, Some(height)),
            Some(Base::Tangent { height }) => (rim, Some(TANGENT_HULL * height)),
        };
        let profile = cone.map_or(cylinder(diameter), |rise| {
            ProfileDocument::from(kinds::V {
                tip_diameter: 2.0 * radius,
                angle_deg: 2.0 * libm::atan((0.5 * diameter - radius) / rise).to_degrees(),
                diameter,
                tip_flat: 0.0,
            })
        });
        Some((ToolPart::Shank, profile, height))
    }
}

fn cylinder(diameter: f64) -> ProfileDocument {
    ProfileDocument::from(kinds::Flat { diameter, tip_flat: 0.0 })
}

/// A solid that begins `height` mm above the tip, with the sheet.
fn with_sheet(profile: &Profile, sheet: Option<&Sheet>, height: f64) -> ToolBody {
    let ball = sheet.map_or(0.0, Sheet::along_normal);
    ToolBody::new(profile, ball).with_tip_above(sheet.map_or(0.0, Sheet::raise) - height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ModelFace, SheetLaw};

    fn tool(more: &str) -> Tool {
        let text = format!(r#"{{"profile": {{"kind": "ball", "diameter": 6.0}}, {more}}}"#);
        Tool::new(serde_json::from_str(&text).unwrap()).unwrap()
    }

    /// What each solid is, its lowest point over the tip, its cylinder's radius and where that begins over the tip.
    fn above(more: &str, sheet: Option<&Sheet>) -> Vec<(ToolPart, [f64; 3])> {
        let numbers = |body: &ToolBody| {
            [-body.tip_above(), body.max_radius(), body.max_height() - body.tip_above()]
                .map(|x| (x * 1e9).round() / 1e9)
        };
        tool(more).bodies_above(sheet).iter().map(|(part, body)| (*part, numbers(body))).collect()
    }

    #[test]
    fn what_is_wider_than_the_profile_stands_above_it() {
        let shank = |base: &str| above(&format!(r#"{base} "shank_diameter": 10.0"#), None);
        assert_eq!(shank(""), [(ToolPart::Shank, [3.0, 5.0, 3.0])]);
        let base = |kind: &str| shank(&format!(r#""base": {{"kind": "{kind}", "height": 2.0}},"#));
        assert_eq!(base("cylindrical"), [(ToolPart::Shank, [5.0, 5.0, 5.0])]);
        assert_eq!(base("chamfer"), [(ToolPart::Shank, [3.0, 5.0, 5.0])]);
        assert_eq!(base("tangent"), [(ToolPart::Shank, [3.0, 5.0, 3.0 + 2.0 * TANGENT_HULL])]);
        let held = above(r#""length": 40.0, "holder": {"diameter": 30.0, "length": 20.0}"#, None);
        assert_eq!(held, [(ToolPart::Holder, [40.0, 15.0, 40.0])]);
        assert_eq!(above(r#""shank_diameter": 5.0"#, None), []);
    }

    #[test]
    fn the_sheet_is_a_ball_around_every_solid() {
        let sheet = Sheet { thickness: 1.0, law: SheetLaw::Constant, model_face: ModelFace::Back };
        let held = above(r#""length": 40.0, "holder": {"diameter": 30.0, "length": 20.0}"#, Some(&sheet));
        assert_eq!(held, [(ToolPart::Holder, [39.0, 16.0, 40.0])]);
        let body = tool(r#""length": 40.0"#).body(Some(&sheet));
        assert_eq!((body.as_ball(), body.tip_above()), (Some(4.0), 1.0));
    }
}

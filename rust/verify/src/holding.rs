//! What of a tool is above its profile: base, shank and holder, as bodies of their own.

use styluscam_geometry::{Base, ProfileDocument, Sheet, Tool, ToolDocument};

use crate::body::Body;
use crate::FindingKind;

/// Share of a tangent base's height at which the straight hull of its half cosine wave has the shank's radius: the line
/// from its foot that touches the wave rises pi / 2.3311 (1 - cos 2.3311) / 2 times as fast as the wave does on average.
const TANGENT_HULL: f64 = 0.878;

/// A body above the profile.
#[derive(Clone, Debug)]
pub(crate) struct Holding {
    /// What it is when it meets the part.
    pub kind: FindingKind,
    /// With the tool's own tip for what it is asked.
    pub body: Body,
}

/// The bodies above a tool's profile that are wider than it; the profile's own body is its base's cylinder, upwards.
///
/// A tangent base is its straight hull; a wider shank without a base begins at the profile's rim.
pub(crate) fn of(tool: &Tool, sheet: Option<&Sheet>) -> Vec<Holding> {
    let document = tool.document();
    let (radius, rim) = tool.profile().base();
    let mut holdings = Vec::new();
    if let Some(diameter) = document.shank_diameter.filter(|d| *d > 2.0 * radius) {
        let (height, cone) = match document.base {
            None => (rim, None),
            Some(Base::Cylindrical { height }) => (rim + height, None),
            Some(Base::Chamfer { height }) => (rim, Some(height)),
            Some(Base::Tangent { height }) => (rim, Some(TANGENT_HULL * height)),
        };
        let profile = cone.map_or(cylinder(diameter), |rise| ProfileDocument::V {
            tip_diameter: 2.0 * radius,
            angle_deg: 2.0 * ((0.5 * diameter - radius) / rise).atan().to_degrees(),
            diameter,
            tip_flat: 0.0,
        });
        holdings.extend(holding(FindingKind::ShankCollision, profile, height, sheet));
    }
    if let (Some(holder), Some(length)) = (document.holder, document.length) {
        holdings.extend(holding(FindingKind::HolderCollision, cylinder(holder.diameter), length, sheet));
    }
    holdings
}

fn cylinder(diameter: f64) -> ProfileDocument {
    ProfileDocument::Flat { diameter, tip_flat: 0.0 }
}

/// None where the numbers make no body: a tool's own checks have passed them.
fn holding(kind: FindingKind, profile: ProfileDocument, height: f64, sheet: Option<&Sheet>) -> Option<Holding> {
    let tool = Tool::new(ToolDocument::of(profile)).ok()?;
    Some(Holding { kind, body: Body::above(&tool, sheet, height) })
}

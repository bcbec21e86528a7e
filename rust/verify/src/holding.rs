//! What may collide: what of a tool is above its profile with the part, and all of it with what stands around.

use styluscam_geometry::{kinds, Base, Bvh, Mesh, ProfileDocument, Sheet, Tool, ToolDocument};

use crate::body::Body;
use crate::clearance::Prober;
use crate::faults::{self, FaultKind};
use crate::subject::{ObstacleKind, Subject};

/// Share of a tangent base's height at which the straight hull of its half cosine wave has the shank's radius: the line
/// from its foot that touches the wave rises pi / 2.3311 (1 - cos 2.3311) / 2 times as fast as the wave does on average.
const TANGENT_HULL: f64 = 0.878;

/// A body above the profile.
#[derive(Clone, Debug)]
struct Holding {
    /// What it is when it meets the part.
    kind: &'static FaultKind,
    /// With the tool's own tip for what it is asked.
    body: Body,
}

/// A body and what it must not come near.
pub(crate) struct Collider<'a> {
    /// What it is when it does.
    pub kind: &'static FaultKind,
    /// Whether the part is what it must not come near.
    pub is_at_part: bool,
    body: Body,
    mesh: &'a Mesh,
    bvh: &'a Bvh,
    /// Height of the mesh's highest point.
    pub top: f64,
    /// The clearance that must be left, mm.
    pub least: f64,
}

impl Collider<'_> {
    pub fn prober(&self) -> Prober<'_> {
        Prober { body: &self.body, mesh: self.mesh, bvh: self.bvh }
    }
}

/// What a tool brings along, against the part and all that stands around it; `least` is the clearance that the part must
/// have, mm.
pub(crate) fn colliders<'a>(tool: &Tool, subject: &Subject<'a>, least: f64) -> Vec<Collider<'a>> {
    let above = of(tool, subject.sheet.as_ref()).into_iter().map(|holding| {
        let (mesh, bvh) = (subject.mesh, subject.bvh);
        Collider { kind: holding.kind, is_at_part: true, body: holding.body, mesh, bvh, top: mesh.bounds().1.z, least }
    });
    let around = subject.obstacles.iter().flat_map(|obstacle| {
        let sheet = obstacle.sheet.as_ref();
        let bodies = of(tool, sheet).into_iter().map(|holding| holding.body);
        std::iter::once(Body::new(tool, sheet)).chain(bodies).map(|body| Collider {
            kind: match obstacle.kind {
                ObstacleKind::Clamp => &faults::CLAMP,
                ObstacleKind::Backing => &faults::BACKING,
            },
            is_at_part: false,
            body,
            mesh: &obstacle.mesh,
            bvh: &obstacle.bvh,
            top: obstacle.mesh.bounds().1.z,
            least: obstacle.margin,
        })
    });
    above.chain(around).collect()
}

/// The bodies above a tool's profile that are wider than it; the profile's own body is its base's cylinder, upwards.
///
/// A tangent base is its straight hull; a wider shank without a base begins at the profile's rim.
fn of(tool: &Tool, sheet: Option<&Sheet>) -> Vec<Holding> {
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
        let profile = cone.map_or(cylinder(diameter), |rise| {
            ProfileDocument::from(kinds::V {
                tip_diameter: 2.0 * radius,
                angle_deg: 2.0 * libm::atan((0.5 * diameter - radius) / rise).to_degrees(),
                diameter,
                tip_flat: 0.0,
            })
        });
        holdings.extend(holding(&faults::SHANK, profile, height, sheet));
    }
    if let (Some(holder), Some(length)) = (document.holder, document.length) {
        holdings.extend(holding(&faults::HOLDER, cylinder(holder.diameter), length, sheet));
    }
    holdings
}

fn cylinder(diameter: f64) -> ProfileDocument {
    ProfileDocument::from(kinds::Flat { diameter, tip_flat: 0.0 })
}

/// None where the numbers make no body: a tool's own checks have passed them.
fn holding(kind: &'static FaultKind, profile: ProfileDocument, height: f64, sheet: Option<&Sheet>) -> Option<Holding> {
    let tool = Tool::new(ToolDocument::of(profile)).ok()?;
    Some(Holding { kind, body: Body::above(&tool, sheet, height) })
}

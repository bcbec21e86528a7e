//! What may collide: what of a tool is above its profile with the part, and all of it with what stands around.

use styluscam_geometry::{Bvh, Mesh, Tool, ToolPart};

use crate::body::Body;
use crate::clearance::Prober;
use crate::expectation::ExpectedOperation;
use crate::faults::{self, FaultKind};
use crate::subject::{ObstacleKind, Subject};

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
    /// The job's operation that alone must not come near it, by its number; none: all.
    pub operation: Option<usize>,
    /// Whether it goes down with the clamp frame.
    pub follows: bool,
}

impl Collider<'_> {
    pub fn prober(&self) -> Prober<'_> {
        Prober { body: &self.body, mesh: self.mesh, bvh: self.bvh }
    }
}

/// What a tool brings along, against the part and all that stands around it; `least` is the clearance that the part must
/// have, mm.
pub(crate) fn colliders<'a>(tool: &Tool, subject: &Subject<'a>, least: f64) -> Vec<Collider<'a>> {
    let above = tool.bodies_above(subject.sheet.as_ref()).into_iter().map(|(part, solid)| {
        let kind = match part {
            ToolPart::Shank => &faults::SHANK,
            ToolPart::Holder => &faults::HOLDER,
        };
        let (mesh, bvh) = (subject.mesh, subject.bvh);
        let top = mesh.bounds().1.z;
        Collider {
            kind,
            is_at_part: true,
            body: Body::of(solid),
            mesh,
            bvh,
            top,
            least,
            operation: None,
            follows: false,
        }
    });
    let around = subject.obstacles.iter().flat_map(|obstacle| {
        let sheet = obstacle.sheet.as_ref();
        let bodies = tool.bodies_above(sheet).into_iter().map(|(_, solid)| Body::of(solid));
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
            operation: None,
            follows: obstacle.follows,
        })
    });
    above.chain(around).chain(of_check_faces(tool, subject)).collect()
}

/// All of a tool, with the sheet, against the check faces of each operation.
fn of_check_faces<'a>(tool: &Tool, subject: &Subject<'a>) -> Vec<Collider<'a>> {
    let sheet = subject.sheet.as_ref();
    let of_operation = |(number, expected): (usize, &'a ExpectedOperation)| {
        let check = expected.expectation.region.check.as_deref()?;
        let bodies = tool.bodies_above(sheet).into_iter().map(|(_, solid)| Body::of(solid));
        let colliders = std::iter::once(Body::new(tool, sheet)).chain(bodies).map(move |body| Collider {
            kind: &faults::CHECK_CLEARANCE,
            is_at_part: false,
            body,
            mesh: &check.mesh,
            bvh: &check.bvh,
            top: check.mesh.bounds().1.z,
            least: check.clearance + subject.deviation_inward,
            operation: Some(number),
            follows: false,
        });
        Some(colliders.collect::<Vec<_>>())
    };
    subject.expected.iter().enumerate().filter_map(of_operation).flatten().collect()
}

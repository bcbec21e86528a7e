//! Where an operation's passes may run, with what planning and verification need of it.

use std::sync::Arc;

use styluscam_geometry::{Bvh, Mesh, Sheet, Tool, ToolBody};
use styluscam_toolpath::budget::Budget;
use styluscam_toolpath::offset::{Envelope, Index};
use styluscam_toolpath::{Boundary, Inside, Region, GRAZES};

use crate::boundary::BoundaryInside;

/// A chord may lie beside exact positions by so many times what it may deviate along the normal: fitting counts at least a quarter of
/// any distance.
const ASIDE: f64 = 4.0;

/// An edge in plan, mm.
pub type Edge = [[f64; 2]; 2];

/// Faces that the tool keeps away from.
#[derive(Clone, Debug)]
pub struct Check {
    /// Their triangles alone, work coordinates, mm.
    pub mesh: Mesh,
    /// How near tool and sheet may come, mm.
    pub clearance: f64,
}

/// Where an operation's passes may run.
#[derive(Clone, Debug, Default)]
pub struct OperationRegion {
    /// What it keeps away from.
    pub check: Option<Check>,
    /// Edges between which it stays; none: everywhere.
    pub edges: Option<Vec<Edge>>,
    /// What of the tool stays between them.
    pub inside: BoundaryInside,
    /// Least and greatest slope of its contacts, rad.
    pub slopes: Option<[f64; 2]>,
}

/// A region with what a tool meets of it.
pub struct PlannedRegion<'a> {
    region: &'a OperationRegion,
    /// The check faces' index, and the tool's solids, grown by their clearance.
    check: Option<(&'a Mesh, Index, Vec<ToolBody>)>,
    radius: f64,
}

impl OperationRegion {
    /// For a tool whose path is fitted with a budget, and rounded by so much, mm.
    /// The triangles lie up to `inward` mm inside the part.
    pub fn planned(
        &self,
        (tool, sheet): (&Tool, Option<&Sheet>),
        inward: f64,
        budget: &Budget,
        rounding: f64,
    ) -> PlannedRegion<'_> {
        let check = self.check.as_ref().map(|check| {
            let ball = check.clearance + inward + ASIDE * budget.deviation + rounding + GRAZES;
            let above = tool.bodies_above(sheet).into_iter().map(|(_, body)| body);
            let bodies = std::iter::once(tool.body(sheet)).chain(above).map(|body| body.grown(ball)).collect();
            (&check.mesh, Index::new(&check.mesh), bodies)
        });
        PlannedRegion { region: self, check, radius: 0.5 * tool.diameter() }
    }

    /// A hint for a plan that reaches nothing.
    pub fn hint(&self) -> &'static str {
        match (self.check.is_some(), self.edges.is_some() || self.slopes.is_some()) {
            (true, true) => ", the boundary, and the clearance of the check faces",
            (true, false) => ", and the clearance of the check faces",
            (false, true) => ", and the boundary",
            (false, false) => "",
        }
    }

    /// What the verifier is to expect.
    pub fn expected(self) -> styluscam_verify::Region {
        let check = self.check.map(|Check { mesh, clearance }| {
            Arc::new(styluscam_verify::CheckFaces { bvh: Bvh::new(&mesh), mesh, clearance })
        });
        styluscam_verify::Region {
            edges: self.edges,
            inside: match self.inside {
                BoundaryInside::Centre => styluscam_verify::Inside::Centre,
                BoundaryInside::Contact => styluscam_verify::Inside::Contact,
                BoundaryInside::Tool => styluscam_verify::Inside::Tool,
            },
            slopes: self.slopes,
            check,
        }
    }

    /// What stays inside, as planning calls it.
    fn inside(&self) -> Inside {
        match self.inside {
            BoundaryInside::Centre => Inside::Centre,
            BoundaryInside::Contact => Inside::Contact,
            BoundaryInside::Tool => Inside::Tool,
        }
    }
}

impl PlannedRegion<'_> {
    /// Ready to be asked.
    pub fn ready(&self) -> Region<'_> {
        let checks = self.check.iter().flat_map(|(mesh, index, bodies)| {
            bodies.iter().map(move |body| Envelope::of_body(mesh, index, body.clone()))
        });
        Region {
            boundary: self.region.edges.clone().map(|edges| Boundary::new(edges, self.region.inside(), self.radius)),
            slopes: self.region.slopes,
            checks: checks.collect(),
        }
    }
}

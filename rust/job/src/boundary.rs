//! Where an operation's passes may run, as a job states it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::numbers::shown;
use crate::JobError;

/// Corners of a boundary at most.
const MOST_CORNERS: usize = 100_000;
/// A loop needs so many corners.
const LEAST_CORNERS: usize = 3;

/// What bounds an operation's passes; what is stated together must hold together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BoundaryKeys {
    /// Closed polylines in plan, each a list of corners [x, y] in work coordinates, mm; one inside another is an island.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-unit" = "mm", "minimum" = -100000.0, "maximum" = 100000.0))]
    pub wire: Vec<Vec<[f64; 2]>>,
    /// A DXF file of closed polylines, work coordinates, relative to the job file: they are added to `wire`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The outline of the selected faces in plan.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub face_edges: bool,
    /// Least and greatest slope of the contacts, degrees: 0 is level, 90 upright.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "deg", "minimum" = 0.0, "maximum" = 90.0))]
    pub slope_deg: Option<[f64; 2]>,
    /// What of the tool must lie inside the polylines, or the outline.
    pub inside: BoundaryInside,
}

/// What of a tool lies inside a boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BoundaryInside {
    /// The tool's axis.
    #[default]
    Centre,
    /// Where the tool touches.
    Contact,
    /// All of the tool's profile.
    Tool,
}

impl BoundaryKeys {
    /// Checks what its schema cannot state; `path` is its own.
    ///
    /// # Errors
    /// Nothing stated, two outlines, a loop of fewer than three corners or too many, slopes the wrong way round.
    pub(crate) fn check(&self, path: &str) -> Result<(), JobError> {
        let corners: usize = self.wire.iter().map(Vec::len).sum();
        let hint =
            "write wire = [[[0.0, 0.0], [40.0, 0.0], [40.0, 30.0]]], face_edges = true or slope_deg = [30.0, 60.0]";
        let has_wire = !self.wire.is_empty() || self.file.is_some();
        if !has_wire && !self.face_edges && self.slope_deg.is_none() {
            return Err(JobError::document("empty", path, "the boundary states nothing", hint));
        }
        if has_wire && self.face_edges {
            let message = "a wire and the outline of the faces: one of them bounds the passes";
            return Err(JobError::document("conflict", format!("{path}.face_edges"), message, "remove one of them"));
        }
        if let Some(number) = self.wire.iter().position(|corners| corners.len() < LEAST_CORNERS) {
            let message = format!("a loop of {} corners encloses nothing", self.wire[number].len());
            return Err(JobError::document("out-of-range", format!("{path}.wire[{number}]"), message, hint));
        }
        if corners > MOST_CORNERS {
            let message = format!("the loops have {corners} corners: at most {MOST_CORNERS}");
            return Err(JobError::document("out-of-range", format!("{path}.wire"), message, "use coarser polylines"));
        }
        match self.slope_deg {
            Some([least, most]) if least >= most => {
                let message = format!("slope_deg = [{}, {}] holds no slope", shown(least), shown(most));
                let hint = "write the smaller slope first, and the larger one second";
                Err(JobError::document("conflict", format!("{path}.slope_deg"), message, hint))
            }
            Some(_) | None => Ok(()),
        }
    }
}

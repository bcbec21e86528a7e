//! A body of any shape in a file: a casting, a forging, what is left of a bar.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Stock, Vector};

use super::kind::{extent, Around, StockKind};
use crate::{JobError, Units};

/// By how much the part may stick out of it, mm: both are triangles, whose chords are as far off.
const CHORDS: f64 = 0.01;

/// A body in a file, such as a casting: it lies to the part as both lie in the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshStock {
    /// STL, OBJ, PLY, 3MF, STEP, BREP or IGES; relative to the job file. It is a closed body, in the part's model coordinates: turned and moved
    /// to the zero point with it.
    pub file: String,
    /// Unit of a file that does not state one; the part's when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<Units>,
}

impl StockKind for MeshStock {
    fn check(&self, path: &str) -> Result<(), JobError> {
        if self.file.trim().is_empty() {
            let hint = "name the file with the body, or choose kind = \"box\"";
            return Err(JobError::document("missing", format!("{path}.file"), "no file is named", hint));
        }
        Ok(())
    }

    fn around(&self, around: &Around<'_>) -> Result<Stock, JobError> {
        let body = around.body.clone().ok_or_else(|| {
            let message = format!("{:?} was not read", self.file);
            JobError::document("missing", "setup.stock.file", message, "give the body with the part")
        })?;
        Ok(Stock::of_solid(body))
    }

    fn words(&self, _: &Around<'_>, stock: &Stock) -> String {
        format!("the body in {}, {}", self.file, extent(stock))
    }

    fn slack(&self) -> f64 {
        CHORDS
    }

    fn holds(&self, stock: &Stock, point: Vector, within: f64) -> bool {
        stock.solid().is_some_and(|solid| solid.holds(point, within))
    }
}

//! What an earlier program left.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Frame, Stock, Vector};

use super::kind::{Around, StockKind};
use crate::earlier::Earlier;
use crate::JobError;

const JOB: &str = "setup.stock.job";
/// By how much numbers of frames that are one may differ: arithmetic's last bits.
const SAME: f64 = 1e-9;
/// The same of parts, beyond what their triangles are off them, mm.
const SAME_PART: f64 = 1e-6;

/// What the program of an earlier job left of its stock: of the same part, with the same zero point. Its text is read as its machine reads it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramStock {
    /// The earlier job's file, relative to this one's.
    pub job: String,
    /// The G-code of that job as it was run, relative to this job's file; the file that it writes when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

impl StockKind for ProgramStock {
    fn check(&self, path: &str) -> Result<(), JobError> {
        let named = [("job", Some(&self.job)), ("file", self.file.as_ref())];
        let blank = named.into_iter().find(|(_, name)| name.is_some_and(|name| name.trim().is_empty()));
        blank.map_or(Ok(()), |(key, _)| {
            let hint = "name the earlier job's file, or choose kind = \"box\"";
            Err(JobError::document("missing", format!("{path}.{key}"), "no file is named", hint))
        })
    }

    fn around(&self, around: &Around<'_>) -> Result<Stock, JobError> {
        let earlier = around.earlier.ok_or_else(|| {
            let message = format!("the program of {:?} was not read", self.job);
            JobError::document("missing", JOB, message, "give what it cut with the part")
        })?;
        self.require_same(around, earlier)?;
        Ok(earlier.stock.clone())
    }

    fn words(&self, around: &Around<'_>, _: &Stock) -> String {
        let of = around.earlier.map_or("", |earlier| &earlier.words);
        format!("what {} leaves of {of}", self.job)
    }

    fn holds(&self, _: &Stock, _: Vector, _: f64) -> bool {
        true // that of the same part, which was looked at with the earlier job
    }
}

impl ProgramStock {
    /// That the earlier job is of the same part, at the same place.
    fn require_same(&self, around: &Around<'_>, earlier: &Earlier) -> Result<(), JobError> {
        let rows = |frame: &Frame| frame.rows().into_iter().flatten().collect::<Vec<f64>>();
        let is_same = rows(&earlier.frame).iter().zip(rows(around.frame)).all(|(a, b)| (a - b).abs() <= SAME);
        if !is_same {
            let message = format!("{:?} has the part turned, or its zero point, otherwise than this job", self.job);
            let hint = "give both jobs the same up, rotation and zero";
            return Err(JobError::document("another-zero", JOB, message, hint));
        }
        let within = earlier.deviation + around.deviation + SAME_PART;
        let apart = [(earlier.part.0, around.part.0), (earlier.part.1, around.part.1)].map(|(a, b)| (a - b).amax());
        if apart.into_iter().any(|apart| apart > within) {
            let message = format!("{:?} is for another part than this job: their boxes differ", self.job);
            return Err(JobError::document("another-part", JOB, message, "give both jobs the same part"));
        }
        Ok(())
    }
}

//! What the verifier hands back.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engaged::OperationEngagement;
use crate::findings::{Finding, FindingKind};
use crate::groups::Group;
use crate::leaning::OperationFlank;
use crate::place::Place;

/// A contact, for a check against the exact model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContactRecord {
    /// Line of the text, from 1; 0 when it was not read from text.
    pub line: u32,
    /// The tool's tip, work coordinates, mm.
    pub tip: [f64; 3],
    /// The nearest point of the triangles, work coordinates, mm.
    pub point: [f64; 3],
    /// Distance between tool (with sheet) and triangles, mm; negative when the tool is in.
    pub clearance: f64,
    /// The triangle, index into the mesh.
    pub triangle: u32,
    /// The model's face behind the triangle.
    pub face: u32,
}

/// The verification. Positions of equal value: the first one in the program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// No finding is an error.
    pub ok: bool,
    /// What is wrong, errors first, kind by kind, region by region in the order of the lines, at most 20 of each group.
    pub findings: Vec<Finding>,
    /// All that is wrong, listed or not, by kind and region: errors first.
    pub groups: Vec<Group>,
    /// How many findings of each kind there are in all.
    pub counts: BTreeMap<FindingKind, usize>,
    /// Length of all moves that show each kind, mm.
    pub lengths: BTreeMap<FindingKind, f64>,
    /// Deepest entry into the part by any move, with the mesh's inward deviation, mm; 0 when nothing enters.
    pub gouge_max: f64,
    /// Where that is.
    pub gouge_at: Option<Place>,
    /// Largest distance of a contact move from the part, with the mesh's outward deviation, mm; 0 when there is none.
    pub excess_max: f64,
    /// Where that is.
    pub excess_at: Option<Place>,
    /// Share of the contact samples that touch within the limits, 0 to 1.
    pub contact_share: f64,
    /// Positions at which the clearance was measured. Gouges between them are excluded by proof.
    pub samples: usize,
    /// Contacts spread evenly over the program, at most 4000.
    pub contacts: Vec<ContactRecord>,
    /// What the operations that mill with the side of a leaning tool leave of their surfaces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub flanks: Vec<OperationFlank>,
    /// What the operations that clear stock engage along their feed moves: too much for a document.
    #[serde(skip)]
    pub engagement: Vec<OperationEngagement>,
}

impl Report {
    /// This report of a whole text, with what was found of a part of it with another shape, which `name` is.
    ///
    /// Contacts, the share of them that touch, and what is engaged stay those of the whole.
    #[must_use]
    pub fn with_stage(mut self, stage: Self, name: &str) -> Self {
        let first = self.findings.len();
        let named = |finding: Finding| Finding { message: format!("{name}: {}", finding.message), ..finding };
        self.findings.extend(stage.findings.into_iter().map(named));
        let moved =
            |group: Group| Group { findings: group.findings.iter().map(|index| first + index).collect(), ..group };
        self.groups.extend(stage.groups.into_iter().map(moved));
        stage.counts.into_iter().for_each(|(kind, count)| *self.counts.entry(kind).or_default() += count);
        stage.lengths.into_iter().for_each(|(kind, length)| *self.lengths.entry(kind).or_default() += length);
        self.ok &= stage.ok;
        self.samples += stage.samples;
        if stage.gouge_max > self.gouge_max {
            (self.gouge_max, self.gouge_at) = (stage.gouge_max, stage.gouge_at);
        }
        if stage.excess_max > self.excess_max {
            (self.excess_max, self.excess_at) = (stage.excess_max, stage.excess_at);
        }
        self
    }
}

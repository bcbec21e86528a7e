//! What planning an operation will take, reported before it is planned.

use serde::Serialize;
use styluscam_geometry::Vector;

use crate::operations::Areas;
use crate::resolve::selection_of;
use crate::selection::face_number;
use crate::{JobDocument, Part, Selection, Stages};

/// Seconds that a facet of the selected faces, and a node of a grid over the part, take.
const SECONDS_PER_FACET: f64 = 5e-6;
const SECONDS_PER_NODE: f64 = 2e-6;
/// Nodes of the grid that finds levels, at most.
const NODES: f64 = 4e6;

/// What planning an operation will take, roughly.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The operation's id.
    pub id: String,
    /// Its kind.
    pub kind: &'static str,
    /// Length of the path over the part, mm.
    pub length: f64,
    /// Moves of the program.
    pub points: f64,
    /// Time, s.
    pub seconds: f64,
    /// The key that decides.
    pub key: &'static str,
    /// Its value, mm.
    pub pitch: f64,
}

/// What planning each operation will take; nothing for kinds that do not know.
#[must_use]
pub fn estimates(job: &JobDocument, part: &Part) -> Vec<Estimate> {
    let up = job.setup.to_spindle();
    let (low, high) = part.mesh.bounds();
    let size = high - low;
    let plan_box = (size.product() / size.dot(&up).abs()).abs();
    let times = 1.0 + job.part.stages.as_ref().map_or(0, Stages::count) as f64; // once for each stage, and for the part
    let sections = job.operations.iter().enumerate();
    let estimates = sections.filter_map(|(index, section)| {
        let (selection, _) = selection_of(job, section, index);
        let (areas, count, mean) = areas(part, selection, up, if plan_box.is_finite() { plan_box } else { 0.0 });
        let effort = section.kind().effort(&areas)?;
        let spacing = section.common.smallest_feature / std::f64::consts::SQRT_2;
        let nodes = if effort.samples_grid { (plan_box / (spacing * spacing)).min(NODES) } else { 0.0 };
        // facets of this size take a chord or two; curved ones are small already
        let points = times * effort.length / (2.0 * mean).sqrt().max(0.5 * spacing);
        Some(Estimate {
            id: section.id(index),
            kind: section.operation.name(),
            length: times * effort.length,
            points,
            seconds: points * effort.seconds_per_point + SECONDS_PER_FACET * count as f64 + SECONDS_PER_NODE * nodes,
            key: effort.key,
            pitch: effort.pitch,
        })
    });
    estimates.collect()
}

/// The areas of a selection's triangles that do not face down, how many there are, and their mean area, mm^2.
fn areas(part: &Part, selection: &Selection, up: Vector, plan_box: f64) -> (Areas, usize, f64) {
    let numbers: Option<Vec<u32>> = match selection {
        Selection::All => None,
        Selection::Named(names) => {
            let added = |name: &str| part.names().iter().find(|(_, of)| *of == name).map(|(number, _)| *number);
            Some(names.iter().filter_map(|name| face_number(name).or_else(|| added(name))).collect())
        }
    };
    let (mut found, mut count, mut whole) = (Areas { plan: 0.0, elevation: 0.0, plan_box }, 0, 0.0);
    for (triangle, face) in part.mesh.faces().iter().enumerate() {
        let (area, rise) = (part.mesh.area(triangle), part.mesh.normal(triangle).dot(&up));
        if rise < -1e-9 || numbers.as_ref().is_some_and(|numbers| !numbers.contains(face)) {
            continue;
        }
        found.plan += area * rise;
        found.elevation += area * (1.0 - rise * rise).max(0.0).sqrt();
        count += 1;
        whole += area;
    }
    (found, count, if count == 0 { 0.5 } else { whole / count as f64 })
}

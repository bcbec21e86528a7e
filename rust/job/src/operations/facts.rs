//! What is reported of a planned operation: its figures, and what becomes of its faces.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::numbers::shown;

/// Less of an edge is no length, mm.
const NOTHING: f64 = 0.02;

/// A figure of a planned operation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fact {
    /// What it is: "levels".
    pub fact: &'static str,
    /// How many, or how much.
    pub value: f64,
    /// Its unit; empty for counts.
    pub unit: &'static str,
    /// In words.
    pub words: String,
}

impl Fact {
    /// So many things, called `one` or `many`.
    #[must_use]
    pub fn count(count: usize, one: &str, many: &'static str) -> Self {
        Self { fact: many, value: count as f64, unit: "", words: counted(count, one, many) }
    }

    /// A length in mm.
    #[must_use]
    pub fn length(fact: &'static str, mm: f64, words: &str) -> Self {
        Self { fact, value: mm, unit: "mm", words: format!("{words} {mm:.3} mm") }
    }
}

/// What of edges is not reached, by their names, mm.
pub(super) fn not_reached(missed: &BTreeMap<String, f64>) -> Option<Fact> {
    let all: Vec<_> = missed.iter().filter(|(_, length)| **length > NOTHING).collect();
    let sum: f64 = all.iter().map(|(_, length)| **length).sum();
    let named: Vec<String> =
        all.iter().map(|(name, length)| format!("{name} ({} mm)", shown((**length * 1e2).round() / 1e2))).collect();
    let words = format!("{sum:.2} mm not reached: {}", named.join(", "));
    (!all.is_empty()).then_some(Fact { fact: "not_reached", value: sum, unit: "mm", words })
}

/// "1 level", "2 levels", "12,000 levels".
pub(crate) fn counted(count: usize, one: &str, many: &str) -> String {
    let digits = count.to_string();
    let mut grouped = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    format!("{grouped} {}", if count == 1 { one } else { many })
}

/// What becomes of the faces that an operation follows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceFacts {
    /// Faces planned.
    pub faces: Vec<u32>,
    /// Largest wall angle of those faces, degrees.
    pub wall_angle_max_deg: f64,
    /// Where it ends though the tool could touch the faces farther down.
    pub ends: Option<End>,
    /// What becomes of the planned faces, in the order of their numbers.
    pub reached: Vec<ReachedFace>,
    /// How large the triangles are from which that is known where something stops the tool, mm, if larger than meant:
    /// there is more of it than is worth the time.
    pub reached_coarsely: Option<f64>,
    /// Faces with positions that the tool cannot touch, worst first.
    pub bridged: Vec<BridgedFace>,
    /// Faces with area that faces down, mm^2: not reached.
    pub undercut: Vec<(u32, f64)>,
}

/// Where an operation ends though the tool could touch its faces farther down; mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct End {
    /// Lowest tip.
    pub z: f64,
    /// Whether that is the part's foot, and nothing that the job states.
    pub at_foot: bool,
    /// Most of the faces' lowest parts that is touched only from lower down.
    pub untouched: f64,
}

/// How much of a face the tool reaches, and what keeps it from the rest; areas, mm^2, from samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReachedFace {
    /// The face.
    pub face: u32,
    /// Touched by the tool.
    pub contact: f64,
    /// Kept from the tool by the same smooth patch of the part, which is more curved than the tool.
    pub bridged: f64,
    /// Kept from the tool by something beyond a crease: a wall, a step, an island.
    pub interferes: f64,
    /// Steeper than the tool's profile: touched by its rim.
    pub rim: f64,
    /// Faces down.
    pub undercut: f64,
}

/// A face that the tool bridges.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BridgedFace {
    /// The face.
    pub face: u32,
    /// Most that is left between it and the tool, along the normal, mm.
    pub excess: f64,
    /// Where, work coordinates, mm.
    pub at: [f64; 3],
}

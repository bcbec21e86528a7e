//! An operation of a starter job before it is text.

use super::cutter::Cutter;
use crate::operations::{Serves, StarterPasses};

/// One operation.
#[derive(Clone, Debug)]
pub struct Work {
    pub id: String,
    /// What its kind is for.
    pub serves: Serves,
    /// Name of its tool.
    pub tool: String,
    /// The tool.
    pub cutter: Cutter,
    /// Numbers of the faces; none: the part's.
    pub faces: Option<Vec<u32>>,
    /// How its passes lie.
    pub passes: StarterPasses,
    /// Stock that it leaves on walls and floors, mm.
    pub leave: f64,
    /// Sentences: why it is there, and so.
    pub why: Vec<String>,
}

impl Work {
    /// Whether it names a face.
    pub fn names(&self, face: u32) -> bool {
        self.faces.as_ref().is_some_and(|faces| faces.contains(&face))
    }
}

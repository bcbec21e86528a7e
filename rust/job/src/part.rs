//! The part as triangles, as it is formed, and what is known of the target.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;
use styluscam_geometry::{Bvh, Mesh, NurbsCurve, Vector};

use crate::operations::Fact;
use crate::shaping::Compensation;

/// The part as its reader hands it over.
#[derive(Clone, Debug)]
pub struct Part {
    /// Triangles in the file's frame, mm.
    pub mesh: Mesh,
    /// How far the triangles lie inside the material at most, mm; checked by the reader.
    pub inward: f64,
    /// How far they lie outside it at most, mm.
    pub outward: f64,
    /// What was done to the part in the file, if it is not that one that is formed.
    pub shaped: Option<Shaped>,
    /// What is known of its curves.
    pub curves: Arc<Curves>,
}

/// Curves of a part in the file's frame, mm.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    /// Its edges from end to end, the first is Edge1; none for one without a curve.
    pub edges: Vec<Option<NurbsCurve>>,
    /// The rails of the faces that are ruled between two curves, by the faces' numbers.
    pub ruled: BTreeMap<u32, [NurbsCurve; 2]>,
}

/// What was done to a part.
#[derive(Clone, Debug)]
pub struct Shaped {
    /// The target, with the triangles of the changed one.
    pub(crate) target: Mesh,
    /// What was changed.
    pub facts: Vec<Fact>,
    /// How far within triangles the linear map differs from the one by which points are taken back, mm.
    pub linear: f64,
    /// How points are taken back to the part in the file.
    pub(crate) undone: Undone,
    /// Faces that were added, and their names.
    pub(crate) names: Vec<(u32, &'static str)>,
    /// Where the part is cut off after it is formed: closed lines in the file's frame, mm.
    pub trim: Vec<Vec<Vector>>,
}

/// What takes points of a changed part back to the one in the file.
#[derive(Clone, Debug)]
pub(crate) enum Undone {
    /// Its springback was compensated.
    Springback(Compensation),
    /// Faces were added, from this number on.
    Addendum {
        /// The changed part's index.
        bvh: Arc<Bvh>,
        /// Number of the first face that was added.
        first: u32,
    },
    /// It is a stage of the part: no point of it is known to be one of the part.
    Nowhere,
}

impl Part {
    /// The target, which decides what its faces are for and where its highest point lies.
    #[must_use]
    pub(crate) fn target(&self) -> &Mesh {
        self.shaped.as_ref().map_or(&self.mesh, |shaped| &shaped.target)
    }

    /// What was changed.
    #[must_use]
    pub fn changes(&self) -> &[Fact] {
        self.shaped.as_ref().map_or(&[], |shaped| &shaped.facts)
    }

    /// Where the part is cut off after it is formed: closed lines in the file's frame, mm; none where it is not.
    #[must_use]
    pub fn trim(&self) -> &[Vec<Vector>] {
        self.shaped.as_ref().map_or(&[], |shaped| &shaped.trim)
    }

    /// The faces that were added to the part, and their names.
    pub(crate) fn names(&self) -> &[(u32, &'static str)] {
        self.shaped.as_ref().map_or(&[], |shaped| &shaped.names)
    }

    /// Where points of the changed part lie on the target, mm; none where that is not unique.
    #[must_use]
    pub fn target_points(&self, points: &[Vector]) -> Vec<Option<Vector>> {
        let target = |point: &Vector| match self.shaped.as_ref().map(|shaped| &shaped.undone) {
            None => Some(*point),
            Some(Undone::Springback(compensation)) => compensation.undone(*point),
            Some(Undone::Nowhere) => None,
            Some(Undone::Addendum { bvh, first }) => {
                let (_, triangle) = bvh.nearest(&self.mesh, *point);
                (self.mesh.faces()[triangle] < *first).then_some(*point)
            }
        };
        points.par_iter().map(target).collect()
    }
}

//! What operations are to make of the part, where that is not the part itself: the edges that they chamfer are sharp in the model.

use styluscam_geometry::{chamfered, Bvh, Mesh};

use crate::expectation::{Chamfering, ExpectedOperation};
use crate::segments::{Segment, SegmentKind};
use crate::subject::Subject;

/// The part as operations that chamfer its edges are to make it.
pub(crate) struct Shapes {
    /// By the operation's number; none of operations that chamfer nothing.
    all: Vec<Option<(Mesh, Bvh)>>,
}

impl Shapes {
    pub fn of(subject: &Subject) -> Self {
        let shape = |chamfering: &Chamfering| {
            let edges: Vec<_> = chamfering.edges.iter().map(|piece| piece.edge).collect();
            // chamfers that do not fit are refused before anything is planned: the part as it is only finds more
            let mesh = chamfered(subject.mesh, &edges, chamfering.size).ok()?;
            let bvh = Bvh::new(&mesh);
            Some((mesh, bvh))
        };
        let of = |operation: &ExpectedOperation| operation.expectation.chamfering().and_then(shape);
        Self { all: subject.expected.iter().map(of).collect() }
    }

    /// What an operation is to make of the part, by its number.
    pub fn at(&self, operation: usize) -> Option<(&Mesh, &Bvh)> {
        self.all.get(operation)?.as_ref().map(|(mesh, bvh)| (mesh, bvh))
    }

    /// What a feed is to leave whole, where that is not the part itself.
    pub fn of_segment(&self, segment: &Segment) -> Option<(&Mesh, &Bvh)> {
        segment.expected.filter(|_| segment.kind != SegmentKind::Rapid).and_then(|number| self.at(number))
    }
}

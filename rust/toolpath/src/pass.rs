//! Exact positions of the tool, and passes of them: what strategies make.

use styluscam_geometry::Vector;

/// An exact position of the tool on the envelope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// The tool's tip, mm.
    pub tip: Vector,
    /// Unit normal of the contact, into the tool: the direction in which it comes free.
    pub normal: Vector,
    /// Whether the contact lies on a selected face.
    pub selected: bool,
    /// The triangle touched, one of equals.
    pub triangle: u32,
}

/// The length in plan of a path through points, mm.
pub(crate) fn plan_length(points: &[PathPoint]) -> f64 {
    points.windows(2).map(|side| (side[1].tip - side[0].tip).xy().norm()).sum()
}

/// A run of the tool along the surface: what a strategy makes and linking joins.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// Tip positions in order; the first is repeated at the end when closed.
    pub points: Vec<PathPoint>,
    /// Whether it ends where it begins.
    pub closed: bool,
    /// Number of the level or row, from 0.
    pub group: usize,
}

impl Pass {
    /// Whether it ends lower than it begins.
    #[must_use]
    pub fn descends(&self) -> bool {
        self.points.first().zip(self.points.last()).is_some_and(|(first, last)| last.tip.z < first.tip.z)
    }
}

/// In which of their two directions passes are followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sense {
    /// As the strategy lays them out.
    #[default]
    Forward,
    /// Each the other way round.
    Reversed,
    /// Every other level or row the other way round.
    Alternate,
}

impl Sense {
    /// Whether the passes of a group are turned round, by its number in their order.
    #[must_use]
    pub fn turns(self, group: usize) -> bool {
        match self {
            Self::Forward => false,
            Self::Reversed => true,
            Self::Alternate => group % 2 == 1,
        }
    }
}

//! What is measured along a segment: clearances at its positions.

use styluscam_geometry::Vector;

use crate::clearance::Touch;
use crate::faults::FaultKind;
use crate::tolerances::SLACK;

/// The clearance at one position of a contact move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// The tool's tip.
    pub tip: [f64; 3],
    pub touch: Touch,
}

/// What was found along one move.
#[derive(Clone, Debug, Default)]
pub(crate) struct Measured {
    /// The deepest position, when it could matter.
    pub deepest: Option<Sample>,
    /// The deepest position in the stock that is to be left, where that could matter.
    pub taken: Option<Sample>,
    /// Start, middle and end of a contact move, as far as they are known.
    pub contacts: [Option<Sample>; 3],
    /// Too little air under a rapid that comes down: the position where it ends.
    pub landing: Option<Sample>,
    /// The worst position of what comes too near to something besides, what that is, and what must be left, mm.
    pub struck: Option<Strike>,
    /// Positions at which the clearance was measured.
    pub samples: usize,
}

/// Something that comes too near to something else.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strike {
    pub kind: &'static FaultKind,
    /// Whether the part is what the tool comes too near to.
    pub is_at_part: bool,
    pub sample: Sample,
    /// The clearance that must be left, mm.
    pub least: f64,
}

impl Strike {
    /// The same this much lower, mm.
    pub fn lowered(self, by: f64) -> Self {
        let Sample { tip: [x, y, z], touch } = self.sample;
        let touch = Touch { point: touch.point - by * Vector::z(), ..touch };
        Self { sample: Sample { tip: [x, y, z - by], touch }, ..self }
    }
}

/// The deepest of the samples; the latest of those that are equal but for arithmetic, because the position that
/// two moves share belongs to the one that ends there.
pub(crate) fn lowest(samples: &[Option<Sample>; 3]) -> Option<Sample> {
    let deeper = |a: Sample, b: Sample| if b.touch.value <= a.touch.value + SLACK { b } else { a };
    samples.iter().flatten().copied().reduce(deeper)
}

/// The sample farthest off; the latest of those that are equal but for arithmetic.
pub(crate) fn highest(samples: &[Option<Sample>; 3]) -> Option<Sample> {
    let higher = |a: Sample, b: Sample| if b.touch.value >= a.touch.value - SLACK { b } else { a };
    samples.iter().flatten().copied().reduce(higher)
}

/// The direction in which the part lies, as a unit normal out of it.
pub(crate) fn normal_of(touch: &Touch) -> Vector {
    -touch.away
}

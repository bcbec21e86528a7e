//! The order of passes by least air: what the tool travels between them.
//!
//! The nearest pass next ([`ordered`]) leaves some behind, which cost long links in the end. From that order, and from one in
//! which separate areas may be finished one after the other, passes and chains of them move to where they cost less
//! ([`improve`]), as long as nothing comes before what it has to follow ([`precedence`]). The shortest of all is taken, which is
//! never longer than the nearest next. Derived in docs/concepts/linking.md.

mod air;
mod freedom;
mod greedy;
mod improve;
mod nearest;
mod precedence;
mod sequence;

use styluscam_motion::{Cancelled, Watch};

use crate::{Pass, Seam, Sense};
use air::LEAST;
use improve::improved;
use precedence::Precedence;
use sequence::Sequence;

pub use air::Air;
pub use freedom::Freedom;
pub use nearest::{begin_nearest, ordered};

/// Improvements of a whole order, at most: each begins loops anew where the one before has them begin.
const ROUNDS: usize = 3;

/// Passes in their order, and what the tool travels between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Ordered {
    /// As they are followed.
    pub passes: Vec<Pass>,
    /// Between them, mm: with the nearest next, group by group; and so.
    pub between: [f64; 2],
}

/// The passes as [`ordered`], in a shorter order where that leaves one free. Deterministic; the work is bounded.
///
/// # Errors
/// `Cancelled`.
pub fn shortly_ordered(
    passes: Vec<Pass>,
    (sense, seam): (Sense, Seam),
    freedom: Freedom<'_>,
    air: &Air,
    watch: &Watch,
) -> Result<Ordered, Cancelled> {
    let nearest = ordered(passes, sense, seam, watch)?;
    let before = air.between(&nearest);
    if !air.is_crossed(&nearest) || nearest.iter().any(|pass| pass.points.is_empty()) {
        return Ok(Ordered { passes: nearest, between: [before; 2] });
    }
    watch.begin("shortening links", nearest.len());
    let given = Sequence::of(&nearest, matches!(seam, Seam::Nearest));
    let mut best = shortened(given.clone(), &Precedence::by_groups(&nearest), air, watch)?;
    if let Some(precedence) = Precedence::of_areas(&nearest, freedom, watch)? {
        let turns = matches!(freedom, Freedom::OfRows { is_reversible: true, .. });
        let free = given.turning(turns);
        let greedy = free.reordered(greedy::nearest_next(&free, &precedence, watch)?, air);
        let by_areas = shortened(greedy, &precedence, air, watch)?;
        if by_areas.length < best.length - LEAST {
            best = by_areas;
        }
    }
    let (order, after) = (best.order(), best.length);
    if after < before - LEAST {
        Ok(Ordered { passes: order.of(nearest), between: [before, after] })
    } else {
        Ok(Ordered { passes: nearest, between: [before; 2] })
    }
}

/// A sequence in a shorter order, loops begun where they are nearest.
fn shortened<'a>(
    mut sequence: Sequence<'a>,
    precedence: &Precedence,
    air: &Air,
    watch: &Watch,
) -> Result<Sequence<'a>, Cancelled> {
    for _ in 0..ROUNDS {
        let stops = improved(&sequence, precedence, air, watch)?;
        let next = sequence.reordered(stops, air);
        if next.length > sequence.length - LEAST {
            break;
        }
        sequence = next;
    }
    Ok(sequence)
}

#[cfg(test)]
mod tests;

//! The order of passes by least air: what the tool travels between them.
//!
//! The nearest pass next ([`ordered`]) leaves some behind, which cost long links in the end. From that order, and from one in
//! which separate areas may be finished one after the other, passes and chains of them move to where they cost less
//! ([`improve`]), as long as nothing comes before what it has to follow ([`precedence`]). The shortest of all is taken, which is
//! never longer than the nearest next. Derived in docs/concepts/linking.md.

mod greedy;
mod improve;
mod nearest;
mod precedence;
mod sequence;

use styluscam_motion::{Cancelled, Watch};

use crate::{Pass, Seam, Sense};
use improve::improved;
use nearest::directed_by_groups;
use precedence::Precedence;
use sequence::Sequence;

pub use nearest::{begin_nearest, ordered};

/// Orders that differ by less are equally long, mm.
const LEAST: f64 = 1e-6;
/// Improvements of a whole order, at most: each begins loops anew where the one before has them begin.
const ROUNDS: usize = 3;

/// What of the order of passes is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Freedom<'a> {
    /// That of the passes of a group (a level or a row): groups follow one after the other.
    WithinGroups,
    /// A pass follows those of the groups above it that lie within a reach of it in plan, or that enclose it.
    OfAreas {
        /// mm.
        reach: f64,
        /// Whether what is inside of a loop is done before the next loop below around it: sheet hangs there.
        inside_first: bool,
    },
    /// Rows in any order; each set, which begins with one of these groups, after those before it.
    OfRows {
        /// Numbers of the first groups of all sets, ascending.
        sets: &'a [usize],
        /// Whether a row may be followed in its other direction.
        is_reversible: bool,
        /// Rows of another set that are within this reach come first, mm.
        reach: f64,
    },
}

/// What the tool travels from a pass to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Height at which rapids cross, mm.
    pub height: f64,
    /// Up to this distance in plan the tool goes straight, mm.
    pub along: f64,
}

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
    passes: &[Pass],
    (sense, seam): (Sense, Seam),
    freedom: Freedom<'_>,
    air: &Air,
    watch: &Watch,
) -> Result<Ordered, Cancelled> {
    let nearest = ordered(passes, sense, seam, watch)?;
    let before = air.between(&nearest);
    let unchanged = |passes| Ok(Ordered { passes, between: [before; 2] });
    if !air.is_crossed(&nearest) || nearest.iter().any(|pass| pass.points.is_empty()) {
        return unchanged(nearest);
    }
    watch.begin("shortening links", passes.len());
    let is_free = matches!(seam, Seam::Nearest);
    let by_groups = shortened(Sequence::of(&nearest, is_free), &Precedence::by_groups(&nearest), air, watch)?;
    let mut best = (by_groups, &nearest);
    let given: Vec<Pass>;
    if let Some(precedence) = Precedence::of_areas(passes, freedom, watch)? {
        given = directed_by_groups(passes, sense, seam);
        let turns = matches!(freedom, Freedom::OfRows { is_reversible: true, .. });
        let free = Sequence::of(&given, is_free).turning(turns);
        let greedy = free.reordered(greedy::nearest_next(&free, &precedence, watch)?, air);
        let by_areas = shortened(greedy, &precedence, air, watch)?;
        if by_areas.length < best.0.length - LEAST {
            best = (by_areas, &given);
        }
    }
    let (sequence, of) = best;
    let shorter = sequence.passes(of);
    let after = air.between(&shorter);
    if after < before - LEAST {
        Ok(Ordered { passes: shorter, between: [before, after] })
    } else {
        unchanged(nearest)
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

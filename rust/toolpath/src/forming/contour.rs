//! Loops of a level from its segments.

use std::collections::{BTreeMap, BTreeSet};

use super::{square::Edge, trace::Segment};
use crate::PathPoint;

/// Points of a level in order; a closed chain repeats the first at the end.
pub struct Chain {
    pub points: Vec<PathPoint>,
    pub closed: bool,
}

/// Joins segments, of which no two begin at one edge, to chains: open ones from their beginnings, then closed ones.
pub fn chains(segments: Vec<Segment>) -> Vec<Chain> {
    let mut next: BTreeMap<Edge, Segment> = segments.into_iter().map(|segment| (segment.from, segment)).collect();
    let reached: BTreeSet<Edge> = next.values().map(|segment| segment.to).collect();
    let begins: Vec<Edge> = next.keys().filter(|edge| !reached.contains(edge)).copied().collect();
    let mut chains: Vec<Chain> = begins.into_iter().map(|begin| walk(&mut next, begin)).collect();
    while let Some(begin) = next.keys().next().copied() {
        chains.push(walk(&mut next, begin));
    }
    chains
}

fn walk(next: &mut BTreeMap<Edge, Segment>, begin: Edge) -> Chain {
    let (mut points, mut at): (Vec<PathPoint>, Edge) = (Vec::new(), begin);
    while let Some(segment) = next.remove(&at) {
        let is_known = points.last().is_some_and(|last| Some(last) == segment.points.first());
        points.extend(segment.points.into_iter().skip(usize::from(is_known)));
        at = segment.to;
    }
    Chain { points, closed: at == begin }
}

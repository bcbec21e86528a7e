//! The nearest of all passes that may come next.

use rstar::RTree;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use super::nearest::{stretches, Stretch};
use super::precedence::Precedence;
use super::sequence::{Sequence, Stop};
use crate::PathPoint;

/// An order in which the nearest pass of all whose predecessors are done comes next, the first of equals.
///
/// # Errors
/// `Cancelled`.
pub fn nearest_next(sequence: &Sequence<'_>, precedence: &Precedence, watch: &Watch) -> Result<Vec<Stop>, Cancelled> {
    let passes = sequence.given();
    let mut missing: Vec<usize> = (0..passes.len()).map(|pass| precedence.before(pass).len()).collect();
    let mut left = Left { sequence, tree: RTree::new() };
    let free = (0..passes.len()).filter(|pass| missing[*pass] == 0);
    left.tree = RTree::bulk_load(free.flat_map(|pass| left.of(pass)).collect());
    let mut stops: Vec<Stop> = Vec::with_capacity(passes.len());
    let mut from: Option<Vector> = None;
    while let Some(pass) = left.nearest(from) {
        watch.advance(1)?;
        for stretch in left.of(pass) {
            left.tree.remove(&stretch);
        }
        let points = &passes[pass].points;
        let ends = [points.first(), points.last()].map(|point| point.map_or_else(Vector::zeros, |point| point.tip));
        let away = |end: Vector| from.map_or(0.0, |from| (end - from).norm_squared());
        let is_turned = sequence.may_turn(pass) && away(ends[1]) < away(ends[0]);
        stops.push(Stop { pass, is_turned });
        from = Some(match from {
            Some(from) if sequence.begins_anywhere(pass) => nearest_tip(points, from),
            _ => ends[usize::from(!is_turned)],
        });
        for next in precedence.after(pass) {
            missing[*next as usize] -= 1;
            if missing[*next as usize] == 0 {
                left.of(*next as usize).for_each(|stretch| left.tree.insert(stretch));
            }
        }
    }
    Ok(stops)
}

fn nearest_tip(points: &[PathPoint], from: Vector) -> Vector {
    let distance = |tip: &Vector| (tip - from).norm_squared();
    points.iter().map(|point| point.tip).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(from)
}

/// The passes that may come next.
struct Left<'s, 'a> {
    sequence: &'s Sequence<'a>,
    tree: RTree<Stretch<'a>>,
}

impl<'a> Left<'_, 'a> {
    /// The nearest to a tip, or the first.
    fn nearest(&self, from: Option<Vector>) -> Option<usize> {
        match from {
            None => self.tree.iter().map(|stretch| stretch.pass).min(),
            Some(from) => self.tree.nearest_neighbors(&from.into()).into_iter().map(|stretch| stretch.pass).min(),
        }
    }

    /// The points at which a pass may begin.
    fn of(&self, pass: usize) -> impl Iterator<Item = Stretch<'a>> + use<'a> {
        let points = &self.sequence.given()[pass].points[..];
        let first = points.get(..1).unwrap_or_default();
        let last = points.len().checked_sub(1).and_then(|last| points.get(last..)).unwrap_or_default();
        let [entries, more] = match (self.sequence.begins_anywhere(pass), self.sequence.may_turn(pass)) {
            (true, _) => [points, &[]],
            (false, true) => [first, last],
            (false, false) => [first, &[]],
        };
        stretches(pass, entries).chain(stretches(pass, more))
    }
}

//! In which direction a path goes at its witnesses, and which pieces keep to it.

use styluscam_geometry::Vector;
use styluscam_motion::Plane;

use crate::fitting::{angle, EDGE};
use crate::{PathPoint, Segment};

/// A path's direction is seen within so many doublings of the shortest length that shows one.
const DOUBLINGS: u32 = 5;

/// The paths before and behind one that goes on from one to the other; empty where the tool comes through the air, or leaves
/// into it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Neighbours<'a> {
    /// Ends where the path begins.
    pub before: &'a [PathPoint],
    /// Begins where the path ends.
    pub after: &'a [PathPoint],
}

/// The directions of a path, of which no piece is to differ by more than half of a corner at its ends: so two that meet turn by
/// no more than the corner.
pub struct Directions<'a> {
    pub witnesses: &'a [PathPoint],
    pub neighbours: Neighbours<'a>,
    /// rad.
    pub corner: f64,
}

impl Directions<'_> {
    /// By how much a piece from one witness to another, that begins and ends in some directions, turns from the end of the one before
    /// and from the path's direction at its own, as a share of what it may.
    pub fn turns(&self, (from, to): (usize, usize), entering: Option<Vector>, [start, end]: [Vector; 2]) -> f64 {
        let aside = |at: usize, piece: &Vector| self.at(at).map_or(0.0, |along| 2.0 * angle(&along, piece));
        let begins = entering.map_or_else(|| aside(from, &start), |entering| angle(&entering, &start));
        begins.max(aside(to, &end)) / self.corner
    }

    /// The direction at a witness, in the middle of those in which the path comes and goes; none at an end that nothing meets, and
    /// at an edge. What turns there and back again over a short way has none there.
    fn at(&self, number: usize) -> Option<Vector> {
        let here = self.witnesses[number].tip;
        for doubled in 0..=DOUBLINGS {
            let window = EDGE * f64::from(1 << doubled);
            let is_far = |point: &&PathPoint| (point.tip - here).norm() > window;
            let coming = self.witnesses[..number].iter().rev().find(is_far);
            let coming = coming.or_else(|| self.neighbours.before.iter().rev().find(is_far));
            let going = self.witnesses[number + 1..].iter().find(is_far);
            let going = going.or_else(|| self.neighbours.after.iter().find(is_far));
            let (coming, going) = (here - coming?.tip, going?.tip - here);
            if angle(&coming, &going) <= 0.5 * self.corner {
                return Some(coming.normalize() + going.normalize());
            }
        }
        None
    }
}

/// In which directions a segment begins and ends; not of unit length.
pub fn of_segment(segment: &Segment, start: Vector) -> [Vector; 2] {
    let Some(arc) = segment.turning() else { return [segment.end - start; 2] };
    let sweep = arc.path(start.into(), segment.end.into()).sweep();
    let [first, second, third] = Plane::axes(arc.plane);
    [start, segment.end].map(|point| {
        let mut along = Vector::zeros();
        along[first] = sweep * (arc.centre[second] - point[second]);
        along[second] = sweep * (point[first] - arc.centre[first]);
        along[third] = segment.end[third] - start[third];
        along
    })
}

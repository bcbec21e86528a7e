//! The height of a wall of constant angle over a position: the lowest of the cones that stand on the edge it rises from, or of
//! what is instead of a cone where the wall leaves the edge by the part's own slope.

use rstar::{primitives::GeomWithData, primitives::Line, RTree};

use super::super::cone;
use super::bend::Bend;
use crate::Vector;

/// How often it is asked where on a side a wall with an arc rises from.
const REPEATED: u32 = 2;
/// A wall is at least so many times as steep as the side that it rises from, and rises by so much: from less it would rise nowhere.
const STEEPER: f64 = 1.001;
const LEAST_RISE: f64 = 1e-6;

/// The wall's height somewhere, and from where on the edge it rises.
#[derive(Clone, Copy, Debug)]
pub struct Risen {
    /// Height of the wall, without an end, mm.
    pub height: f64,
    /// The point of the edge.
    pub foot: Vector,
    /// Rise of the wall per length in plan.
    pub rise: f64,
}

/// Walls of one angle outside of closed lines.
pub struct Walls {
    sides: Vec<[Vector; 2]>,
    tree: RTree<GeomWithData<Line<[f64; 2]>, usize>>,
    slope: f64,
    low: f64,
    /// By which angles the wall leaves both ends of each side, rad; of a wall that has its angle all along, none.
    leaving: Vec<[f64; 2]>,
    /// The bend that rises least.
    bend: Bend,
}

impl Walls {
    /// `sides` in their order along the lines, `leaving` as many pairs of angles, or none; `angle` is the wall's, rad, and `radius`
    /// that of the arcs from those to this, mm.
    pub fn new(sides: Vec<[Vector; 2]>, leaving: Vec<[f64; 2]>, angle: f64, radius: f64) -> Self {
        let line =
            |(number, [a, b]): (usize, &[Vector; 2])| GeomWithData::new(Line::new([a.x, a.y], [b.x, b.y]), number);
        let tree = RTree::bulk_load(sides.iter().enumerate().map(line).collect());
        let low = sides.iter().flatten().map(|point| point.z).fold(f64::INFINITY, f64::min);
        let least = leaving.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let (from, radius) = if leaving.is_empty() { (angle, 0.0) } else { (least, radius) };
        Self { sides, tree, slope: libm::tan(angle), low, leaving, bend: Bend { from, to: angle, radius } }
    }

    /// Rise per length in plan, behind the bends.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// How the wall leaves a point of a side, which is a share of it.
    pub fn bend(&self, side: usize, share: f64) -> Bend {
        match self.leaving.get(side) {
            Some([first, last]) => Bend { from: first + share * (last - first), ..self.bend },
            None => self.bend,
        }
    }

    /// Chords with which the arcs at the edge are followed within a tolerance, mm; none of a wall without.
    pub fn chords(&self, tolerance: f64) -> u32 {
        let turn = |angle: &f64| (self.bend.to - angle).abs();
        let most = self.leaving.iter().flatten().map(turn).fold(0.0, f64::max);
        if most <= 0.0 {
            return 0;
        }
        (most / (8.0 * tolerance / self.bend.radius).sqrt()).ceil() as u32
    }

    /// The highest point at which the wall has its own angle, mm.
    pub fn straight_from(&self) -> f64 {
        let begins = |(side, [a, b]): (usize, &[Vector; 2])| {
            f64::max(a.z + self.bend(side, 0.0).climb(), b.z + self.bend(side, 1.0).climb())
        };
        self.sides.iter().enumerate().map(begins).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The wall that rises from one side, over a position.
    pub fn of_side(&self, side: usize, at: [f64; 2]) -> f64 {
        self.lowest(side, at).0
    }

    /// The height of the wall that rises from a side, over a position, and the share of the side that it rises from there.
    ///
    /// With an arc at the edge it rises least in the direction in which the side falls: as from a cone with the wall's slope at the
    /// position. That depends on where it rises from, and is found by repeating it.
    fn lowest(&self, side: usize, at: [f64; 2]) -> (f64, f64) {
        let [a, b] = self.sides[side];
        let (height, mut share) = cone::lowest(a, b, at, self.slope);
        if self.leaving.is_empty() {
            return (height, share);
        }
        let along = (b.z - a.z).abs() / (b - a).xy().norm().max(f64::MIN_POSITIVE);
        let distance = |share: f64| {
            let foot = a + share * (b - a);
            libm::hypot(at[0] - foot.x, at[1] - foot.y)
        };
        for _ in 0..REPEATED {
            let rise = self.bend(side, share).rise(distance(share));
            share = cone::lowest(a, b, at, rise.max(STEEPER * along).max(LEAST_RISE)).1;
        }
        (a.z + share * (b.z - a.z) + self.bend(side, share).height(distance(share)), share)
    }

    /// The wall over a position: the lowest of all cones on the lines, which no other wall with their heights and this slope
    /// exceeds. Sides are looked at from the nearest on, as long as the lowest point of all could rise from there.
    pub fn at(&self, at: [f64; 2]) -> Risen {
        let mut best = (f64::INFINITY, 0, 0.0);
        for (line, squared) in self.tree.nearest_neighbor_iter_with_distance_2(at) {
            if self.low + self.bend.height(squared.sqrt()) > best.0 {
                break;
            }
            let (height, share) = self.lowest(line.data, at);
            if height < best.0 || height <= best.0 && line.data < best.1 {
                best = (height, line.data, share);
            }
        }
        let (height, side, share) = best;
        let [a, b] = self.sides[side];
        let foot = a + share * (b - a);
        let rise = self.bend(side, share).rise(libm::hypot(at[0] - foot.x, at[1] - foot.y));
        Risen { height, foot, rise }
    }
}

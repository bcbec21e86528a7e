//! The nodes at which heights are kept, and rectangles of them.

use styluscam_geometry::GeometryError;

use super::cut::Position;

/// A grid of nodes in plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The first node, mm.
    pub origin: [f64; 2],
    /// From one node to the next along X and Y, mm.
    pub step: [f64; 2],
    /// Nodes along X and Y.
    pub nodes: [usize; 2],
}

impl Grid {
    /// Intervals along a side come in multiples of a power of two up to this: meshes are drawn by halving squares.
    const SQUARE: usize = 64;
    /// Nodes at most.
    const MOST: f64 = 4e7;

    /// A grid from corner to corner whose nodes are at most `spacing` mm apart.
    ///
    /// # Errors
    /// A spacing that is no length, or so fine that the nodes would be too many.
    pub fn over(low: [f64; 2], high: [f64; 2], spacing: f64) -> Result<Self, GeometryError> {
        let size = [0, 1].map(|k| high[k] - low[k]);
        let count = (size[0] / spacing + 2.0) * (size[1] / spacing + 2.0);
        if spacing <= 0.0 || count.is_nan() || count > Self::MOST {
            let allowed = "a length above 0, at which the part has no more than forty million nodes";
            return Err(GeometryError::OutOfRange { key: "spacing", value: spacing, allowed });
        }
        let least = size.map(|size| (size / spacing * (1.0 - 1e-12)).ceil().max(1.0) as usize);
        let square = Self::square_of(least);
        let intervals = least.map(|count| count.div_ceil(square) * square);
        let step = [0, 1].map(|k| size[k] / intervals[k] as f64);
        Ok(Self { origin: low, step, nodes: intervals.map(|count| count + 1) })
    }

    /// The largest square that adds no more than an eighth to either side.
    fn square_of(intervals: [usize; 2]) -> usize {
        let eighth = intervals[0].min(intervals[1]) / 8;
        (0..).map(|k| 1 << k).take_while(|size| *size <= eighth.clamp(1, Self::SQUARE)).last().unwrap_or(1)
    }

    /// Intervals along the sides of the squares that it consists of.
    #[must_use]
    pub fn square(&self) -> usize {
        let power = |intervals: usize| 1 << intervals.trailing_zeros().min(Self::SQUARE.trailing_zeros());
        power(self.nodes[0] - 1).min(power(self.nodes[1] - 1))
    }

    /// Number of nodes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.nodes[0] * self.nodes[1]
    }

    /// Where a node is in plan, mm.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> [f64; 2] {
        [self.origin[0] + x as f64 * self.step[0], self.origin[1] + y as f64 * self.step[1]]
    }

    /// Where the node of that number is in plan, mm: row by row from the lowest Y.
    pub(super) fn position(&self, node: usize) -> Position {
        self.at(node % self.nodes[0], node / self.nodes[0])
    }

    pub(super) fn whole(&self) -> Region {
        Region { from: [0, 0], to: self.nodes }
    }
}

/// A rectangle of nodes: `to` is beyond.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    pub from: [usize; 2],
    pub to: [usize; 2],
}

/// A region in plan.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub middle: Position,
    /// Half of its sides, mm.
    pub half: Position,
}

impl Region {
    pub fn size(&self) -> [usize; 2] {
        [self.to[0] - self.from[0], self.to[1] - self.from[1]]
    }

    pub fn count(&self) -> usize {
        let [width, height] = self.size();
        width * height
    }

    /// Two halves across its longer side.
    pub fn halves(&self) -> [Self; 2] {
        let size = self.size();
        let axis = usize::from(size[1] > size[0]);
        let middle = self.from[axis] + size[axis] / 2;
        let (mut first, mut second) = (*self, *self);
        first.to[axis] = middle;
        second.from[axis] = middle;
        [first, second]
    }

    pub fn extent(&self, grid: &Grid) -> Extent {
        let low = grid.at(self.from[0], self.from[1]);
        let high = grid.at(self.to[0] - 1, self.to[1] - 1);
        Extent {
            middle: [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])],
            half: [0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1])],
        }
    }
}

impl Extent {
    /// Half of its diagonal, mm.
    pub fn reach(&self) -> f64 {
        crate::body::length(self.half[0], self.half[1])
    }

    /// Offsets of its corners from its middle.
    pub fn corners(&self) -> [Position; 4] {
        let [x, y] = self.half;
        [[-x, -y], [x, -y], [-x, y], [x, y]]
    }
}

//! The stock over a part at the nodes of a grid: how deep tools get there, and what they leave.

use styluscam_geometry::{Mesh, Tool};
use styluscam_toolpath::offset::{Envelope, Index};
use styluscam_toolpath::Surface;

use super::allowances::Allowances;
use super::drilling::Drilled;
use crate::level_edges::sides;

/// The vertical part of the normal of upright triangles.
const UPRIGHT: f64 = 0.02;

/// The nodes of a part's stock in plan.
pub struct StockNodes<'a> {
    mesh: &'a Mesh,
    /// The part's triangles for tools from above.
    index: Index,
    /// Lower left corner of the stock, its top and the part's foot, mm.
    corner: [f64; 2],
    pub top: f64,
    pub foot: f64,
    /// Of the stock in plan, mm.
    size: [f64; 2],
    /// Between nodes, mm.
    apart: f64,
    counts: [usize; 2],
    /// What is drilled.
    holes: &'a [Drilled],
    /// Nodes in holes that are drilled.
    drilled: Vec<bool>,
}

/// What the front of a tool sweeps about its axis.
pub struct Front {
    /// Nodes from the middle to the rim.
    reach: usize,
    /// Rows and columns from `reach` before the axis, and the height over the tip there, mm.
    heights: Vec<([usize; 2], f64)>,
}

impl Front {
    /// Nodes from the axis to the rim.
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// Without what is nearer to its rim than so many nodes.
    pub fn without_rim(&self, nodes: usize) -> Self {
        let within = self.reach.saturating_sub(nodes);
        let is_within =
            |at: &[usize; 2]| at.iter().map(|i| i.abs_diff(self.reach).pow(2)).sum::<usize>() <= within * within;
        Self { reach: self.reach, heights: self.heights.iter().filter(|(at, _)| is_within(at)).copied().collect() }
    }
}

/// A tool that stands on the part over a node.
#[derive(Clone, Copy, Debug)]
pub struct Standing {
    /// Height of its tip, mm.
    pub tip: f64,
    /// The face that it touches.
    pub face: u32,
    /// Whether what it touches is upright.
    pub is_beside_wall: bool,
}

impl<'a> StockNodes<'a> {
    /// The shorter and the longer side of the stock in plan, mm.
    pub fn stock_sides(&self) -> [f64; 2] {
        let [x, y] = self.size;
        [x.min(y), x.max(y)]
    }

    /// So many nodes along the stock's longer side.
    pub fn new(mesh: &'a Mesh, allowances: Allowances, holes: &'a [Drilled], count: f64) -> Self {
        let (low, high) = mesh.bounds();
        let size = [high.x - low.x, high.y - low.y].map(|length| length + 2.0 * allowances.sides);
        let apart = size[0].max(size[1]) / count;
        let mut nodes = Self {
            mesh,
            index: Index::new(mesh),
            corner: [low.x - allowances.sides, low.y - allowances.sides],
            top: high.z + allowances.top,
            foot: low.z,
            size,
            apart,
            counts: size.map(|length| (length / apart).ceil().max(1.0) as usize),
            holes,
            drilled: Vec::new(),
        };
        nodes.drilled = nodes.positions(0).map(|at| holes.iter().any(|holes| holes.holds(at))).collect();
        nodes
    }

    /// The sum of the depths down to some floors, one at each node, as a volume, mm^3; what is drilled does not count.
    pub fn volume(&self, floors: impl Iterator<Item = f64>) -> f64 {
        let counted = floors.zip(&self.drilled).filter(|(_, is_drilled)| !**is_drilled);
        self.area(1) * counted.map(|(floor, _)| (self.top - floor).max(0.0)).sum::<f64>()
    }

    /// The area in plan of so many nodes, mm^2.
    pub fn area(&self, count: usize) -> f64 {
        count as f64 * self.size[0] * self.size[1] / (self.counts[0] * self.counts[1]) as f64
    }

    /// Heights of the stock that nothing has cleared yet, but for what is drilled, mm.
    pub fn uncut(&self) -> Vec<f64> {
        self.drilled.iter().map(|is_drilled| if *is_drilled { self.foot } else { self.top }).collect()
    }

    /// Positions by number, mm, and so many nodes beyond the stock's sides.
    fn positions(&self, beyond: usize) -> impl Iterator<Item = [f64; 2]> + '_ {
        let [columns, rows] = self.counts.map(|count| count + 2 * beyond);
        let at = move |i: usize, axis: usize| {
            let apart = self.size[axis] / self.counts[axis] as f64;
            self.corner[axis] + (i as f64 - beyond as f64 + 0.5) * apart
        };
        (0..rows).flat_map(move |row| (0..columns).map(move |column| [at(column, 0), at(row, 1)]))
    }

    /// The front of a tool, with nodes that lie beyond its rim by no more than a share of the distance between nodes.
    pub fn front(&self, tool: &Tool, beyond: f64) -> Front {
        self.middle(tool, 0.5 * tool.diameter() + beyond * self.apart)
    }

    /// The middle of a tool's front, up to a radius, mm.
    pub fn middle(&self, tool: &Tool, within: f64) -> Front {
        let (cutter, radius) = (tool.cutter(), 0.5 * tool.diameter());
        let nodes = within / self.apart;
        let reach = nodes as usize;
        let around = (0..=2 * reach).flat_map(|row| (0..=2 * reach).map(move |column| [row, column]));
        let height = |at: [usize; 2]| {
            let [row, column] = at.map(|i| i.abs_diff(reach));
            let square = row * row + column * column;
            let off = (square as f64).sqrt() * self.apart;
            (square as f64 <= nodes * nodes).then(|| (at, cutter.height_at_radius(off.min(radius))))
        };
        Front { reach, heights: around.filter_map(height).collect() }
    }

    /// The positions of a tool on the part, which leaves so much, mm.
    pub fn envelope<'e>(&'e self, tool: &'e Tool, leave: f64) -> Envelope<'e> {
        Envelope::new(self.mesh, &self.index, tool, None, leave)
    }

    /// How deep a tool's tip gets at each node and at some beyond the stock's sides, mm; in holes that are drilled it stays above.
    pub fn tips(&self, envelope: &Envelope<'_>, beyond: usize) -> Vec<f64> {
        let surface = Surface::whole(envelope);
        let mut hint = None;
        let mut tip = |[x, y]: [f64; 2]| surface.at(x, y, &mut hint).map_or(self.foot, |at| at.tip.z.max(self.foot));
        let is_drilled = |at: [f64; 2]| self.holes.iter().any(|holes| holes.holds(at));
        self.positions(beyond).map(|at| if is_drilled(at) { self.top } else { tip(at) }).collect()
    }

    /// Where a tool stands on the part at each node; nowhere beside it, and in holes that are drilled.
    pub fn standing(&self, envelope: &Envelope<'_>) -> Vec<Option<Standing>> {
        let surface = Surface::whole(envelope);
        let mut hint = None;
        let mut standing = |[x, y]: [f64; 2]| {
            let at = surface.at(x, y, &mut hint)?;
            let face = *self.mesh.faces().get(at.triangle as usize)?;
            let is_beside_wall = self.is_upright(at.triangle as usize);
            Some(Standing { tip: at.tip.z.max(self.foot), face, is_beside_wall })
        };
        self.positions(0).zip(&self.drilled).map(|(at, is_drilled)| standing(at).filter(|_| !is_drilled)).collect()
    }

    /// How much of some stock is over a tool's front at most, mm, where it stands at each node.
    pub fn over<'f>(
        &'f self,
        heights: &'f [f64],
        (standing, front): (&'f [Option<Standing>], &'f Front),
    ) -> impl Iterator<Item = f64> + 'f {
        let [columns, rows] = self.counts;
        let at = move |(number, standing): (usize, &Option<Standing>)| {
            Some((number / columns, number % columns, standing.as_ref()?.tip))
        };
        standing.iter().enumerate().filter_map(at).map(move |(row, column, tip)| {
            let of = |([r, c], height): &([usize; 2], f64)| {
                let [r, c] = [(row + r).checked_sub(front.reach)?, (column + c).checked_sub(front.reach)?];
                let stock = heights.get(r * columns + c).filter(|_| r < rows && c < columns)?;
                Some(stock - tip - height)
            };
            front.heights.iter().filter_map(of).fold(0.0, f64::max)
        })
    }

    /// Which nodes are no farther than a distance from upright triangles of some faces in plan, mm.
    pub fn beside(&self, faces: &[u32], distance: f64) -> Vec<bool> {
        let [columns, rows] = self.counts;
        let mut beside = vec![false; columns * rows];
        let reach = (distance / self.apart).ceil();
        for [x, y] in self.along_walls(faces) {
            let [column, row] = [x - self.corner[0], y - self.corner[1]].map(|x| (x / self.apart).floor());
            let range = |middle: f64, count: usize| {
                let [low, high] = [middle - reach, middle + reach].map(|i| i.clamp(0.0, count as f64 - 1.0) as usize);
                low..=high
            };
            for (r, c) in range(row, rows).flat_map(|r| range(column, columns).map(move |c| (r, c))) {
                if libm::hypot(r as f64 - row, c as f64 - column) <= reach {
                    beside[r * columns + c] = true;
                }
            }
        }
        beside
    }

    fn is_upright(&self, triangle: usize) -> bool {
        self.mesh.normal(triangle).z.abs() < UPRIGHT
    }

    /// Points along the sides of the upright triangles of some faces in plan, no farther apart than nodes are, mm.
    fn along_walls<'f>(&'f self, faces: &'f [u32]) -> impl Iterator<Item = [f64; 2]> + 'f {
        let is_named = |triangle: &usize| self.mesh.faces().get(*triangle).is_some_and(|face| faces.contains(face));
        let upright = (0..self.mesh.triangles().len()).filter(|triangle| self.is_upright(*triangle)).filter(is_named);
        upright.flat_map(|triangle| sides(self.mesh, triangle)).flat_map(|[from, to]| {
            let count = ((to - from).xy().norm() / self.apart).ceil().max(1.0);
            (0..=count as usize).map(move |i| (from + (to - from) * (i as f64 / count)).xy().into())
        })
    }

    /// The height that a tool's front leaves at each node, from its tips there and as far beyond the sides as it reaches, mm.
    pub fn swept<'f>(&'f self, tips: &'f [f64], front: &'f Front) -> impl Iterator<Item = f64> + 'f {
        let [columns, rows] = self.counts;
        let across = columns + 2 * front.reach;
        let lowest = move |(row, column): (usize, usize)| {
            let of = |([r, c], height): &([usize; 2], f64)| Some(tips.get((row + r) * across + column + c)? + height);
            front.heights.iter().filter_map(of).fold(f64::INFINITY, f64::min)
        };
        (0..rows).flat_map(move |row| (0..columns).map(move |column| (row, column))).map(lowest)
    }
}

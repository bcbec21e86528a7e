//! Branches of the index, and a tile as they see it.

use wide::f32x8;

use super::super::contact::Best;
use super::super::index::{Bounds, HalfLine, Probe};
use super::ground::{Floor, Ground, Tile};

/// A node still to be opened.
#[derive(Clone, Copy)]
pub struct Branch {
    pub level: u32,
    pub node: u32,
    /// Highest tip in the node over the middle of the tile, over the probe's z, and its gradient in the tile.
    pub value: f32,
    pub along: [f32; 2],
}

/// The branches in which all contacts of a piece of the plan are.
pub struct Survey {
    pub branches: Vec<Branch>,
    /// What the branches' values are relative to.
    pub middle: [f64; 2],
    pub zero: f64,
}

/// A tile as the index sees it: in single precision, heights from a contact's.
pub struct View {
    pub middle: [f64; 2],
    pub probe: Probe,
    /// Height from which values count, mm.
    pub zero: f64,
    pub half: [f32; 2],
    pub margin: f32,
}

impl View {
    pub fn of(ground: &Ground<'_>, tile: &Tile, found: &Best) -> Self {
        let probe = ground.probe(tile, found);
        let zero = f64::from(probe.z) + ground.index.centre().z;
        Self { middle: tile.middle, probe, zero, half: tile.half.map(|h| h as f32), margin: ground.margin() }
    }

    /// The bounds of a node's children, those that reach the floor somewhere in the tile, and what the bounds rise to
    /// at most over it.
    #[inline]
    pub fn opened(&self, ground: &Ground<'_>, floor: &Floor, branch: Branch) -> (Bounds, u32, f32x8) {
        let (level, node) = (branch.level as usize, branch.node as usize);
        let bounds = ground.index.levels()[level][node].bounds(&ground.matched[level][node], &self.probe, ground.lines);
        let more = (bounds.along[0] - f32x8::splat(floor.along[0])).abs() * f32x8::splat(self.half[0])
            + (bounds.along[1] - f32x8::splat(floor.along[1])).abs() * f32x8::splat(self.half[1])
            + f32x8::splat(self.margin);
        let open = !(bounds.value + more).simd_lt(f32x8::splat(floor.level)).to_bitmask() & 0xff;
        (bounds, open, more)
    }

    /// How far the tips on a node's children lie over a straight line through the tile at most.
    #[inline]
    pub fn opened_over(&self, ground: &Ground<'_>, branch: Branch, line: &HalfLine) -> f32x8 {
        let (level, node) = (branch.level as usize, branch.node as usize);
        let (lanes, matched) = (&ground.index.levels()[level][node], &ground.matched[level][node]);
        lanes.bounds_over(matched, &self.probe, ground.lines, line)
    }

    /// The bounds of a node's children, and what they do not exceed in the tile.
    #[inline]
    pub fn opened_about(&self, ground: &Ground<'_>, branch: Branch) -> (Bounds, f32x8) {
        let (level, node) = (branch.level as usize, branch.node as usize);
        let (lanes, matched) = (&ground.index.levels()[level][node], &ground.matched[level][node]);
        lanes.bounds_about(matched, &self.probe, ground.lines, self.half)
    }
}

impl Survey {
    /// The root: nothing is known.
    pub fn whole(ground: &Ground<'_>) -> Self {
        let level = ground.index.levels().len() - 1;
        let root = Branch { level: level as u32, node: 0, value: f32::INFINITY, along: [0.0; 2] };
        Self { branches: vec![root], middle: [0.0; 2], zero: 0.0 }
    }

    /// A branch with its value over another middle.
    #[inline]
    pub fn moved(&self, branch: Branch, view: &View) -> Branch {
        let [dx, dy] = [0, 1].map(|i| (view.middle[i] - self.middle[i]) as f32);
        let value = branch.value + branch.along[0] * dx + branch.along[1] * dy + (self.zero - view.zero) as f32;
        Branch { value, ..branch }
    }
}

//! Heights after all cuts: the lowest of them over every node, found by halving the plan.
//!
//! A region of nodes keeps the cuts that may be lowest somewhere in it. Along a straight path the height that a cut leaves
//! is convex over the plan: it is nowhere below a plane that touches it, and nowhere in a rectangle above the highest of its
//! corners. So a cut whose plane is above another cut at the four corners is above it everywhere between them.

use styluscam_motion::{ArcPath, Cancelled, Watch};

use super::cut::{Cut, Plane};
use super::grid::{Extent, Grid, Region};
use super::underside::Underside;

/// Nodes along the sides of a region whose heights are kept together: a piece of work.
const TILE: usize = 64;
/// Nodes along the sides of a region that is not halved any more.
const LEAF: usize = 6;
/// Paths are nearer to their chords than this where heights are taken, mm.
const SAG: f64 = 1e-4;
/// In larger regions, than this share of their size.
const COARSE: f64 = 0.01;
/// Of two heights nearer than this either may be kept, mm.
const EQUAL: f64 = 1e-11;

/// What cuts, and where.
pub(super) struct Field<'a> {
    pub grid: Grid,
    /// Height of the stock before the first cut, mm.
    pub top: f64,
    pub tools: &'a [Underside],
    pub arcs: &'a [ArcPath],
    pub watch: &'a Watch,
}

/// Heights of a region's nodes, row by row.
pub(super) struct Tile {
    pub region: Region,
    pub heights: Vec<f64>,
}

/// The cuts that may matter in a region, each with a plane that it is nowhere below.
type Survivors = Vec<(Plane, Cut)>;

impl Field<'_> {
    /// Heights after the cuts, tile by tile.
    pub fn tiles(&self, region: Region, cuts: &[Cut]) -> Result<Vec<Tile>, Cancelled> {
        if region.size().into_iter().all(|side| side <= TILE) {
            let mut tile = Tile { region, heights: vec![self.top; region.count()] };
            self.fill(region, cuts, &mut tile);
            return self.watch.advance(region.count()).map(|()| vec![tile]);
        }
        let half = |half: Region| self.tiles(half, &cuts_of(&self.survivors(half.extent(&self.grid), cuts)));
        let [first, second] = region.halves();
        let (first, second) = rayon::join(|| half(first), || half(second));
        let mut tiles = first?;
        tiles.extend(second?);
        Ok(tiles)
    }

    /// Lowers the heights of a region of a tile.
    fn fill(&self, region: Region, cuts: &[Cut], tile: &mut Tile) {
        if cuts.is_empty() {
            return;
        }
        if region.size().into_iter().all(|side| side <= LEAF) {
            return self.lower(region, cuts, tile);
        }
        for half in region.halves() {
            self.fill(half, &cuts_of(&self.survivors(half.extent(&self.grid), cuts)), tile);
        }
    }

    /// The heights of the nodes of a small region.
    fn lower(&self, region: Region, cuts: &[Cut], tile: &mut Tile) {
        let extent = region.extent(&self.grid);
        let mut cuts = self.survivors_within(extent, cuts, SAG);
        cuts.sort_by(|a, b| a.0.height.total_cmp(&b.0.height));
        let width = tile.region.size()[0];
        for y in region.from[1]..region.to[1] {
            for x in region.from[0]..region.to[0] {
                let position = self.grid.at(x, y);
                let offset = [position[0] - extent.middle[0], position[1] - extent.middle[1]];
                let height = &mut tile.heights[(y - tile.region.from[1]) * width + x - tile.region.from[0]];
                for (plane, cut) in &cuts {
                    if plane.at(offset) < *height - EQUAL {
                        *height = height.min(cut.over(self.tool(cut), position).0);
                    }
                }
            }
        }
    }

    fn survivors(&self, extent: Extent, cuts: &[Cut]) -> Survivors {
        self.survivors_within(extent, cuts, (COARSE * extent.reach()).max(SAG))
    }

    /// The cuts that may be lowest somewhere in a region; bent ones in parts nearer to their chords than `sag` mm.
    fn survivors_within(&self, extent: Extent, cuts: &[Cut], sag: f64) -> Survivors {
        let mut near = Vec::with_capacity(cuts.len());
        let mut left = Vec::new();
        for cut in cuts {
            left.push(*cut);
            while let Some(cut) = left.pop() {
                let Some(plane) = self.near(extent, &cut) else { continue };
                match cut.halves(self.arcs).filter(|_| cut.sag > sag) {
                    Some(halves) => left.extend(halves),
                    None => near.push((plane, cut)),
                }
            }
        }
        self.drop_covered(extent, &mut near);
        near
    }

    /// A cut's plane, if it may lower anything in a region.
    fn near(&self, extent: Extent, cut: &Cut) -> Option<Plane> {
        let tool = self.tool(cut);
        let [low, high] = cut.bounds();
        let apart = |k: usize| (low[k] - extent.middle[k]).max(extent.middle[k] - high[k]) - extent.half[k];
        if apart(0).max(apart(1)) > tool.radius() {
            return None;
        }
        let reach = extent.reach();
        if cut.distance(extent.middle) > tool.radius() + cut.sag + reach {
            return None;
        }
        let plane = cut.plane(tool, extent.middle, reach);
        let lowest = plane.height - plane.gradient[0].abs() * extent.half[0] - plane.gradient[1].abs() * extent.half[1];
        (lowest < self.top - EQUAL).then_some(plane)
    }

    /// Drops the cuts whose planes are above the one that is lowest in the middle.
    fn drop_covered(&self, extent: Extent, cuts: &mut Survivors) {
        let lowest = |a: usize, b: usize| if cuts[b].0.height < cuts[a].0.height { b } else { a };
        let Some(lowest) = (0..cuts.len()).reduce(lowest) else { return };
        let cut = cuts[lowest].1;
        let tool = self.tool(&cut);
        // along a bent path height is convex for the tool at rest only
        let cover = if cut.sag > 0.0 { cut.still(cut.over(tool, extent.middle).1, self.arcs) } else { cut };
        let corners = extent.corners();
        let heights = corners.map(|[x, y]| cover.over(tool, [extent.middle[0] + x, extent.middle[1] + y]).0);
        let covered = |plane: &Plane| corners.iter().zip(heights).all(|(at, height)| plane.at(*at) >= height - EQUAL);
        let mut index = 0;
        cuts.retain(|(plane, _)| {
            index += 1;
            index == lowest + 1 || !covered(plane)
        });
    }

    fn tool(&self, cut: &Cut) -> &Underside {
        &self.tools[cut.tool as usize]
    }
}

fn cuts_of(survivors: &[(Plane, Cut)]) -> Vec<Cut> {
    survivors.iter().map(|(_, cut)| *cut).collect()
}

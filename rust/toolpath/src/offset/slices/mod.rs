//! What a part asks of the tool over many rows, side by side: found for all of a mesh once, instead of position by position.
//!
//! Each facet, edge and corner has a footprint in plan, from where it can be touched ([`footprints`]); the rows that cross it get a
//! piece each. A row is then asked by its pieces alone ([`slice`]). See docs/concepts/envelope.md.

mod footprint;
mod footprints;
mod frame;
mod gradients;
mod slice;
mod sorted;
#[cfg(test)]
mod tests;

use rayon::prelude::*;
use styluscam_motion::{Cancelled, Watch};

use super::contact::{Contacts, Feature};
use footprint::Footprint;
use footprints::{features, Footprints};
use frame::{dot, Frame};
use slice::Piece;
pub use slice::Slice;
use sorted::Sorted;

/// Rows of a block at least, and blocks at most.
const BLOCK: usize = 8;
const BLOCKS: usize = 256;
/// Triangles handed to a thread at a time.
const TRIANGLES: usize = 4096;
/// A part of a triangle that no more rows cross is cut by them at once, not block by block.
const FEW: usize = 4;
/// Of a mesh of more triangles they are not kept.
const LARGE: usize = 500_000;
/// Pieces that a block may have: where there are more, its rows are asked by searches.
const MOST: usize = 2_000_000;

/// A part of a triangle, in 32 bits.
#[derive(Clone, Copy)]
struct Code(u32);

impl Code {
    fn of(triangle: u32, feature: Feature) -> Self {
        let part = match feature {
            Feature::Facet => 0,
            Feature::Edge(i) => 1 + u32::from(i),
            Feature::Corner(i) => 4 + u32::from(i),
        };
        Self(triangle << 3 | part)
    }

    fn feature(self) -> (u32, Feature) {
        let part = (self.0 & 7) as u8;
        let feature = match part {
            0 => Feature::Facet,
            1..=3 => Feature::Edge(part - 1),
            _ => Feature::Corner(part - 4),
        };
        (self.0 >> 3, feature)
    }
}

/// Parallel rows over a mesh.
pub struct Slices<'a> {
    contacts: Contacts<'a>,
    frame: Frame,
    rows: Vec<f64>,
    /// Rows of a block.
    block: usize,
    /// By block, parts that many rows cross.
    parts: Sorted<Code>,
    /// By row, pieces of other parts.
    pieces: Sorted<Piece>,
    selection: Option<Selection<'a>>,
    reach: f64,
}

/// What a share of the triangles has on the rows.
#[derive(Default)]
struct Crossing {
    /// With first and last block.
    parts: Vec<(Code, [u32; 2])>,
    /// With the row, twice.
    pieces: Vec<(Piece, [u32; 2])>,
}

/// Which triangles are selected.
struct Selection<'a> {
    /// By the mesh's numbers.
    triangles: &'a [bool],
    /// By the index's numbers of corners: whether all that meets there is.
    corners: Vec<bool>,
}

impl<'a> Slices<'a> {
    /// Rows at ascending positions across, mm; `along` and `across` are their unit vectors in plan, `reach` is the largest coordinate
    /// of mesh and cutter.
    pub(super) fn of(
        contacts: Contacts<'a>,
        [along, across]: [[f64; 2]; 2],
        rows: Vec<f64>,
        selected: Option<&'a [bool]>,
        reach: f64,
        watch: &Watch,
    ) -> Result<Self, Cancelled> {
        let block = rows.len().div_ceil(BLOCKS).max(BLOCK);
        let selection = selected.map(|triangles| Selection::of(&contacts, triangles));
        let frame = Frame { along, across };
        let mut slices = Self {
            contacts,
            frame,
            rows,
            block,
            parts: Sorted::default(),
            pieces: Sorted::default(),
            selection,
            reach,
        };
        let count = slices.contacts.index().triangles().corners.len();
        let found: Result<Vec<Crossing>, Cancelled> = (0..count)
            .into_par_iter()
            .step_by(TRIANGLES)
            .map(|first| {
                watch.advance(0)?;
                Ok(slices.crossing(first..(first + TRIANGLES).min(count)))
            })
            .collect();
        let found = found?;
        slices.parts = Sorted::of(found.iter().flat_map(|found| &found.parts), slices.blocks());
        slices.pieces = Sorted::of(found.iter().flat_map(|found| &found.pieces), slices.rows.len());
        Ok(slices)
    }

    /// The blocks in which rows are made ready together.
    pub fn blocks(&self) -> usize {
        self.rows.len().div_ceil(self.block)
    }

    /// The numbers of the rows of a block.
    pub fn rows(&self, block: usize) -> std::ops::Range<usize> {
        block * self.block..((block + 1) * self.block).min(self.rows.len())
    }

    /// What some triangles have on the rows.
    fn crossing(&self, triangles: std::ops::Range<usize>) -> Crossing {
        let mut footprints = Footprints::new(&self.contacts, self.frame);
        let index = self.contacts.index();
        let reach = self.contacts.cutter().max_radius() + self.contacts.overhang();
        // of a large mesh they would take more memory than the index
        let few = if index.triangles().corners.len() > LARGE { 0 } else { FEW };
        let mut found = Crossing::default();
        for triangle in triangles.map(|t| t as u32) {
            let across = footprint::range(index.triangles().at(triangle).map(|p| dot(self.frame.across, [p.x, p.y])));
            let near = self.crossed(0..self.rows.len(), [across[0] - reach, across[1] + reach]);
            if near.is_empty() {
                continue;
            }
            for feature in features(self.contacts.owned(triangle)) {
                let Some(footprint) = footprints.of(triangle, feature) else { continue };
                let rows = self.crossed(near.clone(), footprint.across);
                if rows.len() > few {
                    let blocks = [rows.start, rows.end - 1].map(|row| (row / self.block) as u32);
                    found.parts.push((Code::of(triangle, feature), blocks));
                } else {
                    self.cut(&footprint, (triangle, feature), rows, |row, piece| {
                        found.pieces.push((piece, [row as u32; 2]));
                    });
                }
            }
        }
        found
    }

    /// The pieces of a footprint on some rows.
    fn cut(
        &self,
        footprint: &Footprint,
        (triangle, feature): (u32, Feature),
        rows: std::ops::Range<usize>,
        mut keep: impl FnMut(usize, Piece),
    ) {
        if rows.is_empty() {
            return;
        }
        let is_selected = self.is_selected(triangle, feature);
        let plane = self.plane(triangle);
        for row in rows {
            let across = self.rows[row];
            if let Some(share) = footprint.share(across) {
                let at = plane[0] + plane[1] * share[0] + plane[2] * across;
                let plane = if at.is_finite() { [at, plane[1]] } else { [f64::INFINITY, 0.0] };
                keep(row, Piece { share, plane, triangle, feature, is_selected });
            }
        }
    }

    /// Those of some rows that lie between two positions across.
    fn crossed(&self, rows: std::ops::Range<usize>, [low, high]: [f64; 2]) -> std::ops::Range<usize> {
        let first = rows.start + self.rows[rows.clone()].partition_point(|row| *row < low);
        first..first + self.rows[first..rows.end].partition_point(|row| *row <= high)
    }

    /// The rows of a block; none of them where a search for each position is quicker.
    pub fn of_block(&self, block: usize) -> Vec<Option<Slice<'_>>> {
        let rows = self.rows(block);
        let mut pieces: Vec<Vec<Piece>> = rows.clone().map(|row| self.pieces.at(row).to_vec()).collect();
        let mut footprints = Footprints::new(&self.contacts, self.frame);
        let mut count = 0;
        for code in self.parts.at(block) {
            let (triangle, feature) = code.feature();
            let Some(footprint) = footprints.of(triangle, feature) else { continue };
            let crossed = self.crossed(rows.clone(), footprint.across);
            count += crossed.len();
            if count > MOST {
                return rows.map(|_| None).collect();
            }
            self.cut(&footprint, (triangle, feature), crossed, |row, piece| pieces[row - rows.start].push(piece));
        }
        pieces.into_iter().map(|pieces| Slice::of(&self.contacts, self.frame, pieces, self.reach)).collect()
    }

    /// The height of the tip with the cutter on a triangle's plane: over the origin, and its rises along and across the rows.
    fn plane(&self, triangle: u32) -> [f64; 3] {
        let (gradient, contact, height) = self.contacts.plane(triangle);
        let [origin, ..] = self.contacts.index().triangles().at(triangle);
        let at_origin = origin.z + dot(gradient, [contact[0] - origin.x, contact[1] - origin.y]) - height;
        let [along, across] = self.frame.of(gradient);
        [at_origin, along, across]
    }

    /// Whether all triangles that meet in a part of one are selected, and it lies on no border.
    fn is_selected(&self, triangle: u32, feature: Feature) -> bool {
        let Some(Selection { triangles, corners }) = &self.selection else { return true };
        let index = self.contacts.index();
        let selected = |triangle: u32| triangles[index.number(triangle) as usize];
        let names = index.triangles().corners[triangle as usize];
        match feature {
            Feature::Facet => selected(triangle),
            // how far the tool may roll over a border is another question
            Feature::Edge(i) => match index.neighbours(triangle)[usize::from(i)] {
                super::features::NO_NEIGHBOUR => false,
                other => selected(triangle) && selected(other),
            },
            Feature::Corner(i) => corners[names[usize::from(i)] as usize],
        }
    }
}

impl<'a> Selection<'a> {
    fn of(contacts: &Contacts<'_>, triangles: &'a [bool]) -> Self {
        let index = contacts.index();
        let mut corners = vec![true; index.triangles().points.len()];
        for (triangle, names) in index.triangles().corners.iter().enumerate() {
            let is_selected = triangles[index.number(triangle as u32) as usize];
            for (i, other) in index.neighbours(triangle as u32).into_iter().enumerate() {
                if !is_selected || other == super::features::NO_NEIGHBOUR {
                    [i, (i + 1) % 3].into_iter().for_each(|end| corners[names[end] as usize] = false);
                }
            }
        }
        Self { triangles, corners }
    }
}

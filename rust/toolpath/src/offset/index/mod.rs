//! The index of a mesh for tools that come from above: an eightfold tree of boxes with planes over them.
//!
//! The tree is complete: the triangles are put in an order in which every aligned group of 8, 64, 512.. of them is
//! compact, and the groups of one size are a level. No child is ever named, and eight of them are tested at once.

mod cover;
mod lanes;
mod lines;
mod order;
mod pieces;
mod triangles;
mod width;

use rayon::prelude::*;
use styluscam_geometry::{Mesh, Vector};
use styluscam_motion::{Cancelled, Watch};

pub use lanes::{Bounds, HalfLine, Lanes, Matched, Probe};
pub use lines::Lines;
use pieces::{Part, Piece};
pub use triangles::Triangles;
pub use width::{BATCH, WIDTH};

use super::features::{self, Neighbours, Owned};

/// Least area in plan, as a share of the square of the diagonal.
const WALL: f64 = 1e-3;

/// What rounding makes of a position, as a share of the coordinates.
const ROUNDING: f64 = 1e-13;

/// Stages of building that progress shows.
const STAGES: usize = 3;

/// A mesh, ordered for searching. Independent of tools.
#[derive(Clone, Debug)]
pub struct Index {
    triangles: Triangles,
    /// The triangle of each piece: of the lanes of the first level.
    of_pieces: Vec<u32>,
    /// The mesh's number of each triangle, and back.
    numbers: Vec<u32>,
    positions: Vec<u32>,
    owned: Vec<Owned>,
    neighbours: Vec<Neighbours>,
    /// From pieces of triangles (eight to a node) to the root.
    levels: Vec<Vec<Lanes>>,
    centre: Vector,
    low: Vector,
    high: Vector,
}

impl Index {
    /// Builds the index; the result does not depend on the number of threads.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        Self::built(mesh, &Watch::default())
    }

    /// As [`new`](Self::new), and can be stopped.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn watched(mesh: &Mesh, watch: &Watch) -> Result<Self, Cancelled> {
        watch.begin("index", STAGES);
        let index = Self::built(mesh, watch);
        watch.advance(1)?;
        Ok(index)
    }

    /// The index; something of no use when `watch` is cancelled meanwhile.
    fn built(mesh: &Mesh, watch: &Watch) -> Self {
        let (low, high) = mesh.bounds();
        let centre = (low + high) * 0.5;
        let goes_on = || watch.advance(1).is_ok();
        let pieces = pieces::of(mesh, (low, high), watch);
        let order = if goes_on() { order::of(&pieces, centre, watch) } else { Vec::new() };
        let Owners { of_pieces, parts, numbers, positions } = Owners::of(pieces, &order, mesh.triangles().len());
        let (triangles, firsts) = if goes_on() { renumbered(mesh, &numbers, watch) } else { Default::default() };
        let pieces = cover::Pieces { triangles: &triangles, of_pieces: &of_pieces, parts: &parts, centre };
        let (levels, (owned, neighbours)) =
            rayon::join(|| levels(&pieces, watch), || features::of(&triangles, &firsts, watch));
        Self { triangles, of_pieces, numbers, positions, owned, neighbours, levels, centre, low, high }
    }

    pub(super) fn triangles(&self) -> &Triangles {
        &self.triangles
    }

    /// The triangle of a lane of the first level.
    #[inline]
    pub(super) fn of_piece(&self, piece: u32) -> u32 {
        self.of_pieces[piece as usize]
    }

    /// The levels, pieces first, the root last.
    pub(super) fn levels(&self) -> &[Vec<Lanes>] {
        &self.levels
    }

    /// What the boxes are relative to.
    pub(super) fn centre(&self) -> Vector {
        self.centre
    }

    /// Lower and upper corner of the mesh.
    pub(super) fn bounds(&self) -> (Vector, Vector) {
        (self.low, self.high)
    }

    /// What rounding makes of a position that lies on the mesh, mm.
    pub(super) fn rounding(&self) -> f64 {
        ROUNDING * self.low.amax().max(self.high.amax())
    }

    /// Area in plan for each triangle, mm^2; of a wall that has none, a share of its own.
    pub(super) fn area_per_triangle(&self) -> f64 {
        let size = self.high - self.low;
        (size.x * size.y).max(WALL * size.norm_squared()) / self.numbers.len() as f64
    }

    /// Which edges and corners of a triangle it has to try.
    #[inline]
    pub(super) fn owned(&self, triangle: u32) -> Owned {
        self.owned[triangle as usize]
    }

    /// The triangles beyond the three edges.
    #[inline]
    pub(super) fn neighbours(&self, triangle: u32) -> Neighbours {
        self.neighbours[triangle as usize]
    }

    /// The mesh's number of a triangle.
    #[inline]
    pub(super) fn number(&self, triangle: u32) -> u32 {
        self.numbers[triangle as usize]
    }

    /// The position of the mesh's triangle in the index; the first for one that there is not.
    pub(super) fn position(&self, number: u32) -> u32 {
        self.positions.get(number as usize).copied().unwrap_or(0)
    }
}

/// The triangles in order with corners numbered as they come; for each triangle, which of its corners are new. Fewer of
/// them when `watch` is cancelled.
fn renumbered(mesh: &Mesh, numbers: &[u32], watch: &Watch) -> (Triangles, Vec<u8>) {
    const UNUSED: u32 = u32::MAX;
    let mut names = vec![UNUSED; mesh.vertices().len()];
    let mut triangles =
        Triangles { corners: Vec::with_capacity(numbers.len()), points: Vec::with_capacity(mesh.vertices().len()) };
    let mut firsts = Vec::with_capacity(numbers.len());
    for number in watch.batches(numbers.len(), BATCH).flat_map(|batch| &numbers[batch]) {
        let (mut corners, mut first) = (mesh.triangles()[*number as usize], 0);
        for (i, corner) in corners.iter_mut().enumerate() {
            let name = &mut names[*corner as usize];
            if *name == UNUSED {
                *name = triangles.points.len() as u32;
                triangles.points.push(mesh.vertices()[*corner as usize]);
                first |= 1 << i;
            }
            *corner = *name;
        }
        triangles.corners.push(corners);
        firsts.push(first);
    }
    (triangles, firsts)
}

fn levels(pieces: &cover::Pieces<'_>, watch: &Watch) -> Vec<Vec<Lanes>> {
    let mut covers = cover::of_pieces(pieces, watch);
    let mut levels = Vec::new();
    let mut size = 1;
    loop {
        levels.push(covers.par_chunks(WIDTH).map(cover::lanes).collect());
        if covers.len() <= WIDTH || watch.is_cancelled() {
            return levels;
        }
        size *= WIDTH;
        covers = cover::of_groups(&covers, size, pieces, watch);
    }
}

/// Pieces and their triangles: triangles are numbered as their first pieces come.
struct Owners {
    of_pieces: Vec<u32>,
    parts: Vec<Option<Box<Part>>>,
    numbers: Vec<u32>,
    positions: Vec<u32>,
}

impl Owners {
    fn of(mut pieces: Vec<Piece>, order: &[u32], count: usize) -> Self {
        const NONE: u32 = u32::MAX;
        let mut owners = Self {
            of_pieces: Vec::with_capacity(order.len()),
            parts: Vec::with_capacity(order.len()),
            numbers: Vec::with_capacity(count),
            positions: vec![NONE; count],
        };
        for piece in order {
            let Piece { triangle: number, part, .. } = &mut pieces[*piece as usize];
            let position = &mut owners.positions[*number as usize];
            if *position == NONE {
                *position = owners.numbers.len() as u32;
                owners.numbers.push(*number);
            }
            owners.of_pieces.push(*position);
            owners.parts.push(part.take());
        }
        owners
    }
}

//! Long triangles that lie aslant, cut into pieces with boxes of their own.
//!
//! The box of a sliver across a plane covers the whole plane: a search would try hundreds of them everywhere. Only the boxes
//! are cut; the triangles stay whole.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use rayon::prelude::*;
use styluscam_geometry::{Mesh, Vector};
use styluscam_motion::Watch;

use super::width::BATCH;

/// Empty area of a box worth a cut, as a multiple of the area that the mesh has for each triangle in plan.
const WASTE: f64 = 8.0;
/// Pieces more than triangles at most, as a share of them.
const MORE: f64 = 0.25;

/// A triangle, or a part of it.
pub struct Piece {
    /// The mesh's number.
    pub triangle: u32,
    /// Sum of the box's corners.
    corners: Vector,
    /// Which part, unless it is all of it.
    pub part: Option<Box<Part>>,
}

/// The part of a triangle within a box; its sides in plan are cuts.
#[derive(Clone, Debug)]
pub struct Part {
    pub low: Vector,
    pub high: Vector,
}

/// The pieces of all triangles: the first part of each stands where the triangle would. Fewer when `watch` is cancelled.
pub fn of(mesh: &Mesh, (low, high): (Vector, Vector), watch: &Watch) -> Vec<Piece> {
    let count = mesh.triangles().len();
    let worth = WASTE * (high.x - low.x) * (high.y - low.y) / count as f64;
    let first = |triangle: usize| {
        let part = Part::whole(mesh.corners(triangle));
        Waste::of(mesh, triangle as u32, triangle, part, worth)
    };
    let (mut pieces, mut wastes) = (Vec::with_capacity(count), Vec::new());
    for batch in watch.batches(count, BATCH) {
        pieces.par_extend(batch.clone().into_par_iter().map(|t| Piece::whole(mesh, t as u32)));
        wastes.par_extend(batch.into_par_iter().filter_map(first));
    }
    let mut heap = BinaryHeap::from(wastes);
    let most = count + (MORE * count as f64) as usize;
    while pieces.len() < most && !watch.is_cancelled() {
        let Some(Waste { position, triangle, part, .. }) = heap.pop() else { break };
        let halves = part.halves(mesh.corners(triangle as usize));
        let positions = [position, pieces.len()];
        pieces.push(Piece::whole(mesh, triangle));
        for (position, half) in positions.into_iter().zip(halves) {
            pieces[position] = Piece::of(triangle, &half);
            heap.extend(Waste::of(mesh, triangle, position, half, worth));
        }
    }
    pieces
}

impl Piece {
    fn whole(mesh: &Mesh, triangle: u32) -> Self {
        let Part { low, high } = Part::whole(mesh.corners(triangle as usize));
        Self { triangle, corners: low + high, part: None }
    }

    fn of(triangle: u32, part: &Part) -> Self {
        Self { triangle, corners: part.low + part.high, part: Some(Box::new(part.clone())) }
    }

    /// Middle of the box, relative to a centre.
    pub fn middle(&self, centre: Vector) -> [f32; 3] {
        std::array::from_fn(|i| (0.5 * self.corners[i] - centre[i]) as f32)
    }
}

impl Part {
    /// The box around all of a triangle.
    pub fn whole([a, b, c]: [Vector; 3]) -> Self {
        Self { low: a.inf(&b).inf(&c), high: a.sup(&b).sup(&c) }
    }

    /// Cut across the longer side of the box in plan.
    fn halves(&self, corners: [Vector; 3]) -> [Self; 2] {
        let axis = usize::from(self.high.y - self.low.y > self.high.x - self.low.x);
        let middle = 0.5 * (self.low[axis] + self.high[axis]);
        let (mut below, mut above) = (self.clone(), self.clone());
        below.high[axis] = middle;
        above.low[axis] = middle;
        [below, above].map(|half| half.fitted(corners))
    }

    /// The box around what of the triangle is in it.
    fn fitted(&self, corners: [Vector; 3]) -> Self {
        let (mut low, mut high) = (self.high, self.low);
        for point in self.outline(corners) {
            low = low.inf(&point);
            high = high.sup(&point);
        }
        Self { low, high }
    }

    /// The corners of the triangle's part.
    pub fn outline(&self, corners: [Vector; 3]) -> Vec<Vector> {
        let mut outline = corners.to_vec();
        for axis in 0..2 {
            outline = cut(&outline, |p| p[axis] - self.low[axis]);
            outline = cut(&outline, |p| self.high[axis] - p[axis]);
        }
        outline
    }

    fn area_in_plan(&self, corners: [Vector; 3]) -> f64 {
        let outline = self.outline(corners);
        let Some(first) = outline.first() else { return 0.0 };
        let fan = outline.windows(2).map(|pair| {
            let (u, v) = (pair[0] - first, pair[1] - first);
            u.x * v.y - u.y * v.x
        });
        0.5 * fan.sum::<f64>().abs()
    }
}

/// The part of an outline on the side where `inside` is not negative.
fn cut(outline: &[Vector], inside: impl Fn(&Vector) -> f64) -> Vec<Vector> {
    let mut kept = Vec::with_capacity(outline.len() + 1);
    for (i, p) in outline.iter().enumerate() {
        let q = &outline[(i + 1) % outline.len()];
        let (here, there) = (inside(p), inside(q));
        if here >= 0.0 {
            kept.push(*p);
        }
        if here * there < 0.0 {
            kept.push(p + (q - p) * (here / (here - there)));
        }
    }
    kept
}

/// A part whose box is worth a cut; the most wasteful first.
struct Waste {
    area: f64,
    position: usize,
    triangle: u32,
    part: Part,
}

impl Waste {
    fn of(mesh: &Mesh, triangle: u32, position: usize, part: Part, worth: f64) -> Option<Self> {
        let area = (part.high.x - part.low.x) * (part.high.y - part.low.y);
        if area <= worth {
            return None;
        }
        let area = area - part.area_in_plan(mesh.corners(triangle as usize));
        (area > worth).then_some(Self { area, position, triangle, part })
    }
}

impl PartialEq for Waste {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waste {}

impl Ord for Waste {
    fn cmp(&self, other: &Self) -> Ordering {
        self.area.total_cmp(&other.area).then(other.position.cmp(&self.position))
    }
}

impl PartialOrd for Waste {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

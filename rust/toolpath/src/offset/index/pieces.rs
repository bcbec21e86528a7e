//! Long triangles that lie aslant, cut into pieces with boxes of their own.
//!
//! The box of a sliver across a plane covers the whole plane: a search would try hundreds of them everywhere. Only the boxes
//! are cut; the triangles stay whole.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use rayon::prelude::*;
use styluscam_geometry::{Mesh, Vector};

/// Empty area of a box worth a cut, as a multiple of the area that the mesh has for each triangle in plan.
const WASTE: f64 = 8.0;
/// Pieces more than triangles at most, as a share of them.
const MORE: f64 = 0.25;

/// A triangle, or the part of it within a box.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The mesh's number.
    pub triangle: u32,
    pub low: Vector,
    pub high: Vector,
    /// Whether it is a part.
    pub is_part: bool,
}

/// The pieces of all triangles: those that are whole first, in order.
pub fn of(mesh: &Mesh, (low, high): (Vector, Vector)) -> Vec<Piece> {
    let count = mesh.triangles().len();
    let worth = WASTE * (high.x - low.x) * (high.y - low.y) / count as f64;
    let mut pieces: Vec<Piece> = (0..count as u32).into_par_iter().map(|t| Piece::whole(mesh, t)).collect();
    let mut heap: BinaryHeap<Waste> = pieces
        .par_iter()
        .enumerate()
        .filter_map(|(place, piece)| Waste::of(mesh, place, piece, worth))
        .collect::<Vec<_>>()
        .into();
    let most = count + (MORE * count as f64) as usize;
    while pieces.len() < most {
        let Some(Waste { place, .. }) = heap.pop() else { break };
        let halves = pieces[place].halves(mesh);
        let places = [place, pieces.len()];
        let [first, second] = halves;
        pieces[place] = first;
        pieces.push(second);
        heap.extend(places.into_iter().filter_map(|place| Waste::of(mesh, place, &pieces[place], worth)));
    }
    pieces
}

impl Piece {
    fn whole(mesh: &Mesh, triangle: u32) -> Self {
        let [a, b, c] = mesh.corners(triangle as usize);
        Self { triangle, low: a.inf(&b).inf(&c), high: a.sup(&b).sup(&c), is_part: false }
    }

    /// Cut across the longer side of the box in plan.
    fn halves(&self, mesh: &Mesh) -> [Self; 2] {
        let axis = usize::from(self.high.y - self.low.y > self.high.x - self.low.x);
        let middle = 0.5 * (self.low[axis] + self.high[axis]);
        let (mut below, mut above) = (self.clone(), self.clone());
        below.high[axis] = middle;
        above.low[axis] = middle;
        [below, above].map(|half| half.fitted(mesh))
    }

    /// With the box around what of the triangle is in it.
    fn fitted(self, mesh: &Mesh) -> Self {
        let (mut low, mut high) = (self.high, self.low);
        for point in self.outline(mesh.corners(self.triangle as usize)) {
            low = low.inf(&point);
            high = high.sup(&point);
        }
        Self { low, high, is_part: true, ..self }
    }

    /// The corners of the triangle's part in the box; the box's cuts are upright.
    pub fn outline(&self, corners: [Vector; 3]) -> Vec<Vector> {
        let mut outline = corners.to_vec();
        if self.is_part {
            for axis in 0..2 {
                outline = cut(&outline, |p| p[axis] - self.low[axis]);
                outline = cut(&outline, |p| self.high[axis] - p[axis]);
            }
        }
        outline
    }

    fn area_in_plan(&self, mesh: &Mesh) -> f64 {
        let outline = self.outline(mesh.corners(self.triangle as usize));
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

/// A piece whose box is worth a cut; the most wasteful first.
#[derive(PartialEq)]
struct Waste {
    area: f64,
    place: usize,
}

impl Waste {
    fn of(mesh: &Mesh, place: usize, piece: &Piece, worth: f64) -> Option<Self> {
        let (width, depth) = (piece.high.x - piece.low.x, piece.high.y - piece.low.y);
        if width * depth <= worth {
            return None;
        }
        let area = width * depth - piece.area_in_plan(mesh);
        (area > worth).then_some(Self { area, place })
    }
}

impl Eq for Waste {}

impl Ord for Waste {
    fn cmp(&self, other: &Self) -> Ordering {
        self.area.total_cmp(&other.area).then(other.place.cmp(&self.place))
    }
}

impl PartialOrd for Waste {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

//! What is left of a layer that the tool could have cleared.
//!
//! On a grid of positions the tool is found free of the part, or not, at the layer's height. Free positions around which a disc of
//! the smallest path's radius is free, and that hang together with one over a selected face (all of them where all stock is to be cleared), are where
//! the tool is to have been: all stock within its radius of them is to be swept. The grid itself never asks for more than the tool can do: its positions are exact.

use std::f64::consts::SQRT_2;

use rayon::prelude::*;
use styluscam_geometry::PlanePiece;
use styluscam_motion::{Cancelled, Watch};

use super::layer::Layer;
use crate::body::Body;
use crate::clearance::Prober;
use crate::engagement::Cells;
use crate::findings::{Finding, FindingKind, Severity};
use crate::stroke::Stroke;
use crate::subject::Subject;
use crate::sweep::Question;
use crate::tolerances::{ROUGH, SLACK};

/// Distance of the grid's positions, in tool radii.
const SPACING: f64 = 0.1;
/// Positions at most.
const MOST: f64 = 40_000.0;
/// Positions along the side of the squares for which it is asked first whether the tool is free of the part.
const BLOCK: usize = 16;
/// Share of what the tool reaches that may be left: slivers.
const SHARE: f64 = 1e-3;
/// How far from what is swept stock may be left, in tool radii.
const THICK: f64 = 0.05;
/// Triangles whose normals have less of Z are none that a position lies over.
const UPRIGHT: f64 = 1e-3;

/// The finding of stock that is left.
pub(super) fn left(layer: &Layer<'_>, swept: &[PlanePiece], (grid, reached): (&Grid, &[bool])) -> Option<Finding> {
    let asked = grid.widened(reached, layer.radius - ROUGH.max(layer.clearing.tolerance));
    let mut cells = Cells::new(0.5 * layer.radius, layer.radius + grid.spacing);
    (0_u32..).zip(swept).for_each(|(number, piece)| cells.insert(number, piece));
    let (mut count, mut left, mut worst) = (0.0, 0.0, (0.0, [0.0; 2]));
    for node in (0..asked.len()).filter(|node| asked[*node] && grid.in_stock[*node]) {
        count += 1.0;
        let at = grid.at(node);
        let near = cells.near(at).iter().filter_map(|number| swept.get(*number as usize));
        let beside = near.map(|piece| piece.distance(at)).fold(f64::INFINITY, f64::min) - layer.radius;
        if beside > layer.chip + SLACK {
            left += 1.0;
            // beyond what is listed it is farther
            let beside = if beside.is_finite() { beside } else { layer.radius };
            if beside > worst.0 {
                worst = (beside, at);
            }
        }
    }
    if left <= SHARE * count && worst.0 <= THICK * layer.radius {
        return None;
    }
    let (thick, [x, y]) = worst;
    let area = grid.spacing * grid.spacing;
    let message = format!(
        "operation {:?}: at Z{:.3} some {:.2} mm^2 of {:.1} mm^2 of the stock that the tool reaches are not cleared, up to {thick:.3} mm \
         from where it goes, near X{x:.3} Y{y:.3}; post the job again",
        layer.operation.id,
        layer.floor,
        left * area,
        count * area
    );
    let finding = Finding::of_all(FindingKind::Uncleared, Severity::Error, message);
    let limit = Some(THICK * layer.radius);
    Some(Finding { position: Some([x, y, layer.floor]), value_mm: Some(thick), value: Some(thick), limit, ..finding })
}

/// A square of positions.
#[derive(Clone, Copy)]
struct Block {
    column: usize,
    row: usize,
    /// Positions along its side, a power of 2.
    size: usize,
}

/// Positions over the stock, and around it as far as the tool's centre may matter.
pub(super) struct Grid {
    low: [f64; 2],
    pub spacing: f64,
    columns: usize,
    rows: usize,
    /// Which of them lie in the stock.
    pub in_stock: Vec<bool>,
}

impl Grid {
    pub fn new(layer: &Layer<'_>) -> Self {
        let (low, high) = layer.bounds;
        let around = 1.5 * layer.radius;
        let size = [high.x - low.x + 2.0 * around, high.y - low.y + 2.0 * around];
        let spacing = (SPACING * layer.radius).max((size[0] * size[1] / MOST).sqrt());
        let [columns, rows] = size.map(|length| libm::ceil(length / spacing) as usize + 1);
        let grid = Self { low: [low.x - around, low.y - around], spacing, columns, rows, in_stock: Vec::new() };
        let in_stock = (0..columns * rows).map(|node| layer.is_stock(grid.at(node))).collect();
        Self { in_stock, ..grid }
    }

    pub fn at(&self, node: usize) -> [f64; 2] {
        let (column, row) = (node % self.columns, node / self.columns);
        [self.low[0] + column as f64 * self.spacing, self.low[1] + row as f64 * self.spacing]
    }

    /// Whether a node is one of the third of all at which walls are looked at: every third of each row and of each column.
    pub fn is_looked_at(&self, node: usize) -> bool {
        (node % self.columns + node / self.columns).is_multiple_of(3)
    }

    /// The node nearest to a point, if it lies on the grid.
    pub fn nearest(&self, [x, y]: [f64; 2]) -> Option<usize> {
        let [column, row] =
            [(x, self.low[0]), (y, self.low[1])].map(|(value, low)| libm::round((value - low) / self.spacing));
        let fits = column >= 0.0 && row >= 0.0 && (column as usize) < self.columns && (row as usize) < self.rows;
        fits.then(|| row as usize * self.columns + column as usize)
    }

    /// Where the tool is free of the part, and of what is to stay under it.
    pub fn free(
        &self,
        layer: &Layer<'_>,
        body: &Body,
        subject: &Subject,
        watch: &Watch,
    ) -> Result<Vec<bool>, Cancelled> {
        let prober = Prober { body, mesh: subject.mesh, bvh: subject.bvh };
        let (below, nearest) = (below(subject), |at, below| nearest(&prober, layer.lowered(), below, at));
        let mut free = vec![false; self.columns * self.rows];
        let bands = free.par_chunks_mut(BLOCK * self.columns).enumerate();
        bands.try_for_each(|(band, free)| {
            for column in (0..self.columns).step_by(BLOCK) {
                watch.advance(0)?;
                let block = Block { column, row: band * BLOCK, size: BLOCK };
                self.mark_free(block, free, band * BLOCK, below, &nearest);
            }
            Ok(())
        })?;
        Ok(free)
    }

    /// Marks the free positions of a block; `free` holds whole rows, the first of which is `first_row`. A tool that is moved comes nearer to the part, or out
    /// of it, by no more than it is moved: so one answer is often that of the whole block.
    fn mark_free(
        &self,
        Block { column, row, size }: Block,
        free: &mut [bool],
        first_row: usize,
        below: f64,
        nearest: &impl Fn([f64; 2], f64) -> Option<f64>,
    ) {
        let (columns, rows) = (column..self.columns.min(column + size), row..self.rows.min(row + size));
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let half = 0.5 * (size - 1) as f64 * self.spacing;
        let [x, y] = self.at(row * self.columns + column);
        let reach = half * SQRT_2;
        let found = nearest([x + half, y + half], below + reach);
        if size > 1 && found.is_some_and(|distance| distance >= below - reach) {
            let size = size / 2;
            for [column, row] in
                [[column, row], [column + size, row], [column, row + size], [column + size, row + size]]
            {
                self.mark_free(Block { column, row, size }, free, first_row, below, nearest);
            }
            return;
        }
        for row in rows {
            let from = (row - first_row) * self.columns;
            free[from + columns.start..from + columns.end].fill(found.is_none());
        }
    }

    /// Where the tool is to have been.
    pub fn reached(&self, layer: &Layer<'_>, free: &[bool], swept: &[PlanePiece], subject: &Subject) -> Vec<bool> {
        let core = self.core(free, layer.clearing.smoothing + layer.clearing.left[0]);
        if layer.clearing.all {
            return self.widened(&core, layer.clearing.smoothing);
        }
        let entered = self.over_selected(layer, subject).into_iter().chain(self.passed(swept));
        self.widened(&self.connected(&core, entered), layer.clearing.smoothing)
    }

    /// The free positions around which all are free within a radius, mm, and the space between them.
    fn core(&self, free: &[bool], radius: f64) -> Vec<bool> {
        let blocked: Vec<bool> = free.iter().map(|free| !free).collect();
        let near = self.widened(&blocked, radius + self.spacing);
        near.iter().map(|near| !near).collect()
    }

    /// Positions from which a blocked one may be nearer than a distance, mm.
    pub fn near_blocked(&self, free: &[bool], distance: f64) -> Vec<bool> {
        let blocked: Vec<bool> = free.iter().map(|free| !free).collect();
        self.widened(&blocked, distance + 1.5 * self.spacing)
    }

    /// All positions within a radius of some, mm.
    fn widened(&self, some: &[bool], radius: f64) -> Vec<bool> {
        let reach = (radius / self.spacing) as isize;
        let within = |x: isize, y: isize| libm::hypot(x as f64, y as f64) * self.spacing <= radius;
        let offsets: Vec<[isize; 2]> = (-reach..=reach)
            .flat_map(|y| (-reach..=reach).map(move |x| [x, y]))
            .filter(|[x, y]| within(*x, *y))
            .collect();
        let mut all = vec![false; some.len()];
        for node in (0..some.len()).filter(|node| some[*node]) {
            let (column, row) = ((node % self.columns) as isize, (node / self.columns) as isize);
            // of what lies deep within, the neighbours do the work
            let is_inside = self.neighbours(node).filter(|near| some[*near]).count() == 4;
            let offsets = if is_inside { &[[0, 0]][..] } else { &offsets };
            for [x, y] in offsets {
                let (x, y) = (column + x, row + y);
                if x >= 0 && y >= 0 && (x as usize) < self.columns && (y as usize) < self.rows {
                    all[y as usize * self.columns + x as usize] = true;
                }
            }
        }
        all
    }

    pub fn neighbours(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        let (column, row) = (node % self.columns, node / self.columns);
        [
            (column > 0).then(|| node - 1),
            (column + 1 < self.columns).then(|| node + 1),
            (row > 0).then(|| node - self.columns),
            (row + 1 < self.rows).then(|| node + self.columns),
        ]
        .into_iter()
        .flatten()
    }

    /// The nodes that lie over selected triangles no higher than the layer's floor.
    fn over_selected(&self, layer: &Layer<'_>, subject: &Subject) -> Vec<usize> {
        let is_low = |triangle: &usize| subject.mesh.corners(*triangle).iter().any(|corner| corner.z <= layer.floor);
        let selected = layer.operation.expectation.triangles().into_iter();
        self.over_each(selected.filter(is_low), subject)
    }

    /// Which nodes lie over some triangles, or within a radius of those that do, mm.
    pub fn over(&self, triangles: impl Iterator<Item = usize>, radius: f64, subject: &Subject) -> Vec<bool> {
        let mut over = vec![false; self.columns * self.rows];
        for node in self.over_each(triangles, subject) {
            over[node] = true;
        }
        self.widened(&over, radius)
    }

    /// The nodes that lie over triangles that are not upright.
    fn over_each(&self, triangles: impl Iterator<Item = usize>, subject: &Subject) -> Vec<usize> {
        let mut over = Vec::new();
        for triangle in triangles.filter(|triangle| subject.mesh.normal(*triangle).z >= UPRIGHT) {
            let flat = subject.mesh.corners(triangle).map(|corner| [corner.x, corner.y]);
            let range = |i: usize| {
                let low = flat.iter().fold(f64::INFINITY, |low, p| low.min(p[i]));
                let high = flat.iter().fold(f64::NEG_INFINITY, |high, p| high.max(p[i]));
                [low, high].map(|value| ((value - self.low[i]) / self.spacing).max(0.0) as usize)
            };
            let ([x0, x1], [y0, y1]) = (range(0), range(1));
            for row in y0..=y1.min(self.rows - 1) {
                let nodes = (x0..=x1.min(self.columns - 1)).map(|column| row * self.columns + column);
                over.extend(nodes.filter(|node| is_within(self.at(*node), flat)));
            }
        }
        over
    }

    /// The nodes beside which the tool has been.
    fn passed<'a>(&'a self, swept: &'a [PlanePiece]) -> impl Iterator<Item = usize> + 'a {
        swept.iter().filter_map(|piece| self.nearest(piece.end)).filter(|node| self.in_stock[*node])
    }

    /// The positions of some that hang together with those at which the tool enters.
    fn connected(&self, some: &[bool], entered: impl Iterator<Item = usize>) -> Vec<bool> {
        let mut found = vec![false; some.len()];
        let mut open: Vec<usize> = entered.filter(|node| some[*node]).collect();
        while let Some(node) = open.pop() {
            if !std::mem::replace(&mut found[node], true) {
                open.extend(self.neighbours(node).filter(|near| some[*near] && !found[*near]));
            }
        }
        found
    }
}

/// What a tool may be off the part and touch it, mm: the part's triangles are as far off its faces.
pub(super) fn below(subject: &Subject) -> f64 {
    subject.deviation_inward + SLACK
}

/// Whether the tool is free of the part at a position of the layer, lowered by what is to stay under it.
pub(super) fn is_free(prober: &Prober<'_>, layer: &Layer<'_>, below: f64, at: [f64; 2]) -> bool {
    nearest(prober, layer.lowered(), below, at).is_none()
}

/// Distance from the tool with its tip at a height to the part, if that is less than `below`, mm. Negative is how deep a point of the part
/// lies in the tool: moved by less, the tool still holds it.
fn nearest(prober: &Prober<'_>, height: f64, below: f64, [x, y]: [f64; 2]) -> Option<f64> {
    let position = prober.body.position([x, y, height]);
    let question = Question { stroke: Stroke::still(position), positions: [None; 2], below };
    let touch = prober.survey(question, None).deepest?.touch;
    // a touch's depth is that of a plane, and more than that of any point where the plane's foot is not in the triangle
    Some(if touch.value < 0.0 { prober.body.distance(touch.point - position).value } else { touch.value })
}

/// Whether a point lies in a triangle in plan.
fn is_within([x, y]: [f64; 2], [a, b, c]: [[f64; 2]; 3]) -> bool {
    let side = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use styluscam_geometry::{Bvh, Mesh, Vector};

    use super::*;
    use crate::body::tests::any_body;

    /// Upright walls with level tops, and a slope.
    fn terraces() -> impl Strategy<Value = Mesh> {
        let block = (-20.0..20.0, -20.0..20.0, 1.0..15.0, 1.0..15.0, 0.5..25.0);
        proptest::collection::vec(block, 1..5).prop_map(|blocks| {
            let (mut points, mut triangles) = (Vec::new(), Vec::new());
            for (x, y, width, depth, height) in blocks {
                let first = points.len() as i64;
                for corner in 0..8 {
                    let far = [corner & 1, corner >> 1 & 1, corner >> 2].map(f64::from);
                    points.push(Vector::new(x + far[0] * width, y + far[1] * depth, far[2] * height - 2.0));
                }
                let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
                let halves = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
                triangles.extend(halves.map(|corners| corners.map(|corner| first + corner)));
            }
            Mesh::new(points, &triangles, &[]).unwrap()
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn squares_are_free_where_all_their_positions_are(
            body in any_body(), mesh in terraces(), spacing in 0.1..1.5, columns in 1usize..60, rows in 1usize..60, below in -0.01..0.01,
        ) {
            let bvh = Bvh::new(&mesh);
            let prober = Prober { body: &body, mesh: &mesh, bvh: &bvh };
            let grid = Grid { low: [-20.0; 2], spacing, columns, rows, in_stock: Vec::new() };
            let nearest = |at, below| nearest(&prober, 0.0, below, at);
            let mut free = vec![false; columns * rows];
            for (band, free) in free.chunks_mut(BLOCK * columns).enumerate() {
                for column in (0..columns).step_by(BLOCK) {
                    let block = Block { column, row: band * BLOCK, size: BLOCK };
                    grid.mark_free(block, free, band * BLOCK, below, &nearest);
                }
            }
            let expected: Vec<bool> = (0..columns * rows).map(|node| nearest(grid.at(node), below).is_none()).collect();
            prop_assert_eq!(free, expected);
        }
    }
}

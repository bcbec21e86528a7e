//! Stock that is left beside walls: more of it than is asked for.
//!
//! The grid of positions is too coarse for that. Where it has a free position beside one that is not, the position between
//! them at which the tool touches is found by halving, and a second one beside it gives the direction of the wall. So far from
//! there as stock is to stay, the tool has to have been: if it fits there along a circle of the smallest radius, at once in the stock.

use std::f64::consts::TAU;

use styluscam_geometry::PlanePiece;

use super::layer::Layer;
use super::rest::{below, is_free, Grid};
use crate::body::Body;
use crate::clearance::Prober;
use crate::engagement::Cells;
use crate::findings::{Finding, FindingKind, Severity};
use crate::subject::Subject;
use crate::tolerances::{ROUGH, SLACK};

/// What may be left beside a wall besides what is asked for: so many times the path's tolerance, by which planning keeps from walls.
const ALLOWED: f64 = 2.0;
/// Positions are found to this, mm.
const FINE: f64 = 2e-3;
/// The second position lies so far aside, as a share of the grid's spacing.
const ASIDE: f64 = 0.2;
/// Directions in which a circle is looked at.
const SIDES: u32 = 16;
/// Positions at which too much is left before it counts: a single one may lie at an edge.
const TIMES: usize = 3;

/// The finding of walls beside which too much is left.
pub(super) fn left(
    layer: &Layer<'_>,
    swept: &[PlanePiece],
    (grid, free, reached): (&Grid, &[bool], &[bool]),
    body: &Body,
    subject: &Subject,
) -> Option<Finding> {
    let prober = Prober { body, mesh: subject.mesh, bvh: subject.bvh };
    let below = below(subject);
    let is_free = |at: [f64; 2]| is_free(&prober, layer, below, at);
    let tolerance = layer.clearing.tolerance;
    let allowed = ROUGH + ALLOWED * tolerance + layer.chip + 2.0 * subject.deviation_inward;
    let passed = Passed::new(swept, layer.radius);
    let (mut count, mut worst) = (0, (allowed, [0.0; 2]));
    for node in (0..free.len()).filter(|node| free[*node] && grid.is_looked_at(*node)) {
        for near in grid.neighbours(node).filter(|near| !free[*near]) {
            let Some((at, normal)) = touching(&is_free, grid.at(node), grid.at(near), grid.spacing) else { continue };
            let along = |distance: f64| [0, 1].map(|i| at[i] + distance * normal[i]);
            let wanted = along(layer.clearing.left[0]);
            // where the tool has not been near to at all, `rest` looks
            let Some(beside) = passed.distance(wanted).filter(|beside| *beside > allowed) else { continue };
            if beside <= allowed + tolerance * lean(&prober, layer, at) {
                continue;
            }
            let [across, _] = layer.clearing.left;
            let is_reached = grid.nearest(along(across + 2.0 * grid.spacing)).is_some_and(|node| reached[node]);
            // about corners that stand out all is cleared from both sides of them
            let off_wall = along(across + allowed - layer.radius);
            let is_swept = passed.distance(off_wall).is_some_and(|beside| beside < layer.radius);
            let is_in_stock = layer.is_stock(off_wall) && !is_swept;
            let reach = layer.clearing.smoothing + across;
            let centre = along(reach + FINE);
            let fits = (0..SIDES).map(|i| libm::sincos(TAU * f64::from(i) / f64::from(SIDES)));
            let fits = || fits.clone().all(|(sin, cos)| is_free([centre[0] + reach * cos, centre[1] + reach * sin]));
            if is_reached && is_in_stock && fits() {
                count += 1;
                if beside > worst.0 {
                    worst = (beside, wanted);
                }
            }
        }
    }
    let (thick, [x, y]) = worst;
    (count >= TIMES).then(|| {
        let message = format!(
            "operation {:?}: at Z{:.3} {thick:.3} mm more than is to stay are left beside walls, near X{x:.3} Y{y:.3}; post the job \
             again",
            layer.operation.id, layer.floor
        );
        let finding = Finding::of_all(FindingKind::Uncleared, Severity::Error, message);
        let position = Some([x, y, layer.floor]);
        Finding { position, value_mm: Some(thick), value: Some(thick), limit: Some(allowed), ..finding }
    })
}

/// How far a wall leans where the tool touches it on the layer: across, for each mm in height. Of a fillet near its end in a floor it is
/// much; where the tool is nearest to a level floor it is none, for floors are no walls.
fn lean(prober: &Prober<'_>, layer: &Layer<'_>, [x, y]: [f64; 2]) -> f64 {
    let position = prober.body.position([x, y, layer.floor - layer.clearing.left[1]]);
    let wall = prober.at(position, None).filter(|touch| touch.away.z > SLACK - 1.0);
    wall.map_or(0.0, |touch| touch.away.z.abs() / touch.away.xy().norm())
}

/// Where between a free position and one that is not the tool touches, and the direction off the wall there.
fn touching(
    is_free: &impl Fn([f64; 2]) -> bool,
    free: [f64; 2],
    blocked: [f64; 2],
    spacing: f64,
) -> Option<([f64; 2], [f64; 2])> {
    let halved = |aside: [f64; 2]| {
        let ends = [free, blocked].map(|p| [p[0] + aside[0], p[1] + aside[1]]);
        let at = |share: f64| [0, 1].map(|i| ends[0][i] + share * (ends[1][i] - ends[0][i]));
        if !is_free(ends[0]) || is_free(ends[1]) {
            return None;
        }
        let (mut low, mut high) = (0.0, 1.0);
        while (high - low) * spacing > FINE {
            let middle = 0.5 * (low + high);
            if is_free(at(middle)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(at(low))
    };
    let inwards = [free[0] - blocked[0], free[1] - blocked[1]];
    let at = halved([0.0; 2])?;
    let beside = halved([-ASIDE * inwards[1], ASIDE * inwards[0]])?;
    let along = [beside[0] - at[0], beside[1] - at[1]];
    let length = libm::hypot(along[0], along[1]);
    let normal = [along[1] / length, -along[0] / length];
    (length > FINE).then_some((at, normal))
}

/// Where the tool's centre has been.
struct Passed<'a> {
    swept: &'a [PlanePiece],
    cells: Cells,
}

impl<'a> Passed<'a> {
    fn new(swept: &'a [PlanePiece], reach: f64) -> Self {
        let mut cells = Cells::new(0.5 * reach, reach);
        (0_u32..).zip(swept).for_each(|(number, piece)| cells.insert(number, piece));
        Self { swept, cells }
    }

    /// How far it has been from a position, mm; None where that is farther than what was listed.
    fn distance(&self, at: [f64; 2]) -> Option<f64> {
        let near = self.cells.near(at).iter().filter_map(|number| self.swept.get(*number as usize));
        near.map(|piece| piece.distance(at)).min_by(f64::total_cmp)
    }
}

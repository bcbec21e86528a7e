//! How far apart passes may lie for a scallop: by what the tool and the faces are at each value of the passes' order.

use rayon::prelude::*;
use styluscam_geometry::{bend, wall_axes, Bend, ToolBody, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::stances::stances_of;
use super::steps::StepBounds;
use super::untouched::{in_plan, Untouched};
use crate::Surface;

/// Passes aim at this share of the scallop: what the curvatures leave out is of the order of its ratio to the tool's radius.
const AIM: f64 = 0.985;
/// Facets that are smaller than this share of the tool's radius count only where the tool touches one of their corners.
const SMALL: f64 = 0.5;
/// Faces that slope by less, a sine, are floors: no level lies on them.
const LEVEL: f64 = 1e-4;

/// What is asked of passes that leave scallops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScallopRule {
    /// The scallop, mm.
    pub height: f64,
    /// The smallest and the largest step in the order of the passes, mm.
    pub limits: [f64; 2],
}

/// The order of passes, as far as their distance follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// Levels: by the tip's height.
    Levels,
    /// Rows in this direction from X, rad: by the tip's position across them.
    Rows(f64),
}

/// The steps that a scallop allows, by height or by position across rows.
///
/// `body` is the tool with the sheet that it touches. Every selected facet counts over the values with which the tool touches
/// it, with its slope and the curvature of the model behind it.
///
/// # Errors
/// `Cancelled` when `watch` is cancelled.
pub fn scallop_steps(
    surface: &Surface<'_>,
    body: &ToolBody,
    spread: Spread,
    rule: &ScallopRule,
    watch: &Watch,
) -> Result<StepBounds, Cancelled> {
    let mesh = surface.envelope().mesh();
    let triangles: Vec<usize> = surface.triangles().filter(|triangle| spread.crosses(mesh.normal(*triangle))).collect();
    let stances = stances_of(surface, &triangles);
    let untouched = Untouched::by([], surface);
    let corners: Vec<(usize, [f64; 2])> =
        stances.iter().flat_map(|(triangle, tips)| tips.map(|tip| (*triangle, in_plan(tip)))).collect();
    watch.begin("scallops", corners.len());
    let tips = untouched.tips(&corners, watch)?;
    let large = SMALL * body.max_radius();
    let of_facet = |((triangle, stances), tips): (&(usize, [Vector; 3]), &[Option<f64>])| {
        let corners = mesh.corners(*triangle);
        let size = (0..3).map(|i| (corners[(i + 1) % 3] - corners[i]).norm()).fold(0.0, f64::max);
        if size < large && tips.iter().all(Option::is_none) {
            return None;
        }
        let values = stances.map(|tip| spread.value(tip));
        let [low, high] = [f64::min, f64::max].map(|of| values.into_iter().fold(values[0], of));
        let normals = mesh.corner_normals(*triangle);
        let bend = bend(&corners, &normals, mesh.model_normal(*triangle));
        let step = normals.map(|normal| spread.step(normal, &bend, body, AIM * rule.height));
        Some(([low, high], step.into_iter().fold(f64::INFINITY, f64::min)))
    };
    let ranges: Vec<([f64; 2], f64)> = stances.par_iter().zip(tips.par_chunks(3)).filter_map(of_facet).collect();
    Ok(StepBounds::new(&ranges, rule.limits))
}

impl Spread {
    /// Whether passes cross a face of this normal.
    fn crosses(self, normal: Vector) -> bool {
        match self {
            Self::Levels => normal.xy().norm() > LEVEL,
            Self::Rows(_) => true,
        }
    }

    fn value(self, tip: Vector) -> f64 {
        match self {
            Self::Levels => tip.z,
            Self::Rows(angle) => across(angle).dot(&tip),
        }
    }

    /// The step that a scallop of `height` allows on a face with a unit normal, mm.
    fn step(self, normal: Vector, bend: &Bend, body: &ToolBody, height: f64) -> f64 {
        let slope = libm::atan2(normal.xy().norm(), normal.z);
        let [up, level] = wall_axes(normal);
        // the direction across the passes in the face, and by how much a step along it changes their value
        let (direction, rate) = match self {
            Self::Levels => (up, up.z.abs()),
            Self::Rows(angle) => {
                let (sin, cos) = libm::sincos(angle);
                let row = Vector::new(cos, sin, 0.0);
                // in the upright plane of the row the tool follows the face up and down
                let along = row * normal.z - Vector::z() * row.dot(&normal);
                let Some(aside) = normal.cross(&along).try_normalize(LEVEL) else { return f64::INFINITY };
                (aside, across(angle).dot(&aside).abs())
            }
        };
        let shares = [direction.dot(&up), direction.dot(&level)];
        body.scallop_travel(slope, height, shares, bend.along(shares)) * rate
    }
}

/// The unit vector across rows of a direction, in plan.
fn across(angle: f64) -> Vector {
    let (sin, cos) = libm::sincos(angle);
    Vector::new(-sin, cos, 0.0)
}

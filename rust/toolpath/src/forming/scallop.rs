//! How far apart passes may lie for a scallop: by what the tool and the faces are at each value of the passes' order.

use rayon::prelude::*;
use styluscam_geometry::{bend, ToolBody, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::creases::{creases, tips_at_vertices};
use super::spread::{Ridge, Spread};
use super::stances::smooth_stances_of;
use super::steps::{Allowed, StepBounds};
use super::untouched::{in_plan, Untouched};
use crate::Surface;

/// Passes aim at this share of the scallop: what the curvatures leave out is of the order of its ratio to the tool's radius.
const AIM: f64 = 0.985;
/// Facets that are smaller than this share of the tool's radius count only where the tool touches one of their corners.
const SMALL: f64 = 0.5;

/// What is asked of passes that leave scallops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScallopRule {
    /// The scallop, mm.
    pub height: f64,
    /// The smallest and the largest step in the order of the passes, mm.
    pub limits: [f64; 2],
    /// How far passes may be off the faces to either side, mm.
    pub deviation: f64,
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
    let stances = smooth_stances_of(surface, &triangles);
    let untouched = Untouched::by([], surface);
    let corners: Vec<(usize, [f64; 2])> =
        stances.iter().flat_map(|(triangle, tips)| tips.map(|tip| (*triangle, in_plan(tip)))).collect();
    watch.begin("scallops", corners.len());
    let tips = untouched.tips(&corners, watch)?;
    let large = SMALL * body.max_radius();
    let creases = creases(surface);
    let ridge = Ridge { body: body.clone(), height: AIM * rule.height, deviation: rule.deviation };
    // beside a crease the tool does not get as far as either face alone would let it
    let at_creases = tips_at_vertices(&creases);
    let of_facet = |((triangle, stances), found): (&(usize, [Vector; 3]), &[Option<f64>])| {
        let corners = mesh.corners(*triangle);
        let size = (0..3).map(|i| (corners[(i + 1) % 3] - corners[i]).norm()).fold(0.0, f64::max);
        if size < large && found.iter().all(Option::is_none) {
            return None;
        }
        let vertices = mesh.triangles()[*triangle];
        let tips: [f64; 3] = std::array::from_fn(|i| match spread {
            Spread::Levels => at_creases.get(&vertices[i]).copied().unwrap_or(stances[i].z),
            Spread::Rows(_) => spread.value(stances[i]),
        });
        let by_value = |a: &usize, b: &usize| tips[*a].total_cmp(&tips[*b]);
        let [low, high] = [(0..3).min_by(by_value).unwrap_or(0), (0..3).max_by(by_value).unwrap_or(0)];
        let normals = mesh.corner_normals(*triangle);
        let bend = bend(&corners, &normals, mesh.model_normal(*triangle));
        let step = normals.map(|normal| spread.step(normal, &bend, &ridge).0);
        Some(Allowed {
            values: [tips[low], tips[high]],
            step: step.into_iter().fold(f64::INFINITY, f64::min),
            cosines: Some([normals[low].z, normals[high].z]),
        })
    };
    let mut allowed: Vec<Allowed> = stances.par_iter().zip(tips.par_chunks(3)).filter_map(of_facet).collect();
    allowed.extend(creases.iter().filter_map(|crease| crease.allowed(spread, &ridge)));
    Ok(match spread {
        Spread::Levels => StepBounds::of_levels(&allowed, rule.limits, ridge),
        Spread::Rows(_) => StepBounds::new(&allowed, rule.limits),
    })
}

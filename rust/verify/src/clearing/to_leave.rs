//! Stock that is to be left on the part, and is cut.
//!
//! What is left on walls is a distance across them in plan: the tool may be shifted so far to every side without meeting the part. What is left
//! under it is a distance in height: it may be lowered by so much as well. So every move of a layer is looked at lowered, and
//! shifted to [`SIDES`] sides; between two of them a wall is seen a hundredth of the distance too far away. Moves that lie farther
//! from everything than that on the grid of positions are passed over.

use std::f64::consts::TAU;

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use super::layer::Layer;
use super::own::Own;
use super::rest::Grid;
use crate::body::Body;
use crate::clearance::Prober;
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::stroke::Stroke;
use crate::subject::{Limits, Subject};
use crate::sweep::Question;
use crate::tolerances::{SAME_LEVEL, SLACK};

/// Sides to which the tool is shifted.
const SIDES: u32 = 24;
/// How far the lines that an arc is looked at by may be off it, mm: no more than arithmetic and rounding allow anyway.
const OFF: f64 = 5e-4;

/// What the tool may meet, and how far.
pub(super) struct Solids<'a> {
    pub body: &'a Body,
    pub subject: &'a Subject<'a>,
    pub limits: &'a Limits,
}

/// One fault for each move of the layer that takes what is to be left.
pub(super) fn faults(
    layer: &Layer<'_>,
    own: &[Own],
    (grid, free): (&Grid, &[bool]),
    solids: &Solids<'_>,
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let [across, under] = layer.clearing.left;
    let Solids { body, subject, limits } = solids;
    let prober = Prober { body, mesh: subject.mesh, bvh: subject.bvh };
    let near = grid.near_blocked(free, across);
    let is_near = |[x, y, _]: [f64; 3]| grid.nearest([x, y]).is_none_or(|node| near.get(node) != Some(&false));
    let shifts: Vec<Vector> = match across > 0.0 {
        true => (0..SIDES).map(|i| libm::sincos(TAU * f64::from(i) / f64::from(SIDES))).collect::<Vec<_>>(),
        false => vec![(0.0, 0.0)],
    }
    .into_iter()
    .map(|(sin, cos)| Vector::new(across * cos, across * sin, 0.0))
    .collect();
    let allowed = limits.gouge + 2.0 * limits.unit + subject.deviation_inward + SLACK;
    let deepest = |segment: &Segment| {
        let mut deepest: Option<(f64, [f64; 3])> = None;
        let parts = parts(segment, grid.spacing);
        for part in 0..parts {
            let [from, to] = [part, part + 1].map(|i| segment.at(i as f64 / parts as f64));
            if !is_near(from) && !is_near(to) {
                continue;
            }
            let [start, end] = [from, to].map(|[x, y, z]| body.position([x, y, z - under]));
            let asked = |shift: &Vector, below: f64| {
                let stroke = Stroke { from: start + shift, to: end + shift };
                prober.survey(Question { stroke, positions: [None; 2], below }, None).deepest
            };
            // shifted, it comes nearer by no more than the shift
            if asked(&Vector::zeros(), across - allowed + SLACK).is_none() {
                continue;
            }
            for shift in &shifts {
                let Some(passed) = asked(shift, -allowed) else { continue };
                let depth = -passed.touch.value;
                if deepest.is_none_or(|(most, _)| depth > most) {
                    let [x, y, z] = body.tip(passed.position - shift);
                    deepest = Some((depth, [x, y, z + under]));
                }
            }
        }
        deepest
    };
    let fault = |segment: &&Segment| {
        watch.advance(0)?;
        Ok(deepest(segment).map(|(depth, position)| {
            let fault = segment.fault(&faults::STOCK_TO_LEAVE).measured(depth, allowed);
            Fault { position, ..fault }
        }))
    };
    let is_in = |z: f64| z > layer.floor - SAME_LEVEL && z < layer.top - SLACK;
    let of_layer =
        |segment: &&Segment| segment.kind != SegmentKind::Rapid && segment.start.is_some() && is_in(segment.lowest());
    let segments: Vec<&Segment> = own.iter().map(|own| own.segment).filter(of_layer).collect();
    let found: Result<Vec<Option<Fault>>, Cancelled> = segments.par_iter().with_min_len(64).map(fault).collect();
    Ok(found?.into_iter().flatten().collect())
}

/// Into how many lines a move is divided: no longer than `longest`, mm, and near to it where it is an arc.
fn parts(segment: &Segment, longest: f64) -> usize {
    let turns = segment.bend.map_or(0.0, |bend| {
        let sweep = bend.sweep().abs();
        let radius = bend.length() / sweep;
        sweep / (2.0 * libm::acos((1.0 - OFF / radius).max(0.0)))
    });
    libm::ceil(turns.max(segment.length() / longest)).max(1.0) as usize
}

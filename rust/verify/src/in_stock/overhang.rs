//! Shank and holder in the stock.
//!
//! A tool takes what its profile sweeps in a short piece of a move; then what is above the profile, and wider, is compared with what
//! stands. So what the profile takes is gone before shank and holder follow it down, and what stands beside it is not.

use styluscam_geometry::{Cutter, Stock, Tool, ToolPart};
use styluscam_motion::{Cancelled, Watch};

use super::divided::{asked, pieces, LONGEST};
use crate::faults::{self, Fault, FaultKind};
use crate::segments::Segment;
use crate::simulation::{Material, Moved, Overlap};
use crate::subject::Subject;

/// What shank and holder enter the stock by less, from above or from the side, does not count, mm.
const SLIGHT: f64 = 0.05;
/// Nodes are this far apart at most, mm,
const SPACING: f64 = 0.5;
/// and this share of a solid's radius.
const OF_RADIUS: f64 = 0.1;
/// Chords are nearer to arcs than this, mm.
const SAG: f64 = 5e-3;
/// Pieces of a move are as long as a solid is wider than the profile at most, but no shorter than this share of the profile's radius: what
/// stands beside the path is found anyway.
const SHORTEST: f64 = 0.25;

/// A solid that a tool has above its profile, and wider.
struct Overhang {
    kind: &'static FaultKind,
    solid: Moved,
}

/// A tool as it cuts.
struct Loaded {
    profile: Moved,
    overhangs: Vec<Overhang>,
    /// Of the pieces of its moves, mm.
    longest: f64,
}

/// The moves on which shank or holder are in the stock.
pub(super) fn faults(
    segments: &[Segment],
    (subject, stock): (&Subject, &Stock),
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let tools: Vec<Loaded> = subject.tools.iter().map(Loaded::new).collect();
    let tool_of = |segment: &Segment| tools.get(segment.tool?);
    let may_be_in = |segment: &Segment| tool_of(segment).is_some_and(|tool| tool.is_under(stock.top, segment));
    let overhangs = tools.iter().flat_map(|tool| &tool.overhangs);
    let narrowest = overhangs.map(|overhang| overhang.solid.radius()).fold(f64::INFINITY, f64::min);
    let spacing = SPACING.min(OF_RADIUS * narrowest);
    let Some((segments, mut material)) = asked(segments, may_be_in, spacing, (subject, stock), watch)? else {
        return Ok(Vec::new());
    };
    watch.begin("shank and holder in the stock", segments.len());
    let mut faults = Vec::new();
    for segment in segments {
        watch.advance(1)?;
        if let Some(tool) = tool_of(segment).filter(|_| segment.lowest() < stock.top) {
            faults.extend(tool.move_along(segment, &mut material, stock.top));
        }
    }
    Ok(faults)
}

impl Loaded {
    fn new(tool: &Tool) -> Self {
        let profile = Moved::profile(tool);
        let overhangs: Vec<Overhang> = tool.cutters_above().into_iter().map(Overhang::new).collect();
        let wider = overhangs.iter().map(|overhang| overhang.solid.radius() - profile.radius());
        let longest = wider.fold(LONGEST * profile.radius(), f64::min).max(SHORTEST * profile.radius());
        Self { profile, overhangs, longest }
    }

    /// Whether anything above its profile comes under a height, mm.
    fn is_under(&self, top: f64, segment: &Segment) -> bool {
        self.overhangs.iter().any(|overhang| overhang.is_under(top, segment))
    }

    /// Takes what its profile sweeps, and finds what of it is in the material under `top`.
    fn move_along(&self, segment: &Segment, material: &mut Material, top: f64) -> Vec<Fault> {
        let mut worst: Vec<Option<Overlap>> = vec![None; self.overhangs.len()];
        // straight up: it is where the move before has brought it
        let lifts = segment.start.is_some() && !segment.travels() && !segment.descends();
        for piece in pieces(segment, self.longest, SAG) {
            material.cut(&piece, &self.profile);
            let is_asked = |overhang: &Overhang| !lifts && overhang.is_under(top, &piece);
            let asked = self.overhangs.iter().zip(&mut worst).filter(|(overhang, _)| is_asked(overhang));
            for (overhang, worst) in asked {
                let least = worst.map_or(SLIGHT, |worst| worst.by);
                let within = overhang.solid.radius() - SLIGHT;
                *worst = material.overlap(&piece, &overhang.solid, within, least).or(*worst);
            }
        }
        let found =
            worst.into_iter().zip(&self.overhangs).filter_map(|(worst, overhang)| Some((worst?, overhang.kind)));
        let fault = |(Overlap { by, at: position }, kind)| Fault { position, ..segment.fault(kind).measured(by, 0.0) };
        found.map(fault).collect()
    }
}

impl Overhang {
    fn new((part, cutter, height): (ToolPart, Cutter, f64)) -> Self {
        let kind = match part {
            ToolPart::Shank => &faults::SHANK_IN_STOCK,
            ToolPart::Holder => &faults::HOLDER_IN_STOCK,
        };
        Self { kind, solid: Moved::above(cutter, height) }
    }

    fn is_under(&self, top: f64, segment: &Segment) -> bool {
        segment.lowest() + self.solid.lowest() < top - SLIGHT
    }
}

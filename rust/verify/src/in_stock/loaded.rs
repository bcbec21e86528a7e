//! A tool in the spindle, and what it meets of the stock on a move.

use styluscam_geometry::{Cutter, Tool, ToolPart};

use crate::faults::{self, Fault, FaultKind};
use crate::segments::Segment;
use crate::simulation::{Material, Moved};

/// What shank and holder enter the stock by less, from above or from the side, does not count, mm.
const SLIGHT: f64 = 0.05;
/// What stands nearer to the tool's axis than this share of its radius is cut by its middle: more than a skin on a wall.
const MIDDLE: f64 = 0.5;
/// Pieces of a move at most.
const MOST: f64 = 1e5;

/// A tool and what is above its profile.
pub(super) struct Loaded {
    profile: Moved,
    /// mm.
    radius: f64,
    above: Vec<Above>,
    /// Longest piece of a move on which what the profile takes has been under what is above it, mm.
    longest: f64,
}

/// A solid above a tool's profile.
struct Above {
    kind: &'static FaultKind,
    solid: Moved,
    /// Height of its lowest point over the tip, mm.
    height: f64,
    /// mm.
    radius: f64,
}

/// What is found on a move.
pub(super) struct Met {
    /// Of each solid above the profile.
    pub above: Vec<Fault>,
    /// That its profile cuts deeper than it is wide.
    pub deep: Option<Fault>,
}

impl Loaded {
    pub fn new(tool: &Tool) -> Self {
        let above: Vec<Above> = tool.cutters_above().into_iter().map(Above::new).collect();
        let radius = 0.5 * tool.diameter();
        let wider = above.iter().map(|above| above.radius - radius).filter(|wider| *wider > SLIGHT);
        Self { profile: Moved::profile(tool), radius, longest: wider.fold(f64::INFINITY, f64::min), above }
    }

    /// Of its profile, mm.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Of the solids above its profile, mm.
    pub fn radii_above(&self) -> impl Iterator<Item = f64> + '_ {
        self.above.iter().map(|above| above.radius)
    }

    /// Whether anything above its profile comes under the stock's top.
    pub fn may_be_in(&self, segment: &Segment, top: f64) -> bool {
        self.above.iter().any(|above| segment.lowest() + above.height < top - SLIGHT)
    }

    /// Whether its tip is deeper under the stock's top than it is wide.
    pub fn may_cut_deep(&self, segment: &Segment, top: f64) -> bool {
        segment.lowest() < top - 2.0 * self.radius
    }

    /// Takes what it sweeps of the material under `top`, and finds what it meets.
    pub fn move_along(&self, segment: &Segment, material: &mut Material, top: f64) -> Met {
        let (may_be_in, may_cut_deep) = (self.may_be_in(segment, top), self.may_cut_deep(segment, top));
        let least = if may_be_in { (segment.length() / self.longest).ceil().clamp(1.0, MOST) as u32 } else { 1 };
        let divided = Segment { pieces: segment.pieces.max(least), ..*segment };
        let mut above = vec![Deepest::over(SLIGHT); self.above.len()];
        let mut deep = Deepest::over(2.0 * self.radius);
        for piece in divided.pieces() {
            if may_cut_deep {
                deep.take(material.most_over(&piece, &self.profile, (1.0 - MIDDLE) * self.radius), &piece);
            }
            material.cut(&piece, &self.profile);
            for (deepest, above) in above.iter_mut().zip(&self.above).filter(|_| may_be_in) {
                deepest.take(material.most_over(&piece, &above.solid, SLIGHT), &piece);
            }
        }
        let kinds = self.above.iter().map(|above| above.kind);
        Met {
            above: above.iter().zip(kinds).filter_map(|(deepest, kind)| deepest.fault(segment, kind)).collect(),
            deep: deep.fault(segment, &faults::DEEP_IN_STOCK).map(Fault::warning),
        }
    }
}

impl Above {
    fn new((part, cutter, height): (ToolPart, Cutter, f64)) -> Self {
        let kind = match part {
            ToolPart::Shank => &faults::SHANK_IN_STOCK,
            ToolPart::Holder => &faults::HOLDER_IN_STOCK,
        };
        let radius = cutter.max_radius();
        Self { kind, solid: Moved::above(cutter, height), height, radius }
    }
}

/// The piece of a move on which the material stands highest over a solid's underside.
#[derive(Clone, Copy)]
struct Deepest {
    /// So much is allowed, mm.
    limit: f64,
    /// mm, and the tip's position at the end of the piece.
    worst: Option<(f64, [f64; 3])>,
}

impl Deepest {
    fn over(limit: f64) -> Self {
        Self { limit, worst: None }
    }

    fn take(&mut self, depth: Option<f64>, piece: &Segment) {
        let most = self.worst.map_or(self.limit, |(most, _)| most);
        if let Some(depth) = depth.filter(|depth| *depth > most) {
            self.worst = Some((depth, piece.end));
        }
    }

    fn fault(&self, segment: &Segment, kind: &'static FaultKind) -> Option<Fault> {
        let (depth, position) = self.worst?;
        Some(Fault { position, ..segment.fault(kind).measured(depth, self.limit) })
    }
}

//! What is measured, and what comes of it: plane paths, what they cut, the angle at every position.

use styluscam_geometry::PlanePiece;

/// Thickness of a chip from which it counts, mm.
pub const CHIP: f64 = 1e-3;
/// Length of a step, in radii of the tool.
pub const STEP: f64 = 0.02;
/// Distance of positions at which the tool is probed, in radii of the tool.
pub const PROBE: f64 = 0.1;
/// Path of which the sweep is taken as it is, in radii of the tool: longer than a step, so that 1 um beside it is no angle.
pub const RECENT: f64 = 1.0;

/// What a stretch of a plane path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneRunKind {
    /// Cutting.
    Cut,
    /// The way into the material: a helix or a ramp, seen from above.
    Entry,
    /// At depth, through what is cleared: it should cut nothing.
    Link,
    /// Over the stock: it neither cuts nor clears.
    Rapid,
    /// It clears, and nothing is measured.
    Swept,
    /// What the tool meets all around, at positions farther apart, is measured, and nothing is cleared.
    Probed,
}

/// A stretch of a plane path.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneRun {
    /// Points (x, y, bulge of the piece that begins there), mm.
    pub points: Vec<[f64; 3]>,
    /// What it is for.
    pub kind: PlaneRunKind,
}

/// The engagement along one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunEngagement {
    /// Where it was measured.
    pub measures: Vec<Engaged>,
}

/// The engagement at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engaged {
    /// The tool's centre, mm.
    pub at: [f64; 2],
    /// Length of the run up to there, mm.
    pub travelled: f64,
    /// The engagement angle, rad.
    pub angle: f64,
    /// Area cleared per length of the path, mm: the radial stepover. 0 where the tool comes down.
    pub width: f64,
    /// Distance from the centre to the pocket's nearest wall, mm; infinite beyond two radii.
    pub clearance: f64,
}

/// What a path cuts.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a> {
    /// The tool's radius, mm.
    pub radius: f64,
    /// Outlines (x, y, bulge) of the material, mm; islands are outlines within outlines.
    pub stock: &'a [Vec<[f64; 3]>],
    /// Outlines of the pocket, mm.
    pub pocket: &'a [Vec<[f64; 3]>],
    /// What was swept before the path, with other tools.
    pub cleared: &'a [Swept],
    /// Thickness of a chip from which it counts, mm: [`CHIP`], and more where positions are rounded.
    pub chip: f64,
}

/// A path along which a tool has been.
#[derive(Clone, Debug, PartialEq)]
pub struct Swept {
    /// Points (x, y, bulge of the piece that begins there), mm; a single one is a tool let down there.
    pub points: Vec<[f64; 3]>,
    /// The tool's radius, mm.
    pub radius: f64,
}

impl Swept {
    /// What the tool's centre passes.
    #[must_use]
    pub fn pieces(&self) -> Vec<PlanePiece> {
        let pieces = PlanePiece::path(&self.points);
        if !pieces.is_empty() {
            return pieces;
        }
        let still = self.points.first().map(|[x, y, _]| PlanePiece::new([*x, *y], [*x, *y], 0.0));
        still.into_iter().collect()
    }
}

//! What is asked for, and the path that answers it.

/// Helices of a smaller radius, in radii of the tool, are as good as plunges.
pub const SMALLEST: f64 = 0.04;
/// Ramps are no shorter, in radii of the tool.
pub const SHORTEST: f64 = 0.5;

/// What is cleared, with what.
#[derive(Clone, Copy, Debug)]
pub struct Pocket<'a> {
    /// Where the tool may go, and what it meets there.
    pub shape: Shape<'a>,
    /// The tool's radius, mm.
    pub radius: f64,
    /// The largest engagement angle, rad.
    pub angle: f64,
    /// The smallest radius of the centre's path (MSR), mm.
    pub smoothing: f64,
    /// What stays on the walls, mm across them.
    pub leave: f64,
    /// What the passes leave of that for one along the walls at the end, mm; 0 where there is none.
    pub finish: f64,
    /// What larger tools have cleared before.
    pub cleared: &'a [Cleared],
    /// Whether the material is right of the tool (climb milling, spindle clockwise), or left.
    pub climb: bool,
    /// Whether pieces may be cut in both directions, whichever has the shorter way.
    pub two_way: bool,
    /// How the tool goes down into material.
    pub entry: EntryRule,
    /// Whether the stepover along the cuts is measured, for feeds that depend on it.
    pub stepovers: bool,
}

/// How the tool goes down into material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EntryRule {
    /// On which way.
    pub form: EntryForm,
    /// Diameter of helices and length of ramps, of the tool's centre, mm at most; 1.4 tool radii and 2 where none is stated.
    pub size: Option<f64>,
}

/// The form of an entry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EntryForm {
    /// A helix; a ramp where the helix would be a small one.
    Auto,
    /// A helix.
    #[default]
    Helix,
    /// To and fro along a line.
    Ramp,
}

impl EntryForm {
    /// The smallest size that leads down, in tool radii.
    pub(super) fn least(self) -> f64 {
        match self {
            Self::Auto | Self::Helix => 2.0 * SMALLEST,
            Self::Ramp => SHORTEST,
        }
    }

    /// What it is, in words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Auto => "helix and no ramp",
            Self::Helix => "helix",
            Self::Ramp => "ramp",
        }
    }
}

/// A path along which a tool has cleared the material.
#[derive(Clone, Debug, PartialEq)]
pub struct Cleared {
    /// Points (x, y, bulge of what begins there), mm.
    pub points: Vec<[f64; 3]>,
    /// The tool's radius, mm.
    pub radius: f64,
}

/// Where the tool may go: outlines are points (x, y, bulge of the edge that begins there), mm.
#[derive(Clone, Copy, Debug)]
pub enum Shape<'a> {
    /// Between walls.
    Walls {
        /// The pocket's outline.
        boundary: &'a [[f64; 3]],
        /// Outlines that stay.
        islands: &'a [Vec<[f64; 3]>],
        /// Numbers of the boundary's edges beyond which is air.
        open_edges: &'a [usize],
        /// Outlines of the material, where it is less than the pocket.
        stock: Option<&'a [Vec<[f64; 3]>]>,
    },
    /// With its centre within outlines, by the even-odd rule: for a part whose walls lean, or a tool whose sides do.
    Centres {
        /// Outlines of where the centre may be.
        outlines: &'a [Vec<[f64; 3]>],
        /// Outlines of the material.
        stock: &'a [Vec<[f64; 3]>],
        /// Whether all that lies beyond the outer outline is air.
        in_air: bool,
    },
}

impl<'a> Shape<'a> {
    /// All outlines of where the tool may go, each with its name.
    pub(super) fn outlines(&self) -> Vec<(String, &'a [[f64; 3]])> {
        let listed = |name: &'static str, outlines: &'a [Vec<[f64; 3]>]| {
            outlines.iter().enumerate().map(move |(i, outline)| (format!("{name}[{i}]"), outline.as_slice()))
        };
        match *self {
            Self::Walls { boundary, islands, .. } => {
                std::iter::once(("boundary".to_owned(), boundary)).chain(listed("islands", islands)).collect()
            }
            Self::Centres { outlines, .. } => listed("outlines", outlines).collect(),
        }
    }

    /// Outlines of the material, where they are given.
    pub(super) fn stock(&self) -> Option<&'a [Vec<[f64; 3]>]> {
        match *self {
            Self::Walls { stock, .. } => stock,
            Self::Centres { stock, .. } => Some(stock),
        }
    }
}

/// What a run is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PocketRunKind {
    /// Cutting.
    Cut,
    /// A helix or a ramp into the material, seen from above: once around.
    Entry,
    /// At depth, through what is cleared.
    Link,
    /// Over the stock.
    Rapid,
}

/// A stretch of the path.
#[derive(Clone, Debug, PartialEq)]
pub struct PocketRun {
    /// Points (x, y, bulge of what begins there), mm.
    pub points: Vec<[f64; 3]>,
    /// What it is for.
    pub kind: PocketRunKind,
    /// The stepover along a cut, where it is measured.
    pub stepovers: Vec<Stepover>,
    /// How far the positions that walls leave to the tool's centre reach to all sides of where it may come down, mm: the start, of a link
    /// the end.
    pub room: f64,
}

impl PocketRun {
    /// A run of which no stepover is measured.
    #[must_use]
    pub fn new(points: Vec<[f64; 3]>, kind: PocketRunKind) -> Self {
        Self { points, kind, stepovers: Vec::new(), room: 0.0 }
    }
}

/// What the tool cuts at a position of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stepover {
    /// Length of the run up to there, mm.
    pub travelled: f64,
    /// Area cleared per length of the path, mm: the radial stepover.
    pub width: f64,
    /// Thickness of the thickest chip as a share of the feed per tooth.
    pub chip: f64,
}

/// A path that clears a pocket.
#[derive(Clone, Debug, PartialEq)]
pub struct PocketPath {
    /// In the order in which they are cut.
    pub runs: Vec<PocketRun>,
    /// What of the stock the tool can reach, mm^2.
    pub goal: f64,
    /// What of that it did not clear, mm^2.
    pub left: f64,
}

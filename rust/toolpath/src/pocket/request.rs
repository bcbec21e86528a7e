//! What is asked for, and the path that answers it.

/// What is cleared, with what.
#[derive(Clone, Debug)]
pub struct Pocket<'a> {
    /// The pocket's outline: points (x, y, bulge of the edge that begins there), mm.
    pub boundary: &'a [[f64; 3]],
    /// Outlines that stay.
    pub islands: &'a [Vec<[f64; 3]>],
    /// Numbers of the boundary's edges beyond which is air.
    pub open_edges: &'a [usize],
    /// Outlines of the material, where it is less than the pocket.
    pub stock: Option<&'a [Vec<[f64; 3]>]>,
    /// The tool's radius, mm.
    pub radius: f64,
    /// The largest engagement angle, rad.
    pub angle: f64,
    /// The smallest radius of the centre's path (MSR), mm.
    pub smoothing: f64,
    /// Whether the material is right of the tool (climb milling, spindle clockwise), or left.
    pub climb: bool,
    /// Whether pieces may be cut in both directions, whichever has the shorter way.
    pub two_way: bool,
}

/// What a run is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PocketRunKind {
    /// Cutting.
    Cut,
    /// A helix into the material, seen from above: once around.
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

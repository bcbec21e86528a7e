//! What an operation that clears stock engages and removes along its feed moves, as data.

/// What an operation that clears stock engages and removes.
#[derive(Clone, Debug, PartialEq)]
pub struct OperationEngagement {
    /// The operation's id.
    pub operation: String,
    /// The largest engagement angle, but on entries, rad.
    pub angle: f64,
    /// Length of all its feed moves, mm.
    pub length: f64,
    /// From the top down.
    pub layers: Vec<ClearedLayer>,
    /// Its feed moves that are measured, in the order of the program: not those over the stock, straight up, or below the last layer.
    pub moves: Vec<ClearingMove>,
}

/// A layer of stock that is cleared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearedLayer {
    /// mm.
    pub top: f64,
    /// Height of the tip, mm.
    pub floor: f64,
    /// The tool's radius at the layer's top, mm.
    pub radius: f64,
    /// Volume that a straight pass at the largest angle removes in a minute, at the feed that is stated for it, mm^3.
    pub reference: f64,
}

/// What a move that clears is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearingKind {
    /// It cuts.
    Cut,
    /// Through what is cleared.
    Link,
    /// Down into the material: the largest angle does not hold there.
    Entry,
}

/// A feed move of an operation that clears.
#[derive(Clone, Debug, PartialEq)]
pub struct ClearingMove {
    /// Line of the text, from 1; 0 when it was not read from text.
    pub line: u32,
    /// The layer, index.
    pub layer: usize,
    /// What it is for.
    pub kind: ClearingKind,
    /// Length of the operation's feed moves up to its start and its end, mm.
    pub travelled: [f64; 2],
    /// mm/min; none where the text states none per minute.
    pub feed: Option<f64>,
    /// What rounding the text's coordinates may have added to the stepover, mm.
    pub rounding: f64,
    /// Where it was measured.
    pub positions: Vec<EngagedAt>,
}

/// A position at which the engagement was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EngagedAt {
    /// Length of the operation's feed moves up to there, mm.
    pub travelled: f64,
    /// The tool's tip, work coordinates, mm.
    pub tip: [f64; 3],
    /// The engagement angle, rad.
    pub angle: f64,
    /// Area cleared per length of the path just under the layer's top, mm: the radial stepover.
    pub stepover: f64,
}

//! The verifier of posted text: moves read back from it, compared with the part.
//!
//! It works with distances. The signed distance of a point to the tool (a convex body) is a convex
//! function of the point; the clearance at a position is that function's minimum over the part's
//! triangles. Nothing here lowers a tool onto a surface: that is how planning finds its paths, and a
//! verifier that shared the method would share the mistakes.
//!
//! What is proved, what is sampled:
//!
//! - *Gouge* is proved, not sampled: a straight move sweeps a convex body, so the deepest position over
//!   the whole move is the minimum of one convex function per triangle. Only triangles that a
//!   supporting plane of the swept body cannot keep away are measured.
//! - *Depth* is measured along the triangle's normal where the tool's lowest point lies over the
//!   triangle. Where the tool is in deeper than its own radius of curvature (at a sharp rim: anywhere),
//!   the depth given is a lower bound; that it is in is certain.
//! - *Excess* is sampled: at the start, the middle and the end of every contact move, every quarter of the tool's radius
//!   on longer ones.
//! - *Missing passes* are looked for at 20,000 points of the faces that an operation is for, and at as many of the lines
//!   on which the passes that there are should touch them.
//! - The tool is its profile, and above its base a straight cylinder upwards without end: so a tool
//!   wholly inside the material still meets the surface above it. A wider shank and the holder are
//!   bodies of their own, as wide as they are upwards without end.
//! - *Two tools* on both sides of a sheet: over a move of both their distance is a convex function of time. That they are not
//!   too near is proved, that they are not too far is measured at the ends, where such a function is largest.
//! - An arc is proved in chords that are halved until what they are off it does not matter.
//!
//! The triangles stand for the part; their checked deviation from it is counted against the program
//! on both sides (see [`Subject`]).

#![cfg_attr(test, allow(clippy::disallowed_methods))] // what tests expect may come from std

mod assignment;
mod before;
mod blank;
mod body;
mod bored;
mod bounds;
mod chamfered;
mod clearance;
mod clearing;
mod contact_lines;
mod contoured;
mod convex;
mod corner_angles;
mod corners;
mod coverage;
mod covered;
mod diagnosis;
mod earlier;
mod engaged;
mod engagement;
mod expectation;
mod faults;
mod findings;
mod flank;
mod flats;
mod frame;
mod groups;
mod holding;
mod holes;
mod in_layers;
mod in_stock;
mod judge;
mod leaning;
mod level_moves;
mod low_links;
mod made;
mod measure;
mod merge;
mod opened;
mod pair;
mod passes;
mod pitch;
mod place;
mod probes;
mod reach;
mod region;
mod region_faults;
mod report;
mod rows;
mod samples;
mod scalar;
mod scallop;
mod sections;
mod segments;
mod sequence;
mod settings;
mod simulation;
mod solid;
mod standing;
mod stock_above;
mod stroke;
mod subject;
mod sweep;
mod tabs;
mod tally;
mod tolerances;
mod travel;
mod turning;
mod unknown;
mod unreached;
mod walls;
mod walls_beside;
mod words;

pub use assignment::is_named;
pub use before::Before;
pub use coverage::{coverage, left, needs, FaceCoverage};
pub use earlier::cut_by;
pub use engaged::{ClearedLayer, ClearingKind, ClearingMove, EngagedAt, OperationEngagement};
pub use engagement::{
    engagement, Engaged, EngagementError, Ground, PlaneRun, PlaneRunKind, RunEngagement, Swept, CHIP,
};
pub use expectation::{
    Boring, ChamferedEdge, Chamfering, ClearedHole, Clearing, Contact, ContourLevel, ContourLine, ContourPiece,
    ContourSide, Contouring, DrilledHole, Drilling, Expectation, ExpectedOperation, FlankFace, FlankPasses, Layers,
    OrderedPasses, Passes, TabShape,
};
pub use findings::{Finding, FindingKind, Severity};
pub use flank::{clearance_of_tool, left_by_flank, FlankShape};
pub use flats::Need;
pub use groups::Group;
pub use in_stock::{CUT_BY_MIDDLE, DEEPEST_AT_ONCE};
pub use judge::judge;
pub use leaning::{AxisTurning, FlankFaceError, OperationFlank};
pub use pitch::Pitch;
pub use place::Place;
pub use region::{CheckFaces, Inside, Region};
pub use report::{ContactRecord, Report};
pub use scalar::{Across, Height, Outwards, PassKind, Scalar};
pub use scallop::{scallops, Scallop};
pub use simulation::{simulate, Grid, Simulation, Skin};
pub use subject::{
    Axes, Forming, Found, FrameLevel, Left, Limits, Obstacle, ObstacleKind, Pairing, Partner, Reach, Subject, Support,
    TextFacts, ToolCalls, WallAngleSource,
};
pub use turning::{turned, TooLong, Turned};
pub use unreached::ToolReach;

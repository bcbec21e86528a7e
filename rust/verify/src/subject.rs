//! What a program is checked against, and how strictly.

use std::ops::Range;

use styluscam_geometry::{Bvh, Mesh, Sheet, Stock, Tool};
use styluscam_motion::{Cornering, FeedRounding, MachineMove, Program};

use crate::before::Before;
use crate::body::Body;
use crate::expectation::ExpectedOperation;
use crate::findings::{FindingKind, Severity};

/// The part and the tools, in the program's work coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The whole part as triangles, work coordinates, mm.
    pub mesh: &'a Mesh,
    /// The mesh's index.
    pub bvh: &'a Bvh,
    /// Tools in the order of the program's `tools`.
    pub tools: &'a [Tool],
    /// The sheet between tool and part, when there is one.
    pub sheet: Option<Sheet>,
    /// What the part is cut from, where it is.
    pub stock: Option<&'a Stock>,
    /// Whether the job states that; else it is the part's box, and material may be missing in it.
    pub stock_is_stated: bool,
    /// What earlier programs have cut of it.
    pub before: Option<&'a Before>,
    /// How far the triangles lie inside the true surface at most, mm: taken off every clearance
    /// before it is checked as a gouge.
    pub deviation_inward: f64,
    /// How far the triangles lie outside the true surface at most, mm: added to every clearance
    /// before it is checked as an excess.
    pub deviation_outward: f64,
    /// Work offset in which the part stands; the program must be in it.
    pub wcs: &'a str,
    /// Moves whose end is not known in all three axes, in ascending runs. They have no position, and the move
    /// after them has no start.
    pub unknown_positions: &'a [Range<usize>],
    /// The moves of the machine's axes, of a part that turns: the program is then what they are to the part ([`crate::turned`]).
    pub axes: Option<Axes<'a>>,
    /// What its text states besides the moves; none for a program that was not read from text.
    pub text: Option<&'a TextFacts>,
    /// The job's operations; none when feeds, spindle, coolant and passes are not to be checked.
    pub expected: &'a [ExpectedOperation],
    /// What stands around the part.
    pub obstacles: &'a [Obstacle],
    /// The program that runs beside it, on the other side of a sheet.
    pub pairing: Pairing<'a>,
}

/// The moves of a machine's axes.
#[derive(Clone, Copy, Debug)]
pub struct Axes<'a> {
    /// In order.
    pub program: &'a Program,
    /// Those whose end is not known in all three axes, in ascending runs.
    pub unknown_positions: &'a [Range<usize>],
}

/// Whether a program runs alone.
#[derive(Clone, Copy, Debug)]
pub enum Pairing<'a> {
    /// It does.
    Alone,
    /// It does not, and the other one is not given: nothing about the two together is checked.
    Missing {
        /// The channel of the other one.
        channel: &'a str,
    },
    /// It does not.
    With(&'a Partner<'a>),
}

/// The other program of a pair: its machine's coordinates are this one's, turned half about X.
#[derive(Clone, Copy, Debug)]
pub struct Partner<'a> {
    /// Its moves.
    pub program: &'a Program,
    /// What it is checked against.
    pub subject: &'a Subject<'a>,
    /// What is allowed of it.
    pub limits: &'a Limits,
    /// Whether it follows this one; else this one follows it.
    pub follows: bool,
    /// The sheet that is to be between the two tools.
    pub left: Left,
}

/// A sheet between two tools.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Left {
    /// Along the normal of their contacts, mm.
    pub normal: f64,
    /// Along the vertical, mm.
    pub vertical: f64,
}

/// Something that the tool, or tool and sheet, must not come near.
#[derive(Debug)]
pub struct Obstacle {
    /// What it is.
    pub kind: ObstacleKind,
    /// Its faces as tools from above meet them, work coordinates, mm.
    pub mesh: Mesh,
    /// The mesh's index.
    pub bvh: Bvh,
    /// The sheet between tool and obstacle, when it lies there.
    pub sheet: Option<Sheet>,
    /// What must stay between them, mm.
    pub margin: f64,
    /// Whether it goes down with the clamp frame ([`Support::DieAndFrame`]): `mesh` is where it stands before anything is formed.
    pub follows: bool,
}

/// What stands around a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObstacleKind {
    /// The frame that clamps the sheet.
    Clamp,
    /// The plate under the sheet.
    Backing,
}

/// What a sheet withstands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forming {
    /// Its thickness before, mm.
    pub thickness: f64,
    /// Height of its upper side before, mm.
    pub top: f64,
    /// What holds it up while it is formed.
    pub support: Support,
    /// Thinnest that it may become by the sine law, mm.
    pub min_thickness: f64,
    /// Steepest wall, rad.
    pub max_wall_angle: f64,
    /// Walls up to this angle it withstands whatever it is made of, rad; infinite where the steepest is known.
    pub sure_wall_angle: f64,
    /// Whence that is known.
    pub source: WallAngleSource,
}

/// What holds a sheet up where no tool has pressed it yet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Support {
    /// Its rim, which is clamped at the height of the flat sheet: what is not formed hangs from there.
    #[default]
    Rim,
    /// The part itself, a die under the sheet, and around it a clamp frame that goes down with the path: inside the current loop
    /// the sheet lies on the die, outside it stands as high as the frame.
    DieAndFrame,
    /// The part itself, a mandrel that turns with the sheet and to which its middle is clamped: outside the current turn the sheet
    /// is free and stands flat, as high as the turn.
    Mandrel,
}

/// A height that a text states for the clamp frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameLevel {
    /// Index of the move before which the frame goes there.
    pub before: usize,
    /// Height of the sheet's upper side in the frame, work coordinates, mm.
    pub z: f64,
}

/// Whence it is known how steep a wall a sheet withstands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallAngleSource {
    /// The job states it.
    Job,
    /// It is the material's, of this name.
    Material(&'static str),
    /// The job names no material: it is the most and the least of those that are known.
    Unknown,
}

/// What a text states besides its moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextFacts {
    /// Moves at whose end the height is not known, in ascending runs.
    pub unknown_heights: Vec<Range<usize>>,
    /// Moves in the machine's own coordinates.
    pub machine_moves: Vec<MachineMove>,
    /// Lines that run where a switch at the machine decides, and that the moves leave out.
    pub optional_lines: Vec<u32>,
    /// Modal codes that the first move relies on and that the text does not state.
    pub not_stated: Vec<&'static str>,
    /// Moves made while another plane than G17 was in force and no arc used it, in runs.
    pub planes_not_needed: Vec<Range<usize>>,
    /// Where the clamp frame is to stand, in order; none where the path carries it ([`Support::DieAndFrame`]).
    pub frame_levels: Vec<FrameLevel>,
    /// Moves before which the program stops (M0, M1).
    pub stops: Vec<usize>,
    /// Its lines.
    pub lines: u32,
    /// Whether the text came to its end mark.
    pub ended: bool,
    /// What calls of tools do on the machine.
    pub tool_calls: ToolCalls,
}

/// What a text's calls of tools do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToolCalls {
    /// The machine loads the tool.
    Load,
    /// They name which tool the operator has loaded.
    #[default]
    Name,
    /// There is no word for them.
    NotStated,
}

/// What is allowed. Comparisons allow another 1e-6 mm for arithmetic.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Depth below the surface that is still no gouge, mm.
    pub gouge: f64,
    /// Distance from the surface at which a contact move still touches, mm; `None` when the program
    /// is not meant to touch the part (collisions only).
    pub excess: Option<f64>,
    /// The same for single operations, by index of the program's operations; those beyond the list
    /// take `excess`.
    pub excess_by_operation: Vec<Option<f64>>,
    /// The machine's last digit, mm.
    pub unit: f64,
    /// Height Z at and above which rapids may travel sideways, work coordinates, mm.
    pub clearance: f64,
    /// Air that must be left under a rapid that comes down, mm.
    pub rapid_gap: f64,
    /// Whether all axes of a rapid arrive together: what is beside its line is not passed.
    pub straight_rapids: bool,
    /// Height Z below which rapids do not go, mm; minus infinity where only the air under them counts.
    pub retract: f64,
    /// By half of what a feed may differ from the one that the job states: it was rounded, and perhaps twice.
    pub feed_rounding: FeedRounding,
    /// What the machine can do.
    pub reach: Reach,
    /// What the sheet withstands, where one is formed.
    pub forming: Option<Forming>,
    /// Most that may be left on the faces where the tool cannot get, mm.
    pub bridged: f64,
    /// Share of the faces on which more than `unreached_from` may be left where the tool cannot get.
    pub unreached: f64,
    /// What is left of a face that is not reached, mm, at least.
    pub unreached_from: f64,
    /// Kinds of findings that are no errors: the job takes these risks by name.
    pub accepted: Vec<FindingKind>,
    /// Whether only its shape is checked: it is a part of a text, and all else is checked with the whole.
    pub shape_only: bool,
    /// What was found before the program was looked at.
    pub found: Vec<Found>,
}

/// What was found with the job alone: its kind, how bad it is, and its sentence.
pub type Found = (FindingKind, Severity, String);

/// What the machine can do; what is left out is not checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reach {
    /// Lowest and highest position of each axis, of the point that the text moves, mm.
    pub axes: [Option<[f64; 2]>; 3],
    /// Length of each axis, mm.
    pub travel: Option<[f64; 3]>,
    /// Largest feed, mm/min.
    pub feed: Option<f64>,
    /// Smallest and largest speed of the spindle, rev/min.
    pub rpm: Option<[f64; 2]>,
    /// How fast it may turn.
    pub cornering: Option<Cornering>,
}

impl Subject<'_> {
    /// An operation's tool as a body, with its sheet and the stock around it that it is to leave.
    pub(crate) fn touching(&self, operation: &ExpectedOperation) -> Option<Body> {
        let tool = self.tools.get(operation.tool)?;
        Some(Body::leaving(tool, self.sheet.as_ref(), operation.expectation.to_leave))
    }

    /// Whether a move's end is known.
    pub(crate) fn is_known(&self, index: usize) -> bool {
        run_of(self.unknown_positions, index).is_none()
    }
}

/// The one of the ascending runs that holds an index.
pub(crate) fn run_of(runs: &[Range<usize>], index: usize) -> Option<&Range<usize>> {
    runs.get(runs.partition_point(|run| run.end <= index)).filter(|run| run.contains(&index))
}

impl Limits {
    /// The usual strictness: gouge 0.001 mm, excess 0.005 mm, 0.05 mm under a rapid.
    #[must_use]
    pub fn new(clearance: f64) -> Self {
        Self {
            gouge: 0.001,
            excess: Some(0.005),
            excess_by_operation: Vec::new(),
            unit: 0.001,
            clearance,
            rapid_gap: 0.05,
            straight_rapids: false,
            retract: f64::NEG_INFINITY,
            feed_rounding: FeedRounding::default(),
            reach: Reach::default(),
            forming: None,
            bridged: f64::INFINITY,
            unreached: 1.0,
            unreached_from: f64::INFINITY,
            accepted: Vec::new(),
            shape_only: false,
            found: Vec::new(),
        }
    }

    /// By how much the feed (mm/min) of a move of some length (mm) may differ from the one stated, mm/min.
    pub(crate) fn feed_slack(&self, feed: f64, length: f64) -> f64 {
        2.0 * self.feed_rounding.of(feed, length)
    }

    /// The excess allowed for an operation, mm.
    #[must_use]
    pub fn excess_of(&self, operation: u32) -> Option<f64> {
        self.excess_by_operation.get(operation as usize).copied().unwrap_or(self.excess)
    }
}

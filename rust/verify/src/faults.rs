//! Faults that moves show: each kind with its unit and its words, by subject.
//!
//! A new kind is one constant here and one variant of [`FindingKind`].

mod drilled;
mod edges;
mod stock;
mod tabs;

use styluscam_motion::Move;

use crate::findings::{FindingKind, Severity};

pub(crate) use drilled::*;
pub(crate) use edges::*;
pub(crate) use stock::*;
pub(crate) use tabs::*;

/// A kind of fault, and how it is reported.
#[derive(Debug)]
pub(crate) struct FaultKind {
    pub finding: FindingKind,
    /// The unit of what is measured.
    pub unit: &'static str,
    /// Whether it belongs to a position on the part, and not to a word of the text.
    pub is_on_part: bool,
    /// What is wrong, without where.
    what: fn(&Fault) -> String,
    /// What to do.
    pub remedy: &'static str,
}

/// A fault that one move shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fault {
    pub kind: &'static FaultKind,
    pub severity: Severity,
    /// Index of the move.
    pub index: usize,
    pub line: u32,
    pub position: [f64; 3],
    /// Measured value and limit, in the kind's unit.
    pub measure: Option<(f64, f64)>,
    /// How bad it is here, for comparison with others of its kind, in the kind's unit.
    pub weight: f64,
}

impl Fault {
    /// An error of which nothing is measured.
    pub fn new(kind: &'static FaultKind, index: usize, line: u32, position: [f64; 3]) -> Self {
        Self { kind, severity: Severity::Error, index, line, position, measure: None, weight: 0.0 }
    }

    /// An error at the end of a move.
    pub fn of(kind: &'static FaultKind, index: usize, step: &Move) -> Self {
        Self::new(kind, index, step.line, step.end.tip)
    }

    /// With what was measured and what is allowed; it weighs what lies between them.
    pub fn measured(self, value: f64, limit: f64) -> Self {
        Self { measure: Some((value, limit)), weight: (value - limit).abs().max(0.0), ..self }
    }

    /// The same as a warning.
    pub fn warning(self) -> Self {
        Self { severity: Severity::Warning, ..self }
    }

    /// What is wrong, without where.
    pub fn what(&self) -> String {
        (self.kind.what)(self)
    }

    fn value(&self) -> f64 {
        self.measure.map_or(0.0, |(value, _)| value)
    }

    fn limit(&self) -> f64 {
        self.measure.map_or(0.0, |(_, limit)| limit)
    }
}

impl FaultKind {
    /// On the part; lengths are measured.
    const fn on_part(finding: FindingKind, what: fn(&Fault) -> String, remedy: &'static str) -> Self {
        Self { finding, unit: "mm", is_on_part: true, what, remedy }
    }

    /// In the text; lengths are measured, if anything.
    const fn in_text(finding: FindingKind, what: fn(&Fault) -> String, remedy: &'static str) -> Self {
        Self { finding, unit: "mm", is_on_part: false, what, remedy }
    }

    const fn in_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }
}

// entries and collisions

pub(crate) static GOUGE: FaultKind = FaultKind::on_part(
    FindingKind::Gouge,
    |fault| format!("the tool enters the part by {:.4} mm (limit {:.4} mm)", fault.value(), fault.limit()),
    "correct the coordinate where it begins, or plan again with this tool, sheet and zero point",
);
pub(crate) static FLANK_ENTERS: FaultKind = FaultKind::on_part(
    FindingKind::Gouge,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the moving tool enters the ruled surface by {value:.4} mm (max_error allows {limit:.4} mm)")
    },
    "take a smaller tool, part the surface where it is twisted most, or raise max_error",
);
pub(crate) static FLANK_LEAVES: FaultKind = FaultKind::on_part(
    FindingKind::Excess,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the moving tool leaves {value:.4} mm on the ruled surface (max_error allows {limit:.4} mm)")
    },
    "take a smaller tool, part the surface where it is twisted most, or raise max_error",
);
pub(crate) static FLANK_MISSES: FaultKind = FaultKind::on_part(
    FindingKind::MissingPass,
    |fault| format!("the tool does not come over {:.2} % of the ruled surface", fault.value()),
    "raise extension and overreach, or take a longer tool",
)
.in_unit("%");
pub(crate) static AXIS_JUMP: FaultKind = FaultKind::on_part(
    FindingKind::AxisJump,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the tool's axis turns by {value:.2} degrees for each mm, more than five times the mean ({limit:.2})")
    },
    "plan again, or part the surface there",
)
.in_unit("deg/mm");
pub(crate) static SHANK: FaultKind = FaultKind::on_part(
    FindingKind::ShankCollision,
    |fault| format!("the shank enters the part by {:.4} mm", fault.value()),
    "use a tool with a longer base, or a thinner shank",
);
pub(crate) static HOLDER: FaultKind = FaultKind::on_part(
    FindingKind::HolderCollision,
    |fault| format!("the holder enters the part by {:.4} mm", fault.value()),
    "let the tool stick out farther, or use a smaller holder",
);
pub(crate) static CLAMP: FaultKind = FaultKind::on_part(
    FindingKind::ClampCollision,
    |fault| near("the tool", "the clamp frame", fault),
    "use a wider frame or a lower one, or a longer tool",
);
pub(crate) static BACKING: FaultKind = FaultKind::on_part(
    FindingKind::BackingCollision,
    |fault| near("the sheet under the tool", "the backing plate", fault),
    "use a plate with a wider opening, or move the part in it",
);
pub(crate) static CHECK_CLEARANCE: FaultKind = FaultKind::on_part(
    FindingKind::CheckClearance,
    |fault| near("the tool", "the operation's check faces", fault),
    "plan again, or lower check_clearance, or take the faces out of check_faces",
);
pub(crate) static OUTSIDE_BOUNDARY: FaultKind = FaultKind::on_part(
    FindingKind::OutsideBoundary,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!(
            "the tool works {value:.3} mm outside the operation's boundary (up to {limit:.3} mm is within tolerance)"
        )
    },
    "plan again, or widen the operation's boundary",
);
pub(crate) static OFF_SLOPE: FaultKind = FaultKind::on_part(
    FindingKind::OutsideBoundary,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the tool touches {value:.2} degrees off the slopes of boundary.slope_deg ({limit:.2} are within tolerance)")
    },
    "plan again, or widen slope_deg",
)
.in_unit("deg");
pub(crate) static UNSELECTED_CONTACT: FaultKind = FaultKind::on_part(
    FindingKind::UnselectedContact,
    |fault| format!("the tool works on faces that are not selected: {:.3} mm from those that are", fault.value()),
    "plan again, or select those faces",
);

// two tools

pub(crate) static TOOL_COLLISION: FaultKind = FaultKind::on_part(
    FindingKind::ToolCollision,
    |fault| {
        format!("this tool and the one on the other side of the sheet meet: {:.3} mm into each other", -fault.value())
    },
    "use longer tools or thinner shanks, or plan both programs again",
);
pub(crate) static SQUEEZE: FaultKind = FaultKind::on_part(
    FindingKind::Squeeze,
    |fault| {
        format!(
            "the two tools leave {:.4} mm less for the sheet than asked (limit {:.4} mm)",
            -fault.value(),
            -fault.limit()
        )
    },
    "check process.squeeze, both zero points and both tools, or plan both programs again",
);
pub(crate) static UNSUPPORTED: FaultKind = FaultKind::on_part(
    FindingKind::Unsupported,
    |fault| {
        format!(
            "the two tools leave {:.4} mm more than the sheet between them (limit {:.4} mm)",
            fault.value(),
            fault.limit()
        )
    },
    "check process.squeeze, both zero points and both tools, or plan both programs again",
);
pub(crate) static OUT_OF_STEP: FaultKind = FaultKind::in_text(
    FindingKind::OutOfStep,
    |fault| {
        format!(
            "by this move the two programs are {:.3} mm of path apart (limit {:.3} mm)",
            fault.value(),
            fault.limit()
        )
    },
    "correct F, or plan both programs again",
);
pub(crate) static OTHER_KIND: FaultKind = FaultKind::in_text(
    FindingKind::OutOfStep,
    |_| "one program has a rapid here and the other a feed: how long they take is not the same".to_owned(),
    "plan both programs again",
);
pub(crate) static OTHER_WAIT: FaultKind = FaultKind::in_text(
    FindingKind::OutOfStep,
    |_| "one program waits here and the other does not".to_owned(),
    "plan both programs again",
);

// rapids

pub(crate) static RAPID_INTO_MATERIAL: FaultKind = FaultKind::on_part(
    FindingKind::RapidIntoMaterial,
    |fault| format!("a rapid enters the part by {:.4} mm", fault.value()),
    "retract first, and come down at a feed",
);
pub(crate) static RAPID_PLUNGE: FaultKind = FaultKind::on_part(
    FindingKind::RapidPlunge,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        if value < 0.0 {
            format!("a rapid goes straight down into the part by {:.4} mm", -value)
        } else {
            format!("a rapid comes down to {value:.4} mm from the part (at least {limit:.4} mm)")
        }
    },
    "retract first, and come down at a feed",
);
pub(crate) static DOG_LEG_RAPID: FaultKind = FaultKind::in_text(
    FindingKind::DogLegRapid,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("a rapid goes sideways and down at once to Z{value:.3}, below the clearance height {limit:.3}")
    },
    "go across above the clearance height, then straight down",
);
pub(crate) static LOW_RAPID: FaultKind = FaultKind::in_text(
    FindingKind::LowRapid,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("a rapid goes sideways at Z{value:.3}, below the clearance height {limit:.3}")
    },
    "retract to the clearance height first",
);
pub(crate) static RAPID_NEAR_PART: FaultKind = FaultKind::on_part(
    FindingKind::LowRapid,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("a rapid below clearance, at Z{value:.3}, is less than {limit:.3} mm above the part")
    },
    "raise the link, or retract to the clearance height",
);
pub(crate) static RAPID_NEAR_STOCK: FaultKind = FaultKind::on_part(
    FindingKind::LowRapid,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("a rapid below clearance goes to Z{value:.3}, and stock may stand up to Z{limit:.3}")
    },
    "raise the link, or retract to the clearance height",
);
pub(crate) static RAPID_NEAR_SHEET: FaultKind = FaultKind::on_part(
    FindingKind::LowRapid,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!(
            "a rapid below clearance goes at Z{value:.3}, and the sheet, not formed there yet, stands at Z{limit:.3}"
        )
    },
    "raise the link, or retract to the clearance height",
);
pub(crate) static DEEP_RAPID: FaultKind = FaultKind::in_text(
    FindingKind::DeepRapid,
    |fault| format!("a rapid goes down to Z{:.3}, below the retract height {:.3}", fault.value(), fault.limit()),
    "come down at a feed from there",
);

// contact and passes

pub(crate) static EXCESS: FaultKind = FaultKind::on_part(
    FindingKind::Excess,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the tool is {value:.4} mm off the part where it should touch (limit {limit:.4} mm)")
    },
    "correct this coordinate, or plan again with this tool, sheet and zero point",
);
pub(crate) static MISSING_PASS: FaultKind = FaultKind::on_part(
    FindingKind::MissingPass,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("{value:.3} mm are left beside this move where the tool could touch (passes at the job's distance leave {limit:.3})")
    },
    "post the whole operation, with the job's heights and steps; where nothing is missing, the wall is too gentle for this step: \
     take a smaller one, or step.scallop",
);
pub(crate) static NO_LEVEL_BELOW: FaultKind =
    FaultKind::on_part(FindingKind::MissingLevel, |fault| no_level("below", fault), REPOST);
pub(crate) static NO_LEVEL_ABOVE: FaultKind =
    FaultKind::on_part(FindingKind::MissingLevel, |fault| no_level("above", fault), REPOST);
pub(crate) static NO_ROW: FaultKind = FaultKind::on_part(
    FindingKind::MissingRow,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!(
            "{value:.3} mm without a row beside this one (expected every {limit:.3} mm), where the tool could touch"
        )
    },
    REPOST,
);
pub(crate) static SCALLOP: FaultKind = FaultKind::on_part(
    FindingKind::Scallop,
    |fault| format!("passes leave a scallop of {:.4} mm where {:.4} mm is asked for", fault.value(), fault.limit()),
    "plan again: a pass is missing, or passes lie too far apart",
);
pub(crate) static CORNER: FaultKind = FaultKind::on_part(
    FindingKind::Corner,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the path turns by {value:.2} degrees at once, and max_corner_deg is {limit:.2}")
    },
    "an edge of the part, or a straight link: the machine slows down there; round the edge, set turns = \"rounded\", or raise \
     max_corner_deg",
)
.in_unit("deg");
const REPOST: &str = "post the whole operation, with the job's heights and steps";

// forming

pub(crate) static WALL_ANGLE: FaultKind = FaultKind::on_part(
    FindingKind::WallAngle,
    |fault| format!("the wall is at {:.1} degrees, and the sheet allows {:.1}", fault.value(), fault.limit()),
    SHALLOWER,
)
.in_unit("deg");
pub(crate) static THINNING: FaultKind = FaultKind::on_part(
    FindingKind::Thinning,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the sheet becomes {value:.3} mm thin by the sine law (at least {limit:.3} mm)")
    },
    SHALLOWER,
);
const SHALLOWER: &str = "turn the part so that its walls share the angle, or form in stages";
pub(crate) static PUNCH: FaultKind = FaultKind::on_part(
    FindingKind::Punch,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the tool goes down to Z{value:.3}, and the sheet stands at Z{limit:.3} there: it punches through")
    },
    "form level by level from the top down, and finish with rows after that; or state max_increment for rows in layers; or \
     accept = [\"punch\"]",
);
pub(crate) static INCREMENT: FaultKind = FaultKind::on_part(
    FindingKind::Increment,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("this pass presses the sheet {value:.3} mm down at once, and max_increment is {limit:.3} mm")
    },
    "post the whole operation: a layer is missing or too deep; or raise max_increment",
);
pub(crate) static FORMING_ORDER: FaultKind = FaultKind::in_text(
    FindingKind::FormingOrder,
    |fault| format!("the level Z{:.3} is formed after Z{:.3}, which is lower", fault.value(), fault.limit()),
    "form from the top down",
);

pub(crate) static FRAME_BELOW: FaultKind = FaultKind::in_text(
    FindingKind::ClampLevel,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the clamp frame stands at Z{value:.3}, below the loop at Z{limit:.3}: it pulls the sheet over the die")
    },
    "form from the top down, and lower the frame to each level once the tool is there",
);
pub(crate) static FRAME_ABOVE: FaultKind = FaultKind::in_text(
    FindingKind::ClampLevel,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the clamp frame stands at Z{value:.3}, more than a step above the loop at Z{limit:.3}: it holds the sheet back")
    },
    "lower the frame to each level once the tool is there",
);

// start, end and unknown positions

pub(crate) static UNSAFE_START: FaultKind = FaultKind::in_text(
    FindingKind::UnsafeStart,
    |fault| match fault.value() {
        height if height.is_nan() => "the first move goes across at a height that is not known".to_owned(),
        height => {
            let limit = fault.limit();
            format!("the program starts by going across at Z{height:.3}, below the clearance height {limit:.3}")
        }
    },
    GO_UP,
);
pub(crate) static UNKNOWN_POSITION: FaultKind = FaultKind::in_text(
    FindingKind::UnknownPlace,
    |fault| match fault.value() {
        height if height.is_nan() => "a rapid goes across where the tool's height is not known".to_owned(),
        height => {
            let limit = fault.limit();
            format!("a rapid goes to Z{height:.3}, below the clearance height {limit:.3}, from a position that is not known")
        }
    },
    GO_UP,
);
const GO_UP: &str = "go up to the clearance height in a block of its own first";
pub(crate) static MACHINE_POSITION: FaultKind = FaultKind::in_text(
    FindingKind::MachinePlace,
    |fault| match fault.value() {
        height if height.is_nan() => {
            "a move in machine coordinates (G53) goes across while the tool is not known to be up".to_owned()
        }
        height => {
            format!("a move goes to Z{height:.3} of the machine (G53), and its height in work coordinates is not known")
        }
    },
    "go to the machine's top only (G53 G0 Z0), and across from there",
);
pub(crate) static UNSAFE_END: FaultKind = FaultKind::in_text(
    FindingKind::UnsafeEnd,
    |fault| format!("the tool is left at Z{:.3}, below the clearance height {:.3}", fault.value(), fault.limit()),
    "go up to the clearance height first",
);
pub(crate) static NO_END: FaultKind = FaultKind::in_text(
    FindingKind::NoEnd,
    |_| "the text ends without M2 or M30".to_owned(),
    "the file may be cut off: get the whole file, or write M2",
);
pub(crate) static STOP_BELOW: FaultKind = FaultKind::in_text(
    FindingKind::StopBelow,
    |_| "the program stops (M0, M1) while the tool is down".to_owned(),
    "stop above the clearance height",
);
pub(crate) static DWELL: FaultKind = FaultKind::in_text(
    FindingKind::Dwell,
    |fault| format!("the program waits {} s while the tool is down", plain(fault.value())),
    "remove the wait, or wait above the part",
)
.in_unit("s");

// words of the text

pub(crate) static MISSING_FEED: FaultKind = FaultKind::in_text(
    FindingKind::MissingFeed,
    |_| "a feed move has no feed".to_owned(),
    "give F before the first feed move",
);
pub(crate) static UNPLACED_FEED: FaultKind = FaultKind::in_text(
    FindingKind::UnplacedFeed,
    |_| "a feed move starts where not all axes are known".to_owned(),
    "give X, Y and Z in rapids first",
);
pub(crate) static MISSING_TOOL_CHANGE: FaultKind = FaultKind::in_text(
    FindingKind::MissingToolChange,
    |_| "a feed move comes before any tool change".to_owned(),
    "load the tool and its length before the first feed move",
);
pub(crate) static UNKNOWN_TOOL: FaultKind = FaultKind::in_text(
    FindingKind::UnknownTool,
    |_| "the tool loaded here is not one of the job's".to_owned(),
    "add the tool to the job, or correct the T word",
);
pub(crate) static PLANE_NOT_NEEDED: FaultKind = FaultKind::in_text(
    FindingKind::WorkPlane,
    |_| "moves are made in G18 or G19, and no arc needs that plane".to_owned(),
    "write G17",
);
pub(crate) static NOT_FINITE: FaultKind = FaultKind::in_text(
    FindingKind::NotFinite,
    |_| "a coordinate is not a number, or lies beyond +/-1e7 mm".to_owned(),
    "correct the coordinate",
);
pub(crate) static TOOL_AXIS: FaultKind = FaultKind::in_text(
    FindingKind::ToolAxis,
    |_| "the tool axis is not +Z, and the job has no operation here whose tool leans".to_owned(),
    "write the move for an upright tool, or name the operation that it belongs to",
);
pub(crate) static FEED_MODE: FaultKind = FaultKind::in_text(
    FindingKind::FeedMode,
    |_| "the feed is not in mm/min, and no other is checked".to_owned(),
    "write the feed in mm/min (G94)",
);

// settings that the job states

pub(crate) static FEED: FaultKind = FaultKind::in_text(
    FindingKind::FeedDiffers,
    |fault| format!("the feed is {} mm/min, and {} in the job", plain(fault.value()), plain(fault.limit())),
    "correct F, or the job",
)
.in_unit("mm/min");
pub(crate) static SPINDLE: FaultKind = FaultKind::in_text(
    FindingKind::SpindleDiffers,
    |fault| format!("the spindle {}, and in the job it {}", spindle(fault.value()), spindle(fault.limit())),
    "correct M3, M4, M5 and S, or the job",
)
.in_unit("rev/min");
pub(crate) static COOLANT: FaultKind = FaultKind::in_text(
    FindingKind::CoolantDiffers,
    |_| "coolant is not as the job states".to_owned(),
    "correct M7, M8 and M9, or the job",
);
pub(crate) static TOOL: FaultKind = FaultKind::in_text(
    FindingKind::ToolDiffers,
    |_| "the tool is not the operation's".to_owned(),
    "correct T, or the job",
);

// the machine's limits

/// By axis.
pub(crate) static AXES: [FaultKind; 3] = [
    FaultKind::in_text(FindingKind::XLimit, |fault| beyond('X', fault), MOVE_IN),
    FaultKind::in_text(FindingKind::YLimit, |fault| beyond('Y', fault), MOVE_IN),
    FaultKind::in_text(FindingKind::ZLimit, |fault| beyond('Z', fault), MOVE_IN),
];
const MOVE_IN: &str = "move the zero point, or turn the part";
pub(crate) static FEED_LIMIT: FaultKind = FaultKind::in_text(
    FindingKind::FeedLimit,
    |fault| format!("the feed is {} mm/min, and the machine's largest {}", plain(fault.value()), plain(fault.limit())),
    "correct F",
)
.in_unit("mm/min");
pub(crate) static CORNER_FEED: FaultKind =
    FaultKind::in_text(FindingKind::CornerFeed, |fault| too_fast("at a sharp turn", fault), SLOW_DOWN)
        .in_unit("mm/min");
pub(crate) static ARC_FEED: FaultKind =
    FaultKind::in_text(FindingKind::CornerFeed, |fault| too_fast("on an arc", fault), SLOW_DOWN).in_unit("mm/min");
const SLOW_DOWN: &str = "lower F there, or set slow_corners = false";

fn too_fast(position: &str, fault: &Fault) -> String {
    let (feed, most) = (plain(fault.value()), plain(fault.limit()));
    format!("the feed is {feed} mm/min {position}, where the machine's acceleration allows {most}")
}

fn no_level(side: &str, fault: &Fault) -> String {
    let (value, limit, height) = (fault.value(), fault.limit(), fault.position[2]);
    format!("{value:.3} mm without a level {side} Z{height:.3} (step {limit:.3}), where the tool could touch")
}

/// What comes too near to something, or into it.
fn near(what: &str, other: &str, fault: &Fault) -> String {
    let (value, limit) = (fault.value(), fault.limit());
    if value < 0.0 {
        format!("{what} enters {other} by {:.3} mm", -value)
    } else {
        format!("{what} comes to {value:.3} mm from {other} (at least {limit:.3} mm)")
    }
}

fn beyond(axis: char, fault: &Fault) -> String {
    format!("{axis} goes to {:.3}, beyond the machine's {:.3}", fault.value(), fault.limit())
}

/// A number without needless digits.
fn plain(value: f64) -> String {
    format!("{}", (value * 1e3).round() / 1e3)
}

/// What a spindle does at a signed speed.
fn spindle(rpm: f64) -> String {
    match rpm {
        0.0 => "stands".to_owned(),
        rpm if rpm > 0.0 => format!("turns clockwise (M3) at {} rev/min", plain(rpm)),
        rpm => format!("turns counterclockwise (M4) at {} rev/min", plain(-rpm)),
    }
}

//! What is wrong: the kinds of findings, and one finding.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is wrong. In the order in which a report lists them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FindingKind {
    /// No feed move at all.
    NoFeedMoves,
    /// Not one contact move touches the part: zero, units or tool reference are wrong.
    NoContact,
    /// The program runs in another work offset than the one in which the part stands.
    WorkOffset,
    /// A feed move enters the part.
    Gouge,
    /// The shank, or what joins it to the profile, enters the part.
    ShankCollision,
    /// The holder enters the part.
    HolderCollision,
    /// The tool, its shank or its holder comes too near to the clamp frame.
    ClampCollision,
    /// The sheet is pressed against the backing plate.
    BackingCollision,
    /// The tool, its shank or its holder comes nearer to an operation's check faces than their clearance.
    CheckClearance,
    /// The tools on both sides of the sheet meet.
    ToolCollision,
    /// Two programs that run together have different numbers of moves.
    BlockCount,
    /// Two programs that run together do not stay together: a move of the one takes longer than that of the other.
    OutOfStep,
    /// The tools on both sides squeeze the sheet by more than asked.
    Squeeze,
    /// The tool on the other side of the sheet is not opposite to the main tool's contact.
    Unsupported,
    /// A rapid enters the part.
    RapidIntoMaterial,
    /// A rapid straight down enters the part, or ends with too little air under it.
    RapidPlunge,
    /// A rapid goes sideways and down at once below the clearance height: its path is not defined.
    DogLegRapid,
    /// A rapid goes sideways below the clearance height.
    LowRapid,
    /// A contact move does not touch.
    Excess,
    /// A contact lies outside the operation's boundary, or on a slope that it does not ask for.
    OutsideBoundary,
    /// A contact lies on no face that the operation is for.
    UnselectedContact,
    /// A position that the tool could touch is left, and the distance between passes does not explain it.
    MissingPass,
    /// Tabs that are to hold the part are missing, cut, or not as they should be.
    Tabs,
    /// Levels are farther apart than expected, or end too soon.
    MissingLevel,
    /// Rows are farther apart than expected, or end too soon.
    MissingRow,
    /// A hole is not drilled down to its depth.
    MissingHole,
    /// A drill goes down where no hole is, or deeper than one is.
    ExtraHole,
    /// A drill goes deeper at once than a peck.
    Peck,
    /// The tool goes along the material in climb milling and not in conventional milling, or the other way round.
    CutDirection,
    /// A tool that clears stock engages more of it at once than it may.
    Engagement,
    /// Stock is left that the tool reaches.
    Uncleared,
    /// Stock is cut that is to be left on the part.
    StockToLeave,
    /// More stock is removed in a minute than on a full pass at its feed.
    RemovalRate,
    /// The tool goes down into stock more steeply than asked.
    SteepEntry,
    /// A rapid enters stock that is not cleared.
    RapidIntoStock,
    /// Stock stands above the height at which an operation begins.
    StockAbove,
    /// Neighbouring passes leave a higher scallop than is asked for.
    Scallop,
    /// The path turns by more at once than is asked for.
    Corner,
    /// The axis of a tool that leans turns far where it mostly turns little.
    AxisJump,
    /// A wall is steeper than the sheet allows.
    WallAngle,
    /// The sheet becomes thinner than it may.
    Thinning,
    /// The tool is more curved than the sheet withstands.
    ToolRadius,
    /// The faces that are formed are larger than the clamp frame's opening.
    ClampOpening,
    /// Forming takes a larger force along the spindle than the machine withstands.
    AxialForce,
    /// The tool goes deeper than a step below all that is formed so far.
    Punch,
    /// A pass presses the sheet farther down than `max_increment`.
    Increment,
    /// The tool bridges faces by more than it may: it is less curved than they are.
    Bridged,
    /// The tool reaches less of the faces than it should.
    Unreached,
    /// The model is thicker or thinner than the sheet.
    SheetThickness,
    /// The model shows another face of the sheet than the job states.
    SheetFace,
    /// A solid is to be formed from a sheet.
    SolidFormed,
    /// The model's flange does not lie where the sheet is clamped.
    FlangeHeight,
    /// A level is formed after a lower one at the same position.
    FormingOrder,
    /// The clamp frame stands lower than the loop that is formed, or more than a step higher.
    ClampLevel,
    /// A rapid goes down below the height at which the job wants plunges to begin.
    DeepRapid,
    /// The program stops while the tool is below the clearance height.
    StopBelow,
    /// A feed move without a feed.
    MissingFeed,
    /// A feed move whose start is not known in all axes.
    UnplacedFeed,
    /// A feed move before any tool change.
    MissingToolChange,
    /// A tool change to a tool that the job does not have.
    UnknownTool,
    /// An operation of the job is not in the text.
    MissingOperation,
    /// The text has an operation that the job does not have.
    UnknownOperation,
    /// An operation comes after one that the job has behind it.
    OperationOrder,
    /// The program begins with a move across before it has gone up, or goes across below the clearance height.
    UnsafeStart,
    /// The program ends, or changes the tool, below the clearance height.
    UnsafeEnd,
    /// A move goes across, or down, where it is not known at which height, or where, the tool is.
    UnknownPlace,
    /// A move in the machine's own coordinates that is not one to its top: its path is not known.
    MachinePlace,
    /// The text does not state a mode that its moves rely on.
    UnsaidMode,
    /// Lines run or do not, as a switch at the machine stands.
    OptionalLines,
    /// The text names none of several operations: nothing can be compared with what the job states.
    UnnamedOperations,
    /// The text has no end mark.
    NoEnd,
    /// A feed is not the one that the job states.
    FeedDiffers,
    /// The spindle does not do what the job states.
    SpindleDiffers,
    /// Coolant flows and should not, or should and does not.
    CoolantDiffers,
    /// Another tool than the operation's.
    ToolDiffers,
    /// A wait while the tool is below the clearance height.
    Dwell,
    /// Moves in another plane than G17, and no arc that is for it.
    WorkPlane,
    /// A position beyond the machine's X.
    XLimit,
    /// A position beyond the machine's Y.
    YLimit,
    /// A position beyond the machine's Z.
    ZLimit,
    /// The program needs more travel than the machine has.
    Travel,
    /// A feed above the machine's largest.
    FeedLimit,
    /// A feed above what the machine's acceleration allows at a turn, or on an arc.
    CornerFeed,
    /// A spindle speed that the machine does not have.
    SpindleLimit,
    /// A coordinate that is not a number, or absurd (beyond 10 km).
    NotFinite,
    /// A move whose tool axis is not +Z: distances are those of an upright tool, so it is not checked.
    ToolAxis,
    /// A feed that is not in mm/min, which cannot be compared with the job's or the machine's.
    FeedMode,
    /// Something that the verifier does not check, and why.
    NotChecked,
}

/// Every kind with its words, in the order of [`FindingKind`].
const KINDS: [(FindingKind, &str); FindingKind::NotChecked as usize + 1] = {
    use FindingKind as Kind;
    [
        (Kind::NoFeedMoves, "no feed moves"),
        (Kind::NoContact, "no contact with the part"),
        (Kind::WorkOffset, "wrong work offset"),
        (Kind::Gouge, "gouge"),
        (Kind::ShankCollision, "shank collision"),
        (Kind::HolderCollision, "holder collision"),
        (Kind::ClampCollision, "clamp frame collision"),
        (Kind::BackingCollision, "backing plate collision"),
        (Kind::CheckClearance, "too near to check faces"),
        (Kind::ToolCollision, "collision of both tools"),
        (Kind::BlockCount, "different numbers of moves"),
        (Kind::OutOfStep, "programs out of step"),
        (Kind::Squeeze, "sheet squeezed too much"),
        (Kind::Unsupported, "no support opposite"),
        (Kind::RapidIntoMaterial, "rapid into the part"),
        (Kind::RapidPlunge, "rapid plunge"),
        (Kind::DogLegRapid, "diagonal rapid below the clearance height"),
        (Kind::LowRapid, "rapid across below the clearance height"),
        (Kind::Excess, "excess"),
        (Kind::OutsideBoundary, "contact outside the boundary"),
        (Kind::UnselectedContact, "contact on faces that are not selected"),
        (Kind::MissingPass, "missing pass"),
        (Kind::Tabs, "tabs not as stated"),
        (Kind::MissingLevel, "missing level"),
        (Kind::MissingRow, "missing row"),
        (Kind::MissingHole, "missing hole"),
        (Kind::ExtraHole, "drilled where no hole is"),
        (Kind::Peck, "peck deeper than asked"),
        (Kind::CutDirection, "climb and conventional milling exchanged"),
        (Kind::Engagement, "engagement angle too large"),
        (Kind::Uncleared, "stock not cleared"),
        (Kind::StockToLeave, "stock cut that is to be left"),
        (Kind::RemovalRate, "removal rate above the reference"),
        (Kind::SteepEntry, "entry into stock too steep"),
        (Kind::RapidIntoStock, "rapid into stock"),
        (Kind::StockAbove, "stock above the operation"),
        (Kind::Scallop, "scallop above the limit"),
        (Kind::Corner, "corner of the path"),
        (Kind::AxisJump, "jump of the tool axis"),
        (Kind::WallAngle, "wall angle above the limit"),
        (Kind::Thinning, "thinning below the limit"),
        (Kind::ToolRadius, "tool radius below twice the sheet thickness"),
        (Kind::ClampOpening, "part larger than the clamp frame"),
        (Kind::AxialForce, "axial force above the limit"),
        (Kind::Punch, "punch through the sheet"),
        (Kind::Increment, "increment into the sheet"),
        (Kind::Bridged, "bridged faces"),
        (Kind::Unreached, "unreached faces"),
        (Kind::SheetThickness, "sheet thickness differs from the model"),
        (Kind::SheetFace, "face of the sheet differs from the model"),
        (Kind::SolidFormed, "solid instead of a sheet"),
        (Kind::FlangeHeight, "flange height differs from the clamping height"),
        (Kind::FormingOrder, "forming order"),
        (Kind::ClampLevel, "height of the clamp frame"),
        (Kind::DeepRapid, "rapid below the retract height"),
        (Kind::StopBelow, "stop below the clearance height"),
        (Kind::MissingFeed, "feed not stated"),
        (Kind::UnplacedFeed, "feed move from an unknown position"),
        (Kind::MissingToolChange, "tool change missing"),
        (Kind::UnknownTool, "tool not in the job"),
        (Kind::MissingOperation, "missing operation"),
        (Kind::UnknownOperation, "unknown operation"),
        (Kind::OperationOrder, "order of operations"),
        (Kind::UnsafeStart, "unsafe start"),
        (Kind::UnsafeEnd, "unsafe end"),
        (Kind::UnknownPlace, "rapid from an unknown position"),
        (Kind::MachinePlace, "unsafe move in machine coordinates"),
        (Kind::UnsaidMode, "modal code not stated"),
        (Kind::OptionalLines, "optional lines"),
        (Kind::UnnamedOperations, "operations not named"),
        (Kind::NoEnd, "program end missing"),
        (Kind::FeedDiffers, "feed differs from the job"),
        (Kind::SpindleDiffers, "spindle differs from the job"),
        (Kind::CoolantDiffers, "coolant differs from the job"),
        (Kind::ToolDiffers, "tool differs from the job"),
        (Kind::Dwell, "dwell below the clearance height"),
        (Kind::WorkPlane, "working plane is not G17"),
        (Kind::XLimit, "position beyond the X limit"),
        (Kind::YLimit, "position beyond the Y limit"),
        (Kind::ZLimit, "position beyond the Z limit"),
        (Kind::Travel, "travel longer than the machine's"),
        (Kind::FeedLimit, "feed above the machine's limit"),
        (Kind::CornerFeed, "feed too high at a turn"),
        (Kind::SpindleLimit, "spindle speed outside the machine's range"),
        (Kind::NotFinite, "invalid coordinate"),
        (Kind::ToolAxis, "tool axis is not +Z"),
        (Kind::FeedMode, "feed is not in mm/min"),
        (Kind::NotChecked, "not checked"),
    ]
};

const _: () = {
    let mut index = 0;
    while index < KINDS.len() {
        assert!(KINDS[index].0 as usize == index, "KINDS has the kinds in their order");
        index += 1;
    }
};

impl FindingKind {
    /// All kinds, in the order in which a report lists them.
    pub fn all() -> impl Iterator<Item = Self> {
        KINDS.into_iter().map(|(kind, _)| kind)
    }

    /// Its words for people; its code is for scripts and stays.
    #[must_use]
    pub fn words(self) -> &'static str {
        KINDS[self as usize].1
    }
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// The program must not run.
    Error,
    /// Worth knowing; the program may run.
    Warning,
    /// What the report does not answer for; the program may run.
    Note,
}

/// One fault: its worst position and the lines over which it lasts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Finding {
    /// What is wrong.
    pub kind: FindingKind,
    /// How bad it is.
    pub severity: Severity,
    /// Line of the worst position, from 1; 0 when the program was not read from text or has no such position.
    pub line: u32,
    /// First line of the fault.
    pub first_line: u32,
    /// Last line of the fault.
    pub last_line: u32,
    /// Consecutive moves that show it.
    pub moves: usize,
    /// Their length, mm.
    pub length_mm: f64,
    /// The tool's tip at the worst position, work coordinates, mm.
    pub position: Option<[f64; 3]>,
    /// What was measured there, where that is a length, mm: depth, distance or height.
    pub value_mm: Option<f64>,
    /// What was measured there, in `unit`.
    pub value: Option<f64>,
    /// What is allowed, in `unit`.
    pub limit: Option<f64>,
    /// "mm", "mm/min", "rev/min", "s" or "deg".
    pub unit: String,
    /// What, where and what to do.
    pub message: String,
}

impl Finding {
    /// A finding about the whole program.
    pub(crate) fn of_all(kind: FindingKind, severity: Severity, message: String) -> Self {
        Self {
            kind,
            severity,
            line: 0,
            first_line: 0,
            last_line: 0,
            moves: 0,
            length_mm: 0.0,
            position: None,
            value_mm: None,
            value: None,
            limit: None,
            unit: "mm".to_owned(),
            message,
        }
    }

    /// Makes it a warning: the job takes this risk by name.
    pub(crate) fn accept(&mut self) {
        if self.severity == Severity::Error {
            self.severity = Severity::Warning;
            self.message += " (accepted by the job)";
        }
    }

    /// The same, reported at a line.
    pub(crate) fn at_line(self, line: u32) -> Self {
        Self { line, first_line: line, last_line: line, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_words_of_its_own() {
        let schema = serde_json::to_value(schemars::schema_for!(FindingKind)).unwrap();
        let codes: Vec<_> = schema["oneOf"].as_array().unwrap().iter().map(|kind| kind["const"].clone()).collect();
        let listed: Vec<_> = FindingKind::all().map(|kind| serde_json::to_value(kind).unwrap()).collect();
        assert_eq!(listed, codes);
        let words: std::collections::BTreeSet<_> = FindingKind::all().map(FindingKind::words).collect();
        assert!(words.len() == codes.len() && words.iter().all(|words| !words.is_empty() && !words.contains('-')));
    }
}

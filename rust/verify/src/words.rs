//! Findings in words: what, where, what to do.

use crate::findings::Fault;
use crate::FindingKind;

/// Over how much of a program something lasts.
pub(crate) struct Extent {
    /// The first and the last line, 0 when the program was not read from text.
    pub lines: [u32; 2],
    pub moves: usize,
    /// Length of the moves, mm.
    pub length: f64,
}

/// The whole sentence of a fault at its worst place.
pub(crate) fn message(fault: &Fault, extent: &Extent) -> String {
    let place = place(fault.line, fault.index, fault.position);
    format!("{place}: {}{}; {}", what(fault), lasting(extent), remedy(fault.kind))
}

/// The same for the worst of `count` places, in `regions` of the part or in one that is named.
pub(crate) fn of_many(
    worst: &Fault,
    extent: &Extent,
    count: usize,
    regions: usize,
    region: Option<[[f64; 3]; 2]>,
) -> String {
    let place = place(worst.line, worst.index, worst.position);
    let [first, last] = extent.lines;
    let lines = if first > 0 { format!(" on lines {first} to {last}") } else { String::new() };
    let over = match region {
        Some(corners) => format!(" in {}", within(corners)),
        None if regions > 1 => format!(" in {regions} regions"),
        None => String::new(),
    };
    let (what, moves, remedy) = (what(worst), extent.moves, remedy(worst.kind));
    let length = extent.length;
    format!("{place}: {what}, the worst of {count} places{over}{lines} ({moves} moves, {length:.1} mm); {remedy}")
}

/// A box by its corners.
fn within([low, high]: [[f64; 3]; 2]) -> String {
    let sides = ["X", "Y", "Z"].iter().zip(low.iter().zip(high));
    sides.map(|(axis, (low, high))| format!("{axis}{low:.1} to {high:.1}")).collect::<Vec<_>>().join(", ")
}

/// Line (or move) and coordinates.
fn place(line: u32, index: usize, [x, y, z]: [f64; 3]) -> String {
    let counted = if line > 0 { format!("line {line}") } else { format!("move {}", index + 1) };
    if [x, y, z].iter().all(|v| v.is_finite()) {
        format!("{counted}, X{x:.3} Y{y:.3} Z{z:.3}")
    } else {
        counted
    }
}

fn lasting(extent: &Extent) -> String {
    let Extent { lines: [first, last], moves, length } = extent;
    match moves {
        0 | 1 => String::new(),
        _ if *first > 0 => {
            format!(" (it begins at line {first} and lasts to line {last}: {moves} moves, {length:.1} mm)")
        }
        _ => format!(" ({moves} moves in a row, {length:.1} mm)"),
    }
}

fn what(fault: &Fault) -> String {
    let (value, limit) = fault.measure.unwrap_or((0.0, 0.0));
    match fault.kind {
        FindingKind::Gouge => format!("the tool enters the part by {value:.4} mm (limit {limit:.4} mm)"),
        FindingKind::ShankCollision => format!("the shank enters the part by {value:.4} mm"),
        FindingKind::HolderCollision => format!("the holder enters the part by {value:.4} mm"),
        FindingKind::ClampCollision => near("the tool", "the clamp frame", value, limit),
        FindingKind::BackingCollision => near("the sheet under the tool", "the backing plate", value, limit),
        FindingKind::RapidIntoMaterial => format!("a rapid enters the part by {value:.4} mm"),
        FindingKind::RapidPlunge if value < 0.0 => {
            format!("a rapid goes straight down into the part by {:.4} mm", -value)
        }
        FindingKind::RapidPlunge => {
            format!("a rapid comes down to {value:.4} mm from the part ({limit:.4} mm are kept)")
        }
        FindingKind::DogLegRapid => {
            format!("a rapid goes sideways and down at once to Z{value:.3}, below the clearance height {limit:.3}")
        }
        FindingKind::LowRapid => format!("a rapid goes sideways at Z{value:.3}, below the clearance height {limit:.3}"),
        FindingKind::Excess => {
            format!("the tool is {value:.4} mm off the part where it should touch (limit {limit:.4} mm)")
        }
        FindingKind::MissingPass => {
            format!("{value:.3} mm are left beside this move where the tool could touch (a pass at the ordered distance leaves {limit:.3})")
        }
        FindingKind::MissingLevel => {
            format!("the tool could touch within {value:.3} mm beside this level and no other does (the job's step is {limit:.3})")
        }
        FindingKind::MissingRow => {
            format!("the tool could touch within {value:.3} mm beside this row and no other does (the job's stepover is {limit:.3})")
        }
        FindingKind::WallAngle => format!("the wall is at {value:.1} degrees, and the sheet bears {limit:.1}"),
        FindingKind::Thinning => {
            format!("the sheet becomes {value:.3} mm thin by the sine law, and must keep {limit:.3}")
        }
        FindingKind::Punch => {
            format!("the tool goes down to Z{value:.3}, and the sheet stands at Z{limit:.3} there: it punches through")
        }
        FindingKind::Bridged => format!("the tool bridges a face by {value:.3} mm (limit {limit:.3} mm)"),
        FindingKind::Unreached => format!("the tool reaches too little of the faces: {value:.1} mm2 of {limit:.1}"),
        FindingKind::SheetThickness => format!("the model is {value:.3} mm thick, and the sheet {limit:.3} mm"),
        FindingKind::SheetFace => "the model shows another face of the sheet than the job says".to_owned(),
        FindingKind::SolidFormed => "the model is a solid, and no sheet of nearly constant thickness".to_owned(),
        FindingKind::FlangeHeight => {
            format!("the model's flange lies at Z{value:.3}, and the sheet is clamped at Z{limit:.3}")
        }
        FindingKind::FormingOrder => format!("the level Z{value:.3} is formed after Z{limit:.3}, which is lower"),
        FindingKind::DeepRapid => format!("a rapid goes down to Z{value:.3}, below the retract height {limit:.3}"),
        FindingKind::StopBelow => "the program stops (M0, M1) while the tool is down".to_owned(),
        FindingKind::MissingFeed => "a feed move has no feed".to_owned(),
        FindingKind::UnplacedFeed => "a feed move starts where not all axes are known".to_owned(),
        FindingKind::MissingToolChange => "a feed move comes before any tool change".to_owned(),
        FindingKind::UnknownTool => "the tool loaded here is not one of the job's".to_owned(),
        FindingKind::MissingOperation => "an operation of the job is missing".to_owned(),
        FindingKind::OperationOrder => "operations come in another order than the job's".to_owned(),
        FindingKind::UnnamedOperations => "the job's operations are not named".to_owned(),
        FindingKind::UnsaidMode => "a mode is not said".to_owned(),
        FindingKind::OptionalLines => "lines run or do not, as a switch stands".to_owned(),
        FindingKind::UnsafeStart if value.is_nan() => {
            "the first move goes across at a height that is not known".to_owned()
        }
        FindingKind::UnsafeStart => {
            format!("the program starts by going across at Z{value:.3}, below the clearance height {limit:.3}")
        }
        FindingKind::UnknownPlace if value.is_nan() => {
            "a rapid goes across where the tool's height is not known".to_owned()
        }
        FindingKind::UnknownPlace => {
            format!("a rapid goes to Z{value:.3}, below the clearance height {limit:.3}, from where is not known")
        }
        FindingKind::MachinePlace if value.is_nan() => {
            "a move in machine coordinates (G53) goes across while the tool is not known to be up".to_owned()
        }
        FindingKind::MachinePlace => {
            format!("a move goes to Z{value:.3} of the machine (G53), and where that is in the work is not known")
        }
        FindingKind::UnsafeEnd => format!("the tool is left at Z{value:.3}, below the clearance height {limit:.3}"),
        FindingKind::NoEnd => "the text ends without M2 or M30".to_owned(),
        FindingKind::FeedDiffers => format!("the feed is {} mm/min and the job orders {}", plain(value), plain(limit)),
        FindingKind::SpindleDiffers => {
            format!("the spindle {} and the job orders that it {}", spindle(value), spindle(limit))
        }
        FindingKind::CoolantDiffers => "coolant is not as the job orders it".to_owned(),
        FindingKind::ToolDiffers => "the tool is not the operation's".to_owned(),
        FindingKind::Dwell => format!("the program waits {} s while the tool is down", plain(value)),
        FindingKind::WorkPlane => "moves are made in G18 or G19, and no arc is in that plane".to_owned(),
        FindingKind::XLimit | FindingKind::YLimit | FindingKind::ZLimit => {
            format!("{} goes to {value:.3}, beyond the machine's {limit:.3}", axis(fault.kind))
        }
        FindingKind::Travel => "the program needs more travel than there is".to_owned(),
        FindingKind::FeedLimit => {
            format!("the feed is {} mm/min and the machine's largest is {}", plain(value), plain(limit))
        }
        FindingKind::SpindleLimit => "the spindle has no such speed".to_owned(),
        FindingKind::NotFinite => "a coordinate is not a number, or absurd".to_owned(),
        FindingKind::NoFeedMoves => "the program has no feed move".to_owned(),
        FindingKind::NoContact => "nothing touches the part".to_owned(),
        FindingKind::WorkOffset => "the work offset is not the part's".to_owned(),
        FindingKind::NotChecked => "something is not checked".to_owned(),
    }
}

/// What comes too near to something, or into it.
fn near(what: &str, other: &str, value: f64, limit: f64) -> String {
    if value < 0.0 {
        format!("{what} enters {other} by {:.3} mm", -value)
    } else {
        format!("{what} comes to {value:.3} mm from {other} ({limit:.3} mm are kept)")
    }
}

/// A number without needless places.
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

fn axis(kind: FindingKind) -> char {
    match kind {
        FindingKind::XLimit => 'X',
        FindingKind::YLimit => 'Y',
        _ => 'Z',
    }
}

fn remedy(kind: FindingKind) -> &'static str {
    match kind {
        FindingKind::Gouge => {
            "correct the coordinate where it begins, or plan again with this tool, sheet and zero point"
        }
        FindingKind::ShankCollision => "take a tool with a longer base, or a thinner shank",
        FindingKind::HolderCollision => "let the tool stick out farther, or take a smaller holder",
        FindingKind::ClampCollision => "take a wider frame or a lower one, or a longer tool",
        FindingKind::BackingCollision => "take a plate with a wider opening, or move the part in it",
        FindingKind::WallAngle | FindingKind::Thinning => {
            "turn the part so that its walls share the angle, or form in stages"
        }
        FindingKind::RapidIntoMaterial | FindingKind::RapidPlunge => "retract first, and come down at a feed",
        FindingKind::DogLegRapid => "go across above the clearance height, then straight down",
        FindingKind::LowRapid => "retract to the clearance height first",
        FindingKind::Excess => "correct this coordinate, or plan again with this tool, sheet and zero point",
        FindingKind::MissingPass | FindingKind::MissingLevel | FindingKind::MissingRow => {
            "post the whole operation, with the job's heights and steps"
        }
        FindingKind::Punch => {
            "form level by level from the top down (z-level), and finish with rows after that; or accept = [\"punch\"]"
        }
        FindingKind::Bridged => "take a smaller tool, or accept = [\"bridged\"]",
        FindingKind::Unreached => "take a smaller tool, or accept = [\"unreached\"]",
        FindingKind::SheetThickness => "correct setup.sheet.thickness, or accept = [\"thickness\"]",
        FindingKind::SheetFace => "correct part.model_face, or accept = [\"model-face\"]",
        FindingKind::SolidFormed => "set process.kind = \"milling\", or accept = [\"solid\"]",
        FindingKind::FlangeHeight => "let the flange lie at the sheet's top, or accept = [\"flange\"]",
        FindingKind::FormingOrder => "form from the top down",
        FindingKind::DeepRapid => "come down at a feed from there",
        FindingKind::StopBelow => "stop above the clearance height",
        FindingKind::MissingFeed => "give F before the first feed move",
        FindingKind::UnplacedFeed => "give X, Y and Z in rapids first",
        FindingKind::MissingToolChange => "load the tool and its length before the first feed move",
        FindingKind::UnknownTool => "add the tool to the job, or correct the T word",
        FindingKind::WorkOffset => "write the part's work offset before the moves",
        FindingKind::MissingOperation => "post the whole job",
        FindingKind::UnnamedOperations | FindingKind::OperationOrder => "post the job again",
        FindingKind::UnsaidMode => "say it first",
        FindingKind::OptionalLines => "take them out, or their marks",
        FindingKind::UnsafeStart => "go up to the clearance height in a block of its own first",
        FindingKind::UnknownPlace => "go up to the clearance height in a block of its own first",
        FindingKind::MachinePlace => "go to the machine's top only (G53 G0 Z0), and across from there",
        FindingKind::UnsafeEnd => "go up to the clearance height first",
        FindingKind::NoEnd => "the file may be cut off: get the whole file, or write M2",
        FindingKind::FeedDiffers => "correct F, or the job",
        FindingKind::SpindleDiffers => "correct M3, M4, M5 and S, or the job",
        FindingKind::CoolantDiffers => "correct M7, M8 and M9, or the job",
        FindingKind::ToolDiffers => "correct T, or the job",
        FindingKind::Dwell => "take the wait out, or wait above the part",
        FindingKind::WorkPlane => "write G17",
        FindingKind::XLimit | FindingKind::YLimit | FindingKind::ZLimit => "move the zero point, or turn the part",
        FindingKind::Travel => "turn the part, or split the program",
        FindingKind::FeedLimit => "correct F",
        FindingKind::SpindleLimit => "correct S",
        FindingKind::NotFinite => "correct the coordinate",
        FindingKind::NoFeedMoves => "post an operation that has a path",
        FindingKind::NotChecked => "check it yourself",
        FindingKind::NoContact => "check zero, units and tool reference",
    }
}

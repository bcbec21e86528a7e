//! Findings in words: what, where, what to do.

use crate::faults::Fault;

/// Over how much of a program something lasts.
pub(crate) struct Extent {
    /// The first and the last line, 0 when the program was not read from text.
    pub lines: [u32; 2],
    pub moves: usize,
    /// Length of the moves, mm.
    pub length: f64,
}

/// The whole sentence of a fault at its worst position.
pub(crate) fn message(fault: &Fault, extent: &Extent) -> String {
    let position = position(fault.line, fault.index, fault.position);
    format!("{position}: {}{}; {}", fault.what(), lasting(extent), fault.kind.remedy)
}

/// The same for the worst of `count` positions, in `regions` of the part or in one that is named.
pub(crate) fn of_many(
    worst: &Fault,
    extent: &Extent,
    count: usize,
    regions: usize,
    region: Option<[[f64; 3]; 2]>,
) -> String {
    let position = position(worst.line, worst.index, worst.position);
    let [first, last] = extent.lines;
    let lines = if first > 0 { format!(" on lines {first} to {last}") } else { String::new() };
    let over = match region {
        Some(corners) => format!(" in {}", within(corners)),
        None if regions > 1 => format!(" in {regions} regions"),
        None => String::new(),
    };
    let (what, moves, remedy) = (worst.what(), extent.moves, worst.kind.remedy);
    let length = extent.length;
    format!("{position}: {what}, the worst of {count} positions{over}{lines} ({moves} moves, {length:.1} mm); {remedy}")
}

/// A box by its corners.
fn within([low, high]: [[f64; 3]; 2]) -> String {
    let sides = ["X", "Y", "Z"].iter().zip(low.iter().zip(high));
    sides.map(|(axis, (low, high))| format!("{axis}{low:.1} to {high:.1}")).collect::<Vec<_>>().join(", ")
}

/// Line (or move) and coordinates.
fn position(line: u32, index: usize, [x, y, z]: [f64; 3]) -> String {
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

//! Heidenhain's drilling cycles: `CYCL DEF 200`, then positions with M99.
//!
//! Sources: TNC 320 user's manual 7/2008 p. 238 (cycle 207 and what its heights are measured from), Autodesk Heidenhain post
//! revision 42300 (order of the parameters of 200, 203 and 207).

use std::fmt::Write as _;

use styluscam_motion::CycleKind;

use super::dialect::Hole;
use crate::number::{NumberFormat, DWELL_PLACES, PITCH_PLACES};

/// How far over the last depth a peck goes on at feed, and how far a chip is broken by going up, mm.
const CLEARANCE: f64 = 0.25;
/// Chips broken before the drill leaves the hole to clear it.
const BREAKS: &str = "99";

/// The lines that define a cycle, without block numbers; boring is no cycle here. `per_mm` is units of the last decimal in a mm.
///
/// Heights are measured from a surface just under the position where the hole begins.
pub(super) fn definition(hole: &Hole, linear: &NumberFormat, feed: &NumberFormat, per_mm: f64) -> String {
    #[allow(clippy::cast_possible_truncation)] // a few thousand at most
    let quarter = (CLEARANCE * per_mm).round() as i64;
    let depth = hole.retract - hole.bottom;
    // the control counts pecks from the surface: it must lie so high that the last one is not joined to the one before
    let pecked = if hole.peck > 0 && hole.peck < depth { (depth - hole.peck) / 2 } else { depth / 2 };
    let clearance = quarter.min(pecked).max(1);
    let surface = hole.retract - clearance;
    let length = |count: i64| linear.text(count);
    let real = |places: u8, value: f64| NumberFormat::plain(places).text_of(value);
    let clear = ("Q200", length(clearance), "SET-UP CLEARANCE");
    let depth = ("Q201", length(hole.bottom - surface), "DEPTH");
    let top = ("Q203", length(surface), "SURFACE COORDINATE");
    let second = ("Q204", length(hole.leave - surface), "2ND SET-UP CLEARANCE");
    let plunge = ("Q206", feed.text(hole.feed), "FEED RATE FOR PLNGNG");
    let dwell = ("Q211", real(DWELL_PLACES, hole.dwell), "DWELL TIME AT DEPTH");
    let none = || length(0);
    let (title, parameters) = match (hole.kind, hole.thread) {
        (CycleKind::Tap | CycleKind::LeftTap, Some(thread)) => {
            let hand = if hole.kind == CycleKind::Tap { "+" } else { "-" };
            let pitch = format!("{hand}{}", real(PITCH_PLACES, thread.pitch));
            ("207 RIGID TAPPING", vec![clear, depth, ("Q239", pitch, "PITCH"), top, second])
        }
        (CycleKind::ChipBreak, _) => (
            "203 UNIVERSAL DRILLING",
            vec![
                clear,
                depth,
                plunge,
                ("Q202", length(hole.peck), "PLUNGING DEPTH"),
                ("Q210", none(), "DWELL TIME AT TOP"),
                top,
                second,
                ("Q212", none(), "DECREMENT"),
                ("Q213", BREAKS.into(), "BREAKS"),
                ("Q205", none(), "MIN. PLUNGING DEPTH"),
                dwell,
                ("Q208", "MAX".into(), "RETRACTION FEED RATE"),
                ("Q256", length(quarter), "DIST. FOR CHIP BRKNG"),
            ],
        ),
        _ => {
            let peck = if hole.peck > 0 { hole.peck } else { surface - hole.bottom };
            let infeed = ("Q202", length(peck), "PLUNGING DEPTH");
            let wait = ("Q210", none(), "DWELL TIME AT TOP");
            ("200 DRILLING", vec![clear, depth, plunge, infeed, wait, top, second, dwell])
        }
    };
    let mut out = format!("CYCL DEF {title}");
    for (name, value, label) in parameters {
        // writing to a string cannot fail
        let _ = write!(out, " ~\n  {name}={value} ;{label}");
    }
    out
}

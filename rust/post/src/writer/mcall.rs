//! Sinumerik's drilling cycles: `MCALL CYCLE81(...)`, positions, `MCALL`.
//!
//! Sources: programming guide Cycles 11.02 p. 2-86, Autodesk siemens-840d.cps (order and meaning of the arguments).

use styluscam_motion::CycleKind;

use super::dialect::Hole;
use crate::number::{NumberFormat, DWELL_PLACES, PITCH_PLACES};

/// What ends the calls.
pub(super) const END: &str = "MCALL";

/// The block that calls a cycle at every position from here on; boring is no cycle here.
///
/// All heights are absolute: return plane, reference plane (the clearance is 0), depth.
pub(super) fn call(hole: &Hole, linear: &NumberFormat, rpm: &NumberFormat) -> String {
    let length = |count: i64| linear.text(count);
    let real = |places: u8, value: f64| NumberFormat::plain(places).text_of(value);
    let heights = format!("{},{},0,{}", length(hole.leave), length(hole.retract), length(hole.bottom));
    match (hole.kind, hole.thread) {
        (CycleKind::Peck | CycleKind::ChipBreak, _) => {
            let first = length(hole.retract - hole.peck);
            let leaves_the_hole = i32::from(hole.kind == CycleKind::Peck);
            format!("MCALL CYCLE83({heights},,{first},,0,{},0,1,{leaves_the_hole})", real(DWELL_PLACES, hole.dwell))
        }
        (CycleKind::Tap | CycleKind::LeftTap, Some(thread)) => {
            let (hand, turns) = if hole.kind == CycleKind::Tap { (1.0, 3) } else { (-1.0, 4) };
            let speed = rpm.text(thread.speed);
            let pitch = real(PITCH_PLACES, hand * thread.pitch);
            format!("MCALL CYCLE84({heights},,0,{turns},,{pitch},0,{speed},{speed})")
        }
        _ if hole.dwell > 0.0 => format!("MCALL CYCLE82({heights},,{})", real(DWELL_PLACES, hole.dwell)),
        _ => format!("MCALL CYCLE81({heights})"),
    }
}

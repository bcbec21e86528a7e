//! Slower feeds at sharp turns, where the job asks for them.

use styluscam_motion::Move;
use styluscam_toolpath::slowed;

use super::facts::counted;
use super::{Context, Fact};
use crate::JobError;

/// The moves with lower feeds before and behind sharp turns and on small arcs, and how many there are.
///
/// # Errors
/// The machine's acceleration is not known.
pub fn slowed_down(context: &Context<'_>, moves: &[Move]) -> Result<(Vec<Move>, Fact), JobError> {
    let machine = context.machine;
    let cornering = machine.cornering().ok_or_else(|| {
        let message = format!("slow_corners: the machine file of {} does not state its acceleration", machine.name);
        let hint = "add limits.acceleration, mm/s^2, to it, or remove slow_corners";
        JobError::document("missing", format!("{}.slow_corners", context.path), message, hint)
    })?;
    let (slowed, count) = slowed(moves, &cornering);
    let least = slowed.iter().map(|step| step.feed).filter(|feed| *feed > 0.0).fold(f64::INFINITY, f64::min);
    let words = match count {
        0 => "no turn so sharp that the feed has to drop".to_owned(),
        count => format!(
            "lower feeds at {}, down to {least:.0} mm/min",
            counted(count, "sharp turn or small arc", "sharp turns and small arcs")
        ),
    };
    Ok((slowed, Fact { fact: "slow_corners", value: count as f64, unit: "", words }))
}

//! How a leaning tool's axis turns along its passes.

use styluscam_motion::MoveKind;

use super::found::Judged;
use super::moves::LeaningMove;
use super::report::AxisTurning;
use crate::faults::{self, Fault};

/// A turn for each mm so many times the mean is a jump.
const JUMP: f64 = 5.0;
/// Turns below this are none, rad: coordinates of angles are rounded.
const LEAST: f64 = 2e-3;

/// Measures the turns of an operation's passes, and finds jumps.
pub(super) fn judge(moves: &[&LeaningMove], judged: &mut Judged) -> AxisTurning {
    let mut cuts: Vec<Turn> = Vec::new();
    for turn in moves.iter().filter_map(|step| Turn::of(step)) {
        // what a reader gives as several moves is one in the text
        match cuts.last_mut().filter(|last| last.goes_on(&turn)) {
            Some(last) => {
                *last = Turn {
                    angle: last.angle + turn.angle,
                    length: last.length + turn.length,
                    first: last.first,
                    ..turn
                }
            }
            None => cuts.push(turn),
        }
    }
    let (turned, length) = cuts.iter().fold((0.0, 0.0), |sum, turn| (sum.0 + turn.angle, sum.1 + turn.length));
    let mean = if length > 0.0 { turned / length } else { 0.0 };
    let rate = |turn: &Turn| turn.angle / turn.length;
    let jumps = cuts.iter().filter(|turn| turn.angle > LEAST && rate(turn) > JUMP * mean);
    if let Some(worst) = jumps.max_by(|a, b| rate(a).total_cmp(&rate(b))) {
        let fault = Fault::new(&faults::AXIS_JUMP, worst.step.index, worst.step.line, worst.step.to.tip.into());
        judged.faults.push(fault.measured(rate(worst).to_degrees(), JUMP * mean.to_degrees()).warning());
    }
    let speeds: Vec<f64> = cuts.iter().map(|turn| turn.angle.to_degrees() / turn.time()).collect();
    let changes = cuts.windows(2).zip(speeds.windows(2)).filter(|(pair, _)| pair[1].first == pair[0].step.index + 1);
    let acceleration =
        changes.map(|(pair, speeds)| (speeds[1] - speeds[0]).abs() / (0.5 * (pair[0].time() + pair[1].time())));
    let significant = cuts.iter().filter(|turn| turn.angle > LEAST).map(rate).fold(mean, f64::max);
    AxisTurning {
        speed_max: speeds.iter().copied().fold(0.0, f64::max),
        acceleration_max: acceleration.fold(0.0, f64::max),
        unevenness: if mean > 0.0 { significant / mean } else { 1.0 },
    }
}

struct Turn<'a> {
    /// The last of the moves of its line, and the number of the first.
    step: &'a LeaningMove,
    first: usize,
    /// rad
    angle: f64,
    /// Of the tip's way, mm.
    length: f64,
}

impl<'a> Turn<'a> {
    fn of(step: &'a LeaningMove) -> Option<Self> {
        let from = step.from.filter(|_| step.is_along_pass && step.kind == MoveKind::Feed && step.feed > 0.0)?;
        let angle = libm::atan2(from.axis.cross(&step.to.axis).norm(), from.axis.dot(&step.to.axis));
        let length = (step.to.tip - from.tip).norm();
        (length > 0.0).then_some(Self { step, first: step.index, angle, length })
    }

    /// Whether another is a further part of its line.
    fn goes_on(&self, next: &Self) -> bool {
        self.step.line > 0 && self.step.line == next.step.line && next.first == self.step.index + 1
    }

    /// s
    fn time(&self) -> f64 {
        60.0 * self.length / self.step.feed
    }
}

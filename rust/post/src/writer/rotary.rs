//! The rotary axes of the machine, and how a program goes on them.

use styluscam_motion::Program;

use crate::machine::{Machine, RotaryRules};
use crate::number::NumberFormat;
use crate::post_error::PostError;
use crate::rotary::{between, poses, Limits, Pose, RotaryAxes};

/// Parts of the way between two poses at whose ends it is looked where the linear axes stand.
const PARTS: u32 = 8;

/// Angles in units of the last decimal.
pub(super) type Angles = [i64; 2];

/// The rotary axes of the machine, and where they stand.
pub(super) struct Rotary<'m> {
    pub rules: &'m RotaryRules,
    pub axes: RotaryAxes,
    format: NumberFormat,
    /// Whether the tool leans anywhere in the program.
    pub leans: bool,
    /// Whether the control tracks the tip.
    pub is_tracking: bool,
    /// As the text states them.
    pub stated: Option<Angles>,
    pub last: Option<Pose>,
}

impl<'m> Rotary<'m> {
    pub fn of(machine: &'m Machine) -> Result<Option<Self>, PostError> {
        let Some(rules) = &machine.rotary else { return Ok(None) };
        let (axes, format) = (RotaryAxes::new(rules.axes)?, machine.angle_format());
        Ok(Some(Self { rules, axes, format, leans: false, is_tracking: false, stated: None, last: None }))
    }

    /// Whether the block that switches the tip's control on names the length offset too.
    pub fn names_length(&self, machine: &Machine) -> bool {
        let letter = machine.tool.length.as_ref().map(|length| length.word);
        let control = self.rules.tip_control.as_ref().filter(|_| self.leans);
        control.zip(letter).is_some_and(|(control, letter)| control.names_length(letter))
    }

    /// The poses of a program whose tool leans, or that cannot stand at angles 0; none of another one.
    pub fn course(&self, program: &Program, sag: f64) -> Result<Option<Vec<Pose>>, PostError> {
        let is_at_zero = self.axes.axes().iter().all(|axis| axis.limits_deg[0] <= 0.0 && axis.limits_deg[1] >= 0.0);
        if is_at_zero && program.moves.iter().all(|step| step.end.axis.is_up()) {
            return Ok(None);
        }
        let unsupported = |what| Err(PostError::Unsupported { what });
        if program.tools.iter().any(|tool| tool.reference_height != 0.0) {
            return unsupported("a leaning tool that is measured elsewhere than at its tip");
        }
        if program.cycles.iter().any(|cycle| cycle.kind.is_tapping()) {
            return unsupported("tapping in a program whose tool leans");
        }
        let limits = Limits::new(self.rules.tip_tolerance, self.rules.tip_control.is_some(), sag);
        Ok(Some(poses(program, &self.axes, limits)?))
    }

    pub fn counts(&self, pose: &Pose) -> Result<Angles, PostError> {
        let [first, second] = pose.angles.map(|angle| self.format.count(angle));
        let number = |value| PostError::Number { what: "an angle", place: format!("moves[{}]", pose.index), value };
        Ok([first.ok_or_else(|| number(pose.angles[0]))?, second.ok_or_else(|| number(pose.angles[1]))?])
    }

    /// The tip, mm, and the angles, deg, that words stand for.
    pub fn stands_for(&self, stated: [f64; 3], angles: Angles) -> ([f64; 3], [f64; 2]) {
        let angles = angles.map(|count| count as f64 / self.format.per_one());
        (if self.is_tracking { stated } else { self.axes.tip(stated, angles) }, angles)
    }

    /// Where the linear axes stand on the way to poses, mm.
    pub fn stands(&self, poses: &[Pose]) -> Vec<[f64; 3]> {
        let mut last = self.last;
        let mut stands = Vec::new();
        for pose in poses {
            match last.replace(*pose).filter(|_| !pose.is_fresh && self.rules.tip_control.is_some()) {
                None => stands.push(self.axes.linear(pose.tip, pose.angles)),
                Some(from) => stands.extend((1..=PARTS).map(|part| {
                    let share = f64::from(part) / f64::from(PARTS);
                    self.axes.linear(between(from.tip, pose.tip, share), between(from.angles, pose.angles, share))
                })),
            }
        }
        stands
    }
}

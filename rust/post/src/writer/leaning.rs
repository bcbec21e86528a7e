//! Programs of machines with rotary axes: where the tool leans, all five axes are written; where it never does, their angles once.

use styluscam_motion::{Move, MoveKind, Program, UnitAxis};

use super::rotary::Angles;
use super::Poster;
use crate::machine::Repeat;
use crate::post_error::PostError;
use crate::rotary::{difference, larger_turn, norm, Pose};

impl Poster<'_> {
    /// The poses of a program on a machine with rotary axes; none where it is posted as on any other machine.
    pub(super) fn course(&mut self, program: &Program) -> Result<Option<Vec<Pose>>, PostError> {
        let Some(rotary) = &mut self.rotary else { return Ok(None) };
        let course = rotary.course(program, self.machine.resolution_mm())?;
        rotary.leans = course.is_some();
        Ok(course)
    }

    /// What only an upright tool does.
    pub(super) fn only_upright(&self, what: &'static str) -> Result<(), PostError> {
        match &self.rotary {
            Some(rotary) if rotary.leans => Err(PostError::Unsupported { what }),
            _ => Ok(()),
        }
    }

    /// Where the position is not known and the tool stands upright throughout: the angles, in a block of their own.
    pub(super) fn stand_upright(&mut self, index: usize, step: &Move) -> Result<(), PostError> {
        if self.rotary.is_none() || self.position.iter().any(Option::is_some) {
            return Ok(());
        }
        if !step.end.axis.is_up() {
            return Err(PostError::Unsupported { what: "a leaning tool in a program that comes move by move" });
        }
        if step.kind != MoveKind::Rapid {
            return Err(PostError::FeedFromUnknown { index });
        }
        self.turn_alone(&Pose {
            index,
            tip: step.end.tip,
            direction: UnitAxis::UP.vector(),
            angles: [0.0; 2],
            held: [None; 2],
            is_fresh: true,
        })
    }

    /// A move by way of poses, to the last of them.
    pub(super) fn lean(&mut self, step: &Move, poses: &[Pose]) -> Result<(), PostError> {
        self.start_operation(step.operation)?;
        let index = self.moves;
        let stands = self.rotary.as_ref().map(|rotary| rotary.stands(poses)).unwrap_or_default();
        self.inspector.lean(index, step, &stands)?;
        self.dialect.close(&mut self.lines)?;
        self.state_role(step)?;
        poses.iter().try_for_each(|pose| self.pose(step, pose))?;
        self.tip = Some(step.end.tip);
        self.moves += 1;
        Ok(())
    }

    fn pose(&mut self, step: &Move, pose: &Pose) -> Result<(), PostError> {
        let last = self.rotary.as_mut().and_then(|rotary| rotary.last.replace(*pose)).filter(|_| !pose.is_fresh);
        let Some(rotary) = self.rotary.as_ref().filter(|_| last.is_some()) else { return self.begin(step, pose) };
        let (angles, before) = (rotary.counts(pose)?, rotary.stated.unwrap_or_default());
        let turns = angles != before;
        let (from, target) = (self.position(pose.index)?, self.stand(pose)?);
        if !turns && self.position == target.map(Some) {
            return Ok(());
        }
        if step.kind == MoveKind::Rapid {
            let is_upright = norm(difference(pose.direction, UnitAxis::UP.vector())) < 1e-9;
            if is_upright && !turns {
                return self.rapid(target);
            }
            self.turn(angles, false);
            self.motion_line = self.lines.line;
            self.dialect.rapid(&mut self.lines, self.position, target.map(Some))?;
        } else {
            // as it is rounded: a short way is another
            let [start, end] =
                [(from, before), (target, angles)].map(|(at, angles)| rotary.stands_for(self.mm(at), angles));
            let length = norm(difference(end.0, start.0));
            let way = self.machine.way(length, larger_turn(start.1, end.1));
            let feed = self.feed_count(pose.index, step.feed, way)?;
            self.turn(angles, false);
            self.motion_line = self.lines.line;
            self.dialect.feed(&mut self.lines, self.position, target.map(Some), feed)?;
        }
        self.position = target.map(Some);
        Ok(())
    }

    /// From wherever the machine stands: the rotary axes first, then the tip's control, up, across.
    fn begin(&mut self, step: &Move, pose: &Pose) -> Result<(), PostError> {
        let tool = self.tool.ok_or(PostError::NoTool { index: pose.index })?;
        if step.kind != MoveKind::Rapid {
            return Err(PostError::FeedFromUnknown { index: pose.index });
        }
        self.turn_alone(pose)?;
        if self.rotary.as_ref().is_some_and(|rotary| rotary.rules.tip_control.is_some()) {
            let text = self.templater.tip_control(&self.names, tool)?;
            self.speak(&text)?;
            self.rotary.iter_mut().for_each(|rotary| rotary.is_tracking = true);
        }
        let target = self.stand(pose)?;
        self.rapid(target)
    }

    fn turn_alone(&mut self, pose: &Pose) -> Result<(), PostError> {
        let Some(rotary) = &self.rotary else { return Ok(()) };
        let angles = rotary.counts(pose)?;
        self.turn(angles, true);
        self.motion_line = self.lines.line;
        self.dialect.rapid(&mut self.lines, [None; 3], [None; 3])
    }

    /// Gives the next block the words of the axes that turn, or of both.
    fn turn(&mut self, angles: Angles, both: bool) {
        let Some(rotary) = &mut self.rotary else { return };
        let every = both || self.machine.words.repeat_axes == Repeat::Always;
        let last = rotary.stated.replace(angles).filter(|_| !every);
        let words = [0, 1].map(|axis| Some(angles[axis]).filter(|count| last.is_none_or(|last| last[axis] != *count)));
        self.dialect.turn(words);
    }

    /// The linear words of a pose.
    fn stand(&self, pose: &Pose) -> Result<[i64; 3], PostError> {
        let linear = match &self.rotary {
            Some(rotary) if !rotary.is_tracking => rotary.axes.linear(pose.tip, pose.angles),
            _ => pose.tip,
        };
        self.target(pose.index, linear)
    }

    /// The tip is not tracked any more.
    pub(super) fn stop_tracking(&mut self) -> Result<(), PostError> {
        let Some(rotary) = &mut self.rotary else { return Ok(()) };
        rotary.last = None;
        if !std::mem::take(&mut rotary.is_tracking) {
            return Ok(());
        }
        let off = rotary.rules.tip_control.as_ref().map(|control| control.off.clone()).unwrap_or_default();
        self.speak(&off)
    }
}

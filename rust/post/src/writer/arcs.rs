//! Arcs: in as many blocks as the machine needs, or as lines.

use styluscam_motion::{Arc, ArcPath, Move};

use super::Poster;
use crate::post_error::PostError;
use crate::rounded::RoundedArc;

impl Poster<'_> {
    /// An arc in as many blocks as the machine needs; as lines where it would not take the rounded numbers.
    pub(super) fn arc(&mut self, index: usize, step: &Move, arc: Arc) -> Result<(), PostError> {
        self.position(index)?;
        let path = arc.path(self.tip.unwrap_or(step.end.tip), step.end.tip);
        let rules = self.machine.arc.as_ref();
        let (pieces, turns) = self.machine.arc_blocks(&path, arc.turns);
        let arc = Arc { turns, ..arc };
        let share = |i: u32| f64::from(i) / f64::from(pieces);
        for piece in 0..pieces {
            let part = path.part(share(piece), share(piece + 1));
            let rounded = self.rounded(index, arc, &part)?;
            match rules.filter(|rules| rounded.stands_for(&part, rules, self.machine.resolution_mm())) {
                Some(_) => self.circle(index, step.feed, &rounded)?,
                None => self.chords(index, step.feed, &part)?,
            }
        }
        Ok(())
    }

    fn rounded(&self, index: usize, arc: Arc, path: &ArcPath) -> Result<RoundedArc, PostError> {
        let from = self.position(index)?;
        let to = self.target(index, path.at(1.0))?;
        let mut arc_centre = [0; 3];
        let height = self.tool.map_or(0.0, |tool| tool.reference_height);
        for axis in arc.plane.axes().into_iter().take(2) {
            let mm = arc.centre[axis] + if axis == 2 { height } else { 0.0 };
            arc_centre[axis] = self.count(index, "the centre", mm)?;
        }
        Ok(RoundedArc::new(arc, from, to, arc_centre, self.x_scale))
    }

    fn circle(&mut self, index: usize, feed: f64, rounded: &RoundedArc) -> Result<(), PostError> {
        // a small circle is longer or shorter once rounded, and so is its time
        let feed = self.feed_count(index, feed, rounded.path(self.machine.resolution_mm()).length())?;
        let before = self.lines.line;
        self.dialect.arc(&mut self.lines, rounded, feed)?;
        self.motion_line = (self.lines.line - 1).max(before);
        self.position = rounded.to.map(Some);
        Ok(())
    }

    fn chords(&mut self, index: usize, feed: f64, path: &ArcPath) -> Result<(), PostError> {
        let count = path.chords(self.machine.resolution_mm());
        for chord in 1..=count {
            let target = self.target(index, path.at(chord as f64 / count as f64))?;
            self.feed(index, target, feed)?;
        }
        Ok(())
    }
}

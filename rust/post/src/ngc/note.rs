//! What a trace leaves out or assumes, noted once each.

use std::fmt;

use thiserror::Error;

use super::fault::heading;

/// mm/min: of feed moves whose feed is not known.
pub(super) const FEED_UNKNOWN: f64 = 1000.0;

/// So many different notes are kept.
const KEPT: usize = 200;

/// Something that the machine would do and the trace does not show, and where it first occurs.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// The file that holds the line: a subroutine's name, empty for the program itself.
    pub file: String,
    /// The line where it first occurs, from 1; 0 when no line is meant.
    pub line: u32,
    /// How often it occurs.
    pub times: u64,
    /// What it is.
    pub gap: Gap,
}

impl fmt::Display for Note {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}{}", heading(&self.file, self.line), self.gap)?;
        match self.times {
            0 | 1 => Ok(()),
            2 => write!(out, " (twice)"),
            times => write!(out, " ({times} times)"),
        }
    }
}

/// What a trace does not know or does not show.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Gap {
    /// Lengths before G20 or G21: they are in the unit that the machine starts in.
    #[error("neither G20 nor G21 came before: lengths are taken as mm")]
    Unit,
    /// Words of rotary or secondary axes.
    #[error("axes A, B, C, U, V, W are not shown")]
    OtherAxes,
    /// G41, G42 and their kin.
    #[error("cutter compensation is not applied: the path is as programmed")]
    Compensation,
    /// G38.
    #[error("probing is taken to come to its end point, and G38.2 and G38.4 to trip there")]
    Probe,
    /// G43 and the like: the tool table is the machine's.
    #[error("the tool table is not known: lengths are taken as 0")]
    ToolTable,
    /// G55 and the like: the work offsets are the machine's.
    #[error("work offsets that the program does not set are not known: taken as 0")]
    WorkOffset,
    /// G33, G76, tapping.
    #[error("threading is shown as a feed of pitch times S")]
    Threading,
    /// A feed move and no feed, or a feed per revolution and no speed.
    #[error("no feed is known: {} mm/min are taken", FEED_UNKNOWN)]
    Feed,
    /// G96.
    #[error("surface speed (G96): the spindle is taken to turn at D, or at S where there is no D")]
    SurfaceSpeed,
    /// A parameter that has no value here: another program's, or the machine's.
    #[error("#<{name}> has no value here: 0 is taken")]
    Unset {
        /// Its name.
        name: String,
    },
    /// M66, or a parameter of the machine's inputs.
    #[error("inputs are not known (M66): 0 is taken")]
    Input,
    /// A code of the user's or of one machine.
    #[error("{code} is not known here: left out")]
    Code {
        /// The code.
        code: String,
    },
    /// A call of a subroutine that is nowhere.
    #[error("there is no subroutine o{label} here: its call is left out")]
    Subroutine {
        /// Its label.
        label: String,
    },
    /// G70 to G72.
    #[error("of lathe cycles (G70 to G72) the contour is shown, not their passes")]
    Contour,
    /// G5.2 and G5.3.
    #[error("of a NURBS curve (G5.2) its control points are joined")]
    Nurbs,
    /// The ends of an arc are not equally far from its centre.
    #[error("the arc's ends differ in their distance from its centre")]
    ArcEnds,
    /// A feed move before an axis had a position.
    #[error("{axis} has no position before the first feed move: it is taken to start at the machine's zero")]
    Start {
        /// The axis.
        axis: char,
    },
    /// M99 outside of a subroutine.
    #[error("M99 repeats the program without end: it is shown once")]
    Forever,
    /// Neither M2, M30 nor a closing %.
    #[error("the program has no end (M2, M30 or %): the file may be cut off")]
    NoEnd,
}

/// The notes of a trace.
#[derive(Debug, Default)]
pub(super) struct Notes(Vec<Note>);

impl Notes {
    pub(super) fn add(&mut self, gap: Gap, file: &str, line: u32) {
        if let Some(known) = self.0.iter_mut().find(|note| note.gap == gap) {
            known.times += 1;
        } else if self.0.len() < KEPT {
            self.0.push(Note { file: file.into(), line, times: 1, gap });
        }
    }

    /// What of the program's own was left out, in words.
    pub(super) fn left_out(&self) -> String {
        let name = |note: &Note| match &note.gap {
            Gap::Code { code } => Some(code.clone()),
            Gap::Subroutine { label } => Some(format!("o{label}")),
            _ => None,
        };
        self.0.iter().filter_map(name).collect::<Vec<_>>().join(", ")
    }

    pub(super) fn into_inner(self) -> Vec<Note> {
        self.0
    }
}

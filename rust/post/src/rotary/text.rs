//! G-code with two rotary axes, and what such text means.

use styluscam_motion::{EventKind, FeedMode, Move, MoveKind, Program, SpindleDirection};

use super::error::RotaryError;
use super::kinematics::{difference, norm, RotaryAxes};
use super::poses::{poses, Limits, Pose};
use crate::machine::{Family, LengthUnit, Machine};
use crate::number::NumberFormat;
use crate::post_error::PostError;

/// Decimals that angles may have.
const DECIMALS: std::ops::RangeInclusive<u8> = 1..=8;
/// Decimals of an inverse time feed.
const RATE_DECIMALS: u8 = 5;
const LINEAR: [char; 3] = ['X', 'Y', 'Z'];

/// How rotary axes are written.
#[derive(Clone, Debug, PartialEq)]
pub struct RotaryText {
    /// The lines that switch the control's own tracking of the tip on and off: `G43.4 H1` and `G49`. Coordinates are then the
    /// tip's in the part. Without it they are where the linear axes stand, and feeds are inverse times.
    pub tip_control: Option<[String; 2]>,
    /// Decimals of angles, deg.
    pub angle_decimals: u8,
    /// How far the tip may leave the straight line between two poses, mm, where the control does not track it: there the axes
    /// go evenly, and poses are put between.
    pub tolerance: f64,
}

impl RotaryText {
    /// Whether the control tracks the tip.
    fn tracks_tip(&self) -> bool {
        self.tip_control.is_some()
    }
}

/// A program for a machine with rotary axes, as plain moves.
///
/// The first pose is gone to in rapid: the rotary axes first, then the others. It must lie clear of the part.
///
/// # Errors
/// [`RotaryError`], and no text.
pub fn rotary_text(
    program: &Program,
    machine: &Machine,
    axes: &RotaryAxes,
    form: &RotaryText,
) -> Result<String, RotaryError> {
    let mut out = Writer::new(program, machine, axes, form)?;
    let is_plain =
        |step: &Move| step.arc.is_none() && (step.kind == MoveKind::Rapid || step.feed_mode == FeedMode::PerMinute);
    if let Some(index) = program.moves.iter().position(|step| !is_plain(step)) {
        return Err(RotaryError::Move { index });
    }
    let poses = poses(program, axes, Limits::new(form.tolerance, form.tracks_tip()))?;
    let mut events = program.upcoming();
    for (index, (step, parts)) in program.moves.iter().zip(poses.chunk_by(|a, b| a.index == b.index)).enumerate() {
        events.before(index).try_for_each(|event| out.event(program, event))?;
        out.step(step, parts)?;
    }
    events.before(program.moves.len()).try_for_each(|event| out.event(program, event))?;
    out.finish()
}

struct Writer<'a> {
    machine: &'a Machine,
    axes: &'a RotaryAxes,
    form: &'a RotaryText,
    linear: NumberFormat,
    angle: NumberFormat,
    per_mm: f64,
    out: String,
    last: Option<Pose>,
    feed: Option<i64>,
}

impl<'a> Writer<'a> {
    fn new(
        program: &Program,
        machine: &'a Machine,
        axes: &'a RotaryAxes,
        form: &'a RotaryText,
    ) -> Result<Self, RotaryError> {
        if program.moves.is_empty() {
            return Err(PostError::Empty.into());
        }
        let is_sound = form.tolerance.is_normal() && form.tolerance > 0.0 && DECIMALS.contains(&form.angle_decimals);
        if !is_sound {
            return Err(RotaryError::Form);
        }
        if machine.family != Family::Gcode {
            return Err(unsupported("text with rotary axes in another form than G-code"));
        }
        if !form.tracks_tip() && machine.feed.inverse_time.is_none() {
            return Err(unsupported(
                "inverse time feeds, which rotary axes need where the control does not track the tip",
            ));
        }
        if program.tools.iter().any(|tool| tool.reference_height != 0.0) {
            return Err(unsupported("rotary axes with a tool that is measured elsewhere than at its tip"));
        }
        let units = match machine.units.output {
            LengthUnit::Mm => "G21",
            LengthUnit::Inch => "G20",
        };
        let mut writer = Self {
            machine,
            axes,
            form,
            linear: machine.linear_format(),
            angle: NumberFormat::new(&machine.number, form.angle_decimals),
            per_mm: machine.units.output.in_mm().recip(),
            out: String::new(),
            last: None,
            feed: None,
        };
        writer.line(&format!("{units} G17 G90"));
        writer.line(&program.setup.wcs);
        Ok(writer)
    }

    fn line(&mut self, text: &str) {
        self.out.push_str(text);
        self.out.push('\n');
    }

    fn finish(mut self) -> Result<String, RotaryError> {
        if let Some([_, off]) = &self.form.tip_control {
            self.line(off);
        } else if let Some(per_minute) = &self.machine.feed.per_minute {
            self.line(per_minute);
        }
        self.line(&self.machine.end);
        Ok(self.out)
    }

    fn event(&mut self, program: &Program, event: &EventKind) -> Result<(), RotaryError> {
        let line = match event {
            EventKind::ToolChange { tool } => {
                let number = program.tools.get(*tool as usize).map_or(0, |tool| tool.number);
                format!("T{number} M6")
            }
            EventKind::SpindleOn { rpm, direction } => {
                let code = if *direction == SpindleDirection::Clockwise { "M3" } else { "M4" };
                format!("S{} {code}", NumberFormat::plain(self.machine.number.rpm).text_of(*rpm))
            }
            EventKind::SpindleOff => "M5".into(),
            EventKind::Mist { on } | EventKind::Flood { on } if !on => "M9".into(),
            EventKind::Mist { .. } => "M7".into(),
            EventKind::Flood { .. } => "M8".into(),
            EventKind::Comment { .. } => return Ok(()),
            EventKind::Dwell { .. }
            | EventKind::Stop { .. }
            | EventKind::Raw { .. }
            | EventKind::WorkOffset { .. }
            | EventKind::Probe { .. }
            | EventKind::Sync { .. } => return Err(unsupported("anything but moves, tools, spindle and coolant")),
        };
        self.line(&line);
        Ok(())
    }

    /// A move by way of poses to the last of them.
    fn step(&mut self, step: &Move, poses: &[Pose]) -> Result<(), RotaryError> {
        for pose in poses {
            let (linear, turned) = self.pose_words(pose)?;
            match (self.last.replace(*pose), step.kind) {
                (None, _) => {
                    self.line(&format!("G0{turned}"));
                    if let Some([on, _]) = &self.form.tip_control {
                        self.line(on);
                    }
                    self.line(&format!("G0{linear}"));
                }
                (Some(_), MoveKind::Rapid) => self.line(&format!("G0{linear}{turned}")),
                (Some(last), MoveKind::Feed) => {
                    let feed = self.feed_words(step.feed, [&last, pose])?;
                    let mode = match &self.machine.feed.inverse_time {
                        Some(code) if !self.form.tracks_tip() => format!("{code} "),
                        Some(_) | None => String::new(),
                    };
                    self.line(&format!("{mode}G1{linear}{turned}{feed}"));
                }
            }
        }
        Ok(())
    }

    fn pose_words(&self, pose: &Pose) -> Result<(String, String), RotaryError> {
        let Pose { index, tip, angles, .. } = *pose;
        let at = if self.form.tracks_tip() { tip } else { self.axes.linear(tip, angles) };
        let linear = words(index, LINEAR, at.map(|x| x * self.per_mm), &self.linear)?;
        Ok((linear, words(index, self.axes.axes().map(|axis| axis.letter), angles, &self.angle)?))
    }

    /// The feed, mm/min, of the way from one pose to another.
    fn feed_words(&mut self, feed: f64, [from, to]: [&Pose; 2]) -> Result<String, RotaryError> {
        let none = PostError::Feed { index: to.index, feed };
        if !self.form.tracks_tip() {
            let length = norm(difference(to.tip, from.tip));
            // a turn on the spot takes as long as a mm for each degree
            let turned = (0..2).map(|i| (to.angles[i] - from.angles[i]).abs()).fold(0.0, f64::max);
            let format = NumberFormat::plain(RATE_DECIMALS);
            let count = format.count(feed / if length > 0.0 { length } else { turned }).filter(|count| *count > 0);
            return Ok(format!(" F{}", format.text(count.ok_or(none)?)));
        }
        let format = self.machine.feed_format();
        let count = format.count(feed * self.per_mm * self.machine.feed_scale()).filter(|count| *count > 0);
        let count = count.ok_or(none)?;
        if self.feed.replace(count) == Some(count) {
            return Ok(String::new());
        }
        Ok(format!(" F{}", format.text(count)))
    }
}

fn words<const N: usize>(
    index: usize,
    letters: [char; N],
    values: [f64; N],
    format: &NumberFormat,
) -> Result<String, RotaryError> {
    let mut out = String::new();
    for (letter, value) in letters.into_iter().zip(values) {
        let of_move = || PostError::Number { what: "a word", place: format!("moves[{index}]"), value };
        let count = format.count(value).ok_or_else(of_move)?;
        out.push(' ');
        out.push(letter);
        format.write(&mut out, count);
    }
    Ok(out)
}

fn unsupported(what: &'static str) -> RotaryError {
    PostError::Unsupported { what }.into()
}

/// The tip, mm, and the unit vector from it up the tool, both in work coordinates.
pub type TipAndAxis = ([f64; 3], [f64; 3]);

/// The poses that text of [`rotary_text`] goes to, tip and tool direction in work coordinates: by what its words say, with the
/// kinematics forward.
///
/// # Errors
/// [`RotaryError::Text`]: words that are not written there.
pub fn read_rotary(
    text: &str,
    machine: &Machine,
    axes: &RotaryAxes,
    form: &RotaryText,
) -> Result<Vec<TipAndAxis>, RotaryError> {
    let letters = axes.axes().map(|axis| axis.letter);
    let (mut at, mut angles) = ([0.0; 3], [0.0; 2]);
    let mut poses = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let mut moved = false;
        for word in line.split_whitespace() {
            let fault = || RotaryError::Text { line: number + 1, word: word.into() };
            let mut characters = word.chars();
            let letter = characters.next().ok_or_else(fault)?;
            let number = characters.as_str().parse::<f64>().ok().filter(|number| number.is_finite());
            let value = || number.ok_or_else(fault);
            if let Some(i) = LINEAR.iter().position(|known| *known == letter) {
                at[i] = value()? * machine.units.output.in_mm();
                moved = true;
            } else if let Some(i) = letters.iter().position(|known| *known == letter) {
                angles[i] = value()?;
            } else if !"GMTSFH%N".contains(letter) {
                return Err(fault());
            }
        }
        if moved {
            let tip = if form.tracks_tip() { at } else { axes.tip(at, angles) };
            poses.push((tip, axes.direction(angles)));
        }
    }
    Ok(poses)
}

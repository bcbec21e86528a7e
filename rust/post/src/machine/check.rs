//! Checks on a machine file that its types do not make.

use super::error::MachineError;
use super::rules::ranges;
use super::rules::{CommentForm, Family, FeedMode, RotaryRules, SpeedUnit, ToolChange};
use super::values::{Machine, MACHINE_SCHEMA};
use crate::comment::CommentFormat;
use crate::number::MAX_DECIMALS;
use crate::rotary::RotaryAxes;
use crate::template::Templater;

impl Machine {
    /// Checks every value and compiles every template.
    ///
    /// # Errors
    /// [`MachineError`] for the first thing that is wrong.
    pub fn check(&self) -> Result<(), MachineError> {
        check(self)
    }
}

/// Finds the first thing that is wrong.
fn check(machine: &Machine) -> Result<(), MachineError> {
    check_schema(machine.schema)?;
    check_names(machine)?;
    check_numbers(machine)?;
    check_lines(machine)?;
    check_words(machine)?;
    check_tools(machine)?;
    check_smoothing(machine)?;
    check_arc(machine)?;
    check_limits(machine)?;
    check_rotary(machine)?;
    check_options(machine)?;
    check_reader(machine)?;
    Templater::new(machine).check()
}

fn wrong(key: &str, problem: impl Into<String>) -> MachineError {
    MachineError::Value { key: key.into(), problem: problem.into() }
}

fn require(holds: bool, key: &str, problem: &str) -> Result<(), MachineError> {
    if holds {
        Ok(())
    } else {
        Err(wrong(key, problem))
    }
}

fn check_schema(found: u32) -> Result<(), MachineError> {
    require(found >= 1, "schema", "schemas count from 1")?;
    if found > MACHINE_SCHEMA {
        return Err(MachineError::Schema { found, known: MACHINE_SCHEMA });
    }
    Ok(())
}

fn check_names(machine: &Machine) -> Result<(), MachineError> {
    require(!machine.name.trim().is_empty(), "name", "it is empty")?;
    require(!machine.wcs.is_empty(), "wcs", "list at least one work offset")?;
    for (index, wcs) in machine.wcs.iter().enumerate() {
        let words = wcs.split(' ').filter_map(crate::block::code).count();
        let written = wcs.split(' ').count();
        let holds = words == written && words <= 2;
        require(holds, &format!("wcs[{index}]"), "write one word or two, as in G54 or G54.1 P1")?;
    }
    let words = machine.wcs_words.len();
    require(words == 0 || words == machine.wcs.len(), "wcs_words", "one for each of wcs, in the same order, or none")?;
    if !machine.end.is_empty() {
        check_code("end", &machine.end)?;
    }
    if let Some(number) = machine.program.number {
        let holds = (number.least..=number.most).contains(&number.value) && number.digits <= 10;
        require(holds, "program.number", "its value lies between least and most, and it has at most 10 digits")?;
    }
    if let Some(name) = &machine.program.name {
        require(name.max_len >= 1, "program.name.max_len", "at least 1")?;
        require(ranges(&name.charset).iter().all(|(a, b)| a <= b), "program.name.charset", "a range runs backwards")?;
    }
    require(machine.units_word().is_some(), "units", "the word for the output's unit is missing")
}

/// A single word, a letter and a number: `G54`, `G59.1`, `M2`.
fn check_code(key: &str, code: &str) -> Result<(), MachineError> {
    require(crate::block::code(code).is_some(), key, "write one word: a capital letter and a number, as in G54")
}

fn check_numbers(machine: &Machine) -> Result<(), MachineError> {
    let number = &machine.number;
    for (key, places) in [
        ("number.mm.linear", number.mm.linear),
        ("number.mm.feed", number.mm.feed),
        ("number.inch.linear", number.inch.linear),
        ("number.inch.feed", number.inch.feed),
        ("number.rpm", number.rpm),
    ] {
        require(places <= MAX_DECIMALS, key, "at most 8 decimal places")?;
    }
    Ok(())
}

fn check_lines(machine: &Machine) -> Result<(), MachineError> {
    let line = &machine.line;
    require((20..=100_000).contains(&line.max_chars), "line.max_chars", "20 to 100000")?;
    let needed = "GMTSFXYZHNPQ0123456789.-";
    require(
        !line.forbidden.contains(|c| needed.contains(c)),
        "line.forbidden",
        "letters and digits of G-code must be allowed",
    )?;
    if let Some(length) = machine.comment.max_len {
        require((10..=100_000).contains(&length), "comment.max_len", "10 to 100000")?;
    }
    let set = machine.comment.charset.as_deref().unwrap_or(" -~");
    require(ranges(set).iter().all(|(a, b)| a <= b), "comment.charset", "a range runs backwards")?;
    let probe = CommentFormat::new(machine).lines("A 0");
    let silent = machine.comment.form == CommentForm::None;
    require(silent || !probe.is_empty(), "comment.charset", "neither letters nor digits are left")?;
    let Some(number) = &machine.block_number else { return Ok(()) };
    require(number.step >= 1, "block_number.step", "at least 1; leave the table out for none")?;
    require(number.start <= number.max, "block_number.max", "it is below the start")
}

fn check_words(machine: &Machine) -> Result<(), MachineError> {
    let optional = [
        ("units.mm", &machine.units.mm),
        ("units.inch", &machine.units.inch),
        ("spindle.clockwise", &machine.spindle.clockwise),
        ("spindle.counterclockwise", &machine.spindle.counterclockwise),
        ("spindle.off", &machine.spindle.off),
        ("coolant.flood", &machine.coolant.flood),
        ("coolant.off", &machine.coolant.off),
        ("coolant.mist", &machine.coolant.mist),
        ("stop.always", &machine.stop.always),
        ("stop.optional", &machine.stop.optional),
        ("feed.per_minute", &machine.feed.per_minute),
        ("feed.per_revolution", &machine.feed.per_revolution),
        ("feed.inverse_time", &machine.feed.inverse_time),
    ];
    for (key, word) in optional {
        if let Some(word) = word {
            check_code(key, word)?;
        }
    }
    let turns = machine.spindle.clockwise.is_some() || machine.spindle.counterclockwise.is_some();
    require(!turns || machine.spindle.off.is_some(), "spindle.off", "a spindle that starts needs a word to stop")?;
    let floods = machine.coolant.flood.is_some();
    require(!floods || machine.coolant.off.is_some(), "coolant.off", "coolant that starts needs a word to stop")?;
    let dwell = machine.dwell.as_ref().map_or('P', |d| d.word);
    require(matches!(dwell, 'P' | 'X' | 'S' | 'F' | 'K'), "dwell.word", "P, X, S, F or K")?;
    let start = machine.spindle.start_dwell;
    require((0.0..=600.0).contains(&start), "spindle.start_dwell", "0 to 600 s")?;
    require(start <= 0.0 || machine.dwell.is_some(), "spindle.start_dwell", "a wait needs the words of [dwell]")?;
    let percent = machine.spindle.unit == SpeedUnit::Percent;
    require(!percent || machine.limits.max_rpm.is_some(), "limits.max_rpm", "percent of what: name the largest speed")
}

fn check_tools(machine: &Machine) -> Result<(), MachineError> {
    let tool = &machine.tool;
    require(tool.max_number >= 1, "tool.max_number", "at least 1")?;
    if let Some(length) = &tool.length {
        check_code("tool.length.code", &length.code)?;
        require(matches!(length.word, 'H' | 'D'), "tool.length.word", "H or D")?;
        length.cancel.as_deref().map_or(Ok(()), |word| check_code("tool.length.cancel", word))?;
    }
    let lengths_matter = tool.change == ToolChange::Pause && tool.length.is_some();
    require(
        !lengths_matter || machine.templates.tool_change.is_some(),
        "templates.tool_change",
        "a pause with length offsets needs a template",
    )
}

fn check_smoothing(machine: &Machine) -> Result<(), MachineError> {
    let smoothing = &machine.smoothing;
    require((0.0..=10.0).contains(&smoothing.tolerance), "smoothing.tolerance", "0 to 10 mm")?;
    let exact = smoothing.tolerance <= 0.0;
    require(exact || smoothing.on.is_some(), "smoothing.on", "a tolerance needs the block that sets it")?;
    let rounded_away = !exact && crate::template::tolerance_words(machine).is_none();
    require(
        !rounded_away,
        "smoothing.tolerance",
        "it is smaller than the last decimal of the numbers; take 0 for an exact path",
    )
}

fn check_arc(machine: &Machine) -> Result<(), MachineError> {
    let holes = machine.motion.lathe.is_some() && machine.cycle.is_some();
    require(!holes, "cycle", "a machine of X and Z has no drilling cycles of a mill: write cycle = false")?;
    let Some(arc) = &machine.arc else { return Ok(()) };
    require((10.0..=360.0).contains(&arc.max_sweep_deg), "arc.max_sweep_deg", "10 to 360")?;
    require((0.0..=1e6).contains(&arc.min_radius), "arc.min_radius", "0 or more, in mm")?;
    require(arc.max_radius.is_none_or(|r| r > arc.min_radius), "arc.max_radius", "above min_radius, in mm")?;
    require(matches!(arc.radius_word.as_str(), "" | "R" | "L"), "arc.radius_word", "R, L, or nothing")?;
    let error = arc.radius_error;
    for (key, value) in [("absolute", error.absolute), ("relative", error.relative), ("most", error.most)] {
        require((0.0..=10.0).contains(&value), &format!("arc.radius_error.{key}"), "0 to 10")?;
    }
    Ok(())
}

fn check_limits(machine: &Machine) -> Result<(), MachineError> {
    let limits = &machine.limits;
    for (key, range) in [("limits.x", limits.x), ("limits.y", limits.y), ("limits.z", limits.z)] {
        let holds = range.is_none_or(|[a, b]| a.is_finite() && b.is_finite() && a < b);
        require(holds, key, "lowest, then highest, in mm")?;
    }
    let travel = limits.travel.is_none_or(|t| t.iter().all(|l| positive(*l)));
    require(travel, "limits.travel", "three lengths above 0, in mm")?;
    require(limits.max_feed.is_none_or(positive), "limits.max_feed", "above 0, in mm/min")?;
    require(positive(limits.rapid_rate), "limits.rapid_rate", "above 0, in mm/min")?;
    require(limits.acceleration.is_none_or(positive), "limits.acceleration", "above 0, in mm/s^2")?;
    let each = |values: Option<[f64; 3]>| values.is_none_or(|v| v.iter().all(|x| positive(*x)));
    require(each(limits.axis_rate), "limits.axis_rate", "three speeds above 0, in mm/min")?;
    require(each(limits.axis_acceleration), "limits.axis_acceleration", "three accelerations above 0, in mm/s^2")?;
    require(
        limits.corner_tolerance.is_none_or(|t| (0.0..=10.0).contains(&t)),
        "limits.corner_tolerance",
        "0 to 10 mm",
    )?;
    require(limits.blocks_per_second.is_none_or(positive), "limits.blocks_per_second", "above 0")?;
    let (slowest, fastest) = (limits.min_rpm.unwrap_or(0.0), limits.max_rpm.unwrap_or(f64::INFINITY));
    require(slowest.is_finite() && slowest >= 0.0, "limits.min_rpm", "0 or more, in rev/min")?;
    require(limits.max_rpm.is_none_or(positive), "limits.max_rpm", "above 0, in rev/min")?;
    require(limits.max_axial_force.is_none_or(positive), "limits.max_axial_force", "above 0, in N")?;
    require(slowest <= fastest, "limits.min_rpm", "it is above max_rpm")
}

fn positive(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

fn check_rotary(machine: &Machine) -> Result<(), MachineError> {
    let Some(rules) = &machine.rotary else { return Ok(()) };
    require(machine.family == Family::Gcode, "rotary", "rotary axes are written as G-code only, family = \"gcode\"")?;
    require(machine.motion.lathe.is_none(), "rotary", "a machine of X and Z has no rotary axes here")?;
    RotaryAxes::new(rules.axes)?;
    let places = rules.angle_decimals;
    require((1..=MAX_DECIMALS).contains(&places), "rotary.angle_decimals", "1 to 8 decimal places")?;
    let tolerance = rules.tip_tolerance;
    require((1e-6..=10.0).contains(&tolerance), "rotary.tip_tolerance", "0.000001 to 10 mm")?;
    check_tip_control(rules)?;
    let timed = machine.feed.mode == FeedMode::InverseTime && machine.feed.inverse_time.is_some();
    require(
        rules.tip_control.is_some() || timed,
        "feed.mode",
        "rotary axes without rotary.tip_control need feeds in inverse time: write mode = \"inverse-time\" and inverse_time, its code",
    )
}

fn check_tip_control(rules: &RotaryRules) -> Result<(), MachineError> {
    let Some(control) = &rules.tip_control else { return Ok(()) };
    for (key, block) in [("on", &control.on), ("off", &control.off)] {
        let one = block.lines().count() == 1;
        require(one, &format!("rotary.tip_control.{key}"), "one block")?;
    }
    let [on, off] = control.codes();
    require(on.is_some(), "rotary.tip_control.on", "begin with a code, as in G43.4 H{{ tool.length_offset }}")?;
    require(off.is_some() && off != on, "rotary.tip_control.off", "begin with a code other than that of on, as in G49")
}

fn check_options(machine: &Machine) -> Result<(), MachineError> {
    for (name, rule) in &machine.options {
        if let Some(problem) = rule.refuses(&rule.value) {
            return Err(MachineError::Option { name: name.clone(), problem });
        }
    }
    Ok(())
}

fn check_reader(machine: &Machine) -> Result<(), MachineError> {
    for (index, code) in machine.reader.refused.iter().enumerate() {
        check_code(&format!("reader.refused[{index}]"), code)?;
    }
    for (index, code) in machine.reader.passed.iter().enumerate() {
        check_code(&format!("reader.passed[{index}]"), code)?;
    }
    Ok(())
}

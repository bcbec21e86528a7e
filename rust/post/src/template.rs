//! The text around the moves: a machine's templates, filled in by minijinja with bounded work and no names undefined.

use std::collections::BTreeMap;

use minijinja::{Environment, Error, UndefinedBehavior, Value};
use styluscam_motion::{EventKind, MoveKind, OperationRecord, Program, ToolRecord, ToolReference};

use crate::comment::CommentFormat;
use crate::machine::{Evidence, LengthUnit, Machine, MachineError, OptionValue, ToolChange};
use crate::names::unknown_name;
use crate::number::NumberFormat;

/// Most steps that one template may take: a header of a thousand lines needs a fiftieth of it.
const FUEL: u64 = 1_000_000;

/// Most recursion that one template may take.
const RECURSION: usize = 50;

const HEADER: &str = include_str!("../templates/header.jinja");
const CHANGE_M6: &str = include_str!("../templates/change_m6.jinja");
const CHANGE_PAUSE: &str = include_str!("../templates/change_pause.jinja");
const CHANGE_T: &str = include_str!("../templates/change_t.jinja");
const CHANGE_TOOL_CALL: &str = include_str!("../templates/change_tool_call.jinja");
const CHANGE_LOADED: &str = include_str!("../templates/change_loaded.jinja");
const CHANGE_NOT_STATED: &str = include_str!("../templates/change_unsaid.jinja");

/// What the templates state about a program as a whole, over and above its records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facts {
    /// Lowest Z of a tip at feed, mm.
    pub deepest_z: f64,
    /// Whether the spindle turns.
    pub uses_spindle: bool,
}

impl Facts {
    /// Those of a whole program.
    #[must_use]
    pub fn of(program: &Program) -> Self {
        let uses_spindle = program.events.iter().any(|e| matches!(e.kind, EventKind::SpindleOn { .. }));
        Self { deepest_z: deepest(program), uses_spindle }
    }
}

/// Names and values that a template may use.
type Names = BTreeMap<String, Value>;

/// Fills in one machine's templates.
pub(crate) struct Templater<'m> {
    machine: &'m Machine,
    environment: Environment<'m>,
}

impl<'m> Templater<'m> {
    /// Templates of `machine`.
    pub(crate) fn new(machine: &'m Machine) -> Self {
        let mut environment = Environment::new();
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment.set_fuel(Some(FUEL));
        environment.set_recursion_limit(RECURSION);
        environment.set_auto_escape_callback(|_| minijinja::AutoEscape::None);
        let mut syntax = minijinja::syntax::SyntaxConfig::builder();
        syntax.trim_blocks(true).lstrip_blocks(true);
        if let Ok(syntax) = syntax.build() {
            environment.set_syntax(syntax);
        }
        add_functions(&mut environment, machine);
        Self { machine, environment }
    }

    /// Compiles every template.
    pub(crate) fn check(&self) -> Result<(), MachineError> {
        for (name, source) in self.all() {
            let used = self.compile(name, source)?.undeclared_variables(true);
            if let Some(error) = unknown_name(name, source, used.iter().map(String::as_str)) {
                return Err(error);
            }
        }
        Ok(())
    }

    fn all(&self) -> Vec<(&'static str, &'m str)> {
        let templates = &self.machine.templates;
        vec![
            ("templates.header", self.header_source()),
            ("templates.program_start", &templates.program_start),
            ("templates.tool_change", self.tool_change_source()),
            ("templates.operation_start", &templates.operation_start),
            ("templates.operation_end", &templates.operation_end),
            ("templates.stop", templates.stop.as_deref().unwrap_or_default()),
            ("templates.work_offset", templates.work_offset.as_deref().unwrap_or_default()),
            ("templates.sync", templates.sync.as_deref().unwrap_or_default()),
            ("retract.lines", &self.machine.retract.lines),
            ("templates.program_end", &templates.program_end),
            ("smoothing.on", self.machine.smoothing.on.as_deref().unwrap_or_default()),
            ("rotary.tip_control.on", self.tip_control_source()),
        ]
    }

    fn compile(&self, name: &'m str, source: &'m str) -> Result<minijinja::Template<'_, 'm>, MachineError> {
        self.environment.template_from_named_str(name, source).map_err(|e| failure(name, &e))
    }

    fn fill(&self, name: &'m str, source: &'m str, names: &Names) -> Result<String, MachineError> {
        self.compile(name, source)?.render(Value::from(names.clone())).map_err(|e| failure(name, &e))
    }

    fn header_source(&self) -> &'m str {
        self.machine.templates.header.as_deref().unwrap_or(HEADER)
    }

    fn tool_change_source(&self) -> &'m str {
        self.machine.templates.tool_change.as_deref().unwrap_or(match self.machine.tool.change {
            ToolChange::M6 => CHANGE_M6,
            ToolChange::T => CHANGE_T,
            ToolChange::ToolCall => CHANGE_TOOL_CALL,
            ToolChange::Pause => CHANGE_PAUSE,
            ToolChange::LoadBeforeStart => CHANGE_LOADED,
            ToolChange::Unsaid => CHANGE_NOT_STATED,
        })
    }

    fn tip_control_source(&self) -> &'m str {
        let control = self.machine.rotary.as_ref().and_then(|rules| rules.tip_control.as_ref());
        control.map(|control| control.on.as_str()).unwrap_or_default()
    }

    /// What every template may use.
    pub(crate) fn names(&self, program: &Program, facts: &Facts) -> Result<Names, MachineError> {
        let machine = self.machine;
        let mut names = Names::new();
        let mut name = |key: &str, value: Value| names.insert(key.into(), value);
        name(
            "machine",
            map([
                ("name", machine.name.as_str().into()),
                ("description", machine.description.as_str().into()),
                ("verified", (machine.source.evidence != Evidence::Unverified).into()),
                ("unconfirmed", machine.source.unconfirmed.iter().map(String::as_str).collect()),
            ]),
        );
        name("program", program_value(program, facts, machine));
        name("tools", program.tools.iter().map(tool_value).collect());
        name("units", unit_name(machine.units.output).into());
        name("units_word", machine.units_word().unwrap_or_default().into());
        name("feed_word", machine.feed.word().unwrap_or_default().into());
        wcs_names(machine, &program.setup.wcs).into_iter().for_each(|(key, value)| _ = name(&key, value));
        name("end", machine.end.as_str().into());
        name("options", Value::from(options(machine)));
        name("has_length_offsets", machine.tool.length.is_some().into());
        name("length_with_z", machine.tool.length.as_ref().is_some_and(|length| length.with_z).into());
        name("path_tolerance", path_tolerance(machine).into());
        names.insert("retract".into(), self.fill("retract.lines", &machine.retract.lines, &names)?.into());
        let smoothing = self.smoothing()?;
        names.insert("smoothing".into(), smoothing.into());
        let header = self.fill("templates.header", self.header_source(), &names)?;
        names.insert("header".into(), header.into());
        Ok(names)
    }

    /// The block that states how closely the path is kept.
    pub(crate) fn smoothing(&self) -> Result<String, MachineError> {
        let smoothing = &self.machine.smoothing;
        match (&smoothing.on, tolerance_words(self.machine)) {
            (Some(source), Some(tolerance)) => {
                let names = Names::from([("tolerance".to_string(), tolerance.into())]);
                self.fill("smoothing.on", source, &names)
            }
            _ => Ok(smoothing.off.clone().unwrap_or_default()),
        }
    }

    /// The text before everything else.
    pub(crate) fn program_start(&self, names: &Names) -> Result<String, MachineError> {
        self.fill("templates.program_start", &self.machine.templates.program_start, names)
    }

    /// The text after everything else.
    pub(crate) fn program_end(&self, names: &Names) -> Result<String, MachineError> {
        self.fill("templates.program_end", &self.machine.templates.program_end, names)
    }

    /// The text of a tool change; `first` when no tool was called before, `next` the number of the one that comes after it.
    pub(crate) fn tool_change(
        &self,
        names: &Names,
        tool: &ToolRecord,
        first: bool,
        next: Option<u32>,
    ) -> Result<String, MachineError> {
        let mut names = names.clone();
        names.insert("next_tool".into(), next.filter(|_| self.machine.tool.preselect).unwrap_or(0).into());
        names.insert("tool".into(), tool_value(tool));
        let length = self.machine.tool.length.as_ref();
        let length_words = length.map(|l| format!("{} {}{}", l.code, l.word, tool.length_offset)).unwrap_or_default();
        names.insert("length_words".into(), length_words.into());
        names.insert("first".into(), first.into());
        self.fill("templates.tool_change", self.tool_change_source(), &names)
    }

    /// The block from which on the control tracks the tip of a tool.
    pub(crate) fn tip_control(&self, names: &Names, tool: &ToolRecord) -> Result<String, MachineError> {
        let mut names = names.clone();
        names.insert("tool".into(), tool_value(tool));
        self.fill("rotary.tip_control.on", self.tip_control_source(), &names)
    }

    /// The text where an operation begins.
    pub(crate) fn operation_start(&self, names: &Names, operation: &OperationRecord) -> Result<String, MachineError> {
        let names = with_operation(names, operation);
        self.fill("templates.operation_start", &self.machine.templates.operation_start, &names)
    }

    /// The text where an operation ends.
    pub(crate) fn operation_end(&self, names: &Names, operation: &OperationRecord) -> Result<String, MachineError> {
        let source = &self.machine.templates.operation_end;
        if source.is_empty() {
            return Ok(String::new());
        }
        self.fill("templates.operation_end", source, &with_operation(names, operation))
    }

    /// The text where the work offset changes to the one of this name.
    pub(crate) fn work_offset(&self, names: &Names, wcs: &str) -> Result<String, MachineError> {
        let mut names = names.clone();
        names.extend(wcs_names(self.machine, wcs));
        self.fill("templates.work_offset", self.machine.templates.work_offset.as_deref().unwrap_or("{{ wcs }}"), &names)
    }

    /// The text where the program stops for the operator.
    pub(crate) fn stop(&self, names: &Names, optional: bool) -> Result<String, MachineError> {
        let mut names = names.clone();
        names.insert("optional".into(), optional.into());
        self.fill("templates.stop", self.machine.templates.stop.as_deref().unwrap_or_default(), &names)
    }

    /// The text where the programs of a pair wait for one another.
    pub(crate) fn sync(&self, names: &Names, mark: u32) -> Result<String, MachineError> {
        let mut names = names.clone();
        names.insert("mark".into(), mark.into());
        self.fill("templates.sync", self.machine.templates.sync.as_deref().unwrap_or_default(), &names)
    }
}

fn with_operation(names: &Names, operation: &OperationRecord) -> Names {
    let mut names = names.clone();
    let record = [("id", operation.id.as_str().into()), ("kind", operation.kind.as_str().into())];
    names.insert("operation".into(), map(record));
    names
}

/// The controller's words for a work offset, and which one it is, from 1.
fn wcs_names(machine: &Machine, wcs: &str) -> [(String, Value); 2] {
    let words = machine.wcs_words_of(wcs).unwrap_or_default();
    let number = machine.wcs.iter().position(|name| name == wcs).map_or(0, |index| index + 1);
    [("wcs".into(), words.into()), ("wcs_number".into(), number.into())]
}

/// What the controller may do to the path, in words.
fn path_tolerance(machine: &Machine) -> String {
    match (&machine.smoothing.on, machine.smoothing.tolerance > 0.0) {
        (Some(_), true) => format!("{} mm", machine.smoothing.tolerance),
        (_, false) if machine.smoothing.off.is_some() => "exact".into(),
        _ => "unknown: the controller decides".into(),
    }
}

fn failure(name: &str, error: &Error) -> MachineError {
    let message = error.detail().map_or_else(|| error.kind().to_string(), |d| format!("{}: {d}", error.kind()));
    MachineError::Template { name: name.into(), line: error.line().unwrap_or(1), message }
}

fn add_functions(environment: &mut Environment, machine: &Machine) {
    let comments = CommentFormat::new(machine);
    environment.add_function("comment", move |text: String| comments.lines(&text).join("\n"));
    let (linear, unit) = (machine.linear_format(), machine.units.output);
    environment.add_function("length", move |mm: f64| words(linear, mm / unit.in_mm()));
    let feed = machine.feed_format();
    environment.add_function("feed", move |mm_per_min: f64| words(feed, mm_per_min / unit.in_mm()));
}

fn words(format: NumberFormat, value: f64) -> String {
    let mut out = String::new();
    match format.count(value) {
        Some(count) => format.write(&mut out, count),
        None => out.push_str("unknown"),
    }
    out
}

/// The smoothing tolerance in output units, rounded down; none when nothing is left of it.
///
/// It carries two decimals more than coordinates do, so that rounding takes little of it.
pub(crate) fn tolerance_words(machine: &Machine) -> Option<String> {
    let format = NumberFormat::plain(machine.decimals().linear.saturating_add(2));
    let exact = machine.smoothing.tolerance / machine.units.output.in_mm() * format.per_one();
    // A part in 1e9 keeps 0.002 from becoming 0.00199 by the rounding of binary fractions.
    let count = crate::number::whole((exact * (1.0 + 1e-9)).floor()).filter(|c| *c > 0)?;
    let mut out = String::new();
    format.write(&mut out, count);
    Some(out)
}

fn map<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::from(entries.into_iter().map(|(k, v)| (k.to_string(), v)).collect::<Names>())
}

fn program_value(program: &Program, facts: &Facts, machine: &Machine) -> Value {
    let setup = &program.setup;
    map([
        ("number", program_number(machine).into()),
        ("name", machine.program.name.as_ref().map(|rules| rules.of(&setup.title)).unwrap_or_default().into()),
        ("title", setup.title.as_str().into()),
        ("wcs", setup.wcs.as_str().into()),
        ("zero", setup.zero.as_str().into()),
        ("part_min", setup.part_min.into_iter().collect()),
        ("part_max", setup.part_max.into_iter().collect()),
        ("clearance", setup.clearance.into()),
        ("deepest_z", facts.deepest_z.into()),
        ("notes", setup.notes.iter().map(String::as_str).collect()),
        ("uses_spindle", facts.uses_spindle.into()),
    ])
}

/// `0001`; nothing where programs have no numbers.
fn program_number(machine: &Machine) -> String {
    let format = |n: crate::machine::ProgramNumber| format!("{:0width$}", n.value, width = usize::from(n.digits));
    machine.program.number.map(format).unwrap_or_default()
}

fn tool_value(tool: &ToolRecord) -> Value {
    let reference = if tool.reference == ToolReference::Tip { "tip" } else { "center" };
    map([
        ("name", tool.name.as_str().into()),
        ("number", tool.number.into()),
        ("length_offset", tool.length_offset.into()),
        ("description", tool.description.as_str().into()),
        ("reference", reference.into()),
        ("reference_height", tool.reference_height.into()),
        ("diameter", tool.diameter.into()),
    ])
}

fn options(machine: &Machine) -> Names {
    machine.options.iter().map(|(name, rule)| (name.clone(), option_value(&rule.value))).collect()
}

fn option_value(value: &OptionValue) -> Value {
    match value {
        OptionValue::Switch(on) => (*on).into(),
        OptionValue::Number(number) => (*number).into(),
        OptionValue::Text(text) => text.as_str().into(),
    }
}

fn unit_name(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::Mm => "mm",
        LengthUnit::Inch => "inch",
    }
}

/// Lowest Z of a tip at feed, mm; of any move when none is at feed.
fn deepest(program: &Program) -> f64 {
    let lowest = |at_feed: bool| {
        let moves = program.segments().filter(|(_, m)| !at_feed || m.kind == MoveKind::Feed);
        moves.map(|(start, m)| m.bounds(start).0[2]).fold(f64::INFINITY, f64::min)
    };
    let at_feed = lowest(true);
    if at_feed.is_finite() {
        at_feed
    } else {
        lowest(false)
    }
}

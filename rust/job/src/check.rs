//! What serde cannot know: ranges, and keys that belong together.

use crate::fixture::{FixtureSection, Opening};
use crate::{
    JobDocument, JobError, LengthUnit, MachineSection, OperationKind, OperationSection, Process, ProcessSection,
    Selection, Step, Zero,
};

/// A key, the range of its value (the lower end excluded where `open`), and the range in words.
struct Range {
    key: &'static str,
    low: f64,
    open: bool,
    high: f64,
    words: &'static str,
}

const fn above_zero(key: &'static str, high: f64, words: &'static str) -> Range {
    Range { key, low: 0.0, open: true, high, words }
}

/// Ranges by the end of the key's path.
const RANGES: &[Range] = &[
    Range { key: "part.tolerance", low: 1e-4, open: false, high: 1.0, words: "0.0001 to 1 mm" },
    Range { key: "setup.rotation", low: -360.0, open: false, high: 360.0, words: "-360 to 360 degrees" },
    above_zero("setup.clearance", 1000.0, "above 0 and up to 1000 mm"),
    Range { key: "setup.retract", low: 0.1, open: false, high: 1000.0, words: "0.1 to 1000 mm" },
    above_zero("sheet.thickness", 50.0, "above 0 and up to 50 mm"),
    above_zero("sheet.min_thickness", 50.0, "above 0 and up to 50 mm"),
    Range { key: "max_wall_angle_deg", low: 1.0, open: false, high: 90.0, words: "1 to 90 degrees" },
    Range { key: "max_bridged", low: 0.0, open: false, high: 1000.0, words: "0 to 1000 mm" },
    Range { key: "max_unreached", low: 0.0, open: false, high: 1.0, words: "0 to 1" },
    Range { key: "fixture.margin", low: 0.0, open: false, high: 100.0, words: "0 to 100 mm" },
    above_zero("clamp.height", 500.0, "above 0 and up to 500 mm"),
    above_zero("opening", 1e4, "above 0 and up to 10000 mm"),
    Range { key: "fixture.center", low: -1e5, open: false, high: 1e5, words: "-100000 to 100000 mm" },
    above_zero("step.height", 100.0, "above 0 and up to 100 mm"),
    above_zero("stepover", 100.0, "above 0 and up to 100 mm"),
    Range { key: "angle_deg", low: -360.0, open: false, high: 360.0, words: "-360 to 360 degrees" },
    Range { key: "tolerance", low: 1e-4, open: false, high: 1.0, words: "0.0001 to 1 mm" },
    Range { key: "smallest_feature", low: 0.01, open: false, high: 100.0, words: "0.01 to 100 mm" },
    Range { key: "feeds.cut", low: 0.1, open: false, high: 1e5, words: "0.1 to 100000 mm/min" },
    Range { key: "feeds.plunge", low: 0.1, open: false, high: 1e5, words: "0.1 to 100000 mm/min" },
    above_zero("spindle.rpm", 1e6, "above 0 and up to 1000000 rev/min"),
    Range { key: "z_top", low: -1e4, open: false, high: 1e4, words: "-10000 to 10000 mm" },
    Range { key: "z_bottom", low: -1e4, open: false, high: 1e4, words: "-10000 to 10000 mm" },
];

/// Keys that hold tables, by the end of their path, and what such a table looks like.
const TABLES: &[(&str, &str)] = &[
    ("step", "a table like { height = 0.5 }"),
    ("feeds", "a table like { cut = 1500.0, plunge = 300.0 }"),
    ("spindle", "a table like { mode = \"off\" }"),
    ("profile", "a table like { kind = \"ball\", diameter = 10.0 }"),
    ("sheet", "a table like { thickness = 1.0 }"),
    ("fixture", "a table like { clamp = { opening = [200.0, 150.0], height = 8.0 } }"),
    ("clamp", "a table like { opening = [200.0, 150.0], height = 8.0 }"),
    ("backing", "a table like { opening = 160.0 }"),
];

/// What is allowed at a path of the document, in words and in its unit, where that is known.
pub fn allowed(place: &str, unit: LengthUnit) -> Option<String> {
    let key = place.rsplit('.').next().unwrap_or(place);
    let table = TABLES.iter().find(|(name, _)| *name == key).map(|(_, words)| (*words).to_owned());
    range_of(place).map(|range| range.in_words(unit)).or(table)
}

impl Range {
    /// The range in a document's unit.
    fn in_words(&self, unit: LengthUnit) -> String {
        let (bounds, dimension) = self.words.rsplit_once(' ').unwrap_or((self.words, ""));
        let Some(per) = dimension.strip_prefix("mm").filter(|_| !unit.is_mm()) else { return self.words.to_owned() };
        let [low, high] = [self.low, self.high].map(|mm| unit.shown(mm));
        let above = bounds.starts_with("above");
        let bounds = if above { format!("above {low} and up to {high}") } else { format!("{low} to {high}") };
        format!("{bounds} {}{per}", unit.name())
    }

    fn holds(&self, value: f64) -> bool {
        let low = if self.open { value > self.low } else { value >= self.low };
        low && value <= self.high
    }
}

fn range_of(place: &str) -> Option<&'static Range> {
    RANGES.iter().find(|range| place == range.key || place.ends_with(&format!(".{}", range.key)))
}

/// Checks ranges and combinations.
pub fn document(job: &JobDocument) -> Result<(), JobError> {
    number("part.tolerance", job.part.tolerance)?;
    some_face("part.faces", &job.part.faces)?;
    setup(job)?;
    process(&job.process)?;
    machine(&job.machine)?;
    tools(job)?;
    if job.operations.is_empty() {
        return Err(JobError::document(
            "empty",
            "operations",
            "the job has no operation",
            "add an [[operations]] table",
        ));
    }
    for (i, operation) in job.operations.iter().enumerate() {
        self::operation(job, &format!("operations[{i}]"), operation)?;
    }
    ids(&job.operations)
}

/// No two operations have one name.
fn ids(operations: &[OperationSection]) -> Result<(), JobError> {
    let mut known = std::collections::BTreeMap::new();
    for (index, operation) in operations.iter().enumerate() {
        let id = crate::plan::operation_id(operation, index);
        if let Some(other) = known.insert(id.clone(), index) {
            let message = format!("operations[{other}] and operations[{index}] are both called {id:?}");
            return Err(JobError::document(
                "conflict",
                format!("operations[{index}].id"),
                message,
                "give each its own",
            ));
        }
    }
    Ok(())
}

fn some_face(place: &str, selection: &Selection) -> Result<(), JobError> {
    match selection {
        Selection::Named(names) if names.is_empty() => {
            Err(JobError::document("empty", place, "no face is named", "name one, or write \"all\""))
        }
        _ => Ok(()),
    }
}

fn number(place: &str, value: f64) -> Result<(), JobError> {
    in_range(place, value, value, LengthUnit::Mm)
}

/// Whether a value (in mm where it is a length) is in its key's range; `written` is what the document says, in its unit.
pub fn in_range(place: &str, value: f64, written: f64, unit: LengthUnit) -> Result<(), JobError> {
    let Some(range) = range_of(place) else { return Ok(()) };
    if range.holds(value) {
        return Ok(());
    }
    let key = place.rsplit('.').next().unwrap_or(place);
    Err(JobError::document(
        "out-of-range",
        place,
        format!("{key} = {}: allowed is {}", shown(written), range.in_words(unit)),
        "correct the value",
    ))
}

/// A number as people write it, without hundreds of zeros.
pub fn shown(value: f64) -> String {
    if value == 0.0 || (1e-5..1e9).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

fn setup(job: &JobDocument) -> Result<(), JobError> {
    let setup = &job.setup;
    number("setup.rotation", setup.rotation)?;
    number("setup.clearance", setup.clearance)?;
    number("setup.retract", setup.retract)?;
    if setup.retract > setup.clearance {
        let [retract, clearance] = [setup.retract, setup.clearance].map(|mm| job.units.shown(mm));
        let message = format!("retract = {retract} is above clearance = {clearance}");
        return Err(JobError::document("conflict", "setup.retract", message, "lower retract or raise clearance"));
    }
    if let Some(Zero::Point(point)) = setup.zero {
        if !point.iter().all(|x| x.is_finite() && x.abs() <= 1e5) {
            return Err(JobError::document(
                "out-of-range",
                "setup.zero",
                format!("zero is not a point of this world: up to {} {}", job.units.shown(1e5), job.units.name()),
                format!("give {}", job.units.name()),
            ));
        }
    }
    match (job.process.kind, setup.sheet) {
        (Process::Spif, None) => Err(JobError::document(
            "conflict",
            "setup.sheet",
            "process.kind = \"spif\" forms a sheet, and there is none",
            "add [setup.sheet] with its thickness, or set process.kind = \"milling\"",
        )),
        (Process::Milling, Some(_)) => Err(JobError::document(
            "conflict",
            "setup.sheet",
            "process.kind = \"milling\" has no sheet",
            "remove [setup.sheet], or set process.kind = \"spif\"",
        )),
        (_, Some(sheet)) => {
            number("setup.sheet.thickness", sheet.thickness)?;
            number("setup.sheet.min_thickness", sheet.min_thickness.unwrap_or(sheet.thickness))?;
            if sheet.min_thickness.is_some_and(|least| least > sheet.thickness) {
                return Err(JobError::document(
                    "conflict",
                    "setup.sheet.min_thickness",
                    "the sheet is thinner than that before it is formed",
                    "make min_thickness smaller than thickness",
                ));
            }
            number("setup.sheet.max_wall_angle_deg", sheet.max_wall_angle_deg.unwrap_or(90.0))?;
            if let Some(fixture) = &setup.fixture {
                self::fixture(fixture, setup.clearance, job.units)?;
            }
            if job.part.model_face.is_none() {
                return Err(JobError::document(
                    "missing",
                    "part.model_face",
                    "with a sheet, model_face must say which of its faces the model shows",
                    "add model_face = \"tool\", \"back\" or \"mid\" to [part]",
                ));
            }
            Ok(())
        }
        (_, None) => without_sheet(job),
    }
}

fn process(process: &ProcessSection) -> Result<(), JobError> {
    process.material.as_deref().map_or(Ok(()), crate::materials::check)?;
    number("process.max_bridged", process.max_bridged.unwrap_or(0.0))?;
    number("process.max_unreached", process.max_unreached)
}

/// Openings and heights, and that rapids pass over the clamp.
fn fixture(fixture: &FixtureSection, clearance: f64, unit: LengthUnit) -> Result<(), JobError> {
    number("setup.fixture.margin", fixture.margin)?;
    fixture.center.iter().flatten().try_for_each(|x| number("setup.fixture.center", *x))?;
    let openings = [
        ("setup.fixture.clamp.opening", fixture.clamp.map(|clamp| clamp.opening)),
        ("setup.fixture.backing.opening", fixture.backing.map(|backing| backing.opening)),
    ];
    for (place, opening) in openings {
        opening.into_iter().flat_map(Opening::sides).try_for_each(|side| number(place, side))?;
    }
    let Some(clamp) = fixture.clamp else { return Ok(()) };
    number("setup.fixture.clamp.height", clamp.height)?;
    if clamp.height + fixture.margin <= clearance {
        return Ok(());
    }
    let [height, least, clearance] = [clamp.height, clamp.height + fixture.margin, clearance].map(|mm| unit.shown(mm));
    let message =
        format!("clearance = {clearance}: rapids would cross the clamp, {height} {} high, too near to it", unit.name());
    let hint = format!("raise clearance to {least} or more");
    Err(JobError::document("conflict", "setup.clearance", message, hint))
}

fn without_sheet(job: &JobDocument) -> Result<(), JobError> {
    if job.setup.zero == Some(Zero::SheetTop) {
        let message = "zero = \"sheet-top\" without a sheet";
        return Err(JobError::document("conflict", "setup.zero", message, "write \"model\" or a point [x, y, z]"));
    }
    if job.setup.fixture.is_some() {
        let message = "a fixture holds a sheet, and there is none";
        return Err(JobError::document("conflict", "setup.fixture", message, "remove it, or add [setup.sheet]"));
    }
    if job.part.model_face.is_some() {
        let message = "model_face says which face of the sheet the model shows, and there is no sheet";
        return Err(JobError::document("conflict", "part.model_face", message, "remove it, or add [setup.sheet]"));
    }
    Ok(())
}

fn machine(section: &MachineSection) -> Result<(), JobError> {
    match (&section.name, &section.file) {
        (Some(_), None) | (None, Some(_)) => Ok(()),
        _ => Err(JobError::document(
            "conflict",
            "machine",
            "a machine has either a name or a file",
            format!("write name = one of {}", styluscam_post::shipped().join(", ")),
        )),
    }
}

fn tools(job: &JobDocument) -> Result<(), JobError> {
    let mut numbers = std::collections::BTreeMap::new();
    for (name, tool) in &job.tools {
        if tool.profile.is_some() == tool.library.is_some() {
            let message = format!("tool {name} has either a profile or a library, and needs one");
            let hint = "add profile = { kind = \"ball\", diameter = 10.0 }, or library = \"hemisphere-d10\"";
            return Err(JobError::document("conflict", format!("tools.{name}"), message, hint));
        }
        if tool.length_offset == Some(0) {
            let place = format!("tools.{name}.length_offset");
            let message = "length_offset = 0 means no length offset at all";
            return Err(JobError::document("out-of-range", place, message, "give 1 or more, or leave it out"));
        }
        if let Some(other) = numbers.insert(tool.number, name) {
            let message = format!("tools {other} and {name} have the same number {}", tool.number);
            return Err(JobError::document("conflict", format!("tools.{name}.number"), message, "give each its own"));
        }
    }
    Ok(())
}

fn operation(job: &JobDocument, place: &str, operation: &OperationSection) -> Result<(), JobError> {
    let at = |key: &str| format!("{place}.{key}");
    if !job.tools.contains_key(&operation.tool) {
        let known: Vec<&str> = job.tools.keys().map(String::as_str).collect();
        let message = format!("no tool is called {:?}", operation.tool);
        return Err(JobError::document("unknown", at("tool"), message, format!("the job has {}", known.join(", "))));
    }
    if let Some(selection) = &operation.faces {
        some_face(&at("faces"), selection)?;
    }
    number(&at("angle_deg"), operation.angle_deg)?;
    number(&at("tolerance"), operation.tolerance)?;
    number(&at("smallest_feature"), operation.smallest_feature)?;
    number(&at("feeds.cut"), operation.feeds.cut)?;
    number(&at("feeds.plunge"), operation.feeds.plunge)?;
    if let crate::Spindle::Fixed { rpm, .. } = operation.spindle {
        number(&at("spindle.rpm"), rpm)?;
    }
    if let Some(Step::Height(height)) = operation.step {
        number(&at("step.height"), height)?;
    }
    if let Some(stepover) = operation.stepover {
        number(&at("stepover"), stepover)?;
    }
    heights(place, operation, job.units)?;
    match operation.kind {
        OperationKind::ZLevel if operation.step.is_none() => {
            Err(JobError::document("missing", at("step"), "z-level needs a step", "add step = { height = 0.5 }"))
        }
        OperationKind::ZigZag if operation.stepover.is_none() => {
            Err(JobError::document("missing", at("stepover"), "zig-zag needs a stepover", "add stepover = 0.5"))
        }
        _ => Ok(()),
    }
}

fn heights(place: &str, operation: &OperationSection, unit: LengthUnit) -> Result<(), JobError> {
    for (key, value) in [("z_top", operation.z_top), ("z_bottom", operation.z_bottom)] {
        number(&format!("{place}.{key}"), value.unwrap_or(0.0))?;
    }
    match (operation.z_top, operation.z_bottom) {
        (Some(top), Some(bottom)) if bottom >= top => Err(JobError::document(
            "conflict",
            format!("{place}.z_bottom"),
            format!("z_bottom = {} is not below z_top = {}", unit.shown(bottom), unit.shown(top)),
            "lower z_bottom or raise z_top",
        )),
        _ => Ok(()),
    }
}

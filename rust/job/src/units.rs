//! Documents in inches, and ranges: every length becomes mm once, before anything else reads it, and every number is in the
//! range that its key states.
//!
//! Which numbers are lengths, of what power, and between what they must lie, the schema states at each key (`x-unit`,
//! `minimum`, `exclusiveMinimum`, `maximum`).

use serde_json::{Map, Number, Value};

use crate::document::LengthUnit;
use crate::numbers::shown;
use crate::schema::{Allowed, Range};
use crate::JobError;

impl LengthUnit {
    /// Its name as documents write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Inch => "inch",
        }
    }

    pub(crate) fn is_mm(&self) -> bool {
        *self == Self::Mm
    }

    /// A length in mm, in this unit.
    pub(crate) fn of_mm(self, mm: f64) -> f64 {
        match self {
            Self::Mm => mm,
            Self::Inch => mm / 25.4,
        }
    }

    /// A length in mm as this unit's users write it.
    pub(crate) fn shown(self, mm: f64) -> String {
        match self {
            Self::Mm => shown(mm),
            Self::Inch => shown(rounded(self.of_mm(mm))),
        }
    }
}

/// To six figures: what a conversion adds beyond is noise.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// The unit that a document states at its top; mm where it states none, or none that is known.
pub fn stated(document: &Value) -> LengthUnit {
    let stated = document.get("units").cloned();
    stated.and_then(|unit| serde_json::from_value(unit).ok()).unwrap_or_default()
}

/// Turns a document's lengths into mm, in place, and checks every number's range and that tables are tables.
///
/// # Errors
/// A number out of range, in the unit that the document is in; an array where a table is expected, whose values serde would
/// take in order; in inches a formula: what its numbers are cannot be known.
pub fn to_mm(document: &mut Value) -> Result<(), JobError> {
    let unit = stated(document);
    Walk { unit }.value(document, &Allowed::document(), Key::default(), "")
}

/// What a key states for the numbers below it.
#[derive(Clone, Copy, Default)]
struct Key {
    /// `x-unit`.
    unit: &'static str,
    range: Option<Range>,
}

impl Key {
    fn within(self, allowed: &Allowed) -> Self {
        let unit = allowed.stated("x-unit").and_then(Value::as_str).unwrap_or(self.unit);
        Self { unit, range: Range::of(allowed).or(self.range) }
    }
}

struct Walk {
    unit: LengthUnit,
}

impl Walk {
    /// A value by the schemas that may be its own; `around` is what the list or table around it states.
    fn value(&self, value: &mut Value, allowed: &Allowed, around: Key, path: &str) -> Result<(), JobError> {
        let allowed = allowed.resolved(value.get("kind").and_then(Value::as_str));
        let key = around.within(&allowed);
        if key.unit == "formula" && !value.is_null() && !self.unit.is_mm() {
            return Err(formula(path, self.unit));
        }
        match value {
            Value::Number(number) => self.number(number, key, 1.0, path),
            Value::Array(_) if allowed.is_table() => {
                Err(JobError::document("type", path, "an array, where a table is expected", "write keys and values"))
            }
            Value::Array(items) => {
                let of_items = allowed.items();
                items.iter_mut().enumerate().try_for_each(|(i, item)| {
                    // pairs and points have one range: that of their key
                    let path = if item.is_number() { path.to_owned() } else { format!("{path}[{i}]") };
                    self.value(item, &of_items, key, &path)
                })
            }
            Value::Object(entries) => self.entries(entries, &allowed, key.unit, path),
            Value::Null | Value::Bool(_) | Value::String(_) => Ok(()),
        }
    }

    fn entries(
        &self,
        entries: &mut Map<String, Value>,
        allowed: &Allowed,
        unit: &'static str,
        path: &str,
    ) -> Result<(), JobError> {
        let exponent = entries.get("exponent").and_then(Value::as_f64).unwrap_or(1.0);
        for (key, value) in entries {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            let known = allowed.key(key);
            let power = known.stated("x-unit").and_then(Value::as_str) == Some("mm^(1-p)");
            match value {
                Value::Number(number) if power => {
                    self.number(number, Key::default().within(&known), 1.0 - exponent, &path)?;
                }
                _ => self.value(value, &known, Key { unit, range: None }, &path)?,
            }
        }
        Ok(())
    }

    /// A number of the document; `power` is that of a coefficient whose dimension depends on another key.
    fn number(&self, number: &mut Number, key: Key, power: f64, path: &str) -> Result<(), JobError> {
        let Some(written) = number.as_f64() else { return Ok(()) };
        // 254 / 10: 3 inches are 76.2 mm, and not 76.19999999999999
        let mm = match (self.unit, key.unit) {
            (LengthUnit::Inch, "mm" | "mm/min" | "mm/rev") => Some(written * 254.0 / 10.0),
            (LengthUnit::Inch, "mm^2") => Some(written * 64516.0 / 100.0),
            (LengthUnit::Inch, "mm^(1-p)") => Some(written * libm::pow(25.4, power)),
            (LengthUnit::Inch | LengthUnit::Mm, _) => None,
        };
        if let Some(range) = key.range.filter(|range| !range.holds(mm.unwrap_or(written))) {
            let name = path.rsplit('.').next().unwrap_or(path);
            let message = format!("{name} = {}: allowed is {}", shown(written), range.in_words(key.unit, self.unit));
            return Err(JobError::document("out-of-range", path, message, "correct the value"));
        }
        if let Some(found) = mm.and_then(Number::from_f64) {
            *number = found;
        }
        Ok(())
    }
}

fn formula(path: &str, unit: LengthUnit) -> JobError {
    JobError::document(
        "units",
        path,
        format!("units = {:?}: what the numbers of a formula are cannot be known, and they stay mm", unit.name()),
        "put the tool into a file of its own (library = \"tool.json\", always mm), or write the job in mm",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const JOB: &str = r#"
        schema = 1
        units = "inch"
        part = { file = "a.stl", units = "mm", tolerance = 0.0001, model_face = "back" }
        machine = { name = "grbl", options = { decimals = 5 } }
        [setup]
        rotation = 3.0
        clearance = 1
        retract = 0.25
        zero = [1.0, 2.0, -3.0]
        sheet = { thickness = 0.04 }
        fixture = { clamp = { opening = [8.0, 6.0], height = 0.5 }, backing = { opening = 5.0 }, center = [1.0, 1.0] }
        [tools.a]
        number = 7
        shank_diameter = 0.5
        profile = { kind = "power", coefficient = 2.0, exponent = 3.0, diameter = 0.5 }
        base = { kind = "chamfer", height = 0.1 }
        holder = { diameter = 2.0, length = 3.0 }
        [tools.b]
        number = 8
        profile = { kind = "clothoid", scale = 0.02, end_slope_deg = 60.0 }
        [tools.c]
        number = 9
        profile = { kind = "points", points = [[0, 0], [0.1, 0.02], [0.2, 0.1]], fit_tolerance = 0.001 }
        [[operations]]
        kind = "z-level"
        tool = "a"
        step = { height = 0.02 }
        z_bottom = -1.5
        tolerance = 0.0004
        smallest_feature = 0.05
        feeds = { cut = 60.0, plunge = 12.0 }
        spindle = { mode = "fixed", rpm = 400.0 }
        [[operations]]
        kind = "zig-zag"
        tool = "b"
        stepover = 0.02
        angle_deg = 30.0
    "#;

    fn read(text: &str) -> Result<Value, JobError> {
        crate::from_toml(text).map(|job| serde_json::to_value(job).unwrap())
    }

    #[test]
    fn every_length_is_converted_and_nothing_else() {
        let job = read(JOB).unwrap();
        let at = |pointer: &str| job.pointer(pointer).unwrap().as_f64().unwrap();
        for (pointer, expected) in [
            ("/part/tolerance", 0.00254),
            ("/setup/rotation", 3.0),
            ("/setup/clearance", 25.4),
            ("/setup/retract", 6.35),
            ("/setup/zero/2", -76.2),
            ("/setup/sheet/thickness", 1.016),
            ("/setup/fixture/clamp/opening/0", 203.2),
            ("/setup/fixture/clamp/height", 12.7),
            ("/setup/fixture/backing/opening", 127.0),
            ("/setup/fixture/center/1", 25.4),
            ("/tools/a/number", 7.0),
            ("/tools/a/shank_diameter", 12.7),
            ("/tools/a/profile/diameter", 12.7),
            ("/tools/a/profile/exponent", 3.0),
            ("/tools/a/base/height", 2.54),
            ("/tools/a/holder/length", 76.2),
            ("/tools/b/profile/scale", 12.9032),
            ("/tools/b/profile/end_slope_deg", 60.0),
            ("/tools/c/profile/points/2/0", 5.08),
            ("/tools/c/profile/fit_tolerance", 0.0254),
            ("/operations/0/step/height", 0.508),
            ("/operations/1/stepover", 0.508),
            ("/operations/1/angle_deg", 30.0),
            ("/operations/0/z_bottom", -38.1),
            ("/operations/0/tolerance", 0.01016),
            ("/operations/0/smallest_feature", 1.27),
            ("/operations/0/feeds/cut", 1524.0),
            ("/operations/0/feeds/plunge", 304.8),
            ("/operations/0/spindle/rpm", 400.0),
            ("/machine/options/decimals", 5.0),
        ] {
            assert!((at(pointer) - expected).abs() < 1e-9, "{pointer}: {} for {expected}", at(pointer));
        }
        // z = c r^p in inches is z / 25.4 = c (r / 25.4)^p
        assert!((at("/tools/a/profile/coefficient") - 2.0 / (25.4 * 25.4)).abs() < 1e-12);
        assert_eq!(job.pointer("/part/units").unwrap(), "mm");
        assert!(job.get("units").is_none(), "what was read is in mm");
        // defaults are those in mm
        assert!((at("/setup/fixture/margin") - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_same_from_json() {
        let plain = serde_json::to_string(&toml::from_str::<toml::Value>(JOB).unwrap()).unwrap();
        assert_eq!(serde_json::to_value(crate::from_json(&plain).unwrap()).unwrap(), read(JOB).unwrap());
    }

    #[test]
    fn errors_are_in_the_unit_of_the_document() {
        for (old, new, path, message) in [
            (
                "height = 0.02",
                "height = 5",
                "operations[0].step.height",
                "height = 5: allowed is above 0 and up to 3.93701 inch",
            ),
            (
                "cut = 60.0",
                "cut = 0.001",
                "operations[0].feeds.cut",
                "cut = 0.001: allowed is 0.00393701 to 3937.01 inch/min",
            ),
            ("retract = 0.25", "retract = 1.5", "setup.retract", "retract = 1.5 is above clearance = 1"),
            (
                "height = 0.5",
                "height = 1.5",
                "setup.clearance",
                "clearance = 1: rapids would cross the clamp, 1.5 inch high",
            ),
            (
                "z_bottom = -1.5",
                "z_top = -2.0\nz_bottom = -1.5",
                "operations[0].z_bottom",
                "z_bottom = -1.5 is not below z_top = -2",
            ),
            ("height = 0.02", "height = \"a\"", "operations[0].step.height", "allowed: above 0 and up to 3.93701 inch"),
            ("height = 0.02", "height = nan", "operations[0].step.height", "not a number"),
            ("zero = [1.0", "zero = [9000.0", "setup.zero", "3937.01 inch"),
        ] {
            assert!(JOB.contains(old), "{old}");
            let error = read(&JOB.replacen(old, new, 1)).unwrap_err();
            assert!(error.to_string().contains(message), "{new}: {error}");
            assert_eq!(error.location(), path, "{new}");
        }
        let error = read(&JOB.replace("\"inch\"", "\"inches\"")).unwrap_err();
        assert!(error.hint().contains("inch"), "{error}: {}", error.hint());
    }

    #[test]
    fn formulas_stay_in_mm_and_are_refused() {
        let wrong = "profile = { kind = \"formula\", z = \"r^2\", diameter = 0.5 }";
        let error = read(&JOB.replace("profile = { kind = \"clothoid\", scale = 0.02, end_slope_deg = 60.0 }", wrong));
        let error = error.unwrap_err();
        assert_eq!(error.location(), "tools.b.profile.z");
        assert!(error.hint().contains("library"), "{}", error.hint());
    }

    #[test]
    fn every_number_of_the_job_states_its_range() {
        // numbers of the job's own tables; the geometry of tools checks its own, and a machine's options are its own
        const OTHERS: [&str; 7] =
            ["ProfileDocument", "Base", "Holder", "ToolSection", "OptionValue", "Opening", "Stages"];
        fn look(schema: &Value, has_range: bool, path: &str, missing: &mut Vec<String>) {
            let has = |key: &str| schema.get(key).is_some();
            let has_range = has_range || ((has("minimum") || has("exclusiveMinimum")) && has("maximum"));
            let is_number =
                |kind: &Value| kind == "number" || kind.as_array().is_some_and(|k| k.contains(&"number".into()));
            if schema.get("type").is_some_and(is_number) && !has_range {
                missing.push(path.to_owned());
            }
            match schema {
                Value::Object(entries) => {
                    entries.iter().for_each(|(key, part)| look(part, has_range, &format!("{path}/{key}"), missing));
                }
                Value::Array(items) => {
                    items
                        .iter()
                        .enumerate()
                        .for_each(|(i, part)| look(part, has_range, &format!("{path}/{i}"), missing));
                }
                Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
            }
        }
        let mut missing = Vec::new();
        let mut schema = crate::schema();
        let definitions = schema["$defs"].as_object_mut().unwrap();
        // Zero, Opening and Stages take theirs from the keys that refer to them
        definitions.retain(|name, _| name != "Zero" && !OTHERS.contains(&name.as_str()));
        look(&schema, false, "", &mut missing);
        assert_eq!(missing, Vec::<String>::new());
    }

    #[test]
    fn every_number_of_the_schema_says_its_unit() {
        fn look(schema: &Value, unit: bool, path: &str, missing: &mut Vec<String>) {
            let unit = unit || schema.get("x-unit").is_some();
            let is_number =
                |kind: &Value| kind == "number" || kind.as_array().is_some_and(|all| all.contains(&"number".into()));
            if schema.get("type").is_some_and(is_number) && !unit {
                missing.push(path.to_owned());
            }
            match schema {
                Value::Object(entries) => {
                    entries.iter().for_each(|(key, part)| look(part, unit, &format!("{path}/{key}"), missing));
                }
                Value::Array(items) => {
                    items.iter().enumerate().for_each(|(i, part)| look(part, unit, &format!("{path}/{i}"), missing));
                }
                _ => {}
            }
        }
        let mut missing = Vec::new();
        look(&crate::schema(), false, "", &mut missing);
        // stated at the keys that refer to them; and a machine's options are its own
        missing.retain(|path| !["/Opening/", "/Zero/", "/OptionValue/"].iter().any(|known| path.contains(known)));
        assert_eq!(missing, Vec::<String>::new());
    }
}

//! Documents in inches: every length becomes mm once, before anything else reads it.
//!
//! Which numbers are lengths, and of what power, the schema says at each key (`x-unit`).

use serde_json::{Map, Number, Value};

use crate::document::LengthUnit;
use crate::{check, JobError};

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
            Self::Mm => check::shown(mm),
            Self::Inch => check::shown(rounded(self.of_mm(mm))),
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

/// Turns a document's lengths into mm, in place; ranges are judged, and shown, in the unit that the document is in.
///
/// # Errors
/// A length out of range, or a formula: what its numbers are cannot be known.
pub fn to_mm(document: &mut Value, schema: &Value, unit: LengthUnit) -> Result<(), JobError> {
    match unit {
        LengthUnit::Mm => Ok(()),
        LengthUnit::Inch => Walk { schema, unit }.value(document, &[schema], None, ""),
    }
}

struct Walk<'a> {
    schema: &'a Value,
    unit: LengthUnit,
}

impl<'a> Walk<'a> {
    /// A value by the schemas that may be its own; `unit` is that of the table or list around it.
    fn value(
        &self,
        value: &mut Value,
        schemas: &[&'a Value],
        unit: Option<&'a str>,
        place: &str,
    ) -> Result<(), JobError> {
        let schemas: Vec<&Value> = schemas.iter().flat_map(|schema| self.alternatives(schema, value)).collect();
        let unit = schemas.iter().find_map(|schema| schema.get("x-unit")?.as_str()).or(unit);
        if unit == Some("formula") && !value.is_null() {
            return Err(formula(place, self.unit));
        }
        match value {
            Value::Number(number) => self.number(number, unit.unwrap_or_default(), 1.0, place),
            Value::Array(items) => {
                let of_items: Vec<&Value> = schemas.iter().filter_map(|schema| schema.get("items")).collect();
                items.iter_mut().enumerate().try_for_each(|(i, item)| {
                    // pairs and points have one range: that of their key
                    let place = if item.is_object() { format!("{place}[{i}]") } else { place.to_owned() };
                    self.value(item, &of_items, unit, &place)
                })
            }
            Value::Object(entries) => self.entries(entries, &schemas, unit, place),
            Value::Null | Value::Bool(_) | Value::String(_) => Ok(()),
        }
    }

    fn entries(
        &self,
        entries: &mut Map<String, Value>,
        schemas: &[&'a Value],
        unit: Option<&'a str>,
        place: &str,
    ) -> Result<(), JobError> {
        let exponent = entries.get("exponent").and_then(Value::as_f64).unwrap_or(1.0);
        for (key, value) in entries {
            let place = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
            let known: Vec<&Value> =
                schemas.iter().filter_map(|schema| schema.get("properties")?.get(key.as_str())).collect();
            let others = || schemas.iter().filter_map(|schema| schema.get("additionalProperties")).collect();
            let known = if known.is_empty() { others() } else { known };
            let power = known.iter().any(|schema| schema.get("x-unit").and_then(Value::as_str) == Some("mm^(1-p)"));
            match value {
                Value::Number(number) if power => self.number(number, "mm^(1-p)", 1.0 - exponent, &place)?,
                _ => self.value(value, &known, unit, &place)?,
            }
        }
        Ok(())
    }

    /// A number of the document; `power` is that of a coefficient whose dimension depends on another key.
    fn number(&self, number: &mut Number, unit: &str, power: f64, place: &str) -> Result<(), JobError> {
        let Some(written) = number.as_f64() else { return Ok(()) };
        // 254 / 10: 3 inches are 76.2 mm, and not 76.19999999999999
        let mm = match unit {
            "mm" | "mm/min" => written * 254.0 / 10.0,
            "mm^2" => written * 64516.0 / 100.0,
            "mm^(1-p)" => written * libm::pow(25.4, power),
            _ => return Ok(()),
        };
        check::in_range(place, mm, written, self.unit)?;
        if let Some(found) = Number::from_f64(mm) {
            *number = found;
        }
        Ok(())
    }

    /// The schemas behind a schema: references followed, of tables with a kind that kind's alone.
    fn alternatives(&self, schema: &'a Value, value: &Value) -> Vec<&'a Value> {
        let kind = value.get("kind").and_then(Value::as_str);
        let mut found = Vec::new();
        let mut open = vec![schema];
        while let Some(schema) = open.pop() {
            let constant = |schema: &Value| Some(schema.pointer("/properties/kind/const")?.as_str()?.to_owned());
            if kind.is_some() && constant(schema).is_some_and(|constant| Some(constant.as_str()) != kind) {
                continue;
            }
            found.push(schema);
            let name = schema.get("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
            open.extend(name.and_then(|name| self.schema.get("$defs")?.get(name)));
            let choices = ["allOf", "oneOf", "anyOf"].iter().filter_map(|key| schema.get(*key)?.as_array());
            open.extend(choices.flatten());
        }
        found
    }
}

fn formula(place: &str, unit: LengthUnit) -> JobError {
    JobError::document(
        "units",
        place,
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
        angle_deg = 30.0
        z_bottom = -1.5
        tolerance = 0.0004
        smallest_feature = 0.05
        feeds = { cut = 60.0, plunge = 12.0 }
        spindle = { mode = "fixed", rpm = 400.0 }
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
            ("/operations/0/angle_deg", 30.0),
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
        for (old, new, place, said) in [
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
            assert!(error.to_string().contains(said), "{new}: {error}");
            assert_eq!(error.place(), place, "{new}");
        }
        let error = read(&JOB.replace("\"inch\"", "\"inches\"")).unwrap_err();
        assert!(error.hint().contains("inch"), "{error}: {}", error.hint());
    }

    #[test]
    fn formulas_stay_in_mm_and_are_refused() {
        let wrong = "profile = { kind = \"formula\", z = \"r^2\", diameter = 0.5 }";
        let error = read(&JOB.replace("profile = { kind = \"clothoid\", scale = 0.02, end_slope_deg = 60.0 }", wrong));
        let error = error.unwrap_err();
        assert_eq!(error.place(), "tools.b.profile.z");
        assert!(error.hint().contains("library"), "{}", error.hint());
    }

    #[test]
    fn every_number_of_the_schema_says_its_unit() {
        fn look(schema: &Value, unit: bool, place: &str, missing: &mut Vec<String>) {
            let unit = unit || schema.get("x-unit").is_some();
            let is_number =
                |kind: &Value| kind == "number" || kind.as_array().is_some_and(|all| all.contains(&"number".into()));
            if schema.get("type").is_some_and(is_number) && !unit {
                missing.push(place.to_owned());
            }
            match schema {
                Value::Object(entries) => {
                    entries.iter().for_each(|(key, part)| look(part, unit, &format!("{place}/{key}"), missing));
                }
                Value::Array(items) => {
                    items.iter().enumerate().for_each(|(i, part)| look(part, unit, &format!("{place}/{i}"), missing));
                }
                _ => {}
            }
        }
        let mut missing = Vec::new();
        look(&crate::schema(), false, "", &mut missing);
        // said at the keys that refer to them; and a machine's options are its own
        missing.retain(|place| !["/Opening/", "/Zero/", "/OptionValue/"].iter().any(|known| place.contains(known)));
        assert_eq!(missing, Vec::<String>::new());
    }
}

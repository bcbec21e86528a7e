//! Text to document, with errors that a person can act on.

use serde::de::DeserializeOwned;
use serde_json::Value;

use styluscam_geometry::ToolDocument;

use crate::{check, units, JobDocument, JobError, LengthUnit, JOB_SCHEMA};

/// The key under which a TOML date is passed on.
const DATE: &str = "$__toml_private_datetime";
/// Keys that hold tables, wherever they stand.
const TABLE_KEYS: &[&str] =
    &["part", "setup", "sheet", "process", "tools", "profile", "step", "feeds", "spindle", "machine", "output"];

/// Reads and checks a job written as TOML.
///
/// # Errors
/// [`JobError::Document`] with the key, its value, what is allowed.
pub fn from_toml(text: &str) -> Result<JobDocument, JobError> {
    let value: toml::Value = toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(0, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
        JobError::document("toml", format!("line {line}"), error.message().to_owned(), "correct the TOML there")
    })?;
    let plain = serde_json::to_value(&value)
        .map_err(|error| JobError::document("toml", "", error.to_string(), "correct the TOML"))?;
    tables_only("", &plain)?;
    match units::stated(&plain) {
        LengthUnit::Mm => checked(deserialize(value, &plain)?),
        LengthUnit::Inch => {
            finite("", &value)?; // JSON has no other numbers
            of_plain(plain)
        }
    }
}

/// Reads a tool's document written as JSON; the tool's shape is not checked.
///
/// # Errors
/// [`JobError::Document`] with the key, its value, what is expected.
pub fn tool_from_json(text: &str) -> Result<ToolDocument, JobError> {
    let value: Value = serde_json::from_str(text).map_err(|error| {
        JobError::document("json", format!("line {}", error.line()), error.to_string(), "correct the JSON there")
    })?;
    deserialize(value.clone(), &value)
}

/// Reads and checks a job written as JSON.
///
/// # Errors
/// [`JobError::Document`] with the key, its value, what is allowed.
pub fn from_json(text: &str) -> Result<JobDocument, JobError> {
    let value: Value = serde_json::from_str(text).map_err(|error| {
        JobError::document("json", format!("line {}", error.line()), error.to_string(), "correct the JSON there")
    })?;
    tables_only("", &value)?;
    of_plain(value)
}

/// A document in whatever unit it states.
fn of_plain(mut value: Value) -> Result<JobDocument, JobError> {
    let unit = units::stated(&value);
    units::to_mm(&mut value, &schema(), unit)?;
    checked(deserialize(value.clone(), &value)?)
}

/// Refuses TOML's nan and inf.
fn finite(place: &str, value: &toml::Value) -> Result<(), JobError> {
    match value {
        toml::Value::Float(number) if !number.is_finite() => {
            Err(JobError::document("type", place, format!("{number} is not a number"), "correct the value"))
        }
        toml::Value::Array(items) => {
            items.iter().enumerate().try_for_each(|(i, item)| finite(&format!("{place}[{i}]"), item))
        }
        toml::Value::Table(entries) => entries.iter().try_for_each(|(key, item)| {
            finite(&if place.is_empty() { key.clone() } else { format!("{place}.{key}") }, item)
        }),
        _ => Ok(()),
    }
}

/// Refuses arrays where tables stand, whose values serde would take in order, and TOML's dates.
fn tables_only(place: &str, value: &Value) -> Result<(), JobError> {
    let key = place.rsplit('.').next().unwrap_or(place);
    let is_table = place.is_empty() || TABLE_KEYS.contains(&key) || place.starts_with("tools.") && key == &place[6..];
    match value {
        Value::Array(_) if is_table => {
            Err(JobError::document("type", place, "an array, where a table is expected", "write keys and values"))
        }
        Value::Array(items) => {
            items.iter().enumerate().try_for_each(|(i, item)| tables_only(&format!("{place}[{i}]"), item))
        }
        Value::Object(entries) if entries.contains_key(DATE) => {
            Err(JobError::document("type", place, "a date, where a string is expected", "put it in quotes"))
        }
        Value::Object(entries) => entries.iter().try_for_each(|(key, item)| {
            let place = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
            tables_only(&place, item)
        }),
        _ => Ok(()),
    }
}

/// The document's JSON Schema.
#[must_use]
pub fn schema() -> Value {
    schemars::schema_for!(JobDocument).into()
}

fn checked(document: JobDocument) -> Result<JobDocument, JobError> {
    if document.schema != JOB_SCHEMA {
        return Err(JobError::document(
            "schema",
            "schema",
            format!("schema = {}: this version reads {JOB_SCHEMA}", document.schema),
            "update StylusCAM, or write the job for this version",
        ));
    }
    check::document(&document)?;
    Ok(JobDocument { units: LengthUnit::Mm, ..document })
}

/// `plain`: the value once more, for the search of what is wrong with it.
fn deserialize<'de, T, D>(value: D, plain: &Value) -> Result<T, JobError>
where
    D: serde::Deserializer<'de>,
    T: DeserializeOwned,
{
    serde_path_to_error::deserialize(value).map_err(|error| {
        let place = error.path().to_string().trim_start_matches('.').to_owned();
        let message = error.into_inner().to_string();
        let message = message.lines().next().unwrap_or(&message);
        let key = blamed::<T>(plain, &place, message);
        explained(&key.unwrap_or(place), message, units::stated(plain))
    })
}

/// The key that a table with a `kind` fails by: serde names the table only. It is the one without which the error is another.
fn blamed<T: DeserializeOwned>(plain: &Value, place: &str, message: &str) -> Option<String> {
    let pointer: String = place.split(['.', '[']).map(|key| format!("/{}", key.trim_end_matches(']'))).collect();
    let table = plain.pointer(&pointer)?.as_object().filter(|table| table.contains_key("kind"))?;
    let invalid = message.starts_with("invalid ");
    let is_blamed = |key: &&String| {
        let mut without = plain.clone();
        without.pointer_mut(&pointer).and_then(Value::as_object_mut).map(|table| table.remove(*key));
        serde_json::from_value::<T>(without).err().is_none_or(|error| error.to_string() != message)
    };
    let key = table.keys().filter(|key| invalid && *key != "kind").find(is_blamed)?;
    Some(format!("{place}.{key}"))
}

/// Turns serde's message into one with the key, what is allowed, and the nearest known word.
fn explained(place: &str, message: &str, unit: LengthUnit) -> JobError {
    let place = if place == "." { "" } else { place };
    if let Some((word, known)) = unknown_word(message) {
        let what = if message.starts_with("unknown variant") { "value" } else { "key" };
        let nearest = known.iter().map(|k| (strsim::damerau_levenshtein(&word, k), k));
        let hint = match nearest.min() {
            Some((distance, near)) if distance <= 1 + word.len() / 3 => format!("did you mean {near:?}?"),
            _ => format!("known here: {}", known.join(", ")),
        };
        return JobError::document("unknown", place, format!("unknown {what} {word:?}"), hint);
    }
    if let Some(key) = message.strip_prefix("missing field ") {
        let key = key.trim_matches('`');
        return JobError::document("missing", place, format!("{key} is missing"), format!("add {key}"));
    }
    let words = || words_at(place).map(|words| words.join(", "));
    let allowed = check::allowed(place, unit).or_else(words);
    let allowed = allowed.map_or(String::new(), |words| format!("; allowed: {words}"));
    // serde's own terms for a word among given ones
    let message = match message {
        m if m.contains("unit variant")
            || m.contains("expected string or map")
            || m.contains("wanted exactly 1 element") =>
        {
            "a word in quotes is expected"
        }
        m => m,
    };
    let message = in_words(message);
    JobError::document("type", place, format!("{message}{allowed}"), "correct the value")
}

/// Serde's names of types as people call them.
fn in_words(message: &str) -> String {
    const NAMES: [(&str, &str); 3] =
        [("f64", "a number"), ("struct ", "a table"), ("internally tagged enum ", "a table with a kind")];
    let Some((found, expected)) = message.split_once(", expected ") else { return message.to_owned() };
    let name = NAMES.iter().find(|(name, _)| expected.starts_with(name)).map_or(expected, |(_, words)| *words);
    format!("{found}, where {name} is expected")
}

/// The words that the schema allows at a place.
fn words_at(place: &str) -> Option<Vec<String>> {
    let schema = schema();
    let mut at = &schema;
    for key in place.split('.').map(|key| key.split('[').next().unwrap_or(key)) {
        let items = resolved(&schema, at);
        let table = items.get("items").map_or(items, |items| resolved(&schema, items));
        at = table.get("properties").and_then(|p| p.get(key)).or_else(|| table.get("additionalProperties"))?;
    }
    let choices = resolved(&schema, at);
    let consts = choices.get("oneOf").or_else(|| choices.get("anyOf"))?.as_array()?;
    let words = consts.iter().filter_map(|choice| choice.get("const")?.as_str());
    let words: Vec<String> = words.map(|word| format!("{word:?}")).collect();
    (!words.is_empty()).then_some(words)
}

/// A part of the schema, its reference followed.
fn resolved<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    let alternatives = part.get("anyOf").and_then(Value::as_array);
    let part = alternatives.and_then(|all| all.iter().find(|one| one.get("$ref").is_some())).unwrap_or(part);
    let name = part.get("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
    name.and_then(|name| schema.get("$defs")?.get(name)).unwrap_or(part)
}

/// The word and the known ones of serde's "unknown field `a`, expected one of `b`, `c`".
fn unknown_word(message: &str) -> Option<(String, Vec<String>)> {
    let rest = message.strip_prefix("unknown field ").or_else(|| message.strip_prefix("unknown variant "))?;
    let mut quoted = rest.split('`').skip(1).step_by(2).map(str::to_owned);
    let word = quoted.next()?;
    Some((word, quoted.collect()))
}

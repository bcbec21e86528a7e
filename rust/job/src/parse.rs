//! Text to document, with errors that a person can act on.

use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value};

use styluscam_geometry::ToolDocument;

use crate::tagged::{unknown, written_path};
use crate::{check, cutting, operations, process, schema, units, JobDocument, JobError, LengthUnit};

/// Version of the job document; older ones migrate, newer ones are refused.
pub const JOB_SCHEMA: u32 = 1;

/// Reads and checks a job written as TOML.
///
/// # Errors
/// [`JobError::Document`] with the key, its value, what is allowed.
pub fn from_toml(text: &str) -> Result<JobDocument, JobError> {
    let value: toml::Value = toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(0, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
        JobError::document("toml", format!("line {line}"), error.message().to_owned(), "correct the TOML there")
    })?;
    of_plain(&plain("", value)?)
}

/// Reads a tool's document written as JSON; the tool's shape is not checked.
///
/// # Errors
/// [`JobError::Document`] with the key, its value, what is expected.
pub fn tool_from_json(text: &str) -> Result<ToolDocument, JobError> {
    let value = json(text)?;
    deserialize(&value, &value)
}

/// Reads and checks a job written as JSON.
///
/// # Errors
/// [`JobError::Document`] with the key, its value, what is allowed.
pub fn from_json(text: &str) -> Result<JobDocument, JobError> {
    of_plain(&json(text)?)
}

fn json(text: &str) -> Result<Value, JobError> {
    serde_json::from_str(text).map_err(|error| {
        JobError::document("json", format!("line {}", error.line()), error.to_string(), "correct the JSON there")
    })
}

/// TOML's values as JSON's, which has neither dates nor nan and inf.
fn plain(path: &str, value: toml::Value) -> Result<Value, JobError> {
    Ok(match value {
        toml::Value::Datetime(_) => {
            return Err(JobError::document("type", path, "a date, where a string is expected", "put it in quotes"));
        }
        toml::Value::Float(number) => Value::Number(Number::from_f64(number).ok_or_else(|| {
            JobError::document("type", path, format!("{number} is not a number"), "correct the value")
        })?),
        toml::Value::Array(items) => {
            let items = items.into_iter().enumerate().map(|(i, item)| plain(&format!("{path}[{i}]"), item));
            Value::Array(items.collect::<Result<_, _>>()?)
        }
        toml::Value::Table(entries) => {
            let entries = entries.into_iter().map(|(key, item)| {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                plain(&path, item).map(|item| (key, item))
            });
            Value::Object(entries.collect::<Result<Map<_, _>, _>>()?)
        }
        toml::Value::String(text) => Value::String(text),
        toml::Value::Integer(number) => number.into(),
        toml::Value::Boolean(flag) => flag.into(),
    })
}

/// A document in whatever unit it states.
fn of_plain(written: &Value) -> Result<JobDocument, JobError> {
    let mut in_mm = written.clone();
    units::to_mm(&mut in_mm)?;
    part_keys(&mut in_mm)?;
    let document = checked(deserialize(&in_mm, written)?)?;
    cutting::spindles_stated(&document, written)?;
    Ok(document)
}

/// Parts the tables whose kind decides which keys they take.
fn part_keys(document: &mut Value) -> Result<(), JobError> {
    if let Some(Value::Object(table)) = document.get_mut("process") {
        process::family().part(table, "process")?;
    }
    let Some(Value::Array(items)) = document.get_mut("operations") else { return Ok(()) };
    items.iter_mut().enumerate().try_for_each(|(index, item)| match item {
        Value::Object(table) => operations::family().part(table, &format!("operations[{index}]")),
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) | Value::Array(_) => Ok(()), // serde's to refuse
    })
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

/// `written`: the document as its author wrote it.
fn deserialize<T: DeserializeOwned>(value: &Value, written: &Value) -> Result<T, JobError> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().to_string().trim_start_matches('.').to_owned();
        let message = error.into_inner().to_string();
        let message = message.lines().next().unwrap_or(&message);
        let key = blamed::<T>(value, &path, message).unwrap_or(path);
        explained(written, &written_path(&key), message)
    })
}

/// The key that a table with a `kind` fails by: serde names the table only. It is the one without which the error is another.
fn blamed<T: DeserializeOwned>(plain: &Value, path: &str, message: &str) -> Option<String> {
    let pointer: String = path.split(['.', '[']).map(|key| format!("/{}", key.trim_end_matches(']'))).collect();
    let table = plain.pointer(&pointer)?.as_object().filter(|table| table.contains_key("kind"))?;
    let invalid = message.starts_with("invalid ");
    let is_blamed = |key: &&String| {
        let mut without = plain.clone();
        without.pointer_mut(&pointer).and_then(Value::as_object_mut).map(|table| table.remove(*key));
        serde_json::from_value::<T>(without).err().is_none_or(|error| error.to_string() != message)
    };
    let key = table.keys().filter(|key| invalid && *key != "kind").find(is_blamed)?;
    Some(format!("{path}.{key}"))
}

/// Turns serde's message into one with the key, what is allowed, and the nearest known word.
fn explained(written: &Value, path: &str, message: &str) -> JobError {
    let path = if path == "." { "" } else { path };
    if let Some((word, known)) = unknown_word(message) {
        let what = if message.starts_with("unknown variant") { "value" } else { "key" };
        return unknown(what, &word, path, known.iter().map(String::as_str));
    }
    if let Some(key) = message.strip_prefix("missing field ") {
        let key = key.trim_matches('`');
        let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        let example = schema::example_at(written, &path).map(|text| format!(" = {text}"));
        let allowed = || Some(format!("; allowed: {}", schema::allowed_at(written, &path, units::stated(written))?));
        let how = example.or_else(allowed).unwrap_or_default();
        return JobError::document("missing", path, format!("{key} is missing"), format!("add {key}{how}"));
    }
    let allowed = schema::allowed_at(written, path, units::stated(written));
    let allowed = allowed.map_or(String::new(), |words| format!("; allowed: {words}"));
    // serde's own terms for a word, or a table with one key, among given ones
    let message = match message {
        m if m.contains("unit variant")
            || m.contains("expected string or map")
            || m.contains("wanted exactly 1 element") =>
        {
            if schema::is_table_at(written, path) {
                "a table is expected"
            } else {
                "a word in quotes is expected"
            }
        }
        m if m.contains("map with a single key") => "a table with one key is expected",
        m => m,
    };
    let message = in_words(message);
    let hint =
        if message == A_TABLE_FOR_A_LIST { "put its header in two brackets: [[...]]" } else { "correct the value" };
    JobError::document("type", path, format!("{message}{allowed}"), hint)
}

/// The message about `[operations]`, where `[[operations]]` is meant.
const A_TABLE_FOR_A_LIST: &str = "invalid type: a table, where a list is expected";

/// Serde's names of types as people call them.
fn in_words(message: &str) -> String {
    const NAMES: [(&str, &str); 8] = [
        ("f64", "a number"),
        ("u32", "a whole number"),
        ("usize", "a whole number"),
        ("a sequence", "a list"),
        ("a map", "a table"),
        ("struct ", "a table"),
        ("internally tagged enum ", "a table"),
        ("a string", "a word in quotes"),
    ];
    let Some((found, expected)) = message.split_once(", expected ") else { return message.to_owned() };
    let found = found.replace("type: map", "type: a table").replace("type: sequence", "type: a list");
    let name = NAMES.iter().find(|(name, _)| expected.starts_with(name)).map_or(expected, |(_, words)| *words);
    format!("{found}, where {name} is expected")
}

/// The word and the known ones of serde's "unknown field `a`, expected one of `b`, `c`".
fn unknown_word(message: &str) -> Option<(String, Vec<String>)> {
    let rest = message.strip_prefix("unknown field ").or_else(|| message.strip_prefix("unknown variant "))?;
    let mut quoted = rest.split('`').skip(1).step_by(2).map(str::to_owned);
    let word = quoted.next()?;
    Some((word, quoted.collect()))
}

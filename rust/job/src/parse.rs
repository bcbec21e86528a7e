//! Text to document, with errors that a person can act on.

use serde::de::DeserializeOwned;

use crate::{check, JobDocument, JobError, JOB_SCHEMA};

/// Reads and checks a job written as TOML.
///
/// # Errors
/// [`JobError::Document`] with the key, its value, what is allowed.
pub fn from_toml(text: &str) -> Result<JobDocument, JobError> {
    let value: toml::Value = toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(0, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
        JobError::document("toml", format!("line {line}"), error.message().to_owned(), "correct the TOML there")
    })?;
    checked(deserialize(value)?)
}

/// Reads and checks a job written as JSON.
///
/// # Errors
/// [`JobError::Document`] with the key, its value, what is allowed.
pub fn from_json(text: &str) -> Result<JobDocument, JobError> {
    let value: serde_json::Value = serde_json::from_str(text).map_err(|error| {
        JobError::document("json", format!("line {}", error.line()), error.to_string(), "correct the JSON there")
    })?;
    checked(deserialize(value)?)
}

/// The document's JSON Schema.
#[must_use]
pub fn schema() -> serde_json::Value {
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
    Ok(document)
}

fn deserialize<'de, D>(value: D) -> Result<JobDocument, JobError>
where
    D: serde::Deserializer<'de>,
    JobDocument: DeserializeOwned,
{
    serde_path_to_error::deserialize(value).map_err(|error| {
        let place = error.path().to_string().trim_start_matches('.').to_owned();
        let message = error.into_inner().to_string();
        explained(&place, message.lines().next().unwrap_or(&message))
    })
}

/// Turns serde's message into one with the key, what is allowed, and the nearest known word.
fn explained(place: &str, message: &str) -> JobError {
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
    let allowed = check::allowed(place).map_or(String::new(), |words| format!("; allowed: {words}"));
    JobError::document("type", place, format!("{message}{allowed}"), "correct the value")
}

/// The word and the known ones of serde's "unknown field `a`, expected one of `b`, `c`".
fn unknown_word(message: &str) -> Option<(String, Vec<String>)> {
    let rest = message.strip_prefix("unknown field ").or_else(|| message.strip_prefix("unknown variant "))?;
    let mut quoted = rest.split('`').skip(1).step_by(2).map(str::to_owned);
    let word = quoted.next()?;
    Some((word, quoted.collect()))
}

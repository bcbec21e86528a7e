//! From the text of a machine file to its values, those of the file that it extends below its own.

use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

use super::error::{most_similar, MachineError};
use super::values::Machine;

/// The key that names what a file extends.
const EXTENDS: &str = "extends";
/// A file of a file of a file: more is a mistake.
const DEEPEST: usize = 8;

/// Reads a machine; `file` gives the text of files that are named in `extends`.
pub(super) fn machine(text: &str, file: &dyn Fn(&str) -> Option<String>) -> Result<Machine, MachineError> {
    of_table(toml::from_str(text).map_err(|e| syntax_error(text, &e))?, text, file)
}

/// The machine of a table; `text` is what it was read from, empty where there is none.
pub(super) fn of_table(own: Table, text: &str, file: &dyn Fn(&str) -> Option<String>) -> Result<Machine, MachineError> {
    let whole = with_parents(own, text, file, DEEPEST)?;
    serde_path_to_error::deserialize(Value::Table(whole)).map_err(|e| document_error(text, &e))
}

/// `own` over what it extends.
fn with_parents(
    mut own: Table,
    text: &str,
    file: &dyn Fn(&str) -> Option<String>,
    depth: usize,
) -> Result<Table, MachineError> {
    let Some(parent) = own.remove(EXTENDS) else { return Ok(own) };
    let wrong = |message: String| MachineError::Document { place: position(text, EXTENDS), message, similar: None };
    let Value::String(name) = parent else { return Err(wrong("name a shipped machine, or a file".into())) };
    let Some(depth) = depth.checked_sub(1) else { return Err(wrong("files extend one another without end".into())) };
    let parent_text = match file(&name) {
        Some(text) => text,
        None => Machine::shipped_text(&name).map_err(extended)?.to_owned(),
    };
    let parent: Table = toml::from_str(&parent_text).map_err(|e| wrong(format!("{name}: {}", e.message())))?;
    let mut whole = with_parents(parent, &parent_text, file, depth)?;
    // what was read for the parent states nothing about this machine
    whole.insert("source".into(), Value::Table(unread(&name)));
    if own.contains_key("wcs") && !own.contains_key("wcs_words") {
        whole.remove("wcs_words"); // they go with the list that was there
    }
    lay_over(&mut whole, own);
    Ok(whole)
}

/// The error of a machine that a file extends.
fn extended(error: MachineError) -> MachineError {
    match error {
        MachineError::UnknownMachine { name, similar, .. } => {
            MachineError::UnknownMachine { key: EXTENDS, name, similar }
        }
        other => other,
    }
}

fn unread(parent: &str) -> Table {
    Table::from_iter([("read".to_owned(), Value::Array(vec![format!("extends {parent}").into()]))])
}

/// Puts `upper` over `lower`, table by table; a list replaces the other one, and `false` takes away what is no switch.
fn lay_over(lower: &mut Table, upper: Table) {
    for (key, value) in upper {
        match (lower.get_mut(&key), value) {
            (Some(Value::Table(below)), Value::Table(above)) if key != "source" => lay_over(below, above),
            (Some(below), Value::Boolean(false)) if !below.is_bool() => _ = lower.remove(&key),
            (_, value) => {
                lower.insert(key, value);
            }
        }
    }
}

fn syntax_error(text: &str, error: &toml::de::Error) -> MachineError {
    let start = error.span().map_or(0, |s| s.start);
    MachineError::Document {
        place: format!("line {}", line_of(text, start)),
        message: error.message().into(),
        similar: None,
    }
}

fn document_error(text: &str, error: &serde_path_to_error::Error<toml::de::Error>) -> MachineError {
    let message = error.inner().message().to_string();
    let path = error.path().to_string();
    MachineError::Document { place: position(text, &path), similar: similar_key(&message), message }
}

/// A key, with its line where it stands in this text.
fn position(text: &str, path: &str) -> String {
    match line_of_key(text, path) {
        Some(line) if path == "." => format!("line {line}"),
        Some(line) => format!("{path} (line {line})"),
        None => path.to_owned(),
    }
}

/// The line of a key or of the last table on its path that the text has.
fn line_of_key(text: &str, path: &str) -> Option<usize> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut line = None;
    for name in path.split(['.', '[', ']']).filter(|name| !name.is_empty()) {
        let Some((key, value)) = table.iter().find(|(key, _)| key.get_ref() == name) else { break };
        line = Some(line_of(text, key.span().start));
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    line
}

fn line_of(text: &str, at: usize) -> usize {
    text.get(..at).unwrap_or_default().matches('\n').count() + 1
}

/// The known key most like the unknown one: serde names both between backticks.
fn similar_key(message: &str) -> Option<String> {
    let mut names = message.strip_prefix("unknown field `")?.split('`').step_by(2);
    let unknown = names.next()?;
    most_similar(unknown, names)
}

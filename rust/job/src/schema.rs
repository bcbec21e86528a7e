//! The document's JSON Schema, and the search in it: what is allowed at a path, in which unit and range.
//!
//! Defaults, ranges, units and help texts stand once, at the fields of the document; here they are found again.

use std::sync::LazyLock;

use serde_json::Value;

use crate::numbers::shown;
use crate::{JobDocument, LengthUnit};

static SCHEMA: LazyLock<Value> = LazyLock::new(|| schemars::schema_for!(JobDocument).into());

/// The document's JSON Schema (draft 2020-12).
#[must_use]
pub fn schema() -> Value {
    SCHEMA.clone()
}

/// The schemas that a value may be of, all at once: what one of them states holds for it.
#[derive(Clone, Debug, Default)]
pub struct Allowed(Vec<&'static Value>);

impl Allowed {
    /// Those of the whole document.
    pub fn document() -> Self {
        Self(vec![&*SCHEMA])
    }

    /// References followed; of tables with a kind that kind's alone, if `kind` states one.
    pub fn resolved(&self, kind: Option<&str>) -> Self {
        let mut found = Vec::new();
        let mut open = self.0.clone();
        while let Some(schema) = open.pop() {
            let constant = schema.pointer("/properties/kind/const").and_then(Value::as_str);
            if kind.is_some() && constant.is_some() && constant != kind {
                continue;
            }
            found.push(schema);
            let name = schema.get("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
            open.extend(name.and_then(|name| SCHEMA.get("$defs")?.get(name)));
            let choices = ["allOf", "oneOf", "anyOf"].iter().filter_map(|key| schema.get(*key)?.as_array());
            open.extend(choices.flatten());
        }
        Self(found)
    }

    /// Those of a key of a table; of a table with names that are free (tools, options) those of its values.
    pub fn key(&self, key: &str) -> Self {
        let known: Vec<&Value> = self.0.iter().filter_map(|schema| schema.get("properties")?.get(key)).collect();
        if !known.is_empty() {
            return Self(known);
        }
        Self(self.0.iter().filter_map(|schema| schema.get("additionalProperties")).filter(|s| s.is_object()).collect())
    }

    /// Those of a list's items.
    pub fn items(&self) -> Self {
        Self(self.0.iter().filter_map(|schema| schema.get("items")).collect())
    }

    /// What the first of them states under a name: `x-unit`, `minimum`.
    pub fn stated(&self, name: &str) -> Option<&'static Value> {
        self.0.iter().find_map(|schema| schema.get(name))
    }

    /// Whether a table is expected, and nothing else.
    pub fn is_table(&self) -> bool {
        let types: Vec<&str> = self.0.iter().filter_map(|schema| schema.get("type")).flat_map(types).collect();
        !types.is_empty() && types.iter().all(|name| matches!(*name, "object" | "null"))
    }

    /// The words that are allowed, if it is words.
    pub fn words(&self) -> Vec<&'static str> {
        let choices = self.0.iter().flat_map(|schema| {
            let list = schema.get("enum").and_then(Value::as_array).into_iter().flatten();
            list.chain(schema.get("const"))
        });
        choices.filter_map(Value::as_str).collect()
    }
}

fn types(stated: &Value) -> impl Iterator<Item = &str> {
    let list = stated.as_array().into_iter().flatten().filter_map(Value::as_str);
    stated.as_str().into_iter().chain(list)
}

/// Between which numbers a value must lie, as the schema at its key states them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    low: f64,
    /// Whether `low` itself is not allowed.
    open: bool,
    high: f64,
}

impl Range {
    /// The range that some schemas state.
    pub fn of(allowed: &Allowed) -> Option<Self> {
        let number = |name| allowed.stated(name).and_then(Value::as_f64);
        let open = number("exclusiveMinimum");
        let low = open.or_else(|| number("minimum"))?;
        Some(Self { low, open: open.is_some(), high: number("maximum")? })
    }

    /// Whether a value lies in it.
    pub fn holds(&self, value: f64) -> bool {
        let low = if self.open { value > self.low } else { value >= self.low };
        low && value <= self.high
    }

    /// The range in words; lengths, of the schema's unit `x_unit`, in a document's unit.
    pub fn in_words(&self, x_unit: &str, unit: LengthUnit) -> String {
        let length = x_unit.strip_prefix("mm").filter(|per| !unit.is_mm() && !per.starts_with('^'));
        let [low, high] = [self.low, self.high].map(|value| match length {
            Some(_) => unit.shown(value),
            None => shown(value),
        });
        let dimension = match (x_unit, length) {
            (_, Some(per)) => format!(" {}{per}", unit.name()),
            ("deg", _) => " degrees".to_owned(),
            ("1" | "", _) => String::new(),
            (other, None) => format!(" {other}"),
        };
        match self.open {
            true => format!("above {low} and up to {high}{dimension}"),
            false => format!("{low} to {high}{dimension}"),
        }
    }
}

/// What is allowed at a path of the document, in words and in its unit: a range, words, or a table's example.
pub fn allowed_at(document: &Value, path: &str, unit: LengthUnit) -> Option<String> {
    let (allowed, inherited) = at(document, path);
    let x_unit = allowed.stated("x-unit").and_then(Value::as_str).or(inherited).unwrap_or_default();
    let range = Range::of(&allowed).map(|range| range.in_words(x_unit, unit));
    let example = || example_of(&allowed).filter(|_| allowed.is_table()).map(|text| format!("a table like {text}"));
    let words = || {
        let words: Vec<String> = allowed.words().iter().map(|word| format!("{word:?}")).collect();
        (!words.is_empty()).then(|| words.join(", "))
    };
    range.or_else(example).or_else(words)
}

/// Whether a key's value is a table.
pub fn is_table_at(document: &Value, path: &str) -> bool {
    at(document, path).0.is_table()
}

/// How a key's value may look, as the document's author would write it.
pub fn example_at(document: &Value, path: &str) -> Option<&'static str> {
    example_of(&at(document, path).0)
}

fn example_of(allowed: &Allowed) -> Option<&'static str> {
    allowed.stated("x-example").and_then(Value::as_str)
}

/// The schemas at a path, and the unit of the table or list around it.
fn at(document: &Value, path: &str) -> (Allowed, Option<&'static str>) {
    let (mut allowed, mut unit, mut value) = (Allowed::document(), None, Some(document));
    for segment in path.split('.') {
        let (key, index) = segment
            .split_once('[')
            .map_or((segment, None), |(key, rest)| (key, rest.trim_end_matches(']').parse::<usize>().ok()));
        let kind = value.and_then(|value| value.get("kind")?.as_str());
        allowed = allowed.resolved(kind).key(key);
        value = value.and_then(|value| value.get(key));
        unit = allowed.stated("x-unit").and_then(Value::as_str).or(unit);
        if let Some(index) = index {
            let items = allowed.resolved(None).items();
            // pairs and points have one range: that of their key
            allowed = if items.0.iter().any(|schema| schema.get("$ref").is_some()) { items } else { allowed };
            value = value.and_then(|value| value.get(index));
        }
    }
    let kind = value.and_then(|value| value.get("kind")?.as_str());
    (allowed.resolved(kind), unit)
}

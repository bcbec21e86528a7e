//! Tables whose `kind` decides which further keys they take.
//!
//! People write such a table flat: `{ kind = "z-level", tool = "ball", step = { height = 0.5 } }`. In memory the keys that
//! every kind takes and the keys of one kind are two structs. Before serde reads a table its keys are parted into
//! `{ "$common": {...}, "$own": { "z-level": {...} } }`, so that serde's errors still name the key; [`written_path`] turns
//! their paths back. A key that another kind owns is an error that names it.

use schemars::Schema;
use serde_json::{Map, Value};

use crate::JobError;

/// Name under which serde finds the keys that every kind takes.
pub const COMMON: &str = "$common";
/// Name under which serde finds the keys of the table's kind.
pub const OWN: &str = "$own";

/// The keys that a kind owns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KindKeys {
    /// The kind's name.
    pub kind: &'static str,
    /// Its own keys.
    pub keys: Vec<String>,
}

/// A family of kinds: what their tables may hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Family {
    /// What one of them is called in messages: "operation".
    pub noun: &'static str,
    /// Keys that every kind takes, without `kind`.
    pub common: Vec<String>,
    /// Every kind with its own keys.
    pub kinds: Vec<KindKeys>,
    /// The kind of a table that states none, where there is a default.
    pub default: Option<&'static str>,
}

impl Family {
    /// From the schemas of the common keys and of each kind's own.
    pub fn of(
        noun: &'static str,
        common: &Schema,
        kinds: &[(&'static str, Schema)],
        default: Option<&'static str>,
    ) -> Self {
        let keys = |schema: &Schema| entries(schema, "properties").keys().cloned().collect();
        let kinds = kinds.iter().map(|(kind, own)| KindKeys { kind, keys: keys(own) }).collect();
        Self { noun, common: keys(common), kinds, default }
    }

    /// Parts a table's keys, in place.
    ///
    /// # Errors
    /// No kind, an unknown one, a key that no kind or only another kind takes; `path` is the table's in the document.
    pub fn part(&self, table: &mut Map<String, Value>, path: &str) -> Result<(), JobError> {
        let kind = self.kind_of(table, path)?;
        let (mut common, mut own) = (Map::new(), Map::new());
        for (key, value) in std::mem::take(table) {
            if kind.keys.contains(&key) {
                own.insert(key, value);
            } else if self.common.contains(&key) {
                common.insert(key, value);
            } else if key != "kind" {
                return Err(self.foreign(kind, &key, path));
            }
        }
        table.insert(COMMON.to_owned(), Value::Object(common));
        table.insert(OWN.to_owned(), Value::Object(Map::from_iter([(kind.kind.to_owned(), Value::Object(own))])));
        Ok(())
    }

    fn kind_of(&self, table: &Map<String, Value>, path: &str) -> Result<&KindKeys, JobError> {
        let at = format!("{path}.kind");
        let known = || self.kinds.iter().map(|kind| kind.kind);
        let listed = || known().map(|kind| format!("{kind:?}")).collect::<Vec<_>>().join(", ");
        let stated = match table.get("kind") {
            Some(Value::String(stated)) => stated.as_str(),
            Some(other) => {
                let message = format!("kind = {other}: a word in quotes is expected; allowed: {}", listed());
                return Err(JobError::document("type", at, message, "correct the value"));
            }
            None => self.default.ok_or_else(|| {
                JobError::document("missing", &at, "kind is missing", format!("add kind, one of {}", listed()))
            })?,
        };
        self.kinds.iter().find(|kind| kind.kind == stated).ok_or_else(|| unknown("value", stated, at, known()))
    }

    /// The error for a key that the kind does not take.
    fn foreign(&self, kind: &KindKeys, key: &str, path: &str) -> JobError {
        let at = format!("{path}.{key}");
        let owners: Vec<&str> =
            self.kinds.iter().filter(|other| other.keys.iter().any(|own| own == key)).map(|other| other.kind).collect();
        let own = kind.keys.iter().map(String::as_str);
        if owners.is_empty() {
            let common = self.common.iter().map(String::as_str);
            return unknown("key", key, at, own.chain(common).chain(["kind"]));
        }
        let instead_of = owners.iter().map(|owner| format!("{owner:?}")).collect::<Vec<_>>().join(" or ");
        let (noun, owners) = (self.noun, owners.join(", "));
        let message = format!("{key} is a key of {owners}, and this {noun} is {}", kind.kind);
        let instead = match own.collect::<Vec<_>>().join(", ") {
            none if none.is_empty() => String::new(),
            keys => format!(" ({} takes {keys})", kind.kind),
        };
        JobError::document("foreign-key", at, message, format!("remove {key}{instead}, or write kind = {instead_of}"))
    }
}

/// The error for a word that is not among the known ones, with the nearest that is.
pub fn unknown<'a>(
    what: &str,
    word: &str,
    path: impl Into<String>,
    known: impl IntoIterator<Item = &'a str>,
) -> JobError {
    let known: Vec<&str> = known.into_iter().collect();
    let nearest = known.iter().map(|k| (strsim::damerau_levenshtein(word, k), *k));
    let hint = match nearest.min() {
        Some((distance, near)) if distance <= 1 + word.len() / 3 => format!("did you mean {near:?}?"),
        _ => format!("known here: {}", known.join(", ")),
    };
    JobError::document("unknown", path, format!("unknown {what} {word:?}"), hint)
}

/// The path as the document has it, of a path in a parted document.
pub fn written_path(parted: &str) -> String {
    let mut segments = parted.split('.');
    let mut written = Vec::new();
    while let Some(segment) = segments.next() {
        match segment {
            COMMON => {}
            OWN => {
                segments.next();
            }
            _ => written.push(segment),
        }
    }
    written.join(".")
}

/// Makes an enum with one struct a kind: each line names the module, the struct in it and the kind's name in documents.
/// `$Trait` is what every struct implements, `$About` the type of its constant `ABOUT`.
///
/// The enum reads from `{ "name": { own keys } }` and writes the kind's name and its own keys into the table around it.
/// The modules are declared here too, so that a kind is one file and one line.
macro_rules! kinds {
    ($(#[$attribute:meta])* $Enum:ident: $Trait:path, $About:ty { $($module:ident::$Kind:ident = $name:literal,)+ }) => {
        $(mod $module; pub use $module::$Kind;)+

        $(#[$attribute])*
        #[derive(Clone, Debug, PartialEq, serde::Deserialize)]
        pub enum $Enum {
            $(#[doc = concat!("`", $name, "`.")] #[serde(rename = $name)] $Kind($Kind),)+
        }

        impl $Enum {
            /// The names of all kinds, in their order.
            pub const NAMES: &'static [&'static str] = &[$($name),+];

            /// What is known of each kind without an instance, by its name.
            pub const ABOUT: &'static [(&'static str, $About)] = &[$(($name, $Kind::ABOUT)),+];

            /// Its name as documents write it.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self { $(Self::$Kind(_) => $name,)+ }
            }

            /// What it can do.
            #[must_use]
            pub fn as_kind(&self) -> &dyn $Trait {
                match self { $(Self::$Kind(kind) => kind,)+ }
            }

            /// The schema of each kind's own keys, by the kind's name.
            pub(crate) fn schemas(generator: &mut schemars::SchemaGenerator) -> Vec<(&'static str, schemars::Schema)> {
                vec![$(($name, <$Kind as schemars::JsonSchema>::json_schema(generator))),+]
            }
        }

        impl serde::Serialize for $Enum {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                #[derive(serde::Serialize)]
                struct Flat<'a, T> { kind: &'static str, #[serde(flatten)] own: &'a T }
                match self { $(Self::$Kind(own) => Flat { kind: $name, own }.serialize(serializer),)+ }
            }
        }
    };
}
pub(crate) use kinds;

/// The schema of a family's tables: one alternative a kind, each with the common keys, its own keys and its name.
pub fn schema_of(common: &Schema, kinds: Vec<(&'static str, Schema)>, default: Option<&str>) -> Schema {
    let alternatives: Vec<Value> =
        kinds.into_iter().map(|(kind, own)| alternative(common, kind, &own, default)).collect();
    let description = common.get("description").cloned().unwrap_or_default();
    schemars::json_schema!({ "description": description, "oneOf": alternatives })
}

fn entries(schema: &Schema, key: &str) -> Map<String, Value> {
    schema.get(key).and_then(Value::as_object).cloned().unwrap_or_default()
}

fn alternative(common: &Schema, kind: &str, own: &Schema, default: Option<&str>) -> Value {
    let required = |schema: &Schema| schema.get("required").and_then(Value::as_array).cloned().unwrap_or_default();
    let mut properties = Map::from_iter([("kind".to_owned(), serde_json::json!({ "type": "string", "const": kind }))]);
    if default == Some(kind) {
        properties["kind"]["default"] = kind.into();
    }
    properties.extend(entries(own, "properties"));
    properties.extend(entries(common, "properties"));
    let mut all = if default == Some(kind) { vec![] } else { vec![Value::from("kind")] };
    all.extend(required(own));
    all.extend(required(common));
    let description = own.get("description").cloned().unwrap_or_default();
    let mut schema = serde_json::json!({
        "type": "object",
        "title": kind,
        "description": description,
        "properties": properties,
        "required": all,
        "additionalProperties": false,
    });
    let stated = own.as_object().into_iter().flatten().filter(|(key, _)| key.starts_with("x-"));
    stated.for_each(|(key, value)| schema[key] = value.clone());
    schema
}

#[cfg(test)]
mod tests {
    use super::*;

    fn family() -> Family {
        let kind = |kind, keys: &[&str]| KindKeys { kind, keys: keys.iter().map(|key| (*key).to_owned()).collect() };
        Family {
            noun: "operation",
            common: vec!["tool".to_owned(), "feed".to_owned()],
            kinds: vec![kind("rows", &["apart"]), kind("levels", &["step"]), kind("drill", &[])],
            default: None,
        }
    }

    fn parted(table: &Value) -> Result<Value, JobError> {
        let mut table = table.as_object().unwrap().clone();
        family().part(&mut table, "operations[3]").map(|()| Value::Object(table))
    }

    #[test]
    fn keys_go_to_their_owners() {
        let table = serde_json::json!({ "kind": "rows", "tool": "a", "apart": 2.0 });
        let expected = serde_json::json!({ "$common": { "tool": "a" }, "$own": { "rows": { "apart": 2.0 } } });
        assert_eq!(parted(&table).unwrap(), expected);
    }

    #[test]
    fn a_key_of_another_kind_is_refused_with_its_owner() {
        let error = parted(&serde_json::json!({ "kind": "levels", "apart": 2.0 })).unwrap_err();
        assert_eq!((error.code(), error.location().as_str()), ("foreign-key", "operations[3].apart"));
        assert_eq!(error.to_string(), "apart is a key of rows, and this operation is levels");
        assert_eq!(error.hint(), "remove apart (levels takes step), or write kind = \"rows\"");
        let error = parted(&serde_json::json!({ "kind": "drill", "apart": 2.0 })).unwrap_err();
        assert_eq!(error.hint(), "remove apart, or write kind = \"rows\"");
    }

    #[test]
    fn unknown_keys_and_kinds_are_refused_with_the_nearest() {
        for (table, path, message, hint) in [
            (
                serde_json::json!({ "kind": "rows", "tol": 1 }),
                "operations[3].tol",
                "unknown key \"tol\"",
                "did you mean \"tool\"?",
            ),
            (
                serde_json::json!({ "kind": "row" }),
                "operations[3].kind",
                "unknown value \"row\"",
                "did you mean \"rows\"?",
            ),
            (
                serde_json::json!({ "kind": "x-ray" }),
                "operations[3].kind",
                "unknown value \"x-ray\"",
                "known here: rows, levels, drill",
            ),
            (
                serde_json::json!({ "kind": 5 }),
                "operations[3].kind",
                "kind = 5: a word in quotes is expected; allowed: \"rows\", \"levels\", \"drill\"",
                "correct the value",
            ),
            (
                serde_json::json!({}),
                "operations[3].kind",
                "kind is missing",
                "add kind, one of \"rows\", \"levels\", \"drill\"",
            ),
        ] {
            let error = parted(&table).unwrap_err();
            assert_eq!(
                (error.location().as_str(), error.to_string().as_str(), error.hint().as_str()),
                (path, message, hint)
            );
        }
    }

    #[test]
    fn paths_of_parted_tables_read_as_written() {
        assert_eq!(written_path("operations[0].$own.z-level.step.height"), "operations[0].step.height");
        assert_eq!(written_path("operations[0].$common.feeds.cut"), "operations[0].feeds.cut");
        assert_eq!(written_path("process.$own.spif"), "process");
        assert_eq!(written_path("part.file"), "part.file");
    }
}

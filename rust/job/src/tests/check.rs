//! Jobs that are refused: each error with its code, and the path of the key.

use super::setup::{levels, milling, with, LEVELS};

/// Code and path of the error of a text.
fn refused(text: &str) -> (String, String) {
    let error = crate::from_toml(text).map(|_| ()).expect_err(text);
    assert!(!error.hint().is_empty(), "no hint: {error}");
    (error.code().to_owned(), error.location())
}

#[test]
fn keys_that_exclude_each_other_are_refused_at_the_key() {
    let cases = [
        ("\n[tools.a]", "\nsetup = { sheet = { thickness = 1.0 } }\n[tools.a]", "conflict", "setup.sheet"),
        ("\n[tools.a]", "\nsetup = { zero = \"sheet-top\" }\n[tools.a]", "conflict", "setup.zero"),
        ("\n[tools.a]", "\nsetup = { retract = 20.0 }\n[tools.a]", "conflict", "setup.retract"),
        ("\n[tools.a]", "\nsetup = { fixture = { margin = 1.0 } }\n[tools.a]", "conflict", "setup.fixture"),
        ("units = \"mm\" }", "units = \"mm\", model_face = \"tool\" }", "conflict", "part.model_face"),
        ("units = \"mm\" }", "units = \"mm\", faces = [] }", "empty", "part.faces"),
        ("kind = \"milling\"", "kind = \"spif\"", "conflict", "setup.sheet"),
        ("kind = \"milling\"", "kind = \"spif\", material = \"cheese\"", "conflict", "setup.sheet"),
        ("{ name = \"linuxcnc\" }", "{ name = \"linuxcnc\", file = \"a.toml\" }", "conflict", "machine"),
        ("{ name = \"linuxcnc\" }", "{}", "conflict", "machine"),
        (
            "{ name = \"linuxcnc\" }",
            "{ name = \"linuxcnc\" }\nmachines.b = { name = \"grbl\" }",
            "unknown",
            "machines.b",
        ),
        ("tool = \"a\"", "tool = \"b\"", "unknown", "operations[0].tool"),
        ("tool = \"a\"", "tool = \"a\"\nchannel = \"b\"", "unknown", "operations[0].channel"),
        ("tool = \"a\"", "tool = \"a\"\nfaces = []", "empty", "operations[0].faces"),
        ("tool = \"a\"", "tool = \"a\"\nz_top = 1.0\nz_bottom = 1.0", "conflict", "operations[0].z_bottom"),
        ("tool = \"a\"", "tool = \"a\"\nstepover = 1.0", "foreign-key", "operations[0].stepover"),
        ("diameter = 3.0 }", "diameter = 3.0 }\nlibrary = \"a\"", "conflict", "tools.a"),
        ("diameter = 3.0 }", "diameter = 3.0 }\nlength_offset = 0", "out-of-range", "tools.a.length_offset"),
        ("height = 1.0", "height = 0.0", "out-of-range", "operations[0].step.height"),
        ("tolerance = 0.01", "tolerance = 0.0", "out-of-range", "operations[0].tolerance"),
        ("mode = \"off\"", "mode = \"free\"", "conflict", "operations[0].spindle.mode"),
    ];
    for (before, after, code, path) in cases {
        let text = with(&levels(), before, after);
        assert_eq!(refused(&text), (code.to_owned(), path.to_owned()), "{text}");
    }
}

#[test]
fn a_cutter_whose_spindle_is_not_stated_is_refused_unless_it_follows_from_the_material() {
    let stated = "spindle = { mode = \"off\" }";
    let without = with(&levels(), stated, "");
    assert_eq!(refused(&without), ("missing".to_owned(), "operations[0].spindle".to_owned()));
    let second = format!("{}\n[[operations]]\ntool = \"a\"\ntolerance = 0.01\n{}", levels(), LEVELS);
    assert_eq!(refused(&second).1, "operations[1].spindle");
    let material = with(&without, "kind = \"milling\"", "kind = \"milling\", material = \"aluminium\"");
    crate::from_toml(&material).expect("its spindle follows from the material");
    let sheet = "setup = { sheet = { thickness = 1.0 } }\nmachine = {";
    let text = with(&with(&without, "kind = \"milling\"", "kind = \"spif\""), "machine = {", sheet);
    crate::from_toml(&with(&text, "units = \"mm\"", "units = \"mm\", model_face = \"tool\"")).expect("a stylus slides");
}

#[test]
fn a_number_where_a_table_is_expected_is_answered_with_a_table() {
    for (key, expected) in [
        ("step = 1.0", "a table is expected; allowed: a table like { height = 0.5 }"),
        (
            "step = { height = 1.0, scallop = 0.1 }",
            "a table with one key is expected; allowed: a table like { height = 0.5 }",
        ),
        ("step = {}", "a table with one key is expected"),
        (
            "step = { height = 1.0 }\nspindle = \"off\"",
            "invalid type: string \"off\", where a table is expected; allowed: a table like { mode = \"fixed\", rpm = 8000 }",
        ),
        ("step = { height = 1.0 }\nlinks = 1.0", "a word in quotes is expected; allowed: \"low\", \"clearance\""),
    ] {
        let text = milling(&format!("kind = \"z-level\"\n{key}"));
        let error = crate::from_toml(&text).map(|_| ()).expect_err(key);
        assert!(error.to_string().contains(expected), "{error}");
    }
}

#[test]
fn what_is_missing_or_of_another_type_is_answered_in_words_of_the_document() {
    for (before, after, expected) in [
        ("[[operations]]", "[operations]", "a table, where a list is expected"),
        ("[[operations]]", "[operations]", "put its header in two brackets"),
        ("schema = 1", "", "schema is missing, add schema = 1"),
        ("schema = 1", "schema = \"one\"", "where a whole number is expected"),
        ("step = { height = 1.0 }", "", "step is missing, add step = {"),
    ] {
        let error = crate::from_toml(&with(&levels(), before, after)).map(|_| ()).expect_err(after);
        let words = format!("{error}, {}", error.hint());
        assert!(words.contains(expected), "{words}");
    }
}

#[test]
fn two_tools_with_one_number_and_two_operations_with_one_id_are_refused() {
    let tools = with(&levels(), "[tools.a]", "[tools.b]\nprofile = { kind = \"ball\", diameter = 2.0 }\n[tools.a]");
    assert_eq!(refused(&tools), ("conflict".to_owned(), "tools.b.number".to_owned()));
    let one = "id = \"cut\"\nkind = \"z-level\"\nstep = { height = 1.0 }\ntool = \"a\"\n";
    let operations = format!("{}\n[[operations]]\n{one}\n[[operations]]\n{one}", levels());
    assert_eq!(refused(&operations), ("conflict".to_owned(), "operations[2].id".to_owned()));
}

#[test]
fn a_job_without_operations_is_refused() {
    let (head, _) = levels().split_once("[[operations]]").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    let text = with(&head, "schema = 1", "schema = 1\noperations = []");
    assert_eq!(refused(&text), ("empty".to_owned(), "operations".to_owned()));
}

#[test]
fn every_key_may_be_left_out_that_has_a_default() {
    let job = crate::from_toml(&levels()).unwrap();
    assert_eq!((job.setup.clearance, job.setup.retract), (10.0, 2.0));
    assert_eq!(job.operations[0].common.feeds.cut, 1500.0);
    assert_eq!(job.channels(), ["main"]);
    assert_eq!(job.operations[0].channel(), "main");
}

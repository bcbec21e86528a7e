//! The shipped machine files, and what is refused in a file of one's own.

use crate::support::{cone, grbl, linuxcnc};
use proptest::prelude::*;
use styluscam_post::machine::{LengthUnit, OptionRule};
use styluscam_post::{post, shipped, try_out, Machine, MachineError, OptionValue, TrialError};

/// The shipped file with one passage replaced.
fn changed(from: &str, to: &str) -> Result<Machine, MachineError> {
    let text = Machine::shipped_text("linuxcnc").unwrap();
    assert!(text.contains(from), "{from}");
    Machine::from_toml(&text.replacen(from, to, 1))
}

fn refusal(from: &str, to: &str) -> MachineError {
    let error = changed(from, to).expect_err(to);
    assert!(!error.hint().is_empty() && !error.location().is_empty() && !error.code().is_empty(), "{error}");
    error
}

fn wrong_key(from: &str, to: &str) -> String {
    match refusal(from, to) {
        MachineError::Value { key, .. } => key,
        other => panic!("{other}"),
    }
}

#[test]
fn every_shipped_machine_posts() {
    for name in shipped() {
        let machine = Machine::shipped(name).unwrap();
        assert_eq!(machine.name, name);
        assert!(!machine.source.read.is_empty());
        post(&cone(), &machine).unwrap();
        try_out(&machine).unwrap();
    }
}

#[test]
fn resolution_and_tolerance() {
    let mut machine = linuxcnc();
    assert!((machine.resolution_mm() - 0.001).abs() < 1e-15);
    machine.units.output = LengthUnit::Inch;
    assert!((machine.resolution_mm() - 0.00254).abs() < 1e-15);
    assert!((machine.path_tolerance_mm() - 0.001).abs() < 1e-15);
    assert!(grbl().path_tolerance_mm().abs() < 1e-15);
}

#[test]
fn options() {
    let mut machine = linuxcnc();
    machine.set_option("units", OptionValue::Text("inch".into())).unwrap();
    assert_eq!(machine.units.output, LengthUnit::Inch);
    machine.set_option("smoothing_tolerance", OptionValue::Number(0.01)).unwrap();
    assert!((machine.path_tolerance_mm() - 0.01).abs() < 1e-15);
    let own =
        OptionRule { description: "vacuum".into(), value: OptionValue::Number(1.0), min: Some(0.0), max: Some(2.0) };
    machine.options.insert("vacuum".into(), own);
    machine.templates.program_end = "M10{{ options.vacuum | int }}\nM2".into();
    machine.set_option("vacuum", OptionValue::Number(2.0)).unwrap();
    assert!(post(&cone(), &machine).unwrap().text.ends_with("M102\nM2\n"));
    let refused = [
        ("units", OptionValue::Text("feet".into())),
        ("units", OptionValue::Switch(true)),
        ("vacuum", OptionValue::Number(3.0)),
        ("vacuum", OptionValue::Number(f64::NAN)),
        ("vacuum", OptionValue::Text("2".into())),
    ];
    for (name, value) in refused {
        assert!(matches!(machine.set_option(name, value), Err(MachineError::Option { .. })));
    }
    let error = machine.set_option("vacum", OptionValue::Number(1.0)).unwrap_err();
    assert!(matches!(&error, MachineError::UnknownOption { name, similar, .. }
        if name == "vacum" && similar.as_deref() == Some("vacuum")));
    assert_eq!(error.location(), "options.vacum");
    assert_eq!(
        error.hint(),
        "did you mean \"vacuum\"? Otherwise: the machine's options: vacuum, header, units, smoothing_tolerance, decimals, \
         block_numbers, comments, split_rapids, feed_mode, program_number"
    );
    assert!(error.hint().starts_with("did you mean \"vacuum\"?"));
    assert!(matches!(
        grbl().set_option("smoothing_tolerance", OptionValue::Number(0.1)),
        Err(MachineError::Option { .. })
    ));
}

#[test]
fn unknown_machines() {
    let error = Machine::shipped("linuxnc").unwrap_err();
    let similar = Some("linuxcnc".into());
    assert_eq!(error, MachineError::UnknownMachine { key: "name", name: "linuxnc".into(), similar });
    assert!(error.hint().contains("grbl, grblhal"));
}

#[test]
fn documents_that_are_none() {
    assert!(matches!(Machine::from_toml("schema = "), Err(MachineError::Document { .. })));
    assert!(matches!(Machine::from_toml(""), Err(MachineError::Document { .. })));
    match refusal("max_chars = 252", "max_char = 255") {
        MachineError::Document { place, similar, .. } => {
            assert!(place.starts_with("line.max_char (line "), "{place}");
            assert_eq!(similar.as_deref(), Some("max_chars"));
        }
        other => panic!("{other}"),
    }
    match refusal("unit = \"s\"", "unit = \"minutes\"") {
        MachineError::Document { place, .. } => assert!(place.starts_with("dwell.unit"), "{place}"),
        other => panic!("{other}"),
    }
    assert_eq!(refusal("schema = 1", "schema = 2"), MachineError::Schema { found: 2, known: 1 });
}

#[test]
fn values_out_of_range() {
    let cases = [
        ("schema = 1", "schema = 0", "schema"),
        ("name = \"linuxcnc\"", "name = \" \"", "name"),
        ("[\"G54\",", "[\"g54\",", "wcs[0]"),
        ("end = \"M2\"", "end = \"M2 M5\"", "end"),
        ("mm = \"G21\"", "# no mm", "units"),
        ("linear = 3", "linear = 9", "number.mm.linear"),
        ("linear = 4", "linear = 99", "number.inch.linear"),
        ("max_chars = 252", "max_chars = 5", "line.max_chars"),
        ("counted = \"all\"", "forbidden = \"X\"", "line.forbidden"),
        ("form = \"paren\"", "form = \"paren\"\nmax_len = 1", "comment.max_len"),
        ("form = \"paren\"", "form = \"paren\"\ncharset = \"Z-A\"", "comment.charset"),
        ("form = \"paren\"", "form = \"paren\"\ncharset = \".,\"", "comment.charset"),
        ("[words]", "[block_number]\nstart = 1\nstep = 0\n[words]", "block_number.step"),
        ("[words]", "[block_number]\nstart = 9\nstep = 1\nmax = 5\n[words]", "block_number.max"),
        ("clockwise = \"M3\"", "clockwise = \"3\"", "spindle.clockwise"),
        ("off = \"M5\"", "", "spindle.off"),
        ("off = \"M9\"", "", "coolant.off"),
        ("word = \"P\"", "word = \"Q\"", "dwell.word"),
        ("max_number = 99999", "max_number = 0", "tool.max_number"),
        ("change = \"m6\"", "change = \"pause\"", "templates.tool_change"),
        ("tolerance = 0.001", "tolerance = -1.0", "smoothing.tolerance"),
        ("tolerance = 0.001", "tolerance = 1e-9", "smoothing.tolerance"),
        ("rapid_rate = 3000.0", "rapid_rate = 0.0", "limits.rapid_rate"),
        ("rapid_rate = 3000.0", "rapid_rate = 1.0\nmax_feed = inf", "limits.max_feed"),
        ("rapid_rate = 3000.0", "rapid_rate = 1.0\nmax_rpm = nan", "limits.max_rpm"),
        ("rapid_rate = 3000.0", "rapid_rate = 1.0\nx = [5.0, 1.0]", "limits.x"),
        ("rapid_rate = 3000.0", "rapid_rate = 1.0\naxis_rate = [5.0, 1.0, 0.0]", "limits.axis_rate"),
        ("rapid_rate = 3000.0", "rapid_rate = 1.0\naxis_acceleration = [5.0, -1.0, 1.0]", "limits.axis_acceleration"),
        ("rapid_rate = 3000.0", "rapid_rate = 1.0\ntravel = [5.0, 1.0, 0.0]", "limits.travel"),
        ("percent = true", "percent = true\nrefused = [\"6\"]", "reader.refused[0]"),
    ];
    for (from, to, key) in cases {
        assert_eq!(wrong_key(from, to), key, "{to}");
    }
    assert_eq!(wrong_key("on = \"G64 P{{ tolerance }} Q0\"", ""), "smoothing.on");
}

#[test]
fn options_and_templates_of_a_file() {
    let option = "[options.a]\ndescription = \"\"\nvalue = 5.0\nmax = 1.0\n[templates]";
    assert!(matches!(refusal("[templates]", option), MachineError::Option { .. }));
    match refusal("{{ wcs }}", "{{ wcs }\n") {
        MachineError::Template { name, line, .. } => assert_eq!((name.as_str(), line), ("templates.program_start", 3)),
        other => panic!("{other}"),
    }
}

#[test]
fn trials() {
    let mut machine = linuxcnc();
    machine.limits.x = Some([100.0, 101.0]);
    machine.limits.z = Some([-5.0, -1.0]);
    machine.limits.travel = Some([1.0, 0.5, 4.0]);
    machine.limits.max_feed = Some(5.0);
    machine.limits.max_rpm = Some(90.0);
    try_out(&machine).unwrap();
    let tried = |change: fn(&mut Machine)| {
        let mut machine = linuxcnc();
        change(&mut machine);
        let error = try_out(&machine).unwrap_err();
        assert!(!error.hint().is_empty() && !error.location().is_empty() && !error.code().is_empty(), "{error}");
        error
    };
    assert!(matches!(tried(|m| m.templates.program_end = "M2 ?{{ x }}".into()), TrialError::Post { .. }));
    assert!(matches!(tried(|m| m.templates.program_end = "M66\nM2".into()), TrialError::Read { .. }));
    assert!(matches!(tried(|m| m.templates.program_end = String::new()), TrialError::Read { .. }));
    assert!(matches!(tried(|m| m.templates.tool_change = Some("T1".into())), TrialError::Read { .. }));
    assert!(matches!(tried(|m| m.templates.operation_start = "G0 X0 Y0 Z0\nG91".into()), TrialError::Differs { .. }));
    assert!(matches!(
        tried(|m| m.templates.program_start = "{{ units_word }}\n{{ smoothing }}\nG55".into()),
        TrialError::Differs { .. }
    ));
    assert!(matches!(tried(|m| m.units.mm = Some("G20".into())), TrialError::Read { .. }));
}

#[test]
fn the_schema_lists_the_tables() {
    let schema = Machine::schema();
    let properties = schema.get("properties").unwrap();
    assert!(["units", "line", "tool", "templates", "reader"].iter().all(|k| properties.get(k).is_some()));
}

proptest! {
    #[test]
    fn any_document_is_read_or_refused(at in 0_usize..4000, cut in 0_usize..40, insert in "\\PC{0,8}") {
        for name in shipped() {
            let text: Vec<char> = Machine::shipped_text(name).unwrap().chars().collect();
            let at = at.min(text.len());
            let mutated: String = text[..at].iter().copied().chain(insert.chars()).chain(text.iter().skip(at + cut).copied()).collect();
            if let Ok(machine) = Machine::from_toml(&mutated) {
                let _ = post(&cone(), &machine);
            }
        }
    }
}

//! Damaged text, machine files and templates: an error or a result, never a panic, a hang or a word out of a remark.
//!
//! `FUZZ_SECONDS=600 cargo test --release -p styluscam-post --test it fuzz` goes on for ten minutes each.

use std::time::{Duration, Instant};

use crate::support::{cone, event};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, TestRunner};
use styluscam_motion::EventKind;
use styluscam_post::{check, post, read, shipped, trace, Machine};

/// Longest that any single text may take.
const MOST: Duration = Duration::from_secs(5);

/// Runs `body` on values of a strategy, for as many as `count` or for as long as the environment states.
fn fuzz<S: Strategy>(count: u32, strategy: &S, mut body: impl FnMut(S::Value)) {
    let seconds = std::env::var("FUZZ_SECONDS").ok().and_then(|text| text.parse().ok()).map(Duration::from_secs);
    let mut runner = TestRunner::new(Config::default());
    let start = Instant::now();
    let mut done = 0;
    while seconds.map_or(done < count, |limit| start.elapsed() < limit) {
        let value = strategy.new_tree(&mut runner).unwrap().current();
        let began = Instant::now();
        body(value);
        assert!(began.elapsed() < MOST, "it hung");
        done += 1;
    }
}

/// A change to a text: where (as a share of its length), how much goes, what comes.
type Change = (f64, usize, String);

fn changes() -> impl Strategy<Value = Vec<Change>> {
    let pieces = prop_oneof![
        "\\PC{0,6}",
        "[GMXYZIJKRPQFSTHDNLCO%/;()~.0-9 =+-]{1,12}",
        prop::sample::select(vec![
            "G91",
            "G28",
            "G53",
            "G81",
            "G83 Q0.001",
            "CC X+1 Y+1",
            "C DR-",
            "CP IPA+720",
            "TURN=99999",
            "CR=",
            "T=\"A\"",
            "~",
            "Q339=+1",
            "G2",
            "G3 I1",
            "P999999999",
            "1e9",
            "999999999999999",
            "-.",
            "\u{0}",
            "(",
            ")",
            "\r",
            "\n",
            "CYCLE832(",
            "{{ 1/0 }}",
            "{% for i in range(1000000000) %}x{% endfor %}",
            "{{ comment(comment) }}",
            "[[",
            "= [",
            "\"\"\"",
            "extends",
        ])
        .prop_map(str::to_owned),
    ];
    prop::collection::vec((0.0..1.0_f64, 0_usize..20, pieces), 1..6)
}

fn damaged(text: &str, changes: &[Change]) -> String {
    let mut characters: Vec<char> = text.chars().collect();
    for (share, length, piece) in changes {
        let at = ((share * characters.len() as f64) as usize).min(characters.len());
        let end = (at + length).min(characters.len());
        characters.splice(at..end, piece.chars());
    }
    characters.into_iter().collect()
}

#[test]
fn damaged_programs_of_every_machine() {
    let texts: Vec<(Machine, String)> = shipped()
        .into_iter()
        .flat_map(|name| {
            let machine = Machine::shipped(name).unwrap();
            let trials = check(&machine).unwrap();
            trials
                .into_iter()
                .filter(|t| !t.text.is_empty())
                .map(move |t| (machine.clone(), t.text))
                .collect::<Vec<_>>()
        })
        .collect();
    fuzz(4000, &(0..texts.len(), changes()), |(index, changes)| {
        let (machine, text) = &texts[index];
        let text = damaged(text, &changes);
        if let Ok(reading) = read(&text, machine, &[]) {
            for step in &reading.program.moves {
                assert!(step.end.tip.iter().all(|v| v.is_finite()) && step.feed.is_finite(), "{text}");
            }
            _ = post(&reading.program, machine);
        }
        _ = trace(&text, &|_| None, &styluscam_motion::Watch::default());
    });
}

#[test]
fn damaged_machine_files() {
    let texts: Vec<&str> = shipped().into_iter().map(|name| Machine::shipped_text(name).unwrap()).collect();
    fuzz(1500, &(0..texts.len(), changes()), |(index, changes)| {
        if let Ok(machine) = Machine::from_toml(&damaged(texts[index], &changes)) {
            _ = post(&cone(), &machine);
        }
    });
}

#[test]
fn damaged_templates() {
    let template = "{{ header }}\n{% for t in tools %}T{{ t.number }}{% endfor %}\n{{ comment(program.title) }} {{ length(1.5) }}\n";
    fuzz(1500, &changes(), |changes| {
        let mut machine = Machine::shipped("linuxcnc").unwrap();
        machine.templates.program_start = damaged(template, &changes);
        _ = post(&cone(), &machine);
    });
}

#[test]
fn a_remark_never_becomes_code() {
    let machines: Vec<Machine> = shipped().into_iter().map(|name| Machine::shipped(name).unwrap()).collect();
    let texts = prop_oneof!["\\PC{0,200}", "[()\\[\\]{};:%~\\r\\n/\"'GMXYZ0-9 .-]{0,200}"];
    fuzz(3000, &(0..machines.len(), texts), |(index, remark)| {
        let machine = &machines[index];
        let code = |text: &str| -> Vec<String> {
            let remark =
                |line: &str| line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ').starts_with(['(', ';']);
            text.lines()
                .filter(|line| !remark(line))
                .map(|l| l.trim_start_matches(|c: char| c.is_ascii_digit()).to_owned())
                .collect()
        };
        let mut program = cone();
        let plain = post(&program, machine).unwrap().text;
        program.events.push(event(3, EventKind::Comment { text: remark.clone() }));
        program.setup.title.clone_from(&remark);
        program.setup.notes = vec![remark.clone()];
        program.operations[0].id = remark;
        let text = post(&program, machine).unwrap().text;
        let same = |a: &str, b: &str| {
            a == b || a.contains("PGM") && b.contains("PGM") || a.starts_with('O') && b.starts_with('O')
        };
        let (plain, text) = (code(&plain), code(&text));
        assert!(plain.len() == text.len() && plain.iter().zip(&text).all(|(a, b)| same(a, b)), "{text:#?}");
    });
}

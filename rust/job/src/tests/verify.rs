//! Posted texts, checked: the plan's own, and ones with a fault put in.

use styluscam_motion::Watch;
use styluscam_verify::FindingKind;

use super::setup::{job, levels, machine, planned, scene, with};
use crate::{Judgement, Text, MAIN_CHANNEL};

/// The text of the levels, and what the verifier finds once `edit` has changed it.
fn checked(edit: impl Fn(&str) -> String) -> Judgement {
    let job = job(&levels());
    let plan = planned(&job).unwrap();
    let posted = styluscam_post::post(&plan.channels[MAIN_CHANNEL].program, &machine()).unwrap();
    let (scene, machine, text) = (scene(&job), machine(), edit(&posted.text));
    crate::judge(&job, Text { scene: &scene, machine: &machine, text: &text }, None, &Watch::default()).unwrap()
}

fn kinds(judgement: &Judgement) -> Vec<FindingKind> {
    judgement.report.counts.keys().copied().collect()
}

#[test]
fn nothing_is_found_in_a_plan_s_own_text() {
    let found = checked(str::to_owned);
    assert!(found.report.ok && found.report.findings.is_empty(), "{:?}", found.report.findings);
    assert!(found.report.gouge_max <= 0.001 && found.report.excess_max <= 0.01);
}

#[test]
fn a_level_that_is_left_out_is_missed() {
    let found = checked(|text| {
        let lines: Vec<&str> = text.lines().collect();
        let at = |z: &str| lines.iter().position(|line| line.ends_with(z)).unwrap_or_else(|| panic!("no {z}\n{text}"));
        [&lines[..at(" Z2")], &lines[at(" Z1")..]].concat().join("\n")
    });
    assert_eq!(kinds(&found), [FindingKind::MissingPass, FindingKind::MissingLevel]);
    let heights: Vec<f64> = found.report.findings.iter().filter_map(|finding| Some(finding.position?[2])).collect();
    assert!(heights.iter().all(|z| (1.0..3.0).contains(z)), "{heights:?}");
}

#[test]
fn a_level_that_is_lowered_gouges_by_its_depth_along_the_normal() {
    let found = checked(|text| with(text, "Z2\n", "Z1.9\n"));
    let depth = 0.1 / 2.0_f64.sqrt();
    assert!(kinds(&found).contains(&FindingKind::Gouge), "{:?}", found.report.findings);
    assert!((found.report.gouge_max - depth).abs() < 0.01, "{} for {depth}", found.report.gouge_max);
}

#[test]
fn what_is_left_on_the_faces_is_measured_with_the_operations_expectations() {
    let job = job(&levels());
    let found = checked(str::to_owned);
    let faces = crate::coverage(&job, &scene(&job), &found, &Watch::default()).unwrap();
    assert_eq!(faces.iter().map(|face| face.face).collect::<Vec<_>>(), [1, 3, 4, 5, 6]);
}

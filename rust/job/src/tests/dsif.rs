//! Two tools on both sides of a sheet: the keys, the other side's scene, both programs.

use styluscam_geometry::Vector;
use styluscam_motion::{EventKind, Move, MoveKind, Program, Watch};
use styluscam_verify::FindingKind;

use super::setup::{frustum, job, machine, with};
use crate::{JobDocument, Scene, Setting, Text, MAIN_CHANNEL};

const SUPPORT: &str = "support";

/// A sheet of 1 mm over the frustum, whose face that the main tool touches is the model's.
fn both_sides() -> String {
    r#"
schema = 1
part = { file = "a.stl", units = "mm", model_face = "tool" }
setup = { sheet = { thickness = 1.0 } }
process = { kind = "dsif", support_tool = "b", squeeze = 0.9 }
machine = { name = "linuxcnc" }
machines.support = { name = "linuxcnc" }
[tools.a]
profile = { kind = "ball", diameter = 3.0 }
[tools.b]
number = 2
profile = { kind = "ball", diameter = 2.0 }
[[operations]]
kind = "z-level"
step = { height = 1.0 }
tool = "a"
tolerance = 0.01
"#
    .to_owned()
}

fn scenes(job: &JobDocument) -> [Scene; 2] {
    [MAIN_CHANNEL, SUPPORT].map(|channel| Scene::new(job, channel, &frustum()).unwrap())
}

fn programs(job: &JobDocument) -> [Program; 2] {
    let (scenes, machine) = (scenes(job), machine());
    let settings = [0, 1].map(|i| Setting { scene: &scenes[i], machine: &machine });
    let plan = crate::plan(job, &settings, &Watch::default()).unwrap();
    [MAIN_CHANNEL, SUPPORT].map(|channel| plan.channels[channel].program.clone())
}

/// What is found in the main program beside a support's.
fn found(job: &JobDocument, [main, support]: &[Program; 2]) -> Vec<FindingKind> {
    let (scenes, machine) = (scenes(job), machine());
    let texts = [main, support].map(|program| styluscam_post::post(program, &machine).unwrap().text);
    let text = |i: usize| Text { scene: &scenes[i], machine: &machine, text: &texts[i] };
    let judgement = crate::judge(job, text(0), Some(text(1)), &Watch::default()).unwrap();
    judgement.report.counts.keys().copied().collect()
}

#[test]
fn the_other_side_is_turned_about_x_and_holds_what_is_left_of_the_sheet() {
    for (face, left, top) in [("tool", 0.9, -0.1), ("mid", 0.4, -0.1)] {
        let job = job(&with(&both_sides(), "\"tool\" }", &format!("\"{face}\" }}")));
        let [main, below] = scenes(&job);
        let point = Vector::new(1.0, 2.0, 3.0);
        let [a, b] = [&main, &below].map(|scene| scene.frame.point(point));
        assert!((b - Vector::new(a.x, -a.y, -a.z)).norm() < 1e-12);
        // the top of the hill and its four walls, seen from inside; not the flange's underside
        assert_eq!(below.mesh.triangles().len(), 10);
        assert!((0..10).all(|triangle| below.mesh.normal(triangle).z > 0.0));
        assert!((below.sheet.unwrap().along_normal() - left).abs() < 1e-12);
        assert!((below.opposite.unwrap() - 0.9).abs() < 1e-12);
        // its highest is the frustum's foot, 4 mm under the sheet's top
        let foot = main.mesh.bounds().0.z;
        assert!((below.top - (left - foot)).abs() < 1e-12, "{}", below.top);
        assert!((below.flat - 1.0).abs() < 1e-12 && top < 0.0);
    }
}

#[test]
fn both_programs_have_as_many_moves_and_take_as_long_for_each() {
    let programs = programs(&job(&both_sides()));
    let [main, support] = &programs;
    assert_eq!(main.moves.len(), support.moves.len());
    let (mut late, mut worst) = (0.0_f64, 0.0_f64);
    let unit = machine().resolution_mm();
    let posted = |tip: [f64; 3]| tip.map(|x| (x / unit).round() * unit);
    let length = |step: &Move, start| step.to(posted(step.end.tip)).length(posted(start));
    for ((from, step), (start, other)) in main.segments().zip(support.segments()) {
        assert_eq!(step.kind, other.kind);
        assert_eq!((step.operation, step.role), (other.operation, other.role));
        if let (Some(from), Some(start), MoveKind::Feed) = (from, start, step.kind) {
            late += length(other, start) / other.feed - length(step, from) / step.feed;
            worst = worst.max(late.abs() * step.feed);
        }
    }
    assert!(worst < 0.002, "{worst}");
    let rapids = main.moves.iter().filter(|step| step.kind == MoveKind::Rapid).count();
    assert_eq!(rapids, 1);
    let waits = |program: &Program| {
        program.events.iter().filter(|e| matches!(e.kind, EventKind::Stop { .. })).map(|e| e.before).collect::<Vec<_>>()
    };
    assert_eq!((waits(main), waits(support)), (vec![1], vec![1]));
}

#[test]
fn a_sound_pair_passes_and_what_is_off_is_found() {
    let job = job(&both_sides());
    let sound = programs(&job);
    let errors = |programs: &[Program; 2]| {
        let mut kinds = found(&job, programs);
        // levels of 1 mm on walls that are sharp at their corners are another matter
        kinds.retain(|kind| {
            use FindingKind as Kind;
            matches!(kind, Kind::BlockCount | Kind::OutOfStep | Kind::Squeeze | Kind::Unsupported | Kind::ToolCollision)
        });
        kinds
    };
    assert_eq!(errors(&sound), []);
    let spoilt = |spoil: &dyn Fn(&mut Program)| {
        let mut programs = sound.clone();
        spoil(&mut programs[1]);
        errors(&programs)
    };
    let lengths = sound[1].segments().map(|(start, step)| start.map_or(0.0, |start| step.length(start)));
    let lengths: Vec<f64> = lengths.collect();
    // of the moves along passes
    let longest = |i: &usize| lengths[*i] * f64::from(u8::from(sound[1].moves[*i].is_along_pass()));
    let middle = (1..lengths.len()).max_by(|a, b| longest(a).total_cmp(&longest(b))).unwrap();
    let without = |program: &mut Program| {
        program.moves.remove(middle);
    };
    assert_eq!(spoilt(&without), [FindingKind::BlockCount]);
    assert_eq!(spoilt(&|program| program.moves[middle].feed *= 0.5), [FindingKind::OutOfStep]);
    // up is away from the sheet on both machines
    let raised = |by: f64| move |program: &mut Program| program.moves.iter_mut().for_each(|m| m.end.tip[2] += by);
    assert_eq!(spoilt(&raised(-0.05)), [FindingKind::Squeeze]);
    assert_eq!(spoilt(&raised(0.05)), [FindingKind::Unsupported]);
    assert!(spoilt(&raised(-30.0)).contains(&FindingKind::ToolCollision));
}

#[test]
fn keys_that_contradict_each_other_are_refused() {
    let text = both_sides();
    let refused = |before: &str, after: &str| crate::from_toml(&with(&text, before, after)).unwrap_err();
    let at = |before: &str, after: &str| refused(before, after).location();
    assert_eq!(at("support_tool = \"b\"", "support_tool = \"c\""), "process.support_tool");
    assert_eq!(at("squeeze = 0.9", "squeeze = 0.7"), "process.squeeze");
    assert_eq!(at("model_face = \"tool\"", "model_face = \"back\""), "process.squeeze");
    assert_eq!(at("machines.support = { name = \"linuxcnc\" }\n", ""), "machines.support");
    assert_eq!(at("tool = \"a\"\n", "tool = \"a\"\nchannel = \"support\"\n"), "operations[0].channel");
    let sine =
        with(&with(&text, "model_face = \"tool\"", "model_face = \"back\""), "1.0 } }", "1.0, law = \"sine\" } }");
    assert!(crate::from_toml(&sine).is_ok());
}

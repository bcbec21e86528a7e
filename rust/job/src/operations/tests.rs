//! Every kind of the registry, held to what the rest of the job relies on.

use serde_json::Value;
use styluscam_motion::Watch;
use styluscam_post::Machine;
use styluscam_verify::Passes;

use super::{Direction, Operation, PassContext, Serves, StarterPasses};
use crate::tests::setup::{frustum, machine, milling};
use crate::{JobDocument, Scene, Setting};

/// A milling job of one operation of a kind, with the lines that a starter job gives it.
fn job(kind: usize) -> Result<JobDocument, crate::JobError> {
    let (name, about) = Operation::ABOUT[kind];
    let keys = (about.starter)(StarterPasses { pitch: 1.0, ..StarterPasses::default() });
    crate::from_toml(&milling(&format!("kind = \"{name}\"\n{keys}")))
}

/// The kinds that mill: a meridian is formed of a sheet that turns, and is planned by the tests of spinning.
fn kinds() -> impl Iterator<Item = usize> {
    assert_eq!(Operation::ABOUT.len(), Operation::NAMES.len());
    (0..Operation::ABOUT.len()).filter(|kind| Operation::NAMES[*kind] != "meridian")
}

#[test]
fn the_starter_lines_of_every_kind_make_a_job() {
    for kind in kinds() {
        let (name, about) = Operation::ABOUT[kind];
        let job = job(kind).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(job.operations[0].operation.name(), name);
        assert!(!about.purpose.is_empty(), "{name} does not say what it is for");
        let lines = (about.starter)(StarterPasses { pitch: 1.0, ..StarterPasses::default() });
        assert!(lines.lines().all(|line| line.contains('#')), "{name}: a line of the starter job has no comment");
    }
}

#[test]
fn one_kind_serves_each_work_of_a_starter_job() {
    for serves in [Serves::Walls, Serves::Floors, Serves::Stock, Serves::Holes] {
        assert_eq!(Operation::ABOUT.iter().filter(|(_, about)| about.serves == serves).count(), 1, "{serves:?}");
    }
}

#[test]
fn every_key_of_every_kind_has_a_help_text() {
    let schema = crate::schema();
    let alternatives = schema.pointer("/$defs/OperationSection/oneOf").and_then(Value::as_array).unwrap();
    assert_eq!(alternatives.len(), Operation::NAMES.len());
    for (alternative, name) in alternatives.iter().zip(Operation::NAMES) {
        assert_eq!(alternative.pointer("/properties/kind/const").unwrap(), name);
        let has_text =
            |value: &Value| value.get("description").and_then(Value::as_str).is_some_and(|text| !text.is_empty());
        assert!(has_text(alternative), "{name} has no description");
        for (key, value) in alternative["properties"].as_object().unwrap().iter().filter(|(key, _)| *key != "kind") {
            assert!(has_text(value), "{name}.{key} has no help text");
        }
    }
}

#[test]
fn every_kind_plans_and_says_what_it_planned() {
    let (part, watch) = (frustum(), Watch::default());
    let (upright, turning) = (machine(), Machine::shipped("linuxcnc-trunnion").unwrap());
    // a pocket takes a minute with a tool this small, and a frustum has neither holes nor concave edges, nor the ball a cone:
    // tests/python/test_pocket_operation.py, test_drill.py, test_helix_bore.py, test_pencil.py, test_chamfer.py and
    // test_contour.py plan those
    let others = ["pocket", "drill", "helix-bore", "pencil", "chamfer", "contour"];
    for kind in kinds().filter(|kind| !others.contains(&Operation::NAMES[*kind])) {
        let job = job(kind).unwrap();
        let scene = Scene::new(&job, crate::MAIN_CHANNEL, &part).unwrap();
        let machine = if job.operations[0].kind().leans() { &turning } else { &upright };
        let plan = crate::plan(&job, &[Setting { scene: &scene, machine }], &watch).unwrap();
        let channel = &plan.channels[crate::MAIN_CHANNEL];
        let (name, summary): (&str, _) = (Operation::NAMES[kind], &channel.operations[0]);
        assert_eq!(summary.kind, name);
        assert!(channel.program.moves.len() > 10, "{name} plans nothing");
        assert!(!summary.words.is_empty() && !summary.note.is_empty(), "{name} has no words for what it planned");
        assert!(summary.facts.iter().all(|fact| fact.value > 0.0 && !fact.words.is_empty()), "{name}");
        assert!(!summary.facts.is_empty(), "{name} has no figures");
        let tools = crate::resolve::tools(&job).unwrap();
        let body = tools.values().next().unwrap().0.body(None);
        let faces = [3, 4, 5, 6];
        let given = PassContext {
            scene: &scene,
            faces: &faces,
            tolerance: 0.01,
            smallest_feature: 1.0,
            top: 0.0,
            bottom: None,
            body: &body,
            to_leave: [0.0; 2],
            direction: Direction::default(),
        };
        match job.operations[0].kind().passes(&given) {
            Passes::Ordered(passes) => assert!(passes.pitch.largest() > 0.0, "{name}"),
            Passes::Crossed(sets) => assert!(sets.iter().all(|set| set.pitch.largest() > 0.0), "{name}"),
            Passes::Clearing(clearing) => assert!(clearing.angle > 0.0 && clearing.pitch.largest() > 0.0, "{name}"),
            Passes::Flank(flank) => assert!(flank.max_error > 0.0 && flank.faces.len() == 4, "{name}"),
            Passes::Drilling(drilling) => assert!(!drilling.holes.is_empty(), "{name}"),
            Passes::Boring(boring) => assert!(!boring.holes.is_empty(), "{name}"),
            Passes::Chamfering(chamfering) => assert!(!chamfering.edges.is_empty(), "{name}"),
            Passes::Contouring(contouring) => assert!(!contouring.lines.is_empty(), "{name}"),
            Passes::Covering { scallop } => assert!(scallop > 0.0, "{name}"),
            Passes::Unordered { reason } => {
                assert!(!reason.is_empty(), "{name} does not say why its passes are not checked");
            }
        }
    }
}

#[test]
fn what_one_kind_owns_no_other_takes() {
    for family in [super::family(), crate::process::family()] {
        for kind in &family.kinds {
            for key in &kind.keys {
                assert!(!family.common.contains(key), "{key} of {} is a common key too", kind.kind);
            }
        }
    }
}

#[test]
fn a_job_is_written_as_it_was_read() {
    for kind in kinds() {
        let job = job(kind).unwrap();
        let text = serde_json::to_string(&job).unwrap();
        assert!(!text.contains('$'), "the parted form is written: {text}");
        assert_eq!(crate::from_json(&text).unwrap(), job);
    }
}

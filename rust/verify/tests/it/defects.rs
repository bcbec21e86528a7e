//! Sound programs pass, and every seeded defect is found where it is.

use crate::common::{ball, clothoid, limits, tip_on_cone, Levels, Part, Path, CLEARANCE};
use styluscam_geometry::{ModelFace, Sheet, SheetLaw, Tool, Vector};
use styluscam_motion::{FeedMode, MoveKind, Program, UnitAxis, Watch};
use styluscam_verify::{judge, Finding, FindingKind, Limits, Report, Severity};

const LOW: f64 = 10.0;
const HIGH: f64 = 30.0;

fn levels<'a>(tool: &'a Tool, inner: bool, sheet: Option<Sheet>) -> Levels<'a> {
    Levels { tool, sheet, inner, low: LOW, high: HIGH, levels: 6, points: 300, off: 0.0015 }
}

fn part(inner: bool) -> Part {
    Part::cone(inner, LOW, HIGH, 600, 20)
}

fn judged(part: &Part, tool: &Tool, sheet: Option<Sheet>, program: &Program) -> Report {
    let tools = [tool.clone()];
    let mut subject = part.subject(&tools);
    subject.sheet = sheet;
    judge(program, &subject, &limits(), &Watch::default()).unwrap()
}

fn of_kind(report: &Report, kind: FindingKind) -> Vec<&Finding> {
    report.findings.iter().filter(|f| f.kind == kind).collect()
}

fn sheet(law: SheetLaw, model_face: ModelFace) -> Sheet {
    Sheet { thickness: 1.0, law, model_face }
}

#[test]
fn sound_programs_pass() {
    for inner in [true, false] {
        for tool in [ball(8.0), clothoid(8.0)] {
            for sheet in
                [None, Some(sheet(SheetLaw::Constant, ModelFace::Back)), Some(sheet(SheetLaw::Sine, ModelFace::Mid))]
            {
                let program = levels(&tool, inner, sheet).path().program(&tool);
                let report = judged(&part(inner), &tool, sheet, &program);
                assert!(report.ok && report.findings.is_empty(), "{inner}: {:?}", report.findings);
                assert!(report.gouge_max < 0.001 && report.excess_max > 0.0005, "{inner} {}", report.excess_max);
                assert!((report.contact_share - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn one_wrong_coordinate_is_one_finding_at_its_line() {
    for inner in [true, false] {
        for tool in [ball(8.0), clothoid(8.0)] {
            for wrong in [200, 777, 1500] {
                let part = part(inner);
                let mut program = levels(&tool, inner, None).path().program(&tool);
                program.moves[wrong].end.tip[2] -= 0.05;
                let report = judged(&part, &tool, None, &program);
                let found = of_kind(&report, FindingKind::Gouge);
                assert_eq!((report.findings.len(), found.len()), (1, 1), "{:?}", report.findings);
                assert_eq!(found[0].line, program.moves[wrong].line, "{inner} {} {found:?}", tool.description());
                assert_eq!(found[0].position, Some(program.moves[wrong].end.tip));
                let depth = 0.05 * std::f64::consts::FRAC_1_SQRT_2 - 0.0015;
                assert!((found[0].value_mm.unwrap() - depth).abs() < 0.001, "{:?}", found[0].value_mm);
                assert!(!report.ok && (report.gouge_max - depth).abs() < 0.001);
                assert_eq!(report.gouge_at.unwrap().line, program.moves[wrong].line);

                program.moves[wrong].end.tip[2] += 0.1;
                let report = judged(&part, &tool, None, &program);
                let found = of_kind(&report, FindingKind::Excess);
                assert_eq!((report.findings.len(), found.len()), (1, 1), "{:?}", report.findings);
                assert_eq!(found[0].line, program.moves[wrong].line);
                assert!(found[0].message.starts_with(&format!("line {}, X", found[0].line)), "{}", found[0].message);
            }
        }
    }
}

#[test]
fn a_gouge_between_the_ends_of_a_move_is_found() {
    // straight across the hill's flank, 5 mm deep in the middle, free at both ends
    let (part, tool) = (part(false), ball(8.0));
    let program =
        Path::new().rapid([-40.0, 15.0, CLEARANCE]).feed([-40.0, 15.0, -8.0]).feed([40.0, 15.0, -8.0]).program(&tool);
    let report = judged(&part, &tool, None, &program);
    let found = of_kind(&report, FindingKind::Gouge);
    assert_eq!(found[0].line, 13);
    assert!(found[0].position.unwrap()[0].abs() < 0.5, "{:?}", found[0].position);
    assert!(report.gouge_max > 2.0);
}

#[test]
fn a_shallow_gouge_off_the_samples_is_found() {
    // past the hill's flank: 0.02 mm deep at X0, which is neither an end nor the middle
    let (part, tool) = (part(false), ball(8.0));
    let contact = Vector::new(0.0, 20.0, LOW - 20.0);
    let [_, y, z] = tip_on_cone(&tool.cutter(), None, false, contact, -0.02);
    let program = Path::new().rapid([-40.0, y, CLEARANCE]).feed([-40.0, y, z]).feed([10.0, y, z]).program(&tool);
    let tools = [tool];
    for excess in [Some(0.005), None] {
        let limits = Limits { excess, ..limits() };
        let report = judge(&program, &part.subject(&tools), &limits, &Watch::default()).unwrap();
        let found = of_kind(&report, FindingKind::Gouge);
        assert_eq!((found.len(), found[0].line), (1, 13));
        assert!((found[0].value_mm.unwrap() - 0.02).abs() < 0.001, "{}", found[0].message);
        assert!(found[0].position.unwrap()[0].abs() < 0.2, "{}", found[0].message);
    }
}

#[test]
fn the_model_face_flipped_is_named() {
    let tool = clothoid(8.0);
    for inner in [true, false] {
        for law in [SheetLaw::Constant, SheetLaw::Sine] {
            let program = levels(&tool, inner, Some(sheet(law, ModelFace::Tool))).path().program(&tool);
            let report = judged(&part(inner), &tool, Some(sheet(law, ModelFace::Back)), &program);
            let found = of_kind(&report, FindingKind::NoContact);
            assert!(found[0].message.contains("sheet's thickness: is model_face right"), "{}", found[0].message);
            assert!(report.gouge_max > 0.5 && !report.ok);
            // and the other way round, where it floats
            let program = levels(&tool, inner, Some(sheet(law, ModelFace::Back))).path().program(&tool);
            let report = judged(&part(inner), &tool, Some(sheet(law, ModelFace::Tool)), &program);
            let found = of_kind(&report, FindingKind::NoContact);
            assert!(found[0].message.contains("sheet's thickness: is model_face right"), "{}", found[0].message);
        }
    }
}

#[test]
fn the_centre_taken_for_the_tip_is_named() {
    let tool = ball(8.0);
    for shift in [4.0, -4.0] {
        let mut program = levels(&tool, true, None).path().program(&tool);
        program.moves.iter_mut().for_each(|m| m.end.tip[2] += shift);
        let report = judged(&part(true), &tool, None, &program);
        let found = of_kind(&report, FindingKind::NoContact);
        assert!(found[0].message.contains("centre"), "{}", found[0].message);
    }
}

#[test]
fn inches_taken_for_millimetres_are_named() {
    let tool = ball(8.0);
    for (scale, words) in [(25.4, "millimetres taken for inches"), (1.0 / 25.4, "inches taken for millimetres")] {
        let mut program = levels(&tool, false, None).path().program(&tool);
        program.moves.iter_mut().for_each(|m| m.end.tip = m.end.tip.map(|x| x * scale));
        let report = judged(&part(false), &tool, None, &program);
        assert!(of_kind(&report, FindingKind::NoContact)[0].message.contains(words), "{:?}", report.findings);
    }
}

#[test]
fn rapids_are_judged() {
    let (part, tool) = (part(false), ball(8.0));
    let program = Path::new()
        .rapid([-50.0, 0.0, CLEARANCE])
        .rapid([-50.0, 0.0, -5.0])
        .rapid([50.0, 0.0, -5.0])
        .rapid([50.0, 0.0, CLEARANCE])
        .rapid([0.0, 50.0, 0.0])
        .rapid([0.0, 50.0, CLEARANCE])
        .rapid([0.0, 20.0, CLEARANCE])
        .rapid([0.0, 20.0, -9.0])
        .rapid([0.0, 20.0, CLEARANCE])
        .feed([0.0, 20.0, 5.0])
        .program(&tool);
    let report = judged(&part, &tool, None, &program);
    let lines = |kind| of_kind(&report, kind).iter().map(|f| f.line).collect::<Vec<_>>();
    assert_eq!(lines(FindingKind::LowRapid), [13]);
    assert_eq!(lines(FindingKind::RapidIntoMaterial), [13]);
    assert_eq!(lines(FindingKind::DogLegRapid), [15]);
    assert_eq!(lines(FindingKind::RapidPlunge), [18]);
}

#[test]
fn a_rapid_may_not_land_on_the_part() {
    let (part, tool) = (part(false), ball(8.0));
    let touching = levels(&tool, false, None).path().moves[1].end.tip;
    let above = |gap: f64| [touching[0], touching[1], touching[2] + gap];
    for (gap, count) in [(0.03, 1), (0.2, 0)] {
        let program = Path::new()
            .rapid([touching[0], touching[1], CLEARANCE])
            .rapid(above(gap))
            .feed(touching)
            .rapid([touching[0], touching[1], CLEARANCE])
            .program(&tool);
        let report = judged(&part, &tool, None, &program);
        assert_eq!(of_kind(&report, FindingKind::RapidPlunge).len(), count, "{:?}", report.findings);
    }
}

#[test]
fn text_faults_are_found() {
    let tool = ball(8.0);
    let sound = levels(&tool, true, None).path().program(&tool);
    let kinds = |change: &dyn Fn(&mut Program)| {
        let mut program = sound.clone();
        change(&mut program);
        let report = judged(&part(true), &tool, None, &program);
        report.findings.iter().map(|f| (f.kind, f.line, f.severity)).collect::<Vec<_>>()
    };
    let error = Severity::Error;
    assert_eq!(kinds(&|p| p.moves[7].feed = 0.0), [(FindingKind::MissingFeed, 18, error)]);
    assert_eq!(kinds(&|p| p.events.clear()), [(FindingKind::MissingToolChange, 12, Severity::Warning)]);
    assert_eq!(kinds(&|p| p.moves.clear()), [(FindingKind::NoFeedMoves, 0, error)]);
    assert_eq!(kinds(&|p| p.moves.retain(|m| m.kind == MoveKind::Rapid))[0].0, FindingKind::NoFeedMoves);
    assert_eq!(kinds(&|p| p.moves[9].end.tip[1] = f64::NAN), [(FindingKind::NotFinite, 20, error)]);
    assert_eq!(kinds(&|p| p.moves[9].end.tip[1] = -1e300), [(FindingKind::NotFinite, 20, error)]);
    let unknown = kinds(&|p| p.events[0].kind = styluscam_motion::EventKind::ToolChange { tool: 9 });
    assert_eq!(unknown, [(FindingKind::UnknownTool, 11, error)]);
    let tilted = UnitAxis::new([0.6, 0.0, 0.8]).unwrap();
    let leaning = kinds(&|p| p.moves[9] = p.moves[9].with_axis(tilted));
    // what it enters is checked all the same
    assert_eq!(leaning, [(FindingKind::Gouge, 20, error), (FindingKind::ToolAxis, 20, error)]);
    let turning = kinds(&|p| p.moves[9] = p.moves[9].with_feed(0.1, FeedMode::PerRevolution));
    assert_eq!(turning, [(FindingKind::FeedMode, 20, error)]);
}

#[test]
fn a_feed_move_from_an_unknown_place_is_found() {
    let (part, tool) = (part(true), ball(8.0));
    let program = levels(&tool, true, None).path().program(&tool);
    let tools = [tool];
    let mut subject = part.subject(&tools);
    let run = 0..3;
    subject.unknown_positions = std::slice::from_ref(&run);
    let report = judge(&program, &subject, &limits(), &Watch::default()).unwrap();
    let found = of_kind(&report, FindingKind::UnplacedFeed);
    assert_eq!((found[0].first_line, found[0].last_line), (12, 14));
}

#[test]
fn the_meshs_own_error_counts_against_the_program() {
    let (part, tool) = (part(true), ball(8.0));
    let program = levels(&tool, true, None).path().program(&tool);
    let tools = [tool];
    let mut subject = part.subject(&tools);
    let bare = judge(&program, &subject, &limits(), &Watch::default()).unwrap();
    subject.deviation_inward = 0.004;
    subject.deviation_outward = 0.004;
    let report = judge(&program, &subject, &limits(), &Watch::default()).unwrap();
    assert!((report.gouge_max - 0.0025).abs() < 0.0005, "{}", report.gouge_max);
    assert!((report.excess_max - bare.excess_max - 0.004).abs() < 1e-12, "{}", report.excess_max);
    assert_eq!(of_kind(&report, FindingKind::Gouge).len(), 6);
}

#[test]
fn a_program_that_need_not_touch_is_only_held_clear() {
    let (part, tool) = (part(true), ball(8.0));
    let mut program = levels(&tool, true, None).path().program(&tool);
    program.moves.iter_mut().for_each(|m| m.end.tip[2] += 1.0);
    let free = Limits { excess: None, ..limits() };
    let tools = [tool];
    let report = judge(&program, &part.subject(&tools), &free, &Watch::default()).unwrap();
    assert!(report.ok && report.contacts.is_empty());
    program.moves[500].end.tip[2] -= 1.5;
    let report = judge(&program, &part.subject(&tools), &free, &Watch::default()).unwrap();
    assert_eq!(of_kind(&report, FindingKind::Gouge)[0].line, program.moves[500].line);
}

#[test]
fn a_long_fault_is_one_finding_and_many_are_counted() {
    let (part, tool) = (part(true), ball(8.0));
    let mut program = levels(&tool, true, None).path().program(&tool);
    program.moves[400..500].iter_mut().for_each(|m| m.end.tip[2] -= 0.02);
    let report = judged(&part, &tool, None, &program);
    let found = of_kind(&report, FindingKind::Gouge);
    assert_eq!((found.len(), found[0].first_line, found[0].last_line, found[0].moves), (1, 411, 511, 101));
    let mut program = levels(&tool, true, None).path().program(&tool);
    (0..50).for_each(|i| program.moves[10 * i + 5].end.tip[2] -= 0.02);
    let report = judged(&part, &tool, None, &program);
    assert_eq!(of_kind(&report, FindingKind::Gouge).len(), 20);
    assert!(report.counts[&FindingKind::Gouge] >= 48, "{:?}", report.counts);
}

#[test]
fn contacts_lie_on_the_part() {
    let (part, tool) = (part(true), ball(8.0));
    let program = levels(&tool, true, None).path().program(&tool);
    let report = judged(&part, &tool, None, &program);
    assert!(report.contacts.len() > 3000 && report.contacts.len() <= 4000);
    for contact in &report.contacts {
        let [x, y, z] = contact.point;
        assert!((x.hypot(y) - HIGH - z).abs() < 0.002);
        let centre = [contact.tip[0], contact.tip[1], contact.tip[2] + 4.0];
        let off = (0..3).map(|i| (centre[i] - contact.point[i]).powi(2)).sum::<f64>().sqrt() - 4.0;
        assert!((off - contact.clearance).abs() < 1e-9);
        assert_eq!(contact.face, 1);
    }
}

#[test]
fn the_report_survives_json() {
    let (part, tool) = (part(true), ball(8.0));
    let mut program = levels(&tool, true, None).path().program(&tool);
    program.moves[100].end.tip[2] -= 0.3;
    let report = judged(&part, &tool, None, &program);
    let text = serde_json::to_string(&report).unwrap();
    assert!(text.contains(r#""kind":"gouge""#) && text.contains(r#""counts":{"gouge":1"#), "{text}");
    assert_eq!(serde_json::from_str::<Report>(&text).unwrap(), report);
}

#[test]
fn nothing_is_too_strange_to_be_judged() {
    let part = part(true);
    let tool = ball(8.0);
    let odd = [f64::NAN, f64::INFINITY, -1e300, 1e-300, -0.0, 1e7, 0.1, 9.9e6];
    let mut path = Path::new();
    for x in odd {
        for z in odd {
            path = path.rapid([x, z, x]).feed([x, 0.0, z]).feed([0.0, z, z]).feed([z, z, x]);
        }
    }
    let mut program = path.program(&tool);
    let tools = [tool];
    let nowhere = 0..9999;
    for (unknown_positions, tools, excess) in
        [(&[][..], &tools[..], Some(0.005)), (std::slice::from_ref(&nowhere), &tools, None), (&[], &[], Some(-1.0))]
    {
        program.operations.clear();
        let subject = styluscam_verify::Subject { unknown_positions, tools, ..part.subject(tools) };
        let strange = Limits { excess, gouge: f64::NAN, clearance: f64::INFINITY, ..limits() };
        for limits in [limits(), strange] {
            assert!(!judge(&program, &subject, &limits, &Watch::default()).unwrap().ok);
        }
    }
}

#[test]
fn the_same_fault_in_two_regions_is_told_twice_and_not_a_hundred_times() {
    let (part, tool) = (part(true), ball(8.0));
    let mut program = levels(&tool, true, None).path().program(&tool);
    // every third position beyond X20 or X-20 on the topmost level
    for step in program.moves.iter_mut().step_by(3) {
        let [x, _, z] = &mut step.end.tip;
        if *z < CLEARANCE && x.abs() > 20.0 {
            *z -= if *x > 0.0 { 0.2 } else { 0.05 };
        }
    }
    let report = judged(&part, &tool, None, &program);
    let groups: Vec<_> = report.groups.iter().filter(|group| group.kind == FindingKind::Gouge).collect();
    assert_eq!(groups.len(), 2, "{groups:?}");
    assert_eq!(groups.iter().map(|group| group.count).sum::<usize>(), report.counts[&FindingKind::Gouge]);
    for group in groups {
        let [low, high] = group.extent.unwrap();
        assert!(low[0] > 20.0 || high[0] < -20.0, "{group:?}");
        let listed: Vec<&Finding> = group.findings.iter().map(|index| &report.findings[*index]).collect();
        assert_eq!(listed.len(), group.count.min(20));
        let deepest = listed.iter().filter_map(|finding| finding.value).fold(0.0, f64::max);
        // of positions that differ by arithmetic the first one is named
        assert!((group.value.unwrap() - deepest).abs() < 1e-6);
        assert!((deepest - if low[0] > 0.0 { 0.14 } else { 0.034 }).abs() < 0.01, "{deepest}");
        let worst = listed.iter().find(|finding| finding.value == group.value).unwrap();
        assert_eq!((group.line, group.position), (worst.line, worst.position));
        assert!(group.message.contains(&format!("the worst of {} positions in X", group.count)), "{}", group.message);
    }
}

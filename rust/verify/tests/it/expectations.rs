//! What is expected is data: contact or clearance, and passes in any order that has a value and a gradient.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use std::sync::Arc;

use crate::common::{ball, expected, limits, tip_on_cone, Levels, Part, Path, CLEARANCE};
use styluscam_geometry::{Tool, Vector};
use styluscam_motion::{Move, Program, Role, Watch};
use styluscam_verify::{
    judge, Contact, ExpectedOperation, FindingKind, Height, OrderedPasses, Passes, Pitch, Report, Scalar, Severity,
    Subject,
};

const LOW: f64 = 10.0;
const HIGH: f64 = 30.0;
/// Distance between passes, mm.
const STEP: f64 = 1.0;
/// Radii of the dome and of the ball that goes over it, mm.
const DOME: f64 = 30.0;
const BALL: f64 = 4.0;
/// Plan radius of the innermost ring, mm, and how many rings there are.
const INNERMOST: f64 = 0.6;
const RINGS: usize = 23;

/// Distance from the Z axis: rings. All that an order of its own has to give.
#[derive(Debug)]
struct FromAxis;

impl Scalar for FromAxis {
    fn value(&self, tip: Vector) -> f64 {
        tip.xy().norm()
    }

    fn gradient(&self, tip: Vector) -> Vector {
        Vector::new(tip.x, tip.y, 0.0).try_normalize(1e-9).unwrap_or_else(Vector::zeros)
    }
}

fn ordered(scalar: Arc<dyn Scalar>, continuous: bool) -> Passes {
    Passes::Ordered(OrderedPasses { scalar, pitch: Pitch::Even(STEP), continuous, smallest_feature: 1.0 })
}

fn judged(part: &Part, tool: &Tool, expected: &[ExpectedOperation], program: &Program) -> Report {
    let tools = [tool.clone()];
    let subject = Subject { expected, ..part.subject(&tools) };
    judge(program, &subject, &limits(), &Watch::default()).unwrap()
}

fn kinds(report: &Report) -> Vec<FindingKind> {
    report.groups.iter().map(|group| group.kind).collect()
}

/// A dome about the Z axis, its top at Z0, to 20 mm from the axis.
fn dome() -> Part {
    let (rings, segments) = (64, 240);
    let mut vertices = vec![Vector::zeros()];
    for ring in 1..=rings {
        let angle = (20.0 / DOME).asin() * f64::from(ring) / f64::from(rings);
        for i in 0..segments {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(segments)).sin_cos();
            let (r, z) = (DOME * angle.sin(), DOME * (angle.cos() - 1.0));
            vertices.push(Vector::new(r * cos, r * sin, z));
        }
    }
    let at = |ring: u32, i: u32| i64::from(1 + (ring - 1) * segments as u32 + i % segments as u32);
    let mut triangles: Vec<[i64; 3]> = (0..segments as u32).map(|i| [0, at(1, i), at(1, i + 1)]).collect();
    for ring in 1..rings as u32 {
        for i in 0..segments as u32 {
            let [a, b, c, d] = [at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Part::new(vertices, &triangles)
}

/// Rings over the dome, from the axis outwards; of each the share of a turn that `share` names by its number.
fn rings(tool: &Tool, share: impl Fn(usize) -> f64) -> Program {
    let tip = |ring: usize, turn: f64| {
        let radius = INNERMOST + STEP * ring as f64;
        let (sin, cos) = (TAU * turn).sin_cos();
        let centre = DOME + BALL;
        let z = (centre * centre - radius * radius).sqrt() - DOME - BALL;
        [radius * cos, radius * sin, z]
    };
    let mut path = Path::new();
    for ring in (0..RINGS).filter(|ring| share(*ring) > 0.0) {
        let [x, y, z] = tip(ring, 0.0);
        path = path.rapid([x, y, CLEARANCE]).feed([x, y, z]);
        for i in 1..=360 {
            path = path.feed(tip(ring, share(ring) * f64::from(i) / 360.0));
        }
        let [x, y, _] = tip(ring, share(ring));
        path = path.rapid([x, y, CLEARANCE]);
    }
    path.program(tool)
}

#[test]
fn rings_are_checked_by_a_scalar_of_their_own() {
    let (part, tool) = (dome(), ball(2.0 * BALL));
    let expected = expected(&part, Contact::Touch, [-100.0, 100.0], ordered(Arc::new(FromAxis), false));
    let report = |share: &dyn Fn(usize) -> f64| judged(&part, &tool, &expected, &rings(&tool, share));

    let complete = report(&|_| 1.0);
    assert!(complete.ok && complete.findings.is_empty(), "{:?}", complete.groups);

    let one_missing = report(&|ring| f64::from(ring != 10));
    let gap = one_missing.findings.iter().find(|finding| finding.kind == FindingKind::MissingRow).unwrap();
    assert!((gap.value.unwrap() - 2.0 * STEP).abs() < 0.01 && gap.limit == Some(STEP), "{gap:?}");
    let [x, y, _] = gap.position.unwrap();
    assert!((x.hypot(y) - (INNERMOST + 11.0 * STEP)).abs() < 0.01, "{gap:?}");

    let end_missing = report(&|ring| f64::from(ring < 19));
    assert!(kinds(&end_missing).contains(&FindingKind::MissingRow), "{:?}", end_missing.groups);

    let half_missing = report(&|ring| if ring == 15 { 0.5 } else { 1.0 });
    let left = half_missing.findings.iter().find(|finding| finding.kind == FindingKind::MissingPass).unwrap();
    let [x, y, _] = left.position.unwrap();
    assert!((x.hypot(y) - (INNERMOST + 15.0 * STEP)).abs() < STEP && y < 0.5, "{left:?}");
}

/// A spiral down the hill between two level turns; turns that `skipped` names are left out.
fn spiral(tool: &Tool, turns: usize, skipped: &[usize]) -> Program {
    let (cutter, points) = (tool.cutter(), 300);
    let tip = |turn: f64| {
        let down = (turn - 1.0).clamp(0.0, (turns - 2) as f64) * STEP;
        let (sin, cos) = (TAU * turn).sin_cos();
        let radius = LOW + 2.0 + down;
        let contact = Vector::new(radius * cos, radius * sin, LOW - radius);
        tip_on_cone(&cutter, None, false, contact, 0.0015)
    };
    let mut path = Path::new();
    let mut is_down = false;
    for turn in 0..turns {
        if skipped.contains(&turn) {
            let [x, y, _] = tip(turn as f64);
            path = path.rapid([x, y, CLEARANCE]);
            is_down = false;
            continue;
        }
        if !is_down {
            let first = tip(turn as f64);
            path = path.rapid([first[0], first[1], CLEARANCE]).feed(first);
            is_down = true;
        }
        for i in 1..=points {
            path = path.feed(tip(turn as f64 + f64::from(i) / f64::from(points)));
        }
    }
    path.program(tool)
}

#[test]
fn spirals_are_checked_by_their_height() {
    let (part, tool) = (Part::cone(false, LOW, HIGH, 600, 20), ball(8.0));
    let turns = 14;
    let whole = spiral(&tool, turns, &[]);
    let heights = || whole.moves.iter().map(|step| step.end.tip[2]).filter(|z| *z < CLEARANCE);
    let heights = [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
    let expected = expected(&part, Contact::Touch, heights, ordered(Arc::new(Height), true));
    let report = |skipped: &[usize]| judged(&part, &tool, &expected, &spiral(&tool, turns, skipped));

    let complete = report(&[]);
    assert!(complete.ok && complete.findings.is_empty(), "{:?}", complete.groups);
    let one_missing = report(&[6]);
    assert!(kinds(&one_missing).contains(&FindingKind::MissingPass), "{:?}", one_missing.groups);
    let three_missing = report(&[6, 7, 8]);
    assert!(kinds(&three_missing).contains(&FindingKind::MissingLevel), "{:?}", three_missing.groups);
    let ends_early = report(&[11, 12, 13]);
    assert!(kinds(&ends_early).contains(&FindingKind::MissingLevel), "{:?}", ends_early.groups);
}

#[test]
fn what_only_stays_clear_need_not_touch_and_must_not_gouge() {
    let (part, tool) = (Part::cone(false, LOW, HIGH, 600, 20), ball(8.0));
    let levels = |off: f64| {
        let levels =
            Levels { tool: &tool, sheet: None, inner: false, low: LOW, high: HIGH, levels: 6, points: 300, off };
        levels.path().program(&tool)
    };
    let reason = "for roughing leaves stock";
    let of = |contact: Contact| expected(&part, contact, [-100.0, 100.0], Passes::Unordered { reason });
    let (touch, clear) = (of(Contact::Touch), of(Contact::Clear));
    let note = [FindingKind::NotChecked];

    let above = levels(1.0);
    assert_eq!(kinds(&judged(&part, &tool, &clear, &above)), note);
    assert!(judged(&part, &tool, &clear, &above).ok);
    let report = judged(&part, &tool, &touch, &above);
    assert!(kinds(&report).contains(&FindingKind::Excess) && !report.ok, "{:?}", report.groups);

    let mut gouging = levels(0.0015);
    assert_eq!(kinds(&judged(&part, &tool, &touch, &gouging)), note);
    gouging.moves[777].end.tip[2] -= 0.05;
    for expected in [&touch, &clear] {
        let report = judged(&part, &tool, expected, &gouging);
        assert_eq!(kinds(&report), [FindingKind::Gouge, FindingKind::NotChecked]);
        assert!((report.gouge_max - (0.05 * FRAC_1_SQRT_2 - 0.0015)).abs() < 0.001, "{}", report.gouge_max);
    }
}

#[test]
fn passes_that_are_not_checked_are_reported_with_the_reason() {
    let (part, tool) = (dome(), ball(2.0 * BALL));
    let reason = "for their order depends on the stock";
    let expected = expected(&part, Contact::Touch, [-100.0, 100.0], Passes::Unordered { reason });
    let report = judged(&part, &tool, &expected, &rings(&tool, |ring| f64::from(ring != 10)));
    let [note] = &report.findings[..] else { panic!("{:?}", report.findings) };
    assert!(report.ok && note.severity == Severity::Note, "{note:?}");
    assert_eq!(note.message, format!("operation \"walls\": its passes are not checked, {reason}"));
}

#[test]
fn passes_that_cover_faces_leave_no_more_than_the_scallop() {
    let (part, tool) = (dome(), ball(2.0 * BALL));
    // at the dome's foot the tool goes 1.34 mm from ring to ring, 1.18 mm over the face: 1.18^2 / 8 (1 / 4 + 1 / 30) = 0.049
    let report = |scallop: f64, skipped: usize| {
        let expected = expected(&part, Contact::Touch, [-100.0, 100.0], Passes::Covering { scallop });
        judged(&part, &tool, &expected, &rings(&tool, |ring| f64::from(ring != skipped)))
    };
    let complete = report(0.05, RINGS);
    assert!(complete.ok && complete.findings.is_empty(), "{:?}", complete.groups);
    let missing = report(0.05, 10);
    let finding = missing.findings.iter().find(|finding| finding.kind == FindingKind::Scallop).unwrap();
    let [x, y, _] = finding.position.unwrap();
    assert!(!missing.ok && finding.severity == Severity::Error, "{finding:?}");
    assert!((x.hypot(y) - (INNERMOST + 10.0 * STEP)).abs() < STEP, "{finding:?}");
    // rings that are complete, and too far apart at the foot only
    let apart = report(0.03, RINGS);
    assert!(apart.groups.iter().all(|group| group.kind == FindingKind::Scallop) && !apart.groups.is_empty());
    assert!(apart.findings.iter().flat_map(|finding| finding.position).all(|[x, y, _]| x.hypot(y) > 8.0));
}

#[test]
fn leads_and_links_need_not_touch_and_must_not_enter() {
    let (part, tool) = (dome(), ball(2.0 * BALL));
    let expected = expected(&part, Contact::Touch, [-100.0, 100.0], ordered(Arc::new(FromAxis), false));
    let rings = rings(&tool, |_| 1.0);
    // aslant down from clearance to beside the dome's top, this high over it
    let with = |height: f64, role: Option<Role>| {
        let mut program = rings.clone();
        program.moves.push(Move { role, ..Move::feed([1.0, 2.0, height], 600.0) });
        program.moves.push(Move::rapid([1.0, 2.0, CLEARANCE]));
        judged(&part, &tool, &expected, &program)
    };
    assert!(kinds(&with(3.0, None)).contains(&FindingKind::Excess));
    for role in [Role::Lead, Role::Ramp, Role::Link] {
        assert!(!kinds(&with(3.0, Some(role))).contains(&FindingKind::Excess), "{role:?}");
    }
    assert!(kinds(&with(3.0, Some(Role::Cut))).contains(&FindingKind::Excess));
    assert!(kinds(&with(-3.0, Some(Role::Link))).contains(&FindingKind::Gouge));
}

//! A sheet over a male die: the clamp frame goes down with the path, and is met where it stands then.

use std::sync::Arc;

use crate::common::{ball, limits, Levels, Part};
use styluscam_geometry::{Bvh, Mesh, Tool, Vector};
use styluscam_motion::{Program, Watch};
use styluscam_verify::{
    judge, Contact, Expectation, ExpectedOperation, FindingKind, Forming, FrameLevel, Height, Limits, Obstacle,
    ObstacleKind, OrderedPasses, Passes, Pitch, Region, Report, Severity, Subject, Support, TextFacts, WallAngleSource,
};

const LOW: f64 = 10.0;
const HIGH: f64 = 30.0;
const LEVELS: usize = 16;
/// The levels of [`Levels`] share four fifths of the hill, mm.
const STEP: f64 = 1.0;
const RADIUS: f64 = 2.0;
/// A step above the first of them, mm.
const TOP: f64 = -2.1;
/// Feed down to each level, mm/min; along it, 600.
const PLUNGE: f64 = 300.0;

fn hill() -> Part {
    Part::cone(false, LOW, HIGH, 180, 20)
}

/// Levels down the hill; those whose numbers are in `order`, one after the other.
fn levels(tool: &Tool, order: &[usize]) -> Program {
    let points = 72;
    let all = Levels { tool, sheet: None, inner: false, low: LOW, high: HIGH, levels: LEVELS, points, off: 0.0 }.path();
    let of_level = points + 3;
    let mut path = crate::common::Path::new();
    for level in order {
        path.moves.extend(all.moves[level * of_level..(level + 1) * of_level].iter().copied());
    }
    for (line, step) in (11..).zip(&mut path.moves) {
        step.line = line;
    }
    for plunge in (1..path.moves.len()).filter(|index| index % of_level == 1) {
        path.moves[plunge].feed = PLUNGE;
    }
    path.program(tool)
}

/// The first move on each level, and the tip's height there.
fn reached(program: &Program) -> Vec<FrameLevel> {
    let feeds = program.moves.windows(2).enumerate().filter(|(_, pair)| pair[0].feed <= 0.0 && pair[1].feed > 0.0);
    feeds.map(|(index, pair)| FrameLevel { before: index + 2, z: pair[1].end.tip[2] }).collect()
}

fn forming(support: Support) -> Limits {
    let forming = Forming {
        thickness: 1.0,
        top: TOP,
        support,
        min_thickness: 0.0,
        max_wall_angle: 1.5,
        sure_wall_angle: f64::INFINITY,
        source: WallAngleSource::Job,
    };
    Limits { forming: Some(forming), ..limits() }
}

fn judged(program: &Program, stated: &[FrameLevel], obstacles: &[Obstacle]) -> Report {
    let (part, tools) = (hill(), [ball(2.0 * RADIUS)]);
    let passes =
        OrderedPasses { scalar: Arc::new(Height), pitch: Pitch::Even(STEP), continuous: false, smallest_feature: 1.0 };
    let expectation = Expectation {
        contact: Contact::Touch,
        selected: vec![true; part.mesh.triangles().len()],
        region: Region::default(),
        to_leave: [0.0; 2],
        heights: [-30.0, 30.0],
        passes: Passes::Ordered(passes),
        forms: true,
        layers: None,
        tabs: None,
    };
    let id = "walls".to_owned();
    let expected = [ExpectedOperation {
        id,
        tool: 0,
        cut: 600.0,
        plunge: PLUNGE,
        leads: None,
        low_links: None,
        highest: None,
        slows_at_corners: false,
        keeps_pace: false,
        spindle: None,
        max_corner: None,
        flood: false,
        expectation,
    }];
    let text = TextFacts { frame_levels: stated.to_vec(), ended: true, ..TextFacts::default() };
    let subject = Subject { expected: &expected, text: Some(&text), obstacles, ..part.subject(&tools) };
    judge(program, &subject, &forming(Support::DieAndFrame), &Watch::default()).unwrap()
}

fn has(report: &Report, kind: FindingKind) -> bool {
    report.findings.iter().any(|finding| finding.kind == kind && finding.severity == Severity::Error)
}

fn kinds(report: &Report) -> Vec<FindingKind> {
    report.groups.iter().map(|group| group.kind).collect()
}

fn all() -> Vec<usize> {
    (0..LEVELS).collect()
}

#[test]
fn from_the_top_down_the_frame_is_at_every_loop() {
    let program = levels(&ball(2.0 * RADIUS), &all());
    for stated in [Vec::new(), reached(&program)] {
        let report = judged(&program, &stated, &[]);
        let found = kinds(&report);
        assert!(!found.contains(&FindingKind::Punch) && !found.contains(&FindingKind::ClampLevel), "{found:?}");
    }
}

#[test]
fn missing_levels_and_levels_from_the_bottom_up_are_found() {
    let tool = ball(2.0 * RADIUS);
    let missing = levels(&tool, &[0, 1, 2, 3, 4, 5, 8, 9, 10, 11, 12, 13, 14, 15]);
    let up: Vec<usize> = all().into_iter().rev().collect();
    let up = levels(&tool, &up);
    for stated in [false, true] {
        let stated = |program: &Program| if stated { reached(program) } else { Vec::new() };
        assert!(has(&judged(&missing, &stated(&missing), &[]), FindingKind::Punch));
        let report = judged(&up, &stated(&up), &[]);
        assert!(has(&report, FindingKind::Punch), "{:?}", kinds(&report));
    }
    // what carries the frame down does not lift it again
    assert!(has(&judged(&up, &[], &[]), FindingKind::ClampLevel));
}

#[test]
fn a_frame_that_stands_lower_or_stays_behind_is_found() {
    let program = levels(&ball(2.0 * RADIUS), &all());
    let moved = |by: f64| reached(&program).into_iter().map(|level| FrameLevel { z: level.z + by, ..level }).collect();
    let lower: Vec<FrameLevel> = moved(-0.5 * STEP);
    let report = judged(&program, &lower, &[]);
    let finding = report.findings.iter().find(|finding| finding.kind == FindingKind::ClampLevel).unwrap();
    assert!((finding.limit.unwrap() - finding.value.unwrap() - 0.5 * STEP).abs() < 1e-9, "{finding:?}");
    let higher: Vec<FrameLevel> = moved(1.5 * STEP);
    assert!(has(&judged(&program, &higher, &[]), FindingKind::ClampLevel));
    let behind: Vec<FrameLevel> = reached(&program).into_iter().take(9).collect();
    assert!(has(&judged(&program, &behind, &[]), FindingKind::ClampLevel));
    // one remark late is no more than a step
    let late: Vec<FrameLevel> = moved(STEP);
    assert!(!has(&judged(&program, &late, &[]), FindingKind::ClampLevel));
}

/// A frame 3 mm high with a square opening, on the flat sheet.
fn frame(half: f64) -> [Obstacle; 1] {
    let ring = |half: f64, z: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vector::new(x * half, y * half, z))
    };
    let vertices = [ring(half, TOP), ring(half, TOP + 3.0), ring(200.0, TOP + 3.0)].concat();
    let sides = |outer: i64| {
        (0..4).flat_map(move |i| {
            let (a, b) = (outer + i, outer + (i + 1) % 4);
            [[a, a + 4, b + 4], [a, b + 4, b]]
        })
    };
    let triangles: Vec<[i64; 3]> = sides(0).chain(sides(4)).collect();
    let mesh = Mesh::new(vertices, &triangles, &[]).unwrap();
    [Obstacle { kind: ObstacleKind::Clamp, bvh: Bvh::new(&mesh), mesh, sheet: None, margin: 1.0, follows: true }]
}

#[test]
fn the_frame_is_met_where_it_stands_then() {
    let program = levels(&ball(2.0 * RADIUS), &all());
    let out = program.moves.iter().map(|step| step.end.tip[0].abs()).fold(0.0, f64::max);
    let met = |report: &Report| -> Vec<(f64, f64)> {
        let found = report.findings.iter().filter(|finding| finding.kind == FindingKind::ClampCollision);
        found.map(|finding| (finding.value_mm.unwrap(), finding.position.unwrap()[2])).collect()
    };
    for stated in [Vec::new(), reached(&program)] {
        // at the lowest and widest loop 0.4 mm are left of 1: the ball is widest 2 mm over the sheet
        let near = met(&judged(&program, &stated, &frame(out + RADIUS + 0.4)));
        assert!(near.iter().any(|(left, z)| *z < -15.0 && (left - 0.4).abs() < 1e-3), "{near:?}");
        assert!(met(&judged(&program, &stated, &frame(out + RADIUS + 1.1))).is_empty());
    }
}

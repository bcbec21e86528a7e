//! Tabs of a loop round a box: each that is missing, too thin, too low or cut afterwards is found.

use crate::common::{expected, limits, tool, Part, Path, CLEARANCE};
use styluscam_geometry::{kinds, ProfileDocument, Tool, Vector};
use styluscam_motion::Watch;
use styluscam_verify::{judge, Contact, Expectation, ExpectedOperation, FindingKind, Passes, Subject, TabShape};

const RADIUS: f64 = 2.0;
const FLOOR: f64 = -6.0;
const SHAPE: TabShape = TabShape { count: Some(4), spacing: None, width: 3.0, height: 1.5, slope: 1.0 };
/// Half of the stretch over a tab, mm.
const HALF: f64 = 0.5 * SHAPE.width + RADIUS;
const TOP: f64 = FLOOR + SHAPE.height;

/// 40 x 30 x 6 mm, its top at Z0.
fn block() -> Part {
    let at = |i: usize, z: f64| Vector::new([0.0, 40.0, 40.0, 0.0][i], [0.0, 0.0, 30.0, 30.0][i], z);
    let vertices = (0..8).map(|i| at(i % 4, if i < 4 { FLOOR } else { 0.0 })).collect();
    let mut triangles = vec![[3, 2, 1], [3, 1, 0], [4, 5, 6], [4, 6, 7]];
    for i in 0..4 {
        let next = (i + 1) % 4;
        triangles.extend([[i, next, next + 4], [i, next + 4, i + 4]]);
    }
    Part::new(vertices, &triangles)
}

/// A tab in the middle of a side: how far the tool keeps from it on either side, and how high it goes.
#[derive(Clone, Copy)]
struct Made {
    half: [f64; 2],
    top: f64,
}

const SOUND: Made = Made { half: [HALF; 2], top: TOP };

/// Once round the block at its foot, with a tab on each side that has one.
fn round(tabs: [Option<Made>; 4]) -> Path {
    let corners = [[-2.0, -2.0], [42.0, -2.0], [42.0, 32.0], [-2.0, 32.0]];
    let [x, y] = corners[0];
    let mut path = Path::new().rapid([x, y, CLEARANCE]).feed([x, y, FLOOR]);
    for (side, tab) in tabs.iter().enumerate() {
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at = |along: f64, z: f64| {
            let [x, y] = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * along / length);
            [x, y, z]
        };
        if let Some(Made { half: [before, after], top }) = *tab {
            let (middle, run) = (0.5 * length, (top - FLOOR) / SHAPE.slope);
            path = path
                .feed(at(middle - before - run, FLOOR))
                .feed(at(middle - before, top))
                .feed(at(middle + after, top))
                .feed(at(middle + after + run, FLOOR));
        }
        path = path.feed(at(length, FLOOR));
    }
    path
}

/// Whether its tabs are found to be wrong.
fn is_found(path: Path) -> bool {
    let (part, tools): (Part, [Tool; 1]) =
        (block(), [tool(ProfileDocument::from(kinds::Flat { diameter: 2.0 * RADIUS, tip_flat: 0.0 }))]);
    let [plain] = expected(&part, Contact::Clear, [f64::NEG_INFINITY, 0.0], Passes::Unordered { reason: "one loop" });
    let expectation = Expectation { tabs: Some(SHAPE), ..plain.expectation };
    let operation = [ExpectedOperation { expectation, ..plain }];
    let subject = Subject { expected: &operation, ..part.subject(&tools) };
    let report = judge(&path.program(&tools[0]), &subject, &limits(), &Watch::default()).unwrap();
    report.findings.iter().any(|finding| finding.kind == FindingKind::Tabs)
}

/// The tab of one side is another, or none.
fn with(side: usize, tab: Option<Made>) -> Path {
    let mut tabs = [Some(SOUND); 4];
    tabs[side] = tab;
    round(tabs)
}

#[test]
fn sound_tabs_pass() {
    assert!(!is_found(round([Some(SOUND); 4])));
}

#[test]
fn each_tab_that_is_missing_is_found() {
    for side in 0..4 {
        assert!(is_found(with(side, None)), "side {side}");
    }
}

#[test]
fn a_tab_that_is_too_thin_is_found_from_either_side() {
    for side in 0..4 {
        for half in [[HALF - 0.02, HALF], [HALF, HALF - 0.02], [HALF - 1.0; 2]] {
            assert!(is_found(with(side, Some(Made { half, ..SOUND }))), "side {side} {half:?}");
        }
    }
}

#[test]
fn a_tab_of_another_height_is_found() {
    for off in [-0.02, 0.02, -1.0] {
        assert!(is_found(with(1, Some(Made { top: TOP + off, ..SOUND }))), "{off}");
    }
}

#[test]
fn a_tab_that_is_cut_afterwards_is_found() {
    let cut = |z: f64| {
        round([Some(SOUND); 4])
            .rapid([-2.0, -2.0, CLEARANCE])
            .rapid([20.0, -2.0, CLEARANCE])
            .feed([20.0, -2.0, z])
            .feed([21.0, -2.0, z])
    };
    assert!(is_found(cut(TOP - 0.1)));
    assert!(!is_found(cut(TOP + 0.1)));
}

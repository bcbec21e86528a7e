//! Rows: long where nothing is, and never into what is narrower than the distance of their first samples.

use crate::common::plates::{plate, Boss};
use proptest::prelude::*;
use styluscam_geometry::{kinds, Mesh, ProfileDocument, Tool, ToolDocument, Vector};
use styluscam_motion::Watch;
use styluscam_toolpath::forming::{zig_zag, Rows};
use styluscam_toolpath::offset::{Envelope, Index};
use styluscam_toolpath::{Pass, Surface};

const DEVIATION: f64 = 0.0012;
/// Steps are climbed within less travel than this, mm.
const STEP: f64 = 2e-4;

fn tool(profile: ProfileDocument) -> Tool {
    Tool::new(ToolDocument::of(profile)).unwrap()
}

fn rows(envelope: &Envelope<'_>, angle: f64, stepover: f64) -> Vec<Pass> {
    let rows = Rows { angle, stepover, closer: None, spacing: 0.7, narrow: 0.14 };
    zig_zag(&Surface::whole(envelope), &rows, DEVIATION, &Watch::default()).unwrap()
}

/// That no chord lies under the envelope by more than the deviation along the normal, but where it climbs a step, nor far
/// over it.
fn assert_clear(passes: &[Pass], envelope: &Envelope<'_>, spacing: f64) {
    for pair in passes.iter().flat_map(|pass| pass.points.windows(2)) {
        let (from, span) = (pair[0].tip, pair[1].tip - pair[0].tip);
        let length = span.xy().norm();
        if length < STEP {
            continue;
        }
        let along = span.xy() / length;
        for i in 0..=(length / spacing) as usize {
            let at = from + span * (i as f64 * spacing / length).min(1.0);
            let beside = |s: f64| envelope.contact(at.x + s * along.x, at.y + s * along.y);
            let exact = beside(0.0).unwrap();
            let least = [-STEP, STEP].iter().filter_map(|s| beside(*s)).map(|c| c.tip).fold(exact.tip, f64::min);
            assert!(at.z >= least - DEVIATION / exact.normal.z.max(0.25), "{at:?} {exact:?}");
        }
    }
}

#[test]
fn a_row_over_a_plane_of_ten_metres_has_two_points_a_stretch() {
    let boss = Boss { centre: [5000.0, 500.0], radius: 300.0, sides: 64, height: 20.0 };
    let mesh = plate([10_000.0, 1000.0], &[boss]);
    let (index, tool) = (Index::new(&mesh), tool(ProfileDocument::from(kinds::Flat { diameter: 20.0, tip_flat: 0.0 })));
    let envelope = Envelope::new(&mesh, &index, &tool, None, 0.001);
    let passes = rows(&envelope, 0.0, 40.0);
    let points: Vec<usize> = passes.iter().map(|pass| pass.points.len()).collect();
    assert_eq!(points.len(), 26);
    // the rim, and on some rows up and down a boss of straight sides
    assert!(points.iter().all(|count| *count < 100), "{points:?}");
    assert!(points.iter().filter(|count| **count < 12).count() >= 10, "{points:?}");
}

#[test]
fn rows_aslant_over_facets_are_fitted_closely() {
    let bosses: Vec<Boss> = (0..4)
        .map(|i| Boss { centre: [12.0 + 20.0 * f64::from(i), 14.0], radius: 6.0, sides: 7, height: 3.0 })
        .collect();
    let mesh = plate([90.0, 30.0], &bosses);
    let index = Index::new(&mesh);
    for profile in [
        ProfileDocument::from(kinds::Ball { diameter: 6.0, radius: None, tip_flat: 0.0 }),
        ProfileDocument::from(kinds::Clothoid { diameter: Some(6.0), scale: None, end_slope_deg: None, tip_flat: 0.0 }),
        ProfileDocument::from(kinds::BullNose { diameter: 6.0, corner_radius: 1.0, tip_flat: 0.0 }),
    ] {
        let envelope = Envelope::new(&mesh, &index, &tool(profile), None, 0.002);
        assert_clear(&rows(&envelope, 0.4, 3.0), &envelope, 0.02);
    }
}

/// A floor and needles on it: position, and height.
fn needles(positions: &[([f64; 2], f64)]) -> Mesh {
    let floor = [[-20.0, -20.0, 0.0], [20.0, -20.0, 0.0], [20.0, 20.0, 0.0], [-20.0, 20.0, 0.0]];
    let mut vertices: Vec<Vector> = floor.into_iter().map(Vector::from).collect();
    let mut triangles = vec![[0, 1, 2], [0, 2, 3]];
    for ([x, y], height) in positions {
        let first = vertices.len() as i64;
        vertices.extend(
            [[-1e-4, 0.0, 0.0], [1e-4, 0.0, 0.0], [0.0, 0.0, *height]]
                .map(|p| Vector::from(p) + Vector::new(*x, *y, 0.0)),
        );
        triangles.push([first, first + 1, first + 2]);
    }
    Mesh::new(vertices, &triangles, &[]).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn no_row_of_a_flat_tool_enters_what_it_only_meets_with_its_rim(
        // a needle this far inside the rim is met within a travel of 0.03 to 0.5 mm
        positions in prop::collection::vec((-15.0..15.0_f64, 5e-5..1e-2_f64, any::<bool>(), 0.01..2.0_f64), 1..8),
        corner in prop_oneof![Just(None), (0.1..2.5_f64).prop_map(Some)],
    ) {
        let side = |left: bool| if left { 1.0 } else { -1.0 };
        let positions: Vec<([f64; 2], f64)> =
            positions.iter().map(|(x, inside, left, height)| ([*x, side(*left) * (3.0 - inside)], *height)).collect();
        let mesh = needles(&positions);
        let profile = match corner {
            Some(corner_radius) => ProfileDocument::from(kinds::BullNose { diameter: 6.0, corner_radius, tip_flat: 0.0 }),
            None => ProfileDocument::from(kinds::Flat { diameter: 6.0, tip_flat: 0.0 }),
        };
        let (index, tool) = (Index::new(&mesh), tool(profile));
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
        // one row, over the middle
        assert_clear(&rows(&envelope, 0.0, 100.0), &envelope, 0.003);
    }
}

/// Strips along X, 20 mm long, between positions across (mm) at heights (mm), with the walls between them.
fn strips(edges: &[[f64; 2]]) -> Mesh {
    let rim = edges.iter().flat_map(|[y, z]| [Vector::new(0.0, *y, *z), Vector::new(20.0, *y, *z)]);
    let quads = (0..edges.len() as i64 - 1).map(|i| 2 * i);
    let triangles: Vec<[i64; 3]> = quads.flat_map(|a| [[a, a + 1, a + 3], [a, a + 3, a + 2]]).collect();
    Mesh::new(rim.collect(), &triangles, &[]).unwrap()
}

#[test]
fn a_groove_between_two_rows_gets_one_of_its_own() {
    let tool = tool(ProfileDocument::from(kinds::Flat { diameter: 2.0, tip_flat: 0.0 }));
    for tenths in (0..50).step_by(5) {
        // a floor, a land that is not selected, a groove 3 mm wide, and land again
        let at = 13.0 + 0.1 * f64::from(tenths);
        let mesh = strips(&[
            [0.0, 0.0],
            [10.0, 0.0],
            [10.0, 3.0],
            [at, 3.0],
            [at, 0.0],
            [at + 3.0, 0.0],
            [at + 3.0, 3.0],
            [40.0, 3.0],
        ]);
        let index = Index::new(&mesh);
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.001);
        let rows = Rows { angle: 0.0, stepover: 5.0, closer: None, spacing: 0.7, narrow: 0.14 };
        let across = |pass: &Pass| pass.points[0].tip.y;
        // the floors alone, and all: then the land's rows lie beside the groove
        for chosen in [0b001_0001, 0b111_1111] {
            let selected: Vec<bool> = (0..14).map(|t| chosen >> (t / 2) & 1 == 1).collect();
            let surface = Surface::new(&envelope, &selected);
            let passes = zig_zag(&surface, &rows, DEVIATION, &Watch::default()).unwrap();
            let low = |pass: &&Pass| pass.points.iter().all(|point| point.tip.z < 0.1);
            let in_groove = passes.iter().filter(low).filter(|pass| (at..=at + 3.0).contains(&across(pass))).count();
            assert_eq!(in_groove, 1, "a groove at Y{at}");
            let ascends = |pair: &[Pass]| pair[0].group <= pair[1].group && across(&pair[0]) <= across(&pair[1]);
            assert!(passes.windows(2).all(ascends));
        }
    }
}

//! The envelope against all triangles, one by one, and against closed forms.

#[path = "../../../tests/it/common/mod.rs"]
#[allow(dead_code)] // some of it serves the tests from outside the crate alone
pub(in crate::offset) mod common;
pub(in crate::offset) mod surfaces;

use common::dice::Dice;
use common::tools::{Kind, KINDS};
use proptest::prelude::*;
use styluscam_geometry::{kinds, ModelFace, ProfileDocument, SheetLaw, ToolDocument};
use surfaces::{Surface, MIDDLE, SURFACES};

use super::super::search::Eight;
use super::*;

fn tool(clothoid: bool, diameter: f64, tip_flat: f64) -> Tool {
    of(if clothoid {
        ProfileDocument::from(kinds::Clothoid { diameter: Some(diameter), scale: None, end_slope_deg: None, tip_flat })
    } else {
        ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat })
    })
}

fn of(profile: ProfileDocument) -> Tool {
    Tool::new(ToolDocument::of(profile)).unwrap()
}

fn single(corners: [Vector; 3]) -> Mesh {
    Mesh::new(corners.to_vec(), &[[0, 1, 2]], &[]).unwrap()
}

/// A mesh with hills, valleys, walls and flats.
fn terrain(heights: &[f64], columns: usize) -> Mesh {
    let rows = heights.len() / columns;
    let vertices: Vec<Vector> =
        heights.iter().enumerate().map(|(i, z)| Vector::new((i % columns) as f64, (i / columns) as f64, *z)).collect();
    let mut triangles = Vec::new();
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let i = (row * columns + column) as i64;
            let n = columns as i64;
            triangles.extend([[i, i + 1, i + n], [i + 1, i + n + 1, i + n]]);
        }
    }
    Mesh::new(vertices, &triangles, &[]).unwrap()
}

/// The highest of the tips that the triangles allow, each asked alone: nothing is pruned.
fn highest_alone(ground: &Ground, position: [f64; 2]) -> f64 {
    let tip = |triangle| {
        let mut alone = Best::NOTHING;
        ground.contacts.touch_whole(triangle, position, &mut alone);
        alone.tip
    };
    let triangles = ground.index.triangles().corners.len() as u32;
    (0..triangles).map(tip).fold(f64::NEG_INFINITY, f64::max)
}

/// A raster over a surface and around it, turned; or positions at random.
fn positions(dice: &mut Dice, side: usize) -> Vec<[f64; 2]> {
    let (sin, cos) = libm::sincos(dice.within(0.0, 6.3));
    let (pitch, reach, is_raster) = (16.0 / side as f64, 8.0, dice.chance(0.7));
    let position = |i: usize| {
        let [x, y] = if is_raster {
            [pitch * (i % side) as f64 - reach, pitch * (i / side) as f64 - reach]
        } else {
            [dice.within(-reach, reach), dice.within(-reach, reach)]
        };
        [MIDDLE + cos * x - sin * y, MIDDLE + sin * x + cos * y]
    };
    (0..side * side).map(position).collect()
}

/// Asks `side` squared positions of a surface and compares every `each`th with all triangles.
fn compare(surface: Surface, kind: &Kind, seed: u64, side: usize, each: usize) {
    let mut dice = Dice::new(seed);
    let (mesh, tool) = (surface.mesh(&mut dice), kind.tool(&mut dice));
    let index = Index::new(&mesh);
    let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
    let positions = positions(&mut dice, side);
    let tips = envelope.tips(&positions, &Watch::default()).unwrap();
    let ground = envelope.ground();
    for (position, tip) in positions.iter().zip(tips).step_by(each) {
        let truth = highest_alone(&ground, *position);
        let is_same = if truth.is_finite() { (tip - truth).abs() < 1e-11 } else { tip.is_nan() };
        assert!(is_same, "{surface:?} {:?} seed {seed} at {position:?}: {tip} {truth}", tool.document().profile);
    }
}

#[test]
fn tiles_find_what_all_triangles_say() {
    for seed in 0..60 {
        compare(SURFACES[seed % SURFACES.len()], &KINDS[seed % KINDS.len()], seed as u64, 40, 7);
    }
}

/// A low plate at the rim of a slender tool, in a tile whose other corners a high plate's contact does not reach.
#[test]
fn a_contact_near_the_rim_is_not_lost_to_a_higher_one() {
    let plate = |[x, y]: [f64; 2], [u, v]: [f64; 2], z: f64| {
        let [p, q, r, s] = [[x, y], [u, y], [u, v], [x, v]].map(|[x, y]| Vector::new(x, y, z));
        [p, q, r, p, r, s]
    };
    let corners = [plate([0.86, 1.65], [1.16, 1.98], 30.0), plate([1.07, 1.62], [2.56, 3.26], 1.0)].concat();
    let triangles: Vec<[i64; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = Mesh::new(corners, &triangles, &[]).unwrap();
    let tool = of(ProfileDocument::from(kinds::V { tip_diameter: 0.0, angle_deg: 7.0, diameter: 1.0, tip_flat: 0.0 }));
    let index = Index::new(&mesh);
    let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
    let along = |i: usize| -0.6 + 0.22 * i as f64;
    let positions: Vec<[f64; 2]> = (0..24 * 24).map(|i| [along(i % 24), along(i / 24)]).collect();
    let tips = envelope.tips(&positions, &Watch::default()).unwrap();
    let (tip, by_hand) = (tips[8 * 24 + 9], 1.0 - 0.46 / libm::tan(3.5_f64.to_radians()));
    assert!((tip - by_hand).abs() < 1e-9, "{tip} {by_hand}");
}

/// Slender tools over plates with gaps, as wide as the tools: beside a contact that a tile's corner does not reach, nothing
/// is known.
#[test]
fn tiles_lose_nothing_beside_cliffs() {
    for seed in 0..1500 {
        let mut dice = Dice::new(seed);
        let mesh = Surface::Plates.mesh(&mut dice);
        let angle_deg = dice.within(5.0, 60.0);
        let tool = of(match dice.below(4) {
            0 => ProfileDocument::from(kinds::V { tip_diameter: 0.0, angle_deg, diameter: 1.0, tip_flat: 0.0 }),
            1 => ProfileDocument::from(kinds::TaperedBall {
                tip_radius: 0.1,
                half_angle_deg: angle_deg,
                diameter: 1.0,
                tip_flat: 0.0,
            }),
            2 => ProfileDocument::from(kinds::Flat { diameter: 1.0, tip_flat: 0.0 }),
            _ => ProfileDocument::from(kinds::Ball { diameter: 1.0, radius: None, tip_flat: 0.0 }),
        });
        let index = Index::new(&mesh);
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
        let pitch = dice.within(0.1, 0.4);
        let columns = (7.0 / pitch) as usize;
        let from = [(); 2].map(|()| MIDDLE - 3.5 + dice.within(0.0, pitch));
        let position = |i: usize| [from[0] + pitch * (i % columns) as f64, from[1] + pitch * (i / columns) as f64];
        let positions: Vec<[f64; 2]> = (0..columns * columns).map(position).collect();
        let tips = envelope.tips(&positions, &Watch::default()).unwrap();
        let ground = envelope.ground();
        for (position, tip) in positions.iter().zip(tips) {
            let truth = highest_alone(&ground, *position);
            let is_same = if truth.is_finite() { (tip - truth).abs() < 1e-11 } else { tip.is_nan() };
            assert!(is_same, "{:?} seed {seed} at {position:?}: {tip} {truth}", tool.document().profile);
        }
    }
}

/// Planes that are level for a flat end, or as steep as a cone: over triangles, edges, and beside corners.
#[test]
fn no_position_falls_between_triangles_of_a_plane() {
    for seed in 0..120 {
        let (mesh, tool) = surfaces::plane_and_tool(&mut Dice::new(seed));
        let index = Index::new(&mesh);
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
        let positions = mesh.triangles().iter().flat_map(|corners| {
            let [a, b, c] = corners.map(|corner| mesh.vertices()[corner as usize]);
            [(a + b + c) / 3.0, 0.5 * (a + b), 0.5 * (b + c), 0.999 * a + 0.001 * b].map(|p| [p.x, p.y])
        });
        let positions: Vec<[f64; 2]> = positions.collect();
        let tips = envelope.tips(&positions, &Watch::default()).unwrap();
        for (position, tip) in positions.iter().zip(tips) {
            let truth = highest_alone(&envelope.ground(), *position);
            let is_same = (tip - truth).abs() < 1e-11;
            assert!(is_same, "{:?} seed {seed} at {position:?}: {tip} {truth}", tool.document().profile);
        }
    }
}

#[test]
fn what_eight_triangles_do_not_exceed_is_hardly_higher_than_their_tips() {
    let mut gaps = Vec::new();
    for seed in 0..60 {
        let mut dice = Dice::new(seed);
        let (surface, kind) = (SURFACES[seed as usize % SURFACES.len()], &KINDS[seed as usize % KINDS.len()]);
        let (mesh, tool) = (surface.mesh(&mut dice), kind.tool(&mut dice));
        let index = Index::new(&mesh);
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
        let ground = envelope.ground();
        let count = index.triangles().corners.len() as f64;
        for position in positions(&mut dice, 12) {
            let triangles = [(); 8].map(|()| dice.within(0.0, count) as u32);
            let mut eight = Eight::default();
            for (lane, triangle) in triangles.iter().enumerate() {
                eight.put(lane, &ground.contacts.seen(*triangle, position, 0.5));
            }
            for (triangle, most) in triangles.into_iter().zip(eight.most(ground.lines).to_array()) {
                let mut alone = Best::NOTHING;
                ground.contacts.touch_whole(triangle, position, &mut alone);
                let gap = f64::from(most) + 0.5 - alone.tip;
                assert!(
                    gap >= -f64::from(ground.margin()),
                    "{surface:?} {:?} seed {seed} at {position:?}: {gap}",
                    tool.document().profile
                );
                if alone.is_something() {
                    gaps.push(gap);
                }
            }
        }
    }
    gaps.sort_by(f64::total_cmp);
    assert!(gaps[gaps.len() / 2] < 1e-2, "{}", gaps[gaps.len() / 2]);
}

#[test]
#[ignore = "takes minutes: make test-long"]
fn tiles_find_what_all_triangles_say_at_ten_thousand_places_of_every_surface_and_kind() {
    (0..SURFACES.len() * KINDS.len()).into_par_iter().for_each(|i| {
        compare(SURFACES[i % SURFACES.len()], &KINDS[i / SURFACES.len()], 1000 + i as u64, 100, 1);
    });
}

proptest! {
    #[test]
    fn a_hint_changes_nothing(heights in prop::collection::vec(0.0..4.0_f64, 42), hint in 0..60_u32, x in 0.0..6.0_f64) {
        let mesh = terrain(&heights, 7);
        let bvh = Index::new(&mesh);
        let tool = tool(true, 3.0, 0.2);
        let envelope = Envelope::new(&mesh, &bvh, &tool, None, 0.0);
        let (a, b) = (envelope.contact(x, 2.5).unwrap(), envelope.contact_near(x, 2.5, &mut Some(hint)).unwrap());
        prop_assert!((a.tip - b.tip).abs() < 1e-11);
    }
}

#[test]
fn a_plane_is_touched_where_slopes_match() {
    let mesh = single([Vector::new(-50.0, -50.0, -50.0), Vector::new(50.0, -50.0, 50.0), Vector::new(0.0, 80.0, 0.0)]);
    let bvh = Index::new(&mesh);
    let normal = Vector::new(-1.0, 0.0, 1.0).normalize();
    for law in [SheetLaw::Constant, SheetLaw::Sine] {
        let sheet = Sheet { thickness: 1.5, law, model_face: ModelFace::Back };
        let tool = tool(true, 10.0, 0.5);
        let (tip, _) = super::super::slope_matched_offset(&tool, Some(&sheet), Vector::zeros(), normal);
        let contact = Envelope::new(&mesh, &bvh, &tool, Some(&sheet), 0.0).contact(tip.x, tip.y).unwrap();
        assert!((contact.tip - tip.z).abs() < 1e-12, "{law:?}: {} {}", contact.tip, tip.z);
        assert!((contact.normal - normal).norm() < 1e-12);
    }
}

#[test]
fn beside_the_part_there_is_nothing() {
    let mesh = terrain(&[0.0; 9], 3);
    let bvh = Index::new(&mesh);
    let envelope = Envelope::new(&mesh, &bvh, &tool(false, 2.0, 0.0), None, 0.0);
    assert_eq!(envelope.contact(3.5, 1.0), None);
    assert!(envelope.contact(2.5, 1.0).is_some());
}

//! Bounds over boxes of the plan against what is found at positions in them.

use proptest::prelude::*;
use styluscam_geometry::{kinds, Mesh, ProfileDocument, Tool, ToolDocument, Vector};
use styluscam_motion::Watch;
use styluscam_toolpath::offset::{Envelope, Index, Verdict};
use styluscam_toolpath::Lattice;

const DIAMETER: f64 = 6.0;

/// Tools of every kind of profile: the registry's own examples among them.
fn any_tool() -> impl Strategy<Value = Tool> {
    let registered = prop::sample::select(ProfileDocument::starters())
        .prop_map(|text| Tool::new(ToolDocument::of(serde_json::from_str(text).unwrap())).unwrap());
    prop_oneof![3 => varied_tool(), 1 => registered]
}

fn varied_tool() -> impl Strategy<Value = Tool> {
    (0..5_u8, 0.1..0.9_f64).prop_map(|(kind, a)| {
        let (diameter, tip_flat) = (DIAMETER, 0.0);
        let profile = match kind {
            0 => ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat }),
            1 => ProfileDocument::from(kinds::Clothoid {
                diameter: Some(diameter),
                scale: None,
                end_slope_deg: None,
                tip_flat,
            }),
            2 => ProfileDocument::from(kinds::BullNose { diameter, corner_radius: 3.0 * a, tip_flat }),
            3 => ProfileDocument::from(kinds::Cone { tip_radius: 0.0, half_angle_deg: 80.0 * a, diameter, tip_flat }),
            _ => ProfileDocument::from(kinds::Flat { diameter, tip_flat }),
        };
        Tool::new(ToolDocument::of(profile)).unwrap()
    })
}

/// Single triangles of all sizes, some upright or level, in a square of 12 mm.
fn any_mesh() -> impl Strategy<Value = Mesh> {
    let corner = || [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64].prop_map(Vector::from);
    let triangle =
        ([corner(), corner(), corner()], corner(), -2.0..1.0_f64, 0..4_u8).prop_map(|(corners, at, size, kind)| {
            let mut corners = corners.map(|p| at.component_mul(&Vector::new(6.0, 6.0, 2.0)) + p * 10_f64.powf(size));
            match kind {
                0 => corners.iter_mut().for_each(|p| p.z = at.z),
                1 => corners[1] = Vector::new(corners[0].x, corners[0].y, corners[1].z),
                _ => {}
            }
            corners
        });
    prop::collection::vec(triangle, 1..12).prop_filter_map("no area", |triangles| {
        let numbers: Vec<[i64; 3]> = (0..triangles.len() as i64).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Mesh::new(triangles.concat(), &numbers, &[]).ok()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 300 } else { 20_000 }))]
    #[test]
    fn tips_lie_within_what_is_said_of_the_box(
        mesh in any_mesh(), tool in any_tool(), x in -8.0..8.0_f64, y in -8.0..8.0_f64, size in -2.0..0.5_f64, share in -0.2..1.2_f64,
        over in -1.0..1.0_f64,
        positions in prop::collection::vec([0.0..=1.0_f64, 0.0..=1.0_f64], 12),
    ) {
        let index = Index::new(&mesh);
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
        let side = 10_f64.powf(size);
        let lattice = Lattice { origin: [x, y], cell: side, columns: 1, rows: 1 };
        let (cells, watch) = (lattice.corners(&lattice.cells()), Watch::default());
        let at = envelope.contact(x + share * side, y + share * side);
        let low = at.map_or(f64::NEG_INFINITY, |contact| envelope.least(&contact, &cells));
        let limit = at.map_or(-1.0, |contact| contact.tip + over);
        let high = envelope.ceilings(&lattice, |_| limit, &watch).unwrap()[0].max(limit);
        let verdict = envelope.verdict(&cells, limit);
        let ends = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        for [s, t] in positions.into_iter().chain(ends) {
            let tip = envelope.contact(x + s * side, y + t * side).map_or(f64::NEG_INFINITY, |contact| contact.tip);
            prop_assert!(tip >= low - 1e-9 && tip <= high + 1e-9, "{tip} at {s}, {t} in {low}..{high}");
            let agrees = match verdict {
                Verdict::Above => tip > limit - 1e-9,
                Verdict::Free => tip <= limit + 1e-9,
                Verdict::Open => true,
            };
            prop_assert!(agrees, "{tip} at {s}, {t} but {verdict:?} for {limit}");
        }
    }
}

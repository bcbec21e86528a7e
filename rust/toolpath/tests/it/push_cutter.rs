//! The push-cutter against another method: the least distance between tool and triangle, by nested golden sections.

use proptest::prelude::*;
use styluscam_geometry::{kinds, Cutter, Mesh, ProfileDocument, Tool, ToolDocument, Vector};
use styluscam_toolpath::offset::{Envelope, Index, Line};

/// What a contact may be off, as a distance, mm.
const EXACT: f64 = 1e-9;
const DIAMETER: f64 = 12.0;

/// Tools of every kind of profile: the registry's own examples among them.
fn any_tool() -> impl Strategy<Value = Tool> {
    let registered = prop::sample::select(ProfileDocument::starters())
        .prop_map(|text| Tool::new(ToolDocument::of(serde_json::from_str(text).unwrap())).unwrap());
    prop_oneof![3 => varied_tool(), 1 => registered]
}

/// Curves, kinks, cones and flats.
fn varied_tool() -> impl Strategy<Value = Tool> {
    let flat = prop_oneof![Just(0.0), 0.1..2.0_f64];
    (0..9_u8, 0.05..0.95_f64, 0.05..0.95_f64, flat).prop_map(|(kind, a, b, tip_flat)| {
        let (diameter, beyond) = (DIAMETER, 0.5 * DIAMETER - tip_flat);
        let half_angle_deg = 10.0 + 75.0 * a;
        let profile = match kind {
            0 => ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat }),
            1 => ProfileDocument::from(kinds::Ball { diameter, radius: Some(beyond / a), tip_flat }),
            2 => ProfileDocument::from(kinds::Clothoid {
                diameter: Some(diameter),
                scale: None,
                end_slope_deg: None,
                tip_flat,
            }),
            3 => ProfileDocument::from(kinds::Parabola { apex_radius: 12.0 * a, diameter, tip_flat }),
            4 => ProfileDocument::from(kinds::Ellipse { radial: 6.0, axial: 12.0 * b, diameter: None, tip_flat }),
            5 => ProfileDocument::from(kinds::BullNose { diameter, corner_radius: beyond * a, tip_flat }),
            6 => ProfileDocument::from(kinds::Cone { tip_radius: 0.0, half_angle_deg, diameter, tip_flat }),
            7 => {
                ProfileDocument::from(kinds::TaperedBall { tip_radius: beyond * b, half_angle_deg, diameter, tip_flat })
            }
            _ => ProfileDocument::from(kinds::Flat { diameter, tip_flat: 0.0 }),
        };
        Tool::new(ToolDocument::of(profile)).unwrap()
    })
}

/// Triangles of all sizes: any, slivers, floors, walls.
fn any_triangle() -> impl Strategy<Value = [Vector; 3]> {
    let point = || [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64].prop_map(Vector::from);
    let size = (-2.0..1.5_f64).prop_map(|e| 10_f64.powf(e));
    (point(), point(), point(), point(), size, 0..5_u8).prop_map(|(a, b, c, at, size, kind)| {
        let mut corners = [a, b, c].map(|p| at * 6.0 + p * size);
        match kind {
            0 => corners[2] = corners[0] + (corners[1] - corners[0]) * 0.37 + (corners[2] - corners[0]) * 1e-7,
            1 => corners.iter_mut().for_each(|p| p.z = at.z),
            2 => corners[1] = Vector::new(corners[0].x, corners[0].y, corners[1].z),
            _ => {}
        }
        corners
    })
}

fn mesh_of(corners: [Vector; 3]) -> Option<Mesh> {
    Mesh::new(corners.to_vec(), &[[0, 1, 2]], &[]).ok()
}

/// The least signed distance between the triangle and the body standing with its tip over a position.
fn clearance(cutter: &Cutter, corners: [Vector; 3], [x, y]: [f64; 2], z: f64) -> f64 {
    let [a, b, c] = corners;
    let distance = |p: Vector| cutter.distance((p.x - x).hypot(p.y - y), p.z - z).0;
    least(1.0, |s| least(1.0 - s, |t| distance(a + (b - a) * s + (c - a) * t)))
}

fn least(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (0.0, end);
    let (mut p, mut q) = (high - RATIO * (high - low), low + RATIO * (high - low));
    let (mut fp, mut fq) = (f(p), f(q));
    let mut best = f(0.0).min(f(end));
    for _ in 0..50 {
        best = best.min(fp).min(fq);
        if fp < fq {
            (high, q, fq) = (q, p, fp);
            p = high - RATIO * (high - low);
            fp = f(p);
        } else {
            (low, p, fp) = (p, q, fq);
            q = low + RATIO * (high - low);
            fq = f(q);
        }
    }
    best
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 40 } else { 600 }))]
    #[test]
    fn a_triangle_keeps_the_tool_off_from_first_to_last_touch(
        tool in any_tool(), corners in any_triangle(), turn in 0.0..6.3_f64, aside in -8.0..8.0_f64, z in -9.0..3.0_f64,
    ) {
        let Some(mesh) = mesh_of(corners) else { return Ok(()) };
        let index = Index::new(&mesh);
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
        let (sin, cos) = turn.sin_cos();
        let line = Line { from: [40.0 * cos - aside * sin, 40.0 * sin + aside * cos], along: [-cos, -sin] };
        let clear = |travel: f64| clearance(envelope.cutter(), corners, line.at(travel), z);
        let samples = (0..10).map(|i| 8.0 * f64::from(i));
        match (envelope.push(&line, z, 100.0), envelope.release(0, &line, z)) {
            (Some((stop, stopped)), Some((free, freed))) => {
                prop_assert!(stop <= free + EXACT, "{stop} {free}");
                for (travel, contact) in [(stop, stopped), (free, freed)] {
                    prop_assert!(clear(travel).abs() <= EXACT, "{travel}: {:e} left, {contact:?}", clear(travel));
                    let [x, y] = line.at(travel);
                    let gap = envelope.gap(contact.point, x, y, z);
                    prop_assert!(gap.abs() <= EXACT, "the contact is {gap:e} off, {contact:?}");
                }
                for travel in samples.filter(|travel| *travel < stop || *travel > free) {
                    prop_assert!(clear(travel) >= -EXACT, "at {travel}, outside {stop} to {free}, it enters by {:e}", clear(travel));
                }
            }
            (None, None) => {
                for travel in samples {
                    prop_assert!(clear(travel) >= -EXACT, "missed at {travel}: {:e}", clear(travel));
                }
            }
            other => prop_assert!(false, "{other:?}"),
        }
    }
}

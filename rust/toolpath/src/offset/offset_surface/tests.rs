//! What the offset surface holds at its points, between them and in its regions.

use super::checks::FARTHEST;
use super::*;
use crate::offset::{Envelope, Index};
use proptest::prelude::*;
use styluscam_geometry::{kinds, Mesh, ProfileDocument, Tool, ToolDocument};
use styluscam_motion::{Cancelled, Watch};

const TOLERANCE: f64 = 0.001;
const MOST: usize = 1 << 20;

fn ball(diameter: f64) -> Tool {
    tool(ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }))
}

fn tool(profile: ProfileDocument) -> Tool {
    Tool::new(ToolDocument::of(profile)).unwrap()
}

fn surface(mesh: &Mesh, tool: &Tool) -> OffsetSurface {
    let index = Index::new(mesh);
    let all: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    let envelope = Envelope::new(mesh, &index, tool, None, 0.0);
    OffsetSurface::new(&envelope, tool, None, &all, TOLERANCE, MOST, &Watch::default()).unwrap()
}

/// A section (x, z) from left to right drawn out along Y from 0 to 60, a face to each piece of it where asked for.
fn drawn_out(section: &[[f64; 2]], with_faces: bool) -> Mesh {
    let at = |[x, z]: [f64; 2], y: f64| Vector::new(x, y, z);
    let vertices = section.iter().flat_map(|p| [at(*p, 0.0), at(*p, 60.0)]).collect();
    let pieces = 0..section.len() as i64 - 1;
    let triangles: Vec<[i64; 3]> =
        pieces.flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]).collect();
    let faces: Vec<u32> = (0..triangles.len() as u32).map(|t| 1 + t / 2).collect();
    Mesh::new(vertices, &triangles, if with_faces { &faces } else { &[] }).unwrap()
}

/// A floor, a fillet and a wall of 45 degrees.
fn filleted(radius: f64) -> Mesh {
    let arc = (0..=200).map(|i| f64::from(i) / 200.0 * std::f64::consts::FRAC_PI_4);
    let arc = arc.map(|a| [radius * libm::sin(a), radius * (1.0 - libm::cos(a))]);
    let mut section = vec![[-40.0, 0.0]];
    section.extend(arc);
    let [x, z] = section[section.len() - 1];
    section.push([x + 30.0, z + 30.0]);
    drawn_out(&section, false)
}

fn flags(surface: &OffsetSurface) -> Vec<SurfaceFlag> {
    let mut flags: Vec<SurfaceFlag> = surface.points.iter().map(|p| p.flag).collect();
    flags.sort_unstable();
    flags.dedup();
    flags
}

fn at(surface: &OffsetSurface, x: f64, z: f64) -> OffsetPoint {
    let near = |p: &&OffsetPoint| (p.contact.x - x).abs() < 1e-9 && (p.contact.z - z).abs() < 1e-9;
    *surface.points.iter().find(near).unwrap()
}

#[test]
fn a_fillet_that_runs_into_a_floor_is_bridged_by_a_larger_tool_and_followed_by_a_smaller() {
    assert_eq!(flags(&surface(&filleted(4.0), &ball(6.0))), [SurfaceFlag::Contact]);
    let bridged = surface(&filleted(2.0), &ball(6.0));
    assert_eq!(flags(&bridged), [SurfaceFlag::Contact, SurfaceFlag::Bridged]);
    let [sin, cos] = [libm::sin(22.5_f64.to_radians()), libm::cos(22.5_f64.to_radians())];
    let middle = at(&bridged, 2.0 * sin, 2.0 * (1.0 - cos));
    // the ball enters the floor and the wall, which are tangents of the arc, about equally deep
    let centre = middle.contact + middle.normal * 3.0;
    let over_wall = (centre.z - centre.x) * 0.5_f64.sqrt() + 2.0 - 2.0_f64.sqrt();
    assert_eq!(middle.flag, SurfaceFlag::Bridged);
    assert!((middle.depth - (3.0 - centre.z.min(over_wall))).abs() < 1e-5, "{} {centre:?}", middle.depth);
}

#[test]
fn a_sharp_inner_corner_interferes_with_and_without_faces() {
    let valley = [[-20.0, 20.0], [-1.0, 1.0], [0.0, 0.0], [1.0, 0.0], [30.0, 0.0]];
    for with_faces in [false, true] {
        let found = surface(&drawn_out(&valley, with_faces), &ball(6.0));
        let corner = at(&found, 1.0, 0.0);
        assert_eq!(corner.flag, SurfaceFlag::Interferes, "{with_faces}");
        // the ball's centre stands over (1, 3): 4 / sqrt 2 from the wall
        assert!((corner.depth - (3.0 - 8.0_f64.sqrt())).abs() < 1e-6, "{}", corner.depth);
        assert!((corner.place.x + corner.place.z).abs() < 1e-9 && corner.place.x < -1.0 + 1e-3);
        assert_eq!(at(&found, 30.0, 0.0).flag, SurfaceFlag::Contact);
    }
}

/// A floor with points every half millimetre that ends at an upright wall of some height.
fn with_wall(height: f64) -> Mesh {
    let mut section: Vec<[f64; 2]> = (0..=40).map(|i| [0.5 * f64::from(i) - 20.0, 0.0]).collect();
    section.extend((1..=40).map(|i| [0.0, height * f64::from(i) / 40.0]));
    section.push([20.0, height]);
    drawn_out(&section, false)
}

#[test]
fn a_step_beside_the_point_interferes_as_deep_as_the_tool_would_enter_it() {
    let found = surface(&with_wall(20.0), &ball(6.0));
    for i in 0..12 {
        let x = 0.5 * f64::from(i) - 6.0;
        let point = at(&found, x, 0.0);
        if x > -3.0 {
            assert_eq!(point.flag, SurfaceFlag::Interferes, "{x}");
            assert!((point.depth - (3.0 + x)).abs() < 1e-6, "{x} {}", point.depth);
            assert!(point.place.x.abs() < 1e-9, "{x}");
        } else {
            assert_eq!((point.flag, point.depth), (SurfaceFlag::Contact, 0.0), "{x}");
        }
    }
}

#[test]
fn an_upright_wall_is_touched_by_the_base_down_to_where_the_tip_meets_the_floor() {
    let found = surface(&with_wall(20.0), &ball(6.0));
    for i in 1..40 {
        let z = 0.5 * f64::from(i);
        let walls: Vec<&OffsetPoint> =
            found.points.iter().filter(|p| p.normal.x < -0.5 && (p.contact.z - z).abs() < 1e-9).collect();
        assert!(!walls.is_empty());
        for point in walls {
            assert!((point.tip - Vector::new(-3.0, point.contact.y, z - 3.0)).norm() < 1e-12);
            if z < 3.0 {
                assert_eq!(point.flag, SurfaceFlag::Interferes, "{z}");
                assert!((point.depth - (3.0 - z)).abs() < 1e-6, "{z} {}", point.depth);
                assert!(point.place.z.abs() < 1e-9);
            } else {
                assert_eq!(point.flag, SurfaceFlag::Contact, "{z}");
            }
        }
    }
}

#[test]
fn walls_beside_the_tool_do_not_hide_what_it_enters() {
    // lifted off one wall by the tolerance the tool grazes the other, and it enters the ridge on the floor
    let gap = 6.0 + 0.5 * TOLERANCE;
    let section = [[-20.0, 30.0], [0.0, 30.0], [0.0, 0.0], [1.5, 0.0], [3.0, 0.1], [4.5, 0.0], [gap, 0.0]];
    let found = surface(&drawn_out(&[&section[..], &[[gap, 30.0], [26.0, 30.0]]].concat(), false), &ball(6.0));
    let wall = found.points.iter().find(|p| p.normal.x > 0.5 && p.contact.z == 0.0).unwrap();
    assert!((wall.tip.z + 3.0).abs() < 1e-12);
    assert_eq!(wall.flag, SurfaceFlag::Interferes);
    // the shortest path out of there is to the side
    assert!((wall.depth - 3.0).abs() < 1e-2, "{}", wall.depth);
}

#[test]
fn steeper_than_the_profile_is_rim_and_what_looks_down_is_undercut() {
    let shallow = tool(ProfileDocument::from(kinds::Clothoid {
        diameter: None,
        scale: Some(30.0),
        end_slope_deg: Some(40.0),
        tip_flat: 0.0,
    }));
    let found = surface(&drawn_out(&[[-30.0, 30.0], [0.0, 0.0], [-5.0, -20.0]], true), &shallow);
    assert_eq!(flags(&found), [SurfaceFlag::Rim, SurfaceFlag::Undercut]);
    for point in &found.points {
        assert_eq!(point.flag == SurfaceFlag::Undercut, point.normal.z < 0.0);
        assert_eq!(point.place, point.contact);
    }
}

#[test]
fn normals_of_the_model_move_the_tool_and_part_the_patches() {
    let (vertices, triangles) = (filleted(4.0).vertices().to_vec(), filleted(4.0).triangles().to_vec());
    let names: Vec<[i64; 3]> = triangles.iter().map(|t| t.map(i64::from)).collect();
    let exact = |p: Vector| {
        let angle = libm::asin((p.x / 4.0).clamp(0.0, libm::sin(std::f64::consts::FRAC_PI_4)));
        Vector::new(-libm::sin(angle), 0.0, libm::cos(angle))
    };
    let normals: Vec<[Vector; 3]> = triangles.iter().map(|t| t.map(|i| exact(vertices[i as usize]))).collect();
    let mesh = Mesh::with_normals(vertices, &names, &[], &normals).unwrap();
    let found = surface(&mesh, &ball(6.0));
    assert_eq!(found.points.len(), mesh.vertices().len());
    for point in &found.points {
        let centre = point.contact + exact(point.contact) * 3.0;
        assert!((point.tip + Vector::z() * 3.0 - centre).norm() < 1e-9);
    }
    assert_eq!(flags(&found), [SurfaceFlag::Contact]);
    assert_eq!(flags(&surface(&mesh, &ball(12.0))), [SurfaceFlag::Contact, SurfaceFlag::Bridged]);
}

#[test]
fn a_slight_crease_shows_only_in_normals_of_the_model() {
    let bare = drawn_out(&[[-30.0, 0.0], [0.0, 0.0], [30.0, 5.3]], false);
    assert_eq!(flags(&surface(&bare, &ball(6.0))), [SurfaceFlag::Contact, SurfaceFlag::Bridged]);
    let names: Vec<[i64; 3]> = bare.triangles().iter().map(|t| t.map(i64::from)).collect();
    let normals: Vec<[Vector; 3]> = (0..names.len()).map(|t| [bare.normal(t); 3]).collect();
    let known = Mesh::with_normals(bare.vertices().to_vec(), &names, &[], &normals).unwrap();
    assert_eq!(flags(&surface(&known, &ball(6.0))), [SurfaceFlag::Contact, SurfaceFlag::Interferes]);
}

#[test]
fn the_regions_share_out_the_area() {
    let mesh = with_wall(20.0);
    let found = surface(&mesh, &ball(6.0));
    let regions = found.regions(&mesh);
    let whole: f64 = (0..mesh.triangles().len()).map(|t| mesh.area(t)).sum();
    assert!((regions.iter().map(|r| r.area).sum::<f64>() - whole).abs() < 1e-9 * whole);
    let [contact, interferes] = regions[..] else { panic!("{regions:?}") };
    assert_eq!((contact.flag, interferes.flag), (SurfaceFlag::Contact, SurfaceFlag::Interferes));
    // 3 mm of the floor and 3 mm of the wall are stopped, to half a row of triangles each
    assert!((interferes.area - 360.0).abs() < 60.0, "{}", interferes.area);
    assert!((interferes.worst.depth - 3.0).abs() < 1e-6);
}

#[test]
fn the_base_enters_a_steep_wall_however_it_is_cut_into_triangles() {
    // the rim touches the wall high up first, in one of its triangles, and would enter it deepest in the other
    let tool = tool(ProfileDocument::from(kinds::Ball { diameter: 6.0, radius: Some(3.1), tip_flat: 0.0 }));
    let found = surface(&drawn_out(&[[0.0, 10.0], [9.0, 10.0], [10.8, 0.0], [40.0, 0.0]], true), &tool);
    let rim = tool.point_at(tool.profile().max_slope());
    let normal = Vector::new(10.0, 0.0, 1.8).normalize();
    for point in found.points.iter().filter(|p| p.normal.z > 0.99 && p.contact.z < 1e-9) {
        let depth = -Vector::new(point.contact.x - rim.0 - 10.8, 0.0, rim.1).dot(&normal);
        assert_eq!(point.flag.is_stopped(), depth > TOLERANCE, "{depth} {point:?}");
        // deep inside, the base's side is nearer than the rim
        assert!(depth < TOLERANCE || (0.95 * depth..depth + 1e-6).contains(&point.depth), "{depth} {point:?}");
    }
}

#[test]
fn large_triangles_are_split_where_something_stops_the_tool() {
    // two triangles of floor, two of wall, two on top: every corner of the floor but two stands at the wall
    let mesh = drawn_out(&[[-20.0, 0.0], [0.0, 0.0], [0.0, 20.0], [20.0, 20.0]], true);
    let found = surface(&mesh, &ball(6.0));
    let area = |face, flag| found.regions(&mesh).iter().find(|r| r.face == face && r.flag == flag).map(|r| r.area);
    for face in [1, 2] {
        let [contact, interferes] = [SurfaceFlag::Contact, SurfaceFlag::Interferes].map(|f| area(face, f).unwrap());
        assert!((contact + interferes - 1200.0).abs() < 1e-9);
        assert!((interferes - 180.0).abs() < 25.0, "{face} {interferes}");
    }
    assert_eq!(area(3, SurfaceFlag::Interferes), None);
    let sides = |corners: &[u32; 3]| corners.map(|i| found.points[i as usize].contact);
    for corners in found.triangles.iter().map(sides) {
        assert!((corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm() > 0.0);
    }
}

#[test]
fn it_can_be_cancelled() {
    let mesh = with_wall(20.0);
    let (index, tool, watch) = (Index::new(&mesh), ball(6.0), Watch::default());
    watch.cancel();
    let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
    assert_eq!(OffsetSurface::new(&envelope, &tool, None, &[0], TOLERANCE, MOST, &watch), Err(Cancelled));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn what_is_free_enters_nothing_and_what_is_stopped_enters_its_place(
        heights in prop::collection::vec(prop_oneof![0.0..4.0_f64, Just(1.0)], 42),
        kind in 0..3_u8,
        margin in prop_oneof![Just(0.0), 0.0..0.5_f64],
    ) {
        let tool = match kind {
            0 => tool(ProfileDocument::from(kinds::Clothoid {
                diameter: Some(3.0),
                scale: None,
                end_slope_deg: None,
                tip_flat: 0.1,
            })),
            1 => tool(ProfileDocument::from(kinds::Parabola { apex_radius: 2.0, diameter: 2.4, tip_flat: 0.0 })),
            _ => ball(2.0),
        };
        let mesh = terrain(&heights, 7);
        let index = Index::new(&mesh);
        let all: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
        let envelope = Envelope::new(&mesh, &index, &tool, None, margin);
        let found = OffsetSurface::new(&envelope, &tool, None, &all, TOLERANCE, MOST, &Watch::default()).unwrap();
        let body = tool.cutter_with(None, margin);
        let depth = |p: Vector, point: &OffsetPoint| {
            let tip = point.tip + point.normal * margin - Vector::z() * margin;
            -body.distance(libm::hypot(p.x - tip.x, p.y - tip.y), p.z - tip.z).0
        };
        for point in found.points.iter().step_by(1 + found.points.len() / 80) {
            let deepest = all.iter().flat_map(|t| samples(mesh.corners(*t as usize))).map(|p| depth(p, point));
            let deepest = deepest.fold(f64::NEG_INFINITY, f64::max);
            if point.flag.is_stopped() {
                prop_assert!(depth(point.place, point) > point.depth - 1e-6);
            } else {
                prop_assert!(deepest < FARTHEST * TOLERANCE, "{point:?} {deepest}");
            }
        }
    }
}

fn terrain(heights: &[f64], columns: usize) -> Mesh {
    let position = |i: usize| Vector::new((i % columns) as f64, (i / columns) as f64, heights[i]);
    let triangles: Vec<[i64; 3]> = (0..heights.len() - columns)
        .filter(|i| (i + 1) % columns != 0)
        .map(|i| [i, i + 1, i + columns, i + columns + 1].map(|k| k as i64))
        .flat_map(|[a, b, c, d]| [[a, b, c], [b, d, c]])
        .collect();
    Mesh::new((0..heights.len()).map(position).collect(), &triangles, &[]).unwrap()
}

fn samples([a, b, c]: [Vector; 3]) -> Vec<Vector> {
    let shares = (0..=5).flat_map(|i| (0..=5 - i).map(move |j| (f64::from(i) / 5.0, f64::from(j) / 5.0)));
    shares.map(|(s, t)| a + (b - a) * s + (c - a) * t).collect()
}

#[test]
fn flags_have_their_numbers() {
    let names: Vec<&str> = SurfaceFlag::ALL.iter().map(|f| f.name()).collect();
    assert_eq!(names, ["contact", "bridged", "interferes", "rim", "undercut"]);
    assert!(SurfaceFlag::ALL.iter().enumerate().all(|(i, flag)| *flag as usize == i));
}

//! Offset surfaces are refined where something stops the tool: that ends, with as many points as the positions are wide.

use crate::common::plates::{plate, Boss};
use proptest::prelude::*;
use styluscam_geometry::{kinds, Mesh, ProfileDocument, Tool, ToolDocument, Vector};
use styluscam_motion::Watch;
use styluscam_toolpath::offset::{Envelope, Index, OffsetSurface};

const TOLERANCE: f64 = 0.005;
/// Points that halving may add.
const MOST: usize = 1 << 16;
/// Sides are halved down to this share of the tool's radius.
const FINE: f64 = 0.25;

fn flat(diameter: f64) -> Tool {
    Tool::new(ToolDocument::of(ProfileDocument::from(kinds::Flat { diameter, tip_flat: 0.0 }))).unwrap()
}

fn refined(mesh: &Mesh, tool: &Tool) -> OffsetSurface {
    let index = Index::new(mesh);
    let all: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    let envelope = Envelope::new(mesh, &index, tool, None, 0.0);
    OffsetSurface::new(&envelope, tool, None, &all, TOLERANCE, MOST, &Watch::default()).unwrap()
}

/// That sides are as short as meant where flags change, and four times that where the tool is stopped all over, and that the
/// triangles still have the mesh's area.
fn assert_refined(surface: &OffsetSurface, mesh: &Mesh, tool: &Tool) {
    let radius = tool.profile().point_at(std::f64::consts::FRAC_PI_2).0;
    assert!(!surface.is_coarse && (surface.fine - FINE * radius).abs() < 1e-12, "{}", surface.fine);
    let mut whole = 0.0;
    for corners in &surface.triangles {
        let [a, b, c] = corners.map(|i| &surface.points[i as usize]);
        whole += 0.5 * (b.contact - a.contact).cross(&(c.contact - a.contact)).norm();
        let changes = a.flag != b.flag || a.flag != c.flag;
        if changes || a.flag.is_stopped() {
            let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| (p.contact - q.contact).norm());
            let most = if changes { surface.fine } else { 4.0 * surface.fine };
            assert!(sides.into_iter().fold(0.0, f64::max) <= most);
        }
    }
    let area: f64 = (0..mesh.triangles().len()).map(|t| mesh.area(t)).sum();
    assert!((whole - area).abs() < 1e-9 * area, "{whole} {area}");
}

#[test]
fn a_floor_beside_a_needle_is_refined_to_the_end() {
    let floor = [[4.5, 13.7, 0.0], [16.1, 6.8, 0.0], [1.5, 16.1, 0.0]];
    let needle = [[3.9, 13.2, 0.0], [3.902, 13.2, 0.0], [3.901, 13.2, 20.0]];
    let vertices: Vec<Vector> = floor.into_iter().chain(needle).map(Vector::from).collect();
    let mesh = Mesh::new(vertices, &[[0, 1, 2], [3, 4, 5]], &[]).unwrap();
    let (tool, mesh) = (flat(2.0), &mesh);
    let surface = refined(mesh, &tool);
    assert_refined(&surface, mesh, &tool);
    assert!(surface.points.len() < 5000, "{}", surface.points.len());
}

#[test]
fn a_plate_with_one_boss_is_refined_to_the_end() {
    let boss = Boss { centre: [10.0, 10.0], radius: 3.0, sides: 16, height: 10.0 };
    let mesh = plate([100.0, 40.0], &[boss]);
    for diameter in [2.0, 6.0, 20.0] {
        let tool = flat(diameter);
        let surface = refined(&mesh, &tool);
        assert_refined(&surface, &mesh, &tool);
        assert!(surface.points.len() < 20_000, "{diameter}: {}", surface.points.len());
    }
}

#[test]
fn what_would_take_more_points_than_the_budget_stays_coarse_and_says_so() {
    // pins all over a wide plate: everything beside them is stopped
    let pins = (0..64).map(|i| Boss {
        centre: [60.0 * f64::from(i % 8) + 30.0, 60.0 * f64::from(i / 8) + 30.0],
        radius: 25.0,
        sides: 12,
        height: 30.0,
    });
    let mesh = plate([480.0, 480.0], &pins.collect::<Vec<_>>());
    let surface = refined(&mesh, &flat(1.0));
    assert!(surface.is_coarse && surface.fine > FINE * 0.5, "{}", surface.fine);
    assert!(surface.points.len() < 70_000, "{}", surface.points.len());
}

/// Position along and across, radius, sides and height as they are drawn.
type Drawn = (f64, f64, f64, usize, f64);

fn any_bosses() -> impl Strategy<Value = Vec<Boss>> {
    // one to a cell of 20 mm: they do not meet
    let boss = (0.0..1.0_f64, 0.0..1.0_f64, 0.05..8.0_f64, 3..24_usize, 0.5..20.0_f64);
    prop::collection::vec(prop::option::of(boss), 10).prop_map(|cells| {
        let position = |(cell, boss): (usize, Option<Drawn>)| {
            let (x, y, radius, sides, height) = boss?;
            let free = 19.0 - 2.0 * radius;
            let centre = [
                20.0 * (cell % 5) as f64 + 0.5 + radius + x * free,
                20.0 * (cell / 5) as f64 + 0.5 + radius + y * free,
            ];
            Some(Boss { centre, radius, sides, height })
        };
        cells.into_iter().enumerate().filter_map(position).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn plates_with_bosses_are_refined_to_the_end(bosses in any_bosses(), diameter in 4.0..20.0_f64) {
        let mesh = plate([100.0, 40.0], &bosses);
        let tool = flat(diameter);
        let surface = refined(&mesh, &tool);
        assert_refined(&surface, &mesh, &tool);
        prop_assert!(surface.points.len() < 40_000, "{}", surface.points.len());
    }
}

//! Levels round the walls of pins on a plate: closed passes, and what lies between two levels.

use crate::common::plates::{plate, Boss};
use styluscam_geometry::{kinds, Mesh, ProfileDocument, Tool, ToolDocument, Vector};
use styluscam_motion::Watch;
use styluscam_toolpath::forming::{left_out, z_levels, z_levels_beside, Grid};
use styluscam_toolpath::offset::{Envelope, Index};
use styluscam_toolpath::Surface;

/// Whether each triangle is a wall's.
fn upright(mesh: &Mesh) -> Vec<bool> {
    (0..mesh.triangles().len()).map(|t| mesh.normal(t).z.abs() < 1e-9).collect()
}

/// What a test does with the surface of the mesh's walls, a tool over it, and a grid of 0.7 mm.
fn over_walls<T>(mesh: &Mesh, profile: ProfileDocument, act: impl Fn(&Surface<'_>, &Grid) -> T) -> T {
    let (index, tool) = (Index::new(mesh), Tool::new(ToolDocument::of(profile)).unwrap());
    let envelope = Envelope::new(mesh, &index, &tool, None, 0.001);
    let walls = upright(mesh);
    let surface = Surface::new(&envelope, &walls);
    let grid = Grid::sample(&surface, 0.7, &Watch::default()).unwrap().unwrap();
    act(&surface, &grid)
}

/// Facets of a pin that lie 8 to 60 degrees apart, of which only the upright ones are selected.
#[test]
fn the_wall_of_a_faceted_pin_is_one_closed_pass() {
    let flat = ProfileDocument::from(kinds::Flat { diameter: 3.0, tip_flat: 0.0 });
    let ball = ProfileDocument::from(kinds::Ball { diameter: 3.0, radius: None, tip_flat: 0.0 });
    for (profile, sides) in [(flat.clone(), 6), (flat.clone(), 13), (flat, 45), (ball.clone(), 6), (ball, 45)] {
        let mesh = plate([40.0, 40.0], &[Boss { centre: [20.0, 20.0], radius: 2.0, sides, height: 10.0 }]);
        let heights = [8.0, 5.0, 2.0];
        let passes = over_walls(&mesh, profile.clone(), |surface, grid| {
            z_levels(surface, grid, &heights, 0.01, &Watch::default()).unwrap()
        });
        assert_eq!(passes.len(), heights.len(), "{profile:?} {sides}");
        for pass in passes {
            let (first, last) = (pass.points.first().unwrap().tip, pass.points.last().unwrap().tip);
            assert!((first - last).norm() < 1e-9, "{profile:?} {sides}: open at {first} and {last}");
        }
    }
}

#[test]
fn walls_between_two_levels_are_left_out_and_those_beside_them_not() {
    let boss = |x: f64, height: f64| Boss { centre: [x, 20.0], radius: 4.0, sides: 16, height };
    let mesh = plate([60.0, 40.0], &[boss(10.0, 0.5), boss(30.0, 0.8), boss(50.0, 3.0)]);
    let of_levels = |heights: &[f64]| bands_without(&mesh, heights);
    let bands = of_levels(&[2.0, 1.0]);
    for height in [0.5, 0.8] {
        assert!(bands.iter().any(|band| (band.1 - height).abs() < 0.02), "{bands:?} {height}");
    }
    assert!(bands.iter().all(|(low, high)| *low >= 0.0 && *high < 0.82), "{bands:?}");
    let feet = of_levels(&[2.0, 0.3]);
    assert!(!feet.is_empty() && feet.iter().all(|(low, high)| *low < 0.01 && *high < 0.03), "{feet:?}");
    assert!(of_levels(&[2.0, 0.3, 0.01]).is_empty());
}

#[test]
fn a_low_wall_that_goes_on_as_a_high_one_is_left_out() {
    // a front 5 mm high from X0 to X10, 0.5 mm high to X20, and the step's own wall between
    let points = [[0.0, 0.0], [10.0, 0.0], [20.0, 0.0], [20.0, 0.5], [10.0, 0.5], [10.0, 5.0], [0.0, 5.0]];
    let at = |[x, z]: [f64; 2], y: f64| Vector::new(x, y, z);
    let mut vertices: Vec<Vector> = points.iter().map(|point| at(*point, 0.0)).collect();
    vertices.extend([at(points[4], 10.0), at(points[5], 10.0)]);
    let front = [[0, 1, 4], [0, 4, 5], [0, 5, 6], [1, 2, 3], [1, 3, 4]];
    let step = [[5, 4, 7], [5, 7, 8]];
    let triangles: Vec<[i64; 3]> = front.into_iter().chain(step).collect();
    let mesh = Mesh::new(vertices, &triangles, &[]).unwrap();
    let bands = bands_without(&mesh, &[4.0, 2.0]);
    assert!(!bands.is_empty() && bands.iter().all(|band| (band.1 - 0.5).abs() < 0.02), "{bands:?}");
    assert!(bands_without(&mesh, &[4.0, 0.4]).is_empty());
}

/// Walls and top of a square block, `half` mm to each side of the axis.
fn block(half: f64, low: f64, high: f64) -> (Vec<Vector>, Vec<[i64; 3]>) {
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let at = |z: f64| corners.into_iter().map(move |[x, y]| Vector::new(x, y, z));
    let walls = (0..4).flat_map(|i| [[i, (i + 1) % 4, (i + 1) % 4 + 4], [i, (i + 1) % 4 + 4, i + 4]]);
    (at(low).chain(at(high)).collect(), walls.chain([[4, 5, 6], [4, 6, 7]]).collect())
}

#[test]
fn a_wall_that_ends_on_a_ledge_has_a_level_there() {
    // the ledge is at 3 mm: between the levels at 4 and 2
    let (mut vertices, mut triangles) = block(10.0, 0.0, 3.0);
    let (upper, above) = block(5.0, 3.0, 8.0);
    triangles.extend(above.into_iter().map(|corners| corners.map(|corner| corner + 8)));
    vertices.extend(upper);
    let mesh = Mesh::new(vertices, &triangles, &[]).unwrap();
    let bands = bands_without(&mesh, &[6.0, 4.0, 2.0, 0.0]);
    assert!(!bands.is_empty() && bands.iter().all(|band| (band.0 - 3.0).abs() < 0.01 && band.1 < 3.05), "{bands:?}");
    assert!(bands_without(&mesh, &[6.0, 4.0, 3.01, 2.0, 0.0]).is_empty());
}

#[test]
fn levels_that_are_added_are_those_of_one_plan() {
    let boss = |x: f64, height: f64| Boss { centre: [x, 20.0], radius: 4.0, sides: 16, height };
    let mesh = plate([60.0, 40.0], &[boss(10.0, 0.5), boss(30.0, 0.8), boss(50.0, 3.0)]);
    let profile = ProfileDocument::from(kinds::Flat { diameter: 3.0, tip_flat: 0.0 });
    over_walls(&mesh, profile, |surface, grid| {
        let at = |heights: &[f64]| z_levels(surface, grid, heights, 0.01, &Watch::default()).unwrap();
        let (known, asked) = ([2.0, 1.0, 0.3], [2.0, 1.5, 0.6, 0.3, 0.1]);
        let beside = z_levels_beside((&known, at(&known)), surface, grid, &asked, 0.01, &Watch::default()).unwrap();
        assert!(!beside.is_empty());
        assert_eq!(beside, at(&asked));
    });
}

fn bands_without(mesh: &Mesh, heights: &[f64]) -> Vec<(f64, f64)> {
    over_walls(mesh, ProfileDocument::from(kinds::Flat { diameter: 3.0, tip_flat: 0.0 }), |surface, grid| {
        let passes = z_levels(surface, grid, heights, 0.01, &Watch::default()).unwrap();
        left_out(surface, (heights, &passes), 0.7, &Watch::default()).unwrap()
    })
}

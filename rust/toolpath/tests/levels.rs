//! Levels round the walls of coarse pins: one closed pass each, whatever is selected beside them.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that panics fails

mod common;

use common::plates::{plate, Boss};
use styluscam_geometry::{Mesh, ProfileDocument, Tool, ToolDocument};
use styluscam_motion::Watch;
use styluscam_toolpath::forming::{left_out, z_levels, Grid};
use styluscam_toolpath::offset::{Envelope, Index};
use styluscam_toolpath::Surface;

/// Whether each triangle is a wall's.
fn upright(mesh: &Mesh) -> Vec<bool> {
    (0..mesh.triangles().len()).map(|t| mesh.normal(t).z.abs() < 1e-9).collect()
}

/// Facets of a pin that lie 8 to 60 degrees apart, of which only the upright ones are selected.
#[test]
fn the_wall_of_a_faceted_pin_is_one_closed_pass() {
    let flat = ProfileDocument::Flat { diameter: 3.0, tip_flat: 0.0 };
    let ball = ProfileDocument::Ball { diameter: 3.0, radius: None, tip_flat: 0.0 };
    for (profile, sides) in [(flat.clone(), 6), (flat.clone(), 13), (flat, 45), (ball.clone(), 6), (ball, 45)] {
        let mesh = plate([40.0, 40.0], &[Boss { centre: [20.0, 20.0], radius: 2.0, sides, height: 10.0 }]);
        let walls = upright(&mesh);
        let (index, tool) = (Index::new(&mesh), Tool::new(ToolDocument::of(profile.clone())).unwrap());
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.001);
        let surface = Surface::new(&envelope, &walls);
        let heights = [8.0, 5.0, 2.0];
        let watch = Watch::default();
        let grid = Grid::sample(&surface, 0.7, &watch).unwrap().unwrap();
        let passes = z_levels(&surface, &grid, &heights, 0.01, &watch).unwrap();
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
    let walls = upright(&mesh);
    let profile = ProfileDocument::Flat { diameter: 3.0, tip_flat: 0.0 };
    let (index, tool) = (Index::new(&mesh), Tool::new(ToolDocument::of(profile)).unwrap());
    let envelope = Envelope::new(&mesh, &index, &tool, None, 0.001);
    let surface = Surface::new(&envelope, &walls);
    let watch = Watch::default();
    let grid = Grid::sample(&surface, 0.7, &watch).unwrap().unwrap();
    let of_levels = |heights: &[f64]| {
        let passes = z_levels(&surface, &grid, heights, 0.01, &watch).unwrap();
        left_out(&surface, &passes, 0.7, &watch).unwrap()
    };
    let mut bands = of_levels(&[2.0, 1.0]);
    bands.sort_by(|a, b| a.1.total_cmp(&b.1));
    assert_eq!(bands.len(), 2, "{bands:?}");
    for (band, height) in bands.iter().zip([0.5, 0.8]) {
        assert!(band.0.abs() < 0.02 && (band.1 - height).abs() < 0.02, "{band:?} {height}");
    }
    assert!(of_levels(&[2.0, 0.3]).is_empty());
}

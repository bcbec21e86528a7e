//! The material after a program, against closed forms and brute force.
#![allow(clippy::unwrap_used)] // helpers of tests are not test functions

mod common;

use common::{ball, limits, Part, Path};
use styluscam_geometry::{Tool, Vector};
use styluscam_motion::{Program, Watch};
use styluscam_verify::{simulate, Grid, Simulation};

const SIZE: [f64; 2] = [20.0, 12.0];

fn simulated(tool: &Tool, program: &Program, spacing: f64) -> Simulation {
    let plate = [[0.0, 0.0], [20.0, 0.0], [0.0, 12.0]].map(|[x, y]| Vector::new(x, y, -20.0));
    let part = Part::new(plate.to_vec(), &[[0, 1, 2]]);
    let tools = std::slice::from_ref(tool);
    let grid = Grid::over([0.0, 0.0], SIZE, spacing).unwrap();
    simulate(program, &part.subject(tools), &limits(), grid, 0.0, &Watch::default()).unwrap()
}

/// The nodes with their heights.
fn nodes(simulation: &Simulation) -> impl Iterator<Item = ([f64; 2], f64)> + '_ {
    let width = simulation.grid.nodes[0];
    simulation.heights.iter().enumerate().map(move |(i, height)| (simulation.grid.at(i % width, i / width), *height))
}

#[test]
fn a_ball_along_a_line_leaves_its_groove() {
    let tool = ball(6.0);
    let program = Path::new().rapid([4.0, 6.0, 10.0]).feed([4.0, 6.0, -1.0]).feed([16.0, 6.0, -1.0]).program(&tool);
    let simulation = simulated(&tool, &program, 0.1);
    for ([x, y], height) in nodes(&simulation) {
        let aside = (x - x.clamp(4.0, 16.0)).hypot(y - 6.0);
        let groove = if aside < 3.0 { 2.0 - (9.0 - aside * aside).sqrt() } else { 0.0 };
        assert!((height - groove.min(0.0)).abs() < 1e-9, "{x} {y}: {height} {groove}");
    }
}

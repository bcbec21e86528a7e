//! How long the verifier takes: `cargo test --release -p styluscam-verify --test it speed -- --ignored --nocapture`.

use std::time::Instant;

use crate::common::{ball, clothoid, limits, Levels, Part, Path};
use styluscam_geometry::Vector;
use styluscam_motion::Watch;
use styluscam_verify::judge;

#[test]
#[ignore = "measures time: meant for release builds"]
fn in_a_funnel() {
    measure(true);
}

#[test]
#[ignore = "measures time: meant for release builds"]
fn on_a_hill() {
    measure(false);
}

/// A ball on 200,000 triangles of 200 x 200 mm: moves of 0.57 mm along rows that lie 0.1 mm apart.
#[test]
#[ignore = "measures time: meant for release builds"]
fn over_waves() {
    let (cells, side) = (316_u32, 200.0);
    let height = |x: f64, y: f64| 4.0 * (x / 7.0).sin() * (y / 9.0).cos() + 1.5 * (x / 2.9 + y / 4.3).sin();
    let at = |i: u32| side * f64::from(i) / f64::from(cells);
    let nodes = (0..=cells).flat_map(|j| (0..=cells).map(move |i| (i, j)));
    let vertices = nodes.map(|(i, j)| Vector::new(at(i), at(j), height(at(i), at(j)))).collect();
    let corner = |i: u32, j: u32| i64::from(j * (cells + 1) + i);
    let squares = (0..cells).flat_map(|j| (0..cells).map(move |i| (i, j)));
    let triangles: Vec<[i64; 3]> = squares
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let part = Part::new(vertices, &triangles);
    let (tool, radius) = (ball(6.0), 3.0);
    let slope = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + 1e-6) - f(t - 1e-6)) / 2e-6;
    let mut path = Path::new().rapid([1.0, 1.0, 20.0]);
    for row in 0..570 {
        let y = 1.0 + 0.1 * f64::from(row);
        for i in 0..350 {
            let x = 1.0 + 0.57 * f64::from(if row % 2 == 0 { i } else { 349 - i });
            let up = Vector::new(-slope(&|t| height(t, y), x), -slope(&|t| height(x, t), y), 1.0).normalize();
            path = path.feed((Vector::new(x, y, height(x, y) - radius) + radius * up).into());
        }
    }
    let program = path.program(&tool);
    let tools = [tool];
    let start = Instant::now();
    let report = judge(&program, &part.subject(&tools), &limits(), &Watch::default()).unwrap();
    let seconds = start.elapsed().as_secs_f64();
    let moves = program.moves.len();
    println!("waves: {seconds:.3} s for {moves} moves, {:.1} s a million", seconds / moves as f64 * 1e6);
    println!("gouge {:.6}, excess {:.6}", report.gouge_max, report.excess_max);
}

/// 30,000 moves against 100,000 triangles, where they touch and where they do not.
fn measure(inner: bool) {
    let part = Part::cone(inner, 20.0, 60.0, 1000, 50);
    for (name, tool) in [("ball", ball(10.0)), ("clothoid", clothoid(10.0))] {
        for off in [0.001, -1.0, -6.0, 20.0] {
            let levels =
                Levels { tool: &tool, sheet: None, inner, low: 20.0, high: 60.0, levels: 60, points: 500, off };
            let program = levels.path().program(&tool);
            let tools = [tool.clone()];
            let start = Instant::now();
            let report = judge(&program, &part.subject(&tools), &limits(), &Watch::default()).unwrap();
            let seconds = start.elapsed().as_secs_f64();
            let (moves, samples, triangles) = (program.moves.len(), report.samples, part.mesh.triangles().len());
            println!(
                "{name}, {off} mm off: {seconds:.3} s for {moves} moves, {samples} samples, {triangles} triangles; \
                 gouge {:.6}, excess {:.6}",
                report.gouge_max, report.excess_max
            );
        }
    }
}

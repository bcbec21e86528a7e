//! How long the judge takes: `cargo test --release -p styluscam-verify --test speed -- --ignored --nocapture`.
#![allow(clippy::unwrap_used)] // helpers of tests are not test functions

mod common;

use std::time::Instant;

use common::{ball, clothoid, limits, Levels, Part};
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

//! A part, jobs for it, and what they are planned and posted with.

use std::sync::Arc;

use styluscam_geometry::{Mesh, NurbsCurve, Vector};
use styluscam_motion::Watch;
use styluscam_post::Machine;

use crate::{Curves, JobDocument, JobError, Part, Plan, Scene, Setting, MAIN_CHANNEL};

/// A pyramid frustum of 20 x 20 mm, 4 mm high, with walls of 45 degrees: Face1 on top, Face2 below, Face3 to Face6 around.
pub fn frustum() -> Part {
    let square = |half: f64, z: f64| {
        [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[x, y]| Vector::new(x, y, z))
    };
    let vertices: Vec<Vector> = square(10.0, 0.0).into_iter().chain(square(6.0, 4.0)).collect();
    let mut triangles = vec![[4, 5, 6], [4, 6, 7], [0, 2, 1], [0, 3, 2]];
    for i in 0..4_i64 {
        let j = (i + 1) % 4;
        triangles.extend([[i, j, j + 4], [i, j + 4, i + 4]]);
    }
    let faces: Vec<u32> = vec![1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6];
    let mesh = Mesh::new(vertices.clone(), &triangles, &faces).unwrap();
    Part { mesh, inward: 0.0, outward: 0.0, shaped: None, curves: Arc::new(walls(&vertices)) }
}

/// The walls of a frustum, ruled between its lower and upper edges.
fn walls(vertices: &[Vector]) -> Curves {
    let line = |from: usize, to: usize| {
        let poles = [from, to].map(|i| [vertices[i].x, vertices[i].y, vertices[i].z, 1.0]);
        NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 1.0], &poles).unwrap()
    };
    let wall = |i: usize| [line(i, (i + 1) % 4), line(i + 4, (i + 1) % 4 + 4)];
    Curves { edges: Vec::new(), ruled: (3..).zip((0..4).map(wall)).collect() }
}

/// A milling job with one ball of 3 mm, whose operation has these lines besides its tool and tolerance; its spindle stands unless they state one.
pub fn milling(operation: &str) -> String {
    let spindle = if operation.contains("spindle") { "" } else { "spindle = { mode = \"off\" }" };
    format!(
        r#"
schema = 1
part = {{ file = "a.stl", units = "mm" }}
process = {{ kind = "milling" }}
machine = {{ name = "linuxcnc" }}
[tools.a]
profile = {{ kind = "ball", diameter = 3.0 }}
[[operations]]
tool = "a"
tolerance = 0.01
{spindle}
{operation}
"#
    )
}

/// Its operation.
pub const LEVELS: &str = "kind = \"z-level\"\nstep = { height = 1.0 }";

/// The milling job with levels.
pub fn levels() -> String {
    milling(LEVELS)
}

pub fn job(text: &str) -> JobDocument {
    crate::from_toml(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A text with one of its parts replaced; it must be there.
pub fn with(text: &str, before: &str, after: &str) -> String {
    assert!(text.contains(before), "{before:?} is not in {text}");
    text.replace(before, after)
}

pub fn scene(job: &JobDocument) -> Scene {
    Scene::new(job, MAIN_CHANNEL, &frustum()).unwrap()
}

pub fn machine() -> Machine {
    Machine::shipped("linuxcnc").unwrap()
}

pub fn planned(job: &JobDocument) -> Result<Plan, JobError> {
    let (scene, machine) = (scene(job), machine());
    crate::plan(job, &[Setting { scene: &scene, machine: &machine }], &Watch::default())
}

//! Points spread evenly over a mesh's area.

use styluscam_geometry::{Mesh, Vector};

/// Steps of the R2 sequence: the plane's counterpart of the golden ratio (Roberts, 2018).
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// A point of the surface.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Where, mm.
    pub point: Vector,
    /// Unit normal there, out of the material: the model's where it is known.
    pub normal: Vector,
}

/// `count` points, each for the same area: the same for the same mesh.
pub fn samples(mesh: &Mesh, count: usize) -> Vec<Sample> {
    let all: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    of_triangles(mesh, &all, count)
}

/// The same on some of its triangles.
pub fn of_triangles(mesh: &Mesh, triangles: &[u32], count: usize) -> Vec<Sample> {
    let whole: f64 = triangles.iter().map(|t| mesh.area(*t as usize)).sum();
    let each = whole / count as f64;
    let mut found = Vec::with_capacity(count);
    let mut passed = 0.0;
    for triangle in triangles {
        passed += mesh.area(*triangle as usize);
        let until = (passed / each + 0.5).min(count as f64) as usize;
        while found.len() < until {
            found.push(sample(mesh, *triangle as usize, found.len()));
        }
    }
    found
}

fn sample(mesh: &Mesh, triangle: usize, number: usize) -> Sample {
    Sample { point: in_triangle(mesh.corners(triangle), number), normal: mesh.model_normal(triangle) }
}

/// A point of a triangle: those of successive numbers are spread evenly.
pub fn in_triangle([a, b, c]: [Vector; 3], number: usize) -> Vector {
    let [u, v] = STEPS.map(|step| (0.5 + number as f64 * step).fract());
    let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
    a + u * (b - a) + v * (c - a)
}

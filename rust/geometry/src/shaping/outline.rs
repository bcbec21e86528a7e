//! The outer edges of some triangles of a mesh, as they are seen from above.

use std::collections::HashMap;

use crate::{Mesh, Vector};

type Key = [u64; 3];

/// The closed lines along which the kept triangles end on the outside, counter-clockwise as seen from above, each with the number
/// of a kept triangle beside every side (that side goes from a line's point to the next). Edges of holes are not among them.
///
/// Corners are one by what they measure: faces of a STEP part share none.
pub fn outer_edges(mesh: &Mesh, keep: &[bool]) -> Vec<Vec<(Vector, usize)>> {
    let mut lines: Vec<Vec<(Vector, usize)>> = chained(&open_sides(mesh, keep));
    lines.retain(|line| doubled_area(line) > 0.0);
    lines
}

fn key(p: Vector) -> Key {
    (p + Vector::zeros()).map(f64::to_bits).into()
}

/// The sides of kept triangles that no other kept triangle has, in the order of the triangles.
fn open_sides(mesh: &Mesh, keep: &[bool]) -> Vec<(Vector, Vector, usize)> {
    let kept = || (0..keep.len()).filter(|triangle| keep[*triangle]);
    let sides = |triangle: usize| {
        let corners = mesh.corners(triangle);
        (0..3).map(move |i| (corners[i], corners[(i + 1) % 3]))
    };
    let mut uses: HashMap<(Key, Key), u32> = HashMap::new();
    for (a, b) in kept().flat_map(sides) {
        let (a, b) = (key(a), key(b));
        *uses.entry((a.min(b), a.max(b))).or_default() += 1;
    }
    let is_open = |a: Vector, b: Vector| {
        let (a, b) = (key(a), key(b));
        uses.get(&(a.min(b), a.max(b))) == Some(&1)
    };
    let all = kept().flat_map(|triangle| sides(triangle).map(move |(a, b)| (a, b, triangle)));
    all.filter(|(a, b, _)| is_open(*a, *b)).collect()
}

/// Sides put together to closed lines; what does not close is left out.
fn chained(sides: &[(Vector, Vector, usize)]) -> Vec<Vec<(Vector, usize)>> {
    let mut from: HashMap<Key, Vec<usize>> = HashMap::new();
    for (index, (a, _, _)) in sides.iter().enumerate().rev() {
        from.entry(key(*a)).or_default().push(index);
    }
    let mut used = vec![false; sides.len()];
    let mut lines = Vec::new();
    for first in 0..sides.len() {
        let mut line = Vec::new();
        let mut next = Some(first).filter(|first| !used[*first]);
        while let Some(index) = next {
            used[index] = true;
            let (a, b, triangle) = sides[index];
            line.push((a, triangle));
            if key(b) == key(sides[first].0) {
                lines.push(std::mem::take(&mut line));
                break;
            }
            next = from.get(&key(b)).and_then(|ways| ways.iter().rev().copied().find(|way| !used[*way]));
        }
    }
    lines
}

/// Twice the area that a line encloses in plan; negative where it runs clockwise.
fn doubled_area(line: &[(Vector, usize)]) -> f64 {
    let next = line.iter().cycle().skip(1);
    line.iter().zip(next).map(|((a, _), (b, _))| a.x * b.y - b.x * a.y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plate_with_a_hole_has_one_outer_edge() {
        let at = |x: f64, y: f64| Vector::new(x, y, 0.25 * x);
        let outer = [at(0.0, 0.0), at(4.0, 0.0), at(4.0, 4.0), at(0.0, 4.0)];
        let inner = [at(1.0, 1.0), at(3.0, 1.0), at(3.0, 3.0), at(1.0, 3.0)];
        let vertices = [outer, inner].concat();
        let mut triangles = Vec::new();
        for i in 0..4_i64 {
            let j = (i + 1) % 4;
            triangles.extend([[i, j, 4 + j], [i, 4 + j, 4 + i]]);
        }
        let mesh = Mesh::new(vertices, &triangles, &[]).unwrap();
        let edges = outer_edges(&mesh, &[true; 8]);
        assert_eq!(edges.len(), 1);
        assert_eq!(edges[0].iter().map(|(point, _)| *point).collect::<Vec<_>>(), outer);
        assert!((doubled_area(&edges[0]) - 32.0).abs() < 1e-12);
        assert_eq!(outer_edges(&mesh, &[false; 8]).len(), 0);
    }
}

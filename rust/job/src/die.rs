//! Whether a sheet can be laid over the part as over a male die: nothing of what is formed may be hollow.
//!
//! A hollow is what rain would fill: the water over a point stands as high as the lowest path from there to the part's border
//! rises, and each path's height is that of its highest point (R. Barnes, C. Lehman, D. Mulla, "Priority-Flood", Computers &
//! Geosciences 62, 2014, on the edges of the triangles instead of a grid). Under water the sheet would span what the frame
//! cannot reach.

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};

use styluscam_geometry::{Mesh, Vector};
use styluscam_verify::Support;

use crate::{JobDocument, JobError, Scene};

/// Refuses operations whose faces are hollow where the process lays the sheet over a male die; `selected` by triangle, `path`
/// the operation's.
///
/// # Errors
/// How deep the hollow is, and where.
pub(crate) fn check(job: &JobDocument, scene: &Scene, selected: &[bool], path: &str) -> Result<(), JobError> {
    let support = job.process.process.as_kind().support();
    let (Support::DieAndFrame | Support::Mandrel, Some(sheet)) = (support, scene.sheet) else { return Ok(()) };
    // the sheet itself bridges what is no deeper than it is thick
    let Some(hollow) = deepest(&scene.mesh, selected).filter(|hollow| hollow.depth > sheet.thickness) else {
        return Ok(());
    };
    let [x, y, z] = hollow.at.into();
    let message = format!(
        "the selected faces are hollow: at X{x:.3} Y{y:.3} Z{z:.3} {:.3} mm deep, and a sheet over a male die or a \
         mandrel spans hollows",
        hollow.depth,
    );
    let turn = "turn the part over with setup.up, or leave the hollow's faces out of part.faces";
    let hint = match support {
        Support::DieAndFrame => format!("set die = \"female\", {turn}"),
        Support::Mandrel | Support::Rim => turn.to_owned(),
    };
    Err(JobError::document("conflict", format!("{path}.faces"), message, hint))
}

/// Where a hollow is deepest.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Hollow {
    /// mm.
    depth: f64,
    at: Vector,
}

/// The deepest position of some triangles under the lowest way out; none where all drains.
fn deepest(mesh: &Mesh, selected: &[bool]) -> Option<Hollow> {
    let water = water(mesh);
    let corners = mesh.triangles().iter().zip(selected).filter(|(_, is_selected)| **is_selected).flat_map(|(t, _)| *t);
    let hollow = |vertex: u32| {
        let at = *mesh.vertices().get(vertex as usize)?;
        let depth = water.get(&vertex)? - at.z;
        (depth > 0.0).then_some(Hollow { depth, at })
    };
    corners.filter_map(hollow).reduce(|a, b| if b.depth > a.depth { b } else { a })
}

/// How high water stands over each vertex of what does not face down.
fn water(mesh: &Mesh) -> BTreeMap<u32, f64> {
    let (neighbours, border) = upper_side(mesh);
    let height = |vertex: u32| mesh.vertices()[vertex as usize].z;
    let mut water = BTreeMap::new();
    let mut next: BinaryHeap<Reverse<Level>> =
        border.into_iter().map(|vertex| Reverse(Level { height: height(vertex), vertex })).collect();
    while let Some(Reverse(Level { height: level, vertex })) = next.pop() {
        if water.contains_key(&vertex) {
            continue;
        }
        water.insert(vertex, level);
        for other in neighbours.get(&vertex).into_iter().flatten().filter(|other| !water.contains_key(other)) {
            next.push(Reverse(Level { height: level.max(height(*other)), vertex: *other }));
        }
    }
    water
}

/// The edges of the triangles that do not face down: the neighbours of each vertex, and the vertices on the border.
fn upper_side(mesh: &Mesh) -> (BTreeMap<u32, Vec<u32>>, Vec<u32>) {
    let mut sides: Vec<[u32; 2]> = Vec::new();
    for (triangle, [a, b, c]) in mesh.triangles().iter().enumerate() {
        if !mesh.looks_down(triangle) {
            sides.extend([[a, b], [b, c], [c, a]].map(|[i, j]| [*i.min(j), *i.max(j)]));
        }
    }
    sides.sort_unstable();
    let mut neighbours: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut border = Vec::new();
    for run in sides.chunk_by(|a, b| a == b) {
        let [i, j] = run[0];
        neighbours.entry(i).or_default().push(j);
        neighbours.entry(j).or_default().push(i);
        if run.len() == 1 {
            border.extend([i, j]);
        }
    }
    (neighbours, border)
}

/// A vertex and how high water stands over it; in the order of the heights.
#[derive(Clone, Copy)]
struct Level {
    height: f64,
    vertex: u32,
}

impl Ord for Level {
    fn cmp(&self, other: &Self) -> Ordering {
        self.height.total_cmp(&other.height).then(self.vertex.cmp(&other.vertex))
    }
}

impl PartialOrd for Level {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Level {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Level {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Square rings about the origin, by half side and height, and a floor within the last.
    fn rings(rings: &[(f64, f64)]) -> Mesh {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let vertices = rings.iter().flat_map(|(half, z)| corners.map(|(x, y)| Vector::new(x * half, y * half, *z)));
        let side = |ring: i64, i: i64| {
            let (a, b) = (4 * ring + i, 4 * ring + (i + 1) % 4);
            [[a, b, b + 4], [a, b + 4, a + 4]]
        };
        let count = rings.len() as i64;
        let walls = (0..count - 1).flat_map(|ring| (0..4).flat_map(move |i| side(ring, i)));
        let last = 4 * (count - 1);
        let triangles: Vec<[i64; 3]> = walls.chain([[last, last + 1, last + 2], [last, last + 2, last + 3]]).collect();
        Mesh::new(vertices.collect(), &triangles, &[]).unwrap()
    }

    fn depth(mesh: &Mesh) -> Option<f64> {
        deepest(mesh, &vec![true; mesh.triangles().len()]).map(|hollow| hollow.depth)
    }

    #[test]
    fn a_hill_drains_and_a_pit_in_its_top_does_not() {
        assert_eq!(depth(&rings(&[(20.0, -9.0), (15.0, -9.0), (5.0, 0.0)])), None);
        assert_eq!(depth(&rings(&[(20.0, 0.0), (15.0, 0.0), (5.0, -9.0)])), Some(9.0));
        assert_eq!(depth(&rings(&[(20.0, -9.0), (15.0, 0.0), (10.0, 0.0), (5.0, -2.5)])), Some(2.5));
    }

    #[test]
    fn only_what_is_selected_counts() {
        let mesh = rings(&[(20.0, -9.0), (15.0, 0.0), (10.0, 0.0), (5.0, -2.5)]);
        let outside: Vec<bool> = (0..mesh.triangles().len()).map(|triangle| triangle < 16).collect();
        assert_eq!(deepest(&mesh, &outside), None);
    }
}

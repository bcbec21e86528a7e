//! Which triangles a selection means, and what the model's faces look like to the tool.

use std::collections::{BTreeMap, HashMap, HashSet};

use styluscam_geometry::{Mesh, Vector};

use crate::selection::face_number;
use crate::{JobError, Selection};

/// Normals whose Z is above this face up; a wall of 89.9 degrees still does.
pub(crate) const UP: f64 = 1e-3;

/// Share of a face that may face down and is no undercut: triangles of an upright side lean by their deviation.
const LEAST_UNDERCUT: f64 = 5e-3;

/// A face of the model as its triangles show it in work coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceView {
    /// Area, mm^2.
    pub area: f64,
    /// Area that faces up, mm^2.
    pub up: f64,
    /// Area that faces down, mm^2.
    pub down: f64,
    /// Area of upright walls, which do neither, mm^2.
    pub upright: f64,
    /// Area where the part was cut off, mm^2: upright beside what faces down.
    pub rim: f64,
    /// Largest slope, rad.
    pub steepest: f64,
    /// Whether the part is nothing but triangles: its faces were found, not made by its designer.
    pub is_found: bool,
    /// What the face is called beside its number, where it was added to the part.
    pub name: Option<&'static str>,
}

/// All faces by number; `rims` are those of [`rims`].
pub fn views(mesh: &Mesh, rims: &[bool]) -> BTreeMap<u32, FaceView> {
    let mut views: BTreeMap<u32, FaceView> = BTreeMap::new();
    for (t, face) in mesh.faces().iter().enumerate() {
        let (normal, area) = (mesh.normal(t), mesh.area(t));
        let view = views.entry(*face).or_default();
        view.area += area;
        view.is_found = !mesh.has_corner_normals();
        view.up += if normal.z > UP { area } else { 0.0 };
        view.down += if mesh.looks_down(t) { area } else { 0.0 };
        view.upright += if normal.z <= UP && !mesh.looks_down(t) { area } else { 0.0 };
        view.rim += if rims[t] { area } else { 0.0 };
        view.steepest = view.steepest.max(libm::atan2(libm::hypot(normal.x, normal.y), normal.z));
    }
    views
}

/// Walls go on in one another where their normals are nearer than 30 degrees, by their cosine.
const CREASE: f64 = 0.866;

/// Which triangles stand upright and share a side with one that faces down, and the upright ones that go on from them without a crease: of a
/// sheet, these are its cut edges.
pub fn rims(mesh: &Mesh) -> Vec<bool> {
    // corners by what they measure: faces of a STEP part share none
    let key = |p: Vector| <[u64; 3]>::from((p + Vector::zeros()).map(f64::to_bits));
    let corners = |t: usize| mesh.corners(t).map(key);
    let sides = |t: usize| {
        let corners = corners(t);
        (0..3).map(move |i| (corners[i].min(corners[(i + 1) % 3]), corners[i].max(corners[(i + 1) % 3])))
    };
    let count = mesh.triangles().len();
    let under: HashSet<_> = (0..count).filter(|t| mesh.looks_down(*t)).flat_map(sides).collect();
    let upright: Vec<usize> = (0..count).filter(|t| mesh.is_upright(*t)).collect();
    let mut beside: HashMap<_, Vec<usize>> = HashMap::new();
    upright.iter().for_each(|t| sides(*t).for_each(|side| beside.entry(side).or_default().push(*t)));
    let mut rims = vec![false; count];
    let mut open: Vec<usize> = upright.into_iter().filter(|t| sides(*t).any(|side| under.contains(&side))).collect();
    while let Some(triangle) = open.pop() {
        if !std::mem::replace(&mut rims[triangle], true) {
            let goes_on = |other: &&usize| mesh.normal(**other).dot(&mesh.normal(triangle)) > CREASE;
            open.extend(sides(triangle).filter_map(|side| beside.get(&side)).flatten().filter(goes_on));
        }
    }
    rims
}

/// How faces look that "all" means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Those that face up.
    Up,
    /// As [`Up`](Self::Up); of a mesh upright walls too, but for those where a sheet was cut off.
    UpButRims,
    /// Upright walls too.
    UpOrAside,
}

/// The faces that a selection means, in order of their numbers.
///
/// # Errors
/// A name that no face has, a face with nothing to form, an undercut that was not allowed.
pub fn chosen(
    selection: &Selection,
    views: &BTreeMap<u32, FaceView>,
    all: Look,
    allow_undercuts: bool,
    path: &str,
) -> Result<Vec<u32>, JobError> {
    match selection {
        Selection::All => {
            // a mesh is meant whole: that its walls are faces of their own changes no job
            let aside = |view: &FaceView| match all {
                Look::Up => view.is_found && view.upright > 0.0,
                Look::UpButRims => view.is_found && view.upright > 0.0 && view.rim == 0.0,
                Look::UpOrAside => view.upright > 0.0,
            };
            let looks = |view: &FaceView| view.up > 0.0 || aside(view);
            let up: Vec<u32> = views.iter().filter(|(_, view)| looks(view)).map(|(n, _)| *n).collect();
            if up.is_empty() {
                return Err(JobError::document(
                    "nothing-up",
                    path,
                    "no face of the part faces up",
                    "turn the part with setup.up, or check that its triangles are not inside out",
                ));
            }
            Ok(up)
        }
        Selection::Named(names) => {
            let mut faces = names
                .iter()
                .enumerate()
                .map(|(i, name)| named(name, views, allow_undercuts, &format!("{path}[{i}]")))
                .collect::<Result<Vec<u32>, JobError>>()?;
            faces.sort_unstable();
            faces.dedup();
            Ok(faces)
        }
    }
}

fn named(name: &str, views: &BTreeMap<u32, FaceView>, allow_undercuts: bool, path: &str) -> Result<u32, JobError> {
    let added = || views.iter().find(|(_, view)| view.name == Some(name)).map(|(number, _)| *number);
    let number = face_number(name).or_else(added);
    let Some((number, view)) = number.and_then(|n| views.get(&n).map(|v| (n, v))) else {
        return Err(JobError::document(
            "no-such-face",
            path,
            format!("the part has no face {name:?}"),
            format!("it has {}; see `styluscam part show`", listed(views)),
        ));
    };
    if view.down > LEAST_UNDERCUT * view.area && !allow_undercuts {
        let share = 100.0 * view.down / view.area;
        return Err(JobError::document(
            "undercut",
            path,
            format!("Face{number} faces down on {share:.1} % of its area: no vertical tool reaches that"),
            "turn the part with setup.up, choose other faces, or set part.allow_undercuts = true",
        ));
    }
    Ok(number)
}

/// "Face1 to Face9", or the names one by one where some are missing.
fn listed(views: &BTreeMap<u32, FaceView>) -> String {
    match (views.first_key_value(), views.last_key_value()) {
        (Some((first, _)), Some((last, _))) if (last - first) as usize + 1 == views.len() && first != last => {
            format!("Face{first} to Face{last}")
        }
        _ => views.keys().map(|n| format!("Face{n}")).collect::<Vec<_>>().join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_edge_in_two_strips_is_a_rim_and_the_wall_beside_it_is_none() {
        // under a front of two strips lies what faces down; the wall around the corner meets it nowhere
        let at = |x: f64, y: f64, z: f64| Vector::new(x, y, z);
        let vertices = vec![
            at(0.0, 0.0, 0.0),
            at(9.0, 0.0, 0.0),
            at(9.0, 0.0, 0.5),
            at(0.0, 0.0, 0.5),
            at(9.0, 0.0, 1.0),
            at(0.0, 0.0, 1.0),
            at(4.0, 5.0, 0.0),
            at(9.0, 5.0, 1.0),
            at(9.0, 5.0, 0.5),
        ];
        let front = [[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]];
        let others = [[0, 6, 1], [2, 8, 7], [2, 7, 4]];
        let triangles: Vec<[i64; 3]> = front.into_iter().chain(others).collect();
        let mesh = Mesh::new(vertices, &triangles, &[]).unwrap();
        assert_eq!(rims(&mesh), [true, true, true, true, false, false, false]);
    }

    #[test]
    fn a_wall_that_meets_what_looks_down_in_a_corner_only_is_no_rim() {
        let at = |x: f64, y: f64, z: f64| Vector::new(x, y, z);
        let vertices =
            vec![at(0.0, 0.0, 0.0), at(9.0, 0.0, 0.0), at(9.0, 0.0, 5.0), at(-4.0, 0.0, 0.0), at(-4.0, 5.0, 0.0)];
        let mesh = Mesh::new(vertices, &[[0, 1, 2], [0, 3, 4]], &[]).unwrap();
        assert!(mesh.is_upright(0) && mesh.looks_down(1));
        assert_eq!(rims(&mesh), [false, false]);
    }
}

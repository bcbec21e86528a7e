//! The faces as a tool sees them from above: how they slope, and the concave radii and gaps that bound the tool's radius.
//!
//! A fillet bounds it by its radius: where the model's normals are known, by how fast they turn within a triangle; on
//! plain facets by how much neighbours turn over their width. A slot or a hole bounds it by half its width, which a
//! level ray measures from wall to wall.

use std::collections::BTreeMap;

use styluscam_geometry::{Mesh, Vector};

use super::adjacency::edges;
use super::samples::{of_triangles, Sample};
use super::Body;
use styluscam_geometry::bend as bend_of;

/// From this slope on a wall is upright, degrees.
pub const UPRIGHT_DEG: f64 = 89.0;
/// Faces that slope at most this much are floors, degrees.
const FLOOR_DEG: f64 = 1.0;
/// From this slope on levels serve a face better than rows, degrees.
const STEEP_DEG: f64 = 45.0;
/// Facets that turn more than this meet in a sharp edge: no tool is round enough for it, degrees.
const SHARP_DEG: f64 = 40.0;
/// Curvature below this is none, 1/mm.
const STRAIGHT: f64 = 1e-4;
/// Of two facets of different width only those belong to the fillet that are not wider than this times the other.
const BESIDE: f64 = 2.0;
/// Points on each face, at least and at most, and on all of them about.
const SAMPLES: [usize; 3] = [4, 24, 6000];
/// Radius of the tool that a gap has room for, as a share of its width.
const ROOM: f64 = 0.45;
/// A hole's width is twice its radius within this share.
const ROUND: f64 = 0.15;
/// Most that a concave radius may differ between the narrowest and the widest tenth of a hole's wall.
const EVEN: f64 = 0.3;

/// A face as it is seen from above.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceLook {
    /// Its number.
    pub face: u32,
    /// Area, mm^2.
    pub area: f64,
    /// Share of the area that a tool from above could see.
    pub seen: f64,
    /// Share that faces up and is flat.
    pub flat: f64,
    /// Share that slopes, up to 45 degrees.
    pub gentle: f64,
    /// Share from there to the vertical, walls included.
    pub steep: f64,
    /// Share of walls that are as good as vertical; part of `steep`.
    pub vertical: f64,
    /// Whether a job that names the face must allow undercuts.
    pub looks_down: bool,
    /// Lowest and highest point, mm.
    pub heights: [f64; 2],
    /// Largest radius of a tool that fits, mm, and for how much area, mm^2; only what bounds it.
    pub bounds: Vec<(f64, f64)>,
    /// Diameter of the round upright hole that the face is the wall of, mm.
    pub hole: Option<f64>,
}

impl FaceLook {
    /// Area that a tool from above could see, mm^2.
    #[must_use]
    pub fn seen_area(&self) -> f64 {
        self.seen * self.area
    }
}

/// All faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Hollows {
    /// By number.
    pub faces: Vec<FaceLook>,
    /// Length of sharp concave edges that can be seen from above, mm.
    pub sharp: f64,
}

impl Hollows {
    /// The radius below which a tool must lie to fit all but a `share` of the seen area of some faces, mm.
    #[must_use]
    pub fn bound<'f>(faces: impl IntoIterator<Item = &'f FaceLook>, share: f64) -> Option<f64> {
        let (mut all, mut whole) = (Vec::new(), 0.0);
        for face in faces {
            whole += face.seen_area();
            all.extend(face.bounds.iter().map(|(radius, area)| (*radius, area * face.seen)));
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut passed = 0.0;
        all.into_iter()
            .find(|(_, area)| {
                passed += area;
                passed > share * whole
            })?
            .0
            .into()
    }
}

impl Body<'_> {
    /// The faces as seen from above, with the concave radii and the gaps that bound a tool.
    #[must_use]
    pub fn hollows(&self) -> Hollows {
        let mesh = self.mesh();
        let (radii, sharp) = concave(mesh);
        let mut by_face: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (triangle, face) in mesh.faces().iter().enumerate() {
            by_face.entry(*face).or_default().push(triangle as u32);
        }
        let [least, most, all] = SAMPLES;
        let count = (all / by_face.len().max(1)).clamp(least, most);
        let faces = by_face.iter().map(|(face, triangles)| look(self, *face, triangles, &radii, count)).collect();
        Hollows { faces, sharp }
    }

    /// From a steep point level across to what stands opposite, mm.
    pub(super) fn gap(&self, sample: &Sample) -> Option<f64> {
        let level = Vector::new(sample.normal.x, sample.normal.y, 0.0);
        if level.norm() < libm::sin(STEEP_DEG.to_radians()) {
            return None;
        }
        let hit = self.rays.first(sample.point, level.normalize(), 10.0 * self.fine(), |hit| hit.along < 0.0)?;
        Some(hit.distance)
    }
}

fn look(body: &Body<'_>, face: u32, triangles: &[u32], radii: &[f64], count: usize) -> FaceLook {
    let mesh = body.mesh();
    let mut look = FaceLook {
        face,
        area: 0.0,
        seen: 0.0,
        flat: 0.0,
        gentle: 0.0,
        steep: 0.0,
        vertical: 0.0,
        looks_down: false,
        heights: [f64::INFINITY, f64::NEG_INFINITY],
        bounds: Vec::new(),
        hole: None,
    };
    for triangle in triangles.iter().map(|t| *t as usize) {
        let (area, normal) = (mesh.area(triangle), mesh.model_normal(triangle));
        let slope = libm::acos(normal.z.clamp(-1.0, 1.0)).to_degrees();
        look.area += area;
        look.flat += if slope <= FLOOR_DEG { area } else { 0.0 };
        look.gentle += if slope > FLOOR_DEG && slope <= STEEP_DEG { area } else { 0.0 };
        look.steep += if slope > STEEP_DEG && slope <= 180.0 - UPRIGHT_DEG { area } else { 0.0 };
        look.vertical += if (UPRIGHT_DEG..=180.0 - UPRIGHT_DEG).contains(&slope) { area } else { 0.0 };
        look.looks_down |= mesh.looks_down(triangle);
        if radii[triangle].is_finite() && slope <= 180.0 - UPRIGHT_DEG {
            look.bounds.push((radii[triangle], area));
        }
        for z in mesh.corners(triangle).map(|corner| corner.z) {
            look.heights = [look.heights[0].min(z), look.heights[1].max(z)];
        }
    }
    let samples = of_triangles(mesh, triangles, count);
    let seen: Vec<&Sample> = samples.iter().filter(|sample| body.is_seen(sample, Vector::z())).collect();
    look.seen = seen.len() as f64 / samples.len().max(1) as f64;
    let gaps: Vec<f64> = seen.iter().filter_map(|sample| body.gap(sample)).collect();
    look.hole = hole(&look, &gaps);
    let each = look.area / samples.len().max(1) as f64;
    look.bounds.extend(gaps.iter().map(|gap| (ROOM * gap, each)));
    for share in [&mut look.flat, &mut look.gentle, &mut look.steep, &mut look.vertical] {
        *share /= look.area;
    }
    look
}

/// The diameter, where a face is an upright wall, concave all over with one radius, as wide as that is.
fn hole(look: &FaceLook, gaps: &[f64]) -> Option<f64> {
    let bounded: f64 = look.bounds.iter().map(|(_, area)| area).sum();
    if look.vertical < 0.98 * look.area || bounded < 0.95 * look.area || gaps.is_empty() {
        return None;
    }
    let mut radii: Vec<f64> = look.bounds.iter().map(|(radius, _)| *radius).collect();
    radii.sort_by(f64::total_cmp);
    let mut gaps = gaps.to_vec();
    gaps.sort_by(f64::total_cmp);
    let at = |all: &[f64], tenths: usize| all[(all.len() - 1) * tenths / 10];
    let (radius, width) = (at(&radii, 5), at(&gaps, 5));
    let even = at(&radii, 9) - at(&radii, 1) <= EVEN * radius;
    (even && (width - 2.0 * radius).abs() <= ROUND * width).then_some(width)
}

/// The smallest concave radius of each triangle, mm (infinite: none), and the length of sharp concave edges, mm.
fn concave(mesh: &Mesh) -> (Vec<f64>, f64) {
    let mut radii: Vec<f64> = (0..mesh.triangles().len()).map(|triangle| within(mesh, triangle)).collect();
    let mut sharp = 0.0;
    for edge in edges(mesh) {
        let [a, b] = edge.triangles.map(|t| t as usize);
        let [from, to] = edge.ends.map(|v| mesh.vertices()[v as usize]);
        let (na, nb) = (at_edge(mesh, a, edge.ends), at_edge(mesh, b, edge.ends));
        let turn = libm::atan2(na.cross(&nb).norm(), na.dot(&nb));
        let beyond = mesh.corners(b).iter().sum::<Vector>() / 3.0 - 0.5 * (from + to);
        if beyond.dot(&na) <= 0.0 || turn < STRAIGHT {
            continue;
        }
        let length = (to - from).norm();
        if turn > SHARP_DEG.to_radians() {
            let up = na.z > -STRAIGHT && nb.z > -STRAIGHT;
            sharp += if up { length } else { 0.0 };
            continue;
        }
        let widths = [a, b].map(|t| 2.0 * mesh.area(t) / length);
        // an arc's facets turn by half of both their widths over its radius; a plane beside it gives none of the turn
        let reach = BESIDE * widths[0].min(widths[1]);
        let on_arc: f64 = widths.iter().filter(|width| **width <= reach).sum();
        for (triangle, _) in [a, b].into_iter().zip(widths).filter(|(_, width)| *width <= reach) {
            radii[triangle] = radii[triangle].min(0.5 * on_arc / turn);
        }
    }
    (radii, sharp)
}

/// The model's normal beside an edge, as one of its triangles has it.
fn at_edge(mesh: &Mesh, triangle: usize, ends: [u32; 2]) -> Vector {
    let normals = mesh.corner_normals(triangle);
    let corners = mesh.triangles()[triangle].iter().zip(normals);
    corners.filter(|(corner, _)| ends.contains(corner)).map(|(_, normal)| normal).sum::<Vector>().normalize()
}

/// The smallest concave radius within a triangle, by how its corners' normals lean to each other.
fn within(mesh: &Mesh, triangle: usize) -> f64 {
    if !mesh.has_corner_normals() {
        return f64::INFINITY;
    }
    let (corners, normals) = (mesh.corners(triangle), mesh.corner_normals(triangle));
    let bend = |i: usize, j: usize| {
        let along = corners[j] - corners[i];
        -(normals[j] - normals[i]).dot(&along) / along.norm_squared()
    };
    // no edge need run along the hollow: what they say together does
    let (hollow, _) = bend_of(&corners, &normals, mesh.model_normal(triangle)).most_hollow();
    let most = bend(0, 1).max(bend(1, 2)).max(bend(2, 0)).max(-hollow);
    if most > STRAIGHT {
        1.0 / most
    } else {
        f64::INFINITY
    }
}

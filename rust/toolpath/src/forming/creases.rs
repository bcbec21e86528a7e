//! How far apart passes may lie where two faces meet in a crease. In a hollow one the tool, touching both, stands lower than
//! between two passes beside it, and so more is left there than on either face; over a convex one it rolls from one to the other.

use std::collections::HashMap;

use nalgebra::Matrix3;
use rayon::prelude::*;
use styluscam_geometry::{Bend, Vector};

use super::spread::{Ridge, Spread};
use super::steps::Allowed;
use crate::Surface;

/// Cosine of the angle up to which two faces go over into each other smoothly: 1 degree.
const SMOOTH: f64 = 0.999_847_7;
/// Determinant below which two faces and their edge have no one point in common: 1 degree apart, and more.
const SOUND: f64 = 1e-3;

/// The creases between selected faces, and the borders of these.
pub fn creases(surface: &Surface<'_>) -> Vec<Crease> {
    let (envelope, mesh) = (surface.envelope(), surface.envelope().mesh());
    let mut selected = vec![false; mesh.triangles().len()];
    surface.triangles().for_each(|triangle| selected[triangle] = true);
    let of_triangle = |triangle: usize| {
        let beyond = envelope.neighbours(triangle as u32).into_iter().enumerate();
        let beyond = beyond.map(|(side, other)| (side, other as usize));
        let crease = beyond.filter_map(|(side, other)| match selected.get(other) {
            Some(true) if other > triangle => Crease::between(surface, [triangle, other], side),
            Some(true) => None,
            Some(false) | None => Crease::at_border(surface, triangle, side),
        });
        crease.collect::<Vec<_>>()
    };
    surface.triangles().collect::<Vec<_>>().into_par_iter().flat_map_iter(of_triangle).collect()
}

/// The heights of the tip, mm, at vertices of the mesh on hollow level creases: that of the tool that touches both faces, the highest
/// where creases meet.
pub fn tips_at_vertices(creases: &[Crease]) -> HashMap<u32, f64> {
    let mut heights: HashMap<u32, f64> = HashMap::new();
    for crease in creases {
        let Tips::Hollow { vertices, tips } = crease.tips else { continue };
        if !Spread::Levels.runs_along(tips[1] - tips[0]) {
            continue;
        }
        for (vertex, tip) in vertices.into_iter().zip(tips) {
            heights.entry(vertex).and_modify(|height| *height = height.max(tip.z)).or_insert(tip.z);
        }
    }
    heights
}

/// An edge along which two faces meet.
pub struct Crease {
    /// The unit normals of both faces at it.
    normals: [Vector; 2],
    /// Where the tool's tips are beside either end.
    tips: Tips,
}

/// Tips of the tool at a crease.
enum Tips {
    /// It touches both faces, beside either end.
    Hollow {
        /// The vertices of the mesh at the ends.
        vertices: [u32; 2],
        tips: [Vector; 2],
    },
    /// It touches either face, at either end, and rolls from one to the other.
    Convex([Vector; 4]),
}

impl Tips {
    /// Of a tool that rolls over an edge from touching planes of one normal to those of another.
    fn rolling(surface: &Surface<'_>, ends: [Vector; 2], normals: [Vector; 2]) -> Self {
        let [first, second] = normals.map(|normal| surface.envelope().touching_point(Vector::zeros(), normal));
        Self::Convex([ends[0] - first, ends[1] - first, ends[0] - second, ends[1] - second])
    }
}

impl Crease {
    /// The edge of the first triangle from the corner `side` to the next, if it is no smooth join.
    fn between(surface: &Surface<'_>, [triangle, other]: [usize; 2], side: usize) -> Option<Self> {
        let mesh = surface.envelope().mesh();
        let (corners, next) = (mesh.corners(triangle), (side + 1) % 3);
        let ends = [corners[side], corners[next]];
        let own = mesh.corner_normals(triangle);
        let (others, theirs) = (mesh.corners(other), mesh.corner_normals(other));
        let at = |end: Vector| {
            let nearest = (0..3).min_by(|a, b| (others[*a] - end).norm().total_cmp(&(others[*b] - end).norm()));
            theirs[nearest.unwrap_or(0)]
        };
        let normals = [own[side] + own[next], at(ends[0]) + at(ends[1])].map(|sum| sum.normalize());
        if normals[0].dot(&normals[1]) >= SMOOTH {
            return None;
        }
        let farthest = others.into_iter().map(|corner| (corner - ends[0]).dot(&mesh.normal(triangle)));
        let tips = if farthest.fold(0.0, f64::max) > 0.0 {
            let vertices = [side, next].map(|corner| mesh.triangles()[triangle][corner]);
            Tips::Hollow { vertices, tips: tips(surface, ends, normals)? }
        } else {
            Tips::rolling(surface, ends, normals)
        };
        Some(Self { normals, tips })
    }

    /// The border of a triangle from the corner `side` to the next: the tool rolls over it until its side is upright there.
    fn at_border(surface: &Surface<'_>, triangle: usize, side: usize) -> Option<Self> {
        let mesh = surface.envelope().mesh();
        let (corners, next) = (mesh.corners(triangle), (side + 1) % 3);
        let (ends, normal) = ([corners[side], corners[next]], mesh.normal(triangle));
        let outward = (ends[1] - ends[0]).cross(&normal);
        let outward = Vector::new(outward.x, outward.y, 0.0).try_normalize(0.0)?;
        Some(Self { normals: [normal; 2], tips: Tips::rolling(surface, ends, [normal, outward]) })
    }

    /// What it allows around the positions of the tool that touches both faces, for a ridge; none where passes do
    /// not cross it.
    pub fn allowed(&self, spread: Spread, ridge: &Ridge) -> Option<Allowed> {
        if !self.normals.iter().all(|normal| spread.crosses(*normal) && normal.z > 0.0) {
            return None;
        }
        if matches!(&self.tips, Tips::Hollow { tips, .. } if !spread.runs_along(tips[1] - tips[0])) {
            return None;
        }
        let on_faces = self.normals.map(|normal| spread.step(normal, &Bend::default(), ridge));
        let values = |tips: &[Vector]| {
            let values = tips.iter().map(|tip| spread.value(*tip));
            [values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max)]
        };
        match &self.tips {
            Tips::Convex(tips) => {
                let step = on_faces[0].0.min(on_faces[1].0);
                Some(Allowed { values: values(tips), step, cosines: None })
            }
            Tips::Hollow { tips, .. } => {
                let [first, second] = self.normals.map(|normal| spread.section_slope(normal));
                // half the chord rises as the kink does, and the section over it by its square
                let steep = libm::tan(0.5 * (first - second).abs()) / (4.0 * ridge.height);
                let travel = on_faces.map(|(step, rate)| step / rate).into_iter().fold(f64::INFINITY, f64::min);
                let chord = (steep + libm::sqrt(steep * steep + travel.recip() * travel.recip())).recip();
                let step = chord * on_faces[0].1.min(on_faces[1].1);
                let [low, high] = values(tips);
                (step < travel).then_some(Allowed { values: [low - step, high + step], step, cosines: None })
            }
        }
    }
}

/// The tips of the tool that touches two faces, given by their normals, beside either end of their edge; none where they are too
/// much alike.
fn tips(surface: &Surface<'_>, ends: [Vector; 2], normals: [Vector; 2]) -> Option<[Vector; 2]> {
    let along = (ends[1] - ends[0]).try_normalize(0.0)?;
    let rows = Matrix3::from_rows(&[normals[0].transpose(), normals[1].transpose(), along.transpose()]);
    let inverse = rows.try_inverse().filter(|_| rows.determinant().abs() >= SOUND)?;
    let touching = |normal: Vector| surface.envelope().touching_point(Vector::zeros(), normal).dot(&normal);
    let off = Vector::new(touching(normals[0]), touching(normals[1]), 0.0);
    Some(ends.map(|end| end - inverse * off))
}

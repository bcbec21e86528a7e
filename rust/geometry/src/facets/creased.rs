//! Triangles for drawing: a unit normal at every vertex, smooth where the surface is and two where it has an edge.

use std::collections::{BTreeMap, HashMap};

use super::{sides, Facets};
use crate::{Frame, Vector};

/// Cosine of the angle between neighbours up to which their normals are one: 0.5 rad.
const CREASE: f64 = 0.877_582_561_890_373;
/// Cosine of the angle between neighbours from which on their common side is an edge: 43 degrees, more than between the triangles
/// of a narrow fillet.
const EDGE: f64 = 0.731;
/// Normals that agree this well are one.
const SAME: f64 = 1e-6;

/// Triangles with normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Creased {
    /// Vertices, mm: one for each normal that a point has.
    pub vertices: Vec<Vector>,
    /// The point of the surface that each vertex is, by its number.
    pub points: Vec<u32>,
    /// Unit normals of the vertices, outward.
    pub normals: Vec<Vector>,
    /// Numbers of their vertices, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Edges: sides at which the surface ends, or turns by more than 43 degrees; each by the numbers of two vertices.
    pub edges: Vec<[u32; 2]>,
}

impl Facets {
    /// With normals; triangles without area are left out.
    #[must_use]
    pub fn creased(&self) -> Creased {
        let mut around: Vec<Vec<(usize, Vector, f64)>> = vec![Vec::new(); self.points.len()];
        self.at_corners(|triangle, point, normal, angle| around[point as usize].push((triangle, normal, angle)));
        let mut drawn = Creased::default();
        let mut corners: HashMap<(usize, u32), u32> = HashMap::new();
        for (point, around) in around.iter().enumerate() {
            let first = drawn.vertices.len();
            for (triangle, normal, _) in around {
                let near = around.iter().filter(|(_, other, _)| other.dot(normal) >= CREASE);
                let sum: Vector = near.map(|(_, other, angle)| other * *angle).sum();
                let smooth = sum.try_normalize(0.0).unwrap_or(*normal);
                let known = (first..drawn.normals.len()).find(|i| (drawn.normals[*i] - smooth).amax() < SAME);
                let number = known.unwrap_or_else(|| {
                    drawn.vertices.push(self.points[point]);
                    drawn.points.push(point as u32);
                    drawn.normals.push(smooth);
                    drawn.normals.len() - 1
                });
                corners.insert((*triangle, point as u32), number as u32);
            }
        }
        let vertex = |triangle: usize, point: u32| corners.get(&(triangle, point)).copied();
        let numbered = |(number, [a, b, c]): (usize, &[u32; 3])| {
            Some([vertex(number, *a)?, vertex(number, *b)?, vertex(number, *c)?])
        };
        drawn.triangles = self.triangles.iter().enumerate().filter_map(numbered).collect();
        let edges = self.edges().into_iter();
        drawn.edges = edges.filter_map(|(t, [a, b])| Some([vertex(t, a)?, vertex(t, b)?])).collect();
        drawn
    }

    /// The sides at which the surface ends or turns, each with a triangle that has it; in the order of their points.
    fn edges(&self) -> Vec<(usize, [u32; 2])> {
        let mut beside: BTreeMap<[u32; 2], Vec<(usize, Vector)>> = BTreeMap::new();
        for (number, triangle) in self.triangles.iter().enumerate() {
            let Some(normal) = self.doubled(triangle).try_normalize(0.0) else { continue };
            for [a, b] in sides(*triangle) {
                beside.entry([a.min(b), a.max(b)]).or_default().push((number, normal));
            }
        }
        let is_edge = |beside: &[(usize, Vector)]| match beside {
            [(_, one), (_, other)] => one.dot(other) < EDGE,
            _ => true, // an end, or several sheets that meet
        };
        let edges = beside.into_iter().filter(|(_, beside)| is_edge(beside));
        edges.filter_map(|(side, beside)| Some((beside.first()?.0, side))).collect()
    }
}

impl Creased {
    /// The same in another frame.
    #[must_use]
    pub fn placed(self, frame: &Frame) -> Self {
        Self {
            vertices: self.vertices.iter().map(|p| frame.point(*p)).collect(),
            normals: self.normals.iter().map(|n| frame.direction(*n)).collect(),
            ..self
        }
    }
}

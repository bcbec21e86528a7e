//! A face's edges in its surface's parameters.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::chart::Chart;
use crate::{ElementarySurface, Vector};

/// At so many places, evenly along an edge, its parameters on the face must be given.
pub const GUIDES: usize = 5;

/// A point nearer to the axis than this (mm, per mm of its distance from the origin) is a pole.
const POLE: f64 = 1e-10;

/// Points this near to each other, mm, are at one position.
const ALIKE: f64 = 1e-9;

/// Points at one position whose layouts are nearer than this part of the lattice's side are one.
const SAME: f64 = 1e-3;

/// An edge as a face uses it; a seam is used twice.
#[derive(Clone, Copy, Debug)]
pub struct EdgeUse<'a> {
    /// Points along the edge, mm: the corners that the neighbour gets as well.
    pub points: &'a [Vector],
    /// Where each stands between the edge's ends, 0 to 1 in the curve's parameter.
    pub fractions: &'a [f64],
    /// The edge in the face's parameters, at even fractions: it states on which turn about the axis each point lies, and
    /// the angle at a pole. Only as exact as that needs.
    pub guides: [[f64; 2]; GUIDES],
}

/// Points with their parameters, and the segments between them.
pub struct LaidOut {
    points: Vec<Vector>,
    parameters: Vec<[f64; 2]>,
    segments: Vec<[u32; 2]>,
}

/// The border in the plane, points that are the same merged.
pub struct FlatBorder {
    /// In space, mm.
    pub points: Vec<Vector>,
    /// In the plane.
    pub flat: Vec<[f64; 2]>,
    /// Between points by index; one that the border runs twice is there twice.
    pub segments: Vec<[u32; 2]>,
    /// Least and greatest of the second parameter.
    pub range: [f64; 2],
}

/// The edges' points in the surface's parameters, each on the turn that its edge's guides state.
pub fn laid_out(surface: &ElementarySurface, edges: &[EdgeUse<'_>]) -> LaidOut {
    let mut found = LaidOut { points: Vec::new(), parameters: Vec::new(), segments: Vec::new() };
    for edge in edges {
        for (i, (point, fraction)) in edge.points.iter().zip(edge.fractions).enumerate() {
            let next = found.points.len() as u32;
            if i > 0 {
                found.segments.push([next - 1, next]);
            }
            found.points.push(*point);
            found.parameters.push(beside(surface, *point, guided(&edge.guides, *fraction)));
        }
    }
    found
}

/// The guides' line at a fraction of its length.
fn guided(guides: &[[f64; 2]; GUIDES], fraction: f64) -> [f64; 2] {
    let along = (fraction.clamp(0.0, 1.0) * (GUIDES - 1) as f64).min((GUIDES - 1) as f64);
    let before = (along as usize).min(GUIDES - 2);
    let share = along - before as f64;
    [0, 1].map(|k| guides[before][k] + share * (guides[before + 1][k] - guides[before][k]))
}

/// A point's parameters, on the turn nearest to the guide; on a pole at the guide's angle.
fn beside(surface: &ElementarySurface, point: Vector, guide: [f64; 2]) -> [f64; 2] {
    let mut parameters = surface.parameters(point);
    let is_periodic = surface.is_periodic();
    let is_pole = is_periodic[0] && surface.radius_at(parameters[1]) <= POLE * (1.0 + point.norm());
    for k in 0..2 {
        if is_periodic[k] {
            parameters[k] += TAU * ((guide[k] - parameters[k]) / TAU).round();
        }
    }
    if is_pole {
        parameters[0] = guide[0];
    }
    parameters
}

impl LaidOut {
    /// Least and greatest of a parameter.
    pub fn range(&self, which: usize) -> [f64; 2] {
        let values = self.parameters.iter().map(|parameters| parameters[which]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    }

    /// Laid out in the plane; where edges meet, their points become one.
    pub fn merged(self, chart: &Chart) -> FlatBorder {
        let range = self.range(1);
        let mut merged = FlatBorder { points: Vec::new(), flat: Vec::new(), segments: Vec::new(), range };
        let mut at: HashMap<[i64; 2], Vec<u32>> = HashMap::new();
        let index: Vec<u32> = self
            .points
            .iter()
            .zip(&self.parameters)
            .map(|(point, parameters)| merged.index_of(*point, chart.flat(*parameters), &mut at))
            .collect();
        let ends = self.segments.iter().map(|segment| segment.map(|i| index[i as usize]));
        merged.segments = ends.filter(|[a, b]| a != b).collect();
        merged
    }
}

impl FlatBorder {
    /// The index of a point: of the one that is the same, or a new one.
    fn index_of(&mut self, point: Vector, flat: [f64; 2], at: &mut HashMap<[i64; 2], Vec<u32>>) -> u32 {
        let cell = flat.map(|x| (x / SAME).round() as i64);
        let near = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [cell[0] + i, cell[1] + j]));
        for known in near.filter_map(|cell| at.get(&cell)).flatten() {
            let (same, [x, y]) = (self.points[*known as usize], self.flat[*known as usize]);
            if (same - point).norm_squared() <= ALIKE * ALIKE
                && (x - flat[0]).abs() < SAME
                && (y - flat[1]).abs() < SAME
            {
                return *known;
            }
        }
        let index = self.points.len() as u32;
        self.points.push(point);
        self.flat.push(flat);
        at.entry(cell).or_default().push(index);
        index
    }
}

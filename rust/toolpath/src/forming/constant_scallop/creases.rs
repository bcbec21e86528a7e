//! Where the envelope has a hollow crease: the tool touches two faces there, and a pass runs along it.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::chains::Beside;
use super::crossing::{line_along, Crossing};
use super::distances::reached;
use super::net::{Net, Triangle};
use crate::Surface;

/// The creases as they go through the triangles of a net.
pub struct Creases<'a> {
    by_side: BTreeMap<[usize; 2], &'a Crossing>,
    /// The triangles that they cross, and the two sides of each.
    pieces: Vec<(Triangle, [[usize; 2]; 2])>,
}

impl<'a> Creases<'a> {
    pub fn of(net: &'a Net) -> Self {
        Self::of_turn(net, 0.0)
    }

    /// Those at which normals differ by an angle, rad, or more.
    pub fn of_turn(net: &'a Net, least: f64) -> Self {
        let turning = net.crossings.iter().filter(|crossing| crossing.turn() >= least);
        let by_side: BTreeMap<[usize; 2], &Crossing> = turning.map(|c| (c.side, c)).collect();
        let cells: BTreeSet<[usize; 2]> = by_side.keys().flat_map(|side| net.around(side[0])).collect();
        let mut pieces = Vec::new();
        for triangle in cells.into_iter().flat_map(|cell| net.halves(cell)) {
            let sides = [0, 1, 2].map(|i| {
                let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
                [a.min(b), a.max(b)]
            });
            let crossed: Vec<[usize; 2]> = sides.into_iter().filter(|side| by_side.contains_key(side)).collect();
            // where three meet one of them ends
            if let [first, second, ..] = crossed[..] {
                pieces.push((triangle, [first, second]));
            }
        }
        Self { by_side, pieces }
    }

    /// Their lines in plan; closed ones repeat their first point, and open ones go on up to `beyond` mm from the last node.
    pub fn lines(&self, surface: &Surface<'_>, beyond: f64) -> Vec<Vec<[f64; 2]>> {
        let chains = Beside::of(self.pieces.iter().map(|(_, sides)| *sides)).chains();
        let at = |side: &[usize; 2]| self.by_side.get(side).map(|crossing| crossing.position());
        let line =
            |chain: &Vec<[usize; 2]>| line_along(surface, &chain.iter().filter_map(at).collect::<Vec<_>>(), beyond);
        chains.par_iter().map(line).collect()
    }

    /// The nodes beside walls, with their distances: a pass runs along the foot, and `above` is the distance at its top.
    pub fn beside_walls(&self, net: &Net, above: f64) -> Vec<(usize, f64)> {
        let mut sources = Vec::new();
        for (triangle, crossings) in self.pieces().filter(|(_, crossings)| crossings.iter().all(|c| c.is_jump())) {
            let [[foot, top], [other_foot, other_top]] = crossings.map(Crossing::below_and_above);
            for node in triangle {
                let Some(station) = net.stations[node] else { continue };
                let is_below = station.tip.z < 0.5 * (foot.tip.z + top.tip.z);
                let (ends, at) = if is_below { ([foot, other_foot], 0.0) } else { ([top, other_top], above) };
                sources.push((node, reached(&net.spacing, &station, ends.map(|end| (end, at)))));
            }
        }
        sources
    }

    /// The triangles that they cross, with both crossings.
    pub fn pieces(&self) -> impl Iterator<Item = (Triangle, [&'a Crossing; 2])> + '_ {
        let piece = |(triangle, [a, b]): &(Triangle, [[usize; 2]; 2])| {
            Some((*triangle, [*self.by_side.get(a)?, *self.by_side.get(b)?]))
        };
        self.pieces.iter().filter_map(piece)
    }
}

//! The blank and what holds it. Clamp frame and backing plate are drawn as far as a band around their openings.

use styluscam_geometry::{Facets, Vector};

use super::kind::ShapeKind;
use crate::plates::{self, Plate};
use crate::{FixtureSection, Holder};

/// Width of the band, as a share of the opening's larger side.
const BAND: f64 = 0.08;
/// How far down a plate is drawn at most, as a share of the same.
const DEPTH: f64 = 0.25;

pub(super) struct Holders {
    pub blank: Facets,
    pub plates: Vec<(ShapeKind, Facets)>,
}

/// For a part with these `bounds`, of a sheet whose flat upper side was at the height `flat`, mm.
pub(super) fn of(fixture: Option<&FixtureSection>, bounds: (Vector, Vector), flat: f64, thickness: f64) -> Holders {
    let plates = fixture.map_or_else(Vec::new, |fixture| plates::held(fixture, bounds, flat, thickness));
    let outer: Vec<Vec<[f64; 2]>> = plates.iter().map(outer).collect();
    let kind = |holder: Holder| match holder {
        Holder::Clamp => ShapeKind::Clamp,
        Holder::Backing => ShapeKind::Backing,
    };
    let drawn = plates.iter().zip(&outer).map(|(plate, outer)| (kind(plate.holder), ring(plate, outer))).collect();
    Holders { blank: prism(&largest(&outer, bounds), [flat - thickness, flat]), plates: drawn }
}

/// Middle, and sides along X and Y, of the box around some points in plan.
fn measured(points: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    let ends = |axis: usize| {
        let values = points.iter().map(|point| point[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ends = [0, 1].map(ends);
    (ends.map(|(low, high)| 0.5 * (low + high)), ends.map(|(low, high)| high - low))
}

/// The outer corners of what is drawn of a plate.
fn outer(plate: &Plate) -> Vec<[f64; 2]> {
    let (middle, sides) = measured(&plate.opening);
    let grow = sides.map(|side| 1.0 + 2.0 * BAND * sides[0].max(sides[1]) / side);
    let at = |corner: &[f64; 2]| [0, 1].map(|k| middle[k] + (corner[k] - middle[k]) * grow[k]);
    plate.opening.iter().map(at).collect()
}

/// The blank's outline, counterclockwise: that of the largest plate, or the part's box where it is larger.
fn largest(outlines: &[Vec<[f64; 2]>], (low, high): (Vector, Vector)) -> Vec<[f64; 2]> {
    let box_of_part = vec![[high.x, high.y], [low.x, high.y], [low.x, low.y], [high.x, low.y]];
    let size = |outline: &[[f64; 2]]| {
        let (_, [width, height]) = measured(outline);
        width * height
    };
    let all = outlines.iter().cloned().chain([box_of_part]);
    all.max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or_default()
}

/// A convex outline between two heights.
fn prism(outline: &[[f64; 2]], [low, high]: [f64; 2]) -> Facets {
    let points = outline.iter().map(|[x, y]| Vector::new(*x, *y, high)).collect();
    let triangles = (1..outline.len().saturating_sub(1) as u32).map(|i| [0, i, i + 1]).collect();
    let top = Facets { points, triangles };
    top.body_to(&top.moved(|_| Vector::new(0.0, 0.0, low - high)))
}

/// A plate as far as it is drawn.
fn ring(plate: &Plate, outer: &[[f64; 2]]) -> Facets {
    let (_, sides) = measured(&plate.opening);
    let [foot, high] = plate.heights;
    let low = foot.max(high - DEPTH * sides[0].max(sides[1]));
    let count = outer.len() as u32;
    let points = plate.opening.iter().chain(outer).map(|[x, y]| Vector::new(*x, *y, high)).collect();
    let side = |i: u32| {
        let next = (i + 1) % count;
        [[i, count + i, count + next], [i, count + next, next]]
    };
    let top = Facets { points, triangles: (0..count).flat_map(side).collect() };
    top.body_to(&top.moved(|_| Vector::new(0.0, 0.0, low - high)))
}

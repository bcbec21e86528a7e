//! Points inside a face: what of the rows across it lies within its border, and not close to it.

use std::collections::HashMap;

use super::{border::FlatBorder, chart::Chart, fault::TrimmedFault, rows};
use crate::{ElementaryKind, ElementarySurface};

/// A point nearer to the border than this, in sides, would only make slivers.
const CLOSE: f64 = 0.3;

/// Border segments are looked at in pieces of this many sides.
const PIECE: f64 = 0.25;

/// No face of a part that fits a machine needs more points.
const MOST: usize = 5_000_000;

/// Parameters of the points inside the border.
pub fn points(surface: &ElementarySurface, chart: &Chart, border: &FlatBorder) -> Result<Vec<[f64; 2]>, TrimmedFault> {
    let rows = rows::of(chart, border.range, MOST).ok_or(TrimmedFault::TooMany(MOST))?;
    let heights: Vec<f64> = rows.iter().map(|row| chart.flat([0.0, row.v])[1]).collect();
    let crossings = crossings(&heights, border);
    let scale = chart.flat([1.0, border.range[0]])[0];
    let close = Close::to(surface, chart, border);
    let mut found = Vec::new();
    for (row, crossed) in rows.iter().zip(&crossings) {
        for span in crossed.chunks_exact(2) {
            let index = |flat: f64| flat / (scale * row.step) - row.shift;
            let [first, end] = [index(span[0]).ceil(), index(span[1])];
            let count = (end - first).max(0.0).ceil() as usize; // not a number: none
            if count.saturating_add(found.len()) > MOST {
                return Err(TrimmedFault::TooMany(MOST));
            }
            let at = (0..count).map(|i| [(first + i as f64 + row.shift) * row.step, row.v]);
            found.extend(at.filter(|at| !close.has(surface, chart, *at)));
        }
    }
    Ok(found)
}

/// Where each row at one of the ascending `heights` crosses the border, ascending.
fn crossings(heights: &[f64], border: &FlatBorder) -> Vec<Vec<f64>> {
    let mut crossings = vec![Vec::new(); heights.len()];
    for segment in &border.segments {
        let [a, b] = segment.map(|i| border.flat[i as usize]);
        let (a, b) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        let first = heights.partition_point(|height| *height < a[1]);
        let end = heights.partition_point(|height| *height < b[1]);
        for row in first..end {
            let share = (heights[row] - a[1]) / (b[1] - a[1]);
            crossings[row].push(a[0] + share * (b[0] - a[0]));
        }
    }
    crossings.iter_mut().for_each(|row| row.sort_by(f64::total_cmp));
    crossings
}

/// The border as points in cells.
struct Close {
    cells: HashMap<[i32; 3], Vec<[f64; 3]>>,
}

impl Close {
    fn to(surface: &ElementarySurface, chart: &Chart, border: &FlatBorder) -> Self {
        let mut cells: HashMap<_, Vec<_>> = HashMap::new();
        let place = |i: u32| measured(surface, chart, border.points[i as usize], border.flat[i as usize]);
        for [a, b] in border.segments.iter().map(|ends| ends.map(place)) {
            let length = (0..3).map(|k| (b[k] - a[k]) * (b[k] - a[k])).sum::<f64>().sqrt();
            let pieces = (length / PIECE).ceil().clamp(1.0, 1e6) as usize;
            for i in 0..pieces {
                let share = i as f64 / pieces as f64;
                let at = [0, 1, 2].map(|k| a[k] + share * (b[k] - a[k]));
                cells.entry(cell(at)).or_default().push(at);
            }
        }
        Self { cells }
    }

    /// Whether the border is close to a point at these parameters.
    fn has(&self, surface: &ElementarySurface, chart: &Chart, parameters: [f64; 2]) -> bool {
        let at = measured(surface, chart, surface.point(parameters), chart.flat(parameters));
        let [low, high] = [at.map(|x| x - CLOSE), at.map(|x| x + CLOSE)].map(cell);
        let square = |other: &[f64; 3]| (0..3).map(|k| (other[k] - at[k]) * (other[k] - at[k])).sum::<f64>();
        let span = |k: usize| low[k]..=high[k];
        let near = span(0).flat_map(|x| span(1).flat_map(move |y| span(2).map(move |z| [x, y, z])));
        near.filter_map(|cell| self.cells.get(&cell)).flatten().any(|other| square(other) < CLOSE * CLOSE)
    }
}

/// A position in which the lattice's side is 1. A sphere's sides differ on the map: there distances are taken in space.
fn measured(surface: &ElementarySurface, chart: &Chart, point: crate::Vector, [x, y]: [f64; 2]) -> [f64; 3] {
    match (surface.kind(), *chart) {
        (ElementaryKind::Sphere { radius }, Chart::Mercator { side, .. }) => (point / (radius * side)).into(),
        _ => [x, y, 0.0],
    }
}

/// Cells are as large as the lattice's side.
fn cell(at: [f64; 3]) -> [i32; 3] {
    at.map(|x| x.floor() as i32)
}

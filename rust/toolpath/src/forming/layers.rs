//! Rows in flat sheet, layer by layer: none of them presses the sheet deeper than an increment below where it stands.
//!
//! Planes lie an increment apart below the flat sheet. In a layer the tool follows the higher of its plane and of the envelope,
//! and only where the envelope lies below the plane before: elsewhere that layer, or one before it, has formed the sheet. The
//! rows are the same in each layer, so that the sheet under a row stands on the plane before, or on the envelope. Derived in
//! docs/concepts/rows.md.

use styluscam_geometry::Vector;

use crate::{Pass, PathPoint, PlanError, Planes};

/// Heights that differ by less are one, mm.
const SAME: f64 = 1e-9;
/// Layers at most.
const LIMIT: usize = 10_000;

/// The part of all rows that is formed at once.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Height of its plane, mm.
    pub floor: f64,
    /// Its passes, in the groups of the rows that they are of.
    pub passes: Vec<Pass>,
}

/// Rows in layers on planes, from the top down; what is less than `least` mm below a plane belongs to its layer.
///
/// # Errors
/// More layers than a program can hold.
pub fn layers(rows: &[Pass], planes: &Planes, least: f64) -> Result<Vec<Layer>, PlanError> {
    let Planes { top, increment } = *planes;
    let lowest = rows.iter().flat_map(|row| &row.points).map(|point| point.tip.z).fold(top, f64::min);
    let count = ((top - lowest - least) / increment).ceil().max(1.0) as usize;
    if count > LIMIT {
        return Err(PlanError::TooMany { what: "max_increment", value: increment, count, limit: LIMIT });
    }
    let layer = |number: usize| {
        let floor = planes.height(number);
        // what lies at the top, or above it, is of the first layer
        let before = if number == 1 { f64::INFINITY } else { planes.height(number - 1) };
        let of_row = |row: &Pass| -> Vec<Pass> {
            let parts = below(&row.points, before).into_iter().filter(|part| lowest_of(part) < before - least);
            parts.map(|part| Pass { points: raised(&part, floor, least), closed: false, group: row.group }).collect()
        };
        Layer { floor, passes: rows.iter().flat_map(of_row).collect() }
    };
    Ok((1..=count).map(layer).filter(|layer| !layer.passes.is_empty()).collect())
}

/// The parts of a polyline that lie below a height, from where it crosses that.
fn below(points: &[PathPoint], height: f64) -> Vec<Vec<PathPoint>> {
    let mut parts = Vec::new();
    let mut part: Vec<PathPoint> = Vec::new();
    for (i, point) in points.iter().enumerate() {
        let before = i.checked_sub(1).map(|before| &points[before]);
        let crossing = before.and_then(|before| crossing(before, point, height));
        if point.tip.z < height {
            part.extend(crossing.filter(|_| part.is_empty()));
            part.push(*point);
        } else if !part.is_empty() {
            part.extend(crossing);
            parts.push(std::mem::take(&mut part));
        }
    }
    parts.push(part);
    parts.retain(|part| part.len() > 1);
    parts
}

/// A polyline, of which what lies more than `least` mm below a plane is on that instead.
fn raised(points: &[PathPoint], floor: f64, least: f64) -> Vec<PathPoint> {
    let mut raised: Vec<PathPoint> = Vec::with_capacity(points.len());
    let mut rest = points;
    while let Some(first) = rest.first() {
        let is_under = first.tip.z < floor;
        let count = rest.iter().take_while(|point| (point.tip.z < floor) == is_under).count();
        let (stretch, after) = rest.split_at(count);
        if is_under && lowest_of(stretch) < floor - least {
            let onto = |point: &PathPoint| PathPoint {
                tip: Vector::new(point.tip.x, point.tip.y, floor),
                normal: Vector::z(),
                ..*point
            };
            let begin = raised.last().and_then(|before| crossing(before, first, floor));
            let end = stretch.last().zip(after.first()).and_then(|(last, next)| crossing(last, next, floor));
            raised.extend(begin.or(Some(*first)).map(|point| onto(&point)));
            raised.extend(end.or(stretch.last().copied()).map(|point| onto(&point)));
        } else {
            raised.extend_from_slice(stretch);
        }
        rest = after;
    }
    raised.dedup_by(|b, a| (b.tip - a.tip).norm() <= SAME);
    raised
}

/// Where a line between two points crosses a height, between them.
fn crossing(a: &PathPoint, b: &PathPoint, height: f64) -> Option<PathPoint> {
    let share = (height - a.tip.z) / (b.tip.z - a.tip.z);
    if !(share > 0.0 && share < 1.0) {
        return None;
    }
    let at = a.tip + share * (b.tip - a.tip);
    Some(PathPoint { tip: Vector::new(at.x, at.y, height), ..if share < 0.5 { *a } else { *b } })
}

fn lowest_of(points: &[PathPoint]) -> f64 {
    points.iter().map(|point| point.tip.z).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row over a pit: flat sheet, a wall down to Z-2.5, a floor, and up again.
    fn row() -> Pass {
        let at = |(x, z): (f64, f64)| PathPoint {
            tip: Vector::new(x, 0.0, z),
            normal: Vector::z(),
            selected: true,
            triangle: 0,
        };
        let points = [(0.0, 0.0), (1.0, 0.0), (3.5, -2.5), (6.0, -2.5), (8.5, 0.0), (9.0, 0.0)].map(at).to_vec();
        Pass { points, closed: false, group: 3 }
    }

    fn corners(pass: &Pass) -> Vec<[f64; 2]> {
        pass.points.iter().map(|point| [point.tip.x, point.tip.z]).collect()
    }

    #[test]
    fn each_layer_goes_on_where_the_one_before_ends() {
        let layers = layers(&[row()], &Planes { top: 0.0, increment: 1.0 }, 0.01).unwrap();
        let found: Vec<_> = layers.iter().map(|layer| (layer.floor, corners(&layer.passes[0]))).collect();
        let first = vec![[0.0, 0.0], [1.0, 0.0], [2.0, -1.0], [7.5, -1.0], [8.5, 0.0], [9.0, 0.0]];
        let second = vec![[2.0, -1.0], [3.0, -2.0], [6.5, -2.0], [7.5, -1.0]];
        let third = vec![[3.0, -2.0], [3.5, -2.5], [6.0, -2.5], [6.5, -2.0]];
        assert_eq!(found, [(-1.0, first), (-2.0, second), (-3.0, third)]);
        assert!(layers.iter().all(|layer| layer.passes.iter().all(|pass| pass.group == 3)));
    }

    #[test]
    fn what_is_hardly_below_a_plane_is_of_its_layer() {
        let layers = layers(&[row()], &Planes { top: 0.0, increment: 1.249 }, 0.01).unwrap();
        assert_eq!(layers.len(), 2);
        assert!(corners(&layers[1].passes[0]).contains(&[3.5, -2.5]), "the floor itself, 2 um below the plane");
    }

    #[test]
    fn a_hill_parts_a_row_in_the_layers_below_its_top() {
        let mut row = row();
        let hill = [(4.0, -2.5), (4.75, -1.5), (5.5, -2.5)]
            .map(|(x, z)| PathPoint { tip: Vector::new(x, 0.0, z), ..row.points[0] });
        row.points.splice(3..3, hill);
        let layers = layers(&[row], &Planes { top: 0.0, increment: 1.0 }, 0.01).unwrap();
        let passes: Vec<usize> = layers.iter().map(|layer| layer.passes.len()).collect();
        assert_eq!(passes, [1, 1, 2]);
    }

    #[test]
    fn too_many_layers_are_refused() {
        assert!(layers(&[row()], &Planes { top: 0.0, increment: 1e-4 }, 1e-6).is_err());
    }
}

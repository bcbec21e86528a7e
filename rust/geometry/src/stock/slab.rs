//! What lies of a closed mesh between two heights, as seen from above.
//!
//! A position in plan has material between two heights where the mesh's section just over the lower one holds it, or where a
//! face of the mesh lies over it between them: so the outline is the union of that section and of all faces, cut off at both
//! heights. Only sections that touch a height do not count: what ends there has no material between.
//!
//! Unions are computed on a grid of a power of two (some 1e-7 mm for a part of a few hundred mm), on which they are exact (i_overlay);
//! corners that are corners of the mesh, or of its sections, keep all their digits.

use std::cmp::Ordering;
use std::collections::HashMap;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

use crate::{Mesh, PlanePiece, PlanePoint, Vector};

/// Coordinates on the grid stay below this: a factor 2 is left to the library's limit of 2^30.
const HIGHEST: f64 = 536_870_912.0;
/// Corners nearer to the line between their neighbours are none, mm: what the grid moves crossings by.
const STRAIGHT: f64 = 1e-6;

/// The outlines of what lies of a closed mesh, wound outward, between two heights, from the upper one: counterclockwise, holes clockwise, each
/// from its corner of the lowest X, then Y. mm.
pub fn outlines(mesh: &Mesh, [top, floor]: [f64; 2]) -> Vec<Vec<PlanePoint>> {
    if floor >= top {
        return Vec::new();
    }
    let faces = (0..mesh.triangles().len()).filter_map(|triangle| cut_off(mesh, triangle, [top, floor]));
    Union::new(&section(mesh, floor), &faces.collect::<Vec<_>>()).outlines()
}

/// The outlines of the section just over a height, material to the left.
fn section(mesh: &Mesh, z: f64) -> Vec<Vec<PlanePoint>> {
    // a corner at the height lies under it: so no triangle meets the plane in a corner or along a side only
    let is_over = |vertex: u32| mesh.vertices()[vertex as usize].z > z;
    let sides = |triangle: &[u32; 3]| [0, 1, 2].map(|k| [triangle[k], triangle[(k + 1) % 3]]);
    let crossing = |triangle: &[u32; 3]| {
        let falls = sides(triangle).into_iter().find(|[a, b]| is_over(*a) && !is_over(*b))?;
        let rises = sides(triangle).into_iter().find(|[a, b]| !is_over(*a) && is_over(*b))?;
        Some([falls, rises].map(|[a, b]| [a.min(b), a.max(b)]))
    };
    let steps: Vec<[[u32; 2]; 2]> = mesh.triangles().iter().filter_map(crossing).collect();
    let mut from: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (number, [start, _]) in steps.iter().enumerate().rev() {
        from.entry(*start).or_default().push(number);
    }
    let mut next = |edge: &[u32; 2]| from.get_mut(edge).and_then(Vec::pop);
    let mut contours = Vec::new();
    for [start, _] in &steps {
        let mut contour = Vec::new();
        let mut edge = *start;
        while let Some(step) = next(&edge) {
            contour.push(crossed(mesh, edge, z));
            edge = steps[step][1];
        }
        if !contour.is_empty() {
            contours.push(contour);
        }
    }
    contours
}

/// Where an edge, its vertices in order, crosses a height: the same from both its triangles.
fn crossed(mesh: &Mesh, edge: [u32; 2], z: f64) -> PlanePoint {
    let [a, b] = edge.map(|vertex| mesh.vertices()[vertex as usize]);
    let plan = |point: Vector| [point.x, point.y];
    if b.z <= z && z <= b.z {
        plan(b)
    } else {
        plan(a + (b - a) * ((z - a.z) / (b.z - a.z)))
    }
}

/// What of a triangle lies between two heights, from above; none where nothing does.
fn cut_off(mesh: &Mesh, triangle: usize, [top, floor]: [f64; 2]) -> Option<Vec<PlanePoint>> {
    let heights = mesh.corners(triangle).map(|corner| corner.z);
    let lowest = heights.into_iter().fold(f64::INFINITY, f64::min);
    let highest = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
    if lowest >= top || highest <= floor {
        return None;
    }
    let corners = mesh.triangles()[triangle];
    let mut points = Vec::with_capacity(6);
    for k in 0..3 {
        let [a, b] = [corners[k], corners[(k + 1) % 3]];
        let [from, to] = [heights[k], heights[(k + 1) % 3]];
        if (floor..=top).contains(&from) {
            let corner = mesh.vertices()[a as usize];
            points.push([corner.x, corner.y]);
        }
        let on_the_way = if from < to { [floor, top] } else { [top, floor] };
        let is_between = |z: &f64| from.min(to) < *z && *z < from.max(to);
        points.extend(on_the_way.into_iter().filter(is_between).map(|z| crossed(mesh, [a.min(b), a.max(b)], z)));
    }
    Some(points)
}

/// Areas on the grid, whose union is asked for.
struct Union {
    scale: f64,
    contours: Vec<Vec<IntPoint<i32>>>,
    /// What lies at points of the grid, with all digits.
    exact: HashMap<[i32; 2], PlanePoint>,
}

impl Union {
    /// Of a section, clockwise around its holes, and of convex areas wound either way.
    fn new(section: &[Vec<PlanePoint>], convex: &[Vec<PlanePoint>]) -> Self {
        let all = section.iter().chain(convex);
        let farthest = all.flatten().flatten().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        let mut scale = 1.0;
        while scale * farthest < HIGHEST && scale < HIGHEST {
            scale *= 2.0;
        }
        while scale * farthest > HIGHEST {
            scale *= 0.5;
        }
        let mut exact = HashMap::new();
        let mut on_grid = |point: &PlanePoint| {
            let [x, y] = point.map(|x| libm::round(x * scale) as i32);
            exact.entry([x, y]).or_insert(*point);
            IntPoint::new(x, y)
        };
        let mut on_grid = |contour: &Vec<PlanePoint>| contour.iter().map(&mut on_grid).collect::<Vec<_>>();
        let mut contours: Vec<Vec<IntPoint<i32>>> = section.iter().map(&mut on_grid).collect();
        for mut contour in convex.iter().map(on_grid) {
            let twice = twice_area(&contour);
            if twice < 0 {
                contour.reverse();
            }
            // what stands upright has none
            contours.extend((twice != 0).then_some(contour));
        }
        Self { scale, contours, exact }
    }

    fn outlines(self) -> Vec<Vec<PlanePoint>> {
        let shapes = Overlay::from_subj(&self.contours).overlay(OverlayRule::Subject, FillRule::Positive);
        let mut outlines: Vec<Vec<PlanePoint>> = shapes
            .into_iter()
            .flatten()
            .map(|contour| contour.into_iter().map(|point| self.back(point)).collect::<Vec<PlanePoint>>())
            .map(|contour| straightened(&from_lowest(contour)))
            .filter(|contour| contour.len() > 2)
            .collect();
        outlines.sort_by(|a, b| a.first().zip(b.first()).map_or(Ordering::Equal, |(a, b)| in_order(a, b)));
        outlines
    }

    fn back(&self, point: IntPoint<i32>) -> PlanePoint {
        let near = || [point.x, point.y].map(|x| f64::from(x) / self.scale);
        self.exact.get(&[point.x, point.y]).copied().unwrap_or_else(near)
    }
}

/// Twice an area on the grid, positive counterclockwise.
fn twice_area(contour: &[IntPoint<i32>]) -> i128 {
    let next = contour.iter().cycle().skip(1);
    let wide = |x: i32| i128::from(x);
    contour.iter().zip(next).map(|(a, b)| wide(a.x) * wide(b.y) - wide(b.x) * wide(a.y)).sum()
}

/// By X, then Y.
fn in_order(a: &PlanePoint, b: &PlanePoint) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
}

/// The same outline from its lowest corner.
fn from_lowest(mut contour: Vec<PlanePoint>) -> Vec<PlanePoint> {
    let lowest = (0..contour.len()).min_by(|a, b| in_order(&contour[*a], &contour[*b])).unwrap_or(0);
    contour.rotate_left(lowest);
    contour
}

/// An outline, begun at a corner, without the points that lie on straight lines of it.
fn straightened(contour: &[PlanePoint]) -> Vec<PlanePoint> {
    let Some(first) = contour.first() else { return Vec::new() };
    let mut kept = vec![*first];
    let mut skipped: Vec<PlanePoint> = Vec::new();
    for (point, next) in contour.iter().skip(1).zip(contour.iter().skip(2).chain([first])) {
        let from = kept.last().copied().unwrap_or(*first);
        skipped.push(*point);
        if skipped.iter().any(|skipped| PlanePiece::new(from, *next, 0.0).distance(*skipped) > STRAIGHT) {
            kept.push(*point);
            skipped.clear();
        }
    }
    kept
}

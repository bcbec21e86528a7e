//! The pocket as areas: what the tool's centre may reach, and what is to be cleared.

use rayon::prelude::*;
use styluscam_geometry::PlanePiece;

use super::cut::without_slivers;
use super::error::PocketError;
use super::growth::WALL;
use super::polygons::{signed_area, Kernel, Point, Polygons};
use super::request::{Cleared, Pocket, Shape};
use super::window::wider;

/// Coordinates of the plane lie within this, mm: on the grid of the booleans that leaves 4 nm.
pub const FARTHEST: f64 = 2000.0;
/// Those of a pocket, before it comes to the plane, lie within this, mm: beyond, they are no lengths of a machine.
const OUTERMOST: f64 = 1e6;
/// What is left on walls for the chords of their arcs and for the arcs that are put back, mm.
const GAP: f64 = 3e-3;
/// What of the goal's rim is not looked for, mm: no more than chords are off. A rim that comes to a wall is nearly along it, and of a strip of
/// 1 um there would meet a degree and a half that nobody had counted.
const RIM: f64 = 2e-4;
/// Chords of an earlier tool's path whose sweep is found at once.
const TOGETHER: usize = 48;
/// Areas of which the union is found at once.
const GROUP: usize = 4;
/// How far the tool's centre may go beyond an open edge, in tool radii: so far that it is free of the material there.
const BEYOND: f64 = 2.5;
/// How far discs may reach there, which only say where the tool is permitted to cut: the largest fits, with what it keeps from the material.
const FAR: f64 = 26.0;
/// Angle of the chords of the air around a corner of two open edges, rad.
const CHORD: f64 = 0.2;
/// Stock that an earlier tool left and that is thinner, in tool radii, is left: it engages 8 degrees.
const THIN: f64 = 0.01;
/// But not where something thicker is so near, in tool radii.
const REACH: f64 = 2.0;
/// How much less walls beyond an open edge are kept from than all others, mm, so that nothing else is cut off.
const NEARER: f64 = 1e-3;

/// The pocket's areas.
#[derive(Debug)]
pub struct Ground {
    pub kernel: Kernel,
    /// Where the tool's centre may be.
    pub free: Polygons,
    /// Where permissible discs may be: farther out beyond open edges.
    pub discs: Polygons,
    /// What is to be cleared.
    pub goal: Polygons,
}

impl Ground {
    pub fn new(pocket: &Pocket<'_>) -> Result<Self, PocketError> {
        let (r, smoothing) = (pocket.radius, pocket.smoothing);
        let outlines = pocket.shape.outlines();
        let corners = outlines.iter().flat_map(|(_, outline)| outline.iter());
        let farthest = corners.fold(0.0, |most: f64, [x, y, _]| most.max(x.abs()).max(y.abs()));
        let kernel = Kernel::new(2.0 * farthest + (20.0 + FAR) * r);
        let (walls, free, wide) = match pocket.shape {
            Shape::Walls { boundary, islands, open_edges, .. } => {
                let walls = area(&kernel, boundary, islands)?;
                let free = |far: f64| {
                    let open = kernel.union(&walls, &beyond(&kernel, boundary, open_edges, far * r));
                    let kept = r + GAP + pocket.leave;
                    let free = kernel.offset(&open, -kept, WALL);
                    match open_edges {
                        [] => free,
                        _ => off_walls(&kernel, &free, boundary, open_edges, kept - NEARER),
                    }
                };
                let wide = (!open_edges.is_empty()).then(|| free(FAR));
                let free = free(BEYOND);
                (Some(walls), free, wide)
            }
            Shape::Centres { outlines, in_air, .. } => {
                let chords: Vec<Vec<Point>> = outlines.iter().map(|outline| chords(outline)).collect();
                let (all, kept) = (kernel.even_odd(&chords), GAP + pocket.leave);
                let wide = in_air.then(|| kernel.offset(&within_air(&all, FAR * r), -kept, WALL));
                (None, kernel.offset(&all, -kept, WALL), wide)
            }
        };
        let core = kernel.offset(&free, -smoothing, WALL);
        if core.is_empty() {
            return Err(PocketError::TooSmall { radius: r, smoothing });
        }
        let free = kernel.offset(&core, smoothing, WALL);
        let discs = wide.unwrap_or_else(|| free.clone());
        let mut goal = kernel.offset(&core, smoothing + r - RIM, WALL);
        if let Some(walls) = walls {
            goal = kernel.intersection(&goal, &walls);
        }
        if let Some(stock) = pocket.shape.stock() {
            let chords: Vec<Vec<Point>> = stock.iter().map(|outline| chords(outline)).collect();
            goal = kernel.intersection(&goal, &kernel.even_odd(&chords));
        }
        let swept: Vec<Polygons> = pocket.cleared.par_iter().flat_map_iter(|path| swept(&kernel, path)).collect();
        if !swept.is_empty() {
            let left = without_slivers(kernel.difference(&goal, &united(&kernel, swept)));
            goal = thick_parts(&kernel, &left, THIN * r, REACH * r);
        }
        if goal.is_empty() {
            return Err(PocketError::Empty);
        }
        Ok(Self { kernel, free, discs, goal })
    }
}

/// An area without what is thinner than `thin` and farther than `near` from all that is thicker, mm.
///
/// Along walls an earlier tool leaves slivers as thin as its path is exact. Near to more than that they stay, for there they are cut with it.
fn thick_parts(kernel: &Kernel, area: &Polygons, thin: f64, near: f64) -> Polygons {
    let thick = kernel.offset(area, -0.5 * thin, 0.1 * thin);
    if thick.is_empty() {
        return thick;
    }
    kernel.intersection(area, &kernel.offset(&thick, 0.5 * thin + near, WALL))
}

/// The union of areas that overlap those beside them in the list most, in groups of these: of all at once nearly every side crosses many.
fn united(kernel: &Kernel, mut areas: Vec<Polygons>) -> Polygons {
    while areas.len() > 1 {
        let contours =
            |group: &[Polygons]| group.iter().flat_map(|area| area.contours.iter().cloned()).collect::<Vec<_>>();
        areas = areas.par_chunks(GROUP).map(|group| kernel.union_all(&contours(group))).collect();
    }
    areas.pop().unwrap_or_default()
}

/// What an earlier tool swept, in areas that follow each other.
fn swept(kernel: &Kernel, path: &Cleared) -> Vec<Polygons> {
    let chords = path_chords(&path.points);
    let starts = (0..chords.len().saturating_sub(1)).step_by(TOGETHER);
    let parts = starts.filter_map(|from| chords.get(from..chords.len().min(from + TOGETHER + 1)));
    parts.map(|part| kernel.sweep(part, path.radius, WALL)).collect()
}

/// The pocket without its islands.
fn area(kernel: &Kernel, boundary: &[[f64; 3]], islands: &[Vec<[f64; 3]>]) -> Result<Polygons, PocketError> {
    let outer = kernel.even_odd(&[chords(boundary)]);
    if outer.is_empty() {
        return Err(PocketError::Outline { key: "boundary".to_owned(), count: boundary.len() });
    }
    let mut all = Polygons::default();
    for island in islands {
        all = kernel.union(&all, &kernel.even_odd(&[chords(island)]));
    }
    Ok(kernel.difference(&outer, &all))
}

/// The air beyond open edges up to a distance, mm.
fn beyond(kernel: &Kernel, boundary: &[[f64; 3]], open_edges: &[usize], far: f64) -> Polygons {
    let pieces = PlanePiece::outline(boundary);
    let far = if signed_area(&chords(boundary)) > 0.0 { far } else { -far };
    let outwards = |a: &Point, b: &Point| {
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = libm::hypot(along[0], along[1]);
        [along[1] * far / length, -along[0] * far / length]
    };
    let moved = |p: &Point, by: Point| [p[0] + by[0], p[1] + by[1]];
    let mut areas = Vec::new();
    let mut add = |mut area: Vec<Point>| {
        if far < 0.0 {
            area.reverse();
        }
        areas.push(area);
    };
    for edge in open_edges {
        let mut corners = pieces.get(*edge).map(flat).unwrap_or_default();
        for pair in corners.windows(2) {
            let [a, b] = pair else { continue };
            let out = outwards(a, b);
            add(vec![*a, moved(a, out), moved(b, out), *b]);
        }
        // on to the next one, if that is open too
        let next = (edge + 1) % pieces.len().max(1);
        let after = pieces.get(next).filter(|_| open_edges.contains(&next)).map(flat).unwrap_or_default();
        corners.extend(after.get(1));
        // around the corner with it, and between the chords of an arc
        for corner in corners.windows(3) {
            let [a, corner, b] = corner else { continue };
            let (before, after) = (outwards(a, corner), outwards(corner, b));
            let (cross, dot) =
                (before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]);
            let turn = libm::atan2(cross, dot);
            if turn * far > 0.0 {
                let count = libm::ceil(turn.abs() / CHORD).max(1.0);
                let around = (0..=count as usize).map(|i| {
                    let (sin, cos) = libm::sincos(turn * i as f64 / count);
                    moved(corner, [before[0] * cos - before[1] * sin, before[0] * sin + before[1] * cos])
                });
                add(std::iter::once(*corner).chain(around).collect());
            }
        }
    }
    kernel.union_all(&areas)
}

/// An area with the air beyond its outline, up to a distance, mm.
fn within_air(area: &Polygons, far: f64) -> Polygons {
    let around = area.bounds().map(|bounds| {
        let [[x0, y0], [x1, y1]] = wider(bounds, far);
        vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    });
    let holes = area.contours.iter().filter(|contour| signed_area(contour) < 0.0).cloned();
    Polygons { contours: around.into_iter().chain(holes).collect() }
}

/// Without what is nearer than `distance` to an edge that is not open: beyond an open edge others may lie.
fn off_walls(kernel: &Kernel, free: &Polygons, boundary: &[[f64; 3]], open_edges: &[usize], distance: f64) -> Polygons {
    let pieces = PlanePiece::outline(boundary);
    let walls = pieces.iter().enumerate().filter(|(edge, _)| !open_edges.contains(edge));
    let beside = walls.flat_map(|(_, wall)| kernel.sweep(&flat(wall), distance, WALL).contours);
    kernel.difference(free, &Polygons { contours: beside.collect() })
}

/// A closed outline as chords.
pub fn chords(outline: &[[f64; 3]]) -> Vec<Point> {
    let pieces = PlanePiece::outline(outline);
    pieces
        .iter()
        .flat_map(|piece| {
            let mut points = flat(piece);
            points.pop();
            points
        })
        .collect()
}

/// A path of points with bulges as chords.
pub fn path_chords(points: &[[f64; 3]]) -> Vec<Point> {
    let pieces = PlanePiece::path(points);
    let mut chords: Vec<Point> = pieces.first().map(|piece| piece.start).into_iter().collect();
    chords.extend(pieces.iter().flat_map(|piece| flat(piece).into_iter().skip(1)));
    chords
}

/// A path of points with bulges from its end to its start.
pub fn reversed(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let bulges = points.iter().rev().skip(1).map(|[_, _, bulge]| -bulge).chain([0.0]);
    points.iter().rev().zip(bulges).map(|([x, y, _], bulge)| [*x, *y, bulge]).collect()
}

/// A piece as chords that are off it by no more than walls allow.
fn flat(piece: &PlanePiece) -> Vec<Point> {
    let count = piece.circle.map_or(1, |circle| {
        let step = (8.0 * WALL / circle.radius).sqrt();
        libm::ceil(circle.turn.abs() / step).clamp(4.0, 20_000.0) as usize
    });
    let mut points: Vec<Point> = (0..count).map(|i| piece.at(i as f64 / count as f64)).collect();
    points.push(piece.end);
    points
}

/// Refuses a number by its key where it is not what is allowed.
pub fn number(key: &str, value: f64, ok: bool, allowed: &'static str) -> Result<(), PocketError> {
    if ok {
        Ok(())
    } else {
        Err(PocketError::Number { key: key.to_owned(), value, allowed })
    }
}

/// Refuses what is no pocket and no tool.
pub fn check(pocket: &Pocket<'_>) -> Result<(), PocketError> {
    let r = pocket.radius;
    number("tool_radius", r, (0.01..=500.0).contains(&r), "0.01 to 500 mm")?;
    let degrees = pocket.angle.to_degrees();
    let allowed = "engagement_deg + growth_deg from 10 to 90 deg: past a right angle the method proves nothing";
    number("engagement_deg", degrees, (10.0 - 1e-9..=90.0 + 1e-9).contains(&degrees), allowed)?;
    let share = pocket.smoothing / r;
    number("smoothing_radius", pocket.smoothing, (0.01..=10.0).contains(&share), "0.01 to 10 tool radii")?;
    number("leave", pocket.leave, (0.0..=100.0).contains(&pocket.leave), "0 to 100 mm")?;
    number("finish", pocket.finish, (0.0..=r).contains(&pocket.finish), "0 to the tool's radius")?;
    let least = pocket.entry.form.least() * r;
    let size = pocket.entry.size.unwrap_or(least);
    number("entry_size", size, size >= least, "0.08 tool radii or more, 0.5 for a ramp: what is smaller is a plunge")?;
    for (i, path) in pocket.cleared.iter().enumerate() {
        let key = format!("cleared[{i}]");
        number(&key, path.radius, (0.0..=FARTHEST).contains(&path.radius), "a tool's radius up to 2000 mm")?;
        for value in path.points.iter().flatten() {
            number(&key, *value, value.abs() <= OUTERMOST, "finite numbers within +/-1000000")?;
        }
    }
    let stock = pocket.shape.stock().unwrap_or(&[]).iter().enumerate();
    let stock = stock.map(|(i, outline)| (format!("stock[{i}]"), outline.as_slice()));
    let outlines = pocket.shape.outlines().into_iter().chain(stock);
    for (key, outline) in outlines {
        for (i, point) in outline.iter().enumerate() {
            for value in point {
                let key = format!("{key}[{i}]");
                number(&key, *value, value.abs() <= OUTERMOST, "finite numbers within +/-1000000")?;
            }
        }
        let is_curved = outline.iter().any(|[_, _, bulge]| *bulge != 0.0);
        if outline.len() < 2 || (outline.len() == 2 && !is_curved) {
            return Err(PocketError::Outline { key, count: outline.len() });
        }
    }
    let Shape::Walls { boundary, open_edges, .. } = pocket.shape else { return Ok(()) };
    let count = boundary.len();
    match open_edges.iter().find(|edge| **edge >= count) {
        Some(edge) => Err(PocketError::Edge { edge: *edge, count }),
        None => Ok(()),
    }
}

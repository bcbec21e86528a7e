//! The pass along the walls that takes what was left on them.
//!
//! In hollow corners a strip of even width is too much for the bound: the rim meets both walls there. So the passes before go
//! to the wall where the last one would engage more than the bound, and leave the strip everywhere else. Onto a wall that goes all
//! around the tool is steered as the bound allows, and off it along an arc.

use std::f64::consts::PI;

use styluscam_motion::Watch;

use super::bound::Bound;
use super::check::{beyond, bounded, stepovers};
use super::cut::{left_of, Cut};
use super::error::PocketError;
use super::fit::arcs;
use super::ground::{path_chords, Ground};
use super::growth::WALL;
use super::links;
use super::material::Material;
use super::pieces::{pieces, Piece};
use super::planner::{self, ALLOWED, SLIVER};
use super::polygons::{Point, Polygons};
use super::request::{Pocket, PocketPath, PocketRun, PocketRunKind, Shape};
use super::sequence::{link, measure_room};
use super::steering::around_ring;

/// Around positions at which the last pass would engage too much no strip is left within so many of its widths, and as many more
/// the next time.
const CLEARED: f64 = 2.0;
/// Times that they are looked for.
const ROUNDS: u32 = 8;
/// Radii of the arc off a wall, in tool radii: the first for which there is room.
const OFF: [f64; 4] = [0.5, 0.25, 0.1, 0.05];
/// What may be left after the pass, mm^2 of each of the tool's square radii, before more is planned for it.
const LEFT: f64 = 1e-4;

/// Plans the path of a pocket by climb milling, the last pass along the walls included.
pub fn plan(pocket: &Pocket<'_>, watch: &Watch) -> Result<PocketPath, PocketError> {
    let ground = Ground::new(pocket)?;
    let (r, most) = (pocket.radius, pocket.angle + ALLOWED);
    let strip = Before::new(pocket, &ground, ground.kernel.offset(&ground.free, -pocket.finish, WALL));
    let walls = pieces(&ground.free, &strip.rest, r);
    let Before { rough, mut rest } = before(pocket, &ground, strip, &walls, most);
    let (outlines, stock) = (flat(&rough), flat(&ground.goal));
    let shape = Shape::Centres { outlines: &outlines, stock: &stock, in_air: false };
    let mut path = planner::plan(&Pocket { shape, leave: 0.0, finish: 0.0, ..*pocket }, watch)?;
    path.goal = ground.goal.area();
    let free = Material::new(ground.free.clone());
    let steering = Bound::steering(r, pocket.angle);
    let mut open: Vec<&Piece> = walls.iter().collect();
    watch.begin("finishing the walls", open.len());
    while !open.is_empty() {
        let at = path.runs.last().and_then(|run| run.points.last()).map(|[x, y, _]| [*x, *y]);
        let wall = open.swap_remove(nearest(&open, at));
        let points = match wall.is_ring {
            true => around_ring(&wall.points, at, &rest, &free, &steering).unwrap_or_default(),
            false => arcs(&wall.points),
        };
        let mut points = bounded(points, &rest, r, most);
        if points.len() > 1 {
            off(&mut points, r, &free);
            let swept = ground.kernel.sweep(&path_chords(&points), r + SLIVER, WALL);
            let cut = Cut { path: points, swept, level: 0, is_entry: false, two_way: false };
            append(&mut path, cut.path.clone(), &rest, &free, r);
            rest = left_of(&ground.kernel, &rest, [&cut]);
        }
        watch.advance(1)?;
    }
    path.left = rest.area.area().max(0.0);
    if path.left > LEFT * r * r {
        clear_rest(pocket, &ground, &rest, &mut path, watch)?;
    }
    measure_room(&mut path.runs, &free);
    Ok(path)
}

/// The passes before the last one.
struct Before {
    /// Where the tool's centre may be in them.
    rough: Polygons,
    /// What they leave.
    rest: Material,
}

impl Before {
    fn new(pocket: &Pocket<'_>, ground: &Ground, rough: Polygons) -> Self {
        let kernel = &ground.kernel;
        let core = kernel.offset(&rough, -pocket.smoothing, WALL);
        let swept = kernel.offset(&core, pocket.smoothing + pocket.radius, WALL);
        Self { rough, rest: Material::new(kernel.difference(&ground.goal, &swept)) }
    }
}

/// The passes that leave a strip, but not where the last pass along it would engage more than the bound.
fn before(pocket: &Pocket<'_>, ground: &Ground, strip: Before, walls: &[Piece], most: f64) -> Before {
    let (kernel, r) = (&ground.kernel, pocket.radius);
    let paths: Vec<Vec<[f64; 3]>> = walls.iter().map(|wall| arcs(&wall.points)).collect();
    let mut found = strip;
    for round in 1..=ROUNDS {
        let over: Vec<Point> = paths.iter().flat_map(|path| beyond(path, &found.rest, r, most)).collect();
        if over.is_empty() {
            break;
        }
        let reach = CLEARED * f64::from(round) * pocket.finish;
        let discs = over.iter().flat_map(|at| Polygons::disc(*at, reach, WALL).contours).collect::<Vec<_>>();
        let near = kernel.intersection(&kernel.union_all(&discs), &ground.free);
        // without notches between the discs, in which only small arcs would fit
        let wide = kernel.offset(&kernel.offset(&kernel.union(&found.rough, &near), r, WALL), -r, WALL);
        found = Before::new(pocket, ground, kernel.intersection(&wide, &ground.free));
    }
    found
}

/// The number of the wall that begins nearest; a ring anywhere.
fn nearest(open: &[&Piece], at: Option<Point>) -> usize {
    let away = |wall: &Piece| {
        let Some(at) = at else { return 0.0 };
        let starts = wall.points.iter().take(if wall.is_ring { wall.points.len() } else { 1 });
        starts.map(|p| libm::hypot(p[0] - at[0], p[1] - at[1])).fold(f64::INFINITY, f64::min)
    };
    (0..open.len()).min_by(|a, b| away(open[*a]).total_cmp(&away(open[*b]))).unwrap_or(0)
}

/// A link to a path, and the path.
fn append(path: &mut PocketPath, points: Vec<[f64; 3]>, rest: &Material, free: &Material, radius: f64) {
    let from = path.runs.last().and_then(|run| run.points.last()).map(|[x, y, _]| [*x, *y]);
    if let (Some(from), Some([x, y, _])) = (from, points.first()) {
        path.runs.push(link(from, [*x, *y], Some(links::Ground { material: rest, free, radius })));
    }
    path.runs
        .push(PocketRun { stepovers: stepovers(&points, rest, radius), ..PocketRun::new(points, PocketRunKind::Cut) });
}

/// Adds a quarter of a circle away from the wall, where there is room for one.
fn off(path: &mut Vec<[f64; 3]>, radius: f64, free: &Material) {
    let [.., [a, b, bulge], [x, y, _]] = path.as_slice() else { return };
    let (end, heading) = ([*x, *y], libm::atan2(y - b, x - a) + 2.0 * libm::atan(*bulge));
    let (sin, cos) = libm::sincos(heading);
    let arc = |rho: f64, turn: f64| {
        let (s, c) = libm::sincos(heading + turn);
        [end[0] + rho * (s - sin), end[1] + rho * (cos - c)]
    };
    let has_room = |rho: &&f64| (1..=8).all(|i| free.holds(arc(**rho * radius, 0.5 * PI * f64::from(i) / 8.0)));
    let Some(rho) = OFF.iter().find(has_room) else { return };
    let [u, v] = arc(rho * radius, 0.5 * PI);
    if let Some(last) = path.last_mut() {
        last[2] = libm::tan(PI / 8.0);
    }
    path.push([u, v, 0.0]);
}

/// Clears what the last pass could not take within the bound, as a pocket of its own.
fn clear_rest(
    pocket: &Pocket<'_>,
    ground: &Ground,
    rest: &Material,
    path: &mut PocketPath,
    watch: &Watch,
) -> Result<(), PocketError> {
    let (outlines, stock) = (flat(&ground.free), flat(&rest.area));
    let shape = Shape::Centres { outlines: &outlines, stock: &stock, in_air: false };
    match planner::plan(&Pocket { shape, leave: 0.0, finish: 0.0, ..*pocket }, watch) {
        Ok(more) => {
            let ends = [path.runs.last(), more.runs.first()].map(|run| run.map(|run| run.points.clone()));
            if let [Some(before), Some(next)] = ends {
                let points = before.last().into_iter().chain(next.first()).map(|[x, y, _]| [*x, *y, 0.0]).collect();
                path.runs.push(PocketRun::new(points, PocketRunKind::Rapid));
            }
            path.runs.extend(more.runs);
            path.left = more.left;
            Ok(())
        }
        // nothing of it is thick enough to be cut, or to be entered
        Err(PocketError::Empty | PocketError::NoEntry { .. }) => Ok(()),
        Err(error) => Err(error),
    }
}

/// Areas as outlines of points with bulges.
fn flat(area: &Polygons) -> Vec<Vec<[f64; 3]>> {
    area.contours.iter().map(|contour| contour.iter().map(|[x, y]| [*x, *y, 0.0]).collect()).collect()
}

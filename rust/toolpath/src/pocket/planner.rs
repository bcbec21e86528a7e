//! Level by level: what is reached next, the pieces of its boundary, and the moves between them.

use styluscam_motion::Watch;

use super::bound::Bound;
use super::check::bounded;
use super::entry::{helix, largest_disc};
use super::error::PocketError;
use super::fit::arcs;
use super::ground::{path_chords, Ground};
use super::growth::{Growth, WALL};
use super::links;
use super::material::Material;
use super::pieces::{pieces, Piece, SHALLOWEST};
use super::polygons::{Point, Polygons};
use super::request::{Pocket, PocketPath, PocketRun, PocketRunKind};
use super::steering::onto_ring;

/// The largest disc that is tried, in tool radii: larger ones engage as straight passes do.
const LARGEST: f64 = 12.0;
/// What a pass is taken to sweep beyond the tool's radius, mm: slivers between chords, thinner than the chips that count.
const SLIVER: f64 = 4e-4;
/// Pieces shallower than this share of a straight pass's stepover wait until nothing else is left.
const SHALLOW: f64 = 0.35;
/// Levels and entries, at most: more would mean that the path gains no ground.
const LEVELS: usize = 20_000;
const ENTRIES: usize = 200;

/// What a piece may exceed the bound by, rad (0.3 deg): half a degree is allowed, and the account here is good to a twentieth.
const ALLOWED: f64 = 0.3 * std::f64::consts::PI / 180.0;
/// How much lower the bound is taken where nothing within it was found, rad (2 deg).
const LOWER: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// Plans the path of a pocket by climb milling.
pub fn plan(pocket: &Pocket<'_>, watch: &Watch) -> Result<PocketPath, PocketError> {
    let ground = Ground::new(pocket)?;
    let bound = Bound::new(pocket.radius, pocket.angle);
    let widest = largest_disc(&ground.kernel, &ground.free, pocket.radius).map_or(0.0, |(_, radius)| radius);
    let largest = widest.min(LARGEST * pocket.radius).max(pocket.smoothing);
    let growth = Growth::new(&ground.kernel, &ground.free, &bound, [largest, pocket.smoothing]);
    let lower = Bound::new(pocket.radius, pocket.angle - LOWER);
    let cautious = Growth::new(&ground.kernel, &ground.free, &lower, [largest, pocket.smoothing]);
    let most = pocket.angle + ALLOWED;
    let material = Material::new(ground.goal.clone());
    let free = Material::new(ground.free.clone());
    let whole = material.area.area();
    let steering = Bound::steering(pocket.radius, pocket.angle);
    let growths = [growth, cautious];
    let mut planner = Planner { ground, bound, steering, growths, most, material, free, runs: Vec::new(), at: None };
    watch.begin("clearing the pocket", 1000);
    let (mut told, mut entries) = (0, 0);
    for _ in 0..LEVELS {
        if planner.material.is_empty() {
            break;
        }
        if !(0..planner.growths.len()).any(|growth| planner.level(growth)) {
            entries += 1;
            if entries > ENTRIES || !planner.enter() {
                break;
            }
        }
        let done = (1000.0 * (1.0 - planner.material.area.area() / whole)).max(0.0) as usize;
        watch.advance(done.saturating_sub(told))?;
        told = told.max(done);
    }
    Ok(PocketPath { runs: planner.runs, goal: whole, left: planner.material.area.area().max(0.0) })
}

/// The path so far and what is left.
struct Planner {
    ground: Ground,
    bound: Bound,
    steering: Bound,
    /// At the bound, and somewhat below: for where a joint of the first goes beyond.
    growths: [Growth; 2],
    /// The largest angle of a piece that is cut, rad.
    most: f64,
    material: Material,
    free: Material,
    runs: Vec<PocketRun>,
    at: Option<Point>,
}

impl Planner {
    /// Cuts all pieces of what is reached next; false where there are none.
    fn level(&mut self, growth: usize) -> bool {
        let Some(growth) = self.growths.get(growth) else { return false };
        let reach = growth.reach(&self.ground.kernel, &self.material.area);
        let found = pieces(&reach, &self.material, self.bound.radius);
        let mut shallow = SHALLOW * self.bound.stepover();
        let mut chosen: Vec<Piece> = Vec::new();
        while chosen.is_empty() && shallow > SHALLOWEST {
            chosen = found.iter().filter(|piece| piece.depth >= shallow).cloned().collect();
            shallow *= 0.5;
        }
        let mut has_cut = false;
        while !chosen.is_empty() {
            let next = self.nearest(&chosen);
            has_cut |= self.cut(&chosen.swap_remove(next));
        }
        has_cut
    }

    /// The piece that begins nearest to the tool; of rings any point is a beginning.
    fn nearest(&self, pieces: &[Piece]) -> usize {
        let Some(at) = self.at else { return 0 };
        let away = |p: &Point| libm::hypot(p[0] - at[0], p[1] - at[1]);
        let distance = |piece: &Piece| {
            let starts = if piece.is_ring { piece.points.as_slice() } else { piece.points.get(..1).unwrap_or(&[]) };
            starts.iter().map(away).fold(f64::INFINITY, f64::min)
        };
        let by_distance = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
        pieces.iter().map(distance).enumerate().min_by(by_distance).map_or(0, |(i, _)| i)
    }

    /// Cuts one piece; false where there is no way onto it.
    fn cut(&mut self, piece: &Piece) -> bool {
        let path = if piece.is_ring {
            let steered = onto_ring(&piece.points, self.at, &self.material, &self.ground.free, &self.steering);
            let Some((mut path, side)) = steered else { return false };
            let count = piece.points.len() - 1;
            let crossing = path.pop().map(|[x, y, _]| [x, y]);
            let around = (1..=count).filter_map(|i| piece.points.get((side + i) % count)).copied();
            let ring: Vec<Point> = crossing.into_iter().chain(around).chain(crossing).collect();
            path.extend(arcs(&ring));
            path
        } else {
            arcs(&piece.points)
        };
        let path = bounded(path, &self.material, self.bound.radius, self.most);
        let (Some([x, y, _]), Some([end_x, end_y, _])) = (path.first(), path.last()) else { return false };
        self.go([*x, *y]);
        self.clear(&path);
        self.at = Some([*end_x, *end_y]);
        self.runs.push(PocketRun { points: path, kind: PocketRunKind::Cut });
        true
    }

    /// To a position, through what is cleared or over it.
    fn go(&mut self, to: Point) {
        let Some(from) = self.at else { return };
        let ground = links::Ground { material: &self.material, free: &self.free, radius: self.bound.radius };
        let way = ground.way(from, to);
        let kind = if way.is_some() { PocketRunKind::Link } else { PocketRunKind::Rapid };
        let points = way.unwrap_or_else(|| vec![from, to]).iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        self.runs.push(PocketRun { points, kind });
    }

    fn clear(&mut self, path: &[[f64; 3]]) {
        let kernel = &self.ground.kernel;
        let swept = kernel.sweep(&path_chords(path), self.bound.radius + SLIVER, WALL);
        let left = without_slivers(kernel.difference(&self.material.area, &swept));
        self.material = Material::new(left.thinned(0.3 * WALL));
    }

    /// Goes down into the material where there is most room; false where there is none.
    fn enter(&mut self) -> bool {
        let kernel = &self.ground.kernel;
        let under = kernel.intersection(&self.ground.free, &self.material.area);
        let Some(disc) = largest_disc(kernel, &under, self.bound.radius).filter(|(_, radius)| *radius > 0.0) else {
            return false;
        };
        let helix = helix(disc, self.bound.radius);
        let begin = [helix.centre[0] + helix.radius, helix.centre[1]];
        if let Some([x, y]) = self.at {
            let points = vec![[x, y, 0.0], [begin[0], begin[1], 0.0]];
            self.runs.push(PocketRun { points, kind: PocketRunKind::Rapid });
        }
        self.runs.push(PocketRun { points: helix.points(), kind: PocketRunKind::Entry });
        self.at = Some(begin);
        let swept = Polygons::disc(helix.centre, helix.radius + self.bound.radius, WALL);
        let left = without_slivers(kernel.difference(&self.material.area, &swept));
        self.material = Material::new(left.thinned(0.3 * WALL));
        true
    }
}

/// The areas that are thicker than chips that do not count.
fn without_slivers(area: Polygons) -> Polygons {
    let is_thick = |contour: &Vec<Point>| {
        let (mut twice, mut round) = (0.0, 0.0);
        for (a, b) in super::polygons::sides(contour) {
            twice += a[0] * b[1] - a[1] * b[0];
            round += libm::hypot(b[0] - a[0], b[1] - a[1]);
        }
        twice.abs() > SHALLOWEST * round
    };
    Polygons { contours: area.contours.into_iter().filter(is_thick).collect() }
}

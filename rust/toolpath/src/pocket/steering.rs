//! From cleared ground onto a ring that cuts all around: as steeply outwards as the bound allows.
//!
//! At every step a disc to the left of the tool, tangent to its heading, on whose circle the bound holds, is the
//! certificate: if no steeper turn to the right has one, the tool goes on around the disc that it has.

use super::bound::Bound;
use super::fit::arcs;
use super::material::Material;
use super::polygons::Point;

/// A position with a heading, rad.
#[derive(Clone, Copy, Debug)]
struct Stance {
    at: Point,
    heading: f64,
}

/// The path onto a ring from near `at`, as points with bulges, and the number of the ring's side which it meets; None where it does not come there.
fn onto_ring(
    ring: &[Point],
    at: Option<Point>,
    material: &Material,
    free: &Material,
    bound: &Bound,
) -> Option<(Vec<[f64; 3]>, usize)> {
    let count = ring.len().saturating_sub(1);
    let away = |i: &usize| {
        let (Some(p), Some(at)) = (ring.get(*i), at) else { return 0.0 };
        libm::hypot(p[0] - at[0], p[1] - at[1])
    };
    let nearest = (0..count).min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let tries = (0..TRIES).map(|i| (nearest + i * count / TRIES) % count);
    tries.filter_map(|i| steered(ring, i, material, free, bound)).next()
}

/// The path onto a ring from near `at` and once around it, as points with bulges; None where there is no way onto it.
pub fn around_ring(
    ring: &[Point],
    at: Option<Point>,
    material: &Material,
    free: &Material,
    bound: &Bound,
) -> Option<Vec<[f64; 3]>> {
    let (mut path, side) = onto_ring(ring, at, material, free, bound)?;
    let count = ring.len() - 1;
    let crossing = path.pop().map(|[x, y, _]| [x, y]);
    let around = (1..=count).filter_map(|i| ring.get((side + i) % count)).copied();
    let ring: Vec<Point> = crossing.into_iter().chain(around).chain(crossing).collect();
    path.extend(arcs(&ring));
    Some(path)
}

/// Places on the ring from which the tool is steered.
const TRIES: usize = 12;
/// Steps at most.
const STEPS: usize = 1500;

fn steered(
    ring: &[Point],
    from: usize,
    material: &Material,
    free: &Material,
    bound: &Bound,
) -> Option<(Vec<[f64; 3]>, usize)> {
    let r = bound.radius;
    let step = 0.06 * r;
    let mut stance = beside(ring, from, material, r)?;
    let mut disc = widest(stance, material, bound)?;
    let mut path = Vec::new();
    let mut steepest = 0;
    for _ in 0..STEPS {
        let first = usize::max(steepest, 1) - 1;
        let found = TURNS.iter().enumerate().skip(first).find_map(|(i, turn)| {
            let next = stance.along(step, -turn / r);
            widest(next, material, bound).map(|disc| (i, -turn / r, next, disc))
        });
        let (curvature, next) = match found {
            Some((turn, curvature, next, radius)) => {
                (steepest, disc) = (turn, radius);
                (curvature, next)
            }
            None => {
                steepest = TURNS.len() - 1;
                (1.0 / disc, stance.along(step, 1.0 / disc))
            }
        };
        let [x, y] = stance.at;
        let crossed = crossing(ring, stance.at, next.at);
        let share = crossed.map_or(1.0, |(_, _, share)| share);
        // an arc stands out over its ends
        let is_free = free.holds(stance.along(0.5 * share * step, curvature).at);
        if !is_free || (crossed.is_none() && !free.holds(next.at)) {
            return None;
        }
        if let Some((at, side, share)) = crossed {
            path.push([x, y, libm::tan(0.25 * share * step * curvature)]);
            path.push([at[0], at[1], 0.0]);
            return Some((path, side));
        }
        path.push([x, y, libm::tan(0.25 * step * curvature)]);
        stance = next;
    }
    None
}

/// Curvatures to the right that are tried, in 1/tool radii: half a tool radius is the tightest.
const TURNS: [f64; 9] = [2.0, 1.5, 1.0, 0.7, 0.4, 0.2, 0.1, 0.05, 0.0];

/// A stance left of the ring's corner from which the tool meets nothing yet, headed along the ring.
fn beside(ring: &[Point], corner: usize, material: &Material, radius: f64) -> Option<Stance> {
    let (a, b) = (*ring.get(corner)?, *ring.get(corner + 1)?);
    let heading = libm::atan2(b[1] - a[1], b[0] - a[0]);
    let (sin, cos) = libm::sincos(heading);
    let mut aside = 0.0;
    for _ in 0..60 {
        let at = [a[0] - aside * sin, a[1] + aside * cos];
        let depth = radius - material.away(at);
        if depth <= 0.0 {
            return Some(Stance { at, heading });
        }
        aside += depth.max(1e-4);
    }
    None
}

/// Radius of the largest permissible disc to the left, mm.
///
/// A point of the material at v from the tool's centre keeps f(rho) from the centre of a disc of radius rho along the normal n where
/// v^2 - r^2 >= 2 rho (v n + r cos b): so the nearest point to a disc's centre gives how large the disc may be, and the next
/// one is looked for from there (as balls are shrunk onto a medial axis: J. Ma, S. Bae, S. Choi, 2012).
fn widest(stance: Stance, material: &Material, bound: &Bound) -> Option<f64> {
    let (sin, cos) = libm::sincos(stance.heading);
    let r = bound.radius;
    let mut rho = LARGEST * r;
    while rho >= SMALLEST * r {
        let centre = [stance.at[0] - rho * sin, stance.at[1] + rho * cos];
        let Some(near) = material.nearest(centre) else { return Some(rho) };
        let lacks = bound.keep(rho) - libm::hypot(near[0] - centre[0], near[1] - centre[1]);
        if lacks > NEARLY * r {
            let arm = [near[0] - stance.at[0], near[1] - stance.at[1]];
            rho = bound.widest([arm[0] * cos + arm[1] * sin, arm[1] * cos - arm[0] * sin])?.min(rho - 0.5 * NEARLY * r);
        } else if material.holds(centre) {
            rho *= 0.7;
        } else {
            return Some(rho);
        }
    }
    None
}

/// The largest and smallest disc that are tried, and what may be lacking, in tool radii.
const LARGEST: f64 = 12.0;
const SMALLEST: f64 = 0.04;
const NEARLY: f64 = 1e-4;

impl Stance {
    /// After an arc of a length and curvature, 1/mm, positive to the left.
    fn along(self, length: f64, curvature: f64) -> Self {
        let turn = length * curvature;
        let heading = self.heading + turn;
        // the chord of the arc
        let half = 0.5 * turn;
        let chord = if half.abs() < 1e-9 { length } else { length * libm::sin(half) / half };
        let (sin, cos) = libm::sincos(self.heading + half);
        Self { at: [self.at[0] + chord * cos, self.at[1] + chord * sin], heading }
    }
}

/// Where the line from a to b first crosses the ring, the number of its side, and the share of the line up to there.
fn crossing(ring: &[Point], a: Point, b: Point) -> Option<(Point, usize, f64)> {
    let along = [b[0] - a[0], b[1] - a[1]];
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let share = |(side, pair): (usize, &[Point])| match pair {
        [c, d] => {
            let edge = [d[0] - c[0], d[1] - c[1]];
            let area = cross(along, edge);
            let arm = [c[0] - a[0], c[1] - a[1]];
            let (t, u) = (cross(arm, edge) / area, cross(arm, along) / area);
            ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u)).then_some((t, side))
        }
        _ => None,
    };
    let first = ring.windows(2).enumerate().filter_map(share).min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(([a[0] + first.0 * along[0], a[1] + first.0 * along[1]], first.1, first.0))
}

//! Triangles of a wall and of the level plane around it: its rays, triangulated, and divided where they leave the wall.

use std::collections::HashMap;

use rayon::prelude::*;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation as _};

use super::{corner::Corner, fault::WallFault, field::Walls, rays::Ray};
use crate::Vector;

/// Positions are one within this distance, mm.
const SAME: f64 = 1e-6;
/// Triangles at most.
const MOST: usize = 1_000_000;
/// How often triangles are divided at most: each time what is left of a crease falls to a fraction.
const ROUNDS: usize = 40;
/// Places along a side at which a wall is compared with its triangles.
const PLACES: u32 = 4;
/// Steps by which the worst of them is made exact.
const STEPS: u32 = 24;
/// Heights within this are the plane's, mm.
const LEVEL: f64 = 1e-9;

#[derive(Clone, Copy)]
struct Numbered {
    at: Point2<f64>,
    number: u32,
}

impl HasPosition for Numbered {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// Where a triangle is to be divided.
struct Missing {
    at: [f64; 2],
    /// The side on which that is, if on one.
    side: Option<[u32; 2]>,
}

/// What is triangulated.
pub struct Ground<'a> {
    walls: &'a Walls,
    corner: &'a Corner,
    tolerance: f64,
    pub points: Vec<Vector>,
    places: HashMap<(i64, i64), u32>,
    /// Sides that triangles keep.
    kept: Vec<[u32; 2]>,
    /// How many points and kept sides the edges have: the first ones.
    edge: usize,
    /// How far the triangles were found to lie off the wall, along the normal, mm.
    pub deviation: f64,
}

impl<'a> Ground<'a> {
    /// The edges that the wall rises from; their points keep their heights.
    pub fn new(lines: &[Vec<Vector>], walls: &'a Walls, corner: &'a Corner, tolerance: f64) -> Self {
        let points = lines.concat();
        let mut kept = Vec::with_capacity(points.len());
        for line in lines {
            let first = kept.len() as u32;
            let count = line.len() as u32;
            kept.extend((0..count).map(|i| [first + i, first + (i + 1) % count]));
        }
        let places = points.iter().zip(0..).map(|(point, number)| (place([point.x, point.y]), number)).collect();
        let edge = points.len();
        Self { walls, corner, tolerance, points, places, kept, edge, deviation: 0.0 }
    }

    /// Adds the rays of one line, whose points have numbers from `first` on.
    pub fn add_rays(&mut self, rays: &[Ray], first: usize) {
        let numbered: Vec<Vec<u32>> = rays
            .iter()
            .map(|ray| {
                let crossings: Vec<u32> = ray.crossings.iter().map(|at| self.add(*at)).collect();
                let end = ray.end.map(|at| self.add(at));
                let start = ray.corner.map(|corner| (first + corner) as u32);
                let along: Vec<u32> = start.into_iter().chain(crossings.iter().copied()).chain(end).collect();
                self.kept.extend(along.windows(2).map(|pair| [pair[0], pair[1]]));
                crossings
            })
            .collect();
        // not from end to end: rays end on both sides of a crease, and the nearest of either side are to be neighbours
        for (index, crossings) in numbered.iter().enumerate() {
            let beside = &numbered[(index + 1) % numbered.len()];
            self.kept.extend(crossings.iter().zip(beside).map(|(a, b)| [*a, *b]));
        }
    }

    /// Adds the level plane up to a rectangle.
    pub fn add_blank(&mut self, low: [f64; 2], high: [f64; 2]) {
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]].map(|at| self.add(at));
        self.kept.extend((0..4).map(|i| [corners[i], corners[(i + 1) % 4]]));
    }

    /// The wall's height over a position.
    fn height(&self, at: [f64; 2]) -> f64 {
        self.corner.height(self.walls.at(at).height)
    }

    /// The number of a position, where there is a point or one is made.
    fn add(&mut self, at: [f64; 2]) -> u32 {
        if let Some(known) = self.places.get(&place(at)) {
            return *known;
        }
        let number = self.points.len() as u32;
        self.places.insert(place(at), number);
        self.points.push(Vector::new(at[0], at[1], self.height(at)));
        number
    }

    /// Triangles, counter-clockwise, outside of the edges, within the tolerance of the wall.
    ///
    /// # Errors
    /// Edges that cross, a wall that takes too many triangles.
    pub fn triangles(&mut self) -> Result<Vec<[u32; 3]>, WallFault> {
        for _ in 0..ROUNDS {
            let triangles = self.outside()?;
            let sides = self.sides(&triangles);
            let (missing, off): (Vec<Vec<Missing>>, Vec<f64>) =
                triangles.par_iter().map(|triangle| self.coarse(*triangle, &sides)).unzip();
            self.deviation = off.into_iter().fold(0.0, f64::max);
            let before = self.points.len();
            let mut numbers: HashMap<[u32; 2], usize> =
                self.kept.iter().enumerate().map(|(number, [a, b])| ([*a.min(b), *a.max(b)], number)).collect();
            for Missing { at, side } in missing.into_iter().flatten() {
                let middle = self.add(at);
                // a point that rounding puts beside a side that is kept would leave the side as it is
                if let Some(number) = side.and_then(|side| numbers.remove(&side)) {
                    let [a, b] = self.kept[number];
                    self.kept[number] = [a, middle];
                    self.kept.push([middle, b]);
                }
            }
            if self.points.len() == before {
                return Ok(triangles);
            }
            if self.points.len() > MOST {
                break;
            }
        }
        Err(WallFault::TooFine { tolerance: self.tolerance })
    }

    fn outside(&self) -> Result<Vec<[u32; 3]>, WallFault> {
        let vertex = |(point, number): (&Vector, u32)| Numbered { at: Point2::new(point.x, point.y), number };
        let vertices = self.points.iter().zip(0..).map(vertex).collect();
        let sides = self.kept.iter().filter(|[a, b]| a != b).map(|side| side.map(|i| i as usize)).collect();
        let mut crossed = Vec::new();
        let loaded =
            ConstrainedDelaunayTriangulation::<Numbered>::try_bulk_load_cdt(vertices, sides, |side| crossed.push(side));
        let all = loaded.map_err(|_| WallFault::Crossed)?;
        if all.num_vertices() != self.points.len() || crossed.iter().any(|[a, b]| *a < self.edge && *b < self.edge) {
            return Err(WallFault::Crossed);
        }
        let numbers = all.inner_faces().map(|face| face.vertices().map(|vertex| vertex.data().number));
        Ok(numbers.filter(|triangle| !self.is_inside(*triangle)).collect())
    }

    /// Whether a triangle lies within the edges: only those between corners of edges may.
    fn is_inside(&self, triangle: [u32; 3]) -> bool {
        if triangle.iter().any(|corner| *corner as usize >= self.edge) {
            return false;
        }
        let middle = triangle.iter().map(|corner| self.points[*corner as usize]).sum::<Vector>() / 3.0;
        let sides = &self.kept[..self.edge];
        let crossed = sides.iter().filter(|side| {
            let [a, b] = side.map(|i| self.points[i as usize]);
            (a.y > middle.y) != (b.y > middle.y) && middle.x < a.x + (middle.y - a.y) / (b.y - a.y) * (b.x - a.x)
        });
        crossed.count() % 2 == 1
    }

    /// Where each side of some triangles lies farthest off the wall, as a share of it from its end of the smaller number, and how
    /// far in height, mm.
    fn sides(&self, triangles: &[[u32; 3]]) -> HashMap<[u32; 2], (f64, f64)> {
        let mut sides: Vec<[u32; 2]> = triangles.iter().flat_map(|triangle| ends(*triangle)).collect();
        sides.sort_unstable();
        sides.dedup();
        sides
            .into_par_iter()
            .map(|side| (side, self.off_side(side.map(|corner| self.points[corner as usize]))))
            .collect()
    }

    /// Where a triangle is to be divided, and how far what remains lies off the wall, mm.
    fn coarse(&self, triangle: [u32; 3], sides: &HashMap<[u32; 2], (f64, f64)>) -> (Vec<Missing>, f64) {
        let [a, b, c] = triangle.map(|corner| self.points[corner as usize]);
        let normal = (b - a).cross(&(c - a));
        let lean = normal.z / normal.norm().max(f64::MIN_POSITIVE);
        let mut worst: f64 = 0.0;
        let mut missing = Vec::new();
        for side in ends(triangle) {
            let Some((share, off)) = sides.get(&side) else { continue };
            if off * lean > self.tolerance {
                let [from, to] = side.map(|corner| self.points[corner as usize]);
                let at = from + (to - from) * *share;
                missing.push(Missing { at: [at.x, at.y], side: Some(side) });
            }
            worst = worst.max(off * lean);
        }
        let middle = (a + b + c) / 3.0;
        let off = (self.height([middle.x, middle.y]) - middle.z).abs() * lean;
        if missing.is_empty() && off > self.tolerance {
            missing.push(Missing { at: [middle.x, middle.y], side: None });
        }
        (missing, worst.max(off))
    }

    /// Where a side lies farthest off the wall, as a share of it, and how far in height, mm.
    fn off_side(&self, [a, b]: [Vector; 2]) -> (f64, f64) {
        let off = |share: f64| {
            let at = a + (b - a) * share;
            (self.height([at.x, at.y]) - at.z).abs()
        };
        let step = 1.0 / f64::from(PLACES);
        let places = (1..PLACES).map(|i| step * f64::from(i)).map(|share| (share, off(share)));
        let (mut share, mut most) = places.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.5, 0.0));
        if most * 4.0 < self.tolerance {
            return (share, most);
        }
        // the worst place is a crease of the wall, as a rule: points there let triangles end at it
        let mut around = step;
        for _ in 0..STEPS {
            around *= 0.6;
            for near in [share - around, share + around] {
                let here = if (0.0..=1.0).contains(&near) { off(near) } else { 0.0 };
                if here > most {
                    (share, most) = (near, here);
                }
            }
        }
        (share, most)
    }

    /// Whether a triangle lies in the level plane.
    pub fn is_level(&self, triangle: [u32; 3]) -> bool {
        triangle.iter().all(|corner| (self.points[*corner as usize].z - self.corner.top()).abs() <= LEVEL)
    }

    /// The wall's unit normals, upwards, at the corners of a triangle: those of its part at this triangle.
    pub fn normals(&self, triangle: [u32; 3]) -> [Vector; 3] {
        /// Share of the way to the triangle's middle: at a corner itself several parts of the wall may meet.
        const INWARDS: f64 = 1e-3;
        let corners = triangle.map(|corner| self.points[corner as usize]);
        let middle = corners.iter().sum::<Vector>() / 3.0;
        corners.map(|corner| {
            let at = corner + INWARDS * (middle - corner);
            let risen = self.walls.at([at.x, at.y]);
            let away = (at - risen.foot).xy().try_normalize(0.0).unwrap_or_default();
            let rise = self.corner.rise(risen.height) * risen.rise / self.walls.slope();
            Vector::new(-rise * away.x, -rise * away.y, 1.0).normalize()
        })
    }
}

/// The sides of a triangle, each with its end of the smaller number first.
fn ends([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)])
}

fn place([x, y]: [f64; 2]) -> (i64, i64) {
    ((x / SAME).round() as i64, (y / SAME).round() as i64)
}

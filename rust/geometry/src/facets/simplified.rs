//! Fewer triangles: points are taken away as long as none of them is farther from what is left than a tolerance.
//!
//! A point goes along a side into its neighbour, where the fan around it keeps its sense and its topology (the link condition:
//! T. Dey, H. Edelsbrunner, S. Guha, D. Nekhayev, "Topology preserving edge contraction", Publications de l'Institut
//! Mathematique 66, 1999). Every point that went is kept with the triangle that stands for it, so that the tolerance holds for
//! all of them and does not add up; along a border it does add up, on the safe side.

use super::Facets;
use crate::mesh::nearest_on;
use crate::Vector;

/// Cosine of the angle by which the normal of a triangle may turn at once: 15 degrees. Slivers would turn more, and show as edges.
const TURN: f64 = 0.966;
/// Share of the points that a round over all of them must take away for another one to be worth it.
const WORTH: usize = 50;

impl Facets {
    /// The same surface through fewer of its points, those left out at most `tolerance` mm off it; no new side is one that
    /// `is_long` refuses.
    #[must_use]
    pub fn simplified(&self, tolerance: f64, is_long: impl Fn(&Vector, &Vector) -> bool) -> Self {
        let mut work = Work::new(self, tolerance, &is_long);
        loop {
            let went = (0..self.points.len() as u32).filter(|point| work.remove(*point)).count();
            if went * WORTH <= self.points.len() {
                return work.finished();
            }
        }
    }
}

struct Work<'a> {
    points: &'a [Vector],
    tolerance: f64,
    is_long: &'a dyn Fn(&Vector, &Vector) -> bool,
    /// None where a triangle has gone.
    triangles: Vec<Option<[u32; 3]>>,
    /// The triangles around each point.
    around: Vec<Vec<u32>>,
    /// The points that have gone for which each triangle stands.
    gone: Vec<Vec<u32>>,
    /// How far the border at each point is off the one that was there at most, mm.
    slack: Vec<f64>,
}

/// The points around one, in its triangles' sense; the first and the last differ at a border.
struct Ring {
    points: Vec<u32>,
    is_border: bool,
}

impl<'a> Work<'a> {
    fn new(facets: &'a Facets, tolerance: f64, is_long: &'a dyn Fn(&Vector, &Vector) -> bool) -> Self {
        let mut around = vec![Vec::new(); facets.points.len()];
        for (number, triangle) in facets.triangles.iter().enumerate() {
            triangle.iter().for_each(|point| around[*point as usize].push(number as u32));
        }
        Self {
            points: &facets.points,
            tolerance,
            is_long,
            triangles: facets.triangles.iter().copied().map(Some).collect(),
            around,
            gone: vec![Vec::new(); facets.triangles.len()],
            slack: vec![0.0; facets.points.len()],
        }
    }

    fn at(&self, point: u32) -> Vector {
        self.points[point as usize]
    }

    fn fan(&self, point: u32) -> impl Iterator<Item = (u32, [u32; 3])> + '_ {
        let around = self.around[point as usize].iter();
        around.filter_map(|number| Some((*number, self.triangles[*number as usize]?)))
    }

    /// Takes a point away; whether it could go.
    fn remove(&mut self, point: u32) -> bool {
        let Some(ring) = self.ring(point) else { return false };
        let mut targets = match ring.points.as_slice() {
            [first, .., last] if ring.is_border => vec![*first, *last],
            all => all.to_vec(),
        };
        let distance = |target: &u32| (self.at(*target) - self.at(point)).norm_squared();
        targets.sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
        targets.into_iter().any(|target| self.collapse(point, target, &ring))
    }

    /// The points around one; none where the surface is no disc there, or would vanish.
    fn ring(&self, point: u32) -> Option<Ring> {
        let mut sides: Vec<[u32; 2]> = Vec::new();
        for (_, triangle) in self.fan(point) {
            let at = triangle.iter().position(|corner| *corner == point)?;
            sides.push([triangle[(at + 1) % 3], triangle[(at + 2) % 3]]);
        }
        let starts: Vec<u32> = sides.iter().map(|[a, _]| *a).filter(|a| sides.iter().all(|[_, b]| b != a)).collect();
        let (first, is_border) = match starts.as_slice() {
            [] => (sides.first()?[0], false),
            [start] => (*start, true),
            _ => return None,
        };
        let mut points = vec![first];
        for _ in 0..sides.len() {
            let last = *points.last()?;
            let mut next = sides.iter().filter(|[a, _]| *a == last);
            let [_, found] = next.next()?;
            if next.next().is_some() {
                return None;
            }
            points.push(*found);
        }
        if !is_border && points.pop() != Some(first) {
            return None;
        }
        let mut sorted = points.clone();
        sorted.sort_unstable();
        sorted.dedup();
        (sorted.len() == points.len() && points.len() > 2).then_some(Ring { points, is_border })
    }

    /// Moves a point into one of those around it; whether that was possible.
    fn collapse(&mut self, point: u32, target: u32, ring: &Ring) -> bool {
        let Some(border) = self.border_error(point, target, ring) else { return false };
        if border > self.tolerance || !self.keeps_topology(point, target, ring) {
            return false;
        }
        let old: Vec<(u32, [u32; 3])> = self.fan(point).collect();
        let moved = |triangle: [u32; 3]| triangle.map(|corner| if corner == point { target } else { corner });
        let new: Vec<(u32, [u32; 3])> =
            old.iter().filter(|(_, t)| !t.contains(&target)).map(|(number, t)| (*number, moved(*t))).collect();
        let keeps_sense = |(number, triangle): &(u32, [u32; 3])| {
            self.triangles[*number as usize].is_some_and(|before| self.is_turned_little(&before, triangle))
        };
        if new.is_empty() || !new.iter().all(keeps_sense) {
            return false;
        }
        let is_long = |other: &u32| (self.is_long)(&self.at(target), &self.at(*other));
        if new.iter().flat_map(|(_, triangle)| triangle).any(is_long) {
            return false;
        }
        let stood: Vec<u32> =
            old.iter().flat_map(|(number, _)| self.gone[*number as usize].iter().copied()).chain([point]).collect();
        let Some(owners) = self.owners(&stood, &new) else { return false };
        for (number, triangle) in &old {
            self.triangles[*number as usize] = None;
            self.gone[*number as usize].clear();
            for corner in triangle {
                self.around[*corner as usize].retain(|other| other != number);
            }
        }
        for (number, triangle) in &new {
            self.triangles[*number as usize] = Some(*triangle);
            triangle.iter().for_each(|corner| self.around[*corner as usize].push(*number));
        }
        for (stood, owner) in stood.into_iter().zip(owners) {
            self.gone[owner as usize].push(stood);
        }
        if let (true, [first, .., last]) = (ring.is_border, ring.points.as_slice()) {
            self.slack[*first as usize] = border;
            self.slack[*last as usize] = border;
        }
        true
    }

    /// How far the border is off the one that was there, once a point has gone, mm; 0 inside, none where it must stay.
    fn border_error(&self, point: u32, target: u32, ring: &Ring) -> Option<f64> {
        let (true, [first, .., last]) = (ring.is_border, ring.points.as_slice()) else {
            return Some(0.0);
        };
        let other = if target == *first { *last } else { *first };
        let (from, along) = (self.at(target), self.at(other) - self.at(target));
        let share = (self.at(point) - from).dot(&along) / along.norm_squared();
        let off = (self.at(point) - from - along * share.clamp(0.0, 1.0)).norm();
        let before = [point, *first, *last].map(|at| self.slack[at as usize]);
        share.is_finite().then(|| off + before.into_iter().fold(0.0, f64::max))
    }

    /// The link condition: the two points have no other neighbours in common than those beside their side.
    fn keeps_topology(&self, point: u32, target: u32, ring: &Ring) -> bool {
        let (count, at) = (ring.points.len(), ring.points.iter().position(|other| *other == target));
        let Some(at) = at else { return false };
        let beside = |other: u32| {
            let next = (!ring.is_border || at + 1 < count).then(|| ring.points[(at + 1) % count]);
            let last = (!ring.is_border || at > 0).then(|| ring.points[(at + count - 1) % count]);
            next == Some(other) || last == Some(other)
        };
        let around = self.fan(target).flat_map(|(_, triangle)| triangle);
        let mut common = around.filter(|other| *other != point && *other != target && ring.points.contains(other));
        common.all(beside)
    }

    /// Whether a triangle that takes another's place faces nearly as that did, and not down where that did not.
    fn is_turned_little(&self, before: &[u32; 3], after: &[u32; 3]) -> bool {
        let normal = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| self.at(corner));
            (b - a).cross(&(c - a)).try_normalize(f64::MIN_POSITIVE)
        };
        match (normal(before), normal(after)) {
            (Some(before), Some(after)) => before.dot(&after) > TURN && after.z >= before.z.min(0.0) - 1e-9,
            (None, Some(_)) => true,
            (_, None) => false,
        }
    }

    /// The nearest of some triangles to each of some points; none where one of them is too far away.
    fn owners(&self, points: &[u32], triangles: &[(u32, [u32; 3])]) -> Option<Vec<u32>> {
        let owner = |point: &u32| {
            let (at, mut best) = (self.at(*point), (f64::INFINITY, 0));
            for (number, triangle) in triangles {
                let off = (nearest_on(&triangle.map(|corner| self.at(corner)), at) - at).norm();
                if off < best.0 {
                    best = (off, *number);
                }
            }
            (best.0 <= self.tolerance).then_some(best.1)
        };
        points.iter().map(owner).collect()
    }

    fn finished(self) -> Facets {
        let triangles: Vec<[u32; 3]> = self.triangles.into_iter().flatten().collect();
        let mut numbers = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        for corner in triangles.iter().flatten() {
            if numbers[*corner as usize] == u32::MAX {
                numbers[*corner as usize] = points.len() as u32;
                points.push(self.points[*corner as usize]);
            }
        }
        let triangles = triangles.iter().map(|t| t.map(|corner| numbers[corner as usize])).collect();
        Facets { points, triangles }
    }
}

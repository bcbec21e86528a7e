//! Smaller triangles where they are needed: long sides are halved, so that a picture can let the surface down step by step.
//!
//! A triangle is halved at its longest side first (M. C. Rivara, "Algorithms for refining triangular grids suitable for adaptive
//! and multigrid techniques", International Journal for Numerical Methods in Engineering 20, 1984): its angles stay as they are.

use std::collections::HashMap;

use super::{sides, Facets};
use crate::Vector;

impl Facets {
    /// The same surface, its sides halved as long as they are too long.
    #[must_use]
    pub fn divided(&self, is_long: impl Fn(&Vector, &Vector) -> bool) -> Self {
        let mut facets = self.clone();
        loop {
            let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
            for triangle in &with_long_sides(&facets, &is_long) {
                facets.halve(facets.longest(triangle), &mut middles);
            }
            if middles.is_empty() {
                return facets;
            }
            // what has a halved side is halved at its longest one too
            loop {
                let known = middles.len();
                for triangle in facets.triangles.clone() {
                    if sides(triangle).iter().any(|side| middles.contains_key(&sorted(*side))) {
                        facets.halve(facets.longest(&triangle), &mut middles);
                    }
                }
                if middles.len() == known {
                    break;
                }
            }
            let mut triangles = Vec::with_capacity(facets.triangles.len() + 2 * middles.len());
            for triangle in &facets.triangles {
                halves(facets.turned(*triangle), &middles, &mut triangles);
            }
            facets.triangles = triangles;
        }
    }

    fn halve(&mut self, side: [u32; 2], middles: &mut HashMap<[u32; 2], u32>) {
        let [from, to] = side.map(|end| self.points[end as usize]);
        let number = self.points.len() as u32;
        if *middles.entry(side).or_insert(number) == number {
            self.points.push(0.5 * (from + to));
        }
    }

    /// A triangle that begins with its longest side; of equal ones that with the smaller ends.
    fn turned(&self, triangle: [u32; 3]) -> [u32; 3] {
        let longest = self.longest(&triangle);
        let first = sides(triangle).iter().position(|side| sorted(*side) == longest).unwrap_or(0);
        [0, 1, 2].map(|i| triangle[(first + i) % 3])
    }

    fn longest(&self, triangle: &[u32; 3]) -> [u32; 2] {
        let length = |[a, b]: &[u32; 2]| (self.points[*a as usize] - self.points[*b as usize]).norm_squared();
        let [first, second, third] = sides(*triangle).map(sorted);
        let longer = |a: [u32; 2], b: [u32; 2]| {
            if length(&a).total_cmp(&length(&b)).then(b.cmp(&a)).is_ge() {
                a
            } else {
                b
            }
        };
        longer(longer(first, second), third)
    }
}

/// The triangles whose longest side is too long, or another one.
fn with_long_sides(facets: &Facets, is_long: &impl Fn(&Vector, &Vector) -> bool) -> Vec<[u32; 3]> {
    let long = |[a, b]: [u32; 2]| is_long(&facets.points[a as usize], &facets.points[b as usize]);
    facets.triangles.iter().copied().filter(|triangle| sides(*triangle).into_iter().any(long)).collect()
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The halves of a triangle whose first side is halved, and the others perhaps; itself where none is.
fn halves([a, b, c]: [u32; 3], middles: &HashMap<[u32; 2], u32>, into: &mut Vec<[u32; 3]>) {
    let middle = |a: u32, b: u32| middles.get(&sorted([a, b])).copied();
    let Some(m) = middle(a, b) else {
        into.push([a, b, c]);
        return;
    };
    match middle(b, c) {
        Some(n) => into.extend([[m, b, n], [m, n, c]]),
        None => into.push([m, b, c]),
    }
    match middle(c, a) {
        Some(n) => into.extend([[a, m, n], [m, c, n]]),
        None => into.push([a, m, c]),
    }
}

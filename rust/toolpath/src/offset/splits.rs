//! Triangles of an offset surface split where flags change.

use std::collections::HashMap;

use super::offset_surface::{Corner, OffsetSurface};

/// Sides to be halved in one round.
pub struct Splits {
    /// Their middles: points that the surface does not have yet.
    pub middles: Vec<Corner>,
    /// The number that each side's middle will have among the surface's points; sides by their ends, the lower first.
    numbers: HashMap<(u32, u32), u32>,
    fine: f64,
}

impl Splits {
    /// The sides longer than `fine` (mm) of triangles whose corners differ in flag, or have a flag that says stopped.
    pub fn of(surface: &OffsetSurface, fine: f64) -> Self {
        let mut splits = Self { middles: Vec::new(), numbers: HashMap::new(), fine };
        for (corners, triangle) in surface.triangles.iter().zip(&surface.numbers) {
            let flags = corners.map(|i| surface.points[i as usize].flag);
            if !flags[0].is_stopped() && flags.iter().all(|flag| *flag == flags[0]) {
                continue;
            }
            for side in sides(*corners).into_iter().filter(|side| length(surface, *side) > fine) {
                let next = (surface.points.len() + splits.middles.len()) as u32;
                splits.numbers.entry(side).or_insert_with(|| {
                    let [a, b] = [side.0, side.1].map(|i| &surface.points[i as usize]);
                    splits.middles.push(Corner {
                        point: (a.contact + b.contact) * 0.5,
                        normal: (a.normal + b.normal).try_normalize(0.0).unwrap_or(a.normal),
                        triangle: *triangle,
                    });
                    next
                });
            }
        }
        splits
    }

    /// Puts the parts in the place of all triangles that have such a side; the middles are among the points by now.
    pub fn apply(&self, surface: &mut OffsetSurface) {
        let (mut triangles, mut numbers) = (Vec::new(), Vec::new());
        for (corners, number) in surface.triangles.iter().zip(&surface.numbers) {
            self.part(surface, *corners, &mut triangles);
            numbers.resize(triangles.len(), *number);
        }
        (surface.triangles, surface.numbers) = (triangles, numbers);
    }

    /// Cuts a triangle from the middle of the longest side to be halved to the corner beyond it, and the two parts again.
    fn part(&self, surface: &OffsetSurface, corners: [u32; 3], parts: &mut Vec<[u32; 3]>) {
        let sides = sides(corners);
        // the map is asked for long sides only: it has no others
        let long = (0..3).map(|k| (k, length(surface, sides[k]))).filter(|(_, length)| *length > self.fine);
        let halved = long.filter_map(|(k, length)| Some((k, length, *self.numbers.get(&sides[k])?)));
        let Some((k, _, middle)) = halved.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            parts.push(corners);
            return;
        };
        let [a, b, c] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
        self.part(surface, [a, middle, c], parts);
        self.part(surface, [middle, b, c], parts);
    }
}

/// The sides by their ends, the lower first; side k runs from corner k to the next.
fn sides([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)].map(|(p, q)| (p.min(q), p.max(q)))
}

fn length(surface: &OffsetSurface, side: (u32, u32)) -> f64 {
    (surface.points[side.0 as usize].contact - surface.points[side.1 as usize].contact).norm()
}

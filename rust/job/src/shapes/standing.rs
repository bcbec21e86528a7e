//! The sheet as it stands while it is formed, point by point of what is drawn.
//!
//! As for the verifier's check of the order of passes (docs/concepts/forming-processes.md): a point stands as high as the best
//! path to it from where the sheet is held up, and a path is as high as its lowest point. Here the points are those of the formed
//! sheet's upper face, and a point is pressed down as far as the tools' profiles above it went, never below its formed height.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use styluscam_geometry::{Cutter, Facets};
use styluscam_verify::Support;

use super::formed;

/// Distance of the tool's positions that are looked at along a path, as a share of its radius.
const STEP: f64 = 0.25;
/// A point is held where it is lower than the highest by no more than this, mm.
const SAME: f64 = 1e-3;

/// A tool's way over the sheet.
pub struct Travel<'a> {
    /// Positions of the tips, mm, one after the other.
    pub tips: &'a [[f64; 3]],
    /// The tool that goes to each of them; none where it is not known.
    pub tools: &'a [Option<&'a Cutter>],
    /// The positions behind which the sheet is looked at: numbers that rise.
    pub moments: &'a [usize],
}

/// How far each point of the upper face stands above its formed height at each moment, mm; flat at `flat` before.
pub(super) fn heights(face: &Facets, flat: f64, support: Support, travel: &Travel<'_>) -> Vec<Vec<f64>> {
    let mut sheet = Sheet::new(face, flat, support);
    let mut found = Vec::with_capacity(travel.moments.len());
    let mut next = 0;
    for moment in travel.moments {
        let last = (moment + 1).min(travel.tips.len());
        for index in next..last {
            if let Some(cutter) = travel.tools.get(index).copied().flatten() {
                let from = travel.tips[index.saturating_sub(1)];
                sheet.press_along(if index == 0 { travel.tips[0] } else { from }, travel.tips[index], cutter);
            }
        }
        next = next.max(last);
        found.push(sheet.stands());
    }
    found
}

struct Sheet<'a> {
    face: &'a Facets,
    flat: f64,
    support: Support,
    pressed: Vec<f64>,
    beside: Vec<Vec<u32>>,
    border: Vec<u32>,
    lowest: f64,
    low: [f64; 2],
    cell: f64,
    /// How far apart the points are at most, mm: a narrower tool presses the nearest down, else its loop would have holes.
    spacing: f64,
    counts: [usize; 2],
    cells: Vec<Vec<u32>>,
}

impl<'a> Sheet<'a> {
    fn new(face: &'a Facets, flat: f64, support: Support) -> Self {
        let (low, high) = face.bounds();
        let cell = (high.x - low.x).max(high.y - low.y).max(f64::MIN_POSITIVE) / 64.0;
        let counts = [high.x - low.x, high.y - low.y].map(|side| (side / cell) as usize + 1);
        let mut beside = vec![Vec::new(); face.points.len()];
        for [a, b, c] in &face.triangles {
            for (from, to) in [(a, b), (b, c), (c, a), (b, a), (c, b), (a, c)] {
                beside[*from as usize].push(*to);
            }
        }
        let mut sheet = Self {
            face,
            flat,
            support,
            pressed: vec![flat; face.points.len()],
            beside,
            border: face.borders().into_iter().map(|[a, _]| a).collect(),
            lowest: flat,
            low: [low.x, low.y],
            cell,
            spacing: formed::spacing(face),
            counts,
            cells: vec![Vec::new(); counts[0] * counts[1]],
        };
        for (number, point) in face.points.iter().enumerate() {
            let [i, j] = sheet.cell_of([point.x, point.y]);
            sheet.cells[j * counts[0] + i].push(number as u32);
        }
        sheet
    }

    fn cell_of(&self, position: [f64; 2]) -> [usize; 2] {
        // negative ones become 0
        [0, 1].map(|k| (((position[k] - self.low[k]) / self.cell) as usize).min(self.counts[k] - 1))
    }

    fn press_along(&mut self, from: [f64; 3], to: [f64; 3], cutter: &Cutter) {
        if from[2].min(to[2]) >= self.flat {
            return;
        }
        let length = libm::hypot(libm::hypot(to[0] - from[0], to[1] - from[1]), to[2] - from[2]);
        let count = (length / (STEP * cutter.max_radius()).max(f64::MIN_POSITIVE)).ceil().clamp(1.0, 1e6) as u32;
        for step in 1..=count {
            let share = f64::from(step) / f64::from(count);
            self.press([0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * share), cutter);
        }
    }

    fn press(&mut self, [x, y, z]: [f64; 3], cutter: &Cutter) {
        self.lowest = self.lowest.min(z);
        let reach = cutter.max_radius().max(self.spacing);
        let ([left, front], [right, back]) =
            (self.cell_of([x - reach, y - reach]), self.cell_of([x + reach, y + reach]));
        for cell in (front..=back).flat_map(|j| (left..=right).map(move |i| (i, j))) {
            for number in &self.cells[cell.1 * self.counts[0] + cell.0] {
                let at = *number as usize;
                let point = self.face.points[at];
                let radius = libm::hypot(point.x - x, point.y - y);
                if radius <= reach {
                    let height = z + cutter.quick_height_at_radius(radius.min(cutter.max_radius()));
                    self.pressed[at] = self.pressed[at].min(height.max(point.z));
                }
            }
        }
    }

    /// How far each point stands above its formed height.
    fn stands(&self) -> Vec<f64> {
        let points = &self.face.points;
        let highest = points.iter().map(|point| point.z).fold(f64::NEG_INFINITY, f64::max);
        let held: Vec<(u32, f64)> = match self.support {
            Support::Rim => {
                (0..).zip(points).filter(|(_, p)| p.z >= highest - SAME).map(|(i, _)| (i, self.flat)).collect()
            }
            // nothing clamps a sheet on a mandrel: it is drawn as low as the tool has been, as over a die
            Support::DieAndFrame | Support::Mandrel => {
                let on_die = (0..).zip(points).map(|(i, p)| (i, p.z));
                on_die.chain(self.border.iter().map(|i| (*i, self.lowest))).collect()
            }
        };
        let mut heights = vec![f64::NEG_INFINITY; points.len()];
        let mut next: BinaryHeap<Held> =
            held.into_iter().map(|(at, height)| Held { height: height.min(self.pressed[at as usize]), at }).collect();
        while let Some(Held { height, at }) = next.pop() {
            if heights[at as usize] >= height {
                continue; // a better path has led there
            }
            heights[at as usize] = height;
            for other in &self.beside[at as usize] {
                let height = height.min(self.pressed[*other as usize]);
                if heights[*other as usize] < height {
                    next.push(Held { height, at: *other });
                }
            }
        }
        heights.iter().zip(points).map(|(height, point)| (height - point.z).max(0.0)).collect()
    }
}

/// A point and how high it stands: the highest comes first, of equal ones the first.
struct Held {
    height: f64,
    at: u32,
}

impl Ord for Held {
    fn cmp(&self, other: &Self) -> Ordering {
        self.height.total_cmp(&other.height).then(other.at.cmp(&self.at))
    }
}

impl PartialOrd for Held {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Held {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Held {}

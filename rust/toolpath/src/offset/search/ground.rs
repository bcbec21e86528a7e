//! What a search stands on: mesh and cutter, tiles of the plan, and the floor that a contact gives a tile.

use styluscam_geometry::Cutter;

use super::super::contact::{Best, Contacts};
use super::super::features::NO_NEIGHBOUR;
use super::super::index::{Index, Lines, Matched, Probe, WIDTH};

/// Triangles that a walk from the last contact crosses at most.
const WALK: usize = 64;
/// Rounding in a bound, as a share of the cutter's radius: that of f32 times the steepest line.
const ROUNDING: f64 = 1e-5;
/// And as a share of a height.
const SHARE: f32 = 1e-6;
/// The nodes of a survey's last level are at most this many times a quarter of the surveyed piece, about.
const SURVEYED: f64 = 0.12;

/// What the search needs of a mesh and a cutter.
pub struct Ground<'a> {
    pub index: &'a Index,
    pub cutter: &'a Cutter,
    pub contacts: Contacts<'a>,
    pub lines: &'a Lines,
    /// By level, as [`Index::levels`].
    pub matched: &'a [Vec<Matched>],
    /// A height below every contact, mm.
    pub bottom: f64,
}

/// A piece of the plan in which positions are answered together.
#[derive(Clone, Copy, Debug)]
pub struct Tile {
    pub middle: [f64; 2],
    pub half: [f64; 2],
    /// The middle relative to the index's centre: it is chosen so that this is exact.
    pub x: f32,
    pub y: f32,
}

/// A linear function below the tip heights of a tile, over the probe's z.
#[derive(Clone, Copy)]
pub struct Floor {
    pub level: f32,
    pub along: [f32; 2],
}

impl Floor {
    /// Whether a linear bound stays below the floor in a whole tile.
    #[inline]
    pub fn rules_out(&self, value: f32, along: [f32; 2], half: [f32; 2], margin: f32) -> bool {
        let more = (along[0] - self.along[0]).abs() * half[0] + (along[1] - self.along[1]).abs() * half[1];
        value + more + margin < self.level
    }
}

/// The members of a tile by quarters.
pub fn quarters(positions: &[[f64; 2]], members: &[u32], tile: &Tile) -> [Vec<u32>; 4] {
    let mut quarters: [Vec<u32>; 4] = Default::default();
    for member in members {
        let [x, y] = positions[*member as usize];
        quarters[usize::from(x > tile.middle[0]) + 2 * usize::from(y > tile.middle[1])].push(*member);
    }
    quarters
}

impl Ground<'_> {
    /// The level at which a survey of a piece of the plan ends: its nodes are some parts of the piece.
    pub fn stop(&self, tile: &Tile) -> usize {
        let mut area = WIDTH as f64 * self.index.area_per_triangle();
        let mut level = 0;
        while level + 1 < self.index.levels().len() && SURVEYED * area < tile.half[0] * tile.half[1] {
            area *= WIDTH as f64;
            level += 1;
        }
        level
    }

    /// The tile around some positions.
    pub fn tile(&self, positions: &[[f64; 2]], members: &[u32]) -> Tile {
        let centre = self.index.centre();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for member in members {
            for i in 0..2 {
                low[i] = low[i].min(positions[*member as usize][i]);
                high[i] = high[i].max(positions[*member as usize][i]);
            }
        }
        let exact = [0, 1].map(|i| (0.5 * (low[i] + high[i]) - centre[i]) as f32);
        let middle = [0, 1].map(|i| f64::from(exact[i]) + centre[i]);
        // the sum above rounds as well
        let half =
            [0, 1].map(|i| (high[i] - middle[i]).max(middle[i] - low[i]) * (1.0 + 1e-6) + 1e-15 * middle[i].abs());
        Tile { middle, half, x: exact[0], y: exact[1] }
    }

    pub fn probe(&self, tile: &Tile, found: &Best) -> Probe {
        let reach = self.cutter.max_radius() + libm::hypot(tile.half[0], tile.half[1]);
        Probe {
            x: tile.x,
            y: tile.y,
            z: (found.tip.max(self.bottom) - self.index.centre().z) as f32,
            reach: (reach * reach * (1.0 + 1e-5)) as f32,
        }
    }

    /// A height over `zero` below which a bound in single precision rules out a tip.
    #[inline]
    pub fn enough(&self, tip: f64, zero: f64) -> f32 {
        let over = (tip - zero) as f32;
        over - self.margin() - SHARE * over.abs()
    }

    pub fn margin(&self) -> f32 {
        (ROUNDING * self.cutter.max_radius()) as f32
    }

    /// From the last contact towards the triangle that holds its own: all of it is tried.
    pub fn guess(&self, position: [f64; 2], last: Option<u32>) -> Best {
        let mut found = Best::NOTHING;
        let (mut before, mut triangle) = (NO_NEIGHBOUR, last.unwrap_or(0));
        for _ in 0..WALK {
            match self.contacts.towards(triangle, position) {
                Some(next) if next != NO_NEIGHBOUR && next != before => (before, triangle) = (triangle, next),
                _ => break,
            }
        }
        self.contacts.touch_whole(triangle, position, &mut found);
        found
    }

    /// What the contact found over the middle keeps all of the tile above; where the cutter does not reach it from some
    /// corner, nothing is known.
    pub fn floor(&self, tile: &Tile, found: &Best, zero: f64, whole: bool) -> Floor {
        let nothing = Floor { level: (self.bottom - zero) as f32, along: [0.0; 2] };
        if !found.is_something() {
            return nothing;
        }
        if !whole {
            return Floor { level: (found.tip - zero) as f32, along: [0.0; 2] };
        }
        let away = [0, 1].map(|i| found.at[i] - tile.middle[i]);
        let distance = (away[0] * away[0] + away[1] * away[1]).sqrt();
        let rise = self.lines.rise_at(distance);
        let along = away.map(|a| if distance > 0.0 { rise * a / distance } else { 0.0 });
        let height = found.tip + self.lines.below(distance);
        let mut level = f64::INFINITY;
        for corner in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let [dx, dy] = [0, 1].map(|i| corner[i] * tile.half[i]);
            let (ax, ay) = (away[0] - dx, away[1] - dy);
            let tip = height - self.lines.above((ax * ax + ay * ay).sqrt());
            level = level.min(tip - along[0] * dx - along[1] * dy);
        }
        if level.is_infinite() {
            return nothing;
        }
        let level = (level - zero) as f32;
        Floor { level: level - SHARE * level.abs(), along: along.map(|a| a as f32) }
    }
}

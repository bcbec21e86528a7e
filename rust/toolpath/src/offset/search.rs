//! The search for contacts: one walk through the index for a tile of neighbouring places.
//!
//! A contact found over the tile's middle is a floor for the whole tile: the cutter cannot be lower beside it than that
//! point of the mesh lets it. What cannot rise above the floor anywhere in the tile is passed over; the triangles
//! that are left are then tried for each place.

use styluscam_geometry::Cutter;
use wide::f32x8;

use super::contact::{Best, Contacts};
use super::features::NO_NEIGHBOUR;
use super::index::{Index, Lines, Matched, Probe, WIDTH};

/// Triangles that a walk from the last contact crosses at most.
const WALK: usize = 64;
/// Rounding in a bound, as a share of the cutter's radius: that of f32 times the steepest line.
const ROUNDING: f64 = 1e-5;
/// A tile of more candidates than this is quartered.
const CROWDED: usize = 40;

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

/// Memory of a search, used again from tile to tile.
#[derive(Default)]
pub struct Searcher {
    stack: Vec<Branch>,
    candidates: Candidates,
    /// Where the last search ended: neighbours begin there.
    last: Option<u32>,
}

/// A node still to be opened.
#[derive(Clone, Copy)]
struct Branch {
    level: u32,
    node: u32,
    /// Highest tip in the node over the middle of the tile, over the probe's z, and its gradient in the tile.
    value: f32,
    along: [f32; 2],
}

/// Triangles that may be touched somewhere in a tile, with their bounds.
#[derive(Default)]
struct Candidates {
    /// Height from which the values count, mm.
    zero: f64,
    triangles: Vec<u32>,
    values: Vec<f32>,
    along: [Vec<f32>; 2],
}

/// A piece of the plan in which places are answered together.
#[derive(Clone, Copy, Debug)]
struct Tile {
    middle: [f64; 2],
    half: [f64; 2],
    /// The middle relative to the index's centre: it is chosen so that this is exact.
    x: f32,
    y: f32,
}

/// A linear function below the tip heights of a tile, over the probe's z.
#[derive(Clone, Copy)]
struct Floor {
    level: f32,
    along: [f32; 2],
}

impl Searcher {
    /// The highest contact over one place. `hint`: a triangle near it.
    pub fn one(&mut self, ground: &Ground<'_>, place: [f64; 2], hint: Option<u32>) -> Best {
        let tile = ground.tile(&[place], &[0]);
        self.last = hint.or(self.last);
        let mut found = ground.guess(place, self.last);
        self.explore(ground, &tile, place, &mut found, false);
        if found.is_something() {
            self.last = Some(found.triangle);
        }
        found
    }

    /// The highest contacts over the places named by `members`, which lie together.
    pub fn many(
        &mut self,
        ground: &Ground<'_>,
        places: &[[f64; 2]],
        members: &[u32],
        keep: &mut impl FnMut(u32, Best),
    ) {
        if let [only] = members {
            let found = self.one(ground, places[*only as usize], None);
            return keep(*only, found);
        }
        let tile = ground.tile(places, members);
        let mut found = ground.guess(tile.middle, self.last);
        self.explore(ground, &tile, tile.middle, &mut found, true);
        if found.is_something() {
            self.last = Some(found.triangle);
        }
        if self.candidates.triangles.len() > CROWDED && members.len() > 1 {
            return self.quartered(ground, places, members, &tile, keep);
        }
        self.candidates.pad();
        for member in members {
            let place = places[*member as usize];
            keep(*member, self.settle(ground, &tile, place));
        }
    }

    fn quartered(
        &mut self,
        ground: &Ground<'_>,
        places: &[[f64; 2]],
        members: &[u32],
        tile: &Tile,
        keep: &mut impl FnMut(u32, Best),
    ) {
        let mut quarters: [Vec<u32>; 4] = Default::default();
        for member in members {
            let [x, y] = places[*member as usize];
            let quarter = usize::from(x > tile.middle[0]) + 2 * usize::from(y > tile.middle[1]);
            quarters[quarter].push(*member);
        }
        let whole = quarters.iter().any(|quarter| quarter.len() == members.len());
        for quarter in quarters.iter().filter(|quarter| !quarter.is_empty()) {
            if whole {
                // all at one place, or nearly
                for member in quarter {
                    let found = self.one(ground, places[*member as usize], None);
                    keep(*member, found);
                }
            } else {
                self.many(ground, places, quarter, keep);
            }
        }
    }

    /// Walks through the index: `found` becomes the highest contact over `place`; what may be touched elsewhere in the
    /// tile is collected.
    fn explore(&mut self, ground: &Ground<'_>, tile: &Tile, place: [f64; 2], found: &mut Best, collect: bool) {
        let levels = ground.index.levels();
        let probe = ground.probe(tile, found);
        let zero = ground.zero(&probe);
        let half_width = tile.half.map(|h| h as f32);
        let half = half_width.map(f32x8::splat);
        let mut floor = ground.floor(tile, found, zero, collect);
        let margin = ground.margin();
        self.candidates.clear(zero);
        self.stack.clear();
        let root = Branch { level: levels.len() as u32 - 1, node: 0, value: f32::INFINITY, along: [0.0; 2] };
        self.stack.push(root);
        while let Some(branch) = self.stack.pop() {
            if floor.rules_out(branch.value, branch.along, half_width, margin) {
                continue;
            }
            let (level, node) = (branch.level as usize, branch.node as usize);
            let bounds = levels[level][node].bounds(&ground.matched[level][node], &probe, ground.lines);
            let more = (bounds.along[0] - f32x8::splat(floor.along[0])).abs() * half[0]
                + (bounds.along[1] - f32x8::splat(floor.along[1])).abs() * half[1]
                + f32x8::splat(margin);
            let open = !(bounds.value + more).simd_lt(f32x8::splat(floor.level)).to_bitmask() & 0xff;
            if open == 0 {
                continue;
            }
            let (values, along) = (bounds.value.to_array(), bounds.along.map(f32x8::to_array));
            if level > 0 {
                self.push_children(&values, &along, open, branch);
                continue;
            }
            let more = more.to_array();
            let mut rest = open;
            while rest != 0 {
                let lane = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                let triangle = ground.index.of_piece(branch.node * WIDTH as u32 + lane as u32);
                let height = values[lane] + if collect { margin } else { more[lane] };
                if f64::from(height) + zero >= found.tip {
                    let before = found.tip;
                    ground.contacts.touch(triangle, place, found);
                    if found.tip > before {
                        floor = ground.floor(tile, found, zero, collect);
                    }
                }
                if collect {
                    self.candidates.push(triangle, values[lane], [along[0][lane], along[1][lane]]);
                }
            }
        }
        if collect {
            self.candidates.keep_above(&floor, half_width, margin);
        }
    }

    /// Puts the open children on the stack, the highest on top.
    #[inline]
    fn push_children(&mut self, values: &[f32; WIDTH], along: &[[f32; WIDTH]; 2], open: u32, parent: Branch) {
        let begin = self.stack.len();
        let mut rest = open;
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let child = Branch {
                level: parent.level - 1,
                node: parent.node * WIDTH as u32 + lane as u32,
                value: values[lane],
                along: along.map(|row| row[lane]),
            };
            let mut place = self.stack.len();
            self.stack.push(child);
            while place > begin && self.stack[place - 1].value > child.value {
                self.stack[place] = self.stack[place - 1];
                place -= 1;
            }
            self.stack[place] = child;
        }
    }

    /// The highest contact over a place of the tile, among the candidates.
    fn settle(&mut self, ground: &Ground<'_>, tile: &Tile, place: [f64; 2]) -> Best {
        let mut found = ground.guess(place, self.last);
        let [dx, dy] = [0, 1].map(|i| f32x8::splat((place[i] - tile.middle[i]) as f32));
        let margin = ground.margin();
        for start in (0..self.candidates.triangles.len()).step_by(WIDTH) {
            let eight = |row: &[f32]| {
                let mut lanes = [0.0; WIDTH];
                lanes.copy_from_slice(&row[start..start + WIDTH]);
                f32x8::new(lanes)
            };
            let heights = eight(&self.candidates.values)
                + eight(&self.candidates.along[0]) * dx
                + eight(&self.candidates.along[1]) * dy
                + f32x8::splat(margin);
            let limit = (found.tip - self.candidates.zero) as f32;
            let mut open = !heights.simd_lt(f32x8::splat(limit)).to_bitmask() & 0xff;
            while open != 0 {
                let lane = open.trailing_zeros() as usize;
                open &= open - 1;
                let triangle = self.candidates.triangles[start + lane];
                if triangle != NO_NEIGHBOUR {
                    ground.contacts.touch(triangle, place, &mut found);
                }
            }
        }
        if found.is_something() {
            self.last = Some(found.triangle);
        }
        found
    }
}

impl Floor {
    /// Whether a linear bound stays below the floor in a whole tile.
    #[inline]
    fn rules_out(&self, value: f32, along: [f32; 2], half: [f32; 2], margin: f32) -> bool {
        let more = (along[0] - self.along[0]).abs() * half[0] + (along[1] - self.along[1]).abs() * half[1];
        value + more + margin < self.level
    }
}

impl Candidates {
    fn clear(&mut self, zero: f64) {
        self.zero = zero;
        self.triangles.clear();
        self.values.clear();
        self.along.iter_mut().for_each(Vec::clear);
    }

    #[inline]
    fn push(&mut self, triangle: u32, value: f32, along: [f32; 2]) {
        self.triangles.push(triangle);
        self.values.push(value);
        self.along[0].push(along[0]);
        self.along[1].push(along[1]);
    }

    /// Leaves out what the last floor rules out: most were collected under lower ones.
    fn keep_above(&mut self, floor: &Floor, half: [f32; 2], margin: f32) {
        let mut kept = 0;
        for i in 0..self.triangles.len() {
            let along = [self.along[0][i], self.along[1][i]];
            if floor.rules_out(self.values[i], along, half, margin) {
                continue;
            }
            self.triangles[kept] = self.triangles[i];
            self.values[kept] = self.values[i];
            (self.along[0][kept], self.along[1][kept]) = (along[0], along[1]);
            kept += 1;
        }
        self.triangles.truncate(kept);
        self.values.truncate(kept);
        self.along.iter_mut().for_each(|row| row.truncate(kept));
    }

    /// Fills up the last eight.
    fn pad(&mut self) {
        while self.triangles.len() % WIDTH != 0 {
            self.push(NO_NEIGHBOUR, f32::NEG_INFINITY, [0.0; 2]);
        }
    }
}

impl Ground<'_> {
    /// The tile around some places.
    fn tile(&self, places: &[[f64; 2]], members: &[u32]) -> Tile {
        let centre = self.index.centre();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for member in members {
            for i in 0..2 {
                low[i] = low[i].min(places[*member as usize][i]);
                high[i] = high[i].max(places[*member as usize][i]);
            }
        }
        let exact = [0, 1].map(|i| (0.5 * (low[i] + high[i]) - centre[i]) as f32);
        let middle = [0, 1].map(|i| f64::from(exact[i]) + centre[i]);
        // the sum above rounds as well
        let half =
            [0, 1].map(|i| (high[i] - middle[i]).max(middle[i] - low[i]) * (1.0 + 1e-6) + 1e-15 * middle[i].abs());
        Tile { middle, half, x: exact[0], y: exact[1] }
    }

    fn probe(&self, tile: &Tile, found: &Best) -> Probe {
        let reach = self.cutter.max_radius() + tile.half[0].hypot(tile.half[1]);
        Probe {
            x: tile.x,
            y: tile.y,
            z: (found.tip.max(self.bottom) - self.index.centre().z) as f32,
            reach: (reach * reach * (1.0 + 1e-5)) as f32,
        }
    }

    fn zero(&self, probe: &Probe) -> f64 {
        f64::from(probe.z) + self.index.centre().z
    }

    fn margin(&self) -> f32 {
        (ROUNDING * self.cutter.max_radius()) as f32
    }

    /// From the last contact towards the triangle that holds its own: all of it is tried.
    fn guess(&self, place: [f64; 2], last: Option<u32>) -> Best {
        let mut found = Best::NOTHING;
        let (mut before, mut triangle) = (NO_NEIGHBOUR, last.unwrap_or(0));
        for _ in 0..WALK {
            match self.contacts.towards(triangle, place) {
                Some(next) if next != NO_NEIGHBOUR && next != before => (before, triangle) = (triangle, next),
                _ => break,
            }
        }
        self.contacts.touch_whole(triangle, place, &mut found);
        found
    }

    /// What the contact found over the middle keeps all of the tile above.
    fn floor(&self, tile: &Tile, found: &Best, zero: f64, whole: bool) -> Floor {
        if !found.is_something() {
            return Floor { level: (self.bottom - zero) as f32, along: [0.0; 2] };
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
            let tip = (height - self.lines.above((ax * ax + ay * ay).sqrt())).max(self.bottom);
            level = level.min(tip - along[0] * dx - along[1] * dy);
        }
        Floor { level: (level - zero) as f32, along: along.map(|a| a as f32) }
    }
}

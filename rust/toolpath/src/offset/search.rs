//! The search for contacts: one walk through the index for a tile of neighbouring places.
//!
//! A contact found over the tile's middle is a floor for the whole tile: the cutter cannot be lower beside it than that
//! point of the mesh lets it. What cannot rise above the floor anywhere in the tile is passed over; the triangles
//! that are left are then tried for each place.

use styluscam_geometry::Cutter;
use wide::f32x8;

use super::contact::{Best, Contacts};
use super::features::NO_NEIGHBOUR;
use super::index::{Bounds, Index, Lines, Matched, Probe, WIDTH};

/// Triangles that a walk from the last contact crosses at most.
const WALK: usize = 64;
/// Rounding in a bound, as a share of the cutter's radius: that of f32 times the steepest line.
const ROUNDING: f64 = 1e-5;
/// A tile of more candidates than this is quartered,
const CROWDED: usize = 64;
/// if they are fewer than this share of those of the tile that it is a quarter of.
const WORTH_QUARTERING: f64 = 0.8;

/// Nodes of a survey's last level that cover a quarter of the surveyed piece, about.
const SURVEYED: f64 = 4.;
/// A survey of more branches than this says nothing.
const MOST_BRANCHES: usize = 128;

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
    /// Nodes of the first level that candidates come from.
    leaves: Vec<Branch>,
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

/// The branches in which all contacts of a piece of the plan are.
struct Survey {
    branches: Vec<Branch>,
    /// What the branches' values are relative to.
    middle: [f64; 2],
    zero: f64,
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
        self.last = hint.or(self.last);
        self.one_among(ground, &Survey::whole(ground), place)
    }

    fn one_among(&mut self, ground: &Ground<'_>, survey: &Survey, place: [f64; 2]) -> Best {
        let tile = ground.tile(&[place], &[0]);
        let mut found = ground.guess(place, self.last);
        self.explore(ground, survey, &tile, place, &mut found, false);
        self.remember(&found);
        found
    }

    /// The highest contacts over the places of some tiles, one after the other in `members`, beginning at `starts`.
    pub fn many(
        &mut self,
        ground: &Ground<'_>,
        places: &[[f64; 2]],
        members: &[u32],
        starts: &[u32],
        keep: &mut impl FnMut(u32, Best),
    ) {
        let (Some(first), Some(last)) = (starts.first(), starts.last()) else { return };
        let survey = self.survey(ground, &ground.tile(places, &members[*first as usize..*last as usize]));
        for tile in starts.windows(2) {
            self.many_among(ground, &survey, places, &members[tile[0] as usize..tile[1] as usize], usize::MAX, keep);
        }
    }

    /// The highest contacts over the places named by `members`, which lie together; `before`: candidates of the tile that
    /// this one is a quarter of.
    fn many_among(
        &mut self,
        ground: &Ground<'_>,
        survey: &Survey,
        places: &[[f64; 2]],
        members: &[u32],
        before: usize,
        keep: &mut impl FnMut(u32, Best),
    ) {
        if let [only] = members {
            let found = self.one_among(ground, survey, places[*only as usize]);
            return keep(*only, found);
        }
        let tile = ground.tile(places, members);
        let mut found = ground.guess(tile.middle, self.last);
        self.explore(ground, survey, &tile, tile.middle, &mut found, true);
        self.remember(&found);
        let count = self.candidates.triangles.len();
        if count > CROWDED && (count as f64) < WORTH_QUARTERING * before as f64 {
            let leaves =
                Survey { branches: std::mem::take(&mut self.leaves), middle: tile.middle, zero: self.candidates.zero };
            for quarter in quarters(places, members, &tile).iter().filter(|quarter| !quarter.is_empty()) {
                self.many_among(ground, &leaves, places, quarter, count, keep);
            }
            return;
        }
        self.candidates.pad();
        for member in members {
            keep(*member, self.settle(ground, &tile, places[*member as usize]));
        }
    }

    fn remember(&mut self, found: &Best) {
        if found.is_something() {
            self.last = Some(found.triangle);
        }
    }

    /// The branches in which all contacts of a piece of the plan are: found once, for its tiles.
    fn survey(&mut self, ground: &Ground<'_>, tile: &Tile) -> Survey {
        let stop = ground.stop(tile);
        let whole = Survey::whole(ground);
        if stop + 1 >= ground.index.levels().len() {
            return whole;
        }
        let found = ground.guess(tile.middle, self.last);
        let view = View::of(ground, tile, &found);
        let floor = ground.floor(tile, &found, view.zero, true);
        let mut branches = Vec::new();
        self.stack.clear();
        self.stack.extend_from_slice(&whole.branches);
        while let Some(branch) = self.stack.pop() {
            if branch.level as usize == stop {
                branches.push(branch);
                if branches.len() > MOST_BRANCHES {
                    return whole;
                }
                continue;
            }
            let (bounds, open, _) = view.opened(ground, &floor, branch);
            self.push_children(&bounds.value.to_array(), &bounds.along.map(f32x8::to_array), open, branch);
        }
        Survey { branches, middle: tile.middle, zero: view.zero }
    }

    /// Walks through the branches of a survey: `found` becomes the highest contact over `place`; what may be touched
    /// elsewhere in the tile is collected.
    fn explore(
        &mut self,
        ground: &Ground<'_>,
        survey: &Survey,
        tile: &Tile,
        place: [f64; 2],
        found: &mut Best,
        collect: bool,
    ) {
        let view = View::of(ground, tile, found);
        let mut floor = ground.floor(tile, found, view.zero, collect);
        self.candidates.clear(view.zero);
        self.leaves.clear();
        self.stack.clear();
        // those found first are the highest: they go on top
        self.stack.extend(survey.branches.iter().rev().map(|branch| survey.moved(*branch, &view)));
        while let Some(branch) = self.stack.pop() {
            if floor.rules_out(branch.value, branch.along, view.half, view.margin) {
                continue;
            }
            let (bounds, open, more) = view.opened(ground, &floor, branch);
            if open == 0 {
                continue;
            }
            let (values, along) = (bounds.value.to_array(), bounds.along.map(f32x8::to_array));
            if branch.level > 0 {
                self.push_children(&values, &along, open, branch);
                continue;
            }
            self.leaves.push(branch);
            let more = more.to_array();
            let mut rest = open;
            while rest != 0 {
                let lane = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                let triangle = ground.index.of_piece(branch.node * WIDTH as u32 + lane as u32);
                let height = values[lane] + if collect { view.margin } else { more[lane] };
                if f64::from(height) + view.zero >= found.tip {
                    let before = found.tip;
                    ground.contacts.touch(triangle, place, found);
                    if found.tip > before {
                        floor = ground.floor(tile, found, view.zero, collect);
                    }
                }
                if collect {
                    self.candidates.push(triangle, values[lane], [along[0][lane], along[1][lane]]);
                }
            }
        }
        if collect {
            self.candidates.keep_above(&floor, view.half, view.margin);
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
        self.remember(&found);
        found
    }
}

/// A tile as the index sees it: in single precision, heights from a contact's.
struct View {
    middle: [f64; 2],
    probe: Probe,
    /// Height from which values count, mm.
    zero: f64,
    half: [f32; 2],
    margin: f32,
}

impl View {
    fn of(ground: &Ground<'_>, tile: &Tile, found: &Best) -> Self {
        let probe = ground.probe(tile, found);
        let zero = f64::from(probe.z) + ground.index.centre().z;
        Self { middle: tile.middle, probe, zero, half: tile.half.map(|h| h as f32), margin: ground.margin() }
    }

    /// The bounds of a node's children, those that reach the floor somewhere in the tile, and what the bounds rise to
    /// at most over it.
    #[inline]
    fn opened(&self, ground: &Ground<'_>, floor: &Floor, branch: Branch) -> (Bounds, u32, f32x8) {
        let (level, node) = (branch.level as usize, branch.node as usize);
        let bounds = ground.index.levels()[level][node].bounds(&ground.matched[level][node], &self.probe, ground.lines);
        let more = (bounds.along[0] - f32x8::splat(floor.along[0])).abs() * f32x8::splat(self.half[0])
            + (bounds.along[1] - f32x8::splat(floor.along[1])).abs() * f32x8::splat(self.half[1])
            + f32x8::splat(self.margin);
        let open = !(bounds.value + more).simd_lt(f32x8::splat(floor.level)).to_bitmask() & 0xff;
        (bounds, open, more)
    }
}

impl Survey {
    /// The root: nothing is known.
    fn whole(ground: &Ground<'_>) -> Self {
        let level = ground.index.levels().len() - 1;
        let root = Branch { level: level as u32, node: 0, value: f32::INFINITY, along: [0.0; 2] };
        Self { branches: vec![root], middle: [0.0; 2], zero: 0.0 }
    }

    /// A branch with its value over another middle.
    #[inline]
    fn moved(&self, branch: Branch, view: &View) -> Branch {
        let [dx, dy] = [0, 1].map(|i| (view.middle[i] - self.middle[i]) as f32);
        let value = branch.value + branch.along[0] * dx + branch.along[1] * dy + (self.zero - view.zero) as f32;
        Branch { value, ..branch }
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
        while !self.triangles.len().is_multiple_of(WIDTH) {
            self.push(NO_NEIGHBOUR, f32::NEG_INFINITY, [0.0; 2]);
        }
    }
}

/// The members of a tile by quarters.
fn quarters(places: &[[f64; 2]], members: &[u32], tile: &Tile) -> [Vec<u32>; 4] {
    let mut quarters: [Vec<u32>; 4] = Default::default();
    for member in members {
        let [x, y] = places[*member as usize];
        quarters[usize::from(x > tile.middle[0]) + 2 * usize::from(y > tile.middle[1])].push(*member);
    }
    quarters
}

impl Ground<'_> {
    /// The level at which a survey of a piece of the plan ends: its nodes are some parts of the piece.
    fn stop(&self, tile: &Tile) -> usize {
        let mut area = WIDTH as f64 * self.index.area_per_triangle();
        let mut level = 0;
        while SURVEYED * area < tile.half[0] * tile.half[1] {
            area *= WIDTH as f64;
            level += 1;
        }
        level
    }

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

//! The search for contacts: one walk through the index for a tile of neighbouring positions.
//!
//! A contact found over the tile's middle is a floor for the whole tile: the cutter cannot be lower beside it than that
//! point of the mesh lets it. What cannot rise above the floor anywhere in the tile is passed over; the triangles
//! that are left are then tried for each position.
//!
//! Branch and bound over a hierarchy of boxes; why the bounds hold: docs/concepts/search-bounds.md.

mod candidates;
mod ground;
mod tangents;
mod trials;
mod view;

use std::cell::RefCell;

use wide::f32x8;

use super::contact::{Best, Chord};
use super::index::{HalfLine, WIDTH};
use crate::lattice::{Cells, Lattice, Node};
use candidates::Candidates;
use ground::{quarters, Tile};
use trials::Trials;
use view::{Branch, Survey, View};

pub use ground::Ground;
#[cfg(test)]
pub use tangents::Eight;

/// A tile of more candidates than this is quartered.
const CROWDED: usize = 128;
/// A quarter is quartered again only if it has fewer candidates than this share of its tile's.
const WORTH_QUARTERING: f64 = 0.8;
/// A survey of more branches than this saves no work.
const MOST_BRANCHES: usize = 128;

/// Chords are looked along in parts of at most so many times the cutter's radius.
const PART: f64 = 4.0;
/// Triangles that are tried for a part at most: where thousands of slivers meet, a proof takes longer than it saves.
const MOST_TRIED: usize = 256;
/// Bounds over their ends are so many times as far from those over the middle as in a tile: their rounding.
const MARGINS: f32 = 4.0;
/// Rounding of a height in single precision, as a share of it.
const SHARE: f32 = 1e-6;

/// What is known of a piece of the plan and a height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The tip must stay over the height everywhere.
    Above,
    /// It need not anywhere.
    Free,
    /// Neither, or not known.
    Open,
}

/// What is known of the tips along a chord.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeping {
    /// They stay under the heights asked about.
    Under,
    /// One is over, or looks so.
    Over,
    /// Not known: more triangles come that near to the chord than are tried.
    Crowded,
}

/// What a walk looks for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Goal {
    /// The highest contact over the position.
    Highest,
    /// Any contact over the position that is over a height.
    Over(f64),
    /// The highest contact, and what may be touched elsewhere in the tile.
    Candidates,
}

/// Memory of a search, used again from tile to tile.
#[derive(Default)]
pub struct Searcher {
    stack: Vec<Branch>,
    candidates: Candidates,
    /// Nodes of the first level that candidates come from.
    leaves: Vec<Branch>,
    trials: Trials,
    /// Where the last search ended: neighbours begin there.
    last: Option<u32>,
}

thread_local! {
    /// Memory of this thread's searches.
    static MEMORY: RefCell<Searcher> = RefCell::default();
}

impl Searcher {
    /// A search with memory that is there already, and that knows of none before: the answer is the same on any thread.
    pub fn with<T>(search: impl FnOnce(&mut Self) -> T) -> T {
        MEMORY.with_borrow_mut(|searcher| {
            searcher.last = None;
            search(searcher)
        })
    }

    /// The highest contact over one position. `hint`: a triangle near it.
    pub fn one(&mut self, ground: &Ground<'_>, position: [f64; 2], hint: Option<u32>) -> Best {
        self.last = hint.or(self.last);
        self.one_among(ground, &Survey::whole(ground), position)
    }

    fn one_among(&mut self, ground: &Ground<'_>, survey: &Survey, position: [f64; 2]) -> Best {
        let tile = ground.tile(&[position], &[0]);
        let mut found = ground.guess(position, self.last);
        self.explore(ground, survey, &tile, position, &mut found, Goal::Highest);
        self.remember(&found);
        found
    }

    /// A triangle over which the tip must stay higher than `z` at a position, if there is one. `hint`: a triangle near it.
    pub fn over(&mut self, ground: &Ground<'_>, position: [f64; 2], z: f64, hint: Option<u32>) -> Option<u32> {
        self.last = hint.or(self.last);
        let mut found = ground.guess(position, self.last);
        if found.tip <= z {
            // what does not rise over the height is passed over
            found.tip = z;
            let tile = ground.tile(&[position], &[0]);
            self.explore(ground, &Survey::whole(ground), &tile, position, &mut found, Goal::Over(z));
        }
        self.remember(&found);
        (found.tip > z).then_some(found.triangle)
    }

    /// The highest contacts over the positions of some tiles, one after the other in `members`, beginning at `starts`.
    pub fn many(
        &mut self,
        ground: &Ground<'_>,
        positions: &[[f64; 2]],
        members: &[u32],
        starts: &[u32],
        keep: &mut impl FnMut(u32, Best),
    ) {
        let (Some(first), Some(last)) = (starts.first(), starts.last()) else { return };
        let survey = self.survey(ground, &ground.tile(positions, &members[*first as usize..*last as usize]));
        for tile in starts.windows(2) {
            self.many_among(ground, &survey, positions, &members[tile[0] as usize..tile[1] as usize], usize::MAX, keep);
        }
    }

    /// The highest contacts over the positions named by `members`, which lie together; `before`: candidates of the tile that
    /// this one is a quarter of.
    fn many_among(
        &mut self,
        ground: &Ground<'_>,
        survey: &Survey,
        positions: &[[f64; 2]],
        members: &[u32],
        before: usize,
        keep: &mut impl FnMut(u32, Best),
    ) {
        if let [only] = members {
            let found = self.one_among(ground, survey, positions[*only as usize]);
            return keep(*only, found);
        }
        let tile = ground.tile(positions, members);
        let mut found = ground.guess(tile.middle, self.last);
        self.explore(ground, survey, &tile, tile.middle, &mut found, Goal::Candidates);
        self.remember(&found);
        let count = self.candidates.count();
        if count > CROWDED && (count as f64) < WORTH_QUARTERING * before as f64 {
            let leaves = self.surveyed(&tile);
            for quarter in quarters(positions, members, &tile).iter().filter(|quarter| !quarter.is_empty()) {
                self.many_among(ground, &leaves, positions, quarter, count, keep);
            }
            return;
        }
        self.settle(ground, &tile, positions, members, keep);
    }

    /// Looks for cells over which a tip may be higher than the `limit` of their rectangle, and calls `keep` with each of
    /// them and what no tip there exceeds.
    pub fn ceilings(
        &mut self,
        ground: &Ground<'_>,
        lattice: &Lattice,
        cells: Cells,
        limit: &impl Fn(&Cells) -> f64,
        keep: &mut impl FnMut(Node, f64),
    ) {
        self.ceilings_among(ground, &Survey::whole(ground), lattice, cells, limit, keep);
    }

    fn ceilings_among(
        &mut self,
        ground: &Ground<'_>,
        survey: &Survey,
        lattice: &Lattice,
        cells: Cells,
        limit: &impl Fn(&Cells) -> f64,
        keep: &mut impl FnMut(Node, f64),
    ) {
        let limit_here = limit(&cells);
        if limit_here == f64::INFINITY {
            return;
        }
        let tile = ground.tile(&lattice.corners(&cells), &[0, 1]);
        self.rising(ground, survey, &tile, limit_here);
        if self.leaves.is_empty() {
            return;
        }
        if cells.is_single() {
            let all = 0..self.candidates.count();
            let highest = all.fold(limit_here, |most, i| most.max(self.greatest(ground, &tile, i, most)));
            if highest > limit_here {
                keep(cells.from, highest);
            }
            return;
        }
        let leaves = self.surveyed(&tile);
        for part in cells.quarters() {
            self.ceilings_among(ground, &leaves, lattice, part, limit, keep);
        }
    }

    /// Collects the triangles on which the tip may rise over a height somewhere in a tile.
    fn rising(&mut self, ground: &Ground<'_>, survey: &Survey, tile: &Tile, height: f64) {
        let view = View::of(ground, tile, &Best { tip: height, ..Best::NOTHING });
        let enough = f32x8::splat((height - view.zero) as f32 - view.margin);
        self.candidates.clear(view.zero);
        self.leaves.clear();
        self.stack.clear();
        self.stack.extend_from_slice(&survey.branches);
        while let Some(branch) = self.stack.pop() {
            let (bounds, most) = view.opened_about(ground, branch);
            let open = !most.simd_lt(enough).to_bitmask() & 0xff;
            if open == 0 {
                continue;
            }
            let (values, along) = (bounds.value.to_array(), bounds.along.map(f32x8::to_array));
            if branch.level > 0 {
                self.push_children(&values, &along, open, branch);
                continue;
            }
            self.leaves.push(branch);
            for lane in (0..WIDTH).filter(|lane| open & (1 << lane) != 0) {
                let triangle = ground.index.of_piece(branch.node * WIDTH as u32 + lane as u32);
                self.candidates.push(triangle, values[lane], [along[0][lane], along[1][lane]]);
            }
        }
    }

    /// What a candidate does not exceed in the tile, by its contact.
    fn greatest(&self, ground: &Ground<'_>, tile: &Tile, candidate: usize, enough: f64) -> f64 {
        let (triangle, towards) = self.candidates.direction(candidate);
        ground.contacts.greatest(triangle, tile.middle, tile.half, towards, enough)
    }

    /// Whether the tip must stay over a height everywhere in a box of the plan, or need not anywhere.
    pub fn verdict(&mut self, ground: &Ground<'_>, corners: &[[f64; 2]; 2], z: f64) -> Verdict {
        let tile = ground.tile(corners, &[0, 1]);
        let mut found = ground.guess(tile.middle, self.last);
        self.explore(ground, &Survey::whole(ground), &tile, tile.middle, &mut found, Goal::Candidates);
        self.remember(&found);
        if found.tip > z {
            let above = ground.contacts.least(found.triangle, tile.middle, tile.half) > z;
            return if above { Verdict::Above } else { Verdict::Open };
        }
        let half = tile.half.map(|h| h as f32);
        let height = ground.enough(z, self.candidates.zero);
        let mut rising = (0..self.candidates.count()).filter(|i| self.candidates.most(*i, half) >= height);
        if rising.all(|i| self.greatest(ground, &tile, i, z) <= z) {
            Verdict::Free
        } else {
            Verdict::Open
        }
    }

    /// Whether the tip may stay within some height of a chord along all of it: no triangle asks for more than `most` gives for it
    /// over the chord, which is never less than `least`.
    pub fn keeps_under(
        &mut self,
        ground: &Ground<'_>,
        chord: &Chord,
        least: f64,
        most: &impl Fn(u32) -> f64,
    ) -> Keeping {
        let length = libm::hypot(chord.along[0], chord.along[1]);
        let parts = (length / (PART * ground.cutter.max_radius())).ceil().max(1.0);
        for i in 0..parts as usize {
            let part = chord.part(i as f64 / parts, (i + 1) as f64 / parts);
            match self.part_keeps_under(ground, &part, least, most) {
                Keeping::Under => {}
                other => return other,
            }
        }
        Keeping::Under
    }

    fn part_keeps_under(
        &mut self,
        ground: &Ground<'_>,
        chord: &Chord,
        least: f64,
        most: &impl Fn(u32) -> f64,
    ) -> Keeping {
        let tile = ground.tile(&[chord.from, chord.at(1.0).0], &[0, 1]);
        let middle = chord.at(0.5).1;
        let view = View::of(ground, &tile, &Best { tip: middle, ..Best::NOTHING });
        let line = HalfLine {
            half: chord.along.map(|part| 0.5 * part as f32),
            rise: 0.5 * chord.rise as f32,
            aside: [0, 1].map(|i| (tile.half[i] - 0.5 * chord.along[i].abs()) as f32),
        };
        let lowest = (middle - view.zero + least) as f32;
        let enough = f32x8::splat(lowest - SHARE * (lowest.abs() + line.rise.abs()) - MARGINS * view.margin);
        self.stack.clear();
        self.stack.extend(Survey::whole(ground).branches);
        let (mut last, mut tried) = (None, 0);
        while let Some(branch) = self.stack.pop() {
            let values = view.opened_over(ground, branch, &line);
            let mut open = !values.simd_lt(enough).to_bitmask() & 0xff;
            while open != 0 {
                let lane = open.trailing_zeros();
                open &= open - 1;
                let node = branch.node * WIDTH as u32 + lane;
                if branch.level > 0 {
                    self.stack.push(Branch { level: branch.level - 1, node, ..branch });
                    continue;
                }
                let triangle = ground.index.of_piece(node);
                if last == Some(triangle) {
                    continue;
                }
                if tried == MOST_TRIED {
                    return Keeping::Crowded;
                }
                if !ground.contacts.stays_under(triangle, chord, most(triangle)) {
                    return Keeping::Over;
                }
                (last, tried) = (Some(triangle), tried + 1);
            }
        }
        Keeping::Under
    }

    /// The leaves of the walk just made through a tile, as a survey of it.
    fn surveyed(&mut self, tile: &Tile) -> Survey {
        Survey { branches: std::mem::take(&mut self.leaves), middle: tile.middle, zero: self.candidates.zero }
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

    /// Walks through the branches of a survey: `found` becomes the highest contact over `position`; what may be touched
    /// elsewhere in the tile is collected.
    fn explore(
        &mut self,
        ground: &Ground<'_>,
        survey: &Survey,
        tile: &Tile,
        position: [f64; 2],
        found: &mut Best,
        goal: Goal,
    ) {
        let collect = goal == Goal::Candidates;
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
                // in a tile it pays to try a triangle that lifts the floor by more than what it loses towards the corners;
                // those not tried here are candidates all the same
                let spare =
                    if collect { view.margin - ((found.tip - view.zero) as f32 - floor.level) } else { more[lane] };
                if f64::from(values[lane] + spare) + view.zero >= found.tip {
                    let before = found.tip;
                    ground.contacts.touch(triangle, position, found);
                    if matches!(goal, Goal::Over(z) if found.tip > z) {
                        return;
                    }
                    if found.tip > before {
                        floor = ground.floor(tile, found, view.zero, collect);
                    }
                }
                if collect {
                    self.candidates.push(triangle, values[lane], [along[0][lane], along[1][lane]]);
                }
            }
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
            let mut slot = self.stack.len();
            self.stack.push(child);
            while slot > begin && self.stack[slot - 1].value > child.value {
                self.stack[slot] = self.stack[slot - 1];
                slot -= 1;
            }
            self.stack[slot] = child;
        }
    }

    /// The highest contacts over some positions of a tile, among the candidates.
    fn settle(
        &mut self,
        ground: &Ground<'_>,
        tile: &Tile,
        positions: &[[f64; 2]],
        members: &[u32],
        keep: &mut impl FnMut(u32, Best),
    ) {
        self.trials.clear();
        for member in members {
            let position = positions[*member as usize];
            let found = ground.guess(position, self.last);
            self.remember(&found);
            self.trials.begin(found, position);
            let away = [0, 1].map(|i| (position[i] - tile.middle[i]) as f32);
            let enough = ground.enough(found.tip, self.candidates.zero);
            let Self { candidates, trials, .. } = self;
            candidates.reaching(enough, away, |triangle| {
                if triangle != found.triangle {
                    trials.add(triangle);
                }
            });
        }
        self.trials.bound(ground, self.candidates.zero);
        for (number, member) in members.iter().enumerate() {
            keep(*member, self.trials.highest(number, ground, self.candidates.zero));
        }
    }
}

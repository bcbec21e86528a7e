//! Shorter orders by local search: or-opt and 2-opt.
//!
//! A block of one to three items moves to where it costs less (I. Or, "Traveling salesman-type combinatorial problems and their
//! relation to the logistics of regional blood banking", thesis, Northwestern University, 1976), the other way round where it
//! may; a stretch whose items may all be turned is turned as a whole (G. A. Croes, "A method for solving traveling-salesman
//! problems", Operations Research 6, 1958). Items are chains of passes with short links between them first, then single passes.
//! Only links to the nearest items are tried, so a round is linear in their number but for sorting and shifting, which are
//! bounded.

use rstar::{primitives::GeomWithData, RTree};
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use super::precedence::Precedence;
use super::sequence::{Sequence, Stop};
use super::{Air, LEAST};

/// Nearest items whose neighbours an item may become.
const NEIGHBOURS: usize = 10;
/// Items of a block, at most.
const BLOCK: usize = 3;
/// Rounds over all items, at most.
const ROUNDS: usize = 6;
/// Items that are shifted in all: for each item, at least and at most.
const SHIFTS: usize = 5000;
const FEW_SHIFTS: usize = 1_000_000;
const MANY_SHIFTS: usize = 200_000_000;
/// Items that are turned at once, at most.
const MOST_TURNED: usize = 1000;

/// The stops of a sequence in a shorter order.
///
/// # Errors
/// `Cancelled`.
pub fn improved(
    sequence: &Sequence<'_>,
    precedence: &Precedence,
    air: &Air,
    watch: &Watch,
) -> Result<Vec<Stop>, Cancelled> {
    let mut legs: Vec<Leg> = sequence.stops.iter().zip(&sequence.ends).map(|(stop, ends)| (*stop, *ends)).collect();
    for as_chains in [true, false, true] {
        let mut search = Search::new(&legs, as_chains, sequence, precedence, air);
        search.run(watch)?;
        legs = search.legs();
    }
    Ok(legs.into_iter().map(|(stop, _)| stop).collect())
}

/// A stop, and where the tool comes to it and leaves it.
type Leg = (Stop, [Vector; 2]);
type Place = Option<Vector>;
type Ends = RTree<GeomWithData<[f64; 3], usize>>;

/// What moves as one.
struct Item {
    legs: Vec<Leg>,
    may_turn: bool,
    /// Numbers of items that come before it and after it.
    before: Vec<usize>,
    after: Vec<usize>,
    /// Positions among which it may move, where groups follow one after the other.
    among: [usize; 2],
}

impl Item {
    fn start(&self) -> Option<Vector> {
        self.legs.first().map(|leg| leg.1[0])
    }

    fn end(&self) -> Option<Vector> {
        self.legs.last().map(|leg| leg.1[1])
    }

    fn turn(&mut self) {
        self.legs.reverse();
        for (stop, ends) in &mut self.legs {
            stop.is_turned = !stop.is_turned;
            ends.reverse();
        }
    }
}

fn nearest_to(end: Place, tree: &Ends) -> impl Iterator<Item = usize> + '_ {
    end.into_iter().flat_map(|end| tree.nearest_neighbor_iter(end.into()).take(NEIGHBOURS).map(|found| found.data))
}

struct Search<'a> {
    items: Vec<Item>,
    /// Numbers of items in their order, and the position of each.
    order: Vec<usize>,
    position: Vec<usize>,
    air: &'a Air,
    /// Positions that may still be shifted.
    left: usize,
}

/// A change of the order.
#[derive(Clone, Copy)]
enum Change {
    /// A block goes to before a position, turned or not.
    Move { first: usize, after: usize, to: usize, turned: bool },
    /// The items of a stretch are turned as a whole.
    Turn { first: usize, after: usize },
}

impl<'a> Search<'a> {
    fn new(legs: &[Leg], as_chains: bool, sequence: &Sequence<'_>, precedence: &Precedence, air: &'a Air) -> Self {
        let group = |leg: &Leg| precedence.group(leg.0.pass);
        let is_short = |a: &Leg, b: &Leg| (b.1[0] - a.1[1]).xy().norm() <= air.along;
        let chains = legs.chunk_by(|a, b| as_chains && is_short(a, b) && group(a) == group(b));
        let may_turn = |(stop, _): &Leg| sequence.may_turn(stop.pass) || sequence.begins_anywhere(stop.pass);
        let item = |chain: &[Leg]| Item {
            legs: chain.to_vec(),
            may_turn: chain.iter().all(may_turn) && chain.iter().any(|(stop, _)| sequence.may_turn(stop.pass)),
            before: Vec::new(),
            after: Vec::new(),
            among: [0, usize::MAX],
        };
        let mut items: Vec<Item> = chains.map(item).collect();
        let mut first = 0;
        for same in items.chunk_by_mut(|a, b| a.legs.first().and_then(group) == b.legs.first().and_then(group)) {
            let among = [first, first + same.len()];
            first += same.len();
            same.iter_mut().for_each(|item| item.among = among);
        }
        let mut item_of = vec![0; legs.len()];
        for (number, item) in items.iter().enumerate() {
            item.legs.iter().for_each(|(stop, _)| item_of[stop.pass] = number);
        }
        for (number, item) in items.iter_mut().enumerate() {
            let others = |of: &[u32]| -> Vec<usize> {
                of.iter().map(|pass| item_of[*pass as usize]).filter(|other| *other != number).collect()
            };
            let passes = item.legs.iter().map(|(stop, _)| stop.pass);
            let unique = |mut all: Vec<usize>| {
                all.sort_unstable();
                all.dedup();
                all
            };
            item.before = unique(passes.clone().flat_map(|pass| others(precedence.before(pass))).collect());
            item.after = unique(passes.clone().flat_map(|pass| others(precedence.after(pass))).collect());
            let is_inner = |pass| precedence.before(pass).iter().any(|other| item_of[*other as usize] == number);
            item.may_turn &= !passes.clone().any(is_inner);
        }
        let count = items.len();
        let left = (SHIFTS * count).clamp(FEW_SHIFTS, MANY_SHIFTS);
        Self { items, order: (0..count).collect(), position: (0..count).collect(), air, left }
    }

    fn legs(&self) -> Vec<Leg> {
        self.order.iter().flat_map(|number| self.items[*number].legs.iter().copied()).collect()
    }

    fn run(&mut self, watch: &Watch) -> Result<(), Cancelled> {
        let near = self.neighbours();
        for _ in 0..ROUNDS {
            let mut is_shorter = false;
            for number in 0..self.items.len() {
                watch.advance(0)?;
                if let Some(change) = self.best(number, &near) {
                    if !self.apply(change) {
                        return Ok(());
                    }
                    is_shorter = true;
                }
            }
            if !is_shorter {
                break;
            }
        }
        Ok(())
    }

    /// Of each item those to whose ends a link would be short. Turned items are found by the ends that they had: fewer
    /// candidates, none of them wrong.
    fn neighbours(&self) -> Vec<Vec<usize>> {
        let at = |end: fn(&Item) -> Place| -> Ends {
            let ends = self.items.iter().enumerate().filter_map(|(number, item)| Some((number, end(item)?)));
            RTree::bulk_load(ends.map(|(number, end)| GeomWithData::new(end.into(), number)).collect())
        };
        let [starts, ends] = [at(Item::start), at(Item::end)];
        let near = |(number, item): (usize, &Item)| -> Vec<usize> {
            // a start comes to lie after an end; where items are turned, after a start too
            let mut near: Vec<usize> = nearest_to(item.start(), &ends).chain(nearest_to(item.end(), &starts)).collect();
            if item.may_turn {
                near.extend(nearest_to(item.start(), &starts).chain(nearest_to(item.end(), &ends)));
            }
            near.retain(|other| *other != number);
            near.sort_unstable();
            near.dedup();
            near
        };
        self.items.iter().enumerate().map(near).collect()
    }

    /// The change around an item that shortens the order most, if any does.
    fn best(&self, number: usize, near: &[Vec<usize>]) -> Option<Change> {
        let at = self.position[number];
        let mut best: Option<(f64, Change)> = None;
        let mut take = |gain: f64, change: Change| {
            if gain > best.map_or(LEAST, |(most, _)| most) {
                best = Some((gain, change));
            }
        };
        // blocks that begin with it, or end with it
        for count in 1..=BLOCK.min(self.order.len()) {
            for first in [Some(at), (at + 1).checked_sub(count)].into_iter().flatten() {
                if first + count > self.order.len() || (count == 1 && first != at) {
                    continue;
                }
                self.moves(first, count, near, &mut take);
            }
        }
        for other in &near[number] {
            let [low, high] = [at.min(self.position[*other]), at.max(self.position[*other])];
            self.turns(low + 1, high + 1, &mut take);
            self.turns(low, high, &mut take);
        }
        best.map(|(_, change)| change)
    }

    /// Where a block might go.
    fn moves(&self, first: usize, count: usize, near: &[Vec<usize>], take: &mut impl FnMut(f64, Change)) {
        let after = first + count;
        let (before, into, out, next) = self.around(first, after);
        let removed = self.cost(before, into) + self.cost(out, next) - self.cost(before, next);
        if removed <= LEAST {
            return;
        }
        let [low, high] = self.bounds(first, after);
        let turns = self.turns_freely(first, after);
        let ends = [self.order[first], self.order[after - 1]];
        for other in ends.iter().flat_map(|number| &near[*number]) {
            for to in [self.position[*other], self.position[*other] + 1] {
                if to < low || to > high || (first..=after).contains(&to) {
                    continue;
                }
                let (before, next) = (self.end_before(to), self.start_at(to));
                let joined = self.cost(before, next);
                let straight = self.cost(before, into) + self.cost(out, next) - joined;
                take(removed - straight, Change::Move { first, after, to, turned: false });
                if turns {
                    let turned = self.cost(before, out) + self.cost(into, next) - joined;
                    take(removed - turned, Change::Move { first, after, to, turned: true });
                }
            }
        }
    }

    /// Turning a stretch.
    fn turns(&self, first: usize, after: usize, take: &mut impl FnMut(f64, Change)) {
        if after < first + 2 || after > self.order.len() || !self.items[self.order[first]].may_turn {
            return;
        }
        let (before, into, out, next) = self.around(first, after);
        let gain = self.cost(before, into) + self.cost(out, next) - self.cost(before, out) - self.cost(into, next);
        if gain > LEAST && after - first <= MOST_TURNED && self.turns_freely(first, after) {
            take(gain, Change::Turn { first, after });
        }
    }

    /// Between which positions a block may come to lie.
    fn bounds(&self, first: usize, after: usize) -> [usize; 2] {
        let is_outside = |at: &usize| !(first..after).contains(at);
        let mut bounds = [0, self.order.len()];
        for number in &self.order[first..after] {
            let item = &self.items[*number];
            let before = item.before.iter().map(|other| self.position[*other]).filter(is_outside).map(|at| at + 1);
            let next = item.after.iter().map(|other| self.position[*other]).filter(is_outside);
            bounds[0] = before.chain([item.among[0]]).fold(bounds[0], usize::max);
            bounds[1] = next.chain([item.among[1]]).fold(bounds[1], usize::min);
        }
        bounds
    }

    /// Whether the items of a block may all be turned, and none of them has to follow another.
    fn turns_freely(&self, first: usize, after: usize) -> bool {
        let among = self.items[self.order[first]].among;
        self.order[first..after].iter().all(|number| {
            let item = &self.items[*number];
            let is_inside = |other: &usize| (first..after).contains(&self.position[*other]);
            item.may_turn && item.among == among && !item.before.iter().any(is_inside)
        })
    }

    /// The end before a block, its start and its end, and the start after it.
    fn around(&self, first: usize, after: usize) -> (Place, Place, Place, Place) {
        (self.end_before(first), self.start_at(first), self.end_before(after), self.start_at(after))
    }

    fn end_before(&self, at: usize) -> Place {
        at.checked_sub(1).and_then(|at| self.items[self.order[at]].end())
    }

    fn start_at(&self, at: usize) -> Place {
        self.order.get(at).and_then(|number| self.items[*number].start())
    }

    /// Air between two ends; none before the first item and after the last.
    fn cost(&self, from: Place, to: Place) -> f64 {
        from.zip(to).map_or(0.0, |(from, to)| self.air.from_to(from, to))
    }

    /// Changes the order, if there is work left for it.
    fn apply(&mut self, change: Change) -> bool {
        let (first, after) = match change {
            Change::Move { first, after, to, .. } => (first.min(to), after.max(to)),
            Change::Turn { first, after } => (first, after),
        };
        let Some(left) = self.left.checked_sub(after - first) else { return false };
        self.left = left;
        match change {
            Change::Move { first, after, to, turned } => {
                if turned {
                    self.turn(first, after);
                }
                if to < first {
                    self.order[to..after].rotate_right(after - first);
                } else {
                    self.order[first..to].rotate_left(after - first);
                }
            }
            Change::Turn { first, after } => self.turn(first, after),
        }
        for at in first..after {
            self.position[self.order[at]] = at;
        }
        true
    }

    fn turn(&mut self, first: usize, after: usize) {
        self.order[first..after].reverse();
        for number in &self.order[first..after] {
            self.items[*number].turn();
        }
    }
}

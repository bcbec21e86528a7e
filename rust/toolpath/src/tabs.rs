//! Tabs: short stretches of a contour that stay, so that what is cut out is held. The tool is lifted over them.
//!
//! A tab is a disc in plan about a point of the contour, as wide as the tab; below its top the tool keeps out of it. Beside it the
//! tool goes up and down along slopes.

use styluscam_geometry::Vector;
use styluscam_motion::{Arc, ArcPath, Move, MoveKind, Plane, Role};
use thiserror::Error;

use crate::plan::apart;
use crate::Pass;

/// Discs are wider by this, mm: coordinates are rounded.
const SPARE: f64 = 0.002;
/// Length of the pieces in which a move is looked at, mm.
const PIECE: f64 = 0.2;
/// Halvings of such a piece: to less than 1e-9 mm.
const HALVINGS: usize = 30;
/// Walls lean by more than this, a sine of their slope, are not upright.
const UPRIGHT: f64 = 1e-3;
/// A loop is one of a stack where a tab's centre is as near to it as this share of the tool's radius.
const SAME_WALL: f64 = 0.5;
/// Heights that differ by less are one, and points, mm.
const SAME: f64 = 1e-9;
/// Largest distance of chords from arcs that a machine does not take, mm.
const CHORDS: f64 = 5e-4;

/// How many tabs hold a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TabNumber {
    /// So many on each loop.
    Count(usize),
    /// As many as it takes that none is farther than this from the next, mm along the loop.
    Spacing(f64),
}

/// Tabs as they are asked for; mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TabRule {
    /// How many.
    pub number: TabNumber,
    /// What stays, along the contour.
    pub width: f64,
    /// Above the contour's lowest loop.
    pub height: f64,
    /// Rise over run of the tool's path beside a tab.
    pub slope: f64,
    /// The tool's.
    pub radius: f64,
}

/// A tab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tab {
    /// On the path of the tool's centre, mm.
    pub centre: [f64; 2],
    /// mm.
    pub top: f64,
}

/// Tabs do not fit.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TabError {
    /// There is no loop to hold.
    #[error("no pass is a closed loop, and tabs hold what loops cut out")]
    NoLoop,
    /// A loop is too short for them.
    #[error(
        "the loop through X{:.3} Y{:.3} is {length:.1} mm long, and {count} tabs with the tool and its slopes beside them take {needed:.1} mm \
         and more at corners",
        .at[0], .at[1]
    )]
    TooShort {
        /// A point of it, mm.
        at: [f64; 2],
        /// mm.
        length: f64,
        /// Tabs on it.
        count: usize,
        /// mm.
        needed: f64,
    },
    /// A wall leans.
    #[error("the wall at X{:.3} Y{:.3} is not upright, and a tool that is lifted straight up leaves it", .at[0], .at[1])]
    Leaning {
        /// A point of the path along it, mm.
        at: [f64; 2],
    },
}

impl TabRule {
    /// How far from a tab's centre the tool keeps below its top, mm in plan.
    #[must_use]
    pub fn reach(&self) -> f64 {
        0.5 * self.width + self.radius + SPARE
    }

    /// How far out in plan the path beside a tab comes down by its height, mm.
    fn run(&self) -> f64 {
        self.height / self.slope
    }

    /// Tabs on a loop of a length, mm.
    fn count(&self, length: f64) -> usize {
        match self.number {
            TabNumber::Count(count) => count,
            TabNumber::Spacing(most) => (length / most - SAME).ceil().max(1.0) as usize,
        }
    }
}

/// The tabs of all loops: on the lowest of each stack, evenly along it, the first where it crosses the line from its centroid along +X.
///
/// # Errors
/// No loop, one that is too short, or a wall that leans.
pub fn tabs(passes: &[Pass], rule: &TabRule) -> Result<Vec<Tab>, TabError> {
    let mut loops: Vec<&Pass> = passes.iter().filter(|pass| pass.closed && pass.points.len() > 2).collect();
    if loops.is_empty() {
        return Err(TabError::NoLoop);
    }
    let height = |pass: &&Pass| pass.points.first().map_or(0.0, |point| point.tip.z);
    loops.sort_by(|a, b| height(a).total_cmp(&height(b)));
    let mut tabs: Vec<Tab> = Vec::new();
    for pass in &loops {
        let course = Course::of(pass);
        let near = |tab: &Tab| course.distance(tab.centre) <= SAME_WALL * rule.radius;
        let known = tabs.iter().find(|tab| near(tab));
        if known.is_some_and(|tab| height(pass) >= tab.top) {
            continue;
        }
        if let Some(leaning) = pass.points.iter().find(|point| point.normal.z.abs() > UPRIGHT) {
            return Err(TabError::Leaning { at: [leaning.tip.x, leaning.tip.y] });
        }
        if known.is_none() {
            tabs.extend(course.tabs(height(pass), rule)?);
        }
    }
    Ok(tabs)
}

/// A loop in plan.
struct Course {
    points: Vec<[f64; 2]>,
    /// Length up to each of them, mm.
    lengths: Vec<f64>,
}

impl Course {
    fn of(pass: &Pass) -> Self {
        let points: Vec<[f64; 2]> = pass.points.iter().map(|point| [point.tip.x, point.tip.y]).collect();
        let mut length = 0.0;
        let steps = points.windows(2).map(|side| apart(side[0], side[1]));
        let lengths = std::iter::once(0.0).chain(steps.map(|step| {
            length += step;
            length
        }));
        Self { lengths: lengths.collect(), points }
    }

    fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or_default()
    }

    fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        self.points.windows(2).map(|side| [side[0], side[1]])
    }

    fn distance(&self, from: [f64; 2]) -> f64 {
        self.sides().map(|side| to_side(from, side)).fold(f64::INFINITY, f64::min)
    }

    /// The point at a length along it, mm.
    fn at(&self, length: f64) -> [f64; 2] {
        let length = length.rem_euclid(self.length().max(f64::MIN_POSITIVE));
        let side = self.lengths.partition_point(|end| *end <= length).clamp(1, self.points.len() - 1);
        let [a, b] = [self.points[side - 1], self.points[side]];
        let step = self.lengths[side] - self.lengths[side - 1];
        let share = if step > 0.0 { (length - self.lengths[side - 1]) / step } else { 0.0 };
        [0, 1].map(|i| a[i] + share * (b[i] - a[i]))
    }

    fn centroid(&self) -> [f64; 2] {
        let Some(origin) = self.points.first() else { return [0.0; 2] };
        let (mut area, mut sum) = (0.0, [0.0; 2]);
        for [a, b] in self.sides() {
            let [a, b] = [a, b].map(|p| [p[0] - origin[0], p[1] - origin[1]]);
            let cross = a[0] * b[1] - b[0] * a[1];
            area += cross;
            sum = [0, 1].map(|i| sum[i] + cross * (a[i] + b[i]));
        }
        let divisor = if area == 0.0 { f64::INFINITY } else { 3.0 * area };
        [0, 1].map(|i| origin[i] + sum[i] / divisor)
    }

    /// The length along it, mm, at which it crosses the line from its centroid along +X, farthest out; 0 where it does not.
    fn first(&self) -> f64 {
        let [x, y] = self.centroid();
        let crossings = self.sides().zip(&self.lengths).filter_map(|([a, b], start)| {
            let share = (y - a[1]) / (b[1] - a[1]);
            let out = a[0] + share * (b[0] - a[0]);
            let crosses = (a[1] <= y) != (b[1] <= y) && out > x;
            crosses.then(|| (out, start + share * apart(a, b)))
        });
        crossings.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, length)| length)
    }

    fn tabs(&self, height: f64, rule: &TabRule) -> Result<Vec<Tab>, TabError> {
        let (length, first) = (self.length(), self.first());
        let count = rule.count(length);
        let needed = count as f64 * 2.0 * (rule.reach() + rule.run());
        if needed > length {
            return Err(TabError::TooShort { at: self.at(0.0), length, count, needed });
        }
        let tab = |number: usize| Tab {
            centre: self.at(first + number as f64 / count as f64 * length),
            top: height + rule.height,
        };
        let tabs: Vec<Tab> = (0..count).map(tab).collect();
        let is_foot = |number: usize| {
            let place = first + (number as f64 + 0.5) / count as f64 * length;
            let farther = |tab: &Tab| apart(tab.centre, self.at(place)) >= rule.reach() + rule.run();
            tabs.iter().all(farther)
        };
        if !(0..count).all(is_foot) {
            return Err(TabError::TooShort { at: self.at(0.0), length, count, needed });
        }
        Ok(tabs)
    }
}

/// The moves, lifted over tabs. `takes` states whether a machine takes an arc between two points.
#[must_use]
pub fn lifted(
    moves: &[Move],
    (tabs, rule): (&[Tab], &TabRule),
    takes: &dyn Fn([[f64; 3]; 2], &Arc) -> bool,
) -> Vec<Move> {
    let lift = Lift { tabs, rule, takes };
    let mut lifted: Vec<Move> = Vec::with_capacity(moves.len());
    let mut before: Option<[f64; 3]> = None;
    for step in moves {
        let goes_across = |start: &[f64; 3]| step.arc.is_some() || plan(*start, step.end.tip) > SAME;
        match before.filter(|start| step.kind == MoveKind::Feed && goes_across(start)) {
            Some(start) => lift.along(step, start, &mut lifted),
            None => lift.push(step.to(lift.raised(step.end.tip)), &mut lifted),
        }
        before = Some(step.end.tip);
    }
    lifted
}

struct Lift<'a> {
    tabs: &'a [Tab],
    rule: &'a TabRule,
    takes: &'a dyn Fn([[f64; 3]; 2], &Arc) -> bool,
}

/// The path of a move.
#[derive(Clone, Copy)]
enum Path {
    Line([[f64; 3]; 2]),
    Arc(ArcPath),
}

impl Path {
    fn at(&self, share: f64) -> [f64; 3] {
        match self {
            Self::Line([a, b]) => [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i])),
            Self::Arc(path) => path.at(share),
        }
    }
}

impl Lift<'_> {
    /// The lowest height over a point, mm.
    fn floor(&self, point: [f64; 3]) -> f64 {
        let over = |tab: &Tab| tab.top - (self.off(tab, point).max(0.0)) * self.rule.slope;
        self.tabs.iter().map(over).fold(f64::NEG_INFINITY, f64::max)
    }

    /// How far outside of a tab's disc a point is, mm in plan; negative inside.
    fn off(&self, tab: &Tab, point: [f64; 3]) -> f64 {
        apart(tab.centre, [point[0], point[1]]) - self.rule.reach()
    }

    fn raised(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        [x, y, z.max(self.floor([x, y, z]))]
    }

    /// Adds a move, unless it ends where the one before it does.
    fn push(&self, step: Move, lifted: &mut Vec<Move>) {
        let stays = |before: &Move| (Vector::from(before.end.tip) - Vector::from(step.end.tip)).norm() <= SAME;
        if step.arc.is_some() || !lifted.last().is_some_and(stays) {
            lifted.push(step);
        }
    }

    /// Adds the pieces of a move from a point.
    fn along(&self, step: &Move, start: [f64; 3], lifted: &mut Vec<Move>) {
        let path = step.path(start).map_or(Path::Line([start, step.end.tip]), Path::Arc);
        let count = (step.length(start) / PIECE).ceil().max(1.0) as usize;
        let shares = self.shares(&path, count);
        let is_lifted = |from: f64, to: f64| {
            let middle = path.at(0.5 * (from + to));
            self.floor(middle) > middle[2] + SAME
        };
        if !shares.windows(2).any(|pair| is_lifted(pair[0], pair[1])) {
            lifted.push(*step);
            return;
        }
        let mut from = shares.first().copied().unwrap_or_default();
        for pair in shares.windows(2) {
            let (to, goes_up) = (pair[1], is_lifted(pair[0], pair[1]));
            let end = if to >= 1.0 { step.end.tip } else { path.at(to) };
            let ends = [path.at(from), end].map(|point| if goes_up { self.raised(point) } else { point });
            let slopes = goes_up && (ends[1][2] - ends[0][2]).abs() > SAME;
            let role = if slopes && step.is_along_pass() { Some(Role::Ramp) } else { step.role };
            self.piece(Move { role, ..step.to(ends[1]) }, (&path, [from, to], ends), lifted);
            from = to;
        }
    }

    /// Adds a piece of a move between two shares of its path: an arc where the machine takes it.
    fn piece(&self, step: Move, (path, [from, to], ends): (&Path, [f64; 2], [[f64; 3]; 2]), lifted: &mut Vec<Move>) {
        let (Path::Arc(whole), Some(arc)) = (path, step.arc) else {
            self.push(step, lifted);
            return;
        };
        let arc = Arc { turns: 0, ..arc };
        if arc.plane == Plane::Xy && plan(ends[0], ends[1]) > SAME && (self.takes)(ends, &arc) {
            lifted.push(step.arc(arc));
            return;
        }
        let part = whole.part(from, to);
        let chords = part.chords(CHORDS);
        for number in 1..=chords {
            let share = number as f64 / chords as f64;
            let end = if number == chords { ends[1] } else { self.raised(part.at(share)) };
            self.push(step.arc(None).to(end), lifted);
        }
    }

    /// The shares of a path at which it enters or leaves a disc, or its height is that of the tab or of the slope beside it; with both ends.
    fn shares(&self, path: &Path, count: usize) -> Vec<f64> {
        let mut shares = vec![0.0, 1.0];
        for tab in self.tabs {
            let enters = |share: f64| self.off(tab, path.at(share));
            let rises = |share: f64| {
                let point = path.at(share);
                tab.top - self.off(tab, point).max(0.0) * self.rule.slope - point[2]
            };
            shares.extend(zeros(&enters, count));
            shares.extend(zeros(&rises, count));
        }
        shares.sort_by(f64::total_cmp);
        shares.dedup_by(|b, a| *b - *a <= SAME);
        shares
    }
}

/// Where a function of a share changes its sign, looked at in so many pieces.
fn zeros(function: &dyn Fn(f64) -> f64, count: usize) -> Vec<f64> {
    let share = |number: usize| number as f64 / count as f64;
    let mut before = function(0.0);
    let mut found = Vec::new();
    for number in 1..=count {
        let after = function(share(number));
        if (before > 0.0) != (after > 0.0) {
            let [mut low, mut high] = [share(number - 1), share(number)];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if (function(middle) > 0.0) == (before > 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            found.push(0.5 * (low + high));
        }
        before = after;
    }
    found
}

fn plan(a: [f64; 3], b: [f64; 3]) -> f64 {
    apart([a[0], a[1]], [b[0], b[1]])
}

fn to_side(from: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let dot = (from[0] - a[0]) * along[0] + (from[1] - a[1]) * along[1];
    let share = if square > 0.0 { (dot / square).clamp(0.0, 1.0) } else { 0.0 };
    apart(from, [a[0] + share * along[0], a[1] + share * along[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PathPoint;

    const RULE: TabRule =
        TabRule { number: TabNumber::Count(4), width: 4.0, height: 2.0, slope: 1.0, radius: 3.0 - SPARE };

    fn level_loop(corners: &[[f64; 2]], z: f64, lean: f64) -> Pass {
        let point = |[x, y]: &[f64; 2]| PathPoint {
            tip: Vector::new(*x, *y, z),
            normal: Vector::new(1.0, 0.0, lean),
            selected: true,
            triangle: 0,
        };
        let points = corners.iter().chain(corners.first()).map(point).collect();
        Pass { points, closed: true, group: 0 }
    }

    fn square(z: f64) -> Pass {
        level_loop(&[[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]], z, 0.0)
    }

    fn heights(moves: &[Move]) -> Vec<[f64; 3]> {
        moves.iter().map(|step| step.end.tip.map(|x| (x * 1e6).round() / 1e6 + 0.0)).collect()
    }

    #[test]
    fn four_tabs_of_a_square_are_on_the_middles_of_its_sides() {
        let found = tabs(&[square(4.0), square(1.0)], &RULE).unwrap();
        let at = |x: f64, y: f64| Tab { centre: [x, y], top: 3.0 };
        assert_eq!(found, [at(20.0, 0.0), at(0.0, 20.0), at(-20.0, 0.0), at(0.0, -20.0)]);
        let spaced = TabRule { number: TabNumber::Spacing(60.0), ..RULE };
        assert_eq!(tabs(&[square(1.0)], &spaced).unwrap().len(), 3, "160 mm");
    }

    #[test]
    fn a_line_is_lifted_by_the_tabs_height_over_its_width_and_the_tools() {
        let tab = Tab { centre: [20.0, 0.0], top: 3.0 };
        let moves = [
            Move::rapid([20.0, -20.0, 9.0]),
            Move::feed([20.0, -20.0, 1.0], 300.0),
            Move::feed([20.0, 20.0, 1.0], 900.0),
        ];
        let lifted = lifted(&moves, (&[tab], &RULE), &|_, _| true);
        let expected = [
            [20.0, -20.0, 9.0],
            [20.0, -20.0, 1.0],
            [20.0, -7.0, 1.0],
            [20.0, -5.0, 3.0],
            [20.0, 5.0, 3.0],
            [20.0, 7.0, 1.0],
            [20.0, 20.0, 1.0],
        ];
        assert_eq!(heights(&lifted), expected);
        let roles: Vec<Option<Role>> = lifted.iter().map(|step| step.role).collect();
        assert_eq!(roles, [None, None, None, Some(Role::Ramp), None, Some(Role::Ramp), None]);
        let above = [Move::rapid([20.0, -20.0, 9.0]), Move::feed([20.0, 20.0, 3.5], 900.0)];
        assert_eq!(super::lifted(&above, (&[tab], &RULE), &|_, _| true), above);
    }

    #[test]
    fn a_ramp_that_comes_below_a_tabs_top_over_it_stays_up_to_its_edge() {
        let tab = Tab { centre: [20.0, 0.0], top: 3.0 };
        let ramp = [Move::rapid([20.0, -20.0, 3.5]), Move::feed([20.0, 20.0, 2.5], 900.0)];
        let lifted = heights(&lifted(&ramp, (&[tab], &RULE), &|_, _| true));
        for expected in [[20.0, 0.0, 3.0], [20.0, 5.0, 3.0]] {
            assert!(lifted.contains(&expected), "{expected:?} in {lifted:?}");
        }
    }

    #[test]
    fn a_circle_stays_one_of_arcs_and_is_as_long_in_plan() {
        let tab = Tab { centre: [20.0, 0.0], top: 3.0 };
        let arc = Arc { centre: [0.0, 0.0, 1.0], plane: Plane::Xy, clockwise: false, turns: 0 };
        let start = [-20.0, 0.0, 1.0];
        let moves = [Move::rapid(start), Move::feed(start, 900.0).arc(arc)];
        let whole = lifted(&moves, (&[tab], &RULE), &|_, _| true);
        assert!(whole.iter().skip(1).all(|step| step.arc.is_some()) && whole.len() == 6);
        let turned: f64 = whole.windows(2).map(|pair| pair[1].path(pair[0].end.tip).unwrap().sweep()).sum();
        assert!((turned - std::f64::consts::TAU).abs() < 1e-9, "{turned}");
        let top: Vec<&Move> = whole.iter().filter(|step| (step.end.tip[2] - 3.0).abs() < 1e-9).collect();
        assert!(top.iter().all(|step| (apart([20.0, 0.0], [step.end.tip[0], step.end.tip[1]]) - 5.0).abs() < 1e-6));
        let chords = lifted(&moves, (&[tab], &RULE), &|_, _| false);
        let lowest = |point: [f64; 3]| apart(tab.centre, [point[0], point[1]]) >= 5.0 - 1e-6 || point[2] >= 3.0 - 1e-9;
        assert!(chords.iter().all(|step| step.arc.is_none() && lowest(step.end.tip)));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let rule = |count| TabRule { number: TabNumber::Count(count), ..RULE };
        assert!(matches!(tabs(&[square(1.0)], &rule(12)), Err(TabError::TooShort { count: 12, .. })));
        // 36 mm of 48, but round its corners the tool is nowhere 9 mm off both
        let window = level_loop(&[[0.0, 0.0], [14.0, 0.0], [14.0, 10.0], [0.0, 10.0]], 0.0, 0.0);
        let high = TabRule { height: 4.0, ..rule(2) };
        assert!(matches!(tabs(&[window], &high), Err(TabError::TooShort { count: 2, .. })));
        let leaning = level_loop(&[[0.0, 0.0], [60.0, 0.0], [60.0, 60.0]], 0.0, 0.1);
        assert!(matches!(tabs(&[leaning], &rule(1)), Err(TabError::Leaning { .. })));
        assert_eq!(tabs(&[], &RULE), Err(TabError::NoLoop));
    }
}

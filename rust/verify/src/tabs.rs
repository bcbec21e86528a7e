//! Tabs that passes leave: found in the moves as level stretches that the path goes up to and comes down from, and compared with
//! what is expected of each loop. Below its top nothing may cut a tab.

use styluscam_motion::{MoveKind, Program, Role};

use crate::assignment::Assignment;
use crate::expectation::{ExpectedOperation, TabShape};
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::subject::Subject;
use crate::tolerances::SAME_LEVEL;

/// Ends of a loop are one point in plan, mm: coordinates are rounded.
const CLOSED: f64 = 5e-3;
/// What heights of tabs may differ by, mm: two rounded coordinates, and the last digit of a coarse machine.
const HEIGHT: f64 = 2.0 * SAME_LEVEL;
/// What the tool may be nearer to a tab's middle than it should, mm: rounding, and chords of arcs.
const NEAR: f64 = 5e-3;
/// By how much farther than the tab is wide the tool may be lifted, mm along the path; on curves the path is longer than its chord.
const WIDER: f64 = 0.05;
/// A loop is round the same wall as another where it comes as near to it in plan as this share of the tool's radius.
const SAME_WALL: f64 = 0.5;
/// Stretches are lifted over the same tab where their middles are as near as this share of the distance that the tool keeps from it: a
/// ramp may come down on it behind its edge.
const SAME_TAB: f64 = 0.5;
/// The share of a move that shows its heading at an end, and the cosine from which on two headings are opposite.
const TANGENT: f64 = 1e-3;
const BACK: f64 = -0.9;
/// Length of the pieces in which a move is compared with a tab, mm.
const PIECE: f64 = 0.1;

/// A tab as the moves leave it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tab {
    /// The middle of the stretch that is lifted, mm.
    pub centre: [f64; 2],
    /// mm.
    pub top: f64,
    /// Distance in plan between the ends of the stretch, mm.
    span: f64,
    /// Index of the operation's segment that ends it.
    last: usize,
}

/// The tabs of one operation.
pub(crate) struct Tabs<'a> {
    shape: &'a TabShape,
    radius: f64,
    /// As they are found, level by level.
    found: Vec<Tab>,
    /// Of those over one another the widest.
    apart: Vec<Tab>,
}

impl<'a> Tabs<'a> {
    /// Those of an operation; none where it is to leave none.
    pub fn of(
        program: &Program,
        segments: &[Segment],
        assignment: &Assignment,
        subject: &Subject,
        operation: &'a ExpectedOperation,
    ) -> Option<Self> {
        let shape = operation.expectation.tabs.as_ref()?;
        let radius = 0.5 * subject.tools.get(operation.tool)?.diameter();
        let own = own(program, segments, assignment, operation);
        let found: Vec<Tab> = chains(&own).flat_map(|chain| tabs_of(&own, chain)).collect();
        let mut tabs = Self { shape, radius, apart: Vec::new(), found };
        let mut widest = tabs.found.clone();
        widest.sort_by(|a, b| b.span.total_cmp(&a.span));
        for tab in widest {
            if tabs.apart.iter().all(|other| apart(other.centre, tab.centre) > SAME_TAB * tabs.reach()) {
                tabs.apart.push(tab);
            }
        }
        Some(tabs)
    }

    /// How far from the middle of a tab the tool keeps below its top, mm.
    fn reach(&self) -> f64 {
        0.5 * self.shape.width + self.radius
    }

    /// Whether a tip is where the path goes over a tab, or up to one.
    pub fn excuse(tabs: &Option<Self>, tip: [f64; 3]) -> bool {
        let Some(tabs) = tabs else { return false };
        tabs.found.iter().any(|tab| {
            let below = tab.top - tip[2];
            let aside = below.max(0.0) / tabs.shape.slope;
            below >= -HEIGHT && apart(tab.centre, [tip[0], tip[1]]) <= tabs.reach() + aside + WIDER
        })
    }
}

/// The moves of an operation along its passes, and down to them.
fn own<'a>(
    program: &Program,
    segments: &'a [Segment],
    assignment: &Assignment,
    operation: &ExpectedOperation,
) -> Vec<&'a Segment> {
    let of_pass = |segment: &&Segment| {
        let role = program.moves.get(segment.index).and_then(|step| step.role);
        segment.kind == SegmentKind::Lateral
            && matches!(role, None | Some(Role::Cut | Role::Ramp))
            && assignment.is(segment.operation, operation)
    };
    segments.iter().filter(of_pass).collect()
}

/// Moves that follow each other without a stop and without turning back, as ranges.
fn chains<'a>(own: &'a [&Segment]) -> impl Iterator<Item = std::ops::Range<usize>> + 'a {
    let mut from = 0;
    own.chunk_by(|a, b| b.start == Some(a.end) && !turns_back(a, b)).map(move |chain| {
        let range = from..from + chain.len();
        from = range.end;
        range
    })
}

/// The tabs that a chain of moves leaves: at its ends in two halves.
fn tabs_of(own: &[&Segment], chain: std::ops::Range<usize>) -> Vec<Tab> {
    let moves = own.get(chain.clone()).unwrap_or_default();
    let mut tabs = Vec::new();
    let (mut first, mut last): (Option<&[&Segment]>, Option<&[&Segment]>) = (None, None);
    let mut from = 0;
    for run in moves.chunk_by(|a, b| is_level(a) && is_level(b)) {
        let (begins, ends) = (from, from + run.len());
        from = ends;
        if !run.first().is_some_and(|segment| is_level(segment)) {
            continue;
        }
        let before = begins.checked_sub(1).and_then(|before| moves.get(before));
        let after = moves.get(ends);
        let (comes_up, goes_down) = (before.map(|segment| rises(segment)), after.map(|segment| segment.descends()));
        match (comes_up, goes_down) {
            (Some(true), Some(true)) => tabs.extend(tab(run.iter().copied(), chain.start + ends - 1)),
            (None, Some(true)) => first = Some(run),
            (Some(true), None) => last = Some(run),
            _ => {}
        }
    }
    if let (Some(first), Some(last)) = (first, last) {
        if joined(last, first) {
            tabs.extend(tab(last.iter().chain(first).copied(), chain.end - 1));
        }
    }
    tabs
}

/// Whether the end of moves is the beginning of others.
fn joined(before: &[&Segment], after: &[&Segment]) -> bool {
    let (Some(end), Some(start)) = (before.last(), after.first().and_then(|segment| segment.start)) else {
        return false;
    };
    plan(end.end, start) <= CLOSED && (end.end[2] - start[2]).abs() <= SAME_LEVEL
}

/// The tab over which a level run goes: both its ends are equally far from the middle, which lies on the run.
fn tab<'a>(run: impl Iterator<Item = &'a Segment> + Clone, last: usize) -> Option<Tab> {
    let ends = [run.clone().next()?.start?, run.clone().last()?.end];
    let farther = |point: [f64; 3]| plan(point, ends[0]) - plan(point, ends[1]);
    let points: Vec<[f64; 3]> = run.flat_map(points).collect();
    let middle = points.windows(2).find(|pair| farther(pair[0]) <= 0.0 && farther(pair[1]) > 0.0)?;
    let [before, after] = [farther(middle[0]), farther(middle[1])];
    let share = before / (before - after);
    let [x, y, top] = [0, 1, 2].map(|axis| middle[0][axis] + share * (middle[1][axis] - middle[0][axis]));
    Some(Tab { centre: [x, y], top, span: plan(ends[0], ends[1]), last })
}

/// What is wrong with the tabs of operations that are to leave them.
pub(crate) fn faults(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    for operation in subject.expected {
        let Some(tabs) = Tabs::of(program, segments, assignment, subject, operation) else { continue };
        let own = own(program, segments, assignment, operation);
        let loops = loops(&own, &tabs);
        faults.extend(tabs.numbers(&own, &loops));
        faults.extend(tabs.heights(&own, &loops));
        faults.extend(tabs.widths(&own));
        faults.extend(tabs.cuts(program, segments, subject));
    }
    faults
}

/// A loop at the end of a chain of moves.
struct Loop {
    /// Its moves, of the operation's.
    moves: std::ops::Range<usize>,
    /// In plan, mm.
    length: f64,
    /// Its lowest height, mm.
    low: f64,
    /// The lowest of all that are round the same wall, mm.
    foot: f64,
}

fn loops(own: &[&Segment], tabs: &Tabs<'_>) -> Vec<Loop> {
    let mut loops: Vec<Loop> = chains(own).filter_map(|chain| last_loop(own, chain)).collect();
    let feet: Vec<f64> = loops
        .iter()
        .map(|one| {
            let end = own.get(one.moves.end.saturating_sub(1)).map_or([0.0; 3], |segment| segment.end);
            let is_same = |other: &&Loop| {
                let moves = own.get(other.moves.clone()).unwrap_or_default();
                moves.iter().any(|segment| comes_near(segment, [end[0], end[1]], SAME_WALL * tabs.radius))
            };
            loops.iter().filter(is_same).map(|other| other.low).fold(one.low, f64::min)
        })
        .collect();
    loops.iter_mut().zip(feet).for_each(|(one, foot)| one.foot = foot);
    loops
}

/// The last loop of a chain of moves; none where they do not come back to a point.
fn last_loop(own: &[&Segment], chain: std::ops::Range<usize>) -> Option<Loop> {
    let end = own.get(chain.end.checked_sub(1)?)?.end;
    let (mut length, mut low) = (0.0, f64::INFINITY);
    for number in chain.clone().rev() {
        let segment = own.get(number)?;
        let start = segment.start?;
        length += segment.bend.map_or_else(|| plan(start, segment.end), |bend| bend.length());
        low = low.min(segment.lowest());
        if plan(start, end) <= CLOSED && length > 4.0 * CLOSED {
            return Some(Loop { moves: number..chain.end, length, low, foot: low });
        }
    }
    None
}

impl Tabs<'_> {
    /// Loops that have other tabs than they should.
    fn numbers(&self, own: &[&Segment], loops: &[Loop]) -> Vec<Fault> {
        let is_held = |one: &&Loop| one.low < one.foot + self.shape.height - HEIGHT;
        let wrong = loops.iter().filter(is_held).filter_map(|one| {
            let moves = own.get(one.moves.clone())?;
            let is_over = |tab: &&Tab| {
                let near = |segment: &&Segment| comes_near(segment, tab.centre, SAME_WALL * self.radius);
                tab.top > one.low + HEIGHT && moves.iter().copied().any(|segment| near(&segment))
            };
            let count = self.apart.iter().filter(is_over).count();
            let expected = match (self.shape.count, self.shape.spacing) {
                (None, Some(most)) => ((one.length - WIDER) / most).ceil().max(1.0) as usize,
                (count, _) => count.unwrap_or_default(),
            };
            (count != expected)
                .then(|| {
                    moves.last().map(|last| last.fault(&faults::TAB_NUMBER).measured(count as f64, expected as f64))
                })
                .flatten()
        });
        wrong.collect()
    }

    /// Tabs that are lower or higher than they should be.
    fn heights(&self, own: &[&Segment], loops: &[Loop]) -> Vec<Fault> {
        let wrong = self.found.iter().filter_map(|tab| {
            let one = loops.iter().find(|one| one.moves.contains(&tab.last))?;
            let height = tab.top - one.foot;
            let fault = own.get(tab.last)?.fault(&faults::TAB_HEIGHT).measured(height, self.shape.height);
            ((height - self.shape.height).abs() > HEIGHT).then_some(fault)
        });
        wrong.collect()
    }

    /// Tabs that are wider than they should be: part of the contour is missing.
    fn widths(&self, own: &[&Segment]) -> Vec<Fault> {
        let most = 2.0 * self.reach();
        let wrong = self.found.iter().filter_map(|tab| {
            let fault = own.get(tab.last)?.fault(&faults::TAB_WIDTH).measured(tab.span, most);
            (tab.span > most + WIDER).then_some(fault)
        });
        wrong.collect()
    }

    /// Moves of any operation that cut a tab below its top.
    fn cuts(&self, program: &Program, segments: &[Segment], subject: &Subject) -> Vec<Fault> {
        let cuts = |segment: &Segment| {
            let fed = program.moves.get(segment.index).is_some_and(|step| step.kind == MoveKind::Feed);
            let radius = 0.5 * subject.tools.get(segment.tool?)?.diameter();
            let near = 0.5 * self.shape.width + radius - NEAR;
            let cut = |tab: &Tab| fed && segment.lowest() < tab.top - HEIGHT && is_below(segment, tab, near);
            let tab = self.apart.iter().find(|tab| cut(tab))?;
            Some(segment.fault(&faults::TAB_CUT).measured(segment.lowest(), tab.top))
        };
        segments.iter().filter_map(cuts).collect()
    }
}

/// Whether a move comes nearer to a tab's middle than `near`, mm in plan, below its top.
fn is_below(segment: &Segment, tab: &Tab, near: f64) -> bool {
    let low = tab.top - HEIGHT;
    let Some(start) = segment.start.filter(|_| segment.bend.is_none()) else {
        return points(segment).any(|[x, y, z]| z < low && apart([x, y], tab.centre) < near);
    };
    let fall = segment.end[2] - start[2];
    let crossing = ((low - start[2]) / fall).clamp(0.0, 1.0);
    let [from, to] = match (start[2] < low, segment.end[2] < low) {
        (true, true) => [0.0, 1.0],
        (true, false) => [0.0, crossing],
        (false, true) => [crossing, 1.0],
        (false, false) => return false,
    };
    let way = [0, 1].map(|axis| segment.end[axis] - start[axis]);
    let square = way[0] * way[0] + way[1] * way[1];
    let along = way[0] * (tab.centre[0] - start[0]) + way[1] * (tab.centre[1] - start[1]);
    let nearest = if square > 0.0 { (along / square).clamp(from, to) } else { from };
    let [x, y, _] = segment.at(nearest);
    apart([x, y], tab.centre) < near
}

fn comes_near(segment: &Segment, point: [f64; 2], distance: f64) -> bool {
    points(segment).any(|[x, y, _]| apart([x, y], point) <= distance)
}

/// Points along a move, both ends included.
fn points(segment: &Segment) -> impl Iterator<Item = [f64; 3]> + '_ {
    let count = (segment.length() / PIECE).ceil().clamp(1.0, 1e6) as u32;
    (0..=count).map(move |number| segment.at(f64::from(number) / f64::from(count)))
}

/// Whether the second of two moves goes back along the first.
fn turns_back(a: &Segment, b: &Segment) -> bool {
    let heading = |segment: &Segment, from: f64, to: f64| {
        let [from, to] = [from, to].map(|share| segment.at(share));
        let length = plan(from, to).max(f64::MIN_POSITIVE);
        [0, 1].map(|axis| (to[axis] - from[axis]) / length)
    };
    let [before, after] = [heading(a, 1.0 - TANGENT, 1.0), heading(b, 0.0, TANGENT)];
    before[0] * after[0] + before[1] * after[1] < BACK
}

fn is_level(segment: &Segment) -> bool {
    !segment.falls()
}

fn rises(segment: &Segment) -> bool {
    segment.start.is_some_and(|start| segment.end[2] > start[2] + SAME_LEVEL)
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(b[0] - a[0], b[1] - a[1])
}

fn plan(a: [f64; 3], b: [f64; 3]) -> f64 {
    apart([a[0], a[1]], [b[0], b[1]])
}

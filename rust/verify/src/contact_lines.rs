//! Where the passes that a text has should touch: lines on the triangles, because along a facet the tool's height and its
//! position change as evenly as the point that it touches.

use std::ops::Range;

use styluscam_geometry::{Mesh, Vector};

use crate::body::Body;
use crate::expectation::OrderedPasses;
use crate::probes::Probe;
use crate::scalar::Scalar;
use crate::segments::Segment;

/// Moves at one height are a pass when they are as long as so many steps: links along the part are shorter.
const LONG: f64 = 6.0;

/// Points spread evenly over the lines at which passes of these values, ascending, should touch the triangles `selected`,
/// about `count` of them.
pub(crate) fn spread(
    mesh: &Mesh,
    selected: &[usize],
    body: &Body,
    scalar: &dyn Scalar,
    values: &[f64],
    count: usize,
) -> Vec<Probe> {
    let facets: Vec<Facet> = selected.iter().filter_map(|triangle| Facet::new(mesh, *triangle, body, scalar)).collect();
    let length: f64 = facets.iter().map(|facet| facet.lines(values).map(|[a, b]| (b - a).norm()).sum::<f64>()).sum();
    let each = length / count as f64;
    let mut probes = Vec::with_capacity(count);
    let mut passed = 0.0;
    for facet in &facets {
        for [a, b] in facet.lines(values) {
            let line = (b - a).norm();
            while (probes.len() as f64 + 0.5) * each < passed + line {
                let share = ((probes.len() as f64 + 0.5) * each - passed) / line;
                probes.push(Probe { point: a + share * (b - a), triangle: facet.triangle });
            }
            passed += line;
        }
    }
    probes
}

/// Values of the passes that are long enough and go on over the whole part: ascending. Passes that move on have none: their level
/// loops are [`ends`].
///
/// `segments` are those of one operation that should touch.
pub(crate) fn values(passes: &OrderedPasses, segments: &[&Segment]) -> Vec<f64> {
    if passes.continuous {
        return Vec::new();
    }
    let scalar = &*passes.scalar;
    let value = |tip: [f64; 3]| scalar.value(tip.into());
    let mut begun = None;
    // by the value at the chain's start: on a spiral each move lies nearly on the value of the one before it
    let chains = segments.chunk_by(|a, b| {
        let joined = b.start == Some(a.end);
        let first = *begun.get_or_insert_with(|| value(a.end));
        let goes_on = joined && holds(scalar, a) && holds(scalar, b) && (first - value(b.end)).abs() <= scalar.same();
        if !goes_on {
            begun = None;
        }
        goes_on
    });
    let length = |chain: &[&Segment]| chain.iter().map(|segment| segment.length()).sum::<f64>();
    let long = chains.filter(|chain| holds(scalar, chain[0]) && length(chain) > LONG * passes.step_at(chain[0].end));
    let long = long.map(|chain| [value(chain[0].end), length(chain)]).collect();
    let mut values = scalar.throughout(long, passes.pitch.even());
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| *b - *a <= scalar.same());
    values
}

/// Where passes end that are to end all around: with a level at the foot of what they are for, and where they move on at its
/// top.
pub(crate) struct End {
    /// The value there.
    pub value: f64,
    /// The moves that go to it, by their numbers; none where all of the operation do.
    pub moves: Option<Range<usize>>,
}

/// The ends of one operation's passes: where they move on, those of each chain of moves; else the lowest of all, and the one at
/// which the program ends.
pub(crate) fn ends(passes: &OrderedPasses, segments: &[&Segment]) -> Vec<End> {
    let scalar = &*passes.scalar;
    if !scalar.ends_all_around() {
        return Vec::new();
    }
    if !passes.continuous {
        let value = |segment: &&Segment| scalar.value(segment.end.into());
        let levels = || segments.iter().filter(|segment| holds(scalar, segment)).map(value);
        let mut ends: Vec<f64> = levels().min_by(f64::total_cmp).into_iter().chain(levels().last()).collect();
        ends.dedup_by(|last, lowest| (*last - *lowest).abs() <= scalar.same());
        return ends.into_iter().map(|value| End { value, moves: None }).collect();
    }
    // a move straight down between two of them is no end
    let apart = |a: &Segment, start: [f64; 3]| (Vector::from(start) - Vector::from(a.end)).norm();
    let goes_on = |a: &&Segment, b: &&Segment| b.start.is_some_and(|start| apart(a, start) < passes.pitch.smallest());
    let mut first = 0;
    let mut ends = Vec::new();
    for chain in segments.chunk_by(goes_on) {
        let moves = first..first + chain.len();
        first = moves.end;
        ends.extend(ends_of(passes, chain).into_iter().map(|value| End { value, moves: Some(moves.clone()) }));
    }
    ends
}

/// The values at which a chain of moves that move on ends: the lowest that it goes down to, however it does, and those of level loops
/// at its top and bottom.
fn ends_of(passes: &OrderedPasses, chain: &[&Segment]) -> Vec<f64> {
    let scalar = &*passes.scalar;
    let value = |segment: &Segment| scalar.value(segment.end.into());
    let [low, high] = chain.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], segment| {
        [low.min(value(segment)), high.max(value(segment))]
    });
    let is_level = |end: f64| {
        let level =
            chain.iter().filter(|segment| holds(scalar, segment) && (value(segment) - end).abs() <= scalar.same());
        level.map(|segment| segment.length()).sum::<f64>() > LONG * passes.pitch.at(end)
    };
    let goes_down = high - low > passes.pitch.smallest();
    let bottom = (goes_down || is_level(low)).then_some(low);
    bottom.into_iter().chain((goes_down && is_level(high)).then_some(high)).collect()
}

/// A value of the scalar at which moves lie.
#[derive(Clone, Copy)]
pub(crate) struct Pass<'a> {
    pub value: f64,
    pub first: &'a Segment,
    pub last: &'a Segment,
}

/// Every value at which one of the moves lies, however short: ascending. Of passes that move on, the values at moves' ends.
pub(crate) fn passes<'a>(expected: &OrderedPasses, segments: &[&'a Segment]) -> Vec<Pass<'a>> {
    let scalar = &*expected.scalar;
    let own = segments.iter().filter(|segment| expected.continuous || holds(scalar, segment));
    let mut passes: Vec<Pass> =
        own.map(|segment| Pass { value: scalar.value(segment.end.into()), first: segment, last: segment }).collect();
    passes.sort_by(|a, b| a.value.total_cmp(&b.value));
    passes.dedup_by(|b, a| {
        let one = b.value - a.value <= scalar.same();
        if one {
            a.first = if b.first.index < a.first.index { b.first } else { a.first };
            a.last = if b.last.index > a.last.index { b.last } else { a.last };
        }
        one
    });
    passes
}

/// Whether a move lies on one pass.
pub(crate) fn holds(scalar: &dyn Scalar, segment: &Segment) -> bool {
    let value = |tip: [f64; 3]| scalar.value(tip.into());
    segment.start.is_some_and(|start| (value(start) - value(segment.end)).abs() <= scalar.same())
}

/// A triangle on which passes should show.
struct Facet {
    triangle: usize,
    corners: [Vector; 3],
    /// The height or position of the tool that touches each corner.
    values: [f64; 3],
}

impl Facet {
    fn new(mesh: &Mesh, triangle: usize, body: &Body, scalar: &dyn Scalar) -> Option<Self> {
        let up = mesh.normal(triangle);
        let touching = body.farthest(up).0;
        let corners = mesh.corners(triangle);
        let tips = corners.map(|corner| Vector::from(body.tip(corner - touching)));
        let shows = tips.iter().any(|tip| scalar.shows_on(*tip, up));
        shows.then(|| Self { triangle, corners, values: tips.map(|tip| scalar.value(tip)) })
    }

    /// Where the tool at these heights or positions touches it.
    fn lines<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = [Vector; 2]> + 'a {
        let least = self.values.into_iter().fold(f64::INFINITY, f64::min);
        let most = self.values.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let first = values.partition_point(|value| *value <= least);
        values[first..].iter().take_while(move |value| **value < most).filter_map(|value| self.line(*value))
    }

    fn line(&self, value: f64) -> Option<[Vector; 2]> {
        let mut crossings = (0..3).filter_map(|i| {
            let (a, b) = (self.values[i], self.values[(i + 1) % 3]);
            let share = (value - a) / (b - a);
            let between = (a < value) != (b < value);
            between.then(|| self.corners[i] + share * (self.corners[(i + 1) % 3] - self.corners[i]))
        });
        Some([crossings.next()?, crossings.next()?])
    }
}

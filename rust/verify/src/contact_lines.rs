//! Where the passes that a text has should touch: lines on the triangles, because along a facet the tool's height and its
//! place change as evenly as the point that it touches.

use styluscam_geometry::Mesh;

use crate::body::Body;
use crate::legs::Leg;
use crate::passes::Spacing;
use crate::probes::Probe;
use crate::Vector;

/// Levels that differ by less are one, mm.
pub(crate) const SAME_LEVEL: f64 = 1e-3;
/// Rows that differ by less are one, mm: places on them are rounded to a machine's last digit.
const SAME_ROW: f64 = 5e-3;
/// Moves at one height are a pass when they are as long as so many steps: links along the part are shorter.
const LONG: f64 = 6.0;
/// On ground as gentle as this, a sine, the tolerance moves a level far, or leaves none.
const GENTLE: f64 = 0.15;
/// On walls as steep as this, a cosine, rows climb.
const STEEP: f64 = 0.1;

/// Points spread evenly over the lines at which the passes of `legs` should touch the triangles `wanted`, about `count`
/// of them.
///
/// `legs` are those of one operation that should touch.
pub(crate) fn spread(
    mesh: &Mesh,
    wanted: &[usize],
    body: &Body,
    spacing: Spacing,
    legs: &[&Leg],
    count: usize,
) -> Vec<Probe> {
    let values = values(spacing, legs);
    let facets: Vec<Facet> = wanted.iter().filter_map(|triangle| Facet::new(mesh, *triangle, body, spacing)).collect();
    let length: f64 = facets.iter().map(|facet| facet.lines(&values).map(|[a, b]| (b - a).norm()).sum::<f64>()).sum();
    let each = length / count as f64;
    let mut probes = Vec::with_capacity(count);
    let mut passed = 0.0;
    for facet in &facets {
        for [a, b] in facet.lines(&values) {
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

/// Heights of the levels, or places of the rows across, that are long enough and go on over the whole part: ascending.
fn values(spacing: Spacing, legs: &[&Leg]) -> Vec<f64> {
    let (pitch, same) = spacing.measures();
    let value = |tip: [f64; 3]| spacing.value(tip.into());
    let chains = legs.chunk_by(|a, b| {
        let joined = b.start == Some(a.end);
        joined && spacing.holds(a) && spacing.holds(b) && (value(a.end) - value(b.end)).abs() <= same
    });
    let length = |chain: &[&Leg]| chain.iter().map(|leg| leg.length()).sum::<f64>();
    let long = chains.filter(|chain| spacing.holds(chain[0]) && length(chain) > LONG * pitch);
    let mut values: Vec<f64> = match spacing {
        Spacing::Levels(_) => long.map(|chain| value(chain[0].end)).collect(),
        Spacing::Rows(..) => in_step(long.map(|chain| [value(chain[0].end), length(chain)]).collect(), pitch, same),
    };
    values.sort_by(f64::total_cmp);
    values.dedup_by(|b, a| *b - *a <= same);
    values
}

/// Of rows, with their places and lengths, the places of those that lie whole steps apart: rows that were added for a strip
/// between them are no longer than the strip.
fn in_step(mut rows: Vec<[f64; 2]>, step: f64, same: f64) -> Vec<f64> {
    let past = |[place, _]: &[f64; 2]| place.rem_euclid(step);
    rows.sort_by(|a, b| past(a).total_cmp(&past(b)));
    let mut sets: Vec<Vec<[f64; 2]>> = rows.chunk_by(|a, b| past(b) - past(a) <= same).map(<[_]>::to_vec).collect();
    // a step on is where the first ones are
    if let [first, .., last] = &mut sets[..] {
        if past(&first[0]) + step - past(&last[last.len() - 1]) <= same {
            first.append(last);
        }
    }
    let length = |set: &Vec<[f64; 2]>| set.iter().map(|[_, length]| length).sum::<f64>();
    let longest = sets.into_iter().max_by(|a, b| length(a).total_cmp(&length(b)));
    longest.into_iter().flatten().map(|[place, _]| place).collect()
}

/// A height or a place across at which moves lie.
#[derive(Clone, Copy)]
pub(crate) struct Pass<'a> {
    pub value: f64,
    pub first: &'a Leg,
    pub last: &'a Leg,
}

/// Every height or place across at which one of the moves lies, however short: ascending.
pub(crate) fn passes<'a>(spacing: Spacing, legs: &[&'a Leg]) -> Vec<Pass<'a>> {
    let own = legs.iter().filter(|leg| spacing.holds(leg));
    let mut passes: Vec<Pass> =
        own.map(|leg| Pass { value: spacing.value(leg.end.into()), first: leg, last: leg }).collect();
    passes.sort_by(|a, b| a.value.total_cmp(&b.value));
    let (_, same) = spacing.measures();
    passes.dedup_by(|b, a| {
        let one = b.value - a.value <= same;
        if one {
            a.first = if b.first.index < a.first.index { b.first } else { a.first };
            a.last = if b.last.index > a.last.index { b.last } else { a.last };
        }
        one
    });
    passes
}

impl Spacing {
    /// The distance ordered, mm.
    pub(crate) fn pitch(self) -> f64 {
        self.measures().0
    }

    /// The distance ordered, and that of passes that are one; mm.
    fn measures(self) -> (f64, f64) {
        match self {
            Self::Levels(step) => (step, SAME_LEVEL),
            Self::Rows(stepover, _) => (stepover, SAME_ROW),
        }
    }

    /// Whether a move lies on one pass.
    fn holds(self, leg: &Leg) -> bool {
        let value = |tip: [f64; 3]| self.value(tip.into());
        leg.start.is_some_and(|start| (value(start) - value(leg.end)).abs() <= self.measures().1)
    }
}

/// A triangle on which passes should show.
struct Facet {
    triangle: usize,
    corners: [Vector; 3],
    /// The height or place of the tool that touches each corner.
    values: [f64; 3],
}

impl Facet {
    fn new(mesh: &Mesh, triangle: usize, body: &Body, spacing: Spacing) -> Option<Self> {
        let up = mesh.normal(triangle);
        let shown = match spacing {
            Spacing::Levels(_) => up.xy().norm() > GENTLE,
            Spacing::Rows(..) => up.z > STEEP,
        };
        let touching = body.farthest(up).0;
        let corners = mesh.corners(triangle);
        let tip = |corner: Vector| Vector::from(body.tip(corner - touching));
        shown.then(|| Self { triangle, corners, values: corners.map(|corner| spacing.value(tip(corner))) })
    }

    /// Where the tool at these heights or places touches it.
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

#[cfg(test)]
mod tests {
    use super::in_step;

    #[test]
    fn rows_between_others_are_for_strips() {
        let regular: Vec<[f64; 2]> = (0..5).map(|row| [-0.6 + 0.3 * f64::from(row), 10.0]).collect();
        let mut rows = vec![[0.1, 25.0], [0.4, 12.0]];
        rows.extend(&regular);
        let mut found = in_step(rows, 0.3, 5e-3);
        found.sort_by(f64::total_cmp);
        assert_eq!(found, regular.iter().map(|[place, _]| *place).collect::<Vec<_>>());
        assert!(in_step(Vec::new(), 0.3, 5e-3).is_empty());
    }
}

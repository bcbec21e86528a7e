//! The order of passes: the nearest of a group that are left comes next.

use rstar::{PointDistance, RTree, RTreeObject, AABB};
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use crate::{seam, Pass, PathPoint, Seam, Sense};

/// Groups of more passes are searched in a tree: for fewer it does not pay.
const FEW: usize = 16;
/// Points of a pass that stand in the tree as one, at most.
const STRETCH: usize = 16;

/// All passes in the order and direction in which they are followed, groups (levels or rows) one after the other.
///
/// Groups are turned round as the `sense` has it. Within a group the nearest pass comes next, the first of
/// equals; a loop begins where the `seam` has it. In n log n of the points, or nearly.
///
/// # Errors
/// `Cancelled`.
pub fn ordered(mut passes: Vec<Pass>, sense: Sense, seam: Seam, watch: &Watch) -> Result<Vec<Pass>, Cancelled> {
    watch.begin("ordering", passes.len());
    let mut ordered: Vec<Pass> = Vec::with_capacity(passes.len());
    for (number, group) in passes.chunk_by_mut(|a, b| a.group == b.group).enumerate() {
        let turned = sense.turns(number);
        let bearing = seam.bearing(number);
        for pass in group.iter_mut().filter(|pass| pass.closed) {
            bearing.into_iter().for_each(|bearing| seam::begin_at(&mut pass.points, bearing));
        }
        let last = ordered.last().and_then(|pass| pass.points.last()).map(|point| point.tip);
        for (number, from) in Left::of(group, turned, bearing.is_some()).in_order(last, watch)? {
            let pass = Pass { points: std::mem::take(&mut group[number].points), ..group[number] };
            ordered.push(directed(pass, turned, from.filter(|_| bearing.is_none())));
        }
    }
    Ok(ordered)
}

/// A pass in its direction; a loop begins at its point nearest to `from`, if that is given.
fn directed(mut pass: Pass, turned: bool, from: Option<Vector>) -> Pass {
    if turned {
        pass.points.reverse();
    }
    if let (true, Some(from)) = (pass.closed, from) {
        begin_nearest(&mut pass.points, from);
    }
    pass
}

/// Has a closed polyline begin at its point nearest to `from`, the first of equals.
pub fn begin_nearest(points: &mut Vec<PathPoint>, from: Vector) {
    points.pop();
    let nearest = nearest(points.iter(), from);
    points.rotate_left(nearest);
    points.extend(points.first().copied());
}

/// The number of the point nearest to another, the first of equals.
fn nearest<'a>(points: impl Iterator<Item = &'a PathPoint>, to: Vector) -> usize {
    let distances = points.map(|point| square(point, to)).enumerate();
    distances.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i)
}

fn square(point: &PathPoint, from: Vector) -> f64 {
    (point.tip - from).norm_squared()
}

/// The passes of a group that are not yet taken.
struct Left<'a> {
    group: &'a [Pass],
    turned: bool,
    /// Whether loops begin at their first points.
    is_begun: bool,
    is_taken: Vec<bool>,
    /// Of large groups: stretches of all that are left.
    tree: Option<RTree<Stretch<'a>>>,
}

impl<'a> Left<'a> {
    fn of(group: &'a [Pass], turned: bool, is_begun: bool) -> Self {
        let entries = |pass| entries(pass, turned, is_begun);
        let stretches = || group.iter().enumerate().flat_map(|(number, pass)| stretches(number, entries(pass)));
        let tree = (group.len() > FEW).then(|| RTree::bulk_load(stretches().collect()));
        Self { group, turned, is_begun, is_taken: vec![false; group.len()], tree }
    }

    /// The numbers of all passes in their order, each with where the tool comes from.
    fn in_order(mut self, from: Option<Vector>, watch: &Watch) -> Result<Vec<(usize, Option<Vector>)>, Cancelled> {
        let (mut order, mut from) = (Vec::with_capacity(self.group.len()), from);
        while let Some(number) = self.take(from) {
            watch.advance(1)?;
            order.push((number, from));
            from = left_at(&self.group[number], self.turned, from.filter(|_| !self.is_begun)).or(from);
        }
        Ok(order)
    }

    /// Takes the pass nearest to `from`, or the first.
    fn take(&mut self, from: Option<Vector>) -> Option<usize> {
        let number = match (from, &self.tree) {
            (None, _) => self.numbers().next(),
            (Some(from), Some(tree)) => {
                tree.nearest_neighbors(&from.into()).into_iter().map(|stretch| stretch.pass).min()
            }
            (Some(from), None) => {
                let distance = |number: &usize| least(entries(&self.group[*number], self.turned, self.is_begun), from);
                self.numbers().min_by(|a, b| distance(a).total_cmp(&distance(b)))
            }
        }?;
        self.is_taken[number] = true;
        let pass = &self.group[number];
        if let Some(tree) = &mut self.tree {
            for stretch in stretches(number, entries(pass, self.turned, self.is_begun)) {
                tree.remove(&stretch);
            }
        }
        Some(number)
    }

    fn numbers(&self) -> impl Iterator<Item = usize> + use<'_, 'a> {
        (0..self.group.len()).filter(|number| !self.is_taken[*number])
    }
}

/// Where a pass ends that is followed as [`directed`] has it.
fn left_at(pass: &Pass, turned: bool, from: Option<Vector>) -> Option<Vector> {
    let points = &pass.points;
    let end = match (from.filter(|_| pass.closed), turned) {
        // a loop ends where it begins; its last point is its first
        (Some(from), false) => points.get(nearest(points[..points.len().saturating_sub(1)].iter(), from)),
        (Some(from), true) => points.iter().rev().nth(nearest(points.iter().skip(1).rev(), from)),
        (None, false) => points.last(),
        (None, true) => points.first(),
    };
    end.map(|point| point.tip)
}

/// The points at which a pass may begin.
fn entries(pass: &Pass, turned: bool, is_begun: bool) -> &[PathPoint] {
    let entry = if turned { pass.points.last() } else { pass.points.first() };
    if pass.closed && !is_begun {
        &pass.points
    } else {
        entry.map_or(&[][..], std::slice::from_ref)
    }
}

fn least(points: &[PathPoint], from: Vector) -> f64 {
    points.iter().map(|point| square(point, from)).fold(f64::INFINITY, f64::min)
}

/// Stretches of some points of a pass.
pub(super) fn stretches(pass: usize, points: &[PathPoint]) -> impl Iterator<Item = Stretch<'_>> {
    points.chunks(STRETCH).map(move |points| Stretch { pass, points })
}

/// Some neighbouring points of a pass.
#[derive(PartialEq)]
pub(super) struct Stretch<'a> {
    /// Its number.
    pub pass: usize,
    points: &'a [PathPoint],
}

impl RTreeObject for Stretch<'_> {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        let corner = |of: fn(f64, f64) -> f64| {
            self.points.iter().map(|point| point.tip).reduce(|a, b| a.zip_map(&b, of)).unwrap_or_default()
        };
        AABB::from_corners(corner(f64::min).into(), corner(f64::max).into())
    }
}

impl PointDistance for Stretch<'_> {
    fn distance_2(&self, from: &[f64; 3]) -> f64 {
        least(self.points, Vector::from(*from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pass(points: &[[f64; 3]], closed: bool, group: usize) -> Pass {
        let point =
            |p: &[f64; 3]| PathPoint { tip: Vector::from(*p), normal: Vector::z(), selected: true, triangle: 0 };
        let mut points: Vec<PathPoint> = points.iter().map(point).collect();
        if closed {
            points.extend(points.first().copied());
        }
        Pass { points, closed, group }
    }

    /// Always the nearest of all, by looking at all.
    fn ordered_slowly(passes: &[Pass], sense: Sense) -> Vec<Pass> {
        let mut ordered: Vec<Pass> = Vec::new();
        for (number, group) in passes.chunk_by(|a, b| a.group == b.group).enumerate() {
            let (turned, mut left): (bool, Vec<&Pass>) = (sense.turns(number), group.iter().collect());
            while !left.is_empty() {
                let last = ordered.last().and_then(|pass| pass.points.last()).map(|point| point.tip);
                let distance = |pass: &Pass| last.map_or(0.0, |from| least(entries(pass, turned, false), from));
                let nearest = (0..left.len()).min_by(|a, b| distance(left[*a]).total_cmp(&distance(left[*b]))).unwrap();
                ordered.push(directed(left.remove(nearest).clone(), turned, last));
            }
        }
        ordered
    }

    fn any_passes() -> impl Strategy<Value = Vec<Pass>> {
        // whole numbers: many are equally near
        let point = (0..30_i32, 0..30_i32).prop_map(|(x, y)| [f64::from(x), f64::from(y), 0.0]);
        let pass_of = (prop::collection::vec(point, 2..40), any::<bool>(), 0..3_usize);
        prop::collection::vec(pass_of, 1..80).prop_map(|mut passes| {
            passes.sort_by_key(|(_, _, group)| *group);
            passes.iter().map(|(points, closed, group)| pass(points, *closed, *group)).collect()
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]
        #[test]
        fn the_nearest_comes_next_and_the_first_of_equals(
            passes in any_passes(),
            sense in prop::sample::select(vec![Sense::Forward, Sense::Reversed, Sense::Alternate]),
        ) {
            let ordered = ordered(passes.clone(), sense, Seam::Nearest, &Watch::default()).unwrap();
            prop_assert_eq!(ordered, ordered_slowly(&passes, sense));
        }
    }

    #[test]
    fn thousands_of_loops_are_ordered_at_once() {
        let corner = |i: usize, k: usize| {
            let (sin, cos) = (k as f64).sin_cos();
            [3.0 * (i % 80) as f64 + cos, 3.0 * (i / 80) as f64 + sin, 0.0]
        };
        let loops: Vec<Pass> =
            (0..6400).map(|i| pass(&std::array::from_fn::<_, 60, _>(|k| corner(i, k)), true, 0)).collect();
        let began = std::time::Instant::now();
        assert_eq!(
            ordered(loops.clone(), Sense::Forward, Seam::Nearest, &Watch::default()).unwrap().len(),
            loops.len()
        );
        // half a second of work; to look at all of them takes 40, and machines are busy
        assert!(began.elapsed().as_secs_f64() < 30.0, "{:?}", began.elapsed());
    }

    #[test]
    fn it_can_be_cancelled() {
        let watch = Watch::default();
        watch.cancel();
        assert_eq!(
            ordered(vec![pass(&[[0.0; 3]; 2], false, 0)], Sense::Forward, Seam::Nearest, &watch),
            Err(Cancelled)
        );
    }
}

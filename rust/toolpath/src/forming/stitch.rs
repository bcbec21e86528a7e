//! Which points of two neighbouring loops belong together.
//!
//! The band between two contours is filled with triangles greedily: of the two next ones that with the shorter side comes
//! first (H. N. Christiansen, T. W. Sederberg, "Conversion of complex contour line definitions into polygonal element
//! mosaics", SIGGRAPH 1978). Its sides pair the points, in the order of both loops: no two pairs cross.

use crate::PathPoint;

/// Share of its own distances in how far round a point is.
const OWN: f64 = 0.1;

/// The nearest point of the upper loop lies no more sides from a point's pair.
const AROUND: usize = 3;

/// A position in plan, mm.
type Plan = nalgebra::Vector2<f64>;

/// Numbers of points of two closed loops that belong together, both in their order and once round: from their first points to
/// their last.
pub fn pairs(above: &[PathPoint], below: &[PathPoint]) -> Vec<[usize; 2]> {
    let mut pairs = Vec::with_capacity(above.len() + below.len());
    let (mut i, mut j) = (0, 0);
    if above.is_empty() || below.is_empty() {
        return pairs;
    }
    loop {
        pairs.push([i, j]);
        let side = |i: usize, j: usize| Some((above.get(i)?.tip - below.get(j)?.tip).xy().norm_squared());
        match (side(i + 1, j), side(i, j + 1)) {
            (None, None) => return pairs,
            (Some(a), Some(b)) if a <= b => i += 1,
            (Some(_), None) => i += 1,
            (_, Some(_)) => j += 1,
        }
    }
}

/// The point of a side of a loop that is nearest in plan to a point of the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beside {
    /// Number of the point of the loop at which the side begins.
    pub side: usize,
    /// Share of the side.
    pub share: f64,
    /// Distance, squared, mm^2.
    pub square: f64,
}

/// For each point of the second loop what of the first is beside it.
///
/// Both loops begin in one corner, say: to its point there the first loop's last side may be as near as its first one. What is
/// more than half of the loop farther round than the point itself therefore counts only where there is nothing else.
pub fn beside(pairs: &[[usize; 2]], [first, second]: [&[PathPoint]; 2]) -> Vec<Beside> {
    let fans = pairs.chunk_by(|a, b| a[1] == b[1]);
    let [round, own] = [by_length(first), by_length(second)];
    let of_fan = |fan: &[[usize; 2]]| {
        let ([from, _], [to, j]) = (*fan.first()?, *fan.last()?);
        let sides = from.saturating_sub(AROUND)..(to + AROUND).min(first.len().checked_sub(1)?);
        let point = second.get(j)?.tip.xy();
        let near = sides.map(|side| {
            let (share, square) = nearest(point, [first[side].tip.xy(), first[side + 1].tip.xy()]);
            Beside { side, share, square }
        });
        let is_opposite = |near: &Beside| (0.5 * (round[near.side] + round[near.side + 1]) - own[j]).abs() > 0.5;
        near.min_by(|a, b| is_opposite(a).cmp(&is_opposite(b)).then(a.square.total_cmp(&b.square)))
    };
    fans.filter_map(of_fan).collect()
}

/// How far round the lower loop its points are, from 0 to 1, so that neighbouring turns are as far round at neighbouring points:
/// as far as what is `beside` them on the upper loop is by `round`, but for a tenth by their own distances. That tenth keeps
/// points apart that have one nearest point, a corner, and holds the sum of all turns to the distances.
pub fn carried(beside: &[Beside], round: &[f64], below: &[PathPoint]) -> Vec<f64> {
    let mut least = 0.0_f64;
    let carry = |(near, own): (&Beside, &f64)| {
        let [from, to] = [near.side, near.side + 1].map(|point| round.get(point).copied().unwrap_or(1.0));
        least = least.max(from + near.share * (to - from));
        least + OWN * (own - least)
    };
    let mut carried: Vec<f64> = beside.iter().zip(&by_length(below)).map(carry).collect();
    if let [begin, .., end] = &mut carried[..] {
        (*begin, *end) = (0.0, 1.0);
    }
    carried
}

/// How far round a loop its points are by their distances in plan, from 0 to 1.
pub fn by_length(points: &[PathPoint]) -> Vec<f64> {
    let mut round = vec![0.0];
    for side in points.windows(2) {
        round.push(round[round.len() - 1] + (side[1].tip - side[0].tip).xy().norm());
    }
    let whole = round.last().copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
    round.iter_mut().for_each(|length| *length /= whole);
    round
}

/// The share of a side at which it is nearest to a point, and its distance there, squared, mm^2.
pub fn nearest(point: Plan, [a, b]: [Plan; 2]) -> (f64, f64) {
    let along = b - a;
    let square = along.norm_squared();
    let share = if square > 0.0 { ((point - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (share, (point - a - along * share).norm_squared())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use styluscam_geometry::Vector;

    fn ring(count: usize, radius: f64, z: f64) -> Vec<PathPoint> {
        let at = |i: usize| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / count as f64);
            PathPoint {
                tip: Vector::new(radius * cos, radius * sin, z),
                normal: Vector::z(),
                selected: true,
                triangle: 0,
            }
        };
        (0..=count).map(|i| at(i % count)).collect()
    }

    proptest! {
        #[test]
        fn pairs_go_once_round_both_loops_and_stay_near(above in 3..60_usize, below in 3..60_usize) {
            let (outer, inner) = (ring(above, 10.0, 0.0), ring(below, 9.0, -1.0));
            let found = pairs(&outer, &inner);
            prop_assert_eq!(found.len(), above + below + 1);
            prop_assert_eq!((found[0], found[found.len() - 1]), ([0, 0], [above, below]));
            // no side spans more than the chords of both loops
            let chord = |count: usize| 20.0 * libm::sin(std::f64::consts::PI / count as f64);
            let longest = 1.0 + chord(above).max(chord(below));
            prop_assert!(found.iter().all(|[a, b]| (outer[*a].tip - inner[*b].tip).xy().norm() <= longest));
        }

        #[test]
        fn points_are_as_far_round_as_those_beside_them(above in 3..60_usize, below in 3..60_usize) {
            let (outer, inner) = (ring(above, 10.0, 0.0), ring(below, 9.0, -1.0));
            let beside = beside(&pairs(&outer, &inner), [&outer, &inner]);
            let carried = carried(&beside, &by_length(&outer), &inner);
            prop_assert_eq!(carried.len(), below + 1);
            prop_assert!(carried[0].abs() < 1e-15 && (carried[below] - 1.0).abs() < 1e-15);
            prop_assert!(carried.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", carried);
        }
    }

    #[test]
    fn a_loop_that_begins_in_a_corner_is_not_taken_for_round_there() {
        let square = |half: f64, first: [f64; 2], second: [f64; 2]| {
            let corners = [first, second, [half, half], [-half, half], first];
            let mut points = ring(4, half, 0.0);
            points.iter_mut().zip(corners).for_each(|(point, [x, y])| point.tip = Vector::new(x, y, point.tip.z));
            points
        };
        // the inner one's first corner is nearer to the last side of the outer one than to the first
        let outer = square(10.0, [-10.0, -10.0], [10.0, -10.0]);
        let inner = square(9.0, [-9.001, -9.0], [9.01, -9.0]);
        let beside = beside(&pairs(&outer, &inner), [&outer, &inner]);
        let carried = carried(&beside, &by_length(&outer), &inner);
        let even = carried.iter().enumerate().all(|(corner, round)| (round - 0.25 * corner as f64).abs() < 0.02);
        assert!(even, "{carried:?}");
    }

    #[test]
    fn what_is_carried_on_fine_rings_are_their_angles() {
        let (outer, inner) = (ring(720, 10.0, 0.0), ring(500, 9.0, -1.0));
        let beside = beside(&pairs(&outer, &inner), [&outer, &inner]);
        let carried = carried(&beside, &by_length(&outer), &inner);
        let worst = carried.iter().enumerate().map(|(j, share)| (share - j as f64 / 500.0).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-4, "{worst}");
    }
}

//! The angles of two axes along a path: of all that point the tool right, those that turn least on the way.

use super::error::RotaryError;
use super::kinematics::{cross, dot, norm, RotaryAxes, Vector, UP};
use super::poses::Pose;
use crate::machine::Carrier;

/// A direction this near to an axis' own leaves its angle free, as a sine.
const ALONG: f64 = 1e-9;
/// What a turn counts there, beside one of an upright tool.
const DEARER: f64 = 4.0;
/// By so much a direction may miss the reach of the axes: rounding.
const ROUNDING: f64 = 1e-12;

/// Angles of both axes, deg; none where it is free.
type Free = [Option<f64>; 2];

/// What else counts of a pose.
#[derive(Clone, Copy, Default)]
struct Step {
    /// How far below the highest, 0 to 1 for the lowest.
    deep: f64,
    /// Whether it is gone to from wherever the machine stands.
    is_fresh: bool,
}

/// A pair of angles at a pose, and how it was come to.
struct State {
    angles: [f64; 2],
    cost: f64,
    before: usize,
}

impl RotaryAxes {
    /// The angles of both axes, deg, that point the tool along each direction (unit vectors of work coordinates): within the
    /// limits, and with the least sum of squares of the turns on the way.
    ///
    /// # Errors
    /// [`RotaryError::Unreachable`], [`RotaryError::Limit`].
    pub fn angles(&self, directions: &[[f64; 3]]) -> Result<Vec<[f64; 2]>, RotaryError> {
        let found: Vec<Vec<Free>> = directions.iter().map(|direction| self.pairs(*direction)).collect();
        self.chosen(&found, &vec![Step::default(); found.len()])
    }

    /// The cheapest of the pairs that may be taken along a path; free axes turn where it is least deep.
    fn chosen(&self, found: &[Vec<Free>], steps: &[Step]) -> Result<Vec<[f64; 2]>, RotaryError> {
        let ahead = ahead(found);
        let mut levels: Vec<Vec<State>> = Vec::with_capacity(found.len());
        for (index, pairs) in found.iter().enumerate() {
            if pairs.is_empty() {
                return Err(RotaryError::Unreachable { index });
            }
            let level = match levels.last() {
                None => pairs.iter().flat_map(|pair| self.first(*pair, &ahead[index])).collect(),
                Some(before) => {
                    // where it is free before as well it may turn to what comes
                    let is_free = |i: usize| found[index - 1].iter().all(|pair| pair[i].is_none());
                    let free = [0, 1].map(|i| steps[index].is_fresh || is_free(i));
                    let ahead = [0, 1].map(|i| free[i].then_some(ahead[index][i].as_slice()));
                    let deepest = steps[index - 1].deep.max(steps[index].deep);
                    self.next(before, pairs, ahead, 1.0 + deepest)
                }
            };
            if level.is_empty() {
                return Err(RotaryError::Limit { index });
            }
            levels.push(level);
        }
        Ok(cheapest(&levels))
    }

    /// Gives poses their angles.
    pub(crate) fn turn_to(&self, poses: &mut [Pose]) -> Result<(), RotaryError> {
        let pairs: Vec<Vec<Free>> = poses.iter().map(|pose| self.pairs(pose.direction)).collect();
        let held = |(pairs, pose): (&Vec<Free>, &Pose)| -> Vec<Free> {
            pairs.iter().map(|pair| [0, 1].map(|i| pair[i].or(pose.held[i]))).collect()
        };
        let known: Vec<Vec<Free>> = pairs.iter().zip(poses.iter()).map(held).collect();
        let heights = || poses.iter().map(|pose| pose.tip[2]);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        let deep = |z: f64| (high - z) / (high - low).max(f64::MIN_POSITIVE);
        let steps: Vec<Step> =
            poses.iter().map(|pose| Step { deep: deep(pose.tip[2]), is_fresh: pose.is_fresh }).collect();
        let of_move = |index: usize| poses.get(index).map_or(index, |pose| pose.index);
        let angles = self.chosen(&known, &steps).map_err(|error| match error {
            RotaryError::Unreachable { index } => RotaryError::Unreachable { index: of_move(index) },
            RotaryError::Limit { index } => RotaryError::Limit { index: of_move(index) },
            turn @ RotaryError::Turn { .. } => turn,
        })?;
        for ((pose, angles), pairs) in poses.iter_mut().zip(angles).zip(&pairs) {
            pose.angles = angles;
            pose.held = [0, 1].map(|i| pairs.iter().all(|pair| pair[i].is_none()).then_some(angles[i]));
        }
        Ok(())
    }

    /// Where a path may start: every whole turn within the limits, nearer to 0 cheaper; where an angle is free, at 0 or at what comes.
    fn first(&self, pair: Free, ahead: &[Vec<f64>; 2]) -> Vec<State> {
        let [first, second] = [0, 1].map(|i| match pair[i] {
            Some(angle) => self.wraps(i, angle),
            None => {
                let [low, high] = self.axes()[i].limits_deg;
                let coming = ahead[i].iter().flat_map(|angle| self.wraps(i, *angle));
                std::iter::once(0.0_f64.clamp(low, high)).chain(coming).collect()
            }
        });
        let both = first.iter().flat_map(|a| second.iter().map(move |b| [*a, *b]));
        both.map(|angles| State { angles, cost: 1e-9 * square(angles), before: 0 }).collect()
    }

    /// The cheapest ways on, one from every state before for every pair of angles; where one is free it stays, or turns to what comes
    /// (`ahead`, of an angle that was free before as well): where the tool begins to lean a turn is dearer.
    fn next(&self, before: &[State], pairs: &[Free], ahead: [Option<&[f64]>; 2], deep: f64) -> Vec<State> {
        let mut found: Vec<State> = Vec::new();
        for (number, state) in before.iter().enumerate() {
            for pair in pairs {
                let nearest = |i: usize, angle: f64| {
                    let apart = |angle: &f64| (angle - state.angles[i]).abs();
                    self.wraps(i, angle).into_iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))
                };
                let [first, second] = [0, 1].map(|i| match pair[i] {
                    None => {
                        let coming = ahead[i].into_iter().flatten().filter_map(|angle| nearest(i, *angle));
                        std::iter::once(state.angles[i]).chain(coming).collect()
                    }
                    Some(angle) => nearest(i, angle).into_iter().collect::<Vec<f64>>(),
                });
                for angles in first.iter().flat_map(|a| second.iter().map(move |b| [*a, *b])) {
                    let dearer = |i: usize| match (ahead[i].is_some(), pair[i]) {
                        (true, Some(_)) => DEARER,
                        (true, None) => deep,
                        (false, _) => 1.0,
                    };
                    let turned = [0, 1].map(|i| (angles[i] - state.angles[i]) * dearer(i));
                    let new = State { angles, cost: state.cost + square(turned), before: number };
                    match found.iter_mut().find(|known| near(known.angles, new.angles)) {
                        Some(known) if known.cost <= new.cost => {}
                        Some(known) => *known = new,
                        None => found.push(new),
                    }
                }
            }
        }
        found
    }

    /// An angle and whole turns more or less, within the limits of an axis, deg.
    fn wraps(&self, axis: usize, angle: f64) -> Vec<f64> {
        let [low, high] = self.axes()[axis].limits_deg;
        let mut turned = angle + 360.0 * ((low - angle) / 360.0).ceil();
        let mut found = Vec::new();
        while turned <= high {
            found.push(turned);
            turned += 360.0;
        }
        found
    }

    /// Both pairs of angles, deg, that point the tool along a direction, not yet by limits; none where it cannot.
    ///
    /// With all turns on one side, two rotations take one vector to another: what is between them has known shares of both
    /// directions and length 1 (B. Paden, Kinematics and Control Robot Manipulators, Berkeley 1986, subproblem 2).
    fn pairs(&self, direction: Vector) -> Vec<Free> {
        let [first, second] = self.axes();
        // (outer, its sign, inner, from, to)
        let (outer, sign, inner, from, to) = match (first.carries, second.carries) {
            (Carrier::Table, Carrier::Table) => (0, 1.0, 1, direction, UP),
            (Carrier::Head, Carrier::Head) => (0, 1.0, 1, UP, direction),
            (Carrier::Head, Carrier::Table) => (0, -1.0, 1, direction, UP),
            (Carrier::Table, Carrier::Head) => (1, -1.0, 0, direction, UP),
        };
        let (about, within) = (self.axes()[outer].direction, self.axes()[inner].direction);
        let across = cross(about, within);
        let (shared, wide) = (dot(about, within), dot(across, across));
        let (p, q) = (dot(to, about), dot(from, within));
        let [x, y] = [(p - shared * q) / wide, (q - shared * p) / wide];
        let rest = (1.0 - x * x - y * y - 2.0 * shared * x * y) / wide;
        if rest < -ROUNDING / wide {
            return Vec::new();
        }
        let aside = rest.max(0.0).sqrt();
        let pair = |aside: f64| {
            let middle = [0, 1, 2].map(|i| x * about[i] + y * within[i] + aside * across[i]);
            let mut angles = [None; 2];
            angles[inner] = angle_about(within, from, middle);
            angles[outer] = angle_about(about, middle, to).map(|angle| sign * angle);
            angles
        };
        if aside < ALONG {
            vec![pair(0.0)]
        } else {
            vec![pair(aside), pair(-aside)]
        }
    }
}

/// For every direction and axis the angles that the next direction at which it is not free may have.
fn ahead(found: &[Vec<Free>]) -> Vec<[Vec<f64>; 2]> {
    let mut coming: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    let mut ahead: Vec<[Vec<f64>; 2]> = Vec::with_capacity(found.len());
    for pairs in found.iter().rev() {
        ahead.push(coming.clone());
        for i in 0..2 {
            let fixed: Vec<f64> = pairs.iter().filter_map(|pair| pair[i]).collect();
            if !fixed.is_empty() {
                coming[i] = fixed;
            }
        }
    }
    ahead.reverse();
    ahead
}

/// The angle, deg, by which one vector is turned to another about a unit vector; none where it lies along that.
fn angle_about(about: Vector, from: Vector, to: Vector) -> Option<f64> {
    let beside = cross(about, from);
    let (sin, cos) = (dot(beside, to), dot(cross(beside, about), to));
    (norm(beside) > ALONG).then(|| libm::atan2(sin, cos).to_degrees())
}

fn square([a, b]: [f64; 2]) -> f64 {
    a * a + b * b
}

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    square([a[0] - b[0], a[1] - b[1]]) < 1e-12
}

/// The way to the cheapest of the last states.
fn cheapest(levels: &[Vec<State>]) -> Vec<[f64; 2]> {
    let last = levels.last().into_iter().flat_map(|level| level.iter().enumerate());
    let mut at = last.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost)).map_or(0, |(number, _)| number);
    let mut found: Vec<[f64; 2]> = levels
        .iter()
        .rev()
        .filter_map(|level| {
            let state = level.get(at)?;
            at = state.before;
            Some(state.angles)
        })
        .collect();
    found.reverse();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::{MachineError, RotaryAxis};

    fn axis(letter: char, carries: Carrier, direction: [f64; 3], limits_deg: [f64; 2]) -> RotaryAxis {
        RotaryAxis { letter, carries, direction, pivot: [10.0, -20.0, 150.0], limits_deg }
    }

    fn machines() -> Vec<RotaryAxes> {
        let (table, head) = (Carrier::Table, Carrier::Head);
        let x = |carrier| axis('A', carrier, [1.0, 0.0, 0.0], [-120.0, 120.0]);
        let b = |carrier| axis('B', carrier, [0.0, 1.0, 1.0], [-180.0, 180.0]);
        let c = |carrier| axis('C', carrier, [0.0, 0.0, 1.0], [-720.0, 720.0]);
        let pairs = [
            [x(table), c(table)],
            [c(head), x(head)],
            [x(head), c(table)],
            [c(table), x(head)],
            [b(table), c(table)],
            [c(head), b(head)],
        ];
        pairs.into_iter().map(|axes| RotaryAxes::new(axes).unwrap()).collect()
    }

    /// Twice around a cone, one that the nutating axis reaches too.
    fn around() -> Vec<[f64; 3]> {
        let at = |i: usize| 4.0 * std::f64::consts::PI * i as f64 / 200.0;
        (0..=200).map(|i| [0.6 * at(i).cos(), 0.6 * at(i).sin(), 0.8]).collect()
    }

    #[test]
    fn angles_point_the_tool_and_go_on_without_a_jump() {
        for machine in machines() {
            let angles = machine.angles(&around()).unwrap();
            for (angles, wanted) in angles.iter().zip(around()) {
                let found = machine.direction(*angles);
                assert!((0..3).all(|i| (found[i] - wanted[i]).abs() < 1e-12), "{machine:?}");
                let tip = [30.0, 40.0, -7.0];
                let back = machine.tip(machine.linear(tip, *angles), *angles);
                assert!((0..3).all(|i| (back[i] - tip[i]).abs() < 1e-12), "{machine:?}");
            }
            let largest = angles.windows(2).flat_map(|p| [p[1][0] - p[0][0], p[1][1] - p[0][1]]);
            assert!(largest.map(f64::abs).fold(0.0, f64::max) < 4.0, "{machine:?}");
        }
    }

    #[test]
    fn a_free_angle_turns_where_nothing_leans() {
        let axes = [
            axis('A', Carrier::Table, [1.0, 0.0, 0.0], [-120.0, 120.0]),
            axis('C', Carrier::Table, [0.0, 0.0, 1.0], [-360.0, 360.0]),
        ];
        let machine = RotaryAxes::new(axes).unwrap();
        let lean = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            [0.6 * sin, 0.6 * cos, 0.8]
        };
        // leaning, upright for three positions, leaning to another side
        let directions = [lean(0.0), UP, UP, UP, lean(70.0)];
        let angles = machine.angles(&directions).unwrap();
        let turned = |i: usize| (angles[i][1] - angles[i - 1][1]).abs();
        assert!(turned(1) < 1e-9 && turned(4) < 1e-9, "{angles:?}");
        assert!((turned(2) + turned(3) - 70.0).abs() < 1e-9, "{angles:?}");
    }

    #[test]
    fn what_axes_cannot_reach_is_refused() {
        let limited = |limits| {
            let axes = [
                axis('A', Carrier::Table, [1.0, 0.0, 0.0], limits),
                axis('C', Carrier::Table, [0.0, 0.0, 1.0], [-360.0, 360.0]),
            ];
            RotaryAxes::new(axes).unwrap()
        };
        assert_eq!(limited([-30.0, 20.0]).angles(&around()), Err(RotaryError::Limit { index: 0 }));
        // one and a half turns from the middle of 720 degrees do not fit on one side: the start is chosen so that they do
        assert!(limited([-120.0, 120.0]).angles(&around()[..=150]).is_ok());
        // two turns do not fit at all: the other side is leant to on the way, and both axes jump
        let turned = limited([-120.0, 120.0]).angles(&around()).unwrap();
        assert!(turned.windows(2).any(|pair| (pair[1][1] - pair[0][1]).abs() > 90.0));
        let nutating = machines().remove(4);
        assert_eq!(
            nutating.angles(&[[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]).map(|_| ()),
            Err(RotaryError::Unreachable { index: 1 })
        );
        let key = |axes| match RotaryAxes::new(axes) {
            Err(MachineError::Value { key, .. }) => key,
            other => panic!("{other:?}"),
        };
        let same = [axis('A', Carrier::Table, UP, [0.0, 1.0]), axis('C', Carrier::Head, UP, [0.0, 1.0])];
        assert_eq!(key(same), "rotary.axes[1].direction");
        let none = axis('B', Carrier::Table, [0.0; 3], [0.0, 1.0]);
        assert_eq!(key([none, same[0]]), "rotary.axes[0].direction");
        let twice = [same[0], axis('A', Carrier::Head, [1.0, 0.0, 0.0], [0.0, 1.0])];
        assert_eq!(key(twice), "rotary.axes[1].letter");
        let turned = axis('A', Carrier::Head, [1.0, 0.0, 0.0], [1.0, 0.0]);
        assert_eq!(key([turned, same[1]]), "rotary.axes[0].limits_deg");
    }

    #[test]
    fn an_upright_tool_leaves_the_table_where_it_is() {
        let machine = machines().remove(0);
        let lean = |angle: f64| [angle.sin(), 0.0, angle.cos()];
        let angles = machine.angles(&[lean(0.2), lean(0.1), UP, lean(0.1)]).unwrap();
        assert!((angles[2][1] - angles[1][1]).abs() < 1e-12 && angles[2][0].abs() < 1e-12, "{angles:?}");
    }
}

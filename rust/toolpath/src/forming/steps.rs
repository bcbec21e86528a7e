//! How far one level lies below the other: evenly, by a list, or as far as a bound at each height allows.

use super::spread::Ridge;
use super::wall_line::WallLine;

/// Share of a step by which turns are planned: on the long straight sides of a loop they lie up to a tenth farther apart.
const TURNS: f64 = 0.92;
/// Heights for which a bound is known.
const CELLS: usize = 1 << 14;

/// The distances between levels.
#[derive(Clone, Debug, PartialEq)]
pub enum Steps {
    /// Everywhere alike, mm.
    Even(f64),
    /// One after the other from a height down, the last one again and again; mm.
    Listed {
        /// From where they count.
        from: f64,
        /// The steps; at least one.
        steps: Vec<f64>,
    },
    /// No farther than a bound at any height between two levels.
    Bounded(StepBounds),
}

impl Steps {
    /// The step at a height, mm: the one that reaches it from above.
    #[must_use]
    pub fn at(&self, z: f64) -> f64 {
        match self {
            Self::Even(step) => *step,
            Self::Listed { from, steps } => {
                let mut bottom = *from;
                let reaches = |step: &&f64| {
                    bottom -= **step;
                    bottom <= z
                };
                steps.iter().find(reaches).or(steps.last()).copied().unwrap_or(0.0)
            }
            Self::Bounded(bounds) => bounds.at(z),
        }
    }

    /// The heights below `top`, mm, without end and rounding.
    pub(super) fn heights(&self, top: f64) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Even(step) => Box::new((1..).map(move |i: u32| top - f64::from(i) * step)),
            Self::Listed { from, steps } => {
                let last = steps.last().copied().unwrap_or(f64::INFINITY);
                let all = steps.iter().copied().chain(std::iter::repeat(last));
                let heights = all.scan(*from, |z, step| {
                    *z -= step;
                    Some(*z)
                });
                Box::new(heights.filter(move |z| *z < top))
            }
            Self::Bounded(bounds) => {
                Box::new(std::iter::successors(Some(bounds.below(top)), move |z| Some(bounds.below(*z))))
            }
        }
    }

    /// The job's key of them, for messages.
    pub(super) fn key(&self) -> &'static str {
        match self {
            Self::Even(_) => "step.height",
            Self::Listed { .. } => "step.list",
            Self::Bounded(_) => "step.scallop",
        }
    }

    /// The smallest of them, mm.
    #[must_use]
    pub fn smallest(&self) -> f64 {
        match self {
            Self::Even(step) => *step,
            Self::Listed { steps, .. } => steps.iter().copied().fold(f64::INFINITY, f64::min),
            Self::Bounded(bounds) => bounds.limits[0],
        }
    }
}

/// The largest step that is allowed at each value of an order: a height, or a position across rows.
#[derive(Clone, Debug, PartialEq)]
pub struct StepBounds {
    low: f64,
    /// Size of a cell, mm.
    cell: f64,
    /// By cell from `low` up.
    most: Vec<f64>,
    /// The smallest and the largest step, mm, whatever is allowed.
    limits: [f64; 2],
    /// The walls that allow the least, where their ridges are known as they are.
    walls: Option<Box<WallLine>>,
}

/// What a face allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowed {
    /// The lowest and the highest value at which it is touched, mm.
    pub values: [f64; 2],
    /// The step, mm.
    pub step: f64,
    /// The cosine of its slope at each of the values; none where it is no face but a crease between two.
    pub cosines: Option<[f64; 2]>,
}

impl StepBounds {
    /// Of what faces allow, in steps between `limits`.
    #[must_use]
    pub fn new(allowed: &[Allowed], limits: [f64; 2]) -> Self {
        Self::with_cosines(allowed, limits).0
    }

    /// The same for levels that are to leave a ridge.
    #[must_use]
    pub fn of_levels(allowed: &[Allowed], limits: [f64; 2], ridge: Ridge) -> Self {
        let (bounds, cosines) = Self::with_cosines(allowed, limits);
        let walls = Some(Box::new(WallLine::new(bounds.low, bounds.cell, &cosines, ridge)));
        Self { walls, ..bounds }
    }

    /// The bounds, and the cosine of the slope by cell of what allows least there; NaN where nothing does.
    fn with_cosines(allowed: &[Allowed], limits: [f64; 2]) -> (Self, Vec<f64>) {
        let low = allowed.iter().map(|face| face.values[0]).fold(f64::INFINITY, f64::min);
        let high = allowed.iter().map(|face| face.values[1]).fold(f64::NEG_INFINITY, f64::max);
        let cell = ((high - low) / CELLS as f64).max(f64::MIN_POSITIVE);
        let cells = if low <= high { CELLS } else { 0 };
        let mut bounds = Self { low, cell, most: vec![limits[1]; cells], limits, walls: None };
        let (mut least, mut cosines) = (vec![f64::INFINITY; cells], vec![f64::NAN; cells]);
        for Allowed { values: [low, high], step, cosines: slopes } in allowed {
            let [first, last] = [*low, *high].map(|value| bounds.cell_of(value));
            for cell in first..=last {
                bounds.most[cell] = bounds.most[cell].min(*step);
                let Some([from, to]) = slopes.filter(|_| *step < least[cell]) else { continue };
                let middle = bounds.low + (cell as f64 + 0.5) * bounds.cell;
                let share = if high > low { ((middle - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
                (least[cell], cosines[cell]) = (*step, from + share * (to - from));
            }
        }
        (bounds, cosines)
    }

    /// The same for turns that go down evenly from one step to the next: within a step of each value no more is allowed than
    /// there, for a turn's distance to the next lies between two steps, and of that [`TURNS`].
    #[must_use]
    pub fn for_turns(&self) -> Self {
        let mut most = self.most.clone();
        for (cell, step) in self.most.iter().enumerate() {
            let reach = (step.max(self.limits[0]) / self.cell).ceil() as usize;
            let around = cell.saturating_sub(reach)..(cell + reach + 1).min(most.len());
            most[around].iter_mut().for_each(|other| *other = other.min(TURNS * *step));
        }
        let [least, largest] = self.limits;
        Self { most, walls: None, limits: [TURNS * least, largest], ..self.clone() }
    }

    fn cell_of(&self, value: f64) -> usize {
        (((value - self.low) / self.cell).max(0.0) as usize).min(self.most.len().saturating_sub(1))
    }

    /// The step allowed at a value, mm.
    fn at(&self, value: f64) -> f64 {
        let most = if value < self.low { None } else { self.most.get(self.cell_of(value)) };
        most.copied().unwrap_or(self.limits[1]).max(self.limits[0])
    }

    /// The value to which a step down from another may lead: as far as the ridge is known to be low enough, or else as the mean
    /// over the step of what is allowed.
    fn below(&self, from: f64) -> f64 {
        let [least, most] = self.limits;
        let by_mean = from - self.below_by_mean(from);
        let by_walls = self.walls.as_ref().and_then(|walls| walls.step(from, by_mean, most));
        from - by_walls.unwrap_or(by_mean).clamp(least, most)
    }

    /// The value to which a step down from another may lead by the mean over it of what is allowed.
    fn below_by_mean(&self, from: f64) -> f64 {
        let [least, most] = self.limits;
        let cells = ((from - self.low) / self.cell).ceil().clamp(0.0, self.most.len() as f64) as usize;
        let over = (from - (self.low + cells as f64 * self.cell)).max(0.0);
        // beyond the cells nothing is known
        let cells = self.most[..cells].iter().enumerate().rev().map(|(cell, here)| {
            let bottom = self.low + cell as f64 * self.cell;
            (from.min(bottom + self.cell) - bottom, *here)
        });
        let mut mean = Mean::default();
        for (part, here) in std::iter::once((over, most)).chain(cells).chain(std::iter::once((most, most))) {
            if let Some(step) = mean.reached(part, here) {
                return from - step.clamp(least, most);
            }
        }
        from - most
    }

    /// Values from `low` to `high`, each a step after the other: the first one a step after `low`.
    pub(super) fn upwards(&self, low: f64, high: f64) -> impl Iterator<Item = f64> {
        let mirrored = Self {
            low: -(self.low + self.cell * self.most.len() as f64),
            most: self.most.iter().rev().copied().collect(),
            walls: None,
            ..*self
        };
        let first = mirrored.below(-low);
        let values = std::iter::successors(Some(first), move |value| Some(mirrored.below(*value)));
        values.map(|value| -value).take_while(move |value| *value < high)
    }
}

/// A mean of the steps allowed over a length, of the power -6: near to the least of them where they jump, so that no scallop is
/// exceeded where one face goes over into another, and near to the middle one where they change evenly.
///
/// Where a wall goes over into a rim or a fillet as large as the tool, the highest scallop between two passes is 1.13 times the
/// one asked for with a power of -1, 1.02 with -4, 0.99 with -6; where the step allowed rises by half over one step it is 0.91
/// with -6.
#[derive(Default)]
struct Mean {
    length: f64,
    /// The integral over the length of the allowed steps to the power of -6.
    sum: f64,
}

impl Mean {
    /// Adds a part over which `here` is allowed, unless the length comes up to the mean within it: that length then.
    fn reached(&mut self, part: f64, here: f64) -> Option<f64> {
        let square = here * here;
        let weight = (square * square * square).recip();
        let is_over = |more: f64| {
            let length = self.length + more;
            let square = length * length;
            (self.sum + more * weight) * (square * square * length) >= 1.0
        };
        if part > 0.0 && is_over(part) {
            let (mut low, mut high) = (0.0, part);
            while high - low > CLOSE * part {
                let middle = 0.5 * (low + high);
                if is_over(middle) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            return Some(self.length + high);
        }
        if part > 0.0 {
            self.sum += part * weight;
            self.length += part;
        }
        None
    }
}

/// A length is known to this share of a part.
const CLOSE: f64 = 1e-6;

#[cfg(test)]
#[allow(clippy::float_cmp)] // sums of halves are exact
mod tests {
    use super::*;

    /// The bounds of faces that allow a step over a range of values each.
    fn bounds(ranges: &[([f64; 2], f64)]) -> StepBounds {
        let allowed = ranges.iter().map(|(values, step)| Allowed { values: *values, step: *step, cosines: None });
        StepBounds::new(&allowed.collect::<Vec<_>>(), [0.05, 2.0])
    }

    #[test]
    fn listed_steps_count_from_where_they_begin() {
        let steps = Steps::Listed { from: 1.0, steps: vec![0.5, 0.25] };
        let heights: Vec<f64> = steps.heights(0.6).take(3).collect();
        assert_eq!(heights, [0.5, 0.25, 0.0]);
        assert_eq!([2.0, 0.6, 0.5, 0.4, -3.0].map(|z| steps.at(z)), [0.5, 0.5, 0.5, 0.25, 0.25]);
        assert_eq!(steps.smallest(), 0.25);
    }

    #[test]
    fn steps_are_shared_where_what_they_allow_changes() {
        // 0.5 from 0 down to -2, then 0.1 to -3, then 0.4
        let bounds = bounds(&[([-2.0, 0.0], 0.5), ([-3.0, -2.0], 0.1), ([-4.0, -3.0], 0.4)]);
        let steps = Steps::Bounded(bounds.clone());
        let heights: Vec<f64> = steps.heights(0.0).take_while(|z| *z > -4.0).collect();
        let steps: Vec<f64> = heights.windows(2).map(|pair| pair[0] - pair[1]).collect();
        // 0.5 to the jump, then hardly more than 0.1
        assert!(steps[..3].iter().all(|step| (step - 0.5).abs() < 1e-3), "{steps:?}");
        assert!(steps[3..12].iter().all(|step| *step < 0.12), "{steps:?}");
        assert!((steps[steps.len() - 1] - 0.4).abs() < 1e-3, "{steps:?}");
        let over_the_jump = -1.8 - bounds.below(-1.8);
        assert!((0.2..0.21).contains(&over_the_jump), "{over_the_jump}");
        assert_eq!([bounds.at(-2.5), bounds.at(-0.5), bounds.at(3.0)], [0.1, 0.5, 0.5]);
    }

    #[test]
    fn turns_take_the_smaller_step_where_steps_change() {
        let bounds = bounds(&[([0.0, 2.0], 0.5), ([2.0, 3.0], 0.125)]).for_turns();
        assert_eq!([1.0, 1.8, 1.9, 2.5].map(|value| bounds.at(value) / TURNS), [0.5, 0.5, 0.125, 0.125]);
    }

    #[test]
    fn steps_upwards_are_those_downwards_of_the_mirrored_bounds() {
        let bounds = bounds(&[([0.0, 2.0], 0.5), ([2.0, 3.0], 0.1)]);
        let values: Vec<f64> = bounds.upwards(0.0, 3.0).collect();
        assert!(values.windows(2).all(|pair| pair[1] > pair[0]), "{values:?}");
        assert!((values[0] - 0.5).abs() < 1e-9 && (12..=15).contains(&values.len()), "{values:?}");
    }

    #[test]
    fn what_allows_nothing_gets_the_smallest_step_and_nothing_known_the_largest() {
        let bounds = StepBounds { limits: [0.25, 2.0], ..bounds(&[([0.0, 1.0], 0.0)]) };
        assert_eq!(bounds.below(1.0), 0.75);
        assert!((StepBounds::new(&[], [0.25, 2.0]).below(1.0) + 1.0).abs() < 1e-5);
    }
}

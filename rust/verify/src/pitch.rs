//! How far apart neighbouring passes are to lie, in the scalar of their order.

/// Values that differ by less are one, mm.
const SAME: f64 = 1e-9;

/// The distance between neighbouring passes.
#[derive(Clone, Debug, PartialEq)]
pub enum Pitch {
    /// Everywhere alike, mm.
    Even(f64),
    /// One step after the other downwards, the last one again and again.
    Listed {
        /// Value from which they count, mm.
        from: f64,
        /// The steps, mm; at least one.
        steps: Vec<f64>,
    },
    /// As far as passes leave a scallop of a height: no more than that is to be left between them.
    Scallop {
        /// The scallop, mm.
        height: f64,
        /// Passes that lie no farther apart than the first, mm, may leave more; none lie farther apart than the second.
        steps: [f64; 2],
    },
}

impl Pitch {
    /// The largest step between neighbouring passes that lie at two values, or between them, mm.
    #[must_use]
    pub fn between(&self, low: f64, high: f64) -> f64 {
        match self {
            Self::Even(step) | Self::Scallop { steps: [_, step], .. } => *step,
            Self::Listed { from, steps } => {
                let mut top = *from;
                let mut most: f64 = 0.0;
                for step in steps {
                    let bottom = top - step;
                    if bottom <= high + SAME && top >= low - SAME {
                        most = most.max(*step);
                    }
                    top = bottom;
                }
                let below = steps.last().filter(|_| low <= top + SAME).copied().unwrap_or(0.0);
                let above = steps.first().filter(|_| high >= from - SAME).copied().unwrap_or(0.0);
                most.max(below).max(above)
            }
        }
    }

    /// The step at a value, mm; where two meet, the larger one.
    #[must_use]
    pub fn at(&self, value: f64) -> f64 {
        self.between(value, value)
    }

    /// The largest step of all, mm.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.between(f64::NEG_INFINITY, f64::INFINITY)
    }

    /// The smallest step of all, mm.
    #[must_use]
    pub fn smallest(&self) -> f64 {
        match self {
            Self::Even(step) | Self::Scallop { steps: [step, _], .. } => *step,
            Self::Listed { steps, .. } => steps.iter().copied().fold(f64::INFINITY, f64::min),
        }
    }

    /// The one step of passes that lie evenly.
    #[must_use]
    pub fn even(&self) -> Option<f64> {
        match self {
            Self::Even(step) => Some(*step),
            Self::Listed { .. } | Self::Scallop { .. } => None,
        }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // sums of halves are exact
mod tests {
    use super::Pitch;

    #[test]
    fn listed_steps_hold_where_they_lie() {
        let pitch = Pitch::Listed { from: 1.0, steps: vec![0.25, 0.5, 2.0] };
        for (value, step) in [(3.0, 0.25), (0.9, 0.25), (0.75, 0.5), (0.5, 0.5), (0.25, 2.0), (-1.0, 2.0), (-9.0, 2.0)]
        {
            assert_eq!(pitch.at(value), step, "{value}");
        }
        assert_eq!(pitch.between(0.5, 0.9), 0.5);
        assert_eq!((pitch.smallest(), pitch.largest(), pitch.even()), (0.25, 2.0, None));
        let one = Pitch::Listed { from: 0.0, steps: vec![0.5] };
        assert_eq!([one.at(2.0), one.at(-0.1), one.at(-7.0)], [0.5; 3]);
    }
}

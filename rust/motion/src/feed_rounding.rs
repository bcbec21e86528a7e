//! How far feeds that were read from a text are from those that were posted.

/// The rounding of a text's numbers, as far as it changes feeds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeedRounding {
    /// Whatever the move, mm/min.
    pub per_minute: f64,
    /// For each mm of the move, 1/min: of inverse time, whose number is read times the move's length.
    pub per_mm: f64,
    /// As a share of the feed: of feeds per revolution, whose speed is rounded.
    pub share: f64,
    /// By how much the move's length itself is rounded, mm, where feeds follow from it.
    pub length: f64,
}

impl FeedRounding {
    /// How far the feed (mm/min) of a move of some length (mm) may be off, mm/min; the length may be infinite where feeds do
    /// not follow from it.
    #[must_use]
    pub fn of(&self, feed: f64, length: f64) -> f64 {
        let by_length = if self.length > 0.0 { feed * self.length / length.max(self.length) } else { 0.0 };
        let by_number = if self.per_mm > 0.0 { self.per_mm * length } else { 0.0 };
        self.per_minute + by_number + self.share * feed + by_length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_time_is_off_by_its_number_and_by_the_length() {
        let rounding = FeedRounding { per_mm: 0.001, length: 0.002, ..FeedRounding::default() };
        assert!((rounding.of(1000.0, 20.0) - (0.02 + 0.1)).abs() < 1e-12);
        assert!((rounding.of(1000.0, 0.0) - 1000.0).abs() < 1e-12);
        assert!(
            (FeedRounding { per_minute: 0.5, ..FeedRounding::default() }.of(1000.0, f64::INFINITY) - 0.5).abs() < 1e-12
        );
    }
}

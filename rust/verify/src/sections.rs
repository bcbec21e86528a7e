//! The least of a function of one variable by golden sections.

const RATIO: f64 = 0.618_033_988_749_894_9;

/// The least value of a function and where that is: `known`, or lower between two places, which so many sections bring together.
pub(crate) fn least_between(
    mut known: (f64, f64),
    [mut low, mut high]: [f64; 2],
    sections: usize,
    function: impl Fn(f64) -> f64,
) -> (f64, f64) {
    for _ in 0..sections {
        let [p, q] = [high - RATIO * (high - low), low + RATIO * (high - low)];
        let [at_p, at_q] = [function(p), function(q)];
        known = [(at_p, p), (at_q, q)].into_iter().fold(known, |a, b| if b.0 < a.0 { b } else { a });
        if at_p < at_q {
            high = q;
        } else {
            low = p;
        }
    }
    known
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lowest_point_is_found_and_what_is_lower_already_stays() {
        let bowl = |x: f64| (x - 0.3) * (x - 0.3) + 2.0;
        let (value, at) = least_between((bowl(0.0), 0.0), [-1.0, 1.0], 40, bowl);
        assert!((value - 2.0).abs() < 1e-12 && (at - 0.3).abs() < 1e-6, "{value} {at}");
        let (value, at) = least_between((1.0, 5.0), [-1.0, 1.0], 40, bowl);
        assert!((value - 1.0).abs() < 1e-12 && (at - 5.0).abs() < 1e-12, "{value} {at}");
    }
}

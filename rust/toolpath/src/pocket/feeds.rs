//! Feeds along cuts: as high as what is cut allows.
//!
//! The removal rate is the depth of cut times the stepover times the feed. On a straight pass at the engagement angle `b` the stepover of a tool
//! of radius `r` is `r (1 - cos b)`: with the feed that is stated for it, that is the reference, and no feed is so high that the rate
//! exceeds it. With chip thinning the thickest chip, the feed per tooth times the sine of the angle between rim and side, is no thicker than there either
//! (Altintas, "Manufacturing Automation", 2nd ed., section 2.4: h = c sin(phi)). Derived in docs/concepts/pockets.md.

use std::f64::consts::PI;

use super::frame::CHIP;
use super::request::{PocketRun, Stepover};

/// Seconds in a minute.
const MINUTE: f64 = 60.0;
/// Feeds differ by this factor, or are the same.
const STEP: f64 = 1.05;
/// A feed lasts for this long at least, in tool radii: what allows a higher one on a shorter way is left out.
const SHORTEST: f64 = 0.5;
/// Angles above the bound by less are within it, rad: pieces are planned so (planner.rs).
const WITHIN: f64 = 0.35 * PI / 180.0;
/// Acceleration along the path of a machine that states none, mm/s^2.
const ACCELERATION: f64 = 500.0;

/// How feeds follow what is cut.
#[derive(Clone, Copy, Debug)]
pub struct FeedLaw {
    /// The feed at the largest engagement angle, mm/min.
    pub cut: f64,
    /// The highest feed, mm/min.
    pub highest: f64,
    /// The largest engagement angle, rad.
    pub angle: f64,
    /// The tool's radius, mm.
    pub radius: f64,
    /// By how much more the tool may engage than planned where arcs become chords, rad.
    pub spare: f64,
    /// Whether chips become no thicker than at the largest engagement angle.
    pub chip_thinning: bool,
    /// The machine's acceleration along the path, mm/s^2.
    pub acceleration: Option<f64>,
}

/// One feed up to a length of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Where it ends, mm from the run's start.
    pub end: f64,
    /// mm/min
    pub feed: f64,
}

impl FeedLaw {
    /// The stepover of a straight pass at an engagement angle, mm.
    fn width(&self, angle: f64) -> f64 {
        self.radius * (1.0 - libm::cos(angle))
    }

    /// Area cleared in a minute at the reference, mm^2.
    #[must_use]
    pub fn reference(&self) -> f64 {
        self.width(self.angle) * self.cut
    }

    /// How long a move from standstill to standstill takes, s.
    pub(super) fn seconds(&self, length: f64, feed: f64) -> f64 {
        let (speed, acceleration) = (feed / MINUTE, self.acceleration.unwrap_or(ACCELERATION));
        if length * acceleration < speed * speed {
            2.0 * (length / acceleration).sqrt()
        } else {
            length / speed + speed / acceleration
        }
    }

    /// The highest feed for a stepover, mm/min.
    fn allowed(&self, stepover: &Stepover) -> f64 {
        let engaged = libm::acos((1.0 - stepover.width / self.radius).clamp(-1.0, 1.0));
        let width = self.width((engaged + self.spare).min(PI)) + CHIP;
        let full = self.width(self.angle);
        let width = if width <= self.width(self.angle + WITHIN) + CHIP { width.min(full) } else { width };
        let by_rate = self.reference() / width;
        let by_chip = if self.chip_thinning && width < full {
            let chip = stepover.chip.max(libm::sin(libm::acos(1.0 - width / self.radius)));
            self.cut * libm::sin(self.angle) / chip
        } else {
            f64::INFINITY
        };
        by_rate.min(by_chip).min(self.highest)
    }

    /// The feeds along a run.
    pub fn stretches(&self, run: &PocketRun) -> Vec<Stretch> {
        let at: Vec<f64> = run.stepovers.iter().map(|stepover| stepover.travelled).collect();
        let allowed: Vec<f64> = run.stepovers.iter().map(|stepover| self.allowed(stepover)).collect();
        let Some(end) = at.last() else {
            return vec![Stretch { end: f64::INFINITY, feed: self.cut.min(self.highest) }];
        };
        let half = 0.5 * SHORTEST * self.radius;
        let lowest = within(&at, &allowed, half, f64::min);
        let opened = within(&at, &lowest, half, f64::max);
        let opened: Vec<f64> = opened.iter().zip(&allowed).map(|(a, b)| a.min(*b)).collect();
        let stepped = self.slowed(&at, opened).into_iter().map(|feed| self.stepped(feed)).collect::<Vec<_>>();
        let mut stretches: Vec<Stretch> = Vec::new();
        for (number, pair) in stepped.windows(2).enumerate() {
            let [a, b] = pair else { continue };
            let (feed, end) = (a.min(*b), at.get(number + 1).copied().unwrap_or(*end));
            match stretches.last_mut() {
                Some(last) if last.feed.total_cmp(&feed).is_eq() => last.end = end,
                _ => stretches.push(Stretch { end, feed }),
            }
        }
        merged(stretches, 2.0 * half)
    }

    /// Feeds between which the machine gets by its acceleration.
    fn slowed(&self, at: &[f64], mut feeds: Vec<f64>) -> Vec<f64> {
        let square = 2.0 * MINUTE * MINUTE * self.acceleration.unwrap_or(ACCELERATION);
        let reach = |feed: f64, length: f64| (feed * feed + square * length.abs()).sqrt();
        let mut limit = |before: usize, number: usize| {
            if let (Some(a), Some(b), Some(feed)) = (at.get(before), at.get(number), feeds.get(before).copied()) {
                let most = reach(feed, b - a);
                if let Some(feed) = feeds.get_mut(number) {
                    *feed = feed.min(most);
                }
            }
        };
        (1..at.len()).for_each(|number| limit(number - 1, number));
        (1..at.len()).rev().for_each(|number| limit(number, number - 1));
        feeds
    }

    /// The next lower feed that is posted: steps up and down from that of the reference.
    fn stepped(&self, feed: f64) -> f64 {
        if feed >= self.highest {
            return self.highest;
        }
        let steps = libm::floor(libm::log(feed / self.cut) / libm::log(STEP) + 1e-9);
        self.cut * libm::pow(STEP, steps)
    }
}

/// The lowest or highest of some values within a distance of each position.
fn within(at: &[f64], values: &[f64], distance: f64, chosen: fn(f64, f64) -> f64) -> Vec<f64> {
    let (mut first, mut last) = (0, 0);
    let value = |here: &f64| {
        while at.get(first).is_some_and(|other| *other < here - distance) {
            first += 1;
        }
        while at.get(last).is_some_and(|other| *other <= here + distance) {
            last += 1;
        }
        values.get(first..last).unwrap_or(&[]).iter().copied().reduce(chosen).unwrap_or(0.0)
    };
    at.iter().map(value).collect()
}

/// Stretches none of which is shorter than `shortest`, but where all are: the short take the lower feed of their neighbour with them.
fn merged(mut stretches: Vec<Stretch>, shortest: f64) -> Vec<Stretch> {
    while stretches.len() > 1 {
        let start = |i: usize| i.checked_sub(1).and_then(|i| stretches.get(i)).map_or(0.0, |before| before.end);
        let lengths = stretches.iter().enumerate().map(|(i, stretch)| (i, stretch.end - start(i)));
        let Some((number, _)) = lengths.filter(|(_, length)| *length < shortest).min_by(|a, b| a.1.total_cmp(&b.1))
        else {
            break;
        };
        let off = |i: Option<usize>| {
            let feeds = i.and_then(|i| stretches.get(i)).zip(stretches.get(number));
            feeds.map_or(f64::INFINITY, |(a, b)| libm::log(a.feed / b.feed).abs())
        };
        let first = if off(number.checked_sub(1)) < off(Some(number + 1)) { number - 1 } else { number };
        let Some(gone) = (first + 1 < stretches.len()).then(|| stretches.remove(first + 1)) else { break };
        if let Some(kept) = stretches.get_mut(first) {
            *kept = Stretch { end: gone.end, feed: kept.feed.min(gone.feed) };
        }
    }
    stretches.dedup_by(|next, kept| {
        let same = next.feed.total_cmp(&kept.feed).is_eq();
        if same {
            kept.end = next.end;
        }
        same
    });
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pocket::PocketRunKind;
    use std::f64::consts::FRAC_PI_3;

    const LAW: FeedLaw = FeedLaw {
        cut: 600.0,
        highest: 3000.0,
        angle: FRAC_PI_3,
        radius: 5.0,
        spare: 0.0,
        chip_thinning: false,
        acceleration: Some(500.0),
    };

    /// A run with an engagement angle at each of its tenths of a millimetre, rad.
    fn run(angles: &[f64]) -> PocketRun {
        let stepover = |(i, angle): (usize, &f64)| Stepover {
            travelled: 0.1 * i as f64,
            width: LAW.radius * (1.0 - libm::cos(*angle)),
            chip: libm::sin(angle.min(0.5 * PI)),
        };
        PocketRun {
            stepovers: angles.iter().enumerate().map(stepover).collect(),
            ..PocketRun::new(vec![[0.0; 3], [100.0, 0.0, 0.0]], PocketRunKind::Cut)
        }
    }

    fn only(law: &FeedLaw, angle: f64) -> f64 {
        let found = law.stretches(&run(&[angle; 200]));
        assert_eq!(found.len(), 1);
        found[0].feed
    }

    #[test]
    fn the_feed_of_a_full_stepover_is_the_reference_and_that_of_a_slot_a_quarter_of_it() {
        assert!((only(&LAW, FRAC_PI_3) - LAW.cut).abs() < 1e-9);
        // 1 - cos 60 = 0.5 of 2: a quarter, and at most a step below
        let slot = only(&LAW, PI);
        assert!(slot <= 150.0 && slot > 150.0 / STEP, "{slot}");
        // as much stock in a minute, and never more
        for degrees in [20.0_f64, 35.0, 50.0, 75.0, 90.0, 130.0] {
            let (cos, feed) = (libm::cos(degrees.to_radians()), only(&LAW, degrees.to_radians()));
            let share = feed * (1.0 - cos) / (600.0 * 0.5);
            assert!(share <= 1.0 && (share > 0.94 || feed >= 3000.0), "{degrees} {feed} {share}");
        }
    }

    #[test]
    fn chips_stay_as_thin_and_take_no_more_stock() {
        let law = FeedLaw { chip_thinning: true, ..LAW };
        for degrees in [20.0_f64, 35.0, 50.0] {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            let feed = only(&law, degrees.to_radians());
            let share = feed * sin / (600.0 * libm::sin(FRAC_PI_3));
            assert!(share <= 1.0 && share > 0.94 && feed * (1.0 - cos) < 300.0, "{degrees} {feed} {share}");
        }
        assert!((only(&law, FRAC_PI_3) - law.cut).abs() < 1e-9);
    }

    #[test]
    fn feeds_change_no_faster_than_the_machine_and_not_for_a_moment() {
        let mut angles = vec![FRAC_PI_3; 300];
        angles[140..146].fill(0.3); // 0.6 mm that would allow three times the feed
        let alike = LAW.stretches(&run(&angles));
        assert!(alike.len() == 1 && (alike[0].feed - 600.0).abs() + (alike[0].end - 29.9).abs() < 1e-9, "{alike:?}");
        angles[140..300].fill(0.3);
        let stretches = LAW.stretches(&run(&angles));
        let mut begin = 0.0;
        for pair in stretches.windows(2) {
            let [a, b] = pair else { continue };
            assert!(a.end - begin >= 0.5 * LAW.radius - 1e-9, "{stretches:?}");
            begin = a.end;
            // to the end of the next stretch the machine gets by its acceleration
            let reached = (a.feed * a.feed + 2.0 * 3600.0 * 500.0 * (b.end - a.end)).sqrt();
            assert!(b.feed <= reached && b.feed > a.feed, "{stretches:?}");
        }
        assert!(stretches.len() > 1);
    }

    #[test]
    fn without_a_higher_feed_only_what_is_over_the_bound_is_slower() {
        let law = FeedLaw { highest: 600.0, ..LAW };
        let mut angles = vec![0.2; 400];
        angles[200..260].fill(2.0);
        let stretches = law.stretches(&run(&angles));
        let feeds: Vec<f64> = stretches.iter().map(|stretch| stretch.feed).collect();
        assert!(feeds.len() == 3 && (feeds[0] - 600.0).abs() + (feeds[2] - 600.0).abs() < 1e-9, "{stretches:?}");
        assert!(feeds[1] <= 600.0 * 0.5 / (1.0 - libm::cos(2.0)) && feeds[1] > 190.0, "{stretches:?}");
    }
}

//! How far numbers may come back from where they were.

use crate::machine::Machine;

/// Feeds are compared with this slack over and above their rounding, as a share.
const FEED_SLACK: f64 = 1e-9;

/// How far the feed of a path so long, mm, may come back from the planned one, mm/min: numbers are rounded.
pub(super) fn feed_slack(machine: &Machine, feed: f64, length: f64, rpm: f64) -> f64 {
    let rounded = machine.feed_rounding(rpm).of(feed, length);
    rounded + FEED_SLACK * feed
}

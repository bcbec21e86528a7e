//! Two programs in step: the feeds with which each move of the one takes as long as the same move of the other.

use styluscam_geometry::Vector;
use styluscam_motion::{FeedMode, Move, MoveKind};
use styluscam_post::{machine::FeedMode as PostedFeed, Machine};

use crate::numbers::shown;
use crate::JobError;

/// By how much a feed may make up for what rounding cost the moves before, as a share of the move's time.
const MADE_UP: f64 = 0.5;

/// A move of the main tool, and where the other one goes meanwhile, in its own coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The main tool's move.
    pub main: Move,
    /// Where the other tool's ends, mm.
    pub below: Vector,
    /// Whether both tools touch all along: the main tool's feed is the one that was asked for.
    pub touches: bool,
}

/// The moves of both tools with their feeds.
///
/// A feed is rounded in the text, and so is the path's length; what that costs in time the next moves make up for, so that the
/// two do not drift apart.
///
/// # Errors
/// A feed beyond what the machine of the other tool allows.
pub fn timed(
    steps: &[Step],
    [machine, machine_below]: [&Machine; 2],
    path: &str,
) -> Result<(Vec<Move>, Vec<Move>), JobError> {
    let (mut main, mut below) = (Vec::with_capacity(steps.len()), Vec::with_capacity(steps.len()));
    let mut from: Option<[Vector; 2]> = None;
    let mut behind = 0.0; // how much later than the main tool the other one is, min
    for step in steps {
        let ends = [rounded(step.main.end.tip.into(), machine), rounded(step.below, machine_below)];
        let follow = |kind| Move { kind, arc: None, ..step.main.to(step.below.into()) };
        let Some([start, start_below]) = from.replace(ends).filter(|_| step.main.kind == MoveKind::Feed) else {
            main.push(step.main);
            below.push(follow(step.main.kind).with_feed(0.0, FeedMode::PerMinute));
            continue;
        };
        let posted_main = Move { arc: step.main.arc, ..step.main.to(ends[0].into()) };
        let (length, length_below) = (posted_main.length(start.into()), (ends[1] - start_below).norm());
        let longest = if step.touches { length } else { length.max(length_below) };
        let minutes = longest / step.main.feed;
        let feed = posted(length / minutes, machine);
        let taken = length / feed;
        let wanted = length_below / (taken - behind).clamp((1.0 - MADE_UP) * taken, (1.0 + MADE_UP) * taken);
        let feed_below = posted(wanted, machine_below);
        behind += length_below / feed_below - taken;
        if let Some(most) = machine_below.limits.max_feed.filter(|most| feed_below > *most) {
            return Err(too_fast(feed_below, most, path));
        }
        main.push(step.main.with_feed(if step.touches { step.main.feed } else { feed }, FeedMode::PerMinute));
        below.push(follow(MoveKind::Feed).with_feed(feed_below, FeedMode::PerMinute));
    }
    Ok((main, below))
}

/// A position as a text states it.
fn rounded(position: Vector, machine: &Machine) -> Vector {
    let unit = machine.resolution_mm();
    position.map(|x| (x / unit).round() * unit)
}

/// A feed as a text states it, not 0, mm/min; feeds in inverse time are made of it later.
fn posted(feed: f64, machine: &Machine) -> f64 {
    if machine.feed.mode != PostedFeed::PerMinute {
        return feed;
    }
    let unit = machine.feed_resolution_mm();
    (feed / unit).round().max(1.0) * unit
}

fn too_fast(feed: f64, most: f64, path: &str) -> JobError {
    let message = format!(
        "the tool below would have to go at {} mm/min to stay opposite the main one, and its machine goes at {} at most",
        shown(feed.round()),
        shown(most)
    );
    let hint = format!("lower feeds.cut to {:.2} of what it is, or less", most / feed);
    JobError::document("too-fast", format!("{path}.feeds.cut"), message, hint)
}

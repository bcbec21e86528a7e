//! Whether two programs stay together in time.

use styluscam_motion::{EventKind, Program};

use super::{is_rapid, Member, Pair};
use crate::faults::{self, Fault};
use crate::segments::Segment;

impl Pair<'_> {
    /// Moves by which the two programs are no longer together. Where both wait, they are again; and behind a move that is
    /// reported, so that the next one is seen too.
    ///
    /// How far they are apart is measured along the main tool's path: the gap between the tools changes by no more than that,
    /// so it may be as much as the gap may be off, and what rounding takes of a feed.
    pub(super) fn out_of_step(&self) -> Vec<Fault> {
        let [main, below] = &self.members;
        let waits = [main, below].map(|member| waits(member.program));
        let mut faults = Vec::new();
        let (mut late, mut rounding) = (0.0_f64, 0.0_f64); // min
        for index in 0..main.program.moves.len() {
            let Some((step, other)) = main.segments[index].as_ref().zip(below.segments[index].as_ref()) else {
                continue;
            };
            let fault = |kind| if self.reported == 0 { step } else { other }.fault(kind);
            let [waits, waits_below] = [&waits[0], &waits[1]].map(|waits| waits.contains(&index));
            if waits != waits_below {
                faults.push(fault(&faults::OTHER_WAIT));
            }
            let [rapid, rapid_below] = [main, below].map(|member| is_rapid(member.program, index));
            if rapid != rapid_below {
                faults.push(fault(&faults::OTHER_KIND));
            }
            if rapid || rapid_below || waits {
                (late, rounding) = (0.0, 0.0);
            }
            let Some((minutes, slack)) = time(main, step) else { continue };
            let Some((minutes_below, slack_below)) = time(below, other) else { continue };
            late += minutes_below - minutes;
            rounding = rounding.max(slack + slack_below);
            let speed = step.length() / minutes;
            let allowed = main.excess(step) + below.excess(other) + rounding * speed;
            let apart = late.abs() * speed;
            if apart > allowed {
                faults.push(fault(&faults::OUT_OF_STEP).measured(apart, allowed));
                (late, rounding) = (0.0, 0.0);
            }
        }
        faults
    }
}

/// How long a feed takes, and by how much of that its rounded number may be wrong, min; none of a rapid, and of a feed that is
/// not in mm/min.
fn time(member: &Member, segment: &Segment) -> Option<(f64, f64)> {
    let step = &member.program.moves[segment.index];
    let length = segment.length();
    let feed = step.mm_per_min(length, None).filter(|feed| *feed > 0.0 && length > 0.0)?;
    let minutes = length / feed;
    Some((minutes, minutes * member.limits.feed_slack(feed, length) / feed))
}

/// The moves before which a program waits.
fn waits(program: &Program) -> Vec<usize> {
    let waits = program.events.iter().filter(|event| {
        matches!(event.kind, EventKind::Sync { .. } | EventKind::Stop { optional: false } | EventKind::Raw { .. })
    });
    waits.map(|event| event.before).filter(|before| (1..program.moves.len()).contains(before)).collect()
}

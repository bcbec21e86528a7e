//! Progress and cancel: a flag and a figure that long work and the one who waits for it share.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

/// Shared between the thread that works and the one that waits. Work polls it; it costs a few nanoseconds.
#[derive(Debug, Default)]
pub struct Watch {
    cancelled: Arc<AtomicBool>,
    done: AtomicU64,
    total: AtomicU64,
    phase: Mutex<&'static str>,
}

/// The work was stopped from outside. Nothing is wrong; there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

impl Watch {
    /// Begins a phase of `total` steps.
    pub fn begin(&self, phase: &'static str, total: usize) {
        // held to the end: no one reads the new phase with the last one's share
        let current = self.phase.lock();
        self.done.store(0, Ordering::Relaxed);
        self.total.store(total as u64, Ordering::Relaxed);
        if let Ok(mut current) = current {
            *current = phase;
        }
    }

    /// A watch for work that is done at the same time: cancelled with this one, its phases are nobody's.
    #[must_use]
    pub fn beside(&self) -> Self {
        Self { cancelled: Arc::clone(&self.cancelled), ..Self::default() }
    }

    /// Counts `steps` more as done.
    ///
    /// # Errors
    /// `Cancelled` when somebody asked to stop: give up at once.
    pub fn advance(&self, steps: usize) -> Result<(), Cancelled> {
        self.done.fetch_add(steps as u64, Ordering::Relaxed);
        if self.is_cancelled() {
            Err(Cancelled)
        } else {
            Ok(())
        }
    }

    /// Whether somebody asked to stop: for work that leaves off first and reports it later.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// The numbers from 0 to `count`, `size` at a time: no more of them once somebody asked to stop.
    pub fn batches(&self, count: usize, size: usize) -> impl Iterator<Item = Range<usize>> + '_ {
        let starts = (0..count).step_by(size.max(1));
        starts.map(move |start| start..count.min(start + size.max(1))).take_while(|_| !self.is_cancelled())
    }

    /// Asks the work to stop; it does within a fraction of a second.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// The phase and the share of it that is done, 0 to 1.
    #[must_use]
    pub fn state(&self) -> (&'static str, f64) {
        let phase = self.phase.lock();
        let total = self.total.load(Ordering::Relaxed).max(1);
        let share = (self.done.load(Ordering::Relaxed) as f64 / total as f64).min(1.0);
        (phase.map_or("", |phase| *phase), share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_cover_the_numbers_once_until_cancelled() {
        let watch = Watch::default();
        assert_eq!(watch.batches(7, 3).collect::<Vec<_>>(), [0..3, 3..6, 6..7]);
        assert_eq!(watch.batches(0, 3).count(), 0);
        let mut batches = watch.batches(7, 3);
        assert_eq!(batches.next(), Some(0..3));
        watch.cancel();
        assert_eq!(batches.next(), None);
    }

    #[test]
    fn the_share_is_of_the_phase_and_never_more_than_all() {
        let watch = Watch::default();
        assert_eq!(watch.state(), ("", 0.0));
        watch.begin("linking", 4);
        watch.advance(1).unwrap();
        assert_eq!(watch.state(), ("linking", 0.25));
        watch.advance(9).unwrap();
        assert_eq!(watch.state(), ("linking", 1.0));
        watch.begin("measuring", 2);
        assert_eq!(watch.state(), ("measuring", 0.0));
    }

    #[test]
    fn a_watch_beside_is_cancelled_with_the_first_and_has_phases_of_its_own() {
        let watch = Watch::default();
        watch.begin("rows", 2);
        let beside = watch.beside();
        beside.begin("bridging", 3);
        assert_eq!((watch.state().0, beside.state().0, beside.is_cancelled()), ("rows", "bridging", false));
        watch.cancel();
        assert_eq!(beside.advance(1), Err(Cancelled));
    }

    #[test]
    fn a_cancelled_watch_stops_the_next_step() {
        let watch = Watch::default();
        assert!(!watch.is_cancelled());
        watch.cancel();
        assert_eq!((watch.is_cancelled(), watch.advance(1)), (true, Err(Cancelled)));
    }
}

//! Where one row ends and the next begins, in the moves of a text: it has no word for that.

use crate::contact_lines;
use crate::expectation::Expectation;
use crate::scalar::Scalar;
use crate::segments::Segment;

/// The row that the moves are on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Row(Option<On>);

#[derive(Clone, Copy, Debug)]
struct On {
    /// Which set of rows it is of.
    set: usize,
    /// Its position across.
    value: f64,
    /// Whether it is followed in the direction of its set.
    forward: bool,
}

impl Row {
    /// Goes on with a move; whether a row ends before it, or begins with it: one more, or the same one backwards. What goes straight
    /// up or down changes nothing.
    pub fn changes(&mut self, expectation: &Expectation, segment: &Segment) -> bool {
        if !segment.travels() {
            return false;
        }
        let Some((on, same)) = on(expectation, segment) else { return self.0.take().is_some() };
        let goes_on = |before: On| {
            before.set == on.set && before.forward == on.forward && (before.value - on.value).abs() <= same
        };
        let changes = !self.0.is_some_and(goes_on);
        // by the value at its start: what differs by less than is seen from move to move adds up
        if changes {
            self.0 = Some(on);
        }
        changes
    }
}

/// The row that a move is along, and what positions across may differ on one, mm; none of moves that go across.
fn on(expectation: &Expectation, segment: &Segment) -> Option<(On, f64)> {
    let start = segment.start?;
    let mut sets = expectation.sets().iter().enumerate();
    let (set, passes) = sets.find(|(_, passes)| contact_lines::holds(&*passes.scalar, segment))?;
    let scalar: &dyn Scalar = &*passes.scalar;
    let across = scalar.gradient(start.into());
    let [x, y] = [0, 1].map(|axis| segment.end[axis] - start[axis]);
    let forward = x * across.y - y * across.x > 0.0;
    Some((On { set, value: scalar.value(segment.end.into()), forward }, scalar.same()))
}

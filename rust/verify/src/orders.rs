//! What the job orders for each operation, held against the text: feeds, spindle, coolant, tool, and that none is missing.

use styluscam_motion::{EventKind, Program, SpindleDirection};

use crate::findings::{Fault, Finding};
use crate::legs::{Leg, LegKind};
use crate::passes::Passes;
use crate::{FindingKind, Limits, Severity, Subject};

/// What the job orders for an operation.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The operation's id, as the text's remarks name it.
    pub id: String,
    /// Index of its tool.
    pub tool: usize,
    /// Feed along the path, mm/min.
    pub cut: f64,
    /// Feed straight down, mm/min.
    pub plunge: f64,
    /// Speed and sense of the spindle; it stands when there are none.
    pub spindle: Option<(f64, SpindleDirection)>,
    /// Whether coolant flows.
    pub flood: bool,
    /// How its passes lie; none where that is not to be judged.
    pub passes: Option<Passes>,
    /// Whether it forms a sheet, level by level downwards.
    pub forms: bool,
}

/// Feeds that differ by less than this share are the same: what arithmetic may cost, as units change.
const SAME_FEED: f64 = 1e-6;

/// Orders for the operations of a program's text.
pub(crate) struct Orders<'a> {
    /// For each of the program's operations its order, where the job has one.
    of: Vec<Option<&'a Order>>,
}

impl<'a> Orders<'a> {
    /// By their ids; a job with one operation means it, whatever the text calls it. A text that names none of several means
    /// them all, when it loads their tools in their order.
    pub fn new(program: &Program, subject: &Subject<'a>) -> Self {
        let orders = subject.orders;
        let order = |id: &str| orders.iter().find(|order| order.id == id);
        let of: Vec<Option<&Order>> = program.operations.iter().map(|operation| order(&operation.id)).collect();
        let tools = || program.operations.iter().map(|operation| operation.tool as usize);
        let named = of.iter().any(Option::is_some);
        match orders {
            [only] => Self { of: vec![Some(only); of.len()] },
            _ if !named && tools().eq(orders.iter().map(|order| order.tool)) => {
                Self { of: orders.iter().map(Some).collect() }
            }
            _ => Self { of },
        }
    }

    /// The finding of operations that come in another order than the job's.
    pub fn out_of_order(&self, program: &Program, subject: &Subject) -> Option<Finding> {
        let place = |order: &&Order| subject.orders.iter().position(|other| std::ptr::eq(other, *order));
        let known = self.of.iter().enumerate().filter_map(|(i, order)| Some((i, place(&(*order)?)?)));
        let known: Vec<(usize, usize)> = known.collect();
        let pair = known.windows(2).find(|pair| pair[1].1 < pair[0].1)?;
        let [before, id] = [pair[0], pair[1]].map(|(_, order)| &subject.orders[order].id);
        let first = program.moves.iter().find(|step| step.operation as usize == pair[1].0);
        let line = first.map_or(0, |step| step.line);
        let message = format!(
            "line {line}: operation {id:?} comes after {before:?}, and in the job before it; post the job again"
        );
        Some(Finding::of_all(FindingKind::OperationOrder, Severity::Error, message).at_line(line))
    }

    /// The finding of a text of which nothing can be held against what the job orders.
    pub fn unnamed(&self, subject: &Subject) -> Option<Finding> {
        let known = subject.orders.is_empty() || self.of.is_empty() || self.of.iter().any(Option::is_some);
        let message = format!(
            "the text names none of the job's {} operations, and does not load their tools in their order: it cannot be \
             held against what they order; post the job again, with its remarks",
            subject.orders.len()
        );
        (!known).then(|| Finding::of_all(FindingKind::UnnamedOperations, Severity::Error, message))
    }

    /// The order that a leg carries out.
    pub fn of(&self, leg: &Leg) -> Option<&'a Order> {
        self.of.get(leg.operation as usize).copied().flatten()
    }

    /// Whether a leg carries out this order.
    pub fn own(&self, order: &Order, leg: &Leg) -> bool {
        self.of(leg).is_some_and(|of| std::ptr::eq(of, order))
    }

    /// Faults of the moves, in their order.
    pub fn faults(&self, program: &Program, legs: &[Leg], limits: &Limits) -> Vec<Fault> {
        let mut upcoming = program.upcoming();
        let mut machine = Machine { spindle: None, flood: false, mist: false };
        let mut faults = Vec::new();
        let mut last: Option<LegKind> = None;
        for leg in legs {
            upcoming.before(leg.index).for_each(|event| machine.take(event));
            let before = last.replace(leg.kind);
            if leg.kind == LegKind::Rapid {
                continue;
            }
            let comes_down = before.is_none_or(|kind| kind == LegKind::Rapid);
            let step = &program.moves[leg.index];
            let Some(order) = self.of(leg) else { continue };
            faults.extend(feed_fault(order, leg, comes_down, step.feed, limits.feed_unit));
            faults.extend(spindle_fault(order, leg, machine.spindle));
            if machine.flood != order.flood || machine.mist {
                faults.push(leg.fault(FindingKind::CoolantDiffers));
            }
            if leg.tool.is_some_and(|tool| tool != order.tool) {
                faults.push(leg.fault(FindingKind::ToolDiffers));
            }
        }
        faults
    }
}

/// From a rapid the tool comes down at the plunge's feed; on its way along the part straight down is as good as any
/// other direction.
fn feed_fault(order: &Order, leg: &Leg, comes_down: bool, feed: f64, unit: f64) -> Option<Fault> {
    let ordered = match leg.kind {
        LegKind::Plunge if comes_down => order.plunge,
        // a feed that goes nowhere or up is no faster than any other
        LegKind::Still | LegKind::Retract => feed.min(order.cut.max(order.plunge)),
        _ => order.cut,
    };
    let same = (feed - ordered).abs() <= unit + SAME_FEED * ordered;
    (feed > 0.0 && !same).then(|| leg.fault(FindingKind::FeedDiffers).measured(feed, ordered))
}

/// The findings of orders that the text does not carry out, when it carries out any by name.
pub(crate) fn missing(program: &Program, subject: &Subject) -> Vec<Finding> {
    let named = |order: &&Order| program.operations.iter().any(|operation| operation.id == order.id);
    if !subject.orders.iter().any(|order| named(&order)) {
        return Vec::new();
    }
    let left = subject.orders.iter().filter(|order| !named(order));
    let message = |order: &Order| format!("the text has no operation {:?} of the job; post the whole job", order.id);
    left.map(|order| Finding::of_all(FindingKind::MissingOperation, Severity::Error, message(order))).collect()
}

fn spindle_fault(order: &Order, leg: &Leg, turns: Option<(f64, SpindleDirection)>) -> Option<Fault> {
    let (found, ordered) = (signed(turns), signed(order.spindle));
    let same = (found - ordered).abs() <= 0.5 + SAME_FEED * ordered.abs();
    (!same).then(|| leg.fault(FindingKind::SpindleDiffers).measured(found, ordered))
}

/// Speed, negative counterclockwise, 0 when it stands.
fn signed(turns: Option<(f64, SpindleDirection)>) -> f64 {
    match turns {
        Some((rpm, SpindleDirection::Clockwise)) => rpm,
        Some((rpm, SpindleDirection::Counterclockwise)) => -rpm,
        None => 0.0,
    }
}

/// The states of the machine that events switch.
struct Machine {
    spindle: Option<(f64, SpindleDirection)>,
    flood: bool,
    mist: bool,
}

impl Machine {
    fn take(&mut self, event: &EventKind) {
        match *event {
            EventKind::SpindleOn { rpm, direction } => self.spindle = Some((rpm, direction)),
            EventKind::SpindleOff => self.spindle = None,
            EventKind::Flood { on } => self.flood = on,
            EventKind::Mist { on } => self.mist = on,
            _ => {}
        }
    }
}

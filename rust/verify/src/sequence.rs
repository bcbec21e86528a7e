//! The order in which a sheet is formed: no level after a lower one at the same place, or the sheet is stretched twice.

use std::collections::HashMap;

use styluscam_motion::Program;

use crate::contact_lines::SAME_LEVEL;
use crate::findings::Fault;
use crate::legs::{Leg, LegKind};
use crate::orders::Orders;
use crate::passes::{Spacing, ROUGH, WIDE};
use crate::{FindingKind, Limits, Subject};

/// A level counts as lower from this share of the step on.
const LOWER: f64 = 0.25;

/// Moves that go deeper than a step below all that is formed before them: there the sheet stands as it was.
///
/// Where an operation begins, the sheet is taken to stand at its highest level. A fall at the path's own feed is a part of
/// a pass over a wall, and worth a warning.
pub(crate) fn punches(program: &Program, legs: &[Leg], orders: &Orders, limits: &Limits) -> Vec<Fault> {
    let Some(forming) = limits.forming else { return Vec::new() };
    let levels = |leg: &Leg| {
        let order = orders.of(leg).filter(|order| order.forms)?;
        match order.passes.as_ref()?.spacing {
            Spacing::Levels(step) => Some((order, step)),
            Spacing::Rows(..) => None,
        }
    };
    let mut highest: HashMap<u32, f64> = HashMap::new();
    for leg in legs.iter().filter(|leg| leg.kind == LegKind::Contact && !leg.falls()) {
        let known = highest.entry(leg.operation).or_insert(f64::NEG_INFINITY);
        *known = known.max(leg.end[2]);
    }
    let mut formed = forming.top;
    let mut faults = Vec::new();
    for leg in legs {
        let (Some((order, step)), Some(begins)) = (levels(leg), highest.get(&leg.operation)) else { continue };
        formed = formed.min(*begins);
        let lowest = leg.lowest();
        if lowest < formed - WIDE * step - ROUGH {
            let fault = leg.fault(FindingKind::Punch).measured(lowest, formed);
            let falls = leg.kind == LegKind::Plunge && at_cut(program, leg, order.cut, limits);
            faults.push(if falls { fault.warning() } else { fault });
        }
        if leg.kind != LegKind::Rapid {
            formed = formed.min(lowest);
        }
    }
    faults
}

/// Faults in the order of the moves.
pub(crate) fn faults(
    program: &Program,
    legs: &[Leg],
    orders: &Orders,
    subject: &Subject,
    limits: &Limits,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    for order in subject.orders.iter().filter(|order| order.forms) {
        let Some(Spacing::Levels(step)) = order.passes.as_ref().map(|passes| passes.spacing) else { continue };
        let Some(tool) = subject.tools.get(order.tool) else { continue };
        let cell = 0.5 * tool.diameter();
        let mut lowest: HashMap<[i64; 2], f64> = HashMap::new();
        // straight up or down at the path's feed the tool climbs over what stands there, or falls beside it, and comes
        // back: that is no level
        let mut away_from: Option<f64> = None;
        for leg in legs.iter().flat_map(Leg::pieces) {
            let along =
                at_cut(program, &leg, order.cut, limits) && matches!(leg.kind, LegKind::Plunge | LegKind::Retract);
            match (leg.kind, away_from, leg.start) {
                (LegKind::Rapid, ..) => away_from = None,
                (_, Some(level), _) if (leg.end[2] - level).abs() <= SAME_LEVEL => away_from = None,
                (_, None, Some(start)) if along => away_from = Some(start[2]),
                _ => {}
            }
            if leg.kind != LegKind::Contact || leg.falls() || away_from.is_some() || !orders.own(order, &leg) {
                continue;
            }
            let [x, y, z] = leg.end;
            let [i, j] = [x, y].map(|at| (at / cell).floor() as i64);
            let around = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
            let formed = around.filter_map(|place| lowest.get(&place)).copied().fold(f64::INFINITY, f64::min);
            if z > formed + LOWER * step {
                faults.push(leg.fault(FindingKind::FormingOrder).measured(z, formed).warning());
            }
            let here = lowest.entry([i, j]).or_insert(z);
            *here = here.min(z);
        }
    }
    faults.sort_by_key(|fault| fault.index);
    faults
}

/// Whether a move has the feed of the path.
fn at_cut(program: &Program, leg: &Leg, cut: f64, limits: &Limits) -> bool {
    (program.moves[leg.index].feed - cut).abs() <= limits.feed_unit
}

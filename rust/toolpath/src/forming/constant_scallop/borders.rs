//! Where the selected faces end between the nodes of a lattice.

use std::collections::BTreeMap;

use super::distances::reached;
use super::net::Net;
use super::stations::Station;
use crate::Surface;

/// Halvings of a cell's side: a thousandth of a cell is less than what passes are off.
const HALVINGS: usize = 12;

/// The nodes beside the border, each with its distance where that of the border is `at`, in passes.
pub fn beside(net: &Net, surface: &Surface<'_>, at: f64) -> Vec<(usize, f64)> {
    let mut found: BTreeMap<[usize; 2], Option<Station>> = BTreeMap::new();
    let mut crossing = |inside: usize, outside: usize| {
        *found.entry([inside, outside]).or_insert_with(|| last_before(net, surface, inside, outside))
    };
    let mut sources = Vec::new();
    for cell in net.lattice.cells().iter() {
        let corners = net.lattice.corner_numbers(cell);
        let is_inside = corners.map(|node| net.stations[node].is_some());
        if is_inside.iter().all(|inside| *inside == is_inside[0]) {
            continue;
        }
        let crossings: Vec<Station> = (0..4)
            .filter_map(|i| {
                let j = (i + 1) % 4;
                match [is_inside[i], is_inside[j]] {
                    [true, false] => crossing(corners[i], corners[j]),
                    [false, true] => crossing(corners[j], corners[i]),
                    [true, true] | [false, false] => None,
                }
            })
            .collect();
        for node in corners {
            let Some(station) = net.stations[node] else { continue };
            for (number, first) in crossings.iter().enumerate() {
                let others = crossings
                    .iter()
                    .skip(number)
                    .map(|second| reached(&net.spacing, &station, [(first, at), (second, at)]));
                sources.push((node, others.fold(f64::INFINITY, f64::min)));
            }
        }
    }
    sources
}

/// The last selected position on the way from a node with a station to one without.
fn last_before(net: &Net, surface: &Surface<'_>, inside: usize, outside: usize) -> Option<Station> {
    let [from, to] = [inside, outside].map(|node| net.position(node));
    let mut last = net.stations[inside]?;
    let (mut low, mut high) = (0.0, 1.0);
    let mut hint = None;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let [x, y] = [0, 1].map(|i| from[i] + middle * (to[i] - from[i]));
        let contact = surface.envelope().contact_near(x, y, &mut hint);
        match contact.and_then(|contact| Station::of(surface, [x, y], &contact)) {
            Some(station) => (low, last) = (middle, station),
            None => high = middle,
        }
    }
    Some(last)
}

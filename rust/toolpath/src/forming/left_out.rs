//! Regions that the tool can touch, but between two levels only: short walls over a slope, steep rims.

use std::collections::{BTreeMap, HashSet};

use styluscam_motion::{Cancelled, Watch};

use super::{stances::stances_of, walls};
use crate::{Pass, Surface};

/// What is touched over less than this, mm, needs no level.
const LEAST: f64 = 0.02;
/// The region of a triangle that was not asked for.
const NONE: u32 = u32::MAX;

/// Lowest and highest tip with which the tool touches each connected region of what was selected that no pass touches, mm.
///
/// Walls are looked at in places `spacing` mm apart, slopes at the corners of their facets. A region that some pass touches
/// has its levels, a step apart.
///
/// # Errors
/// `Cancelled` when `watch` says so.
pub fn left_out(
    surface: &Surface<'_>,
    passes: &[Pass],
    spacing: f64,
    watch: &Watch,
) -> Result<Vec<(f64, f64)>, Cancelled> {
    let mesh = surface.envelope().mesh();
    let regions = regions(surface);
    let region = |triangle: usize| regions[triangle];
    let points = passes.iter().flat_map(|pass| &pass.points).filter(|point| point.selected);
    let touched: HashSet<u32> = points.map(|point| region(point.triangle as usize)).collect();
    let (upright, sloping): (Vec<usize>, Vec<usize>) =
        surface.triangles().filter(|t| !touched.contains(&region(*t))).partition(|t| mesh.is_upright(*t));

    let mut tips: Vec<(u32, (f64, f64))> = walls::touched(surface, &upright, spacing, watch)?
        .into_iter()
        .map(|touched| (region(touched.triangle), touched.tips))
        .collect();
    let stances = stances_of(surface, &sloping);
    let places: Vec<[f64; 2]> = stances.iter().flat_map(|(_, stands)| stands.map(|at| [at.x, at.y])).collect();
    watch.begin("slopes", places.len());
    let contacts = surface.envelope().contacts(&places, watch)?;
    let triangles = stances.iter().flat_map(|(triangle, _)| [*triangle; 3]);
    for (triangle, (place, contact)) in triangles.zip(places.iter().zip(&contacts)) {
        let point = contact.as_ref().map(|contact| surface.path_point(place[0], place[1], contact));
        let is_own = |touched: u32| region(touched as usize) == region(triangle);
        if let Some(point) = point.filter(|point| point.selected && is_own(point.triangle)) {
            tips.push((region(triangle), (point.tip.z, point.tip.z)));
        }
    }

    let mut by_region: BTreeMap<u32, (f64, f64)> = BTreeMap::new();
    for (region, (low, high)) in tips {
        let known = by_region.entry(region).or_insert((low, high));
        *known = (known.0.min(low), known.1.max(high));
    }
    Ok(by_region.into_values().filter(|(low, high)| high - low >= LEAST).collect())
}

/// The connected region of each triangle of the mesh, as its first triangle's number; [`NONE`] where it was not selected.
fn regions(surface: &Surface<'_>) -> Vec<u32> {
    let envelope = surface.envelope();
    let mut is_open = vec![false; envelope.mesh().triangles().len()];
    surface.triangles().for_each(|triangle| is_open[triangle] = true);
    let mut regions = vec![NONE; is_open.len()];
    for first in surface.triangles() {
        let mut open = if std::mem::take(&mut is_open[first]) { vec![first as u32] } else { Vec::new() };
        while let Some(triangle) = open.pop() {
            regions[triangle as usize] = first as u32;
            let beside = envelope.neighbours(triangle);
            open.extend(beside.into_iter().filter(|t| is_open.get_mut(*t as usize).is_some_and(std::mem::take)));
        }
    }
    regions
}

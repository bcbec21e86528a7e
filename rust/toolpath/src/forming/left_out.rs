//! Regions that the tool can touch, but between two levels only: short walls over a slope, steep rims.

use std::collections::{BTreeMap, HashSet};

use styluscam_motion::{Cancelled, Watch};

use super::{stances::stances_of, walls};
use crate::{Pass, Surface};

/// What is touched over less than this, mm, needs no level.
const LEAST: f64 = 0.02;
/// The region of a triangle that was not asked for.
const NONE: u32 = u32::MAX;

/// Bands of heights, lowest and highest tip in mm, in which the tool touches a connected region of what was selected that
/// no pass touches.
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
    for ((triangle, _), (places, contacts)) in stances.iter().zip(places.chunks(3).zip(contacts.chunks(3))) {
        let own = places.iter().zip(contacts).filter_map(|(place, contact)| {
            let point = surface.path_point(place[0], place[1], contact.as_ref()?);
            (point.selected && region(point.triangle as usize) == region(*triangle)).then_some(point.tip.z)
        });
        tips.extend(own.map(|tip| (tip, tip)).reduce(joined).map(|range| (region(*triangle), range)));
    }

    let mut by_region: BTreeMap<u32, Vec<(f64, f64)>> = BTreeMap::new();
    for (region, range) in tips {
        by_region.entry(region).or_default().push(range);
    }
    Ok(by_region.into_values().flat_map(bands).filter(|(low, high)| high - low >= LEAST).collect())
}

/// The range over two others.
fn joined(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// Ranges joined where they overlap, from the lowest up.
fn bands(mut ranges: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    ranges.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut bands: Vec<(f64, f64)> = Vec::new();
    for range in ranges {
        match bands.last_mut() {
            Some(last) if range.0 <= last.1 + LEAST => *last = joined(*last, range),
            _ => bands.push(range),
        }
    }
    bands
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

#[cfg(test)]
mod tests {
    use super::bands;

    #[test]
    fn ranges_that_overlap_are_one_band() {
        let ranges = vec![(9.0, 9.2), (5.0, 5.2), (5.1, 5.4), (5.41, 5.5), (5.3, 5.35)];
        assert_eq!(bands(ranges), [(5.0, 5.5), (9.0, 9.2)]);
        assert!(bands(Vec::new()).is_empty());
    }
}

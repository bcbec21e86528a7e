//! Faces that the tool can touch, but between two levels only: short walls over a slope, steep rims.

use std::collections::{BTreeMap, HashSet};

use styluscam_motion::{Cancelled, Watch};

use super::{stances::stances_of, walls};
use crate::{Pass, Surface};

/// What is touched over less than this, mm, needs no level.
const LEAST: f64 = 0.02;

/// Lowest and highest tip with which the tool touches each selected face that no pass touches, mm.
///
/// Walls are looked at in places `spacing` mm apart, slopes at the corners of their facets.
///
/// # Errors
/// `Cancelled` when `watch` says so.
pub fn left_out(
    surface: &Surface<'_>,
    passes: &[Pass],
    spacing: f64,
    watch: &Watch,
) -> Result<Vec<(f64, f64)>, Cancelled> {
    let (envelope, mesh) = (surface.envelope(), surface.envelope().mesh());
    let face = |triangle: usize| mesh.faces()[triangle];
    let points = passes.iter().flat_map(|pass| &pass.points).filter(|point| point.selected);
    let touched: HashSet<u32> = points.map(|point| face(point.triangle as usize)).collect();
    let (upright, sloping): (Vec<usize>, Vec<usize>) =
        surface.triangles().filter(|t| !touched.contains(&face(*t))).partition(|t| mesh.is_upright(*t));

    let mut tips: Vec<(u32, (f64, f64))> = walls::touched(surface, &upright, spacing, watch)?
        .into_iter()
        .map(|touched| (face(touched.triangle), touched.tips))
        .collect();
    let stances = stances_of(surface, &sloping);
    let places: Vec<[f64; 2]> = stances.iter().flat_map(|(_, stands)| stands.map(|at| [at.x, at.y])).collect();
    watch.begin("slopes", places.len());
    let contacts = envelope.contacts(&places, watch)?;
    for ((triangle, _), (places, contacts)) in stances.iter().zip(places.chunks(3).zip(contacts.chunks(3))) {
        for (place, contact) in places.iter().zip(contacts) {
            let point = contact.as_ref().map(|contact| surface.path_point(place[0], place[1], contact));
            if let Some(point) =
                point.filter(|point| point.selected && face(point.triangle as usize) == face(*triangle))
            {
                tips.push((face(*triangle), (point.tip.z, point.tip.z)));
            }
        }
    }

    let mut by_face: BTreeMap<u32, (f64, f64)> = BTreeMap::new();
    for (face, (low, high)) in tips {
        let known = by_face.entry(face).or_insert((low, high));
        *known = (known.0.min(low), known.1.max(high));
    }
    Ok(by_face.into_values().filter(|(low, high)| high - low >= LEAST).collect())
}

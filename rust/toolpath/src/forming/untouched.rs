//! Connected regions of what was selected that no pass touches, and whether the tool can touch them.

use std::collections::HashSet;

use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use crate::{Pass, Surface};

/// The region of a triangle that was not asked for.
const NONE: u32 = u32::MAX;

/// The selected triangles in connected regions of which no pass touches any.
pub(super) struct Untouched<'a> {
    surface: &'a Surface<'a>,
    /// The connected region of each triangle of the mesh, as its first triangle's number.
    regions: Vec<u32>,
    /// The regions that passes touch.
    touched: HashSet<u32>,
}

impl<'a> Untouched<'a> {
    pub fn by<'p>(passes: impl IntoIterator<Item = &'p Pass>, surface: &'a Surface<'a>) -> Self {
        let regions = regions(surface);
        let points = passes.into_iter().flat_map(|pass| &pass.points).filter(|point| point.selected);
        let touched = points.map(|point| regions[point.triangle as usize]).collect();
        Self { surface, regions, touched }
    }

    pub fn surface(&self) -> &'a Surface<'a> {
        self.surface
    }

    /// The triangles of all these regions.
    pub fn triangles(&self) -> impl Iterator<Item = usize> + '_ {
        self.surface.triangles().filter(|triangle| self.is_open(*triangle))
    }

    /// The region of a triangle, as the number of one of its triangles.
    pub fn region(&self, triangle: usize) -> u32 {
        self.regions[triangle]
    }

    /// Whether a selected triangle lies in one of these regions.
    pub fn is_open(&self, triangle: usize) -> bool {
        !self.touched.contains(&self.regions[triangle])
    }

    /// For each triangle with a position of the tip in plan, mm: how high the tip is there, if the tool touches the triangle's
    /// region.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn tips(&self, asked: &[(usize, [f64; 2])], watch: &Watch) -> Result<Vec<Option<f64>>, Cancelled> {
        let positions: Vec<[f64; 2]> = asked.iter().map(|(_, position)| *position).collect();
        let contacts = self.surface.envelope().contacts(&positions, watch)?;
        let tips = asked.iter().zip(contacts).map(|((triangle, position), contact)| {
            let contact = contact?;
            let touched = self.surface.envelope().touched(&contact);
            let is_own = touched.iter().any(|t| self.region(*t as usize) == self.region(*triangle));
            (is_own && self.surface.path_point(position[0], position[1], &contact).selected).then_some(contact.tip)
        });
        Ok(tips.collect())
    }
}

/// Ranges joined where they overlap or lie no farther apart than `apart`, from the lowest up.
pub(super) fn bands(mut ranges: Vec<(f64, f64)>, apart: f64) -> Vec<(f64, f64)> {
    ranges.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut bands: Vec<(f64, f64)> = Vec::new();
    for range in ranges {
        match bands.last_mut() {
            Some(last) if range.0 <= last.1 + apart => last.1 = last.1.max(range.1),
            _ => bands.push(range),
        }
    }
    bands
}

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

/// A position in plan.
pub(super) fn in_plan(tip: Vector) -> [f64; 2] {
    [tip.x, tip.y]
}

#[cfg(test)]
mod tests {
    use super::bands;

    #[test]
    fn ranges_that_overlap_are_one_band() {
        let ranges = vec![(9.0, 9.2), (5.0, 5.2), (5.1, 5.4), (5.41, 5.5), (5.3, 5.35)];
        assert_eq!(bands(ranges, 0.02), [(5.0, 5.5), (9.0, 9.2)]);
        assert!(bands(Vec::new(), 0.02).is_empty());
    }
}

//! Between which heights the tool touches what was selected.
//!
//! A grid meets steep regions by chance only: there a step aside is far down. But a facet's corners say where the
//! tool must stand to touch them, and there the envelope is asked.

use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use super::{stances::stances, walls, Grid};
use crate::Surface;

/// Halvings of an edge between a corner that is touched and one that is not: a thousandth of a millimetre on 1 m.
const HALVINGS: usize = 20;

/// Lowest and highest tip with which the tool touches what was selected, mm, `fine` mm or less from the extremes; none
/// where it touches nothing of it.
///
/// # Errors
/// `Cancelled` when `watch` is cancelled.
pub fn selected_range(
    surface: &Surface<'_>,
    grid: &Grid,
    fine: f64,
    watch: &Watch,
) -> Result<Option<(f64, f64)>, Cancelled> {
    let seen = [grid.selected_range(surface), walls::range(surface, grid.spacing(), watch)?];
    let both = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
    let Some((lowest, highest)) = seen.into_iter().flatten().reduce(both) else { return Ok(None) };
    let facets = stances(surface);
    let search = Search { surface, facets: &facets, fine };
    let lowest = search.farthest(lowest, Direction::Down, watch)?;
    let highest = search.farthest(highest, Direction::Up, watch)?;
    Ok(Some((lowest, highest)))
}

#[derive(Clone, Copy)]
enum Direction {
    Down,
    Up,
}

impl Direction {
    /// Whether a height lies farther on than another by more than `fine`.
    fn passes(self, z: f64, other: f64, fine: f64) -> bool {
        match self {
            Self::Down => z < other - fine,
            Self::Up => z > other + fine,
        }
    }
}

/// A search among stances.
struct Search<'a> {
    surface: &'a Surface<'a>,
    /// Facet by facet.
    facets: &'a [[Vector; 3]],
    fine: f64,
}

impl Search<'_> {
    /// The farthest height beyond `known` that the tip takes, as far as the facets' corners and edges show.
    fn farthest(&self, known: f64, direction: Direction, watch: &Watch) -> Result<f64, Cancelled> {
        let beyond = |stance: &Vector| direction.passes(stance.z, known, self.fine);
        let facets: Vec<&[Vector; 3]> = self.facets.iter().filter(|facet| facet.iter().any(beyond)).collect();
        let positions: Vec<[f64; 2]> =
            facets.iter().flat_map(|facet| facet.map(|stance| [stance.x, stance.y])).collect();
        watch.begin("reach", positions.len());
        let contacts = self.surface.envelope().contacts(&positions, watch)?;
        let touched = |(position, contact): (&[f64; 2], &Option<_>)| {
            let point = self.surface.path_point(position[0], position[1], contact.as_ref()?);
            point.selected.then_some(point.tip.z)
        };
        let tips: Vec<Option<f64>> = positions.iter().zip(&contacts).map(touched).collect();
        let farther = |far: f64, z: f64| if direction.passes(z, far, 0.0) { z } else { far };
        let mut far = tips.iter().flatten().copied().fold(known, farther);
        for (facet, tips) in facets.iter().zip(tips.chunks_exact(3)) {
            for (free, kept) in [(0, 1), (1, 0), (1, 2), (2, 1), (2, 0), (0, 2)] {
                if tips[free].is_some() && tips[kept].is_none() && direction.passes(facet[kept].z, far, self.fine) {
                    far = farther(far, self.along([facet[free], facet[kept]], far, direction));
                }
            }
        }
        Ok(far)
    }

    /// The farthest height between a stance that touches and one that does not, if it passes `known`.
    fn along(&self, [free, kept]: [Vector; 2], known: f64, direction: Direction) -> f64 {
        let tip = |share: f64| {
            let stance = free + share * (kept - free);
            self.surface.at(stance.x, stance.y, &mut None).filter(|p| p.selected).map(|p| p.tip.z)
        };
        let target = match direction {
            Direction::Down => known - self.fine,
            Direction::Up => known + self.fine,
        };
        let start = ((target - free.z) / (kept.z - free.z)).clamp(0.0, 1.0);
        let Some(mut far) = tip(start) else { return known };
        let (mut touching, mut apart) = (start, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (touching + apart);
            match tip(middle) {
                Some(z) => (touching, far) = (middle, z),
                None => apart = middle,
            }
        }
        far
    }
}

//! Planes one below the other, on which a sheet is to stand for a while.

/// Heights that differ by less are one, mm.
const SAME: f64 = 1e-9;

/// Planes one below the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planes {
    /// Height of the tip on the flat sheet, mm.
    pub top: f64,
    /// From one to the next, mm; the first lies as far below the top.
    pub increment: f64,
}

impl Planes {
    /// Height of a plane, counted from 1, mm; of 0, the flat sheet's.
    pub(crate) fn height(&self, number: usize) -> f64 {
        self.top - number as f64 * self.increment
    }

    /// The highest plane that is not above a height, mm.
    pub(crate) fn under(&self, height: f64) -> f64 {
        self.height(((self.top - height - SAME) / self.increment).ceil().max(1.0) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plane_under_a_height_is_not_above_it() {
        let planes = Planes { top: 1.0, increment: 0.5 };
        for (height, plane) in [(2.0, 0.5), (1.0, 0.5), (0.5, 0.5), (0.4, 0.0), (-0.25, -0.5), (0.5 - 1e-12, 0.5)] {
            assert!((planes.under(height) - plane).abs() < 1e-12, "{height}");
        }
    }
}

//! Areas in which the tool's centre may be, taken apart.

use super::ground::chords;
use super::material::Material;
use super::polygons::{Kernel, Point, Polygons};

/// One area in which the tool's centre may be, with the holes in it.
pub struct CentreArea {
    /// Its outline and those of its holes, points with a bulge of 0, mm.
    pub outlines: Vec<Vec<[f64; 3]>>,
    sides: Material,
}

impl CentreArea {
    /// The areas within outlines of points (x, y, bulge), mm, by the even-odd rule, each by itself.
    #[must_use]
    pub fn parted(outlines: &[Vec<[f64; 3]>]) -> Vec<Self> {
        let farthest = outlines.iter().flatten().fold(1.0, |most: f64, [x, y, _]| most.max(x.abs()).max(y.abs()));
        let kernel = Kernel::new(2.0 * farthest);
        let chords: Vec<Vec<Point>> = outlines.iter().map(|outline| chords(outline)).collect();
        let flat = |contour: &Vec<Point>| contour.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        let part =
            |area: Polygons| Self { outlines: area.contours.iter().map(flat).collect(), sides: Material::new(area) };
        kernel.even_odd(&chords).parted().into_iter().map(part).collect()
    }

    /// Whether a point lies in it.
    #[must_use]
    pub fn holds(&self, point: [f64; 2]) -> bool {
        self.sides.holds(point)
    }

    /// Corners of the smallest upright box around it, mm.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        self.sides.area.bounds()
    }
}

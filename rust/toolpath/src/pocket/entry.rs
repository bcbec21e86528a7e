//! Where the tool goes down: a helix in the middle of the largest disc that the walls leave.

use super::growth::WALL;
use super::material::Material;
use super::polygons::{Kernel, Point, Polygons};

/// Radius of the helix, in radii of the tool: no core is left in its middle.
const HELIX: f64 = 0.7;
/// The largest disc is found to this, in radii of the tool.
const FINE: f64 = 0.002;

/// A helix seen from above.
#[derive(Clone, Copy, Debug)]
pub struct Helix {
    pub centre: Point,
    pub radius: f64,
}

/// The largest disc within an area: its centre and radius, found to `FINE` tool radii, mm; None where the area is empty.
pub fn largest_disc(kernel: &Kernel, area: &Polygons, tool_radius: f64) -> Option<(Point, f64)> {
    let [low, high] = area.bounds()?;
    let mut most = 0.5 * (high[0] - low[0]).min(high[1] - low[1]) + FINE * tool_radius;
    let (mut least, mut left) = (0.0, area.clone());
    while most - least > FINE * tool_radius {
        let radius = 0.5 * (least + most);
        let core = kernel.offset(area, -radius, WALL);
        if core.is_empty() {
            most = radius;
        } else {
            (least, left) = (radius, core);
        }
    }
    // the largest rest: all of it lies within the accuracy of the centre
    let contour = left.contours.iter().max_by(|a, b| a.len().cmp(&b.len()))?;
    let count = contour.len().max(1) as f64;
    let mean = contour.iter().fold([0.0, 0.0], |sum, p| [sum[0] + p[0] / count, sum[1] + p[1] / count]);
    let centre = if Material::new(left.clone()).holds(mean) { mean } else { *contour.first()? };
    Some((centre, least))
}

/// The helix for a tool in a disc that is free.
pub fn helix((centre, free): (Point, f64), tool_radius: f64) -> Helix {
    Helix { centre, radius: (HELIX * tool_radius).min(free) }
}

impl Helix {
    /// Once around, as points with bulges.
    pub fn points(&self) -> Vec<[f64; 3]> {
        let [x, y] = self.centre;
        let r = self.radius;
        vec![[x + r, y, 1.0], [x - r, y, 1.0], [x + r, y, 0.0]]
    }
}

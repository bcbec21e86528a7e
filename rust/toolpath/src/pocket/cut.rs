//! Pieces of the path, and what they leave of the material.

use super::contours::bounds;
use super::growth::WALL;
use super::material::Material;
use super::pieces::SHALLOWEST;
use super::polygons::{sides, signed_area, Kernel, Point, Polygons};
use super::window::meets;

/// A piece of the path.
#[derive(Clone, Debug)]
pub struct Cut {
    /// Points with bulges.
    pub path: Vec<[f64; 3]>,
    /// What the tool clears on it.
    pub swept: Polygons,
    /// Number of the step of growth at which it was found.
    pub level: u32,
    /// Whether it is a helix into the material.
    pub is_entry: bool,
    /// Whether it may be cut from its end as well.
    pub two_way: bool,
}

impl Cut {
    pub fn start(&self) -> Option<Point> {
        self.path.first().map(|[x, y, _]| [*x, *y])
    }

    pub fn end(&self) -> Option<Point> {
        self.path.last().map(|[x, y, _]| [*x, *y])
    }
}

/// What pieces leave of material.
pub fn left_of<'a>(kernel: &Kernel, material: &Material, cuts: impl IntoIterator<Item = &'a Cut>) -> Material {
    let swept = Polygons { contours: cuts.into_iter().flat_map(|cut| cut.swept.contours.clone()).collect() };
    let Some(window) = swept.bounds() else { return Material::new(material.area.clone()) };
    // of an area with many holes most are far from what is swept: they stay as they are
    let is_near = |contour: &&Vec<Point>| bounds(contour.iter()).is_some_and(|around| meets(&around, &window));
    let (near, far): (Vec<_>, Vec<_>) = material.area.contours.iter().partition(is_near);
    let near = Polygons { contours: near.into_iter().cloned().collect() };
    let mut left = without_slivers(kernel.difference(&near, &swept)).thinned(0.3 * WALL);
    left.contours.extend(far.into_iter().cloned());
    Material::new(left)
}

/// The areas that are thicker than chips that do not count.
pub fn without_slivers(area: Polygons) -> Polygons {
    let is_thick = |contour: &Vec<Point>| {
        let round: f64 = sides(contour).map(|(a, b)| libm::hypot(b[0] - a[0], b[1] - a[1])).sum();
        2.0 * signed_area(contour).abs() > SHALLOWEST * round
    };
    Polygons { contours: area.contours.into_iter().filter(is_thick).collect() }
}

//! Tools and distances between passes: from what the part has, in the sizes that a shop has.

use styluscam_geometry::{Bvh, Mesh};

use super::cutter::{Cutter, Shape};
use super::shop::{Shop, IN_ONE_PIECE, WIDEST_IN_ONE_PIECE};
use super::workable::workable;
use crate::body::{Body, FaceLook, Hollows};

/// Largest diameter against the part's smaller side: a stylus travels within it, a cutter around it.
const WIDEST: [f64; 2] = [0.15, 0.25];
/// Cutters that nothing bounds are no smaller than this, mm,
const STURDY: f64 = 2.0;
/// but no wider than this share of the part's smaller side.
const HALF: f64 = 0.5;
/// Smallest diameter against the part's larger side: below it the path is longer than anybody waits for.
const THINNEST: f64 = 0.02;
/// Share of the area that may be narrower than the tool: the areas that a shop leaves for a second tool.
const LEFT: f64 = 0.02;
/// The tool may be this much wider than what bounds it: what triangles know of a radius.
const SLACK: f64 = 1.01;

/// The next smaller diameter that a shop has and that makes sense for a part of some size, mm.
pub fn next_smaller(cutter: &Cutter, mesh: &Mesh, shop: &Shop) -> Option<f64> {
    shop.sizes(cutter.shape).find(|other| *other < cutter.diameter).filter(|smaller| *smaller >= thinnest(mesh))
}

/// The radius up to which a tool from above fits the concave areas of a part, all but a fiftieth of its area, mm; none where
/// nothing bounds it.
#[must_use]
pub fn fitting_radius(mesh: &Mesh, bvh: &Bvh) -> Option<f64> {
    Hollows::bound(workable(&Body::new(mesh, bvh).hollows()), LEFT)
}

/// The largest stylus that fits the concave areas of what is formed, and the sentence on it.
pub fn stylus(mesh: &Mesh, looks: &Hollows, thickness: Option<f64>) -> (Cutter, String) {
    let bound = Hollows::bound(workable(looks), LEFT);
    // sharper ones tear the sheet
    let least = 2.0 * thickness.unwrap_or(0.0);
    let [widest, _] = WIDEST.map(|share| share * smaller_side(mesh));
    let (diameter, words) = fitting((mesh, &IN_ONE_PIECE), bound, widest, least);
    (Cutter { shape: Shape::Ball, diameter }, words)
}

/// The largest cutter that fits some faces, and the sentence on it.
pub fn cutter<'f>(
    (mesh, shop): (&Mesh, &Shop),
    faces: impl IntoIterator<Item = &'f FaceLook>,
    shape: Shape,
) -> (Cutter, String) {
    let [_, widest] = WIDEST.map(|share| share * smaller_side(mesh));
    let sturdy = STURDY.min(HALF * smaller_side(mesh));
    let sizes: Vec<f64> = shop.sizes(shape).collect();
    let (diameter, words) = fitting((mesh, &sizes), Hollows::bound(faces, LEFT), widest.max(sturdy), 0.0);
    (Cutter { shape, diameter }, words)
}

/// Of the part's box in plan, mm.
fn smaller_side(mesh: &Mesh) -> f64 {
    let (low, high) = mesh.bounds();
    (high.x - low.x).min(high.y - low.y)
}

/// Smallest diameter that makes sense for the part's size, mm; any cutter with inserts does.
fn thinnest(mesh: &Mesh) -> f64 {
    let (low, high) = mesh.bounds();
    (THINNEST * (high.x - low.x).max(high.y - low.y)).min(WIDEST_IN_ONE_PIECE)
}

/// Of some sizes, the widest first.
fn fitting((mesh, sizes): (&Mesh, &[f64]), bound: Option<f64>, widest: f64, least: f64) -> (f64, String) {
    let at_most = |limit: f64| sizes.iter().copied().find(|d| *d <= limit).unwrap_or(0.5);
    let widest = at_most(widest).max(at_most(thinnest(mesh)));
    let thinnest = f64::max(thinnest(mesh), least);
    let Some(radius) = bound.filter(|radius| 2.0 * SLACK * radius < widest) else {
        return (widest, format!("the tool, {widest} mm wide, follows from the part's size: nothing narrow bounds it, but for {} of the area at most", percent(LEFT)));
    };
    let fits = at_most(2.0 * SLACK * radius);
    let wide = sizes.iter().rev().copied().find(|d| *d >= thinnest).unwrap_or(widest).min(widest);
    if fits >= wide {
        let words = format!("the tool, {fits} mm wide, fits the narrowest areas, but for {} of the area: a radius of {radius:.2} mm fits there", percent(LEFT));
        return (fits, words);
    }
    let words = format!(
        "the part has concave areas with radii of {radius:.2} mm and less; the tool, {wide} mm wide, is the smallest \
         that suits its size and leaves material there"
    );
    (wide, words)
}

/// A share as people say it.
pub fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// A length as a person measures it: to 0.01 mm, thin ones to 0.001 mm.
pub fn measured(length: f64) -> f64 {
    let unit = if length < 0.2 { 1000.0 } else { 100.0 };
    ((length * unit).round() / unit).max(1.0 / unit)
}

/// To two significant digits.
pub fn round(value: f64) -> f64 {
    let unit = libm::pow(10.0, libm::log10(value).floor() - 1.0);
    let rounded = (value / unit - 1e-9).ceil() * unit;
    (rounded * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use styluscam_geometry::Vector;

    use super::*;

    #[test]
    fn what_fits_a_large_part_is_no_wider_for_its_length() {
        let corners = [[0.0, 0.0], [2000.0, 0.0], [2000.0, 500.0], [0.0, 500.0]].map(|[x, y]| Vector::new(x, y, 0.0));
        let mesh = Mesh::new(corners.to_vec(), &[[0, 1, 2], [0, 2, 3]], &[]).unwrap();
        let sizes = [100.0, 50.0, 25.0, 20.0, 16.0];
        for (radius, expected) in [(60.0, 100.0), (25.0, 50.0), (10.0, 20.0), (6.0, 20.0)] {
            let (width, words) = fitting((&mesh, &sizes), Some(radius), 125.0, 0.0);
            assert!((width - expected).abs() < 1e-12, "{radius}: {words}");
        }
    }

    #[test]
    fn thin_sheets_are_measured_to_a_thousandth() {
        for (thickness, expected) in [(0.0347, 0.035), (0.8012, 0.8), (1.456, 1.46), (1e-9, 0.001)] {
            assert!((measured(thickness) - expected).abs() < 1e-12, "{thickness}");
        }
    }
}

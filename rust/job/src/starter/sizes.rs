//! Tools and distances between passes: from what the part has, in the sizes that a shop has.

use styluscam_geometry::{kinds, Bvh, Mesh, ProfileDocument, Tool, ToolDocument};

use super::text::number;
use super::workable::workable;
use crate::body::{Body, FaceLook, Hollows};

/// Diameters of cutters and styluses, mm.
const DIAMETERS: [f64; 14] = [20.0, 16.0, 12.0, 10.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.5, 1.0, 0.8, 0.5];
/// Diameters of cutters with inserts, mm, that rough large parts: ISO 6462 and what lies below.
const WITH_INSERTS: [f64; 7] = [100.0, 80.0, 63.0, 50.0, 40.0, 32.0, 25.0];
/// The widest ball with inserts, mm.
const WIDEST_BALL: f64 = 50.0;
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

/// Angle of a twist drill's point, degrees (DIN 338, for steel and cast metal).
const DRILL_POINT_DEG: f64 = 118.0;

/// The tool's profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// For slopes, and whatever has fillets at its floors.
    Ball,
    /// For floors and upright walls.
    Flat,
    /// For holes: a twist drill.
    Drill,
}

/// A tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutter {
    pub shape: Shape,
    /// mm.
    pub diameter: f64,
}

impl Cutter {
    /// Its profile as a job states it.
    pub fn profile(&self) -> String {
        let diameter = number(self.diameter);
        match self.shape {
            Shape::Ball => format!("{{ kind = \"ball\", diameter = {diameter} }}"),
            Shape::Flat => format!("{{ kind = \"flat\", diameter = {diameter} }}"),
            Shape::Drill => {
                format!("{{ kind = \"v\", angle_deg = {}, diameter = {diameter} }}", number(DRILL_POINT_DEG))
            }
        }
    }

    /// The tool itself; none where its diameter is no tool's.
    pub fn made(&self) -> Option<Tool> {
        let diameter = self.diameter;
        let profile = match self.shape {
            Shape::Ball => ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }),
            Shape::Flat => ProfileDocument::from(kinds::Flat { diameter, tip_flat: 0.0 }),
            Shape::Drill => {
                let (tip_diameter, angle_deg) = (0.0, DRILL_POINT_DEG);
                ProfileDocument::from(kinds::V { tip_diameter, angle_deg, diameter, tip_flat: 0.0 })
            }
        };
        Tool::new(ToolDocument::of(profile)).ok()
    }
}

/// The diameters that a shop has for a part for which no narrower tool makes sense, mm, the widest first: cutters with inserts only where
/// none in one piece is as wide.
fn of_shop(shape: Shape, thinnest: f64) -> impl Iterator<Item = f64> {
    let [widest, ..] = DIAMETERS;
    let is_large = thinnest > widest;
    let with_inserts =
        WITH_INSERTS.into_iter().filter(move |d| is_large && (shape != Shape::Ball || *d <= WIDEST_BALL));
    with_inserts.chain(DIAMETERS)
}

/// The next smaller diameter that a shop has and that makes sense for a part of some size, mm.
pub fn next_smaller(cutter: &Cutter, mesh: &Mesh) -> Option<f64> {
    let thinnest = thinnest(mesh);
    of_shop(cutter.shape, thinnest).find(|other| *other < cutter.diameter).filter(|smaller| *smaller >= thinnest)
}

/// The diameters between two that a shop has, mm, the widest first; `thinnest` is the narrowest that makes sense for the part.
pub fn between([least, most]: [f64; 2], shape: Shape, thinnest: f64) -> impl Iterator<Item = f64> {
    of_shop(shape, thinnest).filter(move |d| (least..=most).contains(d))
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
    let (diameter, words) = fitting((mesh, &DIAMETERS), bound, widest, least);
    (Cutter { shape: Shape::Ball, diameter }, words)
}

/// The largest cutter that fits some faces, and the sentence on it.
pub fn cutter<'f>(mesh: &Mesh, faces: impl IntoIterator<Item = &'f FaceLook>, shape: Shape) -> (Cutter, String) {
    let [_, widest] = WIDEST.map(|share| share * smaller_side(mesh));
    let sturdy = STURDY.min(HALF * smaller_side(mesh));
    let sizes: Vec<f64> = of_shop(shape, thinnest(mesh)).collect();
    let (diameter, words) = fitting((mesh, &sizes), Hollows::bound(faces, LEFT), widest.max(sturdy), 0.0);
    (Cutter { shape, diameter }, words)
}

/// Of the part's box in plan, mm.
fn smaller_side(mesh: &Mesh) -> f64 {
    let (low, high) = mesh.bounds();
    (high.x - low.x).min(high.y - low.y)
}

/// Smallest diameter that makes sense for the part's size, mm.
fn thinnest(mesh: &Mesh) -> f64 {
    let (low, high) = mesh.bounds();
    THINNEST * (high.x - low.x).max(high.y - low.y)
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
    use super::*;

    #[test]
    fn cutters_with_inserts_are_for_large_parts_alone() {
        let widest = |shape, thinnest| of_shop(shape, thinnest).next();
        assert_eq!([12.0, 20.0].map(|thinnest| widest(Shape::Flat, thinnest)), [Some(20.0); 2]);
        assert_eq!(widest(Shape::Flat, 20.1), Some(100.0));
        assert_eq!(widest(Shape::Ball, 20.1), Some(50.0));
        let rising = of_shop(Shape::Flat, 80.0).collect::<Vec<_>>().windows(2).all(|pair| pair[0] > pair[1]);
        assert!(rising, "a size is there twice, or out of order");
    }

    #[test]
    fn thin_sheets_are_measured_to_a_thousandth() {
        for (thickness, expected) in [(0.0347, 0.035), (0.8012, 0.8), (1.456, 1.46), (1e-9, 0.001)] {
            assert!((measured(thickness) - expected).abs() < 1e-12, "{thickness}");
        }
    }
}

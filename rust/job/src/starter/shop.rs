//! The cutters of a shop: those in one piece, and for large parts those with inserts.

use styluscam_geometry::CutterMaterial;

use super::cutter::Shape;
use super::part::StarterPart;
use crate::cutting::{CuttingTable, CuttingWork};

/// What is cut where nothing is stated.
pub const MATERIAL: &str = "aluminium";
/// What cutters are of.
pub const CUTTER: CutterMaterial = CutterMaterial::Carbide;
/// Diameters of cutters and styluses in one piece, mm.
pub const IN_ONE_PIECE: [f64; 14] = [20.0, 16.0, 12.0, 10.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.5, 1.0, 0.8, 0.5];
/// The widest of them, mm.
pub const WIDEST_IN_ONE_PIECE: f64 = IN_ONE_PIECE[0];
/// Diameters of cutters with inserts, mm: those of ISO 6462, and below.
const WITH_INSERTS: [f64; 7] = [100.0, 80.0, 63.0, 50.0, 40.0, 32.0, 25.0];
/// The widest ball with inserts, mm.
const WIDEST_BALL: f64 = 50.0;
/// Parts that are longer are cut with inserts, mm.
const LARGE: f64 = 1000.0;

/// What there is for a part.
#[derive(Clone, Copy, Debug)]
pub struct Shop {
    /// The widest cutter with inserts, mm; none has them below their smallest size.
    with_inserts: f64,
}

impl Shop {
    /// For a part by its length, and by what the cutting data of its material allow.
    pub fn of(part: &StarterPart<'_>) -> Self {
        let (low, high) = part.mesh.bounds();
        let is_large = (high - low).max() > LARGE;
        Self { with_inserts: if is_large { widest(part.table, part.material.unwrap_or(MATERIAL)) } else { 0.0 } }
    }

    /// Diameters of a shape, mm, the widest first.
    pub fn sizes(&self, shape: Shape) -> impl Iterator<Item = f64> {
        let most = if shape == Shape::Ball { self.with_inserts.min(WIDEST_BALL) } else { self.with_inserts };
        WITH_INSERTS.into_iter().filter(move |diameter| *diameter <= most).chain(IN_ONE_PIECE)
    }

    /// The diameters of a shape between two, mm, the widest first.
    pub fn between(&self, [least, most]: [f64; 2], shape: Shape) -> impl Iterator<Item = f64> {
        self.sizes(shape).filter(move |diameter| (least..=most).contains(diameter))
    }
}

/// The widest cutter by which a material can be milled roughly and finely, mm; 0 where there are no data.
fn widest(table: &CuttingTable, material: &str) -> f64 {
    let Ok(material) = table.material(material) else { return 0.0 };
    let of_work = |work| material.entry(CUTTER, work).map_or(0.0, |entry| entry.sizes(work)[1]);
    of_work(CuttingWork::RoughMilling).min(of_work(CuttingWork::FinishMilling))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cutters_with_inserts_are_those_that_the_material_allows() {
        let widest = |with_inserts, shape| Shop { with_inserts }.sizes(shape).next();
        assert_eq!([Shape::Flat, Shape::Ball].map(|shape| widest(0.0, shape)), [Some(20.0); 2]);
        assert_eq!([Shape::Flat, Shape::Ball].map(|shape| widest(100.0, shape)), [Some(100.0), Some(50.0)]);
        assert_eq!(widest(25.4, Shape::Flat), Some(25.0));
        let sizes: Vec<f64> = Shop { with_inserts: 100.0 }.sizes(Shape::Flat).collect();
        assert!(sizes.windows(2).all(|pair| pair[0] > pair[1]), "{sizes:?}");
    }
}

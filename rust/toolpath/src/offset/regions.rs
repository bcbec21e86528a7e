//! An offset surface summed up: how much of each face the tool reaches, and what keeps it from the rest.

use std::collections::BTreeMap;

use styluscam_geometry::Mesh;

use super::{OffsetPoint, OffsetSurface, SurfaceFlag};

/// All points of a face that have one flag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The face.
    pub face: u32,
    /// The flag.
    pub flag: SurfaceFlag,
    /// Area, mm^2: a third of each triangle goes to each of its corners' flags.
    pub area: f64,
    /// The point that the tool would enter deepest for, the first of equals.
    pub worst: OffsetPoint,
}

impl OffsetSurface {
    /// The regions by face and flag; `mesh` is the one that it was made from.
    #[must_use]
    pub fn regions(&self, mesh: &Mesh) -> Vec<Region> {
        let mut regions: BTreeMap<(u32, SurfaceFlag), Region> = BTreeMap::new();
        for (corners, number) in self.triangles.iter().zip(&self.numbers) {
            let face = mesh.faces()[*number as usize];
            let points = corners.map(|i| self.points[i as usize]);
            let [a, b, c] = points.map(|point| point.contact);
            let share = (b - a).cross(&(c - a)).norm() / 6.0;
            for point in points {
                let flag = point.flag;
                let region =
                    regions.entry((face, flag)).or_insert_with(|| Region { face, flag, area: 0.0, worst: point });
                region.area += share;
                if point.depth > region.worst.depth {
                    region.worst = point;
                }
            }
        }
        regions.into_values().collect()
    }
}

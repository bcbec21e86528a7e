//! The slope-matched offset of a whole surface as data: where the tool stands for each point, and what keeps it from there.

mod build;
mod checks;
mod corners;
mod splits;

use styluscam_geometry::Vector;

/// What becomes of the slope-matched position of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum SurfaceFlag {
    /// The tool stands there and enters nothing: the position is one of the envelope's.
    Contact = 0,
    /// Something of the same smooth patch of the part stops the tool: the part is more curved than the tool.
    Bridged = 1,
    /// Something beyond a crease stops it: a wall, a step, an island.
    Interferes = 2,
    /// The surface is steeper than the profile, and not upright: the base's rim touches, and nothing stops the tool.
    Rim = 3,
    /// The surface faces down: no vertical tool reaches it.
    Undercut = 4,
}

impl SurfaceFlag {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 5] = [Self::Contact, Self::Bridged, Self::Interferes, Self::Rim, Self::Undercut];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::Bridged => "bridged",
            Self::Interferes => "interferes",
            Self::Rim => "rim",
            Self::Undercut => "undercut",
        }
    }

    /// Whether something keeps the tool from the point.
    #[must_use]
    pub fn is_stopped(self) -> bool {
        matches!(self, Self::Bridged | Self::Interferes)
    }
}

/// A point of the part and the tool's slope-matched position for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetPoint {
    /// The tool's tip (CL), mm.
    pub tip: Vector,
    /// The point of the part (CC), mm.
    pub contact: Vector,
    /// Unit normal of the part there.
    pub normal: Vector,
    /// Angle between normal and +Z, rad.
    pub slope: f64,
    /// What becomes of the position.
    pub flag: SurfaceFlag,
    /// How deep the tool (with the sheet) standing there would enter what stops it, mm; 0 where nothing does.
    pub depth: f64,
    /// The point of the part that stops it; where nothing does, the contact itself.
    pub place: Vector,
    /// The triangle of the mesh on which `contact` lies, one of equals.
    pub triangle: u32,
    /// The triangle on which `place` lies, one of equals.
    pub place_triangle: u32,
}

/// Positions for the corners of triangles, in the triangles' own connection.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetSurface {
    /// One for each corner point and normal: where faces meet at an angle, there is one for each of them.
    pub points: Vec<OffsetPoint>,
    /// Triangles of `points`: the mesh's, and parts of them where something stops the tool.
    pub triangles: Vec<[u32; 3]>,
    /// The mesh's number of each triangle, or of the one that it is a part of.
    pub numbers: Vec<u32>,
    /// No side of a triangle at which something stops the tool, or flags change, is longer, mm.
    pub fine: f64,
    /// Whether that is longer than meant: the budget of points ended first, and areas are so much the coarser.
    pub is_coarse: bool,
}

#[cfg(test)]
mod tests;

//! How passes lie across the faces: levels by height, rows by position, and the step between them on a face.

use styluscam_geometry::{wall_axes, Bend, ToolBody, Vector};

/// The ridges that passes are to leave.
#[derive(Clone, Debug, PartialEq)]
pub struct Ridge {
    /// What leaves them: the tool with its sheet.
    pub body: ToolBody,
    /// Their height over the faces, mm.
    pub height: f64,
    /// Passes are off their faces by up to this along the normal, to either side, mm.
    pub deviation: f64,
}

impl Ridge {
    /// How much farther apart along a wall two levels are when their passes are off it, mm: a pass that stays at its height moves
    /// along the wall as well.
    pub fn apart(&self, cotangent: f64) -> f64 {
        2.0 * self.deviation * cotangent.abs()
    }
}

/// Faces that slope by less, a sine, are floors: no level lies on them.
const LEVEL: f64 = 1e-4;

/// The order of passes, as far as their distance follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// Levels: by the tip's height.
    Levels,
    /// Rows in this direction from X, rad: by the tip's position across them.
    Rows(f64),
}

/// Sine of the angle to level up to which levels run along an edge,
const ALONG_LEVELS: f64 = 0.1;
/// and of the angle to rows, in plan, up to which these do: where they cross it they follow it up and down.
const ALONG_ROWS: f64 = 0.4;

impl Spread {
    /// Whether an edge runs along passes.
    pub(super) fn runs_along(self, edge: Vector) -> bool {
        let (aside, most) = match self {
            Self::Levels => (edge.z, ALONG_LEVELS),
            Self::Rows(angle) => (across(angle).dot(&edge), ALONG_ROWS),
        };
        aside.abs() <= most * edge.norm()
    }

    /// Whether passes cross a face of this normal.
    pub(super) fn crosses(self, normal: Vector) -> bool {
        match self {
            Self::Levels => normal.xy().norm() > LEVEL,
            Self::Rows(_) => true,
        }
    }

    /// The value of a position of the tip, mm.
    pub(super) fn value(self, tip: Vector) -> f64 {
        match self {
            Self::Levels => tip.z,
            Self::Rows(angle) => across(angle).dot(&tip),
        }
    }

    /// The slope of a face, with its unit normal, in the upright section across the passes, rad.
    pub(super) fn section_slope(self, normal: Vector) -> f64 {
        match self {
            Self::Levels => libm::atan2(normal.xy().norm(), normal.z),
            Self::Rows(angle) => libm::atan2(-across(angle).dot(&normal), normal.z),
        }
    }

    /// The step that leaves a ridge on a face with a unit normal, mm, and what of the tool's travel across the passes becomes
    /// a step, as a share.
    pub(super) fn step(self, normal: Vector, bend: &Bend, ridge: &Ridge) -> (f64, f64) {
        let slope = libm::atan2(normal.xy().norm(), normal.z);
        let [up, level] = wall_axes(normal);
        // the direction across the passes in the face, and by how much a step along it changes their value
        let (direction, rate, off) = match self {
            Self::Levels => (up, up.z.abs(), ridge.apart(libm::tan(slope).recip())),
            Self::Rows(angle) => {
                let (sin, cos) = libm::sincos(angle);
                let row = Vector::new(cos, sin, 0.0);
                // in the upright plane of the row the tool follows the face up and down
                let along = row * normal.z - Vector::z() * row.dot(&normal);
                let Some(aside) = normal.cross(&along).try_normalize(LEVEL) else { return (f64::INFINITY, 1.0) };
                (aside, across(angle).dot(&aside).abs(), 0.0)
            }
        };
        let shares = [direction.dot(&up), direction.dot(&level)];
        let travel = ridge.body.scallop_travel(slope, ridge.height, shares, bend.along(shares));
        ((travel - off).max(0.0) * rate, rate)
    }
}

/// The unit vector across rows of a direction, in plan.
fn across(angle: f64) -> Vector {
    let (sin, cos) = libm::sincos(angle);
    Vector::new(-sin, cos, 0.0)
}

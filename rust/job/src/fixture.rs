//! What holds the sheet, as triangles: the clamp frame above it and the backing plate below it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Bvh, Mesh, ModelFace, Sheet, Vector};
use styluscam_verify::{FindingKind, Obstacle};

use crate::{JobDocument, JobError, Scene};

/// Sides of a round opening; the polygon lies in the circle.
const SIDES: usize = 360;
/// How far the plates reach beyond their openings, mm.
const WIDTH: f64 = 200.0;
/// How far down the backing plate reaches, mm: deeper than any forming.
const DEEP: f64 = 1000.0;

/// Clamp frame and backing plate: nothing of the tool comes near the one, nor tool and sheet near the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FixtureSection {
    /// Middle of the openings in plan, work coordinates, mm; the middle of the part's box when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 2]>,
    /// What is kept clear of clamp and backing, mm.
    #[serde(default = "margin")]
    pub margin: f64,
    /// The frame on the sheet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clamp: Option<ClampSection>,
    /// The plate under the sheet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backing: Option<BackingSection>,
}

/// A frame that presses the sheet down around an opening.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClampSection {
    /// Where the sheet is free.
    pub opening: Opening,
    /// Height above the sheet, mm.
    pub height: f64,
}

/// A plate on which the sheet lies around an opening.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BackingSection {
    /// Where the sheet may go down.
    pub opening: Opening,
}

/// An opening: `[width, height]` along X and Y, or a diameter; mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a diameter or [width, height], mm")]
pub enum Opening {
    /// A circle's diameter.
    Diameter(f64),
    /// A rectangle's sides along X and Y.
    Sides([f64; 2]),
}

fn margin() -> f64 {
    1.0
}

impl Opening {
    /// Its largest measures, mm.
    #[must_use]
    pub fn sides(self) -> [f64; 2] {
        match self {
            Self::Diameter(diameter) => [diameter, diameter],
            Self::Sides(sides) => sides,
        }
    }

    /// Its corners about the origin, counterclockwise.
    fn corners(self) -> Vec<[f64; 2]> {
        match self {
            Self::Sides([w, h]) => {
                [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[x, y]| [0.5 * w * x, 0.5 * h * y]).to_vec()
            }
            Self::Diameter(diameter) => {
                let corner = |i: usize| {
                    let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / SIDES as f64);
                    [0.5 * diameter * cos, 0.5 * diameter * sin]
                };
                (0..SIDES).map(corner).collect()
            }
        }
    }
}

/// What the judge keeps tools, or tools and sheet, away from; the sheet lies at the height of the scene's top.
///
/// # Errors
/// An opening that makes no plate.
pub(crate) fn obstacles(job: &JobDocument, scene: &Scene) -> Result<Vec<Obstacle>, JobError> {
    let (Some(fixture), Some(sheet)) = (job.setup.fixture, scene.sheet) else { return Ok(Vec::new()) };
    let (low, high) = scene.mesh.bounds();
    let center = fixture.center.unwrap_or([0.5 * (low.x + high.x), 0.5 * (low.y + high.y)]);
    let obstacle = |opening: Opening, kind: FindingKind, [foot, top]: [f64; 2], sheet: Option<Sheet>| {
        let mesh = plate(opening, center, foot, top).map_err(JobError::geometry("setup.fixture"))?;
        Ok(Obstacle { kind, bvh: Bvh::new(&mesh), mesh, sheet, margin: fixture.margin })
    };
    let clamp = fixture.clamp.map(|clamp| {
        let heights = [scene.top, scene.top + clamp.height];
        obstacle(clamp.opening, FindingKind::ClampCollision, heights, None)
    });
    let backing = fixture.backing.map(|backing| {
        let under = scene.top - sheet.thickness;
        let whole = Sheet { model_face: ModelFace::Back, ..sheet };
        obstacle(backing.opening, FindingKind::BackingCollision, [under - DEEP, under], Some(whole))
    });
    clamp.into_iter().chain(backing).collect()
}

/// A plate with an opening: its upper face, and the walls of the opening and of its outer edge.
fn plate(opening: Opening, [x, y]: [f64; 2], foot: f64, top: f64) -> Result<Mesh, styluscam_geometry::GeometryError> {
    let corners = opening.corners();
    let [w, h] = opening.sides();
    let outward = [1.0 + 2.0 * WIDTH / w, 1.0 + 2.0 * WIDTH / h];
    let ring = |grow: [f64; 2], z: f64| {
        corners.iter().map(move |[cx, cy]| Vector::new(x + cx * grow[0], y + cy * grow[1], z)).collect::<Vec<_>>()
    };
    // from the foot of the opening up, over the plate and down at its outer edge
    let rings = [ring([1.0; 2], foot), ring([1.0; 2], top), ring(outward, top), ring(outward, foot)];
    let count = corners.len();
    let mut triangles = Vec::with_capacity(6 * count);
    for inner in 0..rings.len() - 1 {
        for i in 0..count {
            let [a, b] = [i, (i + 1) % count].map(|i| (inner * count + i) as i64);
            let [c, d] = [a, b].map(|corner| corner + count as i64);
            triangles.extend([[a, c, d], [a, d, b]]);
        }
    }
    Mesh::new(rings.concat(), &triangles, &[])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plate_is_open_in_the_middle_and_looks_up() {
        let mesh = plate(Opening::Sides([40.0, 20.0]), [5.0, 6.0], -3.0, 2.0).unwrap();
        let up: f64 = (0..mesh.triangles().len()).filter(|t| mesh.normal(*t).z > 0.5).map(|t| mesh.area(t)).sum();
        assert!((up - (440.0 * 420.0 - 40.0 * 20.0)).abs() < 1e-6, "{up}");
        assert!((0..mesh.triangles().len()).all(|t| mesh.normal(t).z > -1e-9));
        let inside = mesh.vertices().iter().filter(|v| (v.x - 5.0).abs() < 19.9 && (v.y - 6.0).abs() < 9.9).count();
        assert_eq!(inside, 0);
    }
}

//! What holds the sheet, as triangles: the clamp frame above it and the backing plate below it.

use styluscam_geometry::{Bvh, Mesh, ModelFace, Sheet, Vector};
use styluscam_verify::{Obstacle, ObstacleKind};

use crate::{FixtureSection, JobError, Opening, Scene};

/// Sides of a round opening; the polygon lies in the circle.
const SIDES: usize = 360;
/// How far the plates reach beyond their openings, mm.
const WIDTH: f64 = 200.0;
/// How far down the backing plate reaches, mm: deeper than any forming.
pub(crate) const DEEP: f64 = 1000.0;

/// What a plate is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holder {
    /// It lies on the sheet.
    Clamp,
    /// The sheet lies on it.
    Backing,
}

impl Holder {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Clamp => "clamp frame",
            Self::Backing => "backing plate",
        }
    }
}

/// A piece of the fixture in work coordinates: all of a plate but its opening.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plate {
    /// What it is for.
    pub holder: Holder,
    /// Corners of the opening, counterclockwise, mm.
    pub opening: Vec<[f64; 2]>,
    /// Heights of its lower and its upper face, mm.
    pub heights: [f64; 2],
}

/// The clamp frame on the sheet, whose top is the scene's, and the backing plate under it, as far as there are any. For a tool
/// from below the backing plate is what it passes through.
fn plates(scene: &Scene) -> Vec<Plate> {
    let (Some(fixture), Some(sheet)) = (scene.fixture, scene.sheet) else { return Vec::new() };
    held(&fixture, scene.mesh.bounds(), scene.flat, sheet.thickness)
}

/// The same around a part with these `bounds`, for a sheet whose flat upper side is at the height `flat`, mm.
pub(crate) fn held(fixture: &FixtureSection, bounds: (Vector, Vector), flat: f64, thickness: f64) -> Vec<Plate> {
    let [x, y] = middle(fixture.center, bounds);
    let moved = |opening: Opening| corners(opening).into_iter().map(|[cx, cy]| [x + cx, y + cy]).collect();
    let under = flat - thickness;
    let clamp = fixture.clamp.map(|clamp| Plate {
        holder: Holder::Clamp,
        opening: moved(clamp.opening),
        heights: [flat, flat + clamp.height],
    });
    let backing = fixture.backing.map(|backing| Plate {
        holder: Holder::Backing,
        opening: moved(backing.opening),
        heights: [under - DEEP, under],
    });
    clamp.into_iter().chain(backing).collect()
}

/// How far some points lie outside the clamp frame's opening in plan at most, mm, negative inside; none without a frame.
pub(crate) fn beyond_clamp(scene: &Scene, points: impl Iterator<Item = Vector>) -> Option<f64> {
    beyond(scene, scene.fixture?.clamp?.opening, points)
}

/// How far some points lie outside an opening of the scene's fixture in plan at most, mm, negative inside; none of no points.
pub(crate) fn beyond(scene: &Scene, opening: Opening, points: impl Iterator<Item = Vector>) -> Option<f64> {
    let [x, y] = middle(scene.fixture.and_then(|fixture| fixture.center), scene.mesh.bounds());
    let beyond = |point: Vector| {
        let [dx, dy] = [point.x - x, point.y - y];
        match opening {
            Opening::Diameter(diameter) => libm::hypot(dx, dy) - 0.5 * diameter,
            Opening::Sides([width, height]) => (dx.abs() - 0.5 * width).max(dy.abs() - 0.5 * height),
        }
    };
    points.map(beyond).reduce(f64::max)
}

/// Middle of the openings in plan, mm: as stated, else that of the part's box.
fn middle(center: Option<[f64; 2]>, (low, high): (Vector, Vector)) -> [f64; 2] {
    center.unwrap_or([0.5 * (low.x + high.x), 0.5 * (low.y + high.y)])
}

/// What the verifier keeps tools, or tools and sheet, away from.
///
/// # Errors
/// An opening that makes no plate.
pub(crate) fn obstacles(scene: &Scene) -> Result<Vec<Obstacle>, JobError> {
    let margin = scene.fixture.map_or(0.0, |fixture| fixture.margin);
    let whole = scene.sheet.map(|sheet| Sheet { model_face: ModelFace::Back, ..sheet });
    let obstacle = |plate: Plate| {
        let mesh = mesh_of(&plate).map_err(JobError::geometry("setup.fixture"))?;
        let (kind, sheet) = match plate.holder {
            Holder::Clamp => (ObstacleKind::Clamp, None),
            Holder::Backing => (ObstacleKind::Backing, whole),
        };
        let follows =
            plate.holder == Holder::Clamp && scene.fixture.and_then(|fixture| fixture.clamp).is_some_and(|c| c.follows);
        Ok(Obstacle { kind, bvh: Bvh::new(&mesh), mesh, sheet, margin, follows })
    };
    plates(scene).into_iter().map(obstacle).collect()
}

/// The corners of an opening about the origin, counterclockwise.
pub(crate) fn corners(opening: Opening) -> Vec<[f64; 2]> {
    match opening {
        Opening::Sides([w, h]) => {
            [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[x, y]| [0.5 * w * x, 0.5 * h * y]).to_vec()
        }
        Opening::Diameter(diameter) => {
            let corner = |i: usize| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / SIDES as f64);
                [0.5 * diameter * cos, 0.5 * diameter * sin]
            };
            (0..SIDES).map(corner).collect()
        }
    }
}

/// Its upper face, and the walls of the opening and of its outer edge.
fn mesh_of(plate: &Plate) -> Result<Mesh, styluscam_geometry::GeometryError> {
    let [foot, top] = plate.heights;
    let corners = &plate.opening;
    let range = |axis: usize| {
        let values = corners.iter().map(|corner| corner[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ([(left, right), (front, back)], count) = ([0, 1].map(range), corners.len());
    let middle = [0.5 * (left + right), 0.5 * (front + back)];
    let grow = [right - left, back - front].map(|side| 1.0 + 2.0 * WIDTH / side);
    let ring = |grow: [f64; 2], z: f64| {
        let at = move |[x, y]: &[f64; 2]| {
            Vector::new(middle[0] + (x - middle[0]) * grow[0], middle[1] + (y - middle[1]) * grow[1], z)
        };
        corners.iter().map(at).collect::<Vec<_>>()
    };
    // from the foot of the opening up, over the plate and down at its outer edge
    let rings = [ring([1.0; 2], foot), ring([1.0; 2], top), ring(grow, top), ring(grow, foot)];
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
        let opening = corners(Opening::Sides([40.0, 20.0])).into_iter().map(|[x, y]| [x + 5.0, y + 6.0]).collect();
        let mesh = mesh_of(&Plate { holder: Holder::Clamp, opening, heights: [-3.0, 2.0] }).unwrap();
        let up: f64 = (0..mesh.triangles().len()).filter(|t| mesh.normal(*t).z > 0.5).map(|t| mesh.area(t)).sum();
        assert!((up - (440.0 * 420.0 - 40.0 * 20.0)).abs() < 1e-6, "{up}");
        assert!((0..mesh.triangles().len()).all(|t| mesh.normal(t).z > -1e-9));
        let inside = mesh.vertices().iter().filter(|v| (v.x - 5.0).abs() < 19.9 && (v.y - 6.0).abs() < 9.9).count();
        assert_eq!(inside, 0);
    }
}

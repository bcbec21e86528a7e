//! Walls of the part that are steeper than the sheet allows, whether a move touches them or not.

use std::collections::HashSet;

use styluscam_geometry::{Cutter, Mesh, Vector};

use crate::expectation::Expectation;
use crate::findings::{Finding, FindingKind, Severity};
use crate::subject::{Forming, Limits, Subject, WallAngleSource};
use crate::tolerances::{ANGLE, VERTICAL};

/// Area that makes a wall, mm^2, and as a share of the faces: less is a sliver's.
const AREA: (f64, f64) = (1.0, 1e-3);
/// Corners of two faces that differ by less are one, mm.
const SAME: f64 = 1e-4;
/// A wall that rises from a face rises by more than this, mm.
const RISES: f64 = 0.1;

/// The finding of the walls that are too steep: an error, or a warning where it depends on a material that is not known.
pub(crate) fn finding(subject: &Subject, limits: &Limits) -> Option<Finding> {
    let forming = limits.forming?;
    let mut walls: Vec<Wall> = Vec::new();
    let mut area = 0.0;
    for operation in subject.expected.iter().filter(|operation| operation.expectation.forms) {
        let expectation = &operation.expectation;
        let Some(tool) = subject.tools.get(operation.tool) else { continue };
        let cutter = tool.cutter_with(subject.sheet.as_ref(), 0.0);
        let above = tool.tip_above(subject.sheet.as_ref(), 0.0);
        let is_formed = |triangle: &usize| forms(expectation, subject.mesh, &cutter, above, *triangle);
        let sloped = expectation.triangles().into_iter().filter(|triangle| !is_vertical(subject.mesh, *triangle));
        let sloped: Vec<usize> = sloped.filter(is_formed).collect();
        let all = 0..subject.mesh.triangles().len();
        let up: Vec<usize> = all.filter(|triangle| subject.mesh.normal(*triangle).z > VERTICAL).collect();
        let from_any = rising_from(subject.mesh, &up).into_iter().filter(|triangle| expectation.selects(*triangle));
        let from_formed =
            rising_from(subject.mesh, &sloped).into_iter().filter(|triangle| !expectation.selects(*triangle));
        let rising = from_any.chain(from_formed).filter(is_formed);
        walls.extend(sloped.iter().copied().chain(rising).map(|triangle| Wall::new(subject.mesh, triangle)));
        area += sloped.iter().map(|triangle| subject.mesh.area(*triangle)).sum::<f64>();
    }
    let most = forming.max_wall_angle.min(forming.sure_wall_angle);
    let enough = AREA.0.min(AREA.1 * area);
    let steepest = steepest(walls, most + ANGLE, enough)?;
    Some(finding_of(&forming, &steepest))
}

/// A triangle of a wall.
#[derive(Clone, Copy)]
struct Wall {
    angle: f64,
    area: f64,
    at: Vector,
}

impl Wall {
    fn new(mesh: &Mesh, triangle: usize) -> Self {
        let [a, b, c] = mesh.corners(triangle);
        // facets lean by their deviation: where the model's normals are known, those tell
        let angle = libm::acos(mesh.model_normal(triangle).z.clamp(0.0, 1.0));
        Self { angle, area: mesh.area(triangle), at: (a + b + c) / 3.0 }
    }
}

/// The angle that more than so much area reaches, when it is above `most`.
fn steepest(mut walls: Vec<Wall>, most: f64, enough: f64) -> Option<Wall> {
    walls.retain(|wall| wall.angle > most);
    walls.sort_by(|a, b| b.angle.total_cmp(&a.angle));
    let mut area = 0.0;
    walls.into_iter().find(|wall| {
        area += wall.area;
        area >= enough
    })
}

/// Whether the tool is at a height that is asked for when it touches a triangle's middle.
fn forms(expectation: &Expectation, mesh: &Mesh, cutter: &Cutter, above: f64, triangle: usize) -> bool {
    let wall = Wall::new(mesh, triangle);
    let tip = wall.at.z - cutter.point_at(wall.angle).1 + above;
    expectation.reaches(tip) && expectation.region.takes_slope(wall.angle)
}

fn is_vertical(mesh: &Mesh, triangle: usize) -> bool {
    mesh.normal(triangle).z.abs() <= VERTICAL
}

/// Vertical triangles that rise from sloped ones. The edge of a plate or sheet is vertical too, and falls from them.
fn rising_from(mesh: &Mesh, sloped: &[usize]) -> Vec<usize> {
    let key = |p: Vector| [p.x, p.y, p.z].map(|x| (x / SAME).round() as i64);
    let feet: HashSet<[i64; 3]> = sloped.iter().flat_map(|triangle| mesh.corners(*triangle)).map(key).collect();
    let rises = |triangle: &usize| {
        let corners = mesh.corners(*triangle);
        let highest = corners.iter().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max);
        corners.into_iter().any(|corner| highest - corner.z > RISES && feet.contains(&key(corner)))
    };
    (0..mesh.triangles().len()).filter(|triangle| is_vertical(mesh, *triangle)).filter(rises).collect()
}

fn finding_of(forming: &Forming, wall: &Wall) -> Finding {
    let angle = wall.angle.to_degrees();
    let [most, sure] = [forming.max_wall_angle, forming.sure_wall_angle].map(f64::to_degrees);
    let is_error = wall.angle > forming.max_wall_angle + ANGLE;
    let position = format!("X{:.3} Y{:.3} Z{:.3}", wall.at.x, wall.at.y, wall.at.z);
    let message = match (forming.source, is_error) {
        (WallAngleSource::Job, _) => format!(
            "{position}: a wall is at {angle:.1} degrees, and the job's max_wall_angle_deg is {most:.1}; turn the part so that \
             its walls share the angle, or form in stages"
        ),
        (WallAngleSource::Material(name), true) => format!(
            "{position}: a wall is at {angle:.1} degrees, and {name} allows {most:.1} in one pass; turn the part so that its \
             walls share the angle, form in stages, or state what your sheet allows as setup.sheet.max_wall_angle_deg"
        ),
        (WallAngleSource::Material(name), false) => format!(
            "{position}: a wall is at {angle:.1} degrees, and {name} allows {sure:.1} to {most:.1} in one pass; try it, and \
             state what your sheet allows as setup.sheet.max_wall_angle_deg"
        ),
        (WallAngleSource::Unknown, true) => format!(
            "{position}: a wall is at {angle:.1} degrees, and no known material allows more than {most:.1} in one \
             pass; turn the part so that its walls share the angle, form in stages, or state what your sheet allows as \
             setup.sheet.max_wall_angle_deg"
        ),
        (WallAngleSource::Unknown, false) => format!(
            "{position}: a wall is at {angle:.1} degrees, and not every material allows more than {sure:.1} in one pass; name \
             the material (process.material), or state what your sheet allows as setup.sheet.max_wall_angle_deg"
        ),
    };
    let severity = if is_error { Severity::Error } else { Severity::Warning };
    Finding {
        position: Some(wall.at.into()),
        value: Some(angle),
        limit: Some(if is_error { most } else { sure }),
        unit: "deg".to_owned(),
        ..Finding::of_all(FindingKind::WallAngle, severity, message)
    }
}

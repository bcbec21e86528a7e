//! By which angles a part's own faces reach its edge.

use super::fault::WallFault;
use crate::{Mesh, Vector};

/// Faces that fall outwards by more, rad, would have to be turned over before a wall rises from them.
const FALLS: f64 = 0.02;
/// Steepest, rad: an upright face is left by 89.5 degrees.
const STEEPEST: f64 = 1.562;
/// Where an edge turns by less in plan, and its faces' angles differ by less than the second, both are one: rad.
const SMOOTH: (f64, f64) = (0.5, 0.2);

/// The angles at both ends of each side of a closed line, counter-clockwise, rad: those of the faces beside, whose triangles
/// the line names. All heights are turned over where `sign` is negative.
///
/// # Errors
/// A face that falls outwards.
pub fn angles(part: &Mesh, line: &[(Vector, usize)], sign: f64) -> Result<Vec<[f64; 2]>, WallFault> {
    let count = line.len();
    let mut angles = Vec::with_capacity(count);
    for (i, (a, triangle)) in line.iter().enumerate() {
        let (b, _) = line[(i + 1) % count];
        let ends = [*a, b].map(|end| angle(part, *triangle, end, b - a, sign));
        angles.push([ends[0].ok_or(WallFault::Falls { at: *a })?, ends[1].ok_or(WallFault::Falls { at: b })?]);
    }
    let heading = |i: usize| line[(i + 1) % count].0.xy() - line[i % count].0.xy();
    for i in 0..count {
        let before = (i + count - 1) % count;
        let (from, to) = (heading(before), heading(i));
        let turn = libm::atan2(from.x * to.y - from.y * to.x, from.dot(&to));
        let (last, first) = (angles[before][1], angles[i][0]);
        if turn.abs() < SMOOTH.0 && (last - first).abs() < SMOOTH.1 {
            let both = 0.5 * (last + first);
            (angles[before][1], angles[i][0]) = (both, both);
        }
    }
    Ok(angles)
}

/// The angle of a triangle's face at one of its corners, none where it falls outwards beyond a side along `side`.
fn angle(part: &Mesh, triangle: usize, corner: Vector, side: Vector, sign: f64) -> Option<f64> {
    let away = |i: &usize| (part.corners(triangle)[*i] - corner).norm();
    let nearest = (0..3).min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let normal =
        if part.has_corner_normals() { part.corner_normals(triangle)[nearest] } else { part.model_normal(triangle) };
    let length = side.xy().norm();
    let outwards = (normal.x * side.y - normal.y * side.x) / length;
    // the rise per length in plan of a plane with this normal is -n.xy / n.z
    let across = libm::atan2(-sign * outwards, normal.z.max(0.0));
    if across < -FALLS {
        return None;
    }
    let along = side.z / length;
    Some(libm::atan(libm::hypot(libm::tan(across.clamp(0.0, STEEPEST)), along)))
}

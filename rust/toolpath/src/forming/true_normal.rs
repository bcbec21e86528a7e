//! The normal of a curved model where a tool touches its triangles.
//!
//! A tool that goes over triangles turns its contact in jerks: inside a triangle it has the triangle's normal, on an edge it rolls from one to the next. The
//! model's normals, interpolated at the point that is touched, have the opposite jerks: they stand still while it rolls. What the
//! tool would touch on the model itself lies between. With the model's normal n(p) = n(x) + B (p - x) around the touched point x,
//! and the tool's radii of curvature D, the tool whose tip touches the triangle at x with the normal m touches the model at p
//! with the normal n where both have one tip: p + D n = x + D m, so (1 + B D) n = n(x) + B D m.

use nalgebra::{Matrix2, Vector2};
use styluscam_geometry::{Mesh, Tool, Vector};

use crate::offset::Contact;

/// Contacts whose normal is turned from the triangle's by no more than so many times what the model's is at its corners are inside a
/// smooth face: on an edge between two triangles it is turned by once or twice as much.
const WITHIN: f64 = 2.0;
/// Radius of curvature that stands for a flat part of a tool, mm.
const FLAT: f64 = 1e6;
/// Sine of the slope below which both curvatures of a tool are one.
const LEVEL: f64 = 1e-6;

/// The model's normal where a tool touches; the contact's own where it rolls over an edge, and where no model is known.
///
/// `ball` is what the tool is grown by, mm.
pub fn true_normal(mesh: &Mesh, tool: &Tool, ball: f64, contact: &Contact) -> Vector {
    smooth(mesh, tool, ball, contact).unwrap_or(contact.normal)
}

fn smooth(mesh: &Mesh, tool: &Tool, ball: f64, contact: &Contact) -> Option<Vector> {
    let triangle = contact.triangle as usize;
    let (facet, normals, corners) = (mesh.normal(triangle), mesh.corner_normals(triangle), mesh.corners(triangle));
    let turned = normals.iter().map(|normal| (normal - facet).norm()).fold(0.0, f64::max);
    if (contact.normal - facet).norm() > WITHIN * turned {
        return None;
    }
    // along the tool's parallel and up its meridian
    let level = Vector::new(-facet.y, facet.x, 0.0).try_normalize(LEVEL).unwrap_or_else(Vector::x);
    let up = facet.cross(&level);
    let flat = |v: Vector| Vector2::new(v.dot(&level), v.dot(&up));
    let sides = Matrix2::from_columns(&[flat(corners[1] - corners[0]), flat(corners[2] - corners[0])]);
    let turns = Matrix2::from_columns(&[flat(normals[1] - normals[0]), flat(normals[2] - normals[0])]);
    let bend = turns * sides.try_inverse()?;
    let here = flat(normals[0]) + bend * flat(contact.point - corners[0]);
    let slope = contact.slope();
    let meridian = tool.profile().curvature_radius_at(slope).min(FLAT);
    let sin = libm::sin(slope);
    let parallel = if sin > LEVEL { (tool.point_at(slope).0 / sin).min(FLAT) } else { meridian };
    let radii = Matrix2::from_diagonal(&Vector2::new(parallel + ball, meridian + ball));
    let found = (Matrix2::identity() + bend * radii).try_inverse()? * (here + bend * radii * flat(contact.normal));
    let aside = level * found.x + up * found.y;
    let normal = (facet + aside).try_normalize(0.0)?;
    ((normal - facet).norm() <= WITHIN * turned).then_some(normal)
}

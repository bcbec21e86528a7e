//! Bounds, from below, of the distance between the body on its path and whatever a node of the index holds.
//!
//! Every plane that touches the body gives one; a body on a straight path has the support of the end that
//! reaches farther.

use styluscam_geometry::{Node, Vector};

use crate::body::{length, Body, Plane};
use crate::stroke::Stroke;

/// A bound from one plane for what lies on one side of it, wherever the body stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    away: Vector,
    /// How far along `away` what is bounded begins, less the body's support, mm.
    reach: f64,
}

impl Gap {
    /// For what begins at the nearest of some points.
    pub fn of_points(plane: &Plane, [a, b, c]: &[Vector; 3]) -> Self {
        let away = plane.away;
        Self { away, reach: away.dot(a).min(away.dot(b)).min(away.dot(c)) - plane.support }
    }

    /// For whatever a node holds.
    pub fn of_node(plane: &Plane, node: &Node) -> Self {
        let (origin, away) = (Vector::zeros(), plane.away);
        let reach = patch_gap(node, plane, origin).max(box_gap(node.low, node.high, plane, origin));
        Self { away, reach }
    }

    /// The same by the plane that lies over all the node's points.
    pub fn over_node(body: &Body, node: &Node) -> Self {
        let [gx, gy] = node.gradient;
        let [mx, my] = node.middle();
        let steep = length(gx, gy);
        let scale = 1.0 / (1.0 + steep * steep).sqrt();
        let over = node.lift - gx * mx - gy * my;
        Self { away: Vector::new(gx, gy, -1.0) * scale, reach: -(over + body.support_bound(steep, 1.0)) * scale }
    }

    /// How far off the body is at a position, at least, mm.
    pub fn at(&self, position: Vector) -> f64 {
        self.reach - self.away.dot(&position)
    }

    /// The same on a whole stroke.
    pub fn along(&self, stroke: Stroke) -> f64 {
        self.at(stroke.from).min(self.at(stroke.to))
    }
}

/// Planes that may keep a node off the body at a position; the second is dearer.
pub(crate) fn planes_at(body: &Body, node: &Node, position: Vector) -> [Plane; 2] {
    [patch_plane(body, node, position), box_plane(body, node.low, node.high, position)]
}

/// The bound by the boxes alone: the body on its path is in its cylinder, or in the sphere that it ends in and above that.
pub(crate) fn apart(body: &Body, node: &Node, Stroke { from, to }: Stroke) -> f64 {
    let beside = |low: f64, high: f64, a: f64, b: f64| (low - a.max(b)).max(a.min(b) - high).max(0.0);
    let x = beside(node.low.x, node.high.x, from.x, to.x);
    let y = beside(node.low.y, node.high.y, from.y, to.y);
    let over = body.ball().map_or(0.0, |ball| (from.z.min(to.z) + ball - node.high.z).max(0.0));
    (x * x + y * y + over * over).sqrt() - body.radius()
}

/// A bound for whatever a box holds, by one plane; the body stands at the origin.
pub(crate) fn box_bound(body: &Body, low: Vector, high: Vector) -> f64 {
    box_gap(low, high, &box_plane(body, low, high, Vector::zeros()), Vector::zeros())
}

/// A plane that keeps the middle of the node's upper plane off the body.
fn patch_plane(body: &Body, node: &Node, position: Vector) -> Plane {
    let [x, y] = node.middle();
    body.separating(Vector::new(x, y, node.lift) - position)
}

/// A plane that keeps the box off the body, nearly as far as any can.
///
/// The box's nearest position is on its top: the body only grows upwards.
fn box_plane(body: &Body, low: Vector, high: Vector, position: Vector) -> Plane {
    let near = |low: f64, high: f64, at: f64| at.clamp(low, high) - at;
    let x = near(low.x, high.x, position.x);
    let y = near(low.y, high.y, position.y);
    body.separating(Vector::new(x, y, high.z - position.z))
}

/// The gap that a plane leaves between body and box, mm.
fn box_gap(low: Vector, high: Vector, plane: &Plane, position: Vector) -> f64 {
    let side = |a: f64, low: f64, high: f64, at: f64| a * (if a > 0.0 { low } else { high } - at);
    side(plane.away.x, low.x, high.x, position.x)
        + side(plane.away.y, low.y, high.y, position.y)
        + side(plane.away.z, low.z, high.z, position.z)
        - plane.support
}

/// The gap that a plane leaves between body and what lies in the box and under the node's upper plane, mm.
///
/// The plane's direction never points up, so the highest points count: those of the upper plane, over the box.
fn patch_gap(node: &Node, plane: &Plane, position: Vector) -> f64 {
    let [x, y] = node.middle();
    let away = plane.away;
    let middle = away.x * (x - position.x) + away.y * (y - position.y) + away.z * (node.lift - position.z);
    let tilt_x = (away.x + away.z * node.gradient[0]).abs();
    let tilt_y = (away.y + away.z * node.gradient[1]).abs();
    let fall = tilt_x * (node.high.x - node.low.x) + tilt_y * (node.high.y - node.low.y);
    middle - 0.5 * fall - plane.support
}

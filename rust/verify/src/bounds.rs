//! Bounds, from below, of the distance between the body on its way and whatever a node of the index holds.
//!
//! Every plane that touches the body gives one; a body on a straight way has the support of the end that
//! reaches farther.

use styluscam_geometry::Node;

use crate::body::{length, Body, Plane};
use crate::sweep::Stroke;
use crate::Vector;

/// A bound for a node; the cheap ones first, until one is above `limit`. `hint` is a plane worth trying.
pub(crate) fn node_bound(body: &Body, node: &Node, stroke: Stroke, limit: f64, hint: Option<&Plane>) -> f64 {
    let apart = apart(body, node, stroke);
    if apart > limit {
        return apart;
    }
    let gap = |plane: &Plane| {
        let position = stroke.farther(plane);
        patch_gap(node, plane, position).max(box_gap(node.low, node.high, plane, position))
    };
    let hinted = hint.map_or(f64::NEG_INFINITY, gap);
    if hinted > limit {
        return hinted;
    }
    let sloped = sloped_bound(body, node, stroke).max(hinted);
    if sloped > limit {
        return sloped;
    }
    let position = stroke.at(stroke.share_near(0.5 * (node.low + node.high)));
    let patch = gap(&patch_plane(body, node, position)).max(sloped);
    if patch > limit {
        return patch;
    }
    patch.max(gap(&box_plane(body, node.low, node.high, position)))
}

/// The bound by the boxes alone: the body on its way is in its cylinder, or in the sphere that it ends in and above that.
fn apart(body: &Body, node: &Node, Stroke { from, to }: Stroke) -> f64 {
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

/// The bound by the plane that lies over all the node's points.
fn sloped_bound(body: &Body, node: &Node, stroke: Stroke) -> f64 {
    let [gx, gy] = node.gradient;
    let [mx, my] = node.middle();
    let steep = length(gx, gy);
    let over = |p: Vector| p.z - node.lift - gx * (p.x - mx) - gy * (p.y - my);
    let lowest = over(stroke.from).min(over(stroke.to));
    (lowest - body.support_bound(steep, 1.0)) / (1.0 + steep * steep).sqrt()
}

/// A plane that keeps the middle of the node's upper plane off the body.
fn patch_plane(body: &Body, node: &Node, position: Vector) -> Plane {
    let [x, y] = node.middle();
    body.separating(Vector::new(x, y, node.lift) - position)
}

/// A plane that keeps the box off the body, nearly as far as any can.
///
/// The box's nearest place is on its top: the body only grows upwards.
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

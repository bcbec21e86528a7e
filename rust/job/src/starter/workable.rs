//! Which faces a tool from above can work on.

use crate::body::{FaceLook, Hollows};

/// Share of a face that a tool from above must see for the face to be worth an operation,
const SEEN: f64 = 0.2;
/// and the share of it that must face up or stand upright.
const UPWARD: f64 = 0.05;

/// The faces of which a tool from above sees enough to work on.
pub fn workable(looks: &Hollows) -> impl Iterator<Item = &FaceLook> {
    looks.faces.iter().filter(|face| face.seen > SEEN && is_upward(face))
}

/// The faces that face up or stand upright, and lie under others.
pub fn covered(looks: &Hollows) -> impl Iterator<Item = &FaceLook> {
    looks.faces.iter().filter(|face| face.seen <= SEEN && is_upward(face))
}

/// Whether more of a face than an edge of it faces up or stands upright.
fn is_upward(face: &FaceLook) -> bool {
    face.flat + face.gentle + face.steep > UPWARD
}

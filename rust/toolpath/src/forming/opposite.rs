//! The tool on the other side of a sheet: where it stands while the main tool moves, and into how many moves the main tool's
//! must be divided so that both keep to their faces, and to each other, between the ends.
//!
//! The derivation is in docs/concepts/double-sided.md.

use styluscam_geometry::{Tool, Vector};
use styluscam_motion::Move;

use super::true_normal::true_normal;
use crate::{PathPoint, PlanError, Surface};

/// Moves of the main tool are not divided below this length, mm: no machine resolves much less.
const SHORTEST: f64 = 0.01;
/// Moves of the tool below that are no longer than this, mm, while the main one moves by [`SHORTEST`], are no jump: the normal turns
/// from triangle to triangle.
const NO_JUMP: f64 = 0.5;

/// Shorter moves of the tool below, mm, are looked at in their middle alone: a kink between their ends is cut by less than counts.
const SEEN: f64 = 0.02;

/// One of the two tools with its side of the sheet.
#[derive(Clone, Copy)]
pub struct Facing<'a> {
    /// The surface on which it runs, in its own machine's coordinates.
    pub surface: &'a Surface<'a>,
    /// The tool.
    pub tool: &'a Tool,
    /// What it is grown by on that surface, along the normal, mm.
    pub ball: f64,
}

/// A main tool and the one on the other side of the sheet, whose coordinates are turned half about X.
#[derive(Clone, Copy)]
pub struct Opposite<'a> {
    /// The main tool.
    pub main: Facing<'a>,
    /// The other.
    pub below: Facing<'a>,
    /// Sheet left between them along the normal, mm.
    pub normal: f64,
    /// Sheet left between them along the vertical, mm.
    pub vertical: f64,
    /// How far the main tool's path may be off its surface and still touch it, mm.
    pub touching: f64,
    /// How far the path between two ends may be off on the other side, mm.
    pub deviation: f64,
}

/// Where both tools stand at the end of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The main tool's tip, mm.
    pub main: Vector,
    /// The other tool on its surface, in its own coordinates.
    pub below: PathPoint,
}

/// Turns a position half about X: from the coordinates of one tool to those of the other.
fn turned(position: Vector) -> Vector {
    Vector::new(position.x, -position.y, -position.z)
}

impl Opposite<'_> {
    /// Both tools while the main one is at a position; none where it does not touch.
    ///
    /// The other tool is where its slope is that of the main tool's contact, lowered where it would enter the sheet elsewhere.
    #[must_use]
    pub fn station(&self, main: Vector, hints: &mut [Option<u32>; 2]) -> Option<Station> {
        let [hint, hint_below] = hints;
        let envelope = self.main.surface.envelope();
        let contact = envelope.contact_near(main.x, main.y, hint)?;
        let normal = true_normal(envelope.mesh(), self.main.tool, self.main.ball, &contact);
        if (main.z - contact.tip) * normal.z > self.touching {
            return None;
        }
        let slope = libm::atan2(normal.xy().norm(), normal.z);
        let aside = normal.xy().try_normalize(0.0).unwrap_or_default();
        let [(radius, height), (radius_below, height_below)] =
            [self.main.tool, self.below.tool].map(|tool| tool.point_at(slope));
        let through = normal * (self.normal + self.vertical * normal.z);
        let apart = aside * (radius + radius_below);
        let rise = height + height_below;
        let below = turned(main + Vector::new(-apart.x, -apart.y, rise) - through);
        let found = self.below.surface.at(below.x, below.y, hint_below);
        // beside the sheet nothing is touched
        let below = found.unwrap_or(PathPoint { tip: below, normal: Vector::z(), selected: false, triangle: u32::MAX });
        Some(Station { main, below })
    }

    /// The ends of the parts into which a move of the main tool from a station is to be divided, as shares of its path, with
    /// where the tools stand there; the last is its own end. None where it ends off the surface.
    ///
    /// # Errors
    /// [`PlanError::Jump`] where the main tool's contact jumps.
    pub fn parts(
        &self,
        from: Station,
        step: &Move,
        hints: &mut [Option<u32>; 2],
    ) -> Result<Option<Vec<(f64, Station)>>, PlanError> {
        let start: [f64; 3] = from.main.into();
        let (path, length, end) = (step.path(start), step.length(start), Vector::from(step.end.tip));
        let at = |share: f64| path.map_or(from.main + share * (end - from.main), |arc| arc.at(share).into());
        let Some(last) = self.station(end, hints) else { return Ok(None) };
        let (mut done, mut pending) = (vec![(0.0, from)], vec![(1.0, last)]);
        while let Some((share, station)) = pending.pop() {
            let (before, behind) = done[done.len() - 1];
            let middle = 0.5 * (before + share);
            let Some(between) = self.station(at(middle), hints) else { return Ok(None) };
            if self.keeps(&behind, &between, &station) {
                done.push((share, station));
            } else if (share - before) * length > SHORTEST {
                pending.extend([(share, station), (middle, between)]);
            } else {
                let jump = (station.below.tip - behind.below.tip).norm();
                if jump > NO_JUMP {
                    return Err(PlanError::Jump { at: station.main.into(), jump });
                }
                done.push((share, station));
            }
        }
        done.remove(0);
        Ok(Some(done))
    }

    /// Whether the straight way of the tool below from one station to another keeps to its surface, and to the main tool.
    fn keeps(&self, a: &Station, middle: &Station, b: &Station) -> bool {
        let (from, to, exact) = (a.below.tip, b.below.tip, &middle.below);
        let off = 0.5 * (from + to) - exact.tip;
        let along_normal = off.dot(&exact.normal);
        let beside = (off - exact.normal * along_normal).norm_squared();
        // beside each other's contacts two round tools are farther apart: by as much as two balls of their diameters
        let apart = along_normal.abs() + beside / (self.main.tool.diameter() + self.below.tool.diameter());
        let kept = || self.below.surface.keeps_to(None, &a.below, &b.below, self.deviation);
        apart <= self.deviation && ((to - from).norm() <= SEEN || kept())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::offset::{Envelope, Index};
    use styluscam_geometry::{kinds, Frame, Mesh, ModelFace, ProfileDocument, Sheet, SheetLaw, ToolDocument};

    fn ball(diameter: f64) -> Tool {
        let profile = ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 });
        Tool::new(ToolDocument::of(profile)).unwrap()
    }

    #[test]
    fn on_a_slope_both_balls_and_the_sheet_between_them_are_on_one_normal() {
        let (main, below, left) = (ball(10.0), ball(6.0), 0.8);
        // 45 degrees, rising along X
        let corners = [[-40.0, -40.0], [40.0, -40.0], [40.0, 40.0], [-40.0, 40.0]];
        let vertices = corners.map(|[x, y]| Vector::new(x, y, x)).to_vec();
        let mesh = Mesh::new(vertices, &[[0, 1, 2], [0, 2, 3]], &[]).unwrap();
        let other = mesh.other_side(|_| true).unwrap().placed(&Frame::turning_up(-Vector::z(), 0.0));
        assert!((0..2).all(|triangle| other.normal(triangle).z > 0.0));
        let sheet = Sheet { thickness: left, law: SheetLaw::Constant, model_face: ModelFace::Back };
        let indices = [Index::new(&mesh), Index::new(&other)];
        let envelopes = [
            Envelope::new(&mesh, &indices[0], &main, None, 0.0),
            Envelope::new(&other, &indices[1], &below, Some(&sheet), 0.0),
        ];
        let surfaces = envelopes.each_ref().map(Surface::whole);
        let opposite = Opposite {
            main: Facing { surface: &surfaces[0], tool: &main, ball: 0.0 },
            below: Facing { surface: &surfaces[1], tool: &below, ball: left },
            normal: left,
            vertical: 0.0,
            touching: 0.001,
            deviation: 0.001,
        };
        let tip = Vector::new(3.0, 4.0, 3.0 + 5.0 * (2.0_f64.sqrt() - 1.0));
        let station = opposite.station(tip, &mut [None; 2]).unwrap();
        let normal = Vector::new(-1.0, 0.0, 1.0).normalize();
        let centre = tip + Vector::z() * 5.0 - normal * (5.0 + left + 3.0);
        let expected = turned(centre) - Vector::z() * 3.0;
        assert!((station.below.tip - expected).norm() < 1e-9, "{} {expected}", station.below.tip);
        assert_eq!(opposite.station(tip + Vector::z() * 0.01, &mut [None; 2]), None);
        // along a plane nothing is divided
        let step = Move::feed([9.0, -2.0, tip.z + 6.0], 100.0);
        let parts = opposite.parts(station, &step, &mut [None; 2]).unwrap().unwrap();
        assert_eq!(parts.len(), 1);
    }
}

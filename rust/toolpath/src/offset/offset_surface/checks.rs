//! Slope-matched positions checked against the envelope: what stops the tool there, and how deep it would enter it.

use rayon::prelude::*;
use styluscam_geometry::{Sheet, Tool, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::super::{
    patches::{Patches, FACET_CREASE},
    slope_matched_offset, Contact, Envelope,
};
use super::{corners::Corner, OffsetPoint, SurfaceFlag};

/// Angles within this are equal, rad.
const SAME_ANGLE: f64 = 1e-9;
/// How often the tool steps aside from what it only grazes: once from each of the walls that can be near.
const ASIDE: usize = 4;
/// How far from where it would stand it may step, in tolerances: free there, it enters nothing deeper where it stands.
pub const FARTHEST: f64 = 3.0;
/// Facets over which the deepest point is walked to at most.
const WALK: usize = 32;
/// How much further than free it steps, as a share of the tolerance.
const FREE: f64 = 1e-3;
/// Points checked between two looks at the watch.
const CHUNK: usize = 1024;

pub struct Checks<'a> {
    pub envelope: &'a Envelope<'a>,
    pub tool: &'a Tool,
    pub sheet: Option<&'a Sheet>,
    pub patches: &'a Patches,
    pub tolerance: f64,
}

impl Checks<'_> {
    /// The positions for points of the part, checked.
    pub fn points(&self, corners: &[Corner], watch: &Watch) -> Result<Vec<OffsetPoint>, Cancelled> {
        let mut points: Vec<OffsetPoint> =
            corners.par_iter().with_min_len(CHUNK).map(|corner| self.matched(corner)).collect();
        let asked: Vec<usize> = (0..points.len()).filter(|i| points[*i].flag != SurfaceFlag::Undercut).collect();
        let positions: Vec<[f64; 2]> =
            asked.iter().map(|i| self.lifted(&points[*i])).map(|tip| [tip.x, tip.y]).collect();
        watch.begin("offset surface", positions.len());
        let met = self.envelope.contacts(&positions, watch)?;
        let checked: Result<Vec<Vec<OffsetPoint>>, Cancelled> = asked
            .par_chunks(CHUNK)
            .zip(met.par_chunks(CHUNK))
            .map(|(asked, met)| {
                watch.advance(0)?;
                Ok(asked.iter().zip(met).map(|(i, met)| self.checked(points[*i], *met)).collect())
            })
            .collect();
        for (i, point) in asked.into_iter().zip(checked?.into_iter().flatten()) {
            points[i] = point;
        }
        Ok(points)
    }

    /// The slope-matched position, not yet checked.
    fn matched(&self, corner: &Corner) -> OffsetPoint {
        let Corner { point, normal, triangle } = *corner;
        let (tip, _) = slope_matched_offset(self.tool, self.sheet, point, normal);
        let slope = libm::atan2(libm::hypot(normal.x, normal.y), normal.z);
        let flag = if normal.z < -SAME_ANGLE {
            SurfaceFlag::Undercut
        } else if slope > self.tool.profile().max_slope() + SAME_ANGLE && !self.is_upright(triangle) {
            SurfaceFlag::Rim
        } else {
            SurfaceFlag::Contact
        };
        OffsetPoint {
            tip,
            contact: point,
            normal,
            slope,
            flag,
            depth: 0.0,
            place: point,
            triangle,
            place_triangle: triangle,
        }
    }

    /// Upright walls are touched by the tool's side, whatever its profile.
    fn is_upright(&self, triangle: u32) -> bool {
        self.envelope.mesh().is_upright(triangle as usize)
    }

    /// Where the tool touches the part with the margin that the envelope keeps clear.
    fn standing(&self, point: &OffsetPoint) -> Vector {
        point.tip + point.normal * self.envelope.margin()
    }

    /// That position lifted off the part by the tolerance.
    fn lifted(&self, point: &OffsetPoint) -> Vector {
        self.standing(point) + point.normal * self.tolerance
    }

    /// The point with what stops its lifted position, over which `met` is the envelope's contact.
    ///
    /// What the tool does not enter deeper than the tolerance, it may only graze, as a wall beside it: it steps aside and
    /// looks again, because the envelope shows what stops the tool first, not what it would enter deepest. If it is not free
    /// after a few small steps, that counts as stopped: the safe side.
    fn checked(&self, point: OffsetPoint, met: Option<Contact>) -> OffsetPoint {
        let (standing, mut stand, mut met, mut hint) = (self.standing(&point), self.lifted(&point), met, None);
        let mut worst = point;
        for _ in 0..=ASIDE {
            let Some(contact) = met.filter(|contact| contact.tip > stand.z) else { return point };
            let (position, depth) = self.deepest(&contact, standing);
            if depth > worst.depth || !worst.flag.is_stopped() {
                let flag = self.stopped_flag(&point, &contact);
                worst = OffsetPoint { flag, depth, place: position, place_triangle: contact.triangle, ..point };
            }
            let entered = self.envelope.depth(contact.point, stand).max(0.0);
            stand += contact.normal * (entered + FREE * self.tolerance);
            if depth > self.tolerance || (stand - standing).norm() > FARTHEST * self.tolerance {
                break;
            }
            met = self.envelope.contact_near(stand.x, stand.y, &mut hint);
        }
        worst
    }

    /// Where the tool standing at a tip would enter what it touches first, and how deep.
    ///
    /// It touches first with its tip higher: what lies deepest in it when it stands is found from there, facet by facet.
    fn deepest(&self, contact: &Contact, standing: Vector) -> (Vector, f64) {
        let touched = self.envelope.touched(contact);
        let positions = touched.into_iter().map(|triangle| self.deepest_from(triangle, standing));
        let measured = std::iter::once(contact.point).chain(positions).map(|p| (p, self.envelope.depth(p, standing)));
        measured.fold((contact.point, f64::NEG_INFINITY), |best, other| if other.1 > best.1 { other } else { best })
    }

    /// The point of the part below the tool's own point of the same slope, walked to from a triangle up to a crease, or
    /// up to a ridge, on both sides of which it lies beyond.
    fn deepest_from(&self, triangle: u32, standing: Vector) -> Vector {
        let (mesh, mut triangle) = (self.envelope.mesh(), triangle as usize);
        let (mut position, mut before) = (standing, triangle);
        for _ in 0..WALK {
            let (corners, normal) = (mesh.corners(triangle), mesh.normal(triangle));
            let below = self.envelope.touching_point(standing, normal);
            let foot = below - normal * (below - corners[0]).dot(&normal);
            position = nearest_in_triangle(corners, foot);
            let Some(side) = side_towards(corners, foot) else { break };
            let next = self.envelope.neighbours(triangle as u32)[side] as usize;
            // where the mesh ends there is no triangle of that number
            if next >= mesh.triangles().len() || next == before || mesh.normal(next).dot(&normal) < FACET_CREASE {
                break;
            }
            (before, triangle) = (triangle, next);
        }
        position
    }

    fn stopped_flag(&self, point: &OffsetPoint, contact: &Contact) -> SurfaceFlag {
        let patch = self.patches.of_triangle(point.triangle);
        if self.envelope.touched(contact).iter().any(|t| self.patches.of_triangle(*t) == patch) {
            SurfaceFlag::Bridged
        } else {
            SurfaceFlag::Interferes
        }
    }
}

/// The side of a triangle beyond which a point of its plane lies farthest, if it lies beyond any.
fn side_towards([a, b, c]: [Vector; 3], point: Vector) -> Option<usize> {
    let normal = (b - a).cross(&(c - a));
    let beyond = [(a, b), (b, c), (c, a)].map(|(p, q)| (point - p).cross(&(q - p)).dot(&normal) / (q - p).norm());
    (0..3).filter(|k| beyond[*k] > 0.0).max_by(|j, k| beyond[*j].total_cmp(&beyond[*k]))
}

/// The point of a triangle nearest to one of its plane.
fn nearest_in_triangle([a, b, c]: [Vector; 3], point: Vector) -> Vector {
    if side_towards([a, b, c], point).is_none() {
        return point;
    }
    let on_side =
        |p: Vector, q: Vector| p + (q - p) * ((point - p).dot(&(q - p)) / (q - p).norm_squared()).clamp(0.0, 1.0);
    let sides = [on_side(a, b), on_side(b, c), on_side(c, a)];
    sides.into_iter().fold(a, |best, p| if (p - point).norm() < (best - point).norm() { p } else { best })
}

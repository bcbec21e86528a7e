//! The slope-matched offset of a whole surface as data: where the tool stands for each point, and what keeps it from there.

use rayon::prelude::*;
use styluscam_geometry::{Mesh, Sheet, Tool, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::patches::{Patches, FACET_CREASE};
use super::splits::Splits;
use super::{slope_matched_offset, Contact, Envelope};

/// Normals of one corner within this are one, mm per mm.
const SAME_NORMAL: f64 = 1e-6;
/// Points of one corner that are compared with a new one at most: fans of thousands of facets have as many normals.
const COMPARED: usize = 64;
/// Angles within this are equal, rad.
const SAME_ANGLE: f64 = 1e-9;
/// How often the tool steps aside from what it only grazes: once from each of the walls that can be near.
const ASIDE: usize = 4;
/// How far from where it would stand it may step, in tolerances: free there, it enters nothing deeper where it stands.
const FARTHEST: f64 = 3.0;
/// Facets over which the deepest point is walked to at most.
const WALK: usize = 32;
/// How much further than free it steps, as a share of the tolerance.
const FREE: f64 = 1e-3;
/// Sides of triangles at which something stops the tool are halved down to this share of the tool's radius: what is
/// stopped is as narrow as the tool, planes have triangles of any size.
const FINE: f64 = 0.25;
/// Points judged between two looks at the watch.
const CHUNK: usize = 1024;

/// What becomes of the slope-matched position of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum SurfaceFlag {
    /// The tool stands there and enters nothing: the position is one of the envelope's.
    Contact = 0,
    /// Something of the same smooth patch of the part stops the tool: the part is more curved than the tool.
    Bridged = 1,
    /// Something beyond a crease stops it: a wall, a step, an island.
    Interferes = 2,
    /// The surface is steeper than the profile, and not upright: the base's rim touches, and nothing stops the tool.
    Rim = 3,
    /// The surface looks down: no vertical tool reaches it.
    Undercut = 4,
}

impl SurfaceFlag {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 5] = [Self::Contact, Self::Bridged, Self::Interferes, Self::Rim, Self::Undercut];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::Bridged => "bridged",
            Self::Interferes => "interferes",
            Self::Rim => "rim",
            Self::Undercut => "undercut",
        }
    }

    /// Whether something keeps the tool from the point.
    #[must_use]
    pub fn is_stopped(self) -> bool {
        matches!(self, Self::Bridged | Self::Interferes)
    }
}

/// A point of the part and the tool's slope-matched position for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetPoint {
    /// The tool's tip (CL), mm.
    pub tip: Vector,
    /// The point of the part (CC), mm.
    pub contact: Vector,
    /// Unit normal of the part there.
    pub normal: Vector,
    /// Angle between normal and +Z, rad.
    pub slope: f64,
    /// What becomes of the position.
    pub flag: SurfaceFlag,
    /// How deep the tool (with the sheet) standing there would enter what stops it, mm; 0 where nothing does.
    pub depth: f64,
    /// The point of the part that stops it; where nothing does, the contact itself.
    pub place: Vector,
    /// The triangle of the mesh on which `contact` lies, one of equals.
    pub triangle: u32,
    /// The triangle on which `place` lies, one of equals.
    pub place_triangle: u32,
}

/// Positions for the corners of triangles, in the triangles' own connection.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetSurface {
    /// One for each corner point and normal: where faces meet at an angle, there is one for each of them.
    pub points: Vec<OffsetPoint>,
    /// Triangles of `points`: the mesh's, and parts of them where something stops the tool.
    pub triangles: Vec<[u32; 3]>,
    /// The mesh's number of each triangle, or of the one that it is a part of.
    pub numbers: Vec<u32>,
    /// No side of a triangle at which something stops the tool, or flags change, is longer, mm.
    pub fine: f64,
    /// Whether that is longer than meant: the budget of points ended first, and areas are so much the coarser.
    pub is_coarse: bool,
}

impl OffsetSurface {
    /// The offset of some `triangles` of the envelope's mesh, every position judged against the whole mesh.
    ///
    /// Triangles with a corner from which something keeps the tool, or with corners of several flags, are split until they
    /// are small beside the tool, as far as a budget of `most` points more goes: the longest first.
    ///
    /// Positions are exact for the normals that the mesh knows at its corners, else for its facets'. A position is free
    /// if the tool, lifted off by `tolerance` (mm) along the normal, enters nothing: then it enters nothing deeper than
    /// that where it stands. (What it grazes beside it may move it by twice as much again.) So vertical walls, where
    /// heights jump, are judged by the same measure as floors. The tolerance has to cover how far the triangles lie outside the surface that the normals belong to.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn new(
        envelope: &Envelope<'_>,
        tool: &Tool,
        sheet: Option<&Sheet>,
        triangles: &[u32],
        tolerance: f64,
        most: usize,
        watch: &Watch,
    ) -> Result<Self, Cancelled> {
        let patches = Patches::of(envelope);
        let judge = Judge { envelope, tool, sheet, patches: &patches, tolerance };
        let (corners, connection) = welded(envelope.mesh(), &patches, triangles);
        let points = judge.points(&corners, watch)?;
        let fine = FINE * envelope.cutter().max_radius();
        let numbers = triangles.to_vec();
        let mut surface = Self { points, triangles: connection, numbers, fine, is_coarse: false };
        let most = surface.points.len() + most;
        loop {
            let splits = Splits::of(&surface, surface.fine);
            if splits.middles.is_empty() {
                break;
            }
            if surface.points.len() + splits.middles.len() > most {
                (surface.fine, surface.is_coarse) = (2.0 * surface.fine, true);
                watch.advance(0)?;
                continue;
            }
            surface.points.extend(judge.points(&splits.middles, watch)?);
            splits.apply(&mut surface);
        }
        Ok(surface)
    }
}

/// A point of the part with its normal.
pub(super) struct Corner {
    pub point: Vector,
    pub normal: Vector,
    /// The first triangle that has it.
    pub triangle: u32,
}

/// Corners of triangles made one where vertex, patch and normal agree, and the triangles of them.
fn welded(mesh: &Mesh, patches: &Patches, triangles: &[u32]) -> (Vec<Corner>, Vec<[u32; 3]>) {
    const LAST: u32 = u32::MAX;
    let mut corners: Vec<Corner> = Vec::with_capacity(mesh.vertices().len());
    // the last corner at each vertex, and before each corner the one before it at the same vertex
    let mut heads = vec![LAST; mesh.vertices().len()];
    let mut before: Vec<u32> = Vec::with_capacity(mesh.vertices().len());
    let mut connection = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        let names = mesh.triangles()[*triangle as usize];
        let normals = mesh.corner_normals(*triangle as usize);
        let patch = patches.of_triangle(*triangle);
        connection.push(std::array::from_fn(|k| {
            let (vertex, normal) = (names[k] as usize, normals[k]);
            let known = std::iter::successors(Some(heads[vertex]), |at| before.get(*at as usize).copied());
            let same = known.take(COMPARED).find(|at| {
                corners.get(*at as usize).is_some_and(|c| {
                    (c.normal - normal).norm() < SAME_NORMAL && patches.of_triangle(c.triangle) == patch
                })
            });
            same.unwrap_or_else(|| {
                corners.push(Corner { point: mesh.vertices()[vertex], normal, triangle: *triangle });
                before.push(heads[vertex]);
                heads[vertex] = corners.len() as u32 - 1;
                heads[vertex]
            })
        }));
    }
    (corners, connection)
}

struct Judge<'a> {
    envelope: &'a Envelope<'a>,
    tool: &'a Tool,
    sheet: Option<&'a Sheet>,
    patches: &'a Patches,
    tolerance: f64,
}

impl Judge<'_> {
    /// The positions for points of the part, judged.
    fn points(&self, corners: &[Corner], watch: &Watch) -> Result<Vec<OffsetPoint>, Cancelled> {
        let mut points: Vec<OffsetPoint> =
            corners.par_iter().with_min_len(CHUNK).map(|corner| self.matched(corner)).collect();
        let asked: Vec<usize> = (0..points.len()).filter(|i| points[*i].flag != SurfaceFlag::Undercut).collect();
        let places: Vec<[f64; 2]> = asked.iter().map(|i| self.lifted(&points[*i])).map(|tip| [tip.x, tip.y]).collect();
        watch.begin("offset surface", places.len());
        let met = self.envelope.contacts(&places, watch)?;
        let judged: Result<Vec<Vec<OffsetPoint>>, Cancelled> = asked
            .par_chunks(CHUNK)
            .zip(met.par_chunks(CHUNK))
            .map(|(asked, met)| {
                watch.advance(0)?;
                Ok(asked.iter().zip(met).map(|(i, met)| self.judged(points[*i], *met)).collect())
            })
            .collect();
        for (i, point) in asked.into_iter().zip(judged?.into_iter().flatten()) {
            points[i] = point;
        }
        Ok(points)
    }

    /// The slope-matched position, not yet judged.
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
        let (place, place_triangle) = (point, triangle);
        OffsetPoint { tip, contact: point, normal, slope, flag, depth: 0.0, place, triangle, place_triangle }
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
    fn judged(&self, point: OffsetPoint, met: Option<Contact>) -> OffsetPoint {
        let (standing, mut stand, mut met, mut hint) = (self.standing(&point), self.lifted(&point), met, None);
        let mut worst = point;
        for _ in 0..=ASIDE {
            let Some(contact) = met.filter(|contact| contact.tip > stand.z) else { return point };
            let (place, depth) = self.deepest(&contact, standing);
            if depth > worst.depth || !worst.flag.is_stopped() {
                let flag = self.stopped_flag(&point, &contact);
                worst = OffsetPoint { flag, depth, place, place_triangle: contact.triangle, ..point };
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
        let places = touched.into_iter().map(|triangle| self.deepest_from(triangle, standing));
        let measured = std::iter::once(contact.point).chain(places).map(|p| (p, self.envelope.depth(p, standing)));
        measured.fold((contact.point, f64::NEG_INFINITY), |best, other| if other.1 > best.1 { other } else { best })
    }

    /// The point of the part below the tool's own point of the same slope, walked to from a triangle up to a crease, or
    /// up to a ridge, on both sides of which it lies beyond.
    fn deepest_from(&self, triangle: u32, standing: Vector) -> Vector {
        let (mesh, mut triangle) = (self.envelope.mesh(), triangle as usize);
        let (mut place, mut before) = (standing, triangle);
        for _ in 0..WALK {
            let (corners, normal) = (mesh.corners(triangle), mesh.normal(triangle));
            let below = self.envelope.touching_point(standing, normal);
            let foot = below - normal * (below - corners[0]).dot(&normal);
            place = nearest_in_triangle(corners, foot);
            let Some(side) = side_towards(corners, foot) else { break };
            let next = self.envelope.neighbours(triangle as u32)[side] as usize;
            // where the mesh ends there is no triangle of that number
            if next >= mesh.triangles().len() || next == before || mesh.normal(next).dot(&normal) < FACET_CREASE {
                break;
            }
            (before, triangle) = (triangle, next);
        }
        place
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

#[cfg(test)]
mod tests;

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
mod tests {
    use super::*;
    use crate::offset::Index;
    use proptest::prelude::*;
    use styluscam_geometry::{kinds, ProfileDocument, ToolDocument};

    const TOLERANCE: f64 = 0.001;
    const MOST: usize = 1 << 20;

    fn ball(diameter: f64) -> Tool {
        tool(ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }))
    }

    fn tool(profile: ProfileDocument) -> Tool {
        Tool::new(ToolDocument::of(profile)).unwrap()
    }

    fn surface(mesh: &Mesh, tool: &Tool) -> OffsetSurface {
        let index = Index::new(mesh);
        let all: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
        let envelope = Envelope::new(mesh, &index, tool, None, 0.0);
        OffsetSurface::new(&envelope, tool, None, &all, TOLERANCE, MOST, &Watch::default()).unwrap()
    }

    /// A section (x, z) from left to right drawn out along Y from 0 to 60, a face to each piece of it where asked for.
    fn drawn_out(section: &[[f64; 2]], with_faces: bool) -> Mesh {
        let at = |[x, z]: [f64; 2], y: f64| Vector::new(x, y, z);
        let vertices = section.iter().flat_map(|p| [at(*p, 0.0), at(*p, 60.0)]).collect();
        let pieces = 0..section.len() as i64 - 1;
        let triangles: Vec<[i64; 3]> =
            pieces.flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]).collect();
        let faces: Vec<u32> = (0..triangles.len() as u32).map(|t| 1 + t / 2).collect();
        Mesh::new(vertices, &triangles, if with_faces { &faces } else { &[] }).unwrap()
    }

    /// A floor, a fillet and a wall of 45 degrees.
    fn filleted(radius: f64) -> Mesh {
        let arc = (0..=200).map(|i| f64::from(i) / 200.0 * std::f64::consts::FRAC_PI_4);
        let arc = arc.map(|a| [radius * libm::sin(a), radius * (1.0 - libm::cos(a))]);
        let mut section = vec![[-40.0, 0.0]];
        section.extend(arc);
        let [x, z] = section[section.len() - 1];
        section.push([x + 30.0, z + 30.0]);
        drawn_out(&section, false)
    }

    fn flags(surface: &OffsetSurface) -> Vec<SurfaceFlag> {
        let mut flags: Vec<SurfaceFlag> = surface.points.iter().map(|p| p.flag).collect();
        flags.sort_unstable();
        flags.dedup();
        flags
    }

    fn at(surface: &OffsetSurface, x: f64, z: f64) -> OffsetPoint {
        let near = |p: &&OffsetPoint| (p.contact.x - x).abs() < 1e-9 && (p.contact.z - z).abs() < 1e-9;
        *surface.points.iter().find(near).unwrap()
    }

    #[test]
    fn a_fillet_that_runs_into_a_floor_is_bridged_by_a_larger_tool_and_followed_by_a_smaller() {
        assert_eq!(flags(&surface(&filleted(4.0), &ball(6.0))), [SurfaceFlag::Contact]);
        let bridged = surface(&filleted(2.0), &ball(6.0));
        assert_eq!(flags(&bridged), [SurfaceFlag::Contact, SurfaceFlag::Bridged]);
        let [sin, cos] = [libm::sin(22.5_f64.to_radians()), libm::cos(22.5_f64.to_radians())];
        let middle = at(&bridged, 2.0 * sin, 2.0 * (1.0 - cos));
        // the ball enters the floor and the wall, which are tangents of the arc, about equally deep
        let centre = middle.contact + middle.normal * 3.0;
        let over_wall = (centre.z - centre.x) * 0.5_f64.sqrt() + 2.0 - 2.0_f64.sqrt();
        assert_eq!(middle.flag, SurfaceFlag::Bridged);
        assert!((middle.depth - (3.0 - centre.z.min(over_wall))).abs() < 1e-5, "{} {centre:?}", middle.depth);
    }

    #[test]
    fn a_sharp_inner_corner_interferes_with_and_without_faces() {
        let valley = [[-20.0, 20.0], [-1.0, 1.0], [0.0, 0.0], [1.0, 0.0], [30.0, 0.0]];
        for with_faces in [false, true] {
            let found = surface(&drawn_out(&valley, with_faces), &ball(6.0));
            let corner = at(&found, 1.0, 0.0);
            assert_eq!(corner.flag, SurfaceFlag::Interferes, "{with_faces}");
            // the ball's centre stands over (1, 3): 4 / sqrt 2 from the wall
            assert!((corner.depth - (3.0 - 8.0_f64.sqrt())).abs() < 1e-6, "{}", corner.depth);
            assert!((corner.place.x + corner.place.z).abs() < 1e-9 && corner.place.x < -1.0 + 1e-3);
            assert_eq!(at(&found, 30.0, 0.0).flag, SurfaceFlag::Contact);
        }
    }

    /// A floor with points every half millimetre that ends at an upright wall of some height.
    fn with_wall(height: f64) -> Mesh {
        let mut section: Vec<[f64; 2]> = (0..=40).map(|i| [0.5 * f64::from(i) - 20.0, 0.0]).collect();
        section.extend((1..=40).map(|i| [0.0, height * f64::from(i) / 40.0]));
        section.push([20.0, height]);
        drawn_out(&section, false)
    }

    #[test]
    fn a_step_beside_the_point_interferes_as_deep_as_the_tool_would_enter_it() {
        let found = surface(&with_wall(20.0), &ball(6.0));
        for i in 0..12 {
            let x = 0.5 * f64::from(i) - 6.0;
            let point = at(&found, x, 0.0);
            if x > -3.0 {
                assert_eq!(point.flag, SurfaceFlag::Interferes, "{x}");
                assert!((point.depth - (3.0 + x)).abs() < 1e-6, "{x} {}", point.depth);
                assert!(point.place.x.abs() < 1e-9, "{x}");
            } else {
                assert_eq!((point.flag, point.depth), (SurfaceFlag::Contact, 0.0), "{x}");
            }
        }
    }

    #[test]
    fn an_upright_wall_is_touched_by_the_base_down_to_where_the_tip_meets_the_floor() {
        let found = surface(&with_wall(20.0), &ball(6.0));
        for i in 1..40 {
            let z = 0.5 * f64::from(i);
            let walls: Vec<&OffsetPoint> =
                found.points.iter().filter(|p| p.normal.x < -0.5 && (p.contact.z - z).abs() < 1e-9).collect();
            assert!(!walls.is_empty());
            for point in walls {
                assert!((point.tip - Vector::new(-3.0, point.contact.y, z - 3.0)).norm() < 1e-12);
                if z < 3.0 {
                    assert_eq!(point.flag, SurfaceFlag::Interferes, "{z}");
                    assert!((point.depth - (3.0 - z)).abs() < 1e-6, "{z} {}", point.depth);
                    assert!(point.place.z.abs() < 1e-9);
                } else {
                    assert_eq!(point.flag, SurfaceFlag::Contact, "{z}");
                }
            }
        }
    }

    #[test]
    fn walls_beside_the_tool_do_not_hide_what_it_enters() {
        // lifted off one wall by the tolerance the tool grazes the other, and it enters the ridge on the floor
        let gap = 6.0 + 0.5 * TOLERANCE;
        let section = [[-20.0, 30.0], [0.0, 30.0], [0.0, 0.0], [1.5, 0.0], [3.0, 0.1], [4.5, 0.0], [gap, 0.0]];
        let found = surface(&drawn_out(&[&section[..], &[[gap, 30.0], [26.0, 30.0]]].concat(), false), &ball(6.0));
        let wall = found.points.iter().find(|p| p.normal.x > 0.5 && p.contact.z == 0.0).unwrap();
        assert!((wall.tip.z + 3.0).abs() < 1e-12);
        assert_eq!(wall.flag, SurfaceFlag::Interferes);
        // its nearest way out of there is to the side
        assert!((wall.depth - 3.0).abs() < 1e-2, "{}", wall.depth);
    }

    #[test]
    fn steeper_than_the_profile_is_rim_and_what_looks_down_is_undercut() {
        let shallow = tool(ProfileDocument::from(kinds::Clothoid {
            diameter: None,
            scale: Some(30.0),
            end_slope_deg: Some(40.0),
            tip_flat: 0.0,
        }));
        let found = surface(&drawn_out(&[[-30.0, 30.0], [0.0, 0.0], [-5.0, -20.0]], true), &shallow);
        assert_eq!(flags(&found), [SurfaceFlag::Rim, SurfaceFlag::Undercut]);
        for point in &found.points {
            assert_eq!(point.flag == SurfaceFlag::Undercut, point.normal.z < 0.0);
            assert_eq!(point.place, point.contact);
        }
    }

    #[test]
    fn normals_of_the_model_move_the_tool_and_part_the_patches() {
        let (vertices, triangles) = (filleted(4.0).vertices().to_vec(), filleted(4.0).triangles().to_vec());
        let names: Vec<[i64; 3]> = triangles.iter().map(|t| t.map(i64::from)).collect();
        let exact = |p: Vector| {
            let angle = libm::asin((p.x / 4.0).clamp(0.0, libm::sin(std::f64::consts::FRAC_PI_4)));
            Vector::new(-libm::sin(angle), 0.0, libm::cos(angle))
        };
        let normals: Vec<[Vector; 3]> = triangles.iter().map(|t| t.map(|i| exact(vertices[i as usize]))).collect();
        let mesh = Mesh::with_normals(vertices, &names, &[], &normals).unwrap();
        let found = surface(&mesh, &ball(6.0));
        assert_eq!(found.points.len(), mesh.vertices().len());
        for point in &found.points {
            let centre = point.contact + exact(point.contact) * 3.0;
            assert!((point.tip + Vector::z() * 3.0 - centre).norm() < 1e-9);
        }
        assert_eq!(flags(&found), [SurfaceFlag::Contact]);
        assert_eq!(flags(&surface(&mesh, &ball(12.0))), [SurfaceFlag::Contact, SurfaceFlag::Bridged]);
    }

    #[test]
    fn a_slight_crease_shows_only_in_normals_of_the_model() {
        let bare = drawn_out(&[[-30.0, 0.0], [0.0, 0.0], [30.0, 5.3]], false);
        assert_eq!(flags(&surface(&bare, &ball(6.0))), [SurfaceFlag::Contact, SurfaceFlag::Bridged]);
        let names: Vec<[i64; 3]> = bare.triangles().iter().map(|t| t.map(i64::from)).collect();
        let normals: Vec<[Vector; 3]> = (0..names.len()).map(|t| [bare.normal(t); 3]).collect();
        let known = Mesh::with_normals(bare.vertices().to_vec(), &names, &[], &normals).unwrap();
        assert_eq!(flags(&surface(&known, &ball(6.0))), [SurfaceFlag::Contact, SurfaceFlag::Interferes]);
    }

    #[test]
    fn the_regions_share_out_the_area() {
        let mesh = with_wall(20.0);
        let found = surface(&mesh, &ball(6.0));
        let regions = found.regions(&mesh);
        let whole: f64 = (0..mesh.triangles().len()).map(|t| mesh.area(t)).sum();
        assert!((regions.iter().map(|r| r.area).sum::<f64>() - whole).abs() < 1e-9 * whole);
        let [contact, interferes] = regions[..] else { panic!("{regions:?}") };
        assert_eq!((contact.flag, interferes.flag), (SurfaceFlag::Contact, SurfaceFlag::Interferes));
        // 3 mm of the floor and 3 mm of the wall are stopped, to half a row of triangles each
        assert!((interferes.area - 360.0).abs() < 60.0, "{}", interferes.area);
        assert!((interferes.worst.depth - 3.0).abs() < 1e-6);
    }

    #[test]
    fn the_base_enters_a_steep_wall_however_it_is_cut_into_triangles() {
        // the rim touches the wall high up first, in one of its triangles, and would enter it deepest in the other
        let tool = tool(ProfileDocument::from(kinds::Ball { diameter: 6.0, radius: Some(3.1), tip_flat: 0.0 }));
        let found = surface(&drawn_out(&[[0.0, 10.0], [9.0, 10.0], [10.8, 0.0], [40.0, 0.0]], true), &tool);
        let rim = tool.point_at(tool.profile().max_slope());
        let normal = Vector::new(10.0, 0.0, 1.8).normalize();
        for point in found.points.iter().filter(|p| p.normal.z > 0.99 && p.contact.z < 1e-9) {
            let depth = -Vector::new(point.contact.x - rim.0 - 10.8, 0.0, rim.1).dot(&normal);
            assert_eq!(point.flag.is_stopped(), depth > TOLERANCE, "{depth} {point:?}");
            // deep inside, the base's side is nearer than the rim
            assert!(depth < TOLERANCE || (0.95 * depth..depth + 1e-6).contains(&point.depth), "{depth} {point:?}");
        }
    }

    #[test]
    fn large_triangles_are_split_where_something_stops_the_tool() {
        // two triangles of floor, two of wall, two on top: every corner of the floor but two stands at the wall
        let mesh = drawn_out(&[[-20.0, 0.0], [0.0, 0.0], [0.0, 20.0], [20.0, 20.0]], true);
        let found = surface(&mesh, &ball(6.0));
        let area = |face, flag| found.regions(&mesh).iter().find(|r| r.face == face && r.flag == flag).map(|r| r.area);
        for face in [1, 2] {
            let [contact, interferes] = [SurfaceFlag::Contact, SurfaceFlag::Interferes].map(|f| area(face, f).unwrap());
            assert!((contact + interferes - 1200.0).abs() < 1e-9);
            assert!((interferes - 180.0).abs() < 25.0, "{face} {interferes}");
        }
        assert_eq!(area(3, SurfaceFlag::Interferes), None);
        let sides = |corners: &[u32; 3]| corners.map(|i| found.points[i as usize].contact);
        for corners in found.triangles.iter().map(sides) {
            assert!((corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm() > 0.0);
        }
    }

    #[test]
    fn it_can_be_cancelled() {
        let mesh = with_wall(20.0);
        let (index, tool, watch) = (Index::new(&mesh), ball(6.0), Watch::default());
        watch.cancel();
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
        assert_eq!(OffsetSurface::new(&envelope, &tool, None, &[0], TOLERANCE, MOST, &watch), Err(Cancelled));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn what_is_free_enters_nothing_and_what_is_stopped_enters_its_place(
            heights in prop::collection::vec(prop_oneof![0.0..4.0_f64, Just(1.0)], 42),
            kind in 0..3_u8,
            margin in prop_oneof![Just(0.0), 0.0..0.5_f64],
        ) {
            let tool = match kind {
                0 => tool(ProfileDocument::from(kinds::Clothoid {
                    diameter: Some(3.0),
                    scale: None,
                    end_slope_deg: None,
                    tip_flat: 0.1,
                })),
                1 => tool(ProfileDocument::from(kinds::Parabola { apex_radius: 2.0, diameter: 2.4, tip_flat: 0.0 })),
                _ => ball(2.0),
            };
            let mesh = terrain(&heights, 7);
            let index = Index::new(&mesh);
            let all: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
            let envelope = Envelope::new(&mesh, &index, &tool, None, margin);
            let found = OffsetSurface::new(&envelope, &tool, None, &all, TOLERANCE, MOST, &Watch::default()).unwrap();
            let body = tool.cutter_with(None, margin);
            let depth = |p: Vector, point: &OffsetPoint| {
                let tip = point.tip + point.normal * margin - Vector::z() * margin;
                -body.distance(libm::hypot(p.x - tip.x, p.y - tip.y), p.z - tip.z).0
            };
            for point in found.points.iter().step_by(1 + found.points.len() / 80) {
                let deepest = all.iter().flat_map(|t| samples(mesh.corners(*t as usize))).map(|p| depth(p, point));
                let deepest = deepest.fold(f64::NEG_INFINITY, f64::max);
                if point.flag.is_stopped() {
                    prop_assert!(depth(point.place, point) > point.depth - 1e-6);
                } else {
                    prop_assert!(deepest < FARTHEST * TOLERANCE, "{point:?} {deepest}");
                }
            }
        }
    }

    fn terrain(heights: &[f64], columns: usize) -> Mesh {
        let place = |i: usize| Vector::new((i % columns) as f64, (i / columns) as f64, heights[i]);
        let triangles: Vec<[i64; 3]> = (0..heights.len() - columns)
            .filter(|i| (i + 1) % columns != 0)
            .map(|i| [i, i + 1, i + columns, i + columns + 1].map(|k| k as i64))
            .flat_map(|[a, b, c, d]| [[a, b, c], [b, d, c]])
            .collect();
        Mesh::new((0..heights.len()).map(place).collect(), &triangles, &[]).unwrap()
    }

    fn samples([a, b, c]: [Vector; 3]) -> Vec<Vector> {
        let shares = (0..=5).flat_map(|i| (0..=5 - i).map(move |j| (f64::from(i) / 5.0, f64::from(j) / 5.0)));
        shares.map(|(s, t)| a + (b - a) * s + (c - a) * t).collect()
    }

    #[test]
    fn flags_have_their_numbers() {
        let names: Vec<&str> = SurfaceFlag::ALL.iter().map(|f| f.name()).collect();
        assert_eq!(names, ["contact", "bridged", "interferes", "rim", "undercut"]);
        assert!(SurfaceFlag::ALL.iter().enumerate().all(|(i, flag)| *flag as usize == i));
    }
}

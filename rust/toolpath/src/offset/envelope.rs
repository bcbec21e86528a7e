//! The gouge-free envelope: how deep the tool's tip may go at a place, exactly, for any convex profile.
//!
//! The tip height at (x, y) is the largest over all triangles of three contacts: facet (the profile's point of
//! equal slope), edge and vertex. A tree of boxes with planes over them rules out nearly all triangles.

use rayon::prelude::*;
use styluscam_geometry::{Bvh, Cutter, Mesh, Node, Sheet, Tool, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::edge;
use super::features::{self, Neighbours, Owned, NO_NEIGHBOUR};

/// Triangles that a walk from the last contact crosses at most.
const WALK: usize = 512;
/// Points handed to a thread at a time: fixed, so that the answer does not depend on the threads.
const CHUNK: usize = 256;
/// Facets closer to vertical than this share of their normal have no facet contact worth its rounding.
const WALL: f64 = 1e-9;
/// A contact this share of the part's size outside its facet still counts: flat edges are not tried, and rounding
/// must not let a contact fall between two facets. The height is wrong by less than this.
const OVERHANG: f64 = 1e-13;
/// Tips that differ by less than this share of the part's size are equal: a search does not go on for less. Triangles of
/// one plane would all be visited otherwise.
const SLACK: f64 = 1e-12;

/// The tool's lowest free position over a place, and what it touches there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Height of the tool's tip, mm.
    pub tip: f64,
    /// The point of the mesh that is touched.
    pub point: Vector,
    /// Unit normal of the tool there, into the tool: the direction in which it comes free.
    pub normal: Vector,
    /// Triangle touched, the first of equals.
    pub triangle: u32,
    /// Whether the contact lies on the facet, on an edge (0 to 2), or on a corner (3 to 5).
    feature: u8,
}

impl Contact {
    /// Slope of the contact, rad.
    #[must_use]
    pub fn slope(&self) -> f64 {
        libm::atan2(self.normal.x.hypot(self.normal.y), self.normal.z)
    }
}

/// A facet made ready for one cutter.
#[derive(Clone, Copy)]
struct Facet {
    /// Corner 0.
    origin: Vector,
    /// Contact relative to the axis, in plan.
    offset: [f64; 2],
    /// The facet's gradient dz/dx, dz/dy.
    gradient: [f64; 2],
    /// Barycentric coordinates: rows of the inverse of (corner 1 - corner 0, corner 2 - corner 0) in plan.
    inverse: [[f64; 2]; 2],
    /// Height of the profile at the contact; NaN for walls: they have no facet contact.
    height: f64,
    slope: f64,
    /// How far outside the triangle a contact still counts, in barycentric coordinates.
    overhang: [f64; 3],
}

/// The plane over a node, made ready for one cutter.
#[derive(Clone, Copy)]
struct NodePlane {
    gradient: [f64; 2],
    /// Where the cutter would touch the plane, relative to the axis, in plan.
    offset: [f64; 2],
    /// Tip height over (0, 0) with the cutter on the plane: no tip in the node is above it.
    lift: f64,
    /// What of `lift` is the cutter's: tip over the plane at the axis.
    peak: f64,
}

/// A mesh and a tool (with sheet and margin), ready to be asked.
pub struct Envelope<'a> {
    mesh: &'a Mesh,
    bvh: &'a Bvh,
    cutter: Cutter,
    /// The tool's tip over the cutter's.
    above: f64,
    /// What the cutter is grown by beyond tool and sheet.
    margin: f64,
    facets: Vec<Facet>,
    planes: Vec<NodePlane>,
    owned: Vec<Owned>,
    neighbours: Vec<Neighbours>,
    slack: f64,
}

#[derive(Clone, Copy)]
struct Best {
    tip: f64,
    triangle: u32,
    feature: u8,
    contact: [f64; 2],
    slope: f64,
}

const FACET: u8 = u8::MAX;
const NOTHING: Best =
    Best { tip: f64::NEG_INFINITY, triangle: u32::MAX, feature: FACET, contact: [0.0; 2], slope: 0.0 };

impl<'a> Envelope<'a> {
    /// The envelope of `tool` over `mesh` with `sheet` between them, kept `margin` mm clear along the normal.
    #[must_use]
    pub fn new(mesh: &'a Mesh, bvh: &'a Bvh, tool: &Tool, sheet: Option<&Sheet>, margin: f64) -> Self {
        let cutter = tool.cutter_with(sheet, margin);
        let (low, high) = mesh.bounds();
        let reach = low.amax().max(high.amax()) + cutter.max_radius();
        let facets = (0..mesh.triangles().len())
            .into_par_iter()
            .map(|t| Facet::of(mesh, t, &cutter, OVERHANG * reach))
            .collect();
        let planes = bvh.nodes().par_iter().map(|node| NodePlane::of(node, &cutter)).collect();
        let (owned, neighbours) = features::of(mesh);
        let slack = SLACK * reach;
        Self {
            mesh,
            bvh,
            cutter,
            above: Tool::tip_above(sheet, margin),
            margin,
            facets,
            planes,
            owned,
            neighbours,
            slack,
        }
    }

    /// The cutter: tool, sheet and margin as one.
    #[must_use]
    pub fn cutter(&self) -> &Cutter {
        &self.cutter
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        self.mesh
    }

    /// The contact at (x, y), or none where the tool meets nothing.
    #[must_use]
    pub fn contact(&self, x: f64, y: f64) -> Option<Contact> {
        self.contact_near(x, y, &mut None)
    }

    /// As [`contact`](Self::contact), quicker when `hint` holds the triangle touched by a neighbouring point; it is
    /// left holding this one's. Another hint changes the tip by less than 1e-12 of the part's size.
    #[must_use]
    pub fn contact_near(&self, x: f64, y: f64, hint: &mut Option<u32>) -> Option<Contact> {
        let mut found = NOTHING;
        self.try_triangle(self.walked(hint.unwrap_or(0), x, y), x, y, &mut found);
        let start = found.tip;
        self.bvh.maximise(
            start,
            |index, node, best| self.bound(index, node, x, y, best),
            |triangle, _| {
                self.try_triangle(triangle, x, y, &mut found);
                found.tip
            },
        );
        (found.triangle != u32::MAX).then(|| {
            *hint = Some(found.triangle);
            self.contact_of(&found, x, y)
        })
    }

    /// Tip heights at many places, in parallel; NaN where the tool meets nothing.
    ///
    /// # Errors
    /// `Cancelled` when `watch` says so.
    pub fn tips(&self, places: &[[f64; 2]], watch: &Watch) -> Result<Vec<f64>, Cancelled> {
        self.map_places(places, watch, |contact| contact.map_or(f64::NAN, |c| c.tip))
    }

    /// Contacts at many places, in parallel.
    ///
    /// # Errors
    /// `Cancelled` when `watch` says so.
    pub fn contacts(&self, places: &[[f64; 2]], watch: &Watch) -> Result<Vec<Option<Contact>>, Cancelled> {
        self.map_places(places, watch, |contact| contact)
    }

    fn map_places<T: Send>(
        &self,
        places: &[[f64; 2]],
        watch: &Watch,
        keep: impl Fn(Option<Contact>) -> T + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        let chunks: Result<Vec<Vec<T>>, Cancelled> = places
            .par_chunks(CHUNK)
            .map(|chunk| {
                let mut hint = None;
                let kept = chunk.iter().map(|[x, y]| keep(self.contact_near(*x, *y, &mut hint))).collect();
                watch.advance(chunk.len())?;
                Ok(kept)
            })
            .collect();
        Ok(chunks?.into_iter().flatten().collect())
    }

    /// From a triangle towards the one that holds its own contact: a good first tip makes the search short.
    fn walked(&self, from: u32, x: f64, y: f64) -> u32 {
        let mut triangle = from;
        for _ in 0..WALK {
            let Some(edge) = self.facets[triangle as usize].beyond(x, y) else { break };
            match self.neighbours[triangle as usize][edge] {
                NO_NEIGHBOUR => break,
                next => triangle = next,
            }
        }
        triangle
    }

    /// A tip height that no triangle of the node exceeds by more than the slack, or any below `best`.
    #[inline]
    fn bound(&self, index: usize, node: &Node, x: f64, y: f64, best: f64) -> f64 {
        let plane = &self.planes[index];
        let free = plane.lift + plane.gradient[0] * x + plane.gradient[1] * y - self.slack;
        if free < best {
            return free;
        }
        let dx = (node.low.x - x).max(x - node.high.x).max(0.0);
        let dy = (node.low.y - y).max(y - node.high.y).max(0.0);
        let by_box = node.high.z - self.cutter.height_bound((dx * dx + dy * dy).sqrt()) - self.slack;
        if by_box < best {
            return by_box;
        }
        by_box.min(free).min(self.bound_in_box(plane, node, x, y) - self.slack)
    }

    /// For a point p of the node under a plane of gradient g, tip <= plane(p) - Z(|p - axis|). The best p of the plane
    /// is where the profile has slope g; clamped into the box (q), the function, concave in p, lies
    /// below its tangent at q. Z is replaced by a line below it, which only raises the bound.
    #[inline]
    fn bound_in_box(&self, plane: &NodePlane, node: &Node, x: f64, y: f64) -> f64 {
        let [gx, gy] = plane.gradient;
        let px = (x + plane.offset[0]).clamp(node.low.x, node.high.x);
        let py = (y + plane.offset[1]).clamp(node.low.y, node.high.y);
        let (rx, ry) = (px - x, py - y);
        let distance = (rx * rx + ry * ry).sqrt();
        let line = self.cutter.supporting_line(distance);
        let fall = if distance > 0.0 { line.rise / distance } else { 0.0 };
        let (tx, ty) = (gx - fall * rx, gy - fall * ry);
        let rest_x = if tx > 0.0 { node.high.x - px } else { node.low.x - px };
        let rest_y = if ty > 0.0 { node.high.y - py } else { node.low.y - py };
        let height = plane.lift - plane.peak + gx * px + gy * py;
        height - (line.height + line.rise * (distance - line.radius)) + tx * rest_x + ty * rest_y
    }

    #[inline]
    fn try_triangle(&self, triangle: u32, x: f64, y: f64, found: &mut Best) {
        let facet = &self.facets[triangle as usize];
        if facet.settles(x, y, triangle, found) {
            return;
        }
        let corners = self.mesh.corners(triangle as usize);
        for (i, corner) in corners.into_iter().enumerate() {
            self.try_vertex(corner, triangle, 3 + i as u8, x, y, found);
        }
        let owned = self.owned[triangle as usize];
        for i in 0..3 {
            if owned & (1 << i) != 0 {
                let (a, b) = (corners[i], corners[(i + 1) % 3]);
                if let Some(touch) = edge::touch(&self.cutter, a, b, x, y, found.tip) {
                    let contact = [a.x + touch.share * (b.x - a.x), a.y + touch.share * (b.y - a.y)];
                    found.improve(Best { tip: touch.tip, triangle, feature: i as u8, contact, slope: touch.slope });
                }
            }
        }
    }

    #[inline]
    fn try_vertex(&self, corner: Vector, triangle: u32, feature: u8, x: f64, y: f64, found: &mut Best) {
        let (dx, dy) = (corner.x - x, corner.y - y);
        let distance = (dx * dx + dy * dy).sqrt();
        if distance > self.cutter.max_radius() || corner.z - self.cutter.height_bound(distance) < found.tip {
            return;
        }
        let tip = corner.z - self.cutter.height_at_radius(distance);
        if tip >= found.tip {
            let slope = self.cutter.slope_at_radius(distance);
            found.improve(Best { tip, triangle, feature, contact: [corner.x, corner.y], slope });
        }
    }

    /// Distance from a point of the mesh to tool and sheet, without the margin, their tip standing at `tip` over (x, y), mm.
    #[must_use]
    pub fn gap(&self, point: Vector, x: f64, y: f64, tip: f64) -> f64 {
        let height = point.z - (tip - self.above);
        self.cutter.distance(libm::hypot(point.x - x, point.y - y), height).0 + self.margin
    }

    fn contact_of(&self, best: &Best, x: f64, y: f64) -> Contact {
        let (sin, cos) = libm::sincos(best.slope);
        let [cx, cy] = best.contact;
        let distance = libm::hypot(x - cx, y - cy);
        let outward = if distance > 0.0 { [(x - cx) / distance, (y - cy) / distance] } else { [0.0; 2] };
        let height = best.tip + self.cutter.point_at(best.slope).1;
        Contact {
            tip: best.tip + self.above,
            point: Vector::new(cx, cy, height),
            normal: Vector::new(sin * outward[0], sin * outward[1], cos),
            triangle: best.triangle,
            feature: best.feature,
        }
    }

    /// Whether the contact belongs to triangles that `selected` accepts, all of those that meet there.
    ///
    /// Rolling over an edge or corner between selected and other faces, the contact belongs to the selected one while
    /// its normal is within `spread` (rad) of the selected facet's.
    #[must_use]
    pub fn belongs(&self, contact: &Contact, selected: &[bool], spread: f64) -> bool {
        let t = contact.triangle as usize;
        let on = |t: u32| t != NO_NEIGHBOUR && selected[t as usize];
        match contact.feature {
            FACET => on(contact.triangle),
            i @ 0..=2 => {
                let other = self.neighbours[t][i as usize];
                (on(contact.triangle) && on(other))
                    || self.faces_like([contact.triangle, other], contact, selected, spread)
            }
            _ => self.faces_like(self.around(contact), contact, selected, spread),
        }
    }

    /// Triangles around the corner touched, found through the edges of the one that was asked; where the mesh ends
    /// there, [`NO_NEIGHBOUR`] is among them.
    fn around(&self, contact: &Contact) -> Vec<u32> {
        let vertex = self.mesh.triangles()[contact.triangle as usize][usize::from(contact.feature - 3).min(2)];
        let mut fan = vec![contact.triangle];
        let mut next = 0;
        while next < fan.len() {
            let triangle = fan[next];
            next += 1;
            if triangle == NO_NEIGHBOUR {
                continue;
            }
            let corners = self.mesh.triangles()[triangle as usize];
            for (i, neighbour) in self.neighbours(triangle).into_iter().enumerate() {
                let meets = corners[i] == vertex || corners[(i + 1) % 3] == vertex;
                if meets && !fan.contains(&neighbour) {
                    fan.push(neighbour);
                }
            }
        }
        fan
    }

    /// The triangles beyond the three edges of one; `u32::MAX` where the mesh ends.
    #[must_use]
    pub fn neighbours(&self, triangle: u32) -> Neighbours {
        self.neighbours[triangle as usize]
    }

    /// Whether the contact's normal lies within `spread` of a selected triangle's, or all triangles are selected.
    fn faces_like(
        &self,
        triangles: impl IntoIterator<Item = u32>,
        contact: &Contact,
        selected: &[bool],
        spread: f64,
    ) -> bool {
        let (mut all, mut near) = (true, false);
        for t in triangles {
            let on = t != NO_NEIGHBOUR && selected[t as usize];
            all &= on;
            near |= on && self.mesh.normal(t as usize).dot(&contact.normal) >= libm::cos(spread);
        }
        all || near
    }
}

impl Best {
    /// Takes the higher; of equals the first triangle, so that the order of search does not show.
    #[inline]
    fn improve(&mut self, other: Self) {
        if other.tip > self.tip || (other.tip >= self.tip && other.triangle < self.triangle) {
            *self = other;
        }
    }
}

impl NodePlane {
    fn of(node: &Node, cutter: &Cutter) -> Self {
        let [gx, gy] = node.gradient;
        let steepness = (gx * gx + gy * gy).sqrt();
        let (r, z) = cutter.point_at(libm::atan(steepness));
        let share = if steepness > 0.0 { r / steepness } else { 0.0 };
        let [mx, my] = node.middle();
        let peak = steepness * r - z;
        Self {
            gradient: node.gradient,
            offset: [share * gx, share * gy],
            lift: node.lift - gx * mx - gy * my + peak,
            peak,
        }
    }
}

impl Facet {
    fn of(mesh: &Mesh, triangle: usize, cutter: &Cutter, overhang: f64) -> Self {
        let [a, b, c] = mesh.corners(triangle);
        let (u, v) = (b - a, c - a);
        let mut normal = u.cross(&v);
        normal /= normal.norm();
        if normal.z < 0.0 {
            normal = -normal; // a tool from above meets the upper side of the point set
        }
        let across = libm::hypot(normal.x, normal.y);
        let slope = libm::atan2(across, normal.z);
        let (r, height) = cutter.point_at(slope);
        let outward = if across > 0.0 { [normal.x / across, normal.y / across] } else { [0.0; 2] };
        let determinant = u.x * v.y - u.y * v.x;
        let wall = normal.z < WALL;
        Self {
            origin: a,
            offset: [-r * outward[0], -r * outward[1]],
            gradient: [-normal.x / normal.z, -normal.y / normal.z],
            inverse: [[v.y / determinant, -v.x / determinant], [-u.y / determinant, u.x / determinant]],
            height: if wall { f64::NAN } else { height },
            slope,
            overhang: [v, u, v - u].map(|side| overhang * libm::hypot(side.x, side.y) / determinant.abs()),
        }
    }

    /// The edge beyond which the facet's contact lies; none when it lies inside.
    fn beyond(&self, x: f64, y: f64) -> Option<usize> {
        let (dx, dy) = (x + self.offset[0] - self.origin.x, y + self.offset[1] - self.origin.y);
        let s = self.inverse[0][0] * dx + self.inverse[0][1] * dy;
        let t = self.inverse[1][0] * dx + self.inverse[1][1] * dy;
        let sides = [t, 1.0 - s - t, s];
        (0..3).filter(|i| sides[*i] < 0.0).min_by(|i, j| sides[*i].total_cmp(&sides[*j]))
    }

    /// Tries the facet's contact; true when nothing else of the triangle can be higher.
    ///
    /// The contact with the facet's whole plane is at least as high as any with the triangle: that settles most.
    #[inline]
    fn settles(&self, x: f64, y: f64, triangle: u32, found: &mut Best) -> bool {
        let contact = [x + self.offset[0], y + self.offset[1]];
        let (dx, dy) = (contact[0] - self.origin.x, contact[1] - self.origin.y);
        let tip = self.origin.z + self.gradient[0] * dx + self.gradient[1] * dy - self.height;
        if tip < found.tip {
            return true; // never for a wall: its height is NaN
        }
        let s = self.inverse[0][0] * dx + self.inverse[0][1] * dy;
        let t = self.inverse[1][0] * dx + self.inverse[1][1] * dy;
        let [es, et, er] = self.overhang;
        let inside = s >= -es && t >= -et && s + t <= 1.0 + er && !self.height.is_nan();
        if inside {
            found.improve(Best { tip, triangle, feature: FACET, contact, slope: self.slope });
        }
        inside
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use styluscam_geometry::{ModelFace, ProfileDocument, SheetLaw, ToolDocument};

    fn tool(clothoid: bool, diameter: f64, tip_flat: f64) -> Tool {
        of(if clothoid {
            ProfileDocument::Clothoid { diameter: Some(diameter), scale: None, end_slope_deg: None, tip_flat }
        } else {
            ProfileDocument::Ball { diameter, radius: None, tip_flat }
        })
    }

    fn of(profile: ProfileDocument) -> Tool {
        Tool::new(ToolDocument::of(profile)).unwrap()
    }

    /// Tools of diameter 12 with curves, kinks, cones and flats.
    fn any_tool() -> impl Strategy<Value = Tool> {
        let diameter = 12.0;
        let flat = prop_oneof![Just(0.0), 0.1..2.0_f64];
        (0..12_u8, 0.05..0.95_f64, 0.05..0.95_f64, flat).prop_map(move |(kind, a, b, tip_flat)| {
            let beyond = 0.5 * diameter - tip_flat;
            of(match kind {
                0 => ProfileDocument::Ball { diameter, radius: None, tip_flat },
                1 => ProfileDocument::Ball { diameter, radius: Some(beyond / a), tip_flat },
                2 => {
                    let end_slope_deg = Some(90.0 * a);
                    ProfileDocument::Clothoid { diameter: Some(diameter), scale: None, end_slope_deg, tip_flat }
                }
                3 => ProfileDocument::Parabola { apex_radius: 12.0 * a, diameter, tip_flat },
                4 => ProfileDocument::Ellipse { radial: 6.0, axial: 12.0 * b, diameter: None, tip_flat },
                5 => ProfileDocument::Cycloid { diameter, tip_flat },
                6 => ProfileDocument::Power { coefficient: 0.1 * a, exponent: 1.2 + 2.0 * b, diameter, tip_flat },
                7 => ProfileDocument::BullNose { diameter, corner_radius: beyond * a, tip_flat },
                8 => ProfileDocument::Barrel { diameter, radius: beyond / a, tip_radius: beyond * b, tip_flat },
                9 => ProfileDocument::Cone { tip_radius: 0.0, half_angle_deg: 10.0 + 75.0 * a, diameter, tip_flat },
                10 => {
                    let tip_radius = beyond * a;
                    ProfileDocument::TaperedBall { tip_radius, half_angle_deg: 10.0 + 75.0 * b, diameter, tip_flat }
                }
                _ => ProfileDocument::Flat { diameter, tip_flat: 0.0 },
            })
        })
    }

    /// The highest tip over a triangle by nested golden sections of the concave height: no facet, edge or vertex.
    fn searched(corners: [Vector; 3], cutter: &Cutter, x: f64, y: f64) -> f64 {
        let [a, b, c] = corners;
        let height = |s: f64, t: f64| {
            let p = a + (b - a) * s + (c - a) * (t * (1.0 - s));
            p.z - cutter.height_at_radius((p.x - x).hypot(p.y - y))
        };
        golden(|s| golden(|t| height(s, t)))
    }

    fn golden(f: impl Fn(f64) -> f64) -> f64 {
        let ratio = 0.618_033_988_749_894_9;
        let (mut low, mut high) = (0.0, 1.0);
        let mut best = f(0.0).max(f(1.0));
        for _ in 0..64 {
            let (p, q) = (high - ratio * (high - low), low + ratio * (high - low));
            let (fp, fq) = (f(p), f(q));
            best = best.max(fp).max(fq);
            if fp < fq {
                low = p;
            } else {
                high = q;
            }
        }
        best
    }

    fn single(corners: [Vector; 3]) -> Mesh {
        Mesh::new(corners.to_vec(), &[[0, 1, 2]], &[]).unwrap()
    }

    /// A mesh with hills, valleys, walls and flats.
    fn terrain(heights: &[f64], columns: usize) -> Mesh {
        let rows = heights.len() / columns;
        let vertices: Vec<Vector> = heights
            .iter()
            .enumerate()
            .map(|(i, z)| Vector::new((i % columns) as f64, (i / columns) as f64, *z))
            .collect();
        let mut triangles = Vec::new();
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let i = (row * columns + column) as i64;
                let n = columns as i64;
                triangles.extend([[i, i + 1, i + n], [i + 1, i + n + 1, i + n]]);
            }
        }
        Mesh::new(vertices, &triangles, &[]).unwrap()
    }

    proptest! {
        #[test]
        fn one_triangle_is_touched_at_the_height_that_a_search_finds(
            points in prop::array::uniform9(-3.0..3.0_f64),
            tool in any_tool(),
            sheet in prop_oneof![Just(0.0), 0.1..2.0_f64],
        ) {
            let p = points;
            let corners = [Vector::new(p[0], p[1], p[2]), Vector::new(p[3], p[4], p[5]), Vector::new(p[6], p[7], p[8])];
            prop_assume!((corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm() > 1e-3);
            let mesh = single(corners);
            let bvh = Bvh::new(&mesh);
            let envelope = Envelope::new(&mesh, &bvh, &tool, None, sheet);
            let tip = envelope.contact(0.0, 0.0).unwrap().tip - sheet;
            let truth = searched(corners, envelope.cutter(), 0.0, 0.0);
            prop_assert!((tip - truth).abs() < 1e-9, "{tip} {truth}");
        }

        #[test]
        fn the_tree_and_the_dropped_edges_lose_nothing(
            heights in prop::collection::vec(prop_oneof![0.0..4.0_f64, Just(1.0)], 42),
            x in -2.0..8.0_f64,
            y in -2.0..7.0_f64,
            tool in any_tool(),
        ) {
            let mesh = terrain(&heights, 7);
            let bvh = Bvh::new(&mesh);
            let envelope = Envelope::new(&mesh, &bvh, &tool, None, 0.0);
            let each = (0..mesh.triangles().len()).filter_map(|t| {
                let alone = single(mesh.corners(t));
                let bvh = Bvh::new(&alone);
                Envelope::new(&alone, &bvh, &tool, None, 0.0).contact(x, y).map(|c| c.tip)
            });
            let truth = each.fold(f64::NEG_INFINITY, f64::max);
            let tip = envelope.contact(x, y).map_or(f64::NEG_INFINITY, |c| c.tip);
            prop_assert!(tip.total_cmp(&truth).is_eq() || (tip - truth).abs() < 1e-10, "{tip} {truth}");
        }

        #[test]
        fn a_hint_changes_nothing(heights in prop::collection::vec(0.0..4.0_f64, 42), hint in 0..60_u32, x in 0.0..6.0_f64) {
            let mesh = terrain(&heights, 7);
            let bvh = Bvh::new(&mesh);
            let tool = tool(true, 3.0, 0.2);
            let envelope = Envelope::new(&mesh, &bvh, &tool, None, 0.0);
            let (a, b) = (envelope.contact(x, 2.5).unwrap(), envelope.contact_near(x, 2.5, &mut Some(hint)).unwrap());
            prop_assert!((a.tip - b.tip).abs() < 1e-11);
        }
    }

    #[test]
    fn a_plane_is_touched_where_slopes_match() {
        let mesh =
            single([Vector::new(-50.0, -50.0, -50.0), Vector::new(50.0, -50.0, 50.0), Vector::new(0.0, 80.0, 0.0)]);
        let bvh = Bvh::new(&mesh);
        let normal = Vector::new(-1.0, 0.0, 1.0).normalize();
        for law in [SheetLaw::Constant, SheetLaw::Sine] {
            let sheet = Sheet { thickness: 1.5, law, model_face: ModelFace::Back };
            let tool = tool(true, 10.0, 0.5);
            let (tip, _) = super::super::slope_matched_offset(&tool, Some(&sheet), Vector::zeros(), normal);
            let contact = Envelope::new(&mesh, &bvh, &tool, Some(&sheet), 0.0).contact(tip.x, tip.y).unwrap();
            assert!((contact.tip - tip.z).abs() < 1e-12, "{law:?}: {} {}", contact.tip, tip.z);
            assert!((contact.normal - normal).norm() < 1e-12);
        }
    }

    #[test]
    fn beside_the_part_there_is_nothing() {
        let mesh = terrain(&[0.0; 9], 3);
        let bvh = Bvh::new(&mesh);
        let envelope = Envelope::new(&mesh, &bvh, &tool(false, 2.0, 0.0), None, 0.0);
        assert_eq!(envelope.contact(3.5, 1.0), None);
        assert!(envelope.contact(2.5, 1.0).is_some());
    }

    #[test]
    fn beside_the_part_nothing_is_searched() {
        let mesh = terrain(&[0.0; 400], 20);
        let mut visited = 0;
        Bvh::new(&mesh).maximise(
            f64::NEG_INFINITY,
            |_, _, _| f64::NEG_INFINITY,
            |_, best| {
                visited += 1;
                best
            },
        );
        assert_eq!(visited, 0);
    }
}

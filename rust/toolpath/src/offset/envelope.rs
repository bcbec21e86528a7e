//! The gouge-free envelope: how deep the tool's tip may go at a place, exactly, for any convex profile.
//!
//! The tip height at (x, y) is the largest over all triangles of three contacts: facet (the profile's point of
//! equal slope), edge and vertex. A tree of boxes with planes over them rules out nearly all triangles.

use rayon::prelude::*;
use styluscam_geometry::{Cutter, Mesh, Sheet, Tool, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::contact::{self, Best, Contacts, Facet, Feature};
use super::features::{Neighbours, NO_NEIGHBOUR};
use super::index::{Index, Lines, Matched};
use super::push::{self, Line, Release};
use super::search::{Ground, Range, Searcher, Verdict};
use super::tiles::Tiles;

/// Places put into tiles at a time: between blocks there is nothing that cannot be cancelled.
const BLOCK: usize = 1 << 20;
/// Tiles handed to a thread at a time: fixed, so that the answer does not depend on the threads.
const CHUNK: usize = 64;
/// Tiles that share a survey of the index.
const SURVEYED: usize = 16;

/// The tool's lowest free position over a place, and what it touches there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Height of the tool's tip, mm.
    pub tip: f64,
    /// The point of the mesh that is touched.
    pub point: Vector,
    /// Unit normal of the tool there, into the tool: the direction in which it comes free.
    pub normal: Vector,
    /// Triangle touched, one of equals.
    pub triangle: u32,
    feature: Feature,
}

impl Contact {
    /// Slope of the contact, rad.
    #[must_use]
    pub fn slope(&self) -> f64 {
        libm::atan2(self.normal.x.hypot(self.normal.y), self.normal.z)
    }
}

/// A mesh and a tool (with sheet and margin), ready to be asked.
pub struct Envelope<'a> {
    mesh: &'a Mesh,
    index: &'a Index,
    cutter: Cutter,
    /// The tool's tip over the cutter's.
    above: f64,
    /// What the cutter is grown by beyond tool and sheet.
    margin: f64,
    /// The largest coordinate of mesh and cutter.
    reach: f64,
    facets: Vec<Facet>,
    lines: Lines,
    matched: Vec<Vec<Matched>>,
}

impl<'a> Envelope<'a> {
    /// The envelope of `tool` over `mesh` with `sheet` between them, kept `margin` mm clear along the normal.
    #[must_use]
    pub fn new(mesh: &'a Mesh, index: &'a Index, tool: &Tool, sheet: Option<&Sheet>, margin: f64) -> Self {
        let cutter = tool.cutter_with(sheet, margin);
        let (low, high) = index.bounds();
        Self {
            mesh,
            index,
            above: Tool::tip_above(sheet, margin),
            margin,
            reach: low.amax().max(high.amax()) + cutter.max_radius(),
            facets: contact::prepared(index, &cutter),
            lines: Lines::of(&cutter),
            matched: index
                .levels()
                .iter()
                .map(|level| level.par_iter().with_min_len(1024).map(|lanes| lanes.matched(&cutter)).collect())
                .collect(),
            cutter,
        }
    }

    /// The cutter: tool, sheet and margin as one.
    #[must_use]
    pub fn cutter(&self) -> &Cutter {
        &self.cutter
    }

    /// What tool and sheet are kept clear by along the normal, mm.
    #[must_use]
    pub fn margin(&self) -> f64 {
        self.margin
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
    /// left holding this one's. Another hint changes the tip by rounding at most.
    #[must_use]
    pub fn contact_near(&self, x: f64, y: f64, hint: &mut Option<u32>) -> Option<Contact> {
        let found = Searcher::default().one(&self.ground(), [x, y], hint.map(|number| self.index.place(number)));
        let contact = self.contact_of(&found, [x, y])?;
        *hint = Some(contact.triangle);
        Some(contact)
    }

    /// Where the tool, its tip at height `z` and standing free at the line's beginning, first touches on its way along
    /// the line, up to `limit` mm: the way and the contact.
    ///
    /// The way is below 0 where the tool does not stand free at the beginning.
    #[must_use]
    pub fn push(&self, line: &Line, z: f64, limit: f64) -> Option<(f64, Contact)> {
        let (triangle, found) = push::first(self.index, &self.cutter, line, z - self.above, limit)?;
        Some((found.way, self.contact_on(line, z, triangle, &found)))
    }

    /// Where a triangle of the mesh lets the tool go, its tip at height `z`, in the direction of the line: the way and
    /// the contact, or none where it never keeps the tool off.
    #[must_use]
    pub fn release(&self, triangle: u32, line: &Line, z: f64) -> Option<(f64, Contact)> {
        let triangle = self.index.place(triangle);
        let found = push::release(&self.cutter, &self.index.triangles().at(triangle), line, z - self.above)?;
        Some((found.way, self.contact_on(line, z, triangle, &found)))
    }

    fn contact_on(&self, line: &Line, z: f64, triangle: u32, found: &Release) -> Contact {
        let [x, y] = line.at(found.way);
        Contact {
            tip: z,
            point: found.point,
            normal: normal(found.slope, [x - found.point.x, y - found.point.y]),
            triangle: self.index.number(triangle),
            feature: found.feature,
        }
    }

    /// Tip heights at many places, in parallel; NaN where the tool meets nothing.
    ///
    /// # Errors
    /// `Cancelled` when `watch` says so.
    pub fn tips(&self, places: &[[f64; 2]], watch: &Watch) -> Result<Vec<f64>, Cancelled> {
        self.map_places(places, watch, |found, _| if found.is_something() { found.tip + self.above } else { f64::NAN })
    }

    /// Contacts at many places, in parallel.
    ///
    /// # Errors
    /// `Cancelled` when `watch` says so.
    pub fn contacts(&self, places: &[[f64; 2]], watch: &Watch) -> Result<Vec<Option<Contact>>, Cancelled> {
        self.map_places(places, watch, |found, place| self.contact_of(&found, place))
    }

    /// Between which heights the tip lies over each of some boxes of the plan (lower and upper corner), in parallel;
    /// boxes that follow each other should lie together.
    ///
    /// # Errors
    /// `Cancelled` when `watch` says so.
    pub fn ranges(&self, boxes: &[[[f64; 2]; 2]], watch: &Watch) -> Result<Vec<Range>, Cancelled> {
        let ground = self.ground();
        let chunks: Result<Vec<Vec<Range>>, Cancelled> = boxes
            .par_chunks(CHUNK * SURVEYED)
            .map(|chunk| {
                let mut searcher = Searcher::default();
                let mut found = Vec::with_capacity(chunk.len());
                for boxes in chunk.chunks(SURVEYED) {
                    searcher.ranges(&ground, boxes, &mut |range: Range| {
                        found.push(Range { low: range.low + self.above, high: range.high + self.above });
                    });
                    watch.advance(boxes.len())?;
                }
                Ok(found)
            })
            .collect();
        Ok(chunks?.concat())
    }

    /// Whether the tip must stay over height `z` everywhere in a box of the plan (lower and upper corner), or need not
    /// anywhere.
    #[must_use]
    pub fn verdict(&self, corners: &[[f64; 2]; 2], z: f64) -> Verdict {
        Searcher::default().verdict(&self.ground(), corners, z - self.above)
    }

    fn map_places<T: Copy + Send + Sync>(
        &self,
        places: &[[f64; 2]],
        watch: &Watch,
        keep: impl Fn(Best, [f64; 2]) -> T + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        let mut answers = Vec::with_capacity(places.len());
        for block in places.chunks(BLOCK) {
            let tiles = Tiles::of(block, self.index.area_per_triangle());
            let by_tile = self.map_tiles(block, &tiles, watch, &keep)?;
            answers.par_extend(tiles.ranks.par_iter().map(|rank| by_tile[*rank as usize]));
        }
        Ok(answers)
    }

    /// Answers for the members of tiles, one after the other.
    fn map_tiles<T: Copy + Send>(
        &self,
        places: &[[f64; 2]],
        tiles: &Tiles,
        watch: &Watch,
        keep: &(impl Fn(Best, [f64; 2]) -> T + Sync),
    ) -> Result<Vec<T>, Cancelled> {
        let ground = self.ground();
        let count = tiles.starts.len() - 1;
        let chunks: Result<Vec<Vec<T>>, Cancelled> = (0..count)
            .into_par_iter()
            .step_by(CHUNK)
            .map(|first| {
                let mut searcher = Searcher::default();
                let starts = &tiles.starts[first..=(first + CHUNK).min(count)];
                let begin = starts[0];
                let mut found = vec![Best::NOTHING; (starts[starts.len() - 1] - begin) as usize];
                for piece in (0..starts.len() - 1).step_by(SURVEYED) {
                    let starts = &starts[piece..=(piece + SURVEYED).min(starts.len() - 1)];
                    searcher.many(&ground, places, &tiles.members, starts, &mut |member, best| {
                        found[(tiles.ranks[member as usize] - begin) as usize] = best;
                    });
                    watch.advance((starts[starts.len() - 1] - starts[0]) as usize)?;
                }
                let members = &tiles.members[begin as usize..begin as usize + found.len()];
                Ok(members.iter().zip(found).map(|(member, best)| keep(best, places[*member as usize])).collect())
            })
            .collect();
        Ok(chunks?.concat())
    }

    fn ground(&self) -> Ground<'_> {
        Ground {
            index: self.index,
            cutter: &self.cutter,
            contacts: Contacts::new(self.index, &self.cutter, &self.facets, self.reach),
            lines: &self.lines,
            matched: &self.matched,
            bottom: self.index.bounds().0.z - self.cutter.max_height() - self.cutter.max_radius(),
        }
    }

    /// Distance from a point of the mesh to tool and sheet, without the margin, their tip standing at `tip` over (x, y), mm.
    #[must_use]
    pub fn gap(&self, point: Vector, x: f64, y: f64, tip: f64) -> f64 {
        let height = point.z - (tip - self.above);
        self.cutter.distance(libm::hypot(point.x - x, point.y - y), height).0 + self.margin
    }

    /// How deep a point of the mesh lies in the cutter (tool, sheet and margin), the tool's tip standing at `tip`, mm;
    /// negative outside.
    #[must_use]
    pub fn depth(&self, point: Vector, tip: Vector) -> f64 {
        let radius = libm::hypot(point.x - tip.x, point.y - tip.y);
        let height = point.z - (tip.z - self.above);
        // deep inside, the way out may be the bottom or the side instead of the nearest stretch of the profile
        let ends = [0.0, std::f64::consts::FRAC_PI_2].map(|slope| self.cutter.gap(radius, height, slope));
        -self.cutter.distance(radius, height).0.max(ends[0]).max(ends[1])
    }

    /// The point of the cutter's surface that looks against `normal`, the tool's tip standing at `tip`: with it the cutter
    /// touches a plane of that normal; the outer end where there are many.
    #[must_use]
    pub fn touching_point(&self, tip: Vector, normal: Vector) -> Vector {
        let across = libm::hypot(normal.x, normal.y);
        let (r, z) = self.cutter.point_at(libm::atan2(across, normal.z).min(std::f64::consts::FRAC_PI_2));
        let outward = if across > 0.0 { [normal.x / across, normal.y / across] } else { [0.0; 2] };
        Vector::new(tip.x - r * outward[0], tip.y - r * outward[1], tip.z - self.above + z)
    }

    fn contact_of(&self, best: &Best, [x, y]: [f64; 2]) -> Option<Contact> {
        if !best.is_something() {
            return None;
        }
        let slope = self.ground().contacts.slope(best, [x, y]);
        let [cx, cy] = best.at;
        let height = best.tip + self.cutter.point_at(slope).1;
        Some(Contact {
            tip: best.tip + self.above,
            point: Vector::new(cx, cy, height),
            normal: normal(slope, [x - cx, y - cy]),
            triangle: self.index.number(best.triangle),
            feature: best.feature,
        })
    }

    /// Whether the contact belongs to triangles that `selected` accepts, all of those that meet there.
    ///
    /// Rolling over an edge or corner between selected and other faces, the contact belongs to the selected one while
    /// its normal is within `spread` (rad) of the selected facet's.
    #[must_use]
    pub fn belongs(&self, contact: &Contact, selected: &[bool], spread: f64) -> bool {
        match contact.feature {
            Feature::Facet => selected[contact.triangle as usize],
            Feature::Edge(i) => {
                let other = self.neighbours(contact.triangle)[usize::from(i)];
                self.faces_like([contact.triangle, other], contact, selected, spread)
            }
            Feature::Corner(i) => self.faces_like(self.around(contact, i), contact, selected, spread),
        }
    }

    /// The triangles that meet where the contact is: one, those beside an edge, or those around a corner.
    #[must_use]
    pub fn touched(&self, contact: &Contact) -> Vec<u32> {
        let mut touched = match contact.feature {
            Feature::Facet => vec![contact.triangle],
            Feature::Edge(i) => vec![contact.triangle, self.neighbours(contact.triangle)[usize::from(i)]],
            Feature::Corner(i) => self.around(contact, i),
        };
        touched.retain(|t| *t != NO_NEIGHBOUR);
        touched
    }

    /// Triangles around the corner touched, found through the edges of the one that was asked; where the mesh ends
    /// there, [`NO_NEIGHBOUR`] is among them.
    fn around(&self, contact: &Contact, corner: u8) -> Vec<u32> {
        let vertex = self.mesh.triangles()[contact.triangle as usize][usize::from(corner)];
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
        let beyond = self.index.neighbours(self.index.place(triangle));
        beyond.map(|place| if place == NO_NEIGHBOUR { NO_NEIGHBOUR } else { self.index.number(place) })
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

/// The unit normal of a contact of some slope, from which the axis stands some way away in plan.
fn normal(slope: f64, [dx, dy]: [f64; 2]) -> Vector {
    let (sin, cos) = libm::sincos(slope);
    let distance = libm::hypot(dx, dy);
    let outward = if distance > 0.0 { [dx / distance, dy / distance] } else { [0.0; 2] };
    Vector::new(sin * outward[0], sin * outward[1], cos)
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
            let bvh = Index::new(&mesh);
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
            let bvh = Index::new(&mesh);
            let envelope = Envelope::new(&mesh, &bvh, &tool, None, 0.0);
            let each = (0..mesh.triangles().len()).filter_map(|t| {
                let alone = single(mesh.corners(t));
                let bvh = Index::new(&alone);
                Envelope::new(&alone, &bvh, &tool, None, 0.0).contact(x, y).map(|c| c.tip)
            });
            let truth = each.fold(f64::NEG_INFINITY, f64::max);
            let tip = envelope.contact(x, y).map_or(f64::NEG_INFINITY, |c| c.tip);
            prop_assert!(tip.total_cmp(&truth).is_eq() || (tip - truth).abs() < 1e-10, "{tip} {truth}");
        }

        #[test]
        fn a_hint_changes_nothing(heights in prop::collection::vec(0.0..4.0_f64, 42), hint in 0..60_u32, x in 0.0..6.0_f64) {
            let mesh = terrain(&heights, 7);
            let bvh = Index::new(&mesh);
            let tool = tool(true, 3.0, 0.2);
            let envelope = Envelope::new(&mesh, &bvh, &tool, None, 0.0);
            let (a, b) = (envelope.contact(x, 2.5).unwrap(), envelope.contact_near(x, 2.5, &mut Some(hint)).unwrap());
            prop_assert!((a.tip - b.tip).abs() < 1e-11);
        }
    }

    /// Surfaces of 24 x 24 cells of half a millimetre: bumps, ridges, steps with upright walls, needles, a bowl of fans.
    fn surface(kind: u8, seed: u64) -> Mesh {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut random = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let side = 25;
        let mut vertices = Vec::new();
        for i in 0..side * side {
            let (column, row) = ((i % side) as f64, (i / side) as f64);
            let (x, y) = (0.5 * column, 0.5 * row);
            let z = match kind {
                0 => libm::sin(x) * libm::cos(1.3 * y),
                1 => (2.0 - (libm::fmod(x + 0.7 * y, 4.0) - 2.0).abs()).abs(),
                2 => 1.5 * libm::floor(random() * 2.0),
                3 if random() < 0.05 => 6.0 * random(),
                3 => 0.0,
                _ => 0.08 * ((x - 6.0) * (x - 6.0) + (y - 6.0) * (y - 6.0)),
            };
            // steps: the ends of a cell's sides fall together in plan, and walls stand upright
            let x = if kind == 2 {
                libm::floor(column / 2.0) + 0.5 * libm::fmod(column, 2.0) * f64::from(z == 0.0)
            } else {
                x
            };
            vertices.push(Vector::new(x, y, z));
        }
        let mut triangles = Vec::new();
        for row in 0..side - 1 {
            for column in 0..side - 1 {
                let (i, n) = ((row * side + column) as i64, side as i64);
                triangles.extend([[i, i + 1, i + n + 1], [i, i + n + 1, i + n]]);
            }
        }
        if kind == 4 {
            // a plane in slivers from one corner, as tessellators make them
            let corner = vertices.len() as i64;
            vertices.push(Vector::new(-20.0, -20.0, 1.0));
            for i in 0..80 {
                vertices.push(Vector::new(30.0, -20.0 + 0.6 * f64::from(i), 1.0));
                if i > 0 {
                    triangles.push([corner, corner + i64::from(i), corner + i64::from(i) + 1]);
                }
            }
        }
        Mesh::new(vertices, &triangles, &[]).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn tiles_find_what_all_triangles_say(kind in 0..5_u8, seed in 1..1_000_000_u64, tool in any_tool(), turn in 0.0..6.3_f64) {
            let mesh = surface(kind, seed);
            let index = Index::new(&mesh);
            let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
            let (sin, cos) = libm::sincos(turn);
            let places: Vec<[f64; 2]> = (0..1600)
                .map(|i| [0.4 * f64::from(i % 40) - 8.0, 0.4 * f64::from(i / 40) - 8.0])
                .map(|[x, y]| [6.0 + cos * x - sin * y, 6.0 + sin * x + cos * y])
                .collect();
            let tips = envelope.tips(&places, &Watch::default()).unwrap();
            let ground = envelope.ground();
            for (place, tip) in places.iter().zip(tips).step_by(7) {
                let mut best = Best::NOTHING;
                for triangle in 0..mesh.triangles().len() as u32 {
                    ground.contacts.touch_whole(triangle, *place, &mut best);
                }
                if best.is_something() {
                    prop_assert!((tip - best.tip).abs() < 1e-11, "{place:?} {tip} {}", best.tip);
                } else {
                    prop_assert!(tip.is_nan());
                }
            }
        }
    }

    #[test]
    fn a_plane_is_touched_where_slopes_match() {
        let mesh =
            single([Vector::new(-50.0, -50.0, -50.0), Vector::new(50.0, -50.0, 50.0), Vector::new(0.0, 80.0, 0.0)]);
        let bvh = Index::new(&mesh);
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
    fn an_upright_triangle_is_touched_at_its_top() {
        let mesh = single([Vector::zeros(), Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 0.0, 1.0)]);
        let index = Index::new(&mesh);
        let tool = tool(false, 2.0, 0.0);
        let envelope = Envelope::new(&mesh, &index, &tool, None, 0.0);
        let places: Vec<[f64; 2]> = (0..100).map(|i| [0.0, 0.01 * f64::from(i)]).collect();
        for (place, tip) in places.iter().zip(envelope.tips(&places, &Watch::default()).unwrap()) {
            let top = searched(mesh.corners(0), envelope.cutter(), place[0], place[1]);
            assert!((tip - top).abs() < 1e-9, "{place:?} {tip} {top}");
        }
    }

    #[test]
    fn beside_the_part_there_is_nothing() {
        let mesh = terrain(&[0.0; 9], 3);
        let bvh = Index::new(&mesh);
        let envelope = Envelope::new(&mesh, &bvh, &tool(false, 2.0, 0.0), None, 0.0);
        assert_eq!(envelope.contact(3.5, 1.0), None);
        assert!(envelope.contact(2.5, 1.0).is_some());
    }
}

//! The gouge-free envelope: how deep the tool's tip may go at a position, exactly, for any convex profile.
//!
//! The tip height at (x, y) is the largest over all triangles of three contacts: facet (the profile's point of
//! equal slope), edge and vertex. A tree of boxes with planes over them rules out nearly all triangles.
//!
//! The three contacts of drop-cutter, for a generalized cutter: H.-T. Yau, C.-M. Chuang, Y.-S. Lee, "Numerical control
//! machining of triangulated sculptured surfaces in a stereo lithography format with a generalized cutter", International
//! Journal of Production Research 42, 2004. Derivation: docs/concepts/envelope.md.

use rayon::prelude::*;
use styluscam_geometry::{Cutter, Mesh, Sheet, Tool, ToolBody, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::contact::{Best, Chord, Contacts, Feature, Prepared};
use super::features::{Neighbours, NO_NEIGHBOUR};
use super::index::{Index, Lines, Matched};
use super::push::{self, Line, Release};
use super::search::{Ground, Keeping, Searcher, Verdict};
use super::slices::{Slice, Slices};
use super::tiles::Tiles;
use crate::lattice::{Cells, Lattice, Node};

/// Positions put into tiles at a time: between blocks there is nothing that cannot be cancelled.
const BLOCK: usize = 1 << 20;
/// Tiles handed to a thread at a time: fixed, so that the answer does not depend on the threads.
const CHUNK: usize = 64;
/// Tiles that share a survey of the index.
const SURVEYED: usize = 16;
/// Contacts that rise by more have their normal by their slope.
const STEEPEST: f64 = 1e3;
/// Cells in each direction of the pieces of a lattice that share a survey of the index.
const PIECE: usize = 16;

/// The tool's lowest free position over a position, and what it touches there.
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
    pub(super) feature: Feature,
}

impl Contact {
    /// Slope of the contact, rad.
    #[must_use]
    pub fn slope(&self) -> f64 {
        libm::atan2(libm::hypot(self.normal.x, self.normal.y), self.normal.z)
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
    prepared: Prepared,
    lines: Lines,
    matched: Vec<Vec<Matched>>,
}

impl<'a> Envelope<'a> {
    /// The envelope of `tool` over `mesh` with `sheet` between them, kept `margin` mm clear along the normal.
    #[must_use]
    pub fn new(mesh: &'a Mesh, index: &'a Index, tool: &Tool, sheet: Option<&Sheet>, margin: f64) -> Self {
        Self::of_cutter(mesh, index, tool.cutter_with(sheet, margin), tool.tip_above(sheet, margin), margin)
    }

    /// The envelope of a solid of a tool over `mesh`: how deep the tool's tip may go for this solid alone.
    #[must_use]
    pub fn of_body(mesh: &'a Mesh, index: &'a Index, body: ToolBody) -> Self {
        let above = body.tip_above();
        Self::of_cutter(mesh, index, Cutter::of(body), above, 0.0)
    }

    fn of_cutter(mesh: &'a Mesh, index: &'a Index, cutter: Cutter, above: f64, margin: f64) -> Self {
        let (low, high) = index.bounds();
        let reach = low.amax().max(high.amax()) + cutter.max_radius();
        Self {
            mesh,
            index,
            above,
            margin,
            reach,
            prepared: Prepared::of(index, &cutter, reach),
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

    /// Height of the tip where the tool stands on a horizontal plane at a height, mm.
    #[must_use]
    pub fn tip_on(&self, height: f64) -> f64 {
        height + self.above
    }

    /// How far beside it a triangle may still count as touched, for rounding, mm.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        self.ground().contacts.overhang()
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
        let found = self.found_near(x, y, hint)?;
        Some(self.contact_of(&found, [x, y]))
    }

    /// Whether the tip must stay higher than `z` at (x, y): quicker than its height. `hint` is as in
    /// [`contact_near`](Self::contact_near).
    #[must_use]
    pub fn is_over(&self, x: f64, y: f64, z: f64, hint: &mut Option<u32>) -> bool {
        let near = hint.map(|number| self.index.position(number));
        let found = Searcher::with(|searcher| searcher.over(&self.ground(), [x, y], z - self.above, near));
        *hint = found.map(|triangle| self.index.number(triangle)).or(*hint);
        found.is_some()
    }

    fn found_near(&self, x: f64, y: f64, hint: &mut Option<u32>) -> Option<Best> {
        let near = hint.map(|number| self.index.position(number));
        let found = Searcher::with(|searcher| searcher.one(&self.ground(), [x, y], near));
        if !found.is_something() {
            return None;
        }
        *hint = Some(self.index.number(found.triangle));
        Some(found)
    }

    /// Where the tool, its tip at height `z` and standing free at the line's beginning, first touches on its path along
    /// the line, up to `limit` mm: the travel and the contact.
    ///
    /// The travel is below 0 where the tool does not stand free at the beginning.
    #[must_use]
    pub fn push(&self, line: &Line, z: f64, limit: f64) -> Option<(f64, Contact)> {
        let (triangle, found) = push::first(self.index, &self.cutter, line, z - self.above, limit)?;
        Some((found.travel, self.contact_on(line, z, triangle, &found)))
    }

    /// Travels of [`push`](Self::push) along many lines, in parallel: infinite where nothing is met, NaN where the tool does not
    /// stand free at the beginning.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn pushes(&self, lines: &[Line], z: f64, watch: &Watch) -> Result<Vec<f64>, Cancelled> {
        let travel = |line: &Line| {
            watch.advance(1)?;
            Ok(match self.push(line, z, f64::INFINITY) {
                Some((travel, _)) if travel < 0.0 => f64::NAN,
                Some((travel, _)) => travel,
                None => f64::INFINITY,
            })
        };
        lines.par_iter().with_min_len(16).map(travel).collect()
    }

    /// Where a triangle of the mesh lets the tool go, its tip at height `z`, in the direction of the line: the travel and
    /// the contact, or none where it never keeps the tool off.
    #[must_use]
    pub fn release(&self, triangle: u32, line: &Line, z: f64) -> Option<(f64, Contact)> {
        let triangle = self.index.position(triangle);
        let found = push::release(&self.cutter, &self.index.triangles().at(triangle), line, z - self.above)?;
        Some((found.travel, self.contact_on(line, z, triangle, &found)))
    }

    fn contact_on(&self, line: &Line, z: f64, triangle: u32, found: &Release) -> Contact {
        let [x, y] = line.at(found.travel);
        Contact {
            tip: z,
            point: found.point,
            normal: normal(found.slope, [x - found.point.x, y - found.point.y]),
            triangle: self.index.number(triangle),
            feature: found.feature,
        }
    }

    /// Tip heights at many positions, in parallel; NaN where the tool meets nothing.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn tips(&self, positions: &[[f64; 2]], watch: &Watch) -> Result<Vec<f64>, Cancelled> {
        self.map_positions(
            positions,
            watch,
            |found, _| if found.is_something() { found.tip + self.above } else { f64::NAN },
        )
    }

    /// Contacts at many positions, in parallel.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn contacts(&self, positions: &[[f64; 2]], watch: &Watch) -> Result<Vec<Option<Contact>>, Cancelled> {
        self.map_positions(positions, watch, |found, position| {
            found.is_something().then(|| self.contact_of(&found, position))
        })
    }

    /// What no tip exceeds over each cell of a lattice where it may be higher than the cell's `limit`, in parallel, row by
    /// row; minus infinity where it is not. `limit` is asked of rectangles as well: the least of those of their cells.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn ceilings(
        &self,
        lattice: &Lattice,
        limit: impl Fn(&Cells) -> f64 + Sync,
        watch: &Watch,
    ) -> Result<Vec<f64>, Cancelled> {
        let ground = self.ground();
        let pieces: Vec<Cells> = lattice.cells().pieces(PIECE).collect();
        let found: Result<Vec<Vec<(Node, f64)>>, Cancelled> = pieces
            .par_iter()
            .map(|piece| {
                let mut found = Vec::new();
                let limit = |cells: &Cells| limit(cells) - self.above;
                let mut keep = |cell, highest: f64| found.push((cell, highest + self.above));
                Searcher::default().ceilings(&ground, lattice, *piece, &limit, &mut keep);
                watch.advance(piece.iter().count())?;
                Ok(found)
            })
            .collect();
        let mut ceilings = vec![f64::NEG_INFINITY; lattice.columns * lattice.rows];
        for (cell, highest) in found?.into_iter().flatten() {
            ceilings[lattice.number(cell)] = highest;
        }
        Ok(ceilings)
    }

    /// A height over which the tip must stay in all of a box of the plan (lower and upper corner), because of what is
    /// touched at one position.
    #[must_use]
    pub fn least(&self, contact: &Contact, corners: &[[f64; 2]; 2]) -> f64 {
        let ground = self.ground();
        let tile = ground.tile(corners, &[0, 1]);
        ground.contacts.least(self.index.position(contact.triangle), tile.middle, tile.half) + self.above
    }

    /// Whether the tip may stay within some height of the straight line between two tips, along all of it: no triangle asks
    /// for more than `most` (mm) gives for it over the line, which is never less than `least`.
    #[must_use]
    pub fn keeps_under(&self, line: [Vector; 2], least: f64, most: impl Fn(u32) -> f64) -> Keeping {
        let most = |triangle| most(self.index.number(triangle));
        Searcher::with(|searcher| searcher.keeps_under(&self.ground(), &self.chord(line), least, &most))
    }

    /// Rows over the mesh, at ascending positions across, mm; `directions` are unit vectors in plan along and across them. What counts as
    /// selected is stated for each triangle; all does where it is not.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn slices<'s>(
        &'s self,
        directions: [[f64; 2]; 2],
        rows: Vec<f64>,
        selected: Option<&'s [bool]>,
        watch: &Watch,
    ) -> Result<Slices<'s>, Cancelled> {
        Slices::of(self.ground().contacts, directions, rows, selected, self.reach, watch)
    }

    /// The contact at a position on a row, or none where the tool meets nothing; and whether all triangles that meet there are
    /// selected.
    #[must_use]
    pub fn contact_on_row(&self, slice: &Slice<'_>, x: f64, y: f64) -> Option<(Contact, bool)> {
        let (found, is_selected) = slice.found([x, y]);
        found.is_something().then(|| (self.contact_of(&found, [x, y]), is_selected))
    }

    /// As [`keeps_under`](Self::keeps_under), of a line on a row; `most` is asked for what is selected and for what is not.
    #[must_use]
    pub fn keeps_under_on_row(&self, slice: &Slice<'_>, line: [Vector; 2], most: impl Fn(bool) -> f64) -> Keeping {
        slice.keeps_under(&self.chord(line), most)
    }

    /// How far the tip may fall below the straight line between two tips at most, mm, because of the triangles that are
    /// touched at its ends; infinite where that is not known.
    ///
    /// The tips that a triangle asks for are concave: nowhere lower than the line between two of them.
    #[must_use]
    pub fn dip(&self, line: [Vector; 2], touched: [u32; 2]) -> f64 {
        if touched[0] == touched[1] {
            return 0.0;
        }
        let ground = self.ground();
        let below = |triangle: u32, at: Vector| {
            let mut alone = Best::NOTHING;
            ground.contacts.touch_whole(self.index.position(triangle), [at.x, at.y], &mut alone);
            (at.z - self.above - alone.tip).max(0.0)
        };
        let (first, last) = (below(touched[0], line[1]), below(touched[1], line[0]));
        // two lines, each from an end of this one to so much below the other: the higher is lowest where they meet
        if first.min(last) > 0.0 && first.max(last) < f64::INFINITY {
            first * last / (first + last)
        } else {
            first.min(last)
        }
    }

    /// The cutter's tip that a triangle of the index alone asks for.
    #[cfg(test)]
    pub(super) fn tip_alone(&self, triangle: u32, position: [f64; 2]) -> f64 {
        let mut alone = Best::NOTHING;
        self.ground().contacts.touch_whole(triangle, position, &mut alone);
        alone.tip
    }

    fn chord(&self, [from, to]: [Vector; 2]) -> Chord {
        let along = (to - from).xy().into();
        Chord { from: [from.x, from.y], along, rise: to.z - from.z, tip: from.z - self.above }
    }

    /// Whether the tip must stay over height `z` everywhere in a box of the plan (lower and upper corner), or need not
    /// anywhere.
    #[must_use]
    pub fn verdict(&self, corners: &[[f64; 2]; 2], z: f64) -> Verdict {
        Searcher::with(|searcher| searcher.verdict(&self.ground(), corners, z - self.above))
    }

    fn map_positions<T: Copy + Send + Sync>(
        &self,
        positions: &[[f64; 2]],
        watch: &Watch,
        keep: impl Fn(Best, [f64; 2]) -> T + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        let mut answers = Vec::with_capacity(positions.len());
        for block in positions.chunks(BLOCK) {
            let tiles = Tiles::of(block, self.index.area_per_triangle());
            let by_tile = self.map_tiles(block, &tiles, watch, &keep)?;
            answers.par_extend(tiles.ranks.par_iter().map(|rank| by_tile[*rank as usize]));
        }
        Ok(answers)
    }

    /// Answers for the members of tiles, one after the other.
    fn map_tiles<T: Copy + Send>(
        &self,
        positions: &[[f64; 2]],
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
                    searcher.many(&ground, positions, &tiles.members, starts, &mut |member, best| {
                        found[(tiles.ranks[member as usize] - begin) as usize] = best;
                    });
                    watch.advance((starts[starts.len() - 1] - starts[0]) as usize)?;
                }
                let members = &tiles.members[begin as usize..begin as usize + found.len()];
                Ok(members.iter().zip(found).map(|(member, best)| keep(best, positions[*member as usize])).collect())
            })
            .collect();
        Ok(chunks?.concat())
    }

    fn ground(&self) -> Ground<'_> {
        Ground {
            index: self.index,
            cutter: &self.cutter,
            contacts: Contacts::new(self.index, &self.cutter, &self.prepared),
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
        // deep inside, the shortest path out may lead through the bottom or the side instead of the nearest stretch of the
        // profile
        let ends = [0.0, std::f64::consts::FRAC_PI_2].map(|slope| self.cutter.gap(radius, height, slope));
        -self.cutter.distance(radius, height).0.max(ends[0]).max(ends[1])
    }

    /// The point of the cutter's surface that looks against `normal`, the tool's tip standing at `tip`: with it the cutter
    /// touches a plane of that normal; the outer end where there are many.
    #[must_use]
    pub fn touching_point(&self, tip: Vector, normal: Vector) -> Vector {
        let across = libm::hypot(normal.x, normal.y);
        let (r, z) = if normal.z > 0.0 {
            self.cutter.at_rise(across / normal.z)
        } else {
            self.cutter.point_at(std::f64::consts::FRAC_PI_2)
        };
        let outward = if across > 0.0 { [normal.x / across, normal.y / across] } else { [0.0; 2] };
        Vector::new(tip.x - r * outward[0], tip.y - r * outward[1], tip.z - self.above + z)
    }

    fn contact_of(&self, best: &Best, [x, y]: [f64; 2]) -> Contact {
        let contacts = self.ground().contacts;
        let [cx, cy] = best.at;
        let gradient = contacts.gradient(best, [x, y]);
        let normal = Vector::new(-gradient[0], -gradient[1], 1.0);
        let length = normal.norm();
        // beside the steepest of walls the gradient says less than the slope
        let (normal, height) = if length < STEEPEST {
            (normal / length, contacts.height_at(best))
        } else {
            let slope = contacts.slope(best, [x, y]);
            (self::normal(slope, [x - cx, y - cy]), best.tip + self.cutter.point_at(slope).1)
        };
        Contact {
            tip: best.tip + self.above,
            point: Vector::new(cx, cy, height),
            normal,
            triangle: self.index.number(best.triangle),
            feature: best.feature,
        }
    }

    /// Height over the tool's tip from which on its side is upright, mm.
    pub(super) fn side_height(&self) -> f64 {
        self.cutter.max_height() - self.above
    }

    /// The triangles beyond the three edges of one; `u32::MAX` where the mesh ends.
    #[must_use]
    pub fn neighbours(&self, triangle: u32) -> Neighbours {
        let beyond = self.index.neighbours(self.index.position(triangle));
        beyond.map(|position| if position == NO_NEIGHBOUR { NO_NEIGHBOUR } else { self.index.number(position) })
    }
}

/// The unit normal of a contact of some slope, from which the axis stands at some distance in plan.
fn normal(slope: f64, [dx, dy]: [f64; 2]) -> Vector {
    let (sin, cos) = libm::sincos(slope);
    let distance = libm::hypot(dx, dy);
    let outward = if distance > 0.0 { [dx / distance, dy / distance] } else { [0.0; 2] };
    Vector::new(sin * outward[0], sin * outward[1], cos)
}

#[cfg(test)]
pub(super) mod tests;

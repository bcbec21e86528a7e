//! The surface on which paths run: the envelope, and which of its contacts were asked for.

use std::borrow::Cow;

use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use crate::fitting;
use crate::offset::{Contact, Envelope, Keeping, Rolling, Slice, Slices};
use crate::region::{Between, Region};
use crate::{Pass, PathPoint};

/// A contact on an unselected face's border still counts while its normal is this close to what selected facets span, rad:
/// wide enough for tessellated tangent joins, too narrow to roll round an edge.
const SPREAD: f64 = 0.0175;

/// Share of the angle between two pieces by which a path may turn between witnesses: so longer pieces have room.
const WITNESSED: f64 = 0.4;

/// Heights without limits.
const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Envelope and selection, asked point by point.
pub struct Surface<'a> {
    envelope: &'a Envelope<'a>,
    /// By triangle; none: all of them, and the borders of the mesh.
    selected: Option<&'a [bool]>,
    heights: [f64; 2],
    /// Height below which the tip does not follow the envelope, mm.
    floor: f64,
    /// What counts of what rolls over the outer edges of the selection.
    rolling: Rolling,
    /// Where passes may run at all; none: everywhere.
    region: Option<&'a Region<'a>>,
    /// Whether passes keep all their witnesses.
    keeps_witnesses: bool,
    /// Largest angle by which passes turn between two witnesses where the envelope is smooth, rad.
    bend: f64,
}

impl<'a> Surface<'a> {
    /// `selected` holds for each triangle whether its face was asked for.
    #[must_use]
    pub fn new(envelope: &'a Envelope<'a>, selected: &'a [bool]) -> Self {
        Self { selected: Some(selected), ..Self::whole(envelope) }
    }

    /// All that the tool can touch counts as selected.
    #[must_use]
    pub fn whole(envelope: &'a Envelope<'a>) -> Self {
        Self {
            envelope,
            selected: None,
            heights: EVERYWHERE,
            floor: f64::NEG_INFINITY,
            rolling: Rolling::Stop,
            region: None,
            keeps_witnesses: false,
            bend: f64::INFINITY,
        }
    }

    /// The same surface, of which only what has its tip between two heights counts as selected.
    #[must_use]
    pub fn between_heights(&self, heights: [f64; 2]) -> Self {
        Self { heights, ..*self }
    }

    /// The same surface, of which what lies below a plane is on that instead: as high as a sheet is to stand for now.
    #[must_use]
    pub fn above(&self, floor: f64) -> Self {
        Self { floor, ..*self }
    }

    /// The same surface, on which the tool also counts as touching what was selected while it rolls over edges of that: from
    /// above, so that a sheet is formed from its flat top down, step by step, though only the walls were selected, or over all.
    #[must_use]
    pub fn rolling(&self, rolling: Rolling) -> Self {
        Self { rolling, ..*self }
    }

    /// The same surface, of which only what a region allows counts as selected.
    #[must_use]
    pub fn within(&self, region: &'a Region<'a>) -> Self {
        Self { region: Some(region), ..*self }
    }

    /// The stretches of a line of exact points in which the region lets the tool go, and whether each is closed.
    pub(crate) fn stretches(
        &self,
        points: Vec<PathPoint>,
        closed: bool,
        between: impl Between,
    ) -> Vec<(Vec<PathPoint>, bool)> {
        match self.region {
            None => vec![(points, closed)],
            Some(region) => region.stretches(self.envelope, &points, closed, between),
        }
    }

    /// Whether the tool keeps clear of the check faces between neighbours of these points, wherever else it goes.
    pub(crate) fn is_clear_along(&self, points: &[PathPoint]) -> bool {
        points.windows(2).all(|pair| self.is_clear([pair[0].tip, pair[1].tip]))
    }

    /// Whether the tool keeps clear of the check faces on the straight line between two tips.
    pub(crate) fn is_clear(&self, line: [Vector; 2]) -> bool {
        self.region.is_none_or(|region| !region.may_be_near(line))
    }

    /// The envelopes on the part and on the check faces: the tip stays above all of them.
    pub(crate) fn envelopes(&self) -> impl Iterator<Item = &'a Envelope<'a>> + '_ {
        std::iter::once(self.envelope).chain(self.region.iter().flat_map(|region| &region.checks))
    }

    /// Whether the region does not end between neighbours of these points, which it allows.
    pub(crate) fn goes_on_along(&self, points: &[PathPoint]) -> bool {
        let goes_on = |region: &Region<'_>| {
            points.windows(2).all(|pair| !region.may_end_between(self.envelope, &pair[0], &pair[1]))
        };
        self.region.is_none_or(goes_on)
    }

    /// The same surface, whose passes keep all their witnesses: what is fitted to them later needs them.
    #[must_use]
    pub fn keeping_witnesses(&self) -> Self {
        Self { keeps_witnesses: true, ..*self }
    }

    /// The same surface, whose passes have witnesses enough for lines and arcs ([`crate::Arcs`]) that turn by no more than an angle, rad,
    /// where it is smooth.
    #[must_use]
    pub fn turning(&self, corner: f64) -> Self {
        Self { keeps_witnesses: true, bend: WITNESSED * corner, ..*self }
    }

    pub(crate) fn bend(&self) -> f64 {
        self.bend
    }

    /// The points of a pass through witnesses: as few as keep within `deviation` mm, or all of them.
    pub(crate) fn thinned(&self, witnesses: &[PathPoint], deviation: f64) -> Vec<PathPoint> {
        if self.keeps_witnesses {
            return witnesses.to_vec();
        }
        let mut points = fitting::thinned(witnesses, deviation);
        points.shrink_to_fit(); // all passes are kept until they are linked
        points
    }

    /// The points of a pass as the ends of chords, also where it keeps its witnesses.
    pub(crate) fn chords<'p>(&self, points: &'p [PathPoint], deviation: f64) -> Cow<'p, [PathPoint]> {
        if self.keeps_witnesses {
            Cow::Owned(fitting::thinned(points, deviation))
        } else {
            Cow::Borrowed(points)
        }
    }

    pub(crate) fn keeps_witnesses(&self) -> bool {
        self.keeps_witnesses
    }

    /// All passes with the ends of their chords as points.
    pub(crate) fn outlines(&self, passes: &[Pass], deviation: f64) -> Vec<Pass> {
        let outline = |pass: &Pass| Pass { points: self.chords(&pass.points, deviation).into_owned(), ..*pass };
        passes.iter().map(outline).collect()
    }

    /// The envelope.
    #[must_use]
    pub fn envelope(&self) -> &'a Envelope<'a> {
        self.envelope
    }

    /// The position over (x, y); none where the tool meets nothing.
    #[must_use]
    pub fn at(&self, x: f64, y: f64, hint: &mut Option<u32>) -> Option<PathPoint> {
        self.envelope.contact_near(x, y, hint).map(|c| self.path_point(x, y, &c))
    }

    /// The position over the middle of two others.
    #[must_use]
    pub fn between(&self, a: &PathPoint, b: &PathPoint, hint: &mut Option<u32>) -> Option<PathPoint> {
        let middle = (a.tip + b.tip) * 0.5;
        self.at(middle.x, middle.y, hint)
    }

    /// Rows over it at ascending positions across, mm; `directions` are unit vectors in plan along and across them.
    pub(crate) fn slices(
        &self,
        directions: [[f64; 2]; 2],
        rows: Vec<f64>,
        watch: &Watch,
    ) -> Result<Slices<'_>, Cancelled> {
        self.envelope.slices(directions, rows, self.selected, watch)
    }

    /// As [`at`](Self::at), on a row if it is given.
    #[must_use]
    pub(crate) fn on_row(&self, row: Option<&Slice<'_>>, x: f64, y: f64, hint: &mut Option<u32>) -> Option<PathPoint> {
        match row {
            None => self.at(x, y, hint),
            Some(slice) => {
                let (contact, is_selected) = self.envelope.contact_on_row(slice, x, y)?;
                Some(self.point_of([x, y], &contact, is_selected))
            }
        }
    }

    /// Whether all exact positions between two (on a row, if it is given) stay within `most` mm of the straight line, as fitting
    /// measures: proven, for whatever lies there. False where that cannot be seen.
    #[must_use]
    pub(crate) fn keeps_to(&self, row: Option<&Slice<'_>>, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        let height = fitting::in_height(a, b, most);
        self.dip(a, b) <= height && self.rise(row, a, b, height) == Keeping::Under
    }

    /// What is known of tips over the straight line between two, by more than a height, mm.
    fn rise(&self, row: Option<&Slice<'_>>, a: &PathPoint, b: &PathPoint, height: f64) -> Keeping {
        match row {
            None => self.envelope.keeps_under([a.tip, b.tip], height, |_| height),
            Some(slice) => self.envelope.keeps_under_on_row(slice, [a.tip, b.tip], |_| height),
        }
    }

    /// Whether exact positions between two may lie over the straight line by more than `most` mm: false where it is proven
    /// that none does, and where more triangles are near than are tried.
    #[must_use]
    pub(crate) fn may_rise(&self, row: Option<&Slice<'_>>, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        self.rise(row, a, b, fitting::in_height(a, b, most)) == Keeping::Over
    }

    /// As [`keeps_to`](Self::keeps_to), and that nothing is touched between two selected positions but what is selected.
    #[must_use]
    pub(crate) fn keeps_to_selected(&self, row: Option<&Slice<'_>>, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        let Some(selected) = self.selected else { return self.keeps_to(row, a, b, most) };
        let height = fitting::in_height(a, b, most);
        // nothing lies lower than that under the line, so what else does is not touched
        let limit = |is_selected: bool| if is_selected { height } else { -height };
        let line = [a.tip, b.tip];
        let stays_under = || match row {
            None => self.envelope.keeps_under(line, -height, |triangle| limit(selected[triangle as usize])),
            Some(slice) => self.envelope.keeps_under_on_row(slice, line, limit),
        };
        a.selected
            && b.selected
            && self.region.is_none_or(|region| !region.may_end_between(self.envelope, a, b))
            && self.dip(a, b) < height
            && stays_under() == Keeping::Under
    }

    /// How far positions between two may lie under the straight line, mm: no more than the floor does.
    fn dip(&self, a: &PathPoint, b: &PathPoint) -> f64 {
        let above_floor = a.tip.z.max(b.tip.z) - self.floor;
        if a.tip.z <= self.floor || b.tip.z <= self.floor {
            return above_floor.max(0.0); // what is touched under the floor shows nothing of the line
        }
        self.envelope.dip([a.tip, b.tip], [a.triangle, b.triangle]).min(above_floor)
    }

    /// A contact over (x, y) as a path point; on the floor where that is higher.
    #[must_use]
    pub fn path_point(&self, x: f64, y: f64, contact: &Contact) -> PathPoint {
        self.point_of([x, y], contact, false)
    }

    /// The same, of a contact of which it may be known that all that meets there is selected.
    fn point_of(&self, [x, y]: [f64; 2], contact: &Contact, is_selected: bool) -> PathPoint {
        let tip = Vector::new(x, y, contact.tip);
        let is_on_faces = |selected: &[bool]| self.envelope.belongs(contact, selected, SPREAD, self.rolling);
        let is_raised = tip.z < self.floor;
        PathPoint {
            tip: Vector::new(x, y, tip.z.max(self.floor)),
            normal: if is_raised { Vector::z() } else { contact.normal },
            selected: (self.heights[0]..=self.heights[1]).contains(&contact.tip)
                && (is_selected || self.selected.is_none_or(is_on_faces))
                && self.region.is_none_or(|region| region.allows(self.envelope, tip, contact.normal)),
            triangle: contact.triangle,
        }
    }

    /// The selected triangles.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = usize> + '_ {
        let counts = |t: &usize| self.selected.is_none_or(|selected| selected[*t]);
        (0..self.envelope.mesh().triangles().len()).filter(counts)
    }

    /// Lower and upper corner in plan of the positions from which the tool can touch a selected face, if any.
    #[must_use]
    pub fn domain(&self) -> Option<([f64; 2], [f64; 2])> {
        let mesh = self.envelope.mesh();
        let reach = self.envelope.cutter().max_radius();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for t in self.triangles() {
            for p in mesh.corners(t) {
                low = [low[0].min(p.x - reach), low[1].min(p.y - reach)];
                high = [high[0].max(p.x + reach), high[1].max(p.y + reach)];
            }
        }
        (low[0] <= high[0]).then_some((low, high))
    }
}

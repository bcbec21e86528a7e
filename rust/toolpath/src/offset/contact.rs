//! Exact contacts of a cutter with a triangle: on the facet, on an edge, on a corner.
//!
//! The contacts of drop-cutter: Yau, Chuang, Lee (2004), see [`super::envelope`].

mod under;

use rayon::prelude::*;
use styluscam_geometry::{Cutter, Vector};

use super::bending::Bending;
use super::edge;
use super::features::{in_plane, Owned, ALL};
use super::index::{Index, Triangles};
use super::normal;

/// Facets closer to vertical than this share of their normal have no facet contact worth its rounding.
const WALL: f64 = 1e-9;
/// An edge is across a direction when it runs along it by less than this share of its length.
const ACROSS: f64 = 1e-6;
/// A contact this share of the part's size outside its facet still counts: edges in a plane are not tried where the contacts
/// on both sides differ by no more, and rounding must not let a contact fall between two facets. The height is wrong by less
/// than this.
const OVERHANG: f64 = 1e-13;

/// The part of a triangle that is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Its inside.
    Facet,
    /// The edge from this corner to the next.
    Edge(u8),
    /// A corner.
    Corner(u8),
}

/// The highest contact found so far.
#[derive(Clone, Copy, Debug)]
pub struct Best {
    /// Height of the cutter's tip, mm; minus infinity before anything was found.
    pub tip: f64,
    /// The triangle by its number in the index.
    pub triangle: u32,
    pub feature: Feature,
    /// The contact in plan.
    pub at: [f64; 2],
}

impl Best {
    pub const NOTHING: Self =
        Self { tip: f64::NEG_INFINITY, triangle: u32::MAX, feature: Feature::Facet, at: [0.0; 2] };

    pub fn is_something(&self) -> bool {
        self.triangle != u32::MAX
    }

    /// Takes the higher; of equals the first triangle, so that the order of search does not show.
    #[inline]
    fn improve(&mut self, other: Self) {
        if other.tip > self.tip || (other.tip >= self.tip && other.triangle < self.triangle) {
            *self = other;
        }
    }
}

/// A facet made ready for one cutter.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// The facet's gradient dz/dx, dz/dy.
    gradient: [f64; 2],
    /// Contact relative to the axis, in plan, as a multiple of the gradient.
    share: f64,
    /// Height of the profile at the contact; NaN for walls: they have no facet contact.
    height: f64,
    /// By how much more the profile bends along its meridian than around its axis at the contact, as a share, over the
    /// square of the gradient.
    bend: f64,
}

/// A straight line of the cutter's tips.
#[derive(Clone, Copy, Debug)]
pub struct Chord {
    pub from: [f64; 2],
    /// From its beginning to its end, in plan,
    pub along: [f64; 2],
    /// and in height.
    pub rise: f64,
    /// Height of its beginning.
    pub tip: f64,
}

impl Chord {
    /// Position and height at a share of its length.
    pub fn at(&self, share: f64) -> ([f64; 2], f64) {
        ([0, 1].map(|i| self.from[i] + share * self.along[i]), self.tip + share * self.rise)
    }

    /// The part of it between two shares of its length.
    pub fn part(&self, from: f64, to: f64) -> Self {
        let (begin, tip) = self.at(from);
        Self { from: begin, along: self.along.map(|rate| (to - from) * rate), rise: (to - from) * self.rise, tip }
    }
}

/// The triangles of an index, made ready for one cutter.
pub struct Contacts<'a> {
    index: &'a Index,
    cutter: &'a Cutter,
    prepared: &'a Prepared,
}

/// What a cutter makes of the triangles of an index.
pub struct Prepared {
    facets: Vec<Facet>,
    /// Which edges and corners each has to try.
    owned: Vec<Owned>,
    /// How far beside it a triangle still counts as touched, mm.
    overhang: f64,
}

impl Prepared {
    /// `reach`: the largest coordinate of mesh and cutter, mm.
    pub fn of(index: &Index, cutter: &Cutter, reach: f64) -> Self {
        let (bending, overhang, triangles) = (Bending::of(cutter), OVERHANG * reach, index.triangles());
        let all = || (0..triangles.corners.len() as u32).into_par_iter();
        let facets: Vec<Facet> = all().map(|t| Facet::of(triangles, t, cutter, &bending)).collect();
        let owned = all().map(|t| owned_for(index, cutter, &facets, t, overhang)).collect();
        Self { facets, owned, overhang }
    }
}

/// The edges and corners that a triangle has to try.
///
/// All of them where rounding of the facet's tilt shifts its contact beside where it counts as touched: a flat end touches
/// a level facet anywhere. And an edge in a plane that the cutter touches at another point on its other side.
fn owned_for(index: &Index, cutter: &Cutter, facets: &[Facet], triangle: u32, overhang: f64) -> Owned {
    let (facet, owned) = (&facets[triangle as usize], index.owned(triangle));
    if facet.rounding_of_contact(index.triangles().at(triangle), cutter) > overhang {
        return ALL;
    }
    let neighbours = index.neighbours(triangle);
    let touches_apart = |other: &Facet| !facet.touches_as(other, overhang);
    let is_to_try =
        |edge: usize| owned & in_plane(edge) != 0 && facets.get(neighbours[edge] as usize).is_some_and(touches_apart);
    (0..3).filter(|edge| is_to_try(*edge)).fold(owned & ALL, |owned, edge| owned | 1 << edge)
}

impl Facet {
    fn of(triangles: &Triangles, triangle: u32, cutter: &Cutter, bending: &Bending) -> Self {
        let normal = normal::upward_or_level(triangles.at(triangle));
        let across = (normal.x * normal.x + normal.y * normal.y).sqrt();
        let (radius, height) = cutter.at_rise(across / normal.z);
        let gradient = [-normal.x / normal.z, -normal.y / normal.z];
        let share = if across > 0.0 { radius * normal.z / across } else { 0.0 };
        let square = gradient[0] * gradient[0] + gradient[1] * gradient[1];
        Self {
            gradient,
            share,
            height: if normal.z >= WALL { height } else { f64::NAN },
            bend: if square > 0.0 { bending.excess_at(radius) / square } else { 0.0 },
        }
    }

    /// The contact relative to the axis, in plan.
    fn contact(&self) -> [f64; 2] {
        self.gradient.map(|part| self.share * part)
    }

    /// Whether the cutter touches two facets at the same point, but for rounding.
    fn touches_as(&self, other: &Self, overhang: f64) -> bool {
        let ([x, y], [u, v]) = (self.contact(), other.contact());
        libm::hypot(x - u, y - v) <= overhang
    }

    /// How far rounding of the triangle's normal shifts the contact, mm; 0 for a facet that is level as given, and for walls.
    fn rounding_of_contact(&self, corners: [Vector; 3], cutter: &Cutter) -> f64 {
        let rise = libm::hypot(self.gradient[0], self.gradient[1]);
        if rise == 0.0 || self.height.is_nan() {
            return 0.0;
        }
        let tilt = normal::rounding(corners) * (1.0 + rise * rise);
        let [inner, outer] = [(rise - tilt).max(0.0), rise + tilt].map(|rise| cutter.at_rise(rise).0);
        (outer - inner) + (tilt / rise).min(1.0) * outer
    }
}

/// The vector in plan from a position to the nearest point of a segment.
fn gap_to_segment(position: [f64; 2], a: Vector, b: Vector) -> [f64; 2] {
    let (along, from) = ([b.x - a.x, b.y - a.y], [a.x - position[0], a.y - position[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let share = if square > 0.0 { (-(along[0] * from[0] + along[1] * from[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    [from[0] + share * along[0], from[1] + share * along[1]]
}

/// A triangle seen from a position and a height, mm.
pub struct Seen {
    pub corners: [[f64; 3]; 3],
    /// The contact of a cutter on its plane.
    pub contact: [f64; 2],
    /// Height of the tip of a cutter on its plane; infinite for walls.
    pub plane: f64,
    /// The plane's gradient.
    pub gradient: [f64; 2],
    /// By how much more the profile bends along its meridian than around its axis there, as a share, over the square
    /// of the gradient.
    pub bend: f64,
}

/// A triangle seen from the cutter's contact with its plane.
struct View {
    corners: [Vector; 3],
    contact: [f64; 2],
    /// Tip height with the cutter on the plane, mm; NaN for walls.
    tip: f64,
    sides: [Side; 3],
}

/// An edge in plan, seen from the contact.
#[derive(Clone, Copy)]
struct Side {
    /// Twice the area that it spans with the contact, positive inside.
    area: f64,
    /// What rounding makes of no area.
    rounding: f64,
}

impl<'a> Contacts<'a> {
    pub fn new(index: &'a Index, cutter: &'a Cutter, prepared: &'a Prepared) -> Self {
        Self { index, cutter, prepared }
    }

    /// How far beside it a triangle still counts as touched, mm.
    pub fn overhang(&self) -> f64 {
        self.prepared.overhang
    }

    /// Which edges and corners a triangle has to try.
    pub fn owned(&self, triangle: u32) -> Owned {
        self.prepared.owned[triangle as usize]
    }

    fn facet(&self, triangle: u32) -> &'a Facet {
        &self.prepared.facets[triangle as usize]
    }

    /// Tries all of a triangle that it owns.
    ///
    /// The contact with the facet's whole plane is at least as high as any with the triangle. Where it lies outside,
    /// the height, concave over the triangle, is largest on an edge that is seen from it, or on a wall anywhere.
    #[inline]
    pub fn touch(&self, triangle: u32, position: [f64; 2], found: &mut Best) {
        if triangle == found.triangle {
            return;
        }
        self.touch_owned(triangle, self.owned(triangle), position, found);
    }

    /// A triangle seen from a position and a height.
    #[inline]
    pub fn seen(&self, triangle: u32, [x, y]: [f64; 2], zero: f64) -> Seen {
        let facet = self.facet(triangle);
        let Facet { gradient: [gx, gy], height, bend, .. } = *facet;
        let corners = self.index.triangles().at(triangle).map(|corner| [corner.x - x, corner.y - y, corner.z - zero]);
        let contact = facet.contact();
        let [first, ..] = corners;
        let plane = first[2] + gx * (contact[0] - first[0]) + gy * (contact[1] - first[1]) - height;
        Seen { corners, contact, plane: if plane.is_nan() { f64::INFINITY } else { plane }, gradient: [gx, gy], bend }
    }

    /// Tries one part of a triangle; of its inside, the whole plane.
    #[inline]
    pub fn touch_feature(&self, triangle: u32, feature: Feature, [x, y]: [f64; 2], found: &mut Best) {
        let Facet { gradient: [gx, gy], share, height, .. } = *self.facet(triangle);
        let corners = self.index.triangles().at(triangle);
        let contact = [x + share * gx, y + share * gy];
        match feature {
            Feature::Facet => {
                let origin = corners[0];
                let tip = origin.z + gx * (contact[0] - origin.x) + gy * (contact[1] - origin.y) - height;
                found.improve(Best { tip, triangle, feature, at: contact });
            }
            Feature::Edge(i) => self.touch_edge((corners, contact), triangle, usize::from(i), [x, y], found),
            Feature::Corner(i) => self.touch_corner(corners[usize::from(i)], triangle, i, x, y, found),
        }
    }

    /// The plane of a triangle for the cutter: gradient, contact relative to the axis in plan, and the profile's height there, NaN
    /// for walls.
    #[inline]
    pub fn plane(&self, triangle: u32) -> ([f64; 2], [f64; 2], f64) {
        let facet = self.facet(triangle);
        (facet.gradient, facet.contact(), facet.height)
    }

    pub fn cutter(&self) -> &'a Cutter {
        self.cutter
    }

    pub fn index(&self) -> &'a Index {
        self.index
    }

    /// Tries all of a triangle, whether others try it too or not.
    pub fn touch_whole(&self, triangle: u32, position: [f64; 2], found: &mut Best) {
        self.touch_owned(triangle, ALL, position, found);
    }

    #[inline]
    fn touch_owned(&self, triangle: u32, owned: Owned, [x, y]: [f64; 2], found: &mut Best) {
        let Facet { gradient: [gx, gy], share, height, .. } = *self.facet(triangle);
        let corners = self.index.triangles().at(triangle);
        let contact = [x + share * gx, y + share * gy];
        let origin = corners[0];
        let tip = origin.z + gx * (contact[0] - origin.x) + gy * (contact[1] - origin.y) - height;
        if tip < found.tip {
            return; // never for a wall: its height is NaN
        }
        let view = View { corners, contact, tip, sides: self.sides(&corners, contact) };
        let sees_all = view.sides.iter().all(|side| side.area >= -side.rounding);
        if !tip.is_nan() && sees_all && self.is_in_box(&corners, contact) {
            found.improve(Best { tip, triangle, feature: Feature::Facet, at: contact });
            return;
        }
        self.touch_border(triangle, owned, &view, [x, y], found);
    }

    /// Whether a contact lies in the box around a triangle in plan: a triangle that is a line there has no sides.
    #[inline]
    fn is_in_box(&self, [a, b, c]: &[Vector; 3], contact: [f64; 2]) -> bool {
        (0..2).all(|i| {
            let (low, high) = (a[i].min(b[i]).min(c[i]), a[i].max(b[i]).max(c[i]));
            contact[i] >= low - self.overhang() && contact[i] <= high + self.overhang()
        })
    }

    #[inline]
    fn sides(&self, corners: &[Vector; 3], contact: [f64; 2]) -> [Side; 3] {
        let [a, b, c] = *corners;
        let turn = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)).signum();
        std::array::from_fn(|i| {
            let (p, q) = (corners[i], corners[(i + 1) % 3]);
            let (ex, ey) = (q.x - p.x, q.y - p.y);
            let side = ex * (contact[1] - p.y) - ey * (contact[0] - p.x);
            Side { area: turn * side, rounding: self.overhang() * (ex.abs() + ey.abs()) }
        })
    }

    fn touch_border(&self, triangle: u32, owned: Owned, view: &View, [x, y]: [f64; 2], found: &mut Best) {
        let seen = |i: usize| view.tip.is_nan() || view.sides[i].area < view.sides[i].rounding;
        for i in 0..3 {
            if owned & (8 << i) != 0 && (seen(i) || seen((i + 2) % 3)) {
                self.touch_corner(view.corners[i], triangle, i as u8, x, y, found);
            }
        }
        for i in 0..3 {
            if owned & (1 << i) != 0 && seen(i) {
                self.touch_edge((view.corners, view.contact), triangle, i, [x, y], found);
            }
        }
    }

    #[inline]
    fn touch_corner(&self, corner: Vector, triangle: u32, number: u8, x: f64, y: f64, found: &mut Best) {
        let (dx, dy) = (corner.x - x, corner.y - y);
        let (distance, rim) = ((dx * dx + dy * dy).sqrt(), self.cutter.max_radius());
        if distance > rim + self.overhang() {
            return;
        }
        // beside the rim by rounding: the rim may meet the edges there, a rounding beyond their ends
        let distance = distance.min(rim);
        if corner.z - self.cutter.height_bound(distance) < found.tip {
            return;
        }
        let tip = corner.z - self.cutter.quick_height_at_radius(distance);
        found.improve(Best { tip, triangle, feature: Feature::Corner(number), at: [corner.x, corner.y] });
    }

    fn touch_edge(
        &self,
        (corners, contact): ([Vector; 3], [f64; 2]),
        triangle: u32,
        number: usize,
        position: [f64; 2],
        found: &mut Best,
    ) {
        let (a, b) = (corners[number], corners[(number + 1) % 3]);
        if let Some(touch) = edge::touch(self.cutter, [a, b], position, contact, found.tip) {
            let at = [a.x + touch.share * (b.x - a.x), a.y + touch.share * (b.y - a.y)];
            found.improve(Best { tip: touch.tip, triangle, feature: Feature::Edge(number as u8), at });
        }
    }

    /// The neighbour towards the cutter's contact with a triangle's plane; none where the contact lies inside.
    #[inline]
    pub fn towards(&self, triangle: u32, [x, y]: [f64; 2]) -> Option<u32> {
        let Facet { gradient: [gx, gy], share, .. } = *self.facet(triangle);
        let corners = self.index.triangles().at(triangle);
        let sides = self.sides(&corners, [x + share * gx, y + share * gy]);
        let farthest =
            (0..3).filter(|i| sides[*i].area < 0.0).min_by(|i, j| sides[*i].area.total_cmp(&sides[*j].area))?;
        Some(self.index.neighbours(triangle)[farthest])
    }

    /// What the tips that a triangle alone asks for do not exceed in a tile over which they rise `towards` somewhere;
    /// infinite where that is not known. What stays below `enough` may be overestimated.
    ///
    /// They are concave over the plan. So they stay below their tangent over any position; over the corner to which they
    /// rise it is hardly higher than they are.
    pub fn greatest(&self, triangle: u32, middle: [f64; 2], half: [f64; 2], towards: [f32; 2], enough: f64) -> f64 {
        let plane = self.greatest_of_plane(triangle, middle, half);
        if plane <= enough {
            return plane;
        }
        let sides = towards.map(|towards| 1_f64.copysign(f64::from(towards)));
        let corner = [0, 1].map(|i| middle[i] + sides[i] * half[i]);
        let apart = self.greatest_apart(triangle, corner, half, sides);
        if apart <= enough {
            return apart;
        }
        let Some((tip, rise)) = self.tangent(triangle, corner) else { return apart };
        // what still rises from that corner into the tile
        let back = [0, 1].map(|i| (-rise[i] * sides[i]).max(0.0) * 2.0 * half[i]);
        let most = tip + back[0] + back[1];
        if most.is_nan() {
            f64::INFINITY
        } else {
            most
        }
    }

    /// What the tips that a triangle's whole plane asks for do not exceed in a tile; NaN for walls.
    fn greatest_of_plane(&self, triangle: u32, middle: [f64; 2], half: [f64; 2]) -> f64 {
        let Facet { gradient: [gx, gy], share, height, .. } = *self.facet(triangle);
        let [origin, ..] = self.index.triangles().at(triangle);
        let [dx, dy] = [middle[0] + share * gx - origin.x, middle[1] + share * gy - origin.y];
        origin.z + gx * dx + gy * dy - height + gx.abs() * half[0] + gy.abs() * half[1]
    }

    /// What the tips that a triangle asks for do not exceed in a tile by their distance in plan alone.
    fn greatest_apart(&self, triangle: u32, corner: [f64; 2], half: [f64; 2], sides: [f64; 2]) -> f64 {
        let corners = self.index.triangles().at(triangle);
        let apart = self.apart(&corners, corner, half, sides);
        if apart > self.cutter.max_radius() {
            return f64::NEG_INFINITY;
        }
        corners.iter().fold(f64::NEG_INFINITY, |most, p| most.max(p.z)) - self.cutter.height_bound(apart)
    }

    /// How far a triangle and a tile are apart in plan at least, seen from a corner of the tile.
    fn apart(&self, corners: &[Vector; 3], corner: [f64; 2], half: [f64; 2], sides: [f64; 2]) -> f64 {
        if self.sides(corners, corner).iter().all(|side| side.area >= 0.0) {
            return 0.0;
        }
        let gaps = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| gap_to_segment(corner, corners[i], corners[j]));
        let distance = |gap: &[f64; 2]| libm::hypot(gap[0], gap[1]);
        let nearest = gaps.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or([0.0; 2]);
        // the triangle lies beyond a line across the gap; some of the tile may be nearer to it than the corner is
        let back = [0, 1].map(|i| (-nearest[i] * sides[i]).max(0.0) * 2.0 * half[i]);
        let apart = distance(&nearest);
        if apart > 0.0 {
            (apart - (back[0] + back[1]) / apart).max(0.0)
        } else {
            0.0
        }
    }

    /// What a triangle alone asks for is nowhere in a tile less than this.
    pub fn least(&self, triangle: u32, middle: [f64; 2], half: [f64; 2]) -> f64 {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let tips = corners.map(|corner| {
            let mut alone = Best::NOTHING;
            self.touch_whole(triangle, [0, 1].map(|i| middle[i] + corner[i] * half[i]), &mut alone);
            alone.tip
        });
        tips.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The tip that a triangle alone asks for over a position, and its gradient there: towards the contact.
    fn tangent(&self, triangle: u32, position: [f64; 2]) -> Option<(f64, [f64; 2])> {
        let mut alone = Best::NOTHING;
        self.touch_whole(triangle, position, &mut alone);
        alone.is_something().then(|| (alone.tip, self.gradient(&alone, position)))
    }

    /// The same of one part of a triangle, an edge with its ends.
    fn tangent_of(&self, triangle: u32, feature: Feature, position: [f64; 2]) -> Option<(f64, [f64; 2])> {
        let mut alone = Best::NOTHING;
        self.touch_feature(triangle, feature, position, &mut alone);
        if let (Feature::Edge(i), false) = (feature, alone.is_something()) {
            for end in [i, (i + 1) % 3] {
                self.touch_feature(triangle, Feature::Corner(end), position, &mut alone);
            }
        }
        alone.is_something().then(|| (alone.tip, self.gradient(&alone, position)))
    }

    /// The gradient of the tips that what is touched asks for, at a position: towards the contact.
    pub fn gradient(&self, best: &Best, position: [f64; 2]) -> [f64; 2] {
        let away = [0, 1].map(|i| best.at[i] - position[i]);
        let distance = libm::hypot(away[0], away[1]);
        let by_table = match best.feature {
            Feature::Facet => return self.facet(best.triangle).gradient,
            Feature::Edge(i) => self.steepness_on_edge(best.triangle, i, away.map(|a| a / distance)),
            Feature::Corner(_) => self.cutter.height_with_derivatives(distance).map(|height| height.rise),
        };
        let steep = by_table.unwrap_or_else(|| libm::tan(self.slope(best, position)));
        let rise = if distance > 0.0 { steep / distance } else { 0.0 };
        away.map(|a| rise * a)
    }

    /// Steepness of the contact with an edge that lies in some direction from the axis: along the edge it is the edge's.
    /// None where the direction is across the edge.
    fn steepness_on_edge(&self, triangle: u32, number: u8, towards: [f64; 2]) -> Option<f64> {
        let corners = self.index.triangles().at(triangle);
        let (a, b) = (corners[usize::from(number)], corners[(usize::from(number) + 1) % 3]);
        let run = (b.x - a.x) * towards[0] + (b.y - a.y) * towards[1];
        let steep = (b.z - a.z) / run;
        (run.abs() > ACROSS * (b - a).norm() && steep > 0.0).then_some(steep)
    }

    /// Height of a contact, mm.
    pub fn height_at(&self, best: &Best) -> f64 {
        let corners = self.index.triangles().at(best.triangle);
        match best.feature {
            Feature::Facet => best.tip + self.facet(best.triangle).height,
            Feature::Edge(i) => {
                let (a, b) = (corners[usize::from(i)], corners[(usize::from(i) + 1) % 3]);
                let along = [b.x - a.x, b.y - a.y];
                let from = [best.at[0] - a.x, best.at[1] - a.y];
                let share = (along[0] * from[0] + along[1] * from[1]) / (along[0] * along[0] + along[1] * along[1]);
                a.z + share * (b.z - a.z)
            }
            Feature::Corner(i) => corners[usize::from(i)].z,
        }
    }

    /// Slope of a contact, rad.
    pub fn slope(&self, best: &Best, [x, y]: [f64; 2]) -> f64 {
        let corners = self.index.triangles().at(best.triangle);
        match best.feature {
            Feature::Facet => {
                let normal = normal::upward(corners);
                libm::atan2(libm::hypot(normal.x, normal.y), normal.z)
            }
            Feature::Edge(i) => {
                let (a, b) = (corners[usize::from(i)], corners[(usize::from(i) + 1) % 3]);
                edge::slope(self.cutter, a, b, x, y)
            }
            Feature::Corner(_) => self.cutter.slope_at_radius(libm::hypot(best.at[0] - x, best.at[1] - y)),
        }
    }
}

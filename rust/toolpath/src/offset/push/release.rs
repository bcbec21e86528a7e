//! How far a triangle keeps a tool off along a horizontal line: the push-cutter's three contacts.
//!
//! A tool that stands at a height and moves along a line is kept off by a point q of the triangle on an interval of the
//! line: to the ends a(q) -+ sqrt(r(q)^2 - b(q)^2), with a the position of q along the line, b its distance beside it and r
//! the tool's radius at the height of q. The far end is concave in q, so that it is largest on the facet where slopes
//! match, or on an edge, or at a corner; the triangle keeps the tool off up to there.

use styluscam_geometry::{Cutter, Vector};

use super::super::contact::Feature;
use super::super::normal;

/// Steps of a search on an edge at most: halving alone would need sixty.
const STEPS: usize = 120;
/// Steps after which only halves are taken: beside a kink secants creep.
const SECANTS: usize = 24;
/// A search ends where what is still to gain is this share of the lengths involved.
const FLAT: f64 = 1e-15;

/// A horizontal line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Where it begins, in plan, mm.
    pub from: [f64; 2],
    /// Its direction in plan, of length one.
    pub along: [f64; 2],
}

/// Where a tool gets free of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Release {
    /// Position along the line, mm.
    pub travel: f64,
    /// The point of the triangle that is touched last.
    pub point: Vector,
    /// Slope of the tool there, rad.
    pub slope: f64,
    /// The part of the triangle that it belongs to.
    pub feature: Feature,
}

impl Line {
    /// From a position in a direction of any length; none for a direction without one, or what is not finite.
    #[must_use]
    pub fn new(from: [f64; 2], along: [f64; 2]) -> Option<Self> {
        let length = libm::hypot(along[0], along[1]);
        let line = Self { from, along: along.map(|a| a / length) };
        from.into_iter().chain(line.along).all(f64::is_finite).then_some(line)
    }

    /// The position in plan after a travel, mm.
    #[must_use]
    pub fn at(&self, travel: f64) -> [f64; 2] {
        [self.from[0] + travel * self.along[0], self.from[1] + travel * self.along[1]]
    }

    /// The same line in the other direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { along: self.along.map(|a| -a), ..*self }
    }

    /// Position along and distance beside the line of a vector from its beginning, mm.
    fn seen(&self, away: [f64; 2]) -> [f64; 2] {
        let [ux, uy] = self.along;
        [ux * away[0] + uy * away[1], ux * away[1] - uy * away[0]]
    }
}

/// Where along `line` a cutter with its tip at `z` gets free of a triangle; none when the triangle never keeps it off.
pub fn release(cutter: &Cutter, corners: &[Vector; 3], line: &Line, z: f64) -> Option<Release> {
    if corners.iter().all(|corner| corner.z <= z) {
        return None;
    }
    if let Some(found) = of_facet(cutter, corners, line, z) {
        return Some(found);
    }
    let ends = corners.map(|corner| End::of(corner, line, z));
    let mut best: Option<Release> = None;
    let mut keep = |found: Option<Release>| {
        if let Some(found) = found.filter(|found| best.is_none_or(|best| found.travel > best.travel)) {
            best = Some(found);
        }
    };
    for i in 0..3_u8 {
        keep(of_corner(cutter, corners[usize::from(i)], &ends[usize::from(i)], i));
    }
    for i in 0..3_u8 {
        let (first, last) = (usize::from(i), (usize::from(i) + 1) % 3);
        keep(of_edge(cutter, [corners[first], corners[last]], [&ends[first], &ends[last]], i));
    }
    best
}

/// A point as the moving tool sees it, mm: position along the line, distance beside it, height over the tip.
struct End {
    along: f64,
    beside: f64,
    height: f64,
}

impl End {
    fn of(point: Vector, line: &Line, z: f64) -> Self {
        let [along, beside] = line.seen([point.x - line.from[0], point.y - line.from[1]]);
        Self { along, beside, height: point.z - z }
    }
}

/// The contact on the facet where slopes match, if it lies inside.
fn of_facet(cutter: &Cutter, corners: &[Vector; 3], line: &Line, z: f64) -> Option<Release> {
    let normal = normal::upward(*corners);
    let across = libm::hypot(normal.x, normal.y);
    let leaves = normal.x * line.along[0] + normal.y * line.along[1];
    if leaves.is_nan() || leaves <= 0.0 {
        return None;
    }
    let slope = libm::atan2(across, normal.z);
    let (radius, height) = cutter.point_at(slope);
    let share = radius / across;
    // the axis stands where the contact, radius behind it and height over the tip, lies in the plane
    let [anchor, ..] = *corners;
    let [dx, dy] = [anchor.x - line.from[0], anchor.y - line.from[1]];
    let off = normal.x * dx + normal.y * dy + normal.z * (anchor.z - z - height);
    let travel = (off + across * radius) / leaves;
    let [x, y] = line.at(travel);
    let point = Vector::new(x - share * normal.x, y - share * normal.y, z + height);
    (travel.is_finite() && is_inside(corners, point)).then_some(Release {
        travel,
        point,
        slope,
        feature: Feature::Facet,
    })
}

/// Whether a point of a triangle's plane lies in the triangle.
fn is_inside([a, b, c]: &[Vector; 3], point: Vector) -> bool {
    [(a, b, c), (b, c, a), (c, a, b)].into_iter().all(|(p, q, third)| {
        let inward = (q - p).cross(&(third - p));
        (q - p).cross(&(point - p)).dot(&inward) >= 0.0
    })
}

fn of_corner(cutter: &Cutter, corner: Vector, end: &End, number: u8) -> Option<Release> {
    if end.height <= 0.0 {
        return None;
    }
    let (radius, rise) = cutter.at_height(end.height);
    let beside = end.beside.abs();
    let ahead = ((radius - beside) * (radius + beside)).sqrt();
    (beside <= radius).then(|| Release {
        travel: end.along + ahead,
        point: corner,
        slope: libm::atan(rise),
        feature: Feature::Corner(number),
    })
}

/// The contact inside an edge.
fn of_edge(cutter: &Cutter, corners: [Vector; 2], ends: [&End; 2], number: u8) -> Option<Release> {
    let edge = Edge {
        along: ends[1].along - ends[0].along,
        beside: ends[1].beside - ends[0].beside,
        rise: ends[1].height - ends[0].height,
        first: ends[0],
    };
    let share = edge.top(cutter)?;
    let Standing { travel, steep, .. } = edge.at(cutter, share);
    let point = corners[0] + (corners[1] - corners[0]) * share;
    travel.map(|travel| Release { travel, point, slope: libm::atan(steep), feature: Feature::Edge(number) })
}

/// An edge as the moving tool sees it; its points are given by their share of it.
struct Edge<'a> {
    first: &'a End,
    along: f64,
    beside: f64,
    rise: f64,
}

/// What a point of an edge does to the tool.
struct Standing {
    /// Where it lets the tool go, mm; none where it does not keep it off.
    travel: Option<f64>,
    /// Steepness of the tool at its height.
    steep: f64,
    /// In which direction along the edge the tool is kept longer, or, where it is not kept off, in which it would be; a
    /// rate of `travel` by the share of the edge where there is a travel.
    pull: f64,
}

impl Edge<'_> {
    fn at(&self, cutter: &Cutter, share: f64) -> Standing {
        let height = self.first.height + share * self.rise;
        if height <= 0.0 {
            return Standing { travel: None, steep: 0.0, pull: self.rise };
        }
        let (radius, steep) = cutter.at_height(height);
        let beside = self.first.beside + share * self.beside;
        // along the edge the radius grows by this
        let wider = self.rise / steep;
        let square = (radius - beside) * (radius + beside);
        if square <= 0.0 {
            let pull = wider - self.beside.copysign(self.beside * beside);
            return Standing { travel: None, steep, pull };
        }
        let ahead = square.sqrt();
        let pull = self.along + (radius * wider - beside * self.beside) / ahead;
        Standing { travel: Some(self.first.along + share * self.along + ahead), steep, pull }
    }

    /// The share at which the edge keeps the tool longest, if it is inside the edge.
    fn top(&self, cutter: &Cutter) -> Option<f64> {
        let (mut low, mut high) = ((0.0, self.at(cutter, 0.0)), (1.0, self.at(cutter, 1.0)));
        if !(low.1.pull > 0.0 && high.1.pull < 0.0) {
            return None;
        }
        let size = self.along.abs() + self.beside.abs() + self.rise.abs() + cutter.max_radius();
        for step in 0..STEPS {
            let both = low.1.travel.is_some() && high.1.travel.is_some() && step < SECANTS && step % 3 != 2;
            let part = if both { low.1.pull / (low.1.pull - high.1.pull) } else { 0.5 };
            // a secant never lands on an end
            let part = if part.is_nan() { 0.5 } else { part.clamp(1e-3, 1.0 - 1e-3) };
            let share = low.0 + part * (high.0 - low.0);
            let standing = self.at(cutter, share);
            let rest = if standing.pull > 0.0 { high.0 - share } else { share - low.0 };
            if standing.travel.is_some() && standing.pull.abs() * rest <= FLAT * size {
                return Some(share);
            }
            if standing.pull > 0.0 {
                low = (share, standing);
            } else {
                high = (share, standing);
            }
            if rest <= f64::EPSILON * share {
                break;
            }
        }
        // where the edge dips under the tip, only one side of the top keeps the tool off
        Some(if low.1.travel >= high.1.travel { low.0 } else { high.0 })
    }
}

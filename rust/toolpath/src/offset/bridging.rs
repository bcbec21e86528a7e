//! Where the tool bridges: the part is more curved than the tool, and some of it stays untouched.

use std::collections::BTreeMap;

use rayon::prelude::*;
use styluscam_geometry::{Sheet, Tool, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::{slope_matched_offset, Envelope};

/// A point of the part of which something keeps the tool's slope-matched position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopped {
    /// The triangle on which it lies.
    pub triangle: u32,
    /// The point.
    pub point: Vector,
    /// Whether the part is more curved there than the tool; else it lies beside an obstacle.
    pub is_smooth: bool,
    /// Area that it stands for, mm^2.
    pub area: f64,
}

/// A point of the part that no free position of the tool touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bridge {
    /// The point of the mesh.
    pub point: Vector,
    /// The face it lies on.
    pub face: u32,
    /// What stays between it and the nearest free position of the tool (with the sheet), mm: along the normal, or the distance
    /// where the normal leads along a wall.
    pub excess: f64,
}

/// What stays untouched of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bridges {
    /// The face.
    pub face: u32,
    /// Share of the area of the points in corners that no free position touches, 0 to 1.
    pub share_left: f64,
    /// The worst of them.
    pub worst: Option<Bridge>,
}

/// What stays at a point of a triangle at most, mm, found by another method; it may give any number that is no more than the last
/// argument where that is enough to know.
pub type Left<'a> = dyn Fn(u32, Vector, f64) -> f64 + Sync + 'a;

/// Halvings of the search for the nearest position: the last interval is a 1e-4 of the tool.
const STEPS: usize = 20;
const RATIO: f64 = 0.618_033_988_749_894_9;

/// A point counts as on the tool within this, mm.
const ON_TOOL: f64 = 1e-5;
/// Along a normal the tool is at most so many times as far as in any direction: a ball in a square corner leaves its radius
/// along either wall, and 0.414 of it between them.
const ALONG_WALL: f64 = 2.5;
/// Share of the distance to a triangle's middle by which points are moved inside.
const INSIDE: f64 = 0.02;
/// Of a face's points that a line does not show to be touched, so many of the worst are measured first, and one in so many.
const EVERY: usize = 4;
const WORST: usize = 4;
/// Steps of a climb at most: across a face of 200 samples it is one or two dozen.
const CLIMB: usize = 200;
/// Positions tried around a point: shares of the tool's radius, the widest first, and directions.
const RINGS: [f64; 4] = [0.98, 0.75, 0.5, 0.25];
const DIRECTIONS: u32 = 24;
/// What a step of a climb gains at least, as a share.
const GAIN: f64 = 1e-3;

/// What of `points` stays more than `limit` mm away from every free position, by face; the worst one
/// is followed uphill from triangle to triangle.
///
/// A point is touched where the envelope is as low as the slope-matched offset. Elsewhere the nearest free
/// position is looked for along the steepest line through the point, on both sides, and by `left`.
///
/// # Errors
/// `Cancelled`.
pub fn bridges(
    envelope: &Envelope<'_>,
    tool: &Tool,
    sheet: Option<&Sheet>,
    points: &[Stopped],
    limit: f64,
    left: &Left<'_>,
    watch: &Watch,
) -> Result<Vec<Bridges>, Cancelled> {
    watch.begin("bridging", points.len());
    let probe = Probe { envelope, tool, sheet, limit, left };
    let face = |stopped: &Stopped| envelope.mesh().faces()[stopped.triangle as usize];
    let mut by_face: BTreeMap<u32, Vec<Stopped>> = BTreeMap::new();
    for stopped in points {
        by_face.entry(face(stopped)).or_default().push(*stopped);
    }
    let of_face = |(face, points): (u32, Vec<Stopped>)| {
        let found = probe.of_face(&points, watch)?;
        let worst = found.worst.map(|(stopped, bridge)| probe.climbed(&stopped, bridge));
        Ok(Bridges { face, share_left: found.share_left(), worst })
    };
    by_face.into_iter().collect::<Vec<_>>().into_par_iter().map(of_face).collect()
}

/// What a face's points came to.
struct Candidates {
    /// Area in corners, and of it the left, mm^2.
    corners: f64,
    left: f64,
    worst: Option<(Stopped, Bridge)>,
}

/// A point that the tool does not touch along the steepest line through it: there it stays so far away, mm.
#[derive(Clone, Copy)]
struct Open<'p> {
    stopped: &'p Stopped,
    along: f64,
}

impl Candidates {
    /// Keeps the worst.
    fn consider(&mut self, stopped: &Stopped, bridge: Option<Bridge>) {
        let worse = |bridge: &Bridge| self.worst.is_none_or(|(_, worst)| bridge.excess > worst.excess);
        self.worst = bridge.filter(worse).map(|bridge| (*stopped, bridge)).or(self.worst);
    }

    /// The share of the corners at which something is left; of none, it is not known that the tool gets there.
    fn share_left(&self) -> f64 {
        if self.corners > 0.0 {
            self.left / self.corners
        } else {
            1.0
        }
    }
}

struct Probe<'a> {
    envelope: &'a Envelope<'a>,
    tool: &'a Tool,
    sheet: Option<&'a Sheet>,
    limit: f64,
    left: &'a Left<'a>,
}

impl Probe<'_> {
    /// What the points of a face come to.
    ///
    /// The distance along a line shows most of those that are touched, and is more where more stays. Of the others a few are
    /// measured; where these are parted by that distance into some at which something stays and some at which nothing does, so
    /// are the rest, and only those between are measured too.
    fn of_face(&self, points: &[Stopped], watch: &Watch) -> Result<Candidates, Cancelled> {
        let along = points.par_iter().map(|stopped| self.along_line(stopped.triangle, self.probed(stopped)));
        let along: Vec<Option<f64>> = along.collect();
        let open = points.iter().zip(along).filter_map(|(stopped, along)| Some(Open { stopped, along: along? }));
        let mut open: Vec<Open<'_>> = open.filter(|point| point.along > self.limit).collect();
        watch.advance(points.len() - open.len())?;
        open.sort_by(|a, b| b.along.total_cmp(&a.along));
        let (few, rest): (Vec<_>, Vec<_>) = open.iter().enumerate().partition(|(i, _)| *i < WORST || i % EVERY == 0);
        let [few, rest] = [few, rest].map(|points| points.into_iter().map(|(_, point)| *point).collect::<Vec<_>>());
        let mut measured = self.measured(few, watch)?;
        let range = |measured: &[(Open<'_>, Option<Bridge>)], stays: bool| {
            let of = measured.iter().filter(move |(_, bridge)| bridge.is_some() == stays).map(|(point, _)| point.along);
            of.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        let ([_, touched], [left, _]) = (range(&measured, false), range(&measured, true));
        let is_open = |point: &Open<'_>| left <= touched || (point.along > touched && point.along < left);
        let (between, known): (Vec<_>, Vec<_>) = rest.into_iter().partition(is_open);
        watch.advance(known.len())?;
        measured.extend(self.measured(between, watch)?);
        let area = |stopped: &Stopped| if stopped.is_smooth { 0.0 } else { stopped.area };
        let left_at = measured.iter().filter(|(_, bridge)| bridge.is_some()).map(|(point, _)| point.stopped);
        let known_left = known.iter().filter(|point| point.along >= left).map(|point| point.stopped);
        let mut found = Candidates {
            corners: points.iter().map(area).sum(),
            left: left_at.chain(known_left).map(area).sum(),
            worst: None,
        };
        measured.into_iter().for_each(|(point, bridge)| found.consider(point.stopped, bridge));
        Ok(found)
    }

    /// The points with what stays at each, if it is more than the limit.
    fn measured<'p>(&self, points: Vec<Open<'p>>, watch: &Watch) -> Result<Vec<(Open<'p>, Option<Bridge>)>, Cancelled> {
        let of_point = |point: Open<'p>| {
            watch.advance(1)?;
            let Open { stopped, along } = point;
            Ok((point, self.beside(stopped.triangle, self.probed(stopped), along, self.limit)))
        };
        points.into_par_iter().map(of_point).collect()
    }

    /// Where it is looked for what stays at a point.
    fn probed(&self, stopped: &Stopped) -> Vector {
        let [a, b, c] = self.envelope.mesh().corners(stopped.triangle as usize);
        inside(stopped.point, (a + b + c) / 3.0)
    }
    /// The worst of the corners and the middles of some triangles, with its triangle, if it is clearly worse than `bridge`.
    fn worse(&self, triangles: impl Iterator<Item = u32>, bridge: &Bridge) -> Option<(u32, Bridge)> {
        let mut worst = None;
        let mut least = bridge.excess * (1.0 + GAIN);
        for triangle in triangles {
            let [a, b, c] = self.envelope.mesh().corners(triangle as usize);
            let middle = (a + b + c) / 3.0;
            for point in [middle, inside(a, middle), inside(b, middle), inside(c, middle)] {
                if let Some(bridge) = self.at(triangle, point, least) {
                    (least, worst) = (bridge.excess, Some((triangle, bridge)));
                }
            }
        }
        worst
    }

    /// From triangle to neighbour as long as the excess grows; of a smooth point the excess found is then measured along
    /// the normal.
    fn climbed(&self, from: &Stopped, bridge: Bridge) -> Bridge {
        let faces = self.envelope.mesh().faces();
        let (mut triangle, mut best) = (from.triangle, bridge);
        for _ in 0..CLIMB {
            let beside = self.envelope.neighbours(triangle).into_iter();
            let beside = beside.filter(|t| faces.get(*t as usize).is_some_and(|face| *face == bridge.face));
            let Some(next) = self.worse(beside, &best) else { break };
            (triangle, best) = next;
        }
        Bridge { excess: self.along_normal(triangle, &best).unwrap_or(best.excess), ..best }
    }

    /// From the point along the normal, each time as far as nothing of the tool can be: that ends on the tool, or goes on
    /// along a wall.
    fn along_normal(&self, triangle: u32, bridge: &Bridge) -> Option<f64> {
        let normal = self.envelope.mesh().normal(triangle as usize);
        let mut length = bridge.excess;
        for _ in 0..CLIMB {
            let gap = self.nearest(triangle, bridge.point + normal * length)?;
            if gap < ON_TOOL {
                break;
            }
            length += gap;
        }
        (length <= ALONG_WALL * bridge.excess).then_some(length)
    }

    /// What stays between a point of a triangle and the nearest free position, if it is more than `least`, mm, which is the
    /// limit or more.
    fn at(&self, triangle: u32, point: Vector, least: f64) -> Option<Bridge> {
        let along = self.along_line(triangle, point).filter(|along| *along > least)?;
        self.beside(triangle, point, along, least)
    }

    /// The distance from a point of a triangle to the nearest free position along the steepest line there, mm: quickly found, and
    /// no shorter than what stays. None where the tool touches the point.
    fn along_line(&self, triangle: u32, point: Vector) -> Option<f64> {
        let normal = self.envelope.mesh().normal(triangle as usize);
        let (matched, _) = slope_matched_offset(self.tool, self.sheet, point, normal);
        let free = self.envelope.contact_near(matched.x, matched.y, &mut Some(triangle))?;
        if (free.tip - matched.z) * normal.z.abs() <= self.limit {
            return None;
        }
        self.nearest(triangle, point)
    }

    /// What stays at a point, of which the distance `along` a line is known, if it is more than `least`, mm.
    fn beside(&self, triangle: u32, point: Vector, along: f64, least: f64) -> Option<Bridge> {
        let excess = Some(along).filter(|along| *along > least)?;
        let excess = excess.min((self.left)(triangle, point, least));
        let excess = if excess > least { excess.min(self.around(point, least)) } else { excess };
        let face = self.envelope.mesh().faces()[triangle as usize];
        (excess > least).then_some(Bridge { point, face, excess })
    }

    /// The least distance from a point to the tool in free positions all around it, mm, or the first that is `enough`: the
    /// flat of a tool touches a floor from the side that is free.
    fn around(&self, point: Vector, enough: f64) -> f64 {
        let (reach, mut hint) = (self.envelope.cutter().max_radius(), None);
        let mut least = f64::INFINITY;
        for share in RINGS {
            for number in 0..DIRECTIONS {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(number) / f64::from(DIRECTIONS));
                let (x, y) = (point.x + share * reach * cos, point.y + share * reach * sin);
                let Some(contact) = self.envelope.contact_near(x, y, &mut hint) else { continue };
                least = least.min(self.envelope.gap(point, x, y, contact.tip));
                if least <= enough {
                    return least;
                }
            }
        }
        least
    }

    /// Distance from a point over a triangle to the nearest free position of the tool, along the steepest line there.
    fn nearest(&self, triangle: u32, point: Vector) -> Option<f64> {
        let normal = self.envelope.mesh().normal(triangle as usize);
        let (matched, _) = slope_matched_offset(self.tool, self.sheet, point, normal);
        let mut hint = Some(triangle);
        let free = self.envelope.contact_near(matched.x, matched.y, &mut hint)?;
        let direction = if normal.xy().norm() > 1e-9 { normal.xy().normalize() } else { free.normal.xy() };
        let mut gap = |s: f64| {
            let (x, y) = (matched.x + s * direction.x, matched.y + s * direction.y);
            let contact = self.envelope.contact_near(x, y, &mut hint);
            contact.map_or(f64::INFINITY, |c| self.envelope.gap(point, x, y, c.tip))
        };
        let reach = self.envelope.cutter().max_radius();
        Some(least(&mut gap, -reach, reach).min(gap(0.0)))
    }
}

/// A point moved a little towards the middle of its triangle: at the very foot of a wall, rounding decides what is touched.
fn inside(point: Vector, middle: Vector) -> Vector {
    point + INSIDE * (middle - point)
}

/// The least value of a function that falls and then rises, by golden sections.
fn least(f: &mut impl FnMut(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let (mut p, mut q) = (high - RATIO * (high - low), low + RATIO * (high - low));
    let (mut fp, mut fq) = (f(p), f(q));
    for _ in 0..STEPS {
        if fp < fq {
            (high, q, fq) = (q, p, fp);
            p = high - RATIO * (high - low);
            fp = f(p);
        } else {
            (low, p, fp) = (p, q, fq);
            q = low + RATIO * (high - low);
            fq = f(q);
        }
    }
    fp.min(fq)
}

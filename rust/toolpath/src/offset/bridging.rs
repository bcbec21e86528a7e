//! Where the tool bridges: the part is more curved than the tool, and some of it stays untouched.

use rayon::prelude::*;
use styluscam_geometry::{Sheet, Tool, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::{slope_matched_offset, Envelope};

/// A place that no free position of the tool touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bridge {
    /// The point of the mesh.
    pub point: Vector,
    /// The face it lies on.
    pub face: u32,
    /// What stays between it and the nearest free position of the tool (with the sheet), along the normal, mm.
    pub excess: f64,
}

/// Halvings of the search for the nearest position: the last interval is a 1e-4 of the tool.
const STEPS: usize = 20;
const RATIO: f64 = 0.618_033_988_749_894_9;

/// A point counts as on the tool within this, mm.
const ON_TOOL: f64 = 1e-5;
/// Steps of a climb at most: across a face of 200 samples it is one or two dozen.
const CLIMB: usize = 200;

/// The worst place of each face among `places` (each with its triangle) that stays more than `limit` mm away from every free
/// position, followed uphill from triangle to triangle.
///
/// A place is touched where the envelope is as low as the slope-matched offset. Elsewhere the nearest free
/// position is looked for along the steepest line through the place, on both sides.
///
/// # Errors
/// `Cancelled`.
pub fn bridges(
    envelope: &Envelope<'_>,
    tool: &Tool,
    sheet: Option<&Sheet>,
    places: &[(u32, Vector)],
    limit: f64,
    watch: &Watch,
) -> Result<Vec<Bridge>, Cancelled> {
    watch.begin("bridging", places.len());
    let probe = Probe { envelope, tool, sheet, limit };
    let found: Result<Vec<Option<(u32, Bridge)>>, Cancelled> = places
        .par_iter()
        .with_min_len(16)
        .map(|(triangle, place)| {
            watch.advance(1)?;
            Ok(probe.at(*triangle, *place).map(|bridge| (*triangle, bridge)))
        })
        .collect();
    let mut worst: Vec<(u32, Bridge)> = Vec::new();
    for (triangle, bridge) in found?.into_iter().flatten() {
        match worst.iter_mut().find(|w| w.1.face == bridge.face) {
            Some(known) if known.1.excess >= bridge.excess => {}
            Some(known) => *known = (triangle, bridge),
            None => worst.push((triangle, bridge)),
        }
    }
    watch.advance(0)?;
    Ok(worst.into_par_iter().map(|(triangle, bridge)| probe.climbed(triangle, bridge)).collect())
}

struct Probe<'a> {
    envelope: &'a Envelope<'a>,
    tool: &'a Tool,
    sheet: Option<&'a Sheet>,
    limit: f64,
}

impl Probe<'_> {
    /// The worst of a triangle's corners and its middle.
    fn worst(&self, triangle: u32) -> Option<Bridge> {
        let [a, b, c] = self.envelope.mesh().corners(triangle as usize);
        let places = [(a + b + c) / 3.0, a, b, c];
        let bridges = places.into_iter().filter_map(|place| self.at(triangle, place));
        bridges.max_by(|a, b| a.excess.total_cmp(&b.excess))
    }

    /// From triangle to neighbour as long as the excess grows; the excess found is then measured along the normal.
    fn climbed(&self, from: u32, bridge: Bridge) -> Bridge {
        let faces = self.envelope.mesh().faces();
        let (mut triangle, mut best) = (from, bridge);
        for _ in 0..CLIMB {
            let beside = self.envelope.neighbours(triangle).into_iter();
            let beside = beside.filter(|t| faces.get(*t as usize).is_some_and(|face| *face == bridge.face));
            let next = beside.filter_map(|t| self.worst(t).map(|b| (t, b)));
            match next.max_by(|p, q| p.1.excess.total_cmp(&q.1.excess)) {
                Some((t, higher)) if higher.excess > best.excess => (triangle, best) = (t, higher),
                _ => break,
            }
        }
        Bridge { excess: self.along_normal(triangle, &best), ..best }
    }

    /// From the point along the normal, each time as far as nothing of the tool can be: that ends on the tool.
    fn along_normal(&self, triangle: u32, bridge: &Bridge) -> f64 {
        let normal = self.envelope.mesh().normal(triangle as usize);
        let mut way = bridge.excess;
        for _ in 0..CLIMB {
            let Some(gap) = self.nearest(triangle, bridge.point + normal * way) else { break };
            if gap < ON_TOOL {
                break;
            }
            way += gap;
        }
        way
    }

    /// What stays between a point of a triangle and the nearest free position, if it is more than the limit.
    fn at(&self, triangle: u32, point: Vector) -> Option<Bridge> {
        let mesh = self.envelope.mesh();
        let normal = mesh.normal(triangle as usize);
        let (matched, _) = slope_matched_offset(self.tool, self.sheet, point, normal);
        let free = self.envelope.contact_near(matched.x, matched.y, &mut Some(triangle))?;
        if (free.tip - matched.z) * normal.z.abs() <= self.limit {
            return None;
        }
        let excess = self.nearest(triangle, point)?;
        (excess > self.limit).then(|| Bridge { point, face: mesh.faces()[triangle as usize], excess })
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

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

/// The places among `triangles` (their middles) that stay more than `limit` mm away from every free position.
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
    triangles: &[u32],
    limit: f64,
    watch: &Watch,
) -> Result<Vec<Bridge>, Cancelled> {
    watch.begin("bridging", triangles.len());
    let found: Result<Vec<Option<Bridge>>, Cancelled> = triangles
        .par_iter()
        .with_min_len(16)
        .map(|triangle| {
            watch.advance(1)?;
            Ok(bridge(envelope, tool, sheet, *triangle, limit))
        })
        .collect();
    Ok(found?.into_iter().flatten().collect())
}

fn bridge(envelope: &Envelope<'_>, tool: &Tool, sheet: Option<&Sheet>, triangle: u32, limit: f64) -> Option<Bridge> {
    let mesh = envelope.mesh();
    let [a, b, c] = mesh.corners(triangle as usize);
    let (point, normal) = ((a + b + c) / 3.0, mesh.normal(triangle as usize));
    let (matched, _) = slope_matched_offset(tool, sheet, point, normal);
    let mut hint = Some(triangle);
    let free = envelope.contact_near(matched.x, matched.y, &mut hint)?;
    if (free.tip - matched.z) * normal.z.abs() <= limit {
        return None;
    }
    let direction = if normal.xy().norm() > 1e-9 { normal.xy().normalize() } else { free.normal.xy() };
    let mut gap = |s: f64| {
        let (x, y) = (matched.x + s * direction.x, matched.y + s * direction.y);
        envelope.contact_near(x, y, &mut hint).map_or(f64::INFINITY, |c| envelope.gap(point, x, y, c.tip))
    };
    let reach = envelope.cutter().max_radius();
    let excess = least(&mut gap, -reach, reach).min(gap(0.0));
    (excess > limit).then(|| Bridge { point, face: mesh.faces()[triangle as usize], excess })
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

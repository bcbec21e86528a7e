//! What a moving cylinder leaves of a strip, as far as planning needs it: the distance along the surface's normal, and how it
//! changes with the positions.

use styluscam_geometry::Vector;

/// A position of the axis, two points of it, mm, and how they move with the free parameter.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    pub axis: [Vector; 2],
    pub rates: [Vector; 2],
}

/// A point of the strip and its unit normal towards the tool.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    pub point: Vector,
    pub normal: Vector,
    /// The station from which its nearest one is looked for.
    pub near: usize,
}

/// What stands over a sample when the tool has passed.
#[derive(Clone, Copy, Debug)]
pub struct Left {
    /// Distance along the normal, mm; below 0 where the tool enters the strip.
    pub height: f64,
    /// How it changes with the free parameter of the station that makes it.
    pub rate: f64,
    /// Where that is, in stations.
    pub station: f64,
}

/// How far over the strip's point the cylinder is met along the normal, mm; infinite where it is not.
fn met(sample: &Sample, axis: &[Vector; 2], radius: f64) -> f64 {
    let direction = (axis[1] - axis[0]).normalize();
    let across = |v: Vector| v - direction * v.dot(&direction);
    let (from, normal) = (across(sample.point - axis[0]), across(sample.normal));
    let (a, b, c) = (normal.norm_squared(), from.dot(&normal), from.norm_squared() - radius * radius);
    let root = b * b - a * c;
    if root > 0.0 {
        (-b - root.sqrt()) / a
    } else {
        f64::INFINITY
    }
}

/// What stands over a sample; none where the nearest station is the first or the last, for what lies beyond is not known.
pub fn left(sample: &Sample, stations: &[Station], radius: f64) -> Option<Left> {
    let height = |i: usize| met(sample, &stations[i].axis, radius);
    let (mut at, mut least) = (sample.near, height(sample.near));
    // downhill from station to station
    loop {
        let beside = [at.checked_sub(1), Some(at + 1).filter(|i| *i < stations.len())];
        let lower = beside.into_iter().flatten().map(|i| (i, height(i))).find(|(_, height)| *height < least);
        let Some((next, lower)) = lower else { break };
        (at, least) = (next, lower);
    }
    if at == 0 || at + 1 >= stations.len() || !least.is_finite() {
        return None;
    }
    // the lowest point of the parabola through it and its neighbours
    let [before, after] = [height(at - 1), height(at + 1)];
    let bend = before - 2.0 * least + after;
    let (offset, lowest) = if bend > 0.0 && bend.is_finite() {
        let offset = (0.5 * (before - after) / bend).clamp(-0.5, 0.5);
        (offset, least - 0.25 * (before - after) * offset)
    } else {
        (0.0, least)
    };
    let Station { axis: [first, second], rates } = stations[at];
    let met = sample.point + sample.normal * least;
    let along = second - first;
    let share = (met - first).dot(&along) / along.norm_squared();
    let outwards = met - first - along * share;
    let moved = rates[0] + (rates[1] - rates[0]) * share;
    let rate = outwards.dot(&moved) / outwards.dot(&sample.normal);
    Some(Left { height: lowest, rate, station: at as f64 + offset })
}

//! What a moving flank leaves of a strip, as far as planning needs it: the distance along the surface's normal, and how it
//! changes with the positions.

use styluscam_geometry::Vector;

use super::cutter::Flank;

/// Parts of a straight move by which the nearest of it may lie aside.
const ASIDE: f64 = 0.1;

/// A position of the axis, two points of it, mm, and how they move with the free parameter.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    pub axis: [Vector; 2],
    /// Unit vector along it.
    pub direction: Vector,
    pub rates: [Vector; 2],
    /// How the radius at the second grows with it.
    pub swell: f64,
}

impl Station {
    /// Part of the way to another: the first point along a line, as the tip, and the direction with it.
    pub fn towards(&self, next: &Self, share: f64) -> Self {
        let between = |from: Vector, to: Vector, share: f64| from + (to - from) * share;
        let over = |station: &Self| station.axis[1] - station.axis[0];
        // of directions of unit length as much as of the lengths here
        let [here, there] = [(1.0 - share) * over(next).norm(), share * over(self).norm()];
        let turned = there / (here + there);
        let first = [between(self.axis[0], next.axis[0], share), between(self.rates[0], next.rates[0], share)];
        let faster = |station: &Self| station.rates[1] - station.rates[0];
        let over = between(over(self), over(next), turned);
        Self {
            axis: [first[0], first[0] + over],
            direction: over.normalize(),
            rates: [first[1], first[1] + between(faster(self), faster(next), turned)],
            swell: self.swell + (next.swell - self.swell) * share,
        }
    }
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

/// How far over the strip's point the flank is met along the normal, mm; infinite where it is not.
fn met(sample: &Sample, station: &Station, flank: &Flank) -> f64 {
    let direction = station.direction;
    let from = sample.point - station.axis[0];
    let along = [from.dot(&direction), sample.normal.dot(&direction)];
    let (beside, normal) = (from - direction * along[0], sample.normal - direction * along[1]);
    flank.met(along, [beside.norm_squared(), beside.dot(&normal), normal.norm_squared()])
}

/// What stands over a sample; none where the nearest station is the first or the last, for what lies beyond is not known.
/// Straight moves of `parts` stations each leave a ripple, in which the lowest lies within one of them.
pub fn left(sample: &Sample, stations: &[Station], flank: &Flank, parts: usize) -> Option<Left> {
    let height = |i: usize| stations.get(i).map_or(f64::INFINITY, |station| met(sample, station, flank));
    let below = |i: usize| i.checked_sub(1).map_or(f64::INFINITY, height);
    let mut at = sample.near;
    let [mut before, mut least, mut after] = [below(at), height(at), height(at + 1)];
    // downhill from station to station
    loop {
        if before < least {
            at -= 1;
            (before, least, after) = (below(at), before, least);
        } else if after < least {
            at += 1;
            (before, least, after) = (least, after, height(at + 1));
        } else {
            break;
        }
    }
    if parts > 1 {
        let about = at.saturating_sub(parts)..=(at + parts).min(stations.len() - 1);
        (at, least) =
            about.map(|i| (i, height(i))).fold((at, least), |best, next| if next.1 < best.1 { next } else { best });
        (before, after) = (below(at), height(at + 1));
    }
    if at == 0 || at + 1 >= stations.len() || !least.is_finite() {
        return None;
    }
    // the lowest point of the parabola through it and its neighbours
    let bend = before - 2.0 * least + after;
    let (offset, lowest) = if bend > 0.0 && bend.is_finite() {
        let offset = (0.5 * (before - after) / bend).clamp(-0.5, 0.5);
        (offset, least - 0.25 * (before - after) * offset)
    } else {
        (0.0, least)
    };
    let Station { axis: [first, second], rates, swell, .. } = stations[at];
    let met = sample.point + sample.normal * least;
    let (along, growth) = (second - first, flank.growth());
    let length = along.norm();
    // the ball that touches there: its centre lies higher up the axis, for a cone's surface looks down
    let height = ((met - first).dot(&along) / length + flank.radius() * growth) / (1.0 - growth * growth);
    let share = height / length;
    let outwards = met - first - along * share;
    let moved = rates[0] + (rates[1] - rates[0]) * share;
    let swollen = swell * share * flank.radius_at(length, share);
    let rate = (outwards.dot(&moved) + swollen) / outwards.dot(&sample.normal);
    Some(Left { height: lowest, rate, station: at as f64 + offset })
}

/// The same of a straight move of `parts` ways between stations, whose middle comes nearest to the sample where the continuous
/// movement does, which leaves this.
pub fn left_by_move(sample: &Sample, continuous: &Left, stations: &[Station], flank: &Flank, parts: usize) -> Left {
    let last = stations.len() - 1;
    let first = ((continuous.station.round() as usize).saturating_sub(parts / 2)).min(last - parts.min(last));
    let ends = [&stations[first], &stations[(first + parts).min(last)]];
    let middle = (continuous.station - first as f64) / parts as f64;
    let height = |share: f64| met(sample, &ends[0].towards(ends[1], share), flank);
    let [before, here, after] = [middle - ASIDE, middle, middle + ASIDE].map(height);
    let bend = before - 2.0 * here + after;
    let lower = if bend > 0.0 && bend.is_finite() { 0.125 * (before - after) * (before - after) / bend } else { 0.0 };
    Left { height: if here.is_finite() { here - lower } else { continuous.height }, ..*continuous }
}

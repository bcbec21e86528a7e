//! What a tool that moves with given spreads of its contacts leaves over samples of a strip.

use super::course::{weights, Course, Normal};
use super::cutter::Flank;
use super::stand::stand;
use super::swept::{left, left_by_move, Left, Sample, Station};
use super::{FlankError, RuledStrip};

/// Stations along the strip from which its swept surface is found, at least.
const STATIONS: usize = 193;
/// Of so many positions at most the straight moves between them count; of more they leave next to nothing.
pub const STRAIGHT_MOVES: usize = 400;
/// Samples of the strip along and across.
const ALONG: usize = 65;
pub const ACROSS: usize = 13;
/// The same where courses are compared at last, and stations in a straight move.
const FINE_ALONG: usize = 161;
const FINE_ACROSS: usize = 21;
const FINE_PARTS: usize = 6;

/// Where a course is looked at.
#[derive(Clone, Copy)]
pub struct Layout {
    /// Ways between stations.
    ways: usize,
    /// Of so many each straight move consists; 0 where these do not count.
    each: usize,
}

impl Layout {
    /// For so many positions.
    pub fn of(count: usize) -> Self {
        if count > STRAIGHT_MOVES {
            return Self { ways: STATIONS - 1, each: 0 };
        }
        let moves = count.saturating_sub(1).max(1);
        let each = 2 * (STATIONS - 1).div_ceil(2 * moves);
        Self { ways: moves * each, each }
    }

    /// Heights over each sample: of the continuous movement, and in the middle of a straight move.
    pub fn heights_each(&self) -> usize {
        1 + usize::from(self.each > 0)
    }

    /// Points of the strip.
    pub fn samples(&self, strip: &RuledStrip) -> Vec<Sample> {
        samples(strip, self.ways, [ALONG, ACROSS])
    }
}

fn samples(strip: &RuledStrip, ways: usize, [along, across]: [usize; 2]) -> Vec<Sample> {
    let sample = |i: usize, j: usize| {
        let at = [i as f64 / (along - 1) as f64, j as f64 / (across - 1) as f64];
        let near = (at[0] * ways as f64).round() as usize;
        Sample { point: strip.point(at), normal: strip.normal(at), near }
    };
    (0..along).flat_map(|i| (0..across).map(move |j| (i, j))).map(|(i, j)| sample(i, j)).collect()
}

/// What the tool leaves when it moves between positions with these spreads, evenly spread over the strip, straight or along a
/// curve: the largest height, mm.
///
/// # Errors
/// No position somewhere.
pub fn largest_of(
    strip: &RuledStrip,
    flank: &Flank,
    spreads: &[f64],
    is_straight: bool,
) -> Result<(f64, Vec<Station>), FlankError> {
    let moves = spreads.len() - 1;
    let positions = stations(strip, flank, moves, &|i| spreads[i])?;
    let parts = if is_straight { FINE_PARTS.max((STATIONS - 1).div_ceil(moves)) } else { 1 };
    let station = |i: usize| {
        let (number, part) = (i / parts, i % parts);
        match positions.get(number + 1) {
            Some(next) if part > 0 => positions[number].towards(next, part as f64 / parts as f64),
            _ => positions[number],
        }
    };
    let all: Vec<_> = (0..=moves * parts).map(station).collect();
    let samples = samples(strip, moves * parts, [FINE_ALONG, FINE_ACROSS]);
    let heights = samples.iter().filter_map(|sample| left(sample, &all, flank, parts));
    let largest = heights.map(|left| left.height.abs()).fold(0.0, f64::max);
    Ok((largest, positions))
}

fn stations(
    strip: &RuledStrip,
    flank: &Flank,
    ways: usize,
    spread: &dyn Fn(usize) -> f64,
) -> Result<Vec<Station>, FlankError> {
    let station = |i: usize| {
        let (u, spread) = (i as f64 / ways as f64, spread(i));
        stand(strip, flank, [u - spread, u + spread], [-1.0, 1.0]).map(|(_, station)| station)
    };
    (0..=ways).map(station).collect()
}

/// What a course leaves over each sample, one height or two; none where that is not known.
pub struct Heights {
    left: Vec<Option<Left>>,
    /// Shares of the strip of their stations.
    shares: Vec<f64>,
    /// Heights along a ruling.
    across: usize,
}

impl Heights {
    /// Of a course.
    pub fn of(
        course: &Course,
        strip: &RuledStrip,
        samples: &[Sample],
        flank: &Flank,
        layout: &Layout,
    ) -> Result<Self, FlankError> {
        let Layout { ways, each } = *layout;
        let stations = stations(strip, flank, ways, &|i| course.spread(i as f64 / ways as f64))?;
        let across = ACROSS * layout.heights_each();
        let mut found = Self { left: Vec::new(), shares: Vec::new(), across };
        for sample in samples {
            let continuous = left(sample, &stations, flank, 1);
            let share = continuous.map_or(0.0, |left| left.station / ways as f64);
            found.left.push(continuous);
            found.shares.push(share);
            if each > 0 {
                let straight = |left: Left| left_by_move(sample, &left, &stations, flank, each);
                found.left.push(continuous.map(straight));
                found.shares.push(share);
            }
        }
        Ok(found)
    }

    fn known(&self) -> impl Iterator<Item = &Left> {
        self.left.iter().flatten()
    }

    /// Each height, and 0 where none is known; along a ruling there are [`Heights::across`].
    pub fn all(&self) -> impl Iterator<Item = f64> + '_ {
        self.left.iter().map(|left| left.map_or(0.0, |left| left.height.abs()))
    }

    /// Heights along a ruling.
    pub fn across(&self) -> usize {
        self.across
    }

    /// The mean of the squares, mm^2.
    pub fn squares(&self) -> f64 {
        self.known().map(|left| left.height * left.height).sum::<f64>() / self.known().count().max(1) as f64
    }

    /// The largest of all, mm.
    pub fn largest(&self) -> f64 {
        self.all().fold(0.0, f64::max)
    }

    /// The largest of all, and the root of the mean over the rulings of the square of the largest along each, mm: what is good at
    /// the worst place only, and what is good but there, both count.
    pub fn measure(&self) -> f64 {
        let along = |left: &[Option<Left>]| left.iter().flatten().map(|left| left.height.abs()).fold(0.0, f64::max);
        let squares: f64 = self.left.chunks(self.across).map(along).map(|largest| largest * largest).sum();
        self.largest() + (squares / ALONG as f64).sqrt()
    }

    /// Weighted least squares.
    pub fn normal(&self, counts: &[f64]) -> Normal {
        let mut normal = Normal::zeros();
        for ((left, share), count) in self.left.iter().zip(&self.shares).zip(counts) {
            let Some(Left { height, rate, .. }) = left else { continue };
            let (first, weights) = weights(*share);
            normal.add_square((first, weights.map(|a| a * rate)), *height, *count);
        }
        normal
    }
}

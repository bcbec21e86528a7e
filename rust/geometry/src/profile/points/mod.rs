//! A profile through measured points: a smooth convex curve through the corners of their hull.
//!
//! The steps, a file each: the points' lower right hull, thinned where it is finer than the tolerance ([`hull`]); a
//! slope at each corner that is left ([`slopes`]); a leg of the curve from corner to corner ([`leg`]). Nothing of it
//! decides whether the profile is right: that is measured at the end, on the finished curve.

mod hull;
mod leg;
mod slopes;
#[cfg(test)]
mod tests;

use super::{chain::Builder, Profile};
use crate::GeometryError;
use hull::{Chord, Hull};

/// Points at most: a file with more is a scan, not a profile.
const MOST: usize = 100_000;
/// A tolerance below this share of the profile's size is one of rounding.
const ROUNDING: f64 = 1e-10;
/// The hull's corners nearer to a chord than this share of the tolerance are passed by: the rest of it is for the
/// points inside the hull, and for the curve's bend. Where no curve follows what is left, they are tried in turn.
const THINNINGS: [f64; 3] = [0.125, 0.01, 1e-4];

/// A profile and the largest distance (mm) of a given point from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The profile.
    pub profile: Profile,
    /// Largest distance of a given point from the finished profile, on either side, mm.
    pub deviation: f64,
    /// What else is to be reported, in sentences.
    pub notes: Vec<String>,
}

/// Fits a convex profile with a continuous tangent to points (r, z), mm, ordered from the tip, beyond the end of `tip`.
///
/// No point is farther from it than `tolerance` mm, inside or outside. It ends at the last point exactly, or, where an
/// earlier point lies farther out or higher by less than the tolerance, at the largest r and z of all. Where three
/// points or more lie on a line, the line is kept; where it begins at the tip, the tip is pointed.
///
/// # Errors
/// Too few points, one that is not finite or turns back, a tip off the axis; points that no such curve follows: a
/// hollow, a corner; each with the point's number and position.
pub fn fit(points: &[[f64; 2]], tolerance: f64, tip: &Builder) -> Result<Fit, GeometryError> {
    check(points, tolerance)?;
    let lowest = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let begin = tip.at().0;
    let moved: Vec<[f64; 2]> = points.iter().map(|[r, z]| [r + begin, z - lowest]).collect();
    let hull = Hull::of(&moved, begin);
    let tolerance = tolerance.max(ROUNDING * hull.size());
    // what is thinned away may have been the round of a corner: then with more of the points
    let mut first_refusal = None;
    for thinning in THINNINGS {
        let close = (thinning * tolerance).max(THINNINGS[0] * ROUNDING * hull.size());
        match through(&moved, &hull, close, tolerance, tip.clone()) {
            Ok(fit) => return Ok(fit),
            Err(refusal) => first_refusal = first_refusal.or(Some(refusal)),
        }
    }
    let Refusal { number, reason, hint } = first_refusal.unwrap_or_default();
    Err(refused(number, points[number], reason, hint))
}

/// Why no curve follows the points.
#[derive(Default)]
struct Refusal {
    /// The point's number.
    number: usize,
    reason: String,
    hint: &'static str,
}

/// The fit through the hull's corners, those within `close` of its chords left out.
fn through(points: &[[f64; 2]], hull: &Hull, close: f64, tolerance: f64, tip: Builder) -> Result<Fit, Refusal> {
    let chords = hull.chords(close);
    let slopes = slopes::at_corners(&chords, tolerance, hull.size());
    let profile = led(tip, &chords, &slopes, hull.size()).map_err(|unled| unled.at(&chords))?;
    let profile = profile.proved().map_err(|flaw| Refusal { number: 0, reason: flaw.to_string(), hint: REPORT })?;
    let (deviation, worst) = largest_distance(points, &profile, tolerance);
    if deviation > tolerance {
        return Err(missed(points, &chords, worst, deviation));
    }
    Ok(Fit { notes: notes(&chords, &slopes), profile, deviation })
}

fn refused(number: usize, [r, z]: [f64; 2], reason: impl Into<String>, hint: &str) -> GeometryError {
    let place = format!("points[{number}] (r = {r}, z = {z})");
    GeometryError::Profile { place, reason: reason.into(), hint: hint.to_owned() }
}

fn check(points: &[[f64; 2]], tolerance: f64) -> Result<(), GeometryError> {
    let few = |count: usize| {
        let reason = format!("{count} points: 3 to {MOST} make a profile");
        GeometryError::Profile { place: "points".to_owned(), reason, hint: "add points, or leave some out".to_owned() }
    };
    if points.len() < 3 || points.len() > MOST {
        return Err(few(points.len()));
    }
    let in_this_world = |x: &f64| x.is_finite() && x.abs() <= 1e4;
    if let Some((i, p)) = points.iter().enumerate().find(|(_, p)| !p.iter().all(in_this_world)) {
        return Err(refused(i, *p, "not a length of up to 10000 mm", "correct the point"));
    }
    if points[0][0] != 0.0 {
        return Err(refused(0, points[0], "the tip is not on the axis", "begin with r = 0"));
    }
    let apart = |pair: &&[[f64; 2]]| pair[0].iter().zip(&pair[1]).any(|(a, b)| a.total_cmp(b).is_ne());
    let different = 1 + points.windows(2).filter(apart).count();
    if different < 3 {
        return Err(few(different));
    }
    let mut most = points[0];
    for (i, point) in points.iter().enumerate() {
        most = [most[0].max(point[0]), most[1].max(point[1])];
        let fall = (most[0] - point[0]).max(most[1] - point[1]);
        if fall > tolerance {
            let reason = format!("r or z falls, by {fall:.3e} mm, from the points before");
            return Err(refused(i, *point, reason, "order the points from tip to base, or raise fit_tolerance"));
        }
    }
    if most[0] <= 1e-6 {
        return Err(refused(points.len() - 1, points[points.len() - 1], "no radius is reached", "give r in mm"));
    }
    Ok(())
}

/// A corner that the curve cannot take, or why a leg of it could not be led.
struct Unled {
    /// The number of the chord at whose start it is.
    chord: usize,
    reason: String,
}

impl Unled {
    fn at(self, chords: &[Chord]) -> Refusal {
        let number = chords.get(self.chord).or(chords.last()).map_or(0, |chord| chord.numbers[0]);
        Refusal { number, reason: self.reason, hint: ROUND_IT }
    }
}

fn led(mut builder: Builder, chords: &[Chord], slopes: &[f64], size: f64) -> Result<Profile, Unled> {
    for (index, (chord, ends)) in chords.iter().zip(slopes.windows(2)).enumerate() {
        builder.kink(ends[0]);
        leg::lead(&mut builder, chord, [ends[0], ends[1]], size).map_err(|unled| {
            let (at_end, reason) = match unled {
                leg::Unled::CornerAtStart(turn) => (0, format!("a corner of {:.3} degrees", turn.to_degrees())),
                leg::Unled::CornerAtEnd(turn) => (1, format!("a corner of {:.3} degrees", turn.to_degrees())),
                leg::Unled::NoTurn => (0, "the curve has no slope left to turn to".to_owned()),
            };
            Unled { chord: index + at_end, reason }
        })?;
    }
    Ok(builder.finish())
}

const ROUND_IT: &str = "round it with more points, or raise fit_tolerance";

const REPORT: &str = "please report these points; fewer of them, or a larger fit_tolerance, may do meanwhile";

/// The largest distance of a point from the profile, mm, and the point's number.
fn largest_distance(points: &[[f64; 2]], profile: &Profile, within: f64) -> (f64, usize) {
    let mut worst = (0.0, 0);
    for (number, [r, z]) in points.iter().enumerate() {
        let distance = profile.distance((*r, *z), within);
        if distance > worst.0 {
            worst = (distance, number);
        }
    }
    worst
}

/// What is wrong where a point is too far from the curve: it is hollow there, or there is a corner beside it.
fn missed(points: &[[f64; 2]], chords: &[Chord], worst: usize, deviation: f64) -> Refusal {
    let chord = chords.partition_point(|c| c.to[0] + c.to[1] < points[worst][0] + points[worst][1]);
    let chord = chord.min(chords.len().max(1) - 1);
    let turn_at = |i: usize| if i == 0 || i >= chords.len() { 0.0 } else { chords[i].slope - chords[i - 1].slope };
    let corner = if turn_at(chord) > turn_at(chord + 1) { chord } else { chord + 1 };
    if chords[chord].depth_of(points[worst]) < 0.5 * deviation && turn_at(corner) > 0.0 {
        let (number, turn) = (chords[corner].numbers[0], turn_at(corner).to_degrees());
        let reason =
            format!("a corner of {turn:.3} degrees: a smooth curve misses points[{worst}] by {deviation:.3e} mm");
        return Refusal { number, reason, hint: ROUND_IT };
    }
    let reason = format!("the profile is hollow here: a convex curve misses the point by {deviation:.3e} mm");
    Refusal { number: worst, reason, hint: "correct the point, or raise fit_tolerance" }
}

fn notes(chords: &[Chord], slopes: &[f64]) -> Vec<String> {
    let mut notes = Vec::new();
    if slopes[0] > 0.0 {
        notes.push(format!(
            "the tip is pointed: the profile begins with a slope of {:.3} degrees",
            slopes[0].to_degrees()
        ));
    }
    let straight = slopes.windows(2).filter(|ends| ends[0].total_cmp(&ends[1]).is_eq()).count();
    notes.push(format!(
        "a curve of {} segments, {straight} of them straight; the radius of curvature jumps between segments, as the points do",
        chords.len(),
    ));
    notes
}

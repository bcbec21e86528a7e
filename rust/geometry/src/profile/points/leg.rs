//! One leg of the curve: along a chord, from the slope at its start to that at its end.

use std::f64::consts::FRAC_PI_2;

use super::hull::Chord;
use crate::profile::{Arc, Builder, Curve, Involute};

/// A round of a smaller radius than this share of the profile's size is a corner, if it turns by more than
/// [`CORNER_TURN`].
const CORNER: f64 = 1e-7;
/// rad.
const CORNER_TURN: f64 = 1e-3;

/// Why a leg cannot be led.
pub enum Unled {
    /// The turn (rad) at its start is a corner.
    CornerAtStart(f64),
    /// The turn (rad) at its end is a corner.
    CornerAtEnd(f64),
    /// The slopes at its ends do not enclose the chord's.
    NoTurn,
}

/// Leads the curve along `chord`, from and to the slopes `ends`, between which the chord's lies.
///
/// One curve whose radius changes evenly where that is possible, two arcs (a convex biarc) where it is not.
pub fn lead(builder: &mut Builder, chord: &Chord, ends: [f64; 2], size: f64) -> Result<(), Unled> {
    let end = (chord.to[0], chord.to[1]);
    let [first, last] = ends;
    // differences of neighbouring numbers are exact: the curves close to rounding even where they hardly turn
    let (before, after) = (chord.slope - first, last - chord.slope);
    if before == 0.0 && after == 0.0 {
        builder.straight(chord.length);
        builder.arrive(end);
        return Ok(());
    }
    match (before, after) {
        _ if before < 0.0 || after < 0.0 => return Err(Unled::NoTurn),
        _ if before == 0.0 => return Err(Unled::CornerAtEnd(after)),
        _ if after == 0.0 => return Err(Unled::CornerAtStart(before)),
        _ => {}
    }
    if let Some(curve) = Involute::over_chord(first, chord.length, before, after) {
        builder.curve(Curve::Involute(curve), first, last);
    } else {
        let [start, stop] = radii(chord.length, before, after);
        if start < CORNER * size && before > CORNER_TURN {
            return Err(Unled::CornerAtStart(before));
        }
        if stop < CORNER * size && after > CORNER_TURN {
            return Err(Unled::CornerAtEnd(after));
        }
        builder.curve(Curve::Arc(Arc::new(start, first)), first, chord.slope);
        let (r, z) = builder.at();
        builder.arrive((r.min(end.0), z.min(end.1)));
        builder.curve(Curve::Arc(Arc::new(stop, chord.slope)), chord.slope, last);
    }
    builder.arrive(end);
    Ok(())
}

/// The radii of two arcs along a chord of `length` mm that meet at its slope, having turned by `before` rad, and then
/// turn by `after`. With the chord their own chords form a triangle, with half of each turn as its angles.
pub fn radii(length: f64, before: f64, after: f64) -> [f64; 2] {
    let (first, last) = (libm::sin(0.5 * before), libm::sin(0.5 * after));
    let scale = 0.5 * length / libm::sin((0.5 * (before + after)).min(FRAC_PI_2));
    [scale * last / first, scale * first / last]
}

/// Whether a turn of `before` rad at the start of a leg is so tight as to be a corner.
pub fn corner_at_start(length: f64, before: f64, after: f64, size: f64) -> bool {
    before > CORNER_TURN && radii(length, before, after)[0] < CORNER * size
}

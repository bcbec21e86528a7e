//! Where the way from one of the tool's positions to another crosses a hollow crease of the envelope.

use super::stations::Station;
use crate::fitting::angle;
use crate::Surface;

/// Least angle between the normals on both sides of a crease, rad: 6 degrees. What is flatter is no higher than a part of the scallop.
const TURNS: f64 = 0.1;
/// Share of that angle that is left where a side of a lattice's cell has been halved [`HALVINGS`] times, if it is a crease and no
/// fillet.
const SUDDEN: f64 = 0.5;
/// What is higher over a crease, mm, and steeper, is a wall.
const JUMP: f64 = 0.01;
const STEEPEST: f64 = 100.0;
/// A pass along a wall's foot is so far off it, mm, that rounding does not lift it onto the wall.
const OFF: f64 = 0.002;
/// Halvings of a side.
const HALVINGS: usize = 10;
/// Lines along creases lie so near to them, mm: before a convex wall nearer than they are off it, or the tool would climb it.
const ALONG: f64 = 0.25 * OFF;
/// A crease is looked for so far to both sides of its chord, as a share of its length and mm.
const ASIDE: f64 = 0.25;
const LEAST_ASIDE: f64 = 4.0 * OFF;
/// Steps beyond the last crossing that are no longer end the line, mm.
const LEAST_STEP: f64 = 0.01;
/// Halvings of the chord between two crossings.
const FINEST: u32 = 8;

/// Where a side of a net crosses a crease.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The nodes, the smaller number first.
    pub side: [usize; 2],
    /// The positions on both sides of the crease, as near to each other as is looked.
    pub stations: [Station; 2],
}

impl Crossing {
    /// The station on the same side of the crease as another one.
    pub fn beside(&self, station: &Station) -> &Station {
        let [first, second] = &self.stations;
        if first.normal.dot(&station.normal) >= second.normal.dot(&station.normal) {
            first
        } else {
            second
        }
    }

    /// The angle between the normals on both sides, rad.
    pub fn turn(&self) -> f64 {
        angle(&self.stations[0].normal, &self.stations[1].normal)
    }

    /// Whether the tool has to be lifted to cross it: an upright wall stands there.
    pub fn is_jump(&self) -> bool {
        let shift = self.stations[1].tip - self.stations[0].tip;
        shift.z.abs() > JUMP + STEEPEST * shift.xy().norm()
    }

    /// The stations below and above a wall.
    pub fn below_and_above(&self) -> [&Station; 2] {
        let [first, second] = &self.stations;
        if first.tip.z <= second.tip.z {
            [first, second]
        } else {
            [second, first]
        }
    }

    /// The position in plan of the pass along it, mm: before a wall a little off it.
    pub fn position(&self) -> [f64; 2] {
        let [below, above] = self.below_and_above();
        let (low, shift) = (below.tip.xy(), below.tip.xy() - above.tip.xy());
        let place = match shift.try_normalize(0.0) {
            Some(away) if self.is_jump() => low + OFF * away,
            Some(_) | None => low - 0.5 * shift,
        };
        [place.x, place.y]
    }
}

/// Where a side between two stations crosses a crease, if it does.
pub fn crossing(surface: &Surface<'_>, side: [usize; 2], [a, b]: [&Station; 2]) -> Option<Crossing> {
    let whole = angle(&a.normal, &b.normal);
    if whole < TURNS || (b.normal - a.normal).dot(&(b.tip - a.tip)) >= 0.0 {
        return None;
    }
    let (mut low, mut high) = (*a, *b);
    let mut hint = None;
    for _ in 0..HALVINGS {
        let middle = (low.tip + high.tip) * 0.5;
        let contact = surface.envelope().contact_near(middle.x, middle.y, &mut hint)?;
        let station = Station::of(surface, [middle.x, middle.y], &contact)?;
        if angle(&low.normal, &station.normal) >= angle(&station.normal, &high.normal) {
            high = station;
        } else {
            low = station;
        }
    }
    let is_sudden = angle(&low.normal, &high.normal) >= SUDDEN * whole;
    is_sudden.then_some(Crossing { side: [side[0].min(side[1]), side[0].max(side[1])], stations: [low, high] })
}

/// The line along a crease through positions on it, mm, with as many more between them as it takes to stay on it; an open one goes on as
/// far as `beyond` mm while there is a crease.
pub fn line_along(surface: &Surface<'_>, positions: &[[f64; 2]], beyond: f64) -> Vec<[f64; 2]> {
    let mut whole = squared(surface, positions);
    if positions.first() != positions.last() {
        go_on(surface, &mut whole, beyond);
        whole.reverse();
        go_on(surface, &mut whole, beyond);
        whole.reverse();
    }
    let mut line: Vec<[f64; 2]> = whole.first().copied().into_iter().collect();
    for ends in whole.windows(2) {
        if let [a, b] = ends {
            follow(surface, [*a, *b], FINEST, &mut line);
            line.push(*b);
        }
    }
    line
}

/// The positions as they are found straight across the line: those on a lattice's sides were found aslant.
fn squared(surface: &Surface<'_>, positions: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let count = positions.len();
    let is_closed = positions.first() == positions.last();
    let across = |number: usize| {
        let before = if is_closed && number == 0 { count - 2 } else { number.saturating_sub(1) };
        let after = if is_closed && number + 1 == count { 1 } else { (number + 1).min(count - 1) };
        let way = [0, 1].map(|i| positions[after][i] - positions[before][i]);
        beside(surface, positions[number], way).unwrap_or(positions[number])
    };
    if count < 3 {
        positions.to_vec()
    } else {
        (0..count).map(across).collect()
    }
}

/// Adds positions behind the last one while the crease goes on.
fn go_on(surface: &Surface<'_>, line: &mut Vec<[f64; 2]>, beyond: f64) {
    let (mut step, mut gone) = (0.5 * beyond, 0.0);
    while step > LEAST_STEP && gone < beyond {
        let [.., before, last] = line[..] else { return };
        let way = [last[0] - before[0], last[1] - before[1]];
        let length = libm::hypot(way[0], way[1]);
        if length <= 0.0 {
            return;
        }
        let at = [0, 1].map(|i| last[i] + step * way[i] / length);
        match beside(surface, at, [0, 1].map(|i| at[i] - last[i])) {
            Some(found) => {
                gone += step;
                line.push(found);
            }
            None => step *= 0.5,
        }
    }
}

/// Adds the positions between two on a crease.
fn follow(surface: &Surface<'_>, [a, b]: [[f64; 2]; 2], halvings: u32, line: &mut Vec<[f64; 2]>) {
    let chord = [b[0] - a[0], b[1] - a[1]];
    let at = |share: f64| [0, 1].map(|i| a[i] + share * chord[i]);
    let found = [0.5, 0.25, 0.75].map(|share| (at(share), beside(surface, at(share), chord)));
    let is_on = |(at, found): &([f64; 2], Option<[f64; 2]>)| {
        found.is_none_or(|found| libm::hypot(found[0] - at[0], found[1] - at[1]) <= ALONG)
    };
    if halvings == 0 || found.iter().all(is_on) {
        return;
    }
    let [(middle, on_crease), ..] = found;
    let between = on_crease.unwrap_or(middle);
    follow(surface, [a, between], halvings - 1, line);
    line.push(between);
    follow(surface, [between, b], halvings - 1, line);
}

/// The position on a crease beside the middle of its chord, if it is found there.
fn beside(surface: &Surface<'_>, middle: [f64; 2], chord: [f64; 2]) -> Option<[f64; 2]> {
    let length = libm::hypot(chord[0], chord[1]);
    if length <= 0.0 {
        return None; // a line without a direction
    }
    let share = (ASIDE * length).max(LEAST_ASIDE) / length;
    let ends = [-share, share].map(|by| [middle[0] - by * chord[1], middle[1] + by * chord[0]]);
    let mut hint = None;
    let [first, second] = ends.map(|at| {
        let contact = surface.envelope().contact_near(at[0], at[1], &mut hint)?;
        Station::of(surface, at, &contact)
    });
    crossing(surface, [0, 1], [&first?, &second?]).map(|crossing| crossing.position())
}

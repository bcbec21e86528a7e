//! How far polynomials are from the formula that they follow: a bound that holds everywhere, not at points only.
//!
//! A piece of the polynomials P is cut into cells. The formula's curve is written by P's own parameter u as P + e, and e is
//! enclosed by Taylor's theorem: its terms about the middle of the cell, and one term about all of it at once, by
//! intervals ([`super::series`]). For r(t), z(t), e is the difference itself. For z(r) and f(r, z) = 0 it is a step in
//! r or z alone, |f(P)| over the derivative of f in that direction.
//!
//! From |e| <= distance and |e'| <= turn x |P'| follows how far the points at one slope are apart: the arc over which P
//! turns by `turn`, and `distance`. Where P turns so little that rounding of the slope itself moves its point by more,
//! that much is left to the slope ([`RELATIVE`]).

use super::interval::Interval;
use super::jet::Jet;
use super::number::Number;
use super::sample::{Sample, Source, BY_RADIUS};
use super::series::{Series, ORDER};
use crate::profile::fitted;

/// What is aimed at, and what is let pass where rounding forbids more; in parts of the extent.
const AIM: f64 = 1e-10;
const MOST: f64 = 4e-10;
/// Change of a slope, relative to itself, that cannot be distinguished from rounding.
const RELATIVE: f64 = 1e-12;
/// Within this of tip or base, in parts of the extent, r and z need hold, but not by slope.
const NEAR_END: f64 = 3e-5;
/// How often a cell is halved, one at an end too.
const MOST_HALVINGS: usize = 6;
const MOST_HALVINGS_AT_END: usize = 45;
/// A cell off by so much more than is aimed at is quartered.
const FAR: f64 = 1e3;
/// Most cells, and most operators and functions in them: some 50 ms.
const MOST_CELLS: usize = 4000;
const MOST_OPERATIONS: usize = 40_000;

/// What holds along all the polynomials.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bound {
    /// The curves are nowhere farther apart, mm.
    pub distance: f64,
    /// Nor are their points at one slope (but for [`RELATIVE`] of it), mm.
    pub by_slope: f64,
    /// Within this of the tip or base only `distance` holds, mm.
    pub except: f64,
}

/// A part of a piece, and what is known of it; lengths in mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    u: [f64; 2],
    distance: f64,
    /// Angle between the two tangents at one u, rad.
    turn: f64,
    /// Radius of curvature of P at most.
    radius: f64,
    length: f64,
    /// Slopes of P at its ends, rad.
    slopes: [f64; 2],
    /// By slope nothing is known of it.
    except: f64,
}

impl Cell {
    /// Its tangents are off by more than rounding of a slope.
    fn exceeds_rounding(&self) -> bool {
        self.turn > RELATIVE * self.slopes[0]
    }

    /// How far P goes along the cell while it turns by an angle.
    fn arc(&self, turn: f64) -> f64 {
        if turn <= 0.0 || self.except > 0.0 {
            return 0.0;
        }
        (turn * self.radius).min(self.length)
    }

    /// How far apart points at one slope are, of its own; mm.
    fn off(&self) -> f64 {
        self.distance + if self.exceeds_rounding() { self.arc(self.turn) } else { 0.0 }
    }
}

/// Why a piece is not followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    /// The polynomials are off, or nothing is known: a shorter piece may do.
    Off,
    /// Rounding of the formula is larger than what is allowed.
    Rounding,
    /// It takes too long.
    Spent,
}

/// Measures the pieces of a fit.
pub(super) struct Ruler<'a> {
    source: &'a dyn Source,
    /// Diameter of the base or height, whichever is larger, mm.
    extent: f64,
    cells: usize,
}

/// A piece and where it comes from.
pub(super) struct Piece<'a> {
    pub interval: &'a fitted::Interval,
    pub from: &'a Sample,
    pub to: &'a Sample,
    /// It begins at the tip; it ends at the base.
    pub ends: [bool; 2],
}

/// What becomes of a cell.
enum Step {
    Settled(Cell),
    Parts(Vec<Open>),
}

/// Where a piece is best cut: before what was settled from its other end, if that is most of it.
fn cut(piece: &Piece, settled: &[Cell]) -> f64 {
    let last = settled.last().map_or([1.0, -1.0], |cell| cell.u);
    match piece.ends {
        [_, true] => last[1].max(0.0),
        [true, false] => last[0].min(0.0),
        _ => 0.0,
    }
}

/// A cell still to be measured.
struct Open {
    u: [f64; 2],
    ends: [bool; 2],
    halvings: usize,
    /// The measure of the cell that it is half of, mm.
    before: f64,
}

impl Open {
    /// It in equal parts; what leaves an end is halved anew.
    fn parts(&self, count: usize, off: f64) -> Vec<Self> {
        let [low, high] = self.u;
        let at = |k: usize| if k == count { high } else { low + (high - low) * (k as f64 / count as f64) };
        let part = |k: usize| {
            let ends = [self.ends[0] && k == 0, self.ends[1] && k + 1 == count];
            let halvings = if ends == self.ends { self.halvings + count / 2 } else { 0 };
            Self { u: [at(k), at(k + 1)], ends, halvings, before: off }
        };
        (0..count).map(part).collect()
    }
}

impl<'a> Ruler<'a> {
    pub fn new(source: &'a dyn Source, extent: f64) -> Self {
        Self { source, extent, cells: 0 }
    }

    /// The cells of a piece that is near enough to the formula; or why it is not, and where it is best cut, by u.
    pub fn cells(&mut self, piece: &Piece) -> Result<Vec<Cell>, (Fault, f64)> {
        let mut open = vec![Open { u: [-1.0, 1.0], ends: piece.ends, halvings: 0, before: f64::INFINITY }];
        let mut cells = Vec::new();
        while let Some(part) = open.pop() {
            match self.settled(piece, &part) {
                Ok(Step::Settled(cell)) => cells.push(cell),
                // an end, which takes long, comes last
                Ok(Step::Parts(parts)) if part.ends[1] => open.extend(parts.into_iter().rev()),
                Ok(Step::Parts(parts)) => open.extend(parts),
                Err(fault) => return Err((fault, cut(piece, &cells))),
            }
        }
        cells.sort_by(|a, b| a.u[0].total_cmp(&b.u[0]));
        Ok(cells)
    }

    fn settled(&mut self, piece: &Piece, part: &Open) -> Result<Step, Fault> {
        self.cells += 1;
        if self.cells > MOST_CELLS || self.cells * self.source.operators() > MOST_OPERATIONS {
            return Err(Fault::Spent);
        }
        let (cell, _) = self.measured(piece, part.u, Interval::size);
        let off = cell.off();
        if off <= AIM * self.extent || (off <= MOST * self.extent && (part.halvings > 2 || off > 0.5 * part.before)) {
            return Ok(Step::Settled(cell));
        }
        if let Some(end) = self.as_end(piece, part, &cell) {
            return Ok(Step::Settled(end));
        }
        let inside = part.ends == [false; 2];
        let most = if inside { MOST_HALVINGS } else { MOST_HALVINGS_AT_END };
        // halving does not help against rounding
        let stuck = inside && off.is_finite() && off > 0.7 * part.before;
        if stuck || part.halvings >= most || part.halvings % 3 == 2 {
            self.looked_at(piece, 0.5 * (part.u[0] + part.u[1]))?;
        }
        if stuck || part.halvings >= most {
            return Err(Fault::Off);
        }
        // one halving gains a factor of 2^ORDER at most
        let twice = inside && off.is_finite() && off > FAR * AIM * self.extent;
        Ok(Step::Parts(part.parts(if twice { 4 } else { 2 }, off)))
    }

    /// Refuses polynomials that are seen to be off at u, and a formula whose rounding is too large there.
    fn looked_at(&mut self, piece: &Piece, u: f64) -> Result<(), Fault> {
        self.cells += 1;
        let (cell, noise) = self.measured(piece, [u, u], least);
        if noise.is_finite() && noise > MOST * self.extent {
            return Err(Fault::Rounding);
        }
        // it has no length here
        let cell = Cell { length: f64::INFINITY, ..cell };
        if cell.off().is_finite() && cell.off() > MOST * self.extent {
            return Err(Fault::Off);
        }
        Ok(())
    }

    /// A cell at the tip or base that is so small that its extent bounds what is not known: both curves rise in it.
    fn as_end(&self, piece: &Piece, part: &Open, cell: &Cell) -> Option<Cell> {
        let [a, b] = part.u.map(|u| piece.interval.point(u));
        let (dr, dz) = ((b.0 - a.0).abs(), (b.1 - a.1).abs());
        let (less, more) = (dr.min(dz), dr.max(dz));
        if part.ends == [false; 2] || less > MOST * self.extent || more > NEAR_END * self.extent {
            return None;
        }
        let whole = more <= MOST * self.extent;
        // towards a tip it is tried on: there curves have a power of r as a rule
        let except = if whole { 0.0 } else { more };
        if !whole && !part.ends[1] && part.halvings < MOST_HALVINGS_AT_END {
            return None;
        }
        Some(Cell { distance: 2.0 * less, turn: f64::INFINITY, length: dr + dz, except, ..*cell })
    }

    /// What is known of a cell, and how much of its distance is rounding of the formula at its middle, mm.
    ///
    /// `size` is what counts of an interval: the largest of its numbers for a bound.
    fn measured(&self, piece: &Piece, u: [f64; 2], size: fn(Interval) -> f64) -> (Cell, f64) {
        let stretch = piece.from.stretch;
        let middle = 0.5 * (u[0] + u[1]);
        let half = (u[1] - middle).max(middle - u[0]);
        let about = |at: Interval, terms: &[Polynomial; 2]| {
            let point = terms.map(|terms| Series::new(std::array::from_fn(|k| terms[k])));
            (self.source.residual(stretch, parameter(piece, at), &point), point)
        };
        let given = [&piece.interval.r, &piece.interval.z].map(|terms| terms.map(Interval::exact));
        // about the middle first, and from there: so the least is lost to what the terms have in common
        let terms = given.map(|terms| shifted(&terms, Interval::exact(middle), fitted::TERMS - 1));
        let (centre, _) = about(Interval::exact(middle), &terms);
        let terms = terms.map(|terms| shifted(&terms, Interval::around_zero(half), ORDER));
        let (wide, [r, z]) = about(Interval::new(u[0], u[1]), &terms);
        let rests = [0, 1].map(|i| remainder(&centre[i], &wide[i], half, size));
        let (mut distance, mut rates) = (rests[0][0] + rests[1][0], [rests[0][1], rests[1][1]]);
        let mut noise: f64 = centre.iter().map(|series| series.terms[0].hi - series.terms[0].lo).sum();
        let d = [r.terms[1], z.terms[1]];
        let two = Interval::exact(2.0);
        let turning = d[0] * (two * z.terms[2]) - (two * r.terms[2]) * d[1];
        if let Some([step, rate]) = self.step(stretch, [r.terms[0], z.terms[0]], d, [distance, rates[0]]) {
            noise *= step / distance;
            distance = step;
            rates = if stretch == BY_RADIUS { [0.0, rate] } else { [rate, 0.0] };
        }
        let speed = (d[0].square() + d[1].square()).sqrt();
        // only what is across the tangent turns it
        let across = d[0].size() * rates[1] + d[1].size() * rates[0];
        let turn = 1.01 * across / (speed.lo * speed.lo);
        let radius = speed.hi * speed.hi * speed.hi / turning.lo;
        let slopes = u.map(|u| {
            let (d, _) = piece.interval.rates(u);
            libm::atan2(d[1], d[0]).abs()
        });
        let cell = Cell {
            u,
            distance: if distance.is_nan() { f64::INFINITY } else { distance },
            // an arc is so much longer than its sine up to here
            turn: if turn <= 0.1 { turn } else { f64::INFINITY },
            radius: if radius >= 0.0 { radius } else { f64::INFINITY },
            length: speed.hi * (u[1] - u[0]).next_up(),
            slopes,
            except: 0.0,
        };
        (cell, noise)
    }

    /// Size and rate of the step onto the curve in one coordinate, where the residual is that of a function of r and z.
    fn step(&self, stretch: usize, over: [Interval; 2], d: [Interval; 2], [rest, rate]: [f64; 2]) -> Option<[f64; 2]> {
        let across = 1 - stretch.min(1);
        let nothing_known = Some([f64::INFINITY; 2]);
        let field = |reach: f64| {
            let mut box_of = over;
            box_of[across] = box_of[across] + Interval::around_zero(reach);
            self.source.field(box_of)
        };
        let slope = |jet: &Jet<Interval>| least(jet.first[across]);
        let reach = 2.0 * rest / slope(&field(0.0)?);
        if !(reach > 0.0 && reach <= self.extent) {
            return if rest <= 0.0 { Some([0.0, 0.0]) } else { nothing_known };
        }
        let jet = field(reach)?;
        let step = rest / slope(&jet);
        // not so for NaN
        let inside = step > 0.0 && step <= reach;
        if !inside {
            return nothing_known;
        }
        // derivatives of f across, by r and by z
        let bend = [jet.second[across], jet.second[1 + across]];
        let turned = bend[0].size() * d[0].size() + bend[1].size() * d[1].size();
        let rate = (rate + turned * step) / slope(&jet);
        Some([step, rate].map(|x| x * (1.0 + 1e-14)))
    }
}

/// The least size of an interval's numbers; NaN where undecided.
fn least(x: Interval) -> f64 {
    if x.lo <= 0.0 && x.hi >= 0.0 {
        0.0
    } else {
        x.lo.abs().min(x.hi.abs())
    }
}

/// The formula's parameter by u; kept within the piece, which rounding may leave.
fn parameter(piece: &Piece, u: Interval) -> Series {
    let (from, to) = (piece.from.p, piece.to.p);
    let half = 0.5 * (to - from);
    let p = Interval::exact(0.5 * (to + from)) + Interval::exact(half) * u;
    Series::linear(Interval::new(p.lo.clamp(from, to), p.hi.clamp(from, to)), half)
}

/// A polynomial's terms.
type Polynomial = [Interval; fitted::TERMS];

/// Terms of a polynomial about a point or an interval, those up to `order`.
fn shifted(terms: &Polynomial, at: Interval, order: usize) -> Polynomial {
    let mut shifted = *terms;
    let last = terms.iter().rposition(|c| !c.is_zero()).unwrap_or(0);
    for i in 0..=order.min(last) {
        for k in (i..last).rev() {
            shifted[k] = shifted[k] + at * shifted[k + 1];
        }
    }
    shifted
}

/// Bounds of a function and of its derivative up to `half` from the middle: by the best of all orders.
fn remainder(centre: &Series, wide: &Series, half: f64, size: fn(Interval) -> f64) -> [f64; 2] {
    let (mut best, mut sums, mut power, mut power_before) = ([f64::INFINITY; 2], [0.0; 2], 1.0, 0.0);
    for k in 0..=ORDER {
        let (about, rest) = (size(centre.terms[k]), size(wide.terms[k]));
        let order = k as f64;
        if k > 0 {
            best[0] = best[0].min(sums[0] + rest * power);
            best[1] = best[1].min(sums[1] + order * rest * power_before);
        }
        sums = [sums[0] + about * power, sums[1] + order * about * power_before];
        (power_before, power) = (power, power * half);
    }
    best.map(|x| x * (1.0 + 1e-14))
}

/// What holds along all the cells, in order from tip to base.
pub(super) fn bound(cells: &[Cell]) -> Bound {
    let mut bound = Bound::default();
    for (k, cell) in cells.iter().enumerate() {
        bound.distance = bound.distance.max(cell.distance);
        bound.except = bound.except.max(cell.except);
        if cell.except > 0.0 {
            continue;
        }
        let turn = if cell.exceeds_rounding() { cell.turn } else { 0.0 };
        let before = arc_through(cells[..k].iter().rev(), turn);
        let after = arc_through(cells[k + 1..].iter(), turn);
        bound.by_slope = bound.by_slope.max(cell.distance + cell.arc(turn) + before.max(after));
    }
    bound
}

/// How far P goes on through further cells while it turns by an angle.
///
/// Slopes of the formula rise along it: one of a cell is not above that where the next cell begins, so that the next
/// one is not entered by more than its own tangents are off.
fn arc_through<'a>(cells: impl Iterator<Item = &'a Cell>, turn: f64) -> f64 {
    let (mut arc, mut rest) = (0.0, turn);
    for cell in cells {
        rest = if cell.exceeds_rounding() { rest.min(cell.turn) } else { 0.0 };
        arc += cell.arc(rest);
        rest -= (cell.slopes[1] - cell.slopes[0]).max(0.0);
        // not so for NaN, of cells that count by their length
        if rest <= 0.0 {
            break;
        }
    }
    arc
}

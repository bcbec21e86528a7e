//! Rows of points whose triangles are as large as the deviation allows.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::chart::Chart;

const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// On a sphere, neighbouring rows have equally many points while these stand this far apart, in circumradii of their
/// triangles: from there on the rows would lie so far apart that triangles are wasted (7 % at this end, 0 at the other).
const NARROWEST: f64 = 1.4;

/// Where the number of points changes the rows are out of step: they lie nearer, as a part of their distance.
const OUT_OF_STEP: f64 = 0.85;

/// Rows nearer to a pole than this many circumradii are left to the pole.
const BESIDE_POLE: f64 = 0.8;

/// Points at one value of the second parameter.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The second parameter.
    pub v: f64,
    /// Distance of the points in the first parameter.
    pub step: f64,
    /// Points stand at whole steps and this part of one.
    pub shift: f64,
}

/// The rows between two values of the second parameter, those at the ends left out; `None` where they are more than `most`.
pub fn of(chart: &Chart, [low, high]: [f64; 2], most: usize) -> Option<Vec<Row>> {
    match *chart {
        Chart::Plane => Some(Vec::new()),
        Chart::Scaled(spacing) => {
            let count = ((high - low) / (0.5 * SQRT_3 * spacing.v)).ceil();
            if count.is_nan() || count > most as f64 {
                return None;
            }
            let row = |k: usize| Row { v: low + (high - low) * k as f64 / count, step: spacing.u, shift: shift(k) };
            Some((1..count as usize).map(row).collect())
        }
        Chart::Mercator { side, .. } => rings(side / SQRT_3, [low, high], most),
    }
}

/// Rows round a sphere: triangles have the circumradius `rho` (rad).
fn rings(rho: f64, [low, high]: [f64; 2], most: usize) -> Option<Vec<Row>> {
    let mut ladder = Ladder { rho, step: 0.0 };
    let mut latitudes = vec![low];
    let mut v = low;
    while v < high {
        v += ladder.climb(v);
        latitudes.push(v);
        if latitudes.len() > most {
            return None;
        }
    }
    let fit = if v > low { (high - low) / (v - low) } else { 1.0 };
    let mut ladder = Ladder { rho, step: 0.0 };
    let inner = latitudes.len().saturating_sub(1);
    let rows = latitudes.iter().take(inner).enumerate().map(|(k, v)| {
        let v = low + (v - low) * fit;
        let _ = ladder.climb(v);
        Row { v, step: ladder.step, shift: shift(k) }
    });
    Some(rows.skip(1).filter(|row| row.v.abs() < FRAC_PI_2 - BESIDE_POLE * rho).collect())
}

/// Decides how many points a ring has, from the one before.
struct Ladder {
    rho: f64,
    /// Of longitude between points, rad.
    step: f64,
}

impl Ladder {
    /// Takes the ring at a latitude; returns how far above it the next one is.
    fn climb(&mut self, v: f64) -> f64 {
        let radius = libm::cos(v).max(self.rho);
        let [narrow, wide] = [NARROWEST * self.rho, SQRT_3 * self.rho];
        let before = self.step * radius;
        let changes = !(narrow..=wide).contains(&before);
        if changes {
            let count = if v < 0.0 { (TAU * radius / narrow).floor() } else { (TAU * radius / wide).ceil() };
            self.step = TAU / count.max(3.0);
        }
        let half = 0.5 * (self.step * radius).min(wide);
        let apart = self.rho + (self.rho * self.rho - half * half).sqrt();
        if changes && before > 0.0 {
            OUT_OF_STEP * apart
        } else {
            apart
        }
    }
}

/// Each row's points stand half a step beside those of the one before.
fn shift(row: usize) -> f64 {
    if row.is_multiple_of(2) {
        0.0
    } else {
        0.5
    }
}

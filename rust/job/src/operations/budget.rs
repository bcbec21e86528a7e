//! What tessellation and rounding leave of a path's tolerance.

use styluscam_post::{Machine, OptionValue};
use styluscam_toolpath::budget::{Budget, POSTED_EACH_SIDE};
use styluscam_toolpath::PlanError;

use crate::limits::GOUGE;
use crate::Scene;

/// Decimal places of coordinates that are tried where a machine's own are too few.
const MOST_DECIMALS: u32 = 6;
/// What is left for fitting must be at least this, mm, or paths would have millions of points.
const LEAST_DEVIATION: f64 = 2e-4;
/// The budget of a path's `tolerance`, mm, on a part and a machine.
///
/// # Errors
/// [`PlanError::Budget`]: too little is left to fit a path with.
pub fn of(tolerance: f64, scene: &Scene, machine: &Machine) -> Result<Budget, PlanError> {
    let tessellation = scene.inward + scene.outward;
    let rounding = rounding(machine);
    left(tolerance, tessellation, rounding, scene.inward).ok_or_else(|| {
        let enough = |machine: &Machine| left(tolerance, tessellation, self::rounding(machine), scene.inward).is_some();
        PlanError::Budget { tolerance, tessellation, rounding, decimals: fewest_decimals(machine, enough) }
    })
}

/// The budget of a path along exact circles, of whose arcs ends and centres are rounded each: how far it keeps inside of them, and how
/// far its chords may be off it where a machine has no arcs.
///
/// # Errors
/// [`PlanError::Budget`]: too little is left.
pub fn of_circles(tolerance: f64, machine: &Machine) -> Result<Budget, PlanError> {
    let rounding = |machine: &Machine| machine.resolution_mm() * std::f64::consts::SQRT_2;
    let kept = |machine: &Machine| (rounding(machine) - 0.9 * GOUGE).max(0.0);
    let deviation = |machine: &Machine| tolerance - rounding(machine) - kept(machine);
    if deviation(machine) >= LEAST_DEVIATION {
        return Ok(Budget { deviation: deviation(machine), margin: kept(machine) });
    }
    let decimals = fewest_decimals(machine, |finer| deviation(finer) >= LEAST_DEVIATION);
    Err(PlanError::Budget { tolerance, tessellation: 0.0, rounding: rounding(machine), decimals })
}

/// What tessellation and rounding leave, if that is enough to fit a path with.
fn left(tolerance: f64, tessellation: f64, rounding: f64, inward: f64) -> Option<Budget> {
    // rounding may also go inwards: beyond what a gouge is allowed, that takes room too
    let inwards = (rounding - 0.9 * GOUGE).max(0.0);
    let left = tolerance - tessellation - rounding - inwards;
    let budget = Budget::sharing(left, inward + inwards, POSTED_EACH_SIDE);
    (budget.deviation >= LEAST_DEVIATION).then_some(budget)
}

/// What a machine's last decimal place takes: half a unit in each of three axes, mm.
pub fn rounding(machine: &Machine) -> f64 {
    0.5 * machine.resolution_mm() * 3.0_f64.sqrt()
}

/// The fewest decimal places with which a machine is good `enough`, if it can post so many.
fn fewest_decimals(machine: &Machine, enough: impl Fn(&Machine) -> bool) -> Option<u32> {
    (1..=MOST_DECIMALS).find(|count| {
        let mut finer = machine.clone();
        finer.set_option("decimals", OptionValue::Number(f64::from(*count))).is_ok() && enough(&finer)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_spent_to_both_sides_of_a_surface_in_the_middle() {
        let budget = left(0.005, 0.001, 0.0005, 0.0004).unwrap();
        assert!((budget.deviation - 0.48 * 0.0035).abs() < 1e-15);
        assert!((budget.margin - (0.0004 + 0.5 * 0.0035)).abs() < 1e-15);
    }

    #[test]
    fn coarse_rounding_is_kept_out_of_the_part_too() {
        let [fine, coarse] = [0.0009, 0.0029].map(|rounding| left(0.01, 0.0, rounding, 0.0).unwrap());
        // 0.0009 may go inwards as a gouge that is allowed; of 0.0029 another 0.002 is kept outside
        assert!((fine.margin - 0.5 * 0.0091).abs() < 1e-15);
        assert!((coarse.margin - (0.002 + 0.5 * 0.0051)).abs() < 1e-15);
    }

    #[test]
    fn too_little_left_is_nothing() {
        assert_eq!(left(0.001, 0.0005, 0.0002, 0.0), None);
    }
}

//! The course that makes what the moving tool leaves least.
//!
//! A single position has two best spreads; chosen for each position by itself, the axis jumps from one to the other and the
//! movement between cuts into the surface. One smooth function for the whole strip, fitted to the surface that the movement
//! leaves, stays on one of them.

use rayon::prelude::*;

use super::course::Course;
use super::cutter::Flank;
use super::heights::{Heights, Layout};
use super::stand::stand;
use super::touch::touching;
use super::{FlankError, RuledStrip};

/// Steps of the fit at most.
const STEPS: usize = 25;
/// Steps from the least squares towards the least of the largest: along every ruling, then of the whole strip.
const LAWSON_STEPS: usize = 16;
const WHOLE_STEPS: usize = 12;
/// What a height of 0 counts in a step for the whole strip, beside the largest.
const FLOOR: f64 = 0.1;
/// Places along the strip at which a start touches the ruling, and how little its bends count beside that.
const TOUCHED: usize = 33;
const STIFFNESS: f64 = 1e-4;
/// A course is gone on with when the mean of squares is at most so many times the least.
const HOPEFUL: f64 = 2.0;
/// Two courses that leave the same but for this share are one.
const SAME: f64 = 1e-3;
/// The fit has ended when a step gains less than this share.
const GAIN: f64 = 1e-4;
/// Damping at first, as a share of the largest diagonal element, and the least that keeps idle coefficients at rest.
const DAMPING: f64 = 1e-4;
const LEAST_DAMPING: f64 = 1e-10;
/// After a step that was too long there is so much at least.
const SOME_DAMPING: f64 = 1e-6;
/// With more a step is none.
const MOST_DAMPING: f64 = 10.0;
/// Spreads tried on either side for one at which there is a position.
const TRIED: usize = 32;
/// Places at which a course is checked for positions, and halvings of the largest radius.
const CHECKED: usize = 129;
const HALVINGS: usize = 14;
/// Times a course is spread farther until there are positions all along, and how much farther.
const WIDENINGS: usize = 6;
const WIDENED: f64 = 1.2;

/// What courses leave.
type LeftBy<'a> = dyn Fn(&Course) -> Result<Heights, FlankError> + Sync + 'a;

/// A course that leaves little in so many positions, bends of it counting for so much beside heights: first by least squares, from
/// there on by the largest heights.
///
/// # Errors
/// No position touches both rails somewhere, however far the contacts are spread.
pub fn fitted(strip: &RuledStrip, flank: &Flank, count: usize, stiffness: f64) -> Result<Course, FlankError> {
    let layout = Layout::of(count);
    let samples = layout.samples(strip);
    let left = |course: &Course| Heights::of(course, strip, &samples, flank, &layout);
    // there are two best spreads, on either side of equal shares, about where the ruling is touched too
    let touching = [0, 1].map(|sign| about_touching(strip, flank, sign));
    let are_both = touching.iter().all(Option::is_some);
    let first = match least_squares(Course::straight(), &left, stiffness) {
        Err(FlankError::NoPosition { .. }) => least_squares(feasible(strip, flank)?, &left, stiffness)?,
        found => found?,
    };
    // the other of the two best spreads lies on about the other side
    let mirrored = (!are_both).then(|| first.0.times(-1.0));
    let starts: Vec<_> = touching.into_iter().chain([mirrored]).flatten().collect();
    // also where no position lies there
    let mut fits: Vec<_> =
        starts.into_par_iter().filter_map(|start| least_squares(start, &left, stiffness).ok()).collect();
    fits.push(first);
    fits.sort_by(|a, b| a.1.squares().total_cmp(&b.1.squares()));
    let hopeful = fits.first().map_or(0.0, |best| HOPEFUL * best.1.squares());
    fits.retain(|fit| fit.1.squares() <= hopeful);
    fits.dedup_by(|b, a| b.1.squares() <= a.1.squares() * (1.0 + SAME));
    let found: Vec<_> = fits.into_par_iter().map(|fit| least_largest(fit, &left, stiffness)).collect();
    let best = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    Ok(best.map_or_else(Course::straight, |(_, course)| course))
}

/// About where the ruling is touched as well as both rails, with the contacts spread to one side; none where it is so in few
/// places only.
fn about_touching(strip: &RuledStrip, flank: &Flank, sign: usize) -> Option<Course> {
    let at = |i: usize| i as f64 / (TOUCHED - 1) as f64;
    let spreads = (0..TOUCHED).filter_map(|i| Some((at(i), touching(strip, flank, at(i))[sign]?)));
    let spreads: Vec<_> = spreads.collect();
    (2 * spreads.len() > TOUCHED).then(|| Course::near(&spreads, STIFFNESS))?
}

/// A course on which there are positions all along, where there are none at equal shares.
fn feasible(strip: &RuledStrip, flank: &Flank) -> Result<Course, FlankError> {
    let share = |i: usize, count: usize| i as f64 / (count - 1) as f64;
    let is_position = |u: f64, spread: f64| stand(strip, flank, [u - spread, u + spread], [0.0; 2]).is_ok();
    // not at the very edge of where there are positions
    let inside = |u: f64, sign: f64| {
        let at = |step: usize| sign * slanted(strip, u) * step as f64 / TRIED as f64;
        let first = (0..TRIED).find(|step| [0, 1].iter().all(|more| is_position(u, at(step + more))))?;
        Some((u, at(if first > 0 { first + 1 } else { 0 })))
    };
    let sides = [1.0, -1.0];
    let found: Vec<_> = (0..TOUCHED).map(|i| sides.map(|sign| inside(share(i, TOUCHED), sign))).collect();
    if let Some(i) = found.iter().position(|pair| pair.iter().all(Option::is_none)) {
        let u = share(i, TOUCHED);
        return Err(FlankError::Nowhere { u, radius: flank.radius(), most: widest_radius(strip, flank, u) });
    }
    let checked = |course: &Course| {
        let mut places = (0..CHECKED).map(|i| share(i, CHECKED));
        places.all(|u| is_position(u, course.spread(u)))
    };
    let courses = (0..2).filter_map(|side| {
        let spreads: Vec<_> = found.iter().map(|pair| pair[side]).collect::<Option<_>>()?;
        let near = Course::near(&spreads, STIFFNESS)?;
        (0..WIDENINGS).map(|times| near.times(libm::pow(WIDENED, times as f64))).find(checked)
    });
    let one_sided = found.iter().position(|pair| pair.iter().any(Option::is_none)).unwrap_or(0);
    let none = || FlankError::NoPosition { u: share(one_sided, TOUCHED), radius: flank.radius() };
    courses.min_by(|a, b| a.largest().total_cmp(&b.largest())).ok_or_else(none)
}

/// The spread with which the contacts are a ruling's length apart along the rails.
fn slanted(strip: &RuledStrip, u: f64) -> f64 {
    let [a, b] = strip.ends(u);
    (b.point - a.point).norm() / (a.first.norm() + b.first.norm())
}

/// The largest radius of a flank of the same taper that touches both rails there with contacts spread so far at most, mm.
fn widest_radius(strip: &RuledStrip, flank: &Flank, u: f64) -> f64 {
    let widest = slanted(strip, u);
    let spreads = || (0..=2 * TRIED).map(|i| widest * (i as f64 / TRIED as f64 - 1.0));
    let does = |share: f64| {
        spreads().any(|spread| stand(strip, &flank.of_share(share), [u - spread, u + spread], [0.0; 2]).is_ok())
    };
    let (mut within, mut beyond) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (within + beyond);
        if does(middle) {
            within = middle;
        } else {
            beyond = middle;
        }
    }
    within * flank.radius()
}

/// A damped Gauss-Newton search (Levenberg, Marquardt): the course and what it leaves.
fn least_squares(start: Course, left: &LeftBy<'_>, stiffness: f64) -> Result<(Course, Heights), FlankError> {
    let mut course = start;
    let mut found = left(&course)?;
    let counts = vec![1.0; found.all().count()];
    let mut damping = DAMPING;
    for _ in 0..STEPS {
        let stepped = course.stepped(found.normal(&counts), damping.max(LEAST_DAMPING), stiffness);
        let Some(tried) = stepped else { break };
        match left(&tried) {
            Ok(better) if better.squares() < found.squares() => {
                let gain = 1.0 - better.squares() / found.squares();
                (course, found, damping) = (tried, better, 0.1 * damping);
                if gain < GAIN {
                    break;
                }
            }
            // also where there is no position so far off
            Ok(_) | Err(_) => damping = (30.0 * damping).max(SOME_DAMPING),
        }
        if damping > MOST_DAMPING {
            break;
        }
    }
    Ok((course, found))
}

/// Least squares whose weights grow where heights are large, until along every ruling the largest are equal, and of the whole
/// strip (C. L. Lawson: Contributions to the theory of linear least maximum approximation. UCLA 1961); the best of the courses
/// on the way, and its measure, mm.
fn least_largest((start, mut found): (Course, Heights), left: &LeftBy<'_>, stiffness: f64) -> (f64, Course) {
    let (mut course, mut best) = (start.clone(), (found.measure(), start));
    let mut counts = vec![1.0; found.all().count()];
    let across = found.across();
    for step in 0..LAWSON_STEPS + WHOLE_STEPS {
        if step < LAWSON_STEPS {
            counts.iter_mut().zip(found.all()).for_each(|(count, height)| *count *= height);
            for counts in counts.chunks_mut(across) {
                let whole: f64 = counts.iter().sum();
                // a ruling without heights counts as before it had any
                counts
                    .iter_mut()
                    .for_each(|count| *count = if whole > 0.0 { *count / whole } else { 1.0 / across as f64 });
            }
        } else {
            let largest = found.largest().max(f64::MIN_POSITIVE);
            counts.iter_mut().zip(found.all()).for_each(|(count, height)| *count *= FLOOR + height / largest);
        }
        let Some(tried) = course.stepped(found.normal(&counts), LEAST_DAMPING, stiffness) else { break };
        let Ok(next) = left(&tried) else { break };
        (course, found) = (tried, next);
        if found.measure() < best.0 {
            best = (found.measure(), course.clone());
        }
    }
    best
}

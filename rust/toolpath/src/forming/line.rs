//! Passes over a line that a strategy lays out in plan.

use styluscam_motion::{Cancelled, Watch};

use super::zig_zag::SurfaceCourse;
use crate::{fitting, PathPoint, Surface};

/// Runs of the tool along the surface over a line in plan, given by its corners (mm) in order.
///
/// The line is followed exactly: chords deviate from the surface over it by at most `deviation` mm along the normal. Runs are
/// interrupted where the contact leaves the selected faces, and where the tool meets nothing. `narrow` mm: between the corners
/// the surface is looked at no closer than this where nothing is proven, so corners should be no farther apart than the
/// smallest feature that counts.
///
/// # Errors
/// `Cancelled`.
pub fn over_line(
    surface: &Surface<'_>,
    corners: impl IntoIterator<Item = [f64; 2]>,
    narrow: f64,
    deviation: f64,
    watch: &Watch,
) -> Result<Vec<Vec<PathPoint>>, Cancelled> {
    let mut course = SurfaceCourse { surface, row: None, hint: None, watch };
    let (mut met, mut run) = (Vec::new(), Vec::new());
    for [x, y] in corners {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        match surface.at(x, y, &mut course.hint) {
            Some(point) => run.push(point),
            None => met.push(std::mem::take(&mut run)),
        }
    }
    met.push(run);
    let mut found = Vec::new();
    let between = |a: &PathPoint, b: &PathPoint| fitting::Course::between(&mut course, a, b);
    let stretches = met.into_iter().scan(between, |between, exact| Some(surface.stretches(exact, false, between)));
    for (exact, _) in stretches.flatten().collect::<Vec<_>>() {
        for run in fitting::selected_runs(&exact, false, |a, b| fitting::Course::between(&mut course, a, b)) {
            let runs = fitting::densified(&run, deviation, narrow, &mut course);
            found.extend(runs.iter().map(|run| surface.thinned(run, deviation)));
        }
    }
    // a cancelled course ends at once: what it left is no path
    if watch.is_cancelled() {
        return Err(Cancelled);
    }
    Ok(found)
}

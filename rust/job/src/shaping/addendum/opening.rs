//! The line within which an addendum ends that goes to the backing plate's opening.

use styluscam_geometry::{Mesh, Vector};

use crate::{plates, JobDocument, JobError, Opening, Zero};

/// The addendum ends so much before the margin, mm: what is rounded on the way does not reach into it.
const GAP: f64 = 0.01;

/// The opening's outline, less the fixture's margin, around a part as it lies turned for the set-up: corners in plan,
/// counter-clockwise, mm. `formed` are the triangles that the sheet takes.
///
/// # Errors
/// No backing plate, an opening that is all margin.
pub fn outline(job: &JobDocument, part: &Mesh, formed: &[bool]) -> Result<Vec<[f64; 2]>, JobError> {
    let fixture = job.setup.fixture;
    let Some((fixture, backing)) = fixture.and_then(|fixture| Some((fixture, fixture.backing?))) else {
        let message = "end = \"opening\" and the job states no backing plate";
        let hint = "state setup.fixture.backing.opening, or remove end and state height";
        return Err(JobError::document("missing", "part.addendum.end", message, hint));
    };
    let less = fixture.margin + GAP;
    let opening = match backing.opening {
        Opening::Diameter(diameter) => Opening::Diameter(diameter - 2.0 * less),
        Opening::Sides(sides) => Opening::Sides(sides.map(|side| side - 2.0 * less)),
    };
    if opening.sides().into_iter().any(|side| side <= 0.0) {
        let message = format!("the opening is no wider than its margin of {} mm on both sides", fixture.margin);
        let hint = "state a wider opening or a smaller margin";
        return Err(JobError::document("out-of-range", "setup.fixture.backing.opening", message, hint));
    }
    let [x, y] = match fixture.center {
        Some([x, y]) => {
            let zero = zero_in_plan(job);
            [x + zero.x, y + zero.y]
        }
        None => middle(part, formed),
    };
    Ok(plates::corners(opening).into_iter().map(|[dx, dy]| [x + dx, y + dy]).collect())
}

/// The program's zero on the turned part.
fn zero_in_plan(job: &JobDocument) -> Vector {
    match job.setup.zero {
        Some(Zero::Point(point)) => job.setup.chuck.turn().point(point.into()),
        Some(Zero::SheetTop | Zero::Model) | None => Vector::zeros(),
    }
}

/// The middle of what is formed, in plan.
fn middle(part: &Mesh, formed: &[bool]) -> [f64; 2] {
    let own = (0..formed.len()).filter(|triangle| formed[*triangle]).flat_map(|triangle| part.corners(triangle));
    let infinite = [f64::INFINITY; 2];
    let (low, high) = own.fold((infinite, infinite.map(|x| -x)), |(low, high), corner| {
        ([low[0].min(corner.x), low[1].min(corner.y)], [high[0].max(corner.x), high[1].max(corner.y)])
    });
    [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]))
}

//! Points of the faces at which something keeps the tool away: from these it is found what is left there.

use styluscam_geometry::Vector;
use styluscam_toolpath::offset::Stopped;

use crate::body::in_triangle;

/// Points on a face.
const SAMPLES: usize = 64;
/// How much nearer a point lies to the corners of a triangle that are stopped than to the others.
const NEAR: f64 = 3.0;

/// A triangle of the offset with corners at which something keeps the tool away.
pub struct StoppedTriangle {
    /// The part's triangle in which it lies.
    pub triangle: u32,
    /// Of the surface.
    pub corners: [Vector; 3],
    /// Whether something stops the tool there.
    pub stopped: [bool; 3],
    /// Whether that is the part's own curvature.
    pub is_smooth: bool,
}

impl StoppedTriangle {
    /// Its share of the stopped corners, mm^2.
    fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        let stopped = self.stopped.into_iter().filter(|stopped| *stopped).count() as f64;
        (b - a).cross(&(c - a)).norm() / 6.0 * stopped
    }

    /// A point of that share: any where all corners are stopped, else nearer to those that are.
    fn sample(&self, number: usize, area: f64) -> Stopped {
        let point = if self.stopped == [true; 3] {
            in_triangle(self.corners, number)
        } else {
            let weights = self.stopped.map(|stopped| if stopped { NEAR } else { 1.0 });
            let whole: f64 = weights.iter().sum();
            weights.iter().zip(self.corners).map(|(weight, corner)| *weight / whole * corner).sum()
        };
        Stopped { triangle: self.triangle, point, is_smooth: self.is_smooth, area }
    }
}

/// [`SAMPLES`] points of some triangles, each for the same area.
pub fn stopped_points(all: &[StoppedTriangle]) -> Vec<Stopped> {
    let each = all.iter().map(StoppedTriangle::area).sum::<f64>() / SAMPLES as f64;
    let mut passed = 0.0;
    let mut taken = Vec::with_capacity(SAMPLES);
    for triangle in all {
        passed += triangle.area();
        while taken.len() < SAMPLES && passed >= (taken.len() as f64 + 0.5) * each {
            taken.push(triangle.sample(taken.len(), each));
        }
    }
    taken
}

//! Open or closed, by lines through the surface: what enters a closed body leaves it.
//!
//! Edges do not show it: a closed body's triangles may meet in T-joints or lie a hair apart, as many files have them.

use styluscam_geometry::Vector;

use super::Body;

/// Directions in which lines are drawn: along no axis, plane or diagonal that a part is likely to have.
const DIRECTIONS: [[f64; 3]; 3] = [[0.211, 0.157, 0.965], [0.683, -0.312, 0.661], [-0.419, 0.871, 0.257]];
/// Lines in each direction.
const LINES: usize = 200;
/// Share of the lines that may miss their other end, where a triangle is lost or turned over.
const SLACK: f64 = 0.04;
/// The same where a body has holes: an open pipe, which most lines cross twice, has 0.15 and more.
const TORN: f64 = 0.12;

/// What kind of surface a mesh is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shell {
    /// It encloses a volume.
    Closed,
    /// It encloses a volume but for holes where triangles are missing.
    Torn,
    /// It encloses a volume, and its triangles are wound inward.
    InsideOut,
    /// It has a border: a surface without thickness.
    Open,
    /// It encloses a volume, and some of its triangles are wound inward.
    Mixed,
}

impl Body<'_> {
    /// Whether the surface is open, closed, or wound both ways.
    #[must_use]
    pub fn shell(&self) -> Shell {
        let shares = DIRECTIONS.map(|direction| unbalanced(self, Vector::from(direction).normalize()));
        let signed = shares.iter().map(|share| share.signed).fold(0.0, f64::max);
        let plain = shares.iter().map(|share| share.plain).fold(0.0, f64::max);
        let inward = shares.iter().map(|share| share.inward).fold(0.0, f64::max);
        match () {
            () if signed <= SLACK && inward > 0.5 => Shell::InsideOut,
            () if signed <= SLACK => Shell::Closed,
            () if plain <= SLACK => Shell::Mixed,
            () if signed <= TORN && inward <= 0.5 => Shell::Torn,
            () => Shell::Open,
        }
    }
}

/// Shares of lines.
struct Unbalanced {
    /// That do not leave as often as they enter.
    signed: f64,
    /// That cross an odd number of times.
    plain: f64,
    /// That leave before they have entered.
    inward: f64,
}

fn unbalanced(body: &Body<'_>, direction: Vector) -> Unbalanced {
    let step = (body.samples.len() / LINES).max(1);
    let (mut lines, mut signed, mut odd, mut inward) = (0.0, 0.0, 0.0, 0.0);
    for sample in body.samples.iter().step_by(step) {
        let hits = body.rays.line(sample.point, direction, body.fine());
        let leaving = hits.iter().filter(|hit| hit.along > 0.0).count();
        lines += 1.0;
        signed += f64::from(2 * leaving != hits.len());
        odd += f64::from(!hits.len().is_multiple_of(2));
        inward += f64::from(hits.first().is_some_and(|hit| hit.along > 0.0));
    }
    Unbalanced { signed: signed / lines, plain: odd / lines, inward: inward / lines }
}

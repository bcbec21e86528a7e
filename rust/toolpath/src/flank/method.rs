//! Ways to place the tool along a strip.

use super::cutter::Flank;
use super::stand::Stand;
use super::RuledStrip;

/// Shares of the ruling at which the two-point offset takes its points.
pub(super) const QUARTERS: [f64; 2] = [0.25, 0.75];

/// How positions are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Both rails touched, the contacts spread so that the moving tool leaves least of the surface and enters it least.
    Swept,
    /// Both rails touched at equal parameters.
    Rails,
    /// Both rails and the ruling touched (J.-M. Redonnet, W. Rubio, G. Dessein: Side milling of ruled surfaces: optimum positioning
    /// of the milling cutter and calculation of interference. International Journal of Advanced Manufacturing Technology 14, 1998).
    ThreePoints,
    /// The axis at the radius along the normals of two points of the ruling, at its quarters (X.-W. Liu: Five-axis NC cylindrical
    /// milling of sculptured surfaces. Computer-Aided Design 27, 1995).
    TwoPoints,
    /// The axis parallel to the ruling, at the radius along the normal of its middle.
    OnePoint,
}

/// Length of the ruling there, mm.
fn ruling(strip: &RuledStrip, u: f64) -> f64 {
    (strip.rail(1, u).point - strip.rail(0, u).point).norm()
}

/// Points of the axis beside both rails, where it lies beside two points of a ruling.
pub(super) fn offset(strip: &RuledStrip, flank: &Flank, u: f64, shares: [f64; 2]) -> Stand {
    let growth = flank.growth_along_line() * ruling(strip, u);
    let radii = shares.map(|v| flank.radius() + growth * v);
    let [a, b] = [0, 1].map(|i| strip.point([u, shares[i]]) + strip.normal([u, shares[i]]) * radii[i]);
    let along = (b - a) / (shares[1] - shares[0]);
    // the tool is moved up or down until it has the first of the radii at the first of the points
    let back = if flank.growth() > 0.0 {
        along.normalize() * ((radii[0] - flank.radius()) / flank.growth())
    } else {
        along * shares[0]
    };
    Stand { axis: [a - back, b + along * (1.0 - shares[1])], contacts: shares.map(|v| strip.point([u, v])) }
}

/// The axis parallel to the ruling, beside its middle.
pub(super) fn beside_middle(strip: &RuledStrip, flank: &Flank, u: f64) -> Stand {
    let middle = [u, 0.5];
    let aside = strip.normal(middle);
    let radii = [flank.radius(), flank.radius() + flank.growth_along_line() * ruling(strip, u)];
    let axis = [0, 1].map(|rail| strip.rail(rail, u).point + aside * radii[rail]);
    Stand { axis, contacts: [strip.point(middle); 2] }
}

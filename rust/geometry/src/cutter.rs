//! A tool's body with tables by radius, height and rise: what planning asks some hundred million times.

use std::f64::consts::FRAC_PI_2;
use std::ops::Deref;

use crate::piecewise::{Piecewise, ROUNDING};
use crate::profile::Profile;
use crate::ToolBody;

/// Cells of the table over the radius; one tangent each. At 1024 a bound costs one look-up and is
/// within micrometres of the curve except at a vertical tangent, where it stays on the safe side.
const RADIUS_CELLS: usize = 1024;
/// Cells of the table over the rise: interpolated, the radius is good to a 1e-5 of the tool.
const RISE_CELLS: usize = 512;
/// Cells of the table over the slope.
const SLOPE_CELLS: usize = 128;

/// Newton's steps to a height at most: four or five do.
const HEIGHT_STEPS: usize = 8;

/// Walls rise by more: their square would be lost, or is infinite.
const STEEP: f64 = 1e9;

/// Height of the profile at a radius with its derivatives by the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Height {
    /// mm.
    pub value: f64,
    /// dz/dr.
    pub rise: f64,
    /// d2z/dr2, 1/mm.
    pub bend: f64,
}

/// A line below the profile: `height + rise * (d - radius)` is never above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportingLine {
    /// Radius at which it touches, mm.
    pub radius: f64,
    /// Height there, mm.
    pub height: f64,
    /// Its steepness dz/dr.
    pub rise: f64,
}

/// A tool's body with tables for quick and safe bounds. Tip at the origin, axis up.
#[derive(Clone, Debug, PartialEq)]
pub struct Cutter {
    body: ToolBody,
    cells_per_mm: f64,
    lines: Vec<SupportingLine>,
    /// Radius by rise / (1 + rise).
    rises: Vec<f64>,
    slopes: Vec<SlopeNode>,
    /// Height by radius.
    heights: Option<Piecewise>,
    /// Radius and height by rise / (1 + rise).
    points: Option<[Piecewise; 2]>,
}

/// The profile at one slope of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SlopeNode {
    slope: f64,
    sin: f64,
    cos: f64,
    radius: f64,
    height: f64,
}

impl Deref for Cutter {
    type Target = ToolBody;

    #[inline]
    fn deref(&self) -> &ToolBody {
        &self.body
    }
}

impl Cutter {
    /// `profile` offset outwards by a ball of radius `ball`, mm, not negative.
    #[must_use]
    pub fn new(profile: &Profile, ball: f64) -> Self {
        Self::of(ToolBody::new(profile, ball))
    }

    /// A body made ready.
    #[must_use]
    pub fn of(body: ToolBody) -> Self {
        let mut cutter = Self {
            body,
            cells_per_mm: 0.0,
            lines: Vec::new(),
            rises: Vec::new(),
            slopes: Vec::new(),
            heights: None,
            points: None,
        };
        cutter.slopes = (0..=SLOPE_CELLS).map(|i| cutter.slope_node(i)).collect();
        cutter.cells_per_mm = RADIUS_CELLS as f64 / cutter.max_radius();
        cutter.lines = (0..RADIUS_CELLS).map(|i| cutter.tangent_at(i as f64 / cutter.cells_per_mm)).collect();
        cutter.rises = (0..=RISE_CELLS).map(|i| cutter.rise_node(i)).collect();
        let size = cutter.size();
        cutter.heights = Some(Piecewise::of(cutter.max_radius(), size, |radius| cutter.height_at_radius(radius)));
        let at_share = |share: f64| cutter.point_at(libm::atan2(share, 1.0 - share));
        cutter.points = Some([
            Piecewise::of(1.0, size, |share| at_share(share).0),
            Piecewise::of(1.0, size, |share| at_share(share).1),
        ]);
        cutter
    }

    /// What rounding is a share of.
    fn size(&self) -> f64 {
        self.max_radius() + self.max_height()
    }

    fn rise_node(&self, i: usize) -> f64 {
        let share = i as f64 / RISE_CELLS as f64;
        self.point_at(libm::atan2(share, 1.0 - share)).0
    }

    fn slope_node(&self, i: usize) -> SlopeNode {
        let slope = FRAC_PI_2 * i as f64 / SLOPE_CELLS as f64;
        let (sin, cos) = if i == SLOPE_CELLS { (1.0, 0.0) } else { libm::sincos(slope) };
        let (radius, height) = self.point_at(slope);
        SlopeNode { slope, sin, cos, radius, height }
    }

    fn tangent_at(&self, radius: f64) -> SupportingLine {
        let slope = self.slope_at_radius(radius);
        let (radius, height) = self.point_at(slope);
        SupportingLine { radius, height, rise: libm::tan(slope) }
    }

    /// Radius and height where the profile rises by `rise` (dz/dr, not negative), mm: [`point_at`](ToolBody::point_at) of its
    /// slope, by table where that does.
    #[must_use]
    pub fn at_rise(&self, rise: f64) -> (f64, f64) {
        if rise > STEEP {
            return self.point_at(libm::atan(rise));
        }
        if let Some(ball) = self.as_ball() {
            let cos = 1.0 / (1.0 + rise * rise).sqrt();
            let sin = rise * cos;
            return (ball * sin, ball * sin * sin / (1.0 + cos));
        }
        self.point_by_table(rise).unwrap_or_else(|| self.point_at(libm::atan(rise)))
    }

    fn point_by_table(&self, rise: f64) -> Option<(f64, f64)> {
        let ([radii, heights], share) = (self.points.as_ref()?, rise / (1.0 + rise));
        Some((radii.value_at(share)?, heights.value_at(share)?))
    }

    /// Slope at a radius from 0 to the base's, rad; 0 on a flat tip.
    #[must_use]
    pub fn slope_at_radius(&self, radius: f64) -> f64 {
        match self.as_ball() {
            Some(ball) => libm::asin((radius / ball).clamp(0.0, 1.0)),
            None => self.meridian().slope_within(radius, self.slope_bracket(radius)),
        }
    }

    /// Two slopes of the table that enclose the one at `radius`.
    fn slope_bracket(&self, radius: f64) -> [f64; 2] {
        if self.slopes.is_empty() {
            return [0.0, FRAC_PI_2];
        }
        let above = self.slopes.partition_point(|n| n.radius < radius).clamp(1, self.slopes.len() - 1);
        [self.slopes[above - 1].slope, self.slopes[above].slope]
    }

    /// Height over the tip at a radius, mm; infinite beyond the base.
    #[must_use]
    pub fn height_at_radius(&self, radius: f64) -> f64 {
        if radius > self.max_radius() {
            return f64::INFINITY;
        }
        match self.as_ball() {
            Some(ball) => radius * radius / (ball + (ball * ball - radius * radius).max(0.0).sqrt()),
            None => self.meridian().height_within(radius, self.slope_bracket(radius)),
        }
    }

    /// Radius (mm) and steepness dz/dr at a height over the tip, mm, not negative: the base's and infinity above it.
    #[must_use]
    pub fn at_height(&self, height: f64) -> (f64, f64) {
        if height >= self.max_height() {
            return (self.max_radius(), f64::INFINITY);
        }
        if let Some(ball) = self.as_ball() {
            let radius = (height * (2.0 * ball - height)).max(0.0).sqrt().min(self.max_radius());
            return (radius, radius / (ball - height));
        }
        let above = self.slopes.partition_point(|n| n.height < height).clamp(1, self.slopes.len() - 1);
        let (low, high) = (&self.slopes[above - 1], &self.slopes[above]);
        self.followed_to_height(height, low, high).unwrap_or_else(|| {
            let (radius, slope) = self.meridian().at_height(height, [low.slope, high.slope]);
            (radius, libm::tan(slope))
        })
    }

    /// By Newton's method on the table of heights, where it has them.
    fn followed_to_height(&self, height: f64, low: &SlopeNode, high: &SlopeNode) -> Option<(f64, f64)> {
        let heights = self.heights.as_ref()?;
        let share = (height - low.height) / (high.height - low.height);
        let mut radius = low.radius + share * (high.radius - low.radius);
        for _ in 0..HEIGHT_STEPS {
            let [value, rise, _] = heights.at(radius)?;
            let next = (radius - (value - height) / rise).clamp(low.radius, high.radius);
            let step = (next - radius).abs();
            radius = next;
            // nearer than the table knows heights a step is chance
            if step <= f64::EPSILON * radius || (value - height).abs() <= ROUNDING * self.size() {
                return Some((radius, rise));
            }
        }
        None
    }

    /// As [`height_at_radius`](Self::height_at_radius), by table where it has the height to a few 1e-15 of the size.
    #[inline]
    #[must_use]
    pub fn quick_height_at_radius(&self, radius: f64) -> f64 {
        let followed = if self.as_ball().is_some() { None } else { self.heights.as_ref() };
        followed.and_then(|heights| heights.value_at(radius)).unwrap_or_else(|| self.height_at_radius(radius))
    }

    /// Height at a radius with its derivatives, by table: none beside kinks, near vertical tangents, beyond the base.
    #[inline]
    #[must_use]
    pub fn height_with_derivatives(&self, radius: f64) -> Option<Height> {
        let [value, rise, bend] = self.heights.as_ref()?.at(radius)?;
        Some(Height { value, rise, bend })
    }

    /// A line that the profile does not fall below, touching near `radius` (mm, up to the base's).
    #[inline]
    #[must_use]
    pub fn supporting_line(&self, radius: f64) -> SupportingLine {
        let cell = (radius * self.cells_per_mm) as usize;
        self.lines[cell.min(RADIUS_CELLS - 1)]
    }

    /// A radius near which the profile rises by `rise` (dz/dr), mm: by table, for bounds.
    #[inline]
    #[must_use]
    pub fn radius_of_rise(&self, rise: f64) -> f64 {
        let scaled = rise / (1.0 + rise) * RISE_CELLS as f64;
        let cell = (scaled as usize).min(RISE_CELLS - 1);
        let (a, b) = (self.rises[cell], self.rises[cell + 1]);
        a + (scaled - cell as f64) * (b - a)
    }

    /// A height that the profile does not fall below at `radius`, mm; infinite beyond the base.
    #[inline]
    #[must_use]
    pub fn height_bound(&self, radius: f64) -> f64 {
        if radius > self.max_radius() {
            return f64::INFINITY;
        }
        let line = self.supporting_line(radius);
        line.height + line.rise * (radius - line.radius)
    }

    /// Signed distance from the body to a point `radius` off the axis and `height` over the tip, mm.
    ///
    /// Negative inside. Outside and near the surface it is exact; the slope of the nearest point comes with it.
    /// It is the largest gap that any supporting plane of the body leaves: max over the slope of
    /// r sin - z cos - H, with H the support function.
    #[must_use]
    pub fn distance(&self, radius: f64, height: f64) -> (f64, f64) {
        let cell = self.distance_cell(radius, height);
        let (mut low, mut high) = (self.slopes[cell].slope, self.slopes[cell + 1].slope);
        // the first and last plane are the horizontal and the vertical one: exact at the table's ends
        let mut slope = 0.5 * (low + high);
        let mut steps = [f64::INFINITY; 2];
        for _ in 0..60 {
            let (sin, cos) = libm::sincos(slope);
            let (r, z) = self.point_at(slope);
            let along = (radius - r) * cos + (height - z) * sin;
            if along > 0.0 {
                low = slope;
            } else {
                high = slope;
            }
            let rate = (height - z) * cos - (radius - r) * sin - self.curvature_radius_at(slope);
            let next = slope - along / rate;
            // where the curvature jumps, Newton's steps may go to and fro over the jump for ever
            let is_better = next > low && next < high && 2.0 * (next - slope).abs() < steps[0];
            let next = if is_better { next } else { 0.5 * (low + high) };
            let step = (next - slope).abs();
            steps = [steps[1], step];
            slope = next;
            // the gap is stationary in the slope: 1e-9 rad leaves 1e-18 of it
            if step < 1e-9 {
                break;
            }
        }
        // over a straight part the gap is largest at its slope alone, not near it
        let straights = self.straights().iter().map(|straight| straight.slope);
        let gaps = [low, slope, high].into_iter().chain(straights).map(|s| (self.gap(radius, height, s), s));
        gaps.fold((f64::NEG_INFINITY, 0.0), |a, b| if b.0 > a.0 { b } else { a })
    }

    /// The cell of the slope table in which the nearest point's slope lies.
    fn distance_cell(&self, radius: f64, height: f64) -> usize {
        let ahead = |n: &SlopeNode| (radius - n.radius) * n.cos + (height - n.height) * n.sin > 0.0;
        self.slopes.partition_point(ahead).clamp(1, SLOPE_CELLS) - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::samples::any_profile;
    use proptest::prelude::*;

    fn any_ball() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), 0.0..3.0_f64]
    }

    proptest! {
        #[test]
        fn a_grown_cutter_is_the_offset_curve(profile in any_profile(), ball in any_ball(), slope in 0.0..FRAC_PI_2) {
            let (bare, grown) = (profile.point_at(slope), Cutter::new(&profile, ball).point_at(slope));
            prop_assert!((grown.0 - bare.0 - ball * slope.sin()).abs() < 1e-12 * (1.0 + bare.0), "{grown:?} {bare:?}");
            prop_assert!((grown.1 - bare.1 - ball * (1.0 - slope.cos())).abs() < 1e-12 * (1.0 + bare.1), "{grown:?} {bare:?}");
        }

        #[test]
        fn radius_gives_back_the_point(profile in any_profile(), ball in any_ball(), share in 0.0..1.0_f64) {
            let cutter = Cutter::new(&profile, ball);
            let radius = share * cutter.max_radius();
            let (slope, height) = (cutter.slope_at_radius(radius), cutter.height_at_radius(radius));
            let (inner, outer) = (cutter.meridian().inner_point_at(slope), cutter.point_at(slope));
            // a slope is rounded: on a flat arc of a large circle that shows
            let size = 1e-12 * (cutter.max_radius() + cutter.max_height()) + 1e-15 * cutter.curvature_radius_at(slope);
            prop_assert!(inner.0 <= radius + size && radius <= outer.0 + size, "{inner:?} {radius} {outer:?}");
            // a point of the curve lies on the supporting line of its slope
            let off = (radius - outer.0) * slope.sin() - (height - outer.1) * slope.cos();
            prop_assert!(off.abs() < 100.0 * size, "{off}");
        }

        #[test]
        fn rise_gives_back_the_point(profile in any_profile(), ball in any_ball(), slope in 0.0..1.57_f64) {
            let cutter = Cutter::new(&profile, ball);
            let (found, exact) = (cutter.at_rise(slope.tan()), cutter.point_at(slope));
            let size = cutter.max_radius() + cutter.max_height();
            let off = (found.0 - exact.0) * slope.sin() - (found.1 - exact.1) * slope.cos();
            prop_assert!(off.abs() <= 1e-14 * size, "{off} {found:?} {exact:?}");
            // a slope is rounded: on a flat arc of a large circle that shows
            let near = 1e-14 * size + 1e-15 * cutter.curvature_radius_at(slope);
            prop_assert!((found.0 - exact.0).abs() <= near, "{found:?} {exact:?}");
        }

        #[test]
        fn height_gives_back_the_point(profile in any_profile(), ball in any_ball(), share in 0.0..1.0_f64) {
            let cutter = Cutter::new(&profile, ball);
            let height = share * cutter.max_height();
            let (radius, rise) = cutter.at_height(height);
            let slope = rise.atan();
            let size = 1e-12 * (cutter.max_radius() + cutter.max_height());
            prop_assert!((cutter.gap(radius, height, slope)).abs() < 100.0 * size, "{}", cutter.gap(radius, height, slope));
            if radius > 0.0 && radius < cutter.max_radius() {
                // the profile itself agrees: moving by rounding along the steeper axis reaches it
                let (low, high) = (cutter.height_at_radius(radius - size.min(radius)), cutter.height_at_radius((radius + size).min(cutter.max_radius())));
                prop_assert!(low <= height + 10.0 * size && height <= high + 10.0 * size, "{low} {height} {high}");
            }
        }

        #[test]
        fn bounds_are_below_the_profile(profile in any_profile(), ball in any_ball(), share in 0.0..1.0_f64) {
            let cutter = Cutter::new(&profile, ball);
            let radius = share * cutter.max_radius();
            prop_assert!(cutter.height_bound(radius) <= cutter.height_at_radius(radius) + 1e-11);
        }

        #[test]
        fn distance_is_to_the_nearest_point(
            profile in any_profile(),
            ball in any_ball(),
            slope in 0.01..1.57_f64,
            away in 0.0..5.0_f64,
        ) {
            let cutter = Cutter::new(&profile, ball);
            let (r, z) = cutter.point_at(slope);
            let (distance, _) = cutter.distance(r + away * slope.sin(), z - away * slope.cos());
            prop_assert!((distance - away).abs() < 1e-9, "{distance} {away}");
        }
    }
}

//! The body that is checked: tool and sheet as one convex solid, open upwards.
//!
//! Distances by support functions alone: E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the
//! distance between complex objects in three-dimensional space", IEEE Journal of Robotics and Automation 4, 1988; simpler here,
//! for the body is one of revolution. See docs/concepts/verifier.md.
//!
//! The meridian is geometry's [`ToolBody`]; of the drop-cutter's tables over it, [`Cutter`](styluscam_geometry::Cutter), nothing
//! is used here, so that an error in them shows as a finding.

use std::f64::consts::FRAC_PI_2;

use styluscam_geometry::{Sheet, Tool, ToolBody, Vector};

use crate::convex::Tangent;
use crate::solid::Solid;

/// Cells of the support table. A chord over one of 4096 is less than 1e-7 of the tool's radius above the function.
const CELLS: usize = 4096;
/// Cells of the table of planes, besides those at straight parts.
const PLANES: usize = 256;
/// Squares along each side of the atlas.
const SQUARES: usize = 128;
/// Side of the atlas in sums of the body's radius and height.
const REACH: f64 = 3.0;
/// What rounding may add to a bound, mm.
const ROUNDING: f64 = 1e-11;
/// Slopes this near to 0 and to a right angle count as the flat and the cylinder, rad.
const EDGE: f64 = 1e-9;
/// The share of the depth for a tool that is blunt.
const OWN: f64 = 0.05;
/// A straight flank that begins nearer to the axis than this share of the radius makes a sharp tip.
const SLENDER: f64 = 0.1;
/// A step of the root of the slope so short that a parabola gives the distance to 1e-14 of the tool's size.
const SHORT: f64 = 1e-5;

/// The convex body that must not enter the triangles. Its tip is the origin of what it is asked.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    solid: Solid,
    supports: Vec<f64>,
    planes: Vec<Tangency>,
    /// For squares of the half plane about the meridian, the plane of the table that separates their middle best.
    atlas: Vec<u16>,
    squares_per_mm: f64,
    /// Depth from which the shortest path out may not be the one that a local search finds, mm.
    shallow: f64,
    /// See [`Body::own`].
    own: f64,
}

/// The body's meridian at one slope, with the plane that touches there.
#[derive(Clone, Copy, Debug)]
struct Tangency {
    /// Square root of the slope: in it, a profile that is flat at its tip is smooth too.
    root: f64,
    slope: f64,
    sin: f64,
    cos: f64,
    radius: f64,
    height: f64,
    /// Whether it is a straight part of the meridian that touches, not a point.
    straight: bool,
}

/// A plane that touches the body and has it on one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// Unit vector out of the body, level or downwards.
    pub away: Vector,
    /// Largest value of `away . p` over the body, mm.
    pub support: f64,
}

/// The body's distance to a point, with what a line search needs to know of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Distance {
    /// Signed distance, mm; negative inside.
    pub value: f64,
    /// Its gradient: unit vector out of the body.
    pub away: Vector,
    radius: f64,
    slope: f64,
    sin: f64,
    cos: f64,
    straight: bool,
}

impl Body {
    /// Tool and sheet, to be checked together.
    pub fn new(tool: &Tool, sheet: Option<&Sheet>) -> Self {
        Self::of(tool.body(sheet))
    }

    /// Tool and sheet, with the stock around them that is to be left, across walls in plan and in height, mm.
    pub fn leaving(tool: &Tool, sheet: Option<&Sheet>, left: [f64; 2]) -> Self {
        Self::of_solid(Solid::new(tool.body(sheet), left))
    }

    /// A solid of a tool with the tables by which it is checked.
    pub fn of(solid: ToolBody) -> Self {
        Self::of_solid(Solid::new(solid, [0.0; 2]))
    }

    fn of_solid(solid: Solid) -> Self {
        let supports = (0..=CELLS).map(|i| support_at(&solid, i)).collect();
        let mut planes: Vec<_> = (0..=PLANES).map(|i| Tangency::at(&solid, plane_root(i))).collect();
        // both ends of a straight part: between them the plane stays and the position jumps
        planes.extend(solid.straights().iter().flat_map(|s| [s.inner, s.outer].map(|end| Tangency::on(s.slope, end))));
        planes.sort_by(|a, b| {
            a.slope.total_cmp(&b.slope).then(a.radius.total_cmp(&b.radius)).then(a.height.total_cmp(&b.height))
        });
        let sharpest = planes.iter().map(|p| solid.curvature_radius_at(p.slope)).fold(f64::INFINITY, f64::min);
        let at_the_tip = solid.straights().iter().filter(|s| s.inner.0 < SLENDER * solid.max_radius());
        let own = at_the_tip.map(|s| 0.5 * libm::cos(s.slope)).fold(OWN, f64::min);
        let squares_per_mm = SQUARES as f64 / (REACH * (solid.max_radius() + solid.max_height()));
        let mut body =
            Self { solid, supports, planes, atlas: Vec::new(), squares_per_mm, shallow: 0.5 * sharpest, own };
        body.atlas = (0..SQUARES * SQUARES).map(|i| body.best_plane_of_square(i)).collect();
        body
    }

    fn best_plane_of_square(&self, i: usize) -> u16 {
        let middle = |i: usize| (i as f64 + 0.5) / self.squares_per_mm;
        let (radius, height) = (middle(i % SQUARES), middle(i / SQUARES) + self.atlas_floor());
        self.better_end(self.cell(radius, height), radius, height) as u16
    }

    /// Lower end of the atlas: as far below the tip as it is wide beyond.
    fn atlas_floor(&self) -> f64 {
        -0.5 * SQUARES as f64 / self.squares_per_mm
    }

    /// A plane of the table that nearly separates a point best: looked up nearby, searched for farther off.
    fn near_plane(&self, radius: f64, height: f64) -> usize {
        let column = (radius * self.squares_per_mm) as usize;
        let row = (height - self.atlas_floor()) * self.squares_per_mm;
        if column < SQUARES && row >= 0.0 && row < SQUARES as f64 {
            return usize::from(self.atlas[row as usize * SQUARES + column]);
        }
        self.better_end(self.cell(radius, height), radius, height)
    }

    /// Of the two planes that bound a cell, the one that leaves the larger gap.
    fn better_end(&self, cell: usize, radius: f64, height: f64) -> usize {
        let gap = |i: usize| self.planes[i].gap(radius, height);
        cell + usize::from(gap(cell + 1) > gap(cell))
    }

    /// Minimum penetration that counts as a gouge at a point, and not as grazing a ridge, as a share of the depth: on the axis of a slender cone, which is near to its side everywhere, by little.
    pub fn own(&self) -> f64 {
        self.own
    }

    /// Radius of the sphere that it ends in, when it does, mm: then its centre alone counts. Its cylinder is as wide.
    pub fn ball(&self) -> Option<f64> {
        self.solid.as_ball()
    }

    /// Radius of the body's cylinder, mm.
    pub fn radius(&self) -> f64 {
        self.solid.max_radius()
    }

    /// The body's tip when the tool's stands at `tip`.
    pub fn position(&self, tip: [f64; 3]) -> Vector {
        Vector::new(tip[0], tip[1], tip[2] - self.solid.tip_above())
    }

    /// The tool's tip when the body's stands at `position`.
    pub fn tip(&self, position: Vector) -> [f64; 3] {
        [position.x, position.y, position.z + self.solid.tip_above()]
    }

    /// Signed distance to a point: the largest gap that any touching plane leaves.
    pub fn distance(&self, p: Vector) -> Distance {
        let radius = length(p.x, p.y);
        if let Some(ball) = self.ball() {
            return of_ball(ball, p, radius);
        }
        let local = self.largest_gap(radius, p.z, self.near_cell(radius, p.z));
        let (value, at) = if local.0 < -self.shallow {
            let other = self.largest_gap(radius, p.z, self.cell_of_all(radius, p.z));
            if other.0 > local.0 {
                other
            } else {
                local
            }
        } else {
            local
        };
        let outward = if radius > 0.0 { at.sin / radius } else { 0.0 };
        let away = Vector::new(p.x * outward, p.y * outward, -at.cos);
        Distance { value, away, radius, slope: at.slope, sin: at.sin, cos: at.cos, straight: at.straight }
    }

    /// The largest gap in a cell of the table, and where it is: Newton in the root of the slope.
    fn largest_gap(&self, radius: f64, height: f64, cell: usize) -> (f64, Tangency) {
        let (mut low, mut high) = (self.planes[cell], self.planes[cell + 1]);
        let (first, last) = (low.ahead(radius, height), high.ahead(radius, height));
        if first <= 0.0 {
            return (low.gap(radius, height), low);
        }
        if last >= 0.0 {
            return (high.gap(radius, height), high);
        }
        if high.root <= low.root {
            return (low.gap(radius, height), Tangency { straight: true, ..low });
        }
        let mut root = low.root + (high.root - low.root) * first / (first - last);
        for _ in 0..60 {
            let here = Tangency::at(&self.solid, root);
            let ahead = here.ahead(radius, height);
            let bend = (height - here.height) * here.cos
                - (radius - here.radius) * here.sin
                - self.solid.curvature_radius_at(here.slope);
            let (rate, step) = (2.0 * root * bend, -ahead / (2.0 * root * bend));
            if rate < 0.0 && step.abs() < SHORT {
                let turn = 2.0 * root * step;
                let gap = here.gap(radius, height) - 0.5 * turn * turn * bend + turn * (ahead + turn * bend);
                return (gap, here.turned(turn));
            }
            let side = if ahead > 0.0 { &mut low } else { &mut high };
            *side = here;
            let next = root + step;
            root = if next > low.root && next < high.root { next } else { 0.5 * (low.root + high.root) };
            if high.root - low.root < 1e-13 {
                return (here.gap(radius, height), here);
            }
        }
        (low.gap(radius, height), low)
    }

    /// The cell of the table in which the gap is largest, for points that are not deep inside.
    fn cell(&self, radius: f64, height: f64) -> usize {
        self.planes.partition_point(|p| p.ahead(radius, height) > 0.0).clamp(1, self.planes.len() - 1) - 1
    }

    /// The same, by a walk from a plane near by.
    fn near_cell(&self, radius: f64, height: f64) -> usize {
        let last = self.planes.len() - 2;
        let mut cell = self.near_plane(radius, height).min(last);
        while cell > 0 && self.planes[cell].ahead(radius, height) <= 0.0 {
            cell -= 1;
        }
        while cell < last && self.planes[cell + 1].ahead(radius, height) > 0.0 {
            cell += 1;
        }
        cell
    }

    /// The same for any point.
    fn cell_of_all(&self, radius: f64, height: f64) -> usize {
        let gaps = self.planes.iter().map(|p| p.gap(radius, height)).enumerate();
        let best = gaps.fold((0, f64::NEG_INFINITY), |a, b| if b.1 > a.1 { b } else { a }).0;
        let before = self.planes[best].ahead(radius, height) <= 0.0;
        (best - usize::from(before && best > 0)).min(self.planes.len() - 2)
    }

    /// The distance along a line of direction `along` through the point that `d` was measured at.
    ///
    /// Second derivative: the offset surface bends with radius rho + d along the meridian and r / sin around the axis.
    pub fn tangent(&self, p: Vector, d: &Distance, along: Vector) -> Tangent {
        let mut bend = 0.0;
        if d.radius > 0.0 {
            let out = (along.x * p.x + along.y * p.y) / d.radius;
            let around = (along.y * p.x - along.x * p.y) / d.radius;
            let meridian = out * d.cos + along.z * d.sin;
            bend = around * around * d.sin / d.radius + meridian * meridian * self.meridian_bend(d);
        }
        Tangent { value: d.value, rate: d.away.dot(&along), bend }
    }

    fn meridian_bend(&self, d: &Distance) -> f64 {
        let curved = !d.straight && d.slope > EDGE && d.slope < FRAC_PI_2 - EDGE;
        let radius = self.solid.curvature_radius_at(d.slope) + d.value;
        if curved && radius > EDGE {
            1.0 / radius
        } else {
            0.0
        }
    }

    /// The point of the body that reaches farthest along a direction, and how far.
    ///
    /// The direction is `-up`, where `up` is a unit vector that does not point down.
    pub fn farthest(&self, up: Vector) -> (Vector, Plane) {
        if let Some(ball) = self.ball() {
            let witness = Vector::new(0.0, 0.0, ball) - ball * up;
            return (witness, Plane { away: -up, support: ball - ball * up.z });
        }
        let sin = length(up.x, up.y);
        let (radius, height) = self.solid.point_at(libm::atan2(sin, up.z));
        let scale = if sin > 0.0 { -radius / sin } else { 0.0 };
        let witness = Vector::new(up.x * scale, up.y * scale, height);
        (witness, Plane { away: -up, support: radius * sin - height * up.z })
    }

    /// A bound, from above, of the support along a direction `steep` outwards and `fall` downwards (neither negative,
    /// any length, not both 0).
    ///
    /// The support function is convex over the directions, so the chords of a table lie above it.
    pub fn support_bound(&self, steep: f64, fall: f64) -> f64 {
        if let Some(ball) = self.ball() {
            return ball * (length(steep, fall) - fall) + ROUNDING;
        }
        let sum = steep + fall;
        let at = steep / sum * CELLS as f64;
        let cell = (at as usize).min(CELLS - 1);
        let share = at - cell as f64;
        sum * (self.supports[cell] + share * (self.supports[cell + 1] - self.supports[cell]) + ROUNDING)
    }

    /// A plane that keeps a point off the body, nearly as far as any can.
    pub fn separating(&self, p: Vector) -> Plane {
        let radius = length(p.x, p.y);
        if let Some(ball) = self.ball() {
            let d = of_ball(ball, p, radius);
            return Plane { away: d.away, support: ball - ball * d.cos };
        }
        let at = &self.planes[self.near_plane(radius, p.z)];
        let outward = if radius > 0.0 { at.sin / radius } else { 0.0 };
        let away = Vector::new(p.x * outward, p.y * outward, -at.cos);
        Plane { away, support: at.radius * at.sin - at.height * at.cos }
    }
}

/// The distance from a sphere on its lowest point, with its cylinder upwards.
fn of_ball(ball: f64, p: Vector, radius: f64) -> Distance {
    let drop = (ball - p.z).max(0.0);
    let from_centre = length(radius, drop);
    let (sin, cos) = if from_centre > 0.0 { (radius / from_centre, drop / from_centre) } else { (0.0, 1.0) };
    let outward = if radius > 0.0 { sin / radius } else { 0.0 };
    let away = Vector::new(p.x * outward, p.y * outward, -cos);
    // the curvature is the same everywhere: of the slope only its ends matter
    let slope = if cos > EDGE { sin } else { FRAC_PI_2 };
    Distance { value: from_centre - ball, away, radius, slope, sin, cos, straight: false }
}

impl Tangency {
    fn at(solid: &Solid, root: f64) -> Self {
        let slope = root * root;
        let (sin, cos) = libm::sincos(slope);
        let (radius, height) = solid.point_at(slope);
        Self { root, slope, sin, cos, radius, height, straight: false }
    }

    /// At a position of the meridian where many have this slope.
    fn on(slope: f64, (radius, height): (f64, f64)) -> Self {
        let (sin, cos) = libm::sincos(slope);
        Self { root: slope.sqrt(), slope, sin, cos, radius, height, straight: false }
    }

    /// The same with its plane turned by an angle so small that its cube does not count, rad.
    fn turned(self, angle: f64) -> Self {
        let less = 1.0 - 0.5 * angle * angle;
        let (sin, cos) = (self.sin * less + self.cos * angle, self.cos * less - self.sin * angle);
        Self { slope: self.slope + angle, sin, cos, ..self }
    }

    /// How far a point lies outside the plane, mm.
    fn gap(&self, radius: f64, height: f64) -> f64 {
        (radius - self.radius) * self.sin - (height - self.height) * self.cos
    }

    /// How far a point lies ahead, up the meridian, mm: the rate at which the gap grows with the slope.
    fn ahead(&self, radius: f64, height: f64) -> f64 {
        (radius - self.radius) * self.cos + (height - self.height) * self.sin
    }
}

/// Roots of the slopes of the table: the last is that of a right angle.
fn plane_root(i: usize) -> f64 {
    if i == PLANES {
        return FRAC_PI_2.sqrt();
    }
    FRAC_PI_2.sqrt() * i as f64 / PLANES as f64
}

/// Length in plan; `hypot` is the platform's and may differ in the last bit.
pub(crate) fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// Support along the direction i / CELLS outwards and the rest downwards.
fn support_at(solid: &Solid, i: usize) -> f64 {
    let steep = i as f64 / CELLS as f64;
    let fall = 1.0 - steep;
    let (radius, height) = solid.point_at(libm::atan2(steep, fall));
    radius * steep - height * fall
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;
    use styluscam_geometry::{kinds, ModelFace, ProfileDocument, SheetLaw, ToolDocument};

    pub fn tool(profile: ProfileDocument) -> Tool {
        Tool::new(ToolDocument::of(profile)).unwrap()
    }

    pub fn ball(diameter: f64) -> Body {
        Body::new(&tool(ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 })), None)
    }

    /// Tools of every kind of profile, with a sheet: the registry's own examples among them.
    pub fn any_body() -> impl Strategy<Value = Body> {
        let thickness = prop_oneof![Just(None), (0.2..2.0_f64).prop_map(Some)];
        let starters = prop::sample::select(ProfileDocument::starters());
        let registered = (starters, thickness).prop_map(|(text, sheet)| {
            let sheet =
                sheet.map(|thickness| Sheet { thickness, law: SheetLaw::Constant, model_face: ModelFace::Back });
            Body::new(&tool(serde_json::from_str(text).unwrap()), sheet.as_ref())
        });
        prop_oneof![3 => varied_body(), 1 => registered]
    }

    /// Curves, kinks, cones and flats of random sizes, with a sheet.
    fn varied_body() -> impl Strategy<Value = Body> {
        let flat = prop_oneof![Just(0.0), 0.0..0.3_f64];
        let thickness = prop_oneof![Just(None), (0.2..2.0_f64).prop_map(Some)];
        (0..8_u8, 2.0..20.0_f64, 0.1..0.9_f64, 0.1..0.9_f64, flat, thickness).prop_map(
            |(kind, diameter, a, b, flat, sheet)| {
                let tip_flat = flat * diameter;
                let beyond = 0.5 * diameter - tip_flat;
                let clothoid = |end_slope_deg| {
                    ProfileDocument::from(kinds::Clothoid {
                        diameter: Some(diameter),
                        scale: None,
                        end_slope_deg,
                        tip_flat,
                    })
                };
                let profile = match kind {
                    0 => ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat }),
                    1 => clothoid(None),
                    2 => clothoid(Some(30.0 + 60.0 * a)),
                    3 => ProfileDocument::from(kinds::Power {
                        coefficient: 0.1 * a,
                        exponent: 1.2 + 2.0 * b,
                        diameter,
                        tip_flat,
                    }),
                    4 => ProfileDocument::from(kinds::BullNose { diameter, corner_radius: beyond * a, tip_flat }),
                    5 => ProfileDocument::from(kinds::Cone {
                        tip_radius: 0.0,
                        half_angle_deg: 80.0 * a,
                        diameter,
                        tip_flat,
                    }),
                    6 => {
                        let tip_radius = beyond * a;
                        ProfileDocument::from(kinds::TaperedBall {
                            tip_radius,
                            half_angle_deg: 80.0 * b,
                            diameter,
                            tip_flat,
                        })
                    }
                    _ => ProfileDocument::from(kinds::Flat { diameter, tip_flat: 0.0 }),
                };
                let sheet =
                    sheet.map(|thickness| Sheet { thickness, law: SheetLaw::Constant, model_face: ModelFace::Back });
                Body::new(&tool(profile), sheet.as_ref())
            },
        )
    }

    /// The largest gap over a fine fan of planes: the distance by its definition.
    fn by_definition(body: &Body, radius: f64, height: f64) -> f64 {
        let slopes = (0..=20_000).map(|i| FRAC_PI_2 * f64::from(i) / 20_000.0);
        let slopes = slopes.chain(body.solid.straights().iter().map(|s| s.slope));
        slopes.map(|s| body.solid.gap(radius, height, s)).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn deep_inside_the_nearest_way_out_counts() {
        let profile = ProfileDocument::from(kinds::Clothoid {
            diameter: Some(20.0),
            scale: None,
            end_slope_deg: None,
            tip_flat: 3.0,
        });
        let body = Body::new(&tool(profile), None);
        for radius in [0.0, 0.5, 2.0, 4.0, 6.0, 8.0, 9.5] {
            for height in [0.1, 1.0, 2.5, 4.0, 6.0, 8.0, 10.0, 14.0, 40.0] {
                let (value, gap) =
                    (body.distance(Vector::new(0.0, radius, height)).value, by_definition(&body, radius, height));
                assert!((value - gap).abs() < 1e-6, "{radius} {height}: {value} {gap}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn distance_is_the_largest_gap(body in any_body(), radius in 0.0..15.0_f64, height in -10.0..20.0_f64) {
            let p = Vector::new(0.6 * radius, 0.8 * radius, height);
            let d = body.distance(p);
            let gap = by_definition(&body, radius, height);
            prop_assert!(d.value > gap - 1e-12 && d.value < gap + 1e-6, "{} {gap}", d.value);
            prop_assert!((d.away.norm() - 1.0).abs() < 1e-12);
        }

        #[test]
        fn the_plane_square_to_the_gradient_leaves_the_distance(body in any_body(), radius in 0.0..15.0_f64,
                                                                height in -10.0..20.0_f64) {
            let p = Vector::new(0.6 * radius, 0.8 * radius, height);
            let d = body.distance(p);
            let support = body.farthest(-d.away).1.support;
            prop_assert!((d.away.dot(&p) - support - d.value).abs() < 1e-11, "{} {support}", d.value);
        }

        #[test]
        fn planes_are_bounds(body in any_body(), radius in 0.0..15.0_f64, height in -10.0..20.0_f64) {
            let p = Vector::new(radius, 0.0, height);
            let plane = body.separating(p);
            prop_assert!(plane.away.dot(&p) - plane.support <= body.distance(p).value + 1e-12);
        }

        #[test]
        fn support_is_bounded_from_above(body in any_body(), slope in 0.0..FRAC_PI_2) {
            let (sin, cos) = slope.sin_cos();
            let (witness, plane) = body.farthest(Vector::new(-sin, 0.0, cos));
            let bound = body.support_bound(sin, cos);
            prop_assert!(bound >= plane.support && bound < plane.support + 1e-3, "{bound} {}", plane.support);
            prop_assert!((plane.away.dot(&witness) - plane.support).abs() < 1e-12);
        }

        #[test]
        fn tangents_are_the_derivatives(body in any_body(), radius in 0.5..15.0_f64, height in -10.0..20.0_f64,
                                        along in (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64)) {
            let p = Vector::new(radius, 0.3, height);
            let d = body.distance(p);
            prop_assume!(d.value > 0.1);
            let along = Vector::new(along.0, along.1, along.2);
            let tangent = body.tangent(p, &d, along);
            let step = 1e-5;
            let (before, after) = (body.distance(p - step * along), body.distance(p + step * along));
            let rate = (after.value - before.value) / (2.0 * step);
            // the distance is convex: between its derivatives at the ends lie that in the middle and the mean of all
            let least = body.tangent(p - step * along, &before, along).rate;
            let most = body.tangent(p + step * along, &after, along).rate;
            for rate in [tangent.rate, rate] {
                prop_assert!(least < rate + 1e-8 && rate < most + 1e-8, "{least} {rate} {most}");
            }
        }
    }
}

//! The clearance of one triangle: the least distance from the body to any of its points.

use styluscam_geometry::{Bvh, Mesh, Vector};

use crate::body::{length, Body, Plane};
use crate::convex::lower;

/// Rounding that a distance may carry, mm.
const ROUNDING: f64 = 1e-9;

/// Where the body is nearest to the part, or deepest in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// Clearance, mm; negative when the body is in.
    pub value: f64,
    /// The point of the triangle, work coordinates.
    pub point: Vector,
    /// Unit vector from the body to the point.
    pub away: Vector,
    /// Largest value of `away . p` over the body with its tip at the origin, mm.
    pub support: f64,
    /// The triangle.
    pub triangle: u32,
}

impl Touch {
    /// The plane that touches the body where the part does.
    pub fn plane(&self) -> Plane {
        Plane { away: self.away, support: self.support }
    }
}

/// The part, as one body meets it.
#[derive(Clone, Copy)]
pub(crate) struct Prober<'a> {
    pub body: &'a Body,
    pub mesh: &'a Mesh,
    pub bvh: &'a Bvh,
}

impl Prober<'_> {
    /// The contact with one triangle, when its clearance is below `best`.
    pub fn touch(&self, triangle: u32, position: Vector, best: f64) -> Option<Touch> {
        let [a, b, c] = self.mesh.corners(triangle as usize);
        let corners = [a - position, b - position, c - position];
        let facet = Facet::new(corners);
        if facet.over - self.body.support_bound(facet.steep, facet.up.z.max(0.0)) >= best {
            return None;
        }
        let mut search = Search { body: self.body, best, found: None };
        search.facet(&facet);
        search.found.map(|f| Touch {
            value: f.value,
            point: f.point + position,
            away: f.plane.away,
            support: f.plane.support,
            triangle,
        })
    }
}

/// The least distance from a body, its tip at the origin, to a triangle with these corners, mm, where it is below `best`, and the point
/// there.
pub(crate) fn nearest(body: &Body, corners: [Vector; 3], best: f64) -> Option<(f64, Vector)> {
    let mut search = Search { body, best, found: None };
    search.facet(&Facet::new(corners));
    search.found.map(|found| (found.value, found.point))
}

/// A triangle seen from the body's tip.
pub(crate) struct Facet {
    corners: [Vector; 3],
    /// Unit normal, turned so that it does not point down; of a vertical triangle the one towards the axis.
    pub up: Vector,
    /// Length of `up` in plan.
    pub steep: f64,
    /// Height of the tip over the triangle's plane, mm.
    pub over: f64,
    /// Whether the corners run counter-clockwise about `up`.
    wound_up: bool,
}

impl Facet {
    pub fn new(corners: [Vector; 3]) -> Self {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a)).normalize();
        let wound_up = normal.z > 0.0 || normal.z >= 0.0 && normal.dot(&a) <= 0.0;
        let up = if wound_up { normal } else { -normal };
        Self { corners, up, steep: length(up.x, up.y), over: -up.dot(&a), wound_up }
    }

    /// Ends of an edge.
    fn edge(&self, i: usize) -> (Vector, Vector) {
        (self.corners[i], self.corners[(i + 1) % 3])
    }

    /// Whether a point of the plane lies on the inner side of an edge.
    fn inside(&self, i: usize, p: Vector) -> bool {
        let (a, b) = self.edge(i);
        let side = self.up.dot(&(b - a).cross(&(p - a)));
        if self.wound_up {
            side >= 0.0
        } else {
            side <= 0.0
        }
    }

    fn holds(&self, p: Vector) -> bool {
        (0..3).all(|i| self.inside(i, p))
    }
}

#[derive(Clone, Copy)]
struct Found {
    value: f64,
    point: Vector,
    plane: Plane,
}

/// Looks for the least distance to one triangle below `best`.
struct Search<'a> {
    body: &'a Body,
    best: f64,
    found: Option<Found>,
}

impl Search<'_> {
    fn take(&mut self, value: f64, point: Vector, plane: Plane) {
        if value < self.best {
            self.best = value;
            self.found = Some(Found { value, point, plane });
        }
    }

    /// Interior first: the body's farthest point under the triangle; then the edges that it may have passed.
    fn facet(&mut self, facet: &Facet) {
        let (witness, plane) = self.body.farthest(facet.up);
        let gap = facet.over - plane.support;
        if gap >= self.best {
            return;
        }
        let foot = witness - gap * facet.up;
        let held = facet.holds(foot);
        if gap < 0.0 && facet.over < 0.0 {
            self.deep(facet, foot, held, gap, plane);
        } else if held {
            self.take(gap, foot, plane);
        }
        if held && self.best <= gap {
            return;
        }
        // a convex function that is least at the foot is least on the triangle at an edge facing the foot
        let all = gap < 0.0;
        for i in 0..3 {
            if all || !facet.inside(i, foot) {
                self.edge(facet.edge(i), foot);
            }
        }
    }

    /// The axis passes below the plane: the farthest point counts if its foot is well inside the body.
    ///
    /// Else the depth of the foot and of the position where the axis pierces the triangle are taken: with the edges
    /// they find every triangle that the body meets.
    fn deep(&mut self, facet: &Facet, foot: Vector, held: bool, gap: f64, plane: Plane) {
        if held {
            let value = self.body.distance(foot).value;
            if value <= self.body.own() * gap + ROUNDING {
                self.take(gap, foot, plane);
                return;
            }
            self.point(foot);
        }
        if facet.up.z > 0.0 {
            let pierced = Vector::new(0.0, 0.0, -facet.over / facet.up.z);
            if facet.holds(pierced) {
                self.point(pierced);
            }
        }
    }

    fn point(&mut self, p: Vector) {
        let d = self.body.distance(p);
        self.take(d.value, p, Plane { away: d.away, support: d.away.dot(&p) - d.value });
    }

    fn edge(&mut self, (a, b): (Vector, Vector), foot: Vector) {
        let along = b - a;
        let square = along.norm_squared();
        let first = along.dot(&(foot - a)) / square;
        let body = self.body;
        lower(first, square.sqrt(), self.best, |t| {
            let p = a + t * along;
            let d = body.distance(p);
            self.take(d.value, p, Plane { away: d.away, support: d.away.dot(&p) - d.value });
            body.tangent(p, &d, along)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::{any_body, ball};
    use proptest::prelude::*;

    fn any_point(size: f64, low: f64, high: f64) -> impl Strategy<Value = Vector> {
        (-size..size, -size..size, low..high).prop_map(|(x, y, z)| Vector::new(x, y, z))
    }

    fn any_triangle(low: f64, high: f64) -> impl Strategy<Value = [Vector; 3]> {
        [any_point(12.0, low, high), any_point(12.0, low, high), any_point(12.0, low, high)]
            .prop_filter("no sliver", |[a, b, c]| (b - a).cross(&(c - a)).norm() > 0.1)
    }

    /// Clearance of a body with its tip at `position` from one triangle.
    fn clearance(body: &Body, corners: [Vector; 3], position: Vector) -> Touch {
        let mesh = Mesh::new(corners.to_vec(), &[[0, 1, 2]], &[]).unwrap();
        let bvh = Bvh::new(&mesh);
        Prober { body, mesh: &mesh, bvh: &bvh }.touch(0, position, f64::INFINITY).unwrap()
    }

    fn in_triangle([a, b, c]: &[Vector; 3], u: f64, v: f64) -> Vector {
        a + u * (b - a) + v * (1.0 - u) * (c - a)
    }

    /// The lowest value of a convex function on [0, 1], by thirds.
    fn by_thirds(f: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..70 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if f(a) < f(b) {
                high = b;
            } else {
                low = a;
            }
        }
        f(0.5 * (low + high)).min(f(0.0)).min(f(1.0))
    }

    /// Minimum over the triangle, by thirds of thirds: nothing shared with what is tested but the distance to a point.
    fn by_search(body: &Body, corners: &[Vector; 3], position: Vector) -> f64 {
        let at = |u: f64, v: f64| body.distance(in_triangle(corners, u, v) - position).value;
        by_thirds(|u| by_thirds(|v| at(u, v)))
    }

    /// Distance from a point to a triangle (Ericson, Real-Time Collision Detection, 5.1.5), by clamping to each edge.
    fn point_triangle(p: Vector, [a, b, c]: [Vector; 3]) -> f64 {
        let n = (b - a).cross(&(c - a)).normalize();
        let foot = p - n * n.dot(&(p - a));
        let edges = [(a, b), (b, c), (c, a)];
        if edges.iter().all(|(s, e)| n.dot(&(e - s).cross(&(foot - s))) >= 0.0) {
            return n.dot(&(p - a)).abs();
        }
        let to_edge = |(s, e): (Vector, Vector)| {
            let t = ((p - s).dot(&(e - s)) / (e - s).norm_squared()).clamp(0.0, 1.0);
            (p - s - t * (e - s)).norm()
        };
        edges.map(to_edge).into_iter().fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_ball_on_a_slope_is_as_far_off_as_it_was_put() {
        let body = ball(10.0);
        let n = Vector::new(-0.6, 0.0, 0.8);
        let corners = [Vector::new(-40.0, -40.0, -30.0), Vector::new(40.0, -40.0, 30.0), Vector::new(0.0, 60.0, 0.0)];
        for off in [-1.0, -0.001, 0.0, 0.001, 3.0] {
            let touch = clearance(&body, corners, (5.0 + off) * n - Vector::new(0.0, 0.0, 5.0));
            assert!((touch.value - off).abs() < 1e-12, "{} {off}", touch.value);
            assert!((touch.away + n).norm() < 1e-12);
            assert!(touch.point.norm() < 1e-9);
        }
    }

    #[test]
    fn a_wall_behind_the_tool_is_not_an_entry() {
        // leans away upwards, 7 mm behind the axis: the side that faces it away from the tool must not count as depth
        let body = ball(10.0);
        let corners = [Vector::new(12.0, -9.0, -9.0), Vector::new(12.0, 9.0, -9.0), Vector::new(11.9, 0.0, 9.0)];
        let touch = clearance(&body, corners, Vector::zeros());
        assert!((touch.value - by_search(&body, &corners, Vector::zeros())).abs() < 1e-6);
        assert!(touch.value > 6.0);
    }

    #[test]
    fn a_tool_far_below_a_surface_still_meets_it() {
        let body = ball(10.0);
        for z in [1.0, 4.0, 6.0, 50.0] {
            for tilt in [0.0, 5.0, 40.0] {
                let corners = [
                    Vector::new(-60.0, -60.0, z - tilt),
                    Vector::new(60.0, -60.0, z + tilt),
                    Vector::new(0.0, 90.0, z),
                ];
                let touch = clearance(&body, corners, Vector::zeros());
                assert!(touch.value < -0.5, "{z} {tilt}: {}", touch.value);
            }
        }
    }

    proptest! {
        #[test]
        fn a_ball_is_a_point_and_a_radius(radius in 0.5..10.0_f64, corners in any_triangle(-20.0, 0.0)) {
            let body = ball(2.0 * radius);
            // all of the triangle below the centre, where the tool is its sphere
            let centre = Vector::new(0.0, 0.0, radius);
            let expected = point_triangle(centre, corners) - radius;
            let touch = clearance(&body, corners, Vector::zeros());
            prop_assert!((touch.value - expected).abs() < 1e-9, "{} {expected}", touch.value);
            let at = (touch.point - centre).norm() - radius;
            prop_assert!((at - touch.value).abs() < 1e-6, "{at}");
        }

        #[test]
        fn it_is_the_minimum_over_the_triangle(body in any_body(), corners in any_triangle(-12.0, 12.0)) {
            let expected = by_search(&body, &corners, Vector::zeros());
            let touch = clearance(&body, corners, Vector::zeros());
            // inside, depth is measured along the triangle's normal: not less than that of any of its points, but for
            // what is deeper than the tool is curved
            if expected > 0.0 {
                prop_assert!((touch.value - expected).abs() < 1e-6, "{} {expected}", touch.value);
            } else {
                prop_assert!(touch.value < 1e-9, "{} {expected}", touch.value);
            }
        }

        #[test]
        fn no_point_of_the_triangle_is_nearer(body in any_body(), corners in any_triangle(-12.0, 12.0),
                                              u in 0.0..1.0_f64, v in 0.0..1.0_f64) {
            let distance = body.distance(in_triangle(&corners, u, v)).value;
            prop_assume!(distance > 0.0);
            prop_assert!(clearance(&body, corners, Vector::zeros()).value <= distance + 1e-9);
        }

        #[test]
        fn it_does_not_matter_where_in_space(body in any_body(), corners in any_triangle(-12.0, 12.0),
                                             shift in any_point(300.0, -300.0, 300.0)) {
            let here = clearance(&body, corners, Vector::zeros()).value;
            prop_assume!(here > -0.1);
            let there = clearance(&body, corners.map(|p| p + shift), shift).value;
            prop_assert!((here - there).abs() < 1e-9, "{here} {there}");
        }

        #[test]
        fn it_does_not_matter_how_the_triangle_is_wound(body in any_body(), [a, b, c] in any_triangle(-12.0, 12.0)) {
            let one = clearance(&body, [a, b, c], Vector::zeros()).value;
            for other in [[b, c, a], [c, b, a]] {
                prop_assert!((clearance(&body, other, Vector::zeros()).value - one).abs() < 1e-9);
            }
        }

        #[test]
        fn stepping_off_along_the_normal_adds_the_step(body in any_body(), corners in any_triangle(-30.0, -1.0),
                                                       step in 0.0..5.0_f64) {
            let touch = clearance(&body, corners, Vector::zeros());
            prop_assume!(touch.value > 0.0);
            let off = clearance(&body, corners, -step * touch.away).value;
            prop_assert!((off - touch.value - step).abs() < 1e-9, "{off} {} {step}", touch.value);
        }
    }
}

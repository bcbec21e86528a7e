//! Where the body on a straight way is nearest to the part, or deepest in it.
//!
//! Along a straight move the distance from the body to a triangle is convex in the place on the move:
//! a supporting plane that keeps the triangle off at both ends keeps it off all the way, and where
//! none is found the lowest place comes from one convex search.

use std::cell::Cell;

use styluscam_geometry::Node;

use crate::body::Plane;
use crate::bounds::node_bound;
use crate::clearance::{Facet, Prober, Touch};
use crate::convex::{lower, Tangent, EQUAL};
use crate::{Vector, SLACK};

/// A contact and the body's position there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passed {
    pub touch: Touch,
    pub position: Vector,
}

/// A straight move of the body's tip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    pub from: Vector,
    pub to: Vector,
}

impl Stroke {
    /// A body that stays where it is.
    pub fn still(at: Vector) -> Self {
        Self { from: at, to: at }
    }

    pub fn at(&self, share: f64) -> Vector {
        self.from + share * (self.to - self.from)
    }

    pub fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    /// The end that reaches farther along a plane's direction.
    pub fn farther(&self, plane: &Plane) -> Vector {
        if plane.away.dot(&(self.to - self.from)) > 0.0 {
            self.to
        } else {
            self.from
        }
    }

    /// A share of the stroke at which the body is about nearest to a point.
    pub fn share_near(&self, p: Vector) -> f64 {
        let along = self.to - self.from;
        let plan = along.x * along.x + along.y * along.y;
        if plan > 0.0 {
            ((along.x * (p.x - self.from.x) + along.y * (p.y - self.from.y)) / plan).clamp(0.0, 1.0)
        } else {
            f64::from(u8::from(along.z < 0.0))
        }
    }
}

/// What is asked about a stroke.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Question {
    pub stroke: Stroke,
    /// Positions on the stroke at which the clearance is asked for.
    pub places: [Option<Vector>; 2],
    /// The deepest contact is asked for if it is below this, and below every place by more than arithmetic; mm.
    pub below: f64,
}

/// The answer.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// The contacts at the places asked for.
    pub places: [Option<Touch>; 2],
    /// The deepest contact; none is a proof that there is none as deep as asked.
    pub deepest: Option<Passed>,
}

impl Prober<'_> {
    /// The contact of the body at one place; none where the part is empty. `warm` as in [`Self::survey`].
    pub fn at(&self, position: Vector, warm: Option<u32>) -> Option<Touch> {
        let places = [Some(position), None];
        let question = Question { stroke: Stroke::still(position), places, below: f64::NEG_INFINITY };
        self.survey(question, warm).places[0]
    }

    /// Answers a question; `warm` is a triangle that may be near and only saves time.
    pub fn survey(&self, question: Question, warm: Option<u32>) -> Seen {
        let survey = Survey {
            prober: self,
            question,
            seen: Cell::new(Seen::default()),
            limit: Cell::new(f64::INFINITY),
            below: Cell::new(question.below),
            hint: Cell::new(None),
        };
        survey.update(Seen::default());
        if let Some(triangle) = warm {
            survey.visit(triangle);
        }
        let visit = |triangle, _| {
            survey.visit(triangle);
            -survey.limit.get()
        };
        self.bvh.maximise(-survey.limit.get(), |node| -survey.bound(node), visit);
        let seen = survey.seen.get();
        // a place may have turned out deeper after the deepest contact between the places was found
        Seen { deepest: seen.deepest.filter(|p| p.touch.value <= survey.below.get()), ..seen }
    }
}

/// A question on its way through the index.
struct Survey<'a> {
    prober: &'a Prober<'a>,
    question: Question,
    seen: Cell<Seen>,
    /// Distance from which on a triangle can no longer matter.
    limit: Cell<f64>,
    /// Depth from which on a triangle matters between the places.
    below: Cell<f64>,
    /// A plane that keeps much of the part off.
    hint: Cell<Option<Plane>>,
}

impl Survey<'_> {
    fn bound(&self, node: &Node) -> f64 {
        let enough = self.limit.get() - EQUAL;
        let hint = self.hint.get();
        let bound = node_bound(self.prober.body, node, self.question.stroke, enough, hint.as_ref());
        if bound > enough {
            f64::INFINITY
        } else {
            bound
        }
    }

    fn visit(&self, triangle: u32) {
        let corners = self.prober.mesh.corners(triangle as usize);
        let kept = self.kept_off(&corners);
        if kept >= self.limit.get() - EQUAL {
            return;
        }
        let mut seen = self.seen.get();
        let mut better = false;
        for (place, found) in self.question.places.iter().zip(&mut seen.places) {
            let Some(position) = *place else { continue };
            let best = found.map_or(f64::INFINITY, |t| t.value);
            if found.is_some_and(|t| t.keeps_off(&corners, position)) {
                continue;
            }
            if let Some(touch) = self.prober.touch(triangle, position, best) {
                *found = Some(touch);
                better = true;
            }
        }
        if better {
            self.update(seen);
        }
        let below = self.below.get();
        if kept < below && self.facet_bound(&corners) < below {
            self.pass(triangle, &corners);
        }
    }

    /// Takes what was seen and draws the limits from it.
    fn update(&self, seen: Seen) {
        let deepest = seen.deepest.map_or(self.question.below, |p| p.touch.value);
        let (mut below, mut limit) = (deepest, deepest);
        for (place, found) in self.question.places.iter().zip(&seen.places) {
            let value = found.map_or(f64::INFINITY, |t| t.value);
            if place.is_some() {
                below = below.min(value - SLACK);
                limit = limit.max(value);
            }
        }
        self.below.set(below);
        self.limit.set(limit);
        let hint = seen.places[0].or(seen.places[1]).or(seen.deepest.map(|p| p.touch));
        self.hint.set(hint.map(|t| t.plane()));
        self.seen.set(seen);
    }

    /// How far planes keep a triangle off over the whole stroke, mm: the hint, and if that is too little, one found for the
    /// triangle's middle, and one half way to the corner that this leaves nearest.
    fn kept_off(&self, corners: &[Vector; 3]) -> f64 {
        let (stroke, enough) = (self.question.stroke, self.limit.get() - EQUAL);
        let gap = |plane: &Plane| {
            let position = stroke.farther(plane);
            let gaps = corners.map(|p| plane.away.dot(&(p - position)) - plane.support);
            gaps[0].min(gaps[1]).min(gaps[2])
        };
        let hinted = self.hint.get().as_ref().map_or(f64::NEG_INFINITY, gap);
        if hinted >= enough {
            return hinted;
        }
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let position = stroke.at(stroke.share_near(middle));
        let plane = self.prober.body.separating(middle - position);
        let kept = gap(&plane).max(hinted);
        if kept >= enough {
            return kept;
        }
        let reach = |p: &Vector| plane.away.dot(p);
        let nearest = corners.iter().fold(corners[0], |a, b| if reach(b) < reach(&a) { *b } else { a });
        kept.max(gap(&self.prober.body.separating(0.5 * (middle + nearest) - position)))
    }

    /// A bound, from below, of the distance between the swept body and a triangle's plane.
    fn facet_bound(&self, corners: &[Vector; 3]) -> f64 {
        let Stroke { from, to } = self.question.stroke;
        let facet = Facet::new(corners.map(|p| p - from));
        let rise = facet.up.dot(&(to - from));
        facet.over + rise.min(0.0) - self.prober.body.support_bound(facet.steep, facet.up.z.max(0.0))
    }

    /// Looks for the deepest contact with one triangle between the places.
    fn pass(&self, triangle: u32, corners: &[Vector; 3]) {
        let stroke = self.question.stroke;
        let along = stroke.to - stroke.from;
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let best = self.below.get();
        let mut deepest: Option<Passed> = None;
        lower(stroke.share_near(middle), along.norm(), best, |share| {
            let position = stroke.at(share);
            let Some(touch) = self.prober.touch(triangle, position, f64::INFINITY) else {
                return Tangent { value: f64::INFINITY, rate: 0.0, bend: 0.0 };
            };
            if touch.value < deepest.map_or(best, |p| p.touch.value) {
                deepest = Some(Passed { touch, position });
            }
            Tangent { value: touch.value, rate: -touch.away.dot(&along), bend: 0.0 }
        });
        if deepest.is_some() {
            self.update(Seen { deepest, ..self.seen.get() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tests::any_body;
    use crate::body::Body;
    use proptest::prelude::*;
    use styluscam_geometry::{Bvh, Mesh};

    fn any_point(size: f64, low: f64, high: f64) -> impl Strategy<Value = Vector> {
        (-size..size, -size..size, low..high).prop_map(|(x, y, z)| Vector::new(x, y, z))
    }

    /// A bumpy sheet of 2 x 12 x 12 triangles over 60 mm, or loose triangles in space.
    fn any_mesh() -> impl Strategy<Value = Mesh> {
        let bumpy = proptest::collection::vec(-4.0..4.0_f64, 13 * 13).prop_map(|heights| {
            let at = |i: usize| Vector::new((i % 13) as f64 * 5.0 - 30.0, (i / 13) as f64 * 5.0 - 30.0, heights[i]);
            let squares = (0..12 * 12).map(|i| ((i / 12) * 13 + i % 12) as i64);
            let triangles: Vec<_> = squares.flat_map(|i| [[i, i + 1, i + 14], [i, i + 14, i + 13]]).collect();
            Mesh::new((0..13 * 13).map(at).collect(), &triangles, &[]).unwrap()
        });
        let loose = proptest::collection::vec(any_point(30.0, -20.0, 4.0), 90).prop_map(|points| {
            let triangles: Vec<_> = (0..30).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            Mesh::new(points, &triangles, &[]).unwrap()
        });
        prop_oneof![bumpy, loose]
    }

    fn nearest(prober: &Prober, position: Vector) -> f64 {
        let question =
            Question { stroke: Stroke::still(position), places: [Some(position), None], below: f64::NEG_INFINITY };
        prober.survey(question, None).places[0].unwrap().value
    }

    /// The least clearance over all triangles, without the index.
    fn of_all(prober: &Prober, position: Vector) -> f64 {
        let all = 0..prober.mesh.triangles().len() as u32;
        all.filter_map(|t| prober.touch(t, position, f64::INFINITY)).fold(f64::INFINITY, |a, t| a.min(t.value))
    }

    fn with<R>(body: &Body, mesh: &Mesh, ask: impl FnOnce(&Prober) -> R) -> R {
        let bvh = Bvh::new(mesh);
        ask(&Prober { body, mesh, bvh: &bvh })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn the_index_loses_nothing(body in any_body(), mesh in any_mesh(), at in any_point(25.0, -2.0, 15.0)) {
            let (found, expected) = with(&body, &mesh, |p| (nearest(p, at), of_all(p, at)));
            // how deep a kink is in the part is told by a bound only
            let deep = found < -1e-3 && expected < -1e-3;
            prop_assert!(deep || (found - expected).abs() < 1e-9, "{found} {expected}");
        }

        #[test]
        fn one_search_answers_as_three_do(body in any_body(), mesh in any_mesh(), from in any_point(25.0, 3.0, 15.0),
                                          way in any_point(3.0, -1.0, 1.0)) {
            let stroke = Stroke { from, to: from + way };
            let places = [Some(stroke.at(0.5)), Some(stroke.to)];
            with(&body, &mesh, |p| {
                let seen = p.survey(Question { stroke, places, below: 5.0 }, Some(3));
                for (place, touch) in places.iter().zip(&seen.places) {
                    let (found, expected) = (touch.unwrap().value, of_all(p, place.unwrap()));
                    prop_assert!((found - expected).abs() < 1e-9, "{found} {expected}");
                    let deeper = seen.deepest.is_none_or(|p| p.touch.value < found - 0.5 * SLACK);
                    prop_assert!(deeper, "{:?} {found}", seen.deepest);
                }
                Ok(())
            })?;
        }

        #[test]
        fn nothing_hides_between_the_samples(body in any_body(), mesh in any_mesh(), from in any_point(25.0, 0.0, 12.0),
                                             way in any_point(30.0, -5.0, 5.0)) {
            let stroke = Stroke { from, to: from + way };
            with(&body, &mesh, |p| {
                let passed = p.survey(Question { stroke, places: [None; 2], below: 1.0 }, None).deepest;
                let sampled = (0..=200).map(|i| of_all(p, stroke.at(f64::from(i) / 200.0)));
                let sampled = sampled.fold(f64::INFINITY, f64::min);
                match passed {
                    // depths beyond the tool's curvature are bounds, and not convex
                    Some(found) if found.touch.value > 0.0 => {
                        prop_assert!(found.touch.value <= sampled + 1e-9, "{} {sampled}", found.touch.value);
                        prop_assert!((of_all(p, found.position) - found.touch.value).abs() < 1e-9);
                    }
                    Some(_) => (),
                    None => prop_assert!(sampled >= 1.0 - 1e-9, "{sampled}"),
                }
                Ok(())
            })?;
        }
    }
}

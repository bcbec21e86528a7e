//! Where the body on a straight path is nearest to the part, or deepest in it.
//!
//! Along a straight move the distance from the body to a triangle is convex in the position on the move:
//! a supporting plane that keeps the triangle off at both ends keeps it off all along it, and where
//! none is found the lowest position comes from one convex search.
//!
//! The derivation, and why one search is enough for a whole move: docs/concepts/verifier.md.

use std::cell::Cell;

use styluscam_geometry::{Node, Vector};

use crate::body::Plane;
use crate::bounds::{apart, planes_at, Gap};
use crate::clearance::{Facet, Prober, Touch};
use crate::convex::{lower, Tangent, EQUAL};
use crate::stroke::Stroke;
use crate::tolerances::SLACK;

/// A contact and the body's position there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passed {
    pub touch: Touch,
    pub position: Vector,
}

/// What is asked about a stroke.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Question {
    pub stroke: Stroke,
    /// Positions on the stroke at which the clearance is asked for.
    pub positions: [Option<Vector>; 2],
    /// The deepest contact is asked for if it is below this, and below every position by more than arithmetic; mm.
    pub below: f64,
}

/// The answer.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// The contacts at the positions asked for.
    pub positions: [Option<Touch>; 2],
    /// The deepest contact; none is a proof that there is none as deep as asked.
    pub deepest: Option<Passed>,
}

/// A contact that may be near the one asked for: it only saves time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Guess {
    triangle: Option<u32>,
    /// From the body's tip to the contact.
    offset: Vector,
}

impl Guess {
    /// The contact that the body had at another position.
    pub fn like(touch: &Touch, position: Vector) -> Self {
        Self { triangle: Some(touch.triangle), offset: touch.point - position }
    }

    /// Under the tip, where nothing better is known.
    const UNDER: Self = Self { triangle: None, offset: Vector::new(0.0, 0.0, 0.0) };
}

impl Prober<'_> {
    /// The contact of the body at one position; none where the part is empty.
    pub fn at(&self, position: Vector, guess: Option<Guess>) -> Option<Touch> {
        let positions = [Some(position), None];
        let question = Question { stroke: Stroke::still(position), positions, below: f64::NEG_INFINITY };
        self.survey(question, guess).positions[0]
    }

    /// Answers a question.
    pub fn survey(&self, question: Question, guess: Option<Guess>) -> Seen {
        let survey = Survey {
            prober: self,
            question,
            seen: Cell::new(Seen::default()),
            limits: Cell::new([f64::INFINITY, f64::INFINITY, question.below]),
            hints: Cell::new([None; 3]),
        };
        survey.begin(guess.unwrap_or(Guess::UNDER));
        let visit = |triangle, _| {
            survey.visit(triangle);
            f64::NEG_INFINITY
        };
        self.bvh.maximise(f64::NEG_INFINITY, |node| -survey.bound(node), visit);
        let seen = survey.seen.get();
        // a position may have turned out deeper after the deepest contact between the positions was found
        Seen { deepest: seen.deepest.filter(|p| p.touch.value <= survey.below()), ..seen }
    }
}

/// A question on its path through the index.
struct Survey<'a> {
    prober: &'a Prober<'a>,
    question: Question,
    seen: Cell<Seen>,
    /// Distance below which a triangle still matters, for each position and for what lies between them, mm.
    limits: Cell<[f64; 3]>,
    /// The contacts found so far: their planes keep most of the part off.
    hints: Cell<[Option<Hint>; 3]>,
}

/// A contact.
#[derive(Clone, Copy)]
struct Hint {
    plane: Plane,
    point: Vector,
    triangle: u32,
}

/// The index of what lies between the positions, after these.
const BETWEEN: usize = 2;

/// For what a triangle, or a node, may still matter: the positions, and what lies between them.
#[derive(Clone, Copy)]
struct Open {
    of: [bool; 3],
    /// The least bound that did not settle it, mm.
    nearest: f64,
}

impl Open {
    fn any(&self) -> bool {
        self.of[0] || self.of[1] || self.of[BETWEEN]
    }
}

impl Survey<'_> {
    /// Looks where the contacts may be: what is found there keeps most of the part off.
    fn begin(&self, guess: Guess) {
        let mut guess = guess;
        for (i, asked) in self.question.positions.iter().enumerate() {
            let Some(position) = *asked else { continue };
            for triangle in guess.triangle.iter().chain(self.prober.bvh.near(position + guess.offset)) {
                self.visit(*triangle);
            }
            if let Some(touch) = self.seen.get().positions[i] {
                guess = Guess::like(&touch, position);
            }
        }
    }

    /// The least bound, by which of two nodes is looked at first; infinite where a node does not matter.
    fn bound(&self, node: &Node) -> f64 {
        let body = self.prober.body;
        let mut open = self.all();
        let apart = apart(body, node, self.question.stroke);
        self.settle(&mut open, |_| apart, apart);
        if !open.any() {
            return f64::INFINITY;
        }
        let hints = self.hints.get();
        if hints.iter().flatten().any(|hint| node.holds(hint.point)) {
            // no plane keeps off a box that holds a contact
            return open.nearest;
        }
        let settled = |open: &mut Open, gap: Gap| {
            self.settle(open, |position| gap.at(position), gap.along(self.question.stroke));
            !open.any()
        };
        for hint in hints.iter().flatten() {
            if settled(&mut open, Gap::of_node(&hint.plane, node)) {
                return f64::INFINITY;
            }
        }
        if settled(&mut open, Gap::over_node(body, node)) {
            return f64::INFINITY;
        }
        let middle = 0.5 * (node.low + node.high);
        for target in 0..3 {
            let Some(position) = self.target(&open, target, middle) else { continue };
            for plane in planes_at(body, node, position) {
                if settled(&mut open, Gap::of_node(&plane, node)) {
                    return f64::INFINITY;
                }
            }
        }
        open.nearest
    }

    /// What is asked at all.
    fn all(&self) -> Open {
        let [first, second] = self.question.positions;
        Open { of: [first.is_some(), second.is_some(), self.below() > f64::NEG_INFINITY], nearest: f64::INFINITY }
    }

    /// Depth from which on a triangle matters between the positions, mm.
    fn below(&self) -> f64 {
        self.limits.get()[BETWEEN]
    }

    /// Where to look for a plane that settles one of the positions, or what lies between them, if that is open.
    fn target(&self, open: &Open, target: usize, middle: Vector) -> Option<Vector> {
        let stroke = &self.question.stroke;
        let between = || Some(stroke.at(stroke.share_near(middle)));
        self.question.positions.get(target).copied().unwrap_or_else(between).filter(|_| open.of[target])
    }

    /// Closes what bounds settle: one for each position, one for all between.
    #[inline]
    fn settle(&self, open: &mut Open, at: impl Fn(Vector) -> f64, along: f64) {
        let limits = self.limits.get();
        let mut nearest = f64::INFINITY;
        for ((asked, limit), is_open) in self.question.positions.iter().zip(limits).zip(&mut open.of[..BETWEEN]) {
            if let Some(position) = asked.filter(|_| *is_open) {
                let bound = at(position);
                *is_open = bound < limit;
                nearest = if *is_open { nearest.min(bound) } else { nearest };
            }
        }
        open.of[BETWEEN] &= along < limits[BETWEEN];
        open.nearest = if open.of[BETWEEN] { nearest.min(along) } else { nearest };
    }

    fn visit(&self, triangle: u32) {
        let corners = self.prober.mesh.corners(triangle as usize);
        let mut open = self.all();
        let hints = self.hints.get();
        for (of, hint) in open.of.iter_mut().zip(&hints) {
            // what was found there is all that it has
            *of &= hint.is_none_or(|hint| hint.triangle != triangle);
        }
        self.keep_off(&mut open, &corners, &hints);
        if !open.any() {
            return;
        }
        let mut seen = self.seen.get();
        let mut better = false;
        for i in 0..2 {
            let Some(position) = self.question.positions[i].filter(|_| open.of[i]) else { continue };
            let best = seen.positions[i].map_or(f64::INFINITY, |touch| touch.value);
            if let Some(touch) = self.prober.touch(triangle, position, best) {
                seen.positions[i] = Some(touch);
                better = true;
            }
        }
        if better {
            self.update(seen);
        }
        if open.of[BETWEEN] && self.facet_bound(&corners) < self.below() {
            self.pass(triangle, &corners);
        }
    }

    /// Takes what was seen and draws limits and planes from it.
    fn update(&self, seen: Seen) {
        let [first, second] = seen.positions;
        let value = |touch: Option<Touch>| touch.map_or(f64::INFINITY, |touch| touch.value);
        let deepest = seen.deepest.map_or(self.question.below, |p| p.touch.value);
        let below = deepest.min(value(first) - SLACK).min(value(second) - SLACK);
        self.limits.set([value(first) - EQUAL, value(second) - EQUAL, below]);
        let hint = |touch: Option<Touch>| {
            touch.map(|touch| Hint { plane: touch.plane(), point: touch.point, triangle: touch.triangle })
        };
        self.hints.set([hint(first), hint(second), hint(seen.deepest.map(|p| p.touch))]);
        self.seen.set(seen);
    }

    /// Closes what planes settle for a triangle: those of the contacts, then for each position one found for the triangle's
    /// middle, and one half way to the corner that this leaves nearest.
    fn keep_off(&self, open: &mut Open, corners: &[Vector; 3], hints: &[Option<Hint>; 3]) {
        let settle = |open: &mut Open, plane: &Plane| {
            let gap = Gap::of_points(plane, corners);
            self.settle(open, |position| gap.at(position), gap.along(self.question.stroke));
            !open.any()
        };
        for hint in hints.iter().flatten() {
            if settle(open, &hint.plane) {
                return;
            }
        }
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for target in 0..3 {
            let Some(position) = self.target(open, target, middle) else { continue };
            let plane = self.prober.body.separating(middle - position);
            if settle(open, &plane) {
                return;
            }
            let reach = |p: &Vector| plane.away.dot(p);
            let nearest = corners.iter().fold(corners[0], |a, b| if reach(b) < reach(&a) { *b } else { a });
            if settle(open, &self.prober.body.separating(0.5 * (middle + nearest) - position)) {
                return;
            }
        }
    }

    /// A bound, from below, of the distance between the swept body and a triangle's plane.
    fn facet_bound(&self, corners: &[Vector; 3]) -> f64 {
        let Stroke { from, to } = self.question.stroke;
        let facet = Facet::new([corners[0] - from, corners[1] - from, corners[2] - from]);
        let rise = facet.up.dot(&(to - from));
        facet.over + rise.min(0.0) - self.prober.body.support_bound(facet.steep, facet.up.z.max(0.0))
    }

    /// Looks for the deepest contact with one triangle between the positions.
    fn pass(&self, triangle: u32, corners: &[Vector; 3]) {
        let stroke = self.question.stroke;
        let along = stroke.to - stroke.from;
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let best = self.below();
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
            Question { stroke: Stroke::still(position), positions: [Some(position), None], below: f64::NEG_INFINITY };
        prober.survey(question, None).positions[0].unwrap().value
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
            // how deep a kink is in the part is known by a bound only
            let deep = found < -1e-3 && expected < -1e-3;
            prop_assert!(deep || (found - expected).abs() < 1e-9, "{found} {expected}");
        }

        #[test]
        fn one_search_answers_as_three_do(body in any_body(), mesh in any_mesh(), from in any_point(25.0, 3.0, 15.0),
                                          travel in any_point(3.0, -1.0, 1.0)) {
            let stroke = Stroke { from, to: from + travel };
            let positions = [Some(stroke.at(0.5)), Some(stroke.to)];
            with(&body, &mesh, |p| {
                let seen = p.survey(Question { stroke, positions, below: 5.0 }, Some(Guess { triangle: Some(3), offset: Vector::zeros() }));
                for (position, touch) in positions.iter().zip(&seen.positions) {
                    let (found, expected) = (touch.unwrap().value, of_all(p, position.unwrap()));
                    prop_assert!((found - expected).abs() < 1e-9, "{found} {expected}");
                    let deeper = seen.deepest.is_none_or(|p| p.touch.value < found - 0.5 * SLACK);
                    prop_assert!(deeper, "{:?} {found}", seen.deepest);
                }
                Ok(())
            })?;
        }

        #[test]
        fn nothing_hides_between_the_samples(body in any_body(), mesh in any_mesh(), from in any_point(25.0, 0.0, 12.0),
                                             travel in any_point(30.0, -5.0, 5.0)) {
            let stroke = Stroke { from, to: from + travel };
            with(&body, &mesh, |p| {
                let passed = p.survey(Question { stroke, positions: [None; 2], below: 1.0 }, None).deepest;
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

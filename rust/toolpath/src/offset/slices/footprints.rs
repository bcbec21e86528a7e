//! From where facets, edges and corners of a mesh can be touched by a cutter.
//!
//! A facet is touched from its copy moved by the cutter's contact with its plane. An edge is touched along the planes between its two
//! facets, a corner along those over all that meets there: the cutter's radii where it rises as they do bound the positions. What is
//! given is somewhat more for edges and corners: nothing is wrong when they are tried from farther away.

use styluscam_geometry::Vector;

use super::super::contact::{Contacts, Feature};
use super::super::features::{Owned, NO_NEIGHBOUR};
use super::footprint::{range, reach, Footprint};
use super::frame::{dot, length, Frame};
use super::gradients::{self, Polygon, STEEPEST};

/// A segment of gradients nearer to the origin has no direction.
const NO_DIRECTION: f64 = 1e-8;
/// Rise and, as a share of it, slack of gradients: beyond it lies what rounding makes of them.
const SLACK: f64 = 1e-8;
/// What directions of planes that count as upright are wrong by at most, as a share of the cutter's radius.
const UPRIGHT: f64 = 0.05;
/// A triangle is thin when twice its area is less than this share of the square of its length.
const THIN: f64 = 1e-3;

/// A triangle is wide beside an edge when it lies this share of the edge's length beside it.
const WIDE: f64 = 1e-6;

/// Positions beside an edge from which it is touched, mm.
struct Beside {
    /// How far down the edge from the contact, from and to.
    shift: [f64; 2],
    /// How far to the left of it, from and to.
    aside: [f64; 2],
}

/// All parts of a triangle that it has to try.
pub fn features(owned: Owned) -> impl Iterator<Item = Feature> {
    let edges = (0..3).filter(move |i| owned & (1 << i) != 0).map(Feature::Edge);
    let corners = (0..3).filter(move |i| owned & (8 << i) != 0).map(Feature::Corner);
    std::iter::once(Feature::Facet).chain(edges).chain(corners)
}

/// The footprints from which the parts of a mesh can be touched, in the frame of rows.
pub struct Footprints<'a> {
    pub contacts: &'a Contacts<'a>,
    pub frame: Frame,
    polygon: Polygon,
}

impl<'a> Footprints<'a> {
    pub fn new(contacts: &'a Contacts<'a>, frame: Frame) -> Self {
        Self { contacts, frame, polygon: Polygon::default() }
    }

    /// From where a part of a triangle can be touched; none where it cannot.
    pub fn of(&mut self, triangle: u32, feature: Feature) -> Option<Footprint> {
        match feature {
            Feature::Facet => self.of_facet(triangle),
            Feature::Edge(i) => self.of_edge(triangle, usize::from(i)),
            Feature::Corner(i) => self.of_corner(triangle, usize::from(i)),
        }
    }

    fn of_facet(&self, triangle: u32) -> Option<Footprint> {
        let (_, contact, height) = self.contacts.plane(triangle);
        if height.is_nan() {
            return None;
        }
        let overhang = self.contacts.overhang();
        let corners = self.contacts.index().triangles().at(triangle);
        let plan = corners.map(|p| self.frame.of([p.x - contact[0], p.y - contact[1]]));
        let [low, high] = range(plan.map(|p| p[1]));
        let mut footprint = Footprint::strip([low - overhang, high + overhang]);
        let edges = [0, 1, 2].map(|i| [0, 1].map(|axis| plan[(i + 1) % 3][axis] - plan[i][axis]));
        let twice = edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0];
        let turn = if twice < 0.0 { -1.0 } else { 1.0 };
        for (edge, from) in edges.iter().zip(&plan) {
            let rounding = overhang * (edge[0].abs() + edge[1].abs());
            let inward = [-turn * edge[1], turn * edge[0]];
            footprint = footprint.cut(rounding - dot(inward, *from), inward);
        }
        let longest = edges.iter().map(|edge| dot(*edge, *edge)).fold(0.0, f64::max);
        if twice.abs() < THIN * longest {
            // a triangle that is a line has no sides, and those of a needle meet far beyond its point
            let [low, high] = range(plan.map(|p| p[0]));
            footprint = footprint.between([low - overhang, high + overhang], [1.0, 0.0]);
        }
        Some(footprint)
    }

    fn of_edge(&self, triangle: u32, number: usize) -> Option<Footprint> {
        let index = self.contacts.index();
        let corners = index.triangles().at(triangle);
        let (a, b) = (corners[number], corners[(number + 1) % 3]);
        let run = ((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y)).sqrt();
        if run <= 1e-12 * (b.z - a.z).abs() || run == 0.0 {
            return None; // vertical: its upper corner stands for it
        }
        let along = [(b.x - a.x) / run, (b.y - a.y) / run];
        let across = [-along[1], along[0]];
        let steep = (b.z - a.z) / run;
        let third = corners[(number + 2) % 3] - a;
        let other = self.beyond(triangle, number).map(|corner| corner - a);
        let sides = other.map(|other| [third, other].map(|corner| dot(across, [corner.x, corner.y])));
        let is_ridge = sides.is_some_and(|[one, other]| one * other < 0.0 && one.abs().min(other.abs()) > WIDE * run);
        let ridge = is_ridge.then(|| self.of_ridge((triangle, number), across, steep)).flatten();
        let Beside { shift, aside } = match ridge {
            Some(beside) => beside,
            None => self.by_planes(third, other, [along, across], steep)?,
        };
        let pad = self.pad();
        let shift = if steep < 0.0 { shift } else { [-shift[1], -shift[0]] };
        let (first, aside) = ([shift[0] - pad, run + shift[1] + pad], [aside[0] - pad, aside[1] + pad]);
        let [along, across, origin] = [along, across, [a.x, a.y]].map(|vector| self.frame.of(vector));
        let offset = |direction: [f64; 2]| dot(direction, origin);
        let corner = |i: usize, j: usize| origin[1] + first[i] * along[1] + aside[j] * across[1];
        let strip = range([corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)]);
        let shifted = |[low, high]: [f64; 2], by: f64| [low + by, high + by];
        Some(
            Footprint::strip(strip)
                .between(shifted(first, offset(along)), along)
                .between(shifted(aside, offset(across)), across),
        )
    }

    /// Positions beside an edge from which it is touched, by the planes on it.
    fn by_planes(
        &self,
        third: Vector,
        other: Option<Vector>,
        [along, across]: [[f64; 2]; 2],
        steep: f64,
    ) -> Option<Beside> {
        let rises = gradients::on_edge(std::iter::once(third).chain(other), [along, across], steep)?;
        // the position beside the contact: against the plane's gradient, as far as the cutter's radius where it rises so much
        let steepest = length([steep, rises[0].abs().max(rises[1].abs())]);
        let nearest = if rises[0] <= 0.0 && rises[1] >= 0.0 { 0.0 } else { rises[0].abs().min(rises[1].abs()) };
        let flattest = length([steep, nearest]);
        let aside = rises.map(|rise| {
            let gradient = length([steep, rise]);
            let share = if rise.is_infinite() { rise.signum() } else { rise / gradient.max(f64::MIN_POSITIVE) };
            range([self.inner(gradient), self.outer(gradient)].map(|radius| -share * radius))
        });
        let aside = range(aside.into_iter().flatten());
        let farthest = self.outer(steepest);
        let shift = range([
            (steep.abs() * farthest / flattest.max(f64::MIN_POSITIVE)).min(farthest),
            if steepest.is_finite() {
                steep.abs() * self.inner(flattest) / steepest.max(f64::MIN_POSITIVE)
            } else {
                0.0
            },
        ]);
        Some(Beside { shift, aside })
    }

    /// The same of an edge between two facets that lie on both sides of it in plan, by the contacts with both; none where that is not
    /// so, and where the cutter has straight parts: those touch a facet at many radii.
    fn of_ridge(&self, (triangle, number): (u32, usize), across: [f64; 2], steep: f64) -> Option<Beside> {
        let index = self.contacts.index();
        let other = index.neighbours(triangle)[number];
        if other == NO_NEIGHBOUR || !self.contacts.cutter().straights().is_empty() {
            return None;
        }
        let planes = [triangle, other].map(|t| self.contacts.plane(t));
        if planes.iter().any(|(_, _, height)| height.is_nan()) {
            return None;
        }
        let rises = planes.map(|(gradient, ..)| dot(gradient, across));
        let squares = rises.map(|rise| rise * rise + steep * steep);
        let radii = planes.map(|(_, contact, _)| dot(contact, contact).sqrt());
        let (radii, squares) = (range(radii), range(squares));
        let (inner, flattest) = if rises[0] * rises[1] < 0.0 {
            (self.inner(steep.abs()), steep.abs())
        } else {
            (radii[0], squares[0].sqrt())
        };
        let shift = [
            steep.abs() * inner / squares[1].sqrt().max(f64::MIN_POSITIVE),
            (steep.abs() * radii[1] / flattest.max(f64::MIN_POSITIVE)).min(radii[1]),
        ];
        Some(Beside { shift, aside: range(planes.map(|(_, contact, _)| -dot(contact, across))) })
    }

    /// The third corner of the triangle beyond an edge, if there is a single one.
    fn beyond(&self, triangle: u32, number: usize) -> Option<Vector> {
        let index = self.contacts.index();
        let other = index.neighbours(triangle)[number];
        if other == NO_NEIGHBOUR {
            return None;
        }
        let names = index.triangles().corners[triangle as usize];
        let edge = [names[number], names[(number + 1) % 3]];
        let apart = index.triangles().corners[other as usize].iter().position(|name| !edge.contains(name));
        apart.map(|i| index.triangles().at(other)[i])
    }

    fn of_corner(&mut self, triangle: u32, number: usize) -> Option<Footprint> {
        let mut polygon = std::mem::take(&mut self.polygon);
        polygon.on_corner(self.contacts.index(), triangle, number);
        let footprint = self.of_planes(&polygon.corners, triangle, number);
        self.polygon = polygon;
        footprint
    }

    /// The footprint around a corner from the gradients of the planes on it.
    fn of_planes(&self, gradients: &[[f64; 2]], triangle: u32, number: usize) -> Option<Footprint> {
        if gradients.is_empty() {
            return None;
        }
        let limit = self.contacts.cutter().max_radius();
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut is_upright = false;
        for i in 0..gradients.len() {
            let ends = [gradients[i], gradients[(i + 1) % gradients.len()]].map(|gradient| self.frame.of(gradient));
            let [least, most] = gradients::distances(ends);
            is_upright |= most >= 0.5 * STEEPEST;
            let radii = [self.inner(least), self.outer(most)];
            let directions = ends.map(|end| {
                let length = length([end[0], end[1]]);
                end.map(|part| part / length)
            });
            for (axis, [low, high]) in [[1.0, 0.0], [0.0, 1.0]].into_iter().zip(&mut ranges) {
                // positions lie against the gradient
                let [from, to] =
                    if least < NO_DIRECTION { [-radii[1], radii[1]] } else { reach(axis, directions, radii) };
                (*low, *high) = (low.min(-to), high.max(-from));
            }
        }
        let pad = self.pad() + if is_upright { UPRIGHT * limit } else { 0.0 };
        let corner = self.contacts.index().triangles().at(triangle)[number];
        let at = self.frame.of([corner.x, corner.y]);
        let rim = limit + self.contacts.overhang();
        let [along, across] = [0, 1].map(|axis| {
            let [low, high] = ranges[axis];
            [at[axis] + (low - pad).max(-rim), at[axis] + (high + pad).min(rim)]
        });
        Some(Footprint::strip(across).between(along, [1.0, 0.0]).within(at, rim))
    }

    /// What rounding makes of a position, and more.
    fn pad(&self) -> f64 {
        1e3 * self.contacts.overhang()
    }

    /// The cutter's radius where it rises by `rise`, or less.
    fn inner(&self, rise: f64) -> f64 {
        let rise = (1.0 - SLACK) * rise - SLACK;
        if rise <= 0.0 {
            0.0
        } else {
            self.contacts.cutter().at_rise(rise.min(STEEPEST)).0
        }
    }

    /// The cutter's radius where it rises by `rise`, or more.
    fn outer(&self, rise: f64) -> f64 {
        if rise >= 0.5 * STEEPEST {
            return self.contacts.cutter().max_radius();
        }
        self.contacts.cutter().at_rise((1.0 + SLACK) * rise + SLACK).0
    }
}

//! Where an operation's contacts must lie beyond its faces: inside a boundary, on some slopes, clear of check faces; and on its
//! faces at all.
//!
//! Where the tool touches is known no better than how far off the part it may be: a ball of radius R that is d off a plane, or in
//! it, is less than d farther from all within sqrt(2 R d) of its nearest point. By so much a contact may lie outside.

use std::sync::{Arc, OnceLock};

use styluscam_geometry::{Bvh, Mesh, Vector};

use crate::body::Body;
use crate::clearance::Prober;
use crate::expectation::{Contact, ExpectedOperation};
use crate::faults::{self, Fault};
use crate::findings::FindingKind;
use crate::probes::Probe;
use crate::samples::{normal_of, Sample};
use crate::segments::Segment;
use crate::subject::Subject;
use crate::tolerances::SLACK;

/// A chord may lie beside the exact path by so many times the excess: a fitted path counts a quarter of any distance.
const ASIDE: f64 = 2.0;
/// What rounding takes of a position, mm.
const ROUNDED: f64 = 2e-3;
/// Facets lean by what they deviate, rad.
const LEAN: f64 = 0.01;
/// Where a wall and the face before it are one to a tool's upright side, mm.
const TOGETHER: f64 = 0.01;
/// Nothing is expected this near to check faces beyond their clearance, or to the end of a boundary, mm.
const BESIDE: f64 = 0.05;

/// What of a tool lies inside a boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Inside {
    /// Its axis.
    #[default]
    Centre,
    /// Its contact.
    Contact,
    /// All of its profile.
    Tool,
}

/// Faces that an operation keeps away from.
#[derive(Clone, Debug)]
pub struct CheckFaces {
    /// Their triangles alone, work coordinates, mm.
    pub mesh: Mesh,
    /// The mesh's index.
    pub bvh: Bvh,
    /// How near tool and sheet may come, mm.
    pub clearance: f64,
}

/// Where an operation's contacts must lie.
#[derive(Clone, Debug, Default)]
pub struct Region {
    /// Edges in plan, mm, in any order: inside is where an odd number of them is crossed on the way out; none: everywhere.
    pub edges: Option<Vec<[[f64; 2]; 2]>>,
    /// What of the tool lies inside.
    pub inside: Inside,
    /// Least and greatest slope of contacts, rad.
    pub slopes: Option<[f64; 2]>,
    /// What tool, shank and holder keep away from.
    pub check: Option<Arc<CheckFaces>>,
}

impl Region {
    /// Whether contacts with this slope, rad, are asked for.
    pub(crate) fn takes_slope(&self, slope: f64) -> bool {
        self.slopes.is_none_or(|[least, most]| (least..=most).contains(&slope))
    }

    /// How far a slope lies off those that are asked for, rad; negative where it is one of them.
    fn off_slope(&self, slope: f64) -> f64 {
        self.slopes.map_or(f64::NEG_INFINITY, |[least, most]| (least - slope).max(slope - most))
    }

    /// Whether passes are expected where a body at a position touches a point with a normal: well inside.
    pub(crate) fn takes(&self, body: &Body, position: Vector, (point, up): (Vector, Vector)) -> bool {
        let is_clear = |check: &Arc<CheckFaces>| {
            let prober = Prober { body, mesh: &check.mesh, bvh: &check.bvh };
            prober.at(position, None).is_none_or(|touch| touch.value > check.clearance + BESIDE)
        };
        let slope = libm::acos(up.z.clamp(-1.0, 1.0));
        self.takes_slope(slope)
            && self.outside(position, point, body.radius()) <= -BESIDE
            && self.check.as_ref().is_none_or(is_clear)
    }

    /// How far outside the edges what must lie inside is, mm; negative inside, by how far.
    fn outside(&self, tip: Vector, contact: Vector, radius: f64) -> f64 {
        let Some(edges) = &self.edges else { return f64::NEG_INFINITY };
        match self.inside {
            Inside::Centre => beyond(edges, tip),
            Inside::Contact => beyond(edges, contact),
            Inside::Tool => beyond(edges, tip) + radius,
        }
    }
}

/// How far a position lies outside of some edges in plan, mm; negative inside.
fn beyond(edges: &[[[f64; 2]; 2]], position: Vector) -> f64 {
    let (mut nearest, mut above) = (f64::INFINITY, 0_usize);
    for [a, b] in edges {
        let (a, b) = (Vector::new(a[0], a[1], 0.0), Vector::new(b[0], b[1], 0.0));
        let (along, to) = (b - a, Vector::new(position.x, position.y, 0.0) - a);
        let share = (to.dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        nearest = nearest.min((to - share * along).norm());
        // of a ray along +Y
        let is_over = (a.x <= position.x) != (b.x <= position.x);
        above += usize::from(is_over && a.y + along.y * (position.x - a.x) / along.x > position.y);
    }
    if above % 2 == 1 {
        -nearest
    } else {
        nearest
    }
}

/// What all operations together ask for.
pub(crate) struct Asked<'a> {
    subject: &'a Subject<'a>,
    bodies: Vec<Option<Body>>,
}

impl<'a> Asked<'a> {
    pub fn of(subject: &'a Subject<'a>) -> Self {
        let bounded = |operation: &ExpectedOperation| {
            let Region { edges, slopes, check, .. } = &operation.expectation.region;
            edges.is_some() || slopes.is_some() || check.is_some()
        };
        let body = |operation: &ExpectedOperation| {
            let tool = subject.tools.get(operation.tool).filter(|_| bounded(operation))?;
            Some(Body::new(tool, subject.sheet.as_ref()))
        };
        Self { subject, bodies: subject.expected.iter().map(body).collect() }
    }

    /// Those of some points that an operation asks for, or that no operation is for; and their share.
    pub fn of_points(&self, probes: Vec<Probe>) -> (Vec<Probe>, f64) {
        if self.bodies.iter().all(Option::is_none) {
            return (probes, 1.0);
        }
        let is_asked = |probe: &Probe| {
            let mut none = true;
            let mut operations = self.subject.expected.iter().zip(&self.bodies);
            let is_asked = operations.any(|(operation, body)| {
                let expectation = &operation.expectation;
                if !expectation.selects(probe.triangle) {
                    return false;
                }
                none = false;
                let up = self.subject.mesh.normal(probe.triangle);
                let takes =
                    |body: &Body| expectation.region.takes(body, probe.point - body.farthest(up).0, (probe.point, up));
                body.as_ref().is_none_or(takes)
            });
            is_asked || none
        };
        let all = probes.len().max(1);
        let asked: Vec<Probe> = probes.into_iter().filter(is_asked).collect();
        let share = asked.len() as f64 / all as f64;
        (asked, share)
    }
}

/// The faces of an operation alone, and its tool.
struct Faces {
    body: Body,
    mesh: Mesh,
    bvh: Bvh,
}

/// Where the contacts of all operations must lie.
pub(crate) struct Regions<'a> {
    subject: &'a Subject<'a>,
    /// By operation, once they are asked for.
    faces: Vec<OnceLock<Option<Faces>>>,
}

impl<'a> Regions<'a> {
    pub fn of(subject: &'a Subject<'a>) -> Self {
        Self { subject, faces: subject.expected.iter().map(|_| OnceLock::new()).collect() }
    }

    /// Faults of a piece of a move that should touch within `excess` mm.
    pub fn faults(&self, segment: &Segment, contacts: &[Option<Sample>; 3], excess: f64) -> Option<Fault> {
        let number = segment.expected?;
        let operation = self.subject.expected.get(number)?;
        let radius = 0.5 * self.subject.tools.get(operation.tool)?.diameter();
        let found = contacts.iter().flatten().filter_map(|sample| {
            let at = |fault: Fault| Fault { position: sample.tip, ..fault };
            let fault = outside(segment, sample, &operation.expectation.region, (radius, excess));
            let fault = fault.filter(|_| !self.touches_inside(sample, number, (radius, excess)));
            fault.or_else(|| self.unselected(segment, sample, number, excess)).map(at)
        });
        found.max_by(|a, b| a.weight.total_cmp(&b.weight))
    }

    /// Whether the tool also touches where the region allows it, within the excess: in a concave corner, or between facets, it touches
    /// several triangles at once, of which only the nearest was looked at.
    fn touches_inside(&self, sample: &Sample, number: usize, (radius, excess): (f64, f64)) -> bool {
        let find = || {
            let region = &self.subject.expected.get(number)?.expectation.region;
            let Faces { body, mesh, bvh } = self.faces_of(number)?;
            let position = body.position(sample.tip);
            let is_near = |triangle: &usize| {
                let corners = mesh.corners(*triangle);
                (0..2).all(|axis| {
                    let [low, high] = [f64::min, f64::max].map(|of| corners.map(|p| p[axis]).into_iter().reduce(of));
                    let reach = radius + excess + self.subject.sheet.map_or(0.0, |sheet| sheet.thickness);
                    low.is_some_and(|low| low <= position[axis] + reach)
                        && high.is_some_and(|high| high >= position[axis] - reach)
                })
            };
            let prober = Prober { body, mesh, bvh };
            let touches = |triangle: usize| {
                let touch = prober.touch(triangle as u32, position, excess + SLACK)?;
                let is_inside =
                    region.outside(sample.tip.into(), touch.point, radius) <= beside(region, radius, excess);
                let slope = libm::acos(normal_of(&touch).z.clamp(-1.0, 1.0));
                Some(is_inside && region.off_slope(slope) <= lean(radius, excess))
            };
            Some((0..mesh.triangles().len()).filter(is_near).any(|triangle| touches(triangle) == Some(true)))
        };
        find().unwrap_or(false)
    }

    /// The faces of an operation, and its tool.
    fn faces_of(&self, number: usize) -> Option<&Faces> {
        let operation = self.subject.expected.get(number)?;
        let faces = self.faces.get(number)?.get_or_init(|| {
            let mesh = self.subject.mesh.part_of(|triangle| operation.expectation.selects(triangle)).ok()?;
            let body = Body::new(self.subject.tools.get(operation.tool)?, self.subject.sheet.as_ref());
            Some(Faces { body, bvh: Bvh::new(&mesh), mesh })
        });
        faces.as_ref()
    }

    /// The fault of a contact with none of the faces that its operation is for.
    fn unselected(&self, segment: &Segment, sample: &Sample, number: usize, excess: f64) -> Option<Fault> {
        let operation = self.subject.expected.get(number)?;
        let expectation = &operation.expectation;
        let triangle = sample.touch.triangle as usize;
        if expectation.contact != Contact::Touch || expectation.ordered().is_none() || expectation.selects(triangle) {
            return None;
        }
        let Faces { body, mesh, bvh } = self.faces_of(number)?;
        let touch = Prober { body, mesh, bvh }.at(body.position(sample.tip), None)?;
        let off = touch.value + self.subject.deviation_outward;
        let limit = excess + TOGETHER;
        (off > limit + SLACK).then(|| segment.fault(&faults::UNSELECTED_CONTACT).measured(off, limit))
    }

    /// Of faults of contacts on other faces keeps those that go on for longer than the tool may stay down over what is not
    /// selected: the smallest feature.
    pub fn keep_long(&self, faults: &mut Vec<Fault>, segments: &[Segment]) {
        let is_own = |fault: &Fault| fault.kind.finding == FindingKind::UnselectedContact;
        let (own, mut others): (Vec<Fault>, Vec<Fault>) = faults.drain(..).partition(is_own);
        let segment_of = |fault: &Fault| segments.get(segments.partition_point(|segment| segment.index < fault.index));
        let long = own.chunk_by(|a, b| b.index <= a.index + 1).filter(|run| {
            let mut indices: Vec<usize> = run.iter().map(|fault| fault.index).collect();
            indices.dedup();
            let length: f64 = indices
                .iter()
                .filter_map(|index| segments.get(segments.partition_point(|segment| segment.index < *index)))
                .map(Segment::length)
                .sum();
            let expected = run.first().and_then(segment_of).and_then(|segment| segment.expected);
            let operation = expected.and_then(|number| self.subject.expected.get(number));
            let passes = operation.and_then(|operation| operation.expectation.ordered());
            passes.is_some_and(|passes| length > passes.smallest_feature)
        });
        others.extend(long.flatten().copied());
        *faults = others;
    }
}

/// How far outside what lies inside may be, mm, for a tool of this radius that may be `excess` off the part, mm.
fn beside(region: &Region, radius: f64, excess: f64) -> f64 {
    let exact = ASIDE * excess + ROUNDED;
    match region.inside {
        Inside::Centre | Inside::Tool => exact,
        Inside::Contact => exact + (2.0 * radius * excess).sqrt(),
    }
}

/// How far off its slopes a contact may be, rad.
fn lean(radius: f64, excess: f64) -> f64 {
    LEAN + (2.0 * excess / radius).sqrt()
}

/// The fault of a contact outside a region; `radius` is the tool's, and it may be `excess` off the part, mm.
fn outside(segment: &Segment, sample: &Sample, region: &Region, (radius, excess): (f64, f64)) -> Option<Fault> {
    let (far, most) = (region.outside(sample.tip.into(), sample.touch.point, radius), beside(region, radius, excess));
    if far > most {
        return Some(segment.fault(&faults::OUTSIDE_BOUNDARY).measured(far, most));
    }
    let slope = libm::acos(normal_of(&sample.touch).z.clamp(-1.0, 1.0));
    let (off, lean) = (region.off_slope(slope), lean(radius, excess));
    (off > lean).then(|| segment.fault(&faults::OFF_SLOPE).measured(off.to_degrees(), lean.to_degrees()))
}

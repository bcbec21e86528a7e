//! Contacts outside the region of their operation, and off its faces; and which points of the faces lie in it.

use std::sync::OnceLock;

use styluscam_geometry::{Bvh, Mesh};

use crate::body::Body;
use crate::clearance::Prober;
use crate::expectation::{Contact, ExpectedOperation};
use crate::faults::{self, Fault};
use crate::findings::FindingKind;
use crate::probes::Probe;
use crate::region::{lean, Region};
use crate::samples::{normal_of, Sample};
use crate::segments::Segment;
use crate::subject::Subject;
use crate::tolerances::SLACK;

/// Where a wall and the face before it are one to a tool's upright side, mm.
const TOGETHER: f64 = 0.01;

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
        let body = |operation: &ExpectedOperation| bounded(operation).then(|| subject.touching(operation)).flatten();
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
                let is_inside = region.outside(sample.tip.into(), touch.point, radius) <= region.beside(radius, excess);
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
            let body = self.subject.touching(operation)?;
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

/// The fault of a contact outside a region; `radius` is the tool's, and it may be `excess` off the part, mm.
fn outside(segment: &Segment, sample: &Sample, region: &Region, (radius, excess): (f64, f64)) -> Option<Fault> {
    let (far, most) = (region.outside(sample.tip.into(), sample.touch.point, radius), region.beside(radius, excess));
    if far > most {
        return Some(segment.fault(&faults::OUTSIDE_BOUNDARY).measured(far, most));
    }
    let slope = libm::acos(normal_of(&sample.touch).z.clamp(-1.0, 1.0));
    let (off, lean) = (region.off_slope(slope), lean(radius, excess));
    (off > lean).then(|| segment.fault(&faults::OFF_SLOPE).measured(off.to_degrees(), lean.to_degrees()))
}

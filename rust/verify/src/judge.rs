//! The judgement: moves in, report out.

use styluscam_motion::{Cancelled, Program, Watch};

use crate::findings::{merge, Fault};
use crate::legs::{placed, Leg, LegKind};
use crate::measure::{highest, measure, normal_of, Measured, Sample, Strike};
use crate::orders::{self, Orders};
use crate::{
    diagnosis, passes, reach, sequence, travel, ContactRecord, FindingKind, Forming, Limits, Place, Report, Severity,
    Subject, SLACK,
};

/// What triangles may add to a wall's angle, rad.
const ANGLE: f64 = 1e-3;
/// Contacts in a report at most.
const CONTACTS: usize = 4000;

/// Judges a program read back from posted text against the part.
///
/// Positions are the tool's tip in work coordinates. The same input gives the same report on any number of threads.
///
/// # Errors
/// `Cancelled` when the watch says so; it is polled at every move.
pub fn judge(program: &Program, subject: &Subject, limits: &Limits, watch: &Watch) -> Result<Report, Cancelled> {
    let legs = placed(program, subject, limits);
    let measured = measure(&legs, subject, limits, watch)?;
    let mut tally = Tally { subject, limits, faults: Vec::new(), gouge: Worst::default(), excess: Worst::default() };
    for (leg, found) in legs.iter().zip(&measured) {
        tally.take(leg, found);
    }
    let contacts = Contacts::of(&legs, &measured, subject, limits);
    let mut faults = tally.faults;
    faults.extend(limits.forming.iter().flat_map(|forming| contacts.beyond(forming, &legs)));
    faults.extend(travel::faults(program, &legs, subject, limits));
    faults.extend(reach::faults(program, subject, &limits.reach));
    let orders = Orders::new(program, subject);
    faults.extend(orders.faults(program, &legs, limits));
    faults.extend(sequence::faults(program, &legs, &orders, subject, limits));
    faults.extend(passes::faults(&legs, &orders, subject, limits, watch)?);
    let (mut findings, mut counts) = merge(&faults);
    let nothing = contacts.nothing_touches().then(|| diagnosis::no_contact(program, &legs, &contacts.samples, subject));
    let offset = travel::work_offset(program, subject.wcs);
    let wholes = reach::findings(program, subject, &limits.reach).into_iter().chain(orders::missing(program, subject));
    for whole in wholes.chain(travel::no_feed_moves(program)).chain(offset).chain(nothing) {
        *counts.entry(whole.kind).or_default() += 1;
        findings.insert(0, whole);
    }
    Ok(Report {
        ok: findings.iter().all(|f| f.severity != Severity::Error),
        findings,
        counts,
        gouge_max: tally.gouge.value,
        gouge_at: tally.gouge.at,
        excess_max: tally.excess.value,
        excess_at: tally.excess.at,
        contact_share: contacts.share(),
        samples: measured.iter().map(|m| m.samples).sum(),
        contacts: contacts.records(subject, &legs),
    })
}

/// The largest value so far and its place.
#[derive(Clone, Copy, Default)]
struct Worst {
    value: f64,
    at: Option<Place>,
}

impl Worst {
    fn take(&mut self, value: f64, line: u32, position: [f64; 3]) {
        if value > 0.0 && (self.at.is_none() || value > self.value + SLACK) {
            *self = Self { value, at: Some(Place { line, position }) };
        }
    }
}

/// Collects what the measured moves show.
struct Tally<'a> {
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    faults: Vec<Fault>,
    gouge: Worst,
    excess: Worst,
}

impl Tally<'_> {
    fn take(&mut self, leg: &Leg, found: &Measured) {
        if let Some(deepest) = &found.deepest {
            self.depth(leg, deepest);
        }
        if let Some(Strike { kind, sample, least }) = &found.struck {
            let room = sample.touch.value - least;
            if room < -SLACK && !(leg.kind == LegKind::Rapid && leg.starts_at(sample.tip)) {
                let depth = self.subject.deviation_inward - sample.touch.value;
                let measure = match kind {
                    FindingKind::ShankCollision | FindingKind::HolderCollision => (depth, self.limits.gouge),
                    _ => (sample.touch.value, *least),
                };
                self.fault(*kind, leg, sample, measure, -room);
            }
        }
        if let Some(landing) = &found.landing {
            let air = landing.touch.value;
            let limit = self.limits.rapid_gap;
            self.fault(FindingKind::RapidPlunge, leg, landing, (air, limit), limit - air);
        }
        if let (Some(limit), Some(sample)) = (leg.excess, highest(&found.contacts)) {
            let excess = sample.touch.value + self.subject.deviation_outward;
            self.excess.take(excess, leg.line, sample.tip);
            if excess > limit + SLACK {
                self.fault(FindingKind::Excess, leg, &sample, (excess, limit), excess);
            }
        }
    }

    /// A rapid that is deepest where it starts only leaves a place that the move before it is blamed for.
    fn depth(&mut self, leg: &Leg, deepest: &Sample) {
        let depth = self.subject.deviation_inward - deepest.touch.value;
        self.gouge.take(depth, leg.line, deepest.tip);
        let brought_here = leg.kind == LegKind::Rapid && leg.starts_at(deepest.tip);
        if depth <= self.limits.gouge + SLACK || brought_here {
            return;
        }
        let (kind, value) = match leg.kind {
            LegKind::Rapid if leg.descends() && !leg.travels() => (FindingKind::RapidPlunge, -depth),
            LegKind::Rapid => (FindingKind::RapidIntoMaterial, depth),
            _ => (FindingKind::Gouge, depth),
        };
        self.fault(kind, leg, deepest, (value, self.limits.gouge), depth);
    }

    fn fault(&mut self, kind: FindingKind, leg: &Leg, at: &Sample, measure: (f64, f64), weight: f64) {
        self.faults.push(Fault { position: at.tip, measure: Some(measure), weight, ..leg.fault(kind) });
    }
}

/// The contact moves' samples, each place once.
struct Contacts {
    samples: Vec<Sample>,
    /// Their legs.
    legs: Vec<usize>,
    touching: Vec<usize>,
}

impl Contacts {
    /// The middle and the end of every contact move: its start is the end of another.
    fn of(legs: &[Leg], measured: &[Measured], subject: &Subject, limits: &Limits) -> Self {
        let mut contacts = Self { samples: Vec::new(), legs: Vec::new(), touching: Vec::new() };
        for (index, (leg, found)) in legs.iter().zip(measured).enumerate() {
            let Some(excess) = leg.excess else { continue };
            for sample in found.contacts[1..].iter().flatten() {
                let value = sample.touch.value;
                let shallow = value - subject.deviation_inward >= -limits.gouge - SLACK;
                if shallow && value + subject.deviation_outward <= excess + SLACK {
                    contacts.touching.push(contacts.samples.len());
                }
                contacts.samples.push(*sample);
                contacts.legs.push(index);
            }
        }
        contacts
    }

    fn nothing_touches(&self) -> bool {
        self.touching.is_empty() && !self.samples.is_empty()
    }

    fn share(&self) -> f64 {
        self.touching.len() as f64 / self.samples.len().max(1) as f64
    }

    /// Touching samples at which the sheet is formed steeper or thinner than it bears.
    fn beyond(&self, forming: &Forming, legs: &[Leg]) -> Vec<Fault> {
        let faults = self.touching.iter().flat_map(|i| {
            let (sample, leg) = (&self.samples[*i], &legs[self.legs[*i]]);
            let cos = normal_of(&sample.touch).z.clamp(0.0, 1.0);
            let (angle, thickness) = (libm::acos(cos), forming.thickness * cos);
            let fault = |kind| Fault { position: sample.tip, ..leg.fault(kind) };
            let steep = angle > forming.max_wall_angle + ANGLE;
            let thin = thickness < forming.min_thickness - SLACK;
            let most = forming.max_wall_angle.to_degrees();
            let steep = steep.then(|| fault(FindingKind::WallAngle).measured(angle.to_degrees(), most));
            steep
                .into_iter()
                .chain(thin.then(|| fault(FindingKind::Thinning).measured(thickness, forming.min_thickness)))
        });
        faults.collect()
    }

    /// Touching samples, spread evenly.
    fn records(&self, subject: &Subject, legs: &[Leg]) -> Vec<ContactRecord> {
        let count = self.touching.len().min(CONTACTS);
        let chosen = (0..count).map(|i| self.touching[i * self.touching.len() / count]);
        chosen.map(|i| record(&self.samples[i], legs[self.legs[i]].line, subject)).collect()
    }
}

fn record(sample: &Sample, line: u32, subject: &Subject) -> ContactRecord {
    let touch = &sample.touch;
    ContactRecord {
        line,
        tip: sample.tip,
        point: touch.point.into(),
        clearance: touch.value,
        triangle: touch.triangle,
        face: subject.mesh.faces().get(touch.triangle as usize).copied().unwrap_or(0),
    }
}

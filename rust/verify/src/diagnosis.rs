//! When nothing touches: which mistake in the input would explain it.

use styluscam_motion::Program;

use crate::findings::{Finding, FindingKind, Severity};
use crate::samples::{normal_of, Sample};
use crate::segments::{Segment, SegmentKind};
use crate::subject::Subject;
use crate::tally::Tally;

/// Lengths agree when they differ by less than this share.
const AGREE: f64 = 0.03;
/// Least cosine of the slope at which a vertical shift differs from a distance.
const STEEPEST: f64 = 0.1;
/// Millimetres in an inch.
const INCH: f64 = 25.4;
/// Factor by which a ratio of extents may miss an inch: paths are smaller or larger than the part.
const ABOUT: f64 = 1.6;

/// The finding, with a hint of the probable cause.
pub(crate) fn no_contact(program: &Program, segments: &[Segment], tally: &Tally, subject: &Subject) -> Finding {
    let samples: Vec<Sample> = tally.kept.iter().map(|kept| kept.sample).collect();
    let clearance = median(samples.iter().map(|s| s.touch.value));
    let away = if clearance < 0.0 { "inside it" } else { "away from it" };
    let hint = hint(program, segments, &samples, subject, clearance).map_or_else(String::new, |h| format!(" ({h})"));
    let message = format!(
        "nothing touches the part: the tool's median distance is {:.4} mm {away}; \
         check zero, units and tool reference{hint}",
        clearance.abs()
    );
    let value_mm = Some(clearance);
    Finding {
        moves: tally.contacts,
        value_mm,
        value: value_mm,
        ..Finding::of_all(FindingKind::NoContact, Severity::Error, message)
    }
}

fn hint(
    program: &Program,
    segments: &[Segment],
    samples: &[Sample],
    subject: &Subject,
    clearance: f64,
) -> Option<String> {
    let raised = median(samples.iter().filter_map(vertical));
    units_hint(segments, subject)
        .or_else(|| sheet_hint(subject, clearance, raised))
        .or_else(|| reference_hint(program, subject, raised))
}

/// The vertical shift that would leave this clearance on a plane.
fn vertical(sample: &Sample) -> Option<f64> {
    let cos = normal_of(&sample.touch).z;
    (cos > STEEPEST).then(|| sample.touch.value / cos)
}

fn units_hint(segments: &[Segment], subject: &Subject) -> Option<String> {
    let (low, high) = subject.mesh.bounds();
    let part = (high.x - low.x).max(high.y - low.y);
    let ratio = extent(segments) / part;
    let about = |factor: f64| ratio > factor / ABOUT && ratio < factor * ABOUT;
    if about(INCH) {
        Some("the path is about 25 times as large as the part: millimetres taken for inches?".to_owned())
    } else if about(1.0 / INCH) {
        Some("the path is about 25 times smaller than the part: inches taken for millimetres?".to_owned())
    } else {
        None
    }
}

/// The larger side of the contact moves' box in plan, mm.
fn extent(segments: &[Segment]) -> f64 {
    let ends = || segments.iter().filter(|l| l.kind == SegmentKind::Lateral).map(|l| l.end);
    let side = |axis: usize| {
        let range = ends().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[axis]), b.max(p[axis])));
        range.1 - range.0
    };
    side(0).max(side(1))
}

fn sheet_hint(subject: &Subject, clearance: f64, raised: f64) -> Option<String> {
    let thickness = subject.sheet?.thickness;
    let shows = |whole: f64| agree(clearance, whole) || agree(raised, whole);
    if shows(thickness) {
        Some("that is the sheet's thickness: is model_face right?".to_owned())
    } else if shows(thickness / 2.0) {
        Some("that is half the sheet's thickness: is model_face right?".to_owned())
    } else {
        None
    }
}

fn reference_hint(program: &Program, subject: &Subject, raised: f64) -> Option<String> {
    let recorded = program.tools.iter().map(|t| t.reference_height);
    let centres = subject.tools.iter().filter_map(|t| t.center_height());
    let radii = subject.tools.iter().map(|t| t.diameter() / 2.0);
    let height = recorded.chain(centres).chain(radii).find(|h| *h > 0.0 && agree(raised, *h))?;
    Some(format!(
        "it is {height:.3} mm off in height, as the tool's centre is over its tip: which of them does the text move?"
    ))
}

fn agree(value: f64, expected: f64) -> bool {
    (value.abs() - expected).abs() <= AGREE * expected
}

/// The middle value; NaN when there is none.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

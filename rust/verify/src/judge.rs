//! The verification: moves in, report out.

use styluscam_motion::{Cancelled, Program, Watch};

use crate::assignment::Assignment;
use crate::faults::Fault;
use crate::findings::{Finding, FindingKind, Severity};
use crate::frame::Frame;
use crate::made::Shapes;
use crate::measure::measure;
use crate::merge::{merge, Merged};
use crate::report::Report;
use crate::segments::{placed, Segment};
use crate::subject::{Axes, Limits, Subject};
use crate::tally::Tally;
use crate::{
    bored, chamfered, clearing, contoured, corner_angles, corners, covered, diagnosis, frame, holes, in_stock, leaning,
    low_links, pair, passes, reach, sequence, settings, stock_above, tabs, travel, unreached, walls,
};

/// Checks a program read back from posted text against the part.
///
/// Positions are the tool's tip in work coordinates. The same input gives the same report on any number of threads.
///
/// # Errors
/// `Cancelled` when the watch is cancelled; it is polled at every move.
pub fn judge(program: &Program, subject: &Subject, limits: &Limits, watch: &Watch) -> Result<Report, Cancelled> {
    let segments = placed(program, subject, limits);
    let frame = Frame::of(program, &segments, subject, limits);
    let assignment = Assignment::new(program, subject);
    let (mut tally, of_edges) = measured((program, &segments, &assignment), subject, limits, frame.as_ref(), watch)?;
    let mut faults = std::mem::take(&mut tally.faults);
    let axes = subject.axes.unwrap_or(Axes { program, unknown_positions: subject.unknown_positions });
    let mut beyond = Vec::new();
    if !limits.shape_only {
        faults.extend(of_text(program, &segments, &assignment, subject, limits, frame.as_ref(), watch)?);
        beyond.extend(reach::faults(&axes, &limits.reach));
    }
    if let Some(frame) = &frame {
        faults.extend(frame::faults(frame, program, &segments, &assignment, subject, limits));
    }
    faults.extend(of_passes(program, &segments, &assignment, subject, limits, &faults, watch)?);
    let cleared = clearing::judged(program, &segments, &assignment, subject, limits, watch)?;
    faults.extend(cleared.faults);
    let leaning = leaning::judged(program, &assignment, subject, limits, watch)?;
    faults.extend(leaning.faults);
    tally.samples += leaning.samples;
    tally.gouge.join(leaning.gouge);
    tally.excess.join(leaning.excess);
    let pair = pair::judged(program, &segments, subject, limits, watch)?;
    faults.extend(pair.faults);
    let beyond_reach = unreached::findings(&segments, subject, limits, watch)?;
    let steep = steep_walls(subject, limits, &mut faults);
    let (low, high) = subject.mesh.bounds();
    let Merged { mut reported, mut counts, lengths } =
        merge([(&faults, program), (&beyond, axes.program)], (high - low).norm());
    let nothing = tally.nothing_touches().then(|| diagnosis::no_contact(program, &segments, &tally, subject));
    let found = limits.found.iter().map(|(kind, severity, words)| Finding::of_all(*kind, *severity, words.clone()));
    let of_shape = found
        .chain(pair.finding)
        .chain(steep)
        .chain(cleared.findings.into_iter().chain(of_edges))
        .chain(beyond_reach)
        .chain(travel::without_feeds(program, &segments, &assignment, subject));
    let of_text =
        if limits.shape_only { Vec::new() } else { of_whole_text(&axes, &assignment, subject, program, limits) };
    let wholes: Vec<Finding> = of_text.into_iter().chain(of_shape).chain(nothing).collect();
    wholes.iter().for_each(|whole| *counts.entry(whole.kind).or_default() += 1);
    reported.add(wholes);
    reported.accept(&limits.accepted);
    let (findings, groups) = reported.in_order();
    Ok(Report {
        ok: findings.iter().all(|f| f.severity != Severity::Error),
        findings,
        groups,
        counts,
        lengths,
        gouge_max: tally.gouge.value,
        gouge_at: tally.gouge.at,
        excess_max: tally.excess.value,
        excess_at: tally.excess.at,
        contact_share: tally.share(),
        samples: tally.samples,
        contacts: tally.records(subject),
        engagement: cleared.engagement,
        flanks: leaning.flanks,
    })
}

/// The distances along the moves, with the faults of edges that they chamfer or go along; and what is found of these edges beyond that.
fn measured(
    (program, segments, assignment): (&Program, &[Segment], &Assignment),
    subject: &Subject,
    limits: &Limits,
    frame: Option<&Frame>,
    watch: &Watch,
) -> Result<(Tally, Vec<Finding>), Cancelled> {
    let shapes = Shapes::of(subject);
    let mut tally = measure(segments, (subject, &shapes), limits, frame, watch)?;
    let edges = chamfered::judged(segments, (subject, &shapes), limits, watch)?;
    let contours = contoured::judged(program, segments, assignment, (subject, limits), watch)?;
    tally.faults.extend(edges.faults.into_iter().chain(contours.faults));
    Ok((tally, edges.findings.into_iter().chain(contours.findings).collect()))
}

/// What is owed to the faces of the operations and is not there, and what tools meet of the stock; `known` is what is known of the moves.
fn of_passes(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
    known: &[Fault],
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let mut faults = passes::faults(program, segments, assignment, subject, limits, watch)?;
    faults.extend(holes::faults(segments, subject, limits));
    faults.extend(bored::faults(program, segments, subject, limits));
    faults.extend(covered::faults(segments, assignment, subject, limits, watch)?);
    faults.extend(stock_above::faults(segments, subject, watch)?);
    faults.extend(in_stock::faults(segments, subject, known, watch)?);
    Ok(faults)
}

/// Walls that are too steep, once for the part: every contact on them would repeat it.
fn steep_walls(subject: &Subject, limits: &Limits, faults: &mut Vec<Fault>) -> Option<Finding> {
    let steep = walls::finding(subject, limits)?;
    faults.retain(|fault| fault.kind.finding != FindingKind::WallAngle);
    Some(steep)
}

/// What is checked of the moves of a whole text only, not of a part of it with a shape of its own.
fn of_text(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
    frame: Option<&Frame>,
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let mut faults = travel::faults(program, segments, assignment, subject, limits);
    faults.extend(low_links::faults(segments, assignment, subject, limits, watch)?);
    let all = leaning::with_leaning(segments, &leaning::leaning_moves(program, assignment, subject));
    faults.extend(settings::faults(program, &all, assignment, limits));
    faults.extend(corners::faults(program, assignment, limits));
    faults.extend(corner_angles::faults(program, segments, assignment, limits));
    faults.extend(sequence::faults(program, segments, assignment, subject, limits));
    faults.extend(sequence::punches(program, segments, assignment, subject, limits, frame));
    faults.extend(tabs::faults(program, segments, assignment, subject));
    Ok(faults)
}

/// What is found of a text as a whole.
fn of_whole_text(
    axes: &Axes,
    assignment: &Assignment,
    subject: &Subject,
    program: &Program,
    limits: &Limits,
) -> Vec<Finding> {
    let mut findings: Vec<Finding> = reach::findings(axes, &limits.reach).into_iter().collect();
    findings.extend(assignment.findings(program, subject));
    findings.extend(travel::optional_lines(subject));
    findings.extend(travel::modes_not_stated(program, subject));
    findings.extend(travel::work_offset(program, subject.wcs));
    findings
}

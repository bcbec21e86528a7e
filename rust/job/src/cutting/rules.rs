//! From a table's numbers to the spindle's speed and the feeds: engagement, chip thinning, limits of the machine.
//!
//! n = v / (pi d) with the cutting speed v and the diameter d at the depth of cut, feed = chip x flutes x n. A tooth that enters by the
//! angle w, less than a quarter turn, cuts a chip of at most f sin(w) sin(k), with the feed per tooth f and the slope k of the profile at
//! the depth of cut: the feed is raised by the inverse (`docs/concepts/cutting-data.md`).

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};
use styluscam_geometry::{Cutter, CutterMaterial};

use super::table::{CuttingEntry, CuttingTable, CuttingWork};
use crate::JobError;

/// What is cut, with what, how.
#[derive(Clone, Copy, Debug)]
pub struct Cut<'a> {
    /// The cutter's shape.
    pub cutter: &'a Cutter,
    /// What it is made of.
    pub cutter_material: CutterMaterial,
    /// How many cutting edges it has; needed in milling.
    pub flutes: Option<u32>,
    /// The workpiece's material, by its name in the table.
    pub material: &'a str,
    /// The work.
    pub work: CuttingWork,
    /// The engagement.
    pub engagement: Engagement,
    /// Pitch of a thread, mm; needed in tapping.
    pub pitch: Option<f64>,
    /// The machine's limits.
    pub limits: MachineLimits,
}

/// How a milling cutter is engaged; what is not stated is full: half of the diameter or more, its largest diameter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Engagement {
    /// Radial width of cut, mm; this or the angle.
    pub width: Option<f64>,
    /// Engagement angle, degrees.
    pub angle_deg: Option<f64>,
    /// Axial depth of cut, mm.
    pub depth: Option<f64>,
}

/// What a machine can do; not stated: anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MachineLimits {
    /// Slowest spindle, rev/min.
    pub min_rpm: Option<f64>,
    /// Fastest spindle, rev/min.
    pub max_rpm: Option<f64>,
    /// Fastest feed, mm/min.
    pub max_feed: Option<f64>,
}

/// Speed and feeds, and why they are so.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CuttingData {
    /// Speed of the spindle, rev/min.
    pub rpm: f64,
    /// Feed along the path, mm/min.
    pub feed: f64,
    /// Feed straight down, mm/min.
    pub plunge: f64,
    /// Cutting speed on `diameter`, m/min.
    pub speed_m_min: f64,
    /// Diameter that cuts, at the depth of cut, mm.
    pub diameter: f64,
    /// Feed per tooth, mm; per revolution in drilling and tapping.
    pub feed_per_tooth: f64,
    /// Thickest chip, mm: the feed per tooth less what thinning takes.
    pub chip: f64,
    /// Sentences: what the numbers follow from.
    pub reasons: Vec<String>,
    /// Where the table's numbers are stated.
    pub sources: Vec<String>,
}

/// Speed and feeds for a cut by a table.
///
/// # Errors
/// `unknown` for a material that the table does not have, `no-cutting-data` for a cutter or work, `out-of-range` for sizes, `missing`
/// for flutes in milling and the pitch in tapping, `conflict` for a width and an angle at once.
pub fn cutting_data(cut: &Cut<'_>, table: &CuttingTable) -> Result<CuttingData, JobError> {
    check(cut)?;
    let material = table.material(cut.material)?;
    let entry = material.entry(cut.cutter_material, cut.work)?;
    let what = format!("{}, {}, {}", material.name, cut.cutter_material.name(), cut.work.name());
    let (diameter, slope_sine) = cutting_circle(cut);
    let mut reasons = Vec::new();
    let rpm = turned(cut, entry, diameter, &what, &mut reasons);
    let mut sources = vec![entry.source.clone()];
    let mut data = match (cut.work, cut.pitch) {
        (CuttingWork::Tapping, Some(pitch)) => tapped(cut, rpm, pitch, &mut reasons),
        _ => {
            if entry.source_of_chips() != entry.source {
                sources.push(entry.source_of_chips().to_owned());
            }
            fed(cut, entry, rpm, [diameter, slope_sine], &mut reasons)?
        }
    };
    data.diameter = diameter;
    data.speed_m_min = PI * diameter * data.rpm / 1000.0;
    data.reasons = reasons;
    data.sources = sources;
    Ok(data)
}

/// Refuses numbers that are no sizes.
fn check(cut: &Cut<'_>) -> Result<(), JobError> {
    let Engagement { width, angle_deg, depth } = cut.engagement;
    let MachineLimits { min_rpm, max_rpm, max_feed } = cut.limits;
    let diameter = 2.0 * cut.cutter.max_radius();
    let sizes = [
        ("width", width, diameter, "mm, no more than the cutter is wide"),
        ("angle_deg", angle_deg, 180.0, "degrees, no more than 180"),
        ("depth", depth, f64::INFINITY, "mm"),
        ("pitch", cut.pitch, diameter, "mm, less than the tap is wide"),
        ("min_rpm", min_rpm, f64::INFINITY, "rev/min"),
        ("max_rpm", max_rpm, f64::INFINITY, "rev/min"),
        ("max_feed", max_feed, f64::INFINITY, "mm/min"),
    ];
    for (name, value, most, allowed) in sizes {
        let Some(value) = value.filter(|value| !(*value > 0.0 && *value <= most && value.is_finite())) else {
            continue;
        };
        let message = format!("{name} = {value}: out of range");
        return Err(JobError::document("out-of-range", name, message, format!("give more than 0 {allowed}")));
    }
    let conflict = |at: &str, message: &str, hint: &str| Err(JobError::document("conflict", at, message, hint));
    if width.is_some() && angle_deg.is_some() {
        return conflict("angle_deg", "the width of cut and the engagement angle are both given", "give one of them");
    }
    if min_rpm.zip(max_rpm).is_some_and(|(min, max)| min > max) {
        return conflict("min_rpm", "it is above max_rpm", "lower min_rpm or raise max_rpm");
    }
    let missing = |name: &str, hint: &str| Err(JobError::document("missing", name, format!("{name} is missing"), hint));
    match cut.work {
        CuttingWork::RoughMilling | CuttingWork::FinishMilling if cut.flutes.unwrap_or(0) == 0 => {
            missing("flutes", "state how many cutting edges the cutter has: feeds are per tooth")
        }
        CuttingWork::Tapping if cut.pitch.is_none() => missing("pitch", "state the thread's pitch, mm: it is the feed"),
        _ => Ok(()),
    }
}

/// Diameter of the circle that cuts, mm, and the sine of the profile's slope there: in milling at the depth of cut.
fn cutting_circle(cut: &Cut<'_>) -> (f64, f64) {
    match cut.engagement.depth.filter(|_| cut.work.mills()) {
        Some(depth) => {
            let (radius, rise) = cut.cutter.at_height(depth);
            let sine = if rise.is_finite() { rise / libm::hypot(1.0, rise) } else { 1.0 };
            (2.0 * radius, sine)
        }
        None => (2.0 * cut.cutter.max_radius(), 1.0),
    }
}

/// Speed of the spindle within the machine's limits, rev/min.
fn turned(cut: &Cut<'_>, entry: &CuttingEntry, diameter: f64, what: &str, reasons: &mut Vec<String>) -> f64 {
    let asked = match (entry.speed(), entry.rpm) {
        (Some([low, high]), _) => {
            let rpm = 1000.0 * low / (PI * diameter);
            let up_to = if high > low { format!(", where {} is allowed", digits(high)) } else { String::new() };
            reasons.push(format!(
                "{what}: a cutting speed of {} m/min{up_to}, which is {} rev/min on a diameter of {} mm",
                digits(low),
                digits(rpm),
                digits(diameter)
            ));
            rpm
        }
        (None, rpm) => {
            let rpm = rpm.unwrap_or_default();
            reasons.push(format!("{what}: {} rev/min whatever the diameter", digits(rpm)));
            rpm
        }
    };
    let MachineLimits { min_rpm, max_rpm, .. } = cut.limits;
    let fastest = max_rpm.filter(|most| asked > *most).map(|most| (most, "no faster", "slower"));
    let slowest = min_rpm.filter(|least| asked < *least).map(|least| (least, "no slower", "faster"));
    let Some((rpm, limit, other)) = fastest.or(slowest) else { return asked };
    reasons
        .push(format!("the spindle turns {limit} than {} rev/min: it cuts {other}, and the feed follows", digits(rpm)));
    rpm
}

/// Feeds of milling and drilling; `circle` is the diameter that cuts, mm, and the sine of the slope there.
fn fed(
    cut: &Cut<'_>,
    entry: &CuttingEntry,
    rpm: f64,
    circle: [f64; 2],
    reasons: &mut Vec<String>,
) -> Result<CuttingData, JobError> {
    let whole = 2.0 * cut.cutter.max_radius();
    let full = chip_at(entry, cut.work, whole, reasons)?;
    let chip = full * share_at_depth(entry, cut.engagement.depth, whole, reasons);
    let (mut per_tooth, flutes) = if cut.work.mills() {
        (thinned(cut.engagement, chip, circle, reasons), f64::from(cut.flutes.unwrap_or(1)))
    } else {
        (chip, 1.0)
    };
    let thinning = chip / per_tooth;
    if let Some(width) = cut.engagement.width.filter(|width| cut.work.mills() && per_tooth > *width) {
        reasons.push(format!(
            "the feed per tooth stays at the width of cut, {} mm: marks of teeth lie no farther apart than passes",
            digits(width)
        ));
        per_tooth = width;
    }
    let mut feed = per_tooth * flutes * rpm;
    reasons.push(format!(
        "{} mm per {} x {} x {} rev/min",
        digits(per_tooth),
        if cut.work.mills() { "tooth" } else { "revolution" },
        flutes,
        digits(rpm)
    ));
    if let Some(most) = cut.limits.max_feed.filter(|most| feed > *most) {
        reasons.push(format!(
            "the machine feeds no faster than {} mm/min: chips are thinner than they may be",
            digits(most)
        ));
        per_tooth *= most / feed;
        feed = most;
    }
    // the end of a cutter cuts as one tooth does: feed per revolution = feed per tooth
    let plunge = if cut.work.mills() { (full * rpm).min(feed) } else { feed };
    Ok(CuttingData {
        rpm,
        feed,
        plunge,
        speed_m_min: 0.0,
        diameter: 0.0,
        feed_per_tooth: per_tooth,
        chip: per_tooth * thinning,
        reasons: Vec::new(),
        sources: Vec::new(),
    })
}

/// The chip at a diameter, mm: between the table's sizes by straight lines; below them as a share of the diameter; above as at the
/// largest.
fn chip_at(entry: &CuttingEntry, work: CuttingWork, diameter: f64, reasons: &mut Vec<String>) -> Result<f64, JobError> {
    let points = entry.chips();
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Ok(0.0) };
    let [least, most] = entry.sizes(work);
    if !(least..=most).contains(&diameter) {
        let message = format!(
            "the cutter is {} mm wide: the table's sizes are {} to {} mm",
            digits(diameter),
            digits(first[0]),
            digits(last[0])
        );
        let hint = format!(
            "choose a cutter of {} to {} mm, or add its size to a table of your own",
            digits(least),
            digits(most)
        );
        return Err(JobError::document("out-of-range", "diameter", message, hint));
    }
    if diameter < first[0] {
        reasons.push(format!(
            "the table begins at {} mm: below, the feed is in proportion to the diameter",
            digits(first[0])
        ));
        return Ok(first[1] * diameter / first[0]);
    }
    if diameter > last[0] {
        reasons.push(format!("the table ends at {} mm: its feed there counts", digits(last[0])));
    }
    Ok(between(&points, diameter))
}

/// The value of a polyline at x; beyond its ends, theirs.
fn between(points: &[[f64; 2]], x: f64) -> f64 {
    let below = points.iter().rev().find(|point| point[0] <= x);
    let above = points.iter().find(|point| point[0] >= x);
    match (below, above) {
        (Some(a), Some(b)) if a[0] < b[0] => a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]),
        (Some(end), _) | (None, Some(end)) => end[1],
        (None, None) => 1.0,
    }
}

/// Share of the chip that the table allows at a depth of cut.
fn share_at_depth(entry: &CuttingEntry, depth: Option<f64>, diameter: f64, reasons: &mut Vec<String>) -> f64 {
    let Some(depth) = depth else { return 1.0 };
    let share = between(&entry.chip_by_depth, depth / diameter);
    if share < 1.0 {
        reasons.push(format!(
            "cut {} diameters deep, chips are {} of the table's",
            digits(depth / diameter),
            digits(share)
        ));
    }
    share
}

/// Feed per tooth at which the thickest chip is `chip`, mm.
fn thinned(engagement: Engagement, chip: f64, [diameter, slope_sine]: [f64; 2], reasons: &mut Vec<String>) -> f64 {
    let by_width = engagement.width.map(|width| libm::acos(1.0 - 2.0 * width.min(diameter) / diameter));
    let angle = by_width.or(engagement.angle_deg.map(f64::to_radians)).unwrap_or(PI);
    let sine = if angle < 0.5 * PI { libm::sin(angle) } else { 1.0 };
    if sine < 1.0 {
        reasons.push(format!(
            "the teeth are engaged over {} deg, less than a quarter turn: chips are thinner by {}, and the feed is raised by {}",
            digits(angle.to_degrees()),
            digits(sine),
            digits(1.0 / sine)
        ));
    }
    if slope_sine < 1.0 {
        reasons.push(format!(
            "at the depth of cut the profile's slope thins chips by {}: the feed is raised by {}",
            digits(slope_sine),
            digits(1.0 / slope_sine)
        ));
    }
    chip / (sine * slope_sine)
}

/// A tap goes one pitch in a revolution, and no faster than the machine feeds.
fn tapped(cut: &Cut<'_>, rpm: f64, pitch: f64, reasons: &mut Vec<String>) -> CuttingData {
    let mut rpm = rpm;
    if let Some(most) = cut.limits.max_feed.filter(|most| pitch * rpm > *most) {
        rpm = most / pitch;
        reasons.push(format!(
            "the machine feeds no faster than {} mm/min: the spindle turns at {} rev/min",
            digits(most),
            digits(rpm)
        ));
    }
    reasons.push(format!("a pitch of {} mm x {} rev/min", digits(pitch), digits(rpm)));
    CuttingData {
        rpm,
        feed: pitch * rpm,
        plunge: pitch * rpm,
        speed_m_min: 0.0,
        diameter: 0.0,
        feed_per_tooth: pitch,
        chip: pitch,
        reasons: Vec::new(),
        sources: Vec::new(),
    }
}

/// A number with four digits.
fn digits(value: f64) -> String {
    let unit = libm::pow(10.0, (libm::log10(value.abs().max(f64::MIN_POSITIVE))).floor() - 3.0);
    let rounded = (value / unit).round() * unit;
    format!("{}", (rounded * 1e9).round() / 1e9)
}

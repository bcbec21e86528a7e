//! Feeds and the spindle of a starter job: for solids from the table of cutting data, for sheets as a stylus slides.

use styluscam_geometry::CutterMaterial;

use super::part::StarterPart;
use super::sizes::Cutter;
use super::text::{number, quoted, wrapped};
use crate::cutting::{cutting_data, Cut, CuttingData, CuttingWork, Engagement, MachineLimits};
use crate::JobError;

/// What is cut where nothing is stated.
const MATERIAL: &str = "aluminium";
/// What a small machine does at most, rev/min, mm/min: turning more slowly than the cutter stands harms nothing, turning faster does.
const SMALL: MachineLimits = MachineLimits { min_rpm: None, max_rpm: Some(12_000.0), max_feed: Some(1500.0) };
/// The cutter.
const FLUTES: u32 = 2;
const CUTTER: CutterMaterial = CutterMaterial::Carbide;
/// Feeds of a stylus, mm/min: along the path, and down.
const SLIDING: [f64; 2] = [1500.0, 300.0];

/// Feeds and spindle of every operation of a job.
pub struct StarterFeeds {
    /// Lines of the process.
    pub process: String,
    /// Lines of the tool.
    pub tool: String,
    /// Lines of each operation.
    pub operation: String,
    /// What a reader is to know.
    pub reason: Option<String>,
}

/// For a solid that is milled with a cutter.
///
/// # Errors
/// A material that the table does not have, a size out of it.
pub fn milling(part: &StarterPart<'_>, cutter: &Cutter) -> Result<StarterFeeds, JobError> {
    let material = part.table.material(part.material.unwrap_or(MATERIAL))?.name.clone();
    let made = cutter.made().ok_or_else(|| {
        let message = format!("no cutter is {} mm wide", cutter.diameter);
        JobError::document("out-of-range", "tools.cutter", message, "check the part's unit")
    })?;
    let cut = Cut {
        cutter: &made.cutter(),
        cutter_material: CUTTER,
        flutes: Some(FLUTES),
        material: &material,
        work: CuttingWork::FinishMilling,
        engagement: Engagement::default(),
        pitch: None,
        limits: SMALL,
    };
    let data = cutting_data(&cut, part.table)?;
    let own = part.cutting_data.map_or(String::new(), |file| format!("cutting_data = {}\n", quoted(file)));
    let assumed = if part.material.is_some() { "" } else { ", which is assumed" };
    Ok(StarterFeeds {
        process: format!(
            "material = {:23}# of the workpiece: see `styluscam material cutting`\n{own}",
            quoted(&material)
        ),
        tool: format!("flutes = {FLUTES}\ncutter_material = {:16}# or \"hss\": high-speed steel\n", quoted(CUTTER.name())),
        operation: written(&data),
        reason: Some(format!(
            "feeds and spindle are for {material}{assumed}, a cutter of {} with {FLUTES} flutes, and a machine that turns at {} rev/min \
             and feeds at {} mm/min at most: beside them is what they follow from",
            CUTTER.name(),
            SMALL.max_rpm.unwrap_or_default(),
            SMALL.max_feed.unwrap_or_default()
        )),
    })
}

/// For a sheet that a stylus forms.
pub fn forming(part: &StarterPart<'_>) -> StarterFeeds {
    let known = part.material.filter(|name| crate::materials::check(name).is_ok());
    let [cut, plunge] = SLIDING.map(number);
    StarterFeeds {
        process: known.map_or(String::new(), |name| format!("material = {}\n", quoted(name))),
        tool: String::new(),
        operation: format!("feeds = {{ cut = {cut}, plunge = {plunge} }}\n"),
        reason: part.material.filter(|_| known.is_none()).map(|name| {
            format!("{name:?} is left out: how steep a wall sheets of it withstand is not known (`styluscam material list`)")
        }),
    }
}

/// Feeds and spindle, rounded down, with what they follow from.
fn written(data: &CuttingData) -> String {
    let sources = data.sources.iter().map(|source| format!("source: {source}"));
    let why = data.reasons.iter().cloned().chain(sources).map(|sentence| wrapped(&sentence));
    let down = |value: f64, unit: f64| (value / unit).floor() * unit;
    let coarse = |feed: f64| down(feed, if feed >= 100.0 { 10.0 } else { 1.0 }).max(1.0);
    let rpm = down(data.rpm, if data.rpm >= 1000.0 { 100.0 } else { 1.0 }).max(1.0);
    let [cut, plunge] = [data.feed, data.plunge].map(|feed| number(coarse(feed * rpm / data.rpm)));
    format!(
        "{}feeds = {{ cut = {cut}, plunge = {plunge} }}\nspindle = {{ mode = \"fixed\", rpm = {} }}\n",
        why.collect::<String>(),
        number(rpm)
    )
}

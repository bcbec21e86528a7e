//! Feeds and the spindle of a starter job: for solids from the table of cutting data, for sheets as a stylus slides.

use super::choice::Choice;
use super::feed_lines::StarterFeeds;
use super::part::StarterPart;
use super::shop::{CUTTER, MATERIAL};
use super::text::{number, quoted, wrapped};
use super::work::Work;
use super::written::Written;
use crate::cutting::{data_of, CuttingData, CuttingTable, MachineLimits};
use crate::operations::Serves;
use crate::{parse, resolve, JobDocument, JobError};

/// What a small machine does at most, rev/min, mm/min: turning more slowly than the cutter stands harms nothing, turning faster does.
const SMALL: MachineLimits = MachineLimits { min_rpm: None, max_rpm: Some(12_000.0), max_feed: Some(1500.0) };
/// Teeth of a cutter.
const FLUTES: u32 = 2;
/// What an operation has before its own spindle is known.
const TURNING: &str = "spindle = { mode = \"fixed\", rpm = 1000.0 }\n";
/// Feeds of a stylus, mm/min: along the path, and down.
const SLIDING: [f64; 2] = [1500.0, 300.0];

/// For a job, from its operations as they are written without; those for which there are no cutting data are left out of it.
///
/// # Errors
/// A material that the table does not have, a size out of it.
pub fn feeds(part: &StarterPart<'_>, choice: &mut Choice, tolerances: [f64; 2]) -> Result<StarterFeeds, JobError> {
    if choice.sheet.is_some() {
        return Ok(forming(part, choice));
    }
    milling(part, choice, tolerances)
}

/// For a solid that is milled with cutters.
fn milling(part: &StarterPart<'_>, choice: &mut Choice, tolerances: [f64; 2]) -> Result<StarterFeeds, JobError> {
    let material = part.table.material(part.material.unwrap_or(MATERIAL))?.name.clone();
    let own = part.cutting_data.map_or(String::new(), |file| format!("cutting_data = {}\n", quoted(file)));
    let mut feeds = StarterFeeds {
        process: format!(
            "material = {:23}# of the workpiece: see `styluscam material cutting`\n{own}",
            quoted(&material)
        ),
        tool: format!(
            "flutes = {FLUTES}\ncutter_material = {:16}# or \"hss\": high-speed steel\n",
            quoted(CUTTER.name())
        ),
        operations: vec![TURNING.to_owned(); choice.operations.len()],
    };
    let job = parse::from_toml(&Written { part, choice, tolerances, feeds: Some(&feeds) }.job())?;
    feeds.operations.clear();
    let mut kept = Vec::new();
    for (index, work) in std::mem::take(&mut choice.operations).into_iter().enumerate() {
        match of_operation(&job, index, &material, part.table) {
            Ok(data) => {
                feeds.operations.push(written(&data));
                kept.push(work);
            }
            Err(error) if error.code() == "no-cutting-data" && is_before_finishing(&work) => {
                choice.reasons.push(format!("no operation {:?}: {error}", work.id));
            }
            Err(error) => return Err(error),
        }
    }
    choice.operations = kept;
    let assumed = if part.material.is_some() { "" } else { ", which is assumed" };
    choice.reasons.push(format!(
        "feeds and spindle are for {material}{assumed}, cutters of {} with {FLUTES} flutes, and a machine that turns at {} rev/min \
         and feeds at {} mm/min at most: beside them is what they follow from",
        CUTTER.name(),
        SMALL.max_rpm.unwrap_or_default(),
        SMALL.max_feed.unwrap_or_default()
    ));
    Ok(feeds)
}

/// What prepares for finishing: without it the rest is a job as well.
fn is_before_finishing(work: &Work) -> bool {
    matches!(work.serves, Serves::Stock | Serves::Holes) || work.leave > 0.0
}

/// What the table states for an operation of a job.
fn of_operation(
    job: &JobDocument,
    index: usize,
    material: &str,
    table: &CuttingTable,
) -> Result<CuttingData, JobError> {
    let tools = resolve::tools(job)?;
    let section = job.operations.get(index);
    let (section, (tool, _)) =
        section.and_then(|section| Some((section, tools.get(&section.common.tool)?))).ok_or_else(|| {
            JobError::document("missing", format!("operations[{index}]"), "it has no tool", "check the part's unit")
        })?;
    data_of(section, index, (tool, material), table, SMALL)
}

/// For a sheet that a stylus forms.
fn forming(part: &StarterPart<'_>, choice: &mut Choice) -> StarterFeeds {
    let known = part.material.filter(|name| crate::materials::check(name).is_ok());
    if let Some(name) = part.material.filter(|_| known.is_none()) {
        choice.reasons.push(format!(
            "{name:?} is left out: how steep a wall sheets of it withstand is not known (`styluscam material list`)"
        ));
    }
    let [cut, plunge] = SLIDING.map(number);
    let feeds = format!("feeds = {{ cut = {cut}, plunge = {plunge} }}\n");
    StarterFeeds {
        process: known.map_or(String::new(), |name| format!("material = {}\n", quoted(name))),
        tool: String::new(),
        operations: choice.operations.iter().map(|_| feeds.clone()).collect(),
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

//! What a person reads before pressing start, and what the program's header repeats.

use serde::Serialize;
use styluscam_motion::{Statistics, ToolReference};
use styluscam_post::{machine::LengthUnit, Machine};

use crate::{operations::Fact, plan::OperationSummary, Channel, Judgement, Scene};

/// Faces that the program's header lists one by one.
const SHOWN: usize = 8;

/// The job in numbers. Lengths mm, time s, angles degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The zero point, in words.
    pub zero: String,
    /// Work offset.
    pub wcs: String,
    /// Lower corner of the part's box in work coordinates.
    pub part_min: [f64; 3],
    /// Upper corner.
    pub part_max: [f64; 3],
    /// The stock, in words; none where the job states none.
    pub stock: Option<String>,
    /// Lowest posted coordinate at feed (of the reference point).
    pub deepest_z: f64,
    /// The machine.
    pub machine: String,
    /// "mm" or "inch": what the text is written in.
    pub units: String,
    /// Tools in order.
    pub tools: Vec<ToolLine>,
    /// What was changed of the part in the file before it was planned.
    pub changes: Vec<Fact>,
    /// Operations in order.
    pub operations: Vec<OperationSummary>,
    /// Length at feed.
    pub length: f64,
    /// Time.
    pub duration: f64,
    /// Whether the machine's acceleration is known and counted in it.
    pub accelerates: bool,
    /// Checked deviation of the part's triangles: inward and outward.
    pub tessellation: [f64; 2],
    /// Deepest gouge found in the posted text; absent before it is checked.
    pub gouge_max: Option<f64>,
    /// Largest excess found at its contact tracks.
    pub excess_max: Option<f64>,
    /// Whether the verifier found nothing.
    pub ok: Option<bool>,
}

/// A tool as the operator must find it.
#[derive(Clone, Debug, Serialize)]
pub struct ToolLine {
    /// Place in the tool table.
    pub number: u32,
    /// Length offset.
    pub length_offset: u32,
    /// What it is.
    pub description: String,
    /// "tip", or "center, 5 above the tip".
    pub reference: String,
}

impl Summary {
    /// Sums up a channel's plan for its machine, with the verification of its text once there is one.
    #[must_use]
    pub fn new(channel: &Channel, scene: &Scene, machine: &Machine, judgement: Option<&Judgement>) -> Self {
        let program = &channel.program;
        let statistics = Statistics::of(program, &machine.dynamics());
        let tools = program.tools.iter().map(|tool| ToolLine {
            number: tool.number,
            length_offset: tool.length_offset,
            description: tool.description.clone(),
            reference: match tool.reference {
                ToolReference::Tip => "tip".to_owned(),
                ToolReference::Center => format!("center, {} above the tip", tool.reference_height),
            },
        });
        // with one reference height the deepest posted coordinate is the deepest tip moved up by it
        let lift = program.tools.iter().map(|t| t.reference_height).fold(f64::INFINITY, f64::min);
        Self {
            zero: program.setup.zero.clone(),
            wcs: program.setup.wcs.clone(),
            part_min: program.setup.part_min,
            part_max: program.setup.part_max,
            stock: scene.stock_words.clone(),
            deepest_z: statistics.lowest + if lift.is_finite() { lift } else { 0.0 },
            machine: machine.name.clone(),
            units: if machine.units.output == LengthUnit::Mm { "mm" } else { "inch" }.to_owned(),
            tools: tools.collect(),
            changes: scene.changes.clone(),
            operations: channel.operations.clone(),
            length: statistics.feed_length,
            duration: statistics.duration,
            accelerates: machine.limits.acceleration.is_some(),
            tessellation: [scene.inward, scene.outward],
            gouge_max: judgement.map(|j| j.report.gouge_max),
            excess_max: judgement.map(|j| j.report.excess_max),
            ok: judgement.map(|j| j.report.ok),
        }
    }

    /// Lines for the program's header: what the set-up record does not say by itself.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let stock = self.stock.iter().map(|words| format!("stock: {words}"));
        let mut notes: Vec<String> = stock.chain(self.changes.iter().map(|change| change.words.clone())).collect();
        for operation in &self.operations {
            notes.extend(operation.notes());
        }
        let counted = if self.accelerates { "" } else { " without acceleration" };
        notes.push(format!("length {:.0} mm, time {}{counted}", self.length, clock(self.duration)));
        notes.push(self.verdict());
        notes
    }
}

impl Summary {
    /// As long before the verification as after it: the lines of the text keep their numbers.
    fn verdict(&self) -> String {
        let figure = |value: Option<f64>| value.map_or("-.----".to_owned(), |v| format!("{v:.4}"));
        let [gouge, excess] = [self.gouge_max, self.excess_max].map(figure);
        let verdict = self.ok.map_or("------", |ok| if ok { "passed" } else { "FAILED" });
        format!("judged from this text: {verdict}, worst gouge {gouge} mm, worst excess {excess} mm")
    }
}

impl OperationSummary {
    /// Its lines of the program's header.
    fn notes(&self) -> Vec<String> {
        let angle = self.surface.as_ref().map(|surface| surface.wall_angle_max_deg);
        let angle = angle.map_or(String::new(), |deg| format!(", largest wall angle {deg:.1} deg"));
        let mut notes = vec![format!("{}: {}{angle}", self.id, self.note)];
        notes.extend(self.lines.iter().cloned());
        let Some(surface) = &self.surface else { return notes };
        notes.extend(surface.ends.map(|end| {
            let which = if end.at_foot { "the part's foot" } else { "z_bottom" };
            format!(
                "ends at Z{:.3}, {which}: {:.3} of the walls are touched only from lower down",
                end.z, end.untouched
            )
        }));
        notes.extend(surface.bridged.iter().take(SHOWN).map(|bridge| {
            let [x, y, z] = bridge.at;
            format!("bridged: Face{} by up to {:.3} at X{x:.2} Y{y:.2} Z{z:.2}", bridge.face, bridge.excess)
        }));
        notes.extend(more("bridged", surface.bridged.len()));
        let undercut = surface.undercut.iter().take(SHOWN);
        notes.extend(undercut.map(|(face, area)| format!("undercut: Face{face}, {area:.1} mm2")));
        notes.extend(more("undercut", surface.undercut.len()));
        notes
    }
}

/// How many faces are not listed, of so many.
fn more(what: &str, count: usize) -> Option<String> {
    (count > SHOWN).then(|| format!("{what}: {} more faces", count - SHOWN))
}

/// Hours, minutes and seconds.
fn clock(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    format!("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}

//! What the schema cannot state: keys that belong together, or exclude each other. Ranges are checked in [`crate::units`].

use styluscam_geometry::{Sheet, SheetLaw};
use styluscam_verify::Support;

use crate::cutting::CuttingTable;
use crate::fixture::FixtureSection;
use crate::process::Opposite;
use crate::resolve::{check_channels, check_stock};
use crate::{
    clamp,
    operations::{Fit, LinkHeight},
    spindle, CheckSelection, Direction, JobDocument, JobError, LengthUnit, MachineSection, OperationKeys,
    OperationSection, Process, ProcessSection, Selection, SheetSection, Zero,
};

/// Checks combinations of keys.
pub fn document(job: &JobDocument) -> Result<(), JobError> {
    some_face("part.faces", &job.part.faces)?;
    if let Some(CheckSelection::Named(names)) = &job.part.check_faces {
        some_face("part.check_faces", &Selection::Named(names.clone()))?;
    }
    setup(job)?;
    process(&job.process)?;
    check_stock(job)?;
    crate::shaping::check(job)?;
    machine("machine", &job.machine)?;
    for (channel, section) in &job.machines {
        machine(&format!("machines.{channel}"), section)?;
    }
    tools(job)?;
    if job.operations.is_empty() {
        return Err(JobError::document(
            "empty",
            "operations",
            "the job has no operation",
            "add an [[operations]] table",
        ));
    }
    for (i, operation) in job.operations.iter().enumerate() {
        self::operation(job, &format!("operations[{i}]"), operation)?;
    }
    ids(&job.operations)?;
    check_channels(job)
}

/// No two operations have one name.
fn ids(operations: &[OperationSection]) -> Result<(), JobError> {
    let mut known = std::collections::BTreeMap::new();
    for (index, operation) in operations.iter().enumerate() {
        let id = operation.id(index);
        if let Some(other) = known.insert(id.clone(), index) {
            let message = format!("operations[{other}] and operations[{index}] are both called {id:?}");
            return Err(JobError::document(
                "conflict",
                format!("operations[{index}].id"),
                message,
                "give each its own",
            ));
        }
    }
    Ok(())
}

fn some_face(path: &str, selection: &Selection) -> Result<(), JobError> {
    match selection {
        Selection::Named(names) if names.is_empty() => {
            Err(JobError::document("empty", path, "no face is named", "name one, or write \"all\""))
        }
        _ => Ok(()),
    }
}

fn setup(job: &JobDocument) -> Result<(), JobError> {
    let setup = &job.setup;
    if setup.retract > setup.clearance {
        let [retract, clearance] = [setup.retract, setup.clearance].map(|mm| job.units.shown(mm));
        let message = format!("retract = {retract} is above clearance = {clearance}");
        return Err(JobError::document("conflict", "setup.retract", message, "lower retract or raise clearance"));
    }
    let (process, sheet) = (&job.process.process, setup.sheet);
    match (process.as_kind().takes_sheet(), sheet) {
        (true, None) => Err(JobError::document(
            "conflict",
            "setup.sheet",
            format!("process.kind = {:?} forms a sheet, and there is none", process.name()),
            format!("add [setup.sheet] with its thickness, or set process.kind = {}", processes(false)),
        )),
        (false, Some(_)) => Err(JobError::document(
            "conflict",
            "setup.sheet",
            format!("process.kind = {:?} has no sheet", process.name()),
            format!("remove [setup.sheet], or set process.kind = {}", processes(true)),
        )),
        (true, Some(sheet)) => with_sheet(job, &sheet),
        (false, None) => without_sheet(job),
    }
}

/// The processes for sheets, or those for solids, as a document writes them.
fn processes(for_sheets: bool) -> String {
    let found = Process::ABOUT.iter().filter(|(_, about)| about.for_sheets == for_sheets);
    found.map(|(name, _)| format!("{name:?}")).collect::<Vec<_>>().join(" or ")
}

fn with_sheet(job: &JobDocument, sheet: &SheetSection) -> Result<(), JobError> {
    if sheet.min_thickness.is_some_and(|least| least > sheet.thickness) {
        return Err(JobError::document(
            "conflict",
            "setup.sheet.min_thickness",
            "the sheet is thinner than that before it is formed",
            "make min_thickness smaller than thickness",
        ));
    }
    if let Some(fixture) = &job.setup.fixture {
        self::fixture(fixture, job.setup.clearance, job.units)?;
        support(fixture, job.process.process.as_kind().support())?;
    }
    spun(&job.process.process, sheet)?;
    if job.part.model_face.is_none() {
        return Err(JobError::document(
            "missing",
            "part.model_face",
            "with a sheet, model_face must state which of its faces the model shows",
            "add model_face = \"tool\", \"back\" or \"mid\" to [part]",
        ));
    }
    Ok(())
}

/// Shear spinning moves each ring of the disc parallel to the axis, and its thickness in that direction stays: the sine law.
fn spun(process: &Process, sheet: &SheetSection) -> Result<(), JobError> {
    match (process.as_kind().turns_part(), sheet.law) {
        (false, _) | (true, SheetLaw::Sine) => Ok(()),
        (true, SheetLaw::Constant) => {
            let message = format!(
                "process.kind = {:?} thins the sheet by the sine law, and the job's keeps its thickness",
                process.name()
            );
            let hint = "write law = \"sine\" in [setup.sheet]";
            Err(JobError::document("conflict", "setup.sheet.law", message, hint))
        }
    }
}

fn process(process: &ProcessSection) -> Result<(), JobError> {
    let kind = process.process.as_kind();
    match (process.common.material.as_deref(), kind.takes_sheet(), kind.cutting_data()) {
        (Some(material), true, _) => crate::materials::check(material),
        (Some(material), false, None) => {
            CuttingTable::shipped().material(material).map(|_| ()).map_err(|error| error.at("process.material"))
        }
        // a shop's own table is still to be read
        (Some(_), false, Some(_)) | (None, _, _) => Ok(()),
    }
}

/// Rapids pass over the clamp.
fn fixture(fixture: &FixtureSection, clearance: f64, unit: LengthUnit) -> Result<(), JobError> {
    let Some(clamp) = fixture.clamp else { return Ok(()) };
    if clamp.height + fixture.margin <= clearance {
        return Ok(());
    }
    let [height, least, clearance] = [clamp.height, clamp.height + fixture.margin, clearance].map(|mm| unit.shown(mm));
    let message =
        format!("clearance = {clearance}: rapids would cross the clamp, {height} {} high, too near to it", unit.name());
    let hint = format!("raise clearance to {least} or more");
    Err(JobError::document("conflict", "setup.clearance", message, hint))
}

/// A clamp goes down, and no plate is below the sheet, where that is formed over a male die; and only there.
fn support(fixture: &FixtureSection, support: Support) -> Result<(), JobError> {
    let follows = fixture.clamp.map(|clamp| clamp.follows);
    let (path, message, hint) = match (support, follows) {
        (Support::Rim, Some(true)) => (
            "setup.fixture.clamp.follows",
            "the clamp goes down with the path, and nothing is under the sheet that holds it up",
            "remove follows, or form over a die: process = { kind = \"tpif\", die = \"male\" }",
        ),
        (Support::DieAndFrame, Some(false)) => (
            "setup.fixture.clamp.follows",
            "the clamp stays, and a sheet over a male die goes down with it",
            "add follows = true to clamp, or leave the clamp out",
        ),
        (Support::DieAndFrame, _) if fixture.backing.is_some() => (
            "setup.fixture.backing",
            "a plate under the sheet, and a sheet over a male die goes down there",
            "remove backing",
        ),
        (Support::Mandrel, _) => (
            "setup.fixture",
            "a fixture, and a sheet on a mandrel is clamped to that and turns with it",
            "remove fixture",
        ),
        (Support::Rim | Support::DieAndFrame, _) => return Ok(()),
    };
    Err(JobError::document("conflict", path, message, hint))
}

fn without_sheet(job: &JobDocument) -> Result<(), JobError> {
    if job.setup.zero == Some(Zero::SheetTop) {
        let message = "zero = \"sheet-top\" without a sheet";
        return Err(JobError::document("conflict", "setup.zero", message, "write \"model\" or a point [x, y, z]"));
    }
    if job.setup.fixture.is_some() {
        let message = "a fixture holds a sheet, and there is none";
        return Err(JobError::document("conflict", "setup.fixture", message, "remove it, or add [setup.sheet]"));
    }
    if job.part.model_face.is_some() {
        let message = "model_face states which face of the sheet the model shows, and there is no sheet";
        return Err(JobError::document("conflict", "part.model_face", message, "remove it, or add [setup.sheet]"));
    }
    Ok(())
}

fn machine(path: &str, section: &MachineSection) -> Result<(), JobError> {
    match (&section.name, &section.file) {
        (Some(_), None) | (None, Some(_)) => Ok(()),
        _ => Err(JobError::document(
            "conflict",
            path,
            "a machine has either a name or a file",
            format!("write name = one of {}", styluscam_post::shipped().join(", ")),
        )),
    }
}

fn tools(job: &JobDocument) -> Result<(), JobError> {
    for (name, tool) in &job.tools {
        if tool.profile.is_some() == tool.library.is_some() {
            let message = format!("tool {name} has either a profile or a library, and needs one");
            let hint = "add profile = { kind = \"ball\", diameter = 10.0 }, or library = \"hemisphere-d10\"";
            return Err(JobError::document("conflict", format!("tools.{name}"), message, hint));
        }
        if tool.length_offset == Some(0) {
            let path = format!("tools.{name}.length_offset");
            let message = "length_offset = 0 means no length offset at all";
            return Err(JobError::document("out-of-range", path, message, "give 1 or more, or leave it out"));
        }
    }
    job.channels().iter().try_for_each(|channel| opposite(job, channel))?;
    job.channels().iter().try_for_each(|channel| tool_numbers(job, channel))
}

/// The tool on the other side of the sheet exists, and a solid is left of it where it goes beyond the face that the model shows.
fn opposite(job: &JobDocument, channel: &str) -> Result<(), JobError> {
    let Some(Opposite { tool, squeeze }) = job.opposite(channel) else { return Ok(()) };
    if !job.tools.contains_key(tool) {
        let known: Vec<&str> = job.tools.keys().map(String::as_str).collect();
        let message = format!("support_tool = {tool:?}: no tool is called that");
        let hint = format!("the job has {}", known.join(", "));
        return Err(JobError::document("unknown", "process.support_tool", message, hint));
    }
    if job.operations.iter().any(|section| section.common.tool == tool) {
        let message = format!("support_tool = {tool:?}: an operation uses that tool, and there are two at a time");
        return Err(JobError::document("conflict", "process.support_tool", message, "add a second tool to [tools]"));
    }
    let sheet = job.setup.sheet.zip(job.part.model_face);
    let sheet = sheet.map(|(section, model_face)| Sheet { thickness: section.thickness, law: section.law, model_face });
    match sheet {
        Some(sheet) if squeeze < sheet.share() && sheet.law == SheetLaw::Constant => {
            let message = format!(
                "squeeze = {squeeze}: the model shows the face that the tool below touches, and in a sheet of constant \
                 thickness that tool would go beyond it"
            );
            let hint = "model the face that the main tool touches (part.model_face = \"tool\"), set law = \"sine\" in \
                        [setup.sheet], or squeeze = 1.0";
            Err(JobError::document("conflict", "process.squeeze", message, hint))
        }
        Some(_) | None => Ok(()),
    }
}

/// No two tools of a machine have one number. A tool that no operation uses could be any machine's.
fn tool_numbers(job: &JobDocument, channel: &str) -> Result<(), JobError> {
    let used_here = |name: &str| job.tools_of(channel).any(|used| used == name);
    let used = |name: &str| job.channels().iter().any(|channel| job.tools_of(channel).any(|used| used == name));
    let mut numbers = std::collections::BTreeMap::new();
    for (name, tool) in job.tools.iter().filter(|(name, _)| used_here(name) || !used(name)) {
        if let Some(other) = numbers.insert(tool.number, name) {
            let message = format!("tools {other} and {name} have the same number {}", tool.number);
            return Err(JobError::document("conflict", format!("tools.{name}.number"), message, "give each its own"));
        }
    }
    Ok(())
}

fn operation(job: &JobDocument, path: &str, section: &OperationSection) -> Result<(), JobError> {
    let common = &section.common;
    if !job.tools.contains_key(&common.tool) {
        return Err(no_tool(job, path, &common.tool));
    }
    if let Some(selection) = &common.faces {
        some_face(&format!("{path}.faces"), selection)?;
    }
    region(job, path, common)?;
    heights(path, common, job.units)?;
    direction(path, common)?;
    fit(job, path, common)?;
    turning(&job.process.process, path, section)?;
    links(job, path, common)?;
    layers(job, path, section)?;
    order(job, path, section)?;
    corners(job, path, section)?;
    stock_to_leave(job, path, common)?;
    spindle::check(job, section, path)?;
    section.kind().check(common, path)
}

/// Stock is left on what is cut.
fn stock_to_leave(job: &JobDocument, path: &str, common: &OperationKeys) -> Result<(), JobError> {
    if !job.process.process.as_kind().takes_sheet() || !common.leaves_stock() {
        return Ok(());
    }
    let message = "stock is left on a part that is cut, and this job forms a sheet";
    let hint = "remove radial_stock_to_leave and axial_stock_to_leave";
    Err(JobError::document("conflict", format!("{path}.radial_stock_to_leave"), message, hint))
}

/// A clearance is that of check faces, and rapids keep it too.
fn region(job: &JobDocument, path: &str, common: &OperationKeys) -> Result<(), JobError> {
    if let Some(boundary) = &common.boundary {
        boundary.check(&format!("{path}.boundary"))?;
    }
    if let Some(CheckSelection::Named(names)) = &common.check_faces {
        some_face(&format!("{path}.check_faces"), &Selection::Named(names.clone()))?;
    }
    let (clearance, path) = match common.check_clearance {
        Some(clearance) => (Some(clearance), format!("{path}.check_clearance")),
        None => (job.part.check_clearance, "part.check_clearance".to_owned()),
    };
    let has_faces = common.check_faces.is_some() || job.part.check_faces.is_some();
    match clearance {
        Some(_) if common.check_clearance.is_some() && !has_faces => {
            let message = "a clearance of check faces, and none are named";
            let hint = "add check_faces = \"rest\" or a list of names, or remove it";
            Err(JobError::document("conflict", path, message, hint))
        }
        Some(clearance) if has_faces && clearance > job.setup.clearance => {
            let [asked, rapids] = [clearance, job.setup.clearance].map(|mm| job.units.shown(mm));
            let message =
                format!("check_clearance = {asked}: rapids cross the part at clearance = {rapids}, nearer than that");
            Err(JobError::document("conflict", path, message, format!("raise setup.clearance to {asked} or more")))
        }
        Some(_) | None => Ok(()),
    }
}

/// Climb and conventional are about a tool that turns.
fn direction(path: &str, common: &OperationKeys) -> Result<(), JobError> {
    let word = match common.direction {
        Direction::Alternate | Direction::Same => return Ok(()),
        Direction::Climb => "climb",
        Direction::Conventional => "conventional",
    };
    if common.spindle.direction().is_some() {
        return Ok(());
    }
    let message = format!("direction = {word:?} needs a tool that turns, and the spindle is off");
    let hint = "set direction = \"same\", or a spindle: spindle = { mode = \"fixed\", rpm = 8000 }";
    Err(JobError::document("conflict", format!("{path}.direction"), message, hint))
}

/// What turns the part takes paths for parts that turn, and nothing else does.
fn turning(process: &Process, path: &str, section: &OperationSection) -> Result<(), JobError> {
    let (name, kind) = (process.name(), section.operation.name());
    let (message, hint) = match (process.as_kind().turns_part(), section.kind().turns_part()) {
        (true, true) | (false, false) => return Ok(()),
        (true, false) => (
            format!("process.kind = {name:?} turns the part, and kind = {kind:?} is for a part that stands"),
            "write kind = \"meridian\"",
        ),
        (false, true) => (
            format!("kind = {kind:?} is for a part that turns, and with process.kind = {name:?} it stands"),
            "write process = { kind = \"spinning\" }",
        ),
    };
    Err(JobError::document("conflict", format!("{path}.kind"), message, hint))
}

/// A tool on the other side of the sheet is planned along straight moves.
fn fit(job: &JobDocument, path: &str, common: &OperationKeys) -> Result<(), JobError> {
    let follows = job.follower().is_some();
    if common.fit == Fit::Lines || !follows {
        return Ok(());
    }
    let kind = job.process.process.name();
    let message = format!("fit = \"arcs\": with process.kind = {kind:?} the tool below follows straight moves");
    Err(JobError::document("conflict", format!("{path}.fit"), message, "write fit = \"lines\""))
}

/// Two tools that keep pace over clearance have no low links.
fn links(job: &JobDocument, path: &str, common: &OperationKeys) -> Result<(), JobError> {
    let follows = job.follower().is_some();
    if common.links == LinkHeight::Clearance || !follows {
        return Ok(());
    }
    let kind = job.process.process.name();
    let message = format!("links = \"low\": with process.kind = {kind:?} both tools cross at clearance");
    Err(JobError::document("conflict", format!("{path}.links"), message, "write links = \"clearance\""))
}

/// Layers are pressed into a sheet that hangs free: a tool below has no contact to follow in them, and no frame goes down with them.
fn layers(job: &JobDocument, path: &str, section: &OperationSection) -> Result<(), JobError> {
    let process = &job.process.process;
    let follows = job.follower().is_some();
    let reason = if !section.kind().forms_in_layers() {
        return Ok(());
    } else if !process.as_kind().forms() {
        "forms no sheet"
    } else if follows {
        "has a tool below that follows contacts, and rows in a layer's plane have none"
    } else if process.as_kind().support() == Support::DieAndFrame {
        "has a frame that goes down from level to level, and rows go up and down"
    } else {
        return Ok(());
    };
    let message = format!("max_increment: process.kind = {:?} {reason}", process.name());
    let hint = "remove max_increment: rows then finish what a z-level or a spiral before them has formed";
    Err(JobError::document("conflict", format!("{path}.max_increment"), message, hint))
}

/// Feeds per revolution, and those with which two tools keep pace, are none that drop at corners.
fn corners(job: &JobDocument, path: &str, section: &OperationSection) -> Result<(), JobError> {
    let follows = job.follower().is_some();
    if !section.common.slow_corners || !(follows || section.kind().turns_part()) {
        return Ok(());
    }
    let kind = job.process.process.name();
    let message = format!("slow_corners: with process.kind = {kind:?} feeds are not in mm/min, and stay as they are");
    Err(JobError::document("conflict", format!("{path}.slow_corners"), message, "remove it"))
}

/// A frame that goes down with the path does not come up again.
fn order(job: &JobDocument, path: &str, section: &OperationSection) -> Result<(), JobError> {
    if !clamp::goes_down(job) || !section.kind().comes_back_up() {
        return Ok(());
    }
    let message =
        "order = \"by-area\": over a male die the frame goes down with the sheet, from level to level".to_owned();
    Err(JobError::document("conflict", format!("{path}.order"), message, "write order = \"by-level\""))
}

/// The error of an operation at `path` whose tool the job does not have.
pub fn no_tool(job: &JobDocument, path: &str, name: &str) -> JobError {
    let known: Vec<&str> = job.tools.keys().map(String::as_str).collect();
    let message = format!("no tool is called {name:?}");
    JobError::document("unknown", format!("{path}.tool"), message, format!("the job has {}", known.join(", ")))
}

fn heights(path: &str, common: &OperationKeys, unit: LengthUnit) -> Result<(), JobError> {
    let (Some(top), Some(bottom)) = (common.z_top, common.z_bottom) else { return Ok(()) };
    if bottom < top {
        return Ok(());
    }
    let message = format!("z_bottom = {} is not below z_top = {}", unit.shown(bottom), unit.shown(top));
    Err(JobError::document("conflict", format!("{path}.z_bottom"), message, "lower z_bottom or raise z_top"))
}

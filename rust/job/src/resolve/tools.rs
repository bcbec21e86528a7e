//! The tools of a job, built and checked.

use std::collections::BTreeMap;

use styluscam_geometry::{Tool, ToolDocument};
use styluscam_motion::{ToolRecord, ToolReference};

use crate::{JobDocument, JobError, ToolSection};

/// The checked tools of a job, by name, and their records.
pub fn tools(job: &JobDocument) -> Result<BTreeMap<String, (Tool, ToolRecord)>, JobError> {
    job.tools.iter().map(|(name, section)| Ok((name.clone(), tool(name, section, job)?))).collect()
}

fn tool(name: &str, section: &ToolSection, job: &JobDocument) -> Result<(Tool, ToolRecord), JobError> {
    let Some(profile) = section.profile.clone() else {
        let path = format!("tools.{name}.library");
        let message = "the tool's file or library has not been read";
        return Err(JobError::document("unresolved", path, message, "read the job from its file, or give a profile"));
    };
    let document = ToolDocument {
        profile,
        base: section.base,
        shank_diameter: section.shank_diameter,
        length: section.length,
        holder: section.holder,
        flutes: section.flutes,
        cutter_material: section.cutter_material,
    };
    let tool = Tool::new(document).map_err(JobError::geometry(format!("tools.{name}")))?;
    let reference_height = match section.reference {
        ToolReference::Tip => 0.0,
        ToolReference::Center => tool.center_height().ok_or_else(|| {
            JobError::document(
                "conflict",
                format!("tools.{name}.reference"),
                format!("reference = \"center\": a {} has no centre", tool.description()),
                "write reference = \"tip\"",
            )
        })?,
    };
    let (_, profile_height) = tool.point_at(tool.profile().max_slope());
    let long = section.length.unwrap_or_else(|| profile_height.max(tool.diameter()));
    if let Some(sheet) = job.setup.sheet.filter(|sheet| sheet.thickness >= long) {
        return Err(JobError::document(
            "conflict",
            "setup.sheet.thickness",
            format!(
                "thickness = {}: the sheet is thicker than tool {name} ({}) is long",
                sheet.thickness,
                tool.description()
            ),
            "give the thickness in mm, or a longer tool with its length",
        ));
    }
    let record = ToolRecord {
        name: name.to_owned(),
        number: section.number,
        length_offset: section.length_offset.unwrap_or(section.number),
        description: tool.description(),
        reference: section.reference,
        reference_height,
        diameter: tool.diameter(),
    };
    Ok((tool, record))
}

/// The tools of a channel in the order of their first use: the order in which planning lists them.
pub fn tools_in_order(job: &JobDocument, channel: &str) -> Result<(Vec<Tool>, Vec<ToolRecord>), JobError> {
    let mut known = tools(job)?;
    Ok(job.tools_of(channel).filter_map(|name| known.remove(name)).unzip())
}

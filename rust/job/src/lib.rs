//! The job document: one schema, filled in alike by CLI, Python and FreeCAD; plans and judges, touches no files.

#![cfg_attr(test, allow(clippy::disallowed_methods))] // what tests expect may come from std

mod body;
mod check;
mod document;
mod error;
mod faces;
mod fixture;
mod heights;
mod judge;
mod materials;
mod model;
mod parse;
mod plan;
mod risk;
mod scene;
mod starter;
mod stopped;
mod summary;
mod units;

pub use body::{Body, Border, FaceLook, Heights, Hollows, Shell, Side, Thickness, Unformable, SIDES};
pub use document::{
    Coolant, Direction, Feeds, JobDocument, LengthUnit, MachineSection, OperationKind, OperationSection, OutputSection,
    PartSection, Process, ProcessSection, Selection, SetupSection, SheetSection, Spindle, Step, ToolSection, Units,
    UpAxis, Zero,
};
pub use error::JobError;
pub use fixture::{plates, BackingSection, ClampSection, FixtureSection, Holder, Opening, Plate};
pub use judge::{coverage, judge, left, needs, read_back, simulate, Judgement};
pub use materials::{materials, Angle, Material};
pub use parse::{from_json, from_toml, schema, tool_from_json};
pub use plan::{plan, OperationSummary, Plan};
pub use risk::Risk;
pub use scene::{Part, Scene};
pub use starter::{fitting_radius, starter, Starter, StarterFace, StarterPart};
pub use summary::Summary;

/// Version of the job document; older ones migrate, newer ones are refused.
pub const JOB_SCHEMA: u32 = 1;

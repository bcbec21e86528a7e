//! The job document: one schema, filled in alike by CLI, Python and FreeCAD; plans and verifies, touches no files.

#![cfg_attr(test, allow(clippy::disallowed_methods))] // what tests expect may come from std

mod advice;
mod axes;
mod body;
mod boundary;
mod check;
mod chuck;
mod clamp;
mod cutting;
mod die;
mod document;
mod earlier;
mod edge_lines;
mod error;
mod estimate;
mod faces;
mod file_units;
mod fixture;
mod forming;
mod heights;
mod holes;
mod judge;
mod level_edges;
mod limits;
mod materials;
mod model;
mod numbers;
mod operations;
mod paired;
mod parse;
mod part;
mod plan;
mod plates;
mod portion;
mod process;
mod region;
mod resolve;
mod risk;
mod scene;
mod schema;
mod selection;
mod shapes;
mod shaping;
mod spindle;
mod starter;
mod stock;
mod stopped;
mod summary;
mod tagged;
#[cfg(test)]
mod tests;
mod timing;
mod units;
mod up_axis;

pub use advice::{walls, Bend, Corner, Wall, Walls};
pub use body::{Body, Border, FaceLook, Heights, Hollows, Shell, Side, Thickness, Unformable, SIDES};
pub use boundary::{BoundaryInside, BoundaryKeys};
pub use chuck::Chuck;
pub use cutting::{
    cutting_data, shipped_texts, with_cutting_data, Cut, CuttingData, CuttingEntry, CuttingMaterial, CuttingTable,
    CuttingWork, Engagement, Filled, MachineLimits, Span,
};
pub use document::{
    JobDocument, LengthUnit, MachineSection, OutputSection, PartSection, SetupSection, SheetSection, ToolSection, Zero,
};
pub use earlier::Earlier;
pub use error::JobError;
pub use estimate::{estimates, Estimate};
pub use file_units::Units;
pub use fixture::{BackingSection, ClampSection, FixtureSection, Opening};
pub use judge::{coverage, earlier, judge, left, needs, read_back, scallops, simulate, Judgement, Text};
pub use materials::{materials, Angle, Material};
pub use operations::{
    BridgedFace, Context, Coolant, Direction, Edges, Effort, End, Fact, Feeds, Operation, OperationKeys, OperationKind,
    OperationSection, PassSpacing, Planned, ReachedFace, Spindle, SurfaceFacts, ZLevel, ZigZag,
};
pub use parse::{from_json, from_toml, tool_from_json, JOB_SCHEMA};
pub use part::{Curves, Part, Shaped};
pub use plan::{plan, Channel, OperationSummary, Plan, Setting};
pub use plates::Holder;
pub use process::{Die, Process, ProcessKeys, ProcessKind, ProcessSection, MAIN_CHANNEL};
pub use risk::Risk;
pub use scene::Scene;
pub use schema::schema;
pub use selection::{CheckSelection, Selection};
pub use shapes::{shapes, standing, Shape, ShapeKind, Travel};
pub use shaping::{
    is_shaped, shaped, AddendumEnd, AddendumKind, AddendumSection, Deviation, MeshPair, SpringbackSection, Stages,
};
pub use starter::{fitting_radius, starter, Starter, StarterFace, StarterOperation, StarterPart};
pub use stock::{BoxStock, CylinderStock, Given, MeshStock, ProgramStock, StockSection};
pub use summary::Summary;
pub use up_axis::UpAxis;

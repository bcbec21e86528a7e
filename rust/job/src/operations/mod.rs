//! The operations of a job: one file a kind, with its own keys, its check, its plan, what the verifier is to expect of it,
//! its words and its starter text.
//!
//! A further kind is one file here and one line in the table below; nothing else names a kind.

use std::sync::LazyLock;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use styluscam_geometry::Tool;
use styluscam_verify::Contact;

use crate::tagged::{self, kinds, Family};
use crate::MAIN_CHANNEL;

mod at_holes;
mod before;
pub(crate) mod budget;
mod clears;
mod context;
mod contour_passes;
mod contour_work;
mod corners;
mod effort;
mod entry;
mod facts;
mod fit;
mod in_order;
mod keys;
mod kind;
mod levels;
mod links;
mod rails;
mod reached;
mod repeated;
mod room;
mod step;
mod surface;
mod tabs;
#[cfg(test)]
mod tests;

pub(crate) use before::Before;
pub(crate) use clears::ENGAGEMENT_DEG;
pub use context::Context;
pub use effort::{Areas, Effort};
pub(crate) use facts::counted;
pub use facts::{BridgedFace, End, Fact, ReachedFace, SurfaceFacts};
pub use keys::{Coolant, Direction, Edges, Feeds, Fit, LeadForm, LinkHeight, OperationKeys, Spindle};
pub use kind::{About, Machining, OperationKind, PassContext, PassSpacing, Planned, Serves, StarterPasses};
pub use tabs::Tabs;

kinds! {
    /// The kinds of operations, each with its own keys.
    Operation: OperationKind, About {
        z_level::ZLevel = "z-level",
        zig_zag::ZigZag = "zig-zag",
        spiral::Spiral = "spiral",
        meridian::Meridian = "meridian",
        pocket::Pocket = "pocket",
        flank::Flank = "flank",
        drill::Drill = "drill",
        helix_bore::HelixBore = "helix-bore",
        constant_scallop::ConstantScallop = "constant-scallop",
        pencil::Pencil = "pencil",
        chamfer::Chamfer = "chamfer",
        contour::Contour = "contour",
    }
}

/// One operation.
///
/// Read from its parted form and written flat: see [`crate::tagged`].
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct OperationSection {
    /// Keys that every kind takes.
    #[serde(rename = "$common")]
    pub common: OperationKeys,
    /// The kind, with its own keys.
    #[serde(rename = "$own")]
    pub operation: Operation,
}

impl OperationSection {
    /// What its kind can do.
    #[must_use]
    pub fn kind(&self) -> &dyn OperationKind {
        self.operation.as_kind()
    }

    /// A tool as it touches the part: with the stock around it that it leaves. What only stays clear keeps away by itself.
    #[must_use]
    pub fn touching(&self, tool: &Tool) -> Tool {
        match self.kind().contact() {
            Contact::Touch => tool.leaving(self.common.stock_to_leave()),
            Contact::Clear => tool.clone(),
        }
    }

    /// The channel whose program does it.
    #[must_use]
    pub fn channel(&self) -> &str {
        self.common.channel.as_deref().unwrap_or(MAIN_CHANNEL)
    }

    /// Its name: its own, or one made of its kind and its number in the job, `index` + 1.
    #[must_use]
    pub fn id(&self, index: usize) -> String {
        match self.common.id.as_str() {
            "" => format!("{}-{}", self.operation.name(), index + 1),
            id => id.to_owned(),
        }
    }
}

impl Serialize for OperationSection {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Flat<'a> {
            #[serde(flatten)]
            operation: &'a Operation,
            #[serde(flatten)]
            common: &'a OperationKeys,
        }
        Flat { operation: &self.operation, common: &self.common }.serialize(serializer)
    }
}

impl JsonSchema for OperationSection {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "OperationSection".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let kinds = Operation::schemas(generator);
        tagged::schema_of(&OperationKeys::json_schema(generator), kinds, None)
    }
}

/// What an item of `[[operations]]` may hold.
pub fn family() -> &'static Family {
    static FAMILY: LazyLock<Family> = LazyLock::new(|| {
        let mut generator = SchemaGenerator::default();
        let kinds = Operation::schemas(&mut generator);
        Family::of("operation", &OperationKeys::json_schema(&mut generator), &kinds, None)
    });
    &FAMILY
}

//! Stock: what the part is cut from, one file a kind.
//!
//! A further kind is one file here and one line in [`StockSection`].

mod block;
mod body;
mod cylinder;
mod kind;
mod program;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use block::BoxStock;
pub use body::MeshStock;
pub use cylinder::CylinderStock;
pub use kind::Given;
pub use program::ProgramStock;

pub(crate) use kind::{Around, StockKind};

/// Stock from which the part is cut.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum StockSection {
    /// A box around the part.
    Box(BoxStock),
    /// An upright cylinder around the part.
    Cylinder(CylinderStock),
    /// A body of any shape in a file.
    Mesh(MeshStock),
    /// What an earlier program left.
    Program(ProgramStock),
}

impl StockSection {
    /// What it answers.
    pub(crate) fn as_kind(&self) -> &dyn StockKind {
        match self {
            Self::Box(kind) => kind,
            Self::Cylinder(kind) => kind,
            Self::Mesh(kind) => kind,
            Self::Program(kind) => kind,
        }
    }
}

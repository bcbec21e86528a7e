//! How the tool goes down into stock, and where.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{circle_outline, Stock};
use styluscam_toolpath::pocket::EntryForm;
use styluscam_verify::ClearedHole;

use super::Context;
use crate::numbers::shown;
use crate::JobError;

/// How much larger than the bound asks for a hole is, for the chords of its circle and of the passes.
const SPARE: f64 = 1.01;

/// The way of the tool down into stock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Entry {
    /// A helix; a ramp where there is room for a small helix only, and more along a line.
    #[default]
    Auto,
    /// Helices.
    Helix,
    /// Zig-zag ramps: to and fro along a line, both ways going down.
    Ramp,
}

impl Entry {
    pub(super) fn form(self) -> EntryForm {
        match self {
            Self::Auto => EntryForm::Auto,
            Self::Helix => EntryForm::Helix,
            Self::Ramp => EntryForm::Ramp,
        }
    }
}

/// A hole that is drilled before.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EntryHole {
    /// Its axis along X, mm in work coordinates.
    #[schemars(extend("x-unit" = "mm", "minimum" = -10000.0, "maximum" = 10000.0))]
    pub x: f64,
    /// Its axis along Y, mm in work coordinates.
    #[schemars(extend("x-unit" = "mm", "minimum" = -10000.0, "maximum" = 10000.0))]
    pub y: f64,
    /// Its diameter, mm.
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub diameter: f64,
    /// Whether the stock comes with it. Else it has to be cut before: by this job, or the one that the stock names.
    #[serde(default)]
    pub in_stock: bool,
}

impl EntryHole {
    /// Its outline: two points with bulges.
    pub(super) fn outline(self) -> Vec<[f64; 3]> {
        circle_outline([self.x, self.y], 0.5 * self.diameter)
    }

    /// It, for the verifier.
    pub(super) fn cleared(self) -> ClearedHole {
        ClearedHole { at: [self.x, self.y], radius: 0.5 * self.diameter, is_in_stock: self.in_stock }
    }

    /// Whether the tool finds its first passes in the hole: a circle of the smallest radius `rho` keeps the material as far away as the bound
    /// `angle` asks for (docs/concepts/pockets.md).
    pub(super) fn check(self, context: &Context<'_>, rho: f64, angle: f64) -> Result<(), JobError> {
        let r = 0.5 * context.tool.diameter();
        let least = 2.0 * SPARE * (rho * rho + r * r + 2.0 * rho * r * libm::cos(angle)).sqrt();
        if self.diameter < least {
            let message = format!("a hole of {} mm is too small for the tool to begin in", shown(self.diameter));
            let at = format!("{}.entry_hole.diameter", context.path);
            let hint =
                format!("drill {least:.2} mm or more, take a smaller tool, or remove entry_hole: then helices go down");
            return Err(JobError::document("out-of-range", at, message, hint));
        }
        let (low, high) = context.scene.stock.as_ref().map_or(context.scene.mesh.bounds(), Stock::bounds);
        let inside = |at: f64, [from, to]: [f64; 2]| at - 0.5 * self.diameter > from && at + 0.5 * self.diameter < to;
        if inside(self.x, [low.x, high.x]) && inside(self.y, [low.y, high.y]) {
            return Ok(());
        }
        Err(self.error(context, "the hole is not within the stock"))
    }

    pub(super) fn error(self, context: &Context<'_>, why: &str) -> JobError {
        let message = format!("{why} (X{} Y{}, {} mm)", shown(self.x), shown(self.y), shown(self.diameter));
        let hint = "move it to where the pocket is widest, or remove entry_hole: then helices go down";
        JobError::document("conflict", format!("{}.entry_hole", context.path), message, hint)
    }
}

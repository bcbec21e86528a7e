//! An upright cylinder.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Stock, Vector};

use super::kind::{Around, StockKind};
use crate::numbers::shown;
use crate::JobError;

/// An upright cylinder around the part, its axis in the middle of the part's box.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CylinderStock {
    /// Its diameter, mm; that of the circle around the part's box, and twice `sides`, when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 10000.0, "x-example" = "60.0"))]
    pub diameter: Option<f64>,
    /// By how much its radius is larger than that of the circle around the part's box, mm.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub sides: f64,
    /// By how much it is higher than the part, mm.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub top: f64,
    /// By how much it is lower than the part, mm.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub bottom: f64,
}

impl StockKind for CylinderStock {
    fn check(&self, path: &str) -> Result<(), JobError> {
        if self.diameter.is_some() && self.sides != 0.0 {
            let message = "the stock's diameter is stated, and sides as well";
            return Err(JobError::document("conflict", format!("{path}.sides"), message, "remove either"));
        }
        Ok(())
    }

    fn around(&self, around: &Around<'_>) -> Result<Stock, JobError> {
        let (low, high) = around.part;
        let middle = 0.5 * (low + high);
        let around = 0.5 * libm::hypot(high.x - low.x, high.y - low.y) + self.sides;
        let radius = self.diameter.map_or(around, |diameter| 0.5 * diameter);
        Ok(Stock::cylinder([middle.x, middle.y], radius, [low.z - self.bottom, high.z + self.top]))
    }

    fn words(&self, _: &Around<'_>, stock: &Stock) -> String {
        let (low, high) = stock.bounds();
        let [diameter, x, y, bottom, top] =
            [high.x - low.x, 0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z, high.z]
                .map(|mm| shown((mm * 1e3).round() / 1e3));
        format!("a cylinder, diameter {diameter}, axis at X{x} Y{y}, Z{bottom} to {top}")
    }

    fn holds(&self, stock: &Stock, point: Vector, within: f64) -> bool {
        let (low, high) = stock.bounds();
        let middle = 0.5 * (low + high);
        libm::hypot(point.x - middle.x, point.y - middle.y) <= 0.5 * (high.x - low.x) + within
    }
}

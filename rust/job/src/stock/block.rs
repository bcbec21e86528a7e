//! A box: so much larger than the part's, or between two corners.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Stock, Vector};

use super::kind::{extent, Around, StockKind};
use crate::JobError;

/// A box around the part: so much larger than the part's box, or between two corners.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BoxStock {
    /// By how much it is larger than the part's box on each of the four sides, mm.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub sides: f64,
    /// By how much it is higher than the part, mm.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub top: f64,
    /// By how much it is lower than the part, mm.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub bottom: f64,
    /// Its lower corner in work coordinates, [x, y, z]; with `high`, instead of the three allowances.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = -100000.0, "maximum" = 100000.0, "x-example" = "[-5.0, -5.0, -20.0]"))]
    pub low: Option<[f64; 3]>,
    /// Its upper corner in work coordinates.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = -100000.0, "maximum" = 100000.0, "x-example" = "[105.0, 65.0, 2.0]"))]
    pub high: Option<[f64; 3]>,
}

impl StockKind for BoxStock {
    fn check(&self, path: &str) -> Result<(), JobError> {
        let missing = match (self.low, self.high) {
            (None, None) => return Ok(()),
            (Some(_), None) => "high",
            (None, Some(_)) => "low",
            (Some(low), Some(high)) => return self.check_corners(path, low, high),
        };
        let message = format!("one corner of the stock is stated, and {missing} is not");
        Err(JobError::document("missing", format!("{path}.{missing}"), message, format!("add {missing} = [x, y, z]")))
    }

    fn around(&self, around: &Around<'_>) -> Result<Stock, JobError> {
        let (low, high) = around.part;
        Ok(match (self.low, self.high) {
            (Some(low), Some(high)) => Stock::of_box(low.into(), high.into()),
            _ => Stock::of_box(
                low - Vector::new(self.sides, self.sides, self.bottom),
                high + Vector::new(self.sides, self.sides, self.top),
            ),
        })
    }

    fn words(&self, _: &Around<'_>, stock: &Stock) -> String {
        format!("a box, {}", extent(stock))
    }

    fn holds(&self, stock: &Stock, point: Vector, within: f64) -> bool {
        let (low, high) = stock.bounds();
        (0..2).all(|i| (low[i] - within..=high[i] + within).contains(&point[i]))
    }
}

impl BoxStock {
    fn check_corners(&self, path: &str, low: [f64; 3], high: [f64; 3]) -> Result<(), JobError> {
        let allowances = [("sides", self.sides), ("top", self.top), ("bottom", self.bottom)];
        if let Some((key, _)) = allowances.into_iter().find(|(_, stated)| *stated != 0.0) {
            let message = format!("the stock's corners are stated, and {key} as well");
            let hint = format!("remove {key}, or low and high");
            return Err(JobError::document("conflict", format!("{path}.{key}"), message, hint));
        }
        if low.iter().zip(&high).any(|(low, high)| low >= high) {
            let message = format!("low = {low:?} is not below and before high = {high:?}");
            return Err(JobError::document("conflict", format!("{path}.low"), message, "correct the corners"));
        }
        Ok(())
    }
}

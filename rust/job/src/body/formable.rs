//! Whether a sheet that is clamped at its border can be pushed down to a shape.

use super::Body;

/// No known material withstands steeper walls in one pass, degrees.
pub const FORMED_DEG: f64 = 70.0;
/// Share of the area that may be steeper: the sheet's own rim.
const RIM: f64 = 0.03;
/// What is less steep is level, degrees.
const LEVEL_DEG: f64 = 1.0;
/// Share of the area that slopes, at least: where floors lie at several heights and nothing slopes, walls between them are upright.
const SLOPING: f64 = 0.01;
/// Share of the plan that may stand above the border: embossed areas.
const EMBOSSED: f64 = 0.02;
/// A sheet that is not deeper than this many thicknesses is flat.
const FLAT: f64 = 2.0;
/// A surface without thickness that is not deeper than this is flat, mm.
const FLAT_SURFACE: f64 = 0.2;
/// Two heights are one within this share of the depth: a border is not exactly level.
const SAME: f64 = 0.03;

/// Why a shape is not formed from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unformable {
    /// Nothing of it is seen from above.
    Unseen,
    /// It is flat.
    Flat,
    /// Its border lies this far below its highest point, mm.
    LowBorder {
        /// mm.
        below: f64,
        /// Whether it would lie at the highest point if the shape were turned over.
        is_lowest: bool,
    },
    /// This share of its area is steeper than [`FORMED_DEG`].
    Steep(f64),
    /// Its floors lie at several heights, and no wall between them slopes.
    Stepped,
}

impl std::fmt::Display for Unformable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unseen => write!(f, "nothing of it is seen from above"),
            Self::Flat => write!(f, "it is flat, and there is nothing to form"),
            Self::LowBorder { below, .. } => write!(
                f,
                "its border, where a sheet is clamped, lies {below:.1} mm below its highest point, and the tool only \
                 pushes down"
            ),
            Self::Steep(share) => {
                write!(f, "{:.0} % of it are walls of {FORMED_DEG} degrees and more, which tear a sheet", 100.0 * share)
            }
            Self::Stepped => {
                write!(f, "its floors lie at several heights with upright walls between, which tear a sheet")
            }
        }
    }
}

impl Body<'_> {
    /// How deep a sheet of a `thickness` (none: a surface without) goes down from its border, mm, where it can be formed
    /// from above.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn formed_depth(&self, thickness: Option<f64>) -> Result<f64, Unformable> {
        self.shaped_depth(thickness, true)
    }

    /// How far a sheet of a `thickness` (none: a surface without) goes down from the top of a male die of this shape, mm: its
    /// border goes down with the frame, and may lie as low as it likes.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn laid_depth(&self, thickness: Option<f64>) -> Result<f64, Unformable> {
        self.shaped_depth(thickness, false)
    }

    fn shaped_depth(&self, thickness: Option<f64>, clamped: bool) -> Result<f64, Unformable> {
        let heights = self.heights();
        let depth = heights.top - heights.bottom;
        let border = heights.border.ok_or(Unformable::Unseen)?;
        if depth < thickness.map_or(FLAT_SURFACE, |t| FLAT * t) {
            return Err(Unformable::Flat);
        }
        let below = heights.top - border.middle;
        let same = thickness.unwrap_or(0.0) + SAME * depth;
        if clamped && below > same && border.above > EMBOSSED {
            return Err(Unformable::LowBorder { below, is_lowest: border.middle - heights.bottom <= same });
        }
        let steep = self.steeper(FORMED_DEG);
        if steep > RIM {
            return Err(Unformable::Steep(steep));
        }
        if self.steeper(LEVEL_DEG) - steep < SLOPING {
            return Err(Unformable::Stepped);
        }
        Ok(depth)
    }
}

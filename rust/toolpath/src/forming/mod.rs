//! Strategies that follow the envelope: Z-levels, spirals and zig-zag.

mod bounds;
mod contour;
mod extra_rows;
mod floors;
mod gaps;
mod grid;
mod left_out;
mod level_curve;
mod levels;
mod line;
mod nesting;
mod pattern;
mod ramps;
mod reach;
mod sides;
mod spiral;
mod square;
mod stances;
mod stitch;
mod trace;
mod untouched;
mod walls;
mod waterlines;
mod z_level;
mod zig_zag;

pub use floors::Floors;
pub use grid::Grid;
pub use left_out::left_out;
pub use levels::{levels, raise_last, with_levels_at, LevelRange};
pub use line::over_line;
pub use ramps::{ramped, Ramp};
pub use reach::selected_range;
pub use spiral::spirals;
pub use waterlines::waterlines;
pub use z_level::{z_levels, z_levels_beside};
pub use zig_zag::{zig_zag, Rows};

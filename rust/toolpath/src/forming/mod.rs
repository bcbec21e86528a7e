//! Strategies that ride on the envelope: Z-levels and zig-zag.

mod bounds;
mod contour;
mod floors;
mod grid;
mod level_curve;
mod levels;
mod reach;
mod sides;
mod square;
mod stances;
mod trace;
mod walls;
mod z_level;
mod zig_zag;

pub use floors::Floors;
pub use grid::Grid;
pub use levels::{levels, LevelRange};
pub use reach::selected_range;
pub use z_level::z_levels;
pub use zig_zag::{zig_zag, Rows};

//! From the document to what plans and verifications are made with: channels, scenes, tools, faces and heights.

mod channels;
mod operation;
mod region;
mod scene;
mod stock;
mod tools;

pub use channels::check as check_channels;
pub use operation::{check_part, descent_of, faces_in, faces_of, heights_of, layers_of, passes_of, selection_of};
pub use region::region_of;
pub use stock::check as check_stock;
pub use tools::{tools, tools_in_order};

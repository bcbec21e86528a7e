//! From the document to what plans and verifications are made with: channels, scenes, tools, faces and heights.

mod channels;
mod operation;
mod scene;
mod tools;

pub use channels::check as check_channels;
pub use operation::{faces_in, faces_of, heights_of, selection_of};
pub use tools::{tools, tools_in_order};

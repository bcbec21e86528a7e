//! The push-cutter: how far a tool goes along a horizontal line before it touches, and where it comes free again.
//!
//! After OpenCAMLib's push-cutter (A. Wallin and others, github.com/aewallin/opencamlib), here for any convex profile; waterlines
//! from it: C.-M. Chuang, H.-T. Yau, "A new approach to z-level contour machining of triangulated surface models using fillet
//! endmills", Computer-Aided Design 37, 2005. Derivation: docs/concepts/push-cutter.md.

mod release;
mod search;

pub use release::{release, Line, Release};
pub use search::first;

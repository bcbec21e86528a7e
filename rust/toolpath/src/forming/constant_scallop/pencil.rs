//! Passes along the hollow creases of the envelope: the tool touches two faces there, and bridges what is between them.

use styluscam_geometry::ToolBody;
use styluscam_motion::Watch;

use super::creases::Creases;
use super::stations::Spacing;
use super::{followed, over};
use crate::{Pass, PlanError, Surface};

/// What is asked of pencil passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PencilRule {
    /// The least angle between the faces' normals where the tool touches them, rad.
    pub least_turn: f64,
    /// Largest distance between nodes, mm.
    pub spacing: f64,
    /// What is narrower may be missed, mm.
    pub narrow: f64,
}

/// The passes along all hollow creases over the selected faces, each a group of its own.
///
/// `body` is the tool with the sheet that it touches; chords deviate by at most `deviation` mm along the normal.
///
/// # Errors
/// Nothing to touch, `Cancelled`.
pub fn pencil(
    surface: &Surface<'_>,
    body: &ToolBody,
    rule: &PencilRule,
    deviation: f64,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    let net = over(surface, Spacing::new(body, deviation), rule.spacing, watch)?;
    let net = net.ok_or_else(|| PlanError::NothingReached(String::new()))?;
    let creases = Creases::of_turn(&net, rule.least_turn);
    let lines: Vec<_> = creases.lines(surface, 2.0 * rule.spacing).into_iter().enumerate().collect();
    followed(&surface.keeping_witnesses(), &lines, rule.narrow, deviation, watch)
}

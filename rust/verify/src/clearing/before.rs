//! What the programs and operations before one have swept of a layer.

use styluscam_geometry::{Cutter, Tool};

use super::own::Own;
use crate::before::{Before, Stretch};
use crate::earlier::stretches;
use crate::engagement::Swept;
use crate::expectation::Clearing;
use crate::segments::Segment;
use crate::tolerances::SAME_LEVEL;

/// The moves that took of the stock before those of an operation: those of earlier programs, and where it clears rest material those before it in
/// its own.
pub(super) struct Took<'a> {
    earlier: Option<&'a Before>,
    own: Vec<Stretch>,
    tools: &'a [Tool],
}

impl<'a> Took<'a> {
    pub fn of(
        earlier: Option<&'a Before>,
        (segments, tools): (&[Segment], &'a [Tool]),
        own: &[Own],
        clearing: &Clearing,
    ) -> Self {
        let first = own.iter().map(|own| own.segment.index).min().filter(|_| clearing.rest).unwrap_or(0);
        let before = segments.iter().filter(|segment| segment.index < first);
        Self { earlier, own: before.flat_map(stretches).collect(), tools }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.own.is_empty() && self.earlier.is_none()
    }

    /// What they sweep of the layer from its top to its floor, as it looks under its top: feeds on which the tip is as low as the floor.
    pub fn cleared(&self, layer: [f64; 2]) -> Vec<Swept> {
        let of_programs = self.earlier.iter().flat_map(|before| swept(&before.stretches, &before.tools, layer));
        of_programs.chain(swept(&self.own, self.tools, layer)).collect()
    }
}

fn swept<'s>(stretches: &'s [Stretch], tools: &'s [Tool], [top, floor]: [f64; 2]) -> impl Iterator<Item = Swept> + 's {
    let cutters: Vec<Cutter> = tools.iter().map(Tool::cutter).collect();
    stretches.iter().filter(|stretch| !stretch.is_rapid).filter_map(move |stretch| {
        let start = stretch.start?;
        let highest = start[2].max(stretch.end[2]);
        let cutter = cutters.get(stretch.tool?).filter(|_| highest <= floor + SAME_LEVEL)?;
        let bulge = stretch.bend.map_or(0.0, |bend| bend.bulge());
        let points = vec![[start[0], start[1], bulge], [stretch.end[0], stretch.end[1], 0.0]];
        Some(Swept { points, radius: cutter.at_height(top - highest).0 })
    })
}

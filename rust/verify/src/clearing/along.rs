//! What an operation that clears engages and removes along its feed moves: the measurement of [`super::judged`], handed out.

use super::layer::{Doing, Inside, Layer};
use super::work::Work;
use crate::engaged::{ClearedLayer, ClearingKind, ClearingMove, EngagedAt, OperationEngagement};
use crate::engagement::Engaged;
use crate::segments::SegmentKind;

/// What is known of an operation so far.
pub(super) struct Along {
    engagement: OperationEngagement,
    /// Length of the operation's feed moves up to start and end of each move, mm.
    ends: Vec<[f64; 2]>,
    moves: Vec<Option<ClearingMove>>,
}

/// The same of one layer.
pub(super) struct LayerAlong {
    layer: ClearedLayer,
    /// By the number among the operation's moves.
    moves: Vec<(usize, ClearingMove)>,
}

impl Along {
    pub fn new(work: &Work<'_>) -> Self {
        let mut length = 0.0;
        let ends = work.own.iter().map(|own| {
            let start = length;
            if own.segment.kind != SegmentKind::Rapid {
                length += own.segment.length();
            }
            [start, length]
        });
        let ends: Vec<[f64; 2]> = ends.collect();
        let engagement = OperationEngagement {
            operation: work.operation.id.clone(),
            angle: work.clearing.angle,
            length,
            layers: Vec::new(),
            moves: Vec::new(),
        };
        Self { engagement, moves: vec![None; ends.len()], ends }
    }

    /// What was measured in a layer, by the move's number.
    pub fn of_layer(&self, number: usize, layer: &Layer<'_>, inside: &[Inside<'_>], work: &Work<'_>) -> LayerAlong {
        let moves = inside.iter().filter_map(|inside| {
            let index = work.own.partition_point(|own| own.segment.index < inside.own.segment.index);
            Some((index, layer.along(inside, number, *self.ends.get(index)?)?))
        });
        LayerAlong { layer: layer.described(), moves: moves.collect() }
    }

    /// Adds the next layer: each move is in the one in which it ends.
    pub fn add(&mut self, LayerAlong { layer, moves }: LayerAlong) {
        for (index, found) in moves {
            if let Some(known @ None) = self.moves.get_mut(index) {
                *known = Some(found);
            }
        }
        self.engagement.layers.push(layer);
    }

    pub fn finished(self) -> OperationEngagement {
        OperationEngagement { moves: self.moves.into_iter().flatten().collect(), ..self.engagement }
    }
}

impl Layer<'_> {
    fn described(&self) -> ClearedLayer {
        let Self { top, floor, radius, .. } = *self;
        let reference = (top - floor) * self.operation.cut * self.full(self.clearing.angle);
        ClearedLayer { top, floor, radius, reference }
    }

    /// A move with its positions; none of one that goes on below the layer, or is a rapid.
    fn along(&self, inside: &Inside, layer: usize, travelled: [f64; 2]) -> Option<ClearingMove> {
        let kind = match inside.doing {
            Doing::Runs => ClearingKind::Cut,
            Doing::Links => ClearingKind::Link,
            Doing::Enters => ClearingKind::Entry,
            Doing::Rapid | Doing::Below => return None,
        };
        let segment = inside.own.segment;
        let in_plan: f64 = inside.centres().iter().map(|piece| piece.length()).sum();
        let position = |measure: &Engaged| {
            let share = if in_plan > 0.0 { (measure.travelled / in_plan).min(1.0) } else { 1.0 };
            let ([x, y], [_, _, z]) = (measure.at, segment.at(share));
            EngagedAt {
                travelled: travelled[0] + share * segment.length(),
                tip: [x, y, z],
                angle: measure.angle,
                stepover: measure.width,
            }
        };
        Some(ClearingMove {
            line: segment.line,
            layer,
            kind,
            travelled,
            feed: inside.own.feed,
            rounding: self.radius * self.heading_error(segment),
            positions: inside.measures.iter().map(position).collect(),
        })
    }
}

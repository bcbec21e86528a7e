//! Moves and events in the order in which the machine meets them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    Cycle, Event, EventKind, Move, NotUnit, OperationRecord, SetupRecord, ToolRecord, UnitAxis, Upcoming,
    PROGRAM_SCHEMA,
};

/// A whole program of one channel.
///
/// The first move goes to a known point from wherever the machine stands: its posted form goes
/// up first, then across. Later moves start where the one before them ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Document")]
pub struct Program {
    /// Version of this document.
    pub schema: u32,
    /// Where the work's zero is and what surrounds it.
    pub setup: SetupRecord,
    /// Tools in the order of their first use.
    pub tools: Vec<ToolRecord>,
    /// Operations in order.
    pub operations: Vec<OperationRecord>,
    /// All moves in order.
    pub moves: Vec<Move>,
    /// Events in order of `before`.
    pub events: Vec<Event>,
    /// Moves and events that a controller's canned cycle makes, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cycles: Vec<Cycle>,
}

/// A program document of any version that is read. Schema 1 had the tool's axes in a list beside the moves.
#[derive(Deserialize, JsonSchema)]
struct Document {
    schema: u32,
    setup: SetupRecord,
    tools: Vec<ToolRecord>,
    operations: Vec<OperationRecord>,
    moves: Vec<Move>,
    events: Vec<Event>,
    #[serde(default)]
    cycles: Vec<Cycle>,
    /// One unit vector for each move, or none at all: +Z throughout.
    #[serde(default)]
    axes: Vec<[f64; 3]>,
}

/// Why the list of axes of an earlier document cannot be read.
#[derive(Debug)]
enum AxesError {
    Count { axes: usize, moves: usize },
    Vector { index: usize, error: NotUnit },
}

impl std::fmt::Display for AxesError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Count { axes, moves } => write!(f, "{axes} axes for {moves} moves: one for each move, or none"),
            Self::Vector { index, error } => write!(f, "axes[{index}]: {error}"),
        }
    }
}

impl TryFrom<Document> for Program {
    type Error = AxesError;

    fn try_from(document: Document) -> Result<Self, AxesError> {
        let Document { schema, setup, tools, operations, mut moves, events, cycles, axes } = document;
        if !axes.is_empty() && axes.len() != moves.len() {
            return Err(AxesError::Count { axes: axes.len(), moves: moves.len() });
        }
        for (index, (step, axis)) in moves.iter_mut().zip(axes).enumerate() {
            step.end.axis = UnitAxis::new(axis).map_err(|error| AxesError::Vector { index, error })?;
        }
        Ok(Self { schema, setup, tools, operations, moves, events, cycles })
    }
}

/// A move in the machine's own coordinates (G53): where that is in the work is not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineMove {
    /// Index of the move before which it comes.
    pub before: usize,
    /// Line of the text, from 1.
    pub line: u32,
    /// Where it goes, machine coordinates, mm; none for axes that stay.
    pub coordinates: [Option<f64>; 3],
}

impl Program {
    /// A program without motion.
    #[must_use]
    pub fn empty(setup: SetupRecord, tools: Vec<ToolRecord>, operations: Vec<OperationRecord>) -> Self {
        let (moves, events, cycles) = Default::default();
        Self { schema: PROGRAM_SCHEMA, setup, tools, operations, moves, events, cycles }
    }

    /// The moves paired with the point where each starts; the first has none.
    pub fn segments(&self) -> impl Iterator<Item = (Option<[f64; 3]>, &Move)> {
        let starts = std::iter::once(None).chain(self.moves.iter().map(|m| Some(m.end.tip)));
        starts.zip(&self.moves)
    }

    /// The events, to be taken in step with the moves.
    #[must_use]
    pub fn upcoming(&self) -> Upcoming<'_> {
        Upcoming::of(&self.events)
    }

    /// The boxes in which the posted points stay, the tools' references, move by move: lowest and highest coordinates, mm.
    ///
    /// Until a tool is called the first one is taken to be loaded.
    pub fn posted_boxes(&self) -> impl Iterator<Item = ([f64; 3], [f64; 3])> + '_ {
        let above = |tool: usize| self.tools.get(tool).map_or(0.0, |tool| tool.reference_height);
        let mut upcoming = self.upcoming();
        let mut height = above(0);
        self.segments().enumerate().map(move |(index, (start, step))| {
            for event in upcoming.before(index) {
                if let EventKind::ToolChange { tool } = event {
                    height = above(*tool as usize);
                }
            }
            let (low, high) = step.bounds(start);
            let lifted = |[x, y, z]: [f64; 3]| [x, y, z + height];
            (lifted(low), lifted(high))
        })
    }

    /// Points along the program and the move that each belongs to: the ends of all moves, and along arcs so many more that
    /// no chord is farther than `sag` mm from its arc.
    pub fn polyline(&self, sag: f64) -> impl Iterator<Item = ([f64; 3], usize)> + '_ {
        self.segments().enumerate().flat_map(move |(index, (start, step))| {
            let path = start.and_then(|start| step.path(start));
            let count = path.map_or(1, |arc| arc.chords(sag));
            (1..=count).map(move |i| match path {
                Some(arc) if i < count => (arc.at(i as f64 / count as f64), index),
                _ => (step.end.tip, index),
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arc, Plane};

    fn document(axes: &str) -> serde_json::Result<Program> {
        let setup = serde_json::to_string(&SetupRecord::default()).unwrap();
        let moves = r#"[{"kind":"rapid","end":[0.0,0.0,5.0],"feed":0.0,"operation":0},
                        {"kind":"feed","end":[0.0,0.0,-1.0],"feed":100.0,"operation":0}]"#;
        serde_json::from_str(&format!(
            r#"{{"schema":1,"setup":{setup},"tools":[],"operations":[],"moves":{moves},"events":[]{axes}}}"#
        ))
    }

    #[test]
    fn axes_of_earlier_documents_move_to_the_moves() {
        let tilted = UnitAxis::new([0.6, 0.0, 0.8]).unwrap();
        let program = document(r#","axes":[[0.0,0.0,1.0],[0.6,0.0,0.8]]"#).unwrap();
        let moves = [Move::rapid([0.0, 0.0, 5.0]), Move::feed([0.0, 0.0, -1.0], 100.0).with_axis(tilted)];
        assert_eq!(program.moves, moves);
        assert_eq!(serde_json::from_str::<Program>(&serde_json::to_string(&program).unwrap()).unwrap(), program);
    }

    #[test]
    fn a_document_without_axes_is_upright_and_written_as_it_was_read() {
        let program = document("").unwrap();
        assert!(program.moves.iter().all(|step| step.end.axis == UnitAxis::UP));
        assert!(!serde_json::to_string(&program).unwrap().contains("\"ax"));
    }

    #[test]
    fn axes_that_do_not_fit_are_refused() {
        let error = |axes: &str| document(axes).unwrap_err().to_string();
        assert!(error(r#","axes":[[0.0,0.0,1.0]]"#).contains("1 axes for 2 moves"));
        assert!(error(r#","axes":[[0.0,0.0,1.0],[0.0,0.0,0.5]]"#).contains("axes[1]"));
    }

    fn with_moves(tools: Vec<ToolRecord>, moves: Vec<Move>) -> Program {
        Program { moves, ..Program::empty(SetupRecord::default(), tools, Vec::new()) }
    }

    #[test]
    fn a_polyline_has_the_ends_of_lines_and_keeps_to_arcs() {
        let arc = Arc { centre: [0.0; 3], plane: Plane::Xy, clockwise: false, turns: 0 };
        let moves =
            vec![Move::rapid([2.0, 0.0, 0.0]), Move::feed([0.0, 2.0, 0.0], 100.0).arc(arc), Move::rapid([9.0; 3])];
        let points: Vec<([f64; 3], usize)> = with_moves(Vec::new(), moves).polyline(0.01).collect();
        assert_eq!((points[0], points[points.len() - 1]), (([2.0, 0.0, 0.0], 0), ([9.0; 3], 2)));
        // a chord of 0.01 mm below a circle of 2 mm spans 0.2 rad: eight of them in a quarter
        assert_eq!(points.len(), 1 + 8 + 1);
        for (point, owner) in &points[..9] {
            assert!((point[0].hypot(point[1]) - 2.0).abs() < 1e-12 && *owner <= 1, "{point:?}");
        }
    }

    #[test]
    fn posted_boxes_rise_with_the_reference_of_the_tool_that_is_loaded() {
        let tool = |reference_height| ToolRecord {
            name: String::new(),
            number: 1,
            length_offset: 1,
            description: String::new(),
            reference: crate::ToolReference::Center,
            reference_height,
            diameter: 6.0,
        };
        let moves = vec![Move::rapid([0.0; 3]), Move::feed([1.0, 0.0, -1.0], 100.0)];
        let mut program = with_moves(vec![tool(3.0), tool(5.0)], moves);
        program.events = vec![Event { before: 1, kind: EventKind::ToolChange { tool: 1 } }];
        let boxes: Vec<_> = program.posted_boxes().collect();
        assert_eq!(boxes, [([0.0, 0.0, 3.0], [0.0, 0.0, 3.0]), ([1.0, 0.0, 4.0], [1.0, 0.0, 4.0])]);
    }
}

//! The moves of leaning tools.

use styluscam_geometry::Vector;
use styluscam_motion::{EventKind, MoveKind, Program};

use crate::assignment::Assignment;
use crate::segments::{is_in_range, Segment, SegmentKind};
use crate::subject::Subject;

/// A tool's tip, mm, and the unit vector from there up its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    pub tip: Vector,
    pub axis: Vector,
}

impl Pose {
    fn of(pose: &styluscam_motion::Pose) -> Self {
        Self { tip: pose.tip.into(), axis: Vector::from(pose.axis.vector()).normalize() }
    }

    /// Part of the way to another.
    pub fn towards(&self, next: &Self, share: f64) -> Self {
        let axis = self.axis + (next.axis - self.axis) * share;
        Self { tip: self.tip + (next.tip - self.tip) * share, axis: axis.normalize() }
    }

    /// In which the tool stands upright.
    pub fn frame(&self) -> ToolFrame {
        let axis = self.axis;
        let aside = if axis.x.abs() < 0.9 { Vector::x() } else { Vector::y() };
        let first = (aside - axis * axis.dot(&aside)).normalize();
        ToolFrame { first, second: axis.cross(&first), axis }
    }

    /// How far a point of the tool that is `height` up its axis is at most from where it is in another, mm.
    pub fn apart(&self, other: &Self, height: f64) -> f64 {
        (self.tip - other.tip).norm().max((self.tip + self.axis * height - other.tip - other.axis * height).norm())
    }
}

/// Directions of the part that are X, Y and Z to a tool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToolFrame {
    first: Vector,
    second: Vector,
    axis: Vector,
}

impl ToolFrame {
    /// A direction of the part, as the tool sees it.
    pub fn turned(&self, v: Vector) -> Vector {
        Vector::new(self.first.dot(&v), self.second.dot(&v), self.axis.dot(&v))
    }

    /// A direction that the tool sees, in the part.
    pub fn back(&self, v: Vector) -> Vector {
        self.first * v.x + self.second * v.y + self.axis * v.z
    }
}

/// A move that begins or ends with a tool that leans, or that of an operation whose tool may.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeaningMove {
    /// Its number in the program.
    pub index: usize,
    pub line: u32,
    /// The program's number of its operation, and the job's.
    pub operation: u32,
    pub expected: Option<usize>,
    pub kind: MoveKind,
    /// mm/min.
    pub feed: f64,
    /// Whether it runs along a pass.
    pub is_along_pass: bool,
    pub tool: Option<usize>,
    /// Where it begins, where that is known.
    pub from: Option<Pose>,
    pub to: Pose,
}

impl LeaningMove {
    /// As a move of an upright tool.
    pub fn segment(&self) -> Segment {
        Segment {
            index: self.index,
            operation: self.operation,
            expected: self.expected,
            kind: match self.kind {
                MoveKind::Rapid => SegmentKind::Rapid,
                MoveKind::Feed if self.comes_down() => SegmentKind::Plunge,
                MoveKind::Feed => SegmentKind::Lateral,
            },
            start: self.from.map(|pose| pose.tip.into()),
            end: self.to.tip.into(),
            bend: None,
            line: self.line,
            tool: self.tool,
            excess: None,
            pieces: 1,
        }
    }

    /// Whether it goes down along the tool's axis.
    fn comes_down(&self) -> bool {
        self.from.is_some_and(|from| {
            let way = self.to.tip - from.tip;
            way.dot(&self.to.axis) < 0.0 && way.cross(&self.to.axis).norm() <= STRAIGHT * way.norm()
        })
    }
}

/// The sine of the angle between a way and an axis along it: coordinates are rounded.
const STRAIGHT: f64 = 1e-2;

/// The moves that begin or end with a tool that leans, and all of operations whose tool may lean, in order.
pub(crate) fn leaning_moves(program: &Program, assignment: &Assignment, subject: &Subject) -> Vec<LeaningMove> {
    let mut upcoming = program.upcoming();
    let known_tool = |tool: usize| Some(tool).filter(|tool| *tool < subject.tools.len());
    let mut tool = known_tool(0);
    let mut before: Option<styluscam_motion::Pose> = None;
    let mut moves = Vec::new();
    for (index, step) in program.moves.iter().enumerate() {
        for event in upcoming.before(index) {
            if let EventKind::ToolChange { tool: called } = event {
                tool = known_tool(*called as usize);
            }
        }
        let known = subject.is_known(index) && is_in_range(step.end.tip);
        let leans = !step.end.axis.is_up() || before.is_some_and(|before| !before.axis.is_up());
        if known && (leans || assignment.leans(step.operation)) {
            moves.push(LeaningMove {
                index,
                line: step.line,
                operation: step.operation,
                expected: assignment.number_of(step.operation),
                kind: step.kind,
                feed: step.feed,
                is_along_pass: step.kind == MoveKind::Feed && step.is_along_pass(),
                tool,
                from: before.as_ref().map(Pose::of),
                to: Pose::of(&step.end),
            });
        }
        before = known.then_some(step.end);
    }
    moves
}

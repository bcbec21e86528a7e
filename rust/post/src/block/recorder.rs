//! The program that comes of the blocks that are carried out.

use std::collections::HashMap;

use styluscam_motion::{
    Event, EventKind, Move, MoveKind, OperationRecord, Program, Role, SetupRecord, ToolRecord, ToolReference,
};

/// A program that grows move by move.
pub(crate) struct Recorder {
    pub program: Program,
    /// Index of the tool in the spindle.
    pub tool: Option<u32>,
    /// Indices of the tools, by number.
    tools: HashMap<u32, u32>,
    /// Id and kind of the operation that begins with the next move, where the text states them.
    label: Option<(String, String)>,
    operation_due: bool,
    /// What the next feed moves are for.
    role: Option<Role>,
}

impl Recorder {
    /// With the tools that are known before, and the number of moves to reserve memory for.
    pub fn new(tools: &[ToolRecord], typical_moves: usize) -> Self {
        let moves = Vec::with_capacity(typical_moves);
        let mut indices = HashMap::new();
        for (tool, index) in tools.iter().zip(0..) {
            indices.entry(tool.number).or_insert(index);
        }
        Self {
            program: Program { moves, ..Program::empty(SetupRecord::default(), tools.to_vec(), Vec::new()) },
            tool: None,
            tools: indices,
            label: None,
            operation_due: true,
            role: None,
        }
    }

    /// What the next feed moves are for, as far as their operation goes.
    pub fn set_role(&mut self, role: Option<Role>) {
        self.role = role;
    }

    pub fn event(&mut self, kind: EventKind) {
        self.program.events.push(Event { before: self.program.moves.len(), kind });
    }

    /// The next move begins an operation of this id and kind.
    pub fn start_operation(&mut self, id: &str, kind: &str) {
        self.label = Some((id.into(), kind.into()));
        self.operation_due = true;
        self.role = None;
    }

    /// The index of a tool that is known.
    pub fn known_tool(&self, number: u32) -> Option<u32> {
        self.tools.get(&number).copied()
    }

    /// The index of a tool; one that is not known is added, with its number alone.
    pub fn tool_of_number(&mut self, number: u32) -> u32 {
        let tools = &mut self.program.tools;
        *self.tools.entry(number).or_insert_with(|| {
            tools.push(bare_tool(number));
            u32::try_from(tools.len() - 1).unwrap_or(u32::MAX)
        })
    }

    /// The tool of this index is in the spindle; the next move begins an operation.
    pub fn load(&mut self, index: u32) {
        self.tool = Some(index);
        self.operation_due = true;
        self.role = None;
    }

    /// Adds a move, to the operation that it belongs to.
    pub fn push(&mut self, step: Move) {
        let operation = self.operation();
        let role = self.role.filter(|_| step.kind == MoveKind::Feed);
        self.program.moves.push(Move { role, ..step.of_operation(operation) });
    }

    fn operation(&mut self) -> u32 {
        if self.operation_due {
            self.operation_due = false;
            let tool = self.tool.unwrap_or_else(|| self.tool_of_number(0));
            self.tool = Some(tool);
            let number = self.program.tools.get(tool as usize).map_or(0, |tool| tool.number);
            let count = self.program.operations.len() + 1;
            let (id, kind) = self.label.take().unwrap_or_else(|| (format!("{count}-T{number}"), "text".into()));
            self.program.operations.push(OperationRecord { id, kind, tool });
        }
        u32::try_from(self.program.operations.len().saturating_sub(1)).unwrap_or(u32::MAX)
    }
}

/// A tool of which the text gives the number only: its tip is what moves.
fn bare_tool(number: u32) -> ToolRecord {
    ToolRecord {
        name: format!("T{number}"),
        number,
        length_offset: number,
        description: String::new(),
        reference: ToolReference::Tip,
        reference_height: 0.0,
        diameter: 0.0,
    }
}

//! Tools, their lengths, and what must be in force before they move.

use styluscam_motion::{EventKind, ToolRecord};

use super::{Interpreter, Z};
use crate::machine::{Family, ToolChange};
use crate::read_error::ReadFault;
use crate::reader::block::Block;
use crate::reader::lexer::{Flaw, Word};

impl Interpreter<'_> {
    pub(super) fn set_tool(&mut self, block: &Block) -> Result<(), Flaw> {
        if let Some(word) = block.words.get(b'T') {
            self.selected = Some(word.number.natural().ok_or((ReadFault::NotNatural, Some(word)))?);
        }
        // Without M6 the T word is all that the text states about a change.
        let by_code = matches!(self.machine.tool.change, ToolChange::M6 | ToolChange::ToolCall | ToolChange::Unsaid);
        let by_word = if by_code { None } else { block.words.get(b'T') };
        let Some(word) = block.change().or(by_word) else { return Ok(()) };
        let number = self.selected.ok_or((ReadFault::NoToolSelected, Some(word)))?;
        let unknown = (ReadFault::UnknownTool { number }, block.words.get(b'T').or(Some(word)));
        let index = if self.tools_given {
            self.record.known_tool(number).ok_or(unknown)?
        } else {
            self.record.tool_of_number(number)
        };
        self.load(index);
        self.modes.direction = None; // the spindle stops before a change
        self.halted = false;
        self.event(EventKind::ToolChange { tool: index });
        Ok(())
    }

    /// Takes the tool for the active one. Its length differs from the last one's: Z is not known until it is commanded.
    pub(super) fn load(&mut self, index: u32) {
        self.record.load(index);
        self.height = self.record.program.tools.get(index as usize).map_or(0.0, |t| t.reference_height);
        self.forget(Z);
        self.note_change();
    }

    /// A job with one tool may run it without calling it; without any tool from the job, the tool is unknown.
    pub(super) fn load_only_tool(&mut self, word: Word) -> Result<(), Flaw> {
        if self.record.tool.is_some() {
            return Ok(());
        }
        if self.record.program.tools.len() > 1 {
            return Err((ReadFault::NoToolLoaded, Some(word)));
        }
        if self.record.program.tools.is_empty() {
            self.record.tool_of_number(0);
        }
        self.load(0);
        Ok(())
    }

    /// D0 takes a tool's length away, D1 gives it back; other edges are not read (Sinumerik).
    pub(super) fn set_edge(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(word) = block.words.get(b'D').filter(|_| self.machine.family == Family::Siemens) else {
            return Ok(());
        };
        match word.number.natural() {
            Some(0) => self.without_edge = true,
            Some(1) => self.without_edge = false,
            _ => return Err((ReadFault::NotRead { what: "edges other than D0 and D1" }, Some(word))),
        }
        Ok(())
    }

    /// Without the job's tools, the text's own words state which length offset a tool has; it has one.
    pub(super) fn learn_length(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(word) = block.length_number(self.length_word()).filter(|_| !self.tools_given) else { return Ok(()) };
        let (Some((true, _)), Some(index)) = (block.length(), self.record.tool) else { return Ok(()) };
        let number = word.number.natural().ok_or((ReadFault::NotNatural, Some(word)))?;
        let known = self.learned.insert(index, number);
        if known.is_some_and(|known| known != number) {
            return Err((ReadFault::NotRead { what: "two length offsets of one tool" }, Some(word)));
        }
        if let Some(tool) = self.record.program.tools.get_mut(index as usize) {
            tool.length_offset = number;
        }
        Ok(())
    }

    /// For a job, every move needs its tool's length offset and the machine's path tolerance.
    pub(super) fn allow_motion(&self, word: Word) -> Result<(), Flaw> {
        self.job_tool().map_or(Ok(()), |tool| self.in_force.allows(self.machine, tool, word))
    }

    /// The loaded tool, where the job's tools are known.
    pub(super) fn job_tool(&self) -> Option<&ToolRecord> {
        self.record.tool.filter(|_| self.tools_given).and_then(|i| self.record.program.tools.get(i as usize))
    }

    /// The letter of a length offset's number.
    pub(crate) fn length_word(&self) -> u8 {
        let word = self.machine.tool.length.as_ref().map_or('H', |length| length.word);
        u8::try_from(word).unwrap_or(b'H')
    }
}

//! O-words: branches, loops, and subroutines with their own parameters.

use std::rc::Rc;

use super::block::Block;
use super::expression::{natural, Cursor};
use super::fault::TraceFault;
use super::frame::{Back, Frame};
use super::note::Gap;
use super::parameters::LOCALS;
use super::source::{Content, Flow, Label, Source};
use super::tracer::{Next, Tracer};

/// Subroutines within subroutines.
const DEPTH: usize = 100;

/// Names that were not found and are remembered.
const REMEMBERED: usize = 1000;

impl Tracer<'_> {
    /// How many subroutines are running.
    pub(super) fn depth(&self) -> usize {
        self.frames.len()
    }

    /// What belongs to the subroutine that runs.
    pub(super) fn frame(&mut self) -> &mut Frame {
        self.frames.last_mut().unwrap_or(&mut self.root)
    }

    pub(super) fn local(&self, name: &str) -> Option<f64> {
        self.frames.last().unwrap_or(&self.root).names.get(name).copied()
    }

    pub(super) fn set_local(&mut self, name: &str, value: f64) {
        self.frame().names.insert(name.into(), value);
    }

    /// The line of the program itself that is being run, or that called what is.
    pub(super) fn line_of_program(&self) -> u32 {
        let calls = self.frames.iter().rev().filter_map(|frame| frame.back.as_ref()).map(|back| (back.file, back.line));
        let line = std::iter::once((self.file, self.line)).chain(calls).find(|(file, _)| *file == 0);
        line.map_or(0, |(_, line)| u32::try_from(line + 1).unwrap_or(u32::MAX))
    }

    pub(super) fn flow(&mut self, source: &Source, label: &Label, flow: Flow, rest: &str) -> Result<Next, TraceFault> {
        let label = match label {
            Label::Fixed(label) => label.clone(),
            Label::Computed(code) => self.computed_label(code)?,
        };
        let line = self.line;
        let after = |flows: &[Flow], other| seek(source.after(line, &label, flows), &label, other);
        match flow {
            Flow::Number => Ok(Next::Line),
            Flow::Sub => Ok(Next::Jump(after(&[Flow::EndSub], "endsub")?.0 + 1)),
            Flow::Call => self.call(&label, rest),
            Flow::Return | Flow::EndSub => self.give_back(&label, rest),
            Flow::If => self.branch(source, &label, rest),
            // reached from above: a branch has been run
            Flow::ElseIf | Flow::Else => Ok(Next::Jump(after(&[Flow::EndIf], "endif")?.0 + 1)),
            Flow::EndIf | Flow::Do => Ok(Next::Line),
            Flow::While if self.holds(rest)? => Ok(Next::Line),
            Flow::While => Ok(Next::Jump(after(&[Flow::EndWhile], "endwhile")?.0 + 1)),
            Flow::EndWhile => Ok(Next::Jump(seek(source.before(line, &label, &[Flow::While]), &label, "while")?.0)),
            Flow::DoWhile if self.holds(rest)? => {
                Ok(Next::Jump(seek(source.before(line, &label, &[Flow::Do]), &label, "do")?.0 + 1))
            }
            Flow::DoWhile => Ok(Next::Line),
            Flow::Repeat => self.repeat(source, &label, rest),
            Flow::EndRepeat => self.repeat_again(source, &label),
            Flow::Break => Ok(Next::Jump(after(&LOOP_ENDS, "loop")?.0 + 1)),
            Flow::Continue => Ok(Next::Jump(after(&LOOP_ENDS, "loop")?.0)),
        }
    }

    fn computed_label(&mut self, code: &str) -> Result<String, TraceFault> {
        let value = self.one_value(code)?;
        natural(value).map(|number| number.to_string()).ok_or(TraceFault::NotNatural { what: "O" })
    }

    /// Works out what follows a keyword: values, mostly in brackets.
    fn values(&mut self, code: &str) -> Result<Vec<f64>, TraceFault> {
        let mut cursor = Cursor::new(code, self);
        let mut values = Vec::new();
        while cursor.peek().is_some() && values.len() < LOCALS {
            values.push(cursor.value()?);
        }
        if cursor.peek().is_some() {
            return Err(TraceFault::FlowWord);
        }
        let unset = cursor.unset;
        unset.into_iter().for_each(|name| self.note(Gap::Unset { name }));
        Ok(values)
    }

    fn one_value(&mut self, code: &str) -> Result<f64, TraceFault> {
        match self.values(code)?.as_slice() {
            [value] => Ok(*value),
            [] => Err(TraceFault::NumberExpected),
            _ => Err(TraceFault::FlowWord),
        }
    }

    fn holds(&mut self, code: &str) -> Result<bool, TraceFault> {
        Ok(self.one_value(code)? != 0.0)
    }

    fn branch(&mut self, source: &Source, label: &str, condition: &str) -> Result<Next, TraceFault> {
        if self.holds(condition)? {
            return Ok(Next::Line);
        }
        let mut from = self.line;
        loop {
            let branches = [Flow::ElseIf, Flow::Else, Flow::EndIf];
            let (line, flow) = seek(source.after(from, label, &branches), label, "endif")?;
            let taken = match source.lines.get(line).map(|line| &line.content) {
                Some(Content::Flow(_, Flow::ElseIf, condition)) if flow == Flow::ElseIf => self.holds(condition)?,
                _ => true,
            };
            if taken {
                return Ok(Next::Jump(line + 1));
            }
            from = line;
        }
    }

    fn repeat(&mut self, source: &Source, label: &str, count: &str) -> Result<Next, TraceFault> {
        let count = self.one_value(count)?;
        let (end, _) = seek(source.after(self.line, label, &[Flow::EndRepeat]), label, "endrepeat")?;
        if count < 0.5 {
            return Ok(Next::Jump(end + 1));
        }
        self.frame().repeats.insert(end, count.round() as usize);
        Ok(Next::Line)
    }

    fn repeat_again(&mut self, source: &Source, label: &str) -> Result<Next, TraceFault> {
        let (begin, _) = seek(source.before(self.line, label, &[Flow::Repeat]), label, "repeat")?;
        let line = self.line;
        let left = self.frame().repeats.entry(line).or_default();
        *left = left.saturating_sub(1);
        Ok(if *left > 0 { Next::Jump(begin + 1) } else { Next::Line })
    }

    // Subroutines

    fn call(&mut self, label: &str, arguments: &str) -> Result<Next, TraceFault> {
        let arguments = self.values(arguments)?;
        let Some((file, line)) = self.find_subroutine(label) else {
            self.note(Gap::Subroutine { label: label.into() });
            self.set_returned(None);
            return Ok(Next::Line);
        };
        self.enter(file, line + 1, 0)?;
        self.parameters.set_locals(std::array::from_fn(|i| arguments.get(i).copied().unwrap_or_default()));
        self.set_returned(None);
        Ok(Next::Elsewhere)
    }

    /// Runs a contour that a lathe cycle names, then goes on after the block.
    pub(super) fn call_contour(&mut self, label: &str) -> Result<Next, TraceFault> {
        self.call(label, "")
    }

    /// M98.
    pub(super) fn call_number(&mut self, block: &Block) -> Result<Next, TraceFault> {
        let number = block.count(b'p', "P of M98")?.ok_or(TraceFault::WordMissing { what: "P of M98" })?;
        let times = block.count(b'l', "L of M98")?.unwrap_or(1);
        let label = number.to_string();
        let Some((file, line)) = self.find_subroutine(&label) else {
            self.note(Gap::Subroutine { label });
            return Ok(Next::Line);
        };
        if times == 0 {
            return Ok(Next::Line);
        }
        self.enter(file, line + 1, times - 1)?;
        Ok(Next::Elsewhere)
    }

    fn enter(&mut self, file: usize, entry: usize, again: u32) -> Result<(), TraceFault> {
        if self.frames.len() >= DEPTH {
            return Err(TraceFault::CallDepth);
        }
        let back = Back { file: self.file, line: self.line, locals: self.parameters.locals(), entry, again };
        self.called = true;
        self.frames.push(Frame { back: Some(back), ..Frame::default() });
        (self.file, self.line) = (file, entry);
        Ok(())
    }

    /// The file and the line that open a subroutine: here, in a file that is known, or in one of its name.
    fn find_subroutine(&mut self, label: &str) -> Option<(usize, usize)> {
        let start = |source: &Rc<Source>| source.subroutine(label).or_else(|| source.number(label));
        let here = self.sources.get(self.file).and_then(start).map(|line| (self.file, line));
        let known = || self.sources.iter().enumerate().find_map(|(file, source)| Some((file, start(source)?)));
        if let Some(found) = here.or_else(known) {
            return Some(found);
        }
        if self.missing.contains(label) {
            return None;
        }
        let name = label.trim_matches(['<', '>']);
        let source = (self.find)(name).map(|text| Rc::new(Source::new(name, &text)));
        let Some((source, line)) = source.and_then(|source| start(&source).map(|line| (source, line))) else {
            if self.missing.len() < REMEMBERED {
                self.missing.insert(label.into());
            }
            return None;
        };
        self.sources.push(source);
        Some((self.sources.len() - 1, line))
    }

    fn give_back(&mut self, label: &str, code: &str) -> Result<Next, TraceFault> {
        if self.frames.is_empty() {
            return Err(TraceFault::Unmatched { label: label.into(), other: "sub" });
        }
        let value = if code.is_empty() { None } else { Some(self.one_value(code)?) };
        self.leave();
        self.set_returned(value);
        Ok(Next::Elsewhere)
    }

    fn set_returned(&mut self, value: Option<f64>) {
        self.parameters.set_global("_value", value.unwrap_or_default());
        self.parameters.set_global("_value_returned", f64::from(u8::from(value.is_some())));
    }

    /// M99, or the end of a file: begins the subroutine again, or goes back; returns whether there is something to go back to.
    pub(super) fn end_of_subroutine(&mut self) -> bool {
        if let Some(back) = self.frames.last_mut().and_then(|frame| frame.back.as_mut()) {
            if back.again > 0 {
                back.again -= 1;
                self.line = back.entry;
                return true;
            }
        }
        self.leave()
    }

    /// Goes back behind the call.
    fn leave(&mut self) -> bool {
        let Some(Frame { back: Some(back), stored, restores, .. }) = self.frames.pop() else { return false };
        (self.file, self.line) = (back.file, back.line + 1);
        self.parameters.set_locals(back.locals);
        if let Some(modes) = stored.filter(|_| restores) {
            self.restore(modes);
        }
        true
    }
}

const LOOP_ENDS: [Flow; 3] = [Flow::EndWhile, Flow::EndRepeat, Flow::DoWhile];

fn seek(found: Option<(usize, Flow)>, label: &str, other: &'static str) -> Result<(usize, Flow), TraceFault> {
    found.ok_or_else(|| TraceFault::Unmatched { label: label.into(), other })
}

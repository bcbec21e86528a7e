//! Which of the job's operations each operation of a text is, and what that leaves over.

use styluscam_motion::{OperationRecord, Program};

use crate::expectation::{ExpectedOperation, Passes};
use crate::findings::{Finding, FindingKind, Severity};
use crate::subject::Subject;

/// The only one of some, if it is.
fn only<T>(mut found: impl Iterator<Item = T>) -> Option<T> {
    found.next().filter(|_| found.next().is_none())
}

/// Whether an operation of a text has the id of a job's, as far as a machine's character set lets remarks hold it.
#[must_use]
pub fn is_named(id: &str, in_text: &str) -> bool {
    id == in_text || plain(id) == plain(in_text)
}

/// What is left of an id in any character set.
fn plain(id: &str) -> String {
    id.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

/// For each of the program's operations the job's, where it has one.
pub(crate) struct Assignment<'a> {
    of: Vec<Option<&'a ExpectedOperation>>,
    expected: &'a [ExpectedOperation],
}

impl<'a> Assignment<'a> {
    /// By their ids; a job with one operation means it, whatever the text calls it. A text that names none of several means
    /// them all, when it loads their tools in their order.
    pub fn new(program: &Program, subject: &Subject<'a>) -> Self {
        let expected = subject.expected;
        let by_id = |id: &str| {
            // a machine's character set changes what remarks can hold
            let named = expected.iter().find(|operation| operation.id == id);
            named.or_else(|| only(expected.iter().filter(|operation| is_named(&operation.id, id))))
        };
        let of: Vec<_> = program.operations.iter().map(|operation| by_id(&operation.id)).collect();
        let tools = || program.operations.iter().map(|operation| operation.tool as usize);
        let named = of.iter().any(Option::is_some);
        let of = match expected {
            [only] => vec![Some(only); of.len()],
            _ if !named && tools().eq(expected.iter().map(|operation| operation.tool)) => {
                expected.iter().map(Some).collect()
            }
            _ => of,
        };
        Self { of, expected }
    }

    /// What is expected of one of the program's operations, by its index.
    pub fn of(&self, index: u32) -> Option<&'a ExpectedOperation> {
        self.of.get(index as usize).copied().flatten()
    }

    /// Whether the tool of one of the program's operations may lean, by its index.
    pub fn leans(&self, index: u32) -> bool {
        self.of(index).is_some_and(|of| of.expectation.flank().is_some())
    }

    /// The job's number of one of the program's operations, by its index.
    pub fn number_of(&self, index: u32) -> Option<usize> {
        let of = self.of(index)?;
        self.expected.iter().position(|expected| std::ptr::eq(of, expected))
    }

    /// Whether this is expected of one of the program's operations, by its index.
    pub fn is(&self, index: u32, expected: &ExpectedOperation) -> bool {
        self.of(index).is_some_and(|of| std::ptr::eq(of, expected))
    }

    /// The findings of operations that are missing, not named, in another order, or not checked in full.
    pub fn findings(&self, program: &Program, subject: &Subject) -> Vec<Finding> {
        let mut findings: Vec<Finding> = self.missing().collect();
        findings.extend(self.unnamed(subject));
        findings.extend(self.unknown(program, subject));
        findings.extend(self.out_of_order(program, subject));
        findings.extend(self.not_checked(subject));
        findings
    }

    /// The findings of operations that the text does not carry out, when it carries out any by name.
    fn missing(&self) -> impl Iterator<Item = Finding> + use<'_, 'a> {
        let carries_out =
            |expected: &ExpectedOperation| self.of.iter().flatten().any(|operation| std::ptr::eq(*operation, expected));
        let any = self.of.iter().any(Option::is_some);
        self.expected.iter().filter(move |expected| any && !carries_out(expected)).map(|expected| {
            let message = format!("the text has no operation {:?} of the job; post the whole job", expected.id);
            Finding::of_all(FindingKind::MissingOperation, Severity::Error, message)
        })
    }

    /// The finding of operations that come in another order than the job's.
    fn out_of_order(&self, program: &Program, subject: &Subject) -> Option<Finding> {
        let position =
            |operation: &ExpectedOperation| subject.expected.iter().position(|other| std::ptr::eq(other, operation));
        let known = self.of.iter().enumerate().filter_map(|(i, operation)| Some((i, position((*operation)?)?)));
        let known: Vec<(usize, usize)> = known.collect();
        let pair = known.windows(2).find(|pair| pair[1].1 < pair[0].1)?;
        let [before, id] = [pair[0], pair[1]].map(|(_, operation)| &subject.expected[operation].id);
        let first = program.moves.iter().find(|step| step.operation as usize == pair[1].0);
        let line = first.map_or(0, |step| step.line);
        let message = format!(
            "line {line}: operation {id:?} comes after {before:?}, and before it in the job; post the job again"
        );
        Some(Finding::of_all(FindingKind::OperationOrder, Severity::Error, message).at_line(line))
    }

    /// The finding of a text of which nothing can be compared with the job.
    fn unnamed(&self, subject: &Subject) -> Option<Finding> {
        let known = subject.expected.is_empty() || self.of.is_empty() || self.of.iter().any(Option::is_some);
        let message = format!(
            "the text names none of the job's {} operations, and does not load their tools in their order: it cannot be \
             compared with the job's feeds, spindle and passes; post the job again, with its remarks",
            subject.expected.len()
        );
        (!known).then(|| Finding::of_all(FindingKind::UnnamedOperations, Severity::Error, message))
    }

    /// The findings of operations that the job does not have, where others are known.
    fn unknown(&self, program: &Program, subject: &Subject) -> Vec<Finding> {
        if self.of.iter().all(Option::is_none) {
            return Vec::new(); // nothing is compared then: that is one finding
        }
        let known: Vec<&str> = subject.expected.iter().map(|operation| operation.id.as_str()).collect();
        let unknown = (0_u32..).zip(&program.operations).filter(|(index, _)| self.of(*index).is_none());
        let finding = |(index, operation): (u32, &OperationRecord)| {
            let line = program.moves.iter().find(|step| step.operation == index)?.line;
            let message = format!(
                "line {line}: the job has no operation {:?} (it has {}): its feeds, tool, spindle and passes are not \
                 checked; post the job again, or add the operation to the job",
                operation.id,
                known.join(", ")
            );
            Some(Finding::of_all(FindingKind::UnknownOperation, Severity::Error, message).at_line(line))
        };
        unknown.filter_map(finding).collect()
    }

    /// Notes of the operations whose passes are not checked.
    fn not_checked<'b>(&'b self, subject: &'b Subject) -> impl Iterator<Item = Finding> + 'b {
        let is_in_text =
            |operation: &&ExpectedOperation| self.of.iter().flatten().any(|of| std::ptr::eq(*of, *operation));
        subject.expected.iter().filter(is_in_text).filter_map(|ExpectedOperation { id, expectation, .. }| {
            let Passes::Unordered { reason } = expectation.passes else { return None };
            let message = format!("operation {id:?}: its passes are not checked, {reason}");
            Some(Finding::of_all(FindingKind::NotChecked, Severity::Note, message))
        })
    }
}

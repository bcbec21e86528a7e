//! A file of the program, cut into lines, and where its loops, branches and subroutines begin and end.

use std::collections::HashMap;

use super::fault::TraceFault;
use crate::block::Comments;

/// A file: the program, or one that a subroutine was called from.
#[derive(Debug)]
pub(super) struct Source {
    /// The subroutine's name; empty for the program.
    pub(super) name: String,
    pub(super) lines: Vec<Line>,
    /// The lines of each label, in order.
    labels: HashMap<String, Vec<(usize, Flow)>>,
}

/// A line, understood as far as no parameter is needed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Line {
    /// Whether it begins with `/`.
    pub(super) optional: bool,
    pub(super) content: Content,
    pub(super) comments: Vec<String>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Content {
    #[default]
    Nothing,
    /// The `%` that ends the file; one that opens it states nothing.
    Percent,
    /// Words, in lower case without blanks.
    Words(String),
    /// An O-word: its label, its keyword and what follows.
    Flow(Label, Flow, String),
    Fault(TraceFault),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Label {
    /// `100` or `<name>`.
    Fixed(String),
    /// An expression that gives a number.
    Computed(String),
}

/// The keyword of an O-word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    Sub,
    EndSub,
    Return,
    Call,
    If,
    ElseIf,
    Else,
    EndIf,
    While,
    EndWhile,
    Do,
    /// The `while` that ends a `do`.
    DoWhile,
    Repeat,
    EndRepeat,
    Break,
    Continue,
    /// None: the number of a program, or of a subroutine for M98.
    Number,
}

impl Flow {
    /// With their texts: a text that begins with another's comes first.
    const KEYWORDS: [(&'static str, Self); 15] = [
        ("sub", Self::Sub),
        ("endsub", Self::EndSub),
        ("return", Self::Return),
        ("call", Self::Call),
        ("if", Self::If),
        ("elseif", Self::ElseIf),
        ("else", Self::Else),
        ("endif", Self::EndIf),
        ("while", Self::While),
        ("endwhile", Self::EndWhile),
        ("do", Self::Do),
        ("repeat", Self::Repeat),
        ("endrepeat", Self::EndRepeat),
        ("break", Self::Break),
        ("continue", Self::Continue),
    ];
}

impl Source {
    pub(super) fn new(name: &str, text: &str) -> Self {
        let mut lines: Vec<Line> = text.lines().map(read_line).collect();
        let opening = lines.iter_mut().find(|line| line.content != Content::Nothing);
        if let Some(opening) = opening.filter(|line| line.content == Content::Percent) {
            opening.content = Content::Nothing;
        }
        let mut source = Self { name: name.into(), lines, labels: HashMap::new() };
        source.collect_labels();
        source
    }

    /// Notes where each label stands, and separates the `while` that ends a `do` from the one that begins a loop.
    fn collect_labels(&mut self) {
        for (index, line) in self.lines.iter_mut().enumerate() {
            let Content::Flow(Label::Fixed(label), flow, _) = &mut line.content else { continue };
            let lines = self.labels.entry(label.clone()).or_default();
            let loops = |flow: &Flow| matches!(flow, Flow::Do | Flow::DoWhile | Flow::While | Flow::EndWhile);
            let before = lines.iter().rev().map(|(_, flow)| *flow).find(loops);
            if (*flow, before) == (Flow::While, Some(Flow::Do)) {
                *flow = Flow::DoWhile;
            }
            lines.push((index, *flow));
        }
    }

    /// The first line after `line` that has the label and one of the keywords.
    pub(super) fn after(&self, line: usize, label: &str, flows: &[Flow]) -> Option<(usize, Flow)> {
        let lines = self.lines_of(label);
        let next = lines.partition_point(|(at, _)| *at <= line);
        lines.iter().skip(next).copied().find(|(_, flow)| flows.contains(flow))
    }

    /// The last line before `line` that has the label and one of the keywords.
    pub(super) fn before(&self, line: usize, label: &str, flows: &[Flow]) -> Option<(usize, Flow)> {
        let lines = self.lines_of(label);
        let next = lines.partition_point(|(at, _)| *at < line);
        lines.iter().take(next).rev().copied().find(|(_, flow)| flows.contains(flow))
    }

    fn lines_of(&self, label: &str) -> &[(usize, Flow)] {
        self.labels.get(label).map_or(&[], Vec::as_slice)
    }

    /// The line that opens a subroutine.
    pub(super) fn subroutine(&self, label: &str) -> Option<usize> {
        self.lines_of(label).iter().find(|(_, flow)| *flow == Flow::Sub).map(|(line, _)| *line)
    }

    /// The line that has only this number: where M98 goes to.
    pub(super) fn number(&self, label: &str) -> Option<usize> {
        self.lines_of(label).iter().find(|(_, flow)| *flow == Flow::Number).map(|(line, _)| *line)
    }

    /// The labels of the subroutines, in the order of the text.
    pub(super) fn subroutines(&self) -> Vec<String> {
        let label = |line: &Line| match &line.content {
            Content::Flow(Label::Fixed(label), Flow::Sub, _) => Some(label.clone()),
            _ => None,
        };
        self.lines.iter().filter_map(label).collect()
    }
}

fn read_line(text: &str) -> Line {
    let (code, comments) = match without_comments(text) {
        Ok(parts) => parts,
        Err(fault) => return Line { content: Content::Fault(fault), ..Line::default() },
    };
    let optional = code.starts_with('/');
    let code = without_number(code.strip_prefix('/').unwrap_or(&code));
    let content = match code.as_bytes() {
        [] => Content::Nothing,
        [b'%', ..] => Content::Percent,
        [b'o', ..] => flow_of(code.get(1..).unwrap_or_default()).unwrap_or_else(Content::Fault),
        _ => Content::Words(code.into()),
    };
    Line { optional, content, comments }
}

/// The code in lower case without blanks, and the comments as they are.
fn without_comments(text: &str) -> Result<(String, Vec<String>), TraceFault> {
    let (mut code, mut comments) = (String::new(), Vec::new());
    let mut at = 0;
    while let Some(character) = text.get(at..).and_then(|rest| rest.chars().next()) {
        if let Some((comment, end)) = Comments::NGC.at(text, at, false).map_err(|_| TraceFault::UnclosedComment)? {
            comments.push(comment.to_string());
            at = end;
            continue;
        }
        at += character.len_utf8();
        // tabs, carriage returns, and the marks and filling bytes that editors and punched tapes leave
        if !character.is_whitespace() && !matches!(character, '\u{feff}' | '\0') {
            code.push(character.to_ascii_lowercase());
        }
    }
    Ok((code, comments))
}

/// What follows the line's number, `N10` or `N10.5`.
fn without_number(code: &str) -> &str {
    let Some(rest) = code.strip_prefix('n') else { return code };
    let numbered = rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    if numbered.len() == rest.len() {
        code
    } else {
        numbered
    }
}

fn flow_of(code: &str) -> Result<Content, TraceFault> {
    let (label, rest) = label_of(code)?;
    if rest.is_empty() {
        return Ok(Content::Flow(label, Flow::Number, String::new()));
    }
    let found =
        Flow::KEYWORDS.into_iter().filter(|(text, _)| rest.starts_with(text)).max_by_key(|(text, _)| text.len());
    let (text, flow) = found.ok_or(TraceFault::FlowWord)?;
    let rest = rest.get(text.len()..).unwrap_or_default();
    if rest.starts_with(|c: char| c.is_ascii_lowercase()) && !matches!(flow, Flow::Return | Flow::EndSub) {
        return Err(TraceFault::FlowWord);
    }
    Ok(Content::Flow(label, flow, rest.into()))
}

/// The label at the start of a code, and the rest.
fn label_of(code: &str) -> Result<(Label, &str), TraceFault> {
    match code.as_bytes().first() {
        Some(b'<') => {
            let end = code.find('>').ok_or(TraceFault::Expected { expected: '>' })? + 1;
            Ok((Label::Fixed(code.get(..end).unwrap_or_default().into()), code.get(end..).unwrap_or_default()))
        }
        Some(b'0'..=b'9') => {
            let (digits, rest) = code.split_at(code.find(|c: char| !c.is_ascii_digit()).unwrap_or(code.len()));
            let number = digits.trim_start_matches('0');
            Ok((Label::Fixed(if number.is_empty() { "0" } else { number }.into()), rest))
        }
        Some(b'[' | b'#') => {
            let end = code.find("call").ok_or(TraceFault::FlowWord)?;
            let (expression, rest) = code.split_at(end);
            Ok((Label::Computed(expression.into()), rest))
        }
        _ => Err(TraceFault::FlowWord),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flow(label: &str, flow: Flow, rest: &str) -> Content {
        Content::Flow(Label::Fixed(label.into()), flow, rest.into())
    }

    #[test]
    fn blanks_case_numbers_and_comments_are_taken_off() {
        let line = read_line("/ N10.5 g 1 X - 1 . 5 (mid) #<A b> = 2 ; End");
        assert_eq!(line.content, Content::Words("g1x-1.5#<ab>=2".into()));
        assert_eq!((line.optional, line.comments), (true, vec!["mid".to_string(), "End".into()]));
        assert_eq!(read_line("G1 (open").content, Content::Fault(TraceFault::UnclosedComment));
    }

    #[test]
    fn flow_words_are_split_from_their_labels() {
        for (text, content) in [
            ("O0100 Sub", flow("100", Flow::Sub, "")),
            ("n5 o<Big One> call [1] [#2]", flow("<bigone>", Flow::Call, "[1][#2]")),
            ("o1 elseif [#1 eq 2]", flow("1", Flow::ElseIf, "[#1eq2]")),
            ("o1 else", flow("1", Flow::Else, "")),
            ("O7 (a program)", flow("7", Flow::Number, "")),
            ("o1 hop", Content::Fault(TraceFault::FlowWord)),
            ("o1 callsub", Content::Fault(TraceFault::FlowWord)),
        ] {
            assert_eq!(read_line(text).content, content, "{text}");
        }
        let computed = Content::Flow(Label::Computed("[#1+1]".into()), Flow::Call, "[2]".into());
        assert_eq!(read_line("o[#1+1] call [2]").content, computed);
    }

    #[test]
    fn a_while_that_ends_a_do_differs_from_one_that_begins() {
        let source = Source::new("", "o1 do\no1 while [0]\no1 while [0]\no1 endwhile\n");
        assert_eq!(source.after(0, "1", &[Flow::DoWhile]), Some((1, Flow::DoWhile)));
        assert_eq!(source.before(3, "1", &[Flow::While]), Some((2, Flow::While)));
    }
}

//! Remarks made fit for a controller: its characters, its length, its marks.

use crate::machine::{ranges, CommentForm, CommentRules, Machine, Numbered};

/// What stands for characters that no controller takes.
const ASCII: [(char, &str); 19] = [
    ('°', " deg"),
    ('µ', "u"),
    ('±', "+-"),
    ('²', "2"),
    ('³', "3"),
    ('×', "x"),
    ('Ø', "D"),
    ('ø', "d"),
    ('–', "-"),
    ('—', "-"),
    ('…', "..."),
    ('ä', "ae"),
    ('ö', "oe"),
    ('ü', "ue"),
    ('Ä', "Ae"),
    ('Ö', "Oe"),
    ('Ü', "Ue"),
    ('ß', "ss"),
    ('%', " percent"),
];

/// How comments are written for one machine.
#[derive(Clone, Debug)]
pub(crate) struct CommentFormat {
    rules: CommentRules,
    allowed: [bool; 128],
    width: usize,
}

impl CommentFormat {
    /// Remarks by a machine's rules.
    pub(crate) fn new(machine: &Machine) -> Self {
        let marks = 2; // "(" and ")", or "; "
        let line = (machine.line.max_chars as usize).saturating_sub(number_width(machine));
        let width = machine.comment.max_len.map_or(line, |l| l as usize).min(line.saturating_sub(marks)).max(1);
        Self { rules: machine.comment.clone(), allowed: allowed_characters(machine), width }
    }

    /// `text` as lines, each a whole remark with its marks; none where remarks are not taken or nothing is left.
    pub(crate) fn lines(&self, text: &str) -> Vec<String> {
        let clean = self.clean(text);
        match self.rules.form {
            CommentForm::None => Vec::new(),
            CommentForm::Paren => self.wrapped(&clean).map(|l| format!("({l})")).collect(),
            CommentForm::Semicolon => self.wrapped(&clean).map(|l| format!("; {l}")).collect(),
            CommentForm::Colon => self.wrapped(&clean).map(|l| format!(": {l}")).collect(),
        }
    }

    fn wrapped<'a>(&self, clean: &'a str) -> impl Iterator<Item = String> + 'a {
        let guard = self.rules.form == CommentForm::Paren;
        let active: Vec<String> = if guard { self.rules.active.clone() } else { Vec::new() };
        let width = if active.is_empty() { self.width } else { self.width.saturating_sub(1).max(1) };
        wrap(clean, width).into_iter().map(move |line| passive(line, &active))
    }

    /// `text` with every character that the controller does not take replaced, and white space made single spaces.
    fn clean(&self, text: &str) -> String {
        let mut out = String::with_capacity(text.len());
        for c in text.chars() {
            self.push_clean(&mut out, c);
        }
        out.split_ascii_whitespace().collect::<Vec<_>>().join(" ")
    }

    fn push_clean(&self, out: &mut String, c: char) {
        let c = if c.is_whitespace() { ' ' } else { c };
        let c = if self.rules.uppercase { c.to_ascii_uppercase() } else { c };
        if self.takes(c) {
            out.push(c);
        } else if let Some(text) = self.rules.substitutions.get(&c) {
            out.extend(
                text.chars()
                    .map(|s| if self.rules.uppercase { s.to_ascii_uppercase() } else { s })
                    .filter(|s| self.takes(*s)),
            );
        } else if let Some(text) = ASCII.iter().find(|(known, _)| *known == c).map(|(_, text)| *text) {
            text.chars().for_each(|s| self.push_clean(out, s));
        } else if let Some(other) = stand_ins(c).iter().find(|s| self.takes(**s)) {
            out.push(*other);
        }
    }

    fn takes(&self, c: char) -> bool {
        c == ' ' || usize::try_from(u32::from(c)).ok().and_then(|i| self.allowed.get(i)).copied().unwrap_or(false)
    }
}

/// Characters that the number before a remark takes.
fn number_width(machine: &Machine) -> usize {
    let numbered = machine.block_number.as_ref().filter(|rules| rules.which == Numbered::Lines);
    numbered.map_or(0, |rules| rules.prefix.len() + 1 + rules.max.to_string().len().max(usize::from(rules.digits)))
}

/// What may stand for a character outside the set, best first.
fn stand_ins(c: char) -> &'static [char] {
    match c {
        '(' | '[' | '{' => &['[', '<', '-', '_'],
        ')' | ']' | '}' => &[']', '>', '-', '_'],
        ';' => &[',', '_'],
        ':' => &['=', '-', '_'],
        '/' => &['-', '_'],
        '\'' => &[],
        _ => &['_'],
    }
}

/// The characters that may stand inside a remark: the set, less its own marks and what no line may hold.
fn allowed_characters(machine: &Machine) -> [bool; 128] {
    let mut allowed = [false; 128];
    let set = machine.comment.charset.as_deref().map_or_else(|| vec![(' ', '~')], ranges);
    for (i, slot) in allowed.iter_mut().enumerate() {
        let c = char::from(u8::try_from(i).unwrap_or(0));
        let inside = (' '..='~').contains(&c) && set.iter().any(|(a, b)| (*a..=*b).contains(&c));
        *slot = inside && !"();".contains(c) && !machine.line.forbidden.contains(c);
    }
    allowed
}

/// Lines of at most `width` characters, broken at spaces, or inside a word that is longer.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_ascii_whitespace() {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.extend(pieces(word, width)),
        }
    }
    lines
}

/// A word in pieces of at most `width` bytes; cleaned text is ASCII.
fn pieces(word: &str, width: usize) -> impl Iterator<Item = String> + '_ {
    word.as_bytes().chunks(width).map(|c| String::from_utf8_lossy(c).into_owned())
}

/// A line that no controller takes as a command.
fn passive(line: String, active: &[String]) -> String {
    let first = line.split([',', ' ']).next().unwrap_or_default();
    if active.iter().any(|a| a.eq_ignore_ascii_case(first)) {
        format!("-{line}")
    } else {
        line
    }
}

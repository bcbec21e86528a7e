//! From a formula's text to tokens, within limits, every name known and every error with its position.

use std::collections::BTreeMap;

use super::refusal::refusal;
use crate::GeometryError;

/// Longest formula, characters.
const LONGEST: usize = 2000;
/// Deepest nesting of parentheses.
const DEEPEST: usize = 64;
/// Most operators and functions: a profile's formula needs a dozen, and each costs time at every point.
const MOST_OPERATIONS: usize = 150;
/// The functions that are smooth.
pub(super) const FUNCTIONS: [&str; 13] =
    ["sqrt", "exp", "ln", "log10", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh"];
/// The constants.
pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// What a formula consists of.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    /// A literal, constant or parameter.
    Number(f64),
    /// A variable.
    Variable(String),
    /// A function, always followed by `Open`.
    Function(String),
    /// + - * / ^
    Operator(char),
    /// (
    Open,
    /// )
    Close,
}

/// What names mean in a formula.
pub(super) struct Names<'a> {
    /// The key of the document, for errors.
    pub key: &'a str,
    /// Its variables.
    pub variables: &'a [&'a str],
    /// Its parameters.
    pub parameters: &'a BTreeMap<String, f64>,
}

impl Names<'_> {
    fn refuse(&self, position: usize, reason: String, hint: &str) -> GeometryError {
        refusal(format!("{}, character {}", self.key, position + 1), reason, hint)
    }

    /// The token that a name stands for.
    fn token(&self, name: &str, position: usize) -> Result<Token, GeometryError> {
        if self.variables.contains(&name) {
            return Ok(Token::Variable(name.to_owned()));
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            return Ok(Token::Number(*value));
        }
        if let Some(value) = self.parameters.get(name) {
            return Ok(Token::Number(*value));
        }
        if FUNCTIONS.contains(&name) {
            return Ok(Token::Function(name.to_owned()));
        }
        let reason = format!("`{}` is not known here", shortened(name));
        Err(self.refuse(position, reason, &self.known_names(name)))
    }

    fn known_names(&self, wrong: &str) -> String {
        let known = || {
            let fixed = FUNCTIONS.into_iter().chain(CONSTANTS.map(|(name, _)| name));
            self.variables.iter().copied().chain(self.parameters.keys().map(String::as_str)).chain(fixed)
        };
        let near =
            known().map(|name| (strsim::jaro_winkler(wrong, name), name)).filter(|(nearness, _)| *nearness > 0.8);
        let guess = near
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, name)| format!("did you mean `{name}`? "))
            .unwrap_or_default();
        let names: Vec<&str> = known().collect();
        format!("{guess}allowed are + - * / ^ ( ) and {}", names.join(", "))
    }
}

/// A name as an error quotes it.
fn shortened(name: &str) -> String {
    if name.chars().count() <= 24 {
        name.to_owned()
    } else {
        name.chars().take(24).chain("...".chars()).collect()
    }
}

/// The tokens of a formula that obeys the grammar: operands and operators alternate, parentheses match.
pub(super) fn tokens(text: &str, names: &Names) -> Result<Vec<Token>, GeometryError> {
    if text.len() > LONGEST {
        let reason = format!("the formula is longer than {LONGEST} characters");
        return Err(refusal(names.key.to_owned(), reason, "a profile needs a few dozen: is this the right text?"));
    }
    let mut grammar = Grammar { names, operand_next: true, open: 0, operations: 0, last: None };
    let mut out = Vec::new();
    let mut rest = Scanner { text, position: 0 };
    while let Some((position, token)) = rest.next(names)? {
        grammar.accept(&token, position)?;
        out.push(token);
    }
    grammar.finish(text.chars().count())?;
    Ok(out)
}

/// Reads one token after the other.
struct Scanner<'a> {
    text: &'a str,
    position: usize,
}

impl Scanner<'_> {
    fn next(&mut self, names: &Names) -> Result<Option<(usize, Token)>, GeometryError> {
        let trimmed = self.text.trim_start();
        self.position += self.text.chars().count() - trimmed.chars().count();
        self.text = trimmed;
        let Some(first) = trimmed.chars().next() else { return Ok(None) };
        let position = self.position;
        let (length, token) = if first.is_ascii_digit() || first == '.' {
            let length = number_length(trimmed);
            (length, number(self.head(length), names, position)?)
        } else if first.is_ascii_alphabetic() || first == '_' {
            let length = trimmed.bytes().take_while(|b| b.is_ascii_alphanumeric() || *b == b'_').count();
            (length, names.token(self.head(length), position)?)
        } else {
            (first.len_utf8(), symbol(first, names, position)?)
        };
        self.text = self.text.get(length..).unwrap_or_default();
        self.position += if first.is_ascii() { length } else { 1 };
        Ok(Some((position, token)))
    }

    fn head(&self, length: usize) -> &str {
        self.text.get(..length).unwrap_or_default()
    }
}

fn symbol(symbol: char, names: &Names, position: usize) -> Result<Token, GeometryError> {
    match symbol {
        '+' | '-' | '*' | '/' | '^' => Ok(Token::Operator(symbol)),
        '(' => Ok(Token::Open),
        ')' => Ok(Token::Close),
        ',' => Err(names.refuse(position, "`,` is not allowed".to_owned(), "the decimal sign is a point")),
        _ => Err(names.refuse(
            position,
            format!("`{}` is not allowed", symbol.escape_debug()),
            "a formula takes numbers, names, + - * / ^ and ( )",
        )),
    }
}

/// Bytes of the number that a text starts with: digits, a point, an exponent only if it has digits.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| text.bytes().skip(from).take_while(u8::is_ascii_digit).count();
    let byte = |at: usize| text.as_bytes().get(at).copied();
    let mut length = digits(0);
    if byte(length) == Some(b'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(byte(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(byte(length + 1), Some(b'+' | b'-')));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}

fn number(text: &str, names: &Names, position: usize) -> Result<Token, GeometryError> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Token::Number(value)),
        _ => Err(names.refuse(position, format!("`{}` is not a number", shortened(text)), "write 12.5 or 1e-3")),
    }
}

/// What may come next.
struct Grammar<'a> {
    names: &'a Names<'a>,
    operand_next: bool,
    open: usize,
    operations: usize,
    last: Option<Token>,
}

impl Grammar<'_> {
    fn accept(&mut self, token: &Token, position: usize) -> Result<(), GeometryError> {
        if matches!(self.last, Some(Token::Function(_))) && *token != Token::Open {
            return Err(self.names.refuse(position, "a function needs ( )".to_owned(), "write sin(t), not sin t"));
        }
        match token {
            Token::Number(_) | Token::Variable(_) | Token::Function(_) | Token::Open => {
                self.operand(token, position)?;
            }
            Token::Operator(symbol) => self.operator(*symbol, position)?,
            Token::Close => self.close(position)?,
        }
        if matches!(token, Token::Function(_) | Token::Operator(_)) {
            self.operations += 1;
        }
        if self.operations > MOST_OPERATIONS {
            let reason = format!("more than {MOST_OPERATIONS} operators and functions");
            return Err(self.names.refuse(position, reason, "simplify the formula, or give the profile as points"));
        }
        self.last = Some(token.clone());
        Ok(())
    }

    fn operand(&mut self, token: &Token, position: usize) -> Result<(), GeometryError> {
        if !self.operand_next {
            let reason = "an operator is missing here".to_owned();
            return Err(self.names.refuse(position, reason, "write 2*r, not 2r or 2(r)"));
        }
        if *token == Token::Open {
            self.open += 1;
            if self.open > DEEPEST {
                let reason = format!("parentheses nest deeper than {DEEPEST}");
                return Err(self.names.refuse(position, reason, "leave out the ones that change nothing"));
            }
        }
        self.operand_next = matches!(token, Token::Open | Token::Function(_));
        Ok(())
    }

    fn operator(&mut self, symbol: char, position: usize) -> Result<(), GeometryError> {
        if self.operand_next && !matches!(symbol, '+' | '-') {
            let reason = format!("`{symbol}` has nothing on its left");
            let power = symbol == '*' && self.last == Some(Token::Operator('*'));
            return Err(self.names.refuse(position, reason, if power { "a power is r^2" } else { "complete it" }));
        }
        self.operand_next = true;
        Ok(())
    }

    fn close(&mut self, position: usize) -> Result<(), GeometryError> {
        if self.open == 0 {
            return Err(self.names.refuse(position, "`)` closes nothing".to_owned(), "match the parentheses"));
        }
        if self.operand_next {
            let reason = "a number or a name is missing before `)`".to_owned();
            return Err(self.names.refuse(position, reason, "complete it"));
        }
        self.open -= 1;
        Ok(())
    }

    fn finish(&self, end: usize) -> Result<(), GeometryError> {
        if self.operand_next {
            return Err(self.names.refuse(end, "the formula ends too early".to_owned(), "complete it"));
        }
        if self.open > 0 {
            return Err(self.names.refuse(end, "`(` is not closed".to_owned(), "match the parentheses"));
        }
        Ok(())
    }
}

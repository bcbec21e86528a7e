//! Values as programs write them: numbers, parameters, functions, and expressions in brackets.
//!
//! Operators bind as in LinuxCNC's manual: `**`; `* / MOD`; `+ -`; `EQ NE GT GE LT LE`; `AND OR XOR`; from left to
//! right. Angles are in degrees.

use super::fault::TraceFault;

/// Brackets, signs and parameters of parameters within one another.
const DEPTH: u32 = 100;

/// Values that differ no more are equal to EQ, NE, LE and GE; LinuxCNC 2.9.4 was tried.
const SAME: f64 = 1e-6;

/// A number may differ so much from the whole one that it is taken for.
const WHOLE: f64 = 1e-4;

/// Where parameters get their values from.
pub(super) trait Values {
    /// Nothing when there is no such number.
    fn numbered(&self, number: usize) -> Option<f64>;
    /// Nothing when it has no value.
    fn named(&self, name: &str) -> Option<f64>;
}

/// A position in a line's code: lower case, without blanks and comments.
pub(super) struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
    depth: u32,
    values: &'a dyn Values,
    /// Names that were asked for and have no value.
    pub(super) unset: Vec<String>,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(text: &'a str, values: &'a dyn Values) -> Self {
        Self { text: text.as_bytes(), at: 0, depth: 0, values, unset: Vec::new() }
    }

    pub(super) fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    pub(super) fn next(&mut self) -> Option<u8> {
        let byte = self.peek()?;
        self.at += 1;
        Some(byte)
    }

    /// Passes over a text if it comes next.
    pub(super) fn take(&mut self, text: &str) -> bool {
        let comes = self.text.get(self.at..).is_some_and(|rest| rest.starts_with(text.as_bytes()));
        if comes {
            self.at += text.len();
        }
        comes
    }

    fn require(&mut self, expected: char) -> Result<(), TraceFault> {
        if self.take(expected.encode_utf8(&mut [0; 4])) {
            Ok(())
        } else {
            Err(TraceFault::Expected { expected })
        }
    }

    /// What follows a parameter's mark `#`: its name, or its number.
    pub(super) fn parameter_key(&mut self) -> Result<Key, TraceFault> {
        if self.take("<") {
            return Ok(Key::Named(self.name()?));
        }
        let number = self.value()?;
        natural(number).map(Key::Numbered).ok_or(TraceFault::ParameterNumber)
    }

    /// A name up to its `>`.
    pub(super) fn name(&mut self) -> Result<String, TraceFault> {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let length = rest.iter().position(|byte| *byte == b'>').ok_or(TraceFault::Expected { expected: '>' })?;
        self.at += length + 1;
        Ok(String::from_utf8_lossy(rest.get(..length).unwrap_or_default()).into_owned())
    }

    /// The value that stands to the right of an assignment's `=`.
    pub(super) fn assigned(&mut self) -> Result<f64, TraceFault> {
        self.require('=')?;
        self.value()
    }

    /// A number, a parameter, a function or an expression in brackets.
    pub(super) fn value(&mut self) -> Result<f64, TraceFault> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(TraceFault::TooDeep);
        }
        let value = match self.peek() {
            Some(b'[') => self.bracketed(),
            Some(b'#') => self.parameter(),
            Some(b'-') => self.signed().map(|value| -value),
            Some(b'+') => self.signed(),
            Some(b'0'..=b'9' | b'.') => self.number(),
            Some(b'a'..=b'z') => self.function(),
            _ => Err(TraceFault::NumberExpected),
        }?;
        self.depth -= 1;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(TraceFault::TooLarge)
        }
    }

    fn signed(&mut self) -> Result<f64, TraceFault> {
        self.at += 1;
        self.value()
    }

    /// An expression in brackets.
    pub(super) fn bracketed(&mut self) -> Result<f64, TraceFault> {
        self.require('[')?;
        let value = self.binary(Operator::LOOSEST)?;
        self.require(']')?;
        Ok(value)
    }

    /// Operands joined by operators that bind at least as tightly as `least`.
    fn binary(&mut self, least: u8) -> Result<f64, TraceFault> {
        let mut left = self.value()?;
        while let Some((text, operator)) = self.operator().filter(|(_, operator)| operator.tightness() >= least) {
            self.at += text.len();
            let right = self.binary(operator.tightness() + 1)?;
            left = operator.apply(left, right)?;
        }
        Ok(left)
    }

    fn operator(&self) -> Option<(&'static str, Operator)> {
        let rest = self.text.get(self.at..)?;
        Operator::ALL.into_iter().find(|(text, _)| rest.starts_with(text.as_bytes()))
    }

    fn parameter(&mut self) -> Result<f64, TraceFault> {
        self.at += 1;
        match self.parameter_key()? {
            Key::Numbered(number) => self.values.numbered(number).ok_or(TraceFault::ParameterNumber),
            Key::Named(name) => Ok(self.values.named(&name).unwrap_or_else(|| {
                self.unset.push(name);
                0.0
            })),
        }
    }

    /// Digits with at most one point; G-code has no exponents.
    pub(super) fn number(&mut self) -> Result<f64, TraceFault> {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let mut points = 0;
        let length = rest
            .iter()
            .position(|byte| {
                points += usize::from(*byte == b'.');
                !(byte.is_ascii_digit() || *byte == b'.' && points == 1)
            })
            .unwrap_or(rest.len());
        self.at += length;
        let digits = rest.get(..length).and_then(|digits| std::str::from_utf8(digits).ok());
        digits.and_then(|digits| digits.parse().ok()).ok_or(TraceFault::NumberExpected)
    }

    fn function(&mut self) -> Result<f64, TraceFault> {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let length = rest.iter().position(|byte| !byte.is_ascii_lowercase()).unwrap_or(rest.len());
        let name = String::from_utf8_lossy(rest.get(..length).unwrap_or_default()).into_owned();
        self.at += length;
        match name.as_str() {
            "exists" => self.exists(),
            "atan" => {
                let (y, x) = (self.bracketed()?, self.divisor()?);
                Ok(libm::atan2(y, x).to_degrees())
            }
            _ => {
                let function = unary(&name).ok_or(TraceFault::Function { name })?;
                let value = function.1(self.bracketed()?);
                if value.is_nan() {
                    return Err(TraceFault::Domain { function: function.0 });
                }
                Ok(value)
            }
        }
    }

    /// The second half of `ATAN[y]/[x]`.
    fn divisor(&mut self) -> Result<f64, TraceFault> {
        self.require('/')?;
        self.bracketed()
    }

    fn exists(&mut self) -> Result<f64, TraceFault> {
        self.require('[')?;
        self.require('#')?;
        let known = match self.parameter_key()? {
            Key::Named(name) => self.values.named(&name),
            Key::Numbered(number) => self.values.numbered(number),
        };
        self.require(']')?;
        Ok(truth(known.is_some()))
    }
}

/// How a parameter is called.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Key {
    Numbered(usize),
    Named(String),
}

/// A number as a count, where it is one.
pub(super) fn natural(value: f64) -> Option<usize> {
    let whole = value.round();
    let fits = (value - whole).abs() < WHOLE && (0.0..=f64::from(u32::MAX)).contains(&whole);
    fits.then_some(whole as usize)
}

fn truth(value: bool) -> f64 {
    f64::from(u8::from(value))
}

type Unary = (&'static str, fn(f64) -> f64);

/// The functions of one argument.
const UNARY: [Unary; 12] = [
    ("abs", f64::abs),
    ("acos", |x| libm::acos(x).to_degrees()),
    ("asin", |x| libm::asin(x).to_degrees()),
    ("cos", |x| libm::cos(x.to_radians())),
    ("exp", libm::exp),
    ("fix", f64::floor),
    ("fup", f64::ceil),
    ("ln", libm::log),
    ("round", f64::round),
    ("sin", |x| libm::sin(x.to_radians())),
    ("sqrt", f64::sqrt),
    ("tan", |x| libm::tan(x.to_radians())),
];

fn unary(name: &str) -> Option<Unary> {
    UNARY.into_iter().find(|(known, _)| *known == name)
}

/// What joins two operands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operator {
    Power,
    Times,
    Over,
    Modulo,
    Plus,
    Minus,
    Equal,
    Unequal,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
    And,
    Or,
    Xor,
}

impl Operator {
    const LOOSEST: u8 = 1;

    /// With their texts: a text that begins with another's comes first.
    const ALL: [(&'static str, Self); 15] = [
        ("**", Self::Power),
        ("*", Self::Times),
        ("/", Self::Over),
        ("mod", Self::Modulo),
        ("+", Self::Plus),
        ("-", Self::Minus),
        ("eq", Self::Equal),
        ("ne", Self::Unequal),
        ("gt", Self::Greater),
        ("ge", Self::GreaterOrEqual),
        ("lt", Self::Less),
        ("le", Self::LessOrEqual),
        ("and", Self::And),
        ("or", Self::Or),
        ("xor", Self::Xor),
    ];

    fn tightness(self) -> u8 {
        match self {
            Self::Power => 5,
            Self::Times | Self::Over | Self::Modulo => 4,
            Self::Plus | Self::Minus => 3,
            Self::And | Self::Or | Self::Xor => Self::LOOSEST,
            _ => 2,
        }
    }

    fn apply(self, left: f64, right: f64) -> Result<f64, TraceFault> {
        let same = (left - right).abs() <= SAME;
        let value = match self {
            Self::Power => libm::pow(left, right),
            Self::Times => left * right,
            Self::Over | Self::Modulo if right == 0.0 => return Err(TraceFault::DivisionByZero),
            Self::Over => left / right,
            Self::Modulo => left.rem_euclid(right),
            Self::Plus => left + right,
            Self::Minus => left - right,
            Self::Equal => truth(same),
            Self::Unequal => truth(!same),
            Self::Greater => truth(left > right),
            Self::GreaterOrEqual => truth(same || left > right),
            Self::Less => truth(left < right),
            Self::LessOrEqual => truth(same || left < right),
            Self::And => truth(left != 0.0 && right != 0.0),
            Self::Or => truth(left != 0.0 || right != 0.0),
            Self::Xor => truth((left != 0.0) != (right != 0.0)),
        };
        match value {
            value if value.is_nan() => Err(TraceFault::Domain { function: "**" }),
            value if value.is_infinite() => Err(TraceFault::TooLarge),
            value => Ok(value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Some;

    impl Values for Some {
        fn numbered(&self, number: usize) -> Option<f64> {
            (number < 100).then_some(number as f64 + 0.5)
        }

        fn named(&self, name: &str) -> Option<f64> {
            (name == "one").then_some(1.0)
        }
    }

    fn value(text: &str) -> Result<f64, TraceFault> {
        Cursor::new(text, &Some).value()
    }

    #[test]
    fn operators_bind_in_their_order_and_from_the_left() {
        for (text, expected) in [
            ("[2+3*4]", 14.0),
            ("[10/4*2]", 5.0),
            ("[2**3**2]", 64.0),
            ("[-2**2]", 4.0),
            ("[2+3*4eq14and1]", 1.0),
            ("[1or0and0]", 0.0),
            ("[3xor0]", 1.0),
            ("[-7mod3]", 2.0),
            ("[1gt2]", 0.0),
            ("[2ge2]", 1.0),
            ("[1.0000009eq1]", 1.0),
            ("[1.000002ne1]", 1.0),
            ("[1.0000009le1]", 1.0),
            ("[1.0000009gt1]", 1.0),
            ("[1-[2-3]]", 2.0),
            ("-[2]", -2.0),
            ("--2", 2.0),
            (".5", 0.5),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn functions_are_in_degrees_and_round_as_the_manual_says() {
        for (text, expected) in [
            ("sin[30]", 0.5),
            ("acos[0.5]", 60.0),
            ("atan[1]/[-1]", 135.0),
            ("round[-2.5]", -3.0),
            ("fix[-2.8]", -3.0),
            ("fup[-2.8]", -2.0),
            ("ln[exp[2]]", 2.0),
            ("sqrt[abs[-9]]", 3.0),
            ("exists[#<one>]", 1.0),
            ("exists[#<two>]", 0.0),
        ] {
            assert!((value(text).unwrap() - expected).abs() < 1e-12, "{text}");
        }
    }

    #[test]
    fn parameters_are_looked_up_and_what_has_no_value_is_reported() {
        assert_eq!(value("#7"), Ok(7.5));
        assert_eq!(value("#[2+3]"), Ok(5.5));
        assert_eq!(value("#<one>"), Ok(1.0));
        assert_eq!(value("##1"), Err(TraceFault::ParameterNumber));
        let mut cursor = Cursor::new("#<two>", &Some);
        assert_eq!((cursor.value(), cursor.unset), (Ok(0.0), vec!["two".into()]));
    }

    #[test]
    fn what_has_no_value_is_refused() {
        for (text, fault) in [
            ("[1/0]", TraceFault::DivisionByZero),
            ("sqrt[-1]", TraceFault::Domain { function: "sqrt" }),
            ("[-8**0.5]", TraceFault::Domain { function: "**" }),
            ("[10**400]", TraceFault::TooLarge),
            ("[1+2", TraceFault::Expected { expected: ']' }),
            ("frac[1]", TraceFault::Function { name: "frac".into() }),
            ("", TraceFault::NumberExpected),
            (".", TraceFault::NumberExpected),
        ] {
            assert_eq!(value(text), Err(fault), "{text}");
        }
        assert_eq!(value(&"[".repeat(5000)), Err(TraceFault::TooDeep));
        assert_eq!(value(&"-".repeat(5000)), Err(TraceFault::TooDeep));
        assert_eq!(value(&"#".repeat(5000)), Err(TraceFault::TooDeep));
    }
}

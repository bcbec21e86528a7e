//! A formula that can be evaluated, with its derivatives.
//!
//! exmex parses and evaluates; what it reads is written here from checked tokens, for two reasons. Its unary operators
//! bind closer than ^ (-r^2 would be (-r)^2) and its powers go from left to right, so a minus is written as the binary
//! `0~r` and a power's exponent is put in parentheses. And no operator is declared commutative: exmex 0.21
//! reorders those next to numbers, and sin(r+1+2) becomes r + sin(3).

use std::fmt::Debug;
use std::num::ParseFloatError;
use std::str::FromStr;

use exmex::{BinOp, Express, FlatEx, MakeOperators, MatchLiteral, Operator};

use super::interval::Interval;
use super::jet::Jet;
use super::number::Number;
use super::refusal::refusal;
use super::series::Series;
use super::tokens::{tokens, Names, Token};
use crate::GeometryError;

/// The operators and functions, on jets and on series.
#[derive(Clone, Debug)]
struct Operators;

/// The operators and functions of a type of operand.
macro_rules! operators {
    ($operand:ty) => {{
        let binary = |name, prio, apply| Operator::make_bin(name, BinOp { apply, prio, is_commutative: false });
        vec![
            binary("^", 5, <$operand>::pow),
            binary("~", 4, |_, x| x.neg()),
            binary("/", 3, <$operand>::div),
            binary("*", 2, <$operand>::mul),
            binary("-", 1, <$operand>::sub),
            binary("+", 0, <$operand>::add),
            Operator::make_unary("sqrt", <$operand>::sqrt),
            Operator::make_unary("exp", <$operand>::exp),
            Operator::make_unary("ln", <$operand>::ln),
            Operator::make_unary("log10", <$operand>::log10),
            Operator::make_unary("sin", <$operand>::sin),
            Operator::make_unary("cos", <$operand>::cos),
            Operator::make_unary("tan", <$operand>::tan),
            Operator::make_unary("asin", <$operand>::asin),
            Operator::make_unary("acos", <$operand>::acos),
            Operator::make_unary("atan", <$operand>::atan),
            Operator::make_unary("sinh", <$operand>::sinh),
            Operator::make_unary("cosh", <$operand>::cosh),
            Operator::make_unary("tanh", <$operand>::tanh),
        ]
    }};
}

impl<T: Number> MakeOperators<Jet<T>> for Operators {
    fn make<'a>() -> Vec<Operator<'a, Jet<T>>> {
        operators!(Jet<T>)
    }
}

impl MakeOperators<Series> for Operators {
    fn make<'a>() -> Vec<Operator<'a, Series>> {
        operators!(Series)
    }
}

/// Numbers as [`canonical`] writes them: 1.5e-3.
#[derive(Clone, Debug)]
struct Literals;

impl MatchLiteral for Literals {
    fn is_literal(text: &str) -> Option<&str> {
        let mantissa = text.bytes().take_while(|b| b.is_ascii_digit() || *b == b'.').count();
        let exponent = text.get(mantissa..)?.strip_prefix('e')?;
        let sign = usize::from(exponent.starts_with('-'));
        let digits = exponent.bytes().skip(sign).take_while(u8::is_ascii_digit).count();
        (mantissa > 0).then(|| text.get(..mantissa + 1 + sign + digits)).flatten()
    }
}

/// What exmex makes of a formula.
type Parsed<T> = FlatEx<T, Operators, Literals>;

/// What a formula is evaluated on.
trait Operand: Copy + Debug + Default + FromStr<Err = ParseFloatError> {}

impl<T: Number> Operand for Jet<T> {}
impl Operand for Series {}

/// A function of up to two variables.
#[derive(Clone, Debug)]
pub(super) struct Expression {
    parsed: Parsed<Jet>,
    /// The same on intervals: exmex folds constants, so that its numbers are of one type.
    enclosing: Parsed<Jet<Interval>>,
    /// The same on Taylor series.
    series: Parsed<Series>,
    /// For each variable that occurs, which of the two it is.
    slots: Vec<usize>,
    /// How many operators and functions an evaluation takes.
    pub operations: usize,
}

impl Expression {
    /// Reads the formula of a key.
    pub fn new(text: &str, names: &Names) -> Result<Self, GeometryError> {
        let tokens = tokens(text, names)?;
        let canonical = canonical(&tokens);
        let parsed: Parsed<Jet> = parse(&canonical, names)?;
        let enclosing = parse(&canonical, names)?;
        let series = parse(&canonical, names)?;
        let slot = |name: &String| names.variables.iter().position(|variable| variable == name);
        let slots = parsed.var_names().iter().filter_map(slot).collect();
        let operations = tokens.iter().filter(|token| matches!(token, Token::Operator(_) | Token::Function(_))).count();
        Ok(Self { parsed, enclosing, series, slots, operations })
    }

    /// Value and derivatives by the variables, in the order of [`Names::variables`].
    pub fn at(&self, first: f64, second: f64) -> Jet {
        self.jets(&self.parsed, [first, second])
    }

    /// Intervals that hold value and derivatives everywhere over the box of the two variables.
    ///
    /// The formula's numbers are the f64 nearest to what was written.
    pub fn over(&self, first: Interval, second: Interval) -> Jet<Interval> {
        self.jets(&self.enclosing, [first, second])
    }

    /// The series of the formula, its variables being series of another one.
    pub fn along(&self, first: Series, second: Series) -> Series {
        self.evaluated(&self.series, [first, second]).unwrap_or_else(Series::undecided)
    }

    fn jets<T: Number>(&self, parsed: &Parsed<Jet<T>>, [first, second]: [T; 2]) -> Jet<T> {
        self.evaluated(parsed, [Jet::variable(first, 0), Jet::variable(second, 1)]).unwrap_or_else(Jet::nan)
    }

    fn evaluated<T: Operand>(&self, parsed: &Parsed<T>, inputs: [T; 2]) -> Option<T>
    where
        Operators: MakeOperators<T>,
    {
        let mut given = inputs;
        for (value, &slot) in given.iter_mut().zip(&self.slots) {
            *value = inputs[slot.min(1)];
        }
        parsed.eval(&given[..self.slots.len().min(2)]).ok()
    }
}

fn parse<T: Operand>(canonical: &str, names: &Names) -> Result<Parsed<T>, GeometryError>
where
    Operators: MakeOperators<T>,
{
    FlatEx::parse(canonical).map_err(|error| {
        refusal(names.key.to_owned(), error.msg().to_owned(), "simplify the formula, and report this one")
    })
}

/// The tokens as exmex reads them as people read them.
fn canonical(tokens: &[Token]) -> String {
    let mut writer = Writer { text: String::new(), pending: vec![0], minus: false, operand_next: true };
    for token in tokens {
        writer.write(token);
    }
    writer.end_powers();
    writer.text
}

struct Writer {
    text: String,
    /// Exponents still open, for each level of parentheses.
    pending: Vec<usize>,
    /// An odd number of minus signs stands before the next operand.
    minus: bool,
    operand_next: bool,
}

impl Writer {
    fn write(&mut self, token: &Token) {
        match token {
            Token::Operator('-') if self.operand_next => self.minus = !self.minus,
            Token::Operator('+') if self.operand_next => {}
            Token::Operator('^') => {
                self.text.push_str("^(");
                if let Some(pending) = self.pending.last_mut() {
                    *pending += 1;
                }
                self.operand_next = true;
            }
            Token::Operator(symbol) => {
                self.end_powers();
                self.text.push(*symbol);
                self.operand_next = true;
            }
            Token::Close => {
                self.end_powers();
                self.pending.pop();
                self.text.push(')');
            }
            operand => self.operand(operand),
        }
    }

    fn operand(&mut self, token: &Token) {
        if std::mem::take(&mut self.minus) {
            self.text.push_str("0e0~");
        }
        self.operand_next = *token == Token::Open;
        match token {
            Token::Number(value) if value.is_sign_negative() => self.text.push_str(&format!("(0e0~{:e})", -value)),
            Token::Number(value) => self.text.push_str(&format!("{value:e}")),
            Token::Variable(name) | Token::Function(name) => self.text.push_str(name),
            _ => {
                self.pending.push(0);
                self.text.push('(');
            }
        }
    }

    fn end_powers(&mut self) {
        let pending = self.pending.last_mut().map(std::mem::take).unwrap_or_default();
        self.text.push_str(&")".repeat(pending));
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

    fn read(text: &str) -> Result<Expression, GeometryError> {
        let parameters = BTreeMap::from([("a".to_owned(), 3.0), ("low".to_owned(), -2.0)]);
        Expression::new(text, &Names { key: "z", variables: &["r", "s"], parameters: &parameters })
    }

    fn value(text: &str) -> f64 {
        read(text).unwrap().at(0.5, 0.25).value
    }

    #[test]
    fn formulas_mean_what_people_write() {
        for (text, expected) in [
            ("-r^2", -0.25),
            ("2-r^2", 1.75),
            ("2^3^2", 512.0),
            ("2^-r^2", libm::pow(2.0, -0.25)),
            ("(-r)^2", 0.25),
            ("--r", 0.5),
            ("1 - -+-r", 0.5),
            ("2*-r^2/4", -0.125),
            ("1e-3*r", 0.0005),
            ("2.E+1*r", 10.0),
            ("sin(r+1+2)", libm::sin(3.5)),
            ("sqrt(r*2*3)^2", 3.0),
            ("-(r+1+2)", -3.5),
            ("r-2+3-1", 0.5),
            ("r/2/5*10", 0.5),
            ("low^2 - a*low", 10.0),
            ("r^low^2", 0.0625),
            ("2*e - e*2 + pi - pi + s", 0.25),
            ("exp(ln(r))^(1+1)*2", 0.5),
        ] {
            let found = value(text);
            assert!((found - expected).abs() < 1e-14, "{text}: {found}, not {expected}");
        }
    }

    #[test]
    fn towers_of_powers_are_infinite_at_once() {
        assert!(value("9^9^9^9^9").is_infinite());
    }

    #[test]
    fn mistakes_are_named_with_their_place() {
        for (text, expected) in [
            ("", "z, character 1: the formula ends too early"),
            ("2r", "z, character 2: an operator is missing"),
            ("sin r", "z, character 5: a function needs ( )"),
            ("r + abs(r)", "z, character 5: `abs` is not known here"),
            ("sqr(r)", "did you mean `sqrt`?"),
            ("log(r)", "did you mean `log10`?"),
            ("r**2", "a power is r^2"),
            ("(r", "z, character 3: `(` is not closed"),
            ("r)", "z, character 2: `)` closes nothing"),
            ("()", "z, character 2: a number or a name is missing"),
            ("r < 2", "z, character 3: `<` is not allowed"),
            ("1,5*r", "the decimal sign is a point"),
            ("1.2.3", "z, character 4: an operator is missing"),
            ("r\u{b2}", "z, character 2: `\u{b2}` is not allowed"),
            ("1e999", "is not a number"),
            (".", "is not a number"),
            ("sin", "ends too early"),
            ("{r}", "`{` is not allowed"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }

    #[test]
    fn limits_come_before_parsing() {
        let deep = |n: usize| format!("{}r{}", "(".repeat(n), ")".repeat(n));
        assert!((read(&deep(64)).unwrap().at(0.5, 0.0).value - 0.5).abs() < 1e-16);
        assert!(read(&deep(65)).unwrap_err().to_string().contains("deeper than 64"));
        assert!(read(&"(".repeat(1_000_000)).unwrap_err().to_string().contains("longer than 2000"));
        assert!(read(&vec!["r"; 300].join("+")).unwrap_err().to_string().contains("more than 150"));
    }

    /// A formula and, worked out apart from it, its value at r = 0.5, s = 0.25.
    fn formula() -> impl Strategy<Value = (String, f64)> {
        let leaf = prop_oneof![
            Just(("r".to_owned(), 0.5)),
            Just(("s".to_owned(), 0.25)),
            Just(("a".to_owned(), 3.0)),
            (1u32..40).prop_map(|n| (format!("{}", f64::from(n) / 8.0), f64::from(n) / 8.0)),
        ];
        leaf.prop_recursive(5, 40, 2, |inner| {
            prop_oneof![
                (inner.clone(), inner.clone()).prop_map(|(x, y)| (format!("({}+{})", x.0, y.0), x.1 + y.1)),
                (inner.clone(), inner.clone(), inner.clone())
                    .prop_map(|(x, y, w)| (format!("({}-{}+{})", x.0, y.0, w.0), x.1 - y.1 + w.1)),
                (inner.clone(), inner.clone(), inner.clone())
                    .prop_map(|(x, y, w)| (format!("sin({}+{}*{})", x.0, y.0, w.0), libm::sin(x.1 + y.1 * w.1))),
                (inner.clone(), inner.clone(), inner.clone())
                    .prop_map(|(x, y, w)| (format!("atan({}*{}/{})", x.0, y.0, w.0), libm::atan(x.1 * y.1 / w.1))),
                (inner.clone(), inner.clone(), inner.clone())
                    .prop_map(|(x, y, w)| (format!("({}+{}+{})", x.0, y.0, w.0), x.1 + y.1 + w.1)),
                inner.clone().prop_map(|x| (format!("(-{}^2)", x.0), -(x.1 * x.1))),
                inner.prop_map(|x| (format!("cos(-{})", x.0), libm::cos(x.1))),
            ]
        })
    }

    proptest! {
        #[test]
        fn values_are_those_worked_out_apart((text, expected) in formula()) {
            prop_assume!(text.len() < 2000 && expected.is_finite());
            let found = value(&text);
            prop_assert!((found - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{text}: {found} {expected}");
        }

        #[test]
        fn any_text_is_read_or_refused(text in "\\PC{0,80}") {
            let _ = read(&text);
        }

        #[test]
        fn any_text_of_formula_characters_is_read_or_refused(text in "[-+*/^()rsae0-9. ]{0,60}|((sin|ln)?[(]?[rs2][)]?[-+*/^]?){0,30}") {
            if let Ok(expression) = read(&text) {
                let _ = expression.at(0.5, 0.25);
            }
        }
    }
}

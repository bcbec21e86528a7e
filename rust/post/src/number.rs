//! Numbers as a controller reads them, written from whole counts of the last decimal.

use crate::machine::{NumberRules, Point, TrailingZeros};

/// Most decimal places that a machine file may ask for.
pub(crate) const MAX_DECIMALS: u8 = 8;

/// Decimal places of a wait, s.
pub(crate) const DWELL_PLACES: u8 = 3;
/// Decimal places of a thread's pitch.
pub(crate) const PITCH_PLACES: u8 = 6;

/// Largest count of last decimals that is taken: every whole number up to here is exact in an f64.
const LARGEST: f64 = 9.0e15;

/// How one kind of number is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NumberFormat {
    decimals: u8,
    units_per_one: u64,
    point_always: bool,
    keep_zeros: bool,
    leading_zero: bool,
    plus_sign: bool,
}

impl NumberFormat {
    /// Numbers with `decimals` places by a machine's rules.
    pub(crate) fn new(rules: &NumberRules, decimals: u8) -> Self {
        let decimals = decimals.min(MAX_DECIMALS);
        Self {
            decimals,
            units_per_one: 10_u64.pow(u32::from(decimals)),
            point_always: rules.point == Point::Always,
            keep_zeros: rules.trailing_zeros == TrailingZeros::Keep,
            leading_zero: rules.leading_zero,
            plus_sign: rules.plus_sign,
        }
    }

    /// Whole numbers, as in tool numbers and speeds without places: never a point or a sign.
    pub(crate) fn plain(decimals: u8) -> Self {
        let decimals = decimals.min(MAX_DECIMALS);
        Self {
            decimals,
            units_per_one: 10_u64.pow(u32::from(decimals)),
            point_always: false,
            keep_zeros: false,
            leading_zero: true,
            plus_sign: false,
        }
    }

    /// The same without a `+`: for numbers that have no sign.
    pub(crate) fn unsigned(self) -> Self {
        Self { plus_sign: false, ..self }
    }

    /// How many units of the last decimal one whole unit has.
    #[allow(clippy::cast_precision_loss)] // at most 1e8
    pub(crate) fn per_one(&self) -> f64 {
        self.units_per_one as f64
    }

    /// `value` in units of the last decimal, rounded half away from zero; none when it is not finite or too large.
    pub(crate) fn count(&self, value: f64) -> Option<i64> {
        whole(value * self.per_one())
    }

    /// A count of last decimals as text.
    pub(crate) fn text(&self, count: i64) -> String {
        let mut out = String::new();
        self.write(&mut out, count);
        out
    }

    /// A value as text; 0 for one that is not finite or too large.
    pub(crate) fn text_of(&self, value: f64) -> String {
        self.text(self.count(value).unwrap_or_default())
    }

    /// Writes a count of last decimals.
    pub(crate) fn write(&self, out: &mut String, count: i64) {
        if count < 0 {
            out.push('-');
        } else if self.plus_sign {
            out.push('+');
        }
        let magnitude = count.unsigned_abs();
        let (integer, fraction) = (magnitude / self.units_per_one, magnitude % self.units_per_one);
        let has_fraction = fraction != 0 || (self.keep_zeros && self.decimals > 0);
        if integer != 0 || self.leading_zero || !has_fraction {
            write_integer(out, integer);
        }
        if has_fraction {
            self.write_fraction(out, fraction);
        } else if self.point_always {
            out.push('.');
        }
    }

    fn write_fraction(&self, out: &mut String, fraction: u64) {
        out.push('.');
        let (mut rest, mut place) = (fraction, self.units_per_one / 10);
        while place > 0 && (rest > 0 || self.keep_zeros) {
            push_digit(out, rest / place);
            rest %= place;
            place /= 10;
        }
    }
}

/// `value` as the nearest whole number, halves away from zero; none when it is not finite or too large.
#[allow(clippy::cast_possible_truncation)] // the size is checked
pub(crate) fn whole(value: f64) -> Option<i64> {
    let rounded = value.round();
    (rounded.abs() <= LARGEST).then_some(rounded as i64)
}

/// Writes a whole number.
pub(crate) fn write_integer(out: &mut String, value: u64) {
    let mut place = 1;
    while value / place >= 10 {
        place *= 10;
    }
    let mut rest = value;
    while place > 0 {
        push_digit(out, rest / place);
        rest %= place;
        place /= 10;
    }
}

#[allow(clippy::cast_possible_truncation)] // a digit
fn push_digit(out: &mut String, digit: u64) {
    out.push(char::from(b'0' + (digit % 10) as u8));
}

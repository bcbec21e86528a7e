//! Numbers as they are written.

use crate::read_error::ReadFault;

/// Most decimal places of a number, and the smallest number of as many digits: fifteen digits are exact in an f64.
const MAX_PLACES: u8 = 15;
const FIFTEEN_DIGITS: i64 = 100_000_000_000_000;

const POWERS_OF_TEN: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// A decimal number as written: `mantissa / 10^places`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number {
    mantissa: i64,
    places: u8,
    /// Whether it has a decimal point.
    pointed: bool,
}

impl Number {
    /// A whole number.
    pub(crate) fn whole(value: i64) -> Self {
        Self { mantissa: value, places: 0, pointed: false }
    }

    /// The nearest f64.
    #[allow(clippy::cast_precision_loss)] // below 2^53
    pub(crate) fn value(self) -> f64 {
        let divisor = POWERS_OF_TEN.get(usize::from(self.places)).copied().unwrap_or(1.0);
        self.mantissa as f64 / divisor
    }

    /// Whether it has a decimal point.
    pub(crate) fn is_pointed(self) -> bool {
        self.pointed
    }

    /// Ten times the number, when that is whole: 591 for 59.1.
    pub(crate) fn tenths(self) -> Option<i64> {
        let Some(excess) = self.places.checked_sub(1) else { return Some(self.mantissa * 10) };
        let divisor = 10_i64.pow(u32::from(excess));
        (self.mantissa % divisor == 0).then_some(self.mantissa / divisor)
    }

    /// The number, when it is whole and not negative.
    pub(crate) fn natural(self) -> Option<u32> {
        let tenths = self.tenths().filter(|t| t % 10 == 0)?;
        u32::try_from(tenths / 10).ok()
    }
}

/// Something in a line that cannot be read, and the bytes where it stands.
#[derive(Debug)]
pub(crate) struct Misfit {
    pub(crate) fault: ReadFault,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// A number from `start` on, and where it ends. White space may stand before it; inside, some controllers end there.
pub(crate) fn cut_number(bytes: &[u8], start: usize) -> Result<(Number, usize), Misfit> {
    let (mut at, mut end) = (start, start);
    let (mut mantissa, mut places) = (0_i64, 0_u8);
    let (mut negative, mut signed, mut digits, mut point) = (false, false, false, false);
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'0'..=b'9' => {
                if mantissa >= FIFTEEN_DIGITS || places == MAX_PLACES {
                    return Err(Misfit { fault: ReadFault::NumberTooLong, start, end: at + 1 });
                }
                mantissa = mantissa * 10 + i64::from(byte - b'0');
                places += u8::from(point);
                digits = true;
            }
            b'.' if !point => point = true,
            b'-' | b'+' if !signed && !digits && !point => {
                negative = *byte == b'-';
                signed = true;
            }
            b' ' | b'\t' if !digits && !signed && !point => {}
            _ => break,
        }
        at += 1;
        end = at;
    }
    let next = bytes.get(at..).unwrap_or_default().iter().position(|b| !b.is_ascii_whitespace());
    if let Some(more) = next.filter(|gap| *gap > 0).and_then(|gap| bytes.get(at + gap)) {
        if more.is_ascii_digit() || *more == b'.' {
            return Err(Misfit { fault: ReadFault::SpaceInNumber, start, end });
        }
    }
    if !digits {
        let end = bytes.get(at).map_or(bytes.len(), |_| at);
        return Err(Misfit { fault: ReadFault::NumberExpected, start, end });
    }
    Ok((Number { mantissa: if negative { -mantissa } else { mantissa }, places, pointed: point }, end))
}

/// A word of a machine file, `G59.1`: its letter and ten times its number.
pub(crate) fn code(word: &str) -> Option<(u8, i64)> {
    let letter = *word.as_bytes().first().filter(|b| b.is_ascii_uppercase())?;
    let (number, end) = cut_number(word.as_bytes(), 1).ok()?;
    let plain = end == word.len() && !word.contains([' ', '\t', '+', '-']);
    plain.then_some((letter, number.tenths()?))
}

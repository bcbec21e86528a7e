//! The words of a block, with their values.

use super::codes::known_g;
use super::expression::{natural, Cursor, Key, Values};
use super::fault::TraceFault;
use crate::block::{once, Code, Twice, Words};

/// A block with its values worked out.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    /// By letter, but for G, M, N and O.
    words: Words<f64>,
    /// `@`.
    pub(super) distance: Option<f64>,
    /// `^`, degrees.
    pub(super) angle: Option<f64>,
    /// `$`: the spindle that S, M3, M4 and M5 are for.
    spindle: Option<f64>,
    /// Numbers of the G words in tenths, in order.
    pub(super) g: Vec<u32>,
    /// Numbers of the M words, in order.
    pub(super) m: Vec<u32>,
    /// Parameters that are set once the block is read.
    pub(super) sets: Vec<(Key, f64)>,
    /// Names that were asked for and have no value.
    pub(super) unset: Vec<String>,
}

impl Block {
    pub(super) fn read(code: &str, values: &dyn Values) -> Result<Self, TraceFault> {
        let mut block = Self::default();
        let mut cursor = Cursor::new(code, values);
        while let Some(byte) = cursor.next() {
            match byte {
                b'#' => {
                    let key = cursor.parameter_key()?;
                    block.sets.push((key, cursor.assigned()?));
                }
                b'g' => block.g.push(tenths(cursor.value()?)?),
                b'm' => block.m.push(whole(cursor.value()?, "M")?),
                b'@' => once(&mut block.distance, cursor.value()?).map_err(twice('@'))?,
                b'$' => once(&mut block.spindle, cursor.value()?).map_err(twice('$'))?,
                b'^' => once(&mut block.angle, cursor.value()?).map_err(twice('^'))?,
                b'a'..=b'z' if !matches!(byte, b'n' | b'o') => {
                    let letter = char::from(byte.to_ascii_uppercase());
                    let value = cursor.value()?;
                    block.words.put(byte, value).map_err(twice(letter))?;
                }
                _ => return Err(TraceFault::Character { character: character_at(code, byte) }),
            }
        }
        block.unset = cursor.unset;
        Ok(block)
    }

    /// The value of a word, by its small letter.
    pub(super) fn word(&self, letter: u8) -> Option<f64> {
        self.words.get(letter)
    }

    /// I, J and K.
    pub(super) fn offsets(&self) -> [Option<f64>; 3] {
        self.words.offsets()
    }

    /// Whether one of its G words asks for this.
    pub(super) fn has(&self, code: Code) -> bool {
        self.codes().any(|known| known == code)
    }

    /// Whether one of its G words is this one, in tenths: for codes that mean nothing to others.
    pub(super) fn has_g(&self, code: u32) -> bool {
        self.g.contains(&code)
    }

    pub(super) fn has_m(&self, code: u32) -> bool {
        self.m.contains(&code)
    }

    /// What its G words ask for, as far as they are known.
    pub(super) fn codes(&self) -> impl Iterator<Item = Code> + '_ {
        self.g.iter().filter_map(|code| known_g(*code))
    }

    /// X, Y and Z.
    pub(super) fn axes(&self) -> [Option<f64>; 3] {
        self.words.axes()
    }

    /// Whether its words for a spindle are for the first one, the only one that is shown.
    pub(super) fn first_spindle(&self) -> bool {
        self.spindle.is_none_or(|number| number <= 0.0)
    }

    /// Whether any word names a position.
    pub(super) fn positions(&self) -> bool {
        self.axes().iter().any(Option::is_some) || self.distance.is_some() || self.angle.is_some() || self.turns()
    }

    /// Whether it has words of axes that are not shown.
    pub(super) fn turns(&self) -> bool {
        b"abcuvw".iter().any(|letter| self.word(*letter).is_some())
    }

    /// A whole word.
    pub(super) fn count(&self, letter: u8, what: &'static str) -> Result<Option<u32>, TraceFault> {
        self.word(letter).map(|value| whole(value, what)).transpose()
    }
}

fn twice(letter: char) -> impl Fn(Twice) -> TraceFault {
    move |Twice| TraceFault::WordTwice { letter }
}

fn whole(value: f64, what: &'static str) -> Result<u32, TraceFault> {
    natural(value).and_then(|value| u32::try_from(value).ok()).ok_or(TraceFault::NotNatural { what })
}

fn tenths(value: f64) -> Result<u32, TraceFault> {
    whole(value * 10.0, "G")
}

/// The character that a byte belongs to: beyond ASCII the first such one.
fn character_at(code: &str, byte: u8) -> char {
    if byte.is_ascii() {
        char::from(byte)
    } else {
        code.chars().find(|character| !character.is_ascii()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Twice;

    impl Values for Twice {
        fn numbered(&self, number: usize) -> Option<f64> {
            Some(2.0 * number as f64)
        }

        fn named(&self, _: &str) -> Option<f64> {
            None
        }
    }

    #[test]
    fn words_have_values_and_settings_wait() {
        let block = Block::read("g38.2x#3y[1+1]#3=7#4=#3m3", &Twice).unwrap();
        assert_eq!((block.g.as_slice(), block.m.as_slice()), ([382].as_slice(), [3].as_slice()));
        assert_eq!((block.word(b'x'), block.word(b'y'), block.word(b'z')), (Some(6.0), Some(2.0), None));
        assert_eq!(block.sets, [(Key::Numbered(3), 7.0), (Key::Numbered(4), 6.0)]);
    }

    #[test]
    fn a_word_stands_once() {
        assert_eq!(Block::read("x1x2", &Twice).unwrap_err(), TraceFault::WordTwice { letter: 'X' });
        assert_eq!(Block::read("x1ü", &Twice).unwrap_err(), TraceFault::Character { character: 'ü' });
        assert_eq!(Block::read("deargcode", &Twice).unwrap_err(), TraceFault::Function { name: "eargcode".into() });
    }
}

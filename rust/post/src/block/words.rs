//! The words of a block, by their letters.

/// A value for each letter, which stands once in a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Words<V>([Option<V>; 26]);

/// A letter that stands twice in a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Twice;

impl<V: Copy> Words<V> {
    /// The value of a letter, a capital or not; none for what is no letter.
    pub fn get(&self, letter: u8) -> Option<V> {
        self.0.get(index(letter)).copied().flatten()
    }

    /// The same, taken out.
    pub fn take(&mut self, letter: u8) -> Option<V> {
        self.0.get_mut(index(letter)).and_then(Option::take)
    }

    /// Puts in a value, in place of another one.
    pub fn set(&mut self, letter: u8, value: V) {
        if let Some(slot) = self.0.get_mut(index(letter)) {
            *slot = Some(value);
        }
    }

    pub fn put(&mut self, letter: u8, value: V) -> Result<(), Twice> {
        self.0.get_mut(index(letter)).map_or(Err(Twice), |slot| once(slot, value))
    }

    /// X, Y and Z.
    pub fn axes(&self) -> [Option<V>; 3] {
        [b'X', b'Y', b'Z'].map(|letter| self.get(letter))
    }

    /// I, J and K.
    pub fn offsets(&self) -> [Option<V>; 3] {
        [b'I', b'J', b'K'].map(|letter| self.get(letter))
    }
}

impl<V> Default for Words<V> {
    fn default() -> Self {
        Self([const { None }; 26])
    }
}

/// Puts a value into a slot that is free.
pub(crate) fn once<V>(slot: &mut Option<V>, value: V) -> Result<(), Twice> {
    slot.replace(value).map_or(Ok(()), |_| Err(Twice))
}

fn index(letter: u8) -> usize {
    usize::from(letter.to_ascii_uppercase().wrapping_sub(b'A'))
}

//! Sets of characters as machine files write them.

/// The ranges of a set: `A-Z0-9 .,-`, where a `-` at an end is itself.
pub(crate) fn ranges(set: &str) -> Vec<(char, char)> {
    let characters: Vec<char> = set.chars().collect();
    let mut rest = characters.as_slice();
    let mut out = Vec::new();
    loop {
        match rest {
            [a, '-', b, tail @ ..] => {
                out.push((*a, *b));
                rest = tail;
            }
            [a, tail @ ..] => {
                out.push((*a, *a));
                rest = tail;
            }
            [] => return out,
        }
    }
}

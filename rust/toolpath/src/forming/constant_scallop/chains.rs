//! Lines through what lies beside one another.

use std::collections::BTreeMap;

/// What lies beside each of some things, both ways.
pub struct Beside<K>(BTreeMap<K, Vec<K>>);

impl<K: Ord + Copy> Beside<K> {
    /// Of pairs.
    pub fn of(pairs: impl Iterator<Item = [K; 2]>) -> Self {
        let mut beside: BTreeMap<K, Vec<K>> = BTreeMap::new();
        for [a, b] in pairs {
            beside.entry(a).or_default().push(b);
            beside.entry(b).or_default().push(a);
        }
        Self(beside)
    }

    /// Lines over all pairs, each of which is in one of them: from ends and branches on, then those that are closed and repeat
    /// where they begin.
    pub fn chains(mut self) -> Vec<Vec<K>> {
        let ends: Vec<K> = self.0.iter().filter(|(_, others)| others.len() != 2).map(|(own, _)| *own).collect();
        let all: Vec<K> = self.0.keys().copied().collect();
        let mut chains = Vec::new();
        for begin in &ends {
            while let Some(chain) = self.walk(*begin, &ends) {
                chains.push(chain);
            }
        }
        for begin in all {
            while let Some(chain) = self.walk(begin, &ends) {
                chains.push(chain);
            }
        }
        chains
    }

    /// The line from `begin` on to the next of the `ends`, ascending; its pairs are taken away. None where no pair is left.
    fn walk(&mut self, begin: K, ends: &[K]) -> Option<Vec<K>> {
        let mut chain = vec![begin];
        let mut at = begin;
        while let Some(next) = self.0.get_mut(&at).and_then(Vec::pop) {
            if let Some(back) = self.0.get_mut(&next) {
                back.retain(|other| *other != at);
            }
            chain.push(next);
            at = next;
            if ends.binary_search(&at).is_ok() {
                break;
            }
        }
        (chain.len() > 1).then_some(chain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_go_from_branch_to_branch_and_around() {
        let pairs = [[1, 2], [2, 3], [3, 4], [3, 5], [7, 8], [8, 9], [9, 7]];
        let mut chains = Beside::of(pairs.into_iter()).chains();
        chains.iter_mut().for_each(|chain| {
            if chain.first() > chain.last() {
                chain.reverse();
            }
        });
        chains.sort();
        assert_eq!(chains.len(), 4);
        assert_eq!(chains[..3], [vec![1, 2, 3], vec![3, 4], vec![3, 5]]);
        assert_eq!((chains[3].len(), chains[3][0]), (4, 7));
    }
}

//! Things sorted by number, one after the other in memory.

/// Things by number, in the order in which they came.
pub struct Sorted<T> {
    /// Where those of each number begin.
    starts: Vec<u32>,
    things: Vec<T>,
}

impl<T> Default for Sorted<T> {
    fn default() -> Self {
        Self { starts: vec![0], things: Vec::new() }
    }
}

impl<T: Copy> Sorted<T> {
    /// Sorts things that each have some numbers, from and to, below `count`.
    pub fn of<'t>(found: impl Iterator<Item = &'t (T, [u32; 2])> + Clone, count: usize) -> Self
    where
        T: 't,
    {
        let mut starts = vec![0; count + 1];
        for (_, [from, to]) in found.clone() {
            (*from..=*to).for_each(|number| starts[number as usize + 1] += 1);
        }
        for number in 0..count {
            starts[number + 1] += starts[number];
        }
        let mut next: Vec<u32> = starts.clone();
        let total = starts[count] as usize;
        let Some((any, _)) = found.clone().next() else { return Self { starts, things: Vec::new() } };
        let mut things = vec![*any; total];
        for (thing, [from, to]) in found {
            for number in *from..=*to {
                let at = &mut next[number as usize];
                things[*at as usize] = *thing;
                *at += 1;
            }
        }
        Self { starts, things }
    }

    /// Those of a number.
    pub fn at(&self, number: usize) -> &[T] {
        &self.things[self.starts[number] as usize..self.starts[number + 1] as usize]
    }
}

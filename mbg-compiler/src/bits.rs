//! Sets of small numbers, one bit each.

/// Bits of a word.
const WORD: usize = u64::BITS as usize;

/// A set of numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Bits(Vec<u64>);

impl Bits {
    /// Takes a number in.
    pub(crate) fn insert(&mut self, member: usize) {
        self.widen(member / WORD + 1);
        self.0[member / WORD] |= 1 << (member % WORD);
    }

    /// Takes in all that another set holds.
    pub(crate) fn join(&mut self, other: &Self) {
        self.widen(other.0.len());
        self.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a |= b);
    }

    fn widen(&mut self, words: usize) {
        if self.0.len() < words {
            self.0.resize(words, 0);
        }
    }

    /// Whether both hold a number.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).any(|(a, b)| a & b != 0)
    }

    /// How many numbers it holds.
    pub(crate) fn len(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Whether it holds a number.
    pub(crate) fn contains(&self, member: usize) -> bool {
        let word = self.0.get(member / WORD).copied().unwrap_or(0);
        word >> (member % WORD) & 1 == 1
    }

    /// The largest of the numbers.
    pub(crate) fn last(&self) -> Option<usize> {
        let mut words = self.0.iter().enumerate().rev();
        words.find_map(|(place, word)| Some(WORD * place + word.checked_ilog2()? as usize))
    }

    /// The numbers, ascending.
    pub(crate) fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().enumerate().flat_map(|(place, word)| {
            (0..WORD)
                .filter(move |bit| word >> bit & 1 == 1)
                .map(move |bit| WORD * place + bit)
        })
    }
}

impl FromIterator<usize> for Bits {
    fn from_iter<I: IntoIterator<Item = usize>>(members: I) -> Self {
        let mut bits = Self::default();
        members.into_iter().for_each(|it| bits.insert(it));
        bits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_any_width_are_joined_and_compared() {
        let mut small: Bits = [3, 63].into_iter().collect();
        let large: Bits = [64, 200].into_iter().collect();
        assert!(!small.meets(&large) && !large.meets(&small));
        small.join(&large);
        assert!(small.meets(&large) && large.meets(&small));
        assert_eq!(small.iter().collect::<Vec<_>>(), [3, 63, 64, 200]);
        assert_eq!((small.len(), large.len(), Bits::default().len()), (4, 2, 0));
    }

    #[test]
    fn members_are_found_in_any_word() {
        let mut some: Bits = [3, 63, 200].into_iter().collect();
        assert!([3, 63, 200].into_iter().all(|it| some.contains(it)));
        assert!(![0, 64, 199, 1000].into_iter().any(|it| some.contains(it)));
        assert_eq!((some.last(), Bits::default().last()), (Some(200), None));
        some.widen(8);
        assert_eq!(some.last(), Some(200));
    }
}

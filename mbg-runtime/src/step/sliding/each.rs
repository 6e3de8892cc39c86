//! One of something for each surface.

use core::ops::{Deref, DerefMut, Index, IndexMut};

/// One for each of up to so many surfaces, by its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Each<V, const K: usize>([V; K]);

impl<V, const K: usize> Each<V, K> {
    pub(super) fn of(each: impl FnMut(usize) -> V) -> Self {
        Self(core::array::from_fn(each))
    }

    pub(super) fn map<W>(self, of: impl FnMut(V) -> W) -> Each<W, K> {
        Each(self.0.map(of))
    }
}

impl<V: Copy, const K: usize> Each<V, K> {
    /// All the same.
    pub(super) const fn all(value: V) -> Self {
        Self([value; K])
    }
}

impl<const K: usize> Each<usize, K> {
    /// So many places, those first of which less is told.
    pub(super) fn by(count: usize, told: impl Fn(usize) -> f64) -> Self {
        let mut order = Self::of(|place| place);
        for last in 1..count {
            for place in (0..last).rev() {
                let [before, behind] = [order[place], order[place + 1]];
                if told(before).total_cmp(&told(behind)).is_gt() {
                    (order[place], order[place + 1]) = (behind, before);
                }
            }
        }
        order
    }
}

impl<V, const K: usize> Deref for Each<V, K> {
    type Target = [V; K];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<V, const K: usize> DerefMut for Each<V, K> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

impl<'a, V, const K: usize> IntoIterator for &'a Each<V, K> {
    type Item = &'a V;
    type IntoIter = core::slice::Iter<'a, V>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

// No place is beyond the last one, which the compiler does not see: without this each of them would be where a run can panic.
impl<V, const K: usize> Index<usize> for Each<V, K> {
    type Output = V;

    fn index(&self, place: usize) -> &V {
        &self.0[place.min(K.saturating_sub(1))]
    }
}

impl<V, const K: usize> IndexMut<usize> for Each<V, K> {
    fn index_mut(&mut self, place: usize) -> &mut V {
        &mut self.0[place.min(K.saturating_sub(1))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_in_the_order_of_what_is_told() {
        let told = [3.0, -1.0, 2.0, -1.0, 9.0];
        let order = Each::<usize, 5>::by(4, |place| told[place]);
        assert_eq!(*order, [1, 3, 2, 0, 4]);
    }
}

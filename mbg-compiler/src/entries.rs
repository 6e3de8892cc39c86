//! Entries in ascending order: of sparse rows, and of products of powers.

/// Entries that have taken in others: `sum` is given the value at a place, if there is one, and that of the other; what it
/// does not give is left out.
pub(crate) fn merged<K: Copy + Ord, T: Copy>(
    entries: &[(K, T)],
    others: &[(K, T)],
    sum: impl Fn(Option<T>, T) -> Option<T>,
) -> Vec<(K, T)> {
    let mut merged = Vec::with_capacity(entries.len() + others.len());
    let mut rest = entries;
    for &(place, other) in others {
        while let [first, later @ ..] = rest
            && first.0 < place
        {
            merged.push(*first);
            rest = later;
        }
        let mut own = None;
        if let [first, later @ ..] = rest
            && first.0 == place
        {
            own = Some(first.1);
            rest = later;
        }
        if let Some(value) = sum(own, other) {
            merged.push((place, value));
        }
    }
    merged.extend_from_slice(rest);
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_summed_inserted_and_left_out() {
        let sum = |own: Option<i32>, other: i32| {
            let sum = own.unwrap_or(0) + other;
            (sum != 0).then_some(sum)
        };
        let found = merged(
            &[(1, 5), (3, 2), (6, 1)],
            &[(0, 4), (3, -2), (6, 2), (9, 7)],
            sum,
        );
        assert_eq!(found, [(0, 4), (1, 5), (6, 3), (9, 7)]);
        assert_eq!(merged(&[], &[(2, 0)], sum), []);
    }
}

//! Maximum matching of equations with unknowns, by augmenting paths (Kuhn 1955), with neighbours in ascending order,
//! so that equal choices fall the same way every time.

/// The unknown of each equation, as many as there are; none if some equation has no unknown of its own.
#[must_use]
pub fn perfect(incidence: &[Vec<usize>], unknowns: usize) -> Option<Vec<usize>> {
    if incidence.len() == unknowns {
        of_all_equations(incidence, unknowns)
    } else {
        None
    }
}

/// An unknown for each equation, of which there may be fewer; none if some equation has no unknown of its own.
#[must_use]
pub fn of_all_equations(incidence: &[Vec<usize>], unknowns: usize) -> Option<Vec<usize>> {
    let mut equation_of = vec![usize::MAX; unknowns];
    let mut unknown_of = vec![usize::MAX; incidence.len()];
    for (equation, neighbours) in incidence.iter().enumerate() {
        if let Some(&free) = neighbours
            .iter()
            .find(|unknown| equation_of[**unknown] == usize::MAX)
        {
            equation_of[free] = equation;
            unknown_of[equation] = free;
        }
    }
    let mut visited = vec![usize::MAX; unknowns];
    for equation in 0..incidence.len() {
        if unknown_of[equation] == usize::MAX
            && !augment(
                incidence,
                equation,
                &mut equation_of,
                &mut unknown_of,
                &mut visited,
            )
        {
            return None;
        }
    }
    Some(unknown_of)
}

/// One augmenting path from `start`, by depth-first search with a stack of its own.
fn augment(
    incidence: &[Vec<usize>],
    start: usize,
    equation_of: &mut [usize],
    unknown_of: &mut [usize],
    visited: &mut [usize],
) -> bool {
    let mut path: Vec<(usize, usize)> = vec![(start, 0)];
    while let Some(&mut (equation, ref mut position)) = path.last_mut() {
        let Some(&unknown) = incidence[equation].get(*position) else {
            path.pop();
            continue;
        };
        *position += 1;
        if std::mem::replace(&mut visited[unknown], start) == start {
            continue;
        }
        if equation_of[unknown] != usize::MAX {
            path.push((equation_of[unknown], 0));
            continue;
        }
        for &(equation, position) in path.iter().rev() {
            let unknown = incidence[equation][position - 1];
            equation_of[unknown] = equation;
            unknown_of[equation] = unknown;
        }
        return true;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_only_matching_and_refuses_a_deficient_one() {
        assert_eq!(perfect(&[vec![0, 1], vec![0]], 2), Some(vec![1, 0]));
        assert_eq!(perfect(&[vec![0], vec![0]], 2), None);
        assert_eq!(
            perfect(&[vec![0, 1], vec![1, 2], vec![0]], 3),
            Some(vec![1, 2, 0])
        );
    }
}

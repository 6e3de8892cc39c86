//! The paper's theorem by the compiler's identity test: eq. (5) equals eq. (11), and no mutation of either does. Its
//! figures as models: the ground, which drawings are accepted, and that all of them are one program.

mod models;
mod paper {
    mod grounded;
    mod language;
    mod locked;
    mod verdicts;
}

use mbg_compiler::symbolic::identity::identical;
use mbg_compiler::symbolic::{Expression, Factor, Matrix, Pool, Product, Symbol};

/// Eq. (1): rates added axis by axis, each followed by its rotation. Eq. (9): the Jacobian, then all rotations.
fn both_sides(pool: &mut Pool) -> (Matrix, Matrix) {
    let angles = [0, 1, 2].map(|index| pool.symbol(Symbol::State(index)));
    let rates = [3, 4, 5].map(|index| pool.symbol(Symbol::State(index)));
    let turn = |axis: usize| {
        Product::of(Factor::Rotation {
            axis,
            angle: angles[axis],
        })
        .transpose()
    };
    let mut classic = Matrix::column(vec![Expression::ZERO; 3]);
    for (axis, rate) in rates.into_iter().enumerate() {
        classic.entries[axis] = pool.add(classic.entries[axis], rate);
        classic = turn(axis).apply(pool, &classic);
    }
    let jacobian = Factor::GimbalJacobian {
        axes: [0, 1, 2],
        angles,
        transposed: false,
    }
    .to_matrix(pool);
    let relative = jacobian.times(pool, &Matrix::column(rates.to_vec()));
    let proposed = turn(2)
        .then(turn(1))
        .then(turn(0))
        .to_matrix(pool)
        .times(pool, &relative);
    (classic, proposed)
}

/// The terms of eq. (5), each a product with a sign.
fn equation_five(pool: &mut Pool, flipped: Option<usize>, swapped: bool) -> Matrix {
    let angles = [0, 1, 2].map(|index| pool.symbol(Symbol::State(index)));
    let rates = [3, 4, 5].map(|index| pool.symbol(Symbol::State(index)));
    let sines = angles.map(|angle| pool.sine(angle));
    let cosines = angles.map(|angle| pool.cosine(angle));
    let (first, second) = if swapped {
        (cosines, sines)
    } else {
        (sines, cosines)
    };
    let [_, s2, s3] = first;
    let [_, c2, c3] = second;
    let one = Expression::ONE;
    let factors = [
        (0, [c3, c2], 0),
        (0, [s3, one], 1),
        (1, [s3.negated(), c2], 0),
        (1, [c3, one], 1),
        (2, [s2, one], 0),
        (2, [one, one], 2),
    ];
    let mut rows = vec![Expression::ZERO; 3];
    for (number, (row, [a, b], rate)) in factors.into_iter().enumerate() {
        let product = pool.multiply(a, b);
        let term = pool
            .multiply(product, rates[rate])
            .flipped(flipped == Some(number));
        rows[row] = pool.add(rows[row], term);
    }
    Matrix::column(rows)
}

#[test]
fn equation_five_equals_equation_eleven() {
    let mut pool = Pool::new();
    let (classic, proposed) = both_sides(&mut pool);
    let written = equation_five(&mut pool, None, false);
    assert!(identical(&pool, &classic, &proposed));
    assert!(identical(&pool, &classic, &written));
}

#[test]
fn single_mutations_are_found() {
    let mut pool = Pool::new();
    let (classic, proposed) = both_sides(&mut pool);
    // One sign in one of the six terms of eq. (5), against both sides; then one sign in one entry of eq. (8).
    for term in 0..6 {
        let mutated = equation_five(&mut pool, Some(term), false);
        assert!(!identical(&pool, &classic, &mutated), "term {term}");
        assert!(!identical(&pool, &proposed, &mutated), "term {term}");
    }
    let swapped = equation_five(&mut pool, None, true);
    assert!(!identical(&pool, &classic, &swapped));
    let angles = [0, 1, 2].map(|index| pool.symbol(Symbol::State(index)));
    let jacobian = Factor::GimbalJacobian {
        axes: [0, 1, 2],
        angles,
        transposed: false,
    }
    .to_matrix(&mut pool);
    let rates = Matrix::column(
        [3, 4, 5]
            .map(|index| pool.symbol(Symbol::State(index)))
            .to_vec(),
    );
    let turn = Product {
        factors: (0..3)
            .map(|axis| Factor::Rotation {
                axis,
                angle: angles[axis],
            })
            .collect(),
    };
    let turn = turn.transpose().to_matrix(&mut pool);
    let mut mutations = 0;
    for entry in 0..9 {
        let mut mutated = jacobian.clone();
        mutated.entries[entry] = mutated.entries[entry].negated();
        if mutated != jacobian {
            let relative = mutated.times(&mut pool, &rates);
            let turned = turn.times(&mut pool, &relative);
            assert!(
                !identical(&pool, &classic, &turned),
                "entry {entry} of eq. (8)"
            );
            mutations += 1;
        }
        let mut mutated = turn.clone();
        mutated.entries[entry] = mutated.entries[entry].negated();
        let relative = jacobian.times(&mut pool, &rates);
        let turned = mutated.times(&mut pool, &relative);
        assert!(
            !identical(&pool, &classic, &turned),
            "entry {entry} of eq. (10)"
        );
        mutations += 1;
    }
    assert!(
        mutations + 6 >= 20,
        "{mutations} mutations of eq. (8) and eq. (10), six of eq. (5)"
    );
}

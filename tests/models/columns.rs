//! A model whose Jacobians are too large to write out.

use mbg_runtime::{Convertible, Dual, System, mbg};
use nalgebra::SVector;

use crate::references::errors::apart;

const CELLS: usize = 52;

mbg! {
    /// A force on cells that are all joined with each other, through a friction which has no force for a strong push backwards.
    pub(crate) model Mesh {
        let count = 52;
        input force;
        1 slide {
            Se push { effort: force }
            R linear { resistance: 1.0 }
            R parabola { effort: 1.0 * powi(f, 2) }
        }
        cells: for k in 0..count { 0 node { C store { effort: 1.0 * q + 1.0 * powi(q, 3) } } }
        slide -> cells[0].node;
        wires: for k in 0..count {
            others: for j in 0..k {
                1 wire { R loss { resistance: 2.0 } }
                cells[k].node -> wire;
                wire -> cells[j].node;
            }
        }
        output flow = slide.f;
    }
}

mbg! {
    include "tests/models/columns/arm.mbg";

    /// One arm, whose Jacobian is written out.
    #[derivative]
    pub(crate) model One {
        param stiffness: N*m/rad = 2.0;
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 stand[6] { Sf still[6] { flow: 0.0 } }
        1 tip[6];
        arm: Arm { stiffness: stiffness, load: 0.5 } (stand, tip);
    }

    /// Five arms on one stand, of which no two act on each other.
    #[derivative]
    pub(crate) model Five {
        param stiffness: N*m/rad = 2.0;
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 stand[6] { Sf still[6] { flow: 0.0 } }
        arms: for k in 0..5 {
            1 tip[6];
            arm: Arm { stiffness: (1.0 + k) * stiffness, load: 0.5 } (stand, tip);
        }
    }
}

mbg! {
    include "tests/models/columns/arm.mbg";

    /// Two arms, one at the end of the other: what the last joints turn does not turn with the first.
    #[derivative]
    pub(crate) model Row {
        param stiffness: N*m/rad = 2.0;
        causality componentwise;
        gravity [0.0, 0.0, -9.81];
        1 stand[6] { Sf still[6] { flow: 0.0 } }
        1 elbow[6];
        1 tip[6];
        near: Arm { stiffness: stiffness, load: 0.5 } (stand, elbow);
        far: Arm { stiffness: stiffness, load: 0.5 } (elbow, tip);
    }
}

fn effort(x: f64) -> f64 {
    x + x.powi(3)
}

/// The flow of the slide, with its slope by the effort across it: `1 f + 1 f² = effort`.
fn slide(effort: f64) -> [f64; 2] {
    let root = f64::sqrt(1.0 + 4.0 * effort);
    [0.5 * (root - 1.0), 1.0 / root]
}

#[test]
fn jacobians_by_columns_equal_the_closed_form_and_remember_their_loop() {
    let model = Mesh::new(MeshParameters::default()).unwrap();
    let x = SVector::<f64, CELLS>::from_fn(|k, _| 0.3 * (k as f64).sin());
    let u = SVector::from([2.0]);
    let mut memory = Default::default();
    let (derivative, by_state) = model.derivative_and_jacobian(0.0, &x, &u, &mut memory);
    let direct = model.derivative(0.0, &x, &u, &mut Default::default());
    assert!(apart(derivative.as_slice(), direct.as_slice()) < 1e-15);
    let [flow, slope] = slide(2.0 - effort(x[0]));
    let total: f64 = x.iter().copied().map(effort).sum();
    let expected = flow + 0.5 * (total - CELLS as f64 * effort(x[0]));
    assert!((derivative[0] - expected).abs() < 1e-13);
    for column in 0..CELLS {
        let stiffness = 1.0 + 3.0 * x[column] * x[column];
        for row in 0..CELLS {
            let conductance = match (row, column) {
                (0, 0) => -0.5 * (CELLS - 1) as f64 - slope,
                _ if row == column => -0.5 * (CELLS - 1) as f64,
                _ => 0.5,
            };
            let error = by_state[(row, column)] - conductance * stiffness;
            assert!(error.abs() < 1e-13, "{row} {column} {error}");
        }
    }
    let by_input = model.jacobian_input(0.0, &x, &u, &mut memory);
    assert!((by_input[0] - slope).abs() < 1e-15);
    assert_eq!(by_input.iter().filter(|it| **it != 0.0).count(), 1);
    // The last iterations began where the first ended.
    assert!(memory.outcomes()[0].iterations <= 2, "{memory:?}");
}

#[test]
fn jacobians_by_columns_are_in_trouble_where_their_loop_has_no_solution() {
    let model = Mesh::new(MeshParameters::default()).unwrap();
    let x = SVector::<f64, CELLS>::zeros();
    let (possible, impossible) = (SVector::from([2.0]), SVector::from([-1.0]));
    let trouble = |u, memory: &_| model.trouble(0.0, &x, u, memory).is_some();

    let mut memory = Default::default();
    let (derivative, by_state) = model.derivative_and_jacobian(0.0, &x, &impossible, &mut memory);
    assert!(derivative[0].is_nan() && by_state[(0, 0)].is_nan());
    assert!(trouble(&impossible, &memory));
    let by_state = model.jacobian_state(0.0, &x, &possible, &mut memory);
    assert!(!trouble(&possible, &memory) && by_state[(0, 0)].is_finite());

    let by_input = model.jacobian_input(0.0, &x, &impossible, &mut memory);
    assert!(by_input[0].is_nan());
    assert!(trouble(&impossible, &memory));
    let by_input = model.jacobian_input(0.0, &x, &possible, &mut memory);
    assert!(!trouble(&possible, &memory) && by_input[0].is_finite());
}

#[test]
fn a_column_costs_no_more_than_a_derivative() {
    let operations = Mesh::<f64>::META.operations;
    let columns = operations.derivative_and_jacobian - operations.derivative;
    assert!(columns <= CELLS * operations.derivative, "{columns}");
}

/// Of one of the five arms: places of its states, angles before rates.
fn own(arm: usize) -> [usize; 8] {
    std::array::from_fn(|k| 20 * (k / 4) + 4 * arm + k % 4)
}

#[test]
fn what_does_not_act_on_each_other_changes_together() {
    let five = Five::new(FiveParameters::default()).unwrap();
    let x = SVector::<f64, 40>::from_fn(|k, _| 0.7 * (1.3 * k as f64).sin());
    let none = SVector::from([]);
    let (derivative, by_state) = five.derivative_and_jacobian(0.0, &x, &none, &mut ());
    for arm in 0..5 {
        let stiffness = 2.0 * (1.0 + arm as f64);
        let one = One::new(OneParameters { stiffness }).unwrap();
        let x = SVector::<f64, 8>::from(own(arm).map(|k| x[k]));
        let alone = one.derivative_and_jacobian(0.0, &x, &none, &mut ());
        assert!(apart(&own(arm).map(|k| derivative[k]), alone.0.as_slice()) < 1e-13);
        for (column, place) in own(arm).into_iter().enumerate() {
            let found = own(arm).map(|row| by_state[(row, place)]);
            let expected = alone.1.column(column);
            assert!(apart(&found, expected.as_slice()) < 1e-13, "{arm} {column}");
            let others = (0..40).filter(|row| !own(arm).contains(row));
            assert!(others.into_iter().all(|row| by_state[(row, place)] == 0.0));
        }
    }
    let [all, alone] = [Five::<f64>::META, One::<f64>::META].map(|it| it.operations);
    assert!(all.derivative_and_jacobian < 9 * all.derivative, "{all:?}");
    assert!(
        alone.derivative_and_jacobian < all.derivative_and_jacobian,
        "{alone:?}"
    );
}

/// The slope of a derivative along a variable, by dual numbers.
fn by_dual_numbers(row: &Row<f64>, x: &SVector<f64, 16>, variable: usize) -> SVector<f64, 16> {
    let dual = row.converted(Dual::constant);
    let x = SVector::from_fn(|k, _| Dual {
        value: x[k],
        slope: if k == variable { 1.0 } else { 0.0 },
    });
    let derivative = dual.derivative(Dual::constant(0.0), &x, &SVector::from([]), &mut ());
    derivative.map(|it| it.slope)
}

#[test]
fn columns_are_the_same_however_many_are_worked_out_at_once() {
    let row = Row::new(RowParameters::default()).unwrap();
    let x = SVector::<f64, 16>::from_fn(|k, _| 0.7 * (1.3 * k as f64 + 0.2).sin());
    let none = SVector::from([]);
    // As many as a register has lanes, one, and lanes of single precision.
    let (_, together) = row.derivative_and_jacobian(0.0, &x, &none, &mut ());
    let alone = row.converted(Dual::constant).jacobian_state(
        Dual::constant(0.0),
        &x.map(Dual::constant),
        &none.map(Dual::constant),
        &mut (),
    );
    let single = row.converted(|it| it as f32);
    let single = single.jacobian_state(0.0, &x.map(|it| it as f32), &SVector::from([]), &mut ());
    for variable in 0..16 {
        let expected = by_dual_numbers(&row, &x, variable);
        let error = |found: SVector<f64, 16>| apart(found.as_slice(), expected.as_slice());
        assert!(
            error(together.column(variable).into()) < 1e-12,
            "{variable}"
        );
        assert!(
            error(alone.column(variable).map(|it| it.value)) < 1e-12,
            "{variable}"
        );
        assert!(
            error(single.column(variable).map(f64::from)) < 1e-3,
            "{variable}"
        );
    }
}

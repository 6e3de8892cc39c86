//! Equations with known solutions.

use super::*;
use crate::Dual;
use crate::solve::lanes::Pair;

/// Kepler's equation `E − e sin E = M`.
fn kepler<T: Real>(eccentricity: T, mean: T, start: T) -> Solved<T, 1> {
    newton(SVector::from([start]), |x| {
        let (sine, cosine) = x[0].sin_cos();
        (
            SVector::from([x[0] - eccentricity * sine - mean]),
            SMatrix::from([[T::from_f64(1.0) - eccentricity * cosine]]),
        )
    })
}

#[test]
fn kepler_also_for_comets() {
    for eccentricity in [0.0, 0.3, 0.9, 0.999] {
        for k in -30..=30 {
            let mean = 0.1 * f64::from(k);
            let solved = kepler(eccentricity, mean, mean);
            let x = solved.solution[0];
            assert!(solved.converged, "{eccentricity} {mean} {solved:?}");
            // The error of the root is that of rounding divided by the slope there.
            let error = x - eccentricity * x.sin() - mean;
            assert!(error.abs() < 1e-15 * (1.0 + mean.abs()), "{error:e}");
            assert!(solved.residual < 1e-14, "{solved:?}");
        }
    }
}

/// Two turbulent losses in a row and a drop of pressure, `p = f |f| + 0.2 f |f|`.
fn turbulent<T: Real>(drop: T, start: T) -> Solved<T, 1> {
    newton(SVector::from([start]), |x| {
        let size = x[0].abs();
        let losses = T::from_f64(1.2);
        (
            SVector::from([drop - losses * x[0] * size]),
            SMatrix::from([[-losses * T::from_f64(2.0) * size]]),
        )
    })
}

#[test]
fn rest_is_a_solution_where_slopes_are_zero() {
    let solved = turbulent(0.0, 0.0);
    assert!(solved.converged && solved.solution[0] == 0.0, "{solved:?}");
    let solved = turbulent(0.0_f32, 0.0);
    assert!(solved.converged && solved.solution[0] == 0.0, "{solved:?}");
    // There the flow changes infinitely faster than the pressure.
    let solved = turbulent(Dual::variable(0.0), Dual::constant(0.0));
    assert!(solved.converged && solved.solution[0].value == 0.0);
    assert!(solved.solution[0].slope > 1e12, "{solved:?}");
}

#[test]
fn a_step_onto_a_singular_point_goes_on() {
    // Newton's first step leads to rest from one, with these drops of pressure exactly.
    for drop in [-1.2, 1.2, -4.8, -1.3, 1e-9, -1e9] {
        for start in [1.0, -1.0, 2.0] {
            let solved = turbulent(drop, start);
            let exact = f64::signum(drop) * f64::sqrt(f64::abs(drop) / 1.2);
            assert!(solved.converged, "{drop} {start} {solved:?}");
            assert!(
                (solved.solution[0] / exact - 1.0).abs() < 1e-14,
                "{solved:?}"
            );
        }
    }
}

#[test]
fn a_warm_start_takes_two_linearisations() {
    let solved = kepler(0.3, 1.0, kepler(0.3, 1.0, 1.0).solution[0]);
    assert_eq!((solved.iterations, solved.converged), (2, true));
}

#[test]
fn slopes_are_those_of_the_implicit_function_theorem() {
    // dE/de = sin E / (1 − e cos E), from a start that is not converged and from one that is.
    for start in [0.2, kepler(0.6, 0.7, 0.7).solution[0]] {
        let x = kepler(
            Dual::variable(0.6),
            Dual::constant(0.7),
            Dual::constant(start),
        )
        .solution[0];
        let expected = x.value.sin() / (1.0 - 0.6 * x.value.cos());
        assert!((x.slope - expected).abs() < 1e-14, "{x:?} {expected}");
    }
}

#[test]
fn second_derivatives_by_nesting() {
    let constant = |value| Dual::constant(Dual::constant(value));
    let eccentricity = Dual {
        value: Dual::variable(0.6),
        slope: Dual::constant(1.0),
    };
    let x = kepler(eccentricity, constant(0.7), constant(0.7)).solution[0];
    let (sine, cosine) = x.value.value.sin_cos();
    let first = sine / (1.0 - 0.6 * cosine);
    let second = first * (2.0 * cosine - 0.6 * sine * first) / (1.0 - 0.6 * cosine);
    assert!((x.slope.slope - second).abs() < 1e-13, "{x:?} {second}");
}

#[test]
fn single_precision() {
    let solved = kepler(0.9_f32, 0.5, 0.5);
    assert!(solved.converged, "{solved:?}");
    let x = f64::from(solved.solution[0]);
    assert!((x - 0.9 * x.sin() - 0.5).abs() < 2e-7);
}

/// `v − u = R i + V ln(1 + i / I)`, a diode with a series resistor, for the current.
fn rectifier<T: Real>(difference: T, start: T) -> Solved<T, 1> {
    let [resistance, thermal, saturation] = [10.0, 0.025852, 1e-12].map(T::from_f64);
    newton(SVector::from([start]), |i| {
        let one = T::from_f64(1.0);
        let law = resistance * i[0] + thermal * (one + i[0] / saturation).ln();
        let slope = resistance + thermal / (saturation + i[0]);
        (SVector::from([difference - law]), SMatrix::from([[-slope]]))
    })
}

#[test]
fn rectifier_in_both_directions() {
    for difference in [5.0, 0.7, 0.1, 1e-3, 0.0, -0.1, -0.2] {
        let solved = rectifier(difference, 0.0);
        let current: f64 = solved.solution[0];
        let law = 10.0 * current + 0.025852 * (current / 1e-12).ln_1p();
        assert!(solved.converged, "{difference} {solved:?}");
        assert!((law - difference).abs() < 1e-12, "{difference} {solved:?}");
    }
    // The current is that of saturation up to 4e-9 of it; the law is not defined beyond.
    let blocked = rectifier(-0.5, 0.0);
    assert!(
        blocked.converged && (blocked.solution[0] + 1e-12).abs() < 1e-20,
        "{blocked:?}"
    );
}

/// Current and slope of a diode.
fn diode(voltage: f64) -> (f64, f64) {
    let conducted = 1e-12 * (voltage / 0.025).exp();
    (conducted - 1e-12, conducted / 0.025)
}

/// Two diodes in series block 12 V, and some current goes to the node between them: each law is flat to 1e-200.
#[test]
fn what_blocks_lets_hardly_any_current_in() {
    for current in [1e-20, 1e-16, -1e-16, 1e-12, 1e-9, -1e-3] {
        let solved = newton(SVector::from([0.0; 2]), |x: &SVector<f64, 2>| {
            let [first, second] = [diode(x[0]), diode(x[1])];
            (
                SVector::from([first.0 - second.0 - current, x[0] + x[1] + 12.0]),
                SMatrix::from([[first.1, 1.0], [-second.1, 1.0]]),
            )
        });
        let expected = 0.025 * (current.abs() * 1e12).ln();
        let found = solved.solution.max();
        assert!(solved.converged, "{current} {solved:?}");
        assert!((found - expected).abs() < 1e-9, "{current} {solved:?}");
    }
}

#[test]
fn lanes_are_solved_each_for_itself() {
    for differences in [[5.0, -0.1], [-0.2, 1e-3], [0.0, 0.7], [-0.5, 5.0]] {
        let both = rectifier(Pair(differences), Pair([0.0; 2]));
        let alone = differences.map(|difference| rectifier(difference, 0.0).solution[0]);
        assert!(both.converged);
        assert_eq!(both.solution[0].0, alone);
    }
}

/// A lane without a solution has no influence on its neighbour.
#[test]
fn a_lane_that_fails_fails_alone() {
    let alone = rectifier(5.0, 0.0);
    for bad in [f64::NAN, f64::INFINITY] {
        let both = rectifier(Pair([bad, 5.0]), Pair([0.0; 2]));
        assert!(!both.converged && both.solution[0].0[1] == alone.solution[0]);
    }
    let parabola = |offsets: Pair| {
        newton(SVector::from([Pair([0.7; 2])]), move |x| {
            let slope = x[0] + x[0];
            (
                SVector::from([x[0] * x[0] + offsets]),
                SMatrix::from([[slope]]),
            )
        })
    };
    let both = parabola(Pair([-1.0, 1.0]));
    assert!(!both.converged && both.solution[0].0[0] == 1.0, "{both:?}");
}

#[test]
fn rosenbrock_from_the_usual_start() {
    let solved = newton(SVector::from([-1.2, 1.0]), |x: &SVector<f64, 2>| {
        (
            SVector::from([10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]),
            SMatrix::from([[-20.0 * x[0], -1.0], [10.0, 0.0]]),
        )
    });
    assert!(solved.converged);
    assert!((solved.solution - SVector::from([1.0, 1.0])).norm() < 1e-15);
}

/// Broyden's tridiagonal function `(3 − 2xᵢ) xᵢ − xᵢ₋₁ − 2xᵢ₊₁ + 1`, rows scaled by 10³ⁱ.
fn broyden<const K: usize>() {
    let solved = newton(SVector::from([-1.0; K]), |x: &SVector<f64, K>| {
        let weight = |i: usize| 1e3_f64.powi(i as i32);
        let at = |i: Option<usize>| i.and_then(|i| x.get(i)).copied().unwrap_or(0.0);
        let residual = SVector::from_fn(|i, _| {
            let row = (3.0 - 2.0 * x[i]) * x[i] - at(i.checked_sub(1)) - 2.0 * at(Some(i + 1));
            weight(i) * (row + 1.0)
        });
        let jacobian = SMatrix::from_fn(|i, j| {
            weight(i)
                * match (i + 1).cmp(&(j + 1)) {
                    core::cmp::Ordering::Equal => 3.0 - 4.0 * x[i],
                    core::cmp::Ordering::Greater if i == j + 1 => -1.0,
                    core::cmp::Ordering::Less if j == i + 1 => -2.0,
                    _ => 0.0,
                }
        });
        (residual, jacobian)
    });
    assert!(solved.converged, "{solved:?}");
    assert!(
        solved.residual < 1e-14 && solved.iterations < 9,
        "{solved:?}"
    );
}

#[test]
fn one_to_six_unknowns() {
    broyden::<1>();
    broyden::<2>();
    broyden::<3>();
    broyden::<4>();
    broyden::<5>();
    broyden::<6>();
}

#[test]
fn nothing_to_solve() {
    let solved = newton(SVector::<f64, 0>::from([]), |x| {
        (*x, SMatrix::from_element(0.0))
    });
    assert!(solved.converged);
}

#[test]
fn zero_is_a_solution_too() {
    for start in [0.0, 1e-12, 3.0] {
        let solved = newton(SVector::from([start]), |x: &SVector<f64, 1>| {
            // The rounding of 7 that remains at the solution.
            let residual = (x[0] + 7.1) * (x[0] + 7.1) - 7.1 * 7.1 + 1e-16;
            (
                SVector::from([residual]),
                SMatrix::from([[2.0 * (x[0] + 7.1)]]),
            )
        });
        assert!(
            solved.converged && solved.solution[0].abs() < 1e-15,
            "{solved:?}"
        );
    }
}

/// A flow of some 1e-6 m³/s through a pipe, in single precision, or of a picolitre in double.
#[test]
fn small_unknowns_are_solved_as_large_ones_are() {
    fn flow<T: Real>(scale: f64) -> f64 {
        let [drop, smooth, rough] = [5e5, 1e2 / scale, 4e5 / (scale * scale)].map(T::from_f64);
        let solved = newton(SVector::from([T::from_f64(0.0)]), |x| {
            let size = x[0].abs();
            (
                SVector::from([drop - smooth * x[0] - rough * x[0] * size]),
                SMatrix::from([[-smooth - (rough + rough) * size]]),
            )
        });
        assert!(solved.converged, "{solved:?}");
        solved.solution[0].magnitude() / scale
    }
    let expected = flow::<f64>(1.0);
    for power in -18..=3 {
        let scale = 10.0_f64.powi(power);
        assert!(
            (flow::<f64>(scale) / expected - 1.0).abs() < 1e-14,
            "{scale:e}"
        );
        if power > -15 {
            assert!(
                (flow::<f32>(scale) / expected - 1.0).abs() < 1e-6,
                "{scale:e}"
            );
        }
    }
}

/// `f |f| = drop` and `√f = drop` from one, as after a jump of the drop.
#[test]
fn small_unknowns_are_solved_from_large_starts() {
    fn squared<T: Real>(flow: f64) -> Solved<T, 1> {
        let drop = T::from_f64(flow * flow);
        newton(SVector::from([T::from_f64(1.0)]), |x| {
            let size = x[0].abs();
            (
                SVector::from([x[0] * size - drop]),
                SMatrix::from([[size + size]]),
            )
        })
    }
    fn root<T: Real>(flow: f64) -> Solved<T, 1> {
        let drop = T::from_f64(flow.sqrt());
        newton(SVector::from([T::from_f64(1.0)]), |x| {
            let root = x[0].abs().sqrt();
            let signed = root * x[0].sign();
            (
                SVector::from([signed - drop]),
                SMatrix::from([[T::from_f64(0.5) / root]]),
            )
        })
    }
    fn error<T: Real>(solved: Solved<T, 1>, flow: f64) -> f64 {
        assert!(solved.converged, "{solved:?}");
        (solved.solution[0].find(|_| true).unwrap() / flow - 1.0).abs()
    }
    for power in -12..=0 {
        let flow = 10.0_f64.powi(power);
        let errors = [
            error(squared::<f64>(flow), flow),
            error(root::<f64>(flow), flow),
        ];
        assert!(
            errors.iter().all(|error| *error < 1e-14),
            "{flow:e} {errors:?}"
        );
        let errors = [
            error(squared::<f32>(flow), flow),
            error(root::<f32>(flow), flow),
        ];
        assert!(
            errors.iter().all(|error| *error < 1e-6),
            "{flow:e} {errors:?}"
        );
    }
}

#[test]
fn without_a_solution_it_says_so() {
    let parabola = |offset: f64| {
        newton(SVector::from([0.7]), move |x: &SVector<f64, 1>| {
            (
                SVector::from([x[0] * x[0] + offset]),
                SMatrix::from([[2.0 * x[0]]]),
            )
        })
    };
    assert!(parabola(-1.0).converged);
    let solved = parabola(1.0);
    assert!(!solved.converged && solved.residual > 0.1, "{solved:?}");
    let singular = newton(SVector::from([0.0]), |_: &SVector<f64, 1>| {
        (SVector::from([1.0]), SMatrix::from([[0.0]]))
    });
    assert!(!singular.converged, "{singular:?}");
    let nan = newton(SVector::from([0.0]), |_: &SVector<f64, 1>| {
        (SVector::from([f64::NAN]), SMatrix::from([[1.0]]))
    });
    assert!(!nan.converged, "{nan:?}");
}

/// A number that is neither less than another nor not, as an interval may be.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Undecided(f64);

macro_rules! operators {
    ($($name:ident $method:ident),*) => { $(
        impl core::ops::$name for Undecided {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self(core::ops::$name::$method(self.0, other.0))
            }
        }
    )* };
}

operators!(Add add, Sub sub, Mul mul, Div div);

impl core::ops::Neg for Undecided {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl core::ops::AddAssign for Undecided {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl core::ops::SubAssign for Undecided {
    fn sub_assign(&mut self, other: Self) {
        self.0 -= other.0;
    }
}

macro_rules! functions {
    ($($name:ident),*; $($pair:ident),*) => {
        $( fn $name(self) -> Self { Self(Real::$name(self.0)) } )*
        $( fn $pair(self, other: Self) -> Self { Self(Real::$pair(self.0, other.0)) } )*
    };
}

impl Real for Undecided {
    type Lane = f64;
    type Columns = Self;
    type Stages = crate::Four<Self>;

    const SINGULAR: f64 = <f64 as Real>::SINGULAR;
    const EPSILON: f64 = <f64 as Real>::EPSILON;

    fn from_f64(value: f64) -> Self {
        Self(value)
    }

    fn from_lane(number: f64) -> Self {
        Self(number)
    }

    fn in_lane(self, lane: usize) -> Option<f64> {
        self.0.in_lane(lane)
    }

    fn sin_cos(self) -> (Self, Self) {
        (Self(self.0.sin()), Self(self.0.cos()))
    }

    functions!(tan, asin, acos, exp, ln, sqrt, tanh, fraction, abs, sign; atan2, pow, min, max);

    fn select_less(self, _bound: Self, yes: Self, no: Self) -> Self {
        Self(0.5 * (yes.0 + no.0))
    }
}

#[test]
fn comparisons_that_are_not_decided_end_all_the_same() {
    let solved = kepler(Undecided(0.3), Undecided(1.0), Undecided(1.0));
    assert!(
        !solved.converged && solved.iterations <= PASSES,
        "{solved:?}"
    );
}

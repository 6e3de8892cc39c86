//! Initial value problems by extrapolation of Gragg's modified midpoint rule, order 12, in equal steps.
//!
//! Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., II.9: the error of the midpoint rule
//! has an expansion in even powers of the substep, which Aitken and Neville's scheme removes power by power.

/// Numbers of substeps.
const SUBSTEPS: [usize; 6] = [2, 4, 6, 8, 10, 12];

/// The state at `end` of `ẋ = derivative(t, x)` from `x` at `start`, in `steps` equal steps.
pub(crate) fn integrate<const N: usize>(
    derivative: impl Fn(f64, &[f64; N]) -> [f64; N],
    (start, end): (f64, f64),
    steps: usize,
    mut x: [f64; N],
) -> [f64; N] {
    let h = (end - start) / steps as f64;
    for step in 0..steps {
        let t = start + h * step as f64;
        x = extrapolate(&derivative, t, h, &x);
    }
    x
}

fn extrapolate<const N: usize>(
    derivative: &impl Fn(f64, &[f64; N]) -> [f64; N],
    t: f64,
    h: f64,
    x: &[f64; N],
) -> [f64; N] {
    let mut table = SUBSTEPS.map(|count| midpoint(derivative, t, h, x, count));
    for column in 1..table.len() {
        for row in (column..table.len()).rev() {
            let ratio = SUBSTEPS[row] as f64 / SUBSTEPS[row - column] as f64;
            let coarser = table[row - 1];
            for (value, coarser) in table[row].iter_mut().zip(coarser) {
                *value += (*value - coarser) / (ratio * ratio - 1.0);
            }
        }
    }
    table[table.len() - 1]
}

/// `count` substeps, without smoothing.
fn midpoint<const N: usize>(
    derivative: &impl Fn(f64, &[f64; N]) -> [f64; N],
    t: f64,
    h: f64,
    x: &[f64; N],
    count: usize,
) -> [f64; N] {
    let substep = h / count as f64;
    let advance = |x: &[f64; N], h: f64, slope: [f64; N]| -> [f64; N] {
        core::array::from_fn(|i| x[i] + h * slope[i])
    };
    let mut before = *x;
    let mut here = advance(x, substep, derivative(t, x));
    for k in 1..count {
        let slope = derivative(t + substep * k as f64, &here);
        (before, here) = (here, advance(&before, 2.0 * substep, slope));
    }
    here
}

/// The same by the classical method of Runge and Kutta, of order 4: for stiff problems, where extrapolation is unstable.
pub(crate) fn runge_kutta<const N: usize>(
    mut derivative: impl FnMut(f64, &[f64; N]) -> [f64; N],
    (start, end): (f64, f64),
    steps: usize,
    mut x: [f64; N],
) -> [f64; N] {
    let h = (end - start) / steps as f64;
    for step in 0..steps {
        let t = start + h * step as f64;
        let advance = |h: f64, slope: &[f64; N]| std::array::from_fn(|i| x[i] + h * slope[i]);
        let k1 = derivative(t, &x);
        let k2 = derivative(t + 0.5 * h, &advance(0.5 * h, &k1));
        let k3 = derivative(t + 0.5 * h, &advance(0.5 * h, &k2));
        let k4 = derivative(t + h, &advance(h, &k3));
        x = std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    x
}

#[test]
fn oscillation() {
    let [x, v] = integrate(|_, [x, v]| [*v, -x], (0.0, 10.0), 20, [1.0, 0.0]);
    assert!((x - 10.0_f64.cos()).abs() < 1e-12, "{x}");
    assert!((v + 10.0_f64.sin()).abs() < 1e-12, "{v}");
}

//! Mistakes in parameters, whose fields other code gives and reads: one message each.
#![forbid(future_incompatible, missing_docs)]

use mbg_runtime::mbg;

mbg! {
    pub model Pair {
        param mass: kg = +2.0;
        param arms: [2]: m = [1.0, 2.0];
        const spring: N/m = 2.0;
        param shape[2] = [50.0 20.0];
        1 velocity { I body { inertia: mass } C coil { stiffness: spring } }
    }
}
mbg! {
    pub model Weight {
        param mass: kg = 2.0;
        param arms = [1.0, 2.0];
        1 velocity { I body { inertia: mass } }
    }
}

impl WeightParameters<f64> {
    fn heavy() -> Self {
        Self { mass: 100.0, ..Self::default() }
    }
}

fn main() {
    let pair = PairParameters { mass: 1.0, arms: [1.0, 2.0], spring: 3.0, shape: [1.0; 2] };
    let pair = Pair::<f64>::new(pair).unwrap();
    let PairParameters { mass, arms, .. } = *pair.parameters();
    let weight = WeightParameters { arms: [1.0, 2.0], ..WeightParameters::heavy() };
    let weight = Weight::<f64>::new(weight).unwrap();
    println!("{}", mass * arms[1] + weight.parameters().arms[0]);
}

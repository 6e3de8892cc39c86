//! Mistakes after which nobody knows how many states, inputs and outputs a model has: one message each.

use mbg_runtime::{Linearised, LoopMemory, System, mbg};
use nalgebra::{SMatrix, SVector};

mbg! {
    pub model Spring {
        param mass: kg = 2.0;
        input force N;
        1 velocity {
            I body { inertia: mass, initial_flow: 1.0 }
            K spring;
            Se drive { effort: force }
        }
        output position[2]: m = ;
        output speed: m/s = velocity.f;
    }
}
mbg! {
    pub model Rods {
        1 rate[3] {
            #[derivative] I rod { inertia: len }
            I carrier { inertia: 2.0 }
            R bearing { resistance: 0.1 }
        }
    }
    pub model Plane {
        1 frame[3] { I body { inertia: 1.0, intial_flow: 1.0 } }
        link: PlanarBdy { mass: 1.0 } (frame);
    }
}

fn energy(model: &impl System<f64, 7, 1, 3>) -> f64 {
    model.energy(0.0, &model.initial_state())
}

fn free<const N: usize, const M: usize, const P: usize>(model: &impl System<f64, N, M, P>) -> f64 {
    model.initial_state().iter().sum()
}

struct Run {
    model: Rods,
    state: SVector<f64, 3>,
}

impl Run {
    fn step(&mut self) {
        let input = SVector::<f64, 0>::zeros();
        let rate = self.model.derivative(0.0, &self.state, &input, &mut ());
        self.state += rate * 0.1;
    }
}

trait Plant {
    fn start(&self) -> f64;
}

impl Plant for Rods {
    fn start(&self) -> f64 {
        self.initial_state()[2]
    }
}

impl Plant for Spring {
    fn start(&self) -> f64 {
        self.initial_state()[1]
    }
}

fn main() {
    let model = Rods::<f64>::new(RodsParameters::default()).unwrap();
    let mut run = Run { model, state: model.initial_state() };
    run.step();
    let _ = energy(&model) + free(&model) + model.start();

    let spring = Spring::<f64>::new(SpringParameters { mass: 1.0 }).unwrap();
    let start: SVector<f64, 2> = spring.initial_state();
    let mut memory = LoopMemory::<f64, 1, 2>::default();
    let slopes: SMatrix<f64, 2, 2> = spring.jacobian_state(0.0, &start, &[1.0].into(), &mut memory);
    let outputs: [f64; 3] = spring.output(0.0, &start, &[1.0].into(), &mut memory).into();
    let linear = Linearised::<f64, 2, 1, 3>::of(&spring, 0.0, &start, &[1.0].into());
    let _ = (slopes, outputs, linear);

    let plane = Plane::<f32>::new(Default::default()).unwrap();
    let start: SVector<f32, 6> = plane.initial_state();
    let _ = plane.conditioning(0.0, &start, &SVector::<f32, 0>::zeros())[1];
}

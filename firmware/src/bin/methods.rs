//! Every method of integration on a small model: an image to be looked at, in which none of them may panic.
#![no_std]
#![no_main]

use core::hint::black_box;

use mbg_runtime::{
    Adaptive, Auto, Constant, Direction, Dop853, Fixed, Gauss6, ImplicitMidpoint, Integrator,
    Pirk8, Pirk16, Radau5, Radau9, Rk4, Rodas4, Rodas5P, Ros2, System, Tsit5, mbg,
};
use nalgebra::SVector;

#[path = "../machine/mod.rs"]
#[allow(dead_code, unused_imports)]
mod machine;

mbg! {
    /// A motor on a spring that becomes harder.
    model Motor {
        param inertia: kg*m^2 = 1e-3;
        param stiffness: N*m/rad = 5.0;
        param hardening: N*m/rad^3 = 1.0;
        param damping: N*m*s/rad = 1e-3;
        input torque: N*m;
        1 shaft {
            I rotor { inertia: inertia }
            C spring { effort: stiffness * q + hardening * powi(q, 3) }
            R bearing { resistance: damping }
            Se drive { effort: torque }
        }
        output angle: rad = spring.q;
    }
}

mbg! {
    /// The same motor with dry friction.
    model Rubbing {
        param inertia: kg*m^2 = 1e-3;
        param stiffness: N*m/rad = 5.0;
        param friction: N*m = 0.05;
        input torque: N*m;
        1 shaft {
            I rotor { inertia: inertia }
            C spring { stiffness: stiffness }
            R bearing { effort: friction * sign(f) }
            Se drive { effort: torque }
        }
        output angle: rad = spring.q;
    }
}

type State = SVector<f32, 2>;

/// Runs over a millisecond, and until the spring is at rest.
#[inline(never)]
fn run(model: &impl System<f32, 2, 1, 1>, x: State, solver: impl Integrator<2>) -> State {
    let input = Constant(black_box(SVector::from([0.1])));
    let mut last = x;
    let ran = solver.integrate(model, &input, 0.0, 1e-3, x, |step| last = *step.state());
    let event = (Direction::Falling, |_t, x: &State| x[1]);
    let arrival = solver.until(model, &input, 0.0, 1e-3, last, event, |_| ());
    black_box((ran.is_ok(), arrival.is_ok()));
    last
}

/// Where the start-up code goes.
#[unsafe(no_mangle)]
extern "C" fn start() -> ! {
    let Ok(model) = Motor::<f32>::new(MotorParameters::default()) else {
        machine::exit(false);
    };
    let mut x = model.initial_state();
    macro_rules! adaptive {
        ($($method:expr),*) => { $( x = run(&model, x, Adaptive::new($method, 1e-4, 1e-5)); )* };
    }
    macro_rules! fixed {
        ($($method:expr),*) => { $( x = run(&model, x, Fixed::new($method, 1e-4).compensated()); )* };
    }
    adaptive!(
        Tsit5, Dop853, Pirk8, Pirk16, Rodas4, Rodas5P, Radau5, Radau9
    );
    fixed!(
        Rk4,
        Ros2,
        Radau5,
        Gauss6::default(),
        ImplicitMidpoint::default()
    );
    x = run(&model, x, Auto::new(1e-4, 1e-5));
    let Ok(model) = Rubbing::<f32>::new(RubbingParameters::default()) else {
        machine::exit(false);
    };
    x = run(&model, x, Fixed::new(Rk4, 1e-4));
    black_box(x);
    machine::exit(true)
}

/// Where the start-up code goes with what the machine refuses to do.
#[unsafe(no_mangle)]
extern "C" fn stop(success: bool) -> ! {
    machine::exit(success)
}

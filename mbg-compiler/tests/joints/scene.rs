//! A joint between bodies, and what can be asked of it.

use mbg_compiler::compile::{Compiled, Routines};
use mbg_compiler::elaborate::StateRate;
use mbg_compiler::graph::ElementKind;
use mbg_runtime::Dual;

use crate::models::compiled;
use crate::models::dual::{Point, evaluate};

/// A model that has been compiled, with what is known of its frames.
pub(crate) struct Scene {
    pub(crate) model: Compiled,
    /// Components of a frame.
    pub(crate) size: usize,
}

impl Scene {
    /// A model as it is written.
    pub(crate) fn of(text: &str) -> Self {
        let model = compiled(text);
        Self { model, size: 6 }
    }

    /// A body on the ground, with coordinates of the joint as outputs.
    pub(crate) fn grounded(joint: &str, arguments: &[&str], coordinates: &[&str]) -> Self {
        let outputs = coordinates.iter().enumerate();
        let outputs: String = outputs
            .map(|(place, name)| format!("output coordinate{place} = joint.{name};"))
            .collect();
        let size = size(joint);
        let body = body(size, "", "b");
        let arguments = joined(arguments);
        let model = compiled(&format!(
            "#[derivative] model Grounded {{
                causality componentwise;
                1 ground[{size}];
                1 b[{size}];
                Sf fixed[{size}] {{ flow: 0.0 }} -> ground;
                joint: {joint} {{ {arguments} }} (ground, b);
                {body}
                {outputs}
            }}"
        ));
        Self { model, size }
    }

    /// A body on a body that swings; outputs are effort into and flow at a, effort out of and flow at b, and in space
    /// the position, the axes and the gravity at b.
    pub(crate) fn carried(joint: &str, arguments: &[&str]) -> Self {
        let size = size(joint);
        let planar = size == 3;
        let gravity = if planar {
            "[0.5, -9.81]"
        } else {
            "[0.5, 1.0, -9.81]"
        };
        let carrier = if planar {
            "carrier: PlanarRevolute (ground, foot);
             reach: PlanarOffset { x: 0.4, y: 0.3 } (foot, a);"
        } else {
            "carrier: Universal { first: 0, second: 2, offset: [0.1, 0.2, 0.3] } (ground, foot);
             reach: Offset { by: [0.3, -0.5, 0.2] } (foot, a);"
        };
        let known = match joint {
            "PlanarRevolute" => "angle_a: carrier.angle",
            "PlanarPrismatic" | "PlanarFree" => {
                "angle_a: carrier.angle, position_a: reach.position_b"
            }
            _ => {
                "gravity_a: carrier.gravity_b, orientation_a: carrier.orientation_b, position_a: reach.position_b"
            }
        };
        let (at_a, at_b) = if planar {
            (body(3, "", "a"), body(3, "", "b"))
        } else {
            (
                body(6, "gravity_at: carrier.gravity_b", "a"),
                body(6, "gravity_at: joint.gravity_b", "b"),
            )
        };
        let outputs = if planar {
            ""
        } else {
            "output position[3] = joint.position_b;
             output x[3] = joint.orientation_b * [1.0, 0.0, 0.0];
             output y[3] = joint.orientation_b * [0.0, 1.0, 0.0];
             output z[3] = joint.orientation_b * [0.0, 0.0, 1.0];
             output gravity_b[3] = joint.gravity_b;"
        };
        let arguments = joined(&[&[known], arguments].concat());
        let model = compiled(&format!(
            "#[derivative] model Carried {{
                causality componentwise;
                gravity {gravity};
                1 ground[{size}]; 1 foot[{size}]; 1 a[{size}]; 1 b[{size}]; 1 at_a[{size}]; 1 at_b[{size}];
                0 into[{size}]; 0 out[{size}];
                Sf fixed[{size}] {{ flow: 0.0 }} -> ground;
                {carrier}
                {at_a}
                a -> into; into -> at_a;
                joint: {joint} {{ {arguments} }} (at_a, at_b);
                at_b -> out; out -> b;
                {at_b}
                output into[{size}] = into.e;
                output at_a[{size}] = at_a.f;
                output out[{size}] = out.e;
                output at_b[{size}] = at_b.f;
                {outputs}
            }}"
        ));
        Self { model, size }
    }

    /// Results of a routine at a state, at time zero and without inputs.
    pub(crate) fn run(&self, routine: usize, state: &[f64]) -> Vec<f64> {
        let along = vec![0.0; state.len()];
        let results = self.dual(routine, state, &along);
        results.iter().map(|result| result.value).collect()
    }

    /// How the results of a routine change along a direction.
    pub(crate) fn along(&self, routine: usize, state: &[f64], direction: &[f64]) -> Vec<f64> {
        let results = self.dual(routine, state, direction);
        results.iter().map(|result| result.slope).collect()
    }

    /// What each state adds to the change of the energy.
    pub(crate) fn powers(&self, state: &[f64], rates: &[f64]) -> Vec<f64> {
        let alone = |place: usize| -> Vec<f64> {
            let mut direction = vec![0.0; rates.len()];
            direction[place] = rates[place];
            direction
        };
        (0..rates.len())
            .map(|place| self.along(Routines::ENERGY, state, &alone(place))[0])
            .collect()
    }

    fn dual(&self, routine: usize, state: &[f64], along: &[f64]) -> Vec<Dual<f64>> {
        let dual = |(value, slope): (&f64, &f64)| Dual {
            value: *value,
            slope: *slope,
        };
        let state: Vec<Dual<f64>> = state.iter().zip(along).map(dual).collect();
        let point = Point {
            parameters: &[],
            time: Dual::constant(0.0),
            state: &state,
            input: &[],
        };
        evaluate(&self.model.program, routine, &point)
    }

    /// Some state without any symmetry; quaternions and matrices are those at the start, since they must be rotations.
    pub(crate) fn state(&self, seed: usize) -> Vec<f64> {
        let rotation = |name: &str| {
            ["rotation.quaternion", "rotation.turn"]
                .iter()
                .any(|part| name.contains(part))
        };
        let places = self.names().into_iter().zip(self.start()).enumerate();
        places
            .map(|(place, (name, start))| {
                if rotation(name) {
                    start
                } else {
                    (1.3 * place as f64 + 0.4 + 0.77 * seed as f64).sin()
                }
            })
            .collect()
    }

    /// The state at the start.
    pub(crate) fn start(&self) -> Vec<f64> {
        self.run(Routines::INITIAL, &vec![0.0; self.model.states.len()])
    }

    /// The place of a state.
    pub(crate) fn place(&self, name: &str) -> usize {
        let mut names = self.names().into_iter();
        names.position(|known| known == name).unwrap()
    }

    /// Names of the states.
    pub(crate) fn names(&self) -> Vec<&str> {
        let states = self.model.states.iter();
        states
            .map(|state| self.model.model.states[*state].variable.name.as_str())
            .collect()
    }

    /// How many states are momenta or flows.
    pub(crate) fn velocities(&self) -> usize {
        let kinds = self.model.states.iter();
        kinds.filter(|state| self.is_velocity(**state)).count()
    }

    /// How many states are displacements or integrals.
    pub(crate) fn displacements(&self) -> usize {
        self.model.states.len() - self.velocities()
    }

    fn is_velocity(&self, state: usize) -> bool {
        match self.model.model.states[state].rate {
            StateRate::Storage(element, _) => {
                self.model.model.graph.elements[element.0].kind == ElementKind::I
            }
            StateRate::Unknown(_) => true,
            StateRate::Expression(_) => false,
        }
    }

    /// The state after `steps` steps of the method of Runge and Kutta.
    pub(crate) fn after(&self, mut state: Vec<f64>, step: f64, steps: usize) -> Vec<f64> {
        let moved = |state: &[f64], by: f64, rates: &[f64]| -> Vec<f64> {
            state
                .iter()
                .zip(rates)
                .map(|(x, rate)| x + by * rate)
                .collect()
        };
        let rates = |state: &[f64]| self.run(Routines::DERIVATIVE, state);
        for _ in 0..steps {
            let first = rates(&state);
            let second = rates(&moved(&state, step / 2.0, &first));
            let third = rates(&moved(&state, step / 2.0, &second));
            let fourth = rates(&moved(&state, step, &third));
            for (place, x) in state.iter_mut().enumerate() {
                let mean = first[place] + 2.0 * (second[place] + third[place]) + fourth[place];
                *x += step / 6.0 * mean;
            }
        }
        state
    }
}

/// Whether a joint is between frames in a plane.
pub(crate) fn is_planar(joint: &str) -> bool {
    joint.starts_with("Planar") && joint != "Planar"
}

/// Components of the frames that a joint is between.
fn size(joint: &str) -> usize {
    if is_planar(joint) { 3 } else { 6 }
}

/// A body without any symmetry.
fn body(size: usize, gravity: &str, at: &str) -> String {
    if size == 3 {
        format!("body_{at}: PlanarBody {{ mass: 2.0, inertia: 3.0 }} ({at});")
    } else {
        format!(
            "body_{at}: Body {{
                mass: 2.0, inertia: [[1.0, 0.1, 0.2], [0.1, 2.0, 0.3], [0.2, 0.3, 3.0]],
                centre: [0.1, 0.2, -0.3], {gravity}
            }} ({at});"
        )
    }
}

/// Arguments that are not empty, with commas between them.
fn joined(arguments: &[&str]) -> String {
    let given: Vec<&str> = arguments
        .iter()
        .copied()
        .filter(|it| !it.is_empty())
        .collect();
    given.join(", ")
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(crate) fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn sum(terms: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|axis| terms.iter().map(|term| term[axis]).sum())
}

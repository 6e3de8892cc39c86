//! What takes part in a scene, and how it is called.

use std::error::Error;
use std::fs;
use std::hint::black_box;
use std::path::Path;
use std::rc::Rc;
use std::str::FromStr;

/// The name under which this project takes part.
pub(crate) const OURS: &str = "mbg";

/// What a contestant is called.
#[derive(Clone)]
pub(crate) struct Label {
    /// Such as `arm-jacobian`.
    pub(crate) scene: String,
    pub(crate) peer: String,
    pub(crate) variant: String,
    /// Operations for one state, where they can be counted.
    pub(crate) operations: Option<usize>,
}

/// One way to evaluate a scene.
pub(crate) struct Contestant {
    pub(crate) label: Label,
    /// How many state variables there are.
    pub(crate) variables: usize,
    /// How many states one turn of `run` is for.
    pub(crate) states: usize,
    /// Largest difference that rounding may make, relative to the largest value of its kind.
    pub(crate) tolerance: f64,
    /// Evaluates so often; states take turns.
    pub(crate) run: Box<dyn FnMut(usize)>,
    /// The result at a state: ẋ, and for a Jacobian all of ∂ẋ/∂x by columns behind it.
    pub(crate) value: Box<dyn FnMut(usize) -> Vec<f64>>,
}

impl Contestant {
    /// Evaluates one state a turn, into the same `result`, of which `flat` makes numbers.
    pub(crate) fn single<A: 'static, R: Clone + 'static>(
        label: Label,
        variables: usize,
        scenes: Vec<A>,
        result: R,
        evaluate: impl Fn(&A, &mut R) + Clone + 'static,
        flat: impl Fn(&R) -> Vec<f64> + 'static,
    ) -> Self {
        let scenes = Rc::new(scenes);
        let (timed, timed_evaluate, mut timed_result) =
            (scenes.clone(), evaluate.clone(), result.clone());
        let mut next = 0;
        let mut result = result;
        Self {
            label,
            variables,
            states: 1,
            tolerance: 1e-11,
            run: Box::new(move |turns| {
                for _ in 0..turns {
                    next = if next + 1 < timed.len() { next + 1 } else { 0 };
                    timed_evaluate(black_box(&timed[next]), black_box(&mut timed_result));
                }
            }),
            value: Box::new(move |state| {
                evaluate(&scenes[state], &mut result);
                flat(&result)
            }),
        }
    }

    /// Evaluates all of a batch in one turn, some states at a time.
    pub(crate) fn batch<A: 'static, R: Clone + 'static>(
        label: Label,
        variables: usize,
        scenes: Vec<A>,
        together: usize,
        result: R,
        evaluate: impl Fn(&A, &mut R) + Clone + 'static,
        flat: impl Fn(&R, usize) -> Vec<f64> + 'static,
    ) -> Self {
        let states = scenes.len() * together;
        let scenes = Rc::new(scenes);
        let (timed, timed_evaluate) = (scenes.clone(), evaluate.clone());
        let mut results = vec![result.clone(); scenes.len()];
        let mut result = result;
        Self {
            label,
            variables,
            states,
            tolerance: 1e-11,
            run: Box::new(move |turns| {
                for _ in 0..turns {
                    for (scene, result) in black_box(&*timed).iter().zip(black_box(&mut results)) {
                        timed_evaluate(scene, result);
                    }
                }
            }),
            value: Box::new(move |state| {
                evaluate(&scenes[state / together], &mut result);
                flat(&result, state % together)
            }),
        }
    }

    pub(crate) fn is_ours(&self) -> bool {
        self.label.peer == OURS
    }

    /// As the command line names it.
    pub(crate) fn name(&self) -> String {
        format!(
            "{}/{}/{}",
            self.label.scene, self.label.peer, self.label.variant
        )
    }
}

/// Rows of a state and an input each.
pub(crate) fn rows(folder: &Path, scene: &str) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let text = fs::read_to_string(folder.join(format!("{scene}.states")))?;
    let row = |line: &str| line.split(' ').map(f64::from_str).collect();
    let rows: Result<Vec<Vec<f64>>, _> = text.lines().map(row).collect();
    Ok(rows?)
}

//! CVODE of SUNDIALS from shared libraries, called by its C interface.
//!
//! The environment variable `SUNDIALS` names the folder of the libraries; without it there are no rows of CVODE.

use std::error::Error;
use std::ffi::{c_int, c_long, c_void};
use std::path::{Path, PathBuf};
use std::ptr::null_mut;

use libloading::Library;
use mbg_compare::{Comparison, Problem, TOLERANCES};
use mbg_runtime::{Input, Statistics, System};
use nalgebra::SVector;

use crate::peers::{RightHandSide, Row, pieces};

type Handle = *mut c_void;
type Slope = extern "C" fn(f64, Handle, Handle, Handle) -> c_int;
type Jacobian = extern "C" fn(f64, Handle, Handle, Handle, Handle, Handle, Handle, Handle) -> c_int;

/// The functions that are needed, as the headers of SUNDIALS 7 declare them, and the libraries that hold them.
pub struct Sundials {
    context: Handle,
    vector: extern "C" fn(i64, *mut f64, Handle) -> Handle,
    destroy_vector: extern "C" fn(Handle),
    numbers: extern "C" fn(Handle) -> *mut f64,
    matrix: extern "C" fn(i64, i64, Handle) -> Handle,
    destroy_matrix: extern "C" fn(Handle),
    entries: extern "C" fn(Handle) -> *mut f64,
    dense: extern "C" fn(Handle, Handle, Handle) -> Handle,
    destroy_solver: extern "C" fn(Handle) -> c_int,
    fixed_point: extern "C" fn(Handle, c_int, Handle) -> Handle,
    destroy_fixed_point: extern "C" fn(Handle) -> c_int,
    create: extern "C" fn(c_int, Handle) -> Handle,
    free: extern "C" fn(*mut Handle),
    init: extern "C" fn(Handle, Slope, f64, Handle) -> c_int,
    restart: extern "C" fn(Handle, f64, Handle) -> c_int,
    tolerances: extern "C" fn(Handle, f64, Handle) -> c_int,
    user: extern "C" fn(Handle, Handle) -> c_int,
    linear: extern "C" fn(Handle, Handle, Handle) -> c_int,
    nonlinear: extern "C" fn(Handle, Handle) -> c_int,
    jacobian: extern "C" fn(Handle, Jacobian) -> c_int,
    most: extern "C" fn(Handle, c_long) -> c_int,
    stop: extern "C" fn(Handle, f64) -> c_int,
    solve: extern "C" fn(Handle, f64, Handle, *mut f64, c_int) -> c_int,
    steps: extern "C" fn(Handle, *mut c_long) -> c_int,
    evaluations: extern "C" fn(Handle, *mut c_long) -> c_int,
    factorisations: extern "C" fn(Handle, *mut c_long) -> c_int,
    _libraries: [Library; 5],
}

/// The library of the folder whose name begins so.
fn library(folder: &Path, name: &str) -> Result<Library, Box<dyn Error>> {
    let files: Vec<PathBuf> = std::fs::read_dir(folder)?
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .collect();
    let begins = |path: &&PathBuf| {
        let file = path.file_name().and_then(|file| file.to_str());
        file.is_some_and(|file| file.starts_with(name) && file.contains(".so"))
    };
    let path = files
        .iter()
        .find(begins)
        .ok_or_else(|| format!("no {name} in {}", folder.display()))?;
    // SAFETY: the libraries of SUNDIALS run no code when they are loaded.
    Ok(unsafe { Library::new(path) }?)
}

impl Sundials {
    /// The libraries in the folder that the environment names; nothing without it.
    pub fn from_environment() -> Result<Option<Self>, Box<dyn Error>> {
        let Some(folder) = std::env::var_os("SUNDIALS") else {
            return Ok(None);
        };
        let folder = Path::new(&folder);
        let [core, vectors, matrices, solvers, cvode] = [
            "libsundials_core",
            "libsundials_nvecserial",
            "libsundials_sunmatrixdense",
            "libsundials_sunlinsoldense",
            "libsundials_cvode",
        ]
        .map(|name| library(folder, name));
        let (core, vectors, matrices, solvers, cvode) =
            (core?, vectors?, matrices?, solvers?, cvode?);
        macro_rules! function {
            ($library:ident, $name:literal) => {
                // SAFETY: the types are those of the headers.
                *unsafe { $library.get(concat!($name, "\0").as_bytes()) }?
            };
        }
        let new: extern "C" fn(c_int, *mut Handle) -> c_int = function!(core, "SUNContext_Create");
        let mut context = null_mut();
        if new(0, &mut context) != 0 {
            return Err("SUNDIALS gives no context".into());
        }
        Ok(Some(Self {
            context,
            vector: function!(vectors, "N_VMake_Serial"),
            destroy_vector: function!(core, "N_VDestroy"),
            numbers: function!(core, "N_VGetArrayPointer"),
            matrix: function!(matrices, "SUNDenseMatrix"),
            destroy_matrix: function!(core, "SUNMatDestroy"),
            entries: function!(matrices, "SUNDenseMatrix_Data"),
            dense: function!(solvers, "SUNLinSol_Dense"),
            destroy_solver: function!(core, "SUNLinSolFree"),
            fixed_point: function!(cvode, "SUNNonlinSol_FixedPoint"),
            destroy_fixed_point: function!(core, "SUNNonlinSolFree"),
            create: function!(cvode, "CVodeCreate"),
            free: function!(cvode, "CVodeFree"),
            init: function!(cvode, "CVodeInit"),
            restart: function!(cvode, "CVodeReInit"),
            tolerances: function!(cvode, "CVodeSVtolerances"),
            user: function!(cvode, "CVodeSetUserData"),
            linear: function!(cvode, "CVodeSetLinearSolver"),
            nonlinear: function!(cvode, "CVodeSetNonlinearSolver"),
            jacobian: function!(cvode, "CVodeSetJacFn"),
            most: function!(cvode, "CVodeSetMaxNumSteps"),
            stop: function!(cvode, "CVodeSetStopTime"),
            solve: function!(cvode, "CVode"),
            steps: function!(cvode, "CVodeGetNumSteps"),
            evaluations: function!(cvode, "CVodeGetNumRhsEvals"),
            factorisations: function!(cvode, "CVodeGetNumLinSolvSetups"),
            _libraries: [core, vectors, matrices, solvers, cvode],
        }))
    }
}

/// What the functions of the problem are given.
struct User<'a, 'b, S, I, L, const N: usize, const M: usize, const P: usize> {
    problem: &'b Problem<'a, S, I, N, M, P>,
    law: &'b L,
    numbers: extern "C" fn(Handle) -> *mut f64,
    entries: extern "C" fn(Handle) -> *mut f64,
    since: f64,
}

/// What CVODE gives to a function: the user's data, the state and the input.
///
/// # Safety
///
/// The pointers are those given to CVODE, which live as long as its run.
unsafe fn asked<'a, S, I, L, const N: usize, const M: usize, const P: usize>(
    t: f64,
    y: Handle,
    user: Handle,
) -> (&'a User<'a, 'a, S, I, L, N, M, P>, Row<N>, SVector<f64, M>)
where
    I: Input<f64, M>,
{
    // SAFETY: as promised; the vector has N numbers.
    let (user, x) = unsafe {
        let user = &*user.cast::<User<'a, 'a, S, I, L, N, M, P>>();
        (user, std::slice::from_raw_parts((user.numbers)(y), N))
    };
    let u = user.problem.input.value(t, user.since);
    (user, Row::from_column_slice(x), u)
}

extern "C" fn slope<S, I, L, const N: usize, const M: usize, const P: usize>(
    t: f64,
    y: Handle,
    slope: Handle,
    user: Handle,
) -> c_int
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    L: RightHandSide<N, M>,
{
    // SAFETY: the pointers are those given to CVODE, which live as long as its run; the vector has N numbers.
    let (user, x, u, found) = unsafe {
        let (user, x, u) = asked::<S, I, L, N, M, P>(t, y, user);
        let found = std::slice::from_raw_parts_mut((user.numbers)(slope), N);
        (user, x, u, found)
    };
    found.copy_from_slice(user.law.slope(t, &x, &u).as_slice());
    0
}

extern "C" fn jacobian<S, I, L, const N: usize, const M: usize, const P: usize>(
    t: f64,
    y: Handle,
    _slope: Handle,
    matrix: Handle,
    user: Handle,
    _: Handle,
    _: Handle,
    _: Handle,
) -> c_int
where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    L: RightHandSide<N, M>,
{
    // SAFETY: as above; the matrix has N columns of N entries each.
    let (user, x, u, found) = unsafe {
        let (user, x, u) = asked::<S, I, L, N, M, P>(t, y, user);
        let found = std::slice::from_raw_parts_mut((user.entries)(matrix), N * N);
        (user, x, u, found)
    };
    let memory = &mut S::Memory::default();
    found.copy_from_slice(
        user.problem
            .system
            .jacobian_state(t, &x, &u, memory)
            .as_slice(),
    );
    0
}

/// CVODE's formulas of Adams, solved by iteration, or backward differences with the exact Jacobian, solved by Newton's
/// method. The absolute tolerances are in units of the states' sizes, as ours are.
pub fn cvode<S, I, L, const N: usize, const M: usize, const P: usize>(
    sundials: &Sundials,
    comparison: &mut Comparison<'_, S, I, N, M, P>,
    law: &L,
    stiff: bool,
) where
    S: System<f64, N, M, P>,
    I: Input<f64, M>,
    L: RightHandSide<N, M>,
{
    let problem = comparison.problem().clone();
    let sizes = comparison.reference().sizes;
    let name = if stiff { "CVODE BDF" } else { "CVODE Adams" };
    for tolerance in TOLERANCES {
        let run = |times: &[f64], states: &mut Vec<Row<N>>| {
            let s = sundials;
            let mut user = User {
                problem: &problem,
                law,
                numbers: s.numbers,
                entries: s.entries,
                since: problem.start,
            };
            let mut state = problem.state;
            let mut absolute = sizes.map(|size| size * tolerance);
            let y = (s.vector)(N as i64, state.as_mut_ptr(), s.context);
            let small = (s.vector)(N as i64, absolute.as_mut_ptr(), s.context);
            let matrix = (s.matrix)(N as i64, N as i64, s.context);
            let mut memory = (s.create)(if stiff { 2 } else { 1 }, s.context);
            (s.init)(memory, slope::<S, I, L, N, M, P>, problem.start, y);
            (s.tolerances)(memory, tolerance, small);
            (s.user)(memory, (&raw mut user).cast());
            (s.most)(memory, 10_000_000);
            let solver = if stiff {
                let solver = (s.dense)(y, matrix, s.context);
                (s.linear)(memory, solver, matrix);
                (s.jacobian)(memory, jacobian::<S, I, L, N, M, P>);
                solver
            } else {
                let solver = (s.fixed_point)(y, 0, s.context);
                (s.nonlinear)(memory, solver);
                solver
            };
            let since = &raw mut user.since;
            let mut begun = problem.start;
            let found = pieces(&problem, times, states, |[t, end], x| {
                let at = (s.numbers)(y);
                // SAFETY: the vector has N numbers; nobody else refers to the field.
                unsafe {
                    std::slice::from_raw_parts_mut(at, N).copy_from_slice(x.as_slice());
                    *since = t;
                }
                // Behind a jump, and behind a time at which only the state is asked for, it starts anew as all do.
                (s.restart)(memory, t, y);
                begun = t;
                (s.stop)(memory, end);
                let flag = (s.solve)(memory, end, y, &mut begun, 1);
                if flag < 0 {
                    return Err(format!("flag {flag}"));
                }
                let count = |ask: extern "C" fn(Handle, *mut c_long) -> c_int| {
                    let mut count = 0;
                    (ask)(memory, &mut count);
                    u64::try_from(count).unwrap_or(0)
                };
                let statistics = Statistics {
                    steps: count(s.steps),
                    evaluations: count(s.evaluations),
                    factorisations: if stiff { count(s.factorisations) } else { 0 },
                    ..Statistics::default()
                };
                // SAFETY: as above.
                let x = unsafe { std::slice::from_raw_parts((s.numbers)(y), N) };
                Ok((Row::from_column_slice(x), statistics))
            });
            (s.free)(&mut memory);
            if stiff {
                (s.destroy_solver)(solver);
            } else {
                (s.destroy_fixed_point)(solver);
            }
            (s.destroy_matrix)(matrix);
            (s.destroy_vector)(small);
            (s.destroy_vector)(y);
            found
        };
        comparison.solver(name, &format!("rtol = {tolerance:e}"), run);
    }
}

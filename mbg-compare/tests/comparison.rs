//! Comparisons of methods on problems written by hand.
#![allow(clippy::unwrap_used)]

#[path = "../../examples/methods/problems.rs"]
#[allow(dead_code)]
mod problems;

use mbg_compare::{Comparison, Problem, compare};
use mbg_runtime::{Rk4, Statistics, Tsit5};
use nalgebra::SVector;
use problems::{Pendulum, VanDerPol, Written};

#[test]
fn smooth_and_stiff_problems_get_their_methods_and_a_reference() {
    let start = SVector::from([2.0, 1.0]);
    let problem = Problem::new("pendulum", &Written(Pendulum), &(), (0.0, 10.0), start);
    let comparison = compare(problem).unwrap();
    assert_eq!(comparison.methods(), ["Tsit5", "Dop853", "PIRK 8"]);
    assert!(comparison.reference().agreement < 1e-8);
    for method in ["Tsit5", "Dop853", "PIRK 8"] {
        let series = comparison.series(method);
        assert!(series[0].error > 1e-5 && series[series.len() - 1].error < 1e-6);
        let [coarse, fine] = [1e-6, 1e-7].map(|error| comparison.time_to(method, error).unwrap());
        assert!(0.0 < coarse && coarse <= fine, "{coarse:e} {fine:e}");
        assert_eq!(comparison.time_to(method, 1e-30), None);
    }
    let table = comparison.to_string();
    assert!(table.contains("pendulum, 0 s to 10 s") && table.contains("rtol = 1e-9"));

    let start = SVector::from([2.0, 0.0]);
    let problem = Problem::new("Van der Pol", &Written(VanDerPol), &(), (0.0, 2.0), start);
    let comparison: Comparison<'_, _, _, 2, 0, 0> = Comparison::new(problem).unwrap();
    assert!(comparison.reference().stiff);
    assert!((comparison.reference().states[0][0] - VanDerPol::AFTER_2_S[0]).abs() < 1e-10);
}

#[test]
fn times_may_come_in_any_order_and_none_is_the_end() {
    let start = SVector::from([2.0, 1.0]);
    let states = |times: &[f64]| {
        let problem = Problem::new("pendulum", &Written(Pendulum), &(), (0.0, 2.0), start);
        let comparison: Comparison<'_, _, _, 2, 0, 0> = Comparison::new(problem.at(times)).unwrap();
        comparison.reference().states.clone()
    };
    assert_eq!(states(&[2.0, 1.0]), states(&[1.0, 2.0]));
    assert_eq!(states(&[2.0, 1.0]).len(), 2);
    assert_eq!(states(&[]), states(&[2.0]));
}

#[test]
fn runs_that_stop_are_listed_with_the_reason() {
    let start = SVector::from([2.0, 0.0]);
    let problem = Problem::new("Van der Pol", &Written(VanDerPol), &(), (0.0, 2.0), start);
    let mut comparison: Comparison<'_, _, _, 2, 0, 0> = Comparison::new(problem).unwrap();
    comparison.over_steps(Rk4, &[0.1, 0.0]);
    let table = comparison.to_string();
    assert!(
        table.contains("is not finite") && table.contains("larger than zero"),
        "{table}"
    );
    assert!(comparison.draw("nowhere.svg").is_err());
    assert_eq!(comparison.time_to("RK4", 1.0), None);
}

#[test]
fn a_reference_that_is_not_verified_is_refused() {
    let start = SVector::from([2.0, 1.0]);
    let mut problem = Problem::new("pendulum", &Written(Pendulum), &(), (0.0, 10.0), start);
    problem.agreement = 1e-30;
    let unverified = Comparison::<'_, _, _, 2, 0, 0>::new(problem).unwrap_err();
    assert!(unverified.best.unwrap() > 1e-30);
    assert!(
        unverified
            .to_string()
            .starts_with("no reference: two methods must agree within 1e-30")
    );
}

#[test]
fn a_picture_is_drawn() {
    let start = SVector::from([2.0, 1.0]);
    let problem = Problem::new("pendulum", &Written(Pendulum), &(), (0.0, 10.0), start);
    let mut comparison: Comparison<'_, _, _, 2, 0, 0> = Comparison::new(problem).unwrap();
    comparison.over_tolerances(Tsit5, &[1e-3, 1e-6]);
    let path = std::env::temp_dir().join("mbg_compare_picture.svg");
    comparison.draw(&path).unwrap();
    let picture = std::fs::read_to_string(&path).unwrap();
    for text in [
        "Speed against error: pendulum",
        "CPU time in µs",
        "largest relative error",
        "Tsit5",
    ] {
        assert!(picture.contains(text), "{text}");
    }
}

#[test]
fn solvers_that_tell_no_work_and_errors_of_zero_have_no_place_on_logarithmic_axes() {
    let start = SVector::from([2.0, 1.0]);
    let problem = Problem::new("pendulum", &Written(Pendulum), &(), (0.0, 10.0), start);
    let mut comparison: Comparison<'_, _, _, 2, 0, 0> = Comparison::new(problem).unwrap();
    let exact = comparison.reference().states.clone();
    comparison.solver("exact", "", |_, states| {
        states.extend_from_slice(&exact);
        Ok(Statistics::default())
    });
    let path = std::env::temp_dir().join("mbg_compare_without_work.svg");
    let told = comparison.draw(&path).unwrap_err().to_string();
    assert!(told.contains("all errors are zero"), "{told}");
    comparison.solver("another", "", |_, states| {
        states.extend(exact.iter().map(|state| state + SVector::from([1e-3, 0.0])));
        Ok(Statistics::default())
    });
    comparison.draw(&path).unwrap();
    assert!(std::fs::read_to_string(&path).unwrap().contains("another"));
}

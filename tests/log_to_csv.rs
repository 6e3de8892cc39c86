//! What the example prints is a table that other programs read.
#![allow(clippy::unwrap_used)]

#[path = "../examples/log_to_csv.rs"]
#[allow(dead_code, reason = "the example prints what is read here")]
mod log_to_csv;

use log_to_csv::{Motor, MotorParameters, SUPPLY, log};

#[test]
fn every_variable_has_its_column() {
    let motor = Motor::new(MotorParameters::default()).unwrap();
    let table = log(&motor, &SUPPLY, &log_to_csv::times()).unwrap();
    let (titles, rows) = table.split_once('\n').unwrap();
    let titles: Vec<&str> = titles.split(',').collect();
    let expected = [
        "time / s",
        "coil.p",
        "wheel.p",
        "angle / rad",
        "voltage / V",
        "current / A",
        "speed / rad/s",
        "turns",
        "held / N*m",
    ];
    assert_eq!(titles, expected);

    let rows: Vec<Vec<f64>> = rows
        .lines()
        .map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert!(rows.iter().all(|row| row.len() == titles.len()));
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(times, log_to_csv::times());
    for row in &rows {
        let [
            time,
            flux,
            momentum,
            angle,
            voltage,
            current,
            speed,
            turns,
            _,
        ] = row[..]
        else {
            panic!("{row:?}")
        };
        assert_eq!(voltage, if time < 0.5 { 12.0 } else { 0.0 });
        assert!((flux - 4e-3 * current).abs() < 1e-12 && (momentum - 2e-3 * speed).abs() < 1e-12);
        assert!((angle - std::f64::consts::TAU * turns).abs() < 1e-12);
    }
    // The wheel runs out, and friction holds what little current still turns it.
    let [.., current, speed, _, held] = rows[rows.len() - 1][..] else {
        panic!("no row")
    };
    assert!(speed.abs() < 1e-12);
    assert!((held - 0.05 * current).abs() < 1e-12);
}

//! The peers: libraries that the scripts in `peers/` have built, and one function by hand.

use std::error::Error;
use std::fs;
use std::path::Path;

use libloading::{Library, Symbol};
use nalgebra::{Matrix3, SVector, Vector3};

use crate::contestant::{Contestant, Label, rows};

/// `symbol(x, u, result)`.
type Function = unsafe extern "C" fn(*const f64, *const f64, *mut f64);

/// A line of the manifest: a function in a library.
struct Entry<'a> {
    name: &'a str,
    kind: &'a str,
    peer: &'a str,
    variant: &'a str,
    library: &'a str,
    symbol: &'a str,
    operations: Option<usize>,
}

impl<'a> Entry<'a> {
    fn parse(line: &'a str) -> Option<Self> {
        let mut words = line.split(' ');
        Some(Self {
            name: words.next()?,
            kind: words.next()?,
            peer: words.next()?,
            variant: words.next()?,
            library: words.next()?,
            symbol: words.next()?,
            operations: words.next()?.parse().ok(),
        })
    }

    fn label(&self, kind: &str) -> Label {
        Label {
            scene: format!("{}-{kind}", self.name),
            peer: self.peer.into(),
            variant: self.variant.into(),
            operations: self.operations,
        }
    }

    fn function(&self, folder: &Path, target: &str) -> Result<Function, Box<dyn Error>> {
        // SAFETY: the scripts in `peers/` have just built this library; nothing runs when it is loaded or stays.
        let library = unsafe { Library::new(folder.join(target).join(self.library)) }?;
        // It stays loaded until the program ends.
        let library = Box::leak(Box::new(library));
        // SAFETY: the manifest names only functions of this form.
        let function: Symbol<Function> = unsafe { library.get(self.symbol) }?;
        Ok(*function)
    }

    /// Rows and columns of the elements of the Jacobian, in the order in which they are given.
    fn pattern(&self, folder: &Path, states: usize) -> Result<Vec<usize>, Box<dyn Error>> {
        if self.kind == "value" {
            return Ok(Vec::new());
        }
        let Ok(text) = fs::read_to_string(folder.join(format!("{}.pattern", self.symbol))) else {
            return Ok((0..states * states).collect());
        };
        let place = |line: &str| {
            let (row, column) = line.split_once(' ')?;
            Some(row.parse::<usize>().ok()? + states * column.parse::<usize>().ok()?)
        };
        let found: Option<Vec<usize>> = text.lines().map(place).collect();
        found.ok_or_else(|| format!("{} has a wrong pattern", self.symbol).into())
    }
}

/// Calls a peer's function with a row of a state of `states` variables and an input.
fn call(function: Function, states: usize, row: &[f64], result: &mut [f64]) {
    let (x, u) = row.split_at(states);
    // SAFETY: rows and results have the sizes for which the function was generated.
    unsafe { function(x.as_ptr(), u.as_ptr(), result.as_mut_ptr()) };
}

/// How many of a row's numbers are the state.
fn states(name: &str, row: usize) -> usize {
    match name {
        "ins" => 9,
        "fourbar" => 6,
        // All angles, all rates, all torques.
        _ => row / 3 * 2,
    }
}

fn contestants_of(
    entry: &Entry,
    folder: &Path,
    target: &str,
) -> Result<Vec<Contestant>, Box<dyn Error>> {
    let function = entry.function(folder, target)?;
    let rows = rows(folder, entry.name)?;
    let n = states(entry.name, rows[0].len());
    let pattern = entry.pattern(folder, n)?;
    let jacobian = entry.kind == "jacobian";
    let evaluate = move |row: &Vec<f64>, result: &mut Vec<f64>| call(function, n, row, result);
    let result = vec![0.0; n + pattern.len()];
    let flat = move |result: &Vec<f64>| {
        let mut dense = result[..n].to_vec();
        dense.resize(if jacobian { n + n * n } else { n }, 0.0);
        for (place, element) in pattern.iter().zip(&result[n..]) {
            dense[n + place] = *element;
        }
        dense
    };
    let (some, single) = (rows[..64].to_vec(), result.clone());
    let mut found = vec![Contestant::single(
        entry.label(entry.kind),
        n,
        some,
        single,
        evaluate,
        flat,
    )];
    if (entry.name, entry.peer) == ("chain64", "MuJoCo") {
        // It factorises the mass matrix, which costs digits in a long chain; all who go link by link agree to 1e-11.
        found[0].tolerance = 1e-10;
    }
    // The engines have no code for batches; one after the other takes them what `value` shows.
    let is_generated = entry.operations.is_some();
    if is_generated && entry.kind == "value" && ["ins", "arm"].contains(&entry.name) {
        let flat = |result: &Vec<f64>, _| result.clone();
        let label = entry.label("batch");
        found.push(Contestant::batch(label, n, rows, 1, result, evaluate, flat));
    }
    Ok(found)
}

/// The equations of the inertial navigation system as one writes them with a library of matrices.
fn by_hand(row: &[f64], result: &mut SVector<f64, 9>) {
    let part = |first: usize| Vector3::new(row[first], row[first + 1], row[first + 2]);
    let (hull, body, angles, gust) = (part(0), part(3), part(6), part(9));
    let (fuselage, platform) = (
        hull.component_div(&Vector3::new(1e4, 1e4, 5e3)),
        body / 10.0,
    );
    let ((s1, c1), (s2, c2), (s3, c3)) = (
        angles[0].sin_cos(),
        angles[1].sin_cos(),
        angles[2].sin_cos(),
    );
    let about_x = Matrix3::new(1.0, 0.0, 0.0, 0.0, c1, -s1, 0.0, s1, c1);
    let about_y = Matrix3::new(c2, 0.0, s2, 0.0, 1.0, 0.0, -s2, 0.0, c2);
    let about_z = Matrix3::new(c3, -s3, 0.0, s3, c3, 0.0, 0.0, 0.0, 1.0);
    let turn = about_x * about_y * about_z;
    let tangent = s2 / c2;
    let inverse = Matrix3::new(
        1.0,
        s1 * tangent,
        -c1 * tangent,
        0.0,
        c1,
        s1,
        0.0,
        -s1 / c2,
        c1 / c2,
    );
    let rates = inverse * (turn * platform - fuselage);
    let torque = -(inverse.transpose() * (angles * 1e-5 + rates * 1e-5));
    let hull_rate = gust - fuselage * 1e3 - torque - fuselage.cross(&hull);
    let body_rate = turn.transpose() * torque;
    result.fixed_rows_mut::<3>(0).copy_from(&hull_rate);
    result.fixed_rows_mut::<3>(3).copy_from(&body_rate);
    result.fixed_rows_mut::<3>(6).copy_from(&rates);
}

/// All peers, or those of which one is named.
pub(crate) fn contestants(
    folder: &Path,
    target: &str,
    only: Option<&str>,
) -> Result<Vec<Contestant>, Box<dyn Error>> {
    let manifest = fs::read_to_string(folder.join("manifest"))?;
    let mut found = Vec::new();
    for line in manifest.lines() {
        let entry = Entry::parse(line).ok_or_else(|| format!("manifest: `{line}`"))?;
        let ending = format!("/{}/{}", entry.peer, entry.variant);
        let is_meant = |name: &str| name.starts_with(entry.name) && name.ends_with(&ending);
        if only.is_none_or(is_meant) {
            found.extend(contestants_of(&entry, folder, target)?);
        }
    }
    found.push(Contestant::single(
        Label {
            scene: "ins-value".into(),
            peer: "nalgebra".into(),
            variant: "by hand".into(),
            operations: None,
        },
        9,
        rows(folder, "ins")?[..64].to_vec(),
        SVector::zeros(),
        |row: &Vec<f64>, result: &mut _| by_hand(row, result),
        |result| result.as_slice().to_vec(),
    ));
    Ok(found)
}

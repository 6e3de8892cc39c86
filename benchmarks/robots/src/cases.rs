//! States at which robots are compared, as `robots.py` writes them.

use std::error::Error;
use std::fs;
use std::path::Path;

use nalgebra::SVector;

/// A state of the model, and the same in the terms of Pinocchio.
pub struct Case<const N: usize, const M: usize> {
    pub state: SVector<f64, N>,
    pub input: SVector<f64, M>,
    /// Of the state, after Pinocchio.
    pub derivative: SVector<f64, N>,
    /// A change of the state and of the input, and what it changes in the derivative, after Pinocchio.
    pub change: (SVector<f64, N>, SVector<f64, M>),
    pub derivative_change: SVector<f64, N>,
    pub position: Vec<f64>,
    pub rates: Vec<f64>,
    pub torques: Vec<f64>,
}

pub struct Cases<const N: usize, const M: usize> {
    pub list: Vec<Case<N, M>>,
}

impl<const N: usize, const M: usize> Cases<N, M> {
    /// Those of a file; the states are put in the order of these names.
    pub fn read(path: &Path, names: &[&str]) -> Result<Self, Box<dyn Error>> {
        let text = fs::read_to_string(path)?;
        let mut lines = text.lines();
        let written: Vec<&str> = lines.next().ok_or("no names")?.split(' ').collect();
        // Angles that change nothing are no states of the model.
        let place = |name: &&str| {
            let place = written.iter().position(|it| it == name);
            place.ok_or_else(|| format!("{}: nothing is told of `{name}`", path.display()))
        };
        let order: Vec<usize> = names.iter().map(place).collect::<Result<_, _>>()?;
        let sizes = numbers::<usize>(lines.next().ok_or("no sizes")?)?;
        let [inputs, positions, rates] = sizes[..] else {
            return Err("three sizes are expected".into());
        };
        if inputs != M {
            return Err(format!("{}: the model has {M} inputs", path.display()).into());
        }
        let states = written.len();
        let list = lines.map(|line| {
            let numbers = numbers::<f64>(line)?;
            let mut rest = numbers.as_slice();
            let mut take = |count: usize| {
                let (taken, left) = rest.split_at_checked(count).ok_or("a line is short")?;
                rest = left;
                Ok::<_, Box<dyn Error>>(taken)
            };
            let ordered =
                |values: &[f64]| SVector::from_iterator(order.iter().map(|it| values[*it]));
            Ok(Case {
                state: ordered(take(states)?),
                input: SVector::from_column_slice(take(M)?),
                derivative: ordered(take(states)?),
                change: (ordered(take(states)?), SVector::from_column_slice(take(M)?)),
                derivative_change: ordered(take(states)?),
                position: take(positions)?.to_vec(),
                rates: take(rates)?.to_vec(),
                torques: take(rates)?.to_vec(),
            })
        });
        let list = list.collect::<Result<_, Box<dyn Error>>>()?;
        Ok(Self { list })
    }
}

fn numbers<T: std::str::FromStr>(line: &str) -> Result<Vec<T>, Box<dyn Error>>
where
    T::Err: Error + 'static,
{
    line.split(' ').map(|it| Ok(it.parse()?)).collect()
}

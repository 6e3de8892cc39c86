//! Elements of random graphs, in the language and as numbers: coefficients, laws of storages, one-ports.

use crate::rank::PRIME;

/// A coefficient of a transformer, a gyrator or a source.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Entry {
    Whole(i64),
    Shifted(i64, usize),
    Sine(usize),
    Cosine(usize),
}

impl Entry {
    pub(crate) fn text(self, variables: &[String]) -> String {
        match self {
            Self::Whole(value) => format!("{value}.0"),
            Self::Shifted(value, variable) => format!("{value}.0 + {}", variables[variable]),
            Self::Sine(variable) => format!("sin({})", variables[variable]),
            Self::Cosine(variable) => format!("cos({})", variables[variable]),
        }
    }

    /// With the values of the variables.
    pub(crate) fn value(self, variables: &[f64]) -> f64 {
        match self {
            Self::Whole(value) => value as f64,
            Self::Shifted(value, variable) => value as f64 + variables[variable],
            Self::Sine(variable) => variables[variable].sin(),
            Self::Cosine(variable) => variables[variable].cos(),
        }
    }

    /// With some values of the variables, each with a sine and a cosine that lie on the circle.
    pub(crate) fn image(self) -> i64 {
        let some = |variable: usize, factor: i64| (variable as i64 + 2) * factor % PRIME;
        let half = |variable| some(variable, 1_234_577);
        let square = |variable| half(variable) * half(variable) % PRIME;
        match self {
            Self::Whole(value) => value,
            Self::Shifted(value, variable) => value + some(variable, 7_654_321),
            Self::Sine(variable) => {
                2 * half(variable) % PRIME * invert(1 + square(variable)) % PRIME
            }
            Self::Cosine(variable) => {
                (1 - square(variable)).rem_euclid(PRIME) * invert(1 + square(variable)) % PRIME
            }
        }
    }
}

fn invert(value: i64) -> i64 {
    let (mut base, mut power, mut inverse) = (value.rem_euclid(PRIME), PRIME - 2, 1);
    while power > 0 {
        if power % 2 == 1 {
            inverse = inverse * base % PRIME;
        }
        base = base * base % PRIME;
        power /= 2;
    }
    inverse
}

/// Unknowns with coefficients and signs; the sum is zero.
pub(crate) type Row = Vec<(usize, Entry, i64)>;

pub(crate) const ONE: Entry = Entry::Whole(1);

pub(crate) const fn effort(bond: usize) -> usize {
    2 * bond
}

pub(crate) const fn flow(bond: usize) -> usize {
    2 * bond + 1
}

/// How a storage's co-energy variable y follows from its state s.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Law {
    /// `M y = s`, with `diagonal` on the diagonal and ones beside it.
    Inverse { diagonal: i64, coupling: i64 },
    /// `y = K s`.
    Direct { diagonal: i64, coupling: i64 },
    /// `y = k s + c` for each component.
    Affine { factor: i64, offset: i64 },
    /// `y = k s + s³` for each component.
    Cubic { factor: i64 },
}

impl Law {
    fn text(self, inertia: bool, dimension: usize) -> String {
        let matrix = |diagonal, coupling| {
            let entry = |row, column| {
                if row == column {
                    diagonal + row as i64
                } else {
                    coupling
                }
            };
            let row = |row| {
                let entries: Vec<String> = (0..dimension)
                    .map(|column| format!("{}.0", entry(row, column)))
                    .collect();
                format!("[{}]", entries.join(", "))
            };
            let rows: Vec<String> = (0..dimension).map(row).collect();
            if dimension == 1 {
                format!("{diagonal}.0")
            } else {
                format!("[{}]", rows.join(", "))
            }
        };
        let (state, word) = if inertia {
            ("p", "flow")
        } else {
            ("q", "effort")
        };
        match self {
            Self::Inverse { diagonal, coupling } => {
                let word = if inertia { "inertia" } else { "compliance" };
                format!("{word}: {}", matrix(diagonal, coupling))
            }
            Self::Direct { diagonal, coupling } => {
                format!("stiffness: {}", matrix(diagonal, coupling))
            }
            Self::Affine { factor, offset } => {
                format!("{word}: {factor}.0 * {state} + {offset}.0")
            }
            Self::Cubic { factor } => {
                format!("{word}: {factor}.0 * {state} + {state} * {state} * {state}")
            }
        }
    }

    fn coupled(diagonal: i64, coupling: i64, vector: &[f64], component: usize) -> f64 {
        let entry = |(place, value): (usize, &f64)| {
            let factor = if place == component {
                diagonal + component as i64
            } else {
                coupling
            };
            factor as f64 * value
        };
        vector.iter().enumerate().map(entry).sum()
    }

    /// By how much the law is broken.
    pub(crate) fn residual(self, state: &[f64], coenergy: &[f64], component: usize) -> f64 {
        let (s, y) = (state[component], coenergy[component]);
        match self {
            Self::Inverse { diagonal, coupling } => {
                Self::coupled(diagonal, coupling, coenergy, component) - s
            }
            Self::Direct { diagonal, coupling } => {
                Self::coupled(diagonal, coupling, state, component) - y
            }
            Self::Affine { factor, offset } => factor as f64 * s + offset as f64 - y,
            Self::Cubic { factor } => factor as f64 * s + s * s * s - y,
        }
    }

    /// What a component contributes to the energy.
    pub(crate) fn energy(self, state: f64, coenergy: f64) -> f64 {
        match self {
            Self::Inverse { .. } | Self::Direct { .. } => state * coenergy / 2.0,
            Self::Affine { factor, offset } => {
                (factor as f64 * state / 2.0 + offset as f64) * state
            }
            Self::Cubic { factor } => (factor as f64 / 2.0 + state * state / 4.0) * state * state,
        }
    }
}

/// An element on one bond.
#[derive(Clone, Debug)]
pub(crate) struct Port {
    pub(crate) kind: Kind,
    /// Its bond's first component, and how many there are.
    pub(crate) bond: usize,
    pub(crate) dimension: usize,
    /// −1 where the bond leads away from it.
    pub(crate) sign: i64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Inertia(Law),
    Compliance(Law),
    Resistor(i64),
    Effort(Entry),
    Flow(Entry),
}

impl Port {
    pub(crate) fn text(&self, number: usize, variables: &[String]) -> String {
        match self.kind {
            Kind::Inertia(law) => format!("I p{number} {{ {} }}", law.text(true, self.dimension)),
            Kind::Compliance(law) => {
                format!(
                    "C p{number} {{ {}, initial: 0.3 }}",
                    law.text(false, self.dimension)
                )
            }
            Kind::Resistor(value) if value % 2 == 0 => {
                format!("R p{number} {{ resistance: {value}.0 }}")
            }
            Kind::Resistor(value) => format!("R p{number} {{ conductance: {value}.0 }}"),
            Kind::Effort(entry) => format!("Se p{number} {{ effort: {} }}", entry.text(variables)),
            Kind::Flow(entry) => format!("Sf p{number} {{ flow: {} }}", entry.text(variables)),
        }
    }

    /// The unknowns that it fixes, as a storage in integral causality.
    pub(crate) fn fixed(&self, component: usize) -> usize {
        let bond = self.bond + component;
        match self.kind {
            Kind::Inertia(_) | Kind::Flow(_) => flow(bond),
            _ => effort(bond),
        }
    }

    /// What the model tells of it, in this order.
    pub(crate) fn variables(&self) -> &'static [&'static str] {
        match self.kind {
            Kind::Inertia(_) => &["e", "f", "p"],
            Kind::Compliance(_) => &["e", "f", "q"],
            _ => &["e", "f"],
        }
    }

    pub(crate) fn is_storage(&self) -> bool {
        matches!(self.kind, Kind::Inertia(_) | Kind::Compliance(_))
    }
}

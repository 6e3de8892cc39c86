//! Graphs of vector bonds, in the language and as equations between the effort `2 b` and the flow `2 b + 1` of every
//! component b of every bond.

use std::fmt::Write;

use super::elements::{Entry, Kind, Law, ONE, Port, Row, effort, flow};
use crate::rank::rank;

#[derive(Debug)]
struct Junction {
    zero: bool,
    coordinate: bool,
    /// Bonds of each component, with 1 where power goes into it.
    bonds: Vec<Vec<(usize, i64)>>,
}

/// Where a bond ends: a junction, its first component, and how many.
pub(crate) type Place = (usize, usize, usize);

/// A two-port between junctions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Link {
    Bond,
    Transformer,
    Gyrator,
}

/// What a graph is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Verdict {
    /// Junctions, two-ports and resistors say something twice, and something else not at all.
    Undetermined,
    /// A source fixes what is fixed already.
    Contradictory,
    /// So many components of storages are no states.
    Dependent(usize),
}

/// How a graph is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawing {
    /// One stroke per multibond.
    pub(crate) uniform: bool,
    /// Elements in the opposite order, which is the order of priority.
    pub(crate) reversed: bool,
    /// With its marks `coordinate`.
    pub(crate) coordinates: bool,
}

#[derive(Default)]
pub(crate) struct Graph {
    lines: Vec<String>,
    pub(crate) bonds: usize,
    junctions: Vec<Junction>,
    laws: Vec<Row>,
    pub(crate) ports: Vec<Port>,
    /// Junctions whose flow is integrated.
    pub(crate) integrals: Vec<usize>,
    /// What a coefficient may depend on.
    pub(crate) variables: Vec<String>,
    pub(crate) gyrators: bool,
    pub(crate) resistive: bool,
}

/// Failures are told by the text of the model.
impl std::fmt::Debug for Graph {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("a graph")
    }
}

impl Graph {
    pub(crate) fn new(resistive: bool) -> Self {
        Self {
            resistive,
            variables: vec!["t".to_owned(), "u".to_owned()],
            ..Self::default()
        }
    }

    pub(crate) fn junction(&mut self, zero: bool, dimension: usize, coordinate: bool) {
        let coordinate = coordinate && !zero;
        self.junctions.push(Junction {
            zero,
            coordinate,
            bonds: vec![Vec::new(); dimension],
        });
    }

    pub(crate) fn dimension(&self, junction: usize) -> usize {
        self.junctions[junction].bonds.len()
    }

    fn name(&self, (junction, start, count): Place) -> String {
        match count {
            _ if count == self.dimension(junction) => format!("j{junction}"),
            1 => format!("j{junction}[{start}]"),
            _ => format!("j{junction}[{start}..{}]", start + count),
        }
    }

    fn attach(&mut self, (junction, start, count): Place, first: usize, sign: i64) {
        for component in 0..count {
            self.junctions[junction].bonds[start + component].push((first + component, sign));
        }
    }

    fn bond(&mut self, dimension: usize) -> usize {
        self.bonds += dimension;
        self.bonds - dimension
    }

    /// Components of a vector as the language names them.
    pub(crate) fn components(name: &str, dimension: usize) -> Vec<String> {
        match dimension {
            1 => vec![name.to_owned()],
            _ => (0..dimension)
                .map(|k| format!("{name}.{}", ["x", "y", "z"][k]))
                .collect(),
        }
    }

    /// A one-port whose bond leads away from it, or towards it.
    pub(crate) fn port(&mut self, at: Place, kind: Kind, outward: bool) {
        let (dimension, number) = (at.2, self.ports.len());
        let bond = self.bond(dimension);
        let port = Port {
            kind,
            bond,
            dimension,
            sign: if outward { -1 } else { 1 },
        };
        self.attach(at, bond, -port.sign);
        if let Kind::Resistor(value) = kind {
            for component in bond..bond + dimension {
                let (one, other) = if value % 2 == 0 {
                    (effort(component), flow(component))
                } else {
                    (flow(component), effort(component))
                };
                let law = vec![(one, ONE, 1), (other, Entry::Whole(value), -port.sign)];
                self.laws.push(law);
            }
        }
        let (place, text) = (self.name(at), port.text(number, &self.variables));
        self.lines.push(if outward {
            format!("{text} -> {place};")
        } else {
            format!("{place} -> {text};")
        });
        if let Kind::Compliance(_) = kind {
            let names = Self::components(&format!("p{number}.q"), dimension);
            self.variables.extend(names);
        }
        self.ports.push(port);
    }

    pub(crate) fn integral(&mut self, junction: usize) {
        if self.junctions[junction].zero || self.integrals.contains(&junction) {
            return;
        }
        let (name, dimension) = (
            format!("a{}", self.integrals.len()),
            self.dimension(junction),
        );
        // At zero a sine by which something is divided would be zero.
        let start: Vec<String> = (0..dimension)
            .map(|component| format!("0.{}", 3 + 2 * component + self.integrals.len()))
            .collect();
        self.lines.push(format!(
            "integral {name}[{dimension}] = j{junction}.f, initial: [{}];",
            start.join(", ")
        ));
        self.variables.extend(Self::components(&name, dimension));
        self.integrals.push(junction);
    }

    /// A link from one place to another; `entries` by rows has as many rows as `to` has components.
    pub(crate) fn link(&mut self, kind: Link, from: Place, to: Place, entries: &[Entry]) {
        let (left, right) = (self.name(from), self.name(to));
        if kind == Link::Bond {
            let bond = self.bond(from.2);
            self.attach(from, bond, -1);
            self.attach(to, bond, 1);
            self.lines.push(format!("{left} -> {right};"));
            return;
        }
        let (input, output) = (self.bond(from.2), self.bond(to.2));
        self.attach(from, input, -1);
        self.attach(to, output, 1);
        let rows: Vec<String> = entries
            .chunks(from.2)
            .map(|row| {
                let row: Vec<String> = row.iter().map(|it| it.text(&self.variables)).collect();
                format!("[{}]", row.join(", "))
            })
            .collect();
        let transforms = kind == Link::Transformer;
        let (word, variable) = if transforms {
            ("MTF", "flow")
        } else {
            ("MGY", "effort")
        };
        let (number, rows) = (self.bonds, rows.join(", "));
        self.gyrators |= !transforms;
        self.lines.push(format!(
            "{left} -> {word} m{number} {{ {variable}: [{rows}] }} -> {right};"
        ));
        // The flow at the input gives a flow or an effort at the output, which acts back as an effort.
        let given = |bond| if transforms { flow(bond) } else { effort(bond) };
        let acting = |bond| if transforms { effort(bond) } else { flow(bond) };
        let entry = |row, column| entries[row * from.2 + column];
        for row in 0..to.2 {
            let mut law = vec![(given(output + row), ONE, 1)];
            law.extend((0..from.2).map(|column| (flow(input + column), entry(row, column), -1)));
            self.laws.push(law);
        }
        for column in 0..from.2 {
            let mut law = vec![(effort(input + column), ONE, 1)];
            law.extend((0..to.2).map(|row| (acting(output + row), entry(row, column), -1)));
            self.laws.push(law);
        }
    }

    /// Whether a transformer or gyrator depends on the state of a storage.
    pub(crate) fn is_modulated_by_storages(&self) -> bool {
        let entries = self.laws.iter().flatten().map(|(_, entry, _)| entry);
        let variables = entries.filter_map(|entry| match entry {
            Entry::Whole(_) => None,
            Entry::Shifted(_, variable) | Entry::Sine(variable) | Entry::Cosine(variable) => {
                Some(*variable)
            }
        });
        variables
            .into_iter()
            .any(|variable| self.variables[variable].starts_with('p'))
    }

    /// A resistor, or a storage where there are none, that agrees with anything at this junction.
    pub(crate) fn load(&self, junction: usize) -> Kind {
        let law = Law::Inverse {
            diagonal: 2,
            coupling: 1,
        };
        match (self.resistive, self.junctions[junction].zero) {
            (true, _) => Kind::Resistor(2),
            (false, true) => Kind::Compliance(law),
            (false, false) => Kind::Inertia(law),
        }
    }

    /// Loads where a component of a junction has no bond, or one that leads nowhere else.
    pub(crate) fn complete(&mut self) {
        for junction in 0..self.junctions.len() {
            for component in 0..self.dimension(junction) {
                if self.junctions[junction].bonds[component].len() < 2 {
                    self.port((junction, component, 1), self.load(junction), false);
                }
            }
        }
    }

    /// Junctions, two-ports and resistors.
    pub(crate) fn structure(&self) -> Vec<Row> {
        let mut rows = self.laws.clone();
        for junction in &self.junctions {
            let common = usize::from(!junction.zero);
            for bonds in &junction.bonds {
                for pair in bonds.windows(2) {
                    let [a, b] = [0, 1].map(|place| 2 * pair[place].0 + common);
                    rows.push(vec![(a, ONE, 1), (b, ONE, -1)]);
                }
                let summed = |(bond, sign): &(usize, i64)| (2 * bond + 1 - common, ONE, *sign);
                rows.push(bonds.iter().map(summed).collect());
            }
        }
        rows
    }

    fn fixed(&self, which: impl Fn(&Port) -> bool) -> Vec<Row> {
        let ports = self.ports.iter().filter(|port| which(port));
        ports
            .flat_map(|port| {
                (0..port.dimension).map(|component| vec![(port.fixed(component), ONE, 1)])
            })
            .collect()
    }

    fn rank(&self, rows: &[Row]) -> usize {
        let value = |(unknown, entry, sign): &(usize, Entry, i64)| (*unknown, sign * entry.image());
        let rows = rows.iter().map(|row| row.iter().map(value).collect());
        rank(2 * self.bonds, rows)
    }

    /// What the ranks of the equations say.
    pub(crate) fn verdict(&self) -> Verdict {
        let mut rows = self.structure();
        if self.rank(&rows) < rows.len() {
            return Verdict::Undetermined;
        }
        rows.extend(self.fixed(|port| matches!(port.kind, Kind::Effort(_) | Kind::Flow(_))));
        let fixed = self.rank(&rows);
        if fixed < rows.len() {
            return Verdict::Contradictory;
        }
        let storages = self.fixed(Port::is_storage);
        let count = storages.len();
        rows.extend(storages);
        Verdict::Dependent(count - (self.rank(&rows) - fixed))
    }

    /// The model, whose outputs are effort, flow and state of every port and the rate of every integral.
    pub(crate) fn text(&self, drawing: Drawing) -> String {
        let mut text = String::from("#[derivative]\nmodel Random {\n    input u;\n");
        if !drawing.uniform {
            text.push_str("    causality componentwise;\n");
        }
        for (number, junction) in self.junctions.iter().enumerate() {
            let kind = u8::from(!junction.zero);
            let mark = if junction.coordinate && drawing.coordinates {
                " coordinate"
            } else {
                ""
            };
            let dimension = junction.bonds.len();
            writeln!(text, "    {kind} j{number}[{dimension}]{mark};").expect("a string grows");
        }
        let mut lines: Vec<&String> = self.lines.iter().collect();
        if drawing.reversed {
            lines.reverse();
        }
        for line in lines {
            writeln!(text, "    {line}").expect("a string grows");
        }
        for (number, port) in self.ports.iter().enumerate() {
            for variable in port.variables() {
                let dimension = port.dimension;
                writeln!(
                    text,
                    "    output {variable}{number}[{dimension}] = p{number}.{variable};"
                )
                .expect("a string grows");
            }
        }
        for (number, junction) in self.integrals.iter().enumerate() {
            let dimension = self.dimension(*junction);
            writeln!(
                text,
                "    output rate{number}[{dimension}] = j{junction}.f;"
            )
            .expect("a string grows");
        }
        text.push_str("}\n");
        text
    }
}

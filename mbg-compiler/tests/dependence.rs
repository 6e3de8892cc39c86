//! Random junction structures: the storages that the compiler calls dependent are as few as brute force finds, and
//! where there are none, the program gives the rates that dense elimination gives.
//!
//! The comparison shares nothing with the compiler: it states every bond's effort and flow as unknowns, every
//! junction, two-port and one-port as equations, and tries all subsets of storages.

mod rank;

use std::collections::BTreeSet;

use mbg_compiler::codes;
use mbg_compiler::compile::{Compiled, Routines, compile};
use mbg_compiler::diagnostics::{Code, Diagnostics};
use mbg_compiler::program::{Arguments, evaluate};
use mbg_compiler::syntax::ast::Item;
use mbg_compiler::{elaborate, syntax};
use proptest::prelude::*;
use rank::rank;

type Row = Vec<(usize, i64)>;

/// A graph in the language and as equations between efforts `2 b` and flows `2 b + 1` of bonds b.
#[derive(Debug, Default)]
struct Graph {
    text: String,
    bonds: usize,
    /// Bonds at each junction, with 1 where power goes into it.
    junctions: Vec<(bool, Vec<(usize, i64)>)>,
    /// Junctions that a bond joins.
    joined: BTreeSet<(usize, usize)>,
    /// Equations of two-ports and resistors.
    laws: Vec<Row>,
    /// What each source fixes, and at which value.
    sources: Vec<(usize, i64)>,
    /// What each storage fixes in integral causality, what its rate is, and the constant of its law.
    storages: Vec<Storage>,
}

#[derive(Clone, Copy, Debug)]
struct Storage {
    fixed: usize,
    rate: usize,
    /// What is fixed, over the state.
    factor: f64,
    /// Of the state's rate, over the bond's variable.
    sign: f64,
}

const fn effort(bond: usize) -> usize {
    2 * bond
}

const fn flow(bond: usize) -> usize {
    2 * bond + 1
}

impl Graph {
    fn write(&mut self, line: &str) {
        self.text.push_str("    ");
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn bond(&mut self, from: Option<usize>, to: Option<usize>) -> usize {
        let bond = self.bonds;
        self.bonds += 1;
        for (end, sign) in [(from, -1), (to, 1)] {
            if let Some(junction) = end {
                self.junctions[junction].1.push((bond, sign));
            }
        }
        bond
    }

    fn junction(&mut self, zero: bool) {
        let kind = u8::from(!zero);
        self.write(&format!("{kind} j{};", self.junctions.len()));
        self.junctions.push((zero, Vec::new()));
    }

    /// A bond, transformer or gyrator between two junctions.
    fn link(&mut self, number: usize, from: usize, to: usize, kind: usize, modulus: i64) {
        if kind < 2 {
            let is_alike = self.junctions[from].0 == self.junctions[to].0;
            // A second bond between junctions of one kind is refused as such.
            if !self.joined.insert((from.min(to), from.max(to))) && is_alike {
                return;
            }
            self.write(&format!("j{from} -> j{to};"));
            self.bond(Some(from), Some(to));
            return;
        }
        let (input, output) = (self.bond(Some(from), None), self.bond(None, Some(to)));
        let equal = |a, b| vec![(a, 1), (b, -modulus)];
        if kind == 2 {
            self.write(&format!(
                "j{from} -> TF t{number} {{ flow: {modulus}.0 }} -> j{to};"
            ));
            self.laws.push(equal(flow(output), flow(input)));
            self.laws.push(equal(effort(input), effort(output)));
        } else {
            self.write(&format!(
                "j{from} -> GY t{number} {{ effort: {modulus}.0 }} -> j{to};"
            ));
            self.laws.push(equal(effort(output), flow(input)));
            self.laws.push(equal(effort(input), flow(output)));
        }
    }

    /// A one-port whose bond leads away from the junction, or towards it.
    fn port(&mut self, number: usize, at: usize, kind: usize, modulus: i64, outward: bool) {
        let (bond, sign) = if outward {
            (self.bond(None, Some(at)), -1)
        } else {
            (self.bond(Some(at), None), 1)
        };
        let (e, f) = (effort(bond), flow(bond));
        // Power into an element is the product of an effort and a flow, one of which turns with the bond.
        let storage = |fixed, rate, factor| Storage {
            fixed,
            rate,
            factor,
            sign: f64::from(sign),
        };
        let element = match kind {
            0 | 1 => {
                self.storages.push(storage(f, e, 1.0 / modulus as f64));
                format!("I p{number} {{ inertia: {modulus}.0 }}")
            }
            2 | 3 => {
                self.storages.push(storage(e, f, modulus as f64));
                format!("C p{number} {{ stiffness: {modulus}.0 }}")
            }
            4 => {
                self.laws
                    .push(vec![(e, 1), (f, -modulus * i64::from(sign))]);
                format!("R p{number} {{ resistance: {modulus}.0 }}")
            }
            5 => {
                self.sources.push((e, modulus));
                format!("Se p{number} {{ effort: {modulus}.0 }}")
            }
            _ => {
                self.sources.push((f, modulus));
                format!("Sf p{number} {{ flow: {modulus}.0 }}")
            }
        };
        self.write(&if outward {
            format!("{element} -> j{at};")
        } else {
            format!("j{at} -> {element};")
        });
    }

    /// Junctions, two-ports and resistors.
    fn structure(&self) -> Vec<Row> {
        let mut rows = self.laws.clone();
        for (zero, bonds) in &self.junctions {
            let common = usize::from(!zero);
            for pair in bonds.windows(2) {
                let [a, b] = [0, 1].map(|place| 2 * pair[place].0 + common);
                rows.push(vec![(a, 1), (b, -1)]);
            }
            let summed = |(bond, sign): &(usize, i64)| (2 * bond + 1 - common, *sign);
            rows.push(bonds.iter().map(summed).collect());
        }
        rows
    }

    fn rank(&self, rows: &[Row]) -> usize {
        rank(2 * self.bonds, rows.iter().cloned())
    }

    /// Whether structure and resistors say something twice; sources that do; the fewest storages that must.
    fn expected(&self) -> (bool, usize, usize) {
        let mut rows = self.structure();
        let structure = self.rank(&rows);
        let redundant = structure < rows.len();
        rows.extend(self.sources.iter().map(|(fixed, _)| vec![(*fixed, 1)]));
        let fixed = self.rank(&rows);
        let sources = self.sources.len() - (fixed - structure);
        let most = (0..1_usize << self.storages.len())
            .filter_map(|subset| {
                let chosen = (0..self.storages.len()).filter(|storage| subset >> storage & 1 == 1);
                let mut all = rows.clone();
                all.extend(chosen.map(|storage| vec![(self.storages[storage].fixed, 1)]));
                let count = all.len() - rows.len();
                (self.rank(&all) == fixed + count).then_some(count)
            })
            .max();
        (redundant, sources, self.storages.len() - most.unwrap_or(0))
    }

    /// Rates of the storages at a state, if nothing depends on anything.
    fn rates(&self, state: &[f64]) -> Vec<f64> {
        let unknowns = 2 * self.bonds;
        let mut rows: Vec<(Row, f64)> =
            self.structure().into_iter().map(|row| (row, 0.0)).collect();
        for (fixed, value) in &self.sources {
            rows.push((vec![(*fixed, 1)], *value as f64));
        }
        for (storage, x) in self.storages.iter().zip(state) {
            rows.push((vec![(storage.fixed, 1)], storage.factor * x));
        }
        let mut matrix: Vec<Vec<f64>> = rows
            .into_iter()
            .map(|(row, value)| {
                let mut dense = vec![0.0; unknowns + 1];
                for (unknown, coefficient) in row {
                    dense[unknown] += coefficient as f64;
                }
                dense[unknowns] = value;
                dense
            })
            .collect();
        for column in 0..unknowns {
            let size = |row: &usize| matrix[*row][column].abs();
            let pivot = (column..unknowns)
                .max_by(|a, b| size(a).total_cmp(&size(b)))
                .unwrap_or(column);
            matrix.swap(column, pivot);
            let top = matrix[column].clone();
            for (index, row) in matrix.iter_mut().enumerate() {
                let factor = row[column] / top[column];
                if index != column {
                    for (entry, above) in row.iter_mut().zip(&top) {
                        *entry -= factor * above;
                    }
                }
            }
        }
        let solution = |unknown: usize| matrix[unknown][unknowns] / matrix[unknown][unknown];
        self.storages
            .iter()
            .map(|storage| storage.sign * solution(storage.rate))
            .collect()
    }

    /// The program, or the mistakes.
    fn compile(&self) -> Result<Compiled, Diagnostics> {
        let text = format!("model Random {{ causality componentwise;\n{}}}", self.text);
        let mut diagnostics = Diagnostics::new();
        let source = syntax::parse(text.parse().expect("tokens"), &mut diagnostics);
        let Some(Item::Model(model)) = source.items.first() else {
            panic!("a model was written")
        };
        let components = elaborate::component_table(&source);
        compile(model, &components, &mut diagnostics).ok_or(diagnostics)
    }
}

/// Structure, sources and storages that a report names; none if it says anything else.
fn reported(diagnostics: &Diagnostics) -> Option<(bool, usize, usize)> {
    let list = diagnostics.list();
    let count = |code: Code| list.iter().filter(|found| found.code == code).count();
    let [structure, sources, storages] = [
        codes::SINGULAR_JUNCTIONS,
        codes::SOURCES_CONFLICT,
        codes::ORDER_LOST,
    ]
    .map(count);
    (diagnostics.any() && structure + sources + storages == list.len()).then_some((
        structure > 0,
        sources,
        storages,
    ))
}

fn graph() -> impl Strategy<Value = Graph> {
    let junctions = prop::collection::vec(any::<bool>(), 2..6);
    let links = prop::collection::vec((0..6_usize, 1..6_usize, 0..4_usize, 1..4_i64), 0..3);
    let tree = prop::collection::vec((0..6_usize, 0..4_usize, 1..4_i64), 5);
    let ports = prop::collection::vec((0..6_usize, 0..7_usize, 1..4_i64, any::<bool>()), 1..7);
    let storage = (0..6_usize, 0..4_usize, 1..4_i64, any::<bool>());
    (junctions, tree, links, storage, ports).prop_map(|(junctions, tree, links, storage, ports)| {
        let mut graph = Graph::default();
        let count = junctions.len();
        junctions.into_iter().for_each(|zero| graph.junction(zero));
        for (to, (from, kind, modulus)) in (1..count).zip(tree) {
            graph.link(to, from % to, to, kind, modulus);
        }
        for (number, (from, step, kind, modulus)) in links.into_iter().enumerate() {
            let (from, step) = (from % count, 1 + step % (count - 1));
            graph.link(count + number, from, (from + step) % count, kind, modulus);
        }
        for (number, (at, kind, modulus, outward)) in
            std::iter::once(storage).chain(ports).enumerate()
        {
            graph.port(number, at % count, kind, modulus, outward);
        }
        graph
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_report_is_brute_force(graph in graph()) {
        let (structure, sources, storages) = graph.expected();
        let found = match graph.compile() {
            Ok(compiled) => {
                let state: Vec<f64> = (1..=graph.storages.len()).map(|k| (k as f64).sin()).collect();
                let arguments = Arguments { parameters: &[], time: 0.0, state: &state, input: &[] };
                let ours = evaluate(&compiled.program, Routines::DERIVATIVE, &arguments);
                let theirs = graph.rates(&state);
                prop_assert_eq!(ours.len(), theirs.len());
                let scale = theirs.iter().fold(1.0_f64, |scale, rate| scale.max(rate.abs()));
                for (ours, theirs) in ours.iter().zip(&theirs) {
                    prop_assert!((ours - theirs).abs() <= 1e-12 * scale, "{} {}\n{}", ours, theirs, graph.text);
                }
                Some((false, 0, 0))
            }
            // A loop of bonds that vanishes when its junctions merge is reported when nothing else is.
            Err(diagnostics) => reported(&diagnostics)
                .map(|(loops, fixed, lost)| (loops || structure && fixed + lost > 0, fixed, lost)),
        };
        prop_assert_eq!(found, Some((structure, sources, storages)), "\n{}", graph.text);
    }
}

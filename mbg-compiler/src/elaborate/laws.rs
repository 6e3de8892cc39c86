//! Constitutive laws: fields of elements to [`Law`]s.

use std::ops::Range;

use proc_macro2::Span;
use syn::Expr;
use syn::spanned::Spanned;

use super::definitions::{as_matrix, off_diagonal};
use super::expressions::{Evaluator, Result, Value};
use super::frames::part_of_frame;
use super::model::{Assumption, Condition, Place, Quantity};
use super::own::Own;
use super::scope::Lookup;
use super::turning;
use crate::causality::ways::beside;
use crate::codes;
use crate::diagnostics::{Diagnostic, error};
use crate::graph::{ElementKind, End, Integral, Law, Rule, Storage, declaration};
use crate::symbolic::print::number;
use crate::symbolic::substitute::symbols;
use crate::symbolic::{
    Differentiator, Expression, Factor, Matrix, Pool, Product, Substitution, Symbol, linear_part,
};
use crate::syntax::ast::{Element, Field};
use crate::syntax::dump;
use crate::syntax::words::{article, is_two_port, law_words};

/// What reading the fields of an element gives.
pub(super) struct Reading {
    pub(super) law: Law,
    pub(super) rule: Rule,
    /// Initial states, when given.
    pub(super) initial: Option<Vec<Expression>>,
    pub(super) assumptions: Vec<Assumption>,
}

/// All words, by element.
pub(super) fn words_of(kind: ElementKind) -> Vec<&'static str> {
    [law_words(kind), other_words(kind)].concat()
}

/// The other words, by element.
fn other_words(kind: ElementKind) -> &'static [&'static str] {
    match kind {
        ElementKind::I => &["initial", "initial_flow", "gyroscopic"],
        ElementKind::C => &["initial", "initial_effort", "displacement"],
        _ => &[],
    }
}

/// Reads one element's law.
pub(super) struct Reader<'a, 'b, 'm> {
    pub(super) pool: &'a mut Pool,
    pub(super) lookup: &'a mut Lookup<'b, 'm>,
    pub(super) element: &'a Element,
    pub(super) own: Own,
}

impl Reader<'_, '_, '_> {
    /// The law, or what is wrong with it. The caller has checked that exactly one law word stands there.
    pub(super) fn read(&mut self, field: &Field) -> Result<Reading> {
        let Some(value) = &field.value else {
            let message = format!("expected `{}: value`", field.name);
            return Err(Box::new(error(
                codes::MISSING_LAW,
                field.name.span(),
                message,
            )));
        };
        let word = field.name.to_string();
        let plain = |law, rule| Reading {
            law,
            rule,
            initial: None,
            assumptions: Vec::new(),
        };
        match (self.element.kind, word.as_str()) {
            (ElementKind::Se, _) => Ok(plain(Law::Source(self.vector(value)?), Rule::EffortOut)),
            (ElementKind::Sf, _) => Ok(plain(Law::Source(self.vector(value)?), Rule::FlowOut)),
            (ElementKind::EJS, _) => {
                self.check_euler(value)?;
                let momentum = self.vector(value)?;
                Ok(plain(Law::EulerJunction(momentum), Rule::Gyroscopic))
            }
            (ElementKind::I | ElementKind::C, _) => self.storage(&word, value),
            (ElementKind::R, "resistance") => Ok(plain(
                Law::Resistance(self.coefficient(value)?),
                Rule::Either,
            )),
            (ElementKind::R, "conductance") => Ok(plain(
                Law::Conductance(self.coefficient(value)?),
                Rule::Either,
            )),
            (ElementKind::R, _) => {
                let (law, rule) = self.resistor(&word, value)?;
                Ok(plain(law, rule))
            }
            (ElementKind::TF | ElementKind::MTF, _) => {
                let product = self.matrix(value)?;
                let (rows, columns, invertible) = self.size(&product);
                Ok(plain(
                    Law::Transformer(product),
                    Rule::Transformer {
                        rows,
                        columns,
                        invertible,
                    },
                ))
            }
            (ElementKind::GY | ElementKind::MGY, _) => {
                let product = self.matrix(value)?;
                let (rows, columns, invertible) = self.size(&product);
                Ok(plain(
                    Law::Gyrator(product),
                    Rule::Gyrator {
                        rows,
                        columns,
                        invertible,
                    },
                ))
            }
        }
    }

    /// An angular momentum has three components.
    fn check_euler(&self, momentum: &Expr) -> Result<()> {
        let (name, size) = (&self.element.name, self.own.dimension);
        if size == 3 {
            return Ok(());
        }
        let message = format!("`{name}` needs a junction of dimension 3, and this one has {size}");
        let report = error(codes::WRONG_DIMENSION, name.span(), message);
        let help = turning::elsewhere(self.lookup.graph, self.own.element, (name, momentum));
        Err(Box::new(help.into_iter().fold(report, Diagnostic::help)))
    }

    /// What stands after a word, without what follows from it.
    pub(super) fn entries(&mut self, word: &str, value: &Expr) -> Result<Matrix> {
        let plain = matches!(self.element.kind, ElementKind::Se | ElementKind::Sf);
        match word {
            "inertia" | "stiffness" | "compliance" | "resistance" | "conductance" => {
                self.coefficient(value)
            }
            "energy" => self.energy_terms(value).map(Matrix::column),
            "effort" | "flow" if is_two_port(self.element.kind) => {
                let product = self.matrix(value)?;
                Ok(product.to_matrix(self.pool))
            }
            "effort" | "flow" if !plain => self.by_component(value).map(Matrix::column),
            _ => self.vector(value).map(Matrix::column),
        }
    }

    fn evaluate(&mut self, component: Option<usize>, value: &Expr) -> Result<Value> {
        self.lookup.own = Some(Own {
            component,
            ..self.own.clone()
        });
        Evaluator {
            pool: self.pool,
            names: self.lookup,
        }
        .evaluate(value)
    }

    fn wrong_shape<T>(&self, value: &Expr, found: &Value) -> Result<T> {
        let size = self.own.dimension;
        let expected = if size == 1 {
            "a number".to_owned()
        } else {
            format!("a number or a vector of {size}")
        };
        let message = format!("expected {expected}, found {}", found.shape());
        let report = error(codes::WRONG_DIMENSION, value.span(), message);
        let helps = self.of_another_size(value, found);
        Err(Box::new(helps.into_iter().fold(report, Diagnostic::help)))
    }

    /// What to type where a vector does not have the size of the element.
    fn of_another_size(&self, value: &Expr, found: &Value) -> Vec<String> {
        let is_inside = self.lookup.scopes[self.lookup.scope].library.is_some();
        let Value::Matrix(vector) = found else {
            return Vec::new();
        };
        let (size, rows) = (self.own.dimension, vector.rows());
        if vector.columns() > 1 {
            return Vec::from_iter(off_diagonal(value, size));
        }
        let Some((End::Junction(id, range), _)) = beside(self.lookup.graph, self.own.element)
        else {
            return Vec::new();
        };
        let junction = &self.lookup.graph.junctions[id.0];
        if is_inside || range.len() < junction.dimension {
            return Vec::new();
        }
        let mut helps = Vec::from_iter(part_of_frame(&junction.name, size, rows));
        if self.element.kind == ElementKind::EJS && rows == 2 {
            let named = (&self.element.name, value);
            helps.push(turning::in_plane(self.lookup.graph, None, named));
        }
        if size == 1 && matches!(value, Expr::Path(_) | Expr::Field(_)) {
            let text = dump::expression(value);
            let first = if rows > 3 { "[0]" } else { ".x" };
            helps.push(format!("write one component, such as `{text}{first}`"));
            let wide = declaration(junction.kind, &junction.name, rows);
            helps.push(format!("or `{wide}` for a junction with as many"));
        }
        helps
    }

    /// One entry per component; a number stands for all of them.
    fn vector(&mut self, value: &Expr) -> Result<Vec<Expression>> {
        let found = self.evaluate(None, value)?;
        self.spread(value, &found)
    }

    fn spread(&mut self, value: &Expr, found: &Value) -> Result<Vec<Expression>> {
        match found.entries(self.pool) {
            Some(entries) if entries.len() == self.own.dimension => Ok(entries),
            Some(entries) if entries.len() == 1 => Ok(vec![entries[0]; self.own.dimension]),
            _ => self.wrong_shape(value, found),
        }
    }

    /// A scalar law applies to each component; a law that names components gives the vector.
    fn by_component(&mut self, value: &Expr) -> Result<Vec<Expression>> {
        let scalar: Result<Vec<Value>> = (0..self.own.dimension)
            .map(|component| self.evaluate(Some(component), value))
            .collect();
        if let Ok(values) = scalar {
            let entries: Option<Vec<Expression>> = values
                .iter()
                .map(|value| {
                    if let Value::Scalar(entry) = value {
                        Some(*entry)
                    } else {
                        None
                    }
                })
                .collect();
            if let Some(entries) = entries {
                return Ok(entries);
            }
        }
        self.vector(value)
    }

    /// A square matrix; a number stands for its multiple of the unit matrix.
    fn coefficient(&mut self, value: &Expr) -> Result<Matrix> {
        let size = self.own.dimension;
        match self.evaluate(None, value)? {
            Value::Scalar(entry) => Ok(Matrix::diagonal(&vec![entry; size])),
            Value::Matrix(product) if (product.rows(), product.columns()) == (size, size) => {
                Ok(product.to_matrix(self.pool))
            }
            found => {
                let article = article(&size.to_string());
                let matrix = match size {
                    1 => String::new(),
                    _ => format!(" or {article} {size}×{size} matrix"),
                };
                let message = format!("expected a number{matrix}, found {}", found.shape());
                let report = error(codes::WRONG_DIMENSION, value.span(), message);
                let vector = found.entries(self.pool);
                let is_diagonal = vector.is_some_and(|it| it.len() == size);
                let on_diagonal = "write `diag(…)` for a matrix with these on its diagonal";
                let help = is_diagonal.then(|| on_diagonal.to_owned());
                let help = help.or_else(|| as_matrix(value, size));
                Err(Box::new(help.into_iter().fold(report, Diagnostic::help)))
            }
        }
    }

    /// A matrix of any size; a number stands for its multiple of the unit matrix of the neighbours' dimension.
    fn matrix(&mut self, value: &Expr) -> Result<Product> {
        match self.evaluate(None, value)? {
            Value::Matrix(product) => Ok(product),
            Value::Scalar(entry) => Ok(Product::of(Factor::Dense(Matrix::diagonal(&vec![
                entry;
                self.own
                    .dimension
                    .max(
                        1
                    )
            ])))),
        }
    }

    fn size(&mut self, product: &Product) -> (usize, usize, bool) {
        let (rows, columns) = (product.rows(), product.columns());
        // Large square matrices are judged factor by factor elsewhere; minors would explode.
        let invertible = rows == columns
            && product.factors.iter().all(|factor| match factor {
                Factor::Dense(matrix) if matrix.rows == matrix.columns && matrix.rows <= 8 => {
                    matrix.determinant(self.pool) != Expression::ZERO
                }
                Factor::Dense(_) => false,
                _ => true,
            });
        (rows, columns, invertible)
    }

    /// A law that gives the effort or the flow; one that multiplies is as good as its coefficient, and has both causalities.
    fn resistor(&mut self, word: &str, value: &Expr) -> Result<(Law, Rule)> {
        let rows = self.by_component(value)?;
        let port = Place::Port(self.own.element);
        let [given, found] = match word {
            "effort" => [Quantity::Flow, Quantity::Effort],
            _ => [Quantity::Effort, Quantity::Flow],
        };
        let read = |quantity| {
            let signals = (0..self.own.dimension).map(move |index| (quantity, port, index));
            signals.map(|signal| self.lookup.signals.symbol(signal))
        };
        let reads = symbols(self.pool, &rows);
        if read(found).flatten().any(|it| reads.contains(&it)) {
            return self.defined_by_itself(word, value);
        }
        let given: Option<Vec<Symbol>> = read(given).collect();
        let multiple = given.and_then(|given| linear_part(self.pool, &rows, &given));
        let multiple = multiple.filter(|(_, rest)| rest.iter().all(|it| *it == Expression::ZERO));
        Ok(match (word, multiple) {
            ("effort", Some((matrix, _))) => (Law::Resistance(matrix), Rule::Either),
            ("effort", None) => (Law::EffortLaw(rows), Rule::ResistanceOnly),
            (_, Some((matrix, _))) => (Law::Conductance(matrix), Rule::Either),
            (_, None) => (Law::FlowLaw(rows), Rule::ConductanceOnly),
        })
    }

    fn defined_by_itself<T>(&self, word: &str, value: &Expr) -> Result<T> {
        let (own, other) = if word == "effort" {
            ("e", "f")
        } else {
            ("f", "e")
        };
        let name = &self.element.name;
        let message = format!("the law of `{name}` gives its {word} `{own}`, and reads it");
        let report = error(codes::CYCLE, value.span(), message);
        Err(Box::new(
            report.help(format!("write it as a function of `{other}`")),
        ))
    }

    fn storage(&mut self, word: &str, value: &Expr) -> Result<Reading> {
        let states: Vec<Expression> = self
            .own
            .states
            .clone()
            .map(|state| self.pool.symbol(Symbol::State(state)))
            .collect();
        let mut assumptions = Vec::new();
        let (coenergy, (energy, integral)) = match word {
            "inertia" | "compliance" | "stiffness" => {
                let matrix = self.coefficient(value)?;
                if !self.is_pseudo() {
                    check_symmetry(self.pool, &matrix, value.span())?;
                }
                if word == "inertia" {
                    assumptions = self.positive(&matrix, value.span())?;
                }
                let matrix = if word == "stiffness" {
                    matrix
                } else {
                    self.inverse(word, &matrix, value.span())?
                };
                let coenergy = matrix
                    .times(self.pool, &Matrix::column(states.clone()))
                    .entries;
                let energy = if self.changes_with_its_state(&matrix) {
                    self.potential(&coenergy, value.span())?
                } else {
                    (self.half_product(&states, &coenergy), Integral::Exact)
                };
                (coenergy, energy)
            }
            "energy" => {
                let (coenergy, energy) = self.by_energy(value)?;
                (coenergy, (energy, Integral::Exact))
            }
            _ => {
                let coenergy = self.by_component(value)?;
                let energy = self.potential(&coenergy, value.span())?;
                (coenergy, energy)
            }
        };
        let displacement = self.displacement()?;
        let rule = match (self.element.kind, &displacement) {
            (ElementKind::I, _) => Rule::PreferFlowOut,
            (_, None) => Rule::PreferEffortOut,
            // What follows from other states is not given by an effort.
            (_, Some(_)) => Rule::EffortOut,
        };
        let initial = self.initial(&coenergy)?;
        let law = Law::Storage(Storage {
            states: self.own.states.clone(),
            coenergy,
            energy,
            integral,
            displacement,
        });
        Ok(Reading {
            law,
            rule,
            initial,
            assumptions,
        })
    }

    /// The displacement, where it is told.
    fn displacement(&mut self) -> Result<Option<Vec<Expression>>> {
        let find = |word: &str| self.element.fields.iter().find(|field| field.name == word);
        let Some(field) = find("displacement") else {
            return Ok(None);
        };
        if let Some(initial) = find("initial").or_else(|| find("initial_effort")) {
            let message = format!(
                "`{}` is given both a displacement and where that starts",
                self.element.name
            );
            let report = error(codes::FIELD_REPEATED, initial.name.span(), message);
            let help = format!(
                "remove `{}` or `displacement`: one follows from the other",
                initial.name
            );
            return Err(Box::new(report.help(help)));
        }
        let Some(value) = &field.value else {
            let message = "expected `displacement: value`";
            let report = error(codes::EXPRESSION, field.name.span(), message);
            return Err(Box::new(report));
        };
        self.vector(value).map(Some)
    }

    fn changes_with_its_state(&self, matrix: &Matrix) -> bool {
        let read = symbols(self.pool, &matrix.entries);
        let mut states = self.own.states.clone().map(Symbol::State);
        states.any(|state| read.contains(&state))
    }

    fn by_energy(&mut self, value: &Expr) -> Result<(Vec<Expression>, Expression)> {
        let terms = self.energy_terms(value)?;
        let energy = self.pool.sum(&terms);
        let states: Range<usize> = self.own.states.clone();
        let coenergy = states
            .map(|state| Differentiator::new(Symbol::State(state)).derivative(self.pool, energy))
            .collect();
        Ok((coenergy, energy))
    }

    /// The energy of each component, or of the vector when components are named.
    fn energy_terms(&mut self, value: &Expr) -> Result<Vec<Expression>> {
        let scalar: Result<Vec<Value>> = (0..self.own.dimension)
            .map(|component| self.evaluate(Some(component), value))
            .collect();
        if let Ok(values) = scalar
            && let Some(entries) = values
                .iter()
                .map(|value| {
                    if let Value::Scalar(entry) = value {
                        Some(*entry)
                    } else {
                        None
                    }
                })
                .collect::<Option<Vec<_>>>()
        {
            return Ok(entries);
        }
        match self.evaluate(None, value)? {
            Value::Scalar(energy) => Ok(vec![energy]),
            found => {
                let message = format!("expected a number, the energy, found {}", found.shape());
                Err(Box::new(error(
                    codes::WRONG_DIMENSION,
                    value.span(),
                    message,
                )))
            }
        }
    }

    fn half_product(&mut self, a: &[Expression], b: &[Expression]) -> Expression {
        let terms: Vec<_> = a
            .iter()
            .zip(b)
            .map(|(a, b)| self.pool.multiply(*a, *b))
            .collect();
        let sum = self.pool.sum(&terms);
        let two = self.pool.integer(2);
        self.pool.divide(sum, two).unwrap_or(Expression::ZERO)
    }

    /// The inverse of what stands behind a word.
    fn inverse(&mut self, word: &str, matrix: &Matrix, span: Span) -> Result<Matrix> {
        matrix.inverse(self.pool).ok_or_else(|| {
            let name = &self.element.name;
            let is_zero = matrix.entries.iter().all(|it| *it == Expression::ZERO);
            let what = if is_zero { "zero" } else { "singular" };
            let message = format!("the {word} of `{name}` is {what}, and its law divides by it");
            Box::new(error(codes::NOT_FINITE, span, message))
        })
    }

    /// Leading principal minors are positive.
    fn positive(&mut self, matrix: &Matrix, span: Span) -> Result<Vec<Assumption>> {
        let owner = self.lookup.graph.elements[self.own.element.0].name.clone();
        let mut assumptions: Vec<Assumption> = Vec::new();
        let is_diagonal = matrix.is_diagonal();
        for size in 1..=matrix.rows {
            let expression = if is_diagonal {
                matrix.at(size - 1, size - 1)
            } else {
                matrix.leading(size).determinant(self.pool)
            };
            let whole = if is_diagonal || size == 1 {
                String::new()
            } else {
                format!("the determinant of the first {size} rows and columns of ")
            };
            match self.pool.constant_value(expression) {
                Some(value) if value > 0.0 => {}
                Some(value) => {
                    let name = &self.element.name;
                    let message = if is_diagonal {
                        format!("the inertia of `{name}` is {value}, not positive")
                    } else {
                        format!(
                            "the inertia of `{name}` is not positive definite: the determinant of its first {size} rows \
                             and columns is {value}"
                        )
                    };
                    let mut report = error(codes::NOT_FINITE, span, message);
                    if is_diagonal && value == 0.0 {
                        report.helps.extend(self.instead_of_zero(matrix));
                    }
                    return Err(Box::new(report));
                }
                None if assumptions
                    .iter()
                    .any(|known| known.expression == expression) => {}
                None => assumptions.push(Assumption {
                    expression,
                    condition: Condition::Positive,
                    reason: format!("it is {whole}the inertia of `{owner}`"),
                }),
            }
        }
        Ok(assumptions)
    }

    /// What to write for a 0 in an inertia: a millionth of the largest other entry. Of a whole that is zero no number is
    /// small beside it, and the rest of the model, of which one may be, is not known here.
    fn instead_of_zero(&self, matrix: &Matrix) -> Option<String> {
        let place = "write a number far below the others in the place of the 0, such as";
        let values = matrix.entries.iter();
        let values = values.map(|it| self.pool.constant_value(*it));
        let largest = values.clone().flatten().fold(0.0, f64::max);
        if largest > 0.0 {
            let exponent = largest.log10().floor() - 6.0;
            return Some(format!(
                "{place} `1e{exponent}`: nothing that is visible changes"
            ));
        }
        if values.clone().any(|it| it.is_none()) {
            return Some(format!("{place} a millionth of one of them: `1e-6 * …`"));
        }
        let is_own = self.lookup.scopes[self.lookup.scope].library.is_none();
        let name = &self.element.name;
        is_own.then(|| format!("remove `{name}`: without an inertia it changes nothing"))
    }

    pub(super) fn initial(&mut self, coenergy: &[Expression]) -> Result<Option<Vec<Expression>>> {
        let Start { word, state, port } = start_of(self.element.kind);
        let find = |word: &str| self.element.fields.iter().find(|field| field.name == word);
        if let (Some(_), Some(second)) = (find("initial"), find(word)) {
            let name = &self.element.name;
            let message = format!("`{name}` is given both a {state} and {port} at the start");
            let report = error(codes::FIELD_REPEATED, second.name.span(), message);
            let help = format!("remove `initial` or `{word}`: one follows from the other");
            return Err(Box::new(report.help(help)));
        }
        if let Some(value) = find("initial").and_then(|field| field.value.as_ref()) {
            return self.vector(value).map(Some);
        }
        let Some(value) = find(word).and_then(|field| field.value.as_ref()) else {
            return Ok(None);
        };
        let given = self.vector(value)?;
        self.stored(coenergy, &given, value.span()).map(Some)
    }

    /// The state at which a linear law gives this flow or effort: `p = I (f − f₀)`, from `f = I⁻¹ p + f₀`, and so for displacements.
    fn stored(
        &mut self,
        coenergy: &[Expression],
        given: &[Expression],
        span: Span,
    ) -> Result<Vec<Expression>> {
        let mut at_rest = Substitution::new();
        for state in self.own.states.clone() {
            at_rest.set(Symbol::State(state), Expression::ZERO);
        }
        let (mut entries, mut added) = (Vec::new(), Vec::new());
        for (row, given) in coenergy.iter().zip(given) {
            for state in self.own.states.clone() {
                entries.push(Differentiator::new(Symbol::State(state)).derivative(self.pool, *row));
            }
            let rest = at_rest.apply(self.pool, *row).unwrap_or(Expression::ZERO);
            added.push(self.pool.subtract(*given, rest));
        }
        let own =
            |it: &Symbol| matches!(it, Symbol::State(state) if self.own.states.contains(state));
        if symbols(self.pool, &entries).iter().any(own) {
            let (Start { state, port, .. }, name) =
                (start_of(self.element.kind), &self.element.name);
            let message = format!(
                "the {state} of `{name}` does not follow from {port}: its law is not linear"
            );
            let report = error(codes::EXPRESSION, span, message);
            return Err(Box::new(
                report.help(format!("give the {state} itself: `initial: …`")),
            ));
        }
        let size = self.own.dimension;
        let slopes = self.inverse("slope", &Matrix::new(size, size, entries), span)?;
        Ok(slopes.times(self.pool, &Matrix::column(added)).entries)
    }
}

/// How the start of a storage is given in the place of its state.
struct Start {
    word: &'static str,
    state: &'static str,
    port: &'static str,
}

const fn start_of(kind: ElementKind) -> Start {
    match kind {
        ElementKind::I => Start {
            word: "initial_flow",
            state: "momentum",
            port: "a flow",
        },
        _ => Start {
            word: "initial_effort",
            state: "displacement",
            port: "an effort",
        },
    }
}

/// A storage keeps its energy on all ways between two states where its matrix is symmetric.
pub(super) fn check_symmetry(pool: &Pool, matrix: &Matrix, span: Span) -> Result<()> {
    if matrix.is_symmetric() {
        return Ok(());
    }
    let message = "the matrix of a storage must be symmetric, or it would create energy";
    let report = error(codes::EXPRESSION, span, message);
    Err(Box::new(match asymmetry(pool, matrix) {
        Some(note) => report.note(note),
        None => report,
    }))
}

/// The first two entries that would be equal in a symmetric matrix, and are not.
fn asymmetry(pool: &Pool, matrix: &Matrix) -> Option<String> {
    let pairs = (0..matrix.rows).flat_map(|row| (0..row).map(move |column| (column, row)));
    let mut pairs = pairs.map(|(row, column)| [(row, column), (column, row)]);
    let entry = |(row, column): (usize, usize)| matrix.at(row, column);
    let [first, second] = pairs.find(|[a, b]| entry(*a) != entry(*b))?;
    let text = |(row, column): (usize, usize)| {
        let value = pool.constant_value(matrix.at(row, column));
        let value = value.map_or_else(String::new, |value| format!(" is {}", number(value)));
        format!("entry `[{row}][{column}]`{value}")
    };
    let (first, second) = (text(first), text(second));
    Some(format!("two of its entries differ: {first}, {second}"))
}

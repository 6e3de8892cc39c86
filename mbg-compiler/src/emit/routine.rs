//! Steps as `let` bindings.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

use proc_macro2::{Delimiter, Group, Ident, Literal, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};

use crate::compile::Compiled;
use crate::program::{Columns, Operand, Routine, Solve, Solver, Source, Step, angles};
use crate::symbolic::{Kind, Symbol};

/// Where a routine finds what it reads.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Setting {
    /// A method of the model.
    Method,
    /// `new`, where parameters are at hand and nothing is folded yet.
    Constructor,
    /// `new`, after folding.
    Folded,
}

/// The bindings of a routine, and its results.
pub(super) fn lines(
    compiled: &Compiled,
    routine: &Routine,
    setting: Setting,
) -> (TokenStream, Vec<TokenStream>) {
    let writer = Writer {
        setting,
        ..Writer::of(compiled, routine)
    };
    let body = writer.lines(&routine.steps, 0, &Made::read(&routine.results));
    let results = routine
        .results
        .iter()
        .map(|result| writer.operand(*result).into_token_stream())
        .collect();
    (body, results)
}

/// The bindings of a method, with each result written to its place, the left side of an assignment, as soon as it is known;
/// what has no place is not written.
pub(super) fn written_lines(
    writer: &Writer,
    routine: &Routine,
    places: &[Option<TokenStream>],
) -> TokenStream {
    let mut writer = writer.clone();
    for (value, place) in &*writer.kept {
        let (name, place) = (&writer.names[*value], Literal::usize_suffixed(*place));
        writer.written.insert(*value, quote!(kept[#place] = #name;));
    }
    let (mut known, mut solved) = (TokenStream::new(), TokenStream::new());
    for (result, place) in routine.results.iter().zip(places) {
        let Some(place) = place else { continue };
        let value = writer.operand(*result);
        let line = quote!(#place = #value;);
        match result.source {
            Source::Value(value) => writer.written.entry(value).or_default().extend(line),
            Source::Solved(_) => solved.extend(line),
            _ => known.extend(line),
        }
    }
    let columns = routine.columns.iter().flat_map(|it| &it.steps);
    let mut behind: Vec<Made> = columns.filter_map(Made::needed_by).collect();
    let results = Made::read(&routine.results).into_iter();
    behind.extend(results.filter(|made| matches!(made, Made::Solved(_))));
    let lines = writer.lines(&routine.steps, 0, &behind);
    let kept = Literal::usize_suffixed(writer.kept.len());
    let kept = (!writer.kept.is_empty()).then(|| quote!(let mut kept = [T::from_f64(0.0); #kept];));
    quote!(#kept #known #lines #solved)
}

/// The bindings of columns of a Jacobian, and the slopes of the rates with these numbers. `whole(value)` makes a scalar one
/// for all columns, and `slopes` holds what changes.
pub(super) fn column_lines(
    writer: &Writer,
    columns: &Columns,
    rows: &[usize],
) -> (TokenStream, Vec<TokenStream>) {
    let solved = columns.steps.iter().filter_map(|step| match step {
        Step::Solve(solve) => Some(solve.number),
        _ => None,
    });
    let writer = Writer {
        columns: Some((columns.first, solved.collect())),
        ..writer.clone()
    };
    let behind = Made::read(&columns.results);
    let body = writer.lines(&columns.steps, columns.first, &behind);
    let results = rows.iter().map(|row| writer.operand(columns.results[*row]));
    let results = results.map(|result| result.into_token_stream());
    (body, results.collect())
}

/// The place of each value that columns of a Jacobian read. These values are put into one array as soon as they are there,
/// so that nothing is copied for the columns.
fn kept(routine: &Routine) -> BTreeMap<usize, usize> {
    let numbered = routine.kept().into_iter().enumerate();
    numbered.map(|(place, value)| (value, place)).collect()
}

/// A local name for each value: its variable's, where it has one that no other value has.
fn names(routine: &Routine) -> Vec<Ident> {
    let mut taken = BTreeSet::new();
    routine
        .names
        .iter()
        .enumerate()
        .map(|(value, name)| {
            if name.is_empty() {
                return Ident::new(&format!("v{value}"), Span::mixed_site());
            }
            let word: String = name
                .chars()
                .map(|c| {
                    if c.is_ascii_alphanumeric() {
                        c.to_ascii_lowercase()
                    } else {
                        '_'
                    }
                })
                .collect();
            let word = format!("v_{word}");
            let is_new = taken.insert(word.clone());
            let name = if is_new { word } else { format!("v{value}") };
            Ident::new(&name, Span::mixed_site())
        })
        .collect()
}

/// Most lines in one block. Each `let` is a scope inside the one before, and debuggers' tables of thousands of them
/// overflow the stack of `rustc`.
const PART: usize = 256;

/// What a step makes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Made {
    Value(usize),
    Solved(usize),
    Factors(usize),
}

impl Made {
    fn of(source: Source) -> Option<Self> {
        match source {
            Source::Value(value) => Some(Self::Value(value)),
            Source::Solved(place) => Some(Self::Solved(place.number)),
            Source::Constant(_) | Source::Symbol(_) | Source::Folded(_) => None,
        }
    }

    /// What operands read.
    fn read(operands: &[Operand]) -> Vec<Self> {
        let operands = operands.iter();
        operands.filter_map(|it| Self::of(it.source)).collect()
    }

    /// The factors that a step uses.
    fn needed_by(step: &Step) -> Option<Self> {
        match step {
            Step::Solve(solve) => match solve.solver {
                Solver::Slope(of) => Some(Self::Factors(of)),
                Solver::Newton(_) | Solver::Linear(_) => None,
            },
            _ => None,
        }
    }
}

/// The last part that reads what is made, some of which is read behind all parts.
fn last_parts(parts: &[&[Step]], behind: &[Made]) -> BTreeMap<Made, usize> {
    let mut last = BTreeMap::new();
    if parts.len() == 1 {
        return last;
    }
    for (number, part) in parts.iter().enumerate() {
        let factors = part.iter().filter_map(Made::needed_by);
        let read = part.iter().flat_map(|step| Made::read(&step.operands()));
        last.extend(read.chain(factors).map(|made| (made, number)));
    }
    last.extend(behind.iter().map(|made| (*made, parts.len())));
    last
}

/// What writes the steps of a routine.
#[derive(Clone)]
pub(super) struct Writer<'a> {
    compiled: &'a Compiled,
    names: Rc<[Ident]>,
    setting: Setting,
    /// The place of each value that is kept for columns of a Jacobian.
    kept: Rc<BTreeMap<usize, usize>>,
    /// What is written as soon as a value is there.
    written: BTreeMap<usize, TokenStream>,
    /// In columns of a Jacobian, the first value that is theirs, and the numbers of their solves.
    columns: Option<(usize, BTreeSet<usize>)>,
}

impl<'a> Writer<'a> {
    /// For a method.
    pub(super) fn of(compiled: &'a Compiled, routine: &Routine) -> Self {
        Self {
            compiled,
            names: names(routine).into(),
            setting: Setting::Method,
            kept: kept(routine).into(),
            written: BTreeMap::new(),
            columns: None,
        }
    }

    /// Steps whose values begin with number `value`, with what is read behind them.
    fn lines(&self, steps: &[Step], mut value: usize, behind: &[Made]) -> TokenStream {
        let parts: Vec<&[Step]> = steps.chunks(PART).collect();
        let last_part = last_parts(&parts, behind);
        let mut body = TokenStream::new();
        for (number, part) in parts.iter().enumerate() {
            let mut lines = TokenStream::new();
            let mut made = BTreeMap::new();
            let mut rest = *part;
            while let Some(step) = rest.first() {
                let angles = angles(rest, value);
                let taken = angles.len().max(1);
                lines.extend(match angles.len() {
                    0 | 1 => self.line(step, value),
                    _ => self.sines_cosines(&angles, value),
                });
                let (now, after) = rest.split_at(taken);
                for step in now {
                    self.make(step, value, &mut made);
                    lines.extend(self.store(value..value + step.results()));
                    value += step.results();
                }
                rest = after;
            }
            if parts.len() == 1 {
                return lines;
            }
            let live: Vec<&Ident> = made
                .iter()
                .filter(|(made, _)| last_part.get(made).is_some_and(|last| *last > number))
                .map(|(_, name)| name)
                .collect();
            lines.extend(quote!((#(#live,)*)));
            let block = Group::new(Delimiter::Brace, lines);
            body.extend(quote!(let (#(#live,)*) = #block;));
        }
        body
    }

    /// Puts values where they are wanted.
    fn store(&self, values: Range<usize>) -> TokenStream {
        let written = self.written.range(values);
        written.map(|(_, lines)| lines.clone()).collect()
    }

    /// The names that a step gives to what it makes.
    fn make(&self, step: &Step, value: usize, made: &mut BTreeMap<Made, Ident>) {
        if let Step::Solve(solve) = step {
            made.insert(Made::Solved(solve.number), unknowns(solve.number));
            if matches!(solve.solver, Solver::Linear(_)) {
                made.insert(Made::Factors(solve.number), factors(solve.number));
            }
            return;
        }
        for value in value..value + step.results() {
            made.insert(Made::Value(value), self.names[value].clone());
        }
    }

    fn line(&self, step: &Step, value: usize) -> TokenStream {
        let name = self.names.get(value);
        match step {
            Step::Add(a, b) => {
                let (first, second) = (self.operand(*a), self.operand(Operand::plain(b.source)));
                if b.negative {
                    quote!(let #name = #first - #second;)
                } else {
                    quote!(let #name = #first + #second;)
                }
            }
            Step::Multiply(a, b) => {
                let (a, b) = (self.operand(*a), self.operand(*b));
                quote!(let #name = #a * #b;)
            }
            Step::MultiplyAdd(a, b, c) => {
                let [a, b, c] = [*a, *b, *c].map(|it| self.operand(it));
                if self.columns.is_some() {
                    quote!(let #name = #a.multiply_add(#b, #c);)
                } else {
                    quote!(let #name = T::multiply_add(#a, #b, #c);)
                }
            }
            Step::Divide(a, b) => {
                let (a, b) = (self.operand(*a), self.operand(*b));
                quote!(let #name = #a / #b;)
            }
            Step::SineCosine(a) => {
                let (sine, cosine) = (&self.names[value], &self.names[value + 1]);
                let a = self.operand(*a);
                quote!(let (#sine, #cosine) = T::sin_cos(#a);)
            }
            Step::Sine(a) => self.call(name, "sin", &[*a]),
            Step::Cosine(a) => self.call(name, "cos", &[*a]),
            Step::Call(function, arguments) => self.call(name, function.name(), arguments),
            Step::Solve(solve) => self.solve(solve, value),
        }
    }

    /// Sines and cosines of several angles, side by side.
    fn sines_cosines(&self, angles: &[Operand], value: usize) -> TokenStream {
        let pairs = self.names[value..].chunks(2).take(angles.len());
        let (sines, cosines): (Vec<_>, Vec<_>) = pairs.map(|pair| (&pair[0], &pair[1])).unzip();
        let angles = angles.iter().map(|angle| self.operand(*angle));
        quote! {
            let ([#(#sines),*], [#(#cosines),*]) = T::sines_cosines([#(#angles),*]);
        }
    }

    /// The runtime's iteration, with residuals and Jacobian as a closure over what comes before.
    fn solve(&self, solve: &Solve, value: usize) -> TokenStream {
        let unknowns = unknowns(solve.number);
        let number = match solve.solver {
            Solver::Newton(number) => number,
            Solver::Linear(kind) => return self.linear(solve, kind),
            Solver::Slope(of) => return self.slope(solve, of),
        };
        let [number, first, size] =
            [number, self.compiled.first(number), solve.size].map(Literal::usize_suffixed);
        let body = self.lines(&solve.steps, value, &Made::read(&solve.results));
        let operands = |list: &[Operand]| -> Vec<Term<'_>> {
            list.iter().map(|operand| self.operand(*operand)).collect()
        };
        let (residuals, jacobian) = solve.results.split_at(solve.size);
        let (residuals, jacobian) = (operands(residuals), operands(jacobian));
        quote! {
            let #unknowns = ::mbg_runtime::LoopMemory::solve(
                memory, #number, #first,
                |#unknowns: &::mbg_runtime::__private::SVector<T, #size>| {
                    #body
                    (
                        ::mbg_runtime::__private::SVector::<T, #size>::from_row_slice(&[#(#residuals),*]),
                        ::mbg_runtime::__private::SMatrix::<T, #size, #size>::from_row_slice(&[#(#jacobian),*]),
                    )
                },
            );
        }
    }

    /// The runtime's solution of linear equations, with the factors of their matrix.
    fn linear(&self, solve: &Solve, kind: Kind) -> TokenStream {
        let (unknowns, factors) = (unknowns(solve.number), factors(solve.number));
        let (right, matrix) = solve.results.split_at(solve.size);
        let entries = matrix.iter().enumerate().filter_map(|(place, entry)| {
            let (row, column) = (place / solve.size, place % solve.size);
            let needed = kind == Kind::Regular || column <= row;
            let [row, column] = [row, column].map(Literal::usize_unsuffixed);
            let value = self.operand(*entry);
            (needed && entry.source != Source::Constant(0.0))
                .then(|| quote!((#row, #column, #value)))
        });
        let (size, right) = (Literal::usize_suffixed(solve.size), self.column(right));
        let (factorised, matrix) = match kind {
            Kind::Semidefinite => (quote!(Semidefinite), quote!(symmetric)),
            Kind::Regular => (quote!(Regular), quote!(sparse)),
        };
        quote! {
            let #factors = ::mbg_runtime::solve::#factorised::<T, #size>::new(
                ::mbg_runtime::__private::#matrix(&[#(#entries),*])
            );
            let #unknowns = #factors.solution(&#right);
        }
    }

    /// The same with earlier factors.
    fn slope(&self, solve: &Solve, of: usize) -> TokenStream {
        let (unknowns, factors) = (unknowns(solve.number), factors(of));
        if self.columns.is_some() {
            let right = solve.results.iter().map(|operand| self.operand(*operand));
            return quote! {
                let #unknowns = ::mbg_runtime::__private::by_lane(&[#(#right),*], |right| #factors.solution(right));
            };
        }
        let right = self.column(&solve.results);
        quote!(let #unknowns = #factors.solution(&#right);)
    }

    fn column(&self, operands: &[Operand]) -> TokenStream {
        let size = Literal::usize_suffixed(operands.len());
        let operands = operands.iter().map(|operand| self.operand(*operand));
        quote!(::mbg_runtime::__private::SVector::<T, #size>::from_row_slice(&[#(#operands),*]))
    }

    fn call(&self, name: Option<&Ident>, function: &str, arguments: &[Operand]) -> TokenStream {
        let function = format_ident!("{}", function);
        let mut arguments = arguments.iter().map(|argument| self.operand(*argument));
        if self.columns.is_some() {
            let first = arguments.next();
            return quote!(let #name = #first.#function(#(#arguments),*););
        }
        quote!(let #name = T::#function(#(#arguments),*);)
    }

    fn operand(&self, operand: Operand) -> Term<'_> {
        Term {
            writer: self,
            operand,
        }
    }

    /// Whether a scalar stands where columns side by side are worked out.
    fn is_whole(&self, source: Source) -> bool {
        let Some((first, solved)) = &self.columns else {
            return false;
        };
        match source {
            Source::Value(value) => value < *first,
            Source::Solved(place) => !solved.contains(&place.number),
            Source::Symbol(Symbol::Slope(_)) => false,
            Source::Constant(_) | Source::Symbol(_) | Source::Folded(_) => true,
        }
    }

    /// A scalar without its sign.
    fn scalar(&self, source: Source) -> TokenStream {
        match source {
            Source::Constant(value) => {
                let literal = Literal::f64_suffixed(value);
                quote!(T::from_f64(#literal))
            }
            Source::Symbol(Symbol::Parameter(index)) => {
                let name = &self.compiled.model.parameters[index].name;
                if self.setting == Setting::Method {
                    quote!(self.parameters.#name)
                } else {
                    quote!(parameters.#name)
                }
            }
            Source::Symbol(Symbol::State(index)) => element(quote!(x), index),
            Source::Symbol(Symbol::Input(index)) => element(quote!(u), index),
            Source::Symbol(Symbol::Slope(index)) => element(quote!(slopes), index),
            Source::Solved(place) => {
                let unknowns = unknowns(place.number);
                element(quote!(#unknowns), place.row)
            }
            Source::Symbol(Symbol::Time | Symbol::Signal(_) | Symbol::Unknown(_)) => quote!(t),
            Source::Folded(index) => {
                let index = Literal::usize_suffixed(index);
                if self.setting == Setting::Method {
                    quote!(self.folded[#index])
                } else {
                    quote!(folded[#index])
                }
            }
            Source::Value(index) => match self.columns.as_ref().and_then(|_| self.kept.get(&index))
            {
                Some(place) => element(quote!(kept), *place),
                None => self.names[index].to_token_stream(),
            },
        }
    }
}

/// An operand as it is read. It is written where it belongs at once: tokens that go through several streams are copied
/// as often.
struct Term<'a> {
    writer: &'a Writer<'a>,
    operand: Operand,
}

impl ToTokens for Term<'_> {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        let Operand { source, negative } = self.operand;
        let scalar = self.writer.scalar(source);
        match (self.writer.is_whole(source), negative) {
            (false, false) => tokens.extend(scalar),
            (false, true) => tokens.extend(quote!((-#scalar))),
            (true, false) => tokens.extend(quote!(whole(#scalar))),
            (true, true) => tokens.extend(quote!(whole((-#scalar)))),
        }
    }
}

/// What holds the unknowns of an iteration.
fn unknowns(number: usize) -> Ident {
    format_ident!("z{}", number, span = Span::mixed_site())
}

/// What holds the factors of the matrix that gives the unknowns.
fn factors(number: usize) -> Ident {
    format_ident!("s{}", number, span = Span::mixed_site())
}

fn element(array: TokenStream, index: usize) -> TokenStream {
    let index = Literal::usize_suffixed(index);
    quote!(#array[#index])
}

//! Steps as `let` bindings.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

use proc_macro2::{Delimiter, Ident, Literal, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use rustc_hash::FxHashMap;

use super::parameters;
use super::repeats::Left;
use super::tokens::{Tokens, Words, block, element, numbered};
use crate::compile::Compiled;
use crate::program::{Operand, Repeat, Routine, Solve, Solver, Source, Step, Sweep, angles};
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
        left: Left::of(routine, &[]).into(),
        ..Writer::of(compiled, routine)
    };
    let body = writer.parts(&parts(routine), 0, &Made::read(&routine.results));
    let results = routine
        .results
        .iter()
        .map(|result| writer.operand(*result).into_token_stream())
        .collect();
    (body, results)
}

/// Where a result goes.
#[derive(Clone, Copy)]
pub(super) enum Place {
    /// A row of the derivative.
    Derivative(usize),
    /// A row and a column of a Jacobian.
    Jacobian(usize, usize),
}

impl ToTokens for Place {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        let number = Literal::usize_suffixed;
        tokens.extend(match *self {
            Self::Derivative(row) => {
                let row = number(row);
                quote!(derivative[#row])
            }
            Self::Jacobian(row, column) => {
                let (row, column) = (number(row), number(column));
                quote!(jacobian[(#row, #column)])
            }
        });
    }
}

/// The bindings of a method, with each result written to its place as soon as it is known; what has no place is not written.
pub(super) fn written_lines(
    writer: &Writer,
    routine: &Routine,
    places: &[Option<Place>],
) -> TokenStream {
    let mut writer = writer.clone();
    writer.left = Left::of(routine, places).into();
    for (value, place) in &*writer.kept {
        let (name, place) = (&writer.names[*value], Literal::usize_suffixed(*place));
        writer.written.insert(*value, quote!(kept[#place] = #name;));
    }
    let (mut known, mut late) = (TokenStream::new(), TokenStream::new());
    for (result, place) in routine.results.iter().zip(places) {
        let Some(place) = place.filter(|_| !writer.left.writes(*result)) else {
            continue;
        };
        let value = writer.operand(*result);
        let line = quote!(#place = #value;);
        match result.source {
            Source::Solved(_) => late.extend(line),
            Source::Value(_) if writer.left.home_of(*result).is_some() => late.extend(line),
            Source::Value(value) => writer.written.entry(value).or_default().extend(line),
            _ => known.extend(line),
        }
    }
    let swept = routine.sweeps.iter().flat_map(|it| &it.steps);
    let mut behind: Vec<Made> = swept.filter_map(Made::needed_by).collect();
    // Values that sweeps read are kept, and those that are returned are written at once.
    let read = Made::read(&routine.read_behind()).into_iter();
    behind.extend(read.filter(|made| matches!(made, Made::Solved(_))));
    let lines = writer.parts(&parts(routine), 0, &behind);
    let kept = Literal::usize_suffixed(writer.kept.len());
    let kept = (!writer.kept.is_empty()).then(|| quote!(let mut kept = [T::from_f64(0.0); #kept];));
    let mut all = kept.unwrap_or_default();
    all.extend([known, lines, late]);
    all
}

/// The bindings of a sweep of a Jacobian, and its results with these numbers. `whole(value)` makes a scalar one for all
/// directions side by side, `slopes` holds what changes, and `changing` says in which directions.
pub(super) fn sweep_lines(
    writer: &Writer,
    sweep: &Sweep,
    results: &[usize],
) -> (TokenStream, Vec<TokenStream>) {
    let solved = sweep.steps.iter().filter_map(|step| match step {
        Step::Solve(solve) => Some(solve.number),
        _ => None,
    });
    let writer = Writer {
        sweep: Some((sweep.first, solved.collect())),
        ..writer.clone()
    };
    let behind = Made::read(&sweep.results);
    let body = writer.parts(&by_stretches(sweep), sweep.first, &behind);
    let results = results
        .iter()
        .map(|result| writer.operand(sweep.results[*result]));
    let results = results.map(|result| result.into_token_stream());
    (body, results.collect())
}

/// The steps of a routine: straight ones, and repeats.
fn parts(routine: &Routine) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    let mut begin = 0;
    for repeat in &routine.repeats {
        let Range { start, end } = repeat.steps;
        parts.extend(Part::straight(&routine.steps[begin..start], None));
        parts.push(Part {
            steps: &routine.steps[start..end],
            changes: None,
            repeat: Some(repeat),
        });
        begin = end;
    }
    parts.extend(Part::straight(&routine.steps[begin..], None));
    parts
}

/// The steps of a sweep by stretches. What changes in all directions is never left out.
fn by_stretches(sweep: &Sweep) -> Vec<Part<'_>> {
    let mut rest = &sweep.steps[..];
    let stretches = sweep.stretches().into_iter();
    let parts = stretches.flat_map(|stretch| {
        let (steps, behind) = rest.split_at(stretch.steps);
        rest = behind;
        let some = stretch.directions.len() < sweep.coverage.directions.len();
        let changes = some.then(|| stretch.mask());
        Part::straight(steps, changes)
    });
    parts.collect()
}

/// The place of each value that sweeps of a Jacobian read. These values are put into one array as soon as they are there,
/// so that nothing is copied for the sweeps.
fn kept(routine: &Routine) -> BTreeMap<usize, usize> {
    let numbered = routine.kept().into_iter().enumerate();
    numbered.map(|(place, value)| (value, place)).collect()
}

/// A local name for each value: its variable's, where it has one that no other value has.
fn names(routine: &Routine) -> Vec<Ident> {
    let mut taken = BTreeSet::new();
    // A line of a loop is about no variable in particular.
    let in_turn = |value: usize| routine.repeats.iter().any(|it| it.place(value).is_some());
    routine
        .names
        .iter()
        .enumerate()
        .map(|(value, name)| {
            if name.is_empty() || in_turn(value) {
                return numbered("v", value);
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
            let word = format!("v_{word}_");
            if taken.insert(word.clone()) {
                Ident::new(&word, Span::mixed_site())
            } else {
                numbered("v", value)
            }
        })
        .collect()
}

/// Most lines in one block. Each `let` is a scope inside the one before, and debuggers' tables of thousands of them
/// overflow the stack of `rustc`.
const PART: usize = 256;

/// What a step makes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Made {
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

    /// Adds what a step makes, whose values begin with number `value`.
    fn by(step: &Step, value: usize, made: &mut Vec<Self>) {
        match step {
            Step::Solve(solve) => {
                made.push(Self::Solved(solve.number));
                if matches!(solve.solver, Solver::Linear(_)) {
                    made.push(Self::Factors(solve.number));
                }
            }
            _ => made.extend((value..value + step.results()).map(Self::Value)),
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

/// Steps in one block.
struct Part<'a> {
    steps: &'a [Step],
    /// The directions of which one must be worked out, else all of it is zero.
    changes: Option<u64>,
    /// Whether they are written as a loop.
    repeat: Option<&'a Repeat>,
}

impl<'a> Part<'a> {
    fn straight(steps: &'a [Step], changes: Option<u64>) -> impl Iterator<Item = Self> {
        steps.chunks(PART).map(move |steps| Self {
            steps,
            changes,
            repeat: None,
        })
    }
}

/// The last part that reads what is made, some of which is read behind all parts.
fn last_parts(parts: &[Part<'_>], behind: &[Made]) -> FxHashMap<Made, usize> {
    let mut last = FxHashMap::default();
    if parts.len() == 1 {
        return last;
    }
    for (number, part) in parts.iter().enumerate() {
        for step in part.steps {
            let read = step.operands();
            let read = read.iter().filter_map(|it| Made::of(it.source));
            for made in read.chain(Made::needed_by(step)) {
                last.insert(made, number);
            }
        }
    }
    last.extend(behind.iter().map(|made| (*made, parts.len())));
    last
}

/// Steps in a block, with what later ones read of them.
fn bound(mut lines: Tokens, live: &[Ident], changes: Option<u64>) -> TokenStream {
    if live.is_empty() {
        let block = block(lines.stream());
        let changes = changes.map(Literal::u64_unsuffixed);
        return match changes {
            Some(changes) => quote!(if changing & #changes != 0 #block),
            None => quote!(#block),
        };
    }
    lines.extend(quote!((#(#live,)*)));
    let block = block(lines.stream());
    let Some(changes) = changes.map(Literal::u64_unsuffixed) else {
        return quote!(let (#(#live,)*) = #block;);
    };
    let zeros = live.iter().map(|_| quote!(zero));
    quote! {
        let (#(#live,)*) = if changing & #changes != 0 #block else {
            let zero = whole(T::from_f64(0.0));
            (#(#zeros,)*)
        };
    }
}

/// What writes the steps of a routine.
#[derive(Clone)]
pub(super) struct Writer<'a> {
    compiled: &'a Compiled,
    words: Rc<Words>,
    pub(super) names: Rc<[Ident]>,
    setting: Setting,
    /// The place of each value that is kept for sweeps of a Jacobian.
    kept: Rc<BTreeMap<usize, usize>>,
    /// What is written as soon as a value is there.
    written: BTreeMap<usize, TokenStream>,
    /// What loops leave behind.
    pub(super) left: Rc<Left>,
    /// In a loop, the values that have a name there.
    named: Range<usize>,
    /// In a sweep of a Jacobian, the first value that is its own, and the numbers of its solves.
    sweep: Option<(usize, BTreeSet<usize>)>,
}

impl<'a> Writer<'a> {
    /// For a method.
    pub(super) fn of(compiled: &'a Compiled, routine: &Routine) -> Self {
        Self {
            compiled,
            words: Rc::new(Words::new()),
            names: names(routine).into(),
            setting: Setting::Method,
            kept: kept(routine).into(),
            written: BTreeMap::new(),
            left: Rc::default(),
            named: 0..0,
            sweep: None,
        }
    }

    /// For a turn of a loop: with other names, those of these values, and what is written there.
    pub(super) fn in_turn(
        &self,
        names: Vec<Ident>,
        named: Range<usize>,
        written: BTreeMap<usize, TokenStream>,
    ) -> Self {
        Self {
            names: names.into(),
            named,
            written,
            ..self.clone()
        }
    }

    /// Steps whose values begin with number `value`, with what is read behind them.
    fn lines(&self, steps: &[Step], value: usize, behind: &[Made]) -> TokenStream {
        let parts: Vec<Part> = Part::straight(steps, None).collect();
        self.parts(&parts, value, behind)
    }

    /// The same, of steps in parts.
    fn parts(&self, parts: &[Part<'_>], mut value: usize, behind: &[Made]) -> TokenStream {
        let last_part = last_parts(parts, behind);
        let mut body = TokenStream::new();
        for (number, part) in parts.iter().enumerate() {
            if let Some(repeat) = part.repeat {
                body.extend(self.repeat(repeat, part.steps));
                value += repeat.turns * repeat.values;
                continue;
            }
            let mut lines = Tokens::default();
            let mut made = Vec::new();
            value = self.straight(part.steps, value, &mut lines, &mut made);
            if parts.len() == 1 {
                return lines.stream();
            }
            made.retain(|made| last_part.get(made).is_some_and(|last| *last > number));
            made.sort_unstable();
            let live: Vec<Ident> = made.iter().map(|made| self.name(*made)).collect();
            body.extend(bound(lines, &live, part.changes));
        }
        body
    }

    /// Adds steps whose values begin with number `value`, and what they make; gives the number of the next value.
    pub(super) fn straight(
        &self,
        steps: &[Step],
        mut value: usize,
        lines: &mut Tokens,
        made: &mut Vec<Made>,
    ) -> usize {
        let mut rest = steps;
        while let Some(step) = rest.first() {
            let angles = angles(rest, value);
            let taken = angles.len().max(1);
            match angles.len() {
                0 | 1 => self.line(step, value, lines),
                _ => lines.extend(self.sines_cosines(&angles, value)),
            }
            let (now, after) = rest.split_at(taken);
            for step in now {
                Made::by(step, value, made);
                for (_, written) in self.written.range(value..value + step.results()) {
                    lines.extend(written.clone());
                }
                value += step.results();
            }
            rest = after;
        }
        value
    }

    /// The name of what a step makes.
    fn name(&self, made: Made) -> Ident {
        match made {
            Made::Value(value) => self.names[value].clone(),
            Made::Solved(number) => unknowns(number),
            Made::Factors(number) => factors(number),
        }
    }

    /// Adds the line of a step. Most are sums and products, and written without `quote!`.
    fn line(&self, step: &Step, value: usize, lines: &mut Tokens) {
        let words = &*self.words;
        let name = self.names.get(value);
        let arithmetic = |lines: &mut Tokens, write: &dyn Fn(&mut Tokens)| {
            lines.name(&words.bind);
            lines.name(&self.names[value]);
            lines.sign('=');
            write(lines);
            lines.sign(';');
        };
        let between = |lines: &mut Tokens, sign: char, a: Operand, b: Operand| {
            arithmetic(lines, &|lines| {
                self.read(a, lines);
                lines.sign(sign);
                self.read(b, lines);
            });
        };
        match step {
            Step::Add(a, b) if b.negative => between(lines, '-', *a, Operand::plain(b.source)),
            Step::Add(a, b) => between(lines, '+', *a, *b),
            Step::Multiply(a, b) => between(lines, '*', *a, *b),
            Step::Divide(a, b) => between(lines, '/', *a, *b),
            Step::MultiplyAdd(a, b, c) => arithmetic(lines, &|lines| {
                let mut arguments = Tokens::default();
                if self.sweep.is_some() {
                    self.read(*a, lines);
                    lines.sign('.');
                } else {
                    lines.name(&words.scalar);
                    lines.colons();
                    self.read(*a, &mut arguments);
                    arguments.sign(',');
                }
                lines.name(&words.multiply_add);
                self.read(*b, &mut arguments);
                arguments.sign(',');
                self.read(*c, &mut arguments);
                lines.group(Delimiter::Parenthesis, arguments);
            }),
            Step::SineCosine(a) => {
                let (sine, cosine) = (&self.names[value], &self.names[value + 1]);
                let a = self.operand(*a);
                lines.extend(quote!(let (#sine, #cosine) = T::sin_cos(#a);));
            }
            Step::Sine(a) => lines.extend(self.call(name, "sin", &[*a])),
            Step::Cosine(a) => lines.extend(self.call(name, "cos", &[*a])),
            Step::Call(function, arguments) => {
                lines.extend(self.call(name, function.name(), arguments));
            }
            Step::Solve(solve) => lines.extend(self.solve(solve, value)),
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
            let #unknowns = mbg_runtime::LoopMemory::solve(
                memory, #number, #first,
                |#unknowns: &mbg_runtime::__private::SVector<T, #size>| {
                    #body
                    (
                        mbg_runtime::__private::SVector::<T, #size>::from_row_slice(&[#(#residuals),*]),
                        mbg_runtime::__private::SMatrix::<T, #size, #size>::from_row_slice(&[#(#jacobian),*]),
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
            Kind::Symmetric => (quote!(Symmetric), quote!(symmetric)),
        };
        let (new, rank) = match self.compiled.ranks.of.get(&solve.number) {
            Some(group) => (
                quote!(of_rank),
                Some(super::close::rank(self.compiled, *group)),
            ),
            None => (quote!(new), None),
        };
        quote! {
            let #factors = mbg_runtime::solve::#factorised::<T, #size>::#new(
                mbg_runtime::__private::#matrix(&[#(#entries),*]), #rank
            );
            let #unknowns = #factors.solution(&#right);
        }
    }

    /// The same with earlier factors.
    fn slope(&self, solve: &Solve, of: usize) -> TokenStream {
        let (unknowns, factors) = (unknowns(solve.number), factors(of));
        if self.sweep.is_some() {
            let right = solve.results.iter().map(|operand| self.operand(*operand));
            return quote!(let #unknowns = #factors.columns(&[#(#right),*]););
        }
        let right = self.column(&solve.results);
        quote!(let #unknowns = #factors.solution(&#right);)
    }

    fn column(&self, operands: &[Operand]) -> TokenStream {
        let size = Literal::usize_suffixed(operands.len());
        let operands = operands.iter().map(|operand| self.operand(*operand));
        quote!(mbg_runtime::__private::SVector::<T, #size>::from_row_slice(&[#(#operands),*]))
    }

    fn call(&self, name: Option<&Ident>, function: &str, arguments: &[Operand]) -> TokenStream {
        let function = format_ident!("{}", function);
        let mut arguments = arguments.iter().map(|argument| self.operand(*argument));
        if self.sweep.is_some() {
            let first = arguments.next();
            return quote!(let #name = #first.#function(#(#arguments),*););
        }
        quote!(let #name = T::#function(#(#arguments),*);)
    }

    pub(super) fn operand(&self, operand: Operand) -> Term<'_> {
        Term {
            writer: self,
            operand,
        }
    }

    /// Whether a scalar stands where directions side by side are worked out.
    fn is_whole(&self, source: Source) -> bool {
        let Some((first, solved)) = &self.sweep else {
            return false;
        };
        match source {
            Source::Value(value) => value < *first,
            Source::Solved(place) => !solved.contains(&place.number),
            Source::Symbol(Symbol::Slope(_)) => false,
            Source::Constant(_) | Source::Symbol(_) | Source::Folded(_) => true,
        }
    }

    /// Adds an operand.
    fn read(&self, operand: Operand, tokens: &mut Tokens) {
        let Operand { source, negative } = operand;
        let within = |delimiter, write: &dyn Fn(&mut Tokens), tokens: &mut Tokens| {
            let mut inner = Tokens::default();
            write(&mut inner);
            tokens.group(delimiter, inner);
        };
        let signed = |tokens: &mut Tokens| {
            if !negative {
                return self.scalar(source, tokens);
            }
            let opposite = |inner: &mut Tokens| {
                inner.sign('-');
                self.scalar(source, inner);
            };
            within(Delimiter::Parenthesis, &opposite, tokens);
        };
        if self.is_whole(source) {
            tokens.name(&self.words.whole);
            within(Delimiter::Parenthesis, &signed, tokens);
        } else {
            signed(tokens);
        }
    }

    /// Adds a scalar without its sign.
    fn scalar(&self, source: Source, tokens: &mut Tokens) {
        let words = &*self.words;
        let of_model = |tokens: &mut Tokens| {
            if self.setting == Setting::Method {
                tokens.name(&words.model);
                tokens.sign('.');
            }
        };
        match source {
            Source::Value(index) => match self.sweep.as_ref().and_then(|_| self.kept.get(&index)) {
                Some(place) => element(tokens, &words.kept, *place),
                None => match self.left.home(index) {
                    Some(home) if !self.named.contains(&index) => self.left.read(home, tokens),
                    _ => tokens.name(&self.names[index]),
                },
            },
            Source::Constant(value) => {
                tokens.name(&words.scalar);
                tokens.colons();
                tokens.name(&words.from_f64);
                let mut number = Tokens::default();
                number.extend(super::tokens::number(value));
                tokens.group(Delimiter::Parenthesis, number);
            }
            Source::Symbol(Symbol::Parameter(index)) => {
                of_model(tokens);
                let parameter = &self.compiled.model.parameters[index];
                tokens.extend(parameters::read(parameter));
            }
            Source::Symbol(Symbol::State(index)) => element(tokens, &words.state, index),
            Source::Symbol(Symbol::Input(index)) => element(tokens, &words.input, index),
            Source::Symbol(Symbol::Slope(index)) => element(tokens, &words.slopes, index),
            Source::Solved(place) => element(tokens, &unknowns(place.number), place.row),
            Source::Symbol(Symbol::Time | Symbol::Signal(_) | Symbol::Unknown(_)) => {
                tokens.name(&words.time);
            }
            Source::Folded(index) => {
                of_model(tokens);
                element(tokens, &words.folded, index);
            }
        }
    }
}

/// An operand as it is read, inside of what is written as a whole.
pub(super) struct Term<'a> {
    writer: &'a Writer<'a>,
    operand: Operand,
}

impl ToTokens for Term<'_> {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        let mut read = Tokens::default();
        self.writer.read(self.operand, &mut read);
        tokens.extend(read.stream());
    }
}

/// What holds the unknowns of an iteration.
fn unknowns(number: usize) -> Ident {
    numbered("z", number)
}

/// What holds the factors of the matrix that gives the unknowns.
fn factors(number: usize) -> Ident {
    numbered("s", number)
}

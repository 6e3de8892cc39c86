//! Repeats as loops.
//!
//! A turn is written once. What it reads and is not the same in all turns is bound first; what the next turn reads of it is
//! bound outside and handed on at its end; what is read behind the loop goes into arrays, one for each value of a turn.
//! Sines and cosines of angles in a row are worked out several at once.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};

use super::routine::{Place, Writer};
use super::tokens::{Tokens, block, element, numbered};
use crate::program::{Operand, Reading, Repeat, Routine, Source, Step};
use crate::symbolic::Symbol;

/// What loops leave behind.
#[derive(Default)]
pub(super) struct Left {
    repeats: Vec<Repeat>,
    /// Values of first turns: of these, and of those in their place in other turns, there is an array.
    arrays: BTreeSet<usize>,
    /// The same of what is read of the last turn behind the loop.
    lasts: BTreeSet<usize>,
    /// Results that are written in the loop, by the value of its first turn.
    results: BTreeMap<usize, Rows>,
}

/// Where a value of a repeat is made.
#[derive(Clone, Copy)]
pub(super) struct Home {
    repeat: usize,
    turn: usize,
    /// The value in its place in the first turn.
    first: usize,
}

/// Rows of the derivative, one for each turn.
struct Rows {
    first: usize,
    stride: isize,
    negative: bool,
}

impl Left {
    /// Of a routine whose results go to these places, or are read behind it.
    pub(super) fn of(routine: &Routine, places: &[Option<Place>]) -> Self {
        let repeats = routine.repeats.clone();
        let mut left = Self {
            repeats,
            ..Self::default()
        };
        if left.repeats.is_empty() {
            return left;
        }
        left.results = left.rows(&routine.results, places);
        let mut value = 0;
        for step in &routine.steps {
            let reader = left.home(value);
            for operand in &*step.operands() {
                left.keep(*operand, reader);
            }
            value += step.results();
        }
        for result in &routine.results {
            if !left.writes(*result) {
                left.keep(*result, None);
            }
        }
        left.lasts.retain(|first| !left.arrays.contains(first));
        left
    }

    /// Where a value is made, if in a repeat.
    pub(super) fn home(&self, value: usize) -> Option<Home> {
        let behind = self.repeats.partition_point(|it| it.first <= value);
        let repeat = behind.checked_sub(1)?;
        let (turn, place) = self.repeats[repeat].place(value)?;
        Some(Home {
            repeat,
            turn,
            first: self.repeats[repeat].first + place,
        })
    }

    /// Where an operand is made, if in a repeat.
    pub(super) fn home_of(&self, operand: Operand) -> Option<Home> {
        match operand.source {
            Source::Value(value) => self.home(value),
            _ => None,
        }
    }

    /// Whether a loop writes this result.
    pub(super) fn writes(&self, result: Operand) -> bool {
        let home = self.home_of(result);
        home.is_some_and(|home| self.results.contains_key(&home.first))
    }

    /// Keeps what is read elsewhere than in its turn and the next.
    fn keep(&mut self, operand: Operand, reader: Option<Home>) {
        let Some(home) = self.home_of(operand) else {
            return;
        };
        let is_handed_on = reader.is_some_and(|reader| {
            reader.repeat == home.repeat && (0..=1).contains(&(reader.turn - home.turn))
        });
        let is_last = home.turn + 1 == self.repeats[home.repeat].turns;
        match (is_handed_on, is_last) {
            (true, _) => false,
            (false, true) => self.lasts.insert(home.first),
            (false, false) => self.arrays.insert(home.first),
        };
    }

    /// How a value is read behind the loop that makes it.
    pub(super) fn read(&self, home: Home, tokens: &mut Tokens) {
        if self.arrays.contains(&home.first) {
            element(tokens, &array(home.first), home.turn);
        } else {
            tokens.name(&handed_on(home.first));
        }
    }

    /// Results that go on from row to row, and are nothing else.
    fn rows(&self, results: &[Operand], places: &[Option<Place>]) -> BTreeMap<usize, Rows> {
        let mut of_value: BTreeMap<usize, Vec<(usize, Option<usize>, bool)>> = BTreeMap::new();
        for (result, place) in results.iter().zip(places) {
            let row = match place {
                Some(Place::Derivative(row)) => Some(*row),
                _ => None,
            };
            if let Some(home) = self.home_of(*result) {
                let rows = of_value.entry(home.first).or_default();
                rows.push((home.turn, row, result.negative));
            }
        }
        let in_a_row = of_value.into_iter().filter_map(|(value, mut rows)| {
            rows.sort_unstable();
            let [(_, Some(first), negative), (_, Some(second), _), ..] = rows[..] else {
                return None;
            };
            let stride = second as isize - first as isize;
            let turns = self.repeats[self.home(value)?.repeat].turns;
            let row = |turn: usize| first.checked_add_signed(turn as isize * stride);
            let expected = (0..turns).map(|turn| (turn, row(turn), negative));
            let rows_of_turns = Rows {
                first,
                stride,
                negative,
            };
            rows.iter()
                .copied()
                .eq(expected)
                .then_some((value, rows_of_turns))
        });
        in_a_row.collect()
    }

    /// Those of the repeat's first turn in a list of values.
    fn of_first_turn(repeat: &Repeat, values: &BTreeSet<usize>) -> impl Iterator<Item = usize> {
        let turn = repeat.first..repeat.first + repeat.values;
        values.range(turn).copied()
    }
}

/// The array of a value of first turns, and of those in its place in the other turns.
fn array(first: usize) -> Ident {
    numbered("a", first)
}

/// What the turn before has made in the place of a value of first turns.
fn handed_on(first: usize) -> Ident {
    numbered("b", first)
}

/// A loop in the making. Turns that are written together count as one.
struct Turn<'a> {
    repeat: &'a Repeat,
    counter: Ident,
    /// Names of values, and behind them of what is bound for the turn.
    names: Vec<Ident>,
    bound: BTreeMap<String, usize>,
    bindings: TokenStream,
    /// What is handed on, by its place in a turn: the name outside, and what the first turn reads.
    handed_on: BTreeMap<usize, (usize, Source)>,
}

impl Turn<'_> {
    /// `first + stride · turn`, where the turn is that of the loop and so many more.
    fn index(&self, first: usize, stride: isize, more: usize) -> TokenStream {
        let first = first.saturating_add_signed(stride * more as isize);
        let step = stride * self.repeat.together as isize;
        let counter = &self.counter;
        let number = Literal::usize_suffixed;
        let behind = match step.unsigned_abs() {
            1 => quote!(#counter),
            factor => {
                let factor = number(factor);
                quote!(#factor * #counter)
            }
        };
        let begin = number(first);
        match (step < 0, first) {
            (true, _) => quote!(#begin - #behind),
            (false, 0) => behind,
            (false, _) => quote!(#behind + #begin),
        }
    }

    /// The number of a name for what is bound in each turn.
    fn bind(&mut self, value: TokenStream) -> usize {
        let text = value.to_string();
        if let Some(number) = self.bound.get(&text) {
            return *number;
        }
        let number = self.names.len();
        let name = numbered("r", number);
        self.bindings.extend(quote!(let #name = #value;));
        self.names.push(name);
        self.bound.insert(text, number);
        number
    }

    /// The number of the name for a value of the turn before.
    fn before(&mut self, place: usize, begin: Source) -> usize {
        if let Some((number, _)) = self.handed_on.get(&place) {
            return *number;
        }
        let number = self.names.len();
        self.names.push(handed_on(self.repeat.first + place));
        self.handed_on.insert(place, (number, begin));
        number
    }
}

impl Writer<'_> {
    /// A repeat, of which these are the steps of all turns, as a loop.
    pub(super) fn repeat(&self, repeat: &Repeat, steps: &[Step]) -> TokenStream {
        let width = repeat.width();
        let mut turn = Turn {
            repeat,
            counter: numbered("n", repeat.first),
            names: self.names.to_vec(),
            bound: BTreeMap::new(),
            bindings: TokenStream::new(),
            handed_on: BTreeMap::new(),
        };
        let steps: Vec<Step> = (0..repeat.together)
            .flat_map(|more| {
                let steps = &steps[more * width..(more + 1) * width];
                self.turned(steps, more, &mut turn)
            })
            .collect();
        for last in Left::of_first_turn(repeat, &self.left.lasts) {
            turn.before(last - repeat.first, Source::Constant(0.0));
        }
        let values = repeat.first..repeat.first + repeat.together * repeat.values;
        let written = self.written_in(&turn, values.clone());
        let inside = self.in_turn(std::mem::take(&mut turn.names), values, written);
        let mut lines = Tokens::default();
        lines.extend(std::mem::take(&mut turn.bindings));
        inside.straight(&steps, repeat.first, &mut lines, &mut Vec::new());
        let mut outside = TokenStream::new();
        for first in Left::of_first_turn(repeat, &self.left.arrays) {
            let (array, turns) = (array(first), Literal::usize_suffixed(repeat.turns));
            outside.extend(quote!(let mut #array = [T::from_f64(0.0); #turns];));
        }
        for (place, (number, begin)) in &turn.handed_on {
            let last = (repeat.together - 1) * repeat.values;
            let (name, value) = (
                &inside.names[*number],
                &inside.names[repeat.first + last + place],
            );
            let begin = self.operand(Operand::plain(*begin));
            outside.extend(quote!(let mut #name = #begin;));
            lines.extend(quote!(#name = #value;));
        }
        let turns = Literal::usize_suffixed(repeat.turns / repeat.together);
        let (counter, body) = (&turn.counter, block(lines.stream()));
        quote!(#outside for #counter in 0usize..#turns #body)
    }

    /// The steps of a turn with what they read bound to names.
    fn turned(&self, steps: &[Step], more: usize, turn: &mut Turn) -> Vec<Step> {
        let own = turn.repeat.first + more * turn.repeat.values;
        let mut readings = turn.repeat.readings.iter();
        let state = RefCell::new((turn, &mut readings));
        let turned = |operand: Operand| {
            let (turn, readings) = &mut *state.borrow_mut();
            let value = match readings.next() {
                Some(Reading::Own(place)) => own + place,
                Some(Reading::Before(place)) if more > 0 => own - turn.repeat.values + place,
                Some(Reading::Before(place)) => turn.before(*place, operand.source),
                Some(Reading::Numbers(numbers)) => {
                    let numbers = numbers.iter().map(|it| super::tokens::number(*it));
                    let place = turn.index(0, 1, more);
                    turn.bind(quote!(T::from_f64(const { &[#(#numbers),*] }[#place])))
                }
                Some(Reading::Along(stride)) => {
                    // What the steps read is that of their own turn.
                    let element = self.along(operand.source, *stride, turn);
                    turn.bind(element)
                }
                Some(Reading::Same) | None => return operand,
            };
            Operand {
                source: Source::Value(value),
                ..operand
            }
        };
        steps.iter().map(|step| step.with(&turned)).collect()
    }

    /// What goes on by so many places from turn to turn.
    fn along(&self, source: Source, stride: isize, turn: &Turn) -> TokenStream {
        let (array, first, stride) = match source {
            Source::Symbol(Symbol::State(first)) => (quote!(x), first, stride),
            Source::Symbol(Symbol::Input(first)) => (quote!(u), first, stride),
            Source::Folded(first) => (quote!(self.folded), first, stride),
            source => {
                let home = self.left.home_of(Operand::plain(source));
                let Some(home) = home else {
                    return self.operand(Operand::plain(source)).into_token_stream();
                };
                let name = array(home.first);
                let values = self.left.repeats[home.repeat].values as isize;
                (quote!(#name), home.turn, stride / values)
            }
        };
        let place = turn.index(first, stride, 0);
        quote!(#array[#place])
    }

    /// What is written as soon as a value is there.
    fn written_in(&self, turn: &Turn, values: Range<usize>) -> BTreeMap<usize, TokenStream> {
        let repeat = turn.repeat;
        let mut written: BTreeMap<usize, TokenStream> = BTreeMap::new();
        for value in values {
            let behind = value - repeat.first;
            let (more, first) = (
                behind / repeat.values,
                repeat.first + behind % repeat.values,
            );
            let name = &turn.names[value];
            let lines = written.entry(value).or_default();
            if self.left.arrays.contains(&first) {
                let (array, place) = (array(first), turn.index(0, 1, more));
                lines.extend(quote!(#array[#place] = #name;));
            }
            if let Some(rows) = self.left.results.get(&first) {
                let place = turn.index(rows.first, rows.stride, more);
                let sign = rows.negative.then(|| quote!(-));
                lines.extend(quote!(derivative[#place] = #sign #name;));
            }
        }
        written
    }
}

//! Places in the files, of errors that came at the statement which includes them.
//!
//! A stable compiler gives a macro no spans but those of its own call. They serve as marks: the tokens of the files are
//! parted into as many runs as there are marks, everything is done again, and the mark at which the same error comes
//! back says in which run it lies. That run is parted next, until it is a single token.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};

use super::{Inclusion, placed};
use crate::diagnostics::Diagnostics;

/// More marks than this would make the list of their pairs long.
const MOST_MARKS: usize = 64;

impl Inclusion {
    /// Adds the place in its file to each error in one, from the error number `first` on. `again` reports, from the same
    /// tokens with other spans, the same errors.
    pub fn locate(
        &self,
        first: usize,
        diagnostics: &mut Diagnostics,
        again: &dyn Fn(TokenStream) -> Diagnostics,
    ) {
        let inside: BTreeSet<String> = self.files.iter().flat_map(|it| ends(it.from)).collect();
        let reports = first..diagnostics.list().len();
        let open: Vec<usize> = reports
            .filter(|report| inside.contains(&text(diagnostics.list()[*report].span)))
            .collect();
        if open.is_empty() {
            return;
        }
        let marks = Marks::among(&self.call);
        if marks.spans.len() < 2 {
            return;
        }
        let calls: Vec<usize> = open.iter().map(|it| diagnostics.call(*it)).collect();
        let mut search = Search {
            inclusion: self,
            marks,
            again,
            found: BTreeMap::new(),
        };
        search.part(0, self.count(), &calls);
        for (report, call) in open.iter().zip(&calls) {
            let Some(token) = search.found.get(call) else {
                continue;
            };
            let (file, token) = self.token(*token);
            let file = &self.files[file];
            let place = file.places[token].clone();
            let report = diagnostics.get_mut(*report);
            *report = placed(report.clone(), &file.path, &file.text, place);
        }
    }

    /// How many tokens all files have.
    fn count(&self) -> usize {
        self.files.iter().map(|file| file.places.len()).sum()
    }

    /// The file of a token by its number among those of all files, and its number there.
    fn token(&self, mut number: usize) -> (usize, usize) {
        for (place, file) in self.files.iter().enumerate() {
            if number < file.places.len() {
                return (place, number);
            }
            number -= file.places.len();
        }
        (0, 0)
    }
}

struct Search<'a> {
    inclusion: &'a Inclusion,
    marks: Marks,
    again: &'a dyn Fn(TokenStream) -> Diagnostics,
    /// The token of each call that reported.
    found: BTreeMap<usize, usize>,
}

impl Search<'_> {
    /// Finds the tokens of calls, given that they are among `count` tokens from `start` on.
    fn part(&mut self, start: usize, count: usize, calls: &[usize]) {
        if count <= 1 {
            self.found.extend(calls.iter().map(|call| (*call, start)));
            return;
        }
        let most = self.marks.spans.len();
        let length = count.div_ceil(most);
        let files = &self.inclusion.files;
        let before: Vec<usize> = (0..files.len())
            .map(|file| files[..file].iter().map(|it| it.places.len()).sum())
            .collect();
        // The marks ascend, so that an error over several tokens is known by the first of them.
        let tokens = self.inclusion.spanned(&|file, token| {
            let part = (before[file] + token).saturating_sub(start) / length;
            self.marks.spans[part.min(most - 1)]
        });
        let reported = (self.again)(tokens);
        let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for call in calls {
            let mark = reported.place_of_call(*call).map(text);
            if let Some(part) = mark.and_then(|mark| self.marks.numbers.get(&mark)) {
                parts.entry(*part).or_default().push(*call);
            }
        }
        for (part, calls) in parts {
            let skipped = part * length;
            self.part(
                start + skipped,
                length.min(count - skipped.min(count)),
                &calls,
            );
        }
    }
}

/// Spans that differ from each other.
struct Marks {
    /// In order of appearance.
    spans: Vec<Span>,
    /// The number of the mark at which a span begins, by the span's text.
    numbers: BTreeMap<String, usize>,
}

impl Marks {
    fn among(tokens: &TokenStream) -> Self {
        let mut spans: Vec<Span> = Vec::new();
        let mut known = BTreeSet::new();
        collect(tokens.clone(), &mut |span| {
            if spans.len() < MOST_MARKS && known.insert(text(span)) {
                spans.push(span);
            }
        });
        let mut numbers = BTreeMap::new();
        for (number, span) in spans.iter().enumerate() {
            // Where spans can be joined, an error over several tokens has the span from the first to the last.
            let joined = spans[number..].iter().filter_map(|last| span.join(*last));
            for span in ends(*span).into_iter().chain(joined.map(text)) {
                numbers.entry(span).or_insert(number);
            }
        }
        Self { spans, numbers }
    }
}

/// Calls `found` with the span of every token that is no group.
fn collect(tokens: TokenStream, found: &mut impl FnMut(Span)) {
    let mut open = vec![tokens.into_iter()];
    while let Some(tokens) = open.last_mut() {
        match tokens.next() {
            Some(TokenTree::Group(group)) => open.push(group.stream().into_iter()),
            Some(token) => found(token.span()),
            None => drop(open.pop()),
        }
    }
}

/// A span, and those of the brackets of a group that has it, which some compilers tell from the whole.
fn ends(span: Span) -> [String; 3] {
    let mut group = Group::new(Delimiter::Brace, TokenStream::new());
    group.set_span(span);
    [span, group.span_open(), group.span_close()].map(text)
}

/// The only thing by which a macro can tell spans apart on a stable compiler.
fn text(span: Span) -> String {
    format!("{span:?}")
}

//! A place in a list of token trees, and the errors that are told from there.

use proc_macro2::{Delimiter, Group, Ident, Spacing, Span, TokenStream, TokenTree};
use syn::LitInt;

use super::ast::JunctionKind;
use super::{LARGEST_DIMENSION, raw, words};
use crate::codes;
use crate::diagnostics::{Code, Diagnostic, error};

/// What a rule returns: its tree, or the one mistake that stopped it.
///
/// The mistake is boxed because it is far larger than most trees and rare.
pub(super) type Parsed<T> = Result<T, Box<Diagnostic>>;

/// Operators of several characters, longest first, so that an error shows what was typed.
const OPERATORS: &[&str] = &[
    "..=", "...", "<<=", ">>=", "->", "=>", "<-", "::", "..", "==", "!=", "<=", ">=", "&&", "||",
    "+=", "-=", "*=", "/=", "^=", "<<", ">>",
];

/// A place in the tokens of one group.
pub(super) struct Cursor {
    tokens: Vec<TokenTree>,
    at: usize,
    /// Where an error points when the group is empty.
    close: Span,
    /// What the end is called in errors.
    end: &'static str,
}

impl Cursor {
    /// The tokens of the whole macro call, where no value stands that an invisible group would keep together.
    pub(super) fn new(stream: TokenStream) -> Self {
        Self {
            tokens: opened(stream),
            at: 0,
            close: Span::call_site(),
            end: "the end of the macro call",
        }
    }

    /// The tokens between delimiters.
    pub(super) fn inside(group: &Group) -> Self {
        let end = match group.delimiter() {
            Delimiter::Brace => "the end of the braces",
            Delimiter::Parenthesis => "the end of the parentheses",
            Delimiter::Bracket => "the end of the brackets",
            Delimiter::None => "the end of the group",
        };
        Self {
            tokens: dissolved(group.stream()),
            at: 0,
            close: group.span_close(),
            end,
        }
    }

    /// Replaces an invisible group that stands here by its tokens.
    pub(super) fn open(&mut self) {
        if let Some(group) = self.group(0, Delimiter::None) {
            let inside = opened(group.stream());
            self.tokens.splice(self.at..=self.at, inside);
        }
    }

    /// How many tokens lie behind.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// Whether no token is left.
    pub(super) fn ended(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// The tokens from `start` up to here.
    pub(super) fn since(&self, start: usize) -> &[TokenTree] {
        &self.tokens[start.min(self.at)..self.at]
    }

    /// The token `offset` places ahead.
    pub(super) fn peek(&self, offset: usize) -> Option<&TokenTree> {
        self.tokens.get(self.at + offset)
    }

    /// Steps over `count` tokens.
    pub(super) fn advance(&mut self, count: usize) {
        self.at = (self.at + count).min(self.tokens.len());
    }

    /// Steps back to a place, where an error belongs.
    pub(super) fn step_back(&mut self, place: usize) {
        self.at = place.min(self.at);
    }

    /// The identifier `offset` places ahead.
    pub(super) fn ident(&self, offset: usize) -> Option<&Ident> {
        match self.peek(offset) {
            Some(TokenTree::Ident(ident)) => Some(ident),
            _ => None,
        }
    }

    /// The group with this delimiter `offset` places ahead.
    pub(super) fn group(&self, offset: usize, delimiter: Delimiter) -> Option<&Group> {
        match self.peek(offset) {
            Some(TokenTree::Group(group)) if group.delimiter() == delimiter => Some(group),
            _ => None,
        }
    }

    /// Whether this punctuation character stands `offset` places ahead.
    pub(super) fn punct(&self, offset: usize, character: char) -> bool {
        matches!(self.peek(offset), Some(TokenTree::Punct(punct)) if punct.as_char() == character)
    }

    /// Whether `->` stands `offset` places ahead.
    pub(super) fn arrow(&self, offset: usize) -> bool {
        self.operator(offset).as_deref() == Some("->")
    }

    /// Whether the `0` or `1` of a junction stands `offset` places ahead.
    pub(super) fn junction_digit(&self, offset: usize) -> bool {
        matches!(self.peek(offset), Some(TokenTree::Literal(literal)) if matches!(literal.to_string().as_str(), "0" | "1"))
    }

    /// Steps over the `0` or `1` of a junction if it stands here.
    pub(super) fn take_junction_kind(&mut self) -> Option<JunctionKind> {
        let kind = match self.found().as_str() {
            "`0`" => JunctionKind::Zero,
            "`1`" => JunctionKind::One,
            _ => return None,
        };
        self.at += 1;
        Some(kind)
    }

    /// Steps over this character if it stands here.
    pub(super) fn take_punct(&mut self, character: char) -> bool {
        let found = self.punct(0, character);
        if found {
            self.at += 1;
        }
        found
    }

    /// Steps over `->` if it stands here.
    pub(super) fn take_arrow(&mut self) -> Option<Span> {
        if !self.arrow(0) {
            return None;
        }
        let (start, end) = (self.tokens[self.at].span(), self.tokens[self.at + 1].span());
        self.at += 2;
        Some(start.join(end).unwrap_or(start))
    }

    /// Steps over the group with this delimiter if it stands here.
    pub(super) fn take_group(&mut self, delimiter: Delimiter) -> Option<Group> {
        let group = self.group(0, delimiter)?.clone();
        self.at += 1;
        Some(group)
    }

    /// Reads a name; `what` says whose.
    pub(super) fn name(&mut self, what: &str) -> Parsed<Ident> {
        match self.ident(0) {
            Some(ident) => {
                let text = ident.to_string();
                if words::is_reserved(&text) {
                    let message = format!("expected {what}, found the keyword `{text}`");
                    let report = *self.failure(codes::SYNTAX, message);
                    return Err(Box::new(match text.as_str() {
                        "_" => report,
                        "mut" if self.ident(1).is_some() => {
                            report.help("a value does not change: leave out `mut`")
                        }
                        _ => report.help(words::another_name(&text)),
                    }));
                }
                let name = ident.clone();
                self.at += 1;
                Ok(name)
            }
            None => Err(self.expected(what)),
        }
    }

    /// Reads `[n]`, when it stands here.
    pub(super) fn dimension(&mut self) -> Parsed<Option<usize>> {
        let Some(group) = self.take_group(Delimiter::Bracket) else {
            return Ok(None);
        };
        let mut inner = Self::inside(&group);
        let computed = |report: Box<Diagnostic>| {
            let help = "a dimension is a number as it stands, such as `[3]`; `for k in 0..n { … }` repeats a computed \
                        number of times";
            Box::new(report.help(help))
        };
        let what = "a dimension, which is an integer from 1 up";
        let is_name = inner.ident(0).is_some();
        let dimension = inner.integer(what, codes::DIMENSION_LITERAL);
        let dimension =
            dimension.map_err(|report| if is_name { computed(report) } else { report })?;
        if dimension == 0 {
            inner.at -= 1;
            return Err(inner.expected_with(codes::DIMENSION_LITERAL, what));
        }
        if !inner.ended() {
            let wanted = "`]` after the dimension";
            return Err(computed(
                inner.expected_with(codes::DIMENSION_LITERAL, wanted),
            ));
        }
        Ok(Some(dimension))
    }

    /// Reads a plain integer up to [`LARGEST_DIMENSION`].
    pub(super) fn integer(&mut self, what: &str, code: Code) -> Parsed<usize> {
        let number = match self.peek(0) {
            Some(TokenTree::Literal(literal)) => {
                syn::parse_str::<LitInt>(&literal.to_string()).ok()
            }
            _ => None,
        };
        let Some(number) = number.filter(|number| number.suffix().is_empty()) else {
            return Err(self.expected_with(code, what));
        };
        match number.base10_parse::<usize>() {
            Ok(value) if value <= LARGEST_DIMENSION => {
                self.at += 1;
                Ok(value)
            }
            _ => {
                let message = format!(
                    "`{}` is over the limit of {LARGEST_DIMENSION} for dimensions",
                    shortened(&number.to_string())
                );
                Err(self.failure(code, message))
            }
        }
    }

    /// The place to which an error belongs: the token here, or the last real one when nothing is left, because the
    /// end of the input would mark the whole macro call.
    pub(super) fn span(&self) -> Span {
        match self.peek(0) {
            Some(TokenTree::Group(group)) => group.span_open(),
            Some(token) => token.span(),
            None => self.last_span(),
        }
    }

    /// The place of the token just read.
    pub(super) fn last_span(&self) -> Span {
        match self
            .at
            .checked_sub(1)
            .and_then(|last| self.tokens.get(last))
        {
            Some(TokenTree::Group(group)) => group.span_close(),
            Some(token) => token.span(),
            None => self.close,
        }
    }

    /// The token here as errors show it.
    pub(super) fn found(&self) -> String {
        match self.peek(0) {
            None => self.end.to_owned(),
            Some(TokenTree::Ident(ident)) => format!("`{ident}`"),
            Some(TokenTree::Literal(literal)) => format!("`{}`", shortened(&literal.to_string())),
            Some(TokenTree::Group(group)) => match group.delimiter() {
                Delimiter::Brace => "`{`".to_owned(),
                Delimiter::Parenthesis => "`(`".to_owned(),
                Delimiter::Bracket => "`[`".to_owned(),
                Delimiter::None => "a group of tokens".to_owned(),
            },
            Some(TokenTree::Punct(punct)) => {
                let documentation = self.punct(0, '#')
                    && self.group(1, Delimiter::Bracket).is_some_and(
                        |group| matches!(group.stream().into_iter().next(), Some(TokenTree::Ident(word)) if word == "doc"),
                    );
                if documentation {
                    return "a documentation comment".to_owned();
                }
                format!(
                    "`{}`",
                    self.operator(0)
                        .unwrap_or_else(|| punct.as_char().to_string())
                )
            }
        }
    }

    /// The token just read.
    pub(super) fn last(&self) -> Option<&TokenTree> {
        self.tokens.get(self.at.checked_sub(1)?)
    }

    /// The token just read as errors show it.
    pub(super) fn previous(&self) -> String {
        match self
            .at
            .checked_sub(1)
            .and_then(|last| self.tokens.get(last))
        {
            Some(TokenTree::Group(group)) => match group.delimiter() {
                Delimiter::Brace => "`}`".to_owned(),
                Delimiter::Parenthesis => "`)`".to_owned(),
                Delimiter::Bracket => "`]`".to_owned(),
                Delimiter::None => "the group".to_owned(),
            },
            Some(token) => format!("`{}`", shortened(&token.to_string())),
            None => "the start".to_owned(),
        }
    }

    /// An error here.
    pub(super) fn failure(&self, code: Code, message: impl Into<String>) -> Box<Diagnostic> {
        Box::new(error(code, self.span(), message))
    }

    /// `expected …, found …`, at the token found.
    pub(super) fn expected(&self, what: &str) -> Box<Diagnostic> {
        self.expected_with(codes::SYNTAX, what)
    }

    /// As [`Cursor::expected`], with a code of its own.
    pub(super) fn expected_with(&self, code: Code, what: &str) -> Box<Diagnostic> {
        self.failure(code, format!("expected {what}, found {}", self.found()))
    }

    /// How many tokens lie ahead before one for which `stop` holds, given its offset.
    pub(super) fn length_until(&self, stop: impl Fn(&Self, usize) -> bool) -> usize {
        let left = self.tokens.len() - self.at;
        (0..left).find(|&offset| stop(self, offset)).unwrap_or(left)
    }

    /// The next `length` tokens.
    pub(super) fn ahead(&self, length: usize) -> &[TokenTree] {
        &self.tokens[self.at..(self.at + length).min(self.tokens.len())]
    }

    /// How a junction of this name is declared among these tokens, as far as its dimension, if it is.
    pub(super) fn declaration(&self, name: &Ident) -> Option<String> {
        let mut places = self.tokens.windows(2).enumerate();
        let (at, digit) = places.find_map(|(at, pair)| match pair {
            [TokenTree::Literal(digit), TokenTree::Ident(found)] if found == name => {
                let digit = digit.to_string();
                matches!(digit.as_str(), "0" | "1").then_some((at, digit))
            }
            _ => None,
        })?;
        let size = match self.tokens.get(at + 2) {
            Some(TokenTree::Group(size)) if size.delimiter() == Delimiter::Bracket => {
                size.to_string()
            }
            _ => String::new(),
        };
        Some(format!("{digit} {name}{size}"))
    }

    /// The operator `offset` places ahead, joined from its characters.
    fn operator(&self, offset: usize) -> Option<String> {
        let mut text = String::new();
        for token in self.tokens[self.tokens.len().min(self.at + offset)..]
            .iter()
            .take(3)
        {
            let TokenTree::Punct(punct) = token else {
                break;
            };
            text.push(punct.as_char());
            if punct.spacing() == Spacing::Alone {
                break;
            }
        }
        let operator = OPERATORS
            .iter()
            .find(|operator| text.starts_with(**operator));
        operator.map_or_else(
            || text.chars().next().map(String::from),
            |operator| Some((*operator).to_owned()),
        )
    }
}

/// At most forty characters of what was written.
fn shortened(text: &str) -> String {
    if text.chars().count() <= 40 {
        text.to_owned()
    } else {
        text.chars().take(39).chain(['…']).collect()
    }
}

/// The tokens, without the invisible groups around single tokens that `macro_rules!` leaves.
pub(crate) fn dissolved(stream: TokenStream) -> Vec<TokenTree> {
    let mut tokens = Vec::new();
    for mut token in stream {
        while let TokenTree::Group(group) = &token {
            if group.delimiter() != Delimiter::None {
                break;
            }
            let mut inner = group.stream().into_iter();
            match (inner.next(), inner.next()) {
                (Some(only), None) => token = only,
                _ => break,
            }
        }
        let empty = matches!(&token, TokenTree::Group(group) if group.delimiter() == Delimiter::None && group.stream().is_empty());
        if !empty {
            tokens.push(raw::plain(token));
        }
    }
    tokens
}

/// The tokens, without any of the invisible groups that `macro_rules!` leaves.
fn opened(stream: TokenStream) -> Vec<TokenTree> {
    let mut tokens = Vec::new();
    for token in stream {
        match token {
            TokenTree::Group(group) if group.delimiter() == Delimiter::None => {
                tokens.extend(opened(group.stream()));
            }
            token => tokens.push(raw::plain(token)),
        }
    }
    tokens
}

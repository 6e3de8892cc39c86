//! Stage 0, inclusion: the files that a macro call includes.
//!
//! - Input: the tokens between the braces of `mbg! { … }`, and a way to read files.
//! - Output: an [`Inclusion`], whose tokens hold those of the files in place of `include "joints/mine.mbg";`. Such
//!   statements stand first, in the call and in the files. A file is taken once, however often it is included.
//! - Errors: `MBG0105`, a file that cannot be read, is no list of tokens, or includes itself.
//!
//! Errors of later stages come at the statement that includes the file; [`locate`](Inclusion::locate) finds their place in
//! it.

mod locate;
pub(crate) mod text;

use std::io;
use std::ops::Range;
use std::path::Path;

use proc_macro2::{Span, TokenStream, TokenTree};
use quote::quote;

use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::syntax::cursor::dissolved;

/// What reads a file, given its path as it is written.
pub type Read<'a> = dyn Fn(&str) -> io::Result<String> + 'a;

/// Reads a file of the crate that is being built, by its path from the crate's root.
///
/// # Errors
///
/// Those of the file system, and a build without cargo, which says where the root is.
pub fn crate_file(path: &str) -> io::Result<String> {
    let Some(root) = std::env::var_os("CARGO_MANIFEST_DIR") else {
        return Err(io::Error::other("`CARGO_MANIFEST_DIR` is not set"));
    };
    std::fs::read_to_string(Path::new(&root).join(path))
}

/// Reads nothing: for callers whose texts include nothing.
///
/// # Errors
///
/// Always.
pub fn no_file(_: &str) -> io::Result<String> {
    Err(io::Error::other("no files can be included here"))
}

/// A file that was read.
struct File {
    path: String,
    text: String,
    /// The bytes of each token.
    places: Vec<Range<usize>>,
    /// How many tokens its own `include` statements take.
    statements: usize,
    /// The statement in the macro call that led to it.
    from: Span,
}

/// The tokens of a macro call, with those of the files that it includes.
pub struct Inclusion {
    /// In order of inclusion; what a file includes comes before it.
    files: Vec<File>,
    /// The tokens of the call behind its statements.
    rest: TokenStream,
    /// The tokens of the call.
    call: TokenStream,
}

/// `include "path";`
struct Statement {
    path: String,
    span: Span,
}

/// Tokens per statement.
const LENGTH: usize = 3;

impl Inclusion {
    /// Reads the files.
    #[must_use]
    pub fn of(tokens: TokenStream, read: &Read<'_>, diagnostics: &mut Diagnostics) -> Self {
        let (statements, rest) = split(tokens.clone());
        let mut inclusion = Self {
            files: Vec::new(),
            rest,
            call: tokens,
        };
        for statement in statements {
            let (path, span) = (statement.path, statement.span);
            if let Err(report) = inclusion.include(&path, span, &mut Vec::new(), read) {
                diagnostics.report(*report);
            }
        }
        inclusion
    }

    /// Takes a file and what it includes, inside the files that are `open`.
    fn include(
        &mut self,
        path: &str,
        from: Span,
        open: &mut Vec<String>,
        read: &Read<'_>,
    ) -> Result<(), Box<Diagnostic>> {
        let fail = |message: String| Err(Box::new(error(codes::INCLUDE, from, message)));
        if path.starts_with('/') || Path::new(path).is_absolute() {
            return fail(format!("`{path}` is no path from the root of the crate"));
        }
        let path = plain(path);
        if path.is_empty() {
            return fail("expected the path of a file between the quotes".to_owned());
        }
        if let Some(start) = open.iter().position(|other| *other == path) {
            open.push(path.clone());
            let cycle: Vec<String> = open[start..].iter().map(|it| format!("`{it}`")).collect();
            let message = format!("`{path}` includes itself");
            let note = format!("each includes the next: {}", cycle.join(", "));
            return Err(Box::new(error(codes::INCLUDE, from, message).note(note)));
        }
        if self.files.iter().any(|file| file.path == path) {
            return Ok(());
        }
        let text = match read(&path) {
            Ok(text) => text,
            Err(reason) => return fail(format!("`{path}` cannot be read: {reason}")),
        };
        let cut = text::tokens(&text, &|_| from).map_err(|failure| {
            let report = error(codes::INCLUDE, from, failure.message);
            Box::new(placed(report, &path, &text, failure.place))
        });
        let (tokens, places) = cut?;
        let (statements, _) = split(tokens);
        open.push(path.clone());
        for (number, statement) in statements.iter().enumerate() {
            let inner = self.include(&statement.path, from, open, read);
            inner.map_err(|report| {
                let place = places[LENGTH * number + 1].clone();
                Box::new(placed(*report, &path, &text, place))
            })?;
        }
        open.pop();
        self.files.push(File {
            path,
            text,
            places,
            statements: LENGTH * statements.len(),
            from,
        });
        Ok(())
    }

    /// All tokens but the statements; each of a file's stands where the call includes the file.
    #[must_use]
    pub fn tokens(&self) -> TokenStream {
        self.spanned(&|file, _| self.files[file].from)
    }

    /// All tokens but the statements, those of files with the spans that are given by file and number.
    fn spanned(&self, span: &dyn Fn(usize, usize) -> Span) -> TokenStream {
        let mut tokens = TokenStream::new();
        for (number, file) in self.files.iter().enumerate() {
            // It was cut before.
            if let Ok((all, _)) = text::tokens(&file.text, &|token| span(number, token)) {
                tokens.extend(all.into_iter().skip(file.statements));
            }
        }
        tokens.extend(self.rest.clone());
        tokens
    }

    /// Makes cargo build again when a file changes: nothing else on a stable compiler does.
    #[must_use]
    pub fn dependencies(&self) -> TokenStream {
        let dependency = |file: &File| {
            let path = format!("/{}", file.path);
            quote! {
                const _: &[::core::primitive::u8] = ::core::include_bytes!(::core::concat!(::core::env!("CARGO_MANIFEST_DIR"), #path));
            }
        };
        self.files.iter().map(dependency).collect()
    }
}

/// The statements at the top, and what is left.
fn split(tokens: TokenStream) -> (Vec<Statement>, TokenStream) {
    // What a `macro_rules!` hands on stands in groups that nobody wrote.
    let trees = dissolved(tokens);
    let mut statements = Vec::new();
    while let Some(statement) = trees.get(LENGTH * statements.len()..).and_then(first) {
        statements.push(statement);
    }
    let rest = trees.into_iter().skip(LENGTH * statements.len());
    (statements, rest.collect())
}

/// The statement that stands here. What only resembles one is left to the grammar, which says how it is written.
fn first(trees: &[TokenTree]) -> Option<Statement> {
    let [
        TokenTree::Ident(word),
        TokenTree::Literal(literal),
        TokenTree::Punct(end),
        ..,
    ] = trees
    else {
        return None;
    };
    if word != "include" || end.as_char() != ';' {
        return None;
    }
    let path: syn::LitStr = syn::parse2(TokenTree::from(literal.clone()).into()).ok()?;
    Some(Statement {
        path: path.value(),
        span: literal.span(),
    })
}

/// A path without steps that lead nowhere or back, so that each file has one.
fn plain(path: &str) -> String {
    let mut steps: Vec<&str> = Vec::new();
    for step in path.split('/') {
        match step {
            "" | "." => {}
            ".." if steps.last().is_some_and(|last| *last != "..") => {
                steps.pop();
            }
            _ => steps.push(step),
        }
    }
    steps.join("/")
}

/// The longest part of a line that is shown.
const WIDTH: usize = 100;

/// A report with the place in a file's text: its line and column, the line, and a caret.
fn placed(mut report: Diagnostic, path: &str, text: &str, place: Range<usize>) -> Diagnostic {
    let before = &text[..place.start];
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    let number = before.matches('\n').count() + 1;
    let column = text[start..place.start].chars().count();
    let line = text[start..].lines().next().unwrap_or_default();
    let length = text[place].lines().next().unwrap_or_default();
    let length = length.chars().count().clamp(1, WIDTH / 2);
    // Of a long line the part around the place is shown.
    let skipped = (column + length).saturating_sub(WIDTH);
    let shown = line.chars().skip(skipped).take(WIDTH);
    let shown: String = shown.map(|it| if it == '\t' { ' ' } else { it }).collect();
    let indent = " ".repeat(column - skipped.min(column));
    let lines = [
        format!("in {path}:{number}:{}", column + 1),
        format!("  {shown}"),
        format!("  {indent}{}", "^".repeat(length)),
    ];
    report.notes.splice(0..0, lines);
    report
}

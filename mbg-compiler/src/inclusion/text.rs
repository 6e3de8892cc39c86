//! The text of a file to tokens.
//!
//! A procedural macro cannot read a file's text with places on a stable compiler: tokens that the compiler makes of a
//! string all stand where the macro was called. So the text is cut here, where each token keeps its place, and what
//! cannot be cut is told at its place instead of stopping the compiler.

use std::ops::Range;

use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};

/// Where a text cannot be cut into tokens, and why.
#[derive(Debug)]
pub(crate) struct Failure {
    /// Bytes of the text.
    pub(crate) place: Range<usize>,
    /// What is wrong.
    pub(crate) message: String,
}

/// The tokens of a text and, by number, the bytes that each was made of: a bracket and its partner have one number,
/// that of where it opens, and so has all that a documentation comment becomes.
///
/// # Errors
///
/// What is no token, and brackets that do not match.
pub(crate) fn tokens(
    text: &str,
    span: &dyn Fn(usize) -> Span,
) -> Result<(TokenStream, Vec<Range<usize>>), Failure> {
    let mut reader = Reader {
        text,
        at: if text.starts_with('\u{feff}') { 3 } else { 0 },
        span,
        places: Vec::new(),
        open: Vec::new(),
        trees: Vec::new(),
    };
    while reader.skip_space()? {
        reader.token()?;
    }
    match reader.open.pop() {
        Some(open) => Err(Failure {
            place: open.place,
            message: "this bracket is never closed".to_owned(),
        }),
        None => Ok((reader.trees.into_iter().collect(), reader.places)),
    }
}

/// Brackets within brackets, beyond which those who read them could run out of stack.
const DEEPEST: usize = 256;

/// A bracket that is open.
struct Open {
    delimiter: Delimiter,
    span: Span,
    place: Range<usize>,
    /// What stood before it.
    before: Vec<TokenTree>,
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    span: &'a dyn Fn(usize) -> Span,
    places: Vec<Range<usize>>,
    open: Vec<Open>,
    trees: Vec<TokenTree>,
}

impl Reader<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn fail<T>(&self, length: usize, message: impl Into<String>) -> Result<T, Failure> {
        Err(Failure {
            place: self.at..self.at + length,
            message: message.into(),
        })
    }

    /// Takes the next `length` bytes as one place.
    fn take(&mut self, length: usize) -> Span {
        let span = (self.span)(self.places.len());
        self.places.push(self.at..self.at + length);
        self.at += length;
        span
    }

    /// Steps over space and comments; false at the end.
    fn skip_space(&mut self) -> Result<bool, Failure> {
        loop {
            self.at += self.rest().len() - self.rest().trim_start().len();
            let rest = self.rest();
            if rest.starts_with("//") && !documents(rest) {
                self.at += line(rest).len();
            } else if rest.starts_with("/*") {
                self.at += self.comment()?;
            } else {
                return Ok(!rest.is_empty());
            }
        }
    }

    /// The length of the comment here; comments nest.
    fn comment(&self) -> Result<usize, Failure> {
        let (bytes, mut depth, mut at) = (self.rest().as_bytes(), 0, 0);
        loop {
            match bytes.get(at..at + 2) {
                Some(b"/*") => (depth, at) = (depth + 1, at + 2),
                Some(b"*/") if depth == 1 => return Ok(at + 2),
                Some(b"*/") => (depth, at) = (depth - 1, at + 2),
                Some(_) => at += 1,
                None => return self.fail(2, "this comment is never closed"),
            }
        }
    }

    fn token(&mut self) -> Result<(), Failure> {
        let rest = self.rest();
        let Some(first) = rest.chars().next() else {
            return Ok(());
        };
        match first {
            '/' if rest.starts_with("///") => self.documentation(),
            '(' => return self.open(Delimiter::Parenthesis),
            '[' => return self.open(Delimiter::Bracket),
            '{' => return self.open(Delimiter::Brace),
            ')' => return self.close(Delimiter::Parenthesis),
            ']' => return self.close(Delimiter::Bracket),
            '}' => return self.close(Delimiter::Brace),
            '"' => return self.string(),
            '0'..='9' => return self.number(),
            _ if first == '_' || unicode_ident::is_xid_start(first) => self.word(),
            _ if "=<>!~+-*/%^&|@.,;:#$?".contains(first) => self.punctuation(first),
            _ => {
                return self.fail(
                    first.len_utf8(),
                    format!("`{first}` means nothing in the language"),
                );
            }
        }
        Ok(())
    }

    /// A comment that documents what follows becomes the attribute that it stands for.
    fn documentation(&mut self) {
        let comment = line(self.rest());
        let mut text = Literal::string(&comment[3..]);
        let span = self.take(comment.len());
        text.set_span(span);
        let mut equals = Punct::new('=', Spacing::Alone);
        equals.set_span(span);
        let inner: [TokenTree; 3] = [Ident::new("doc", span).into(), equals.into(), text.into()];
        let mut group = Group::new(Delimiter::Bracket, inner.into_iter().collect());
        group.set_span(span);
        let mut hash = Punct::new('#', Spacing::Alone);
        hash.set_span(span);
        self.trees.extend([hash.into(), TokenTree::Group(group)]);
    }

    fn open(&mut self, delimiter: Delimiter) -> Result<(), Failure> {
        if self.open.len() == DEEPEST {
            return self.fail(1, format!("brackets nest deeper than {DEEPEST}"));
        }
        let place = self.at..self.at + 1;
        let span = self.take(1);
        let before = std::mem::take(&mut self.trees);
        self.open.push(Open {
            delimiter,
            span,
            place,
            before,
        });
        Ok(())
    }

    fn close(&mut self, delimiter: Delimiter) -> Result<(), Failure> {
        let Some(open) = self.open.pop() else {
            return self.fail(1, "this bracket was never opened");
        };
        if open.delimiter != delimiter {
            return Err(Failure {
                place: open.place,
                message: "this bracket is closed by one of another kind".to_owned(),
            });
        }
        let inner = std::mem::replace(&mut self.trees, open.before);
        let mut group = Group::new(delimiter, inner.into_iter().collect());
        group.set_span(open.span);
        self.trees.push(group.into());
        self.at += 1;
        Ok(())
    }

    fn string(&mut self) -> Result<(), Failure> {
        let rest = line(self.rest());
        let Some(end) = rest[1..].find('"') else {
            return self.fail(1, "this string is not closed on its line");
        };
        let mut literal = Literal::string(&rest[1..=end]);
        literal.set_span(self.take(end + 2));
        self.trees.push(literal.into());
        Ok(())
    }

    /// `2`, `1_000`, `2.5`, `2.`, `1e-5`; in `0..3` and `1.x` the dots are not part of it.
    fn number(&mut self) -> Result<(), Failure> {
        let rest = self.rest();
        let digits = |from: usize| {
            let part = &rest[from..];
            let no_digit = |letter: char| !letter.is_ascii_digit() && letter != '_';
            from + part.find(no_digit).unwrap_or(part.len())
        };
        let mut length = digits(0);
        let mut after = rest[length..].chars();
        let point = after.next() == Some('.');
        if point
            && !after
                .next()
                .is_some_and(|next| next == '.' || next == '_' || unicode_ident::is_xid_start(next))
        {
            length = digits(length + 1);
        }
        if rest[length..].starts_with(['e', 'E']) {
            let signed = rest[length + 1..].starts_with(['+', '-']);
            length = digits(length + 1 + usize::from(signed));
        }
        length += rest[length..]
            .chars()
            .take_while(|it| unicode_ident::is_xid_continue(*it))
            .map(char::len_utf8)
            .sum::<usize>();
        let text = &rest[..length];
        // The compiler stops at what it cannot read as a literal, so it is only shown numbers.
        let plain = text.replace('_', "");
        if plain.parse::<f64>().is_err() {
            return self.fail(length, format!("`{text}` is no number"));
        }
        let Ok(mut literal) = text.parse::<Literal>() else {
            return self.fail(length, format!("`{text}` is no number"));
        };
        literal.set_span(self.take(length));
        self.trees.push(literal.into());
        Ok(())
    }

    fn word(&mut self) {
        let rest = self.rest();
        let length = rest.find(|letter| !unicode_ident::is_xid_continue(letter));
        let word = &rest[..length.unwrap_or(rest.len())];
        let (mut ident, length) = match raw(rest) {
            Some(name) => (Ident::new_raw(name, Span::call_site()), 2 + name.len()),
            None => (Ident::new(word, Span::call_site()), word.len()),
        };
        ident.set_span(self.take(length));
        self.trees.push(ident.into());
    }

    /// Punctuation is joined to the punctuation behind it, as `-` to `>` in an arrow.
    fn punctuation(&mut self, character: char) {
        let next = self.rest()[1..].chars().next();
        let joined = next.is_some_and(|next| "=<>!~+-*/%^&|@.,;:#$?".contains(next));
        let spacing = if joined {
            Spacing::Joint
        } else {
            Spacing::Alone
        };
        let mut punct = Punct::new(character, spacing);
        punct.set_span(self.take(1));
        self.trees.push(punct.into());
    }
}

/// The name behind `r#`, with which a text begins.
fn raw(text: &str) -> Option<&str> {
    let text = text.strip_prefix("r#")?;
    let length = text.find(|letter| !unicode_ident::is_xid_continue(letter));
    let name = &text[..length.unwrap_or(text.len())];
    let begins = name.starts_with(|first| first == '_' || unicode_ident::is_xid_start(first));
    // These cannot be raw.
    let is_kept = ["_", "self", "Self", "super", "crate"].contains(&name);
    (begins && !is_kept).then_some(name)
}

/// The first line of a text.
fn line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

/// Whether a comment documents what follows: three strokes, and not four.
fn documents(text: &str) -> bool {
    text.starts_with("///") && !text.starts_with("////")
}

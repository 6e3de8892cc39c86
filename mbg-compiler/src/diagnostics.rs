//! Errors as values: collected, never thrown, and rendered at the edge.
//!
//! House style: the first line says what is wrong, in lower case, without a full stop, names in backticks; notes
//! carry the causal chain; `help` says what to type. Every diagnostic has a code from [`crate::codes`].

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, quote, quote_spanned};

use crate::syntax::words::{nearest, shortened};

/// A code such as `MBG0301`; the first two digits name the stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Code {
    /// The code's text.
    pub text: &'static str,
    /// What the code stands for, one line.
    pub meaning: &'static str,
}

/// One mistake, at one place.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// Which mistake.
    pub code: Code,
    /// Where.
    pub span: Span,
    /// What is wrong.
    pub message: String,
    /// Why: the chain of causes, one step a line.
    pub notes: Vec<String>,
    /// What to do about it, with the text to type.
    pub helps: Vec<String>,
    /// How many more there are that differ in numbers alone, as a loop makes them.
    pub alike: usize,
    /// The expressions that are to blame, where they are only parts of what was read; the first foremost.
    pub about: Vec<TokenStream>,
}

impl Diagnostic {
    /// Adds a line to the chain of causes.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Adds a way out.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.helps.push(help.into());
        self
    }

    /// Adds an expression that is to blame.
    #[must_use]
    pub fn about(mut self, expression: &impl ToTokens) -> Self {
        self.about.push(expression.to_token_stream());
        self
    }

    /// Adds the name that was probably meant, if one is near.
    #[must_use]
    pub fn did_you_mean(self, found: &str, names: &[&str]) -> Self {
        match nearest(found, names).or_else(|| shortened(found, names)) {
            Some(near) => self.help(format!("did you mean `{near}`?")),
            None => self,
        }
    }

    /// Moves a mistake inside a component of the library to the instance, which is what the user wrote.
    #[must_use]
    pub fn inside(mut self, component: &str, instance: Span) -> Self {
        self.span = instance;
        self.note(format!(
            "this is inside `{component}`, a component of the library"
        ))
    }

    /// The text that the user reads. Keywords that are names are told as names, and typed as `r#type`.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("{} [{}]", self.message, self.code.text);
        for note in &self.notes {
            text.push_str("\n  ");
            text.push_str(note);
        }
        text = without_raw(&text);
        if self.alike > 0 {
            text += &format!("\n  and {} more, which differ in their numbers", self.alike);
        }
        for help in &self.helps {
            text.push_str("\n  help: ");
            text.push_str(help);
        }
        text
    }

    /// Whether a mistake at the same place differs in the numbers of its names alone.
    fn is_alike(&self, other: &Self) -> bool {
        self.code == other.code
            && self.message != other.message
            && without_numbers(&self.message).eq(without_numbers(&other.message))
            && place(self) == place(other)
    }
}

/// A text with `type` for `r#type`.
fn without_raw(text: &str) -> String {
    let mut parts = text.split("r#");
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let is_name = part.starts_with(char::is_alphabetic);
        if !is_name || plain.ends_with(|before: char| before.is_alphanumeric() || before == '_') {
            plain += "r#";
        }
        plain += part;
    }
    plain
}

/// What tells places apart.
fn place(diagnostic: &Diagnostic) -> String {
    format!("{:?}", diagnostic.span)
}

/// A text without the numbers in brackets.
fn without_numbers(text: &str) -> impl Iterator<Item = char> {
    let mut is_number = false;
    text.chars().filter(move |character| {
        is_number = *character == '[' || is_number && character.is_ascii_digit();
        !is_number
    })
}

/// The sink into which every stage reports.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    /// The place of every call, also of one that told what was told already; and the call by which each mistake came.
    places: Vec<Span>,
    calls: Vec<usize>,
    /// What is warned of, in a sink of its own.
    warnings: Option<Box<Self>>,
    /// The constant in which the mistakes are told, that of shells of models.
    constant: Option<Ident>,
}

impl Diagnostics {
    /// An empty sink.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Reports one mistake; those that a loop makes of it are counted.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        debug_assert!(
            !diagnostic.message.ends_with('.'),
            "house style: no full stop"
        );
        let call = self.places.len();
        self.places.push(diagnostic.span);
        match self.list.iter_mut().find(|it| it.is_alike(&diagnostic)) {
            Some(known) => known.alike += 1,
            None => {
                self.calls.push(call);
                self.list.push(diagnostic);
            }
        }
    }

    /// Reports one mistake, unless the same was told at the same place since there were `before`.
    pub fn report_once(&mut self, diagnostic: Diagnostic, before: usize) {
        let told = self.list[before..].iter().any(|known| {
            known.message == diagnostic.message
                && known.notes == diagnostic.notes
                && place(known) == place(&diagnostic)
        });
        if told {
            self.places.push(diagnostic.span);
        } else {
            self.report(diagnostic);
        }
    }

    /// Warns of something, once at each place: each iteration of a loop has the same.
    pub fn warn(&mut self, warning: Diagnostic) {
        let warnings = self.warnings.get_or_insert_default();
        warnings.report_once(warning, 0);
    }

    /// What a model that has no mistake should be looked at for.
    #[must_use]
    pub fn warnings(&self) -> &[Diagnostic] {
        match &self.warnings {
            Some(warnings) if !self.any() => warnings.list(),
            _ => &[],
        }
    }

    /// The sink of what is warned of, for a pass over it.
    pub(crate) fn take_warnings(&mut self) -> Self {
        self.warnings.take().map_or_else(Self::new, |it| *it)
    }

    /// Puts the sink back.
    pub(crate) fn put_warnings(&mut self, warnings: Self) {
        self.warnings = Some(Box::new(warnings));
    }

    /// Reports a mistake that needs no more than its message.
    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.report(error(code, span, message));
    }

    /// Whether anything was reported.
    #[must_use]
    pub fn any(&self) -> bool {
        !self.list.is_empty()
    }

    /// What was reported, in order.
    #[must_use]
    pub fn list(&self) -> &[Diagnostic] {
        &self.list
    }

    /// How many calls there were, also those that told what was told already.
    pub(crate) fn calls(&self) -> usize {
        self.places.len()
    }

    /// The call by which a mistake came, by the mistake's number.
    pub(crate) fn call(&self, number: usize) -> usize {
        self.calls[number]
    }

    /// Where a call reported.
    pub(crate) fn place_of_call(&self, call: usize) -> Option<Span> {
        self.places.get(call).copied()
    }

    /// Puts some ways out before those of the mistakes from number `before` on that have any.
    pub(crate) fn offer_first(&mut self, before: usize, helps: &[String]) {
        for number in before..self.list().len() {
            let own = &mut self.get_mut(number).helps;
            if !own.is_empty() {
                own.splice(0..0, helps.iter().cloned());
            }
        }
    }

    /// A mistake by number.
    pub(crate) fn get_mut(&mut self, number: usize) -> &mut Diagnostic {
        &mut self.list[number]
    }

    /// Says in which constant the mistakes are told, which leave it without a value.
    pub(crate) fn tell_in(&mut self, constant: Option<Ident>) {
        self.constant = constant;
    }

    /// One `compile_error!` per mistake and one lint per warning, each at its own token.
    #[must_use]
    pub fn to_tokens(&self) -> TokenStream {
        let errors = self.list.iter().map(|diagnostic| {
            let text = diagnostic.text();
            quote_spanned!(diagnostic.span=> ::core::compile_error!(#text);)
        });
        let mut told = match &self.constant {
            Some(constant) => {
                quote!(const #constant: ::core::primitive::usize = { #(#errors)* 0 };)
            }
            None => errors.collect(),
        };
        told.extend(self.warnings().iter().map(lint));
        told
    }
}

/// A warning as a stable compiler lets a macro give one: the use of something deprecated.
fn lint(warning: &Diagnostic) -> TokenStream {
    let text = warning.text();
    let name = Ident::new("mbg", warning.span);
    quote! {
        const _: () = {
            #[deprecated(note = #text)]
            const fn #name() {}
            #name()
        };
    }
}

/// Starts a diagnostic.
pub fn error(code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic {
        code,
        span,
        message: message.into(),
        notes: Vec::new(),
        helps: Vec::new(),
        alike: 0,
        about: Vec::new(),
    }
}

/// How many names a listing leaves out, if any, and how many it has at most before it does.
const LEFT_OUT: usize = 4;
const LISTED: usize = 8;

/// All names where they are few, and the first of many, then how many more.
#[must_use]
pub fn listing<I: IntoIterator<Item = String>>(names: I) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    let more = names.len().saturating_sub(LISTED);
    if more < LEFT_OUT {
        return names.join(", ");
    }
    format!("{} and {more} more", names[..LISTED].join(", "))
}

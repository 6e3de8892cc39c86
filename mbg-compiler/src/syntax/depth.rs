//! How much stack a law would take, before `syn`, which recurses, is let near it.
//!
//! A stack that overflows ends the compiler without an error, so a law that could do it is refused. The costs are
//! in kilobytes, measured without optimisation, which is how macros run, and rounded up.

use proc_macro2::{Delimiter, TokenTree};

use super::words;

/// What a law may take: half of the smallest stack in use, that of a thread.
const BUDGET: usize = 1_000;

/// Whether the tokens nest or run on so far that reading them could exhaust the stack.
pub(super) fn too_deep(tokens: &[TokenTree]) -> bool {
    weight(tokens.iter().cloned(), BUDGET, false).is_none()
}

/// The stack for these tokens, if it is within the budget.
fn weight(tokens: impl Iterator<Item = TokenTree>, budget: usize, typed: bool) -> Option<usize> {
    let mut run = Run {
        typed,
        ..Run::default()
    };
    let mut heaviest = 0;
    for token in tokens {
        run.add(&token, budget)?;
        heaviest = heaviest.max(run.flat + run.nested);
        if heaviest > budget {
            return None;
        }
    }
    Some(heaviest)
}

/// Tokens between two separators: each may be the operand of the one before.
#[derive(Default)]
struct Run {
    /// Cost of the tokens side by side.
    flat: usize,
    /// Cost of the deepest group among them.
    nested: usize,
    /// Whether the last token was an operand, after which an operator is a binary one.
    operand: bool,
    /// Whether a type or a pattern may have begun, whose reader takes far more, and whose commas nest.
    typed: bool,
    /// How many colons came last.
    colons: usize,
}

impl Run {
    fn add(&mut self, token: &TokenTree, budget: usize) -> Option<()> {
        match token {
            TokenTree::Punct(punct) => self.punct(punct.as_char()),
            TokenTree::Group(group) => {
                let own = match group.delimiter() {
                    _ if self.typed => 60,
                    Delimiter::Brace => 32,
                    _ => 20,
                };
                self.flat += 1;
                let left = budget.checked_sub(own)?;
                let inner = weight(group.stream().into_iter(), left, self.typed)?;
                self.nested = self.nested.max(own + inner);
                self.operand = true;
            }
            TokenTree::Ident(word) => {
                let word = word.to_string();
                let value = matches!(word.as_str(), "if" | "else" | "true" | "false" | "self");
                let keyword = words::is_reserved(&word) && !value;
                self.flat += if keyword { 45 } else { 1 };
                self.typed |= keyword;
                self.operand = !words::is_reserved(&word);
            }
            TokenTree::Literal(_) => {
                self.flat += 1;
                self.operand = true;
            }
        }
        if !matches!(token, TokenTree::Punct(_)) {
            self.colons = 0;
        }
        Some(())
    }

    fn punct(&mut self, character: char) {
        match character {
            ',' | ';' if !self.typed => {
                *self = Self::default();
                return;
            }
            // A turbofish, a qualified path, a closure.
            '<' if !self.operand || self.colons == 2 => self.typed = true,
            '|' if !self.operand => self.typed = true,
            _ => {}
        }
        self.flat += match character {
            '<' if self.typed => 60,
            '&' | '*' if self.typed => 40,
            '|' if self.typed => 10,
            '=' => 8,
            _ if self.typed => 8,
            _ if !self.operand => 5,
            _ => 1,
        };
        self.colons = if character == ':' { self.colons + 1 } else { 0 };
        self.operand = character == '?';
    }
}

#[cfg(test)]
mod tests {
    use proc_macro2::TokenStream;

    use super::*;

    fn deep(law: &str) -> bool {
        too_deep(
            &law.parse::<TokenStream>()
                .unwrap()
                .into_iter()
                .collect::<Vec<_>>(),
        )
    }

    #[test]
    fn laws_of_ordinary_size_pass() {
        assert!(!deep(&format!("{} 1.0", "a * b.q.x + ".repeat(100))));
        assert!(!deep(&"[a * (b + -c), rot_x(f(q))], ".repeat(5_000)));
        assert!(!deep(&format!(
            "if a < 1.0 {{ b }} {} else {{ c }}",
            "else if a < 2.0 { b * (c - d) }".repeat(60)
        )));
        assert!(!deep(&format!("{}x{}", "f(".repeat(40), ")".repeat(40))));
    }

    #[test]
    fn deep_laws_are_refused() {
        assert!(deep(&format!("{}x{}", "f(".repeat(60), ")".repeat(60))));
        assert!(deep(&format!("{}x", "-".repeat(300))));
        assert!(deep(&format!("{}x", "a + ".repeat(1_000))));
    }
}

//! What the equations, component by component, say of a drawing that is rejected.

use super::report::COMPONENTWISE;
use crate::codes;
use crate::diagnostics::Diagnostic;
use crate::graph::Element;

/// How ways out begin that change what a dependence is on, and do not spare accepting it.
pub const IN_PLACE: &str = "in the place of";

/// Which ways out exist.
#[derive(Clone, Debug)]
pub enum Outlook {
    /// The equations keep every storage as a state: the drawing alone is at fault.
    Soluble,
    /// Storages depend on each other by the physics, which can be accepted.
    Acceptable,
    /// Storages depend on each other by the physics, and who accepts that is answered with this.
    Refused(Box<Diagnostic>),
}

impl Outlook {
    /// Whether the drawing alone is at fault.
    #[must_use]
    pub fn is_soluble(&self) -> bool {
        matches!(self, Self::Soluble)
    }

    /// Whether storages depend on each other, unlike where a loop has a law without an inverse.
    #[must_use]
    pub fn loses_order(&self) -> bool {
        match self {
            Self::Soluble => false,
            Self::Acceptable => true,
            Self::Refused(report) => report.code != codes::NONLINEAR_LOOP,
        }
    }

    /// Whether storages depend on each other and that can be accepted.
    #[must_use]
    pub fn is_acceptable(&self) -> bool {
        matches!(self, Self::Acceptable)
    }

    /// How to accept that storages are no states; nothing where that does not help.
    #[must_use]
    pub fn acceptance<'a>(&self, storages: impl Iterator<Item = &'a Element>) -> Option<String> {
        if matches!(self, Self::Refused(_)) {
            return None;
        }
        let mut ways: Vec<String> = Vec::new();
        for way in storages.map(Element::acceptance) {
            if !ways.contains(&way) {
                ways.push(way);
            }
        }
        Some(ways.join("; and "))
    }

    /// One stroke per component as a way out.
    #[must_use]
    pub fn componentwise(&self, storage: &Element) -> Option<String> {
        if self.is_soluble() {
            return Some(COMPONENTWISE.to_owned());
        }
        let acceptance = self.acceptance(std::iter::once(storage))?;
        let name = &storage.name;
        Some(format!(
            "{COMPONENTWISE}; what is imposed on `{name}` is no state then: {acceptance}"
        ))
    }

    /// Why it does not help to accept that storages are no states.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let Self::Refused(report) = self else {
            return Vec::new();
        };
        let first = format!("`#[derivative]` does not mend it: {}", report.message);
        std::iter::once(first)
            .chain(report.notes.iter().cloned())
            .collect()
    }

    /// What helps where accepting does not.
    #[must_use]
    pub fn helps(&self) -> Vec<String> {
        let Self::Refused(report) = self else {
            return Vec::new();
        };
        let helps = report.helps.iter();
        let helps = helps.map(|help| help.trim_start_matches("or "));
        let accepted = |help: &str| match help.starts_with(IN_PLACE) {
            true => format!("write `#[derivative]`, and {help}"),
            false => help.to_owned(),
        };
        helps.map(accepted).collect()
    }
}

//! How large a model is, and whether it is known which of its statements are chosen, before anything is built.

use std::collections::BTreeMap;

use proc_macro2::Span;
use syn::spanned::Spanned;

use super::constants::Constants;
use crate::codes;
use crate::diagnostics::{Diagnostic, Diagnostics, error};
use crate::syntax::ast::{Component, Conditional, Element, Instance, Loop, Model, Statement};

/// The most vector bonds that a model may have, and the most instances and iterations of loops.
pub const LIMIT: usize = 4096;

/// Reports a model that is too large, a component that contains itself or an `if` that is not decided; false if it did.
pub(super) fn check(
    model: &Model,
    components: &BTreeMap<String, &Component>,
    diagnostics: &mut Diagnostics,
) -> bool {
    let mut counter = Counter {
        components,
        known: BTreeMap::new(),
        open: Vec::new(),
        library: None,
        probing: false,
    };
    let constants = Constants::of_model(&model.statements);
    let mut place = model.name.span();
    let found = match counter.count(&model.statements, &constants) {
        Ok(size) if size.bonds <= LIMIT => return true,
        Ok(size) => format!("{} vector bonds", size.bonds),
        Err(Stop::Scopes(of_loop)) => {
            place = of_loop.unwrap_or(place);
            "too many instances and iterations of loops".to_owned()
        }
        Err(Stop::Mistake(report)) => {
            diagnostics.report(*report);
            return false;
        }
        // Elaboration tells which bound of a loop is no whole number.
        Err(Stop::Unknown) => return true,
    };
    let message = format!("`{}` has {found}, the limit is {LIMIT}", model.name);
    let report = error(codes::TOO_LARGE, place, message);
    diagnostics.report(report.help("split the scene into models that exchange inputs and outputs"));
    false
}

/// What there is to build.
#[derive(Clone, Copy, Default)]
struct Size {
    /// Vector bonds.
    bonds: usize,
    /// Instances and iterations of loops.
    scopes: usize,
}

impl Size {
    fn add(&mut self, other: Self, times: usize) -> Result<(), Stop> {
        let grown = |own: usize, other: usize| own.saturating_add(other.saturating_mul(times));
        self.bonds = grown(self.bonds, other.bonds);
        self.scopes = grown(self.scopes, other.scopes);
        if self.scopes > LIMIT {
            return Err(Stop::Scopes(None));
        }
        Ok(())
    }
}

/// Why counting ended early.
enum Stop {
    /// Too many instances and iterations to count on, and the end of the loop that makes them, if one does.
    Scopes(Option<Span>),
    /// A bound of a loop or a condition is not known.
    Unknown,
    /// A condition is not known, or a component contains itself.
    Mistake(Box<Diagnostic>),
}

struct Counter<'a> {
    components: &'a BTreeMap<String, &'a Component>,
    /// Sizes of components by the whole numbers that they are given, and by whether that was a probe.
    known: BTreeMap<(bool, String, Constants), Size>,
    open: Vec<String>,
    /// Inside a component of the library: its name, and the instance in the user's text.
    library: Option<(String, Span)>,
    /// Whether an unknown bound ends the count; otherwise its loop counts for nothing, since it will not be built.
    probing: bool,
}

impl Counter<'_> {
    fn count(&mut self, statements: &[Statement], constants: &Constants) -> Result<Size, Stop> {
        let mut total = Size::default();
        for statement in statements {
            let bonds = match statement {
                Statement::Junction(junction) => junction.elements.iter().map(bonds).sum(),
                Statement::Chain(chain) => chain.arrows.len(),
                Statement::Closure(_) => 2,
                Statement::Instance(instance) => {
                    total.add(self.instance(instance, constants)?, 1)?;
                    0
                }
                Statement::Loop(repeated) => {
                    total.add(self.repeated(repeated, constants)?, 1)?;
                    0
                }
                Statement::Conditional(conditional) => {
                    total.add(self.chosen(conditional, constants)?, 1)?;
                    0
                }
                _ => 0,
            };
            total.add(Size { bonds, scopes: 0 }, 1)?;
        }
        Ok(total)
    }

    fn instance(&mut self, instance: &Instance, constants: &Constants) -> Result<Size, Stop> {
        let name = instance.component.to_string();
        if self.open.contains(&name) {
            let message = format!("component `{name}` contains itself");
            let report = error(codes::RECURSION, instance.component.span(), message);
            return Err(self.mistake(report));
        }
        let Some(component) = self.components.get(&name) else {
            return Ok(Size::default());
        };
        let inner = constants.of_instance(instance, component);
        let key = (self.probing, name.clone(), inner.clone());
        if let Some(known) = self.known.get(&key) {
            return Ok(*known);
        }
        self.open.push(name.clone());
        let around = self.library.clone();
        if component.library {
            self.library
                .get_or_insert_with(|| (name, instance.name.span()));
        }
        let counted = self.count(&component.statements, &inner);
        self.library = around;
        self.open.pop();
        let mut size = counted?;
        size.scopes += 1;
        self.known.insert(key, size);
        Ok(size)
    }

    /// What an `if` chooses.
    fn chosen(&mut self, conditional: &Conditional, constants: &Constants) -> Result<Size, Stop> {
        match constants.branch(conditional) {
            Ok(branch) => self.count(branch, constants),
            Err(_) if self.probing => Err(Stop::Unknown),
            Err(report) => Err(self.mistake(*report)),
        }
    }

    /// A mistake, which inside a component of the library is told at the instance.
    fn mistake(&self, report: Diagnostic) -> Stop {
        Stop::Mistake(Box::new(match &self.library {
            Some((component, instance)) => report.inside(component, *instance),
            None => report,
        }))
    }

    /// What a loop makes, which is told of where it is too much.
    fn repeated(&mut self, repeated: &Loop, constants: &Constants) -> Result<Size, Stop> {
        let place = self.library.as_ref().map(|(_, instance)| *instance);
        let place = place.unwrap_or_else(|| repeated.end.span());
        let size = self.iterations(repeated, constants);
        size.map_err(|stop| match stop {
            Stop::Scopes(inner) => Stop::Scopes(inner.or(Some(place))),
            stop => stop,
        })
    }

    /// All iterations at once where they are alike; otherwise one after the other, as far as the limit.
    fn iterations(&mut self, repeated: &Loop, constants: &Constants) -> Result<Size, Stop> {
        let range = match constants.range(repeated) {
            Ok(range) => range,
            Err(_) if self.probing => return Err(Stop::Unknown),
            Err(_) => return Ok(Size::default()),
        };
        let length = usize::try_from(range.end.saturating_sub(range.start)).unwrap_or(0);
        if length == 0 {
            return Ok(Size::default());
        }
        let iteration = Size {
            bonds: 0,
            scopes: 1,
        };
        let mut total = Size::default();
        let probing = std::mem::replace(&mut self.probing, true);
        let alike = self.count(
            &repeated.statements,
            &constants.of_iteration(repeated, None),
        );
        self.probing = probing;
        match alike {
            Ok(size) => {
                total.add(size, length)?;
                total.add(iteration, length)?;
            }
            Err(Stop::Unknown) => {
                for number in range {
                    let constants = constants.of_iteration(repeated, Some(number));
                    total.add(self.count(&repeated.statements, &constants)?, 1)?;
                    total.add(iteration, 1)?;
                }
            }
            Err(stop) => return Err(stop),
        }
        Ok(total)
    }
}

fn bonds(element: &Element) -> usize {
    1 + usize::from(
        element
            .fields
            .iter()
            .any(|field| field.name == "gyroscopic"),
    )
}

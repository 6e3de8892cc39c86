//! The page of the library in the documentation of `mbg-runtime`, which is made of the components themselves.
#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::fs;

use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::syntax::ast::{
    ChainNode, Component, Conditional, Element, ElementKind, Item, Port, Statement, Unit,
};
use mbg_compiler::syntax::dump::expression;
use mbg_compiler::syntax::{self, library};
use syn::{Attribute, Expr, Lit, Meta};

/// Where the page stands.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../mbg-runtime/src/library.md");

/// What stands before the components.
const INTRODUCTION: &str = "\
All components of the library. This page is generated from their files.

`hinge: Revolute { axis: 2 } (ground, arm);` makes an instance: values of parameters by name, then a junction for each port, in
order, see [`language`](crate::language). `port 1 a` takes a 1-junction, whose bonds share one flow, `port 0 a` a 0-junction,
whose bonds share one effort, and `port a` either. A port without a number in brackets has one component; `[3]` is a frame in a
plane, or of a body that only turns, `[6]` a frame in space, see [`joints`](crate::joints).

- *Parameters.* One without a default must be given. One without a unit takes any that fits, one without a number in
  brackets any shape that fits. `gravity` is that of the scene. One whose name ends in that of a port, such as `gravity_a`, is
  by default what the joint that leads to this port hands on.
- *Values* are read by the name of the instance, `hinge.angle`.
- *Inside* are junctions, of which the flow is read if they are 1-junctions and the effort if they are 0-junctions,
  `hinge.rate.f`, `hinge.moment.e`; elements, `hinge.damper.e`; and instances, whose values and insides are read alike.
  What a loop repeats stands behind its label.
- An entry with a condition after it exists only where the condition holds.
";

#[test]
fn page_is_made_of_the_components() {
    let page = page();
    if std::env::var("INSTA_UPDATE").is_ok_and(|word| word == "always") {
        fs::write(PAGE, &page).unwrap();
    }
    let found = fs::read_to_string(PAGE).unwrap();
    let differs = page
        .lines()
        .zip(found.lines())
        .find(|(new, old)| new != old);
    assert!(
        found == page,
        "`INSTA_UPDATE=always cargo test -p mbg-compiler --test library_page` writes the page anew: {differs:?}"
    );
}

/// The whole page.
fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    let links: Vec<String> = library::names().map(link).collect();
    writeln!(page, "\n{}", links.join(",\n")).unwrap();
    for name in library::names() {
        section(&mut page, &component(name));
    }
    page
}

fn component(name: &str) -> Component {
    let mut diagnostics = Diagnostics::new();
    let tokens = library::text(name).unwrap().parse().unwrap();
    let source = syntax::parse(tokens, &mut diagnostics);
    let found = source.items.into_iter().find_map(|item| match item {
        Item::Component(component) if component.name == name => Some(component),
        _ => None,
    });
    found.unwrap()
}

fn section(page: &mut String, component: &Component) {
    let name = component.name.to_string();
    let ports: Vec<String> = component.ports.iter().map(port).collect();
    let lines = documentation(&component.documentation);
    write!(page, "\n# {name}\n\n`{name}({})`\n\n", ports.join(", ")).unwrap();
    page.push_str(&linked(&text(&lines), &name));
    let rows: Vec<String> = component.statements.iter().filter_map(parameter).collect();
    table(page, "parameter | unit | default | ", &rows, &name);
    let mut inside = Inside::default();
    inside.read(&component.statements, "", "");
    table(page, "value | unit | is | ", &inside.values, &name);
    let parts = [inside.junctions, inside.elements, inside.instances].concat();
    if !parts.is_empty() {
        writeln!(page, "\nInside: {}.", parts.join(", ")).unwrap();
    }
}

/// As a port is declared.
fn port(port: &Port) -> String {
    let kind = port
        .kind
        .map_or_else(String::new, |kind| format!("{} ", kind.digit()));
    format!("port {kind}{}{}", port.name, brackets(Some(port.dimension)))
}

/// The row of a parameter.
fn parameter(statement: &Statement) -> Option<String> {
    let (name, unit, default, comment) = match statement {
        Statement::Parameter(it) => {
            let default = it.default.as_ref().map(|value| code(&expression(value)));
            let name = format!("{}{}", it.name, brackets(it.dimension));
            (name, it.unit.as_ref(), default, &it.documentation)
        }
        Statement::Choice(it) => {
            let others = it
                .words
                .iter()
                .filter(|&word| Some(word) != it.default.as_ref());
            let others: Vec<String> = others.map(|word| code(&word.to_string())).collect();
            let default = it.default.as_ref();
            let first = default.map_or_else(String::new, |word| format!("`{word}`, or "));
            let words = Some(format!("{first}{}", others.join(", ")));
            (it.name.to_string(), None, words, &it.documentation)
        }
        _ => return None,
    };
    let (default, comment) = (
        default.unwrap_or_default(),
        documentation(comment).join(" "),
    );
    Some(format!(
        "`{name}` | {} | {default} | {comment}",
        unit_text(unit)
    ))
}

/// What can be read of an instance.
#[derive(Default)]
struct Inside {
    /// Rows of a table.
    values: Vec<String>,
    junctions: Vec<String>,
    elements: Vec<String>,
    instances: Vec<String>,
}

impl Inside {
    /// What statements add that stand behind the label of a loop, `label[k].`, and under a condition.
    fn read(&mut self, statements: &[Statement], label: &str, condition: &str) {
        let given = |text: String| format!("{text}{}", on(condition));
        for statement in statements {
            match statement {
                Statement::Let(it) => {
                    let name = format!("{label}{}{}", it.name, brackets(it.dimension));
                    let value = given(code(&expression(&it.value)));
                    self.value(&name, it.unit.as_ref(), &value, &it.documentation);
                }
                Statement::Integral(it) => {
                    let name = format!("{label}{}{}", it.name, brackets(Some(it.dimension)));
                    let value = given(format!("the integral of `{}`", expression(&it.rate)));
                    self.value(&name, it.unit.as_ref(), &value, &it.documentation);
                }
                Statement::Attitude(it) => {
                    let (word, rate) = (it.orientation.word(), expression(&it.angular_velocity));
                    let value = given(format!("the attitude `{word}({rate})`"));
                    self.value(
                        &format!("{label}{}", it.name),
                        None,
                        &value,
                        &it.documentation,
                    );
                }
                Statement::Junction(it) => {
                    let (digit, size) = (it.kind.digit(), brackets(Some(it.dimension)));
                    self.junctions
                        .push(given(format!("`{digit} {label}{}{size}`", it.name)));
                    it.elements
                        .iter()
                        .for_each(|it| self.element(it, label, condition));
                }
                Statement::Chain(chain) => {
                    for node in &chain.nodes {
                        if let ChainNode::Element(it) = node {
                            self.element(it, label, condition);
                        }
                    }
                }
                Statement::Instance(it) => {
                    let component = link(&it.component.to_string());
                    self.instances
                        .push(given(format!("`{label}{}`: {component}", it.name)));
                }
                // Without a label nothing of it can be called.
                Statement::Loop(it) => {
                    if let Some(name) = &it.label {
                        let label = format!("{label}{name}[{}].", it.variable);
                        self.read(&it.statements, &label, condition);
                    }
                }
                Statement::Conditional(it) => self.branches(it, label, condition),
                _ => {}
            }
        }
    }

    fn branches(&mut self, conditional: &Conditional, label: &str, condition: &str) {
        let mut before = condition.to_owned();
        for branch in &conditional.branches {
            let own = branch.condition.as_ref();
            let own = own.map_or_else(String::new, |it| code(&expression(it)));
            self.read(&branch.statements, label, &both(&before, &own));
            before = both(&before, &format!("not {own}"));
        }
    }

    fn value(&mut self, name: &str, unit: Option<&Unit>, value: &str, comment: &[Attribute]) {
        let comment = documentation(comment).join(" ");
        let row = format!("`{name}` | {} | {value} | {comment}", unit_text(unit));
        self.values.push(row);
    }

    fn element(&mut self, element: &Element, label: &str, condition: &str) {
        use ElementKind::{GY, MGY, MTF, TF};
        let name = format!("`{:?} {label}{}`", element.kind, element.name);
        // Of these nothing is read.
        if !matches!(element.kind, TF | MTF | GY | MGY) {
            self.elements.push(name + &on(condition));
        }
    }
}

/// Two conditions, either of which may be none.
fn both(first: &str, second: &str) -> String {
    let all = [first, second].into_iter().filter(|it| !it.is_empty());
    all.collect::<Vec<_>>().join(" and ")
}

fn on(condition: &str) -> String {
    if condition.is_empty() {
        String::new()
    } else {
        format!(" if {condition}")
    }
}

fn code(text: &str) -> String {
    format!("`{text}`")
}

/// `[3]`, and nothing for one component.
fn brackets(dimension: Option<usize>) -> String {
    let dimension = dimension.filter(|dimension| *dimension > 1);
    dimension.map_or_else(String::new, |dimension| format!("[{dimension}]"))
}

fn unit_text(unit: Option<&Unit>) -> String {
    unit.map_or_else(String::new, |unit| code(&unit.text))
}

/// The lines of a documentation comment.
fn documentation(attributes: &[Attribute]) -> Vec<String> {
    let line = |attribute: &Attribute| match &attribute.meta {
        Meta::NameValue(named) => match &named.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(line) => Some(line.value()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    };
    let lines = attributes.iter().filter_map(line);
    lines
        .map(|line| line.strip_prefix(' ').unwrap_or(&line).to_owned())
        .collect()
}

/// Lines as Markdown: those that are set in are formulas.
fn text(lines: &[String]) -> String {
    let (mut text, mut formula) = (String::new(), false);
    for line in lines.iter().map(String::as_str).chain([""]) {
        let set_in = line.strip_prefix("    ");
        if set_in.is_some() != formula {
            formula = !formula;
            text.push_str(if formula { "```text\n" } else { "```\n" });
        }
        writeln!(text, "{}", set_in.unwrap_or(line)).unwrap();
    }
    text.truncate(text.trim_end().len());
    text + "\n"
}

fn table(page: &mut String, heads: &str, rows: &[String], own: &str) {
    if rows.is_empty() {
        return;
    }
    let columns = heads.split('|').count();
    writeln!(page, "\n| {heads} |\n|{}", "---|".repeat(columns)).unwrap();
    for row in rows {
        let cells = row
            .splitn(columns, " | ")
            .map(|cell| cell.replace('|', "\\|"));
        let row: Vec<String> = cells.map(|cell| linked(&cell, own)).collect();
        writeln!(page, "| {} |", row.join(" | ")).unwrap();
    }
}

/// A component's name, with a link to its section.
fn link(name: &str) -> String {
    format!("[`{name}`](#{})", name.to_lowercase())
}

/// A text in which names of other components are links.
fn linked(text: &str, own: &str) -> String {
    let others = library::names().filter(|name| *name != own);
    others.fold(text.to_owned(), |text, name| {
        text.replace(&code(name), &link(name))
    })
}

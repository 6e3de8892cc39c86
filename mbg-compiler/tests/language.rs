//! Loops, named values and gravity, from the text to the flat graph.
#![allow(clippy::unwrap_used)]

mod models;

use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::items;
use models::{compiled, elaborated, flat, mistake};

#[test]
fn a_chain_of_masses_is_written_once() {
    let text = "model Masses {
        param stiffness = 2.0;
        let count = 3;
        masses: for k in 0..count {
            1 rate { I body { inertia: k + 1, initial: k } }
        }
        springs: for k in 1..count {
            0 force { C spring { stiffness: k * stiffness } }
            masses[k-1].rate -> force;
            force -> masses[k].rate;
            output between = masses[k].body.p - masses[k-1].body.p;
        }
        output last = masses[count-1].body.p + springs[2].spring.q;
    }";
    insta::assert_snapshot!(flat(text), @"
    masses[0].rate -> masses[0].body [1]
    masses[1].rate -> masses[1].body [1]
    masses[2].rate -> masses[2].body [1]
    springs[1].force -> springs[1].spring [1]
    masses[0].rate -> springs[1].force [1]
    springs[1].force -> masses[1].rate [1]
    springs[2].force -> springs[2].spring [1]
    masses[1].rate -> springs[2].force [1]
    springs[2].force -> masses[2].rate [1]
    state masses[0].body.p = 0
    state masses[1].body.p = 1
    state masses[2].body.p = 2
    state springs[1].spring.q = 0
    state springs[2].spring.q = 0
    output springs[1].between = masses[1].body.p - masses[0].body.p
    output springs[2].between = masses[2].body.p - masses[1].body.p
    output last = masses[2].body.p + springs[2].spring.q
    ");
}

#[test]
fn an_unlabelled_loop_has_a_path_of_its_own() {
    let text = "model M {
        1 a[2];
        for k in 0..2 { a[k] -> I m { inertia: 1.0 }; }
        for k in 0..2 { for j in k..2 { 1 b { I m { inertia: 1.0 } } } }
        for k in 5..5 { nowhere -> else_where; }
    }";
    insta::assert_snapshot!(flat(text), @"
    a.x -> k[0].m [1]
    a.y -> k[1].m [1]
    k'[0].j[0].b -> k'[0].j[0].m [1]
    k'[0].j[1].b -> k'[0].j[1].m [1]
    k'[1].j[1].b -> k'[1].j[1].m [1]
    state k[0].m.p = 0
    state k[1].m.p = 0
    state k'[0].j[0].m.p = 0
    state k'[0].j[1].m.p = 0
    state k'[1].j[1].m.p = 0
    ");
}

#[test]
fn a_component_is_repeated_as_often_as_its_parameter_says() {
    let text = "component Ladder(port a) {
        param rungs;
        param half = rungs / 2;
        for k in 0..half { a -> R rung { resistance: k + 1 }; }
    }
    model M {
        1 a { I m { inertia: 1.0 } }
        for k in 1..3 { ladder: Ladder { rungs: 2 * k } (a); }
    }";
    insta::assert_snapshot!(flat(text), @"
    a -> m [1]
    a -> k[1].ladder.k[0].rung [1]
    a -> k[2].ladder.k[0].rung [1]
    a -> k[2].ladder.k[1].rung [1]
    state m.p = 0
    ");
}

#[test]
fn values_are_found_whatever_their_order_and_from_outside() {
    let text = "component Arm(port a) {
        param shift[2];
        param turn = rot_x(0.0);
        let tip[2] = [base.x + spring.q, base.y];
        let base = 2 * shift;
        a -> C spring { stiffness: 1.0 };
        output height = (turn * [0.0, tip.y, 0.0]).z;
    }
    model M {
        output reach = second.tip.x;
        output beyond[2] = second.tip[0..2];
        let quarter = rot_x(1.5);
        second: Arm { shift: first.tip, turn: quarter } (b);
        first: Arm { shift: [1.0, 1.0] } (a);
        1 a { I m { inertia: 1.0 } }
        1 b { I n { inertia: 1.0 } }
    }";
    insta::assert_snapshot!(flat(text), @"
    b -> second.spring [1]
    a -> first.spring [1]
    a -> m [1]
    b -> n [1]
    state second.spring.q = 0
    state first.spring.q = 0
    state m.p = 0
    state n.p = 0
    output reach = 2 (2 + first.spring.q) + second.spring.q
    output beyond.x = 2 (2 + first.spring.q) + second.spring.q
    output beyond.y = 4
    output second.height = 3.989979946416218
    output first.height = 0
    ");
}

#[test]
fn a_long_chain_of_values_needs_no_deep_stack() {
    let text = "model M {
        output first = links[0].sum;
        links: for k in 0..3000 { let sum = if k == 2999 { spring.q } else { links[k+1].sum + 1.0 }; }
        1 a { I m { inertia: 1.0 } C spring { stiffness: 1.0 } }
    }";
    insta::assert_snapshot!(flat(text), @"
    a -> m [1]
    a -> spring [1]
    state m.p = 0
    state spring.q = 0
    output first = spring.q + 2999
    ");
}

#[test]
fn a_value_that_nothing_reads_costs_nothing() {
    let model = |body: &str| {
        compiled(&format!(
            "model M {{ 1 a {{ I m {{ inertia: 1.0 }} R r {{ resistance: 1.0 }} }} {body} output y = m.p; }}"
        ))
    };
    let (with, without) = (model("let power = r.e * r.f;"), model(""));
    assert_eq!(
        with.model.signals.list().len(),
        without.model.signals.list().len()
    );
    assert_eq!(with.states, without.states);
}

#[test]
fn a_comparison_of_whole_numbers_chooses_at_compile_time() {
    let text = "model M {
        links: for k in 0..3 {
            let before = if k > 0 { links[k-1].before + 1.0 } else { 0.5 };
            let turn = if k % 2 == 0 { rot_x(spring.q) } else { rot_y(spring.q) };
            output first = (turn * [0.0, 1.0, 0.0]).z;
        }
        1 a { I m { inertia: 1.0 } C spring { stiffness: 1.0 } }
        output before = links[2].before;
    }";
    insta::assert_snapshot!(flat(text), @"
    a -> m [1]
    a -> spring [1]
    state m.p = 0
    state spring.q = 0
    output links[0].first = sin(spring.q)
    output links[1].first = 0
    output links[2].first = sin(spring.q)
    output before = 2.5
    ");
}

#[test]
fn time_yields_to_a_value_of_its_name_and_to_nothing_else() {
    let text = "model M {
        1 a { R t { effort: 2.0 * f } I m { inertia: 1.0 } }
        for t in 3..4 { output declared = t; }
        output time = t;
    }";
    insta::assert_snapshot!(flat(text), @"
    a -> t [1]
    a -> m [1]
    state m.p = 0
    output t[3].declared = 3
    output time = Time
    ");
    for value in [
        "param t = 1.0;",
        "input t;",
        "let t = 1.0;",
        "integral t = a.f.x;",
    ] {
        let told = mistake(value);
        assert!(
            told.contains("`t` is time, and no other value is called so [MBG0202]"),
            "{told}"
        );
    }
}

#[test]
fn gravity_is_seen_by_every_component() {
    let text = |statement: &str| {
        format!(
            "component Weight(port a[2]) {{
            param mass;
            Se weight {{ effort: mass * gravity }} -> a;
            let down[2] = gravity;
            output down[2] = down;
        }}
        model M {{
            {statement}
            param g = 9.81;
            1 a[2] {{ I m {{ inertia: 2.0 }} }}
            bodies: for k in 0..1 {{ weight: Weight {{ mass: 2.0 }} (a); }}
        }}"
        )
    };
    insta::assert_snapshot!(flat(&text("gravity [0.0, -g];")), @"
    a -> m [2]
    bodies[0].weight.weight -> a [2]
    state m.p.x = 0
    state m.p.y = 0
    output bodies[0].weight.down.x = 0
    output bodies[0].weight.down.y = -g
    ");
    insta::assert_snapshot!(flat(&text("")), @"
    a -> m [2]
    bodies[0].weight.weight -> a [2]
    state m.p.x = 0
    state m.p.y = 0
    output bodies[0].weight.down.x = 0
    output bodies[0].weight.down.y = 0
    ");
}

/// A component whose axes are chosen by words, numbers and what the call gives.
const CHOICES: &str = "component Hinge(port a[3]) {
    param blocked: ideal | compliant = ideal;
    param axis = 0;
    param stiffness = 2.0;
    param compliance = 1.0;
    let count = if blocked == compliant { 3 } else { 1 };
    if given(stiffness) && axis < 2 {
        a[axis] -> C spring { stiffness: stiffness };
        let law = spring.e;
    } else if given(stiffness) || given(compliance) {
        a[axis] -> C soft { compliance: compliance };
        let law = soft.e;
    } else {
        let law = 0.0;
    }
    if blocked == ideal { } else {
        for k in 0..3 { if k != axis { a[k] -> C wall { stiffness: 100.0 }; } }
    }
    if !(blocked != compliant) { let last = count + 1; } else { let last = count; }
    if last == 2 { a.z -> R friction { resistance: 1.0 }; }
    output law = law;
    output count = count;
}";

#[test]
fn statements_are_chosen_at_compile_time() {
    let model = |call: &str| {
        flat(&format!(
            "{CHOICES} model M {{ 1 a[3] {{ I m {{ inertia: 1.0 }} }} {call} }}"
        ))
    };
    insta::assert_snapshot!(model("h: Hinge (a);"), @"
    a -> m [3]
    state m.p.x = 0
    state m.p.y = 0
    state m.p.z = 0
    output h.law = 0
    output h.count = 1
    ");
    insta::assert_snapshot!(model("h: Hinge { axis: 1, stiffness: 5.0, blocked: compliant } (a);"), @"
    a -> m [3]
    a.y -> h.spring [1]
    a.x -> h.k[0].wall [1]
    a.z -> h.k[2].wall [1]
    state m.p.x = 0
    state m.p.y = 0
    state m.p.z = 0
    state h.spring.q = 0
    state h.k[0].wall.q = 0
    state h.k[2].wall.q = 0
    output h.law = Signal(0)
    output h.count = 3
    ");
    insta::assert_snapshot!(model("for k in 2..3 { h: Hinge { axis: k, stiffness: 5.0 } (a); }"), @"
    a -> m [3]
    a.z -> k[2].h.soft [1]
    state m.p.x = 0
    state m.p.y = 0
    state m.p.z = 0
    state k[2].h.soft.q = 0
    output k[2].h.law = Signal(0)
    output k[2].h.count = 1
    ");
}

#[test]
fn a_choice_and_what_is_not_given_are_handed_on() {
    let text = format!(
        "{CHOICES} component Both(port a[3]) {{
        param blocked: ideal | compliant;
        param stiffness = 1.0;
        h: Hinge {{ blocked: blocked, stiffness: stiffness }} (a);
    }}
    model M {{ 1 a[3] {{ I m {{ inertia: 1.0 }} }} b: Both {{ blocked: compliant }} (a); }}"
    );
    insta::assert_snapshot!(flat(&text), @"
    a -> m [3]
    a.y -> b.h.k[1].wall [1]
    a.z -> b.h.k[2].wall [1]
    state m.p.x = 0
    state m.p.y = 0
    state m.p.z = 0
    state b.h.k[1].wall.q = 0
    state b.h.k[2].wall.q = 0
    output b.h.law = 0
    output b.h.count = 3
    ");
}

#[test]
fn raw_names_are_the_names() {
    let text =
        "model M { param r#type = 1.0; 1 a { I r#m { inertia: type_ } C c { stiffness: r#type } }
        let type_ = 2.0 * (r#type); output r#in = r#c.q + m.p; }";
    insta::assert_snapshot!(flat(text), @"
    a -> m [1]
    a -> c [1]
    state m.p = 0
    state c.q = 0
    output in = c.q + m.p
    ");
}

/// Formatting pads to 65,535 characters.
#[test]
fn names_may_be_of_any_length() {
    let name = "a".repeat(70_000);
    let text = format!("model M {{ 1 {name} {{ I m {{ inertia: 1.0 }} }} 1 b; {name} -> b; }}");
    let mut diagnostics = Diagnostics::new();
    let code = items(text.parse().unwrap(), &mut diagnostics);
    assert!(!diagnostics.any(), "{:?}", diagnostics.list());
    let code = code.behaviour.to_string();
    assert!(code.contains(&format!("\\n{name} ")));
}

#[test]
fn mistakes_in_choices_are_told() {
    insta::assert_snapshot!(mistake("if n > 2 { 1 b; } a.x -> b;"), @"
    2:4 expected a condition that is decided while the model is compiled, found `n > 2` [MBG0220]
      help: it compares whole numbers that are known then, or a parameter with one of its words, as in `blocked == ideal`
      help: it may ask `given(parameter)`, and join conditions by `&&`, `||` and `!`
    ");
    insta::assert_snapshot!(mistake("if given(n) { 1 b; }"), @"2:10 `n` is no parameter of this component [MBG0203]");
    insta::assert_snapshot!(mistake("for k in 0..2 { for j in 0..k { if j + n == 2 { 1 b; } } }"), @"
    2:36 expected a condition that is decided while the model is compiled, found `j + n == 2` [MBG0220]
      help: it compares whole numbers that are known then, or a parameter with one of its words, as in `blocked == ideal`
      help: it may ask `given(parameter)`, and join conditions by `&&`, `||` and `!`
    ");
    insta::assert_snapshot!(mistake("param way: left | right = left; if way == right { 1 b; }"), @"2:7 a choice of words belongs to a component, whose instances choose [MBG0213]");
    insta::assert_snapshot!(mistake("if 1 == 1 { input u; gravity [0.0, 0.0, -u]; let b = a.f.x; output b = b; } else { nonsense -> more; output b = 1.0; }"), @"");
    insta::assert_snapshot!(mistake("if 1 == 2 { 1 b; a.x -> b; } a.x -> b;"), @"
    2:37 `b` is not declared [MBG0203]
      help: junctions here are `a`
    ");
}

#[test]
fn mistakes_in_calls_of_choices_are_told() {
    let mistake = |call: &str, inside: &str| {
        let text = format!(
            "component C(port a[3]) {{ param way: left | right; param n = 1;\n {inside} }}
model M {{ 1 a[3] {{ I m {{ inertia: 1.0 }} }}
{call} }}"
        );
        elaborated(&text).err().unwrap_or_default()
    };
    insta::assert_snapshot!(mistake("c: C { way: lift } (a);", ""), @"
    4:13 expected `left` or `right`, found `lift` [MBG0219]
      help: did you mean `left`?
    ");
    insta::assert_snapshot!(mistake("c: C { way: 2.0 } (a);", ""), @"4:13 expected `left` or `right`, found `2.0` [MBG0219]");
    insta::assert_snapshot!(mistake("c: C { way } (a);", ""), @"
    4:1 `C` needs a value for `way` [MBG0214]
      help: write `{ way: left | right }`
    ");
    insta::assert_snapshot!(mistake("c: C (a);", ""), @"
    4:1 `C` needs a value for `way` [MBG0214]
      help: write `{ way: left | right }`
    ");
    insta::assert_snapshot!(mistake("c: C { wya: left } (a);", ""), @"
    4:8 `C` has no parameter `wya` [MBG0207]
      help: did you mean `way`?
      help: its parameters are `n`, `way`
    ");
    insta::assert_snapshot!(mistake("c: C { way: left } (a);", "if way == rihgt { }"), @"
    2:12 expected `left` or `right`, found `rihgt` [MBG0219]
      help: did you mean `right`?
    ");
    insta::assert_snapshot!(mistake("c: C { way: left } (a);", "if way < right { }"), @"
    2:5 expected a condition that is decided while the model is compiled, found `way < right` [MBG0220]
      help: it compares whole numbers that are known then, or a parameter with one of its words, as in `blocked == ideal`
      help: it may ask `given(parameter)`, and join conditions by `&&`, `||` and `!`
    ");
    insta::assert_snapshot!(mistake("c: C { way: left } (a);", "if given(m) { }"), @"2:11 `m` is no parameter of this component [MBG0203]");
    insta::assert_snapshot!(mistake("c: C { way: left } (a);", "output y = way;"), @"2:13 `way` is a word and no number; ask `if way == …` [MBG0213]");
    insta::assert_snapshot!(mistake("c: C { way: left } (a);", "output y = if way == up { 1.0 } else { 2.0 };"), @"2:23 expected `left` or `right`, found `up` [MBG0219]");
}

#[test]
fn mistakes_in_loops_are_told() {
    insta::assert_snapshot!(mistake("links: for k in 0..2 { 1 b; a.x -> b; } a.x -> lings[0].b;"), @"
    2:48 `lings[0].b` is not declared [MBG0203]
      help: did you mean `links`?
    ");
    insta::assert_snapshot!(mistake("links: for k in 0..2 { 1 b; a.x -> b; } links[2].b -> a.x;"), @"2:41 `links` runs over 0..2, there is no `links[2]` [MBG0203]");
    insta::assert_snapshot!(mistake("links: for k in 0..2 { let v = links[k-1].v; }"), @"
    2:38 `links` runs over 0..2, there is no `links[-1]` [MBG0203]
      help: where there is none, nothing is written: `if k > 0 { … }` around the statement
    ");
    insta::assert_snapshot!(mistake("links: for k in 0..2 { let v = 1.0; } output y = links.v;"), @"2:50 `links` is a loop; write `links[0]` for its first iteration [MBG0203]");
    insta::assert_snapshot!(mistake("links: for k in 0..2 { let v = 1.0; } output y = links[a].v;"), @"
    2:56 expected a whole number that is known while the model is compiled, found `a` [MBG0217]
      help: it is made of integers, variables of loops, values given by `let`, and parameters of a component that are given as integers
      help: a `param` of a model is no such number, because it can change after the model is compiled
    ");
    insta::assert_snapshot!(mistake("for k in 0..2 { 1 b; } a.x -> b;"), @"
    2:31 `b` is not declared [MBG0203]
      help: give the loop a name, `cells: for k in 0..2 { … }`, and write `cells[0].b`
    ");
    insta::assert_snapshot!(mistake("for k in 0..n { 1 b; }"), @"
    2:13 expected a whole number that is known while the model is compiled, found `n` [MBG0217]
      help: a `param` of a model can change after the model is compiled: declare `let n = 3;` in its place
    ");
    insta::assert_snapshot!(mistake("for k in 0..2.0 { 1 b; }"), @"
    2:13 expected a whole number that is known while the model is compiled, found `2.0` [MBG0217]
      help: a whole number has no decimal point: write `2`
    ");
    insta::assert_snapshot!(mistake("for k in 0..5 / 2 { 1 b; }"), @"
    2:13 expected a whole number, found `5 / 2`, which is 2.5 [MBG0217]
      help: its whole part is `(5 - 5 % 2) / 2`
    ");
    insta::assert_snapshot!(mistake("let z = 4000000000; for k in 0..z*z { 1 b; }"), @"2:33 expected a whole number, found `z * z`, which is beyond the largest, 9223372036854775807 [MBG0217]");
    insta::assert_snapshot!(mistake("for k in 0..1/0 { 1 b; }"), @"2:13 expected a whole number, found `1 / 0`, which divides by zero [MBG0217]");
    insta::assert_snapshot!(mistake("output y = a.f[18446744073709551616];"), @"2:16 expected a whole number, found `18446744073709551616`, which is beyond the largest, 9223372036854775807 [MBG0217]");
    insta::assert_snapshot!(mistake("output y = a.f[1e3];"), @"
    2:16 expected a whole number that is known while the model is compiled, found `1e3` [MBG0217]
      help: a whole number has no decimal point: write `1000`
    ");
    insta::assert_snapshot!(mistake("for k in 0..4 { a[k] -> R r { resistance: 1.0 }; }"), @"
    2:17 `a` has 3 components, `a[k]` asks for more [MBG0204]
      help: they are counted from 0: the last is `a[2]`
    ");
    insta::assert_snapshot!(mistake("a[2..1] -> R r { resistance: 1.0 };"), @"2:1 `a[2..1]` selects no component [MBG0204]");
    insta::assert_snapshot!(mistake("output y = a.f[3];"), @"
    2:16 component 3 of a vector of 3 does not exist [MBG0204]
      help: they are counted from 0: the last is `[2]`
    ");
    insta::assert_snapshot!(mistake("output y[2] = a.f[2..4];"), @"
    2:19 components 2..4 of a vector of 3 do not exist [MBG0204]
      help: they are counted from 0: the last is `[2]`
    ");
    insta::assert_snapshot!(mistake("for k in 0..2 { param p = 1.0; input u; gravity 1.0; }"), @"
    2:23 a parameter belongs to a model or a component; in a loop, use `let` [MBG0213]
    2:38 an input belongs to a model; give a component a parameter or a port [MBG0213]
    2:41 `gravity` belongs to a model, all of whose components see it [MBG0213]
    ");
    insta::assert_snapshot!(mistake("for k in 0..2 { 1 k; }"), @"2:19 `k` is declared twice [MBG0202]");
}

#[test]
fn mistakes_in_values_are_told() {
    insta::assert_snapshot!(mistake("let p = q + 1; let q = r; let r = 2 * p; let s = p; output y = s;"), @"
    2:5 `p` is defined by itself [MBG0218]
      each needs the next: `p`, `q`, `r`, `p`
    ");
    insta::assert_snapshot!(mistake("let p[2] = [1.0, 2.0, 3.0]; output y = p.x;"), @"2:5 `p` has dimension 2, found a vector of 3 [MBG0204]");
    insta::assert_snapshot!(mistake("let p = nowhere;"), @"2:9 `nowhere` is not declared [MBG0203]");
    insta::assert_snapshot!(mistake("let p = 1.0; let p = 2.0;"), @"2:18 `p` is declared twice [MBG0202]");
    insta::assert_snapshot!(mistake("let p = 1.0; p -> a;"), @"
    2:14 expected a junction or an element, found `p` [MBG0203]
      help: a value is no bond, and comes from a source: `Se p_source { effort: p }` or `Sf p_source { flow: p }` in its place
    ");
}

#[test]
fn mistakes_with_gravity_are_told() {
    insta::assert_snapshot!(mistake("gravity [0.0, 1.0]; a -> Se w { effort: 2.0 * gravity };"), @"2:41 expected a number or a vector of 3, found a vector of 2 [MBG0204]");
    insta::assert_snapshot!(mistake("gravity 1.0; gravity 2.0;"), @"2:14 `gravity` is given twice [MBG0202]");
    insta::assert_snapshot!(mistake("param gravity = 9.81;"), @"
    2:7 `gravity` is the acceleration of free fall and names nothing else [MBG0202]
      help: `gravity [0.0, 0.0, -9.81];` gives it its value
    ");
    let text = |gravity: &str, body: &str| {
        format!(
            "model M {{ {gravity} 1 a[6]; body: Body {{ mass: 1.0, inertia: 1.0, {body} }} (a); }}"
        )
    };
    let told = |text: String| elaborated(&text).err().unwrap_or_default();
    insta::assert_snapshot!(told(text("gravity -9.81;", "gravity_at: gravity")), @"
    1:72 `gravity_at` has dimension 3, found a number [MBG0204]
      help: write `gravity [0.0, 0.0, -9.81];` in the model
    ");
    insta::assert_snapshot!(told(text("", "centre: 0.5")), @"
    1:58 `centre` has dimension 3, found a number [MBG0204]
      help: write each component, such as `[0.5, 0.5, 0.5]`
    ");
    insta::assert_snapshot!(mistake("gravity [gravity, 1.0];"), @"
    2:1 `gravity` is defined by itself [MBG0218]
      each needs the next: `gravity`, `gravity`
    ");
}

#[test]
fn the_size_of_loops_is_known_before_they_are_built() {
    let nested = "for i in 0..1000000 { for j in 0..1000000 { a.x -> R r { resistance: 1.0 }; } }";
    insta::assert_snapshot!(mistake(nested), @"
    2:35 `M` has too many instances and iterations of loops, the limit is 4096 [MBG0601]
      help: split the scene into models that exchange inputs and outputs
    ");
    let dependent = "for i in 0..1000000 { for j in 0..i { for k in 0..j {} } }";
    insta::assert_snapshot!(mistake(dependent), @"
    2:13 `M` has too many instances and iterations of loops, the limit is 4096 [MBG0601]
      help: split the scene into models that exchange inputs and outputs
    ");
    let side_by_side = "for i in 0..4000 {} for j in 0..4000 {}";
    insta::assert_snapshot!(mistake(side_by_side), @"
    1:7 `M` has too many instances and iterations of loops, the limit is 4096 [MBG0601]
      help: split the scene into models that exchange inputs and outputs
    ");
    let many = "for i in 0..2000 { a.x -> R r { resistance: 1.0 } -> a.y; R s { resistance: 1.0 } -> a.x; }";
    insta::assert_snapshot!(mistake(many), @"
    1:7 `M` has 6001 vector bonds, the limit is 4096 [MBG0601]
      help: split the scene into models that exchange inputs and outputs
    ");
    assert_eq!(
        mistake("for i in 0..0 { for j in 0..1000000000 { 1 b; } }"),
        ""
    );
}

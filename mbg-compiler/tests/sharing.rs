//! Values that read the one before them twice: looked at once each, they take no time; along each way to them, forever.

mod models;

/// So many in a row that nothing could go along all of 2⁴⁰ ways.
const COUNT: usize = 40;

/// A damper of which the law is made of a row of values, each of which reads the one before it as `next` says.
fn row(unit: &str, first: &str, law: &str, next: &str) -> String {
    let mut text = format!(
        "model Row {{
            input push{unit};
            1 rate {{
                I mass {{ inertia: 1.0 }}
                C spring {{ stiffness: 3.0 }}
                R damper {{ effort: {} }}
                Se drive {{ effort: push }}
            }}
            let v0 = {first};\n",
        law.replace('v', &format!("v{COUNT}"))
    );
    for number in 1..=COUNT {
        let value = next.replace('v', &format!("v{}", number - 1));
        text += &format!("let v{number} = {value};\n");
    }
    text + "output way = spring.q; }"
}

#[test]
fn a_unit_that_is_not_declared_is_looked_for_once_in_each_value() {
    models::compiled(&row(
        ": N",
        "1.0 * rate.f",
        "1.0 * v",
        "0.4 * v + 0.1 * v * cos(1.0 * v)",
    ));
}

#[test]
fn a_unit_that_does_not_agree_is_told() {
    let told = models::attempted(&row(
        ": N",
        "rate.f",
        "v",
        "sin(v) + 0.1 * cos(v * spring.q)",
    ));
    assert!(told.err().is_some_and(|codes| codes.contains(&"MBG0501")));
}

#[test]
fn the_slope_of_a_root_asks_each_value_once_whether_it_may_vanish() {
    models::compiled(&row("", "rate.f", "sqrt(v)", "v + 0.1 * sin(v) * v"));
    models::compiled(&row(
        "",
        "rate.f",
        "v",
        "sqrt(v * v + 1.0) + v / (1.0 + v * v)",
    ));
}

#[test]
fn the_exponential_of_a_product_asks_each_factor_once_for_logarithms() {
    models::compiled(&row("", "rate.f", "exp(v)", "(v + 0.3) * (v - 0.7)"));
}

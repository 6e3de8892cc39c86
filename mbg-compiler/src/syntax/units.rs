//! Units: `kg*m^2/s`, `N/(m*s)`, `1/s`.

use syn::parse::ParseStream;
use syn::{Ident, LitInt, Token, token};

use super::ast::Unit;

/// Reads a unit up to the token that no unit holds.
pub(super) fn unit(input: ParseStream) -> syn::Result<Unit> {
    let mut unit = Unit {
        text: String::new(),
        factors: Vec::new(),
    };
    product(input, &mut unit, 1)?;
    Ok(unit)
}

fn product(input: ParseStream, unit: &mut Unit, sign: i32) -> syn::Result<()> {
    factor(input, unit, sign)?;
    loop {
        if input.peek(Token![*]) {
            input.parse::<Token![*]>()?;
            unit.text.push('*');
            factor(input, unit, sign)?;
        } else if input.peek(Token![/]) {
            input.parse::<Token![/]>()?;
            unit.text.push('/');
            factor(input, unit, -sign)?;
        } else {
            return Ok(());
        }
    }
}

fn factor(input: ParseStream, unit: &mut Unit, sign: i32) -> syn::Result<()> {
    if input.peek(token::Paren) {
        let content;
        syn::parenthesized!(content in input);
        unit.text.push('(');
        product(&content, unit, sign)?;
        unit.text.push(')');
        return if content.is_empty() {
            Ok(())
        } else {
            Err(content.error("expected `*`, `/` or `)` in a unit"))
        };
    }
    if input.peek(LitInt) {
        let one: LitInt = input.parse()?;
        unit.text.push('1');
        return if one.base10_digits() == "1" {
            Ok(())
        } else {
            Err(syn::Error::new(
                one.span(),
                "expected the name of a unit or `1`, found another number",
            ))
        };
    }
    let name: Ident = input
        .parse()
        .map_err(|error| syn::Error::new(error.span(), "expected the name of a unit"))?;
    unit.text.push_str(&name.to_string());
    let exponent = if input.peek(Token![^]) {
        exponent(input, unit)?
    } else {
        1
    };
    unit.factors.push((name.to_string(), sign * exponent));
    Ok(())
}

fn exponent(input: ParseStream, unit: &mut Unit) -> syn::Result<i32> {
    input.parse::<Token![^]>()?;
    let negative = input.parse::<Option<Token![-]>>()?.is_some();
    let digits: LitInt = input
        .parse()
        .map_err(|error| syn::Error::new(error.span(), "expected an integer exponent"))?;
    let value: i32 = digits.base10_parse()?;
    let value = if negative { -value } else { value };
    unit.text.push_str(&format!("^{value}"));
    Ok(value)
}

//! Text and numbers, byte by byte: the formatting of `core` can panic.

use crate::machine;

pub(crate) fn text(text: &str) {
    text.bytes().for_each(machine::write);
}

pub(crate) fn line(line: &str) {
    text(line);
    machine::write(b'\n');
}

/// A whole number, filled up with blanks to `width`.
pub(crate) fn integer(number: u64, width: usize) {
    digits(number, width, b' ');
}

fn digits(number: u64, width: usize, fill: u8) {
    let mut buffer = [fill; 20];
    let (mut rest, mut length) = (number, 0);
    for place in buffer.iter_mut().rev() {
        *place = b'0' + (rest % 10) as u8;
        rest /= 10;
        length += 1;
        if rest == 0 {
            break;
        }
    }
    let unused = 20_usize.saturating_sub(width.max(length));
    buffer
        .iter()
        .skip(unused)
        .for_each(|digit| machine::write(*digit));
}

/// A number below a million in nine decimals.
pub(crate) fn decimal(number: f64) {
    let billionths = (number.abs() * 1e9 + 0.5) as u64;
    let whole = billionths / 1_000_000_000;
    text(if number < 0.0 { "  -" } else { "   " });
    digits(whole, 1, b' ');
    machine::write(b'.');
    digits(billionths % 1_000_000_000, 9, b'0');
}

/// A number of at least zero in two digits and a power of ten.
pub(crate) fn scientific(mut number: f64) {
    let mut exponent = 0_u64;
    while number < 1.0 && exponent < 99 {
        number *= 10.0;
        exponent += 1;
    }
    let tenths = (number * 10.0 + 0.5) as u64;
    digits(tenths / 10, 1, b' ');
    machine::write(b'.');
    digits(tenths % 10, 1, b'0');
    text("e-");
    digits(exponent, 1, b' ');
}

/// Sixteen hexadecimal digits.
pub(crate) fn bits(bits: u64) {
    for place in (0..16).rev() {
        let digit = (bits >> (4 * place)) as u8 & 0xF;
        machine::write(if digit < 10 {
            b'0' + digit
        } else {
            b'a' + digit - 10
        });
    }
}

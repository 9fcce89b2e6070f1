//! Numbers, vectors and polynomials as text. Decimals are the shortest that read back as the same
//! bits.

use std::fmt::Write;

use nalgebra::DMatrix;

use super::system::{Factor, Polynomial};

/// Largest number of columns of a comment.
const WIDTH: usize = 96;

/// Number of terms that one line of a long sum holds.
const TERMS_PER_LINE: usize = 4;

/// Returns a number in the fewest digits that read back as the same bits.
pub(super) fn number(x: f64) -> String {
    format!("{x:?}")
}

/// Returns numbers, separated by `separator`.
pub(super) fn numbers(values: impl IntoIterator<Item = f64>, separator: &str) -> String {
    values.into_iter().map(number).collect::<Vec<_>>().join(separator)
}

/// Returns the rows of a matrix, each between `open` and `close`, one per line.
pub(super) fn rows(matrix: &DMatrix<f64>, [open, between, close]: [&str; 3]) -> String {
    let row =
        |i: usize| format!("  {open}{}{close}\n", numbers(matrix.row(i).iter().copied(), between));
    (0..matrix.nrows()).map(row).collect()
}

/// Returns a name without what would end a comment or a string: control characters, quotes and
/// backslashes become underscores.
pub(super) fn harmless(name: &str) -> String {
    let ends = |c: char| c.is_control() || matches!(c, '"' | '\\' | '\u{2028}' | '\u{2029}');
    name.chars().map(|c| if ends(c) { '_' } else { c }).collect()
}

/// Returns paragraphs as comment lines of at most [`WIDTH`] columns that start with `mark`.
pub(super) fn comment(mark: &str, paragraphs: &[String]) -> String {
    let mut text = String::new();
    for paragraph in paragraphs {
        let mut line = mark.to_owned();
        for word in paragraph.split(' ') {
            if line.len() + word.len() >= WIDTH {
                let _ = writeln!(text, "{}", line.trim_end());
                line = mark.to_owned();
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line += word;
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// Returns the terms of a polynomial, each with its sign: `+ 1.5*qd1^2*(u1 - 0.25)`. `name` gives
/// the text of a variable.
pub(super) fn terms(polynomial: &Polynomial, name: &dyn Fn(usize) -> String) -> Vec<String> {
    let of = |term: &super::system::Term| {
        let sign = if term.coefficient.is_sign_negative() { '-' } else { '+' };
        let factors: String =
            term.factors.iter().map(|f| format!("*{}", factor(f, name))).collect();
        format!("{sign} {}{factors}", number(term.coefficient.abs()))
    };
    polynomial.terms.iter().map(of).collect()
}

fn factor(factor: &Factor, name: &dyn Fn(usize) -> String) -> String {
    let name = name(factor.variable);
    let mut text = match factor.origin {
        0.0 => name,
        origin if origin > 0.0 => format!("({name} - {})", number(origin)),
        origin => format!("({name} + {})", number(-origin)),
    };
    if factor.power > 1 {
        let _ = write!(text, "^{}", factor.power);
    }
    text
}

/// Returns a sum on lines of its own, each ended by `end`; "0.0" if there are no terms.
pub(super) fn sum(terms: &[String], end: &str) -> String {
    if terms.is_empty() {
        return "0.0".into();
    }
    let lines: Vec<String> = terms.chunks(TERMS_PER_LINE).map(|chunk| chunk.join(" ")).collect();
    lines.join(&format!("{end}\n    "))
}

//! Cells of CSV tables that a spreadsheet must not run: text of strangers stays text, and can be had back as it was.
//!
//! A spreadsheet runs a cell that begins with `=`, `+`, `-`, `@`, a tab or a line break as a formula, whatever quotes the
//! CSV has around it (OWASP, "CSV injection"). Such a text gets an apostrophe in front, which spreadsheets take as "this
//! is text". So does one that begins with apostrophes and goes on like that, or nobody could tell which apostrophe is
//! ours. A plain number, such as `-0.5`, is no formula and stays.

use std::borrow::Cow;

/// What turns a text into an inert cell and back.
const MARK: char = '\'';

/// Whether a spreadsheet would run the text, behind any apostrophes.
fn is_formula(text: &str) -> bool {
    let begins = |c: char| {
        matches!(c, '=' | '+' | '-' | '@' | '\t' | '\r' | '\n' | '\u{ff1d}' | '\u{ff0b}' | '\u{ff0d}' | '\u{ff20}')
    };
    text.trim_start_matches(MARK).starts_with(begins) && !is_number(text)
}

/// Digits with a sign, a point or an exponent: `inf` and `nan` are names to a spreadsheet.
fn is_number(text: &str) -> bool {
    text.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'e' | b'E'))
        && text.parse::<f64>().is_ok()
}

/// A text without what a terminal obeys or turns round when a table is looked at there: control characters but line breaks and tabs,
/// and marks of direction. Each becomes one replacement character.
pub fn visible(text: &str) -> Cow<'_, str> {
    let turns =
        |c: char| matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let odd = |c: char| turns(c) || c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    if text.contains(odd) { Cow::Owned(text.replace(odd, "\u{fffd}")) } else { Cow::Borrowed(text) }
}

/// A text as a cell of a CSV table.
pub fn inert(text: &str) -> Cow<'_, str> {
    if is_formula(text) { Cow::Owned(format!("{MARK}{text}")) } else { Cow::Borrowed(text) }
}

/// The text that a cell was made of.
pub fn original(cell: &str) -> &str {
    match cell.strip_prefix(MARK) {
        Some(text) if is_formula(text) => text,
        _ => cell,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_not_in_a_cell() {
        assert_eq!(visible("a\u{1b}[31m\u{202e}b\u{7f}\tc\nd"), "a\u{fffd}[31m\u{fffd}b\u{fffd}\tc\nd");
        assert!(matches!(visible("plain \u{e9}"), Cow::Borrowed(_)));
    }

    #[test]
    fn formulas_become_text_and_everything_comes_back() {
        for formula in [
            "=cmd|' /C calc'!A0",
            "+1+1",
            "-2+3",
            "@SUM(A1)",
            "\t=1",
            "\r=1",
            "\n=1",
            "\u{ff1d}1",
            "'=1",
            "''-x",
            "-",
            "-inf",
        ] {
            assert_eq!(inert(formula), format!("'{formula}"), "{formula}");
        }
        for plain in ["", "a=1", "-0.5", "+1e3", "it's", "'quoted'", "'", " =1", "3 - 2", "'-0"] {
            let cell = inert(plain);
            assert_eq!(original(&cell), plain, "{plain}");
        }
        for text in ["=1", "'=1", "''=1", "'", "-0.5", "'-0.5", "''-0.5", "\t", "'\t", "-x"] {
            assert_eq!(original(&inert(text)), text);
        }
        assert_eq!(inert("-0.5"), "-0.5");
    }
}

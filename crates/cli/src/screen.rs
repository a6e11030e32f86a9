//! The one way to the screen: everything that is printed for people goes through here, and is clean.
//!
//! Names, records and answers of models are written by strangers, and a terminal obeys what is printed. So control
//! characters are printed as their codes, whoever wrote them; colours of our own are put in afterwards. A standard output
//! that nobody reads any more is silently written no further; one that cannot be written ends the run with an error.

use std::fmt;
use std::hash::{BuildHasher, RandomState};
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Columns where there is no terminal to ask.
const WIDTH_WITHOUT_TERMINAL: usize = 100;
/// Narrower than this nothing can be shown.
const LEAST_WIDTH: usize = 40;

/// Why the standard output could not be written, the first time.
static FAILED: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// Prints a line for people on the standard output.
macro_rules! print_line {
    ($($text:tt)*) => { $crate::screen::out(format_args!($($text)*)) };
}

/// Prints a line for people on the standard error.
macro_rules! print_error_line {
    ($($text:tt)*) => { $crate::screen::error(format_args!($($text)*)) };
}

pub(crate) use {print_error_line as eprintln, print_line as println};

/// Prints a line on the standard output.
pub fn out(text: fmt::Arguments<'_>) {
    let line = format!("{}\n", clean(&text.to_string()));
    written(anstream::stdout().write_all(line.as_bytes()));
}

/// Prints a line on the standard error. That nobody can read it is no reason to stop.
pub fn error(text: fmt::Arguments<'_>) {
    let _ = writeln!(anstream::stderr(), "{}", clean(&text.to_string()));
}

/// Prints a sentence for people on the standard output. On a terminal it is broken between words, and goes on a step further in.
pub fn sentence(text: &str) {
    out(format_args!("{}", broken(text, told_width())));
}

/// A sentence in lines of this width, where there is one.
fn broken(text: &str, width: Option<usize>) -> String {
    let indent = " ".repeat(text.len() - text.trim_start().len() + 2);
    let (mut broken, mut column) = (String::new(), 0);
    for word in text.split_inclusive(' ') {
        let length = word.chars().count();
        if column > indent.len() && width.is_some_and(|width| column + word.trim_end().chars().count() > width) {
            broken.truncate(broken.trim_end().len());
            broken.push('\n');
            broken.push_str(&indent);
            column = indent.len();
        }
        broken.push_str(word);
        column += length;
    }
    broken
}

/// Writes for programs on the standard output, as it is.
pub fn raw(bytes: &[u8]) {
    written(std::io::stdout().write_all(bytes));
}

/// Remembers whether something was written on the standard output.
pub fn written(result: std::io::Result<()>) {
    if let Err(error) = result {
        FAILED.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}

/// Whether everything was printed, at the end of a run. A reader that has seen enough (`| head`) is no error.
///
/// # Errors
/// The standard output could not be written.
pub fn finish() -> std::io::Result<()> {
    written(std::io::stdout().flush());
    match FAILED.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// Columns of the terminal; those of the variable `COLUMNS` where it is set.
pub fn width() -> usize {
    told_width().unwrap_or(WIDTH_WITHOUT_TERMINAL)
}

/// The same, where there is a terminal or the variable.
fn told_width() -> Option<usize> {
    let set = std::env::var("COLUMNS").ok().and_then(|columns| columns.trim().parse().ok());
    let asked = || terminal_size::terminal_size_of(std::io::stdout()).map(|(width, _)| usize::from(width.0));
    set.or_else(asked).filter(|columns| *columns > 0).map(|columns| columns.max(LEAST_WIDTH))
}

/// Text in a colour or weight.
pub struct Painted<T>(T, &'static str);

impl<T: fmt::Display> fmt::Display for Painted<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{0}{1}m{2}{0}0m", mark(), self.1, self.0)
    }
}

/// Bold text.
pub fn bold<T: fmt::Display>(text: T) -> Painted<T> {
    Painted(text, "1")
}

/// Dim text.
pub fn dim<T: fmt::Display>(text: T) -> Painted<T> {
    Painted(text, "2")
}

/// Red text.
pub fn red<T: fmt::Display>(text: T) -> Painted<T> {
    Painted(text, "31")
}

/// Yellow text.
pub fn yellow<T: fmt::Display>(text: T) -> Painted<T> {
    Painted(text, "33")
}

/// Stands for the beginning of an escape sequence of our own until the text is clean. Nobody outside can know it, because
/// it is another one in every run.
fn mark() -> &'static str {
    static MARK: OnceLock<String> = OnceLock::new();
    MARK.get_or_init(|| format!("\u{fdd0}{:016x}", RandomState::new().hash_one(0)))
}

/// Whether a terminal obeys a character, or shows the text around it in another order.
fn is_unsafe(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

/// A text with the codes of unsafe characters in their place, and our own colours.
fn clean(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        if is_unsafe(c) && !matches!(c, '\n' | '\t') {
            safe.extend(c.escape_unicode());
        } else {
            safe.push(c);
        }
    }
    safe.replace(mark(), "\u{1b}[")
}

/// A stranger's text that must not begin a line of its own.
pub fn one_line(text: &str) -> String {
    let flat = |c: char| if matches!(c, '\n' | '\t' | '\r') { ' ' } else { c };
    text.chars().map(flat).flat_map(|c| if is_unsafe(c) { c.escape_unicode().collect() } else { vec![c] }).collect()
}

/// A text as it looks without colours.
#[cfg(test)]
pub fn plain(text: &str) -> String {
    anstream::adapter::strip_str(&clean(text)).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_are_broken_between_words_where_there_is_a_width() {
        let text = "  one two three four";
        assert_eq!(broken(text, None), text);
        assert_eq!(broken(text, Some(11)), "  one two\n    three\n    four");
        assert_eq!(broken("averyverylongword next", Some(8)), "averyverylongword\n  next");
    }

    #[test]
    fn a_stranger_s_escapes_are_told_and_our_colours_stay() {
        let hostile = "\u{1b}]0;owned\u{7}\u{9b}31m\u{202e}x\r\u{fdd0}31m";
        let shown = clean(&format!("{} {hostile}", red("error:")));
        assert!(shown.starts_with("\u{1b}[31merror:\u{1b}[0m \\u{1b}]0;owned\\u{7}"), "{shown}");
        assert_eq!(shown.matches('\u{1b}').count(), 2, "{shown}");
        assert!(!shown.contains(['\u{7}', '\u{9b}', '\u{202e}', '\r']), "{shown}");
        assert_eq!(one_line("a\nb\tc\u{1b}"), "a b c\\u{1b}");
    }
}

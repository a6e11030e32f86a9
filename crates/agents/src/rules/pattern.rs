//! Text patterns that are compiled when they are first used.

use regex::Regex;
use std::ops::Deref;
use std::sync::OnceLock;

/// A constant regular expression.
pub struct Pattern {
    text: &'static str,
    compiled: OnceLock<Regex>,
}

impl Pattern {
    pub const fn new(text: &'static str) -> Self {
        Self { text, compiled: OnceLock::new() }
    }
}

impl Deref for Pattern {
    type Target = Regex;

    fn deref(&self) -> &Regex {
        self.compiled.get_or_init(|| Regex::new(self.text).expect("constant pattern"))
    }
}

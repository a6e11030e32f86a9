//! Claims as a goal structure (GSN): goals, strategies, solutions, contexts, assumptions.

use super::number::{Number, find};
use serde::Serialize;

/// One element of the structure.
#[derive(Debug, Serialize)]
pub struct Claim {
    id: String,
    /// `goal`, `strategy`, `solution`, `context`, `assumption` or `undeveloped`.
    kind: &'static str,
    /// With the names of numbers in braces.
    template: String,
    /// With the numbers.
    text: String,
    numbers: Vec<String>,
    supported_by: Vec<String>,
    in_context_of: Vec<String>,
}

/// Makes claims with numbers.
pub struct Structure<'a> {
    numbers: &'a [Number],
    claims: Vec<Claim>,
}

impl<'a> Structure<'a> {
    /// Without a claim.
    pub fn new(numbers: &'a [Number]) -> Self {
        Self { numbers, claims: Vec::new() }
    }

    /// Adds an element: its template has the names of numbers in braces.
    pub fn add(&mut self, id: &str, kind: &'static str, template: &str, supported_by: &[&str], in_context_of: &[&str]) {
        let names: Vec<String> = template
            .split('{')
            .skip(1)
            .filter_map(|rest| rest.split_once('}'))
            .map(|(name, _)| name.to_owned())
            .collect();
        let text = names.iter().fold(template.to_owned(), |text, name| {
            let shown = find(self.numbers, name).map_or("?", |number| number.shown.as_str());
            text.replace(&format!("{{{name}}}"), shown)
        });
        let owned = |ids: &[&str]| ids.iter().map(|id| (*id).to_owned()).collect();
        self.claims.push(Claim {
            id: id.to_owned(),
            kind,
            template: template.to_owned(),
            text,
            numbers: names,
            supported_by: owned(supported_by),
            in_context_of: owned(in_context_of),
        });
    }
    /// All of them, in the order in which they were added.
    pub fn claims(self) -> Vec<Claim> {
        self.claims
    }
}

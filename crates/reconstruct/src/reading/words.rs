//! The words of a fact, and where they stand.

use recrash_model::account::{ActFact, Other, Source};

pub(super) fn before_contact(other: &Other) -> impl Iterator<Item = &ActFact> {
    other.acts.iter().filter(|fact| !fact.after_contact && !fact.begun)
}

/// Where the words of a fact stand.
pub(super) fn span(source: &Source) -> Option<(usize, usize)> {
    match source {
        Source::Words { start, end, .. } => Some((*start, *end)),
        _ => None,
    }
}

pub(super) fn text(source: &Source) -> String {
    match source {
        Source::Words { text, .. } => text.to_lowercase(),
        _ => String::new(),
    }
}

//! Words that name a town, a street or a building, and nobody.

use super::{Article, Chunker, DETERMINERS, Noun};
use crate::token::TokenKind;

/// What is called by names that makes have too: "Lincoln Boulevard".
const PLACES: [&str; 20] = [
    "airport",
    "boulevard",
    "blvd",
    "street",
    "st",
    "avenue",
    "ave",
    "road",
    "rd",
    "drive",
    "dr",
    "parkway",
    "way",
    "terminal",
    "highway",
    "park",
    "plaza",
    "lane",
    "center",
    "court",
];

impl Chunker<'_> {
    /// "South Van Ness".
    pub(super) fn names_a_street(&self, noun: &Noun, first: usize, length: usize) -> bool {
        noun.article == Article::None
            && length == 1
            && first > self.first
            && self.tokens[first].capital
            && self.text(first) == "van"
            && self.tokens.get(first + 1).is_some_and(|next| next.capital)
    }

    /// "in Denver, Colorado", "near Lake Tahoe", "at the Civic Center": written large, behind a place word or among other capitals that are no make.
    pub(super) fn is_a_town(&self, at: usize) -> bool {
        let Some(before) = at.checked_sub(1).filter(|before| *before >= self.first && self.tokens[at].capital) else {
            return false;
        };
        let unknown = |at: usize| {
            let token = self
                .tokens
                .get(at)
                .filter(|token| token.capital && token.kind == TokenKind::Word && token.text.len() > 2);
            token.is_some_and(|_| self.lexicon.longest(self.tokens, at, |_| true).is_none())
                && !self.lexicon.is_make(self.text(at))
        };
        let town = self.text(before) == "," && before > self.first && unknown(before - 1);
        let there = matches!(self.text(before), "in" | "at" | "near" | "outside" | "around");
        let named = unknown(before) && !DETERMINERS.contains(&self.text(before));
        let place = PLACES.contains(&self.text(at + 1)) && self.tokens.get(at + 1).is_some_and(|next| next.capital);
        town || there || named || place
    }

    /// "the Bayside International Airport": a make that stands here is of the name of a place.
    pub(super) fn names_a_place(&self, at: usize) -> bool {
        let capital = |at: usize| self.tokens.get(at).is_some_and(|token| token.capital);
        self.lexicon.is_make(self.text(at)) && capital(at) && capital(at + 1) && PLACES.contains(&self.text(at + 1))
    }
}

//! Nouns of several: "a group of", "the crowd" again, "another of our cars", "the van and motorcycle".

use super::noun::{LONGEST_LEAD, stands};
use super::{Article, Chunker, Noun};
use crate::lexicon::Adjective;
use recrash_model::account::Kind;

impl Chunker<'_> {
    /// "the van and motorcycle", "a stopped van and bus": the noun before, whose article is that of the second too, and that it stands.
    pub(super) fn shares_with(&self, first: usize, kind: Kind) -> Option<Noun> {
        let and = first.checked_sub(1).filter(|and| *and > self.first && self.text(*and) == "and")?;
        let mut lead = (self.first.max(and.saturating_sub(LONGEST_LEAD))..and).rev();
        let begins = lead.find(|at| matches!(self.text(*at), "the" | "a" | "an"))?;
        let (before, length) = self.noun(begins)?;
        let stand =
            kind.is_vehicle() && before.kind.is_some_and(Kind::is_vehicle) && before.adjectives.iter().any(stands);
        let shares = before.article == Article::Definite || stand;
        (shares && begins + length == and && !before.several).then_some(before)
    }

    /// "a group of", "the pair of".
    pub(super) fn is_group(&self, at: usize) -> bool {
        const GROUPS: [&str; 15] = [
            "group", "pair", "couple", "pack", "party", "trio", "crowd", "class", "gang", "band", "swarm", "convoy",
            "flock", "herd", "handful",
        ];
        let many = GROUPS.contains(&self.text(at + 1)) || self.text(at) == "a" && self.text(at + 1) == "number";
        matches!(self.text(at), "a" | "the") && many && self.text(at + 2) == "of"
    }

    /// "A crowd of dirt bikes came. ... The crowd rode by": those again.
    pub(super) fn crowd_again(&self, first: usize) -> Option<Noun> {
        let named = |at: usize| self.text(at) == "crowd" && self.text(at + 1) == "of";
        if self.text(first) != "the" || self.text(first + 1) != "crowd" || named(first + 1) {
            return None;
        }
        let (crowd, _) = (1..first).rfind(|&at| named(at)).and_then(|at| self.noun(at - 1))?;
        Some(Noun { article: Article::Definite, ..crowd })
    }

    /// "another of our test cars".
    pub(super) fn another_of(&self, at: usize) -> Option<(Noun, usize)> {
        let (inner, length) = self.noun(at)?;
        let kind = inner.kind.filter(|_| !inner.subject).unwrap_or(Kind::Vehicle);
        let (article, adjectives) = (Article::Indefinite, vec![Adjective::Another]);
        Some((Noun { article, kind: Some(kind), adjectives, ..Noun::unnamed() }, length))
    }
}

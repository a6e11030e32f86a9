//! What is only supposed: "even if it had come to a stop", "it would have struck the van". Nothing of that happened.

use super::Frame;
use crate::lexicon::Progress;
use crate::token::{Sentence, Token, TokenKind};

/// Words that tell, before a verb, what would have been.
const WOULD: [&str; 5] = ["would", "might", "could", "likely", "potentially"];

/// How far before a verb "would have" stands: "would most likely have". [tokens]
const WOULD_BEFORE: usize = 5;

/// Takes back what is only supposed.
pub(super) fn apply(frames: &mut [Frame], tokens: &[Token], sentences: &[Sentence]) {
    for frame in frames {
        let sentence = sentences[frame.sentence];
        if behind_if(&tokens[sentence.first..frame.first]) || behind_would_have(&tokens[sentence.first..frame.first]) {
            frame.progress = Progress::Wished;
        }
    }
}

/// "if it had stopped": up to the comma, or the main verb, that ends the clause.
fn behind_if(before: &[Token]) -> bool {
    let Some(at) = before.iter().rposition(|token| token.text == "if") else { return false };
    // "as if".
    let as_if = at.checked_sub(1).is_some_and(|at| before[at].text == "as");
    let clause = &before[at..];
    let ends = clause.iter().any(|token| token.kind == TokenKind::Mark || token.text == "then");
    let had = clause.iter().take(8).any(|token| token.text == "had");
    !as_if && !ends && had
}

/// "would have struck it".
fn behind_would_have(before: &[Token]) -> bool {
    let near = &before[before.len().saturating_sub(WOULD_BEFORE)..];
    let have = near.iter().rposition(|token| token.text == "have");
    have.is_some_and(|have| near[..have].iter().any(|token| WOULD.contains(&token.text.as_str())))
}

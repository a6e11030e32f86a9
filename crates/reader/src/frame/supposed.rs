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
        let before = &tokens[sentence.first..frame.first];
        if behind_if(before)
            || behind_would_have(before)
            || behind_expected(before)
            || behind_fear(before)
            || behind_purpose(before)
        {
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

/// "saw a risk of hitting the wall", "braked to avoid scraping it": what was feared.
fn behind_fear(before: &[Token]) -> bool {
    const FEARS: [&str; 8] =
        ["risk", "danger", "possibility", "chance", "chances", "threat", "likelihood", "probability"];
    let word = |back: usize| before.len().checked_sub(back).map_or("", |at| before[at].text.as_str());
    // "of potentially hitting it".
    let adverb = usize::from(word(1).ends_with("ly"));
    let feared = word(1 + adverb) == "of" && FEARS.contains(&word(2 + adverb));
    // "was unable to avoid hitting it": so it did.
    let in_vain = (2..6).any(|back| matches!(word(back), "unable" | "not" | "couldn" | "failed" | "late"));
    feared || word(1).starts_with("avoid") && !in_vain
}

/// "stopped so that a van could turn": what it made room for. "Hemmed in, so that it could only slow": so it did.
fn behind_purpose(before: &[Token]) -> bool {
    if matches!(before, [.., could, only] if could.text == "could" && only.text == "only") {
        return false;
    }
    let so = before.iter().rposition(|token| matches!(token.text.as_str(), "so" | "order"));
    let Some(clause) = so.map(|at| &before[at..]) else { return false };
    let modal = |token: &Token| matches!(token.text.as_str(), "could" | "might" | "would" | "can");
    let that = clause.get(1).is_some_and(|next| next.text == "that");
    let so = clause[0].text == "so" && so.is_some_and(|at| at > 0 && before[at - 1].text != ",");
    (that || so) && clause.iter().any(modal) && !clause.iter().any(|token| token.kind == TokenKind::Mark)
}

/// "predicted that it would wait", and not all that stands behind it.
fn behind_expected(before: &[Token]) -> bool {
    before.last().is_some_and(|token| matches!(token.text.as_str(), "would" | "will" | "might")) && expects(before)
}

/// Whether these words tell what somebody expects of another: "predicted that the van".
pub(super) fn expects(words: &[Token]) -> bool {
    let stems = ["predict", "expect", "believ", "assum", "anticipat"];
    let expects = |word: &str| stems.iter().any(|stem| word.starts_with(stem));
    words.windows(2).any(|pair| expects(&pair[0].text) && pair[1].text == "that")
}

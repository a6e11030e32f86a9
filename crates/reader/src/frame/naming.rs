//! Words that name somebody, made plain before a narrative is read: numbered units, companies, nouns that nobody knows.

use crate::lexicon::{COMPANY, Lexicon, Meaning};
use crate::token::{Token, TokenKind, word};
use crate::world::Own;

/// Companies that report, and whose vehicles others drive too.
const MAKERS: [&str; 3] = ["tesla", "rivian", "lucid"];

/// "V2", "Vehicle2", "Unit 2", "V-1", "P-2": another vehicle.
pub(super) fn units(tokens: &mut Vec<Token>) {
    for at in (0..tokens.len()).rev() {
        let next = word(tokens, at + 1);
        let unit = match tokens[at].text.as_str() {
            "unit" | "party" => matches!(next, "2" | "3" | "4" | "5"),
            "v" | "p" => {
                let joined = tokens.get(at + 1).is_some_and(|next| next.start == tokens[at].end + 1);
                joined && matches!(next, "1" | "2" | "3" | "4" | "5")
            }
            _ => split_number(tokens, at),
        };
        if unit {
            "vehicle".clone_into(&mut tokens[at].text);
            tokens[at].capital = false;
        }
    }
}

/// "V2", "Vehicle2": parts the number from the word. Whether there is one.
fn split_number(tokens: &mut Vec<Token>, at: usize) -> bool {
    let word = tokens[at].text.as_str();
    let number = word.strip_prefix("vehicle").or_else(|| word.strip_prefix('v'));
    let Some(number) = number.filter(|number| matches!(*number, "2" | "3" | "4" | "5")).map(str::to_owned) else {
        return false;
    };
    let middle = tokens[at].end - number.len();
    let end = std::mem::replace(&mut tokens[at].end, middle);
    let token = Token { start: middle, end, text: number, kind: TokenKind::Number, capital: false };
    tokens.insert(at + 1, token);
    true
}

/// Names of companies, in words that the lexicon knows.
pub(super) fn companies(tokens: &mut [Token], own: Own<'_>) {
    for at in 0..tokens.len() {
        let named = tokens[at].capital && tokens[at].text.len() > 2 && tokens[at].text == own.company;
        // "A Tesla struck it": of the company only in its own reports.
        // "The Finch pulled over", "a Taxico vehicle": to a company that is called by a word for somebody, it is its name.
        let make = |meaning: Meaning| match meaning {
            Meaning::Make => MAKERS.contains(&own.company),
            Meaning::Kind(_) => true,
            _ => false,
        };
        if named && Lexicon::get().longest(tokens, at, |meaning| !make(meaning)).is_none() {
            COMPANY.clone_into(&mut tokens[at].text);
        }
    }
    name_operators(tokens);
}

/// "A Tern autonomous vehicle ... the Tern vehicle", "a Tern vehicle driving in autonomous mode": a company whose name the lexicon does not know
/// is known by its first vehicle.
fn name_operators(tokens: &mut [Token]) {
    let word = |at: usize| word(tokens, at);
    let lexicon = Lexicon::get();
    let subject = |at: usize| lexicon.longest(tokens, at, |meaning| matches!(meaning, Meaning::Subject)).is_some();
    let drives_itself = |at: usize| {
        let behind: Vec<&str> = (at..at + OWN_MODE_WITHIN).map(word).take_while(|word| *word != ".").collect();
        behind.windows(2).any(|pair| {
            matches!(
                (pair[0], pair[1]),
                ("autonomous" | "automated", "mode" | "system") | ("in", "autonomy") | ("ads", "engaged")
            )
        })
    };
    let named = |at: &usize| {
        let token = &tokens[*at];
        let unknown = token.capital
            && token.kind == TokenKind::Word
            && token.text.len() > 3
            && lexicon.longest(tokens, *at, |_| true).is_none();
        let vehicle = matches!(word(at + 1), "vehicle" | "truck" | "shuttle" | "car");
        let called =
            subject(at + 1) && !vehicle || vehicle && (word(at + 2) == "(" && subject(at + 3) || drives_itself(at + 2));
        unknown && *at > 0 && matches!(word(at - 1), "a" | "an" | "the" | "our") && called
    };
    if (0..tokens.len()).any(|at| lexicon.longest(tokens, at, |meaning| matches!(meaning, Meaning::Company)).is_some())
    {
        return;
    }
    let Some(name) = (0..tokens.len()).find(named).map(|at| tokens[at].text.clone()) else { return };
    for token in tokens.iter_mut().filter(|token| token.capital && token.text == name) {
        COMPANY.clone_into(&mut token.text);
    }
}

/// "a Tern truck traveling with its safety driver in autonomous mode": so near stands what drives it. [tokens]
const OWN_MODE_WITHIN: usize = 10;

/// Nouns that nobody knows, and that may be a road user: "a gleeper was", "by a gleeper".
pub(super) fn strangers(tokens: &[Token]) -> Vec<String> {
    let lexicon = Lexicon::get();
    let mut all: Vec<String> = Vec::new();
    for (at, token) in tokens.iter().enumerate().skip(1) {
        let unknown = token.kind == TokenKind::Word
            && !token.capital
            && token.text.len() > 3
            && lexicon.longest(tokens, at, |_| true).is_none()
            && ["a", "an", "another", "the", "one"].contains(&word(tokens, at - 1));
        let acts = lexicon.longest(tokens, at + 1, |meaning| matches!(meaning, Meaning::Verb(..))).is_some()
            || matches!(
                word(tokens, at + 1),
                "was" | "had" | "that" | "which" | "who" | "behind" | "in" | "on" | "from" | "also"
            );
        let done_by = at > 1 && matches!(word(tokens, at - 2), "by" | "with" | "into");
        if unknown && (acts || done_by) && !all.contains(&token.text) {
            all.push(token.text.clone());
        }
    }
    all.truncate(6);
    all
}

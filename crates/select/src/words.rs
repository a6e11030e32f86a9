//! From narratives to words. Narratives are untrusted text: any input gives words or none.

use std::collections::BTreeSet;

/// Longest word kept; what is longer is no word. [characters]
const LONGEST_WORD: usize = 30;

/// Longest masked passage in brackets; a bracket that closes later than this is text. [bytes]
const LONGEST_MASK: usize = 200;

/// Words of English that say nothing about a crash: articles, pronouns, auxiliaries, conjunctions, and `as`, `at`, `by`
/// and the like. Those that tell places and order (`behind`, `left`, `before`, `into`, `not`) are kept.
const STOP_WORDS: [&str; 82] = [
    "a", "about", "all", "also", "am", "an", "and", "any", "are", "as", "at", "be", "been", "being", "both", "but",
    "by", "can", "could", "did", "do", "does", "for", "from", "had", "has", "have", "having", "he", "her", "him",
    "his", "however", "i", "if", "in", "is", "it", "its", "itself", "may", "might", "more", "most", "must", "of", "on",
    "or", "other", "our", "own", "shall", "she", "should", "so", "some", "such", "than", "that", "the", "their",
    "them", "then", "there", "these", "they", "this", "those", "to", "was", "we", "were", "when", "where", "which",
    "while", "who", "will", "with", "would", "you", "your",
];

/// The words of a text in lower case, in order, without masks such as `[XXX]`, numbers, single letters and stop words.
pub(crate) fn words(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for passage in without_masks(text) {
        for run in passage.split(|c: char| !c.is_alphanumeric() && c != '\'' && c != '\u{2019}') {
            let run = run.trim_matches(['\'', '\u{2019}']).to_lowercase();
            let word = run.strip_suffix("'s").or_else(|| run.strip_suffix("\u{2019}s")).unwrap_or(&run);
            let length = word.chars().count();
            let is_word = (2..=LONGEST_WORD).contains(&length) && !word.chars().any(char::is_numeric);
            if is_word && STOP_WORDS.binary_search(&word).is_err() {
                found.push(word.to_owned());
            }
        }
    }
    found
}

/// Every word of these texts, to be left out of others.
pub(crate) fn vocabulary<'t>(texts: impl Iterator<Item = &'t str>) -> BTreeSet<String> {
    texts.flat_map(words).collect()
}

/// The passages between masks: brackets without a lower-case letter inside, as in `[XXX]`.
fn without_masks(text: &str) -> Vec<&str> {
    let mut passages = Vec::new();
    let mut passage_start = 0;
    let mut search_from = 0;
    while let Some(open) = text[search_from..].find('[').map(|at| search_from + at) {
        let close = text.as_bytes()[open..].iter().take(LONGEST_MASK).position(|&b| b == b']').map(|at| open + at);
        search_from = open + 1;
        if let Some(close) = close
            && !text[open..close].chars().any(char::is_lowercase)
        {
            passages.push(&text[passage_start..open]);
            passage_start = close + 1;
            search_from = passage_start;
        }
    }
    passages.push(&text[passage_start..]);
    passages
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stop_words_are_sorted_for_the_search() {
        assert!(STOP_WORDS.is_sorted());
    }

    #[test]
    fn words_lose_case_masks_numbers_and_possessives() {
        let text =
            "The AV\u{2019}s front-left at 12:30 PM on [XXX] [MAY CONTAIN CBI] was hit by a [Honda] driver's SUV.";
        assert_eq!(words(text), ["av", "front", "left", "pm", "hit", "honda", "driver", "suv"]);
    }

    #[test]
    fn odd_texts_give_words_or_none() {
        assert!(words("").is_empty());
        assert!(words("[[[ ]] 1 2 3 ' '' \u{2019} ]").is_empty());
        assert_eq!(words("[UNCLOSED mask"), ["unclosed", "mask"]);
        assert_eq!(words("\u{c9}t\u{e9} [\u{e9}] \u{8eca}\u{8f1b}"), ["\u{e9}t\u{e9}", "\u{8eca}\u{8f1b}"]);
        assert!(words(&"x".repeat(10_000)).is_empty());
    }
}

//! BERT's uncased WordPiece: from a text to the numbers of its tokens (Wu et al. 2016; Devlin et al. 2019).
//!
//! What this does **not** do: names of special tokens inside a text, such as `[SEP]`, are text like any other, not
//! marks; a narrative cannot steer the model.

use crate::EmbedError;
use std::collections::BTreeMap;
use unicode_normalization::UnicodeNormalization;
use unicode_properties::{GeneralCategory, GeneralCategoryGroup, UnicodeGeneralCategory};

/// Longer words are unknown. [characters]
const LONGEST_WORD: usize = 100;

/// A vocabulary.
#[derive(Debug)]
pub(crate) struct WordPiece {
    numbers: BTreeMap<String, usize>,
    start: usize,
    end: usize,
    unknown: usize,
}

impl WordPiece {
    /// From `vocab.txt`: one token a line, its number is the line's.
    pub fn new(bytes: &[u8], expected: usize) -> Result<Self, EmbedError> {
        let text = std::str::from_utf8(bytes).map_err(|e| EmbedError::Vocabulary(format!("not UTF-8: {e}")))?;
        let numbers: BTreeMap<String, usize> = text.lines().map(str::to_owned).zip(0..).collect();
        let lines = text.lines().count();
        if lines != expected {
            return Err(EmbedError::Vocabulary(format!("{lines} tokens where config.json says {expected}")));
        }
        let special = |token: &str| {
            let number = numbers.get(token).copied();
            number.ok_or_else(|| EmbedError::Vocabulary(format!("no token {token}")))
        };
        let (start, end, unknown) = (special("[CLS]")?, special("[SEP]")?, special("[UNK]")?);
        Ok(Self { numbers, start, end, unknown })
    }

    /// The tokens of a text between a start and an end mark, at most `limit` in all (at least 3).
    pub fn tokens(&self, text: &str, limit: usize) -> Vec<usize> {
        let mut tokens = vec![self.start];
        let mut word = String::new();
        // One blank more, so that the last word ends.
        for c in normalised(text).chain([' ']) {
            if tokens.len() >= limit {
                break;
            }
            let alone = is_punctuation(c);
            if alone || c.is_whitespace() {
                self.split_word(&word, &mut tokens);
                word.clear();
            } else {
                word.push(c);
            }
            if alone {
                self.split_word(c.encode_utf8(&mut [0; 4]), &mut tokens);
            }
        }
        tokens.truncate(limit - 1);
        tokens.push(self.end);
        tokens
    }

    /// The longest pieces from the left that are in the vocabulary; a word that cannot be split so is unknown.
    fn split_word(&self, word: &str, tokens: &mut Vec<usize>) {
        if word.is_empty() {
            return;
        }
        let before = tokens.len();
        if word.chars().count() > LONGEST_WORD {
            tokens.push(self.unknown);
            return;
        }
        let mut start = 0;
        while start < word.len() {
            let ends = word[start..].char_indices().map(|(at, c)| start + at + c.len_utf8());
            let piece = ends.rev().find_map(|end| {
                let piece = &word[start..end];
                let number = if start == 0 { self.numbers.get(piece) } else { self.numbers.get(&format!("##{piece}")) };
                number.map(|&number| (number, end))
            });
            let Some((number, end)) = piece else {
                tokens.truncate(before);
                tokens.push(self.unknown);
                return;
            };
            tokens.push(number);
            start = end;
        }
    }
}

/// Without control characters and accents, in lower case, with blanks around Chinese characters.
fn normalised(text: &str) -> impl Iterator<Item = char> + '_ {
    text.chars()
        .filter(|&c| c.is_whitespace() || !is_control(c))
        .flat_map(|c| if is_chinese(c) { [Some(' '), Some(c), Some(' ')] } else { [Some(c), None, None] })
        .flatten()
        .nfd()
        .filter(|&c| c.general_category() != GeneralCategory::NonspacingMark)
        .flat_map(char::to_lowercase)
}

fn is_control(c: char) -> bool {
    let category = c.general_category();
    let control = matches!(category, GeneralCategory::Control | GeneralCategory::Format | GeneralCategory::PrivateUse);
    control || c == '\0' || c == '\u{fffd}'
}

fn is_punctuation(c: char) -> bool {
    c.is_ascii_punctuation() || c.general_category_group() == GeneralCategoryGroup::Punctuation
}

/// The blocks of CJK ideographs.
fn is_chinese(c: char) -> bool {
    matches!(u32::from(c),
        0x4e00..=0x9fff | 0x3400..=0x4dbf | 0x20000..=0x2a6df | 0x2a700..=0x2b73f | 0x2b740..=0x2b81f
        | 0x2b920..=0x2ceaf | 0xf900..=0xfaff | 0x2f800..=0x2fa1f)
}

#[cfg(test)]
mod tests {
    use super::*;

    const VOCABULARY: &str = "[UNK]\n[CLS]\n[SEP]\nturn\n##ing\n##ed\nleft\n,\n.\n\u{8eca}\n[\n]\ncafe\nsep";

    fn tokens(text: &str, limit: usize) -> Vec<usize> {
        WordPiece::new(VOCABULARY.as_bytes(), 14).unwrap().tokens(text, limit)
    }

    #[test]
    fn words_are_split_from_the_left() {
        assert_eq!(tokens("Turning left, turned.", 20), [1, 3, 4, 6, 7, 3, 5, 8, 2]);
    }

    #[test]
    fn unknown_and_overlong_words_are_one_token() {
        assert_eq!(tokens("turnip", 20), [1, 0, 2]);
        assert_eq!(tokens(&"turn".repeat(26), 20), [1, 0, 2]);
    }

    #[test]
    fn accents_controls_and_chinese() {
        assert_eq!(tokens("CAF\u{c9}\u{0}", 20), [1, 12, 2]);
        assert_eq!(tokens("left\u{8eca}left", 20), [1, 6, 9, 6, 2]);
        assert_eq!(tokens("", 20), [1, 2]);
    }

    #[test]
    fn marks_in_a_text_are_text() {
        assert_eq!(tokens("[SEP]", 20), [1, 10, 13, 11, 2]);
    }

    #[test]
    fn long_texts_are_cut_and_still_end() {
        assert_eq!(tokens("left left left left", 4), [1, 6, 6, 2]);
        assert_eq!(tokens("turning turning", 4), [1, 3, 4, 2]);
        assert_eq!(tokens("left turning", 4), [1, 6, 3, 2]);
    }

    #[test]
    fn vocabularies_that_do_not_fit_are_refused() {
        for (text, expected) in [("[UNK]\n[CLS]", 2), ("[UNK]\n[CLS]\n[SEP]", 4)] {
            assert!(matches!(WordPiece::new(text.as_bytes(), expected), Err(EmbedError::Vocabulary(_))));
        }
        assert!(matches!(WordPiece::new(&[0xff], 1), Err(EmbedError::Vocabulary(_))));
    }
}

//! Narratives as sentences, without the boilerplate. Every sentence is a slice of the narrative, so whatever is found in
//! it stands in the record word for word.

use super::pattern::Pattern;

/// No more of a narrative than this is read. The longest of the real file has about 6 kB. [bytes]
pub const MAX_NARRATIVE_BYTES: usize = 20_000;

/// A sentence longer than this is read up to here. [bytes]
const MAX_SENTENCE_BYTES: usize = 2_000;

/// Turns of phrase that are about the report and not about the crash: who files it and why, copies and updates of other
/// reports, who was informed, what was engaged. The preamble that names the parties and the place is among them.
static BOILERPLATE: Pattern = Pattern::new(
    r"(?ix)
      \bis\ reporting\ this\ (?:crash|collision|incident|event)
    | \bmay\ supplement\ or\ correct\b
    | \bwas\ submitted\ from\ the\ \w+\ time\ zone\b
    | \bcontent\ of\ this\ report\ is\ unchanged\b
    | \b(?:is|submitting)\ a\ duplicate\b
    | \bduplicate\ (?:of|report|copy)\b
    | \bno\ (?:update|additional|further|changes)\b
    | \bupdate\ to\ (?:a\ |the\ )?previously\b
    | \bthis\ update\ provides\b
    | \bsubmitting\ this\ (?:updated\ )?report\b
    | \bplease\ refer\ to\b
    | \bfiled\ an?\b .{0,60} \breport\b
    | \bstanding\ general\ order\b
    | \bgm\ (?:is|has)\b | \bgm's\ submission\b | \bmanufactured\ the\b | \bincorporates\ cruise
    | \breference\ file\b | \bnonpublic\b | \bconfidential\ business\ information\b
    | \blevel\ \d\ ads\ was\b | \bautomated\ driving\ system\ was\ (?:not\ )?engaged\b
    | \b(?:was|were)\ (?:involved\ )?in\ an?\ (?:\w+\ )?(?:collision|crash|accident|incident)\ (?:involving|with)\b
    | \b(?:police|law\ enforcement)\ (?:were|was|responded|did)\b
    | \bno\ (?:reported\ )?injur | \breported\ injur | \binjuries\ were\ reported
    | \bnotice\ of\b",
);

/// The sentences that tell about the crash, in order.
pub fn telling_sentences(narrative: &str) -> Vec<&str> {
    let mut kept = sentences(head(narrative, MAX_NARRATIVE_BYTES));
    kept.retain(|sentence| !BOILERPLATE.is_match(sentence));
    kept
}

/// Sentences end at a full stop, a question or exclamation mark before a capital, or at a line break; not inside numbers
/// (`24.9 mph`), times of day (`p.m.`) or after initials (`E. Main`).
fn sentences(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut start = 0;
    let bytes = text.as_bytes();
    for (at, &byte) in bytes.iter().enumerate() {
        let ends = match byte {
            b'\n' | b'\r' => true,
            b'.' | b'!' | b'?' => ends_sentence(bytes, at),
            _ => false,
        };
        if ends {
            push_sentence(&mut found, &text[start..=at]);
            start = at + 1;
        }
    }
    push_sentence(&mut found, &text[start..]);
    found
}

fn ends_sentence(bytes: &[u8], at: usize) -> bool {
    let after_initial = at >= 1
        && bytes[at - 1].is_ascii_uppercase()
        && (at == 1 || !bytes[at - 2].is_ascii_alphanumeric() && bytes[at - 2] != b'.');
    if after_initial {
        return false;
    }
    let mut next = at + 1;
    while next < bytes.len() && matches!(bytes[next], b' ' | b'\t' | b'"' | b'\'' | b')' | b']') {
        next += 1;
    }
    match bytes.get(next) {
        None => true,
        Some(byte) => byte.is_ascii_uppercase() || matches!(byte, b'\n' | b'\r' | b'[' | b'('),
    }
}

fn push_sentence<'a>(found: &mut Vec<&'a str>, sentence: &'a str) {
    let sentence = head(sentence, MAX_SENTENCE_BYTES).trim();
    if sentence.bytes().any(|byte| byte.is_ascii_alphabetic()) {
        found.push(sentence);
    }
}

/// The first `bytes` bytes at most, cut between characters.
fn head(text: &str, bytes: usize) -> &str {
    let mut end = text.len().min(bytes);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    &text[..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_stops_inside_numbers_times_and_initials_end_nothing() {
        let text = "At 3:10 p.m. the car did 24.9 mph on E. Main Street. It stopped.Then it went on";
        assert_eq!(
            telling_sentences(text),
            ["At 3:10 p.m. the car did 24.9 mph on E. Main Street.", "It stopped.", "Then it went on"]
        );
    }

    #[test]
    fn sentences_about_the_report_are_left_out() {
        let text = "Acme is reporting this crash because a car was towed. The car turned left. \
                    Acme may supplement or correct its report.";
        assert_eq!(telling_sentences(text), ["The car turned left."]);
    }

    #[test]
    fn long_text_is_cut_between_characters() {
        let text = "\u{e9}".repeat(MAX_NARRATIVE_BYTES);
        assert!(telling_sentences(&text).is_empty());
        let letters = "a\u{e9}".repeat(MAX_NARRATIVE_BYTES);
        assert_eq!(telling_sentences(&letters).len(), 1);
    }
}

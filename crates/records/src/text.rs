//! Text out of untrusted bytes: encodings, twice-encoded characters, and keys that forgive blanks and letter case.

use encoding_rs::WINDOWS_1252;
use std::borrow::Cow;

/// Longest excerpt of a file's text in a message. [characters]
const EXCERPT_CHARS: usize = 60;

/// The text of a cell, and whether it was no UTF-8 and had to be read as Windows-1252.
pub fn decode(bytes: &[u8]) -> (Cow<'_, str>, bool) {
    match std::str::from_utf8(bytes) {
        Ok(text) => (Cow::Borrowed(text), false),
        Err(_) => (WINDOWS_1252.decode_without_bom_handling(bytes).0, true),
    }
}

/// Letters and digits in lower case, for comparing codes: `Highway / Freeway` and `highway/freeway` are the same.
pub fn same_code(left: &str, right: &str) -> bool {
    fn letters(text: &str) -> impl Iterator<Item = char> + '_ {
        text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase)
    }
    letters(left).eq(letters(right))
}

/// The key of a column name: letters, digits and `?` in lower case (`State or Local Permit?` and
/// `State or Local Permit` are two columns).
pub fn header_key(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric() || *c == '?').flat_map(char::to_lowercase).collect()
}

/// A short, printable piece of untrusted text for a message.
pub fn excerpt(text: &str) -> String {
    let mut short: String = text.trim().chars().take(EXCERPT_CHARS).flat_map(char::escape_debug).collect();
    if text.trim().chars().nth(EXCERPT_CHARS).is_some() {
        short.push_str("...");
    }
    short
}

/// Mends characters that were encoded as UTF-8 twice or three times, as some published narratives have them: `â`,
/// `U+0080`, `U+0099` for an apostrophe. `None` where there is nothing to mend.
pub fn mend_twice_encoded(text: &str) -> Option<String> {
    let mut mended = mend_once(text)?;
    while let Some(again) = mend_once(&mended) {
        mended = again;
    }
    Some(mended)
}

/// One round. Every round makes the text shorter, so rounds end.
fn mend_once(text: &str) -> Option<String> {
    if text.is_ascii() {
        return None;
    }
    let mut mended = String::with_capacity(text.len());
    let mut changed = false;
    let mut run: Vec<u8> = Vec::new();
    let mut run_text = String::new();
    let mut flush = |run: &mut Vec<u8>, run_text: &mut String, mended: &mut String| {
        match std::str::from_utf8(run) {
            Ok(decoded) if !run.is_empty() => {
                mended.push_str(decoded);
                changed = true;
            }
            _ => mended.push_str(run_text),
        }
        run.clear();
        run_text.clear();
    };
    for c in text.chars() {
        match single_byte(c) {
            Some(byte) => {
                run.push(byte);
                run_text.push(c);
            }
            None => {
                flush(&mut run, &mut run_text, &mut mended);
                mended.push(c);
            }
        }
    }
    flush(&mut run, &mut run_text, &mut mended);
    changed.then_some(mended)
}

/// The byte that a non-ASCII character stands for in Latin-1 or Windows-1252.
fn single_byte(c: char) -> Option<u8> {
    match u32::from(c) {
        code @ 0x80..=0xff => u8::try_from(code).ok(),
        0..=0x7f => None,
        _ => {
            let mut buffer = [0; 4];
            let (bytes, _, unmappable) = WINDOWS_1252.encode(c.encode_utf8(&mut buffer));
            (!unmappable && bytes.len() == 1).then(|| bytes[0])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_forgive_blanks_case_and_punctuation() {
        assert!(same_code(" highway/FREEWAY ", "Highway / Freeway"));
        assert!(same_code("Non-Motorist: Scooter \u{2013} Skateboard", "Non-Motorist: Scooter - Skateboard"));
        assert!(!same_code("Minor W/ Hospitalization", "Minor W/O Hospitalization"));
    }

    #[test]
    fn windows_1252_is_the_fallback() {
        assert_eq!(decode(b"caf\xe9 \x93x\x94"), ("caf\u{e9} \u{201c}x\u{201d}".into(), true));
        assert_eq!(decode("caf\u{e9}".as_bytes()), ("caf\u{e9}".into(), false));
    }

    #[test]
    fn twice_and_thrice_encoded_apostrophes_are_mended() {
        let once = "vehicle\u{2019}s";
        let latin = |text: &str| -> String { text.bytes().map(char::from).collect() };
        assert_eq!(mend_twice_encoded(&latin(once)).as_deref(), Some(once));
        assert_eq!(mend_twice_encoded(&latin(&latin(once))).as_deref(), Some(once));
        assert_eq!(mend_twice_encoded(&WINDOWS_1252.decode(once.as_bytes()).0).as_deref(), Some(once));
    }

    #[test]
    fn honest_accents_are_left_alone() {
        assert_eq!(mend_twice_encoded("caf\u{e9} on Pe\u{f1}a Street"), None);
        assert_eq!(mend_twice_encoded(""), None);
    }

    #[test]
    fn excerpts_are_short_and_printable() {
        assert_eq!(excerpt("a\u{0}b\n"), "a\\0b");
        assert!(excerpt(&"x".repeat(500)).len() < 70);
    }
}

//! Keys, and how they stay out of everything that is kept or shown.

use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD;
use regex::Regex;
use std::fmt::Write as _;

/// Shortest text that is taken for a key; anything shorter stands in ordinary text as well. [bytes]
const SHORTEST: usize = 5;
/// What stands where a key was.
const BLACKED_OUT: &str = "[key]";

/// A text that is never shown.
#[derive(Clone, PartialEq, Eq)]
pub struct Secret(String);

impl Secret {
    /// Wraps a key; blanks around it do not belong to it.
    pub fn new(key: &str) -> Self {
        Self(key.trim().to_owned())
    }

    /// The key, for the header it belongs in and nothing else.
    pub fn expose(&self) -> &str {
        &self.0
    }
}

impl std::fmt::Debug for Secret {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("[key]")
    }
}

/// Blacks keys out: servers echo headers in errors, models can be made to repeat anything, and programs tell what they
/// find. A key is found as it is and as others write it: with the escapes of JSON, of addresses and of HTML, in hexadecimal,
/// and in base64 wherever in the encoded text it begins.
#[derive(Clone, Default)]
pub struct Scrubber(Vec<Regex>);

impl Scrubber {
    /// For these keys; those of less than five bytes are left in.
    pub fn new(secrets: &[Secret]) -> Self {
        let keys = secrets.iter().map(Secret::expose).filter(|key| key.len() >= SHORTEST);
        // A key that is too long for its pattern is found as it is.
        let pattern = |key: &str| Regex::new(&pattern(key)).or_else(|_| Regex::new(&regex::escape(key)));
        Self(keys.filter_map(|key| pattern(key).ok()).collect())
    }

    /// The text without keys.
    pub fn scrub(&self, text: &str) -> String {
        self.0.iter().fold(text.to_owned(), |text, key| key.replace_all(&text, BLACKED_OUT).into_owned())
    }
}

impl std::fmt::Debug for Scrubber {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "[{} keys]", self.0.len())
    }
}

/// Every way to write a key.
fn pattern(key: &str) -> String {
    let letters: String = key.chars().map(letter).collect();
    let hexadecimal: String = key.bytes().map(|byte| format!("{byte:02x}")).collect();
    let encoded = (0..3).map(|before| encoded(key, before)).map(|middle| {
        let middle: String = middle.chars().map(encoded_letter).collect();
        // What stands around it holds the key's first and last bits.
        format!("[A-Za-z0-9+/_-]{{0,2}}{middle}[A-Za-z0-9+/_-]{{0,2}}={{0,2}}")
    });
    let ways: Vec<String> = [letters, format!("(?i:{hexadecimal})")].into_iter().chain(encoded).collect();
    ways.join("|")
}

/// Every way to write a letter: as it is or behind backslashes, as `\u0041`, `\x41`, `%41` or `&#65;`.
fn letter(letter: char) -> String {
    let (mut json, mut percent) = (String::new(), String::new());
    for unit in letter.encode_utf16(&mut [0; 2]) {
        let _ = write!(json, r"\\+u{unit:04x}");
    }
    for byte in letter.encode_utf8(&mut [0; 4]).bytes() {
        let _ = write!(percent, "%(?:25)*{byte:02x}");
    }
    let (number, plain) = (u32::from(letter), regex::escape(&letter.to_string()));
    let behind = if letter.is_alphanumeric() { "" } else { r"\\*" };
    let byte = if number < 0x100 { format!(r"|\\+x{number:02x}") } else { String::new() };
    format!("(?:{behind}{plain}|(?i:{json}{byte}|{percent}|&#0*{number};|&#x0*{number:x};))")
}

/// A letter of base64 in both alphabets; JSON may put a backslash before a slash.
fn encoded_letter(letter: char) -> String {
    match letter {
        '+' => "[+-]".to_owned(),
        '/' => r"(?:\\*/|_)".to_owned(),
        other => other.to_string(),
    }
}

/// What the base64 of every text holds that has so many bytes, of three, before the key: without the letters at both ends,
/// which depend on what else is in it.
fn encoded(key: &str, before: usize) -> String {
    let bytes = [&vec![0; before], key.as_bytes()].concat();
    let (first, end) = ((8 * before).div_ceil(6), 8 * bytes.len() / 6);
    STANDARD_NO_PAD.encode(bytes)[first..end].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base64::engine::general_purpose::URL_SAFE;

    const KEY: &str = "sk-pl/A+nted~1";

    fn scrub(text: &str) -> String {
        Scrubber::new(&[Secret::new(&format!(" {KEY} \n")), Secret::new("the"), Secret::new("tiny5")]).scrub(text)
    }

    #[test]
    fn keys_are_blacked_out_and_short_words_are_not() {
        assert_eq!(scrub(&format!("Bearer {KEY}; the end of tiny5")), "Bearer [key]; the end of [key]");
        assert_eq!(format!("{:?}", Secret::new(KEY)), "[key]");
        assert_eq!(format!("{:?}", Scrubber::new(&[Secret::new(KEY)])), "[1 keys]");
    }

    #[test]
    fn keys_are_found_however_they_are_written() {
        let each = |write: fn(char) -> String| KEY.chars().map(write).collect::<String>();
        for written in [
            each(|c| format!("\\u{:04x}", u32::from(c))),
            each(|c| format!("\\\\u{:04X}", u32::from(c))),
            each(|c| format!("%{:02X}", u32::from(c))),
            each(|c| format!("%25{:02x}", u32::from(c))),
            each(|c| format!("&#{};", u32::from(c))),
            each(|c| format!("{:02x}", u32::from(c))),
            KEY.replace('/', "\\/"),
            KEY.replace('A', "\\u0041"),
            KEY.replace('/', "%2F").replace('+', "%2b"),
        ] {
            assert_eq!(scrub(&format!("<{written}>")), "<[key]>", "{written}");
        }
    }

    #[test]
    fn keys_are_found_in_base64_wherever_they_begin() {
        for key in [KEY, "tiny5"] {
            for (before, after) in [("", ""), ("x", ""), ("xy", "z"), ("Bearer ", " and more"), ("user:", "!")] {
                let text = format!("{before}{key}{after}");
                for encoded in [STANDARD_NO_PAD.encode(&text), URL_SAFE.encode(&text)] {
                    let scrubbed = scrub(&format!("({encoded})"));
                    assert!(scrubbed.contains(BLACKED_OUT), "{text}: {encoded} -> {scrubbed}");
                }
            }
        }
    }

    #[test]
    fn ordinary_text_stays() {
        let text = "A sedan drove 25% faster than the van: {\"speed\": \"\\u0041\", \"map\": \"x/y\"} c2VkYW4gZHJvdmU=";
        assert_eq!(scrub(text), text);
    }
}

//! Words of a narrative, and its sentences.

/// Names of the months, as tokens have them.
pub(crate) const MONTHS: [&str; 12] = [
    "january",
    "february",
    "march",
    "april",
    "may",
    "june",
    "july",
    "august",
    "september",
    "october",
    "november",
    "december",
];

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenKind {
    /// A word, or a number with a unit.
    Word,
    /// A number.
    Number,
    /// A masked name: `[XXX]`.
    Name,
    /// One punctuation mark.
    Mark,
}

/// A token and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Token {
    /// First byte. [byte]
    pub start: usize,
    /// Byte behind it. [byte]
    pub end: usize,
    /// The word in small letters.
    pub text: String,
    /// What it is.
    pub kind: TokenKind,
    /// It begins with a capital letter.
    pub capital: bool,
}

/// A sentence: a range of tokens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sentence {
    /// First token.
    pub first: usize,
    /// Token behind the last.
    pub end: usize,
}

/// Words with a full stop that ends no sentence.
const ABBREVIATIONS: [&str; 26] = [
    "st", "ave", "blvd", "dr", "no", "mr", "ms", "mrs", "vs", "approx", "rd", "hwy", "ln", "pl", "ct", "ste", "jr",
    "sr", "e.g", "i.e", "al", "pony", "apt", "ft", "mt", "pkwy",
];

/// British spellings of words that the lexicon knows in American.
const SPELLINGS: [(&str, &str); 18] = [
    ("kerb", "curb"),
    ("kerbs", "curbs"),
    ("kerbside", "curbside"),
    ("tyre", "tire"),
    ("tyres", "tires"),
    ("lorry", "truck"),
    ("lorries", "trucks"),
    ("bonnet", "hood"),
    ("windscreen", "windshield"),
    ("centre", "center"),
    ("centreline", "centerline"),
    ("manoeuvring", "maneuvering"),
    ("pavements", "sidewalks"),
    ("carriageway", "roadway"),
    ("bumber", "bumper"),
    ("vehical", "vehicle"),
    ("vehice", "vehicle"),
    ("vehilce", "vehicle"),
];

fn american(word: String) -> String {
    SPELLINGS.iter().find(|(british, _)| *british == word).map_or(word, |(_, american)| (*american).to_owned())
}

/// Splits a narrative into tokens. Hyphens part words; `'s` is a token of its own.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut all = Vec::new();
    let mut start = 0;
    while let Some(c) = text[start..].chars().next() {
        if let Some(token) = masked(text, start).or_else(|| spelled(text, start)) {
            start = token.end;
            all.push(token);
            continue;
        }
        let end = start + c.len_utf8();
        start = match c {
            '\'' | '\u{2019}' | '\u{60}' | '\u{b4}' => apostrophe(text, start, end, &mut all),
            // "the?vehicle": a blank that was lost on its way here.
            '?' if text[end..].starts_with(char::is_alphanumeric) => end,
            // A line that breaks within a sentence.
            '\n' if runs_on(&all, text, end) => end,
            '.' | ',' | ';' | ':' | '(' | ')' | '!' | '?' | '\n' => {
                let text = if c == '\n' { "\u{b6}".to_owned() } else { c.to_string() };
                all.push(Token { start, end, text, kind: TokenKind::Mark, capital: false });
                end
            }
            _ => end,
        };
    }
    all
}

/// A masked name, or a withheld part: both end at the next bracket, if that is near.
fn masked(text: &str, start: usize) -> Option<Token> {
    let rest = text[start..].strip_prefix('[')?;
    let (at, _) = rest.char_indices().take(MASK_WITHIN).find(|(_, c)| *c == ']')?;
    let length = at + 2;
    let end = start + length;
    let name = length <= 8 || goes_on(&text[end..]);
    let kind = if name { TokenKind::Name } else { TokenKind::Mark };
    Some(Token { start, end, text: if name { "[xxx]" } else { "." }.to_owned(), kind, capital: name })
}

/// Characters of a mask behind its first, at most. [characters]
const MASK_WITHIN: usize = 119;

/// A word or a number.
fn spelled(text: &str, start: usize) -> Option<Token> {
    let first = text[start..].chars().next().filter(|c| c.is_alphanumeric() || *c == '#')?;
    let behind = start + first.len_utf8();
    let ends = |(at, c): &(usize, char)| !(c.is_alphanumeric() || *c == '.' && decimal(text, behind + at));
    let end = text[behind..].char_indices().find(ends).map_or(text.len(), |(at, _)| behind + at);
    let word = &text[start..end];
    let number = word.trim_start_matches('#').chars().all(|c| c.is_ascii_digit() || c == '.');
    let kind = if number && word != "#" { TokenKind::Number } else { TokenKind::Word };
    Some(Token { start, end, text: american(word.to_lowercase()), kind, capital: first.is_uppercase() })
}

/// Reads an apostrophe, which tells whose something is where it touches a word. Where the text goes on.
fn apostrophe(text: &str, start: usize, end: usize, all: &mut Vec<Token>) -> usize {
    let Some(last) = all.last_mut().filter(|last| last.end == start && last.kind != TokenKind::Mark) else {
        return end;
    };
    let s = text[end..].starts_with('s');
    let end = end + usize::from(s);
    if s && last.text == "it" {
        // "with it's bumper".
        (last.text, last.end) = ("its".to_owned(), end);
    } else if s || last.text.ends_with('s') {
        all.push(Token { start, end, text: "'s".to_owned(), kind: TokenKind::Word, capital: false });
    }
    end
}

/// Whether a sentence goes on behind a withheld part, which names a place then: "on [REDACTED ...] and turned".
fn goes_on(rest: &str) -> bool {
    rest.trim_start_matches(' ').starts_with(|c: char| c == ',' || c.is_lowercase())
}

/// Whether a line goes on with a small letter on the next one.
fn runs_on(before: &[Token], text: &str, end: usize) -> bool {
    let word = before.last().is_some_and(|last| last.kind == TokenKind::Word);
    word && text[end..].trim_start_matches([' ', '\r']).starts_with(|c: char| c.is_lowercase())
}

/// Whether the full stop at this byte stands between digits, or inside a name such as `Pony.ai`.
fn decimal(text: &str, at: usize) -> bool {
    let before = text[..at].chars().next_back();
    let after = text[at + 1..].chars().next();
    match (before, after) {
        (Some(before), Some(after)) => {
            (before.is_ascii_digit() && after.is_ascii_digit()) || text[..at].to_lowercase().ends_with("pony")
        }
        _ => false,
    }
}

/// The sentences of a narrative.
pub fn sentences(tokens: &[Token]) -> Vec<Sentence> {
    let mut all = Vec::new();
    let mut first = 0;
    for (at, token) in tokens.iter().enumerate() {
        if let Some(end) = ends_at_a_name(tokens, at).filter(|end| *end > first) {
            all.push(Sentence { first, end });
            first = at;
        }
        if token.kind != TokenKind::Mark || !ends_sentence(tokens, at) {
            continue;
        }
        if at > first {
            all.push(Sentence { first, end: at });
        }
        first = at + 1;
    }
    if first < tokens.len() {
        all.push(Sentence { first, end: tokens.len() });
    }
    all
}

/// Whether a word begins a sentence where it is written large.
fn opens(word: &str) -> bool {
    matches!(word, "the" | "a" | "an" | "as" | "while" | "when" | "at")
}

/// Whether a word begins a sentence where it is written large behind "St." or "Ave.".
fn opens_behind_abbreviation(word: &str) -> bool {
    opens(word)
        || matches!(
            word,
            "it" | "its" | "in" | "on" | "after" | "before" | "both" | "another" | "behind" | "this" | "there"
        )
        || matches!(word, "they" | "he" | "she" | "during" | "upon" | "once" | "because" | "with" | "two" | "traffic")
        || matches!(
            word,
            "facing" | "driving" | "traveling" | "heading" | "approaching" | "waiting" | "having" | "turning"
        )
}

/// Whether this full stop is the last of "a.m." or "p.m.".
fn is_clock(tokens: &[Token], at: usize) -> bool {
    let Some(first) = at.checked_sub(3) else { return false };
    let word = |ahead: usize| tokens[first + ahead].text.as_str();
    matches!(word(0), "a" | "p") && word(1) == "." && word(2) == "m" && tokens[first].end == tokens[first + 1].start
}

/// Time zones, which follow a time of day.
const ZONES: [&str; 20] = [
    "pt", "et", "ct", "mt", "pst", "pdt", "est", "edt", "cst", "cdt", "mst", "mdt", "hst", "pacific", "eastern",
    "central", "mountain", "local", "arizona", "utc",
];

/// "at 12:14 PM CT. Facing north": a time zone is no court.
fn is_of_time(tokens: &[Token], at: usize) -> bool {
    at.checked_sub(1).is_some_and(|before| {
        let before = &tokens[before];
        matches!(before.text.as_str(), "am" | "pm" | "m") || before.kind == TokenKind::Number
    }) && matches!(tokens[at].text.as_str(), "ct" | "mt")
}

/// "It stood at [XXX] A van came": the token behind a masked name that ends a sentence without a full stop, where the next one begins here.
fn ends_at_a_name(tokens: &[Token], at: usize) -> Option<usize> {
    if !tokens[at].capital || !opens(&tokens[at].text) {
        return None;
    }
    let name = tokens[..at].iter().rposition(|token| token.text != "\u{b6}")?;
    // A street may be called "The Alameda".
    let goes_on = tokens.get(at + 1).is_some_and(|next| next.kind == TokenKind::Word && !next.capital);
    (tokens[name].kind == TokenKind::Name && goes_on).then_some(name + 1)
}

fn ends_sentence(tokens: &[Token], at: usize) -> bool {
    let token = &tokens[at];
    match token.text.as_str() {
        ";" | "!" | "?" => true,
        "." => {
            if token.end - token.start > 1 {
                return true;
            }
            let Some(before) = at.checked_sub(1).map(|at| &tokens[at]) else { return true };
            let Some(after) = tokens.get(at + 1) else { return true };
            if after.text == "," {
                return false;
            }
            // "at 5:44 p.m. on May 3", "at 5:44 p.m. Pacific time".
            if is_clock(tokens, at) {
                return after.capital && !ZONES.contains(&after.text.as_str());
            }
            let initial = before.text.chars().count() == 1 && before.capital && before.kind == TokenKind::Word;
            let abbreviated = ABBREVIATIONS.contains(&before.text.as_str());
            let begins = after.capital || after.kind != TokenKind::Word || after.text == "\u{b6}";
            let apart = after.start > token.end;
            if initial || abbreviated {
                // `St. The van ...` ends one all the same.
                return abbreviated
                    && after.capital
                    && (opens_behind_abbreviation(&after.text) || is_of_time(tokens, at - 1));
            }
            begins || apart
        }
        _ => false,
    }
}

/// The word of a token; nothing where none is.
pub(crate) fn word(tokens: &[Token], at: usize) -> &str {
    tokens.get(at).map_or("", |token| token.text.as_str())
}

/// Whether a word names a crash.
pub(crate) fn is_crash_noun(word: &str) -> bool {
    matches!(word, "collision" | "crash" | "contact" | "impact" | "incident" | "accident")
}

/// A small number, in a word or in digits.
pub(crate) fn number(word: &str) -> Option<u8> {
    match word {
        "one" => Some(1),
        "two" => Some(2),
        "three" => Some(3),
        "four" => Some(4),
        "five" => Some(5),
        "six" => Some(6),
        other => other.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(text: &str) -> Vec<String> {
        let tokens = tokens(text);
        sentences(&tokens)
            .iter()
            .map(|s| tokens[s.first..s.end].iter().map(|t| t.text.clone()).collect::<Vec<_>>().join(" "))
            .collect()
    }

    #[test]
    fn sentences_end_where_they_end() {
        let found = split(
            "The van ran at 2.5 mph on E. Elm St. near [XXX].The car's rear-end was hit. See [REDACTED, MAY CONTAIN X] It left.",
        );
        assert_eq!(
            found,
            ["the van ran at 2.5 mph on e . elm st . near [xxx]", "the car 's rear end was hit", "see", "it left"]
        );
        let withheld =
            split("It ran on [REDACTED, MAY CONTAIN X] and stopped. It left [REDACTED, MAY CONTAIN X], too.");
        assert_eq!(withheld, ["it ran on [xxx] and stopped", "it left [xxx] , too"]);
        let masked = split("It stood at [XXX]  A van came down [XXX] The Alameda.");
        assert_eq!(masked, ["it stood at [xxx]", "a van came down [xxx] the alameda"]);
    }
}

//! The words of a filter: text in, tokens with their columns out.

use super::FilterError;

/// A word of a filter.
#[derive(Debug, Clone, PartialEq)]
pub enum Token {
    /// A name, a keyword or a number.
    Word(String),
    /// A quoted text, without its quotes.
    Quoted(String),
    /// `=`, `!=`, `<`, `<=`, `>`, `>=`, `(`, `)` or `,`.
    Sign(&'static str),
}

/// A word and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// The word.
    pub token: Token,
    /// In characters, counted from 1.
    pub column: usize,
}

/// Signs, longer ones first.
const SIGNS: [&str; 11] = ["==", "!=", "<=", ">=", "&&", "||", "=", "<", ">", "(", ")"];

/// Cuts a filter into words.
pub fn words(text: &str) -> Result<Vec<Placed>, FilterError> {
    let characters: Vec<char> = text.chars().collect();
    let error = |at: usize, message: String| Err(FilterError { text: text.to_owned(), column: at + 1, message });
    let mut all = Vec::new();
    let mut at = 0;
    while let Some(&c) = characters.get(at) {
        let start = at;
        let token = if c.is_whitespace() {
            at += 1;
            continue;
        } else if c == '"' || c == '\'' {
            let Some(length) = characters[at + 1..].iter().position(|&other| other == c) else {
                return error(start, format!("the quote {c} is never closed"));
            };
            at += length + 2;
            Token::Quoted(characters[start + 1..at - 1].iter().collect())
        } else if c == ',' {
            at += 1;
            Token::Sign(",")
        } else if let Some(sign) = SIGNS.into_iter().find(|sign| starts_with(&characters[at..], sign)) {
            at += sign.len();
            match sign {
                "==" => Token::Sign("="),
                "&&" | "||" => {
                    let word = if sign == "&&" { "and" } else { "or" };
                    return error(start, format!("write \"{word}\" instead of {sign}"));
                }
                _ => Token::Sign(sign),
            }
        } else if c.is_alphanumeric() || "_-.".contains(c) {
            while characters.get(at).is_some_and(|c| c.is_alphanumeric() || "_-.".contains(*c)) {
                at += 1;
            }
            Token::Word(characters[start..at].iter().collect())
        } else {
            return error(start, format!("cannot read {c:?} here; texts with blanks or signs stand in quotes"));
        };
        all.push(Placed { token, column: start + 1 });
    }
    Ok(all)
}

fn starts_with(characters: &[char], sign: &str) -> bool {
    sign.chars().enumerate().all(|(i, c)| characters.get(i) == Some(&c))
}

//! Keys, and how they stay out of everything that is kept or shown.

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

/// The text with every key in it blacked out: servers echo headers in errors, and models can be made to repeat anything.
#[cfg(any(feature = "live", test))]
pub fn redact(text: &str, secrets: &[Secret]) -> String {
    /// Shortest text that is taken for a key; anything shorter stands in ordinary text as well. [bytes]
    const SHORTEST: usize = 6;
    let keys = secrets.iter().map(Secret::expose).filter(|key| key.len() >= SHORTEST);
    keys.fold(text.to_owned(), |text, key| text.replace(key, "[key]"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_blacked_out_and_short_words_are_not() {
        let secrets = [Secret::new(" sk-planted-1 \n"), Secret::new("the")];
        assert_eq!(redact("Bearer sk-planted-1; the end", &secrets), "Bearer [key]; the end");
        assert_eq!(format!("{secrets:?}"), "[[key], [key]]");
    }
}

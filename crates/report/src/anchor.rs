//! Names of a scenario's file and of its place on the page. Scenario ids are untrusted text, so a name holds only letters that
//! need no escaping, in a path, an address or markup.

use recrash_model::hash::hexadecimal;
use sha2::{Digest, Sha256};

/// Longest part of a name that is taken over from the id. [characters]
const LONGEST: usize = 80;

/// The name of a scenario: its id where that is plain, or else what is plain in it and a part of its hash, so that no two
/// ids have one name, on file systems that do not tell capitals apart either.
pub fn stem(scenario_id: &str) -> String {
    let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '.' | '_' | '-');
    let kept = !scenario_id.is_empty()
        && scenario_id.len() <= LONGEST
        && !scenario_id.starts_with('.')
        && scenario_id.chars().all(is_plain);
    if kept {
        return scenario_id.to_owned();
    }
    let letters = scenario_id.chars().map(|c| c.to_ascii_lowercase());
    let plain: String = letters.filter(|&c| is_plain(c) && c != '.').take(LONGEST).collect();
    format!("{plain}-{}", hexadecimal(&Sha256::digest(scenario_id.as_bytes())[..6]))
}

/// Its place on the page.
pub fn anchor(scenario_id: &str) -> String {
    format!("case-{}", stem(scenario_id))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_ids_stay_and_others_differ() {
        assert_eq!(stem("03-intersection-straight-left"), "03-intersection-straight-left");
        let odd = ["../../etc/passwd", "", ".", "..", "A", "a b", "a/b", "a\u{0}b", &"x".repeat(200), "</script>"];
        let mut names: Vec<String> = odd.iter().map(|id| stem(id)).collect();
        for name in &names {
            assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || "._-".contains(c)), "{name}");
            assert!(!name.starts_with('.') && !name.contains('/') && name.len() <= 100, "{name}");
        }
        names.sort();
        names.dedup();
        assert_eq!(names.len(), odd.len());
    }
}

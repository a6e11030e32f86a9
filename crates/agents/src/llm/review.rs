//! The role that reviews: what a model finds who holds a replay against its report.

use recrash_model::review::{LONGEST_NOTE, Review};

/// The answer, where it says what is shown otherwise than told; its note in one line, and only where there is something to note.
///
/// # Errors
/// A field is `no`, and nothing says why.
pub(super) fn taken(answer: Review) -> Result<Review, Vec<String>> {
    let note = in_one_line(&answer.note);
    let wrong: Vec<&str> = answer.wrong().collect();
    if wrong.is_empty() {
        return Ok(Review { note: String::new(), ..answer });
    }
    if note.is_empty() {
        let what = format!(
            "note is empty, and no stands for {}: say in one sentence what is told and what is shown instead",
            wrong.join(", ")
        );
        return Err(vec![what]);
    }
    Ok(Review { note, ..answer })
}

/// A note as it is kept.
pub(super) fn in_one_line(note: &str) -> String {
    // Marks that turn the direction of text would turn what stands behind the note.
    let turns = |c: char| matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let words = note.split(|c: char| c.is_whitespace() || c.is_control() || turns(c)).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join(" ").chars().take(LONGEST_NOTE).collect()
}

//! The role that reviews: what a model finds who holds a replay against its report.

use recrash_model::review::{LONGEST_NOTE, Review};

/// The answer, where it says what is shown otherwise than told; its note in one line, and only where there is something to note.
///
/// # Errors
/// A field is `no`, and nothing says why.
pub(super) fn taken(answer: Review) -> Result<Review, Vec<String>> {
    let words: Vec<&str> = answer.note.split(|c: char| c.is_whitespace() || c.is_control()).collect();
    let note: String = words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ");
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
    Ok(Review { note: note.chars().take(LONGEST_NOTE).collect(), ..answer })
}

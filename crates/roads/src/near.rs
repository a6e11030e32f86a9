//! Names that were probably meant.

/// A hint: the known name that was probably meant, and what is known.
pub(crate) fn near_names(found: &str, known: &[&str]) -> String {
    const SHOWN: usize = 12;
    let more = if known.len() > SHOWN { format!(" and {} more", known.len() - SHOWN) } else { String::new() };
    let listed = format!("known: {}{more}", known[..known.len().min(SHOWN)].join(", "));
    match nearest(found, known) {
        Some(meant) => format!("did you mean `{meant}`? {listed}"),
        None => listed,
    }
}

/// The known name that was probably meant.
pub fn nearest<'a>(found: &str, known: &[&'a str]) -> Option<&'a str> {
    let found: String = found.chars().take(40).collect();
    known
        .iter()
        .map(|name| (edits(&found, name), *name))
        .filter(|(edits, name)| *edits <= 1 + name.len() / 4 || (found.len() > 3 && name.starts_with(&found)))
        .min()
        .map(|(_, name)| name)
}

/// Levenshtein's distance: the fewest insertions, deletions and replacements of one letter.
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}

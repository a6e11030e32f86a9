//! From a path such as `partners[0].start` back to the line of the JSON text it stands on.

use recrash_model::Diagnostic;

/// Diagnostics that are given their line: each is looked for from the beginning of the text, and nobody mends more at once.
const MOST_LINES: usize = 1000;

/// Fills in the line of every diagnostic that has a JSON path, so that an editor can jump to it.
pub fn add_lines(json: &str, diagnostics: &mut [Diagnostic]) {
    for diagnostic in diagnostics.iter_mut().take(MOST_LINES) {
        if let (None, Some(path)) = (diagnostic.location.line, &diagnostic.location.path) {
            diagnostic.location.line = locate(json, path).map(|(line, _)| line);
        }
    }
}

/// Line and column (from 1) of the value at a path; of the nearest thing around it where the text has no such value.
pub fn locate(json: &str, path: &str) -> Option<(u64, u64)> {
    let bytes = json.as_bytes();
    let mut at = skip_space(bytes, 0);
    for step in steps(path) {
        let found = match step {
            Step::Field(name) => field(json, at, name),
            Step::Index(index) => element(bytes, at, index),
        };
        match found {
            Some(position) => at = position,
            None => break,
        }
    }
    (at < bytes.len()).then(|| {
        let before = &bytes[..at];
        let line = before.iter().filter(|byte| **byte == b'\n').count() + 1;
        let column = at - before.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1) + 1;
        (line as u64, column as u64)
    })
}

enum Step<'a> {
    Field(&'a str),
    Index(usize),
}

fn steps(path: &str) -> Vec<Step<'_>> {
    let mut found = Vec::new();
    for part in path.split('.') {
        let mut pieces = part.split('[');
        if let Some(name) = pieces.next().filter(|name| !name.is_empty()) {
            found.push(Step::Field(name));
        }
        found.extend(pieces.filter_map(|piece| piece.trim_end_matches(']').parse().ok()).map(Step::Index));
    }
    found
}

fn skip_space(bytes: &[u8], mut at: usize) -> usize {
    while bytes.get(at).is_some_and(u8::is_ascii_whitespace) {
        at += 1;
    }
    at
}

/// The end of the string that begins at `at`.
fn skip_string(bytes: &[u8], at: usize) -> usize {
    let mut end = at + 1;
    while end < bytes.len() {
        match bytes[end] {
            b'\\' => end += 2,
            b'"' => return end + 1,
            _ => end += 1,
        }
    }
    bytes.len()
}

/// The end of the value that begins at `at`.
fn skip_value(bytes: &[u8], at: usize) -> usize {
    let mut depth = 0_usize;
    let mut end = at;
    while end < bytes.len() {
        match bytes[end] {
            b'"' => {
                end = skip_string(bytes, end);
                if depth == 0 {
                    return end;
                }
                continue;
            }
            b'{' | b'[' => depth += 1,
            b'}' | b']' if depth == 0 => return end,
            b'}' | b']' => {
                depth -= 1;
                if depth == 0 {
                    return end + 1;
                }
            }
            b',' if depth == 0 => return end,
            _ => {}
        }
        end += 1;
    }
    end
}

fn field(json: &str, at: usize, name: &str) -> Option<usize> {
    let bytes = json.as_bytes();
    if bytes.get(at) != Some(&b'{') {
        return None;
    }
    let mut key = skip_space(bytes, at + 1);
    while bytes.get(key) == Some(&b'"') {
        let key_end = skip_string(bytes, key);
        let colon = skip_space(bytes, key_end);
        let value = skip_space(bytes, colon + 1);
        let written = json.get(key..key_end).and_then(|text| serde_json::from_str::<String>(text).ok());
        if written.as_deref() == Some(name) {
            return Some(value);
        }
        let comma = skip_space(bytes, skip_value(bytes, value));
        key = skip_space(bytes, comma + 1);
    }
    None
}

fn element(bytes: &[u8], at: usize, index: usize) -> Option<usize> {
    if bytes.get(at) != Some(&b'[') {
        return None;
    }
    let mut value = skip_space(bytes, at + 1);
    for _ in 0..index {
        let comma = skip_space(bytes, skip_value(bytes, value));
        if bytes.get(comma) != Some(&b',') {
            return None;
        }
        value = skip_space(bytes, comma + 1);
    }
    (bytes.get(value).is_some_and(|byte| *byte != b']')).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::locate;

    const TEXT: &str = "{\n  \"a\": [1, {\"b\": \"}\\\"\",\n    \"c\": 2}],\n  \"d\": null\n}";

    #[test]
    fn values_are_found_by_path() {
        assert_eq!(locate(TEXT, "a"), Some((2, 8)));
        assert_eq!(locate(TEXT, "a[1].b"), Some((2, 18)));
        assert_eq!(locate(TEXT, "a[1].c"), Some((3, 10)));
        assert_eq!(locate(TEXT, "d"), Some((4, 8)));
    }

    #[test]
    fn what_is_missing_points_to_what_is_around_it() {
        assert_eq!(locate(TEXT, "a[1].x"), locate(TEXT, "a[1]"));
        assert_eq!(locate(TEXT, "a[7]"), locate(TEXT, "a"));
        assert_eq!(locate(TEXT, "nothing"), Some((1, 1)));
        assert_eq!(locate("", "a"), None);
    }
}

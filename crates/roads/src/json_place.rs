//! From a path such as `partners[0].start` to the line of the JSON text it stands on, and back.

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

/// What is open at a place of a text.
enum Open {
    /// An object, and the key whose value was begun.
    Object(Option<String>),
    /// An array, and which element was begun.
    Array(usize),
}

/// Path of the value that was being read where a reader stopped: the line and column (from 1) of the last byte it took, as
/// `serde_json` tells them. "." is the whole document.
pub fn path_at(json: &[u8], line: usize, column: usize) -> String {
    let before =
        json.split_inclusive(|byte| *byte == b'\n').take(line.saturating_sub(1)).map(<[u8]>::len).sum::<usize>();
    let last = (before + column).saturating_sub(1).min(json.len());
    let (mut open, mut at): (Vec<Open>, usize) = (Vec::new(), 0);
    while at < last {
        match json[at] {
            b'"' => {
                let end = skip_string(json, at);
                if let Some(Open::Object(key @ None)) = open.last_mut() {
                    if end > last {
                        break;
                    }
                    *key = serde_json::from_slice(&json[at..end]).ok();
                }
                at = end;
                continue;
            }
            b'{' => open.push(Open::Object(None)),
            b'[' => open.push(Open::Array(0)),
            b'}' | b']' => drop(open.pop()),
            b',' => match open.last_mut() {
                Some(Open::Object(key)) => *key = None,
                Some(Open::Array(index)) => *index += 1,
                None => {}
            },
            _ => {}
        }
        at += 1;
    }
    // Whoever stops at the end of an object or array has read all that is in it.
    match (json.get(last), open.last_mut()) {
        (Some(b'}'), Some(Open::Object(key))) => *key = None,
        (Some(b']'), Some(Open::Array(_))) => drop(open.pop()),
        _ => {}
    }
    let mut path = String::new();
    for step in open {
        match step {
            Open::Object(Some(key)) if path.is_empty() => path = key,
            Open::Object(Some(key)) => path += &format!(".{key}"),
            Open::Object(None) => {}
            Open::Array(index) => path += &format!("[{index}]"),
        }
    }
    if path.is_empty() { ".".to_owned() } else { path }
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
    use super::{locate, path_at};

    const TEXT: &str = "{\n  \"a\": [1, {\"b\": \"}\\\"\",\n    \"c\": 2}],\n  \"d\": null\n}";

    #[test]
    fn values_are_found_by_path() {
        assert_eq!(locate(TEXT, "a"), Some((2, 8)));
        assert_eq!(locate(TEXT, "a[1].b"), Some((2, 18)));
        assert_eq!(locate(TEXT, "a[1].c"), Some((3, 10)));
        assert_eq!(locate(TEXT, "d"), Some((4, 8)));
    }

    #[test]
    fn where_a_reader_stops_is_a_path() {
        #[derive(Debug, serde::Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[expect(dead_code, reason = "read for its errors")]
        enum Kind {
            Car { length_m: f64 },
            Thing,
        }
        #[derive(Debug, serde::Deserialize)]
        #[expect(dead_code, reason = "read for its errors")]
        struct Part {
            kind: Kind,
            sizes: [f64; 2],
            name: Option<String>,
        }
        #[derive(Debug, serde::Deserialize)]
        #[expect(dead_code, reason = "read for its errors")]
        struct Whole {
            parts: Vec<Part>,
            seed: u8,
        }
        let good = "{\n  \"parts\": [\n    {\"kind\": \"thing\", \"sizes\": [1.0, 2.0], \"name\": \"}\\\"]\"},\n    {\"kind\": {\"car\": {\"length_m\": 4}}, \"sizes\": [3, 4]}\n  ],\n  \"seed\": 7\n}";
        assert!(serde_json::from_str::<Whole>(good).is_ok());
        for (of, by) in [
            ("\"thing\"", "\"lorry\""),
            ("\"thing\"", "7"),
            ("1.0,", "\"one\","),
            ("[1.0, 2.0]", "[1.0]"),
            ("\"sizes\": [3, 4]", "\"size\": [3, 4]"),
            ("\"length_m\": 4", "\"length_m\": {}"),
            ("\"length_m\": 4", "\"length\": 4"),
            ("\"seed\": 7", "\"seed\": 700"),
            (",\n  \"seed\": 7", ""),
            ("\"seed\": 7", "\"seed\": null"),
            ("\"name\": ", "\"name\": [], \"of\": "),
        ] {
            let bad = good.replacen(of, by, 1);
            let error = serde_json::from_str::<Whole>(&bad).unwrap_err();
            let followed: Result<Whole, _> =
                serde_path_to_error::deserialize(&mut serde_json::Deserializer::from_str(&bad));
            let followed = followed.unwrap_err().path().to_string();
            assert_eq!(path_at(bad.as_bytes(), error.line(), error.column()), followed, "{error} in {bad}");
        }
        // One element too many is told where it is.
        assert_eq!(path_at(b"{\"a\": [1.0, 2.0, 3.0]}", 1, 18), "a[2]");
        assert_eq!(path_at(b"", 1, 0), ".");
        assert_eq!(path_at(b"{\"a\": [1, ", 1, 11), "a[1]");
        assert_eq!(path_at(b"]]", 9, 9), ".");
    }

    #[test]
    fn what_is_missing_points_to_what_is_around_it() {
        assert_eq!(locate(TEXT, "a[1].x"), locate(TEXT, "a[1]"));
        assert_eq!(locate(TEXT, "a[7]"), locate(TEXT, "a"));
        assert_eq!(locate(TEXT, "nothing"), Some((1, 1)));
        assert_eq!(locate("", "a"), None);
    }
}

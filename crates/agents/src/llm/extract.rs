//! Finds the JSON object in an answer: alone, in a code fence, in prose, or behind its drafts.

/// What a model that thinks aloud puts around it.
const THOUGHTS: (&str, &str) = ("<think>", "</think>");

/// The last JSON object of `answer` that stands in no other one, with comments and trailing commas taken out.
///
/// Servers without structured output wrap their JSON in words or fences, and models write drafts before they answer. Braces
/// inside strings do not count, and nothing within an object is taken for the answer where the object is broken.
///
/// # Errors
/// A sentence for the model: no object, a broken one, or a cut-off one.
pub fn json_object(answer: &str) -> Result<String, String> {
    let answer = behind_thoughts(answer);
    let mut last = None;
    let mut from = 0;
    while let Some(start) = answer[from..].find('{').map(|at| from + at) {
        from = start + 1;
        if !begins_an_object(&answer[from..]) {
            continue;
        }
        match read_object(&answer[start..]) {
            Some((end, object)) => {
                last = Some(object);
                from = start + end;
            }
            None => return Err("the JSON object is cut off; answer with one complete JSON object".to_owned()),
        }
    }
    let Some(object) = last else {
        let none = "there is no valid JSON object in the answer; answer with one JSON object and nothing else";
        return Err(none.to_owned());
    };
    match serde_json::from_str::<serde_json::Value>(&object) {
        Ok(_) => Ok(object),
        Err(e) => Err(format!("the last JSON object of the answer is no valid JSON: {e}; answer with one JSON object")),
    }
}

/// What follows the last thoughts. Thoughts without an end hold no answer.
fn behind_thoughts(answer: &str) -> &str {
    let behind = answer.rsplit_once(THOUGHTS.1).map_or(answer, |(_, behind)| behind);
    behind.split_once(THOUGHTS.0).map_or(behind, |(before, _)| before)
}

/// Whether what follows a brace is a field (with quotes or, wrongly, without) or the brace that closes it, and not a word of
/// prose.
fn begins_an_object(rest: &str) -> bool {
    let mut rest = rest.trim_start();
    while let Some(length) = comment(rest) {
        rest = rest[length..].trim_start();
    }
    if rest.is_empty() || rest.starts_with(['"', '\'', '}']) {
        return true;
    }
    let behind = rest.trim_start_matches(|letter: char| letter.is_alphanumeric() || letter == '_');
    behind.len() < rest.len() && behind.trim_start().starts_with(':')
}

/// Bytes of the comment that `text` begins with.
fn comment(text: &str) -> Option<usize> {
    if text.starts_with("//") {
        Some(text.find('\n').unwrap_or(text.len()))
    } else if text.starts_with("/*") {
        Some(text.find("*/").map_or(text.len(), |end| end + 2))
    } else {
        None
    }
}

/// The object that `text` begins with: its bytes, and what it says without comments and trailing commas. `None` where it does
/// not end.
fn read_object(text: &str) -> Option<(usize, String)> {
    let (mut depth, mut in_string, mut escaped) = (0_usize, false, false);
    let (mut object, mut at) = (String::new(), 0);
    while let Some(letter) = text[at..].chars().next() {
        if !in_string && let Some(length) = comment(&text[at..]) {
            at += length;
            continue;
        }
        match letter {
            _ if escaped => escaped = false,
            '\\' if in_string => escaped = true,
            '"' => in_string = !in_string,
            '{' if !in_string => depth += 1,
            '}' | ']' if !in_string => {
                let kept = object.trim_end();
                if let Some(kept) = kept.strip_suffix(',') {
                    object.truncate(kept.len());
                }
                depth -= usize::from(letter == '}');
            }
            _ => {}
        }
        object.push(letter);
        at += letter.len_utf8();
        if depth == 0 {
            return Some((at, object));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBJECT: &str = r#"{"a": {"b": 1}}"#;

    #[test]
    fn finds_the_object_wherever_it_stands() {
        for answer in [
            OBJECT,
            "Sure! Here it is:\n```json\n{\"a\": {\"b\": 1}}\n```\nAnything else?",
            "The set {x} is not JSON, and { is a brace, but this is: {\"a\": {\"b\": 1}}",
            "\u{feff}{\"a\": {\"b\": 1}}",
        ] {
            assert_eq!(json_object(answer).unwrap(), OBJECT, "{answer}");
        }
    }

    #[test]
    fn a_draft_does_not_replace_the_answer() {
        for answer in [
            r#"<think>Perhaps {"a": 0}? No.</think>{"a": {"b": 1}}"#,
            r#"First {"a": 0}, better: {"a": {"b": 1}} That is all."#,
            r#"Perhaps {"a": 0}</think>{"a": {"b": 1}}"#,
        ] {
            assert_eq!(json_object(answer).unwrap(), OBJECT, "{answer}");
        }
        for answer in [r#"<think>Perhaps {"a": 0}? No"#, r#"<think>{"a": 0}</think> I cannot say."#] {
            assert!(json_object(answer).unwrap_err().contains("no valid JSON"), "{answer}");
        }
        assert!(json_object(r#"Perhaps {"a": 0}? {"a": [1,"#).unwrap_err().contains("cut off"));
    }

    #[test]
    fn comments_and_trailing_commas_are_taken_out() {
        let answer = "{ // the road {\n \"a\": \"x // no, } comment\", /* } */ \"b\": [1, 2, ], \"c\": {\"d\": 1,},\n}";
        let value: serde_json::Value = serde_json::from_str(&json_object(answer).unwrap()).unwrap();
        assert_eq!(value, serde_json::json!({"a": "x // no, } comment", "b": [1, 2], "c": {"d": 1}}));
    }

    #[test]
    fn an_inner_object_is_not_taken_for_a_broken_answer() {
        let error = json_object(r#"{"map": {"type": "x"}, "ego": oops}"#).unwrap_err();
        assert!(error.contains("no valid JSON") && error.contains("column"), "{error}");
        for answer in [r#"{map: {"type": "x"}}"#, r#"{'map': {"type": "x"}}"#] {
            assert!(json_object(answer).unwrap_err().contains("no valid JSON"), "{answer}");
        }
    }

    #[test]
    fn braces_in_strings_do_not_count() {
        assert_eq!(json_object(r#"x {"a": "}{\"}"} y"#).unwrap(), r#"{"a": "}{\"}"}"#);
    }

    #[test]
    fn a_cut_off_object_and_none_at_all_are_told_apart() {
        assert!(json_object(r#"{"a": [1, 2"#).unwrap_err().contains("cut off"));
        assert!(json_object("I cannot help with that.").unwrap_err().contains("no valid JSON"));
    }

    #[test]
    fn braces_without_end_take_no_time() {
        assert!(json_object(&"{".repeat(200_000)).is_err());
        assert!(json_object(&"{\"a\":".repeat(50_000)).is_err());
    }
}

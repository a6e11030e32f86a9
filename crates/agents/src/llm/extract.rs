//! Finds the JSON object in an answer: alone, in a code fence, or in prose.

/// Longest answer that is looked at. [bytes]
const MAX_ANSWER: usize = 1 << 20;

/// The first complete JSON object in `answer`, the longest where several begin at the same place.
///
/// Servers without structured output wrap their JSON in words or fences. Braces inside strings do not count.
///
/// # Errors
/// A sentence for the model: no object, a cut-off one, or an answer that is too long.
pub fn json_object(answer: &str) -> Result<&str, String> {
    if answer.len() > MAX_ANSWER {
        return Err(format!("the answer is longer than {MAX_ANSWER} bytes"));
    }
    let mut cut_off = false;
    for (start, _) in answer.match_indices('{') {
        match object_end(&answer[start..]) {
            Some(end) => {
                let candidate = &answer[start..start + end];
                if serde_json::from_str::<serde_json::Value>(candidate).is_ok() {
                    return Ok(candidate);
                }
            }
            None => {
                cut_off = true;
                break;
            }
        }
    }
    Err(if cut_off {
        "the JSON object is cut off; answer with one complete JSON object".to_owned()
    } else {
        "there is no valid JSON object in the answer; answer with one JSON object and nothing else".to_owned()
    })
}

/// Bytes to the brace that closes the one `text` begins with.
fn object_end(text: &str) -> Option<usize> {
    let (mut depth, mut in_string, mut escaped) = (0_usize, false, false);
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            b'{' if !in_string => depth += 1,
            b'}' if !in_string => {
                depth -= 1;
                if depth == 0 {
                    return Some(at + 1);
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_object_wherever_it_stands() {
        for answer in [
            r#"{"a": {"b": 1}}"#,
            "Sure! Here it is:\n```json\n{\"a\": {\"b\": 1}}\n```\nAnything else?",
            "The set {x} is not JSON, but this is: {\"a\": {\"b\": 1}} and {\"c\": 2} comes later",
            "\u{feff}{\"a\": {\"b\": 1}}",
        ] {
            assert_eq!(json_object(answer).unwrap(), r#"{"a": {"b": 1}}"#, "{answer}");
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
}

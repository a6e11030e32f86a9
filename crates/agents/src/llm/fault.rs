//! A provider's fault, as this program acts on it.

use crate::llm::access::LiveOptions;
use serde_json::Value;
use ureq::http::{HeaderMap, Uri};

/// Longest time until a connection stands. [s]
pub const CONNECT_S: f64 = 4.0;
/// Most that is read of an answer; one of 16 000 tokens has 100 kB, with its thoughts perhaps ten times that. [bytes]
pub const MOST_BYTES: u64 = 4 << 20;

/// Longest text of a provider's that is passed on. [characters]
const LONGEST_TEXT: usize = 240;

/// How models find their servers.
const WHERE: &str = "Models are asked at the address given; without one, at the provider their name tells, and at Ollama where it tells none";

/// What is wrong, and what follows from it.
#[derive(Debug, PartialEq)]
pub enum Fault {
    /// No question will be answered: how to mend it.
    Refused(String),
    /// The server takes no such request: perhaps without the schema.
    Request(String),
    /// The answer has no end: asking again would cost the same once more.
    Endless(String),
    /// Asking again may help.
    Passing {
        /// What is wrong.
        why: String,
        /// When to ask again, where the provider says so. [s]
        retry_after_s: Option<f64>,
        /// Whether anybody answered at all.
        reachable: bool,
    },
}

impl Fault {
    /// Sorts an error of the client's.
    pub fn of(error: &ureq::Error, url: &str, options: &LiveOptions) -> Self {
        use std::io::ErrorKind::{ConnectionRefused, HostUnreachable, NetworkUnreachable, NotFound};
        use ureq::{Error, Timeout};
        let unreachable =
            |why: &str| Self::Passing { why: unreachable(url, why), retry_after_s: None, reachable: false };
        match error {
            Error::Timeout(Timeout::Connect | Timeout::Resolve) => {
                unreachable(&format!("no connection within {} s", options.timeout_s.min(CONNECT_S)))
            }
            Error::Timeout(_) => Self::Passing {
                why: format!("no whole answer within {} s", options.timeout_s),
                retry_after_s: None,
                reachable: true,
            },
            Error::BodyExceedsLimit(_) => Self::Endless(format!("its answer is longer than {MOST_BYTES} bytes")),
            Error::BadUri(_) | Error::Http(_) | Error::InvalidProxyUrl => {
                Self::Refused("the address or the key cannot be sent".to_owned())
            }
            Error::HostNotFound => unreachable("its name is not known"),
            Error::ConnectionFailed => unreachable("no connection"),
            Error::Io(e) if matches!(e.kind(), ConnectionRefused | HostUnreachable | NetworkUnreachable | NotFound) => {
                unreachable(&e.to_string())
            }
            Error::Tls(_) | Error::Rustls(_) => unreachable(&presentable(&error.to_string(), options)),
            _ => Self::broken(),
        }
    }

    /// An answer that is none.
    pub fn broken() -> Self {
        let why = "its answer was cut off, or is not what the protocol says".to_owned();
        Self::Passing { why, retry_after_s: None, reachable: true }
    }

    /// Sorts an answer with another status than 200.
    pub fn of_response(status: u16, headers: &HeaderMap, body: &[u8], options: &LiveOptions) -> Self {
        let header = |name: &str| headers.get(name).and_then(|value| value.to_str().ok());
        let retry_after_s = retry_after_s(header("retry-after-ms"), header("retry-after"));
        Self::of_status(status, &provider_text(&String::from_utf8_lossy(body), options), retry_after_s)
    }

    fn of_status(status: u16, text: &str, retry_after_s: Option<f64>) -> Self {
        let told = if text.is_empty() { format!("status {status}") } else { format!("status {status}, \"{text}\"") };
        match status {
            401 | 403 | 407 => Self::Refused(format!("the provider refuses the key ({told}); check its variable")),
            402 => Self::Refused(format!("the provider wants to be paid first ({told})")),
            300..=399 => Self::Refused(format!(
                "the server sends questions to another address ({told}), and keys are sent to none but the given one; give \
                 that one as the address"
            )),
            404 | 405 | 410 => Self::Refused(format!(
                "the provider knows no such model or address ({told}); check the name of the model, and the address"
            )),
            429 if text.contains("quota") && text.contains("billing") => {
                Self::Refused(format!("the account's quota is used up ({told})"))
            }
            408 | 409 | 425 | 429 | 500 | 502..=599 => Self::Passing { why: told, retry_after_s, reachable: true },
            _ => Self::Request(told),
        }
    }
}

/// Both headers count from now; a date is not understood, and the own patience takes its place.
fn retry_after_s(milliseconds: Option<&str>, seconds: Option<&str>) -> Option<f64> {
    let number = |text: Option<&str>| text?.trim().parse::<f64>().ok().filter(|n| n.is_finite() && *n >= 0.0);
    number(milliseconds).map(|ms| ms / 1e3).or_else(|| number(seconds))
}

/// The message in a provider's error, wherever it keeps it.
fn provider_text(body: &str, options: &LiveOptions) -> String {
    let parsed: Value = serde_json::from_str(body).unwrap_or_default();
    let places = ["/error/message", "/0/error/message", "/message", "/detail", "/error"];
    let message = places.iter().find_map(|place| parsed.pointer(place)?.as_str());
    presentable(message.unwrap_or(body), options)
}

/// The beginning of a stranger's text, on one line, without keys and control characters.
fn presentable(text: &str, options: &LiveOptions) -> String {
    let text = options.scrubber.scrub(text);
    let words: Vec<&str> =
        text.split(|c: char| c.is_whitespace() || c.is_control()).filter(|w| !w.is_empty()).collect();
    words.join(" ").chars().take(LONGEST_TEXT).collect()
}

/// That nobody answers at the host of an address, which may hold more than may be shown.
pub fn unreachable(url: &str, why: &str) -> String {
    let uri: Option<Uri> = url.parse().ok();
    let host = uri.as_ref().and_then(Uri::host).unwrap_or("the server");
    let port = uri.as_ref().and_then(Uri::port_u16).map(|port| format!(":{port}")).unwrap_or_default();
    format!("cannot connect to {host}{port} ({why}); is it running? {WHERE}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::llm::{PriceTable, Scrubber, Secret};

    fn options() -> LiveOptions {
        let scrubber = Scrubber::new(&[Secret::new("sk-planted")]);
        LiveOptions { scrubber, ..LiveOptions::new(PriceTable::built_in()) }
    }

    #[test]
    fn statuses_are_sorted_by_what_follows_from_them() {
        for status in [301, 307, 401, 403, 404] {
            assert!(matches!(Fault::of_status(status, "", None), Fault::Refused(_)), "{status}");
        }
        for status in [408, 429, 500, 503, 529] {
            assert!(matches!(Fault::of_status(status, "", None), Fault::Passing { .. }), "{status}");
        }
        for status in [400, 413, 422, 501] {
            assert!(matches!(Fault::of_status(status, "", None), Fault::Request(_)), "{status}");
        }
        let spent = "You exceeded your current quota, please check your plan and billing details.";
        assert!(matches!(Fault::of_status(429, spent, None), Fault::Refused(_)));
    }

    #[test]
    fn the_wait_is_read_in_milliseconds_and_seconds() {
        assert_eq!(retry_after_s(Some("250"), Some("7")), Some(0.25));
        assert_eq!(retry_after_s(None, Some(" 7 ")), Some(7.0));
        assert_eq!(retry_after_s(None, Some("Wed, 21 Oct 2026 07:28:00 GMT")), None);
        assert_eq!(retry_after_s(None, Some("-1")), None);
    }

    #[test]
    fn a_providers_text_is_one_line_without_keys_and_control_characters() {
        let body = "{\"error\": {\"message\": \"bad key\\nsk-planted \\u001b[31mred\"}}";
        assert_eq!(provider_text(body, &options()), "bad key [key] [31mred");
        assert_eq!(provider_text("plain sk-planted", &options()), "plain [key]");
        assert_eq!(presentable(&"x".repeat(10_000), &options()).len(), LONGEST_TEXT);
    }
}

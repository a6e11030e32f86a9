//! A provider's fault, as this program acts on it.

use crate::llm::access::LiveOptions;
use crate::llm::secrets::redact;
use genai::resolver;
use serde_json::Value;

/// Longest text of a provider's that is passed on. [characters]
const LONGEST_TEXT: usize = 240;

/// How models find their servers.
const WHERE: &str =
    "Models are asked at --base-url; without it, at the provider their name tells, and at Ollama where it tells none";

/// What is wrong, and what follows from it.
#[derive(Debug, PartialEq)]
pub enum Fault {
    /// No question will be answered: how to mend it.
    Refused(String),
    /// The server takes no such request: perhaps without the schema.
    Request(String),
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
    /// Sorts an error.
    pub fn of(error: &genai::Error, options: &LiveOptions) -> Self {
        use genai::Error::{
            ChatResponseGeneration, NoAuthData, NoAuthResolver, RequiresApiKey, Resolver, WebAdapterCall, WebModelCall,
        };
        use genai::webc::Error as Web;
        let passing = |why: String, reachable| Self::Passing { why, retry_after_s: None, reachable };
        let broken = "its answer was cut off, or is not what the protocol says".to_owned();
        match error {
            Resolver { resolver_error: resolver::Error::ApiKeyEnvNotFound { env_name }, model_iden } => {
                let model = &model_iden.model_name;
                Self::Refused(format!("{model} needs a key: set the environment variable {env_name} to it"))
            }
            RequiresApiKey { model_iden } | NoAuthData { model_iden } | NoAuthResolver { model_iden } => {
                Self::Refused(format!("{} needs a key in the environment", model_iden.model_name))
            }
            WebModelCall { webc_error, .. } | WebAdapterCall { webc_error, .. } => match webc_error {
                Web::ResponseFailedStatus { status, body, headers } => {
                    let header = |name: &str| headers.get(name).and_then(|value| value.to_str().ok());
                    let retry_after_s = retry_after_s(header("retry-after-ms"), header("retry-after"));
                    Self::of_status(status.as_u16(), &provider_text(body, options), retry_after_s)
                }
                Web::Reqwest(e) if e.is_timeout() => {
                    passing(format!("no answer within {} s (--timeout)", options.timeout_s), true)
                }
                Web::Reqwest(e) if e.is_builder() => Self::Refused("the address or the key cannot be sent".to_owned()),
                Web::Reqwest(e) if e.is_connect() => {
                    let host = e.url().and_then(|url| url.host_str()).unwrap_or("the server");
                    let port = e.url().and_then(|url| url.port()).map(|port| format!(":{port}")).unwrap_or_default();
                    passing(
                        format!("cannot connect to {host}{port} ({}); is it running? {}", innermost(e), WHERE),
                        false,
                    )
                }
                _ => passing(broken, true),
            },
            ChatResponseGeneration { .. } => passing(broken, true),
            other => Self::Request(presentable(&other.to_string(), options)),
        }
    }

    fn of_status(status: u16, text: &str, retry_after_s: Option<f64>) -> Self {
        let told = if text.is_empty() { format!("status {status}") } else { format!("status {status}, \"{text}\"") };
        match status {
            401 | 403 | 407 => Self::Refused(format!("the provider refuses the key ({told}); check its variable")),
            402 => Self::Refused(format!("the provider wants to be paid first ({told})")),
            404 | 405 | 410 => Self::Refused(format!(
                "the provider knows no such model or address ({told}); check the name of the model, and --base-url"
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
    let text = redact(text, &options.secrets);
    let words: Vec<&str> =
        text.split(|c: char| c.is_whitespace() || c.is_control()).filter(|w| !w.is_empty()).collect();
    words.join(" ").chars().take(LONGEST_TEXT).collect()
}

/// What the operating system said.
fn innermost(error: &impl std::error::Error) -> String {
    let mut cause = error.source();
    let mut text = "no connection".to_owned();
    while let Some(inner) = cause {
        text = inner.to_string();
        cause = inner.source();
    }
    text.chars().take(LONGEST_TEXT).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::llm::{PriceTable, Secret};

    fn options() -> LiveOptions {
        LiveOptions { secrets: vec![Secret::new("sk-planted")], ..LiveOptions::new(PriceTable::built_in()) }
    }

    #[test]
    fn statuses_are_sorted_by_what_follows_from_them() {
        for status in [401, 403, 404] {
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

//! The keys in our environment: read for who is asked with them, and blacked out everywhere else.

use recrash_agents::llm::{Scrubber, Secret};

/// Endings of the names of variables that hold keys.
const KEY_ENDINGS: [&str; 6] = ["_KEY", "_TOKEN", "_SECRET", "_PASSWORD", "_PASSWD", "_CREDENTIALS"];

/// A key by the name of its variable; none where it is empty.
pub(crate) fn key(variable: &str) -> Option<Secret> {
    std::env::var(variable).ok().map(|key| Secret::new(&key)).filter(|key| !key.expose().is_empty())
}

/// Blacks out every key in our environment.
pub(crate) fn scrubber() -> Scrubber {
    let is_key = |name: &str| KEY_ENDINGS.iter().any(|ending| name.to_ascii_uppercase().ends_with(ending));
    let variables = std::env::vars_os().filter_map(|(name, value)| Some((name.into_string().ok()?, value)));
    let values = variables.filter(|(name, _)| is_key(name)).filter_map(|(_, value)| value.into_string().ok());
    Scrubber::new(&values.map(|value| Secret::new(&value)).collect::<Vec<_>>())
}

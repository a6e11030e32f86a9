//! Format tags: a document of a format that this version does not read is refused where it is read.

use serde::de::Error;
use serde::{Deserialize, Deserializer};

/// Reads a format tag that must be this one.
///
/// # Errors
/// It is another one: both are named.
pub(crate) fn known<'de, D: Deserializer<'de>>(deserializer: D, format: &str) -> Result<String, D::Error> {
    let found = String::deserialize(deserializer)?;
    if found == format {
        Ok(found)
    } else {
        Err(Error::custom(format_args!("format is {found:?}; this version reads {format:?}")))
    }
}

#[cfg(test)]
mod tests {
    use crate::account::{Account, AccountSet};
    use crate::narrative::Narrative;
    use crate::run::Judgement;
    use crate::triage::Triage;
    use crate::tuning::TuneLog;
    use serde::de::DeserializeOwned;

    type Read = fn(&str) -> String;

    fn told<T: DeserializeOwned>(format: &str) -> String {
        let read: Result<T, _> = serde_json::from_value(serde_json::json!({ "format": format }));
        read.err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn every_document_of_a_suite_is_refused_by_a_format_that_is_not_its_own() {
        let all: [(&str, Read); 6] = [
            (crate::narrative::NARRATIVE_FORMAT, told::<Narrative>),
            (crate::account::ACCOUNT_FORMAT, told::<Account>),
            (crate::account::ACCOUNTS_FORMAT, told::<AccountSet>),
            (crate::run::RUN_FORMAT, told::<Judgement>),
            (crate::tuning::TUNE_FORMAT, told::<TuneLog>),
            (crate::triage::TRIAGE_FORMAT, told::<Triage>),
        ];
        for (format, read) in all {
            assert_eq!(read("x/9"), format!("format is \"x/9\"; this version reads \"{format}\""));
            // Of its own it is asked for the rest.
            assert!(read(format).starts_with("missing field"), "{}", read(format));
        }
    }
}

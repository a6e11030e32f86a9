//! How live models are reached, and how patiently.

use crate::llm::prices::PriceTable;
use crate::llm::secrets::{Scrubber, Secret};
use crate::llm::spending::Caps;

/// How live models are asked. No byte of a question depends on it.
#[derive(Debug, Clone)]
pub struct LiveOptions {
    /// Address of an OpenAI-compatible server (Ollama, vLLM, llama.cpp); the model's own provider where not given.
    pub base_url: Option<String>,
    /// Key for `base_url`.
    pub key: Option<Secret>,
    /// Key of a provider by the name of its variable, such as `OPENAI_API_KEY`.
    pub provider_key: fn(&str) -> Option<Secret>,
    /// Blacks out every key that must not be seen in an answer or an error.
    pub scrubber: Scrubber,
    /// Longest time for one answer. [s]
    pub timeout_s: f64,
    /// How often a question is asked again after a passing fault: 429, 5xx, a time-out, a broken connection.
    pub retries: u32,
    /// Caps on what the run spends.
    pub caps: Caps,
    /// Prices.
    pub prices: PriceTable,
}

impl LiveOptions {
    /// Patience that suits hosted models and small local ones; nothing capped, nothing priced.
    pub fn new(prices: PriceTable) -> Self {
        let (timeout_s, retries) = (300.0, 4);
        let scrubber = Scrubber::default();
        let (base_url, key, provider_key, caps): (_, _, fn(&str) -> _, _) = (None, None, |_| None, Caps::default());
        Self { base_url, key, provider_key, scrubber, timeout_s, retries, caps, prices }
    }

    /// Checks what can be wrong before anything is asked. `models` are those that will be asked.
    ///
    /// # Errors
    /// One sentence, and how to mend it.
    pub fn check(&self, models: &[&str]) -> Result<(), String> {
        if let Some(url) = &self.base_url {
            check_address(url)?;
        }
        if self.caps.cost_usd.is_some() {
            let unknown: Vec<&str> = models.iter().copied().filter(|m| self.prices.price(m).is_none()).collect();
            if !unknown.is_empty() {
                return Err(format!(
                    "a cap on costs needs a price, and none is known for {}; give one in a file of prices, or cap the tokens",
                    unknown.join(", ")
                ));
            }
        }
        Ok(())
    }
}

fn check_address(url: &str) -> Result<(), String> {
    let rest = url.strip_prefix("https://").or_else(|| url.strip_prefix("http://"));
    let wrong = match rest {
        None => "it starts with http:// or https://",
        Some(rest) if rest.split('/').next().unwrap_or_default().is_empty() => "there is no host in it",
        Some(rest) if rest.contains('@') => "it holds a name or a password; put the key into RECRASH_API_KEY",
        Some(rest) if rest.contains(['?', '#']) => "it ends before any ? or #; put the key into RECRASH_API_KEY",
        Some(_) => return Ok(()),
    };
    // The address is not repeated: it may hold a password.
    Err(format!("the address given is none of a server, such as http://localhost:11434/v1: {wrong}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_with_a_password_is_refused_without_showing_it() {
        let told = |url: &str| {
            let options = LiveOptions { base_url: Some(url.into()), ..LiveOptions::new(PriceTable::built_in()) };
            options.check(&["m"])
        };
        assert_eq!(told("http://localhost:8000/v1"), Ok(()));
        for bad in ["localhost:8000", "ftp://x", "http:///v1", "https://me:hunter2@host/v1", "http://h/v1?key=hunter2"]
        {
            assert!(!told(bad).unwrap_err().contains("hunter2"), "{bad}");
        }
    }

    #[test]
    fn a_cap_on_money_needs_a_price() {
        let caps = Caps { cost_usd: Some(1.0), tokens: None };
        let options = LiveOptions { caps, ..LiveOptions::new(PriceTable::built_in()) };
        assert_eq!(options.check(&["gpt-5-mini", "openai::gpt-5"]), Ok(()));
        assert!(options.check(&["gpt-5-mini", "qwen3:8b"]).unwrap_err().contains("known for qwen3:8b;"));
    }
}

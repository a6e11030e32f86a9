//! What tokens cost: a table with date and source, which a file of the user's goes before.

use serde::{Deserialize, Serialize};

/// The built-in table.
const BUILT_IN: &str = include_str!("../../prices.toml");

/// Prices of models.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PriceTable {
    /// Prices, those that go before others first.
    #[serde(rename = "model")]
    models: Vec<ModelPrice>,
}

/// The price of a model, or of a family of models.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelPrice {
    /// Name of the model, such as `gpt-5-mini`; also its dated editions, such as `gpt-5-mini-2025-08-07`.
    pub name: String,
    /// A million tokens read. [USD]
    pub input_usd: f64,
    /// A million tokens written. [USD]
    pub output_usd: f64,
    /// Share of these prices that a batch costs. [1]
    #[serde(default = "whole")]
    pub batch_share: f64,
    /// Day on which the price was looked up, such as `2026-07-29`.
    pub checked: String,
    /// Where it was looked up.
    pub source: String,
}

fn whole() -> f64 {
    1.0
}

impl PriceTable {
    /// The built-in table.
    pub fn built_in() -> Self {
        Self::parse(BUILT_IN).expect("a test reads the built-in table")
    }

    /// Reads a table in the form of the built-in one.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn parse(text: &str) -> Result<Self, String> {
        let table: Self = toml::from_str(text).map_err(|e| e.to_string().trim_end().to_owned())?;
        for price in &table.models {
            let numbers = [price.input_usd, price.output_usd, price.batch_share];
            if !numbers.iter().all(|number| number.is_finite() && *number >= 0.0) {
                return Err(format!("{}: prices are finite numbers from 0", price.name));
            }
        }
        Ok(table)
    }

    /// This table with `first` going before it.
    #[must_use]
    pub fn after(self, first: Self) -> Self {
        Self { models: first.models.into_iter().chain(self.models).collect() }
    }

    /// The price of a model, where one is known: under its own name, or under the name without its date. A provider's
    /// prefix (`openai::`) does not count.
    pub fn price(&self, model: &str) -> Option<&ModelPrice> {
        let model = plain_name(model);
        let exact = self.models.iter().find(|price| price.name == model);
        exact.or_else(|| self.models.iter().find(|price| model.strip_prefix(&price.name).is_some_and(is_date)))
    }
}

impl ModelPrice {
    /// What an exchange of so many tokens costs. [USD]
    pub fn cost_usd(&self, input_tokens: u64, output_tokens: u64) -> f64 {
        (input_tokens as f64 * self.input_usd + output_tokens as f64 * self.output_usd) / 1e6
    }
}

/// A model's name without the prefix that names its provider: `gpt-5` of `openai::gpt-5`.
pub fn plain_name(model: &str) -> &str {
    model.split_once("::").map_or(model, |(_, name)| name)
}

/// `-2025-08-07` or `-20250807`, as providers date the editions of a model.
fn is_date(ending: &str) -> bool {
    let digits = ending.bytes().filter(u8::is_ascii_digit).count();
    ending.starts_with('-') && digits == 8 && ending.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_price_has_a_day_and_a_source() {
        let table = PriceTable::built_in();
        assert!(table.models.len() > 20);
        for price in &table.models {
            assert!(is_date(&format!("-{}", price.checked)), "{price:?}");
            assert!(price.source.starts_with("https://"), "{price:?}");
            assert!(price.output_usd > price.input_usd && price.input_usd > 0.0, "{price:?}");
        }
    }

    #[test]
    fn dated_editions_cost_what_their_model_costs_and_relatives_do_not() {
        let table = PriceTable::built_in();
        let mini = table.price("gpt-5-mini").unwrap();
        assert_eq!(table.price("openai::gpt-5-mini-2025-08-07"), Some(mini));
        assert_eq!(table.price("claude-haiku-4-5-20251001").unwrap().name, "claude-haiku-4-5");
        assert_ne!(table.price("gpt-5").unwrap(), mini);
        assert_eq!(table.price("gpt-5-maxi"), None);
        assert_eq!(table.price("llama3.1:8b"), None);
    }

    #[test]
    fn a_file_of_the_users_goes_before_the_table() {
        let own = "[[model]]\nname = 'gpt-5-mini'\ninput_usd = 1\noutput_usd = 3\nchecked = '2026-11-01'\nsource = 'contract'";
        let table = PriceTable::built_in().after(PriceTable::parse(own).unwrap());
        assert!((table.price("gpt-5-mini").unwrap().cost_usd(1_000_000, 2_000_000) - 7.0).abs() < 1e-12);
        assert!(PriceTable::parse("[[model]]\nname = 'x'").unwrap_err().contains("input_usd"));
        assert!(PriceTable::parse(&own.replace("= 3", "= -3")).is_err());
    }
}

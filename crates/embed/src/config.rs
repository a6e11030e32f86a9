//! `config.json`: the sizes of the model.

use crate::EmbedError;
use serde::Deserialize;

/// Greatest size of anything; bounds what a damaged file can ask for.
const MAX_SIZE: usize = 1 << 20;

/// The fields of `config.json` that matter here.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(crate) struct Config {
    pub model_type: String,
    pub hidden_act: String,
    pub hidden_size: usize,
    pub intermediate_size: usize,
    pub layer_norm_eps: f32,
    pub max_position_embeddings: usize,
    pub num_attention_heads: usize,
    pub num_hidden_layers: usize,
    pub vocab_size: usize,
}

impl Config {
    pub fn read(bytes: &[u8]) -> Result<Self, EmbedError> {
        let config: Self = serde_json::from_slice(bytes).map_err(|e| EmbedError::Config(e.to_string()))?;
        let unsupported = |field, found: String, allowed| Err(EmbedError::Unsupported { field, found, allowed });
        if config.model_type != "bert" {
            return unsupported("model_type", format!("{:?}", config.model_type), "only \"bert\" is known");
        }
        if config.hidden_act != "gelu" {
            return unsupported("hidden_act", format!("{:?}", config.hidden_act), "only \"gelu\" is known");
        }
        for (field, size) in [
            ("hidden_size", config.hidden_size),
            ("intermediate_size", config.intermediate_size),
            ("num_attention_heads", config.num_attention_heads),
            ("num_hidden_layers", config.num_hidden_layers),
            ("vocab_size", config.vocab_size),
        ] {
            if !(1..=MAX_SIZE).contains(&size) {
                return unsupported(field, size.to_string(), "it must be from 1 to 1048576");
            }
        }
        if !(3..=MAX_SIZE).contains(&config.max_position_embeddings) {
            let found = config.max_position_embeddings.to_string();
            return unsupported("max_position_embeddings", found, "it must be from 3 to 1048576");
        }
        if !config.hidden_size.is_multiple_of(config.num_attention_heads) {
            let found = config.num_attention_heads.to_string();
            return unsupported("num_attention_heads", found, "it must divide hidden_size");
        }
        if !(0.0..=1.0).contains(&config.layer_norm_eps) {
            return unsupported("layer_norm_eps", config.layer_norm_eps.to_string(), "it must be from 0 to 1");
        }
        Ok(config)
    }
}

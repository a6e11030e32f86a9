//! Embeddings of narratives by `all-MiniLM-L6-v2`, from a folder of local files.

use crate::error::PipelineError;
use crate::store::read_bytes;
use rayon::prelude::*;
use recrash_embed::{Embedder, MINILM_NAME, MODEL_FILES, ModelFiles};
use recrash_model::record::RecordSet;
use recrash_select::{Embedding, SelectError};
use std::path::Path;

/// Model files larger than this are refused. [bytes]
const MAX_MODEL_FILE: u64 = 1 << 30;

/// Loads the model from a folder with its three files.
///
/// # Errors
/// A file is missing or is not the model's.
pub fn load(folder: &Path) -> Result<Embedder, PipelineError> {
    let [config, weights, vocabulary] = MODEL_FILES.map(|name| read_bytes(&folder.join(name), MAX_MODEL_FILE));
    let (config, weights, vocabulary) = (config?, weights?, vocabulary?);
    Embedder::new(ModelFiles { config: &config, weights: &weights, vocabulary: &vocabulary })
        .map_err(|e| PipelineError::bad_input(format!("{}: {e}", folder.display())))
}

/// Embeds the narratives of the usable records, in parallel, in their order.
///
/// # Errors
/// A vector is not finite.
pub fn embed(model: &Embedder, records: &RecordSet) -> Result<Embedding, SelectError> {
    let rows: Vec<Vec<f32>> =
        records.usable.par_iter().map(|&index| model.embed_text(&records.records[index].narrative)).collect();
    Embedding::new(MINILM_NAME, &rows)
}

//! Which embedding of the narratives a suite uses, and its rows: computed in parallel, kept by content.

pub(crate) mod weights;

use crate::embedding::weights::{find_weights, load};
use crate::error::{Choice, PipelineError};
use crate::files::json::to_compact_json;
use crate::files::store::sha256;
use rayon::prelude::*;
use recrash_embed::{Embedder, MINILM_NAME};
use recrash_model::diagnostic::{Diagnostic, Location, Severity};
use recrash_model::record::RecordSet;
use recrash_model::selection::Strategy;
use recrash_select::{EMBEDDING_GRID, Embedding, SelectError, embed_records, usable_narratives, usable_reporters};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Which embedding of the narratives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EmbeddingKind {
    /// MiniLM where its files are on this machine, else the lexical one.
    #[default]
    Auto,
    /// The lexical one, which needs no files.
    Lexical,
    /// MiniLM, or an error.
    Minilm,
}

impl EmbeddingKind {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Lexical, Self::Minilm];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Lexical => "lexical",
            Self::Minilm => "minilm",
        }
    }
}

/// What embeds the narratives of a suite.
#[derive(Debug)]
pub enum Embeds {
    /// Words.
    Lexical,
    /// A model.
    Model(Box<Embedder>),
}

impl Embeds {
    /// What the user asked for, as far as it is on this machine; with remarks on what was passed over. Files that nobody
    /// named are used only where they are the published ones.
    ///
    /// # Errors
    /// A model was asked for and is not there, or its files are damaged.
    pub fn choose(
        kind: EmbeddingKind,
        model_dir: Option<&Path>,
        python: &Path,
    ) -> Result<(Self, Vec<Diagnostic>), PipelineError> {
        if kind == EmbeddingKind::Lexical {
            return Ok((Self::Lexical, Vec::new()));
        }
        if let Some(folder) = model_dir {
            return Ok((Self::Model(Box::new(load(folder)?)), Vec::new()));
        }
        let Some(weights) = find_weights(python) else {
            return match kind {
                EmbeddingKind::Minilm => Err(PipelineError::choose(
                    format!(
                        "the files of {MINILM_NAME} are not on this machine; `recrash model pull` gets them, or name \
                         their folder"
                    ),
                    Choice::ModelFolder,
                )),
                _ => Ok((Self::Lexical, Vec::new())),
            };
        };
        let model = load(&weights.folder);
        match model {
            Ok(model) if model.is_pinned() => Ok((Self::Model(Box::new(model)), Vec::new())),
            Err(error) if kind == EmbeddingKind::Minilm => Err(error),
            Ok(_) if kind == EmbeddingKind::Minilm => Err(PipelineError::choose(
                format!(
                    "{}: these are not the published weights and vocabulary of {MINILM_NAME}; to use them all the same, \
                     name the folder",
                    weights.folder.display()
                ),
                Choice::ModelFolder,
            )),
            other => {
                let what = other.map_or_else(|e| e.to_string(), |_| "they are not the published ones".to_owned());
                let message =
                    format!("the files of {MINILM_NAME} in {} were passed over: {what}", weights.source.label());
                let remark =
                    Diagnostic::new(Severity::Warning, "select.weights-passed-over", Location::default(), message)
                        .with_hint("mend the files, or name their folder; `recrash model show` names it");
                Ok((Self::Lexical, vec![remark]))
            }
        }
    }

    /// What decides the rows beside the texts.
    pub fn fingerprint(&self) -> &str {
        match self {
            Self::Lexical => "lexical",
            Self::Model(model) => model.fingerprint(),
        }
    }

    /// The embedding of the usable records. Rows that are kept already are not computed again.
    ///
    /// # Errors
    /// A row is not finite.
    pub fn embed(&self, records: &RecordSet, kept: KeptRows) -> Result<(Embedding, KeptRows), SelectError> {
        let Self::Model(model) = self else { return Ok((embed_records(records), KeptRows::default())) };
        let narratives = usable_narratives(records);
        let known = if kept.model == model.fingerprint() { kept.rows } else { BTreeMap::new() };
        let mut rows: BTreeMap<String, Vec<i32>> = BTreeMap::new();
        let keys: Vec<String> = narratives.iter().map(|text| sha256(text.as_bytes())).collect();
        let mut missing: BTreeMap<&str, &str> = BTreeMap::new();
        for (key, text) in keys.iter().zip(&narratives) {
            match known.get(key).filter(|row| row.len() == model.dimensions()) {
                Some(row) => drop(rows.insert(key.clone(), row.clone())),
                None => drop(missing.insert(key, text)),
            }
        }
        let missing: Vec<(&str, &str)> = missing.into_iter().collect();
        let new: Vec<Vec<f32>> = missing.par_iter().map(|(_, text)| model.embed_text(text)).collect();
        // Checks that they are finite.
        Embedding::new(MINILM_NAME, &new)?;
        let steps = |row: Vec<f32>| row.into_iter().map(|x| (f64::from(x) / EMBEDDING_GRID).round() as i32).collect();
        rows.extend(missing.into_iter().zip(new).map(|((key, _), row)| (key.to_owned(), steps(row))));

        let values = |key: &String| -> Vec<f32> {
            rows.get(key).into_iter().flatten().map(|&steps| (f64::from(steps) * EMBEDDING_GRID) as f32).collect()
        };
        let all: Vec<Vec<f32>> = keys.iter().map(values).collect();
        let embedding = Embedding::new(MINILM_NAME, &all)?;
        Ok((embedding, KeptRows { model: model.fingerprint().to_owned(), rows, ..KeptRows::default() }))
    }
}

/// The embedding as a strategy wants it. `kmeans` is the paper's and takes the model's rows as they are; the others take
/// off the reporter's house style, which else outweighs what happened (`docs/models/selection.md`). The lexical rows are
/// without it anyway.
pub fn for_strategy(embedding: &Embedding, records: &RecordSet, strategy: Strategy) -> Embedding {
    let plain = embedding.name() != MINILM_NAME || strategy == Strategy::Kmeans;
    if plain { embedding.clone() } else { embedding.without_house_style(&usable_reporters(records)) }
}

/// Format tag of [`KeptRows`].
const KEPT_FORMAT: &str = "recrash.embedding/1";

/// Rows of a model by the SHA-256 of their texts, in steps of [`EMBEDDING_GRID`]: the rounding comes before the keeping, so
/// that kept and computed rows are the same.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeptRows {
    format: String,
    /// Fingerprint of the model's files.
    model: String,
    rows: BTreeMap<String, Vec<i32>>,
}

impl Default for KeptRows {
    fn default() -> Self {
        Self { format: KEPT_FORMAT.to_owned(), model: String::new(), rows: BTreeMap::new() }
    }
}

impl KeptRows {
    /// From a file of a suite; what cannot be read is as good as nothing.
    pub fn read(bytes: &[u8]) -> Self {
        let kept: Option<Self> = serde_json::from_slice(bytes).ok();
        kept.filter(|kept| kept.format == KEPT_FORMAT).unwrap_or_default()
    }

    /// For a file of a suite; `None` where there is nothing to keep.
    pub fn write(&self) -> Option<Vec<u8>> {
        (!self.rows.is_empty()).then(|| to_compact_json(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profiles::load_profile;
    use recrash_embed::ModelFiles;
    use recrash_records::{SAMPLE_CSV, SAMPLE_NAME, SourceText, ingest};

    fn tiny() -> Embeds {
        let files = ModelFiles {
            config: include_bytes!("../../../embed/tests/tiny/config.json"),
            weights: include_bytes!("../../../embed/tests/tiny/model.safetensors"),
            vocabulary: include_bytes!("../../../embed/tests/tiny/vocab.txt"),
        };
        Embeds::Model(Box::new(Embedder::new(files).unwrap()))
    }

    fn sample() -> RecordSet {
        let files = [SourceText { name: SAMPLE_NAME, bytes: SAMPLE_CSV.as_bytes() }];
        ingest(&files, &load_profile("paper").unwrap()).unwrap().value
    }

    #[test]
    fn kept_rows_are_those_that_would_be_computed() {
        let (records, embeds) = (sample(), tiny());
        let (fresh, kept) = embeds.embed(&records, KeptRows::default()).unwrap();
        let bytes = kept.write().unwrap();
        let (again, kept_again) = embeds.embed(&records, KeptRows::read(&bytes)).unwrap();
        assert!(fresh == again && kept == kept_again);
        // A changed row shows that kept rows are what is used; another model's are not.
        let mut changed = kept.clone();
        changed.rows.values_mut().for_each(|row| row[0] += 1);
        assert!(embeds.embed(&records, changed.clone()).unwrap().0 != fresh);
        changed.model = "another".into();
        assert!(embeds.embed(&records, changed).unwrap().0 == fresh);
        for damaged in [&bytes[..bytes.len() / 2], b"{}", b""] {
            assert_eq!(KeptRows::read(damaged), KeptRows::default());
        }
    }

    #[test]
    fn a_damaged_record_set_is_an_error_and_no_panic() {
        let records = sample();
        let damaged = RecordSet { usable: vec![0, usize::MAX], ..records };
        let (embedding, _) = tiny().embed(&damaged, KeptRows::default()).unwrap();
        assert_eq!(embedding.rows(), 2);
        let (profile, options) = (load_profile("paper").unwrap(), recrash_select::SelectOptions::default());
        let error = recrash_select::select_with(&damaged, &profile, &options, &embedding).unwrap_err();
        assert!(matches!(error, SelectError::DamagedRecordSet { .. }), "{error}");
    }

    #[test]
    fn only_the_papers_strategy_keeps_the_house_style() {
        let records = sample();
        let (embedding, _) = tiny().embed(&records, KeptRows::default()).unwrap();
        assert_eq!(for_strategy(&embedding, &records, Strategy::Kmeans), embedding);
        assert!(for_strategy(&embedding, &records, Strategy::Stratified).name().ends_with("house style removed"));
    }
}

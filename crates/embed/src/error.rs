//! Why a model cannot be used.

/// Why a model cannot be used. Each names the file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EmbedError {
    /// `config.json` cannot be read.
    #[error("config.json: {0}")]
    Config(String),
    /// `config.json` describes another kind of model.
    #[error("config.json: {field} is {found}; {allowed}")]
    Unsupported {
        /// Field.
        field: &'static str,
        /// What stands there.
        found: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// `model.safetensors` cannot be read.
    #[error("model.safetensors: {0}; is the download complete?")]
    Weights(String),
    /// A tensor is missing.
    #[error("model.safetensors: no tensor \"{0}\"; this is not the model that config.json describes")]
    MissingTensor(String),
    /// A tensor has another type or shape.
    #[error("model.safetensors: tensor \"{name}\" is {found}, expected {expected}")]
    TensorShape {
        /// Tensor.
        name: String,
        /// Type and shape found.
        found: String,
        /// Type and shape expected.
        expected: String,
    },
    /// `vocab.txt` does not fit.
    #[error("vocab.txt: {0}")]
    Vocabulary(String),
}

//! `model.safetensors`: named arrays of single-precision numbers, each checked for its shape when taken.

use crate::EmbedError;
use ndarray::{Array1, Array2};
use safetensors::{Dtype, SafeTensors};

/// The tensors of a file.
pub(crate) struct Tensors<'a>(SafeTensors<'a>);

impl<'a> Tensors<'a> {
    pub fn read(bytes: &'a [u8]) -> Result<Self, EmbedError> {
        SafeTensors::deserialize(bytes).map(Self).map_err(|e| EmbedError::Weights(e.to_string()))
    }

    /// A row of numbers.
    pub fn vector(&self, name: &str, length: usize) -> Result<Array1<f32>, EmbedError> {
        self.values(name, &[length]).map(Array1::from_vec)
    }

    /// Rows of numbers.
    pub fn matrix(&self, name: &str, rows: usize, columns: usize) -> Result<Array2<f32>, EmbedError> {
        let values = self.values(name, &[rows, columns])?;
        Array2::from_shape_vec((rows, columns), values).map_err(|e| EmbedError::Weights(format!("{name}: {e}")))
    }

    fn values(&self, name: &str, shape: &[usize]) -> Result<Vec<f32>, EmbedError> {
        // Some copies put the model's name before its parts.
        let tensor = self.0.tensor(name).or_else(|_| self.0.tensor(&format!("bert.{name}")));
        let tensor = tensor.map_err(|_| EmbedError::MissingTensor(name.to_owned()))?;
        if tensor.dtype() != Dtype::F32 || tensor.shape() != shape {
            return Err(EmbedError::TensorShape {
                name: name.to_owned(),
                found: format!("{:?} {:?}", tensor.dtype(), tensor.shape()),
                expected: format!("F32 {shape:?}"),
            });
        }
        let values: Vec<f32> = tensor.data().as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        if values.iter().any(|value| !value.is_finite()) {
            return Err(EmbedError::Weights(format!("tensor \"{name}\" holds a value that is not a finite number")));
        }
        Ok(values)
    }
}

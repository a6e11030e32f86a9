//! The forward pass of BERT (Devlin et al. 2019) with mean pooling (Reimers and Gurevych 2019), one text at a time: no
//! padding, so no masks.

use crate::EmbedError;
use crate::config::Config;
use crate::functions::{gelu, layer_norm, softmax, unit_length};
use crate::tensors::Tensors;
use ndarray::linalg::general_mat_mul;
use ndarray::{Array1, Array2, Axis, concatenate, s};

/// A model's weights.
#[derive(Debug)]
pub(crate) struct Bert {
    words: Array2<f32>,
    /// Position plus the type of the first segment: texts have one.
    positions: Array2<f32>,
    norm: Norm,
    layers: Vec<Layer>,
    heads: usize,
}

#[derive(Debug)]
struct Layer {
    /// Queries, keys and values in one product.
    attention: Linear,
    attention_output: Linear,
    attention_norm: Norm,
    widen: Linear,
    narrow: Linear,
    output_norm: Norm,
}

/// `x W + b`. Files hold W transposed; this way round its rows are packed faster.
#[derive(Debug)]
struct Linear {
    weight: Array2<f32>,
    bias: Array1<f32>,
}

#[derive(Debug)]
struct Norm {
    scale: Array1<f32>,
    shift: Array1<f32>,
    epsilon: f32,
}

impl Bert {
    pub fn new(config: &Config, weights: &[u8]) -> Result<Self, EmbedError> {
        let tensors = Tensors::read(weights)?;
        let width = config.hidden_size;
        let part = |name: &str| format!("embeddings.{name}");
        let words = tensors.matrix(&part("word_embeddings.weight"), config.vocab_size, width)?;
        let mut positions =
            tensors.matrix(&part("position_embeddings.weight"), config.max_position_embeddings, width)?;
        positions += &tensors.matrix(&part("token_type_embeddings.weight"), 2, width)?.row(0);
        let norm = Norm::read(&tensors, &part("LayerNorm"), config)?;
        let layers =
            (0..config.num_hidden_layers).map(|n| Layer::read(&tensors, n, config)).collect::<Result<_, _>>()?;
        Ok(Self { words, positions, norm, layers, heads: config.num_attention_heads })
    }

    /// Length of a row.
    pub fn width(&self) -> usize {
        self.words.ncols()
    }

    /// Most tokens a text can have.
    pub fn positions(&self) -> usize {
        self.positions.nrows()
    }

    /// The mean of the last layer over the tokens, of unit length. Tokens are rows of the vocabulary.
    pub fn embed(&self, tokens: &[usize]) -> Vec<f32> {
        let mut states = self.words.select(Axis(0), tokens);
        states += &self.positions.slice(s![..tokens.len(), ..]);
        self.norm.apply(&mut states);
        for layer in &self.layers {
            states = layer.apply(&states, self.heads);
        }
        let mut mean = states.sum_axis(Axis(0)) / tokens.len().max(1) as f32;
        if let Some(values) = mean.as_slice_mut() {
            unit_length(values);
        }
        mean.to_vec()
    }
}

impl Layer {
    fn read(tensors: &Tensors<'_>, number: usize, config: &Config) -> Result<Self, EmbedError> {
        let (width, wide) = (config.hidden_size, config.intermediate_size);
        let part = |name: &str| format!("encoder.layer.{number}.{name}");
        let linear = |name: &str, outputs, inputs| Linear::read(tensors, &part(name), outputs, inputs);
        let query = linear("attention.self.query", width, width)?;
        let key = linear("attention.self.key", width, width)?;
        let value = linear("attention.self.value", width, width)?;
        Ok(Self {
            attention: Linear::stacked(&[query, key, value])?,
            attention_output: linear("attention.output.dense", width, width)?,
            attention_norm: Norm::read(tensors, &part("attention.output.LayerNorm"), config)?,
            widen: linear("intermediate.dense", wide, width)?,
            narrow: linear("output.dense", width, wide)?,
            output_norm: Norm::read(tensors, &part("output.LayerNorm"), config)?,
        })
    }

    fn apply(&self, states: &Array2<f32>, heads: usize) -> Array2<f32> {
        let mut attended = self.attention_output.apply(&self.attend(states, heads));
        attended += states;
        self.attention_norm.apply(&mut attended);
        let mut wide = self.widen.apply(&attended);
        wide.rows_mut().into_iter().for_each(|mut row| row.as_slice_mut().into_iter().for_each(gelu));
        let mut output = self.narrow.apply(&wide);
        output += &attended;
        self.output_norm.apply(&mut output);
        output
    }

    /// For each head, values mixed by `softmax(Q K^T / sqrt(d))`.
    fn attend(&self, states: &Array2<f32>, heads: usize) -> Array2<f32> {
        let (tokens, width) = states.dim();
        let size = width / heads;
        let scale = 1.0 / (size as f32).sqrt();
        let joined = self.attention.apply(states);
        let mut mixed = Array2::zeros((tokens, width));
        let mut shares = Array2::zeros((tokens, tokens));
        for head in 0..heads {
            let part = |n: usize| joined.slice(s![.., n * width + head * size..n * width + (head + 1) * size]);
            general_mat_mul(1.0, &part(0), &part(1).t(), 0.0, &mut shares);
            for mut row in shares.rows_mut() {
                row.as_slice_mut().into_iter().for_each(|row| softmax(row, scale));
            }
            general_mat_mul(1.0, &shares, &part(2), 0.0, &mut mixed.slice_mut(s![.., head * size..(head + 1) * size]));
        }
        mixed
    }
}

impl Linear {
    fn read(tensors: &Tensors<'_>, name: &str, outputs: usize, inputs: usize) -> Result<Self, EmbedError> {
        let weight = tensors.matrix(&format!("{name}.weight"), outputs, inputs)?;
        let weight = weight.t().as_standard_layout().into_owned();
        Ok(Self { weight, bias: tensors.vector(&format!("{name}.bias"), outputs)? })
    }

    fn stacked(parts: &[Self]) -> Result<Self, EmbedError> {
        let weights: Vec<_> = parts.iter().map(|part| part.weight.view()).collect();
        let biases: Vec<_> = parts.iter().map(|part| part.bias.view()).collect();
        let shape = |e: ndarray::ShapeError| EmbedError::Weights(e.to_string());
        let weight = concatenate(Axis(1), &weights).map_err(shape)?;
        Ok(Self { weight, bias: concatenate(Axis(0), &biases).map_err(shape)? })
    }

    fn apply(&self, x: &Array2<f32>) -> Array2<f32> {
        let mut y = Array2::zeros((x.nrows(), self.bias.len()));
        y.rows_mut().into_iter().for_each(|mut row| row.assign(&self.bias));
        general_mat_mul(1.0, x, &self.weight, 1.0, &mut y);
        y
    }
}

impl Norm {
    fn read(tensors: &Tensors<'_>, name: &str, config: &Config) -> Result<Self, EmbedError> {
        let scale = tensors.vector(&format!("{name}.weight"), config.hidden_size)?;
        let shift = tensors.vector(&format!("{name}.bias"), config.hidden_size)?;
        Ok(Self { scale, shift, epsilon: config.layer_norm_eps })
    }

    fn apply(&self, states: &mut Array2<f32>) {
        let (Some(scale), Some(shift)) = (self.scale.as_slice(), self.shift.as_slice()) else { return };
        for mut row in states.rows_mut() {
            row.as_slice_mut().into_iter().for_each(|row| layer_norm(row, scale, shift, self.epsilon));
        }
    }
}

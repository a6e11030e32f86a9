//! Embeddings of narratives: one row of numbers per usable record, wherever they come from.

use crate::SelectError;
use crate::matrix::{Matrix, add_scaled};
use std::collections::BTreeMap;

/// Grid to which embeddings are rounded: machines that differ in the last bits of a language model's output then give
/// the same clusters. (Five decimals; single precision carries seven.)
pub const EMBEDDING_GRID: f64 = 1e-5;

/// Reports after which half of a reporter's mean counts as its style. Assumed; between 0.5 and 10 the result hardly
/// changes.
const HOUSE_STYLE_PRIOR: f64 = 5.0;

/// One row of numbers per usable record, in the order of [`recrash_model::record::RecordSet::usable`].
#[derive(Debug, Clone, PartialEq)]
pub struct Embedding {
    name: String,
    matrix: Matrix,
}

impl Embedding {
    /// From the rows of any embedder. Values are rounded to [`EMBEDDING_GRID`].
    ///
    /// # Errors
    /// Where rows differ in length or hold a value that is not finite.
    pub fn new<R: AsRef<[f32]>>(name: &str, rows: &[R]) -> Result<Self, SelectError> {
        let columns = rows.first().map_or(0, |row| row.as_ref().len());
        for (row, values) in rows.iter().enumerate() {
            let values = values.as_ref();
            if values.len() != columns {
                return Err(SelectError::EmbeddingRagged { row, expected: columns, found: values.len() });
            }
            if values.iter().any(|value| !value.is_finite()) {
                return Err(SelectError::EmbeddingNotFinite { row });
            }
        }
        let rows: Vec<Vec<f64>> = rows.iter().map(|row| row.as_ref().iter().map(|&v| f64::from(v)).collect()).collect();
        Ok(Self::from_matrix(name, Matrix::from_rows(columns, &rows)))
    }

    /// Name for files and reports, such as `all-MiniLM-L6-v2`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.matrix.rows
    }

    /// Length of a row.
    pub fn dimensions(&self) -> usize {
        self.matrix.columns
    }

    /// One row.
    pub fn row(&self, i: usize) -> &[f64] {
        self.matrix.row(i)
    }

    /// The same without what the reports of one reporter have in common, where `reporters` names the reporter of each row.
    ///
    /// Companies write their reports from templates of their own, so narratives lie near to those of the same company
    /// rather than to those of similar crashes. From each row `n / (n + 5)` of the mean of its reporter's `n` rows is
    /// subtracted: nearly all of it for those who report much, little for those who report once, of whom nothing else
    /// is known. The effect on NHTSA's file: `docs/models/selection.md`.
    #[must_use]
    pub fn without_house_style(&self, reporters: &[&str]) -> Self {
        let mut rows_of: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (row, &reporter) in (0..self.rows()).zip(reporters) {
            rows_of.entry(reporter).or_default().push(row);
        }
        let mut matrix = self.matrix.clone();
        for rows in rows_of.values() {
            let share = rows.len() as f64 / (rows.len() as f64 + HOUSE_STYLE_PRIOR);
            let mean = self.matrix.select(rows).mean();
            rows.iter().for_each(|&row| add_scaled(matrix.row_mut(row), -share, &mean));
        }
        Self::from_matrix(&format!("{}, house style removed", self.name), matrix)
    }

    pub(crate) fn from_matrix(name: &str, mut matrix: Matrix) -> Self {
        for i in 0..matrix.rows {
            for value in matrix.row_mut(i) {
                // Adding zero turns -0 into 0.
                *value = (*value / EMBEDDING_GRID).round() * EMBEDDING_GRID + 0.0;
            }
        }
        Self { name: name.to_owned(), matrix }
    }

    pub(crate) fn select(&self, positions: &[usize]) -> Matrix {
        self.matrix.select(positions)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_bits_do_not_matter() {
        let a = Embedding::new("m", &[[0.123_456_7_f32, -0.000_000_1]]).unwrap();
        let b = Embedding::new("m", &[[0.123_456_8_f32, 0.000_000_1]]).unwrap();
        assert_eq!(a, b);
        assert!(a.row(0)[1].is_sign_positive());
    }

    #[test]
    fn house_style_is_the_mean_of_a_reporter_shrunken() {
        let embedding = Embedding::new("m", &[[4.0_f32], [2.0], [6.0], [1.2]]).unwrap();
        let without = embedding.without_house_style(&["A", "A", "A", "B"]);
        // A: mean 4, share 3/8. B: mean 1.2, share 1/6.
        let expected = [2.5, 0.5, 4.5, 1.0];
        (0..4).for_each(|i| assert!((without.row(i)[0] - expected[i]).abs() < 1e-9));
        assert_eq!(without.name(), "m, house style removed");
    }

    #[test]
    fn ragged_and_infinite_rows_are_refused() {
        assert!(matches!(
            Embedding::new("m", &[vec![1.0], vec![1.0, 2.0]]),
            Err(SelectError::EmbeddingRagged { row: 1, expected: 1, found: 2 })
        ));
        assert!(matches!(Embedding::new("m", &[[f32::NAN]]), Err(SelectError::EmbeddingNotFinite { row: 0 })));
    }
}

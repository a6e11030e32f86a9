//! A dense matrix of records by coordinates, and the distances in it.

/// Rows of equal length, one after another.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Length of a row.
    pub columns: usize,
    values: Vec<f64>,
}

impl Matrix {
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![0.0; rows * columns] }
    }

    /// From rows of `columns` values each; shorter rows are filled with zeros, longer ones cut.
    pub fn from_rows<R: AsRef<[f64]>>(columns: usize, rows: &[R]) -> Self {
        let mut matrix = Self::zeros(rows.len(), columns);
        for (i, row) in rows.iter().enumerate() {
            for (to, from) in matrix.row_mut(i).iter_mut().zip(row.as_ref()) {
                *to = *from;
            }
        }
        matrix
    }

    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// Rows `a` and `b`, to change both. `a < b`.
    pub fn two_rows_mut(&mut self, a: usize, b: usize) -> (&mut [f64], &mut [f64]) {
        let (head, tail) = self.values.split_at_mut(b * self.columns);
        (&mut head[a * self.columns..(a + 1) * self.columns], &mut tail[..self.columns])
    }

    /// The rows at these positions.
    pub fn select(&self, positions: &[usize]) -> Self {
        let rows: Vec<&[f64]> = positions.iter().map(|&i| self.row(i)).collect();
        Self::from_rows(self.columns, &rows)
    }

    /// Mean of all rows.
    pub fn mean(&self) -> Vec<f64> {
        let mut mean = vec![0.0; self.columns];
        for i in 0..self.rows {
            add_scaled(&mut mean, 1.0, self.row(i));
        }
        mean.iter_mut().for_each(|m| *m /= self.rows.max(1) as f64);
        mean
    }

    /// How many rows differ from every earlier row.
    pub fn distinct_rows(&self) -> usize {
        let mut order: Vec<usize> = (0..self.rows).collect();
        let compare = |&a: &usize, &b: &usize| {
            let differing = self.row(a).iter().zip(self.row(b)).map(|(x, y)| x.total_cmp(y)).find(|o| o.is_ne());
            differing.unwrap_or(std::cmp::Ordering::Equal)
        };
        order.sort_by(compare);
        order.dedup_by(|a, b| compare(a, b).is_eq());
        order.len()
    }
}

/// Inner product, summed from the first to the last.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Squared Euclidean distance.
pub(crate) fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}

/// Euclidean distance.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    squared_distance(a, b).sqrt()
}

/// `to += factor * from`.
pub(crate) fn add_scaled(to: &mut [f64], factor: f64, from: &[f64]) {
    for (t, f) in to.iter_mut().zip(from) {
        *t += factor * f;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distinct_rows_are_counted_once() {
        let matrix = Matrix::from_rows(2, &[[1.0, 2.0], [0.0, 2.0], [1.0, 2.0], [1.0, 3.0]]);
        assert_eq!(matrix.distinct_rows(), 3);
        assert_eq!(Matrix::zeros(4, 0).distinct_rows(), 1);
        assert_eq!(Matrix::zeros(0, 3).distinct_rows(), 0);
    }

    #[test]
    fn a_3_4_5_triangle() {
        assert_eq!(distance(&[0.0, 0.0], &[3.0, 4.0]), 5.0);
    }
}

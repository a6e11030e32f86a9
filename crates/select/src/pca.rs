//! Principal component analysis: the directions along which centred rows vary most.

use crate::eigen;
use crate::matrix::{Matrix, add_scaled, dot};

/// Rows seen along the first principal components.
#[derive(Debug, Clone)]
pub(crate) struct Principal {
    /// One row per input row, one column per component.
    pub scores: Matrix,
    /// Share of the total variance in the components, in [0, 1]; 0 where nothing varies.
    pub explained_variance: f64,
}

/// The scores `(X - mean) V` on at most `dimensions` components; fewer where the rows vary in fewer directions.
///
/// `V` holds the eigenvectors of `C = (X - mean)^T (X - mean)`, or, where there are fewer rows than columns, those of
/// the smaller `(X - mean)(X - mean)^T` carried over. Each component's sign makes its largest loading positive.
pub(crate) fn principal_components(x: &Matrix, dimensions: usize) -> Principal {
    let mean = x.mean();
    let mut centred = x.clone();
    for i in 0..x.rows {
        add_scaled(centred.row_mut(i), -1.0, &mean);
    }
    let total: f64 = (0..x.rows).map(|i| dot(centred.row(i), centred.row(i))).sum();
    let components = if x.columns <= x.rows {
        eigen::symmetric(gram_of_columns(&centred))
    } else {
        let mut of_rows = eigen::symmetric(gram_of_rows(&centred));
        let mut vectors = Matrix::zeros(of_rows.values.len(), x.columns);
        for (k, value) in of_rows.values.iter().enumerate().filter(|(_, value)| **value > 0.0) {
            for i in 0..x.rows {
                add_scaled(vectors.row_mut(k), of_rows.vectors.row(k)[i] / value.sqrt(), centred.row(i));
            }
        }
        of_rows.vectors = vectors;
        of_rows
    };
    // Directions below this share of the variance are rounding errors.
    let negligible = 1e-12 * total;
    let kept = components.values.iter().take(dimensions).take_while(|&&value| value > negligible).count();
    let mut scores = Matrix::zeros(x.rows, kept);
    for k in 0..kept {
        let direction = components.vectors.row(k);
        let largest = direction.iter().fold(0.0_f64, |best, v| if v.abs() > best.abs() { *v } else { best });
        let sign = if largest < 0.0 { -1.0 } else { 1.0 };
        for i in 0..x.rows {
            scores.row_mut(i)[k] = sign * dot(centred.row(i), direction);
        }
    }
    let explained: f64 = components.values[..kept].iter().sum();
    let explained_variance = if total > 0.0 { (explained / total).clamp(0.0, 1.0) } else { 0.0 };
    Principal { scores, explained_variance }
}

fn gram_of_columns(x: &Matrix) -> Matrix {
    let mut gram = Matrix::zeros(x.columns, x.columns);
    for i in 0..x.rows {
        let row = x.row(i);
        for (j, &value) in row.iter().enumerate() {
            add_scaled(&mut gram.row_mut(j)[..=j], value, row);
        }
    }
    gram
}

fn gram_of_rows(x: &Matrix) -> Matrix {
    let mut gram = Matrix::zeros(x.rows, x.rows);
    for i in 0..x.rows {
        for j in 0..=i {
            gram.row_mut(i)[j] = dot(x.row(i), x.row(j));
        }
    }
    gram
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::oracle;

    #[test]
    fn points_on_a_line_have_one_component() {
        // Along (3, 4) / 5 at -5, 0 and 5.
        let x = Matrix::from_rows(2, &[[1.0, 1.0], [4.0, 5.0], [7.0, 9.0]]);
        let pca = principal_components(&x, 2);
        assert_eq!(pca.scores.columns, 1);
        assert!((pca.explained_variance - 1.0).abs() < 1e-12);
        for (i, expected) in [-5.0, 0.0, 5.0].into_iter().enumerate() {
            assert!((pca.scores.row(i)[0] - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn more_columns_than_rows_gives_the_same_as_padding_with_rows() {
        let rows = [[1.0, 0.0, 2.0, 5.0], [0.0, 1.0, -1.0, 0.5], [3.0, 1.0, 0.0, 1.0]];
        let wide = principal_components(&Matrix::from_rows(4, &rows), 2);
        // Every row twice: same mean, same directions, and now the other branch is taken.
        let twice: Vec<_> = rows.iter().chain(&rows).copied().collect();
        let tall = principal_components(&Matrix::from_rows(4, &twice), 2);
        for i in 0..3 {
            for k in 0..2 {
                assert!((wide.scores.row(i)[k] - tall.scores.row(i)[k]).abs() < 1e-9);
            }
        }
        assert!((wide.explained_variance - tall.explained_variance).abs() < 1e-12);
    }

    #[test]
    fn scikit_learn_gives_the_same_scores() {
        let fixture = oracle("pca.json");
        for shape in ["tall", "wide"] {
            let expected = fixture.matrix(&format!("{shape}_scores"));
            let pca = principal_components(&fixture.matrix(shape), expected.columns);
            let explained = fixture.number(&format!("{shape}_explained_variance"));
            assert!((pca.explained_variance - explained).abs() < 1e-10);
            for k in 0..expected.columns {
                // Equal up to the sign of each component.
                let same = (0..expected.rows).map(|i| pca.scores.row(i)[k] * expected.row(i)[k]).sum::<f64>();
                for i in 0..expected.rows {
                    let difference = pca.scores.row(i)[k] - same.signum() * expected.row(i)[k];
                    assert!(difference.abs() < 1e-10, "{shape}, row {i}, component {k}: {difference}");
                }
            }
        }
    }

    #[test]
    fn equal_rows_have_no_components() {
        let pca = principal_components(&Matrix::from_rows(2, &[[1.0, 2.0]; 4]), 2);
        assert_eq!((pca.scores.rows, pca.scores.columns, pca.explained_variance), (4, 0, 0.0));
    }
}

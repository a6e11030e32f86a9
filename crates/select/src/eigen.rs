//! Eigenvalues and eigenvectors of real symmetric matrices: Householder tridiagonalisation and the implicit QL method
//! with Wilkinson's shift. Golub and Van Loan, "Matrix Computations", 4th edition, sections 8.3.1 and 8.3.3.

use crate::matrix::{Matrix, add_scaled, dot};
use recrash_model::math;

/// Eigenvalues, greatest first, and their unit eigenvectors as rows.
#[derive(Debug, Clone)]
pub(crate) struct Eigen {
    pub values: Vec<f64>,
    pub vectors: Matrix,
}

/// Of a symmetric matrix. Only its lower half is read.
pub(crate) fn symmetric(mut a: Matrix) -> Eigen {
    let n = a.rows;
    let mut diagonal = vec![0.0; n];
    let mut beside = vec![0.0; n.saturating_sub(1)];
    // Column k is mirrored so that only its first entry below the diagonal stays; the unit mirror normals are kept.
    let mut mirrors: Vec<Vec<f64>> = Vec::new();
    for (k, below) in beside.iter_mut().enumerate().take(n.saturating_sub(2)) {
        let mut normal: Vec<f64> = (k + 1..n).map(|i| a.row(i)[k]).collect();
        let length = dot(&normal, &normal).sqrt();
        let kept = if normal[0] > 0.0 { -length } else { length };
        *below = kept;
        normal[0] -= kept;
        let normal_length = dot(&normal, &normal).sqrt();
        if normal_length > 0.0 {
            normal.iter_mut().for_each(|x| *x /= normal_length);
            mirror_both_sides(&mut a, k + 1, &normal);
        } else {
            normal.fill(0.0);
        }
        mirrors.push(normal);
    }
    for (k, value) in diagonal.iter_mut().enumerate() {
        *value = a.row(k)[k];
    }
    if n >= 2 {
        beside[n - 2] = a.row(n - 1)[n - 2];
    }
    // Rows of the basis are the columns of the product of all mirrors.
    let mut basis = identity(n);
    for (k, normal) in mirrors.iter().enumerate().rev() {
        for i in 0..n {
            let tail = &mut basis.row_mut(i)[k + 1..];
            let projection = dot(tail, normal);
            add_scaled(tail, -2.0 * projection, normal);
        }
    }
    tridiagonal(diagonal, beside, basis)
}

/// Of a symmetric tridiagonal matrix, with the eigenvectors expressed in the given basis (rows): the identity gives
/// the plain ones.
pub(crate) fn tridiagonal(mut d: Vec<f64>, mut e: Vec<f64>, mut basis: Matrix) -> Eigen {
    let n = d.len();
    e.resize(n, 0.0);
    // Each eigenvalue takes two or three sweeps; the limit is never met and only bounds the loop.
    const MAX_SWEEPS: usize = 60;
    for first in 0..n {
        for _ in 0..MAX_SWEEPS {
            let negligible = |i: usize| e[i].abs() <= f64::EPSILON * (d[i].abs() + d[i + 1].abs());
            let last = (first..n - 1).find(|&i| negligible(i)).unwrap_or(n - 1);
            if last == first {
                break;
            }
            ql_sweep(&mut d, &mut e, &mut basis, first, last);
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| d[b].total_cmp(&d[a]));
    Eigen { values: order.iter().map(|&i| d[i]).collect(), vectors: basis.select(&order) }
}

pub(crate) fn identity(n: usize) -> Matrix {
    let mut matrix = Matrix::zeros(n, n);
    (0..n).for_each(|i| matrix.row_mut(i)[i] = 1.0);
    matrix
}

/// `a := H a H` on the rows and columns from `start`, with `H = 1 - 2 normal normal^T`.
fn mirror_both_sides(a: &mut Matrix, start: usize, normal: &[f64]) {
    let n = a.rows;
    let mut product = vec![0.0; n - start];
    for i in start..n {
        for j in start..=i {
            let value = a.row(i)[j];
            product[i - start] += value * normal[j - start];
            if j < i {
                product[j - start] += value * normal[i - start];
            }
        }
    }
    let half = dot(&product, normal);
    let mut other = product;
    add_scaled(&mut other, -half, normal);
    for i in start..n {
        let (normal_i, other_i) = (normal[i - start], other[i - start]);
        let row = &mut a.row_mut(i)[start..=i];
        for (j, value) in row.iter_mut().enumerate() {
            *value -= 2.0 * (normal_i * other[j] + other_i * normal[j]);
        }
    }
}

/// One implicit QL sweep over the unreduced block `first..=last`.
fn ql_sweep(d: &mut [f64], e: &mut [f64], basis: &mut Matrix, first: usize, last: usize) {
    let half_difference = (d[first + 1] - d[first]) / (2.0 * e[first]);
    let root = math::hypot(half_difference, 1.0);
    let signed_root = if half_difference >= 0.0 { root } else { -root };
    let mut g = d[last] - d[first] + e[first] / (half_difference + signed_root);
    let (mut sine, mut cosine, mut shift) = (1.0, 1.0, 0.0);
    for i in (first..last).rev() {
        let f = sine * e[i];
        let b = cosine * e[i];
        let r = math::hypot(f, g);
        e[i + 1] = r;
        if r == 0.0 {
            d[i + 1] -= shift;
            e[last] = 0.0;
            return;
        }
        sine = f / r;
        cosine = g / r;
        let next = d[i + 1] - shift;
        let t = (d[i] - next) * sine + 2.0 * cosine * b;
        shift = sine * t;
        d[i + 1] = next + shift;
        g = cosine * t - b;
        let (low, high) = basis.two_rows_mut(i, i + 1);
        for (x, y) in low.iter_mut().zip(high) {
            (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
        }
    }
    d[first] -= shift;
    e[first] = g;
    e[last] = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;
    use recrash_model::Seed;

    fn check(a: &Matrix) -> Eigen {
        let eigen = symmetric(a.clone());
        for (k, &value) in eigen.values.iter().enumerate() {
            let vector = eigen.vectors.row(k);
            assert!((dot(vector, vector) - 1.0).abs() < 1e-12);
            for i in 0..a.rows {
                assert!((dot(a.row(i), vector) - value * vector[i]).abs() < 1e-10, "pair {k}, row {i}");
            }
        }
        eigen
    }

    #[test]
    fn two_by_two_by_hand() {
        let eigen = check(&Matrix::from_rows(2, &[[2.0, 1.0], [1.0, 2.0]]));
        assert!((eigen.values[0] - 3.0).abs() < 1e-14 && (eigen.values[1] - 1.0).abs() < 1e-14);
    }

    #[test]
    fn random_matrices_of_every_small_size() {
        for n in 1..30 {
            let mut rng = Seed(n as u64).rng();
            let mut a = Matrix::zeros(n, n);
            for i in 0..n {
                for j in 0..=i {
                    let x = rng.normal();
                    a.row_mut(i)[j] = x;
                    a.row_mut(j)[i] = x;
                }
            }
            let trace: f64 = (0..n).map(|i| a.row(i)[i]).sum();
            let eigen = check(&a);
            assert!((eigen.values.iter().sum::<f64>() - trace).abs() < 1e-10);
            assert!(eigen.values.is_sorted_by(|a, b| a >= b));
        }
    }

    #[test]
    fn repeated_and_zero_eigenvalues() {
        check(&identity(7));
        check(&Matrix::zeros(5, 5));
        let ones = Matrix::from_rows(6, &[[1.0; 6]; 6]);
        assert!((check(&ones).values[0] - 6.0).abs() < 1e-12);
    }
}

//! The lexical embedding: TF-IDF with a truncated singular value decomposition (latent semantic analysis).
//!
//! What this does **not** do: it knows no grammar and no synonyms beyond words that occur in the same narratives.
//! Equations and sources: `docs/models/selection.md`.

use crate::eigen;
use crate::embedding::Embedding;
use crate::matrix::{Matrix, add_scaled, dot};
use crate::words::{vocabulary, words};
use recrash_model::{Seed, math};
use std::collections::BTreeMap;

/// Singular vectors kept. Latent semantic analysis of mixed texts takes 100 or more (Deerwester et al. 1990); crash
/// narratives have a narrow vocabulary, and on NHTSA's file 32 put more narratives beside ones of the same template than
/// 20, 64 or 100 do (`docs/models/selection.md`).
pub const LEXICAL_DIMENSIONS: usize = 32;

/// Name of the lexical embedding in files and reports.
pub const LEXICAL_NAME: &str = "lexical (TF-IDF, truncated SVD)";

/// Embeds texts by the words they use: one row per text, of unit length (or zero, for a text without words).
///
/// Words of the `ignored` texts are left out: give what names the author or the vehicle instead of the crash. A word
/// `t` of text `i` that occurs `f` times weighs `(1 + ln f) * ln((1 + n) / df)`, where `n` is the number of texts and
/// `df` the number that have the word: a sentence that every report repeats weighs next to nothing. Rows are scaled to
/// unit length, projected on the first [`LEXICAL_DIMENSIONS`] right singular vectors, and scaled to unit length again.
/// The result depends on nothing but the texts.
pub fn lexical_embedding(texts: &[&str], ignored: &[&str]) -> Embedding {
    let table = TermTable::of(texts, ignored);
    let directions = table.leading_directions(LEXICAL_DIMENSIONS);
    let mut rows = Matrix::zeros(texts.len(), directions.rows);
    for i in 0..texts.len() {
        let row = rows.row_mut(i);
        for (value, k) in row.iter_mut().zip(0..directions.rows) {
            *value = table.row(i).map(|(term, weight)| weight * directions.row(k)[term]).sum();
        }
        scale_to_unit_length(row);
    }
    Embedding::from_matrix(LEXICAL_NAME, rows)
}

/// Texts by terms: a sparse matrix, row by row.
struct TermTable {
    /// Where each row starts in `entries`, and the end.
    starts: Vec<usize>,
    /// Term and weight.
    entries: Vec<(usize, f64)>,
    terms: usize,
}

impl TermTable {
    fn of(texts: &[&str], ignored: &[&str]) -> Self {
        let ignored = vocabulary(ignored.iter().copied());
        let mut counts: Vec<BTreeMap<String, u32>> = Vec::with_capacity(texts.len());
        let mut texts_with: BTreeMap<String, u32> = BTreeMap::new();
        for text in texts {
            let mut of_text = BTreeMap::new();
            for word in words(text).into_iter().filter(|word| !ignored.contains(word)) {
                *of_text.entry(word).or_insert(0) += 1;
            }
            for word in of_text.keys() {
                *texts_with.entry(word.clone()).or_insert(0) += 1;
            }
            counts.push(of_text);
        }
        let scale = 1.0 + texts.len() as f64;
        let terms: BTreeMap<&str, (usize, f64)> = texts_with
            .iter()
            .enumerate()
            .map(|(term, (word, &df))| (word.as_str(), (term, math::ln(scale / f64::from(df)))))
            .collect();
        let mut table = Self { starts: vec![0], entries: Vec::new(), terms: terms.len() };
        for of_text in &counts {
            let mut row: Vec<(usize, f64)> = of_text
                .iter()
                .map(|(word, &count)| {
                    let (term, rarity) = terms[word.as_str()];
                    (term, (1.0 + math::ln(f64::from(count))) * rarity)
                })
                .collect();
            let length = row.iter().map(|(_, weight)| weight * weight).sum::<f64>().sqrt();
            if length > 0.0 {
                row.iter_mut().for_each(|(_, weight)| *weight /= length);
            }
            table.entries.append(&mut row);
            table.starts.push(table.entries.len());
        }
        table
    }

    fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.entries[self.starts[i]..self.starts[i + 1]].iter().copied()
    }

    /// `A x`.
    fn times(&self, x: &[f64]) -> Vec<f64> {
        (0..self.rows()).map(|i| self.row(i).map(|(term, weight)| weight * x[term]).sum()).collect()
    }

    /// `A^T y`.
    fn transposed_times(&self, y: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.terms];
        for (i, &factor) in y.iter().enumerate() {
            for (term, weight) in self.row(i) {
                x[term] += weight * factor;
            }
        }
        x
    }

    /// At most `count` right singular vectors, that of the greatest singular value first, as rows.
    ///
    /// They come from the symmetric Lanczos method on the smaller of `A A^T` and `A^T A`.
    fn leading_directions(&self, count: usize) -> Matrix {
        let by_texts = self.rows() <= self.terms;
        let size = self.rows().min(self.terms);
        let steps = size.min(2 * count + 50);
        let apply = |x: &[f64]| {
            if by_texts { self.times(&self.transposed_times(x)) } else { self.transposed_times(&self.times(x)) }
        };
        let leading = lanczos(size, steps, apply);
        let kept = leading.values.iter().take(count).take_while(|&&value| value > 1e-10 * leading.values[0]).count();
        let mut directions = Matrix::zeros(kept, self.terms);
        for k in 0..kept {
            let vector = leading.vectors.row(k);
            let of_terms = if by_texts { self.transposed_times(vector) } else { vector.to_vec() };
            directions.row_mut(k).copy_from_slice(&of_terms);
            scale_to_unit_length(directions.row_mut(k));
        }
        directions
    }
}

/// Leading eigenpairs of a symmetric operator: Lanczos with full reorthogonalisation (Golub and Van Loan, section 10.1).
/// Where the Krylov space is exhausted it goes on with a new direction, so with `steps` = `size` all pairs are found.
fn lanczos(size: usize, steps: usize, apply: impl Fn(&[f64]) -> Vec<f64>) -> eigen::Eigen {
    let mut rng = Seed(0).child("lanczos").rng();
    let mut basis = Matrix::zeros(steps, size);
    let mut diagonal = Vec::with_capacity(steps);
    let mut beside = Vec::with_capacity(steps);
    let mut next: Vec<f64> = (0..size).map(|_| rng.normal()).collect();
    scale_to_unit_length(&mut next);
    for step in 0..steps {
        basis.row_mut(step).copy_from_slice(&next);
        next = apply(basis.row(step));
        let overlap = dot(&next, basis.row(step));
        diagonal.push(overlap);
        let before = dot(&next, &next).sqrt();
        remove_directions(&mut next, &basis, step + 1);
        let length = dot(&next, &next).sqrt();
        if length > 1e-10 * before {
            beside.push(length);
            next.iter_mut().for_each(|x| *x /= length);
        } else {
            beside.push(0.0);
            next = (0..size).map(|_| rng.normal()).collect();
            remove_directions(&mut next, &basis, step + 1);
            scale_to_unit_length(&mut next);
        }
    }
    beside.truncate(steps.saturating_sub(1));
    let small = eigen::tridiagonal(diagonal, beside, eigen::identity(steps));
    let mut vectors = Matrix::zeros(steps, size);
    for k in 0..steps {
        for (step, &part) in small.vectors.row(k).iter().enumerate() {
            add_scaled(vectors.row_mut(k), part, basis.row(step));
        }
    }
    eigen::Eigen { values: small.values, vectors }
}

/// Makes `x` orthogonal to the first `count` rows, twice, which is enough (Parlett, "twice is enough").
fn remove_directions(x: &mut [f64], basis: &Matrix, count: usize) {
    for _ in 0..2 {
        for i in 0..count {
            let overlap = dot(x, basis.row(i));
            add_scaled(x, -overlap, basis.row(i));
        }
    }
}

fn scale_to_unit_length(x: &mut [f64]) {
    let length = dot(x, x).sqrt();
    // Shorter than this is what rounding leaves of zero.
    if length > 1e-12 {
        x.iter_mut().for_each(|value| *value /= length);
    } else {
        x.fill(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::oracle;

    #[test]
    fn weights_follow_the_formula() {
        // "car" in both texts: idf ln(3/2); "left" in one: ln 3, twice, so (1 + ln 2) ln 3.
        let table = TermTable::of(&["car left left", "car"], &[]);
        let car = math::ln(1.5);
        let left = (1.0 + math::ln(2.0)) * math::ln(3.0);
        let length = (car * car + left * left).sqrt();
        let row: Vec<_> = table.row(0).collect();
        assert!((row[0].1 - car / length).abs() < 1e-15 && (row[1].1 - left / length).abs() < 1e-15);
        assert!((table.row(1).next().unwrap().1 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn truncated_decomposition_agrees_with_numpy() {
        let fixture = oracle("lexical.json");
        let texts = fixture.texts("texts");
        let table = TermTable::of(&texts.iter().map(String::as_str).collect::<Vec<_>>(), &[]);
        let directions = table.leading_directions(fixture.number("kept") as usize);
        let rows: Vec<Vec<f64>> = (0..table.rows())
            .map(|i| (0..directions.rows).map(|k| table.row(i).map(|(t, w)| w * directions.row(k)[t]).sum()).collect())
            .collect();
        // Inner products do not depend on the signs of the directions.
        let expected = fixture.matrix("inner_products");
        for i in 0..rows.len() {
            for j in 0..rows.len() {
                assert!((dot(&rows[i], &rows[j]) - expected.row(i)[j]).abs() < 1e-10, "{i}, {j}");
            }
        }
    }

    #[test]
    fn lanczos_finds_all_pairs_of_a_diagonal_operator_with_repeats() {
        let values = [5.0, 3.0, 3.0, 3.0, 1.0, 0.0, 0.0];
        let found = lanczos(7, 7, |x| x.iter().zip(values).map(|(x, v)| x * v).collect());
        for (k, value) in values.into_iter().enumerate() {
            assert!((found.values[k] - value).abs() < 1e-10, "{:?}", found.values);
            let vector = found.vectors.row(k);
            for i in 0..7 {
                assert!((values[i] * vector[i] - value * vector[i]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn similar_texts_lie_closer_and_equal_texts_together() {
        let texts = [
            "partner vehicle turned left across the path at the junction",
            "partner vehicle turned left across the path near the junction",
            "cyclist fell beside a parked bus",
            "partner vehicle turned left across the path at the junction",
            "",
        ];
        let embedding = lexical_embedding(&texts, &[]);
        let rows: Vec<&[f64]> = (0..5).map(|i| embedding.row(i)).collect();
        assert!(dot(rows[0], rows[1]) > 0.5 && dot(rows[0], rows[2]).abs() < 0.1);
        assert_eq!(rows[0], rows[3]);
        assert!(rows[4].iter().all(|&x| x == 0.0));
        assert!((dot(rows[2], rows[2]) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn ignored_words_make_no_difference() {
        let with = lexical_embedding(&["Acme reports a rear impact", "Zed reports a side impact"], &["Acme Zed LLC"]);
        let without = lexical_embedding(&["reports a rear impact", "reports a side impact"], &[]);
        assert_eq!(with, without);
    }

    #[test]
    fn texts_without_words_embed_to_nothing() {
        assert_eq!(lexical_embedding(&[], &[]).rows(), 0);
        assert_eq!(lexical_embedding(&["", "[XXX]"], &[]).dimensions(), 0);
    }
}

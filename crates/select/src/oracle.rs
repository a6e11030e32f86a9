//! Numbers that other programs computed: `oracle/oracle.py` writes the files, tests read them.

use crate::matrix::Matrix;
use serde_json::Value;

/// The numbers in one file.
pub(crate) struct Oracle(Value);

/// Reads `oracle/NAME`.
pub(crate) fn oracle(name: &str) -> Oracle {
    let text = match name {
        "pca.json" => include_str!("../oracle/pca.json"),
        "clusters.json" => include_str!("../oracle/clusters.json"),
        "lexical.json" => include_str!("../oracle/lexical.json"),
        _ => panic!("no oracle {name}"),
    };
    Oracle(serde_json::from_str(text).expect("oracle files are JSON"))
}

impl Oracle {
    pub fn number(&self, key: &str) -> f64 {
        self.0[key].as_f64().unwrap_or_else(|| panic!("no number {key}"))
    }

    pub fn numbers(&self, key: &str) -> Vec<f64> {
        serde_json::from_value(self.0[key].clone()).unwrap_or_else(|e| panic!("{key}: {e}"))
    }

    pub fn whole_numbers(&self, key: &str) -> Vec<usize> {
        serde_json::from_value(self.0[key].clone()).unwrap_or_else(|e| panic!("{key}: {e}"))
    }

    pub fn texts(&self, key: &str) -> Vec<String> {
        serde_json::from_value(self.0[key].clone()).unwrap_or_else(|e| panic!("{key}: {e}"))
    }

    pub fn matrix(&self, key: &str) -> Matrix {
        let rows: Vec<Vec<f64>> = serde_json::from_value(self.0[key].clone()).unwrap_or_else(|e| panic!("{key}: {e}"));
        Matrix::from_rows(rows[0].len(), &rows)
    }
}

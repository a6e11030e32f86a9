//! What goes wrong, as Python's exceptions: `recrash.errors` has their classes.

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use recrash_model::Diagnostic;
use recrash_pipeline::PipelineError;
use serde::Serialize;

/// A class of `recrash.errors`.
#[derive(Clone, Copy)]
pub enum Kind {
    /// What was given cannot be used.
    Input,
    /// An ego did something wrong.
    Ego,
    /// Anything else.
    Other,
}

static INPUT: PyOnceLock<Py<PyType>> = PyOnceLock::new();
static EGO: PyOnceLock<Py<PyType>> = PyOnceLock::new();
static OTHER: PyOnceLock<Py<PyType>> = PyOnceLock::new();

/// An exception of this kind.
pub fn error(py: Python<'_>, kind: Kind, message: String) -> PyErr {
    with_diagnostics(py, kind, message, &[])
}

/// What cannot be used, and why.
pub fn input(py: Python<'_>, message: impl ToString) -> PyErr {
    error(py, Kind::Input, message.to_string())
}

/// What the library could not do.
pub fn of_library(py: Python<'_>, failed: &PipelineError) -> PyErr {
    match failed {
        PipelineError::BadInput { what, diagnostics } => with_diagnostics(py, Kind::Input, what.clone(), diagnostics),
        PipelineError::Scenario { .. } => error(py, Kind::Ego, failed.to_string()),
        other if other.exit_code() == 1 => error(py, Kind::Other, other.to_string()),
        other => error(py, Kind::Input, other.to_string()),
    }
}

fn with_diagnostics(py: Python<'_>, kind: Kind, what: String, diagnostics: &[Diagnostic]) -> PyErr {
    let (cell, name) = match kind {
        Kind::Input => (&INPUT, "InputError"),
        Kind::Ego => (&EGO, "EgoError"),
        Kind::Other => (&OTHER, "RecrashError"),
    };
    let lines = diagnostics.iter().map(|diagnostic| format!("\n  {diagnostic}"));
    let message: String = std::iter::once(what).chain(lines).collect();
    let made = || {
        let list = to_python(py, &diagnostics)?;
        cell.import(py, "recrash.errors", name)?.call1((message, list))
    };
    match made() {
        Ok(made) => PyErr::from_value(made),
        Err(error) => error,
    }
}

/// A value as plain Python objects, as its JSON has it.
pub fn to_python<'py, T: Serialize>(py: Python<'py>, value: &T) -> PyResult<Bound<'py, PyAny>> {
    let text =
        serde_json::to_string(value).map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    from_json(py, &text)
}

/// JSON as plain Python objects.
pub fn from_json<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import(pyo3::intern!(py, "json"))?.call_method1(pyo3::intern!(py, "loads"), (text,))
}

/// Plain Python objects as JSON.
///
/// # Errors
/// They are not plain.
pub fn to_json(value: &Bound<'_, PyAny>) -> PyResult<String> {
    let py = value.py();
    py.import(pyo3::intern!(py, "json"))?.call_method1(pyo3::intern!(py, "dumps"), (value,))?.extract()
}

//! Crash files: read into accounts, into scenarios, into tables.

use crate::errors::{input, of_library, to_python};
use crate::scenario::Scenario;
use crate::table::Table;
use pyo3::prelude::*;
use recrash_model::account::Account;
use recrash_pipeline::{
    NoProgress, Options, RecordSource, ReportedColumns, TableRows, account_table, reconstruct_accounts,
    reconstruction_table, record_table, reported_columns,
};
use std::path::PathBuf;

/// What crash files tell, one account an incident. It never changes.
#[pyclass(frozen, module = "recrash")]
pub struct Accounts {
    accounts: recrash_pipeline::Accounts,
    columns: ReportedColumns,
}

#[pymethods]
impl Accounts {
    /// Main facts of every account, a row an incident.
    #[getter]
    fn table(&self, py: Python<'_>) -> PyResult<Table> {
        Table::of_table(py, account_table(&self.accounts.accounts, &self.columns))
    }

    /// Rows of the files that are crash reports.
    #[getter]
    fn reports(&self) -> usize {
        self.accounts.reports
    }

    /// Incidents, those without a narrative among them.
    #[getter]
    fn incidents(&self) -> usize {
        self.accounts.incidents.len()
    }

    /// Remarks on the files.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.accounts.diagnostics.iter().map(ToString::to_string).collect()
    }

    /// Reconstructs every account: the scenarios that show every told fact that is checked, and a table of what became of each.
    fn reconstruct(&self, py: Python<'_>) -> PyResult<(Vec<Scenario>, Table)> {
        let accounts = &self.accounts.accounts;
        let retold = py.detach(|| reconstruct_accounts(accounts, &NoProgress));
        let mut scenarios = Vec::new();
        for each in &retold {
            let Some(made) = each.shown() else { continue };
            let account = &accounts[each.account];
            let checked = recrash_roads::check(made.draft.clone()).map_err(|_| {
                input(py, format!("{}: its own reconstruction does not pass the check", account.incident))
            })?;
            scenarios.push(Scenario::of(checked.value, made.assumed.clone(), crash_type(account)));
        }
        let table = py.detach(|| reconstruction_table(accounts, &retold));
        Ok((scenarios, Table::of_table(py, table)?))
    }

    /// Accounts `begin` to `end` (which is not among them), without what the files say besides: to share work out.
    fn part(&self, begin: usize, end: usize) -> Self {
        let all = &self.accounts.accounts;
        let end = end.min(all.len());
        let part = all[begin.min(end)..end].to_vec();
        let columns = part.iter().filter_map(|account| self.columns.get_key_value(&account.incident));
        let columns = columns.map(|(incident, reported)| (incident.clone(), reported.clone())).collect();
        Self::alone(part, columns)
    }

    /// Pickled as the JSON of its accounts, so that it goes from process to process; what the files say besides stays behind.
    #[allow(clippy::type_complexity, reason = "Python's protocol: a callable and its arguments")]
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String, String))> {
        let restore = py.get_type::<Self>().getattr("_restore")?;
        let accounts = serde_json::to_string(&self.accounts.accounts).map_err(|error| input(py, error))?;
        let columns = serde_json::to_string(&self.columns).map_err(|error| input(py, error))?;
        Ok((restore, (accounts, columns)))
    }

    /// What `pickle` calls.
    #[staticmethod]
    fn _restore(py: Python<'_>, accounts: &str, columns: &str) -> PyResult<Self> {
        let accounts = serde_json::from_str(accounts).map_err(|error| input(py, error))?;
        Ok(Self::alone(accounts, serde_json::from_str(columns).map_err(|error| input(py, error))?))
    }

    fn __len__(&self) -> usize {
        self.accounts.accounts.len()
    }

    /// One account as plain objects.
    fn __getitem__<'py>(&self, py: Python<'py>, number: isize) -> PyResult<Bound<'py, PyAny>> {
        let count = self.accounts.accounts.len() as isize;
        let at = if number < 0 { number + count } else { number };
        let account = usize::try_from(at).ok().and_then(|at| self.accounts.accounts.get(at));
        match account {
            Some(account) => to_python(py, account),
            None => Err(pyo3::exceptions::PyIndexError::new_err(format!("account {number} of {count}"))),
        }
    }

    fn __repr__(&self) -> String {
        let (reports, incidents, accounts) = (self.reports(), self.incidents(), self.accounts.accounts.len());
        format!("Accounts({accounts} accounts of {incidents} incidents in {reports} reports)")
    }
}

impl Accounts {
    /// Accounts without their files.
    fn alone(accounts: Vec<Account>, columns: ReportedColumns) -> Self {
        let (files, incidents, diagnostics) = (Vec::new(), Vec::new(), Vec::new());
        Self { accounts: recrash_pipeline::Accounts { files, reports: 0, incidents, accounts, diagnostics }, columns }
    }
}

/// The type of crash as its format writes it.
fn crash_type(account: &Account) -> Option<String> {
    let told = serde_json::to_value(account.crash_type.as_ref()?.value).ok()?;
    Some(told.as_str().map_or_else(|| told.to_string(), str::to_owned))
}

/// What is read, and how.
fn options(
    files: Option<Vec<PathBuf>>,
    filter: Option<String>,
    mapping: Option<PathBuf>,
    profile: Option<String>,
) -> Options {
    let default = Options::default();
    let records = files.map_or(RecordSource::Sample, RecordSource::Files);
    Options { records, filter, mapping, profile: profile.unwrap_or(default.profile), ..Options::default() }
}

/// Reads crash files into accounts; the built-in sample without any.
#[pyfunction]
#[pyo3(signature = (files=None, filter=None, mapping=None, profile=None))]
pub fn read_accounts(
    py: Python<'_>,
    files: Option<Vec<PathBuf>>,
    filter: Option<String>,
    mapping: Option<PathBuf>,
    profile: Option<String>,
) -> PyResult<Accounts> {
    let options = options(files, filter, mapping, profile);
    let read = py.detach(|| recrash_pipeline::read_accounts(&options));
    let accounts = read.map_err(|failed| of_library(py, &failed))?;
    let columns = reported_columns(&accounts.incidents);
    Ok(Accounts { accounts, columns })
}

/// Reads crash files into a table of records, every field a column; the built-in sample without any.
#[pyfunction]
#[pyo3(signature = (files=None, filter=None, mapping=None, profile=None, all=false))]
pub fn read_records(
    py: Python<'_>,
    files: Option<Vec<PathBuf>>,
    filter: Option<String>,
    mapping: Option<PathBuf>,
    profile: Option<String>,
    all: bool,
) -> PyResult<Table> {
    let options = options(files, filter, mapping, profile);
    let read = py.detach(|| recrash_pipeline::read_records(&options)).map_err(|failed| of_library(py, &failed))?;
    let rows = if all { TableRows::All } else { TableRows::Usable };
    Table::of_table(py, record_table(&read.value, rows))
}

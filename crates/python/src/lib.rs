//! The extension module `recrash._recrash`: the Rust library as Python objects, and nothing that it does not have.
//!
//! What stands here turns arguments into values of the library, calls it without Python's lock, and turns what comes back
//! into objects, arrays and tables. The pure part of the package (`python/recrash`) presents it.

mod batch;
mod ego;
mod errors;
mod host;
mod reading;
mod run;
mod scenario;
mod search;
mod simulator;
mod suite;
mod table;

use pyo3::prelude::*;

/// Runs the `recrash` command. Gives the exit code.
#[pyfunction]
fn command(py: Python<'_>, words: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| recrash_cli::command(words))
}

#[pymodule]
fn _recrash(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("EGOS", recrash_sim::Ego::NAMES)?;
    module.add("METADRIVE_EGOS", recrash_pipeline::metadrive_egos())?;
    module.add_class::<scenario::Scenario>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<table::Table>()?;
    module.add_class::<reading::Accounts>()?;
    module.add_class::<batch::Batch>()?;
    module.add_class::<search::Points>()?;
    module.add_class::<simulator::Simulator>()?;
    module.add_function(wrap_pyfunction!(search::tune_one, module)?)?;
    module.add_function(wrap_pyfunction!(command, module)?)?;
    module.add_function(wrap_pyfunction!(reading::read_accounts, module)?)?;
    module.add_function(wrap_pyfunction!(reading::read_records, module)?)?;
    module.add_function(wrap_pyfunction!(suite::run_suite, module)?)?;
    module.add_function(wrap_pyfunction!(suite::suite_options, module)?)?;
    module.add_function(wrap_pyfunction!(suite::crash_types, module)?)?;
    module.add_function(wrap_pyfunction!(batch::held_out, module)?)?;
    batch::add_constants(module)
}

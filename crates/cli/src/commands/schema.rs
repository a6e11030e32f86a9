//! `recrash schema`.

use crate::output;
use recrash_pipeline::{PipelineError, schema};

/// Prints the JSON Schema of scenario files.
///
/// # Errors
/// Never.
pub fn run() -> Result<(), PipelineError> {
    output::json(&schema());
    Ok(())
}

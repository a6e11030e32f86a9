//! What is installed, for `recrash doctor`.

use crate::worker::Worker;
use crate::{METADRIVE_VERSION, MetadriveError};
use std::fmt;
use std::path::Path;
use std::time::Duration;

/// What was found on one interpreter.
#[derive(Debug)]
pub struct Inspection {
    /// Version of Python.
    pub python: Option<String>,
    /// Version of MetaDrive.
    pub metadrive: Option<String>,
    /// Why it cannot be used, and how to mend that; `None` where all is well.
    pub problem: Option<MetadriveError>,
}

impl fmt::Display for Inspection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.problem, &self.python) {
            (Some(problem), _) => write!(f, "MetaDrive: not usable: {problem}"),
            (None, python) => {
                let python = python.as_deref().unwrap_or("?");
                write!(f, "MetaDrive: {METADRIVE_VERSION} on Python {python}, ready")
            }
        }
    }
}

/// Starts a worker on an interpreter and asks what it has.
pub fn inspect(python: &Path, patience: Duration) -> Inspection {
    match Worker::start(python, patience) {
        Ok(worker) => {
            let hello = worker.hello();
            Inspection { python: Some(hello.python.clone()), metadrive: hello.metadrive.clone(), problem: None }
        }
        Err(problem) => Inspection { python: None, metadrive: None, problem: Some(problem) },
    }
}

//! How the pipeline tells what it is doing.

/// Listens to the pipeline. Called from several threads.
pub trait Progress: Sync {
    /// Something happened.
    fn event(&self, event: ProgressEvent<'_>);
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProgressEvent<'a> {
    /// There is something to know before it goes on.
    Said {
        /// What, in a sentence.
        what: &'a str,
    },
    /// A stage begins.
    Started {
        /// Its name.
        stage: &'a str,
        /// Units of work.
        units: usize,
    },
    /// A unit of work is done.
    Advanced {
        /// The stage's name.
        stage: &'a str,
        /// The unit's name.
        unit: &'a str,
        /// Whether it was there already.
        skipped: bool,
    },
    /// A stage is done.
    Finished {
        /// Its name.
        stage: &'a str,
    },
}

/// Listens to nothing.
pub struct NoProgress;

impl Progress for NoProgress {
    fn event(&self, _event: ProgressEvent<'_>) {}
}

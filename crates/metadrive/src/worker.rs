//! One worker process: started, asked, and ended.

use crate::MetadriveError;
use crate::protocol::{Answer, Done, Hello, Message, Problem, Request};
use recrash_child::{Program, Silence, printable};
use recrash_plan::metadrive::{Run, SCRIPT};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// Reads the script from stdin, its length being the first argument: neither a temporary file nor a long command line.
const BOOT: &str = "import sys; exec(compile(sys.stdin.buffer.read(int(sys.argv[1])), 'run_metadrive.py', 'exec'))";

/// The longest answer; the longest rollout of 17 actors has a few megabytes. [bytes]
const MAX_ANSWER_BYTES: u64 = 64 << 20;

/// Why a worker could not finish a scenario.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WorkerFault {
    /// It did not answer in time and was ended.
    #[error("no answer within {seconds} s")]
    Hung {
        /// How long it was waited for. [s]
        seconds: u64,
    },
    /// It ended by itself.
    #[error("the worker ended{}", complained(complaint))]
    Died {
        /// The last it wrote to stderr.
        complaint: String,
    },
    /// It wrote something that is no answer.
    #[error("the worker wrote something else than an answer: {beginning}")]
    Rubbish {
        /// The beginning of what it wrote.
        beginning: String,
    },
    /// The scenario goes on with something that cannot be known there.
    #[error("{why}")]
    Refused {
        /// What.
        why: String,
    },
    /// MetaDrive raised an error.
    #[error("MetaDrive raised {error}")]
    Raised {
        /// The error.
        error: String,
    },
}

/// Why MetaDrive cannot be used although Python runs.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotReady {
    /// The package is not installed.
    #[error("MetaDrive is not installed in Python {python}; {}", crate::INSTALL_HINT)]
    Missing {
        /// Python's version.
        python: String,
    },
    /// Another version is.
    #[error("MetaDrive {found} is installed, but {} is needed; {}", crate::METADRIVE_VERSION, crate::INSTALL_HINT)]
    Version {
        /// Its version.
        found: String,
    },
    /// It is installed but cannot be imported.
    #[error("MetaDrive cannot be imported: {detail}")]
    Import {
        /// What Python said.
        detail: String,
    },
    /// The program is no Python that can run the worker.
    #[error("this is no Python that can run MetaDrive: {fault}; it needs Python 3.7 to 3.11")]
    NoWorker {
        /// What happened instead.
        fault: WorkerFault,
    },
}

impl NotReady {
    /// What a worker says of itself at first.
    fn of(problem: &Problem, hello: &Hello) -> Self {
        match problem.kind.as_str() {
            "metadrive_missing" => Self::Missing { python: hello.python.clone() },
            "metadrive_version" => Self::Version { found: hello.metadrive.clone().unwrap_or_default() },
            _ => Self::Import { detail: problem.detail.clone() },
        }
    }
}

fn complained(complaint: &str) -> String {
    if complaint.is_empty() { String::new() } else { format!(", saying: {complaint}") }
}

/// A running worker that has said hello.
pub(crate) struct Worker {
    program: Program,
    hello: Hello,
    requests: u64,
    /// Maps it has built, which it keeps.
    pub(crate) maps: u64,
}

impl Worker {
    /// Starts a worker and waits until MetaDrive is imported.
    pub(crate) fn start(python: &Path, patience: Duration) -> Result<Self, MetadriveError> {
        let mut command = Command::new(python);
        command
            .args(["-c", BOOT, &SCRIPT.len().to_string(), "--worker"])
            // Sets of strings are iterated somewhere inside; one seed for all workers.
            .env("PYTHONHASHSEED", "0")
            .env("PYTHONUTF8", "1")
            // A worker is one thread; the pool is what runs in parallel.
            .env("OMP_NUM_THREADS", "1")
            .env("OPENBLAS_NUM_THREADS", "1");
        let program = Program::start(&mut command, MAX_ANSWER_BYTES)
            .map_err(|error| MetadriveError::NoPython { python: python.to_owned(), reason: error.to_string() })?;
        let mut worker = Self { program, hello: Hello::default(), requests: 0, maps: 0 };
        let not_ready = |reason| MetadriveError::NotReady { reason };
        match worker.ask(SCRIPT.as_bytes().to_vec(), patience) {
            Ok(Message::Hello { hello }) => match &hello.problem {
                None => {
                    worker.hello = hello;
                    Ok(worker)
                }
                Some(problem) => Err(not_ready(NotReady::of(problem, &hello))),
            },
            Ok(Message::Answer(_)) => {
                Err(not_ready(NotReady::NoWorker { fault: WorkerFault::Rubbish { beginning: "an answer".to_owned() } }))
            }
            Err(fault) => Err(not_ready(NotReady::NoWorker { fault })),
        }
    }

    /// What it said first.
    pub(crate) fn hello(&self) -> &Hello {
        &self.hello
    }

    /// Runs one scenario. After any fault but [`WorkerFault::Raised`] and [`WorkerFault::Refused`] the worker must not be used again.
    pub(crate) fn run(&mut self, run: &Run, patience: Duration) -> Result<Done, WorkerFault> {
        self.requests += 1;
        let request = Request { id: self.requests, run };
        let mut line =
            serde_json::to_vec(&request).map_err(|error| WorkerFault::Raised { error: error.to_string() })?;
        line.push(b'\n');
        match self.ask(line, patience)? {
            Message::Answer(Answer { id, refused: Some(why), .. }) if id == self.requests => {
                Err(WorkerFault::Refused { why: printable(&why, 500) })
            }
            Message::Answer(Answer { id, done: Some(done), error: None, .. }) if id == self.requests => {
                self.maps = done.maps;
                Ok(done)
            }
            Message::Answer(Answer { id, done: None, error: Some(error), .. }) if id == self.requests => {
                Err(WorkerFault::Raised { error: printable(&error, 500) })
            }
            _ => Err(WorkerFault::Rubbish { beginning: "an answer to another question".to_owned() }),
        }
    }

    fn ask(&mut self, bytes: Vec<u8>, patience: Duration) -> Result<Message, WorkerFault> {
        let line = self.program.ask(bytes, patience).map_err(|silence| match silence {
            Silence::Hung => WorkerFault::Hung { seconds: patience.as_secs() },
            Silence::TooLong => WorkerFault::Rubbish { beginning: "more than 64 MiB in one line".to_owned() },
            Silence::Ended { complaint, .. } => WorkerFault::Died { complaint: printable(&complaint, 300) },
        })?;
        serde_json::from_str(&line).map_err(|_| WorkerFault::Rubbish { beginning: printable(&line, 80) })
    }
}

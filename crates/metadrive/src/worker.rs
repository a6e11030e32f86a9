//! One worker process: started, asked, and ended.

use crate::MetadriveError;
use crate::protocol::{Answer, Done, Hello, Message, Request, RunSpec};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What the workers run.
pub(crate) const SCRIPT: &str = include_str!("../worker/metadrive_worker.py");

/// Reads the script from stdin, its length being the first argument: neither a temporary file nor a long command line.
const BOOT: &str = "import sys; exec(compile(sys.stdin.buffer.read(int(sys.argv[1])), 'metadrive_worker.py', 'exec'))";

/// The longest answer; the longest rollout of 17 actors has a few megabytes. [bytes]
const MAX_ANSWER_BYTES: u64 = 64 << 20;

/// How much of what a worker complained about is kept. [bytes]
const KEPT_COMPLAINT_BYTES: usize = 2000;

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

fn complained(complaint: &str) -> String {
    if complaint.is_empty() { String::new() } else { format!(", saying: {complaint}") }
}

/// A running worker that has said hello.
pub(crate) struct Worker {
    child: Child,
    /// To the thread that writes to its stdin: a worker that does not read must not stop us.
    stdin: Option<Sender<Vec<u8>>>,
    answers: Receiver<Line>,
    complaint: Arc<Mutex<String>>,
    hello: Hello,
    requests: u64,
    /// Maps it has built, which it keeps.
    pub(crate) maps: u64,
}

/// A line of output.
enum Line {
    Text(String),
    TooLong,
}

impl Worker {
    /// Starts a worker and waits until MetaDrive is imported.
    pub(crate) fn start(python: &Path, patience: Duration) -> Result<Self, MetadriveError> {
        let mut child = Command::new(python)
            .args(["-c", BOOT, &SCRIPT.len().to_string()])
            // Sets of strings are iterated somewhere inside; one seed for all workers.
            .env("PYTHONHASHSEED", "0")
            .env("PYTHONUTF8", "1")
            // A worker is one thread; the pool is what runs in parallel.
            .env("OMP_NUM_THREADS", "1")
            .env("OPENBLAS_NUM_THREADS", "1")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| MetadriveError::NoPython { python: python.to_owned(), reason: error.to_string() })?;
        let answers = read_lines(child.stdout.take());
        let complaint = keep_tail(child.stderr.take());
        let stdin = child.stdin.take().map(write_all);
        let hello = Hello::default();
        let mut worker = Self { child, stdin, answers, complaint, hello, requests: 0, maps: 0 };
        let not_ready = |reason| MetadriveError::NotReady { reason };
        let said = worker.write(SCRIPT.as_bytes().to_vec()).and_then(|()| worker.receive(patience));
        match said {
            Ok(Message::Hello { hello }) => match &hello.problem {
                None => {
                    worker.hello = hello;
                    Ok(worker)
                }
                Some(problem) => Err(not_ready(problem.reason(&hello))),
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

    /// Runs one scenario. After any fault but [`WorkerFault::Raised`] the worker must not be used again.
    pub(crate) fn run(&mut self, run: &RunSpec, patience: Duration) -> Result<Done, WorkerFault> {
        self.requests += 1;
        let request = Request { id: self.requests, run };
        let mut line =
            serde_json::to_vec(&request).map_err(|error| WorkerFault::Raised { error: error.to_string() })?;
        line.push(b'\n');
        self.write(line)?;
        match self.receive(patience)? {
            Message::Answer(Answer { id, done: Some(done), error: None }) if id == self.requests => {
                self.maps = done.maps;
                Ok(done)
            }
            Message::Answer(Answer { id, done: None, error: Some(error) }) if id == self.requests => {
                Err(WorkerFault::Raised { error: printable(&error, 500) })
            }
            _ => Err(WorkerFault::Rubbish { beginning: "an answer to another question".to_owned() }),
        }
    }

    fn write(&mut self, bytes: Vec<u8>) -> Result<(), WorkerFault> {
        let gone = self.stdin.as_ref().is_none_or(|stdin| stdin.send(bytes).is_err());
        if gone { Err(self.died()) } else { Ok(()) }
    }

    fn receive(&mut self, patience: Duration) -> Result<Message, WorkerFault> {
        match self.answers.recv_timeout(patience) {
            Ok(Line::Text(line)) => {
                serde_json::from_str(&line).map_err(|_| WorkerFault::Rubbish { beginning: printable(&line, 80) })
            }
            Ok(Line::TooLong) => Err(WorkerFault::Rubbish { beginning: "more than 64 MiB in one line".to_owned() }),
            Err(RecvTimeoutError::Timeout) => Err(WorkerFault::Hung { seconds: patience.as_secs() }),
            Err(RecvTimeoutError::Disconnected) => Err(self.died()),
        }
    }

    /// What to say of a worker that has ended; its last words may still be on their way.
    fn died(&mut self) -> WorkerFault {
        let until = Instant::now() + Duration::from_secs(1);
        while Instant::now() < until && matches!(self.child.try_wait(), Ok(None)) {
            std::thread::sleep(Duration::from_millis(10));
        }
        std::thread::sleep(Duration::from_millis(20));
        let complaint = self.complaint.lock().unwrap_or_else(PoisonError::into_inner);
        let last = complaint.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
        WorkerFault::Died { complaint: printable(last, 300) }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // Without its stdin a healthy worker ends by itself, but nobody waits for a sick one.
        self.stdin = None;
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The beginning of a text without control characters: it comes from another program.
fn printable(text: &str, longest: usize) -> String {
    text.chars().filter(|c| !c.is_control()).take(longest).collect()
}

/// Writes everything that is sent; ends when the pipe or the channel closes.
fn write_all(mut pipe: impl Write + Send + 'static) -> Sender<Vec<u8>> {
    let (sender, receiver) = channel::<Vec<u8>>();
    std::thread::spawn(move || {
        for bytes in receiver {
            if pipe.write_all(&bytes).and_then(|()| pipe.flush()).is_err() {
                return;
            }
        }
    });
    sender
}

/// Sends every line of a pipe; the channel closes with the pipe.
fn read_lines(pipe: Option<impl Read + Send + 'static>) -> Receiver<Line> {
    // One answer at a time is awaited: a worker that writes more than it was asked for waits itself.
    let (sender, receiver) = sync_channel(1);
    if let Some(pipe) = pipe {
        std::thread::spawn(move || {
            let mut reader = BufReader::new(pipe);
            loop {
                let mut line = Vec::new();
                match reader.by_ref().take(MAX_ANSWER_BYTES).read_until(b'\n', &mut line) {
                    Ok(0) | Err(_) => return,
                    Ok(_) if line.last() == Some(&b'\n') || (line.len() as u64) < MAX_ANSWER_BYTES => {
                        if sender.send(Line::Text(String::from_utf8_lossy(&line).into_owned())).is_err() {
                            return;
                        }
                    }
                    Ok(_) => {
                        let _ = sender.send(Line::TooLong);
                        return;
                    }
                }
            }
        });
    }
    receiver
}

/// Keeps the last of what comes through a pipe, so that it never fills.
fn keep_tail(pipe: Option<impl Read + Send + 'static>) -> Arc<Mutex<String>> {
    let kept = Arc::new(Mutex::new(String::new()));
    if let Some(mut pipe) = pipe {
        let kept = Arc::clone(&kept);
        std::thread::spawn(move || {
            let mut tail = Vec::new();
            let mut piece = [0_u8; 4096];
            while let Ok(read @ 1..) = pipe.read(&mut piece) {
                tail.extend_from_slice(&piece[..read]);
                let surplus = tail.len().saturating_sub(KEPT_COMPLAINT_BYTES);
                tail.drain(..surplus);
                *kept.lock().unwrap_or_else(PoisonError::into_inner) = String::from_utf8_lossy(&tail).into_owned();
            }
        });
    }
    kept
}

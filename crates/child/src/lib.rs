//! Programs that are started: asked line by line ([`Program`]), or run to their end ([`run`]). Whatever one of them does,
//! it is waited for so long and no longer, no more than so much of what it says is kept, and none of them is left running,
//! nor anything that it started. It sees of our environment what a program needs, and no key ([`let_through`]).
//!
//! What this crate does **not** do: it does not look at what is said.

mod environment;
mod group;

pub use environment::{PASS_VARIABLE, let_through};
pub use group::end_all;

use group::Group;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How much of a pipe is kept that nobody waits for: the last of it. [bytes]
const KEPT_BYTES: usize = 1 << 16;

/// Longest last words; whoever shows them looks through them first. [characters]
const LONGEST_COMPLAINT: usize = 8_192;

/// How long a program may take to end that has closed its output, and then its last words to come.
const LAST_WORDS: Duration = Duration::from_secs(1);

/// A running program that answers in lines. It is ended with this value.
pub struct Program {
    child: Group,
    /// To the thread that writes to its stdin: a program that does not read must not stop us.
    stdin: Option<Sender<Vec<u8>>>,
    lines: Receiver<Result<String, Silence>>,
    stderr: Tail,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Silence {
    /// It did not come in time.
    Hung,
    /// Its line is longer than was allowed.
    TooLong,
    /// The program has ended.
    Ended {
        /// Its exit status; `None` where it runs on and has closed its output.
        status: Option<ExitStatus>,
        /// The last line it wrote to stderr, printable; may be empty.
        complaint: String,
    },
}

impl Program {
    /// Starts it. A line of more than `longest_line` bytes is no answer.
    ///
    /// # Errors
    /// What the system says where it cannot be started.
    pub fn start(command: &mut Command, longest_line: u64) -> io::Result<Self> {
        let mut child = Group::start(command.stdin(Stdio::piped()))?;
        let lines = read_lines(child.leader.stdout.take(), longest_line);
        let stderr = Tail::of(child.leader.stderr.take());
        let stdin = child.leader.stdin.take().map(write_all);
        Ok(Self { child, stdin, lines, stderr })
    }

    /// Says something; false where nobody listens.
    pub fn say(&self, bytes: Vec<u8>) -> bool {
        self.stdin.as_ref().is_some_and(|stdin| stdin.send(bytes).is_ok())
    }

    /// Says something and waits for the line that answers it.
    ///
    /// # Errors
    /// None came. The next line would answer another question, so the program is to be asked no more.
    pub fn ask(&mut self, bytes: Vec<u8>, patience: Duration) -> Result<String, Silence> {
        if !self.say(bytes) {
            return Err(self.ended());
        }
        match self.lines.recv_timeout(patience) {
            Ok(line) => line,
            Err(RecvTimeoutError::Timeout) => Err(Silence::Hung),
            Err(RecvTimeoutError::Disconnected) => Err(self.ended()),
        }
    }

    /// Closes its input, at which a healthy program ends by itself, and waits for that.
    pub fn dismiss(&mut self, patience: Duration) {
        self.stdin = None;
        self.child.wait(patience);
    }

    fn ended(&mut self) -> Silence {
        let status = self.child.wait(LAST_WORDS);
        let complaint = self.stderr.text();
        let last = complaint.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
        Silence::Ended { status, complaint: printable(last, LONGEST_COMPLAINT) }
    }
}

/// What a program left that ran to its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finished {
    /// Its exit status.
    pub status: ExitStatus,
    /// The last 64 KiB that it wrote to stdout.
    pub stdout: String,
    /// The last 64 KiB that it wrote to stderr.
    pub stderr: String,
}

/// Runs a program to its end; `None` where it took too long and was ended.
///
/// # Errors
/// What the system says where it cannot be started.
pub fn run(command: &mut Command, patience: Duration) -> io::Result<Option<Finished>> {
    let mut child = Group::start(command.stdin(Stdio::null()))?;
    let (stdout, stderr) = (Tail::of(child.leader.stdout.take()), Tail::of(child.leader.stderr.take()));
    let status = child.wait(patience);
    // What it left running keeps the pipes open, and would be waited for.
    drop(child);
    Ok(status.map(|status| Finished { status, stdout: stdout.text(), stderr: stderr.text() }))
}

/// The beginning of a text without control characters: it comes from another program.
pub fn printable(text: &str, longest: usize) -> String {
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

/// Sends every line of a pipe, up to one that is too long; the channel closes with the pipe.
fn read_lines(pipe: Option<impl Read + Send + 'static>, longest: u64) -> Receiver<Result<String, Silence>> {
    // One answer at a time is awaited: a program that writes more than it was asked for waits itself.
    let (sender, receiver) = sync_channel(1);
    if let Some(pipe) = pipe {
        std::thread::spawn(move || {
            let mut reader = BufReader::new(pipe);
            loop {
                let mut line = Vec::new();
                let text = match reader.by_ref().take(longest).read_until(b'\n', &mut line) {
                    Ok(0) | Err(_) => return,
                    Ok(_) if line.last() == Some(&b'\n') || (line.len() as u64) < longest => {
                        Ok(String::from_utf8_lossy(&line).into_owned())
                    }
                    Ok(_) => Err(Silence::TooLong),
                };
                let last = text.is_err();
                if sender.send(text).is_err() || last {
                    return;
                }
            }
        });
    }
    receiver
}

/// The last of what comes through a pipe, which is read all the time, so that it never fills.
struct Tail {
    kept: Arc<Mutex<Vec<u8>>>,
    /// Closes with the pipe.
    open: Receiver<()>,
}

impl Tail {
    fn of(pipe: Option<impl Read + Send + 'static>) -> Self {
        let kept = Arc::new(Mutex::new(Vec::new()));
        let (sender, open) = channel();
        if let Some(mut pipe) = pipe {
            let kept = Arc::clone(&kept);
            std::thread::spawn(move || {
                let mut piece = [0_u8; 4096];
                while let Ok(read @ 1..) = pipe.read(&mut piece) {
                    let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
                    kept.extend_from_slice(&piece[..read]);
                    let surplus = kept.len().saturating_sub(KEPT_BYTES);
                    kept.drain(..surplus);
                }
                drop(sender);
            });
        }
        Self { kept, open }
    }

    /// What is kept of a program that has ended; its last words may still be on their way.
    fn text(&self) -> String {
        let _ = self.open.recv_timeout(LAST_WORDS);
        String::from_utf8_lossy(&self.kept.lock().unwrap_or_else(PoisonError::into_inner)).into_owned()
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::time::Instant;

    const LONG: Duration = Duration::from_secs(20);

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    fn answer(script: &str, patience: Duration) -> Result<String, Silence> {
        Program::start(&mut shell(script), 10).expect("a shell").ask(b"question\n".to_vec(), patience)
    }

    #[test]
    fn a_line_is_answered_with_a_line() {
        assert_eq!(answer("read line; echo \"<$line\"", LONG), Ok("<question\n".to_owned()));
        assert_eq!(answer("printf cut", LONG), Ok("cut".to_owned()));
    }

    #[test]
    fn silence_has_its_reason() {
        assert_eq!(answer("exec sleep 60", Duration::from_millis(50)), Err(Silence::Hung));
        assert_eq!(answer("echo 1234567890; exec sleep 60", LONG), Err(Silence::TooLong));
        let Err(Silence::Ended { status, complaint }) = answer("echo first >&2; echo last >&2; exit 3", LONG) else {
            panic!("it has ended");
        };
        assert_eq!((status.and_then(|status| status.code()), complaint.as_str()), (Some(3), "last"));
    }

    #[test]
    fn a_program_runs_to_its_end_or_is_ended() {
        let run = |script: &str, patience| super::run(&mut shell(script), patience).expect("a shell");
        let finished = run("cat; echo out; head -c 300000 /dev/zero >&2; echo err >&2; exit 1", LONG).expect("in time");
        assert_eq!((finished.status.code(), finished.stdout.as_str()), (Some(1), "out\n"));
        assert!(finished.stderr.ends_with("err\n") && finished.stderr.len() == KEPT_BYTES);
        let begun = Instant::now();
        assert_eq!(run("exec sleep 60", Duration::from_millis(50)), None);
        assert!(begun.elapsed() < LONG);
    }

    /// Whether any program runs with this word among its arguments.
    fn runs(word: &str) -> bool {
        let told = Command::new("ps").args(["-A", "-o", "args"]).output().expect("ps");
        String::from_utf8_lossy(&told.stdout).lines().any(|line| line.contains(word))
    }

    #[test]
    fn nothing_behind_a_wrapper_is_left_running() {
        // Behind a wrapper that waits, and behind one that has ended; each sleeps for a time that nobody else does.
        for (script, word) in [("sleep 61.171; true", "sleep 61.171"), ("sleep 61.172 & echo begun", "sleep 61.172")] {
            let mut program = Program::start(&mut shell(script), 100).expect("a shell");
            let _ = program.ask(Vec::new(), Duration::from_millis(500));
            assert!(runs(word), "{word}");
            drop(program);
            assert!(!runs(word), "{word}");
        }
        let begun = Instant::now();
        assert_eq!(super::run(&mut shell("sleep 61.173; true"), Duration::from_millis(300)).expect("a shell"), None);
        assert!(!runs("sleep 61.173") && begun.elapsed() < LONG);
    }

    #[test]
    fn what_cannot_be_started_is_an_error() {
        assert!(super::run(&mut Command::new("no-such-program"), LONG).is_err());
    }
}

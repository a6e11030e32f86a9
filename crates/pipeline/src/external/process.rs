//! One process of an external ego: started, asked, and ended.

use super::command::EgoCommand;
use super::protocol::{Answer, PROTOCOL, Reset, Said, Step};
use recrash_model::record::PartnerKind;
use recrash_model::rollout::Termination;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Scenario;
use recrash_sim::{CastMember, Controls, EgoDriver, Observation};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The longest answer; a control has some fifty bytes. [bytes]
const MAX_ANSWER_BYTES: u64 = 1 << 20;

/// How much of what a program writes to stderr is kept. [bytes]
const KEPT_COMPLAINT_BYTES: usize = 2000;

/// How long a program may take to end by itself when it is no longer needed.
const FAREWELL: Duration = Duration::from_millis(300);

/// How long answers are waited for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patience {
    /// From the start to the first answer; a program may load much.
    pub start: Duration,
    /// For every later answer.
    pub answer: Duration,
}

impl Default for Patience {
    fn default() -> Self {
        Self { start: Duration::from_secs(60), answer: Duration::from_secs(10) }
    }
}

/// What an external ego did wrong.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum EgoFault {
    /// The program could not be started.
    #[error("could not be started as `{program}`: {reason}; check the name, or give the whole path")]
    NoProgram {
        /// What was tried.
        program: String,
        /// What the system said.
        reason: String,
    },
    /// It speaks another version of the protocol, or names none.
    #[error("speaks {found}, not \"{PROTOCOL}\"; see docs/ego-protocol.md")]
    Protocol {
        /// What it named.
        found: String,
    },
    /// It did not answer in time and was ended.
    #[error("gave no answer to {question} within {seconds} s (--ego-timeout allows more)")]
    Hung {
        /// What it was asked.
        question: String,
        /// How long it was waited for. [s]
        seconds: u64,
    },
    /// It ended by itself.
    #[error("ended at {question}{}", ending(status, complaint))]
    Ended {
        /// What it was asked.
        question: String,
        /// Its exit status.
        status: String,
        /// The last it wrote to stderr.
        complaint: String,
    },
    /// It wrote something that is no answer.
    #[error("answered {question} with something else than {wanted}: {beginning} (its own messages belong on stderr)")]
    Rubbish {
        /// What it was asked.
        question: String,
        /// What should have come.
        wanted: &'static str,
        /// The beginning of what it wrote.
        beginning: String,
    },
    /// A number of its answer is none.
    #[error("answered {question} with {beginning}: controls must be finite numbers")]
    NotFinite {
        /// What it was asked.
        question: String,
        /// The beginning of what it wrote.
        beginning: String,
    },
    /// Its answer has no end.
    #[error("answered {question} with more than 1 MiB in one line")]
    TooLong {
        /// What it was asked.
        question: String,
    },
    /// It says itself that it failed.
    #[error("failed at {question}, saying: {message}")]
    Told {
        /// What it was asked.
        question: String,
        /// What it said.
        message: String,
    },
}

fn ending(status: &str, complaint: &str) -> String {
    let saying = if complaint.is_empty() { String::new() } else { format!(", saying: {complaint}") };
    format!(" ({status}){saying}")
}

/// A running program that has said it is ready.
pub(crate) struct EgoProcess {
    /// The ego's name in rollouts: the command as typed.
    name: String,
    child: Child,
    /// To the thread that writes to its stdin: a program that does not read must not stop us.
    stdin: Option<Sender<Vec<u8>>>,
    answers: Receiver<Line>,
    complaint: Arc<Mutex<String>>,
    patience: Patience,
    /// Names of the run's actors but the ego.
    ids: Vec<String>,
    spec: VehicleSpec,
}

/// A line of output.
enum Line {
    Text(String),
    TooLong,
}

impl EgoProcess {
    /// Starts the program and waits until it is ready.
    pub(crate) fn start(command: &EgoCommand, patience: Patience) -> Result<Self, EgoFault> {
        let mut child = Command::new(&command.program)
            .args(&command.arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| EgoFault::NoProgram { program: command.program.clone(), reason: error.to_string() })?;
        let answers = read_lines(child.stdout.take());
        let complaint = keep_tail(child.stderr.take());
        let stdin = child.stdin.take().map(write_all);
        let mut process = Self {
            name: command.as_str().to_owned(),
            child,
            stdin,
            answers,
            complaint,
            patience,
            ids: Vec::new(),
            spec: VehicleSpec::of(PartnerKind::PassengerCar),
        };
        let hello = Said::Hello { protocol: PROTOCOL, recrash: env!("CARGO_PKG_VERSION") };
        match process.ask(&hello, "hello", patience.start, READY)? {
            (Answer::Ready { protocol: Some(protocol) }, _) if protocol == PROTOCOL => Ok(process),
            (Answer::Ready { protocol: Some(other) }, _) => {
                Err(EgoFault::Protocol { found: format!("\"{}\"", printable(&other, 40)) })
            }
            (Answer::Ready { protocol: None }, _) => Err(EgoFault::Protocol { found: "no version".to_owned() }),
            (_, line) => Err(rubbish("hello", READY, &line)),
        }
    }

    /// Says something and waits for the answer, which comes with the line it was.
    fn ask(
        &mut self,
        said: &Said<'_>,
        question: &str,
        patience: Duration,
        wanted: &'static str,
    ) -> Result<(Answer, String), EgoFault> {
        if !self.say(said) {
            return Err(self.ended(question));
        }
        match self.answers.recv_timeout(patience) {
            Ok(Line::Text(line)) => match serde_json::from_str(&line) {
                Ok(Answer::Error { message }) => {
                    Err(EgoFault::Told { question: question.to_owned(), message: printable(&message, 300) })
                }
                Ok(answer) => Ok((answer, line)),
                Err(_) if names_no_number(&line) => {
                    Err(EgoFault::NotFinite { question: question.to_owned(), beginning: printable(&line, 80) })
                }
                Err(_) => Err(rubbish(question, wanted, &line)),
            },
            Ok(Line::TooLong) => Err(EgoFault::TooLong { question: question.to_owned() }),
            Err(RecvTimeoutError::Timeout) => {
                Err(EgoFault::Hung { question: question.to_owned(), seconds: patience.as_secs() })
            }
            Err(RecvTimeoutError::Disconnected) => Err(self.ended(question)),
        }
    }

    /// Says something; false where nobody listens.
    fn say(&self, said: &Said<'_>) -> bool {
        let mut line = serde_json::to_vec(said).unwrap_or_else(|_| unreachable!("numbers and texts serialise"));
        line.push(b'\n');
        self.stdin.as_ref().is_some_and(|stdin| stdin.send(line).is_ok())
    }

    /// What to say of a program that has ended; its last words may still be on their way.
    fn ended(&mut self, question: &str) -> EgoFault {
        let status = self.wait(Duration::from_secs(1));
        std::thread::sleep(Duration::from_millis(20));
        let complaint = self.complaint.lock().unwrap_or_else(PoisonError::into_inner);
        let last = complaint.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
        EgoFault::Ended {
            question: question.to_owned(),
            status: status.map_or_else(|| "it closed its output".to_owned(), |status| status.to_string()),
            complaint: printable(last, 300),
        }
    }

    /// Waits for its end, but no longer than this.
    fn wait(&mut self, longest: Duration) -> Option<ExitStatus> {
        let until = Instant::now() + longest;
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => return Some(status),
                Ok(None) if Instant::now() < until => std::thread::sleep(Duration::from_millis(5)),
                _ => return None,
            }
        }
    }
}

const READY: &str = "{\"type\":\"ready\"}";
const CONTROL: &str = "{\"type\":\"control\"} with throttle and steer, or acceleration_mps2 and wheel_angle_rad";

impl EgoDriver for EgoProcess {
    type Error = EgoFault;

    fn name(&self) -> &str {
        &self.name
    }

    fn begin(&mut self, scenario: &Scenario, cast: &[CastMember]) -> Result<(), EgoFault> {
        let draft = scenario.draft();
        self.ids = cast.iter().enumerate().skip(1).map(|(position, member)| member.id(draft, position)).collect();
        self.spec = VehicleSpec::of(scenario.ego().kind);
        let reset = Said::Reset(Box::new(Reset::new(scenario, cast)));
        match self.ask(&reset, "reset", self.patience.answer, READY)? {
            (Answer::Ready { .. }, _) => Ok(()),
            (_, line) => Err(rubbish("reset", READY, &line)),
        }
    }

    fn decide(&mut self, observation: &Observation<'_>) -> Result<Controls, EgoFault> {
        let question = format!("step {}", observation.step);
        let ids = std::mem::take(&mut self.ids);
        let answer = self.ask(&Said::Step(Step::new(observation, &ids)), &question, self.patience.answer, CONTROL);
        self.ids = ids;
        match answer? {
            (Answer::Control(control), _) => Ok(control.controls(&self.spec)),
            (_, line) => Err(rubbish(&question, CONTROL, &line)),
        }
    }

    fn end(&mut self, termination: Termination) -> Result<(), EgoFault> {
        // Nothing is answered to this; who is gone by now is noticed at the next reset.
        self.say(&Said::End(termination));
        Ok(())
    }
}

impl Drop for EgoProcess {
    fn drop(&mut self) {
        // A healthy program ends when its stdin does; nobody waits long for another.
        self.stdin = None;
        if self.wait(FAREWELL).is_none() {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

fn rubbish(question: &str, wanted: &'static str, line: &str) -> EgoFault {
    EgoFault::Rubbish { question: question.to_owned(), wanted, beginning: printable(line, 80) }
}

/// Whether a line is no JSON because of a number that JSON does not have: many languages write these all the same.
fn names_no_number(line: &str) -> bool {
    line.contains("\"control\"") && ["NaN", "nan", "Infinity", "inf"].iter().any(|word| line.contains(word))
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
    // One answer at a time is awaited: a program that writes more than it was asked for waits itself.
    let (sender, receiver) = sync_channel(1);
    if let Some(pipe) = pipe {
        std::thread::spawn(move || {
            let mut reader = BufReader::new(pipe);
            loop {
                let mut line = Vec::new();
                let text = match reader.by_ref().take(MAX_ANSWER_BYTES).read_until(b'\n', &mut line) {
                    Ok(0) | Err(_) => return,
                    Ok(_) if line.last() == Some(&b'\n') || (line.len() as u64) < MAX_ANSWER_BYTES => {
                        Line::Text(String::from_utf8_lossy(&line).into_owned())
                    }
                    Ok(_) => Line::TooLong,
                };
                if sender.send(text).is_err() {
                    return;
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

//! One process of an external ego: started, asked, and ended.

use super::command::EgoCommand;
use super::protocol::{Answer, PROTOCOL, Reset, Said, Step};
use crate::secrets;
use recrash_agents::llm::Scrubber;
use recrash_child::{Program, Silence, printable};
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::Termination;
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::Scenario;
use recrash_sim::{CastMember, Controls, EgoDriver, Observation};
use std::process::Command;
use std::time::{Duration, Instant};

/// The longest answer; a control has some fifty bytes. [bytes]
const MAX_ANSWER_BYTES: u64 = 1 << 20;

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
    #[error("gave no answer to {question} within {seconds} s")]
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
    program: Program,
    patience: Patience,
    /// Names of the run's actors but the ego.
    ids: Vec<String>,
    spec: VehicleSpec,
    scrubber: Scrubber,
    /// How long each decision was waited for, until they are taken. [us]
    waited_us: Vec<u32>,
}

impl EgoProcess {
    /// Starts the program and waits until it is ready.
    pub(crate) fn start(command: &EgoCommand, patience: Patience) -> Result<Self, EgoFault> {
        let program = Program::start(Command::new(&command.program).args(&command.arguments), MAX_ANSWER_BYTES)
            .map_err(|error| EgoFault::NoProgram { program: command.program.clone(), reason: error.to_string() })?;
        let mut process = Self {
            name: command.as_str().to_owned(),
            program,
            patience,
            ids: Vec::new(),
            spec: VehicleSpec::of(PartnerKind::PassengerCar),
            scrubber: secrets::scrubber(),
            waited_us: Vec::new(),
        };
        let hello = Said::Hello { protocol: PROTOCOL, recrash: env!("CARGO_PKG_VERSION") };
        match process.ask(&hello, "hello", patience.start, READY)? {
            (Answer::Ready { protocol: Some(protocol) }, _) if protocol == PROTOCOL => Ok(process),
            (Answer::Ready { protocol: Some(other) }, _) => {
                Err(EgoFault::Protocol { found: format!("\"{}\"", process.presentable(&other, 40)) })
            }
            (Answer::Ready { protocol: None }, _) => Err(EgoFault::Protocol { found: "no version".to_owned() }),
            (_, line) => Err(process.rubbish("hello", READY, &line)),
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
        let asked = || question.to_owned();
        let line = self.program.ask(line_of(said), patience).map_err(|silence| match silence {
            Silence::Hung => EgoFault::Hung { question: asked(), seconds: patience.as_secs() },
            Silence::TooLong => EgoFault::TooLong { question: asked() },
            Silence::Ended { status, complaint } => {
                let complaint = self.presentable(&complaint, 300);
                let status = status.map_or_else(|| "it closed its output".to_owned(), |status| status.to_string());
                EgoFault::Ended { question: asked(), status, complaint }
            }
        })?;
        match serde_json::from_str(&line) {
            Ok(Answer::Error { message }) => {
                Err(EgoFault::Told { question: asked(), message: self.presentable(&message, 300) })
            }
            Ok(answer) => Ok((answer, line)),
            Err(_) if names_no_number(&line) => {
                Err(EgoFault::NotFinite { question: asked(), beginning: self.presentable(&line, 80) })
            }
            Err(_) => Err(self.rubbish(question, wanted, &line)),
        }
    }
}

impl EgoProcess {
    /// How long its decisions took since this was asked last. [us]
    pub(super) fn take_waited(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.waited_us)
    }

    fn rubbish(&self, question: &str, wanted: &'static str, line: &str) -> EgoFault {
        EgoFault::Rubbish { question: question.to_owned(), wanted, beginning: self.presentable(line, 80) }
    }

    /// The beginning of what the program said, printable and without keys: it ends up in files of the suite.
    fn presentable(&self, text: &str, longest: usize) -> String {
        /// How much is looked through for keys, so that none is cut in half before. [characters]
        const LOOKED_THROUGH: usize = 8_192;
        printable(&self.scrubber.scrub(&printable(text, LOOKED_THROUGH)), longest)
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
            (_, line) => Err(self.rubbish("reset", READY, &line)),
        }
    }

    fn decide(&mut self, observation: &Observation<'_>) -> Result<Controls, EgoFault> {
        let question = format!("step {}", observation.step);
        let ids = std::mem::take(&mut self.ids);
        let asked = Instant::now();
        let answer = self.ask(&Said::Step(Step::new(observation, &ids)), &question, self.patience.answer, CONTROL);
        self.waited_us.push(u32::try_from(asked.elapsed().as_micros()).unwrap_or(u32::MAX));
        self.ids = ids;
        match answer? {
            (Answer::Control(control), _) => Ok(control.controls(&self.spec)),
            (_, line) => Err(self.rubbish(&question, CONTROL, &line)),
        }
    }

    fn end(&mut self, termination: Termination) -> Result<(), EgoFault> {
        // Nothing is answered to this; who is gone by now is noticed at the next reset.
        self.program.say(line_of(&Said::End(termination)));
        Ok(())
    }
}

impl Drop for EgoProcess {
    fn drop(&mut self) {
        self.program.dismiss(FAREWELL);
    }
}

fn line_of(said: &Said<'_>) -> Vec<u8> {
    let mut line = serde_json::to_vec(said).unwrap_or_else(|_| unreachable!("numbers and texts serialise"));
    line.push(b'\n');
    line
}

/// Whether a line is no JSON because of a number that JSON does not have: many languages write these all the same.
fn names_no_number(line: &str) -> bool {
    line.contains("\"control\"") && ["NaN", "nan", "Infinity", "inf"].iter().any(|word| line.contains(word))
}

//! Our MiniLM beside sentence-transformers: the same texts, the same weights, the same threads, in turn in one run.

use crate::embedding::weights::{find_weights, load};
use crate::error::{Choice, PipelineError};
use crate::options::Options;
use crate::reading::records::read_records;
use rayon::prelude::*;
use recrash_child::{Program, Silence, printable};
use recrash_model::record::Redaction;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// What Python runs.
const SCRIPT: &str = include_str!("embed_bench.py");
/// Longest wait for one answer of Python: importing torch takes up to a minute on a cold disk.
const PATIENCE: Duration = Duration::from_secs(600);
/// Longest answer: 2,000 rows of 384 numbers. [bytes]
const MAX_ANSWER_BYTES: u64 = 64 << 20;
/// Rest before each measurement, in which the other side's threads go to sleep. [s]
const REST_S: f64 = 0.5;

/// What to measure.
#[derive(Debug, Clone, PartialEq)]
pub struct EmbedBenchRequest {
    /// Where narratives come from: every readable one of these records, in their order.
    pub options: Options,
    /// At most so many narratives.
    pub count: usize,
    /// Measurements of each side, in turn.
    pub rounds: usize,
    /// Threads of each side.
    pub threads: usize,
    /// Python interpreter with sentence-transformers.
    pub python: PathBuf,
}

/// What was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EmbedBench {
    /// Narratives embedded.
    pub narratives: usize,
    /// Characters of the longest.
    pub longest_chars: usize,
    /// Characters of all narratives.
    pub total_chars: usize,
    /// Threads of each side.
    pub threads: usize,
    /// Ours first.
    pub sides: [BenchSide; 2],
    /// Greatest difference of any value of any row.
    pub max_difference: f64,
}

/// One side of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BenchSide {
    /// Program and versions.
    pub name: String,
    /// Reading the model's files. [s]
    pub load_s: f64,
    /// Each measurement: all narratives once. [s]
    pub times_s: Vec<f64>,
}

impl BenchSide {
    /// The middle one of the measurements. [s]
    pub fn median_s(&self) -> f64 {
        let mut times = self.times_s.clone();
        times.sort_by(f64::total_cmp);
        times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// The least of the measurements. [s]
    pub fn best_s(&self) -> f64 {
        self.times_s.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// Measures both sides.
///
/// # Errors
/// The model's files are not here, there is nothing to embed, or Python fails.
pub fn bench_embedding(request: &EmbedBenchRequest) -> Result<EmbedBench, PipelineError> {
    let records = read_records(&request.options)?.value.records;
    let readable = records.iter().filter(|record| record.redaction == Redaction::Open);
    let texts: Vec<&str> = readable.map(|record| record.narrative.as_str()).take(request.count).collect();
    if texts.is_empty() {
        return Err(PipelineError::choose("no readable narrative to embed; give a crash file", Choice::Records));
    }
    let given = request.options.model_dir.clone();
    let folder = given.or_else(|| find_weights(&request.python).map(|weights| weights.folder)).ok_or_else(|| {
        PipelineError::bad_input(
            "the files of all-MiniLM-L6-v2 are not on this machine; `recrash model pull` gets them",
        )
    })?;
    let begun = Instant::now();
    let model = load(&folder)?;
    let load_s = begun.elapsed().as_secs_f64();
    let threads = rayon::ThreadPoolBuilder::new().num_threads(request.threads).build();
    let threads = threads.map_err(|e| PipelineError::Threads(e.to_string()))?;
    let name = format!("recrash {}", env!("CARGO_PKG_VERSION"));
    let mut ours = BenchSide { name, load_s, times_s: Vec::new() };
    let (mut python, mut theirs) = Python::start(&request.python, &folder, request.threads, &texts)?;
    let mut rows: Vec<Vec<f32>> = Vec::new();
    for _ in 0..request.rounds.max(1) {
        std::thread::sleep(Duration::from_secs_f64(REST_S));
        let begun = Instant::now();
        rows = threads.install(|| texts.par_iter().map(|text| model.embed_text(text)).collect());
        ours.times_s.push(begun.elapsed().as_secs_f64());
        std::thread::sleep(Duration::from_secs_f64(REST_S));
        theirs.times_s.push(python.ask("run")?.seconds.ok_or_else(|| failed("no time came"))?);
    }
    let their_rows = python.ask("rows")?.rows.ok_or_else(|| failed("no rows came"))?;
    let same_shape = rows.len() == their_rows.len() && rows.iter().zip(&their_rows).all(|(a, b)| a.len() == b.len());
    if !same_shape {
        return Err(failed("its rows have another number or length"));
    }
    let pairs = rows.iter().zip(&their_rows).flat_map(|(a, b)| a.iter().zip(b));
    let max_difference = pairs.map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
    let chars: Vec<usize> = texts.iter().map(|text| text.chars().count()).collect();
    Ok(EmbedBench {
        narratives: texts.len(),
        longest_chars: chars.iter().copied().max().unwrap_or(0),
        total_chars: chars.iter().sum(),
        threads: request.threads,
        sides: [ours, theirs],
        max_difference,
    })
}

/// One line from Python.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Answer {
    error: Option<String>,
    name: Option<String>,
    load_s: f64,
    seconds: Option<f64>,
    rows: Option<Vec<Vec<f64>>>,
}

#[derive(Serialize)]
struct Task<'a> {
    model: &'a Path,
    threads: usize,
    texts: &'a [&'a str],
}

/// The other side.
struct Python(Program);

impl Python {
    fn start(
        interpreter: &Path,
        model: &Path,
        threads: usize,
        texts: &[&str],
    ) -> Result<(Self, BenchSide), PipelineError> {
        let mut command = Command::new(interpreter);
        command.args(["-c", SCRIPT]);
        command.env("OMP_NUM_THREADS", threads.to_string()).env("TOKENIZERS_PARALLELISM", "false");
        let started = Program::start(&mut command, MAX_ANSWER_BYTES);
        let mut this =
            Self(started.map_err(|e| {
                failed(&format!("cannot start {}: {e}; name another interpreter", interpreter.display()))
            })?);
        let task = serde_json::to_string(&Task { model, threads, texts }).unwrap_or_default();
        let hello = this.ask(&task)?;
        let name = hello.name.ok_or_else(|| failed("it did not tell its name"))?;
        Ok((this, BenchSide { name, load_s: hello.load_s, times_s: Vec::new() }))
    }

    fn ask(&mut self, question: &str) -> Result<Answer, PipelineError> {
        let line = self.0.ask(format!("{question}\n").into_bytes(), PATIENCE);
        let line = line.map_err(|silence| match silence {
            Silence::Hung => failed("it gave no answer in time"),
            Silence::TooLong => failed("its answer has no end"),
            Silence::Ended { complaint, .. } => failed(&format!("it ended, saying: {}", printable(&complaint, 300))),
        })?;
        let answer: Answer = serde_json::from_str(&line).map_err(|e| failed(&format!("its answer is none: {e}")))?;
        match answer.error {
            Some(error) => Err(failed(&error)),
            None => Ok(answer),
        }
    }
}

fn failed(why: &str) -> PipelineError {
    PipelineError::bad_input(format!("Python with sentence-transformers: {why}"))
}

//! Suites: run stage by stage, with progress and Ctrl-C.

use crate::errors::{input, of_library, to_json, to_python};
use crate::host::interpreter;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use recrash_pipeline::{
    Options, Permissions, PipelineError, Progress, ProgressEvent, Resources, Stage, Suite, check_choices,
    must_be_ready, run_stage,
};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// How often Python is asked whether somebody wants it to stop.
const LOOK_UP: Duration = Duration::from_millis(100);

/// Somebody pressed Ctrl-C: unwinds from the next unit of work, of which nothing is half written.
struct Interrupted;

/// Hands what happens to the thread that speaks Python.
struct Reporter {
    sender: Mutex<Sender<(String, usize, bool)>>,
    stop: AtomicBool,
}

impl Progress for Reporter {
    fn event(&self, event: ProgressEvent<'_>) {
        if self.stop.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Interrupted));
        }
        let said = match event {
            ProgressEvent::Started { stage, units } => (stage.to_owned(), units, true),
            ProgressEvent::Advanced { stage, .. } => (stage.to_owned(), 1, false),
            ProgressEvent::Said { .. } | ProgressEvent::Finished { .. } => return,
        };
        if let Ok(sender) = self.sender.lock() {
            // Nobody listens any more once the run is given up.
            let _ = sender.send(said);
        }
    }
}

/// Options of a suite, from the defaults and what was chosen.
fn options(py: Python<'_>, chosen: &Bound<'_, PyDict>) -> PyResult<Options> {
    let mut all = serde_json::to_value(Options::default()).map_err(|error| input(py, error))?;
    let chosen: serde_json::Value =
        serde_json::from_str(&to_json(chosen.as_any())?).map_err(|error| input(py, error))?;
    if let (Some(all), serde_json::Value::Object(chosen)) = (all.as_object_mut(), chosen) {
        for (name, value) in chosen {
            if !all.contains_key(&name) {
                let known: Vec<&str> = all.keys().map(String::as_str).collect();
                return Err(input(py, format!("there is no option \"{name}\"; there are: {}", known.join(", "))));
            }
            all.insert(name, value);
        }
    }
    serde_json::from_value(all).map_err(|error| input(py, format!("an option cannot be used: {error}")))
}

/// Makes a suite, or goes on with one. `progress(stage, units, begins)` is called as work goes on.
#[pyfunction]
#[pyo3(signature = (folder, chosen, progress=None, threads=None, replace=false, trust=false, until=None, python=None))]
#[allow(clippy::too_many_arguments, reason = "one for each argument of the Python function")]
pub fn run_suite(
    py: Python<'_>,
    folder: PathBuf,
    chosen: &Bound<'_, PyDict>,
    progress: Option<&Bound<'_, PyAny>>,
    threads: Option<usize>,
    replace: bool,
    trust: bool,
    until: Option<&str>,
    python: Option<PathBuf>,
) -> PyResult<()> {
    let options = options(py, chosen)?;
    let last = match until {
        None => Stage::Report,
        Some(name) => Stage::ALL.into_iter().find(|stage| stage.name() == name).ok_or_else(|| {
            input(py, format!("there is no stage \"{name}\"; there are: {}", Stage::ALL.map(Stage::name).join(", ")))
        })?,
    };
    let permissions = Permissions { replace, trust, ..Permissions::default() };
    let python = interpreter(py, python)?;
    let resources = Resources { threads, permissions, python, ..Resources::default() };
    let (sender, mut receiver) = channel();
    let reporter = Reporter { sender: Mutex::new(sender), stop: AtomicBool::new(false) };
    let work = || {
        let suite = Suite::open(&folder, options, resources)?;
        check_choices(&suite)?;
        if last >= Stage::Simulate {
            must_be_ready(&suite)?;
        }
        for stage in Stage::ALL.into_iter().filter(|stage| *stage <= last) {
            run_stage(&suite, stage, &reporter)?;
        }
        Ok(())
    };
    watched(py, work, &reporter, &mut receiver, progress)?.map_err(|failed: PipelineError| of_library(py, &failed))
}

/// Does work in a thread of its own, while this one tells its progress and listens to Ctrl-C.
fn watched<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send,
    reporter: &Reporter,
    receiver: &mut Receiver<(String, usize, bool)>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<T> {
    std::thread::scope(|scope| {
        let worker = scope.spawn(|| catch_unwind(AssertUnwindSafe(work)));
        let mut interrupted = None;
        loop {
            // Asked first: what was said before the work was done is still heard.
            let done = worker.is_finished();
            let heard = &mut *receiver;
            let said = py.detach(move || heard.recv_timeout(if done { Duration::ZERO } else { LOOK_UP }));
            let told = match (said, progress) {
                (Ok(_), _) if interrupted.is_some() => Ok(()),
                (Ok((stage, units, begins)), Some(progress)) => progress.call1((stage, units, begins)).map(drop),
                (Err(RecvTimeoutError::Disconnected), _) => break,
                (Err(RecvTimeoutError::Timeout), _) if done => break,
                _ => Ok(()),
            };
            if let Err(error) = told.and_then(|()| py.check_signals()) {
                reporter.stop.store(true, Ordering::Relaxed);
                interrupted.get_or_insert(error);
            }
        }
        let done: Result<T, Box<dyn Any + Send>> = py.detach(|| worker.join()).unwrap_or_else(Err);
        match (interrupted, done) {
            (Some(error), _) => Err(error),
            (None, Ok(done)) => Ok(done),
            (None, Err(panic)) => resume_unwind(panic),
        }
    })
}

/// Crash types of the scenarios in a folder, by their ids: of a suite by accounts, or of a frozen one.
#[pyfunction]
pub fn crash_types<'py>(py: Python<'py>, folder: PathBuf) -> PyResult<Bound<'py, PyAny>> {
    to_python(py, &py.detach(|| recrash_pipeline::crash_types(&folder)))
}

/// Options of the suite in a folder.
#[pyfunction]
pub fn suite_options<'py>(py: Python<'py>, folder: PathBuf) -> PyResult<Bound<'py, PyAny>> {
    match Suite::saved_options(&folder).map_err(|failed| of_library(py, &failed))? {
        Some(options) => to_python(py, &options),
        None => {
            let text = format!("there is no suite in {}: it holds no suite.json; check the folder", folder.display());
            Err(input(py, text))
        }
    }
}

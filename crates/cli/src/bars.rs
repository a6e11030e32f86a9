//! Progress: bars with counts and time left on a terminal; elsewhere one plain line per stage, and one every ten seconds while it
//! lasts.

use crate::screen::one_line;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use recrash_pipeline::{Progress, ProgressEvent};
use std::io::{IsTerminal, Write};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How often it is said off a terminal how far a stage is: a log shows that the program is alive.
const SAID_EVERY: Duration = Duration::from_secs(10);

/// Shows the pipeline's progress on standard error.
pub struct Bars {
    terminal: bool,
    current: Mutex<Option<Current>>,
}

struct Current {
    bar: ProgressBar,
    begun: Instant,
    units: usize,
    skipped: usize,
    /// Ends the thread that says how far it is.
    _told: Option<Sender<()>>,
}

/// Says every now and then how far a stage is, until the other end is dropped.
fn tell(stage: &str, bar: &ProgressBar, units: usize) -> Sender<()> {
    let (stop, stopped) = channel::<()>();
    let (stage, bar) = (one_line(stage), bar.clone());
    let begun = Instant::now();
    std::thread::spawn(move || {
        while stopped.recv_timeout(SAID_EVERY) == Err(RecvTimeoutError::Timeout) {
            let (done, seconds) = (bar.position(), begun.elapsed().as_secs());
            // A closed standard error is no reason to stop.
            let _ = writeln!(anstream::stderr(), "  {stage:<9} {done}/{units} after {seconds} s");
        }
    });
    stop
}

impl Bars {
    /// Bars where standard error is a terminal.
    pub fn new() -> Self {
        Self { terminal: std::io::stderr().is_terminal(), current: Mutex::new(None) }
    }
}

impl Progress for Bars {
    fn event(&self, event: ProgressEvent<'_>) {
        let mut current = self.current.lock().unwrap_or_else(PoisonError::into_inner);
        match event {
            // A closed standard error is no reason to stop.
            ProgressEvent::Said { what } => drop(writeln!(anstream::stderr(), "  {}", one_line(what))),
            ProgressEvent::Started { stage, units } => {
                let target = if self.terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
                let bar = ProgressBar::with_draw_target(Some(units as u64), target);
                let template = "  {prefix:<9} {bar:28} {pos}/{len}  {msg:.dim}  {eta} left";
                bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
                bar.set_prefix(stage.to_owned());
                bar.enable_steady_tick(Duration::from_millis(200));
                let told = (!self.terminal).then(|| tell(stage, &bar, units));
                *current = Some(Current { bar, begun: Instant::now(), units, skipped: 0, _told: told });
            }
            ProgressEvent::Advanced { unit, skipped, .. } => {
                if let Some(current) = current.as_mut() {
                    current.skipped += usize::from(skipped);
                    current.bar.set_message(one_line(unit));
                    current.bar.inc(1);
                }
            }
            ProgressEvent::Finished { stage } => {
                if let Some(done) = current.take() {
                    done.bar.finish_and_clear();
                    let there =
                        if done.skipped > 0 { format!(" ({} there already)", done.skipped) } else { String::new() };
                    let seconds = done.begun.elapsed().as_secs_f64();
                    // A closed standard error is no reason to stop.
                    let _ = writeln!(
                        anstream::stderr(),
                        "  {stage:<9} {}/{}{there}  {seconds:.1} s",
                        done.units,
                        done.units
                    );
                }
            }
        }
    }
}

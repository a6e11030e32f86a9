//! How results reach people and programs: JSON, errors, remarks. Colours only on a terminal.

use crate::bars::Bars;
use crate::screen::{self, bold, dim, eprintln, println, red, yellow};
use recrash_model::diagnostic::{Diagnostic, Severity};
use recrash_model::frozen::FROZEN_FILE;
use recrash_pipeline::{Choice, NoProgress, PipelineError, Progress, StageReport, Suite, quoted};
use serde::Serialize;
use std::borrow::Cow;

/// Remarks of one stage that are shown one by one.
const REMARKS_SHOWN: usize = 8;

/// What the user wants to see.
#[derive(Clone, Copy)]
pub struct Output {
    /// Results as JSON on standard output.
    pub json: bool,
    /// Errors only.
    pub quiet: bool,
}

impl Output {
    /// Where progress is told.
    pub fn progress(self) -> Box<dyn Progress> {
        if self.quiet || self.json { Box::new(NoProgress) } else { Box::new(Bars::new()) }
    }

    /// Whether to print tables for people.
    pub fn tables(self) -> bool {
        !self.quiet && !self.json
    }
}

/// Prints a value as JSON.
pub fn json<T: Serialize>(value: &T) {
    // Paths are told as text, so that every result can be.
    let mut text = serde_json::to_vec_pretty(value).expect("results serialise");
    text.push(b'\n');
    screen::raw(&text);
}

/// Prints why the command stopped.
pub fn error(error: &PipelineError) {
    eprintln!("{} {error}", bold(red("error:")));
    if let PipelineError::BadInput { diagnostics, .. } = error {
        for diagnostic in diagnostics.iter().take(REMARKS_SHOWN) {
            remark(diagnostic);
        }
        if diagnostics.len() > REMARKS_SHOWN {
            eprintln!("  ... and {} more", diagnostics.len() - REMARKS_SHOWN);
        }
    }
    if let Some(options) = options_for(error) {
        eprintln!("  {options}");
    }
}

/// The options that mend an error: the library knows none.
fn options_for(error: &PipelineError) -> Option<Cow<'static, str>> {
    let options = match error {
        PipelineError::MissingStage { dir, missing: stage } | PipelineError::StaleStage { dir, stage } => {
            return Some(format!("recrash {stage} --out {} runs it", quoted(&dir.to_string_lossy())).into());
        }
        PipelineError::NoSuite { dir } if !dir.join(FROZEN_FILE).is_file() => {
            return Some(format!("recrash run --out {} makes one there", quoted(&dir.to_string_lossy())).into());
        }
        PipelineError::Choose { choice, .. } => options_of(*choice),
        PipelineError::Busy { .. } | PipelineError::NotASuite { .. } => "--out names the folder",
        PipelineError::OtherSuite { .. } => "--out names the folder; --replace makes this suite in the other's place",
        PipelineError::ChangedBesideEdit { .. } | PipelineError::NoJournal { .. } => {
            "--discard-edits makes everything anew, what was edited too"
        }
        PipelineError::Untrusted { .. } => "--ego names the program; --trust trusts the suite",
        PipelineError::BudgetSpent(_) => "--max-tokens and --max-cost are the caps",
        PipelineError::Threads(_) => "--threads 1 is the least",
        _ => return None,
    };
    Some(options.into())
}

/// The options by which something is chosen.
fn options_of(choice: Choice) -> &'static str {
    match choice {
        Choice::ExportFolder => "--force overwrites them; --to-dir names another folder",
        Choice::ImportFile => "--force overwrites it; --out names another file",
        Choice::FrozenSuite => "--replace makes this one in its place",
        Choice::Records => "--records names them; recrash fetch --edition archive and recrash fetch download NHTSA's",
        Choice::Record => "recrash records --csv FILE lists them",
        Choice::Filter => "recrash records --help lists the fields",
        Choice::ModelFolder => "--model-dir names the folder",
    }
}

/// Prints that the standard output cannot be written.
pub fn cannot_print(error: &std::io::Error) {
    eprintln!("{} cannot write the standard output: {error}", bold(red("error:")));
}

/// Prints what is wrong with what was typed, in the words of the command line's library.
pub fn usage(text: &str) {
    match text.trim_end().strip_prefix("error:") {
        Some(what) => eprintln!("{}{what}", bold(red("error:"))),
        None => eprintln!("{}", text.trim_end()),
    }
}

/// Prints the command that goes on where this one stopped.
pub fn go_on() {
    let words: Vec<String> = std::env::args_os().map(|word| quoted(&word.to_string_lossy())).collect();
    eprintln!("go on with: {}", words.join(" "));
}

/// Prints that the user stopped the program, and how to go on where something was kept.
pub fn interrupted(goes_on: bool) {
    if goes_on {
        eprintln!("\ninterrupted; what is done is kept");
        go_on();
    } else {
        eprintln!("\ninterrupted");
    }
}

/// Prints one remark.
pub fn remark(diagnostic: &Diagnostic) {
    let option = match (&*diagnostic.code, diagnostic.severity) {
        ("suite.edited", Severity::Warning) => Some("--discard-edits makes it anew"),
        ("select.new-without-pick", _) => Some("--reselect chooses anew"),
        _ => None,
    };
    let with_option = option.map(|option| diagnostic.clone().with_hint(option));
    let diagnostic = with_option.as_ref().unwrap_or(diagnostic);
    match diagnostic.severity {
        Severity::Error => eprintln!("  {} {diagnostic}", red("error")),
        Severity::Warning => eprintln!("  {} {diagnostic}", yellow("warning")),
        Severity::Note => eprintln!("  {} {diagnostic}", dim("note")),
    }
}

/// Prints the remarks of a stage.
pub fn remarks(report: &StageReport) {
    remark_list(&report.diagnostics, "in the files of the suite");
}

/// Prints what there is to say about the answers of a batch: every line, because each was paid for.
pub fn batch_remarks(suite: &Suite, output: Output) {
    if !output.quiet {
        suite.remarks().iter().for_each(remark);
    }
}

/// Prints remarks, warnings and errors one by one, as far as there is room, and where to find the rest.
pub fn remark_list(diagnostics: &[Diagnostic], the_rest: &str) {
    let serious: Vec<_> = diagnostics.iter().filter(|d| d.severity > Severity::Note).collect();
    serious.iter().take(REMARKS_SHOWN).for_each(|d| remark(d));
    if serious.len() > REMARKS_SHOWN {
        eprintln!("  ... and {} more, {the_rest}", serious.len() - REMARKS_SHOWN);
    }
    for (code, count, first) in notes_by_code(diagnostics) {
        match count {
            1 => remark(first),
            _ => eprintln!("  {} {count} x {code}, the first: {}", dim("note"), first.message),
        }
    }
}

/// Notes, which tell of nothing lost, by their code in order of first appearance: code, how many, the first one.
fn notes_by_code(diagnostics: &[Diagnostic]) -> Vec<(&str, usize, &Diagnostic)> {
    let mut groups: Vec<(&str, usize, &Diagnostic)> = Vec::new();
    for note in diagnostics.iter().filter(|d| d.severity == Severity::Note) {
        match groups.iter_mut().find(|(code, ..)| *code == note.code) {
            Some((_, count, _)) => *count += 1,
            None => groups.push((&note.code, 1, note)),
        }
    }
    groups
}

/// Prints a heading.
pub fn title(text: &str) {
    println!("\n{}", bold(text));
}

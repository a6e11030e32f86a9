//! How results reach people and programs: JSON, tables, lines. Colours only on a terminal.

use crate::bars::Bars;
use anstream::{eprintln, println};
use comfy_table::{Attribute, Cell, CellAlignment, LineStyle, Table, presets};
use owo_colors::OwoColorize;
use recrash_model::diagnostic::{Diagnostic, Severity};
use recrash_pipeline::{NoProgress, PipelineError, Progress, StageReport, Suite};
use serde::Serialize;
use std::io::Write;

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
    let text = serde_json::to_string_pretty(value).unwrap_or_default();
    // A reader that has seen enough (`| head`) is no error.
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Prints why the command stopped.
pub fn error(error: &PipelineError) {
    eprintln!("{} {error}", "error:".red().bold());
    if let PipelineError::BadInput { diagnostics, .. } = error {
        for diagnostic in diagnostics.iter().take(REMARKS_SHOWN) {
            remark(diagnostic);
        }
        if diagnostics.len() > REMARKS_SHOWN {
            eprintln!("  ... and {} more", diagnostics.len() - REMARKS_SHOWN);
        }
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

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Prints one remark.
pub fn remark(diagnostic: &Diagnostic) {
    match diagnostic.severity {
        Severity::Error => eprintln!("  {} {diagnostic}", "error".red()),
        Severity::Warning => eprintln!("  {} {diagnostic}", "warning".yellow()),
        Severity::Note => eprintln!("  {} {diagnostic}", "note".dimmed()),
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
            _ => eprintln!("  {} {count} x {code}, the first: {}", "note".dimmed(), first.message),
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

/// A table with a header.
pub fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    // A line under the header and none between rows: a table of 20 scenarios fits on a screen.
    table.load_style(presets::NOTHING.header_separator(LineStyle::new(' ', '\u{2500}', '\u{2500}', ' ')));
    table.set_header(header.iter().map(|h| Cell::new(h).add_attribute(Attribute::Bold)));
    table
}

/// A cell with a number, to the right.
pub fn number(value: impl ToString) -> Cell {
    Cell::new(value).set_alignment(CellAlignment::Right)
}

/// Prints a heading.
pub fn title(text: &str) {
    println!("\n{}", text.bold());
}
